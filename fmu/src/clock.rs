//! Communication points: the importer's time, which nobody else may drift from.

use serde::{Deserialize, Serialize};

/// Share of the larger of time and step by which two communication points may differ; importers
/// add steps up or multiply them, and some round to nanoseconds.
const TOLERANCE: f64 = 1e-9;

/// A time or step that makes no sense, times in s.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub(crate) enum TimeError {
    /// NaN or infinite
    #[error("{what} = {value} is not a finite number")]
    NotFinite {
        /// name of the argument
        what: &'static str,
        /// as given
        value: f64,
    },
    /// the experiment ends before it starts
    #[error("stopTime = {stop} s is not after startTime = {start} s")]
    Backwards {
        /// startTime
        start: f64,
        /// stopTime
        stop: f64,
    },
    /// zero or negative
    #[error("communicationStepSize = {step} s must be above 0")]
    NoStep {
        /// communicationStepSize
        step: f64,
    },
    /// time plus step is time
    #[error("communicationStepSize = {step} s is lost in rounding at {time} s")]
    TooSmall {
        /// communicationStepSize
        step: f64,
        /// currentCommunicationPoint
        time: f64,
    },
    /// not where the last step ended
    #[error("currentCommunicationPoint = {given} s, but the last step ended at {expected} s")]
    Elsewhere {
        /// currentCommunicationPoint
        given: f64,
        /// end of the last step
        expected: f64,
    },
    /// the experiment is over
    #[error("step would end at {end} s, after stopTime = {stop} s")]
    PastStop {
        /// end of the step
        end: f64,
        /// stopTime
        stop: f64,
    },
}

/// Start, stop and last communication point, s.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Clock {
    start: f64,
    stop: Option<f64>,
    now: f64,
}

impl Clock {
    /// Experiment from `start` to `stop`, if there is an end.
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

    /// The communication point that the last step ended at.
    pub(crate) fn now(&self) -> f64 {
        self.now
    }

    /// Whether the experiment has reached its stop time; without one, at any time.
    pub(crate) fn is_over(&self) -> bool {
        self.stop
            .is_none_or(|stop| self.now >= stop - TOLERANCE * stop.abs().max(self.now.abs()))
    }

    /// End of a step of `step` from `point`, or why it cannot be taken.
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
        match self.stop {
            Some(stop) if end - stop > tolerance(end, stop, step) => {
                Err(TimeError::PastStop { end, stop })
            }
            _ => Ok(end),
        }
    }

    /// Whether times are what the constructor lets pass; bytes from elsewhere may hold anything.
    pub(crate) fn is_sound(&self) -> bool {
        let sound = Self::new(self.start, self.stop).is_ok() || *self == Self::default();
        sound && self.now.is_finite()
    }

    /// Takes over the importer's number for the end of a step, so that its rounding and ours
    /// never add up.
    pub(crate) fn set(&mut self, end: f64) {
        self.now = end;
    }

    /// Time of the experiment when `simulated` seconds have passed since its start.
    pub(crate) fn experiment_time(&self, simulated: f64) -> f64 {
        self.start + simulated
    }
}

/// Allowed difference of two times, s; never more than half a step, or a step could be skipped.
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
        assert!(Clock::default().is_over());
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
