//! Force of one touch of a node: spring, dashpot and stick-slip friction.
//!
//! Normal: `N = k h + c h'` for the wire length that the node stands for. The dashpot `c` is chosen so that a
//! free node rebounds with the stated restitution; the paper's eq. 7 has none and rebounds fully.
//! Tangential: a spring from an anchor in the core frame, the bristle, with a dashpot of its own, cut off
//! at `mu N`. The coefficient falls from static to kinetic with the slip speed and not with the slip per
//! step, so that the law does not depend on the step.

use crate::contact::law::{ContactLaw, TANGENTIAL_SHARE};
use crate::math::V3;

/// Force of one touch of a node and the energy it dissipates, core frame.
#[derive(Clone, Copy, Debug)]
pub struct TouchForce {
    /// force on the node, N
    pub force: V3,
    /// bristle stretch after the cut-off, m
    pub bristle: V3,
    /// slip that the cut-off let go, m
    pub slip: V3,
    /// friction force on the node, N
    pub friction: V3,
    /// damping power: normal and tangential dashpots, W
    pub damping: f64,
}

impl ContactLaw {
    /// Energy stored in a touch of `depth` (m) and `bristle` stretch (m) over `length` (m) of wire, J.
    pub fn stored(&self, depth: f64, bristle: V3, length: f64) -> f64 {
        0.5 * self.stiffness * length * (depth * depth + TANGENTIAL_SHARE * bristle.norm_squared())
    }

    /// Force of a touch on a node of mass `mass` (kg) that stands for `length` (m) of wire.
    ///
    /// `normal` is the unit vector from the surface to the node and `depth` > 0 (m). `velocity` (m/s) is relative to
    /// the surface, `bristle` (m) the node's position relative to its anchor. All vectors are in the core frame.
    #[inline]
    pub fn force(
        &self,
        normal: V3,
        depth: f64,
        velocity: V3,
        bristle: V3,
        length: f64,
        mass: f64,
    ) -> TouchForce {
        let k = self.stiffness * length;
        let c = 2.0 * self.damping_ratio * (k * mass).sqrt();
        let rate = -velocity.dot(&normal);
        let push = k * depth + c * rate;
        let slide = velocity + normal * rate;
        let mut stretch = bristle - normal * bristle.dot(&normal);
        let kt = k * TANGENTIAL_SHARE;
        let ct = 2.0 * self.damping_ratio * (kt * mass).sqrt();
        let mut friction = -(stretch * kt + slide * ct);
        let limit = self.mu(slide.norm()) * push.max(0.0);
        let size = friction.norm();
        let mut slip = V3::zeros();
        let mut damping = c * rate * rate;
        if size > limit {
            friction *= limit / size;
            let kept = friction * (-1.0 / kt);
            slip = stretch - kept;
            stretch = kept;
        } else {
            damping += ct * slide.norm_squared();
        }
        TouchForce {
            force: normal * push + friction,
            bristle: stretch,
            slip,
            friction,
            damping,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::law::damping_for_restitution;

    fn law() -> ContactLaw {
        ContactLaw {
            stiffness: 1e10,
            damping_ratio: damping_for_restitution(0.5),
            mu_static: 0.23,
            mu_kinetic: 0.17,
            slip_speed: 0.01,
        }
    }

    #[test]
    fn the_paper_law_is_singular_and_fully_elastic_ours_is_not() {
        assert!((damping_for_restitution(1.0)).abs() < 1e-15);
        let z = damping_for_restitution(0.5);
        let e = (-std::f64::consts::PI * z / (1.0 - z * z).sqrt()).exp();
        assert!((e - 0.5).abs() < 1e-12);
        let f = law().force(V3::y(), 1e-6, V3::zeros(), V3::zeros(), 1e-3, 3e-6);
        assert!((f.force - V3::new(0.0, 10.0, 0.0)).norm() < 1e-12);
    }

    #[test]
    fn friction_stays_inside_its_cone_and_opposes_the_slide() {
        let l = law();
        for speed in [0.0, 1e-3, 1e-2, 1.0] {
            let f = l.force(
                V3::y(),
                2e-6,
                V3::new(speed, 0.0, 0.0),
                V3::new(1e-4, 0.0, 0.0),
                1e-3,
                3e-6,
            );
            let mu = l.mu(speed);
            assert!((f.friction.norm() - mu * 20.0).abs() < 1e-9 && f.friction.x < 0.0);
            assert!(
                f.slip.x > 0.0 && (f.slip + f.bristle - V3::new(1e-4, 0.0, 0.0)).norm() < 1e-18
            );
        }
        assert!((l.mu(0.0) - 0.23).abs() < 1e-15 && (l.mu(1.0) - 0.17).abs() < 1e-15);
    }

    #[test]
    fn sticking_force_is_minus_the_energy_gradient() {
        let l = law();
        let (n, length) = (V3::new(0.6, 0.8, 0.0), 5e-4);
        let (depth, b) = (1e-6, V3::new(0.8e-7, -0.6e-7, 0.5e-7));
        let f = l.force(n, depth, V3::zeros(), b, length, 1.7e-6);
        let e = |d: V3| {
            let t = b + d;
            l.stored(depth - d.dot(&n), t - n * t.dot(&n), length)
        };
        let h = 1e-10;
        for a in [V3::x(), V3::y(), V3::z()] {
            let de = (e(a * h) - e(a * -h)) / (2.0 * h);
            assert!((de + f.force.dot(&a)).abs() < 1e-6 * f.force.norm());
        }
    }
}
