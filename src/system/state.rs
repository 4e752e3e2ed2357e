//! The least that restarts a run to the bit: what a saved state holds.
//!
//! What influences the rounding of a later step belongs to it, be it a cache: forces of the last
//! evaluation, history of the step formula. Work arrays do not, nor does what follows from the state.

use super::{ContactState, EnergyBalance, FrozenHistory, FrozenPulls, Past, Spindle, Support};
use crate::feed::{Feed, LineWire};
use crate::geometry::Tube;
use crate::rod::{Load, Rod};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// State of a [`super::System`].
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct State {
    /// the live wire
    pub rod: Rod,
    /// supports at the first and last node
    pub support: [Support; 2],
    /// core motion
    pub spindle: Spindle,
    /// accepted instants before this one, for the implicit method
    pub past: Past,
    /// what contact remembers
    pub contact: ContactState,
    /// frozen wire as fixed geometry, oldest node first; copies share it until one of them changes it
    pub frozen: Arc<Tube>,
    /// frozen wire of the implicit method, as it is kept to let it move again
    pub(crate) frozen_history: FrozenHistory,
    /// tensions of frozen wire of the implicit method
    pub frozen_pulls: FrozenPulls,
    /// the first frozen edge whose tension has changed and was not measured since; beyond all: none
    pub(crate) slipped_from: usize,
    /// feed at the last node, if there is one
    pub feed: Option<Feed>,
    /// plastic stretch of the wire behind the nozzle
    pub line_wire: LineWire,
    /// set pull of the tensioner, N
    pub set_tension: f64,
    /// its rate, N/s
    pub set_rate: f64,
    /// unstretched length from the clamp to the first live node, m
    pub arc0: f64,
    /// wire that went where nodes did and arcs became chords, less what came where nodes did, m; both count as fed
    pub joined_away: f64,
    /// energy balance
    pub balance: EnergyBalance,
    /// deepest penetration met, m
    pub deepest: f64,
    /// that at the last accepted instant, m
    pub depth: f64,
    /// moment of the wire on the core about +y at the last evaluation, N m
    pub torque_on_core: f64,
    /// moment that turns the wire's mass, as the last implicit step has it, N m
    pub(crate) turning: Option<f64>,
    /// the part of the torque that is there because forces and motion are a little out of balance, N m
    pub(crate) unbalanced: f64,
    /// moment on the core beside that of its forces over the last implicit step, N m; 0 unless that was too short for stiff contact to
    /// follow its load. There impulses of touches hold the wire, and the step formula leaves momentum out.
    pub(crate) pressed: f64,
    /// elapsed time, s
    pub time: f64,
    /// forces of the last evaluation
    pub load: Load,
    /// roll of each edge since the step began, rad
    pub(crate) roll: Vec<f64>,
}

impl State {
    /// The state of a wire of this `radius` (m) at rest on which nothing acts.
    pub(super) fn of(rod: Rod, radius: f64) -> Self {
        let roll = vec![0.0; rod.edges()];
        Self {
            rod,
            support: [Support::free(), Support::free()],
            spindle: Spindle::default(),
            past: Past::default(),
            contact: ContactState::None,
            frozen: Arc::new(Tube::new(radius)),
            frozen_history: FrozenHistory::default(),
            frozen_pulls: FrozenPulls::default(),
            slipped_from: usize::MAX,
            feed: None,
            line_wire: LineWire::default(),
            set_tension: 0.0,
            set_rate: 0.0,
            arc0: 0.0,
            joined_away: 0.0,
            balance: EnergyBalance::default(),
            deepest: 0.0,
            depth: 0.0,
            torque_on_core: 0.0,
            turning: None,
            unbalanced: 0.0,
            pressed: 0.0,
            time: 0.0,
            load: Load::default(),
            roll,
        }
    }

    /// Becomes a copy of another state, in the room that this one has.
    pub(super) fn copy_from(&mut self, other: &Self) {
        let Self {
            rod,
            support,
            spindle,
            past,
            contact,
            frozen,
            frozen_history,
            frozen_pulls,
            slipped_from,
            feed,
            line_wire,
            set_tension,
            set_rate,
            arc0,
            joined_away,
            balance,
            deepest,
            depth,
            torque_on_core,
            turning,
            unbalanced,
            pressed,
            time,
            load,
            roll,
        } = other;
        self.rod.copy_from(rod);
        (self.support, self.spindle) = (*support, *spindle);
        self.past.copy_from(past);
        self.contact.copy_from(contact);
        self.frozen.clone_from(frozen);
        self.frozen_history.clone_from(frozen_history);
        self.frozen_pulls.clone_from(frozen_pulls);
        self.slipped_from = *slipped_from;
        self.feed = *feed;
        self.line_wire.clone_from(line_wire);
        (self.set_tension, self.set_rate) = (*set_tension, *set_rate);
        (self.arc0, self.joined_away) = (*arc0, *joined_away);
        self.balance = *balance;
        (self.deepest, self.depth) = (*deepest, *depth);
        self.torque_on_core = *torque_on_core;
        (self.turning, self.unbalanced) = (*turning, *unbalanced);
        self.pressed = *pressed;
        self.time = *time;
        self.load.copy_from(load);
        self.roll.clone_from(roll);
    }

    /// Fails with what is impossible about a state, whose bytes may say anything.
    pub(super) fn check(&self) -> Result<(), &'static str> {
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
        if !self.line_wire.is_sound() {
            return Err("wire behind the nozzle is stretched beyond measure");
        }
        let pulls = &self.frozen_pulls;
        if pulls.len() != self.frozen_history.len() || !pulls.iter().all(|pull| pull.is_sound()) {
            return Err("tensions of frozen wire cannot be");
        }
        if !self.frozen_history.iter().all(|node| node.is_sound()) {
            return Err("frozen wire remembers what cannot be");
        }
        Ok(())
    }
}
