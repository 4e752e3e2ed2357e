//! Wire that is drawn back over its clamp.
//!
//! A clamp holds the wire's direction. Wire that leaves it backwards is folded there, and at half a turn the bend of one node has
//! no direction: it would change sides, with the work of a whole turn. A real clamp lets wire fold over its edge. So does this one:
//! from [`HALF_TURN`] on it turns along with the wire.

use super::System;
use crate::math::{relative, turn_about_y};
use crate::rod::Joint;
use std::f64::consts::PI;

/// Turning angle of a node from which on its direction is not to be trusted, rad.
pub(crate) const HALF_TURN: f64 = 0.9 * PI;

impl System {
    /// Turns the clamp at the start by what the fold over it exceeds [`HALF_TURN`] by; says whether it does.
    ///
    /// What the bend there loses, the plastic bend loses too: moment, torque and stored energy stay what they are.
    pub fn turn_folded_clamp(&mut self) -> bool {
        let support = &mut self.state.support[0];
        let Some(clamp) = support.frame.filter(|_| support.turning) else {
            return false;
        };
        let rod = &mut self.state.rod;
        let first = turn_about_y(-self.state.spindle.angle) * rod.frame[0];
        let joint = Joint::between(&clamp, &first);
        let angle = libm::hypot(joint.bend[0], joint.bend[1]);
        if angle <= HALF_TURN {
            return false;
        }
        let kept = joint.bend.map(|bend| bend * HALF_TURN / angle);
        support.frame = Some(first * relative(kept, joint.twist).conjugate());
        let length = rod.voronoi(0);
        let gone = [0, 1].map(|a| joint.bend[a] - kept[a]);
        for (curvature, gone) in rod.bend[0].curvature.iter_mut().zip(gone) {
            *curvature -= gone / length;
        }
        // frozen wire before the clamp bends by what the clamp turns by, for when it thaws
        let history = &mut self.state.frozen_history;
        for mut before in history.split_off(1) {
            before.fold_end(gone);
            history.push(before);
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Quat, V3};
    use crate::rod::{Bend, Rod, Section};
    use crate::system::Support;

    /// Elastic curvature and twist between clamp and wire, and how far the wire is folded, rad.
    fn moment(sys: &System) -> ([f64; 2], f64, f64) {
        let rod = &sys.state.rod;
        let clamp = sys.state.support[0].frame.expect("a clamp");
        let first = turn_about_y(-sys.state.spindle.angle) * rod.frame[0];
        let joint = Joint::between(&clamp, &first);
        let plastic = rod.bend[0].curvature;
        let elastic = [0, 1].map(|a| joint.bend[a] / rod.voronoi(0) - plastic[a]);
        let angle = libm::hypot(joint.bend[0], joint.bend[1]);
        (elastic, joint.twist, angle)
    }

    #[test]
    fn a_folded_clamp_turns_and_its_moment_stays() {
        let points = [0.0, 1e-3, 2e-3].map(|z| V3::new(0.0, 0.0, z));
        for (fold, turns) in [(170_f64, true), (150.0, false)] {
            let mut sys = System::new(Section::table1_elastic(), Rod::through(&points, None));
            sys.state.spindle.angle = 0.4;
            let first = turn_about_y(-0.4) * sys.state.rod.frame[0];
            let bend = [0.6, 0.8].map(|share: f64| share * fold.to_radians());
            let clamp: Quat = first * relative(bend, 0.1).conjugate();
            sys.state.support[0] = Support {
                turning: true,
                ..Support::clamped(points[0], clamp)
            };
            let curvature = bend.map(|b| 0.9 * b / sys.state.rod.voronoi(0));
            sys.state.rod.bend[0] = Bend {
                curvature,
                rise: 1e-3,
            };
            let (elastic, twist, _) = moment(&sys);
            assert_eq!(sys.turn_folded_clamp(), turns);
            let (after, twist_after, angle) = moment(&sys);
            let most = if turns { HALF_TURN } else { fold.to_radians() };
            assert!((angle - most).abs() < 1e-9, "{angle}");
            assert!((twist_after - twist).abs() < 1e-9);
            for a in 0..2 {
                assert!(
                    (after[a] - elastic[a]).abs() < 1e-6,
                    "{after:?} {elastic:?}"
                );
            }
            assert!(!sys.turn_folded_clamp(), "once is enough");
        }
    }
}
