//! Letting settled wire go.

use super::super::{FrozenNodeRecord, Support, System};
use crate::math::{Quat, Spin, V3, spin_velocity, turn_about_y};
use crate::rod::Joint;

impl System {
    /// Takes the first `count` nodes out of the computation; the node after them becomes the clamp.
    ///
    /// The wire just behind the new clamp keeps its direction such that the curvature and moment
    /// there stay what they are.
    pub fn freeze_front(&mut self, count: usize) {
        let spin = Spin::new(self.state.spindle.angle);
        let back = turn_about_y(-self.state.spindle.angle);
        let stored = self.stored();
        let mut handed = 0.0;
        for i in 1..=count {
            let v = spin_velocity(self.state.spindle.speed, self.state.rod.x[i]);
            handed += 0.5 * self.state.rod.mass(&self.model.section, i) * v.norm_squared();
        }
        let frame = self.frame_to_clamp(count);
        self.record_frozen(count);
        self.record_pulls(count);
        self.state.support[0] = Support {
            hold: [true; 3],
            point: spin.to_core(self.state.rod.x[count]),
            velocity: V3::zeros(),
            frame: Some(back * frame),
            turning: true,
        };
        self.state.arc0 += self.state.rod.rest[..count].iter().sum::<f64>();
        for part in self.parts() {
            part.remove_front(count);
        }
        self.place_supports();
        self.state.balance.frozen_kinetic += handed;
        self.state.balance.frozen_stored += stored - self.stored();
    }

    /// Frame of a clamp at an inner node that leaves curvature and moment there what they are.
    fn frame_to_clamp(&self, node: usize) -> Quat {
        let rod = &self.state.rod;
        let joint = Joint::between(&rod.frame[node - 1], &rod.frame[node]);
        let share = rod.rest[node] / (rod.rest[node - 1] + rod.rest[node]);
        let rel = crate::math::relative(
            [joint.bend[0] * share, joint.bend[1] * share],
            joint.twist * share,
        );
        rod.frame[node] * rel.conjugate()
    }

    /// Puts the first `count` nodes on record for [`Self::thaw_front`].
    fn record_frozen(&mut self, count: usize) {
        let Some(line) = self.state.contact.as_line() else {
            return;
        };
        let spin = Spin::new(self.state.spindle.angle);
        let back = turn_about_y(-self.state.spindle.angle);
        for i in 0..count {
            let clamp = match self.state.support[0].frame {
                Some(frame) if i == 0 => frame,
                _ if i == 0 => back * self.state.rod.frame[0],
                _ => back * self.frame_to_clamp(i),
            };
            let rod = &self.state.rod;
            self.state.frozen_history.push(FrozenNodeRecord {
                place: spin.to_core(rod.x[i]),
                frame: back * rod.frame[i],
                clamp,
                rest: rod.rest[i],
                spin: rod.spin[i],
                stretch: rod.stretch[i],
                bend: rod.bend[i],
                twist: rod.twist[i],
                end_bend: rod.bend[i + 1],
                end_twist: rod.twist[i + 1],
                memory: line.memory(i),
            });
        }
    }

    /// Unstretched lengths of the frozen edges, the last to freeze first, m.
    pub fn frozen_lengths(&self) -> impl Iterator<Item = f64> {
        self.state.frozen_pulls.iter().rev().map(|pull| pull.rest)
    }
}
