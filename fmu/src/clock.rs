//! Communication points, kept in the importer's own numbers so that rounding never adds up.

use crate::error::TimeError;
use serde::{Deserialize, Serialize};

/// Share of the larger of time and step by which two communication points may differ.
///
/// Chosen: importers add steps up or multiply them, and some round to nanoseconds.
const TOLERANCE: f64 = 1e-9;

/// Shortest step, s. Chosen: steps below a nanosecond only add up, and inputs that change in one as short as this still have rates
/// that squares of them can be taken of.
const SHORTEST: f64 = 1e-18;

/// Start time, stop time and last communication point, s.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Clock {
    start: f64,
    stop: Option<f64>,
    now: f64,
}

impl Clock {
    /// Returns the clock of an experiment from `start` to `stop`, s, at its start.
    ///
    /// # Errors
    ///
    /// If a time is not finite or the stop time is not after the start time.
    pub(crate) fn new(start: f64, stop: Option<f64>) -> Result<Self, TimeError> {
        finite("startTime", start)?;
        if let Some(stop) = stop {
            finite("stopTime", stop)?;
            if stop <= start {
                return Err(TimeError::Backwards { start, stop });
            }
        }
        Ok(Self {
            start,
            stop,
            now: start,
        })
    }

    /// Returns the communication point that the last step ended at, s.
    pub(crate) fn now(&self) -> f64 {
        self.now
    }

    /// Tells whether the experiment has reached its stop time. Without a stop time it always has.
    pub(crate) fn is_over(&self) -> bool {
        self.stop
            .is_none_or(|stop| self.now >= stop - TOLERANCE * stop.abs().max(self.now.abs()))
    }

    /// Tells whether there is a stop time, and the experiment has reached it.
    pub(crate) fn has_reached_stop(&self) -> bool {
        self.stop.is_some() && self.is_over()
    }

    /// Returns the end of a step of `step` from `point`, all in s.
    ///
    /// # Errors
    ///
    /// If the step does not begin at the last communication point, is not above 0, is lost in
    /// rounding, is too short or ends after the stop time.
    pub(crate) fn end_of(&self, point: f64, step: f64) -> Result<f64, TimeError> {
        finite("currentCommunicationPoint", point)?;
        finite("communicationStepSize", step)?;
        if step <= 0.0 {
            return Err(TimeError::NoStep { step });
        }
        if (point - self.now).abs() > tolerance(point, self.now, step) {
            return Err(TimeError::Elsewhere {
                given: point,
                expected: self.now,
            });
        }
        let end = point + step;
        if end <= point {
            return Err(TimeError::TooSmall { step, time: point });
        }
        if step < SHORTEST {
            let shortest = SHORTEST;
            return Err(TimeError::TooShort { step, shortest });
        }
        match self.stop {
            Some(stop) if end - stop > tolerance(end, stop, step) => {
                Err(TimeError::PastStop { end, stop })
            }
            _ => Ok(end),
        }
    }

    /// Tells whether the constructor could have made these times. Decoded bytes may hold anything.
    pub(crate) fn is_sound(&self) -> bool {
        let sound = Self::new(self.start, self.stop).is_ok() || *self == Self::default();
        sound && self.now.is_finite()
    }

    /// Sets the communication point to the importer's number for the end of a step, s.
    pub(crate) fn set(&mut self, end: f64) {
        self.now = end;
    }

    /// Returns the time of the experiment, s, when `simulated` s have passed since its start.
    pub(crate) fn experiment_time(&self, simulated: f64) -> f64 {
        self.start + simulated
    }
}

/// Returns the allowed difference of two times, s. More than half a step would let an importer skip
/// a step.
fn tolerance(a: f64, b: f64, step: f64) -> f64 {
    (TOLERANCE * a.abs().max(b.abs()).max(step)).min(0.5 * step)
}

fn finite(what: &'static str, value: f64) -> Result<(), TimeError> {
    if value.is_finite() {
        Ok(())
    } else {
        Err(TimeError::NotFinite { what, value })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_may_be_added_up_or_multiplied() {
        let (step, mut added) = (0.1, 2.5);
        let mut clock = Clock::new(2.5, Some(2.5 + 1000.0 * step)).expect("valid");
        for k in 0..1000 {
            let point = if k % 2 == 0 {
                added
            } else {
                2.5 + f64::from(k) * step
            };
            let end = clock.end_of(point, step).expect("same point");
            clock.set(end);
            added += step;
        }
        assert!(clock.end_of(added, step).is_err(), "stop time is reached");
    }

    /// However an importer counts, a million steps end at the stop time and none is refused.
    #[test]
    fn a_million_steps_lead_to_the_stop_time() {
        const STEPS: u32 = 1_000_000;
        for step in [1e-6, 1e-4, 1.0 / 3.0] {
            let stop = 0.7 + f64::from(STEPS) * step;
            for multiplies in [true, false] {
                let mut clock = Clock::new(0.7, Some(stop)).expect("valid");
                let mut added = 0.7;
                for k in 0..STEPS {
                    let product = 0.7 + f64::from(k) * step;
                    let point = if multiplies { product } else { added };
                    clock.set(clock.end_of(point, step).expect("a step"));
                    added += step;
                }
                assert!(clock.is_over());
                assert!((clock.now() - stop).abs() < 1e-9 * stop);
            }
        }
    }

    #[test]
    fn senseless_steps_are_named() {
        let clock = Clock::new(1.0, Some(2.0)).expect("valid");
        let error = |point, step| clock.end_of(point, step).expect_err("refused");
        assert_eq!(error(1.0, 0.0), TimeError::NoStep { step: 0.0 });
        assert_eq!(error(1.0, -0.1), TimeError::NoStep { step: -0.1 });
        assert_eq!(
            error(1.5, 0.1),
            TimeError::Elsewhere {
                given: 1.5,
                expected: 1.0
            }
        );
        assert_eq!(
            error(1.0, 1e-20),
            TimeError::TooSmall {
                step: 1e-20,
                time: 1.0
            }
        );
        // at the time 0 nothing is lost in rounding
        let at_zero = Clock::new(0.0, None).expect("valid");
        for step in [5e-324, 1e-300, 1e-20] {
            let refused = at_zero.end_of(0.0, step).expect_err("too short");
            assert!(refused.to_string().contains("1e-18 s or more"), "{refused}");
        }
        assert_eq!(at_zero.end_of(0.0, 1e-18), Ok(1e-18));
        assert!(matches!(error(1.0, 1.1), TimeError::PastStop { .. }));
        assert!(matches!(error(f64::NAN, 0.1), TimeError::NotFinite { .. }));
        assert!(matches!(
            error(1.0, f64::INFINITY),
            TimeError::NotFinite { .. }
        ));
        assert_eq!(clock.end_of(1.0, 1.0), Ok(2.0));
        assert_eq!(clock.end_of(1.0 + 1e-10, 1.0), Ok(2.0 + 1e-10));
    }

    #[test]
    fn a_point_one_small_step_off_is_elsewhere() {
        let mut clock = Clock::new(0.0, None).expect("valid");
        clock.set(1e4);
        let step = 1e-6;
        assert!(matches!(
            clock.end_of(1e4 + step, step),
            Err(TimeError::Elsewhere { .. })
        ));
    }

    #[test]
    fn an_experiment_is_over_at_its_stop_time() {
        let mut clock = Clock::new(1.0, Some(2.0)).expect("valid");
        assert!(!clock.is_over());
        clock.set(2.0 - 1e-6);
        assert!(!clock.is_over());
        clock.set(1.0 + 10.0 * 0.1);
        assert!(clock.is_over());
        assert!(clock.has_reached_stop());
        assert!(Clock::default().is_over() && !Clock::default().has_reached_stop());
    }

    #[test]
    fn experiments_run_forwards() {
        assert_eq!(
            Clock::new(1.0, Some(1.0)),
            Err(TimeError::Backwards {
                start: 1.0,
                stop: 1.0
            })
        );
        assert!(Clock::new(f64::NAN, None).is_err());
        assert!(Clock::new(0.0, Some(f64::INFINITY)).is_err());
    }
}
