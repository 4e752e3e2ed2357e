//! Penalty contact and stick-slip friction of one touching point.
//!
//! Normal: `N = k h + c h'` per the wire length the node stands for; the dashpot is chosen so
//! that a free node rebounds with the stated restitution (the paper's eq. 7 has none and
//! rebounds fully). Tangential: a spring from an anchor in the core frame (bristle) with its own
//! dashpot, cut off at `mu N`. The coefficient falls from static to kinetic with the slip speed,
//! not with the slip per step, so that the law does not depend on the step.

use crate::math::V3;

/// Tangential over normal contact stiffness of equal bodies, `2(1 - nu)/(2 - nu)` (Mindlin 1949),
/// for copper, nu = 0.34.
pub(super) const TANGENTIAL_SHARE: f64 = 2.0 * (1.0 - 0.34) / (2.0 - 0.34);

/// Contact parameters, per length of wire.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactLaw {
    /// line load per depth, N/m^2
    pub stiffness: f64,
    /// damping ratio of a free node on the contact spring
    pub damping_ratio: f64,
    /// static friction coefficient
    pub mu_static: f64,
    /// kinetic friction coefficient
    pub mu_kinetic: f64,
    /// slip speed over which static turns into kinetic, m/s
    pub slip_speed: f64,
}

/// Damping ratio at which a linear spring and dashpot rebounds by `e` (0 < e <= 1); critical at 0.
pub fn damping_for_restitution(e: f64) -> f64 {
    if e <= 0.0 {
        return 1.0;
    }
    let l = -libm::log(e);
    l / (std::f64::consts::PI * std::f64::consts::PI + l * l).sqrt()
}

/// Force of one touch and what it costs.
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
    /// Friction coefficient at a slip speed, m/s.
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

    /// Stored energy of a touch over `length` of wire, J.
    pub fn stored(&self, depth: f64, bristle: V3, length: f64) -> f64 {
        0.5 * self.stiffness * length * (depth * depth + TANGENTIAL_SHARE * bristle.norm_squared())
    }

    /// Force on a node of mass `mass` that stands for `length` of wire.
    ///
    /// `normal` points from the surface to the node, `depth` > 0, `velocity` is relative to the
    /// surface, `bristle` the node's position relative to its anchor; all in the core frame.
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
