//! How the line gives way to tension above yield: its wire gets longer, and that takes work.
//!
//! Each part of the line yields from the largest tension on that it has seen. What all parts have got longer by when the line
//! pulls by `T` is a chain of straight pieces.
//!
//! ```text
//! longer(T) = sum of compliance_i max(0, T - T_i)      compliance: length of the part over the wire's hardening
//! ```

/// Most tensions that a step tells apart; parts that yield from a higher one on count as yielding from the last.
pub const MOST_LEVELS: usize = 4;

/// The tensions at which more of the line begins to yield.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LineYield {
    /// tension, N, and compliance, m/N, in order of the tension
    levels: [[f64; 2]; MOST_LEVELS],
    count: usize,
}

impl LineYield {
    /// Adds a part that yields from `tension`, N, on; no part before it yields later.
    pub fn push(&mut self, tension: f64, compliance: f64) {
        let last = self.count.checked_sub(1);
        let is_one = |last: usize| self.levels[last][0] >= tension || self.count == MOST_LEVELS;
        if let Some(last) = last.filter(|last| is_one(*last)) {
            self.levels[last][1] += compliance;
        } else {
            self.levels[self.count] = [tension, compliance];
            self.count += 1;
        }
    }

    /// Tension, N, and compliance, m/N, of each part, in order of the tension.
    pub fn levels(&self) -> &[[f64; 2]] {
        &self.levels[..self.count]
    }

    /// By how much the line gets longer under a tension, m.
    pub fn longer(&self, tension: f64) -> f64 {
        let of = |level: &[f64; 2]| level[1] * (tension - level[0]).max(0.0);
        self.levels().iter().map(of).sum()
    }

    /// Tension of a line that would pull by `elastic`, N, if nothing yielded, and by `slope`, N/m, less were it longer; and what is
    /// left of that slope.
    pub fn tension(&self, elastic: f64, slope: f64) -> [f64; 2] {
        let (mut tension, mut left) = (elastic, 1.0);
        let mut compliance = 0.0;
        for level in self.levels() {
            if tension <= level[0] {
                break;
            }
            // what lies beyond this level is shared with one more part
            let before = left;
            compliance += level[1];
            left = 1.0 / (1.0 + slope * compliance);
            tension = level[0] + (tension - level[0]) * (left / before);
        }
        [tension, left * slope]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parts() -> LineYield {
        let mut parts = LineYield::default();
        for (tension, compliance) in [(38.0, 1e-4), (41.0, 3e-4), (50.0, 2e-4)] {
            parts.push(tension, compliance);
        }
        parts
    }

    #[test]
    fn elastic_and_plastic_way_add_up() {
        let (parts, slope) = (parts(), 97_800.0);
        for elastic in [10.0, 37.9, 39.0, 200.0, 400.0, 4000.0] {
            let [tension, left] = parts.tension(elastic, slope);
            let elastic_again = tension + slope * parts.longer(tension);
            assert!((elastic_again / elastic - 1.0).abs() < 1e-12, "{elastic}");
            let h = 1e-6 * elastic;
            let rise = (parts.tension(elastic + h, slope)[0] - tension) / h;
            assert!(
                (rise * slope / left - 1.0).abs() < 1e-6,
                "{elastic}: {rise}"
            );
        }
        assert_eq!(LineYield::default().tension(60.0, slope), [60.0, slope]);
    }

    #[test]
    fn more_parts_than_levels_yield_with_the_last() {
        let mut parts = parts();
        for tension in [55.0, 60.0] {
            parts.push(tension, 1e-4);
        }
        assert_eq!(parts.levels().len(), MOST_LEVELS);
        assert_eq!(parts.levels()[MOST_LEVELS - 1], [55.0, 2e-4]);
    }
}
