//! What is told of settled wire: turns at rest, and each defect once.

use super::Winding;
use crate::measure::{CountedRun, DefectKind, STATION_STEP, STATIONS_PER_TURN, SettledNode};
use crate::signals::EventKind;

/// Stations within which defects that are found at once are told in one line. Chosen: about what a node settles.
const TOGETHER: usize = 10;

impl Winding {
    /// Measures wire that has come to rest, and tells of turns and defects that came to those there were.
    pub(super) fn settle_and_tell(&mut self, settled: SettledNode) {
        let (turns, defects) = (self.coil.turns_settled(), self.coil.raised());
        let from = self.coil.stations().len();
        self.coil_mut().settle(settled);
        let now = self.coil.turns_settled();
        if now.floor() > turns.floor() {
            self.report(
                EventKind::Turn,
                format!("turn {} has come to rest", now.floor()),
            );
        }
        let raised = self.coil.raised();
        if (raised.iter().zip(defects)).any(|(now, before)| *now > before) {
            self.keep_last_defect();
            self.tell_of_defects(from);
        }
    }

    /// Tells of the defects that reach the station `from` or beyond and have not been told yet.
    ///
    /// Where the nozzle turned is known only once it has gone back. Wire of before is measured again then, and what is found so is
    /// told late. Wire that came loose and settles again with the same defect is no news.
    pub(super) fn tell_of_defects(&mut self, from: usize) {
        let is_told = |run: &CountedRun| {
            let mut told = self.run.told_defects.iter();
            told.any(|(kind, at)| *kind == run.kind && (run.first..=run.last).contains(at))
        };
        let kinds = DefectKind::MEASURED.into_iter();
        let runs = kinds.flat_map(|kind| self.coil.counted_runs(kind, from));
        let mut new: Vec<CountedRun> = runs.filter(|run| !is_told(run)).collect();
        new.sort_by_key(|run| run.counts_at);
        let told = new.iter().map(|run| (run.kind, run.counts_at));
        self.run.told_defects.extend(told);
        for together in new.chunk_by_mut(|a, b| b.counts_at - a.counts_at < TOGETHER) {
            let at = together.last().map_or(0, |run| run.counts_at);
            together.sort_by_key(|run| run.kind as usize);
            let names: Vec<&str> = together.iter().map(|run| run.kind.words()).collect();
            let angle = (at % STATIONS_PER_TURN) as f64 * STATION_STEP;
            self.report(
                EventKind::Defect,
                format!(
                    "defect in turn {} at {:.0} deg ({})",
                    at / STATIONS_PER_TURN + 1,
                    angle.to_degrees(),
                    names.join(", ")
                ),
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Simulation;
    use super::*;
    use crate::math::V3;
    use crate::settings::SceneSettings;
    use std::f64::consts::TAU;

    /// Six turns on a circle round the core, one beside the other but for a step back of 0.6 diameters after three turns.
    fn turns_with_a_step_back(start: f64, d: f64) -> Vec<SettledNode> {
        let node = |k: u32| {
            let turn = f64::from(k) / 72.0;
            let polar = start + TAU * turn;
            let back = 0.6 * (12.0 * (turn - 3.0)).clamp(0.0, 1.0);
            SettledNode {
                position: V3::new(
                    10e-3 * libm::cos(polar),
                    d * (turn - back),
                    10e-3 * libm::sin(polar),
                ),
                arc: TAU * 10e-3 * turn,
                height: 0.0,
                plastic_strain: 0.0,
                tension: 15.0,
                time: turn,
                flange: None,
            }
        };
        (0..6 * 72).map(node).collect()
    }

    fn defects_told(winding: &mut Winding) -> Vec<String> {
        let events = std::mem::take(&mut winding.run.events).into_iter();
        let defects = events.filter(|event| event.kind == EventKind::Defect);
        defects.map(|event| event.text).collect()
    }

    /// Nobody was told of what was found when wire was measured again, as the nozzle had turned: it stood among the defects at the end.
    #[test]
    fn a_defect_that_is_found_late_is_told_once() {
        let scene = SceneSettings::default().build().expect("a scene");
        let d = scene.wire.diameter;
        let simulation = Simulation::new(&scene).expect("a start");
        let mut winding = simulation.winding().clone();
        winding.run.events.clear();
        let start = winding.coil.spec().start_angle;
        for node in turns_with_a_step_back(start, d) {
            winding.settle_and_tell(node);
        }
        assert!(defects_told(&mut winding).is_empty());
        assert!(winding.coil.defects().is_empty());
        // wire that goes on as before lies on the wrong side of its neighbour once the nozzle is known to have turned
        winding.coil_mut().begin_pass_at(3.0 * TAU, -1.0, 3.0 * d);
        winding.tell_of_defects(0);
        let told = defects_told(&mut winding);
        let found = winding.coil.defects();
        assert!(!found.is_empty());
        let names: usize = told.iter().map(|text| text.split(", ").count()).sum();
        assert_eq!(names, found.len(), "{told:?}");
        assert!(told[0].contains("overlap"), "{told:?}");

        // a loose end comes to rest where it lay
        winding.coil_mut().unsettle(200);
        for node in turns_with_a_step_back(start, d).split_off(6 * 72 - 200) {
            winding.settle_and_tell(node);
        }
        assert_eq!(winding.coil.defects().len(), found.len());
        assert_eq!(defects_told(&mut winding), [""; 0]);
    }
}
