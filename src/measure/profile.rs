//! Height of the wire over the core when it is wound without inertia.

use std::f64::consts::TAU;

/// Quasi-static height of the wire over the core by polar angle.
///
/// A stiff wire stands off a flat face even when it is wound slowly. Only the height that a fast
/// run adds is a defect.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    heights: Vec<f64>,
}

impl Profile {
    /// From heights in m at equal polar angles `k 2 pi / n` from +x, one turn, periodic.
    ///
    /// `None` for no values or one that is not finite.
    pub fn new(heights: Vec<f64>) -> Option<Self> {
        (!heights.is_empty() && heights.iter().all(|h| h.is_finite())).then_some(Self { heights })
    }

    /// Height at a polar angle (rad, any turn), linear between values, m.
    pub fn at(&self, angle: f64) -> f64 {
        let n = self.heights.len();
        let place = (angle / TAU).rem_euclid(1.0) * n as f64;
        // Rounding may put the place on n itself; the modulo brings it home.
        let low = place.floor() as usize % n;
        let share = place - place.floor();
        self.heights[low] + share * (self.heights[(low + 1) % n] - self.heights[low])
    }

    /// The values at equal polar angles, m.
    pub fn heights(&self) -> &[f64] {
        &self.heights
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_linear_between_values_and_periodic() {
        let profile = Profile::new(vec![0.0, 1.0, 4.0, 1.0]).unwrap();
        let quarter = TAU / 4.0;
        for turn in 0..3 {
            let start = f64::from(turn) * TAU;
            assert!((profile.at(start + quarter) - 1.0).abs() < 1e-12);
            assert!((profile.at(start + 1.5 * quarter) - 2.5).abs() < 1e-12);
            assert!((profile.at(start + 3.5 * quarter) - 0.5).abs() < 1e-12);
        }
        assert!((profile.at(-quarter) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn refuses_what_is_no_profile() {
        assert_eq!(Profile::new(vec![]), None);
        assert_eq!(Profile::new(vec![0.0, f64::NAN]), None);
    }
}
