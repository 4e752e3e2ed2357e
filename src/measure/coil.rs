//! The settled wire, node by node, and what is measured on it.

use super::buckets::Buckets;
use super::crossover::Crossover;
use super::defect::{BulgeLimit, DefectLimits, FALLBACK_BULGE, MEASURED};
use super::node::{Node, SettledNode};
use super::onset::Onset;
use super::passes::Passes;
use super::planned_start::LayerStart;
use super::plumb::Plumb;
use super::profile::Profile;
use super::row::{Row, RowPlace};
use super::runs::{Run, SHORT_RUN, stations_for};
use super::segment::Segment;
use super::station::{Signs, Station};
use super::{STATION_STEP, STATIONS_PER_TURN};
use crate::math::PersistentVec;
use crate::math::{polar_angle, wrap_to_pi};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Last part of a pass, in which its wire may climb to the next layer, and first part of a row, in which it may still do so, rad:
/// a quarter of a turn. Crossovers take a twelfth to a sixth of a turn, and wire lands face by face.
pub(crate) const STEP_UP: f64 = 0.25 * TAU;

/// How near a nozzle comes to a place to have come back to it, diameters: the way back from which on it has turned.
const CAME_BACK: f64 = 0.5;

/// A station is taken this far before its angle, rad: rounding may leave the clamp's own node a hair before its own angle.
const HAIR: f64 = 1e-9;

/// What the measures need to know of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct CoilSpec {
    /// wire diameter d, m
    pub diameter: f64,
    /// limits of the defect flags
    pub limits: DefectLimits,
    /// quasi-static height over the polar angle of this wire at this tension; without one the bulge is judged against
    /// `limits.bulge_absolute`, or a diameter where that is 0
    pub profile: Option<Profile>,
    /// tension that wire is meant to be laid with, N; 0: not known, and no turn is loose for its tension
    pub tension: f64,
    /// winding angles between which wire is meant to climb to the next layer, rad, one pair a layer; none: not known, and
    /// no jump is early or late
    pub jumps: Arc<[[f64; 2]]>,
    /// winding angle at which the last layer is meant to be full, rad; none: not known, and no wire climbs out of it early
    pub full: Option<f64>,
    /// winding angle at which the planned turns end, rad; none: not known
    pub planned: Option<f64>,
    /// where each planned layer begins between flanges; none where that is not known
    pub layer_starts: Arc<[LayerStart]>,
    /// crossover of each turn; none: wire is not meant to cross in steps, or it is not known where
    pub crossover: Option<Crossover>,
    /// polar angle of the clamp, rad
    pub start_angle: f64,
    /// +1 where wire runs towards growing polar angle (positive spindle speed), else -1; see
    /// [`Coil::set_direction`]
    pub direction: f64,
    /// direction of the first pass along y, see [`Coil::set_first_sense`]; 0 counts as +1
    pub traverse: f64,
    /// unstretched length at the clamp, m
    pub clamp_arc: f64,
    /// polar angle of the corner between the faces on +x and +z, rad; pi/4 for a cylinder
    pub corner_angle: f64,
}

/// A station with all that is known after it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Record {
    pub(crate) station: Station,
    pub(crate) row: Row,
    pub(crate) signs: Signs,
    pub(crate) runs: [Run; MEASURED],
    /// defects so far, by kind
    pub(crate) raised: [u32; MEASURED],
    /// station at which the last defect was found
    pub(crate) last_defect: Option<usize>,
    /// sum and number of the axial distances so far
    pub(crate) axial_sum: f64,
    pub(crate) axial_count: u32,
    /// first node of the neighbour window
    pub(crate) window: usize,
    /// bucket of wire at this polar angle and place along y
    pub(crate) bucket: (usize, i64),
    /// the station that was in the bucket before
    pub(crate) beneath: Option<usize>,
    /// for how many stations what lies below has said another layer than the station's
    pub(crate) other_layer: u32,
    /// last station up to here at which wire crosses to its next place
    pub(crate) last_crossing: Option<usize>,
    /// +1 where the flange beside it lies towards +y, -1 towards -y, 0 without one
    pub(super) flange_side: f64,
    /// it lies on the climb of its own row, which it crosses
    pub(super) on_climb: bool,
    /// its place along y from that climb's, m, where it passes over it
    pub(super) beside_climb: Option<f64>,
    /// height over the core at which it would be at rest, m; 0 where that is not known
    pub(super) at_rest: f64,
    /// a place left empty beside the flange where its layer begins: stations on end, and the room there beyond the plan, m
    pub(super) left_empty: (u32, f64),
    /// it is on its way to the next row, or is pressed up beside a flange
    pub(super) rises: bool,
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
    pub(super) buckets: Buckets,
    pub(super) passes: Passes,
    /// steps to a next row that began before they were certain, and those that were none, along the wire
    pub(super) onsets: Vec<Onset>,
}

/// Settled nodes in a saved state, and what they were laid by.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct SavedCoil {
    nodes: Vec<SettledNode>,
    passes: Passes,
    direction: f64,
}

impl Coil {
    /// A coil without wire.
    pub fn new(spec: CoilSpec) -> Self {
        let passes = Passes::new(spec.traverse, CAME_BACK * spec.diameter).planned(&spec.jumps);
        Self {
            spec,
            nodes: PersistentVec::default(),
            records: PersistentVec::default(),
            buckets: Buckets::default(),
            passes,
            onsets: Vec::new(),
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
        self.spec.limits = limits;
        self.measure_again(0);
    }

    /// Replaces the tension that wire is meant to be laid with, N, and the quasi-static height under it, and measures all
    /// settled wire again (linear in the wire).
    pub fn set_profile(&mut self, tension: f64, profile: Option<Profile>) {
        if self.spec.profile != profile || self.spec.tension != tension {
            self.spec.profile = profile;
            self.spec.tension = tension;
            self.measure_again(0);
        }
    }

    /// What bulges are judged by.
    pub fn bulge_limit(&self) -> BulgeLimit {
        let (d, limits) = (self.spec.diameter, &self.spec.limits);
        match &self.spec.profile {
            _ if limits.bulge_absolute > 0.0 => BulgeLimit::Absolute {
                limit_m: limits.bulge_absolute,
            },
            Some(profile) => BulgeLimit::OverRest {
                limit_m: limits.bulge_excess * d,
                highest_m: profile.highest(),
            },
            None => BulgeLimit::Fallback {
                limit_m: FALLBACK_BULGE * d,
            },
        }
    }

    /// Replaces the direction of winding, +1 or -1 as in [`CoilSpec::direction`], and measures all settled wire
    /// again (linear in the wire).
    pub fn set_direction(&mut self, direction: f64) {
        if self.spec.direction != direction {
            self.spec.direction = direction;
            self.measure_again(0);
        }
    }

    /// Replaces the direction of the first pass along y, +1 or -1, while there is no other pass.
    pub fn set_first_sense(&mut self, sense: f64) {
        if self.passes.count() == 1 && self.passes.last().sense != sense {
            self.passes.set_first_sense(sense);
            self.measure_again(0);
        }
    }

    /// From this winding angle (rad) on, wire was laid while the nozzle went this way along y, +1 or -1.
    ///
    /// Such wire is meant to lie on that of the passes before, and its first turn has no neighbour. The last quarter of a
    /// turn before it may climb and is not judged. Settled wire from there on is measured again.
    pub fn begin_pass(&mut self, from: f64, sense: f64) {
        self.take_pass(from, sense, None);
    }

    /// The same where the nozzle turned at `place` along y, m.
    ///
    /// A nozzle that turns back for less than one and a quarter turns, on again, and not as far as `place` has turned there
    /// for good, and swings on its way. Where the place is not known, it has hung back.
    pub fn begin_pass_at(&mut self, from: f64, sense: f64, place: f64) {
        self.take_pass(from, sense, Some(place));
    }

    fn take_pass(&mut self, from: f64, sense: f64, turned_at: Option<f64>) {
        self.passes.push(from, sense, turned_at);
        self.measure_again(self.first_node_from(self.passes.open_from() - STEP_UP));
    }

    /// Takes the last pass back, unless it is the first: its wire belongs to the pass before.
    pub fn take_back_pass(&mut self) {
        let from = self.passes.open_from();
        if self.passes.pop().is_some() {
            self.measure_again(self.first_node_from(from - STEP_UP));
        }
    }

    /// How many passes there are.
    pub fn passes(&self) -> usize {
        self.passes.count()
    }

    /// First node by which wire has reached a winding angle, rad; a hair before it, as a station may be taken there.
    fn first_node_from(&self, angle: f64) -> usize {
        let beyond = self.nodes.iter().rev();
        let count = beyond
            .take_while(|node| node.reach >= angle - 2.0 * HAIR)
            .count();
        self.nodes.len() - count
    }

    /// Takes the nodes from this one on back and settles them again.
    fn measure_again(&mut self, first: usize) {
        for node in self.take_from(first) {
            self.settle(node);
        }
    }

    /// Replaces the tensions of the settled wire from the node `first` on, N, and measures it again.
    pub fn set_tensions(&mut self, first: usize, tensions: &[f64]) {
        let nodes = self.take_from(first).into_iter().zip(tensions);
        for (node, &tension) in nodes {
            self.settle(SettledNode { tension, ..node });
        }
    }

    /// Takes the nodes from this one on back.
    pub(super) fn take_from(&mut self, first: usize) -> Vec<SettledNode> {
        let nodes: Vec<SettledNode> = (first..self.nodes.len())
            .map(|node| self.nodes[node].settled)
            .collect();
        self.unsettle(nodes.len());
        nodes
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
        let mut height_max = settled.height;
        let (mut second_moment, mut added_by_stretch) = (0.0, 0.0);
        if let Some(last) = self.nodes.last() {
            y_min = y_min.min(last.y_min);
            y_max = y_max.max(last.y_max);
            height_max = height_max.max(last.height_max);
            let [square, before] = [settled, last.settled].map(|n| n.position.xz().norm_squared());
            second_moment =
                last.second_moment + 0.5 * (settled.arc - last.settled.arc) * (square + before);
            added_by_stretch = last.added_by_stretch_to(settled.arc);
        }
        self.nodes.push(Node {
            settled,
            polar,
            angle,
            reach: from_reach.max(angle),
            y_min,
            y_max,
            height_max,
            second_moment,
            added_by_stretch,
            stations_before: self.records.len(),
        });
        while self.records.len() as f64 * STATION_STEP <= angle + HAIR {
            self.add_station();
            if self.date_step_back() || self.take_step_back() {
                return;
            }
        }
    }

    /// Length of unstretched wire, m, that would add as much to the resistance as plastic stretch does between the clamp and
    /// the place `arc`, m of unstretched wire from there. See [`added_by_stretch`](super::added_by_stretch). Wire behind the last node counts as
    /// stretched like the wire before it.
    pub fn added_by_stretch(&self, arc: f64) -> f64 {
        let node = self.node_before(arc);
        node.map_or(0.0, |node| node.added_by_stretch_to(arc))
    }

    /// The last node that is not beyond the place `arc`, m of unstretched wire from the clamp.
    pub(super) fn node_before(&self, arc: f64) -> Option<&Node> {
        let (mut before, mut after) = (0, self.nodes.len());
        while before < after {
            let middle = usize::midpoint(before, after);
            match self.nodes[middle].settled.arc <= arc {
                true => before = middle + 1,
                false => after = middle,
            }
        }
        before.checked_sub(1).map(|node| &self.nodes[node])
    }

    /// See [`Passes::planned`].
    pub(crate) fn has_planned_passes(&self) -> bool {
        self.passes.has_plan()
    }

    /// See [`Passes::last_swing`].
    pub(crate) fn last_swing(&self, angle: f64) -> Option<u32> {
        self.passes.last_swing(angle)
    }

    /// The part of this coil that a saved state holds; everything else is computed from it.
    pub(crate) fn saved(&self) -> SavedCoil {
        SavedCoil {
            nodes: self.nodes.iter().map(|n| n.settled).collect(),
            passes: self.passes.clone(),
            direction: self.spec.direction,
        }
    }

    /// Replaces the wire by that of a saved state and measures it again.
    ///
    /// # Errors
    /// Says what is impossible about the state, such as a node farther than `far` (m) from the
    /// origin.
    pub(crate) fn restore(&mut self, saved: SavedCoil, far: f64) -> Result<(), &'static str> {
        let mut fresh = Self::new(self.spec.clone());
        if saved.direction.abs() != 1.0 || !saved.passes.is_sound() {
            return Err("wire was laid in no direction");
        }
        fresh.spec.direction = saved.direction;
        fresh.passes.take(saved.passes);
        for node in saved.nodes {
            if !node.position.iter().all(|x| x.abs() < far) {
                return Err("settled wire is nowhere near the core");
            }
            fresh.settle(node);
        }
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
                Some(beneath) => {
                    self.buckets.insert(record.bucket, beneath);
                }
                None => self.buckets.remove(record.bucket),
            }
        }
        self.nodes.truncate(keep);
        if let Some(first) = self.forget_steps() {
            self.measure_again(first);
        }
    }

    /// A copy of this coil with `extra` wire settled too, to measure wire that is still live.
    pub fn what_if(&self, extra: &[SettledNode]) -> Coil {
        let mut coil = self.clone();
        for &node in extra {
            coil.settle(node);
        }
        coil
    }

    /// Measures the next station, which lies on the last segment.
    fn add_station(&mut self) {
        let index = self.records.len();
        let angle = index as f64 * STATION_STEP;
        let end = self.nodes[self.nodes.len() - 1];
        let start = self.nodes.len().checked_sub(2);
        let segment = Segment::new(start.map_or(end, |node| self.nodes[node]), end);
        let wire = segment.at(angle);
        let (position, height) = (wire.position, wire.height);

        let bucket = (
            index % STATIONS_PER_TURN,
            (position.y / self.spec.diameter).floor() as i64,
        );
        let (number, pass) = self.passes.at(angle);
        let last_crossing = self.last_crossing(position.y);
        let in_crossover = self.is_in_crossover(last_crossing);
        let flange = segment.flange_face().map(|face| face - position.y);
        let at = RowPlace {
            angle,
            bucket,
            y: position.y,
            height,
            flange: wire.flange,
            plumb: Plumb::at(position, segment.way(), segment.rise(), self.spec.direction),
            crosses: in_crossover,
        };
        let (row, support, rises) = self.row_and_support(pass, &at);
        let at_rest = self.level_at_rest((angle, position.y), &support, wire.tension);
        let bulge = height - support.held;
        let (layer, other_layer) = self.layer_after(support.layer, row);
        let (neighbour, window) = self.neighbour(angle, position, row);
        // Beside a double turn, in the place after it, lies the turn below that one.
        let after_double = || {
            let before = index.checked_sub(STATIONS_PER_TURN);
            before.is_some_and(|before| self.is_double(before))
        };
        let neighbour = neighbour.filter(|_| !after_double());
        let crosses = in_crossover && !self.is_hole(neighbour);
        let is_up = self.has_ridden_up((height, neighbour), at_rest, &support);
        // The nozzle turns here or the flange is near, and the wire leaves its row.
        let lifts = !self.is_pressed_up_next()
            && (row.is_over_in(pass) || at.has_no_room_in(row, self.spec.diameter))
            && self.may_climb(layer, angle)
            && is_up;
        let steps_up = lifts || self.passes.ends_within(angle, STEP_UP);
        let mut station = Station {
            angle,
            position,
            arc: wire.arc,
            time: wire.time,
            height,
            bulge,
            bulge_excess: at_rest.map(|at_rest| height - support.held.max(at_rest)),
            neighbour,
            overlap_depth: 0.0,
            flange_gap: flange.map(|way| way.abs() - 0.5 * self.spec.diameter),
            layer,
            pass: number,
            crosses,
            out_of_groove: support.stands_on_wire && self.has_grooves_below(number) && !crosses,
            measured: self.is_free_of_clamp(angle) && !steps_up && !self.has_no_place(angle, pass),
        };
        station.overlap_depth = self.overlap_depth(&station, is_up);
        let support = match lifts {
            true => support.without_own_row(),
            false => support,
        };
        let (strain, tension) = (wire.plastic_strain, wire.tension);
        let left_empty = self.left_empty(&station, row);
        let signs = self.signs(&station, row, &support, bucket, strain, tension);
        let beneath = self.buckets.insert(bucket, index);
        self.records.push(self.judge(Record {
            station,
            row,
            signs,
            runs: [Run::default(); MEASURED],
            raised: [0; MEASURED],
            last_defect: None,
            axial_sum: 0.0,
            axial_count: 0,
            window,
            bucket,
            beneath,
            other_layer,
            last_crossing,
            flange_side: flange.map_or(0.0, f64::signum),
            on_climb: support.on_climb,
            beside_climb: support.beside_climb,
            at_rest: at_rest.unwrap_or(0.0),
            left_empty,
            rises: rises && self.may_climb(layer, angle),
        }));
    }

    /// True where neither this wire nor the wire one turn back lies within the skip angle of the
    /// clamp.
    pub(crate) fn is_free_of_clamp(&self, angle: f64) -> bool {
        let within = angle - TAU * (angle / TAU + 1e-9).floor();
        let skip = self.spec.limits.skip_angle;
        within >= skip || angle >= TAU + skip.max(TAU) - 1e-9
    }

    /// Layer of the next station where wire lies `below` it as it does, and for how many stations that has said otherwise.
    /// A layer changes once it has for as many as a defect needs, or at once where a step begins that is certain, or a planned row. Layers
    /// of a turn begin over each other, and would do so later and later.
    fn layer_after(&self, below: u32, row: Row) -> (u32, u32) {
        let at_once = self.has_planned_passes() || self.steps_up_next();
        match self.records.last() {
            Some(last) if at_once && row.number > last.row.number => (below, 0),
            Some(last) if last.station.layer != below => match last.other_layer + 1 {
                count if count < stations_for(SHORT_RUN) => (last.station.layer, count),
                _ => (below, 0),
            },
            _ => (below, 0),
        }
    }
}
