//! The part of a system that a saved state has to hold: all that the scene does not give.
//!
//! What influences the rounding of a later step belongs to it, be it a cache: surroundings of
//! contact points, lists of pairs, history of the step formula. Work arrays do not.

use super::contact_model::SavedContact;
use super::{EnergyBalance, FrozenHistory, Past, Spindle, Support, System};
use crate::feed::Feed;
use crate::rod::{Load, Rod};
use serde::{Deserialize, Serialize};

/// State of a [`System`].
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct SavedSystem {
    rod: Rod,
    support: [Support; 2],
    spindle: Spindle,
    contact: SavedContact,
    past: Past,
    frozen_history: FrozenHistory,
    feed: Option<Feed>,
    set_tension: f64,
    set_rate: f64,
    arc0: f64,
    balance: EnergyBalance,
    deepest: f64,
    joined_away: f64,
    torque_on_core: f64,
    turning: Option<f64>,
    unbalanced: f64,
    time: f64,
    load: Load,
    roll: Vec<f64>,
}

impl System {
    /// What a saved state has to hold. Loads that no scene has are not in it.
    pub(crate) fn saved(&self) -> SavedSystem {
        // a new field asks here whether it is state
        let Self {
            section: _,
            laws: _,
            rod,
            mass: _,
            support,
            spindle,
            loads: _,
            contact: _,
            frozen_wire: _,
            past,
            frozen_history,
            feed,
            set_tension,
            set_rate,
            twist: _,
            arc0,
            balance,
            deepest,
            joined_away,
            torque_on_core,
            turning,
            unbalanced,
            velocity_lag: _,
            time,
            load,
            roll,
            forces: _,
        } = self;
        SavedSystem {
            rod: rod.clone(),
            support: *support,
            spindle: *spindle,
            contact: self.saved_contact(),
            past: past.clone(),
            frozen_history: frozen_history.clone(),
            feed: feed.map(|(_, feed)| feed),
            set_tension: *set_tension,
            set_rate: *set_rate,
            arc0: *arc0,
            balance: *balance,
            deepest: *deepest,
            joined_away: *joined_away,
            torque_on_core: *torque_on_core,
            turning: *turning,
            unbalanced: *unbalanced,
            time: *time,
            load: load.clone(),
            roll: roll.clone(),
        }
    }

    /// Takes a saved state over in a fresh system of the same scene. Says what is impossible about it; the
    /// system is then useless.
    pub(crate) fn restore(&mut self, saved: SavedSystem) -> Result<(), &'static str> {
        let nodes = saved.rod.nodes();
        saved.check()?;
        self.restore_contact(saved.contact, nodes)?;
        match (&mut self.feed, saved.feed) {
            (Some((_, feed)), Some(saved)) => *feed = saved,
            (None, None) => {}
            _ => return Err("a feed is there in one of scene and state only"),
        }
        self.rod = saved.rod;
        self.support = saved.support;
        self.spindle = saved.spindle;
        self.past = saved.past;
        self.frozen_history = saved.frozen_history;
        self.set_tension = saved.set_tension;
        self.set_rate = saved.set_rate;
        self.arc0 = saved.arc0;
        self.balance = saved.balance;
        self.deepest = saved.deepest;
        self.joined_away = saved.joined_away;
        self.torque_on_core = saved.torque_on_core;
        self.turning = saved.turning;
        self.unbalanced = saved.unbalanced;
        self.time = saved.time;
        self.load = saved.load;
        self.roll = saved.roll;
        Ok(())
    }
}

impl SavedSystem {
    /// Arrays that an index runs through together are of one length.
    fn check(&self) -> Result<(), &'static str> {
        let rod = &self.rod;
        let nodes = rod.x.len();
        let Some(edges) = nodes.checked_sub(1).filter(|edges| *edges > 0) else {
            return Err("a wire without an edge");
        };
        let load = &self.load;
        let per_node = [
            rod.v.len(),
            rod.bend.len(),
            rod.twist.len(),
            load.force.len(),
        ];
        let per_edge = [
            rod.rest.len(),
            rod.frame.len(),
            rod.spin.len(),
            rod.stretch.len(),
            load.torque.len(),
            load.tangent.len(),
            load.tension.len(),
            self.roll.len(),
        ];
        if per_node != [nodes; 4] || per_edge != [edges; 8] {
            return Err("arrays of the wire differ in length");
        }
        let places = rod.x.iter().chain(&rod.v).flatten();
        let core = [self.spindle.angle, self.spindle.speed, self.time];
        if !places.chain(&core).all(|x| x.is_finite()) || !rod.rest.iter().all(|l| *l > 0.0) {
            return Err("the wire is nowhere");
        }
        let past = &self.past;
        let known = match past.known {
            0 => true,
            k @ (1 | 2) => {
                past.x.len() == nodes
                    && past.v.len() == nodes
                    && past.q[..=k].iter().all(|q| q.len() == nodes)
            }
            _ => false,
        };
        let mut rolls = past.roll.iter().chain([&past.spin]);
        let rolls = rolls.all(|r| r.is_empty() || r.len() == edges);
        if !known || !rolls {
            return Err("the history does not go with the wire");
        }
        if !self.frozen_history.iter().all(|node| node.is_sound()) {
            return Err("frozen wire remembers what cannot be");
        }
        Ok(())
    }
}
