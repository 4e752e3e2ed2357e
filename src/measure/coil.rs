//! The settled wire, node by node, and what is measured on it.

use super::defect::{DefectKind, DefectLimits};
use super::profile::Profile;
use super::runs::{Run, stations_for};
use super::station::{NEIGHBOUR_WINDOW, Neighbour, Station, closest_point_segment};
use super::{STATION_STEP, STATIONS_PER_TURN};
use crate::math::PersistentVec;
use crate::math::V3;
use crate::math::{polar_angle, wrap_to_pi};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// Fraction of a turn that a bulge or an overlap must cover before its flag rises: 8 degrees.
///
/// Chosen: a noisy node 0.4 mm from its neighbours, 6 mm from the axis, reaches over 7.6 degrees; a
/// 2 mm corner of the 12 x 30 mm core, the shortest place for a wire to ride up, over 11.
const SHORT_RUN: f64 = 8.0 / STATIONS_PER_TURN as f64;

/// What the measures need to know of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct CoilSpec {
    /// wire diameter d, m
    pub diameter: f64,
    /// limits of the defect flags
    pub limits: DefectLimits,
    /// quasi-static height of this wire at this tension; without one the bulge is reported but
    /// only judged against `limits.bulge_absolute`
    pub profile: Option<Profile>,
    /// polar angle of the clamp, rad
    pub start_angle: f64,
    /// +1 where wire runs towards growing polar angle (positive spindle speed), else -1
    pub direction: f64,
    /// sign of the wire's advance along y at the start; 0 counts as +1
    pub traverse: f64,
    /// unstretched length at the clamp, m
    pub clamp_arc: f64,
    /// polar angle of the corner between the faces on +x and +z, rad; pi/4 for a cylinder
    pub corner_angle: f64,
}

/// A node of wire that has come to rest.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SettledNode {
    /// centreline in the core frame, m
    pub position: V3,
    /// unstretched length from the clamp, m
    pub arc: f64,
    /// signed distance of the centreline from the core, minus the radius, m
    pub height: f64,
    /// plastic stretch
    pub plastic_strain: f64,
    /// time at which it came to rest, s
    pub time: f64,
}

/// A node with all that is known after it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Node {
    pub(crate) settled: SettledNode,
    pub(crate) polar: f64,
    /// winding angle from the clamp, rad
    pub(crate) angle: f64,
    /// largest winding angle up to here, rad
    pub(crate) reach: f64,
    sense: f64,
    pass: u32,
    pub(crate) y_min: f64,
    pub(crate) y_max: f64,
    pub(crate) height_max: f64,
    stations_before: usize,
}

/// A station with all that is known after it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Record {
    pub(crate) station: Station,
    pub(crate) runs: [Run; 3],
    /// defects so far, by kind
    pub(crate) raised: [u32; 3],
    /// station at which the last defect was found
    pub(crate) last_defect: Option<usize>,
    /// sum and number of the axial distances so far
    pub(crate) axial_sum: f64,
    pub(crate) axial_count: u32,
    /// first node of the neighbour window
    window: usize,
    /// bucket of wire at this polar angle and place along y
    bucket: (usize, i64),
    /// the station that was in the bucket before
    beneath: Option<usize>,
}

/// Measures of the settled wire, kept up to date node by node.
///
/// Memory is linear in the wire. A node costs time independent of the number of turns, apart from
/// a logarithm for finding what lies beneath, which grows with the number of layers.
#[derive(Clone, Debug, PartialEq)]
pub struct Coil {
    pub(crate) spec: CoilSpec,
    pub(crate) nodes: PersistentVec<Node, 256>,
    /// a turn to the chunk
    pub(crate) records: PersistentVec<Record, STATIONS_PER_TURN>,
    /// latest station by polar station and `floor(y / d)`
    buckets: BTreeMap<(usize, i64), usize>,
    traverse: f64,
}

/// Settled nodes in a saved state, each with the direction of the traverse at its time.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct SavedCoil {
    nodes: Vec<(SettledNode, f64)>,
    traverse: f64,
}

impl Coil {
    /// A coil without wire.
    pub fn new(spec: CoilSpec) -> Self {
        let traverse = if spec.traverse < 0.0 { -1.0 } else { 1.0 };
        Self {
            spec,
            nodes: PersistentVec::default(),
            records: PersistentVec::default(),
            buckets: BTreeMap::new(),
            traverse,
        }
    }

    /// The specification that [`Self::new`] was given.
    pub fn spec(&self) -> &CoilSpec {
        &self.spec
    }

    /// Replaces the defect limits and judges all settled wire again (linear in the wire).
    pub fn set_limits(&mut self, limits: DefectLimits) {
        if self.spec.limits == limits {
            return;
        }
        let nodes = std::mem::take(&mut self.nodes);
        let traverse = self.traverse;
        self.spec.limits = limits;
        self.records.truncate(0);
        self.buckets.clear();
        for node in nodes.iter() {
            self.traverse = node.sense;
            self.settle(node.settled);
        }
        self.traverse = traverse;
    }

    /// Direction in which wire settled from now on advances along y; 0 changes nothing.
    ///
    /// A change of sign starts a new pass: its wire is meant to lie on that of the pass before and
    /// has no neighbour in it.
    pub fn set_traverse(&mut self, sign: f64) {
        if sign != 0.0 {
            self.traverse = sign.signum();
        }
    }

    /// Number of nodes settled.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// True before anything has settled.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// The measured stations, clamp first; station `k` of turn `t` (both from 0) is at
    /// `t * STATIONS_PER_TURN + k`.
    pub fn stations(&self) -> impl ExactSizeIterator<Item = &Station> {
        self.records.iter().map(|record| &record.station)
    }

    /// Appends the next node of wire that has come to rest, in order from the clamp, and measures
    /// it.
    pub fn settle(&mut self, settled: SettledNode) {
        let polar = polar_angle(settled.position);
        let (from_polar, from_angle, from_reach) = self
            .nodes
            .last()
            .map_or((self.spec.start_angle, 0.0, f64::NEG_INFINITY), |n| {
                (n.polar, n.angle, n.reach)
            });
        let angle = from_angle + self.spec.direction * wrap_to_pi(polar - from_polar);
        let (mut y_min, mut y_max) = (settled.position.y, settled.position.y);
        let (mut height_max, mut pass) = (settled.height, 1);
        if let Some(last) = self.nodes.last() {
            y_min = y_min.min(last.y_min);
            y_max = y_max.max(last.y_max);
            height_max = height_max.max(last.height_max);
            pass = last.pass + u32::from(last.sense != self.traverse);
        }
        self.nodes.push(Node {
            settled,
            polar,
            angle,
            reach: from_reach.max(angle),
            sense: self.traverse,
            pass,
            y_min,
            y_max,
            height_max,
            stations_before: self.records.len(),
        });
        // Rounding may leave the clamp's own node a hair before its own angle.
        while self.records.len() as f64 * STATION_STEP <= angle + 1e-9 {
            self.add_station();
        }
    }

    /// The part of this coil that a saved state holds; everything else is computed from it.
    pub(crate) fn saved(&self) -> SavedCoil {
        SavedCoil {
            nodes: self.nodes.iter().map(|n| (n.settled, n.sense)).collect(),
            traverse: self.traverse,
        }
    }

    /// Replaces the wire by that of a saved state and measures it again.
    ///
    /// # Errors
    /// Says what is impossible about the state, such as a node farther than `far` (m) from the
    /// origin.
    pub(crate) fn restore(&mut self, saved: SavedCoil, far: f64) -> Result<(), &'static str> {
        let mut fresh = Self::new(self.spec.clone());
        for (node, sense) in saved.nodes {
            if !node.position.iter().all(|x| x.abs() < far) {
                return Err("settled wire is nowhere near the core");
            }
            fresh.traverse = sense;
            fresh.settle(node);
        }
        fresh.traverse = saved.traverse;
        *self = fresh;
        Ok(())
    }

    /// Takes back the last `count` nodes (all, when there are fewer), as if never settled.
    pub fn unsettle(&mut self, count: usize) {
        let keep = self.nodes.len().saturating_sub(count);
        let Some(first_gone) = self.nodes.get(keep) else {
            return;
        };
        let stations = self.records.len() - first_gone.stations_before;
        for record in self.records.split_off(stations).into_iter().rev() {
            match record.beneath {
                Some(beneath) => self.buckets.insert(record.bucket, beneath),
                None => self.buckets.remove(&record.bucket),
            };
        }
        self.nodes.truncate(keep);
    }

    /// A copy of this coil with `extra` wire settled too, to measure wire that is still live.
    pub fn what_if(&self, extra: &[SettledNode]) -> Coil {
        let mut coil = self.clone();
        for &node in extra {
            coil.settle(node);
        }
        coil
    }

    /// Heights over the core of a complete turn (from 1), for use as a [`Profile`] of other runs.
    pub fn height_profile(&self, turn: usize) -> Option<Profile> {
        let records = self.records.chunks().nth(turn.checked_sub(1)?)?;
        if records.len() < STATIONS_PER_TURN {
            return None;
        }
        Profile::new(records.iter().map(|record| record.station.height).collect())
    }

    /// Measures the next station, which lies on the last segment.
    fn add_station(&mut self) {
        let index = self.records.len();
        let angle = index as f64 * STATION_STEP;
        let end = self.nodes[self.nodes.len() - 1];
        let start = self
            .nodes
            .len()
            .checked_sub(2)
            .map_or(end, |node| self.nodes[node]);
        let span = end.angle - start.angle;
        let share = if span > 0.0 {
            ((angle - start.angle) / span).clamp(0.0, 1.0)
        } else {
            1.0
        };
        let between = |a: f64, b: f64| a + share * (b - a);
        let position =
            start.settled.position + (end.settled.position - start.settled.position) * share;
        let height = between(start.settled.height, end.settled.height);

        let bucket = (
            index % STATIONS_PER_TURN,
            (position.y / self.spec.diameter).floor() as i64,
        );
        let (layer, bulge) = self.layer_and_bulge(bucket, position.y, height, end.pass);
        let (neighbour, window) = self.neighbour(angle, position, end.sense, end.pass);
        let mut station = Station {
            angle,
            position,
            arc: between(start.settled.arc, end.settled.arc),
            time: between(start.settled.time, end.settled.time),
            height,
            bulge,
            bulge_excess: self
                .spec
                .profile
                .as_ref()
                .map(|profile| bulge - profile.at(angle)),
            neighbour,
            overlap_depth: 0.0,
            layer,
            pass: end.pass,
            measured: self.is_free_of_clamp(angle),
        };
        station.overlap_depth = self.overlap_depth(&station);
        let beneath = self.buckets.insert(bucket, index);
        let record = self.judge(station, window, bucket, beneath);
        self.records.push(record);
    }

    /// True where neither this wire nor the wire one turn back lies within the skip angle of the
    /// clamp.
    fn is_free_of_clamp(&self, angle: f64) -> bool {
        let within = angle - TAU * (angle / TAU + 1e-9).floor();
        within >= self.spec.limits.skip_angle || angle >= 2.0 * TAU - 1e-9
    }

    /// Geometric layer, and clear distance to what this pass should lie on.
    fn layer_and_bulge(&self, bucket: (usize, i64), y: f64, height: f64, pass: u32) -> (u32, f64) {
        let d = self.spec.diameter;
        let (mut layer, mut bulge) = (1, height);
        for bin in bucket.1 - 2..=bucket.1 + 2 {
            let mut next = self.buckets.get(&(bucket.0, bin)).copied();
            while let Some(index) = next {
                let Record {
                    station: lower,
                    beneath,
                    ..
                } = &self.records[index];
                let (dy, rise) = (y - lower.position.y, height - lower.height);
                if dy.abs() <= 0.5 * d && rise >= 0.5 * d {
                    layer = layer.max(lower.layer + 1);
                }
                if lower.pass < pass && dy.abs() < 1.5 * d {
                    bulge = bulge.min((dy * dy + rise * rise).sqrt() - d);
                }
                next = *beneath;
            }
        }
        (layer, bulge)
    }

    /// Nearest centreline point of the same pass one turn back, and where its search began.
    fn neighbour(&self, angle: f64, p: V3, sense: f64, pass: u32) -> (Option<Neighbour>, usize) {
        let target = angle - TAU;
        // The window only moves on; what is behind it need not be looked at again.
        let mut first = self.records.last().map_or(0, |record| record.window);
        if target < -1e-9 {
            return (None, first);
        }
        while first + 1 < self.nodes.len()
            && self.nodes[first + 1].reach < target - NEIGHBOUR_WINDOW
        {
            first += 1;
        }
        let mut nearest: Option<(f64, V3)> = None;
        for node in first + 1..self.nodes.len() {
            let pair = [&self.nodes[node - 1], &self.nodes[node]];
            if pair[0].reach > target + NEIGHBOUR_WINDOW {
                break;
            }
            if pair[1].pass != pass {
                continue;
            }
            let q = closest_point_segment(p, pair[0].settled.position, pair[1].settled.position);
            let distance2 = (p - q).norm_squared();
            if nearest.is_none_or(|(least, _)| distance2 < least) {
                nearest = Some((distance2, q));
            }
        }
        let neighbour = nearest.map(|(distance2, q)| Neighbour {
            gap: distance2.sqrt() - self.spec.diameter,
            axial: sense * (p.y - q.y),
        });
        (neighbour, first)
    }

    /// Diameter minus axial distance where the wire overlaps its neighbour, else 0, m.
    fn overlap_depth(&self, station: &Station) -> f64 {
        let (d, limits) = (self.spec.diameter, &self.spec.limits);
        let Some(Neighbour { axial, .. }) = station.neighbour else {
            return 0.0;
        };
        let stands_on =
            axial < limits.overlap_axial * d && station.bulge > limits.overlap_height * d;
        if stands_on || axial < 0.0 {
            d - axial
        } else {
            0.0
        }
    }

    /// The record of a station, with the runs and sums carried on from the one before.
    fn judge(
        &self,
        station: Station,
        window: usize,
        bucket: (usize, i64),
        beneath: Option<usize>,
    ) -> Record {
        let index = self.records.len();
        let mut record = Record {
            station,
            runs: [Run::default(); 3],
            raised: [0; 3],
            last_defect: None,
            axial_sum: 0.0,
            axial_count: 0,
            window,
            bucket,
            beneath,
        };
        let mut runs_before = [Run::default(); 3];
        if let Some(last) = self.records.last() {
            runs_before = last.runs;
            record.raised = last.raised;
            record.last_defect = last.last_defect;
            record.axial_sum = last.axial_sum;
            record.axial_count = last.axial_count;
        }
        for kind in DefectKind::MEASURED {
            let (value, limit, least) = self.criterion(kind, &station);
            let k = kind as usize;
            record.runs[k] = runs_before[k].next(value, limit);
            if record.runs[k].counts(least) && !runs_before[k].counts(least) {
                record.raised[k] += 1;
                record.last_defect = Some(index);
            }
        }
        if let (true, Some(neighbour)) = (station.measured, station.neighbour) {
            record.axial_sum += neighbour.axial;
            record.axial_count += 1;
        }
        record
    }

    /// Value of a defect at a station (`None`: nothing to judge), its limit, m, and the least
    /// length of a run, in stations.
    pub(crate) fn criterion(&self, kind: DefectKind, station: &Station) -> (Option<f64>, f64, u32) {
        let (d, limits) = (self.spec.diameter, &self.spec.limits);
        let (value, limit, least) = match kind {
            DefectKind::Bulge if limits.bulge_absolute > 0.0 => {
                (Some(station.bulge), limits.bulge_absolute, SHORT_RUN)
            }
            DefectKind::Bulge => (station.bulge_excess, limits.bulge_excess * d, SHORT_RUN),
            DefectKind::Gap => (
                station.neighbour.map(|n| n.gap),
                limits.gap * d,
                limits.gap_fraction,
            ),
            DefectKind::Overlap => (
                Some(station.overlap_depth),
                (1.0 - limits.overlap_axial) * d,
                SHORT_RUN,
            ),
            DefectKind::Slack | DefectKind::Break => (None, f64::INFINITY, 0.0),
        };
        (
            value.filter(|_| station.measured),
            limit,
            stations_for(least),
        )
    }
}
