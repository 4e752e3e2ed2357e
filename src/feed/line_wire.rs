//! Plastic stretch of the wire between tensioner and nozzle.
//!
//! All wire in the line is as tight as the line. A peak of tension above yield therefore stretches as
//! much wire as the line holds, and what the tensioner lets in afterwards is virgin. Wire near the
//! nozzle has been in the line for longer and has seen every peak that wire behind it has. So the
//! plastic stretch never grows from the nozzle backwards, and its steps are all there is to remember.

use super::line_yield::LineYield;
use crate::rod::{Law, Scalar};
use serde::{Deserialize, Serialize};

/// Share of the line below which two steps of plastic stretch count as one: bounds the memory.
const RESOLUTION: f64 = 1.0 / 64.0;

/// Wire up to a place, m of wire passed, that has this plastic stretch.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Stretch {
    until: f64,
    state: Scalar,
}

/// What the wire behind the nozzle has been through.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LineWire {
    /// from the nozzle backwards, each less stretched than the one before
    stretched: Vec<Stretch>,
    /// state of all wire beyond them: what the present tension makes of virgin wire
    least: Scalar,
    /// what the tension behind the exit makes of virgin wire: friction there stretches wire as it comes out
    exit: Scalar,
}

impl LineWire {
    /// Wire that has seen the tension of this state and never more.
    pub fn at_rest(state: Scalar) -> Self {
        Self {
            stretched: Vec::new(),
            least: state,
            exit: Scalar::default(),
        }
    }

    /// Plastic state of the wire that comes out next once `fed` (m) has passed.
    pub fn next(&self, fed: f64) -> Scalar {
        let here = self.stretched.iter().find(|s| s.until > fed);
        let here = here.map_or(self.least, |s| s.state);
        if self.exit.rise > here.rise {
            self.exit
        } else {
            here
        }
    }

    /// How a line of `length` (m) yields to more tension after `fed` (m) of wire has passed.
    pub fn yields(&self, law: &Law, length: f64, fed: f64) -> LineYield {
        let mut parts = LineYield::default();
        if law.hardening <= 0.0 || length <= 0.0 || !law.limit.is_finite() {
            return parts;
        }
        let mut end = fed + length;
        let mut part = |from: f64, state: &Scalar| {
            let from = from.clamp(fed, end);
            if from < end {
                parts.push(law.limit + state.rise, (end - from) / law.hardening);
            }
            end = from;
        };
        let furthest = self.stretched.last().map_or(fed, |last| last.until);
        part(furthest, &self.least);
        for (k, own) in self.stretched.iter().enumerate().rev() {
            part(
                k.checked_sub(1)
                    .map_or(fed, |ahead| self.stretched[ahead].until),
                &own.state,
            );
        }
        parts
    }

    /// How much longer wire is for good that goes into the line than wire of this plastic stretch, per length.
    pub fn lengthens_by(&self, passing: f64) -> f64 {
        self.least.strain - passing
    }

    /// Takes in the tension of wire that has come out, N; 0 where none comes.
    pub fn pull_at_exit(&mut self, law: &Law, tension: f64) {
        self.exit = loaded(law, tension);
    }

    /// Takes in that a line of `length` (m) pulls by `tension` (N) after `fed` (m) of wire has passed.
    pub fn pull(&mut self, law: &Law, length: f64, fed: f64, tension: f64) {
        let now = loaded(law, tension);
        self.stretched
            .retain(|s| s.until > fed && s.state.rise > now.rise);
        let before = std::mem::replace(&mut self.least, now);
        if before.rise <= now.rise || length <= 0.0 {
            return;
        }
        let step = Stretch {
            until: fed + length,
            state: before,
        };
        match self.stretched.as_mut_slice() {
            [.., ahead, last] if last.until - ahead.until < RESOLUTION * length => *last = step,
            _ => self.stretched.push(step),
        }
    }

    /// Takes in that wire of this state goes back, `fed` (m) of which had passed.
    pub fn take_back(&mut self, fed: f64, state: Scalar) {
        if state.rise > self.next(fed).rise {
            self.stretched
                .retain(|s| s.until > fed || s.state.rise > state.rise);
            let place = self.stretched.partition_point(|s| s.until <= fed);
            self.stretched.insert(place, Stretch { until: fed, state });
        }
    }

    /// Whether all values are finite, as in any state that a run leaves.
    pub(crate) fn is_sound(&self) -> bool {
        let sound = |s: &Scalar| s.strain.is_finite() && s.rise.is_finite() && s.rise >= 0.0;
        sound(&self.least)
            && sound(&self.exit)
            && self
                .stretched
                .iter()
                .all(|s| sound(&s.state) && s.until.is_finite())
    }
}

/// State of virgin wire under a tension, N: on the loading branch, where it yields.
fn loaded(law: &Law, tension: f64) -> Scalar {
    let over = tension - law.limit;
    // without hardening no strain belongs to a tension
    if over <= 0.0 || law.hardening <= 0.0 {
        return Scalar::default();
    }
    Scalar {
        strain: over / law.hardening,
        rise: over,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LENGTH: f64 = 0.5;

    fn law() -> Law {
        Law::new(48900.0, 1100.0, 38.5, f64::INFINITY)
    }

    /// Plastic stretch of the wire that comes out after so much has passed, m.
    fn strain(wire: &LineWire, fed: f64) -> f64 {
        wire.next(fed).strain
    }

    #[test]
    fn a_peak_stretches_the_line_and_no_more() {
        let law = law();
        let mut wire = LineWire::default();
        for (fed, tension) in [(0.0, 15.0), (0.01, 60.0), (0.02, 15.0)] {
            wire.pull(&law, LENGTH, fed, tension);
        }
        let (peak, _, _) = crate::rod::respond_scalar(&law, &Scalar::default(), 0.03);
        let stretch = loaded(&law, peak);
        assert!((stretch.strain - (0.03 - peak / law.modulus)).abs() < 1e-15);
        assert!(strain(&wire, 0.02) > 0.01);
        assert_eq!(strain(&wire, 0.02), strain(&wire, 0.5));
        assert_eq!(strain(&wire, 0.53), 0.0);
    }

    /// What the line gets longer by in a pull is the stretch of its pieces, however often they were stretched before.
    #[test]
    fn the_line_yields_by_what_its_wire_is_stretched() {
        let law = law();
        let mut wire = LineWire::default();
        // stretch of the line's wire, m
        let longer = |wire: &LineWire, fed: f64| -> f64 {
            let pieces = 5000;
            let piece = LENGTH / f64::from(pieces);
            let at = |k| fed + (f64::from(k) + 0.5) * piece;
            (0..pieces).map(|k| strain(wire, at(k)) * piece).sum()
        };
        for (fed, tension) in [
            (0.0, 15.0),
            (0.01, 60.0),
            (0.11, 15.0),
            (0.21, 50.0),
            (0.25, 30.0),
            (0.35, 45.0),
        ] {
            wire.pull(&law, LENGTH, fed, tension);
        }
        let fed = 0.35;
        assert_eq!(wire.yields(&law, LENGTH, fed).levels().len(), 3);
        for tension in [40.0, 46.0, 52.0, 61.0] {
            let mut pulled = wire.clone();
            let yields = wire.yields(&law, LENGTH, fed);
            pulled.pull(&law, LENGTH, fed, tension);
            let more = longer(&pulled, fed) - longer(&wire, fed);
            assert!(
                (yields.longer(tension) - more).abs() < 1e-5,
                "{tension}: {more} {yields:?}"
            );
        }
    }

    /// The slow twin is each piece of wire with the largest tension while it was in the line.
    #[test]
    fn each_piece_remembers_the_largest_tension_it_saw() {
        let law = law();
        let mut wire = LineWire::default();
        let step = 2e-3;
        let tension = |k: usize| 40.0 + 15.0 * libm::sin(0.031 * k as f64) - 0.01 * k as f64;
        for k in 0..1200 {
            let fed = step * k as f64;
            wire.pull(&law, LENGTH, fed, tension(k));
            assert!(wire.stretched.len() < 70);
            let behind = (LENGTH / step) as usize;
            let seen = (k.saturating_sub(behind)..=k).map(tension);
            let largest = seen.fold(0.0, f64::max);
            let want = loaded(&law, largest).strain;
            // as far off as the tension changes over the resolution of the line
            let off = loaded(
                &law,
                38.5 + 15.0 * 0.031 * (1.0 + RESOLUTION * LENGTH / step),
            )
            .strain;
            let got = strain(&wire, fed);
            assert!((got - want).abs() < off, "{k}: {got}, {want}");
        }
    }

    #[test]
    fn wire_that_went_back_comes_out_as_it_was() {
        let law = law();
        let mut wire = LineWire::default();
        wire.pull(&law, LENGTH, 1.0, 15.0);
        let state = loaded(&law, 45.0);
        wire.take_back(1.0, state);
        wire.take_back(0.95, state);
        assert_eq!(wire.next(0.9), state);
        assert_eq!(strain(&wire, 1.0), 0.0);
        wire.pull(&law, LENGTH, 1.01, 15.0);
        assert_eq!(wire.stretched, Vec::new());
    }

    #[test]
    fn without_a_line_the_present_tension_counts() {
        let law = law();
        let mut wire = LineWire::default();
        wire.pull(&law, 0.0, 0.0, 50.0);
        assert_eq!(wire.next(1.0), loaded(&law, 50.0));
        wire.pull(&law, 0.0, 0.1, 15.0);
        assert_eq!(strain(&wire, 0.1), 0.0);
    }
}
