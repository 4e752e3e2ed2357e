//! How long a step may be.

use super::unknowns::Unknowns;
use super::work::Work;
use super::{CLOSE, Implicit, Scheme};
use crate::contact::MostTurn;
use crate::system::System;

/// Largest growth of the step from one to the next; variable-step BDF2 is stable to 2.4.
const GROWTH: f64 = 1.7;
/// Share of the tolerance that a step length is chosen for. Fewer steps thrown away outweigh more
/// steps (at 0.7 a fifth of all steps was rejected, at 0.4 a tenth, for a tenth less work in all).
const AIM: f64 = 0.4;
/// Smallest factor from an accepted step to the next. Chosen, like the next four.
const SHRINKAGE: f64 = 0.3;
/// Least and largest share of its length with which a step is tried again whose error is too large.
pub(super) const SHORTER: [f64; 2] = [0.2, 0.8];
/// The same of a step whose first update tells that its error would be.
pub(super) const SHORTER_BY_FIRST_UPDATE: [f64; 2] = [0.3, 0.8];
/// Share with which a step is tried again after Newton's method failed.
pub(super) const AFTER_FAILURE: f64 = 0.4;
/// Share with which it is after wire moved farther than pairs were looked for.
pub(super) const AFTER_MISSED_PAIRS: f64 = 0.5;
/// Failures of Newton's method for one step after which it searches as far as it can. One or two are ordinary where wire lands:
/// giving a long step up is cheaper than searching on.
pub const PATIENCE: u64 = 3;
/// Share of the length that a bound on ways or turns allows: a little less than all, so that the second look agrees.
pub(super) const WITHIN: f64 = 0.9;
/// Steps below this multiple of the shortest are taken in trouble only.
pub(super) const SHORT: f64 = 1e3;
/// Least share of what is close that a short step asks for: 2 pm for wire of 0.7 mm, a thousand times the rounding of places.
const LEAST_SHARE: f64 = 1e-4;
/// Angle by which the nozzle's own motion may turn the edge there in a step, rad. The nozzle's work is booked by the
/// forces at both ends of the step. If the edge swings further, these two forces have little to do with each other. It is the angle
/// from which on edges are halved, too: a long edge that bends by more before anyone looks gives energy when it is halved.
pub const NOZZLE_TURN: f64 = 0.05;

/// How far the normal of a touch may turn in a step. A step takes touches by their normals at its end; of a shoulder that wire
/// meets early and is past then, it would see nothing. Wire that lies on the shoulder already goes round it more slowly: with
/// twice as much for it, the gaps of `fig8` and `fig8_gap` stay within 0.005 diameters of those at a finer tolerance.
pub(super) const MOST_TURN: MostTurn = MostTurn {
    landing: 0.01,
    lasting: 0.02,
};

impl Implicit {
    /// Update, m, up to which the guess of a step of `h`, s, stands as it is.
    ///
    /// Forces that no solve takes up are lost. A step of the length that the error asks for may lose what moves the wire by
    /// a share of the tolerance. Shorter steps lose it again and again, and all of them together no more than that:
    /// the forces, which move wire by the square of the time, may be no larger.
    pub(super) fn largest_guess(&self, h: f64) -> f64 {
        // the midpoint rule keeps what is wrong with a guess for ever, and of a prescribed step nobody knows how long it could be
        if self.scheme == Scheme::Midpoint || self.fixed.is_some() {
            return 0.0;
        }
        let share = (h / self.wanted).min(1.0);
        CLOSE * self.tolerance * share * share
    }

    /// Length of a step of `h`, s, over that which the error asks for, at most 1, and at least [`LEAST_SHARE`].
    ///
    /// What a solve leaves moves wire that is held by friction, step after step and the same way. So what is close goes with
    /// this share: in steps cut short by communication points wire creeps no faster than in steps that the error asks for.
    pub(super) fn share_of_wanted(&self, h: f64) -> f64 {
        match self.fixed {
            Some(_) => 1.0,
            None => (h / self.wanted).clamp(LEAST_SHARE, 1.0),
        }
    }

    /// Length that the next step is tried with, s, in an interval of which `most`, s, is left.
    pub(super) fn first_length(&self, sys: &System, most: f64) -> f64 {
        let mut h = self.fixed.unwrap_or(self.next).min(self.longest);
        if self.fixed.is_none() {
            h = h.min(sys.time_to_turn_nozzle_edge(NOZZLE_TURN).max(self.shortest));
        }
        if h >= most {
            h = most;
        } else if 2.0 * h > most && self.fixed.is_none() {
            // two equal steps to the end instead of a long and a very short one
            h = 0.5 * most;
        }
        h
    }

    /// Factor on the length of a step of this `error`, m, that aims at the tolerance.
    pub(super) fn length_factor(&self, error: f64) -> f64 {
        libm::cbrt(AIM * self.tolerance / error)
    }

    /// Sets the length to propose after an accepted step of `h`, s, whose error asks for `factor` times its length.
    pub(super) fn propose(&mut self, h: f64, factor: f64) {
        self.wanted = h * factor;
        self.next = self.length_after(h, factor);
    }

    fn length_after(&self, h: f64, factor: f64) -> f64 {
        // a step cut short by the end of the interval says nothing against a longer one
        let allowed = h * factor;
        if h < self.next && allowed > self.next {
            allowed.min(GROWTH * self.next)
        } else if h < self.next && factor > 1.0 {
            self.next
        } else {
            h * factor.clamp(SHRINKAGE, GROWTH)
        }
        .clamp(self.shortest, self.longest)
    }
}

impl<const D: usize, U: Unknowns<D>> Work<D, U> {
    /// Share of the guess's way that takes no node deeper than its radius into core or frozen wire. Error
    /// estimate and contact search know nothing of a surface that lies between the ends of a step.
    pub(super) fn share_of_way(&self, sys: &System) -> f64 {
        let (Some(model), Some(line)) = (sys.model.contact.as_line(), sys.state.contact.as_line())
        else {
            return 1.0;
        };
        let mut share: f64 = 1.0;
        for (q, guess) in sys.state.past.q[0].iter().zip(&self.guess) {
            let way = (guess - q).norm();
            if way > model.radius {
                let over = model.shape.lower_bound(*q) - line.height;
                let beside = model.flange(*q).map_or(over, |flange| flange.distance);
                let room = over.min(beside).max(model.radius);
                share = share.min(room / way);
            }
        }
        if share < 1.0 { WITHIN * share } else { 1.0 }
    }
}
