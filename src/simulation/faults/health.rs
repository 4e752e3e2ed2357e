//! Health checks of the wire: finite, whole, and where it was sent.

use crate::measure::DefectKind;
use crate::simulation::{SimError, Winding};
use crate::system::HALF_TURN;
use std::f64::consts::TAU;

/// Wire that has passed the nozzle over what core and way can have taken up at most, from which on it runs away.
const RUNAWAY: f64 = 2.0;

impl Winding {
    /// Values must be finite, the wire below its strength and where it was sent.
    pub(in crate::simulation) fn check_health(&mut self) -> Result<(), SimError> {
        let rod = &self.sys.state.rod;
        let sums = rod.x.iter().zip(&rod.v).map(|(x, v)| x.sum() + v.sum());
        // (which node it is, is asked only where there is one)
        let sound = (sums.clone()).fold(true, |sound, sum| sound & sum.is_finite());
        if !sound && let Some(i) = sums.clone().position(|sum| !sum.is_finite()) {
            return Err(SimError {
                time: self.sys.state.time,
                node: Some(i),
                reason: format!(
                    "position or velocity is not finite after {} steps, the last of {:.3e} s; lower solver.step_share, or take solver.integrator = implicit if it is not in use",
                    self.run.steps, self.run.last_step
                ),
            });
        }
        self.check_feed();
        self.check_clearance();
        self.check_body();
        if self.run.over {
            return Ok(());
        }
        let strength = self.scene.wire.strength;
        if let Some((j, _)) = self
            .sys
            .state
            .load
            .tension
            .iter()
            .enumerate()
            .filter(|(_, t)| **t > strength)
            .max_by(|(_, a), (_, b)| a.total_cmp(b))
        {
            self.note_parted(j);
        } else if let Some((i, radius)) = self.kink() {
            let text = format!(
                "the wire broke: it is kinked at live node {i}, bent to a radius of {:.3} mm and itself {:.3} mm thick; keep it under tension there",
                1e3 * radius,
                1e3 * self.scene.wire.diameter
            );
            self.note_end(DefectKind::Break, i, text);
        }
        Ok(())
    }

    /// The wire must not run away from the nozzle.
    ///
    /// The line behind the nozzle has neither inertia nor an end. Wire that is fast under little
    /// tension therefore draws more wire after it, and each metre makes a step more expensive.
    /// A coil of springy wire that opens can start this, or a loop that whirls without tension.
    ///
    /// It does where more than [`RUNAWAY`] times the wire has come in that the largest possible core takes up.
    fn check_feed(&mut self) {
        let Some(feed) = self.sys.state.feed else {
            return;
        };
        let angle = (self.sys.state.spindle.angle - self.run.angle0).abs();
        let before = self.run.farthest;
        self.run.farthest = before.max(angle);
        self.tell_of_full_layers(before);
        let rod = &self.sys.state.rod;
        let way = (self.sys.state.support[1].point - rod.x[0]).norm();
        // a core cannot be larger than the nozzle's circle
        let most = way + (self.run.farthest + TAU) * self.nozzle_distance();
        if feed.fed <= RUNAWAY * most {
            return;
        }
        let text = format!(
            "the wire runs away from the nozzle, at {:.1} m/s under {:.2} N: {:.3} m of it have come in, more than twice what a core as large as the nozzle's circle could have taken up; raise the tension (tensioner.tension, or the input tension_setpoint) or turn the spindle more slowly",
            feed.rate, self.sys.state.set_tension, feed.fed
        );
        self.note_end(DefectKind::Runaway, self.sys.state.rod.nodes() - 1, text);
    }

    /// The first live node at which the wire is kinked, and the radius of its centreline there, m.
    ///
    /// No wire bends tighter than folded flat on itself, to its own radius. Nodes may gather the bend of
    /// their neighbours, so half of that is allowed. At half a turn the bend of a node has no direction any more and
    /// changes sides, with the work of a whole turn.
    fn kink(&self) -> Option<(usize, f64)> {
        let (rod, radius) = (&self.sys.state.rod, 0.5 * self.scene.wire.diameter);
        (1..rod.edges()).find_map(|i| {
            let (a, b) = (rod.x[i] - rod.x[i - 1], rod.x[i + 1] - rod.x[i]);
            let own = rod.voronoi(i);
            let most = (2.0 * own / radius).min(HALF_TURN);
            let square = most * most;
            // above the cosine of that angle, whatever it is
            let cosine = 1.0 - square * (0.5 - square / 24.0);
            if a.dot(&b) > cosine * a.norm() * b.norm() {
                return None;
            }
            let angle = libm::acos((a.dot(&b) / (a.norm() * b.norm())).clamp(-1.0, 1.0));
            (angle > most).then(|| (i, own / angle))
        })
    }
}
