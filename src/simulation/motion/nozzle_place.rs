//! Where the nozzle stands in a run that is driven by inputs.

use crate::math::V3;
use crate::scene::{Scene, si};
use crate::signals::{EventKind, Inputs};
use crate::simulation::Winding;
use std::f64::consts::TAU;

/// Share of a turn's way that rounding may add up to. Chosen: too little to be seen.
const NEAR: f64 = 1e-9;

/// Share of a nozzle's distance from the axis by which its offsets may differ for rounding.
pub(super) const OFFSET_ROUNDING: f64 = 1e-15;

/// Place of the nozzle by its inputs, in the frame at rest, m.
pub(in crate::simulation) fn nozzle_of(scene: &Scene, inputs: &Inputs) -> V3 {
    V3::new(
        scene.nozzle.distance + inputs.nozzle_offset_x,
        inputs.nozzle_position,
        inputs.nozzle_offset_z,
    )
}

/// What is told of a nozzle that begins farther from the clamp than the scene has it, at this place along the core axis, m.
pub(in crate::simulation) fn beside_clamp(scene: &Scene, nozzle: f64) -> Option<String> {
    let clamp = scene.start.clamp_y;
    let planned = (scene.nozzle_law.start() - clamp).abs();
    let beside = (nozzle - clamp).abs() > planned + scene.wire.diameter;
    beside.then(|| {
        format!(
            "the nozzle begins at y = {} m, and the wire is clamped at {} m, from where its first turns run aslant; set start.clamp_y to where the nozzle begins",
            si(nozzle),
            si(clamp)
        )
    })
}

impl Winding {
    /// Where the nozzle has to be at the end of a step whose inputs end as `end`, m: along the core axis as its law says,
    /// where it follows one.
    pub(in crate::simulation) fn nozzle_at_end(&self, end: &Inputs) -> V3 {
        let mut place = nozzle_of(&self.scene, end);
        if self.run.nozzle_by_law {
            place.y = self.nozzle_by_law();
        }
        place
    }

    /// Puts the nozzle where its offsets have it, if that is not where it is but for rounding.
    pub(in crate::simulation) fn put_aside(&mut self, inputs: &Inputs) {
        let (is, there) = (self.inputs(), nozzle_of(&self.scene, inputs));
        let near = OFFSET_ROUNDING * self.scene.nozzle.distance;
        let nozzle = &mut self.sys.state.support[1].point;
        if (is.nozzle_offset_x - inputs.nozzle_offset_x).abs() > near {
            nozzle.x = there.x;
        }
        if (is.nozzle_offset_z - inputs.nozzle_offset_z).abs() > near {
            nozzle.z = there.z;
        }
    }

    /// Tells where the nozzle has come farther beside the winding than it stands in front of it; it was at `before` along the core
    /// axis, m, at the last communication point, if there was one.
    ///
    /// A scene may not begin so. An input may be in the wrong unit.
    pub(in crate::simulation) fn watch_nozzle(&mut self, before: Option<f64>) {
        let (now, reach) = (self.sys.state.support[1].point.y, self.nozzle_distance());
        let [low, high] = self.ends;
        let is_far = |y: f64| y < low - reach || y > high + reach;
        if is_far(now) && !before.is_some_and(is_far) {
            let end = if now < low { low } else { high };
            self.report(
                EventKind::Judgement,
                format!(
                    "the nozzle is at y = {} m, farther beside the winding, which ends at {} m, than it stands in front of it, {} m; check the unit of nozzle_position",
                    si(now),
                    si(end),
                    si(reach)
                ),
            );
        }
    }

    /// Tells where a nozzle that goes on evenly by its law begins a turn that has no place on the core. Inputs may turn the core that far.
    ///
    /// It was at `before` along the core axis, m, at the last communication point, if there was one.
    pub(in crate::simulation) fn watch_even_law(&mut self, before: Option<f64>) {
        let (law, traverse) = (&self.scene.nozzle_law, &self.scene.traverse);
        if !self.run.nozzle_by_law || traverse.mode != "by-angle" {
            return;
        }
        // (a turn ends a turn's way behind its place)
        let way = TAU * law.pieces()[0].travel.abs();
        let room = way + traverse.lead.abs() - self.scene.wire.radius();
        let [low, high] = [self.ends[0] - room, self.ends[1] + room];
        let (now, near) = (self.sys.state.support[1].point.y, NEAR * way);
        let has_no_place = |y: f64| y < low - near || y > high + near;
        if has_no_place(now) && before.is_some_and(|y| !has_no_place(y)) {
            let end = if now < low {
                self.ends[0]
            } else {
                self.ends[1]
            };
            self.report(
                EventKind::Judgement,
                format!(
                    "the nozzle has gone on past the end of the winding, at {} m, and the turns from here on have no place beside the others; let it turn back by another traverse.mode, wind fewer turns, or set traverse.per_turn to less",
                    si(end)
                ),
            );
        }
    }

    /// Distance of the nozzle from the core axis, m.
    pub(in crate::simulation) fn nozzle_distance(&self) -> f64 {
        let nozzle = self.sys.state.support[1].point;
        libm::hypot(nozzle.x, nozzle.z)
    }
}

#[cfg(test)]
mod tests {
    use super::{EventKind, Inputs, TAU};
    use crate::settings::SceneSettings;
    use crate::simulation::Simulation;

    /// How often it is told, of a nozzle that starts at the first of these places and is sent to the others, m.
    fn told(places: [f64; 4]) -> usize {
        let scene = SceneSettings::load("fig8")
            .and_then(|s| s.build())
            .expect("a scene");
        let at = |nozzle_position| Inputs {
            nozzle_position,
            ..scene.start_inputs()
        };
        let mut sim = Simulation::starting_with(&scene, at(places[0])).expect("starts");
        for place in &places[1..] {
            sim.advance(at(*place), 1e-4).expect("the run goes on");
        }
        let events = sim.drain_events();
        let told = |e: &&crate::signals::Event| {
            e.kind == EventKind::Judgement && e.text.contains("unit of nozzle_position")
        };
        events.iter().filter(told).count()
    }

    /// Inputs may turn the core farther than an even law has room for. The scene's own number of turns was judged, which they do not wind.
    #[test]
    fn a_nozzle_whose_law_goes_on_past_a_flange_is_told_once() {
        let mut settings = SceneSettings::load("fig8").expect("packed");
        for (name, value) in [
            ("traverse.mode", "by-angle"),
            ("core.flange.inner_distance", "3e-3"),
            ("core.flange.height", "5e-3"),
            ("nozzle.y_start", "-1.1e-3"),
            ("start.clamp_y", "-1.1e-3"),
            ("spindle.turns", "14"),
        ] {
            settings.set_text(name, value).expect("a setting");
        }
        let refused = settings.build().expect_err("14 turns have no room");
        assert!(refused.to_string().contains("for 14 turns"), "{refused}");
        let by_inputs = settings.build_for(settings.nozzle_follows());
        let (scene, _) = by_inputs.expect("inputs may wind fewer");
        let start = scene.start_inputs();
        let mut sim = Simulation::starting_by_law(&scene, start).expect("starts");
        sim.step_beyond(true);
        let turning = Inputs {
            spindle_speed: 60.0,
            ..start
        };
        let mut told = Vec::new();
        for _ in 0..700 {
            sim.advance(turning, 1e-3).expect("goes on");
            let events = sim.drain_events().into_iter();
            told.extend(events.filter(|e| e.text.contains("no place beside the others")));
        }
        assert_eq!(told.len(), 1, "{told:?}");
        // places from -1.1 to 1.15 mm hold four turns, 0.7 mm apart
        assert!((told[0].angle / TAU - 4.2).abs() < 0.3, "{told:?}");
        settings
            .set_text("nozzle.y_start", "-2e-3")
            .expect("a setting");
        let past = settings.build_for(settings.nozzle_follows());
        let past = past.expect_err("the first turn lies in the flange");
        assert!(past.to_string().contains("nozzle.y_start"), "{past}");
    }

    /// A run from the other flange wound forty defects, and nothing was said.
    #[test]
    fn a_nozzle_that_begins_beside_the_clamp_is_told() {
        let scene = SceneSettings::load("fig8").and_then(|s| s.build());
        let scene = scene.expect("a scene");
        for (nozzle_position, told) in [(0.0, 0), (0.6e-3, 0), (3e-3, 1), (-3e-3, 1)] {
            let inputs = Inputs {
                nozzle_position,
                ..scene.start_inputs()
            };
            let mut sim = Simulation::starting_with(&scene, inputs).expect("starts");
            let events = sim.drain_events();
            let aslant = |e: &&crate::signals::Event| e.text.contains("set start.clamp_y");
            assert_eq!(
                events.iter().filter(aslant).count(),
                told,
                "{nozzle_position}"
            );
        }
    }

    /// 6 instead of 6e-3 m was wound with, and nothing was said.
    #[test]
    fn a_nozzle_that_is_sent_in_millimetres_is_told_once() {
        assert_eq!(told([6.0; 4]), 1);
        assert_eq!(told([0.0, 0.0, 6.0, 6.0]), 1);
        assert_eq!(told([0.0, 6e-3, 12e-3, 6e-3]), 0);
    }
}
