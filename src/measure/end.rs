//! The end of a coil: where each turn crosses before the angle of the clamp, the last one has no place of its own from there on.

use super::STATIONS_PER_TURN;
use super::coil::Coil;
use super::defect::DefectKind;
use super::passes::Pass;
use super::runs::{SHORT_RUN, stations_for};
use super::support::{BELOW, NEXT_LAYER, PLACE};
use std::f64::consts::TAU;

/// Last part of the planned turns in which wire without a place is the end of the coil, rad. Chosen: half a turn, as for a double turn.
const END: f64 = 0.5 * TAU;

impl Coil {
    /// Whether the next station, of this pass, lies at the end of the coil, where the turn before it has crossed into its place beside a
    /// flange. In a window of one turn each lies on the one before by plan.
    pub(super) fn has_no_place(&self, angle: f64, pass: Pass) -> bool {
        let is_end = |end: f64| (end - END..=end).contains(&angle);
        let before = self.records.len().checked_sub(STATIONS_PER_TURN);
        self.spec.planned.is_some_and(is_end)
            && !self.has_planned_passes()
            && before.is_some_and(|before| self.leaves_no_place(before, pass))
    }

    /// Whether a turn leaves none to the next one of a pass, between it and the flange that the pass goes to.
    fn leaves_no_place(&self, station: usize, pass: Pass) -> bool {
        let record = &self.records[station];
        let room = record.station.flange_gap;
        record.flange_side == pass.sense
            && room.is_some_and(|room| room < PLACE * self.spec.diameter)
    }

    /// Station from which on wire lies on the turn before, which has left it no place, into the last half of the last planned turn or as
    /// far as wire is at rest. None where it has a place there.
    pub fn without_place_from(&self) -> Option<usize> {
        if self.has_planned_passes() {
            return None;
        }
        let end = (self.spec.planned? / TAU).round() as usize * STATIONS_PER_TURN;
        let from = end.checked_sub(STATIONS_PER_TURN)?;
        let stands = |index: &usize| {
            index.checked_sub(STATIONS_PER_TURN).is_some_and(|before| {
                let [last, under] = [*index, before].map(|at| &self.records[at].station);
                let (_, pass) = self.passes.at(last.angle);
                let d = self.spec.diameter;
                self.leaves_no_place(before, pass)
                    && last.height - under.height >= NEXT_LAYER * d
                    && (last.position.y - under.position.y).abs() <= BELOW * d
            })
        };
        let least = stations_for(SHORT_RUN) as usize;
        let there = end.min(self.records.len());
        let excused = end - stations_for(END / TAU) as usize;
        let mut first = from;
        while let Some(begun) = (first..there).find(stands) {
            first = (begun..there).find(|index| !stands(index)).unwrap_or(there);
            // (what comes down to a place of its own sooner is judged)
            if first - begun >= least && (first == there || first > excused) {
                // it may have begun in the turn before
                return Some(begun - (0..begun).rev().take_while(stands).count());
            }
        }
        None
    }

    /// Whether wire has ridden up on its own row for long enough to count before a station: a coil that ends there is none the better for it.
    pub fn rides_up_before(&self, station: usize) -> bool {
        [DefectKind::Overlap, DefectKind::DoubleTurn]
            .into_iter()
            .flat_map(|kind| self.counted_runs(kind, 0))
            .any(|run| run.counts_at < station)
    }
}
