//! Numbers that describe the settled coil as a whole, as the machine sees them.

use super::coil::{Coil, Record, STEP_UP};
use super::defect::{Defect, DefectFlags, DefectKind, DefectPlace, MEASURED};
use super::marks::CountedRun;
use super::runs::{Run, stations_for};
use super::station::Station;
use super::{STATION_STEP, STATIONS_PER_TURN, Verdict};
use serde::Serialize;
use std::f64::consts::{PI, TAU};

/// Share below the largest value of an overlap or double turn within which a station is as bad: sizes are told to a hundredth of a
/// diameter. Wire that lies on the turn before overlaps it by a diameter over half a turn, and which station of these has the most is rounding.
const LEVEL: f64 = 1e-2;

/// Largest values over the last 2 pi of settled wire, m; 0 before there is any.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Worst {
    /// absolute height over the core or the layer below
    pub bulge_height: f64,
    /// clear distance to the neighbour one turn back, without crossovers
    pub gap_width: f64,
    /// diameter minus axial distance where wire overlaps
    pub overlap_depth: f64,
}

impl Coil {
    /// Defects present in the settled wire.
    pub fn flags(&self) -> DefectFlags {
        let [
            bulge,
            gap,
            overlap,
            double_turn,
            skipped_groove,
            early_jump,
            late_jump,
            loose_turn,
            overstretch,
        ] = self.raised().map(|count| count > 0);
        DefectFlags {
            bulge,
            gap,
            overlap,
            double_turn,
            skipped_groove,
            early_jump,
            late_jump,
            loose_turn,
            overstretch,
        }
    }

    /// The gap of a turn that lasts for as long as a gap has to that counts, m: the largest limit at which it would be one. None where
    /// nothing is that long.
    pub fn lasting_gap(&self, turn: usize) -> Option<f64> {
        let first = (turn - 1) * STATIONS_PER_TURN;
        let stations = self.stations().skip(first).take(STATIONS_PER_TURN);
        let gaps: Vec<Option<f64>> = stations
            .map(|s| s.neighbour.filter(|_| s.measured && !s.crosses))
            .map(|neighbour| neighbour.map(|n| n.gap))
            .collect();
        let least = stations_for(self.spec.limits.gap_fraction);
        let counts = |limit: f64| {
            let mut run = Run::default();
            gaps.iter().any(|&gap| {
                run = run.next(gap, limit);
                run.counts(least)
            })
        };
        let mut limits: Vec<f64> = gaps.iter().flatten().copied().collect();
        limits.sort_by(f64::total_cmp);
        let within = limits.partition_point(|&limit| counts(limit));
        limits.get(within.checked_sub(1)?).copied()
    }

    /// Number of defects in the settled wire, of all kinds.
    pub fn defect_count(&self) -> u32 {
        self.raised().iter().sum()
    }

    /// Where the latest defect was found; `None` before the first.
    pub fn last_defect(&self) -> Option<DefectPlace> {
        let index = self.records.last()?.last_defect?;
        let raised = self.records[index].raised;
        let before = index
            .checked_sub(1)
            .map_or([0; MEASURED], |k| self.records[k].raised);
        let mut kinds = DefectKind::MEASURED.into_iter();
        let kind = kinds.find(|kind| raised[*kind as usize] > before[*kind as usize])?;
        Some(DefectPlace {
            kind,
            size: self.size_at(kind, index).unwrap_or(0.0),
            turn: (index / STATIONS_PER_TURN) as u32 + 1,
            angle: (index % STATIONS_PER_TURN) as f64 * STATION_STEP,
            time: self.records[index].station.time,
        })
    }

    /// Defects of the settled wire, along the wire: one for each run of stations long enough to count, at
    /// the station of the run where it is largest, or the middle of those where it is (linear in the wire).
    pub fn defects(&self) -> Vec<Defect> {
        let mut found: Vec<Defect> = DefectKind::MEASURED
            .into_iter()
            .flat_map(|kind| self.defects_of(kind))
            .collect();
        found
            .sort_by_key(|defect| defect.turn * STATIONS_PER_TURN as u32 + defect.angle_deg as u32);
        found
    }

    fn defects_of(&self, kind: DefectKind) -> Vec<Defect> {
        let worst = |run: CountedRun| -> Option<(usize, usize)> {
            let value = |index: usize| self.criterion(kind, &self.records[index]).0;
            let most = (run.first..=run.last)
                .filter_map(value)
                .max_by(f64::total_cmp)?;
            let level = match kind {
                DefectKind::Overlap | DefectKind::DoubleTurn => LEVEL,
                _ => 0.0,
            };
            let is_high = |index: &usize| value(*index).is_some_and(|v| v >= (1.0 - level) * most);
            let high: Vec<usize> = (run.first..=run.last).filter(is_high).collect();
            let middle = (high.first()? + high.last()?) / 2;
            let at = high.into_iter().min_by_key(|at| at.abs_diff(middle))?;
            Some((at, run.counts_at))
        };
        let runs = self.counted_runs(kind, 0).into_iter();
        let worst = runs.filter_map(worst);
        let at = |(index, found)| self.defect_at(kind, index, found);
        worst.map(at).collect()
    }

    /// The defect of a run that is worst at `index` and counts from the station `found` on.
    fn defect_at(&self, kind: DefectKind, index: usize, found: usize) -> Defect {
        let place = self.place_of(kind, index);
        let station = &self.records[place].station;
        let size = self.size_at(kind, index);
        Defect {
            kind,
            turn: (place / STATIONS_PER_TURN) as u32 + 1,
            layer: station.layer,
            angle_deg: (place % STATIONS_PER_TURN) as f64,
            found_turn: (found / STATIONS_PER_TURN) as u32 + 1,
            found_angle_deg: (found % STATIONS_PER_TURN) as f64,
            time_s: station.time,
            until_s: None,
            size_m: size,
            size_d: size.map(|size| size / self.spec.diameter),
            place_m: station.position.into(),
        }
    }

    /// Where the defect lies that shows at `index`: a jump where it was or should have been, a loose turn where it stands
    /// off most, or, for its tension alone, in its middle.
    fn place_of(&self, kind: DefectKind, index: usize) -> usize {
        let signs = &self.records[index].signs;
        let back = match kind {
            DefectKind::EarlyJump => {
                let angle = self.records[index].station.angle;
                angle - signs.above_since.unwrap_or(angle)
            }
            DefectKind::LateJump => TAU * signs.late.unwrap_or(0.0),
            DefectKind::LooseTurn => match self.loosest(index) {
                Some((place, _)) => return place,
                None => PI,
            },
            _ => 0.0,
        };
        index.saturating_sub((back / STATION_STEP).round() as usize)
    }

    /// How large a defect is that shows at `index`, m.
    fn size_at(&self, kind: DefectKind, index: usize) -> Option<f64> {
        let record = &self.records[index];
        let Record { station, signs, .. } = record;
        match kind {
            DefectKind::Gap => self.gap_at(record),
            DefectKind::Overlap => Some(station.overlap_depth),
            DefectKind::DoubleTurn => signs.rise,
            DefectKind::SkippedGroove => signs.empty_groove,
            DefectKind::EarlyJump => signs.early.map(|turns| turns * self.spec.diameter),
            DefectKind::LateJump => signs.late.map(|turns| turns * self.spec.diameter),
            // for its tension alone a turn has no size
            DefectKind::LooseTurn => self.loosest(index).map(|(_, bulge)| bulge),
            DefectKind::Overstretch => {
                // the turn up to here, or the first one
                let first = index.saturating_sub(STATIONS_PER_TURN);
                let last = (first + STATIONS_PER_TURN).min(self.records.len() - 1);
                let [from, to] = [first, last].map(|index| self.records[index].station.arc);
                Some(signs.strain * (to - from))
            }
            _ => Some(station.bulge),
        }
    }

    /// Where the turn up to `index` stands off most, and how far, m; none where it is loose for its tension alone, if at all.
    fn loosest(&self, index: usize) -> Option<(usize, f64)> {
        let turn = index.saturating_sub(STATIONS_PER_TURN)..=index;
        let start = &self.records[*turn.start()].signs;
        let by_place = self.looseness_by_place(start, &self.records[index].signs) >= 1.0;
        let stations = turn.map(|k| (k, &self.records[k].station));
        let bulges = stations
            .filter(|(_, s)| s.measured)
            .map(|(k, s)| (k, s.bulge));
        let most = bulges.reduce(|most, one| if one.1 > most.1 { one } else { most });
        most.filter(|_| by_place)
    }

    /// Largest values of the last settled turn, without the neighbourhood of the clamp.
    pub fn worst(&self) -> Worst {
        self.last_turn()
            .map(|record| &record.station)
            .filter(|s| s.measured)
            .fold(Worst::default(), |worst, station: &Station| Worst {
                bulge_height: worst.bulge_height.max(station.bulge),
                gap_width: station
                    .neighbour
                    .filter(|_| !station.crosses)
                    .map_or(worst.gap_width, |n| worst.gap_width.max(n.gap)),
                overlap_depth: worst.overlap_depth.max(station.overlap_depth),
            })
    }

    /// Angle along the wire from the clamp and polar angle of the last settled node, rad.
    pub fn end_angle(&self) -> Option<(f64, f64)> {
        self.nodes.last().map(|n| (n.angle, n.polar))
    }

    /// Turns settled, counted on the wire from the clamp.
    pub fn turns_settled(&self) -> f64 {
        self.nodes
            .last()
            .map_or(0.0, |node| node.angle.max(0.0) / TAU)
    }

    /// Layer of the last settled wire, from 1.
    pub fn layer(&self) -> u32 {
        self.records.last().map_or(1, |record| record.station.layer)
    }

    /// Layer of wire that need not have settled, at this winding angle, rad: that of the last settled wire, and one more for each
    /// layer that the nozzle has begun since.
    pub(crate) fn layer_at(&self, angle: f64) -> u32 {
        let settled = self.end_angle().map_or(0.0, |(angle, _)| angle);
        let mut begun = self.passes.layers_begun(settled, angle);
        let Some(first) = begun.next() else {
            return self.layer();
        };
        // Settled wire may have climbed already to the layer that begins next.
        let before_it = self.settled_layer_at(settled.min(first - STEP_UP));
        before_it.unwrap_or_else(|| self.layer()) + 1 + begun.count() as u32
    }

    /// Layer of the settled wire at this winding angle, rad; none where the wire has not settled.
    pub(crate) fn settled_layer_at(&self, angle: f64) -> Option<u32> {
        let record = self.records.get((angle / STATION_STEP).round() as usize);
        record.map(|record| record.station.layer)
    }

    /// Extent of the settled wire along y with its thickness, m.
    pub fn coil_width(&self) -> f64 {
        self.nodes
            .last()
            .map_or(0.0, |node| node.y_max - node.y_min + self.spec.diameter)
    }

    /// Mean axial distance of neighbouring turns, m; 0 before the second turn.
    pub fn mean_pitch(&self) -> f64 {
        match self.records.last() {
            Some(last) if last.axial_count > 0 => last.axial_sum / f64::from(last.axial_count),
            _ => 0.0,
        }
    }

    /// Share of wire in the rectangle that the coil's section occupies.
    ///
    /// Section area of the wire times `turns_settled` (the mean number of wires in a section round
    /// the core), over `coil_width` times the largest height of the wire's outer side over the
    /// core. Bulging wire thus lowers it, as it does in a slot.
    pub fn fill_factor(&self) -> f64 {
        let d = self.spec.diameter;
        self.nodes.last().map_or(0.0, |node| {
            let rectangle = self.coil_width() * (node.height_max.max(0.0) + d);
            self.turns_settled() * PI / 4.0 * d * d / rectangle
        })
    }

    /// Square of the distance from the axis over the length of the settled wire, m3.
    pub fn second_moment(&self) -> f64 {
        self.nodes.last().map_or(0.0, |node| node.second_moment)
    }

    /// Largest plastic stretch of the last settled turn.
    pub fn wire_strain(&self) -> f64 {
        let end = self.nodes.last().map_or(0.0, |node| node.angle);
        self.nodes
            .iter()
            .rev()
            .take_while(|node| node.angle > end - TAU)
            .fold(0.0, |most, node| node.settled.plastic_strain.max(most))
    }

    /// Winding angle of the settled wire at the place `arc`, m of unstretched wire from the clamp, rad; `None` where wire lies too
    /// near the clamp to be judged.
    pub(crate) fn judged_angle(&self, arc: f64) -> Option<f64> {
        let angle = self.node_before(arc)?.angle;
        self.is_free_of_clamp(angle).then_some(angle)
    }

    /// Largest plastic stretch of the settled wire, and the station where it first is; `None` before there is wire.
    pub(crate) fn largest_stretch(&self) -> Option<(f64, usize)> {
        let strains = self.records.iter().map(|record| record.signs.strain);
        let strains = strains.enumerate().map(|(index, strain)| (strain, index));
        strains.reduce(|most, next| if next.0 > most.0 { next } else { most })
    }

    /// The worst verdict of the turns of which half has settled, and of every defect; [`Verdict::Unsettled`] before that.
    pub fn verdict(&self) -> Verdict {
        let turns = self.turns();
        let judged = turns.iter().filter(|turn| turn.settled >= 0.5);
        let defects = self.defects();
        judged
            .map(|turn| turn.verdict)
            .chain(defects.iter().map(|defect| defect.kind.into()))
            .max()
            .unwrap_or(Verdict::Unsettled)
    }

    /// How many defects of each kind there are in the settled wire.
    pub(crate) fn raised(&self) -> [u32; MEASURED] {
        self.records
            .last()
            .map_or([0; MEASURED], |record| record.raised)
    }

    fn last_turn(&self) -> impl Iterator<Item = &Record> {
        let first = self.records.len().saturating_sub(STATIONS_PER_TURN);
        (first..self.records.len()).map(|k| &self.records[k])
    }
}
