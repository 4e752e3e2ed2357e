//! What landings took out of the motion in the solve, for the energy balance.
//!
//! The solve gives a blow the impulse `gamma F`. It acts on the mean of `v*` and the velocity after it. Half the force over
//! the way of the step, which the balance takes for any other force, is right for what grows evenly from the step's start on.
//!
//! Not every landing is a blow. Where wire is laid on a core under tension, what it is pulled by comes with the touch and balances it:
//! no motion is stopped, and speeds of a long step say nothing. So impulses carry the share of the force that the inertia of
//! the wire holds, as far as bending carries a blow within the step. They do so only where the wire came in faster than its
//! way in the step says.

use super::carried::Carried;
use super::impulse::Impulse;
use super::scheme::StepFormula;
use crate::math::{Spin, V3, spin_velocity};
use crate::system::{Spindle, System};

/// How far a blow goes to either side: lengths over which the bending of a step falls to 1/e.
const REACH: f64 = 3.0;

/// The nodes as a step solved for them, without its impulses.
#[derive(Clone, Copy, Debug)]
pub(super) struct Solved<'a> {
    /// lumped masses, kg
    pub(super) mass: &'a [f64],
    /// velocities `v*`, m/s
    pub(super) star: &'a [V3],
    /// forces at the step's start, N
    pub(super) force: &'a [V3],
    /// motion energy and moment of momentum that it left
    pub(super) carried: Carried,
    /// numerical losses up to the step's start, J
    pub(super) numerical: f64,
}

/// Forces on each node that came within a step, core frame, N.
#[derive(Debug, Default)]
pub(super) struct Came {
    /// all together
    all: Vec<V3>,
    /// of landings
    landed: Vec<V3>,
}

impl Came {
    /// What blows and friction took in the landings of a step from the motion `old` of the spindle, J, beyond half the force
    /// over the way. `after` are the velocities that the solve left, core frame, m/s.
    pub(super) fn in_landings(
        &mut self,
        sys: &System,
        step: &StepFormula,
        (solved, old): (Solved, Spindle),
        (impulses, after): (&[Impulse], &[V3]),
    ) -> [f64; 2] {
        let lands = |impulse: &&Impulse| impulse.touch.lands;
        if !impulses.iter().any(|i| lands(&i)) {
            return [0.0; 2];
        }
        let now = sys.state.spindle;
        let (spin, before) = (Spin::new(now.angle), Spin::new(old.angle));
        let (all, landed) = (&mut self.all, &mut self.landed);
        all.clear();
        let forces = sys.state.load.force.iter().zip(solved.force);
        all.extend(forces.map(|(now, old)| spin.to_core(*now) - before.to_core(*old)));
        landed.clear();
        landed.resize(all.len(), V3::zeros());
        for impulse in impulses.iter().filter(lands) {
            for (i, w) in impulse.nodes().filter(|(_, w)| *w > 0.0) {
                landed[i] += impulse.touch.force * w;
            }
        }
        let section = &sys.model.section;
        let stiff = (sys.model.laws.bend.modulus / section.mass_per_length()).sqrt();
        let reach = REACH * (2.0 * stiff * step.gamma).sqrt();
        let (places, x) = (&sys.state.past.q, &sys.state.rod.x);
        let (mut blow, mut rubbed) = (0.0, 0.0);
        for impulse in impulses.iter().filter(lands) {
            // what the way of the step says more than the impulse
            let of_node = |(i, w): (usize, f64)| {
                let speed = spin.to_core(solved.star[i] - spin_velocity(now.speed, x[i]));
                let mean = (speed + after[i]) * 0.5;
                ((places[0][i] - places[1][i]) * 0.5 - mean * step.gamma) * w
            };
            let beyond: V3 = impulse.nodes().map(of_node).sum();
            let (force, normal) = (impulse.touch.force, impulse.touch.normal);
            let along_normal = force.dot(&normal) * beyond.dot(&normal);
            if along_normal <= 0.0 {
                continue;
            }
            let share = self.share_of_inertia(impulse, &sys.state.rod.rest, reach);
            blow += share * along_normal;
            rubbed += share * (force.dot(&beyond) - along_normal);
        }
        [blow, rubbed]
    }

    /// Share of a landing's force that is held by inertia of the wire within `reach` (m); `rest` are the lengths of the
    /// edges, m.
    fn share_of_inertia(&self, impulse: &Impulse, rest: &[f64], reach: f64) -> f64 {
        let normal = impulse.touch.normal;
        let middle = impulse.touch.point.weights().nodes[1];
        let ends = |edges: &mut dyn Iterator<Item = usize>| {
            let mut far = 0.0;
            edges
                .take_while(|&e| {
                    far += rest[e];
                    far < reach
                })
                .count()
        };
        let first = middle - ends(&mut (0..middle).rev());
        let last = middle + ends(&mut (middle..rest.len()));
        let along = |forces: &[V3]| -> f64 {
            let near = forces[first..=last].iter();
            near.map(|force| force.dot(&normal)).sum()
        };
        let landed = along(&self.landed).max(impulse.touch.force.dot(&normal));
        (along(&self.all) / landed).clamp(0.0, 1.0)
    }
}
