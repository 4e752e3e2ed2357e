//! Wire that has parted: the machine goes on, the wire stays as it was.

use crate::math::{Spin, V3, turn_about_y};
use crate::signals::Outputs;
use crate::simulation::Winding;
use crate::system::Drive;

/// What ends with the wire: its tension at the nozzle, what it does to the spindle, and how fast it comes.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::simulation) struct Pull {
    tension: f64,
    torque: f64,
    torque_total: f64,
    speed: f64,
    tensioner_speed: f64,
}

impl Pull {
    pub(in crate::simulation) fn write(self, o: &mut Outputs) {
        o.wire_tension = self.tension;
        o.spindle_torque = self.torque;
        o.spindle_torque_total = self.torque_total;
        o.feed_speed = self.speed;
        o.tensioner_speed = self.tensioner_speed;
    }
}

impl Winding {
    /// Gives the machine the motion at the start of `drive`. The nozzle holds no wire that has parted.
    pub(in crate::simulation) fn begin_drive(&mut self, drive: &Drive) {
        let end = self.sys.state.rod.x.last().copied();
        self.sys.begin_drive(drive);
        if let (true, Some(end), Some(x)) = (self.run.over, end, self.sys.state.rod.x.last_mut()) {
            *x = end;
        }
    }

    /// Lets spindle and nozzle go on by `drive` for `dt`, s; all wire goes round with the core, as it was on it.
    pub(in crate::simulation) fn turn_on(&mut self, dt: f64, drive: &Drive) {
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
    pub(in crate::simulation) fn first_loose_edge(&self) -> usize {
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
    pub(in crate::simulation) fn update_broken(&mut self) {
        self.raise_flags();
        let o = &mut self.run.outputs;
        let angle = self.sys.state.spindle.angle - self.run.angle0;
        // (the place where wire was last laid goes round with the core)
        let turned = Spin::new(angle - o.spindle_angle);
        let layon = turned.to_lab(V3::new(o.layon_x, 0.0, o.layon_z));
        (o.layon_x, o.layon_z) = (layon.x, layon.z);
        o.spindle_angle = angle;
        o.nozzle_y = self.sys.state.support[1].point.y;
        self.let_go();
    }

    /// Tells of wire that neither pulls nor moves.
    pub(in crate::simulation) fn let_go(&mut self) {
        let torque_total = -self.torque_of_inertia();
        let o = &mut self.run.outputs;
        Pull {
            torque_total,
            ..Pull::default()
        }
        .write(o);
        o.meet_tension(0.0);
    }

    /// Outputs at the end of a step of the method; where winding has ended in it, with the pull that the wire had until then.
    pub(in crate::simulation) fn until_it_parted(&self) -> Outputs {
        let mut outputs = self.run.outputs;
        self.pull().write(&mut outputs);
        outputs
    }

    /// The pull of the wire as the last step of the method left it.
    pub(in crate::simulation) fn pull(&self) -> Pull {
        let state = &self.sys.state;
        let feed = state.feed.unwrap_or_default();
        let torque = state.torque_on_core + state.pressed;
        Pull {
            tension: self.wire_tension(),
            torque,
            torque_total: torque - self.torque_of_inertia(),
            speed: feed.rate,
            tensioner_speed: feed.paid_rate,
        }
    }
}
