//! Frozen wire that slips along itself.

use super::{FrozenPull, System};
use crate::contact::ContactPoint;
use crate::math::V3;
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
            let [pressed, net] = self.normal_force_at(i + 1);
            let mut pull = FrozenPull {
                tension,
                rest: rod.rest[i],
                turned: turning([&load.tangent[i], &load.tangent[i + 1]]).norm(),
                pressed,
                net,
                drawn: 0.0,
                bent: 0.0,
                apart: 0.0,
            };
            let per_force = self.turned_per_force(&pull);
            pull.split(per_force);
            pull.hold(load.tension[i + 1].max(0.0), friction);
            self.state.frozen_pulls.push(pull);
        }
    }

    /// Angle by which the wire of the last turn turns, up to this edge, over all that presses on it, 1/N: what a force there has to do with
    /// tension.
    fn turned_per_force(&self, last: &FrozenPull) -> f64 {
        let (mut turned, mut net) = (last.turned, last.net);
        for pull in self.state.frozen_pulls.iter().rev() {
            if turned >= TAU {
                break;
            }
            turned += pull.turned;
            net += pull.net;
        }
        if net > 0.0 { turned / net } else { 0.0 }
    }

    /// Normal forces of what node `i` touches, N: the sum of all, and that of what they are together at each point.
    ///
    /// A point shares its forces out among its nodes.
    fn normal_force_at(&self, i: usize) -> [f64; 2] {
        let (Some(model), Some(line)) =
            (self.model.contact.as_line(), self.state.contact.as_line())
        else {
            return [0.0; 2];
        };
        let (mut sum, mut together) = (0.0, 0.0);
        let last = 2 * self.state.rod.edges();
        for number in (2 * i).saturating_sub(2).max(1)..(2 * i + 3).min(last) {
            let point = ContactPoint::of_number(number);
            let weights = point.weights();
            let at_node = weights.iter().filter(|(node, _)| *node == i);
            let share: f64 = at_node.map(|(_, weight)| weight).sum();
            let mut of_point = V3::zeros();
            for force in line.normal_forces(model, number, point.length(&self.state.rod)) {
                sum += share * force.norm();
                of_point += force;
            }
            together += share * of_point.norm();
        }
        [sum, together]
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
