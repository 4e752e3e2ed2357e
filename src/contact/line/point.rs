//! State of one contact point of the live wire.

use super::saved_touches;
use super::touch::TouchState;
use crate::contact::friction::FrictionLimit;
use crate::geometry::{Surface, WallFoot};
use crate::math::V3;
use serde::{Deserialize, Serialize};

/// Passages of frozen wire that a point can have near it: neighbours left and right, and a layer below, with
/// one to spare.
pub(super) const PASSAGES: usize = 4;

/// Slot of the touch with what wire is wound on, and of that with the flange nearer to the point. On a concave mesh these and
/// one more are the three walls nearest to the point, in any order: bottom and sides of a groove that fits the wire.
pub(super) const CORE: usize = 0;
pub(super) const FLANGE: usize = 1;
/// Slot of the first passage, after those of walls, and number of all slots.
pub(super) const WIRE: usize = 3;
pub(super) const SLOTS: usize = WIRE + PASSAGES;

/// State of a contact point, core frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct PointState {
    /// place at the last accepted instant, m
    pub(super) last: V3,
    /// whether `last` was ever set
    pub(super) placed: bool,
    /// where the surroundings were looked up, m
    pub(super) centre: V3,
    /// how far from `centre` they hold, m; negative: they have to be looked up again
    pub(super) reach: f64,
    /// a place at which the point touched nothing, m
    pub(super) clear_at: V3,
    /// how far from `clear_at` it touches nothing, m; 0: not known
    pub(super) clear_within: f64,
    /// the core, a flange, a third wall, then passages of frozen wire
    #[serde(with = "saved_touches")]
    pub(super) touch: [TouchState; SLOTS],
    /// whether the touches with core, flange and third wall are in use
    pub(super) near: [bool; WIRE],
    /// number of passages in use
    pub(super) passages: usize,
}

impl PointState {
    /// A point that was never placed.
    pub(super) const NEW: Self = Self {
        last: V3::new(0.0, 0.0, 0.0),
        placed: false,
        centre: V3::new(0.0, 0.0, 0.0),
        reach: -1.0,
        clear_at: V3::new(0.0, 0.0, 0.0),
        clear_within: 0.0,
        touch: [TouchState::UNUSED; SLOTS],
        near: [false; WIRE],
        passages: 0,
    };

    /// Becomes a copy of another point. Most have little near them, and all other touches are unused.
    #[inline]
    pub(super) fn copy_from(&mut self, other: &Self) {
        let used = match self.has_surroundings() || other.has_surroundings() {
            true => WIRE + self.passages.max(other.passages),
            false => 0,
        };
        self.touch[..used].copy_from_slice(&other.touch[..used]);
        let Self {
            last,
            placed,
            centre,
            reach,
            clear_at,
            clear_within,
            touch: _,
            near,
            passages,
        } = *other;
        (self.last, self.placed) = (last, placed);
        (self.centre, self.reach) = (centre, reach);
        (self.clear_at, self.clear_within) = (clear_at, clear_within);
        (self.near, self.passages) = (near, passages);
        debug_assert_eq!(self, other, "a touch that is not in use is not unused");
    }

    /// Whether core or frozen wire is near.
    #[inline]
    pub(super) fn has_surroundings(&self) -> bool {
        self.near != [false; WIRE] || self.passages > 0
    }

    /// Whether its surroundings have to be looked up at `p`, m.
    #[inline(always)]
    pub(super) fn has_left(&self, p: V3) -> bool {
        self.reach < 0.0 || (p - self.centre).norm_squared() >= self.reach * self.reach
    }

    /// The friction limits of its touches.
    #[inline]
    pub(super) fn limits(&self) -> [FrictionLimit; SLOTS] {
        self.touch.each_ref().map(|t| t.limit)
    }

    /// The slots of what is near the point.
    #[inline]
    pub(super) fn slots(&self) -> impl Iterator<Item = usize> + use<> {
        let near = self.near;
        (0..WIRE + self.passages).filter(move |&slot| slot >= WIRE || near[slot])
    }

    /// The touches with core, flange and third wall, used or not, and those with the passages near the point.
    #[inline]
    pub(super) fn touches(&self) -> &[TouchState] {
        &self.touch[..WIRE + self.passages]
    }

    /// [`Self::touches`], to be changed.
    #[inline]
    pub(super) fn touches_mut(&mut self) -> &mut [TouchState] {
        &mut self.touch[..WIRE + self.passages]
    }

    /// Whether another touch counts for the passage or the wall that the touch in `slot` is with.
    ///
    /// Inside a sharp bend two feet merge as the point moves; they are one touch then, the one with an anchor. So do the feet on
    /// two walls where the edge between them ends.
    #[inline]
    pub(super) fn is_double(&self, slot: usize) -> bool {
        let touch = &self.touch[slot];
        if slot < WIRE && touch.start == TouchState::UNUSED.start {
            return false;
        }
        let alike = if slot < WIRE {
            0..WIRE
        } else {
            WIRE..WIRE + self.passages
        };
        alike.into_iter().any(|other| {
            let found = &self.touch[other];
            let counts = match found.anchored == touch.anchored {
                true => other < slot,
                false => found.anchored,
            };
            counts && found.start == touch.start && (other >= WIRE || self.near[other])
        })
    }

    /// Gives the nearest walls of a concave core a slot each, from their feet at `p` (m), the nearest first. A wall keeps the
    /// slot that it has, and the friction in it.
    pub(super) fn keep_walls(&mut self, p: V3, surface: &Surface, feet: &[WallFoot]) {
        let mut left: [_; WIRE] = std::array::from_fn(|k| feet.get(k));
        self.near = [false; WIRE];
        for (touch, near) in self.touch.iter_mut().zip(&mut self.near) {
            let Some(here) = surface.wall_foot(p, touch.start) else {
                continue;
            };
            let same = |foot: &Option<&WallFoot>| foot.is_some_and(|f| f.triangle == here.triangle);
            if let Some(found) = left.iter().position(same) {
                touch.start = here.triangle;
                left[found] = None;
                *near = true;
            }
        }
        let mut left = left.into_iter().flatten();
        for (touch, near) in self.touch.iter_mut().zip(&mut self.near) {
            if *near {
                continue;
            }
            *touch = TouchState::UNUSED;
            if let Some(foot) = left.next() {
                touch.start = foot.triangle;
                *near = true;
            }
        }
    }
}
