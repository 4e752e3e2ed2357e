//! Wire that has parted: the machine goes on, the wire stays as it was.

use super::Winding;
use crate::system::Drive;

impl Winding {
    /// Lets spindle and nozzle go on by `drive` for `dt`, s; all else stays as it was.
    pub(super) fn turn_on(&mut self, dt: f64, drive: &Drive) {
        if dt > 0.0 {
            self.sys.guide_nozzle(drive, dt);
        }
        self.sys.state.time += dt;
        self.sys.state.spindle = self.sys.state.spindle.after(dt);
        let support = &mut self.sys.state.support[1];
        support.point += support.velocity * dt;
    }

    /// Outputs of parted wire: it neither pulls nor moves on, and measures stay those of the moment it broke.
    pub(super) fn update_broken(&mut self) {
        self.raise_flags();
        let torque = -self.torque_of_inertia();
        let o = &mut self.run.outputs;
        o.spindle_angle = self.sys.state.spindle.angle - self.run.angle0;
        (o.wire_tension, o.spindle_torque, o.feed_speed) = (0.0, 0.0, 0.0);
        o.tensioner_speed = 0.0;
        o.nozzle_y = self.sys.state.support[1].point.y;
        o.spindle_torque_total = torque;
    }
}
