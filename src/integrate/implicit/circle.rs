//! Updates of Newton's method that go round in a circle.

/// Full updates in a row, each as large as the one before, that make a circle.
const REPEATS: usize = 2;
/// How far the sizes of two updates may be apart to count as the same, as a share.
const ALIKE: f64 = 0.1;

/// Looks for updates that no longer shrink: a whole flat that lets go and is caught again, time after time. A shorter step finds
/// the way, and all further updates of this one are in vain.
#[derive(Clone, Copy, Debug)]
pub(super) struct Circle {
    last: f64,
    repeats: usize,
}

impl Circle {
    /// No update yet.
    pub(super) const NEW: Self = Self {
        last: f64::INFINITY,
        repeats: 0,
    };

    /// Whether an update of this size, m, which was taken in full or not, closes a circle.
    pub(super) fn closes(&mut self, update: f64, full: bool) -> bool {
        let alike = full && (update - self.last).abs() < ALIKE * self.last;
        self.repeats = if alike { self.repeats + 1 } else { 0 };
        self.last = if full { update } else { f64::INFINITY };
        self.repeats >= REPEATS
    }
}

#[cfg(test)]
mod tests {
    use super::Circle;

    fn closes_at(updates: &[f64]) -> Option<usize> {
        let mut circle = Circle::NEW;
        updates.iter().position(|u| circle.closes(*u, true))
    }

    /// Twelve updates of one size were gone through with all their looks ahead before the solve gave up.
    #[test]
    fn updates_of_one_size_are_given_up() {
        assert_eq!(
            closes_at(&[4.5e-5, 9.9e-5, 9.8e-5, 9.8e-5, 9.8e-5]),
            Some(3)
        );
        assert_eq!(closes_at(&[1.5e-5, 4.5e-5, 4.4e-5, 4.7e-5]), Some(3));
    }

    #[test]
    fn updates_that_shrink_or_swing_go_on() {
        assert_eq!(closes_at(&[7e-6, 2e-7, 3e-9]), None);
        assert_eq!(closes_at(&[9e-6, 7e-6, 5.6e-6, 4.4e-6]), None);
        assert_eq!(closes_at(&[1.4e-5, 1.3e-5, 3.1e-5, 2.9e-5, 4e-6]), None);
    }

    /// Updates that a bound cuts to one length still lead somewhere.
    #[test]
    fn updates_cut_short_go_on() {
        let mut circle = Circle::NEW;
        assert!((0..9).all(|_| !circle.closes(1e-3, false)));
        assert!(!circle.closes(1e-3, true));
    }
}
