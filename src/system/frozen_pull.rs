//! Tension of frozen wire, and how far friction holds it.

use crate::math::PersistentVec;
use serde::{Deserialize, Serialize};

/// The tension of a frozen edge, and what holds it against the edge after it.
///
/// The core presses on a node with what the tension asks for where the wire turns, and with what bending does. Where the tension changes, the
/// first part goes with it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrozenPull {
    /// tension, N
    pub tension: f64,
    /// unstretched length of the edge, m
    pub rest: f64,
    /// angle by which the wire turned at the node after the edge, rad
    pub turned: f64,
    /// normal force on that node when the edge froze, over the tension then
    pub pressed: f64,
    /// the part of it that goes with the tension
    pub drawn: f64,
    /// the part that bending made, N
    pub bent: f64,
    /// difference of the tensions on either side when the edge froze, beyond what friction holds, N
    pub apart: f64,
}

impl FrozenPull {
    /// The tension without what pushes, N.
    pub fn pulls(&self) -> f64 {
        self.tension.max(0.0)
    }

    /// Largest tension beside one of `T` that a coefficient of `friction` holds: factor of `T`, and what comes to it, N.
    pub fn most(&self, friction: f64) -> Beside {
        Beside {
            share: 1.0 + friction * self.drawn,
            more: friction * self.bent + self.apart,
        }
    }

    /// Least tension beside one of `T`; less than none is none.
    pub fn least(&self, friction: f64) -> Beside {
        let share = 1.0 / (1.0 + friction * self.drawn);
        Beside {
            share,
            more: -(friction * self.bent + self.apart) * share,
        }
    }

    /// The limit of the tension where that of the wire after it falls, or rises.
    pub fn limit(&self, falls: bool, friction: f64) -> Beside {
        match falls {
            true => self.most(friction),
            false => self.least(friction),
        }
    }

    /// Splits what presses by the `share` that goes with the tension.
    pub(super) fn split(&mut self, share: f64) {
        self.drawn = share * self.pressed;
        self.bent = (1.0 - share) * self.pressed * self.pulls();
    }

    /// Holds the tension that is there `after` the edge, N, whatever friction does: the wire's stiffness may.
    pub(super) fn hold(&mut self, after: f64, friction: f64) {
        let (low, high) = (self.pulls().min(after), self.pulls().max(after));
        self.apart += (high - self.most(friction).at(low)).max(0.0);
    }

    /// Whether it can be; bytes from elsewhere may say anything.
    pub(super) fn is_sound(&self) -> bool {
        let parts = [self.turned, self.pressed, self.drawn, self.bent, self.apart];
        self.tension.is_finite()
            && self.rest > 0.0
            && self.rest.is_finite()
            && parts.iter().all(|x| *x >= 0.0 && x.is_finite())
    }
}

/// A tension that is a straight line over that of other wire.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beside {
    /// its slope
    pub share: f64,
    /// its value where the other is none, N
    pub more: f64,
}

impl Beside {
    /// The tension of the other wire itself.
    pub const ITSELF: Self = Self {
        share: 1.0,
        more: 0.0,
    };

    /// The tension beside this one, N.
    pub fn at(&self, tension: f64) -> f64 {
        self.share * tension + self.more
    }

    /// This limit beside wire that is itself at `other`.
    pub fn after(&self, other: &Self) -> Self {
        Self {
            share: self.share * other.share,
            more: self.share * other.more + self.more,
        }
    }
}

/// Tensions of all frozen edges, the oldest first; a chunk is about half a turn of fine wire.
pub type FrozenPulls = PersistentVec<FrozenPull, 64>;
