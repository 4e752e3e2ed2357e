//! The longest explicit step, from the scene.
//!
//! Gershgorin on the grid's worst pattern: a zig-zag of nodes `h` apart. Axial `4 EA / (rho A h^2)`,
//! bending `16 EI / (rho A h^4)`, torsion `4 GJ / (rho I h^2)` with the cylinder's inertia about
//! its axis; contact adds its stiffness per mass to whichever translation it acts on.

use crate::rod::Section;

/// Highest angular frequency of a uniform rod of spacing `h` in contact of stiffness `contact`
/// (N/m^2), rad/s.
pub fn highest_frequency(section: &Section, h: f64, contact: f64, twist: bool) -> f64 {
    let m = section.mass_per_length();
    let touch = contact / m;
    let axial = 4.0 * section.ea / (m * h * h) + touch;
    let bending = 16.0 * section.ei / (m * h * h * h * h) + touch;
    let torsion = if twist {
        4.0 * section.gj / (section.spin_inertia_per_length() * h * h)
    } else {
        0.0
    };
    axial.max(bending).max(torsion).sqrt()
}

/// Longest stable step, s: `omega^2 dt^2 + 2 (c/m) dt = limit^2` with the contact dashpot's `c/m = 2 zeta
/// omega_contact`, which sees velocities of half a step before.
pub fn longest_step(
    limit: f64,
    frequency: f64,
    damping_ratio: f64,
    contact: f64,
    section: &Section,
) -> f64 {
    let b = 4.0 * damping_ratio * (contact / section.mass_per_length()).sqrt();
    let w2 = frequency * frequency;
    ((b * b + 4.0 * w2 * limit * limit).sqrt() - b) / (2.0 * w2)
}

/// Stability limits on an undamped oscillation: step times frequency.
pub const VERLET_LIMIT: f64 = 2.0;
/// The same for RK4: `2 sqrt(2)`.
pub const RK4_LIMIT: f64 = 2.828_427_124_746_19;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrate::{Explicit, ExplicitMethod};
    use crate::math::V3;
    use crate::rod::Rod;
    use crate::system::System;

    fn section() -> Section {
        Section::table1_elastic()
    }

    /// Growth of a small zig-zag over many steps at a share of the limit.
    fn growth(method: ExplicitMethod, share: f64, h: f64) -> f64 {
        let s = section();
        let points: Vec<V3> = (0..40).map(|i| V3::new(h * i as f64, 0.0, 0.0)).collect();
        let mut sys = System::new(s.clone(), Rod::through(&points, None));
        for i in 0..40 {
            let sign = if i % 2 == 0 { 1e-4 } else { -1e-4 };
            sys.state.rod.v[i] = V3::new(sign, sign, 0.0);
            if i < 39 {
                sys.state.rod.spin[i] = sign * 1e3;
            }
        }
        let dt = share * method.limit() / highest_frequency(&s, h, 0.0, true);
        sys.evaluate(Some(dt));
        let start = sys.kinetic();
        let mut explicit = Explicit::new(method);
        for _ in 0..4000 {
            explicit.step(&mut sys, dt);
            let k = sys.kinetic();
            if k.is_nan() || k > 1e6 * start {
                return f64::INFINITY;
            }
        }
        sys.kinetic() / start
    }

    #[test]
    fn stable_below_the_limit_and_not_above() {
        for h in [0.5e-3, 1.0e-3] {
            assert!(growth(ExplicitMethod::Verlet, 0.97, h) < 3.0);
            assert!(growth(ExplicitMethod::Verlet, 1.06, h) > 1e3);
            assert!(growth(ExplicitMethod::Rk4, 0.97, h) < 1.01);
            assert!(growth(ExplicitMethod::Rk4, 1.08, h) > 1e3);
        }
    }
}
