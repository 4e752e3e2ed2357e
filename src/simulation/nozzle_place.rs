//! Where the nozzle stands in a run that is driven by inputs.

use super::Winding;
use crate::math::V3;
use crate::scene::{Scene, si};
use crate::signals::{EventKind, Inputs};

/// Place of the nozzle by its inputs, in the frame at rest, m.
pub(super) fn nozzle_of(scene: &Scene, inputs: &Inputs) -> V3 {
    V3::new(
        scene.nozzle.distance + inputs.nozzle_offset_x,
        inputs.nozzle_position,
        inputs.nozzle_offset_z,
    )
}

impl Winding {
    /// Where the nozzle has to be at the end of a step whose inputs end as `end`, m: along the core axis as its law says,
    /// where it follows one.
    pub(super) fn nozzle_at_end(&self, end: &Inputs) -> V3 {
        let mut place = nozzle_of(&self.scene, end);
        if self.run.nozzle_by_law {
            place.y = self.nozzle_by_law();
        }
        place
    }

    /// Tells where the nozzle has come farther beside the winding than it stands in front of it; it was at `before` along the core
    /// axis, m, at the last communication point, if there was one.
    ///
    /// A scene may not begin so. An input may be in the wrong unit.
    pub(super) fn watch_nozzle(&mut self, before: Option<f64>) {
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

    /// Distance of the nozzle from the core axis, m.
    pub(super) fn nozzle_distance(&self) -> f64 {
        let nozzle = self.sys.state.support[1].point;
        libm::hypot(nozzle.x, nozzle.z)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Simulation;
    use super::{EventKind, Inputs};
    use crate::settings::SceneSettings;

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

    /// 6 instead of 6e-3 m was wound with, and nothing was said.
    #[test]
    fn a_nozzle_that_is_sent_in_millimetres_is_told_once() {
        assert_eq!(told([6.0; 4]), 1);
        assert_eq!(told([0.0, 0.0, 6.0, 6.0]), 1);
        assert_eq!(told([0.0, 6e-3, 12e-3, 6e-3]), 0);
    }
}
