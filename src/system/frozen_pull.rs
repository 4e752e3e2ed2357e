//! Tension of frozen wire, which slips along itself where friction gives way.

use super::System;
use crate::contact::ContactPoint;
use crate::math::PersistentVec;
use serde::{Deserialize, Serialize};

/// The tension of a frozen edge, and what holds it against the edge after it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrozenPull {
    /// tension, N
    pub tension: f64,
    /// unstretched length of the edge, m
    pub rest: f64,
    /// normal force on the node after the edge, over the tension that the edge froze with
    pub pressed: f64,
}

impl FrozenPull {
    /// The tension without what pushes, N.
    pub fn pulls(&self) -> f64 {
        self.tension.max(0.0)
    }

    /// Largest ratio of tensions on either side of the node after the edge that a coefficient of `friction` holds.
    pub fn held_by(&self, friction: f64) -> f64 {
        1.0 + friction * self.pressed
    }

    /// Whether it can be; bytes from elsewhere may say anything.
    pub(super) fn is_sound(&self) -> bool {
        self.tension.is_finite() && self.rest > 0.0 && self.rest.is_finite() && self.pressed >= 0.0
    }
}

/// Tensions of all frozen edges, the oldest first; a chunk is about half a turn of fine wire.
pub type FrozenPulls = PersistentVec<FrozenPull, 64>;

/// What frozen wire gave to the first live edge when it slipped.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrozenSlip {
    /// the first frozen edge that slipped
    pub from: usize,
    /// tension of the first live edge now, N
    pub tension: f64,
    /// the tensions fell
    pub falls: bool,
    /// work that was done on frozen wire, J
    pub work: f64,
}

impl System {
    /// Coefficient of friction by which frozen wire holds; none where wire does not freeze with its tensions.
    pub(crate) fn friction_at_rest(&self) -> Option<f64> {
        self.model.contact.as_line().map(|line| line.law.mu_static)
    }

    /// Puts the tensions of the first `count` edges on record, which freeze.
    ///
    /// A ratio of tensions that is there is one that something holds, be it inertia.
    pub(super) fn record_pulls(&mut self, count: usize) {
        let Some(friction) = self.friction_at_rest() else {
            return;
        };
        for i in 0..count {
            let tension = self.state.load.tension[i];
            let rest = self.state.rod.rest[i];
            let pressed = match tension > 0.0 {
                true => self.normal_force_at(i + 1) / tension,
                false => 0.0,
            };
            let mut pull = FrozenPull {
                tension,
                rest,
                pressed,
            };
            let after = self.state.load.tension[i + 1].max(0.0);
            if friction > 0.0 && tension > 0.0 && after > 0.0 {
                let ratio = (after / tension).max(tension / after);
                pull.pressed = pull.pressed.max((ratio - 1.0) / friction);
            }
            self.state.frozen_pulls.push(pull);
        }
    }

    /// Normal force of what node `i` touches with half of the edges at it, N.
    fn normal_force_at(&self, i: usize) -> f64 {
        let (Some(model), Some(line)) =
            (self.model.contact.as_line(), self.state.contact.as_line())
        else {
            return 0.0;
        };
        let at = |point: ContactPoint| {
            let forces = line.normal_forces(model, point.number(), point.length(&self.state.rod));
            forces.map(|force| force.norm()).sum::<f64>()
        };
        at(ContactPoint::Node(i))
            + 0.5 * (at(ContactPoint::Edge(i - 1)) + at(ContactPoint::Edge(i)))
    }

    /// Takes over how frozen wire slipped in a step: the first live edge is `rest` long unstretched now, m.
    pub(crate) fn slip_frozen(&mut self, slip: &FrozenSlip, rest: f64) {
        let Some(friction) = self.friction_at_rest() else {
            return;
        };
        let modulus = self.model.laws.stretch.modulus;
        let stored = |pull: &FrozenPull| 0.5 * pull.tension * pull.tension * pull.rest / modulus;
        let mut tension = slip.tension;
        let mut gained = 0.0;
        for i in (slip.from..self.state.frozen_pulls.len()).rev() {
            let Some(pull) = self.state.frozen_pulls.get_mut(i) else {
                break;
            };
            gained -= stored(pull);
            let held = pull.held_by(friction);
            tension = if slip.falls {
                tension * held
            } else {
                tension / held
            };
            pull.rest -= pull.rest * (tension - pull.pulls()) / modulus;
            pull.tension = tension;
            gained += stored(pull);
        }
        self.state.slipped_from = self.state.slipped_from.min(slip.from);
        self.state.arc0 -= rest - self.state.rod.rest[0];
        self.state.rod.rest[0] = rest;
        self.state.balance.frozen_stored += gained;
        if let Some(line) = self.state.contact.as_line_mut() {
            line.loss.friction += slip.work - gained;
        }
    }

    /// The first frozen edge that has slipped since this was asked last.
    pub(crate) fn take_slipped(&mut self) -> Option<usize> {
        let from = std::mem::replace(&mut self.state.slipped_from, usize::MAX);
        (from < self.state.frozen_pulls.len()).then_some(from)
    }
}
