//! Passes of the traverse: which wire was laid while the nozzle went which way.

use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use std::sync::Arc;

/// A nozzle that goes the other way for less wire than this, rad, and on again has hung back: its way is that of one pass.
/// Chosen: a turn, and the quarter in which wire follows from one place to the next.
const HUNG_BACK: f64 = 1.25 * TAU;

/// A pass of less wire than this, rad, is no layer. Chosen: layers may be a turn long, of which a crossover takes a part.
const SHORTEST: f64 = 0.75 * TAU;

/// A pass: wire laid while the nozzle went one way along y.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Pass {
    /// winding angle at which its wire begins, rad
    pub(crate) from: f64,
    /// +1 where the nozzle went towards +y, else -1
    pub(crate) sense: f64,
    /// place along y at which the nozzle turned, m; not known for the first pass
    pub(crate) turned_at: Option<f64>,
}

impl Pass {
    /// Whether a nozzle of this pass that turned back and on again came back to where it had turned, before it turned at
    /// `next`. It went on then; otherwise it went the other way for good, and swung on the way.
    fn goes_on(&self, back: &Pass, next: &Pass, near: f64) -> bool {
        match (back.turned_at, next.turned_at) {
            (Some(back), Some(next)) => self.sense * (next - back) >= -near,
            _ => true,
        }
    }
}

/// All passes so far, in the order of their wire; there is always a first one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Passes {
    passes: Vec<Pass>,
    /// how near the nozzle has to come to a place to have come back to it, m
    #[serde(skip)]
    near: f64,
    /// winding angles at which the second pass and those after it begin by plan, rad; empty: the nozzle's way says so
    #[serde(skip)]
    planned: Arc<[f64]>,
}

impl Passes {
    /// A first pass in this direction along y; 0 counts as +1.
    pub(crate) fn new(sense: f64, near: f64) -> Self {
        let first = Pass {
            from: f64::NEG_INFINITY,
            sense: if sense < 0.0 { -1.0 } else { 1.0 },
            turned_at: None,
        };
        Self {
            passes: vec![first],
            near,
            planned: Arc::new([]),
        }
    }

    /// The same where wire is meant to climb to each next layer between these winding angles, rad.
    ///
    /// A nozzle that lays a single turn and goes back cannot be told from one that hangs back, or does not move at all. Where a layer
    /// is that short, the passes are those of the plan.
    pub(crate) fn planned(self, jumps: &[[f64; 2]]) -> Self {
        let ends = jumps.iter().map(|jump| jump[1]);
        let mut short = ends.clone().zip([0.0].into_iter().chain(ends));
        let planned: Arc<[f64]> = match short.any(|(end, start)| end - start < HUNG_BACK) {
            true => jumps.iter().map(|jump| jump[0]).collect(),
            false => Arc::new([]),
        };
        Self { planned, ..self }
    }

    /// Whether passes are those of a plan.
    pub(crate) fn has_plan(&self) -> bool {
        !self.planned.is_empty()
    }

    /// Whether the pass with this number lies on a layer that is a single turn long by plan.
    pub(crate) fn lies_on_single_turn(&self, number: u32) -> bool {
        let from = |number: usize| match number {
            0 => Some(0.0),
            _ => self.planned.get(number - 1).copied(),
        };
        let number = number as usize;
        let [below, own] = [number.checked_sub(2), number.checked_sub(1)].map(|at| from(at?));
        below
            .zip(own)
            .is_some_and(|(below, own)| own - below < HUNG_BACK)
    }

    /// The same for a first pass in this direction along y.
    pub(crate) fn set_first_sense(&mut self, sense: f64) {
        let first = Self::new(sense, self.near);
        self.passes = first.passes;
    }

    /// The passes of a saved state, under the same plan.
    pub(crate) fn take(&mut self, saved: Self) {
        self.passes = saved.passes;
    }

    /// Number from 1 and pass of the wire at this winding angle, rad.
    pub(crate) fn at(&self, angle: f64) -> (u32, Pass) {
        let mut number = 0;
        let mut found = self.passes[0];
        for pass in self.judged().take_while(|pass| pass.from <= angle) {
            number += 1;
            found = pass;
        }
        (number.max(1), found)
    }

    /// Winding angle at which the pass of the wire at this winding angle begins, rad; of wire in the last swing, see
    /// [`Self::last_swing`], that of the pass before. Wire that `climbed` to its layer there, rad, was laid by a nozzle that has turned.
    pub(crate) fn begins(&self, angle: f64, climbed: Option<f64>) -> f64 {
        let has_turned = climbed.is_some_and(|at| (at - self.last().from).abs() < HUNG_BACK);
        let swing = self.last_swing(angle).filter(|_| !has_turned);
        let begun = self.judged().take_while(|pass| pass.from <= angle);
        let passes = begun.zip(1..).filter(|(_, number)| swing != Some(*number));
        passes.last().map_or(0.0, |(pass, _)| pass.from)
    }

    /// Winding angles, rad, at which layers begin after one and up to another: passes that follow one which filled a layer.
    pub(crate) fn layers_begun(&self, after: f64, until: f64) -> impl Iterator<Item = f64> {
        let mut before = 0.0;
        let passes = self.judged().skip(1).map(|pass| pass.from);
        passes
            .take_while(move |from| *from <= until)
            .filter(move |from| {
                let full = from - std::mem::replace(&mut before, *from) >= SHORTEST;
                full && *from > after
            })
    }

    /// The passes without those in which the nozzle hung back.
    fn judged(&self) -> impl Iterator<Item = Pass> {
        let mut rest = &self.passes[..];
        let mut number = 0;
        std::iter::from_fn(move || {
            if self.has_plan() {
                number += 1;
                return self.planned_pass(number - 1);
            }
            let (first, mut after) = rest.split_first()?;
            while let [back, on, ..] = after
                && on.from - back.from < HUNG_BACK
                && after
                    .get(2)
                    .is_none_or(|next| first.goes_on(back, next, self.near))
            {
                after = &after[2..];
            }
            rest = after;
            Some(*first)
        })
    }

    /// A pass of the plan, by its number from 0: each goes the other way.
    fn planned_pass(&self, number: usize) -> Option<Pass> {
        let first = self.passes[0];
        let from = match number {
            0 => first.from,
            _ => *self.planned.get(number - 1)?,
        };
        let sense = match number % 2 {
            0 => first.sense,
            _ => -first.sense,
        };
        Some(Pass {
            from,
            sense,
            turned_at: None,
        })
    }

    /// Number of the last pass of a nozzle that swings past its places, where less wire than a swing takes has been laid in it up
    /// to this winding angle, rad: what it turned for shows once it goes on.
    pub(crate) fn last_swing(&self, angle: f64) -> Option<u32> {
        if self.has_plan() {
            return None;
        }
        let count = self.judged().count();
        let swings = count < self.passes.len() && self.judged().last() == Some(self.last());
        (swings && angle - self.last().from < HUNG_BACK).then_some(count as u32)
    }

    /// Where the wire begins that the last pass says something about, rad: with it the one before may turn out to be none.
    pub(crate) fn open_from(&self) -> f64 {
        match self.passes[..] {
            // it says whether the nozzle went on from there
            [.., _, back, on, _] if on.from - back.from < HUNG_BACK => back.from,
            [.., before, back, on] if on.from - back.from < HUNG_BACK => back.from.max(before.from),
            _ => self.last().from,
        }
    }

    /// Whether the pass of the wire at this winding angle ends within so much of it, rad.
    pub(crate) fn ends_within(&self, angle: f64, reach: f64) -> bool {
        let next = self.judged().find(|pass| pass.from > angle);
        next.is_some_and(|next| next.from - angle < reach)
    }

    /// The last pass.
    pub(crate) fn last(&self) -> Pass {
        self.passes[self.passes.len() - 1]
    }

    /// How many there are.
    pub(crate) fn count(&self) -> usize {
        self.passes.len()
    }

    /// Adds a pass, not before the one that is last so far.
    pub(crate) fn push(&mut self, from: f64, sense: f64, turned_at: Option<f64>) {
        let from = from.max(self.last().from);
        self.passes.push(Pass {
            from,
            sense,
            turned_at,
        });
    }

    /// Takes the last pass away, unless it is the first.
    pub(crate) fn pop(&mut self) -> Option<Pass> {
        if self.passes.len() > 1 {
            self.passes.pop()
        } else {
            None
        }
    }

    /// Whether these can be passes; bytes from elsewhere may say anything.
    pub(crate) fn is_sound(&self) -> bool {
        let passes = &self.passes;
        let order = passes.windows(2).all(|pair| pair[0].from <= pair[1].from);
        let senses = passes.iter().all(|pass| pass.sense.abs() == 1.0);
        !passes.is_empty() && order && senses
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `turn_in_layer` fell to nothing in each swing of a led nozzle, for a sixth of a turn.
    #[test]
    fn a_swing_begins_no_pass() {
        let mut passes = Passes::new(1.0, 1e-4);
        let mut begun = Vec::new();
        for turn in 1..8 {
            let from = f64::from(turn) * TAU;
            // the nozzle goes back a little, and on again from where it had turned
            passes.push(from, -1.0, Some(1e-3 * f64::from(turn)));
            begun.push(passes.begins(from + 0.3, None));
            passes.push(from + 1.0, 1.0, Some(1e-3 * f64::from(turn) - 2e-4));
            begun.push(passes.begins(from + 1.3, None));
        }
        // what the first turns for is not known until it goes on
        assert_eq!(begun[0], TAU);
        assert!(
            begun[1..].iter().all(|from| *from == f64::NEG_INFINITY),
            "{begun:?}"
        );
        // where wire has climbed, the nozzle has turned for good
        let end = 8.0 * TAU;
        passes.push(end, -1.0, Some(8e-3));
        assert_eq!(passes.begins(end + 0.3, None), f64::NEG_INFINITY);
        assert_eq!(passes.begins(end + 0.3, Some(3.0 * TAU)), f64::NEG_INFINITY);
        assert_eq!(passes.begins(end + 0.3, Some(end - 0.2)), end);
    }
}
