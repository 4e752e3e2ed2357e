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
    /// all normal forces on that node when the edge froze, N
    pub pressed: f64,
    /// what they are together, N: less where wire lies in a groove, whose walls press from either side
    pub net: f64,
    /// the part of it that goes with the tension, over the tension
    pub drawn: f64,
    /// the part that bending made, N
    pub bent: f64,
    /// by how much the tension lay above, or below, what friction held beside that after the edge, N
    pub apart: f64,
}

impl FrozenPull {
    /// The tension without what pushes, N.
    pub fn pulls(&self) -> f64 {
        self.tension.max(0.0)
    }

    /// Largest tension beside one of `T` after it that a coefficient of `friction` holds: factor of `T`, and what comes to it, N.
    pub fn most(&self, friction: f64) -> Beside {
        Beside {
            share: 1.0 + friction * self.drawn,
            // (wire pushes no wire along itself)
            more: (friction * self.bent + self.apart).max(0.0),
        }
    }

    /// Least tension beside one of `T` after it; less than none is none.
    pub fn least(&self, friction: f64) -> Beside {
        let share = 1.0 / (1.0 + friction * self.drawn);
        Beside {
            share,
            more: self.apart - friction * self.bent * share,
        }
    }

    /// The limit of the tension where that of the wire after it falls, or rises.
    pub fn limit(&self, falls: bool, friction: f64) -> Beside {
        match falls {
            true => self.most(friction),
            false => self.least(friction),
        }
    }

    /// Splits what presses: tension makes as much of it as turns the wire by `turned_per_force` (1/N), and the wire's stiffness the rest.
    pub(super) fn split(&mut self, turned_per_force: f64) {
        let tension = self.pulls();
        let all = if tension > 0.0 { 1.0 / tension } else { 0.0 };
        self.drawn = self.pressed * turned_per_force.min(all);
        self.bent = (self.pressed - self.drawn * tension).max(0.0);
    }

    /// Holds the tension that is there `after` the edge, N, whatever friction does: the wire's stiffness may.
    pub(super) fn hold(&mut self, after: f64, friction: f64) {
        let own = self.pulls();
        let above = own - self.most(friction).at(after);
        let below = own - self.least(friction).at(after);
        self.apart += above.max(0.0) + below.min(0.0);
    }

    /// Whether it can be; bytes from elsewhere may say anything.
    pub(super) fn is_sound(&self) -> bool {
        let parts = [self.turned, self.pressed, self.net, self.drawn, self.bent];
        self.tension.is_finite()
            && self.apart.is_finite()
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

    /// The other tension, where this one is the tension beside it, N.
    pub fn other(&self, beside: f64) -> f64 {
        (beside - self.more) / self.share
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
