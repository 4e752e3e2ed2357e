//! Runs of stations above a limit, with hysteresis and a least length.

use super::STATIONS_PER_TURN;

/// Share of the limit below which a run ends. Between this and the limit a run goes on but does
/// not grow, so a value that wavers about the limit makes one run and not many. Chosen.
const RELEASE: f64 = 0.8;

/// Fraction of a turn that a bulge or an overlap must cover before its flag rises: 8 degrees.
///
/// Chosen: a noisy node 0.4 mm from its neighbours, 6 mm from the axis, reaches over 7.6 degrees.
/// The shortest place for a wire to ride up, a 2 mm corner of the 12 x 30 mm core, reaches over 11.
pub(crate) const SHORT_RUN: f64 = 8.0 / STATIONS_PER_TURN as f64;

/// A run of neighbouring stations above a limit, as it stands after the last station.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Run {
    /// stations of the run above the limit; 0: no run
    above: u32,
}

impl Run {
    /// The run after one more station; `None` (nothing to measure there) ends it.
    pub(crate) fn next(self, value: Option<f64>, limit: f64) -> Self {
        let above = match value {
            Some(value) if value > limit => self.above + 1,
            Some(value) if value > RELEASE * limit => self.above,
            _ => 0,
        };
        Self { above }
    }

    /// Length as a fraction of a turn.
    pub(crate) fn fraction(self) -> f64 {
        f64::from(self.above) / STATIONS_PER_TURN as f64
    }

    /// True once the run covers `least` stations.
    pub(crate) fn counts(self, least: u32) -> bool {
        self.above >= least
    }
}

/// Stations a run needs to cover `fraction` of a turn, at least one.
pub(crate) fn stations_for(fraction: f64) -> u32 {
    // A tenth of 360 must be 36 although 0.1 is not a tenth in binary.
    ((fraction * STATIONS_PER_TURN as f64 - 1e-9).ceil() as u32).max(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn longest(values: &[Option<f64>]) -> u32 {
        let mut run = Run::default();
        values.iter().fold(0, |most, &value| {
            run = run.next(value, 1.0);
            most.max(run.above)
        })
    }

    #[test]
    fn wavering_is_one_run_and_counts_only_what_is_above() {
        assert_eq!(
            longest(&[Some(1.1), Some(0.9), Some(1.1), Some(0.85), Some(1.2)]),
            3
        );
        assert_eq!(longest(&[Some(1.1), Some(0.7), Some(1.1)]), 1);
        assert_eq!(longest(&[Some(0.9); 50]), 0);
        assert_eq!(longest(&[Some(2.0), None, Some(2.0)]), 1);
        assert_eq!(longest(&[Some(2.0), Some(f64::NAN), Some(2.0)]), 1);
    }

    #[test]
    fn a_fraction_is_reached_by_its_number_of_stations() {
        assert_eq!(stations_for(0.1), 36);
        assert_eq!(stations_for(0.0), 1);
        assert_eq!(stations_for(0.0101), 4);
        assert!(Run { above: 36 }.counts(stations_for(0.1)));
        assert!((Run { above: 36 }.fraction() - 0.1).abs() < 1e-15);
    }
}
