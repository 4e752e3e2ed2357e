//! Taking frozen wire back.

use super::super::{FrozenNodeRecord, Spindle, Support, System};
use crate::math::{Quat, V3, align, rotate, turn_about_y};
use crate::rod::Twist;

/// Frozen nodes that come back at the front, at rest on the turning core.
#[derive(Clone, Debug)]
pub(in crate::system) struct Thaw {
    /// the nodes, clamp first
    pub nodes: Vec<FrozenNodeRecord>,
    /// the core's motion now
    pub core: Spindle,
    /// the core's motion one instant back
    pub core_before: Spindle,
}

impl System {
    /// Takes the last `count` frozen nodes back into the computation, the reverse of
    /// [`Self::freeze_front`]: at rest on the core, with the plastic state, stress and friction anchors
    /// they froze with.
    ///
    /// The first of them becomes the clamp. Only wire of the implicit method is kept
    /// for this; returns how many nodes came back.
    pub fn thaw_front(&mut self, count: usize) -> usize {
        let count = count.min(self.state.frozen_history.len());
        if count == 0 {
            return 0;
        }
        let mut nodes = self.state.frozen_history.split_off(count);
        let pulls = self.state.frozen_pulls.split_off(count);
        for (node, pull) in nodes.iter_mut().zip(&pulls) {
            node.rest = pull.rest;
        }
        let thaw = Thaw {
            nodes,
            core: self.state.spindle,
            core_before: self.state.spindle.before(self.state.past.h[0]),
        };
        let stored = self.stored();
        self.state.support[0] = Support {
            hold: [true; 3],
            point: thaw.nodes[0].place,
            velocity: V3::zeros(),
            frame: Some(thaw.nodes[0].clamp),
            turning: true,
        };
        self.state.arc0 -= pulls.iter().map(|pull| pull.rest).sum::<f64>();
        for part in self.parts() {
            part.insert_front(&thaw);
        }
        // the point of what was the clamp lies elsewhere since its neighbour moved, and nothing saw it slide
        self.carry_points(count, count);
        self.roll_with_core(count);
        self.place_supports();
        for i in 1..=count {
            let m = self.state.rod.mass(&self.model.section, i);
            self.state.balance.frozen_kinetic -= 0.5 * m * self.state.rod.v[i].norm_squared();
        }
        self.state.balance.frozen_stored += stored - self.stored();
        count
    }

    /// Gives the first `count` edges the spin of the turning core, now and in the instants before.
    fn roll_with_core(&mut self, count: usize) {
        if self.model.twist == Twist::Dynamic {
            for j in 0..count {
                self.state.rod.spin[j] = self.state.spindle.speed * self.state.rod.tangent(j).y;
            }
        }
        if self.state.past.roll[0].len() + count != self.state.rod.edges() {
            return;
        }
        let [h, h1] = self.state.past.h;
        let times = [0.0, h, h + h1].map(|dt| self.state.spindle.before(dt));
        for k in 0..2 {
            let [now, back] = [times[k].angle, times[k + 1].angle];
            let away = [now, back].map(|angle| turn_about_y(angle - self.state.spindle.angle));
            let frames = self.state.rod.frame[..count].iter();
            let rolls = frames.map(|f| roll_between(&(away[1] * f), &(away[0] * f)));
            self.state.past.roll[k].splice(0..0, rolls);
        }
        let spin = self.state.rod.spin[..count].iter();
        let share = if self.state.spindle.speed == 0.0 {
            1.0
        } else {
            times[1].speed / self.state.spindle.speed
        };
        self.state.past.spin.splice(0..0, spin.map(|s| s * share));
    }
}

/// Angle by which a frame has rolled on its way, against the shortest way of its edge, rad.
fn roll_between(from: &Quat, to: &Quat) -> f64 {
    let carried = align(from, &rotate(to, &V3::z()), 0.0);
    let roll = carried.conjugate() * to;
    2.0 * libm::atan2(roll.k, roll.w)
}
