//! Wire that has parted: the machine goes on, the wire stays as it was.

use super::Winding;
use crate::math::{Spin, V3, turn_about_y};
use crate::system::Drive;

impl Winding {
    /// Gives the machine the motion at the start of `drive`. The nozzle holds no wire that has parted.
    pub(super) fn begin_drive(&mut self, drive: &Drive) {
        let end = self.sys.state.rod.x.last().copied();
        self.sys.begin_drive(drive);
        if let (true, Some(end), Some(x)) = (self.run.over, end, self.sys.state.rod.x.last_mut()) {
            *x = end;
        }
    }

    /// Lets spindle and nozzle go on by `drive` for `dt`, s; all wire goes round with the core, as it was on it.
    pub(super) fn turn_on(&mut self, dt: f64, drive: &Drive) {
        if dt > 0.0 {
            self.sys.guide_nozzle(drive, dt);
        }
        self.sys.state.time += dt;
        let before = self.sys.state.spindle;
        let after = before.after(dt);
        self.sys.state.spindle = after;
        let (from, to) = (Spin::new(before.angle), Spin::new(after.angle));
        let turn = turn_about_y(after.angle - before.angle);
        let rod = &mut self.sys.state.rod;
        rod.x
            .iter_mut()
            .for_each(|x| *x = to.to_lab(from.to_core(*x)));
        rod.frame
            .iter_mut()
            .for_each(|frame| *frame = turn * *frame);
        let support = &mut self.sys.state.support[1];
        support.point += support.velocity * dt;
    }

    /// The first live edge that nothing pulls any more, once winding has ended: from where the wire parted, or left the coil.
    /// [`usize::MAX`] before.
    pub(super) fn first_loose_edge(&self) -> usize {
        if !self.run.over {
            return usize::MAX;
        }
        let parted = self.run.outputs.break_position;
        let arc0 = self.sys.state.arc0;
        let mut before = 0.0;
        let pulled = self.sys.state.rod.rest.iter().take_while(|rest| {
            before += **rest;
            // (an edge that parts within itself pulls no more)
            parted == 0.0 || arc0 + before <= parted
        });
        pulled.count().min(self.lift_off())
    }

    /// Outputs of parted wire: it neither pulls nor moves on, and measures stay those of the moment it broke.
    pub(super) fn update_broken(&mut self) {
        self.raise_flags();
        let torque = -self.torque_of_inertia();
        let o = &mut self.run.outputs;
        let angle = self.sys.state.spindle.angle - self.run.angle0;
        // (the place where wire was last laid goes round with the core)
        let turned = Spin::new(angle - o.spindle_angle);
        let layon = turned.to_lab(V3::new(o.layon_x, 0.0, o.layon_z));
        (o.layon_x, o.layon_z) = (layon.x, layon.z);
        o.spindle_angle = angle;
        (o.wire_tension, o.spindle_torque, o.feed_speed) = (0.0, 0.0, 0.0);
        o.meet_tension(0.0);
        o.tensioner_speed = 0.0;
        o.nozzle_y = self.sys.state.support[1].point.y;
        o.spindle_torque_total = torque;
    }
}
