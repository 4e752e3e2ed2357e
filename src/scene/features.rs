//! What a scene does not need: decided once, before the first step.
//!
//! Every part of a step that some scene can do without has a switch `auto | on | off` (twist has
//! levels instead). `on` and `off` are obeyed. `auto` takes the part in where it can change what a
//! run shows. It leaves a [`Decision`] in the summary either way.

use super::{Decision, Integrator, LiveContact, Scene, SceneError};
use crate::rod::Section;
use crate::rod::Twist;
use crate::settings::SceneSettings;

/// What a switch says.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Switch {
    Auto,
    On,
    Off,
}

fn switch(text: &str) -> Switch {
    match text {
        "on" => Switch::On,
        "off" => Switch::Off,
        _ => Switch::Auto,
    }
}

/// Collects the decisions on settings that are `auto`.
#[derive(Default)]
pub(super) struct Decisions(pub(super) Vec<Decision>);

impl Decisions {
    /// `switch` as it is, or what the scene asks for, with the reason.
    fn decide(
        &mut self,
        name: &'static str,
        switch: Switch,
        needed: bool,
        [with, without]: [&'static str; 2],
    ) -> bool {
        match switch {
            Switch::On => true,
            Switch::Off => false,
            Switch::Auto => {
                let (decision, why) = if needed {
                    ("on", with)
                } else {
                    ("off", without)
                };
                self.0.push(Decision {
                    name,
                    setting: "auto",
                    decision,
                    why,
                });
                needed
            }
        }
    }
}

/// The least of twist that a run needs.
///
/// Wire that is bent beyond yield keeps a curvature whose direction turns with its roll. Without
/// twist the set of a corner points the wrong way on the next face: `fig8` at 30 and 300 rad/s
/// lands 75 and 81 um rms along the core elsewhere. Elastic wire is straight when unloaded, and
/// nothing holds its roll at the nozzle, so it rolls freely whatever way it is bent. Without twist
/// it lies 90 and 10 um rms elsewhere, while 0.7 um of the nozzle's place make 87 and 17. Rotary
/// inertia changes nothing that a run shows. The explicit methods cannot solve for a balance of
/// torques and step them in time.
fn twist_that_matters(integrator: Integrator, wire: &Section) -> (Twist, Decision) {
    let yields = wire.m_y.is_finite() || wire.t_y.is_finite();
    let (twist, decision, why) = match integrator {
        Integrator::Implicit if yields => (
            Twist::QuasiStatic,
            "quasi-static",
            "the wire can yield, and set curvature turns with its roll; rotary inertia is left out",
        ),
        Integrator::Implicit => (
            Twist::Off,
            "off",
            "elastic wire that may turn in the nozzle stays free of twist",
        ),
        Integrator::Rk4 | Integrator::Verlet => (
            Twist::Dynamic,
            "dynamic",
            "the explicit methods step every edge's roll in time",
        ),
    };
    let decision = Decision {
        name: "solver.twist",
        setting: "auto",
        decision,
        why,
    };
    (twist, decision)
}

impl SceneSettings {
    /// How twist is carried.
    pub(super) fn twist(
        &self,
        integrator: Integrator,
        wire: &Section,
        decisions: &mut Decisions,
    ) -> Result<Twist, SceneError> {
        let implicit = integrator.is_implicit();
        match self.solver.twist.as_str() {
            "off" => Ok(Twist::Off),
            "dynamic" => Ok(Twist::Dynamic),
            "quasi-static" if implicit => Ok(Twist::QuasiStatic),
            "quasi-static" => Err(self.impossible(
                "solver.twist",
                "the explicit methods step every edge's roll in time",
                "auto, off or dynamic; quasi-static with solver.integrator = implicit",
            )),
            _ => {
                let (twist, decision) = twist_that_matters(integrator, wire);
                decisions.0.push(decision);
                Ok(twist)
            }
        }
    }

    /// Makes the wire elastic where the scene says so; an elastic wire has no plastic state.
    pub(super) fn plasticity(&self, wire: &mut Section, decisions: &mut Decisions) {
        let yields = wire.n_y.is_finite() || wire.m_y.is_finite() || wire.t_y.is_finite();
        let plastic = decisions.decide(
            "solver.plasticity",
            switch(&self.solver.plasticity),
            yields,
            ["the wire can yield", "the wire is elastic"],
        );
        if plastic {
            return;
        }
        for limit in [
            &mut wire.n_y,
            &mut wire.m_y,
            &mut wire.t_y,
            &mut wire.moment_cap,
        ] {
            *limit = f64::INFINITY;
        }
    }

    /// Takes out of a scene what it does not need or must not have.
    pub(super) fn skip(
        &self,
        scene: &mut Scene,
        decisions: &mut Decisions,
    ) -> Result<(), SceneError> {
        let implicit = scene.solver.integrator.is_implicit();
        let s = &self.solver;
        let rubs = scene.friction.static_ > 0.0 || scene.friction.kinetic > 0.0;
        let rubs = decisions.decide(
            "solver.friction",
            switch(&s.friction),
            rubs,
            ["surfaces rub", "both friction coefficients are 0"],
        );
        if !rubs {
            (scene.friction.static_, scene.friction.kinetic) = (0.0, 0.0);
        }
        let coarser = scene.solver.spacing_free > scene.solver.spacing_near;
        let coarse = decisions.decide(
            "solver.coarse_span",
            switch(&s.coarse_span),
            coarser,
            [
                "the free span is nearly straight",
                "solver.spacing_free is no more than solver.spacing_near",
            ],
        );
        if !coarse {
            scene.solver.spacing_free = scene.solver.spacing_near;
        }
        let settled = switch(&s.coarse_settled);
        if !implicit && settled == Switch::On {
            return Err(self.impossible(
                "solver.coarse_settled",
                "the explicit methods keep their spacing",
                "auto or off; on with solver.integrator = implicit",
            ));
        }
        let free = scene.solver.integrator.is_implicit() && self.solver.step == 0.0;
        let asked = switch(&self.solver.steps_beyond);
        let beyond = decisions.decide(
            "solver.steps_beyond",
            asked,
            free,
            [
                match asked {
                    Switch::On => "steps end neither at communication points nor at rows",
                    _ => "steps need not end at communication points; at rows of the scene's own motion they do",
                },
                "steps of a given length end at communication points",
            ],
        );
        scene.solver.features.steps_beyond = beyond && free;
        // rows cost little where the motion is slow, and steps that end there show the tension's ringing
        scene.solver.features.rows_between = free && asked == Switch::On;
        scene.solver.features.coarse_settled = decisions.decide(
            "solver.coarse_settled",
            settled,
            implicit,
            [
                "bows between corners are smooth",
                "the explicit methods keep their spacing",
            ],
        );
        scene.solver.features.live_contact = match switch(&s.live_contact) {
            Switch::On => LiveContact::Always,
            Switch::Off => LiveContact::Never,
            Switch::Auto => {
                decisions.0.push(Decision {
                    name: "solver.live_contact",
                    setting: "auto",
                    decision: "from half a live turn on",
                    why: "less of it cannot meet itself",
                });
                LiveContact::WhenHalfATurnIsLive
            }
        };
        let inertia = switch(&s.inertia);
        if !implicit && inertia == Switch::Off {
            return Err(self.impossible(
                "solver.inertia",
                "the explicit methods move masses",
                "auto or on; off with solver.integrator = implicit",
            ));
        }
        scene.solver.features.inertia = decisions.decide(
            "solver.inertia",
            inertia,
            true,
            [
                "mass costs nothing, and spares Newton's method the snaps between states of rest",
                "",
            ],
        );
        Ok(())
    }
}
