//! Parameters of contact and friction, and the smooth normal law of the production method.

use serde::{Deserialize, Serialize};

/// Tangential over normal contact stiffness of equal bodies, `2(1 - nu)/(2 - nu)` (Mindlin 1949),
/// for copper, nu = 0.34.
pub(super) const TANGENTIAL_SHARE: f64 = 2.0 * (1.0 - 0.34) / (2.0 - 0.34);

/// Parameters of contact and friction, per length of wire.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactLaw {
    /// line load per depth, N/m^2
    pub stiffness: f64,
    /// damping ratio of a free node on the contact spring (nodal contact only)
    pub damping_ratio: f64,
    /// static friction coefficient
    pub mu_static: f64,
    /// kinetic friction coefficient
    pub mu_kinetic: f64,
    /// slip speed over which static turns into kinetic, m/s
    pub slip_speed: f64,
}

impl ContactLaw {
    /// Friction coefficient at a slip speed (m/s): `mu_k + (mu_s - mu_k) exp(-(v / v_s)^2)`.
    #[inline]
    pub fn mu(&self, speed: f64) -> f64 {
        let rise = self.mu_static - self.mu_kinetic;
        if rise == 0.0 {
            return self.mu_kinetic;
        }
        let s = speed / self.slip_speed;
        if s > 6.0 {
            self.mu_kinetic
        } else {
            self.mu_kinetic + rise * libm::exp(-s * s)
        }
    }
}

/// Damping ratio at which a mass on a linear spring and dashpot rebounds with restitution `e` (0 < e <= 1);
/// 1, the critical one, at `e` = 0.
pub fn damping_for_restitution(e: f64) -> f64 {
    if e <= 0.0 {
        return 1.0;
    }
    let l = -libm::log(e);
    l / (std::f64::consts::PI * std::f64::consts::PI + l * l).sqrt()
}

/// Running totals of the energy that contact dissipated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactLoss {
    /// slip against friction, J
    pub friction: f64,
    /// dashpots of contact and landings, J
    pub damping: f64,
}

/// The normal law at a depth, over the contact stiffness k (N/m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct NormalLaw {
    /// energy / k, m^2
    pub(super) energy: f64,
    /// force / k, m
    pub(super) force: f64,
    /// stiffness / k
    pub(super) stiffness: f64,
}

impl NormalLaw {
    /// The force is quadratic up to the depth `onset`, then linear.
    #[inline]
    pub(super) fn at(depth: f64, onset: f64) -> Self {
        if depth < onset {
            let s = depth / onset;
            Self {
                energy: s * depth * depth / 6.0,
                force: 0.5 * s * depth,
                stiffness: s,
            }
        } else {
            Self {
                energy: 0.5 * depth * depth - 0.5 * depth * onset + onset * onset / 6.0,
                force: depth - 0.5 * onset,
                stiffness: 1.0,
            }
        }
    }
}

/// Work over stiffness (m^2) that a touch does beyond the `energy` it stores, if it acts at one end of a step
/// only and the energy balance takes half its `force` over the `way` (m).
///
/// [`LineContact::commit`](super::LineContact::commit) says when this is the case.
#[inline]
pub(super) fn work_beyond_stored(force: f64, energy: f64, way: f64) -> f64 {
    0.5 * force * way - energy
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Force and stiffness are the derivatives of energy and force, and the force never pulls.
    #[test]
    fn normal_law_is_a_family() {
        let onset = 1e-6;
        for i in 1..400 {
            let depth = 1.37e-8 * f64::from(i) * (1.0 + 0.01 * f64::from(i));
            let h = 1e-12;
            let here = NormalLaw::at(depth, onset);
            let (a, b) = (
                NormalLaw::at(depth - h, onset),
                NormalLaw::at(depth + h, onset),
            );
            assert!(here.energy >= 0.0 && here.force >= 0.0 && here.stiffness >= 0.0);
            let slope = (b.energy - a.energy) / (2.0 * h);
            assert!((slope - here.force).abs() < 1e-4 * onset);
            let slope = (b.force - a.force) / (2.0 * h);
            assert!((slope - here.stiffness).abs() < 1e-4);
        }
    }
}
