//! What is told of settled wire: turns at rest, and each defect once.

use crate::measure::{Coil, CountedRun, DefectKind, OnTurn, STATIONS_PER_TURN, SettledNode};
use crate::signals::EventKind;
use crate::simulation::Winding;

/// Stations within which defects that are found at once are told in one line. Chosen: about what a node settles.
const TOGETHER: usize = 10;

/// Why wire that comes to rest may lack the defect that was told of it. It slid and came to rest elsewhere, or it was unwound and is
/// wound again. Or it was measured again without what comes to rest after it.
const MEASURED_ANEW: &str = "its wire had come loose or been unwound, or the nozzle had turned back, and was measured again";

/// The same where wire beside a flange has left its row for certain.
const STEPPED: &str = "its wire was on its way to the next layer";

impl Winding {
    /// Measures wire that has come to rest, and tells of turns and defects that came to those there were.
    pub(in crate::simulation) fn settle_and_tell(&mut self, settled: SettledNode) {
        let defects = self.coil.raised();
        let (from, step) = (self.coil.stations().len(), self.coil.last_step());
        self.coil_mut().settle(settled);
        let now = self.coil.turns_settled() as u32;
        if now > self.run.told_turns {
            self.run.told_turns = now;
            self.report(EventKind::Turn, format!("turn {now} has come to rest"));
        }
        // a step to the next row that has become certain changes what was measured since it began
        let changed = self
            .coil
            .last_step()
            .filter(|_| self.coil.last_step() != step);
        let from = changed.map_or(from, |step| from.min(step));
        let raised = self.coil.raised();
        if changed.is_some() || (raised.iter().zip(defects)).any(|(now, before)| *now > before) {
            self.count_defects();
            self.tell_of_defects(from);
        }
        self.tell_of_withdrawn(
            changed.map_or(MEASURED_ANEW, |_| STEPPED),
            Coil::has_come_to_nothing,
        );
    }

    /// Takes the last `count` nodes back that have come to rest. A turn is told again once all of it was taken back: a part of it may come
    /// loose and settle again with nobody unwinding it. So is a defect once a turn before it is gone.
    pub(in crate::simulation) fn take_back(&mut self, count: usize) {
        self.coil_mut().unsettle(count);
        let left = self.coil.turns_settled().ceil() as u32;
        self.run.told_turns = self.run.told_turns.min(left);
        self.tell_of_withdrawn("its wire has been unwound", |coil, _, at| {
            let left = coil.stations().len();
            left == 0 || at >= left + STATIONS_PER_TURN
        });
    }

    /// Settled wire has been measured again, since `because`: tells of defects that are new, and of those told before that are none
    /// any more.
    pub(super) fn tell_of_changes(&mut self, because: &str) {
        self.tell_of_defects(0);
        self.tell_of_withdrawn(because, Coil::has_come_to_nothing);
    }

    /// The limits of defects have changed: tells of defects that are new by them, and of those told before that do not count by now.
    pub(in crate::simulation) fn tell_of_limits(&mut self) {
        self.tell_of_defects(0);
        self.tell_of_withdrawn("the limits of defects have changed", Coil::counts_no_more);
    }

    /// Tells of each defect that was told and is `gone` from the wire there, which is at rest: `because` says what has
    /// come to pass. Wire that has just come loose is not there to be asked.
    fn tell_of_withdrawn(&mut self, because: &str, gone: fn(&Coil, DefectKind, usize) -> bool) {
        let coil = &self.coil;
        let gone = |(kind, at): &mut (DefectKind, usize)| gone(coil, *kind, *at);
        let withdrawn: Vec<_> = self.run.told_defects.extract_if(.., gone).collect();
        for (kind, at) in withdrawn {
            let (place, name) = (place(at), kind.words());
            self.report(
                EventKind::Defect,
                format!("no longer a defect {place} ({name}): {because}"),
            );
        }
    }

    /// Tells of the defects that reach the station `from` or beyond and have not been told yet.
    ///
    /// Where the nozzle turned is known only once it has gone back. Wire of before is measured again then, and what is found so is
    /// told late. Wire that came loose and settles again with the same defect is no news.
    fn tell_of_defects(&mut self, from: usize) {
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
            together.sort_by_key(|run| (run.counts_at, run.kind as usize));
            let there = |runs: &[CountedRun]| {
                let names: Vec<&str> = runs.iter().map(|run| run.kind.words()).collect();
                format!("{} ({})", place(runs[0].counts_at), names.join(", "))
            };
            let places = together.chunk_by(|a, b| a.counts_at == b.counts_at);
            let places: Vec<String> = places.map(there).collect();
            let text = format!("defect found {}", places.join(" and "));
            self.report(EventKind::Defect, text);
        }
    }
}

/// Where a station lies, in words.
fn place(station: usize) -> String {
    format!("in {}", OnTurn::of_station(station))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::V3;
    use crate::settings::SceneSettings;
    use crate::simulation::Simulation;
    use std::f64::consts::TAU;

    /// Six turns on a circle round the core; `place` says where along y wire lies after so many turns, m.
    fn six_turns(start: f64, place: impl Fn(f64) -> f64) -> Vec<SettledNode> {
        let node = |k: u32| {
            let turn = f64::from(k) / 72.0;
            let polar = start + TAU * turn;
            SettledNode {
                position: V3::new(
                    10e-3 * libm::cos(polar),
                    place(turn),
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

    /// Six turns one beside the other but for a step back of 0.6 diameters after three turns.
    fn turns_with_a_step_back(start: f64, d: f64) -> Vec<SettledNode> {
        six_turns(start, |turn| {
            d * (turn - 0.6 * (12.0 * (turn - 3.0)).clamp(0.0, 1.0))
        })
    }

    /// A winding of the default scene that has told nothing yet, its wire's diameter, m, and the angle of its clamp, rad.
    fn started() -> (Winding, f64, f64) {
        let scene = SceneSettings::default().build().expect("a scene");
        let simulation = Simulation::new(&scene).expect("a start");
        let mut winding = simulation.winding().clone();
        winding.run.events.clear();
        let start = winding.coil.spec().start_angle;
        (winding, scene.wire.diameter, start)
    }

    fn defects_told(winding: &mut Winding) -> Vec<String> {
        let events = std::mem::take(&mut winding.run.events).into_iter();
        let defects = events.filter(|event| event.kind == EventKind::Defect);
        defects.map(|event| event.text).collect()
    }

    /// Nobody was told of what was found when wire was measured again, as the nozzle had turned: it stood among the defects at the end.
    #[test]
    fn a_defect_that_is_found_late_is_told_once() {
        let (mut winding, d, start) = started();
        for node in turns_with_a_step_back(start, d) {
            winding.settle_and_tell(node);
        }
        assert!(defects_told(&mut winding).is_empty());
        assert!(winding.coil.defects().is_empty());
        // wire that goes on as before lies on the wrong side of its neighbour once the nozzle is known to have turned
        winding.coil_mut().begin_pass_at(3.0 * TAU, -1.0, 3.0 * d);
        winding.tell_of_changes("the nozzle has turned since");
        let told = defects_told(&mut winding);
        let found = winding.coil.defects();
        assert!(!found.is_empty());
        // each is told at the place that the tables name
        let all = told.join(" and ");
        for defect in &found {
            let (turn, angle, name) = (
                defect.found_turn,
                defect.found_angle_deg,
                defect.kind.words(),
            );
            let place = format!("in turn {turn} at {angle:.0} deg (");
            let there = all.split(" and ").find(|told| told.contains(&place));
            assert!(
                there.is_some_and(|told| told.contains(name)),
                "{defect:?}: {all}"
            );
        }
        let names = all.matches([',', '(']).count();
        assert_eq!(names, found.len(), "{told:?}");
        assert!(all.contains("overlap"), "{told:?}");

        // a loose end comes to rest where it lay
        winding.coil_mut().unsettle(200);
        for node in turns_with_a_step_back(start, d).split_off(6 * 72 - 200) {
            winding.settle_and_tell(node);
        }
        assert_eq!(winding.coil.defects().len(), found.len());
        assert_eq!(defects_told(&mut winding), [""; 0]);
    }

    /// A telling stood in the log that no table confirmed.
    #[test]
    fn a_defect_that_was_told_and_is_gone_is_told_to_be_gone() {
        let (mut winding, d, start) = started();
        for node in turns_with_a_step_back(start, d) {
            winding.settle_and_tell(node);
        }
        winding.coil_mut().begin_pass_at(3.0 * TAU, -1.0, 3.0 * d);
        winding.tell_of_changes("the nozzle has turned since");
        let told = defects_told(&mut winding);
        // Unwound wire is not there to be asked, and wire that comes to rest as before has its defects again.
        winding.coil_mut().unsettle(200);
        winding.tell_of_changes("nothing has come to pass");
        assert_eq!(defects_told(&mut winding), [""; 0]);
        for node in turns_with_a_step_back(start, d).split_off(6 * 72 - 200) {
            winding.settle_and_tell(node);
        }
        assert_eq!(defects_told(&mut winding), [""; 0]);

        winding.coil_mut().take_back_pass();
        winding.tell_of_changes("the nozzle has turned since");
        assert!(winding.coil.defects().is_empty());
        let gone = defects_told(&mut winding);
        let places = |texts: &[String]| -> Vec<String> {
            let all = texts.join(" and ");
            let of = |text: &str| {
                let from = text.find("in turn").expect("a place");
                text[from..=text.find(')').expect("a kind")].to_owned()
            };
            all.split(" and ").map(of).collect()
        };
        assert_eq!(places(&gone), places(&told), "{gone:?}");
        let because = "): the nozzle has turned since";
        assert!(gone.iter().all(|text| text.ends_with(because)), "{gone:?}");
        // and told again where it comes again
        winding.coil_mut().begin_pass_at(3.0 * TAU, -1.0, 3.0 * d);
        winding.tell_of_changes("the nozzle has turned since");
        assert_eq!(defects_told(&mut winding), told);
    }

    /// Rewound wire may lie better than it lay before.
    #[test]
    fn a_defect_that_is_wound_anew_without_it_is_told_to_be_gone() {
        let (mut winding, d, start) = started();
        for node in six_turns(start, |turn| d * (turn + 0.5 * (turn - 3.0).max(0.0))) {
            winding.settle_and_tell(node);
        }
        let told = defects_told(&mut winding);
        assert!(told.len() == 1 && told[0].contains("(gap)"), "{told:?}");
        winding.coil_mut().unsettle(4 * 72);
        for node in six_turns(start, |turn| d * turn).split_off(2 * 72) {
            winding.settle_and_tell(node);
        }
        assert!(winding.coil.defects().is_empty());
        let gone = defects_told(&mut winding);
        let place = told[0].strip_prefix("defect found ").expect("a defect");
        assert_eq!(
            gone,
            [format!("no longer a defect {place}: {MEASURED_ANEW}")]
        );
    }

    /// The number of defects fell without a word, and rose again without one when the same place was wound again.
    #[test]
    fn a_defect_that_is_unwound_is_told_to_be_gone_and_told_again() {
        let (mut winding, d, start) = started();
        let nodes = six_turns(start, |turn| d * (turn + 0.5 * (turn - 3.0).max(0.0)));
        for node in &nodes {
            winding.settle_and_tell(*node);
        }
        let told = defects_told(&mut winding);
        assert!(told.len() == 1 && told[0].contains("(gap)"), "{told:?}");
        // half a turn beyond the place may have come loose
        winding.take_back(2 * 72);
        assert_eq!(defects_told(&mut winding), [""; 0]);
        winding.take_back(4 * 72);
        let place = told[0].strip_prefix("defect found ").expect("a defect");
        let gone = format!("no longer a defect {place}: its wire has been unwound");
        assert_eq!(defects_told(&mut winding), [gone]);
        for node in &nodes {
            winding.settle_and_tell(*node);
        }
        assert_eq!(defects_told(&mut winding), told);
    }

    /// A run of stations that could still grow until it counts was told neither when larger limits took it out nor when it came back.
    #[test]
    fn a_defect_that_goes_on_is_told_to_count_no_more_where_limits_change() {
        let (mut winding, d, start) = started();
        for node in six_turns(start, |turn| d * (turn + 0.5 * (turn - 3.0).max(0.0))) {
            winding.settle_and_tell(node);
        }
        let told = defects_told(&mut winding);
        assert!(told.len() == 1 && told[0].contains("(gap)"), "{told:?}");
        let limits = winding.scene.defects;
        let mut longer = winding.scene.clone();
        longer.defects.gap_fraction = 1.0;
        // (a run is two turns long)
        winding.coil_mut().unsettle(2 * 72 + 36);
        winding.retune(&longer);
        let gone = defects_told(&mut winding);
        assert!(gone.len() == 1 && gone[0].contains("no longer"), "{gone:?}");
        assert_eq!(winding.coil.defect_count(), 0);
        longer.defects = limits;
        winding.retune(&longer);
        assert_eq!(defects_told(&mut winding), told);
    }

    /// Wire beside a flange that has left its row for certain was on its way since it stood on the turn before, and is judged there.
    #[test]
    fn a_defect_on_the_way_to_the_next_layer_is_told_once_the_wire_is_there() {
        let (mut winding, d, start) = started();
        // beside the flange wire rises on the turn before, stands off it for a tenth of a turn, and climbs on
        let lean = |turn: f64| match turn.fract() {
            within if within < 0.2 => 0.0,
            within if within < 0.6 => 0.15,
            _ => 0.4,
        };
        let mut nodes = six_turns(start, |turn| match turn {
            turn if turn < 3.0 => d * turn,
            turn if turn < 4.0 => d * (3.0 + lean(turn)),
            _ => d * 4.0,
        });
        nodes.truncate(5 * 72);
        for (node, k) in nodes.iter_mut().zip(0..) {
            let turn = f64::from(k) / 72.0;
            let rise = match turn {
                turn if turn < 4.0 => 0.0,
                turn if (4.4..4.5).contains(&turn) => 2.0,
                turn => (1.0 - (1.0 - lean(turn)).powi(2)).sqrt(),
            };
            node.height = d * rise;
            node.flange = Some(4.5 * d - node.position.y);
        }
        for node in nodes {
            winding.settle_and_tell(node);
        }
        let found = winding.coil.defects();
        let bulges = found
            .iter()
            .filter(|defect| defect.kind == DefectKind::Bulge);
        let places: Vec<(u32, f64)> = bulges.map(|d| (d.found_turn, d.found_angle_deg)).collect();
        let [(5, angle)] = places[..] else {
            panic!("one bulge: {found:?}");
        };
        assert!((144.0..180.0).contains(&angle), "{found:?}");
        let told = defects_told(&mut winding);
        let place = format!("in turn 5 at {angle:.0} deg (");
        assert!(told.iter().any(|told| told.contains(&place)), "{told:?}");
    }

    /// An end of a turn that came loose told of the turn twice.
    #[test]
    fn a_turn_is_told_once_unless_it_is_unwound() {
        let (mut winding, d, start) = started();
        let nodes = six_turns(start, |turn| d * turn);
        let mut told_after = |back: usize| -> Vec<String> {
            winding.take_back(back);
            let there = winding.coil.len();
            for node in &nodes[there..3 * 72 + 5] {
                winding.settle_and_tell(*node);
            }
            let events = std::mem::take(&mut winding.run.events).into_iter();
            let turns = events.filter(|event| event.kind == EventKind::Turn);
            turns.map(|event| event.text).collect()
        };
        let told = |turns: &[u32]| -> Vec<String> {
            let words = |turn| format!("turn {turn} has come to rest");
            turns.iter().map(words).collect()
        };
        assert_eq!(told_after(0), told(&[1, 2, 3]));
        assert_eq!(told_after(30), told(&[]));
        assert_eq!(told_after(72), told(&[]));
        assert_eq!(told_after(72 + 30), told(&[3]));
        assert_eq!(told_after(3 * 72 + 5), told(&[1, 2, 3]));
    }
}
