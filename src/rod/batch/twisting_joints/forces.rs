//! Internal forces of a rod, many joints at once: what
//! [`internal_forces`](crate::rod::internal_forces()) does joint by joint.

use super::TwistingJoints;
use crate::math::simd::{Lanes, ROWS, RowBlock, WithSimd, run};
use crate::math::{Quat, V3};
use crate::rod::batch::{GRADIENT, JOINT, Joints, TORQUE};
use crate::rod::forces::{ForceParts, Laws, Load};
use crate::rod::plasticity::{beyond, respond_scalar};
use crate::rod::state::Rod;
use pulp::Simd;

/// Internal forces of a rod; holds working memory only, no state.
#[derive(Debug, Default)]
pub struct Forces {
    joints: TwistingJoints,
    along: Vec<V3>,
}

/// A copy starts with empty arrays.
impl Clone for Forces {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl Forces {
    /// Adds the internal forces of `rod` into a fitted `load`, see
    /// [`internal_forces`](crate::rod::internal_forces()).
    pub fn add(
        &mut self,
        rod: &mut Rod,
        laws: &Laws,
        clamp: &[Option<Quat>; 2],
        roll: &[f64],
        parts: ForceParts,
        load: &mut Load,
    ) {
        let edges = rod.edges();
        self.along.clear();
        self.along
            .extend(rod.x.windows(2).map(|x| (x[1] - x[0]).normalize()));
        // frames go the shortest way from where they are, not from an instant before
        self.joints.begin(&rod.frame, &self.along, *clamp);
        self.joints.place(&rod.x, roll);
        self.joints.respond_explicit(rod, laws, clamp, parts, load);
        for j in 0..edges {
            let (_, length, _) = self.joints.edge(j);
            let (tension, state, work) =
                respond_scalar(&laws.stretch, &rod.stretch[j], length / rod.rest[j] - 1.0);
            load.stored += 0.5 * tension * tension / laws.stretch.modulus * rod.rest[j];
            let was = std::mem::replace(&mut load.tension[j], tension);
            load.torque[j] = 0.0;
            load.tangent[j] = self.along[j];
            if parts.commit && work > 0.0 {
                // (the edge at the nozzle grows: its work is counted there)
                if j + 1 < edges {
                    let way = state.strain - rod.stretch[j].strain;
                    load.beyond += beyond([was], [tension], [way], work) * rod.rest[j];
                }
                rod.stretch[j] = state;
                load.plastic[2] += work * rod.rest[j];
            }
            let pull = self.along[j] * tension;
            load.force[j] += pull;
            load.force[j + 1] -= pull;
        }
        run(Add {
            joints: &self.joints,
            edges,
            twist: parts.twist,
            load,
        });
    }
}

/// Forces and torques of the joints, from their gradients.
struct Add<'a> {
    joints: &'a TwistingJoints,
    edges: usize,
    twist: bool,
    load: &'a mut Load,
}

impl WithSimd for Add<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let mut out = RowBlock::<JOINT>::default();
        for block in 0..self.joints.blocks() {
            for first in (0..ROWS).step_by(Lanes::<S>::COUNT) {
                self.joints
                    .derive::<S, false>(simd, block, first, false, &mut out);
            }
            for row in 0..ROWS.min(self.edges + 1 - block * ROWS) {
                let j = block * ROWS + row;
                for (side, k) in [(0, j.wrapping_sub(1)), (1, j)] {
                    if k >= self.edges {
                        continue;
                    }
                    let at = |a: usize| out.get(GRADIENT[side] + a, row);
                    let g = V3::new(at(0), at(1), at(2));
                    self.load.force[k] += g;
                    self.load.force[k + 1] -= g;
                    if self.twist {
                        self.load.torque[k] -= out.get(TORQUE + side, row);
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{frame_along, relative};
    use crate::rod::{Bend, Scalar, Section, internal_forces};
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    /// A crooked rod that yields in places, and what its edges have rolled.
    fn rod(seed: u64, edges: usize, crooked: f64) -> (Rod, Vec<f64>) {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut number = move || rng.next_u32() as f64 / f64::from(u32::MAX) * 2.0 - 1.0;
        let mut some = |size: f64| V3::new(number(), number(), number()) * size;
        let mut x = vec![V3::zeros()];
        for j in 0..edges {
            x.push(x[j] + V3::new(0.0, 0.0, 5e-4) + some(crooked * 5e-4));
        }
        let mut rod = Rod::through(&x, Some(vec![4.99e-4; edges]));
        for x in &mut rod.x {
            *x += some(0.1 * crooked * 5e-4);
        }
        for frame in &mut rod.frame {
            *frame *= relative([0.0; 2], some(0.3).x);
        }
        for i in 0..=edges {
            let k = some(200.0);
            rod.bend[i] = Bend {
                curvature: [k.x, k.y],
                rise: k.z.abs() * 1e-5,
            };
            rod.twist[i] = Scalar {
                strain: some(20.0).x,
                rise: 0.0,
            };
        }
        let roll = (0..edges)
            .map(|j| some(if j % 4 == 0 { 0.1 } else { 1e-3 }).x)
            .collect();
        (rod, roll)
    }

    /// The slow twin is one joint after the other.
    #[test]
    fn they_are_those_of_the_joints_one_by_one() {
        let laws = Laws::new(&Section {
            m_y: 5.72e-3,
            t_y: 6e-3,
            n_y: 60.0,
            ..Section::table1_elastic()
        });
        for (seed, edges, crooked) in [(1, 30, 0.05), (2, 7, 0.5), (3, 1, 0.9), (4, 16, 0.8)] {
            for twist in [true, false] {
                let (mut slow, roll) = rod(seed, edges, crooked);
                let ends = [slow.x[0], slow.x[1]];
                let clamp = [
                    Some(frame_along(
                        &(ends[1] - ends[0] + V3::x() * 1e-5).normalize(),
                        None,
                    )),
                    (seed % 2 == 0).then(|| frame_along(&V3::new(0.1, 0.2, 0.9).normalize(), None)),
                ];
                let mut fast = slow.clone();
                let (mut a, mut b) = (Load::default(), Load::default());
                let commit = seed != 4;
                let parts = ForceParts { commit, twist };
                a.fit(&slow);
                internal_forces(&mut slow, &laws, &clamp, &roll, parts, &mut a);
                b.fit(&fast);
                Forces::default().add(&mut fast, &laws, &clamp, &roll, parts, &mut b);
                let size = a.force.iter().map(|f| f.norm()).fold(0.0, f64::max);
                assert!(size > 0.0);
                for (f, g) in a.force.iter().zip(&b.force) {
                    assert!((f - g).norm() < 1e-10 * size, "{f:?} {g:?}");
                }
                let near = |p: f64, q: f64, size: f64| {
                    assert!((p - q).abs() <= 1e-10 * (size + p.abs()), "{p} {q}");
                };
                for j in 0..edges {
                    near(a.torque[j], b.torque[j], 1e-2);
                    near(a.tension[j], b.tension[j], 1.0);
                    near(slow.stretch[j].strain, fast.stretch[j].strain, 1.0);
                    assert!((slow.frame[j].coords - fast.frame[j].coords).norm() < 1e-12);
                }
                for i in 0..=edges {
                    for k in 0..2 {
                        near(slow.bend[i].curvature[k], fast.bend[i].curvature[k], 1.0);
                    }
                    near(slow.twist[i].strain, fast.twist[i].strain, 1.0);
                }
                for k in 0..3 {
                    near(a.plastic[k], b.plastic[k], 1e-6);
                }
                for end in 0..2 {
                    assert!((a.clamp_moment[end] - b.clamp_moment[end]).norm() < 1e-12);
                }
                near(a.stored, b.stored, 0.0);
                if commit {
                    let stored = crate::rod::stored_energy(&fast, &laws, &clamp, twist);
                    near(b.stored, stored.iter().sum(), 0.0);
                }
            }
        }
    }
}
