//! Frozen wire that slips along itself.

use super::{FrozenPull, System};
use crate::contact::ContactPoint;
use crate::rod::turning;
use std::f64::consts::TAU;

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
    /// Coefficient of friction by which frozen wire holds; none where wire does not freeze with its tensions, or nothing holds it.
    ///
    /// Without friction wire swings along the core and never comes to rest. It freezes all the same, and then stays as it froze.
    pub(crate) fn friction_at_rest(&self) -> Option<f64> {
        let line = self.model.contact.as_line()?;
        Some(line.law.mu_static).filter(|friction| *friction > 0.0)
    }

    /// Puts the tensions of the first `count` edges on record, which freeze.
    pub(super) fn record_pulls(&mut self, count: usize) {
        if !self.model.contact.is_line() {
            return;
        }
        let friction = self.friction_at_rest().unwrap_or(0.0);
        // an edge that yields as it freezes pulls harder than frozen wire followed
        let (first, before) = (self.state.load.tension[0], self.state.frozen_pulls.len());
        if let Some(i) = before.checked_sub(1)
            && let Some(last) = self.state.frozen_pulls.get_mut(i)
        {
            last.hold(first.max(0.0), friction);
        }
        for i in 0..count {
            let (rod, load) = (&self.state.rod, &self.state.load);
            let tension = load.tension[i];
            let mut pull = FrozenPull {
                tension,
                rest: rod.rest[i],
                turned: turning([&load.tangent[i], &load.tangent[i + 1]]).norm(),
                pressed: match tension > 0.0 {
                    true => self.normal_force_at(i + 1) / tension,
                    false => 0.0,
                },
                drawn: 0.0,
                bent: 0.0,
                apart: 0.0,
            };
            let share = self.share_by_tension(&pull);
            pull.split(share);
            pull.hold(load.tension[i + 1].max(0.0), friction);
            self.state.frozen_pulls.push(pull);
        }
    }

    /// Share of what presses on the wire of the last turn, up to this edge, that its tension alone would make; 1 at most.
    fn share_by_tension(&self, last: &FrozenPull) -> f64 {
        let (mut turned, mut pressed) = (last.turned, last.pressed);
        for pull in self.state.frozen_pulls.iter().rev() {
            if turned >= TAU {
                break;
            }
            turned += pull.turned;
            pressed += pull.pressed;
        }
        if pressed > turned {
            turned / pressed
        } else {
            1.0
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
            tension = pull.limit(slip.falls, friction).at(tension);
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
