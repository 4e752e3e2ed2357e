//! Height of the wire over the core when it is wound without inertia.

use std::f64::consts::TAU;

/// Quasi-static height of the wire over the core by polar angle and, on a core that tapers, by the place along its axis.
///
/// A stiff wire stands off a flat face even when it is wound slowly. Only the height that a fast
/// run adds is a defect.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// by rising y, m; at least one
    levels: Vec<(f64, Level)>,
}

/// Heights at one place along the axis, m, at equal polar angles.
#[derive(Clone, Debug, PartialEq)]
struct Level(Vec<f64>);

impl Level {
    /// Height at a polar angle (rad, any turn), linear between values, m.
    fn at(&self, angle: f64) -> f64 {
        let n = self.0.len();
        let place = (angle / TAU).rem_euclid(1.0) * n as f64;
        // Rounding may put the place on n itself; the modulo brings it home.
        let low = place.floor() as usize % n;
        let share = place - place.floor();
        self.0[low] + share * (self.0[(low + 1) % n] - self.0[low])
    }
}

impl Profile {
    /// From heights in m at equal polar angles `k 2 pi / n` from +x, one turn, periodic; the same all along the core.
    ///
    /// `None` for no values or one that is not finite.
    pub fn new(heights: Vec<f64>) -> Option<Self> {
        let is_known = !heights.is_empty() && heights.iter().all(|h| h.is_finite());
        is_known.then(|| Self {
            levels: vec![(0.0, Level(heights))],
        })
    }

    /// From profiles of one level each at places along y that rise, m; linear between them, and held beyond.
    ///
    /// `None` for no profiles or places that do not rise.
    pub(crate) fn along(levels: Vec<(f64, Self)>) -> Option<Self> {
        let rises = levels.windows(2).all(|pair| pair[0].0 < pair[1].0);
        let levels: Vec<_> = levels
            .into_iter()
            .filter_map(|(y, profile)| Some((y, profile.levels.into_iter().next()?.1)))
            .collect();
        (rises && !levels.is_empty()).then_some(Self { levels })
    }

    /// Height at a polar angle (rad, any turn) and a place along the axis, m, linear between values, m.
    pub fn at(&self, angle: f64, y: f64) -> f64 {
        let above = self.levels.partition_point(|(level, _)| *level < y);
        let [low, high] =
            [above.saturating_sub(1), above].map(|k| &self.levels[k.min(self.levels.len() - 1)]);
        let from = low.1.at(angle);
        if low.0 == high.0 {
            return from;
        }
        from + (y - low.0) / (high.0 - low.0) * (high.1.at(angle) - from)
    }

    /// The largest height, m.
    pub fn highest(&self) -> f64 {
        let all = self.levels.iter().flat_map(|(_, level)| &level.0);
        all.copied().fold(0.0, f64::max)
    }

    /// The values at equal polar angles, m, at the lowest of its levels.
    pub fn heights(&self) -> &[f64] {
        &self.levels[0].1.0
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
            assert!((profile.at(start + quarter, 0.0) - 1.0).abs() < 1e-12);
            assert!((profile.at(start + 1.5 * quarter, 1.0) - 2.5).abs() < 1e-12);
            assert!((profile.at(start + 3.5 * quarter, -1.0) - 0.5).abs() < 1e-12);
        }
        assert!((profile.at(-quarter, 0.0) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn is_linear_between_levels_and_held_beyond() {
        let flat = |height: f64| Profile::new(vec![height, height + 1.0]).unwrap();
        let profile = Profile::along(vec![(-1.0, flat(0.0)), (0.0, flat(2.0)), (3.0, flat(5.0))]);
        let profile = profile.unwrap();
        for (y, height) in [
            (-2.0, 0.0),
            (-1.0, 0.0),
            (-0.5, 1.0),
            (0.0, 2.0),
            (1.0, 3.0),
            (9.0, 5.0),
        ] {
            assert!((profile.at(0.0, y) - height).abs() < 1e-12, "{y}");
            assert!(
                (profile.at(0.5 * TAU, y) - height - 1.0).abs() < 1e-12,
                "{y}"
            );
        }
        assert_eq!(profile.highest(), 6.0);
        assert_eq!(
            Profile::along(vec![(0.0, flat(0.0)), (0.0, flat(1.0))]),
            None
        );
        assert_eq!(Profile::along(vec![]), None);
    }

    #[test]
    fn refuses_what_is_no_profile() {
        assert_eq!(Profile::new(vec![]), None);
        assert_eq!(Profile::new(vec![0.0, f64::NAN]), None);
    }
}
