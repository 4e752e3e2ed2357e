//! One joint that bends and twists: the slow twin of [`TwistingJoints`](crate::rod::TwistingJoints), for tests.

use super::{Turned, answer};
use crate::math::{V3, add_outer};
use crate::rod::bending::{Bent, Symmetric, add_square};
use crate::rod::forces::Laws;
use crate::rod::joint::Joint;
use crate::rod::plasticity::{Bend, Scalar};
use crate::rod::yield_branch::YieldBranch;

/// Derivatives of the energy of a joint in which the rolls of its edges take part; index 0 is the
/// edge before the joint, 1 the edge after it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rolled {
    /// derivative of the energy with respect to the rolls, N m
    pub torque: [f64; 2],
    /// Hessian, roll by roll: before-before, before-after, after-after, N m
    pub own: [f64; 3],
    /// Hessian, roll by edge vector, N
    pub with: [[V3; 2]; 2],
}

/// Bending and twist of a joint of Voronoi length `lv`, m.
#[inline]
pub fn twisted(
    laws: &Laws,
    bend: &Bend,
    twist: &Scalar,
    lv: f64,
    [before, after]: [&Turned; 2],
) -> (Bent, Rolled) {
    let joint = Joint::between(&before.frame, &after.frame);
    let law = answer(laws, bend, twist, lv, joint.bend, joint.twist);
    // derivatives of the angles with respect to the rotation of the edge after against the one
    // before, for bending along the moment and across it
    let rows = joint.rows();
    let (d, free) = (law.along, law.free);
    let turn = before.frame_matrix();
    let lead = turn * (rows[0] * d[0] + rows[1] * d[1]);
    let side = turn * (rows[1] * d[0] - rows[0] * d[1]);
    let about = turn * rows[2];
    // gradients by edge vectors and rolls, first edge with its sign
    let pair = |row: &V3, free: f64| {
        let ((w0, r0), (w1, r1)) = (before.derivative(row), after.derivative(row));
        [
            (before.detour * (free * before.inverse) - w0, free - r0),
            (w1 + after.detour * (free * after.inverse), r1 + free),
        ]
    };
    let lead = pair(&lead, 0.0);
    let side = pair(&side, free);
    let about = pair(&about, 0.0);
    let (push, t) = (law.push, law.torque);
    let mut bent = Bent {
        energy: law.energy,
        before: lead[0].0 * push + about[0].0 * t,
        after: lead[1].0 * push + about[1].0 * t,
        own: [Symmetric::default(); 2],
        cross: [[0.0; 3]; 3],
        yield_branch: law.yield_branch.map(|yield_branch| YieldBranch {
            rows: [lead[0].0, lead[1].0],
            rolls: [lead[0].1, lead[1].1],
            ..yield_branch
        }),
    };
    let mut rolled = Rolled {
        torque: [0, 1].map(|k| lead[k].1 * push + about[k].1 * t),
        ..Rolled::default()
    };
    for ([(w0, r0), (w1, r1)], c) in [
        (lead, law.stiffness[0]),
        (side, law.stiffness[1]),
        (about, law.stiffness[2]),
    ] {
        add_square(&mut bent.own[0], &w0, c);
        add_square(&mut bent.own[1], &w1, c);
        add_outer(&mut bent.cross, &(w0 * c), &w1);
        let (c0, c1) = (c * r0, c * r1);
        rolled.own[0] += c0 * r0;
        rolled.own[1] += c0 * r1;
        rolled.own[2] += c1 * r1;
        rolled.with[0][0] += w0 * c0;
        rolled.with[0][1] += w1 * c0;
        rolled.with[1][0] += w0 * c1;
        rolled.with[1][1] += w1 * c1;
    }
    (bent, rolled)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Quat, frame_along, relative, rotate};
    use crate::rod::Section;
    use nalgebra::{SMatrix, SVector};
    use proptest::prelude::*;

    /// Two edge vectors, each followed by its roll.
    type Place = SVector<f64, 8>;
    type Hessian = SMatrix<f64, 8, 8>;

    const LV: f64 = 0.5e-3;

    /// A joint: where its edges were at the last instant, how their frames stand, and its plastic
    /// state.
    #[derive(Clone, Copy, Debug)]
    struct Setting {
        frames: [Quat; 2],
        bend: Bend,
        twist: Scalar,
        laws: Laws,
    }

    fn laws(yields: bool) -> Laws {
        let open = f64::INFINITY;
        let limit = |x: f64| if yields { x } else { open };
        Laws::new(&Section {
            m_y: limit(5.72e-3),
            t_y: limit(6e-3),
            ..Section::table1_elastic()
        })
    }

    impl Setting {
        /// Frames along `was`, twisted against each other.
        fn new(was: [V3; 2], twist: f64, yields: bool) -> Self {
            let before = frame_along(&was[0].normalize(), None);
            let after = frame_along(&was[1].normalize(), Some(&before));
            Self {
                frames: [before, after * relative([0.0; 2], twist)],
                bend: Bend::default(),
                twist: Scalar::default(),
                laws: laws(yields),
            }
        }

        fn turned(&self, p: &Place) -> [Turned; 2] {
            [0, 1].map(|k| {
                let d = V3::new(p[4 * k], p[4 * k + 1], p[4 * k + 2]);
                let l = d.norm();
                let start = rotate(&self.frames[k], &V3::z());
                Turned::edge(&self.frames[k], &start, d / l, 1.0 / l, p[4 * k + 3])
            })
        }

        fn at(&self, p: &Place) -> (Bent, Rolled) {
            let [a, b] = self.turned(p);
            twisted(&self.laws, &self.bend, &self.twist, LV, [&a, &b])
        }

        fn gradient(&self, p: &Place) -> Place {
            let (b, r) = self.at(p);
            let (x, y, [s, t]) = (b.before, b.after, r.torque);
            Place::from_row_slice(&[x.x, x.y, x.z, s, y.x, y.y, y.z, t])
        }

        fn hessian(&self, p: &Place) -> Hessian {
            let (b, r) = self.at(p);
            let mut h = Hessian::zeros();
            for k in 0..2 {
                let (o, at) = (b.own[k], 4 * k);
                let own = [[o[0], o[1], o[3]], [o[1], o[2], o[4]], [o[3], o[4], o[5]]];
                for (i, j) in (0..9).map(|q| (q / 3, q % 3)) {
                    h[(at + i, at + j)] = own[i][j];
                    h[(i, 4 + j)] = b.cross[i][j];
                    h[(4 + j, i)] = b.cross[i][j];
                }
                for (e, i) in (0..6).map(|q| (q / 3, q % 3)) {
                    h[(at + 3, 4 * e + i)] = r.with[k][e][i];
                    h[(4 * e + i, at + 3)] = r.with[k][e][i];
                }
            }
            for (i, j, k) in [(3, 3, 0), (3, 7, 1), (7, 3, 1), (7, 7, 2)] {
                h[(i, j)] = r.own[k];
            }
            h
        }

        /// A length for each unknown that makes their derivatives comparable.
        fn scale(k: usize) -> f64 {
            if k % 4 == 3 { 1.0 } else { LV }
        }

        fn check_gradient(&self, p: &Place) {
            let g = self.gradient(p);
            let size: f64 = (0..8).map(|k| g[k].abs() * Self::scale(k)).sum();
            for k in 0..8 {
                let h = 1e-6 * Self::scale(k);
                let energy = |s: f64| {
                    let mut q = *p;
                    q[k] += s * h;
                    self.at(&q).0.energy
                };
                let got = (energy(1.0) - energy(-1.0)) / 2e-6;
                let want = g[k] * Self::scale(k);
                assert!(
                    (got - want).abs() < 1e-5 * size + 1e-10,
                    "unknown {k}: {got} by differences, {want}"
                );
            }
        }

        fn check_semidefinite(&self, p: &Place) {
            let mut h = self.hessian(p);
            for (i, j) in (0..64).map(|q| (q / 8, q % 8)) {
                h[(i, j)] *= Self::scale(i) * Self::scale(j);
            }
            assert!((h - h.transpose()).norm() == 0.0);
            let least = h.symmetric_eigenvalues().min();
            assert!(least > -1e-12 * h.norm(), "{least} of {}", h.norm());
        }

        /// Where nothing is stressed the part that Gauss-Newton leaves out vanishes.
        fn check_hessian(mut self, p: &Place) {
            let [a, b] = self.turned(p);
            let joint = Joint::between(&a.frame, &b.frame);
            self.bend.curvature = joint.bend.map(|k| k / LV);
            self.twist.strain = joint.twist / LV;
            let h = self.hessian(p);
            let size = (0..8).map(|k| h[(k, k)] * Self::scale(k).powi(2));
            let size: f64 = size.sum();
            for k in 0..8 {
                let step = 1e-6 * Self::scale(k);
                let at = |s: f64| {
                    let mut q = *p;
                    q[k] += s * step;
                    self.gradient(&q)
                };
                let column = (at(1.0) - at(-1.0)) / 2e-6;
                for i in 0..8 {
                    let got = column[i] * Self::scale(i);
                    let want = h[(i, k)] * Self::scale(i) * Self::scale(k);
                    assert!((got - want).abs() < 1e-5 * size, "{i} {k}: {got} {want}");
                }
            }
        }

        fn check(&self, p: &Place) {
            self.check_gradient(p);
            self.check_semidefinite(p);
            self.check_hessian(p);
        }
    }

    fn place(a: V3, roll: f64, b: V3, other: f64) -> Place {
        Place::from_row_slice(&[a.x, a.y, a.z, roll, b.x, b.y, b.z, other])
    }

    fn edge() -> impl Strategy<Value = V3> {
        (0.2..1.0f64, -1.0..1.0f64, -1.0..1.0f64).prop_map(|(x, y, z)| V3::new(x, y, z) * 5e-4)
    }

    proptest! {
        #[test]
        fn derivatives(now in [edge(), edge()], was in [edge(), edge()], rolls in prop::array::uniform2(-0.6..0.6f64),
            twist in -1.0..1.0f64, set in prop::array::uniform2(-100.0..100.0f64), strain in -300.0..300.0f64) {
            for yields in [false, true] {
                let mut s = Setting::new(was, twist, yields);
                s.bend = Bend { curvature: set, rise: 1e-3 };
                s.twist = Scalar { strain, rise: 2e-3 };
                s.check(&place(now[0], rolls[0], now[1], rolls[1]));
            }
        }

        /// What is minimised is what is committed: the forces of the explicit path at the same
        /// place.
        #[test]
        fn forces_are_those_of_the_joints(now in [edge(), edge()], was in [edge(), edge()], rolls in prop::array::uniform2(-0.6..0.6f64)) {
            use crate::rod::{ForceParts, Load, Rod, internal_forces, stored_energy};
            let mut s = Setting::new(was, 0.3, true);
            s.bend.curvature = [30.0, -20.0];
            s.twist.strain = 50.0;
            let mut rod = Rod::through(&[V3::zeros(), now[0], now[0] + now[1]], None);
            rod.frame = s.frames.to_vec();
            rod.bend[1] = s.bend;
            rod.twist[1] = s.twist;
            let lv = rod.voronoi(1);
            let p = place(now[0], rolls[0], now[1], rolls[1]);
            let [a, b] = s.turned(&p);
            let (bent, rolled) = twisted(&s.laws, &s.bend, &s.twist, lv, [&a, &b]);
            let mut load = Load::default();
            load.fit(&rod);
            let parts = ForceParts { commit: true, twist: true };
            internal_forces(&mut rod, &s.laws, &[None, None], &rolls, parts, &mut load);
            let stored: f64 = stored_energy(&rod, &s.laws, &[None, None], true).iter().sum();
            let total = stored + load.plastic.iter().sum::<f64>();
            prop_assert!((bent.energy / total - 1.0).abs() < 1e-12);
            for k in 0..2 {
                prop_assert!((rolled.torque[k] + load.torque[k]).abs() < 1e-14);
            }
            // without the detour of the shortest way from the last instant, which the torque does
            // work on
            let first = bent.before - a.detour * (rolled.torque[0] * a.inverse);
            let last = bent.after - b.detour * (rolled.torque[1] * b.inverse);
            let scale = first.norm() + last.norm();
            prop_assert!((load.force[0] - first).norm() < 1e-12 * scale);
            prop_assert!((load.force[2] + last).norm() < 1e-12 * scale);
        }
    }

    #[test]
    fn straight_folded_and_far_twisted() {
        let l = 5e-4;
        let x = V3::x() * l;
        let a = 170f64.to_radians();
        let fold = V3::new(a.cos(), a.sin(), 0.0) * l;
        for yields in [false, true] {
            for twist in [0.0, 1e-9, 0.3, 2.5] {
                Setting::new([x, x], twist, yields).check(&place(x, 0.0, x, 1e-7));
            }
            for twist in [0.0, 0.4] {
                let was = [x, V3::new(a.cos(), a.sin(), 0.1) * l];
                Setting::new(was, twist, yields).check(&place(x, 0.1, fold, -0.1));
            }
        }
    }

    #[test]
    fn a_clamp_does_not_move() {
        let l = 5e-4;
        let frame = frame_along(&V3::x(), None);
        let d = V3::new(1.0, 0.3, -0.2).normalize();
        let edge = Turned::edge(&frame, &rotate(&frame, &V3::z()), d, 1.0 / l, 0.2);
        let (bent, rolled) = twisted(
            &laws(false),
            &Bend::default(),
            &Scalar::default(),
            0.5 * l,
            [&Turned::clamp(frame), &edge],
        );
        assert!(bent.before == V3::zeros() && bent.own[0] == [0.0; 6]);
        assert!(bent.after.norm() > 0.0 && rolled.torque[1] > 0.0);
    }
}
