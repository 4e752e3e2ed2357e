//! Whether the forces on the wire balance, measured against the loads.

use super::error::RelaxError;
use super::unknowns::held;
use crate::system::System;

/// The size of the loads, against which forces out of balance are judged.
pub(super) struct Balance {
    force: f64,
    moment: f64,
}

impl Balance {
    pub(super) fn of(sys: &System) -> Result<Self, RelaxError> {
        let length: f64 = sys.state.rod.rest.iter().sum();
        for i in 0..sys.state.rod.nodes() {
            let torque = sys.state.load.torque.get(i).copied().unwrap_or(0.0);
            if !(sys.state.load.force[i].norm() + torque.abs()).is_finite() {
                return Err(RelaxError::Broken {
                    node: i,
                    share: 1.0,
                });
            }
        }
        let last = sys.state.rod.nodes() - 1;
        let mut force =
            sys.model.loads.gravity.norm() * sys.model.section.mass_per_length() * length;
        for i in [0, last] {
            for a in 0..3 {
                if held(sys, i, a) {
                    force = force.max(sys.state.load.force[i][a].abs());
                }
            }
        }
        for (_, f) in &sys.model.loads.nodal {
            force = force.max(f.norm());
        }
        let couples = sys.model.loads.moments.iter().map(|(_, m)| m.norm());
        let clamps = sys.state.load.clamp_moment.iter().map(|m| m.norm());
        let moment = couples.chain(clamps).fold(force * length, f64::max);
        Ok(Self {
            force: moment / length,
            moment,
        })
    }

    /// Rounding of positions felt as force at node `i`, N.
    fn noise(sys: &System, i: usize) -> f64 {
        let after = sys.state.rod.rest.get(i).copied().unwrap_or(f64::INFINITY);
        let before = if i > 0 {
            sys.state.rod.rest[i - 1]
        } else {
            f64::INFINITY
        };
        let h = after.min(before);
        let stiffness = sys.model.section.ea / h + 4.0 * sys.model.section.ei / (h * h * h);
        16.0 * f64::EPSILON * sys.state.rod.x[i].norm().max(h) * stiffness
    }

    pub(super) fn holds(&self, sys: &System, tolerance: f64) -> bool {
        let forces = (0..sys.state.rod.nodes()).all(|i| {
            let limit = tolerance * self.force + Self::noise(sys, i);
            (0..3).all(|a| held(sys, i, a) || sys.state.load.force[i][a].abs() <= limit)
        });
        let torques = (0..sys.state.rod.edges()).all(|j| {
            let noise = 64.0 * f64::EPSILON * sys.model.section.gj / sys.state.rod.rest[j];
            !sys.model.twist.is_carried()
                || sys.state.load.torque[j].abs() <= tolerance * self.moment + noise
        });
        forces && torques
    }

    /// Size of the loads, N.
    pub(super) fn load(&self) -> f64 {
        self.force
    }

    /// Largest force out of balance over the load.
    pub(super) fn worst(&self, sys: &System) -> f64 {
        let worst = Self::largest(sys);
        if self.force > 0.0 {
            worst / self.force
        } else {
            worst
        }
    }

    /// Largest force out of balance along an axis that is not held, N.
    pub(super) fn largest(sys: &System) -> f64 {
        let mut worst = 0.0_f64;
        for i in 0..sys.state.rod.nodes() {
            for a in 0..3 {
                if !held(sys, i, a) {
                    worst = worst.max(sys.state.load.force[i][a].abs());
                }
            }
        }
        worst
    }
}
