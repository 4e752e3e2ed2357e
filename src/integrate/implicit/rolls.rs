//! The rolls of the edges about themselves, the unknowns that carry twist.
//!
//! A roll counts from the frame that the edge had at the last accepted instant, carried along the
//! shortest way onto the iterate's edge. The explicit methods turn their frames in the same way, so a
//! converged step is committed by them. The unknown of edge `j` stands with node `j`; the last node
//! has none. With inertia the roll follows the scheme of the positions, without it every edge is
//! where its torques balance. Contact acts on the centreline: friction puts no moment on the wire
//! about its own axis, neither here nor in the explicit methods.

use super::scheme::{Scheme, StepFormula, extrapolation};
use crate::linalg::Banded;
use crate::math::rotate;
use crate::math::turn_about_y;
use crate::math::{Quat, V3};
use crate::rod::Twist;
use crate::rod::TwistingJoints;
use crate::system::{Spindle, Support, System};

/// Largest change of a joint's twist in a guess or an update, rad. Chosen: a third of half a turn, at which a twist changes sides.
/// Wire without torque has nothing that holds its rolls, and a set that looks away from the bend turns over in no time: neither says
/// how far.
pub(super) const MOST_TWIST: f64 = 1.0;

/// Rolls of a step, rad, one per edge.
#[derive(Debug, Default)]
pub(super) struct Rolls {
    pub(super) angle: Vec<f64>,
    pub(super) start: Vec<f64>,
    pub(super) guess: Vec<f64>,
    /// where rolls would go without torques
    target: Vec<f64>,
    /// roll and spin that the scheme makes of history
    star: [Vec<f64>; 2],
    /// moment of inertia of each edge about itself, kg m^2; 0: quasi-static
    inertia: Vec<f64>,
    /// derivative of the potential, N m, one per node
    pub(super) gradient: Vec<f64>,
    /// frames at the last accepted instant, turned with the core to the present one, and their edges' directions
    frame: Vec<Quat>,
    along: Vec<V3>,
    clamp: [Option<Quat>; 2],
    /// nothing says how the wire as a whole is rolled
    loose: bool,
    /// torques at the last accepted instant, N m
    before: Vec<f64>,
}

impl Rolls {
    /// Guess and history for a step of twist at the level `sys.twist`; `inert`: with the inertia that
    /// the level asks for.
    pub(super) fn prepare(
        &mut self,
        sys: &System,
        step: &StepFormula,
        spindle: &Spindle,
        support: &[Support; 2],
        inert: bool,
    ) {
        let (rod, past) = (&sys.state.rod, &sys.state.past);
        let back = turn_about_y(-spindle.angle);
        let e = extrapolation(step.share * step.h, past);
        let dynamic = inert && sys.model.twist == Twist::Dynamic;
        let [star, rate] = &mut self.star;
        for v in [
            &mut self.guess,
            &mut self.target,
            &mut self.inertia,
            star,
            rate,
        ] {
            v.clear();
        }
        self.frame.clear();
        self.frame.extend(rod.frame.iter().map(|f| back * f));
        self.along.clear();
        let directions = self.frame.iter().map(|f| rotate(f, &V3::z()));
        self.along.extend(directions);
        self.clamp = [0, 1].map(|end| {
            let s = &support[end];
            s.frame.map(|f| if s.turning { f } else { back * f })
        });
        let density = sys.model.section.spin_inertia_per_length();
        // (array by array: an array whose length is known is filled with nothing to check)
        let edges = rod.edges();
        let [one, two] = &past.roll;
        if step.weight[1] == 0.0 {
            star.resize(edges, 0.0);
            rate.extend_from_slice(&rod.spin);
        } else {
            star.extend(one[..edges].iter().map(|roll| step.blend(0.0, -roll)));
            let spins = rod.spin.iter().zip(&past.spin[..edges]);
            rate.extend(spins.map(|(now, before)| step.blend(*now, *before)));
        }
        let history = star.iter().zip(rate.iter());
        (self.target).extend(history.map(|(roll, spin)| roll + spin * step.gamma));
        match past.known {
            0 => (self.guess).extend(rod.spin.iter().map(|spin| spin * step.share * step.h)),
            1 => (self.guess).extend(one[..edges].iter().map(|roll| -roll * e[1])),
            _ => {
                let rolls = one[..edges].iter().zip(&two[..edges]);
                (self.guess).extend(rolls.map(|(one, two)| -one * e[1] - (one + two) * e[2]));
            }
        }
        if dynamic {
            (self.inertia).extend(rod.rest.iter().map(|rest| density * rest));
        } else {
            self.inertia.resize(edges, 0.0);
        }
        let share = within(MOST_TWIST, self.guess.iter().copied());
        if share < 1.0 {
            self.guess.iter_mut().for_each(|roll| *roll *= share);
        }
        self.loose = !dynamic && self.clamp == [None; 2];
        self.angle.clone_from(&self.guess);
    }

    /// Hands what stays the same in a step to `batch`.
    pub(super) fn lay_out(&self, batch: &mut TwistingJoints) {
        batch.begin(&self.frame, &self.along, self.clamp);
    }

    /// Which of the joints at the ends there are: the first and the last with a frame on either side.
    pub(super) fn joints(&self) -> [usize; 2] {
        let edges = self.frame.len();
        [
            usize::from(self.clamp[0].is_none()),
            edges - usize::from(self.clamp[1].is_none()),
        ]
    }

    /// Adds inertia and drag of the rolls, to the matrix if there is one; returns their potential.
    pub(super) fn add_inertia(
        &mut self,
        gamma: f64,
        drag: f64,
        mut matrix: Option<&mut Banded<4>>,
    ) -> f64 {
        let mut energy = 0.0;
        if self.inertia.iter().all(|inertia| *inertia == 0.0) {
            return energy;
        }
        for j in 0..self.angle.len() {
            let (d, way) = (
                self.angle[j] - self.target[j],
                self.angle[j] - self.star[0][j],
            );
            let k = self.inertia[j] / (gamma * gamma);
            let c = drag * self.inertia[j] / gamma;
            energy += 0.5 * (k * d * d + c * way * way);
            self.gradient[j] += k * d + c * way;
            if let Some(matrix) = &mut matrix {
                matrix.add_to_entry(j, 3, k + c);
            }
        }
        energy
    }

    /// Holds what is no unknown.
    pub(super) fn pin(&mut self, mut matrix: Option<&mut Banded<4>>) {
        for i in self.pinned().into_iter().flatten() {
            if let Some(matrix) = &mut matrix {
                matrix.pin(i, 3);
            }
            self.gradient[i] = 0.0;
        }
    }

    /// Nodes whose roll is no unknown: the last has none, the first is held where nothing else says how the
    /// wire is rolled.
    pub(super) fn pinned(&self) -> [Option<usize>; 2] {
        [Some(self.angle.len()), self.loose.then_some(0)]
    }

    /// Largest move of an edge's surface that the torques allow, m; without inertia nothing bounds it.
    pub(super) fn bound(&self, gamma: f64, radius: f64) -> f64 {
        let weight = gamma * gamma * radius;
        (self.gradient.iter().zip(&self.inertia))
            .map(|(g, i)| g.abs() * weight / i)
            .fold(0.0, f64::max)
    }

    /// Sum of inertia times the square of what the guess was off by, kg m^2.
    pub(super) fn difference(&self) -> f64 {
        (self.angle.iter().zip(&self.guess).zip(&self.inertia))
            .map(|((a, g), i)| i * (a - g) * (a - g))
            .sum()
    }

    /// Keeps the torques of the present instant for the energy balance of the step to come.
    pub(super) fn keep_torques(&mut self, sys: &System) {
        self.before.clone_from(&sys.state.load.torque);
    }

    /// Hands rolls and spins over to the rod, whose frames turn with the next evaluation, and moves history on.
    pub(super) fn hand_over(&mut self, sys: &mut System, scheme: Scheme, step: &StepFormula) {
        let past = &mut sys.state.past;
        past.spin.clone_from(&sys.state.rod.spin);
        for j in 0..self.angle.len() {
            let (roll, spin) = match scheme {
                Scheme::Bdf2 => (
                    self.angle[j],
                    (self.angle[j] - self.star[0][j]) / step.gamma,
                ),
                Scheme::Midpoint => (
                    2.0 * self.angle[j],
                    self.angle[j] * (4.0 / step.h) - sys.state.rod.spin[j],
                ),
            };
            sys.state.roll[j] = roll;
            // without inertia a rate means nothing and would count as motion energy
            sys.state.rod.spin[j] = if self.inertia[j] > 0.0 { spin } else { 0.0 };
        }
        past.roll.rotate_right(1);
        past.roll[0].clone_from(&sys.state.roll);
    }

    /// Work of the torques in the step just committed, J.
    pub(super) fn work(&self, sys: &System) -> f64 {
        (self.before.iter().zip(&sys.state.load.torque))
            .zip(&sys.state.past.roll[0])
            .map(|((a, b), roll)| 0.5 * (a + b) * roll)
            .sum()
    }
}

/// Share of changes of the `rolls`, rad, by which no joint twists by more than `most`, rad; may be above 1.
pub(super) fn within(most: f64, rolls: impl Iterator<Item = f64>) -> f64 {
    let mut before = 0.0;
    let mut largest = 0.0_f64;
    for roll in rolls {
        largest = largest.max((roll - before).abs());
        before = roll;
    }
    most / largest
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rolls that nothing held were continued from step to step, to a million turns.
    #[test]
    fn no_joint_twists_by_more_than_the_share() {
        let rolls = [0.0, 0.5, 0.4, -3.6, -3.5];
        let share = within(1.0, rolls.into_iter());
        assert_eq!(share, 0.25);
        assert_eq!(within(1.0, [1.0, 2.0, 3.0].into_iter()), 1.0);
        assert!(within(1.0, [0.0; 4].into_iter()) > 1.0);
    }
}
