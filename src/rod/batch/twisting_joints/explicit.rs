//! Answers of all joints for the explicit methods: moments and couples by the laws, and the plastic
//! state.

use super::layout::{BEND, TWIST, TwistingJoints};
use crate::math::simd::ROWS;
use crate::math::{Quat, V3, rotate};
use crate::rod::forces::{ForceParts, Laws, Load};
use crate::rod::joint::Joint;
use crate::rod::plasticity::{beyond, respond_bend, respond_scalar};
use crate::rod::state::Rod;

impl TwistingJoints {
    /// Computes the moments and couples of the joints of `rod` for [`Forces`](crate::rod::Forces).
    ///
    /// With `parts.commit` the plastic state of `rod` and its frames become those of the present
    /// angles. Moments of the clamps (lab frame, N m), stored energy (J) and plastic work (J) are
    /// written into `load`.
    pub(in crate::rod::batch) fn respond_explicit(
        &mut self,
        rod: &mut Rod,
        laws: &Laws,
        clamp: &[Option<Quat>; 2],
        parts: ForceParts,
        load: &mut Load,
    ) {
        load.plastic = [0.0; 3];
        load.clamp_moment = [V3::zeros(); 2];
        load.stored = 0.0;
        load.beyond = 0.0;
        for j in 0..=self.edges {
            let (block, row) = (j / ROWS, j % ROWS);
            let end = (j == 0, j == self.edges);
            let was = || Joint::between(&rod.frame[j - 1], &rod.frame[j]);
            let inner = !end.0 && !end.1;
            let missing = (end.0 && clamp[0].is_none()) || (end.1 && clamp[1].is_none());
            let (mut m, mut torque) = ([0.0; 2], 0.0);
            if !missing {
                let angles = &self.angle.blocks()[block];
                let angle = [angles.get(BEND, row), angles.get(BEND + 1, row)];
                let lv = rod.voronoi(j);
                let inv = 1.0 / lv;
                let curvature = [angle[0] * inv, angle[1] * inv];
                let (moment, bend, work) = respond_bend(&laws.bend, &rod.bend[j], curvature);
                m = moment;
                load.stored += 0.5 * (m[0] * m[0] + m[1] * m[1]) / laws.bend.modulus * lv;
                if parts.commit && work > 0.0 {
                    if inner {
                        let before = was().bend.map(|angle| angle * inv);
                        let old = respond_bend(&laws.bend, &rod.bend[j], before).0;
                        let set = rod.bend[j].curvature;
                        let way = [0, 1].map(|k| bend.curvature[k] - set[k]);
                        load.beyond += beyond(old, m, way, work) * lv;
                    }
                    rod.bend[j] = bend;
                    load.plastic[0] += work * lv;
                }
                if parts.twist {
                    let rate = angles.get(TWIST, row) * inv;
                    let (t, twist, work) = respond_scalar(&laws.twist, &rod.twist[j], rate);
                    torque = t;
                    load.stored += 0.5 * t * t / laws.twist.modulus * lv;
                    if parts.commit && work > 0.0 {
                        if inner {
                            let before = was().twist * inv;
                            let old = respond_scalar(&laws.twist, &rod.twist[j], before).0;
                            let way = twist.strain - rod.twist[j].strain;
                            load.beyond += beyond([old], [t], [way], work) * lv;
                        }
                        rod.twist[j] = twist;
                        load.plastic[1] += work * lv;
                    }
                }
            }
            let answers = &mut self.answer.blocks_mut()[block];
            for (k, x) in [m[0], m[1], 1.0, torque].into_iter().enumerate() {
                answers.set(k, row, x);
            }
            if !missing && (end.0 || end.1) {
                let before = if end.0 {
                    clamp[0]
                } else {
                    Some(self.frame(j - 1))
                };
                if let Some(before) = before {
                    let joint = Joint::between(&before, &self.frame(j));
                    let moment = rotate(&before, &joint.moment(m, torque));
                    load.clamp_moment[usize::from(end.1)] = if end.0 { -moment } else { moment };
                }
            }
        }
        if parts.commit {
            for j in 0..self.edges {
                rod.frame[j] = self.frame(j);
            }
        }
    }
}
