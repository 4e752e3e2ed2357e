//! So many steps are enough.
//!
//! A step ends at every communication point, and it is cut short where a contact point lands. In between its error bounds it:
//! a wave of the angular frequency `w` and the amplitude `a` may take steps of `(tolerance / a)^(1/3) / w`. The fastest wave
//! on the free span that nodes resolve has a length of two spacings, and runs as on a string. Its amplitude is set to the
//! wire's diameter; hardly any are so large, so a share of those steps counts.
//!
//! A jump of the set tension makes tensioner and pulley ring on their line, by the jump over the line's stiffness and until the line has damped it.

use crate::lab::stress::Measures;
use crate::scene::Scene;
use crate::simulation::Simulation;
use std::f64::consts::PI;

/// Share of the steps for the fastest wave that a run needs. Calibrated with 500 scenes (seed 1, before twelve kinds of scene
/// were added). With it the steps tried over the sum of all three are 0.6 in the middle, 4 at 98 % and 7 at most.
const WAVES: f64 = 1.0 / 300.0;
/// Steps tried that are enough over that sum. As each counts by its nodes, and nodes are the most there were, twice the most of
/// those scenes: where every input shakes, steps are cut at waves that nothing but the shaking makes.
const ENOUGH: f64 = 10.0;

/// What a run had to do so far.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Work {
    /// communication steps
    looks: f64,
    /// contact points that landed, or are on their way
    landed: f64,
    /// steps for the fastest wave
    waves: f64,
    /// steps for the ringing of tensioner and pulley after jumps of the set tension
    rings: f64,
    /// live nodes at most
    nodes: f64,
}

impl Work {
    /// Counts a communication step of `dt` (s) with this set tension, N, that is about to be tried.
    pub(super) fn begin(&mut self, sim: &Simulation, tension: f64, dt: f64) {
        let (solver, wire) = (&sim.scene().solver, &sim.scene().wire);
        let o = sim.outputs();
        let rod = &sim.system().state;
        let pull = rod.load.tension.iter().copied().fold(0.0, f64::max);
        let wave = (pull / wire.mass_per_length()).sqrt() * PI / solver.spacing_free;
        self.looks += 1.0;
        self.waves += wave * dt * libm::cbrt(wire.diameter / solver.tolerance);
        self.rings += rings(sim.scene(), tension - sim.inputs().tension_setpoint, dt);
        let landed = 2.0 * (o.fed_length.abs() + o.free_length) / solver.spacing_near;
        self.landed = self.landed.max(landed);
        self.nodes = self.nodes.max(rod.rod.nodes() as f64);
    }

    /// Steps tried that are enough, each times its number of nodes.
    pub(super) fn allowed(&self) -> u64 {
        let estimated = ENOUGH * (self.looks + self.landed + WAVES * self.waves);
        ((estimated + self.rings) * self.nodes) as u64
    }

    /// Says how much of that is done.
    pub(super) fn end(&self, sim: &Simulation, m: &mut Measures) {
        m.work = sim.work() as f64 / self.allowed() as f64;
    }
}

/// Steps for the ringing of a tensioner with mass, and its pulley, after a jump of the set tension, N, within `dt`, s.
fn rings(scene: &Scene, jump: f64, dt: f64) -> f64 {
    let t = &scene.tensioner;
    if t.mass == 0.0 || t.line_length == 0.0 {
        return 0.0;
    }
    let stiffness = scene.wire.ea / t.line_length;
    let amplitude = jump.abs() / stiffness;
    let share = t.pulley_place * (1.0 - t.pulley_place);
    let of_pulley = (t.pulley_mass > 0.0).then(|| (stiffness / (share * t.pulley_mass)).sqrt());
    let of_tensioner = (stiffness / t.mass).sqrt();
    let fading = t.line_damping_ratio * of_tensioner + 0.5 * t.damping / t.mass;
    // (a step goes with the cube root of the amplitude, which fades three times as slowly)
    let time = dt.min(3.0 / fading);
    let frequency = of_pulley.map_or(of_tensioner, |of| of.max(of_tensioner));
    frequency * time * libm::cbrt(amplitude / scene.solver.tolerance)
}

#[cfg(test)]
mod tests {
    use crate::lab::stress::invariants::judge;
    use crate::lab::stress::{Invariant, Outcome, draw};

    /// Steps a thousand times as short as the tolerance asks for are too many.
    #[test]
    fn a_solver_that_crawls_is_seen() {
        let mut case = draw::case(1, 4).unwrap();
        assert_eq!(judge(&case).outcome, Outcome::Completed);
        case.settings.solver.step = 1e-8;
        match judge(&case).outcome {
            Outcome::Invariant { what, .. } => assert_eq!(what, Invariant::Steps),
            other => panic!("{other}"),
        }
    }
}
