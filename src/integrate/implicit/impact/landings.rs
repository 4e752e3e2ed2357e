//! What landings took out of the motion in the solve, for the energy balance.
//!
//! The solve gives a blow the impulse `gamma F`. It acts on the mean of `v*` and the velocity after it. Half the force over
//! the way of the step, which the balance takes for any other force, is right for what grows evenly from the step's start on.
//!
//! Not every landing is a blow. Where wire is laid on a core under tension, what it is pulled by comes with the touch and balances it:
//! no motion is stopped, and speeds of a long step say nothing. So what goes by impulses is the share of the force that
//! the inertia of the wire holds, as far as bending carries a blow within the step, and only where the wire came in
//! faster than its way in the step says.

use super::{Impacts, Impulse, Solved, book};
use crate::integrate::implicit::scheme::StepFormula;
use crate::math::{Spin, V3, spin_velocity};
use crate::system::{Spindle, System};

/// How far a blow goes to either side: lengths over which the bending of a step falls to 1/e.
const REACH: f64 = 3.0;

/// Forces on each node that came within a step, core frame, N.
#[derive(Debug, Default)]
pub(super) struct Came {
    /// all together
    all: Vec<V3>,
    /// of landings
    landed: Vec<V3>,
}

impl Impacts {
    /// Accounts for the landings of a step from the motion `old` of the spindle.
    pub(super) fn book_landings(
        &mut self,
        sys: &mut System,
        step: &StepFormula,
        solved: Solved,
        old: Spindle,
    ) {
        let lands = |impulse: &&Impulse| impulse.touch.lands;
        if !self.impulses.iter().any(|i| lands(&i)) {
            return;
        }
        let now = sys.state.spindle;
        let (spin, before) = (Spin::new(now.angle), Spin::new(old.angle));
        let Came { all, landed } = &mut self.came;
        all.clear();
        let forces = sys.state.load.force.iter().zip(solved.force);
        all.extend(forces.map(|(now, old)| spin.to_core(*now) - before.to_core(*old)));
        landed.clear();
        landed.resize(all.len(), V3::zeros());
        for impulse in self.impulses.iter().filter(lands) {
            for (i, w) in impulse.nodes().filter(|(_, w)| *w > 0.0) {
                landed[i] += impulse.touch.force * w;
            }
        }
        let section = &sys.model.section;
        let stiff = (sys.model.laws.bend.modulus / section.mass_per_length()).sqrt();
        let reach = REACH * (2.0 * stiff * step.gamma).sqrt();
        let (places, x) = (&sys.state.past.q, &sys.state.rod.x);
        let (mut blow, mut rubbed) = (0.0, 0.0);
        for impulse in self.impulses.iter().filter(lands) {
            // what the way of the step says more than the impulse
            let of_node = |(i, w): (usize, f64)| {
                let speed = spin.to_core(solved.star[i] - spin_velocity(now.speed, x[i]));
                let mean = (speed + self.start[0][i]) * 0.5;
                ((places[0][i] - places[1][i]) * 0.5 - mean * step.gamma) * w
            };
            let beyond: V3 = impulse.nodes().map(of_node).sum();
            let (force, normal) = (impulse.touch.force, impulse.touch.normal);
            let along_normal = force.dot(&normal) * beyond.dot(&normal);
            if along_normal <= 0.0 {
                continue;
            }
            let share = self
                .came
                .share_of_inertia(impulse, &sys.state.rod.rest, reach);
            blow += share * along_normal;
            rubbed += share * (force.dot(&beyond) - along_normal);
        }
        sys.state.balance.numerical -= blow + rubbed;
        book(sys, rubbed, blow);
    }
}

impl Came {
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
