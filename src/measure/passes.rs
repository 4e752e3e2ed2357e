//! Passes of the traverse: which wire was laid while the nozzle went which way.

use serde::{Deserialize, Serialize};

/// A pass: wire laid while the nozzle went one way along y.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Pass {
    /// winding angle at which its wire begins, rad
    pub(crate) from: f64,
    /// +1 where the nozzle went towards +y, else -1
    pub(crate) sense: f64,
}

/// All passes so far, in the order of their wire; there is always a first one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Passes(Vec<Pass>);

impl Passes {
    /// A first pass in this direction along y; 0 counts as +1.
    pub(crate) fn new(sense: f64) -> Self {
        Self(vec![Pass {
            from: f64::NEG_INFINITY,
            sense: if sense < 0.0 { -1.0 } else { 1.0 },
        }])
    }

    /// Number from 1 and pass of the wire at this winding angle, rad.
    pub(crate) fn at(&self, angle: f64) -> (u32, Pass) {
        let number = self.0.partition_point(|pass| pass.from <= angle).max(1);
        (number as u32, self.0[number - 1])
    }

    /// Whether the pass of the wire at this winding angle ends within so much of it, rad.
    pub(crate) fn ends_within(&self, angle: f64, reach: f64) -> bool {
        let (number, _) = self.at(angle);
        let next = self.0.get(number as usize);
        next.is_some_and(|next| next.from - angle < reach)
    }

    /// The last pass.
    pub(crate) fn last(&self) -> Pass {
        self.0[self.0.len() - 1]
    }

    /// How many there are.
    pub(crate) fn count(&self) -> usize {
        self.0.len()
    }

    /// Adds a pass, not before the one that is last so far.
    pub(crate) fn push(&mut self, from: f64, sense: f64) {
        let from = from.max(self.last().from);
        self.0.push(Pass { from, sense });
    }

    /// Takes the last pass away, unless it is the first.
    pub(crate) fn pop(&mut self) -> Option<Pass> {
        if self.0.len() > 1 { self.0.pop() } else { None }
    }

    /// Whether these can be passes; bytes from elsewhere may say anything.
    pub(crate) fn is_sound(&self) -> bool {
        let order = self.0.windows(2).all(|pair| pair[0].from <= pair[1].from);
        let senses = self.0.iter().all(|pass| pass.sense.abs() == 1.0);
        !self.0.is_empty() && order && senses
    }
}
