//! Frozen wire that the next turn pushes along the core, and that has to move.

use super::Winding;
use super::run_state::Pushed;
use crate::math::V3;
use crate::scene::LiveContact;
use std::f64::consts::TAU;

/// Turns behind lift-off up to which wire may have to move: the next turn lands on it a turn after it, and bends it a little farther on.
const WITHIN: f64 = 1.25;

/// Turns for which wire stays live that had to move: that of the wire on which the next one lands, and that of the next one.
const STAYS: f64 = 2.0;

/// Share of the gap that is a defect by which frozen wire may fail to move. Chosen.
const HELD_BACK: f64 = 0.1;

/// Share of a turn that a push moves at most: on a core with corners wire is held at the next one.
const MOST: f64 = 0.25;

impl Winding {
    /// Length behind lift-off that stays live, m.
    pub(super) fn keep_length(&self) -> f64 {
        let own = self.run.policy.keep_length;
        let angle = self.sys.state.spindle.angle;
        match self.run.pushed {
            Some(pushed) if (angle - pushed.at).abs() < STAYS * TAU => own.max(pushed.keep),
            _ => own,
        }
    }

    /// Lets wire move again that the next turn pushes along the core.
    pub(super) fn free_pushed_wire(&mut self) {
        let mut pushes = std::mem::take(&mut self.pushes);
        self.sys.pushes_on_frozen(&mut pushes);
        let count = self.nodes_pushed(&pushes);
        self.pushes = pushes;
        let Some(count) = count else {
            return;
        };
        let live: f64 = self.sys.state.rod.rest[..self.lift_off()].iter().sum();
        let frozen: f64 = self.sys.frozen_lengths().take(count).sum();
        self.run.pushed = Some(Pushed {
            at: self.sys.state.spindle.angle,
            keep: live + frozen,
        });
        let unexplained = self.sys.energy_residual(None);
        self.thaw(count);
        self.sys.follow_mesh(unexplained);
    }

    /// How many frozen nodes come back: from one on that the next turn pushes, and that has room to go. Given are the forces on
    /// frozen nodes, core frame, N.
    fn nodes_pushed(&self, pushes: &[(usize, V3)]) -> Option<usize> {
        let is_seen = self.scene.solver.features.live_contact != LiveContact::Never;
        if pushes.is_empty() || !self.scene.freeze.enabled || !is_seen {
            return None;
        }
        let friction = self.sys.friction_at_rest()?;
        let lifts = self.layon().angle;
        let limit = HELD_BACK * self.scene.defects.gap * self.scene.wire.diameter;
        let (node, _) = pushes.iter().find(|&&(node, _)| {
            lifts - self.coil.angle_of_node(node) <= WITHIN * TAU
                && self.coil.room_beside_node(node) > limit
                && self.way_pushed(pushes, node, friction) > limit
        })?;
        let frozen = self.sys.state.frozen_pulls.len();
        Some(frozen - self.nodes_around(*node).start)
    }

    /// Frozen nodes within the keep length of one, over which stiff wire spreads a force.
    fn nodes_around(&self, node: usize) -> std::ops::Range<usize> {
        let pulls = &self.sys.state.frozen_pulls;
        let reach = self.run.policy.keep_length;
        let (mut start, mut way) = (node, 0.0);
        while start > 0 && way < reach {
            start -= 1;
            way += pulls[start].rest;
        }
        let (mut end, mut way) = (node, 0.0);
        while end < pulls.len() && way < reach {
            way += pulls[end].rest;
            end += 1;
        }
        start..end
    }

    /// How far wire would move if a force went along it that is what pushes around a frozen node, m.
    ///
    /// Behind the force `P` the wire has moved. Ahead of it friction `q` per length holds a part of `a = P / q`, which bends from one
    /// place to the other: `P = w (2 T / a + 24 EI / a^3)`.
    fn way_pushed(&self, pushes: &[(usize, V3)], node: usize, friction: f64) -> f64 {
        let pulls = &self.sys.state.frozen_pulls;
        let around = self.nodes_around(node);
        let (mut hold, mut length) = (0.0, 0.0);
        for i in around.clone() {
            hold += friction * (pulls[i].drawn * pulls[i].pulls() + pulls[i].bent);
            length += pulls[i].rest;
        }
        let mut push = 0.0;
        for (i, force) in pushes.iter().filter(|(i, _)| around.contains(i)) {
            let (along, out) = self.sys.frozen_way(*i);
            push += force.dot(&along.cross(&out));
            hold += friction * (-force.dot(&out)).max(0.0);
        }
        let place = self.sys.state.frozen.points[node];
        let turn = TAU * libm::hypot(place.x, place.z);
        let part = (push.abs() * length / hold).min(MOST * turn);
        if part.is_nan() || part <= 0.0 {
            return 0.0;
        }
        let bends = 24.0 * self.scene.wire.ei / (part * part * part);
        push.abs() / (2.0 * pulls[node].pulls() / part + bends)
    }
}
