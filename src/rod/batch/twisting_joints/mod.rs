//! Joints of a rod with twist: what [`twisted`](crate::rod::twisted()) does for one.

mod derivatives;
mod explicit;
mod forces;
mod layout;
mod passes;
#[cfg(test)]
mod tests;

use super::{JOINT, Joints, edge_of, put_places};
use crate::math::V3;
use crate::math::align;
use crate::math::simd::{Lanes3, ROWS, RowBlock, run};
use crate::rod::forces::Laws;
use crate::rod::joint::Joint;
use crate::rod::plasticity::{Bend, Scalar};
use crate::rod::twisting::{Turned, answer, twist_by};
use crate::rod::yield_branch::{YieldBranch, YieldBranches};
pub use forces::Forces;
pub use layout::TwistingJoints;
use layout::*;
use passes::{Angles, Edges, Elastic};
use pulp::Simd;

/// Below this the sine and cosine of a roll are series, see [`align`].
const SMALL_ROLL: f64 = 2e-3;

impl TwistingJoints {
    /// Computes edges and angles with the nodes at `q`, m, and the edges rolled by `roll`, rad,
    /// since [`Self::begin`].
    pub fn place(&mut self, q: &[V3], roll: &[f64]) {
        put_places(&mut self.places, q);
        self.roll.put(roll, |block, row, x| block.set(0, row, *x));
        // the pass over the edges goes over the far clamp's row
        let far = self.frame(self.edges);
        run(Edges(self));
        self.put_clamp(&far);
        for (j, roll) in roll.iter().enumerate() {
            if roll.abs() >= SMALL_ROLL {
                let from = quaternion(|a| self.from.get(FROM + a, j));
                let frame = align(&from, &self.along(j), *roll);
                for a in 0..4 {
                    self.edge.set(FRAME + a, j, frame.coords[a]);
                }
            }
        }
        self.edge.join();
        run(Angles(self));
        self.put_all_large_angles();
    }

    /// Puts right the angles that are too large for their series, in those blocks that have any.
    fn put_all_large_angles(&mut self) {
        for block in 0..self.large.len() {
            if !self.large[block] {
                continue;
            }
            for row in 0..ROWS.min(self.edges + 1 - block * ROWS) {
                let angle = &self.angle.blocks()[block];
                let (x, y, z) = (
                    angle.get(V, row),
                    angle.get(V + 1, row),
                    angle.get(V + 2, row),
                );
                let small = x * x + y * y < Joint::SERIES
                    && z.abs() < Joint::TWIST_SERIES * angle.get(W, row);
                if !small {
                    self.put_large_angles(block * ROWS + row);
                }
            }
        }
    }

    #[cold]
    fn put_large_angles(&mut self, j: usize) {
        let before = match j {
            0 => self.frame_before(),
            _ => self.frame(j - 1),
        };
        let joint = Joint::between(&before, &self.frame(j));
        let (bend, g) = (joint.bend, joint.series());
        self.angle.set(BEND, j, bend[0]);
        self.angle.set(BEND + 1, j, bend[1]);
        self.angle.set(TWIST, j, joint.twist);
        self.angle.set(G, j, g[0]);
        self.angle.set(G1, j, g[1]);
    }

    /// Computes the moments, couples and stiffnesses of all joints by their laws; returns their
    /// energy, J.
    ///
    /// Joints that may change their branch are appended to `yield_branches`, if given;
    /// [`Joints::joints`] completes those of bending.
    pub fn respond(&mut self, laws: &Laws, yield_branches: Option<&mut YieldBranches>) -> f64 {
        run(Elastic(self, laws));
        self.answer_near_yielding(laws, yield_branches)
    }

    /// Mends the elastic answers of joints that yield and finds those that may, in those blocks that have any; returns the energy
    /// of all, J.
    fn answer_near_yielding(
        &mut self,
        laws: &Laws,
        mut yield_branches: Option<&mut YieldBranches>,
    ) -> f64 {
        if let Some(yield_branches) = &mut yield_branches {
            self.find_twist_branches(laws, &mut yield_branches.twist);
        }
        let mut energy = 0.0;
        for block in 0..self.blocks() {
            let state = &self.state.blocks()[block];
            let angles = &self.angle.blocks()[block];
            let answers = &mut self.answer.blocks_mut()[block];
            let rows = ROWS.min(self.edges + 1 - block * ROWS);
            if self.near[block] == [false; 2] {
                // all far from yielding, as in the free span
                for row in 0..rows {
                    energy += answers.get(ENERGY, row);
                }
                continue;
            }
            for row in 0..rows {
                let j = block * ROWS + row;
                let (trial, limit) = (answers.get(PUSH, row), state.get(LIMIT, row));
                let yields =
                    trial > limit || answers.get(COUPLE, row).abs() > state.get(TWIST_LIMIT, row);
                if !yields {
                    energy += answers.get(ENERGY, row);
                    let rise = state.get(RISE, row);
                    if let Some(yield_branches) = &mut yield_branches
                        && YieldBranch::matters(&laws.bend, trial, rise)
                    {
                        let length = state.get(LV, row);
                        let stiffness = answers.get(STIFF, row);
                        yield_branches.bending.push((
                            j as u32,
                            YieldBranch::elastic(trial, rise, length, stiffness),
                        ));
                    }
                    continue;
                }
                let bend = Bend {
                    curvature: [state.get(SET, row), state.get(SET + 1, row)],
                    rise: state.get(RISE, row),
                };
                let twist = Scalar {
                    strain: state.get(TWIST_SET, row),
                    rise: state.get(TWIST_RISE, row),
                };
                let angle = [angles.get(BEND, row), angles.get(BEND + 1, row)];
                let lv = state.get(LV, row);
                let one = answer(laws, &bend, &twist, lv, angle, angles.get(TWIST, row));
                energy += one.energy;
                let [stiff, across, about] = one.stiffness;
                let [x, y] = one.along;
                let all = [x, y, one.push, one.torque, stiff, across, about, one.free];
                for (k, x) in all.into_iter().enumerate() {
                    answers.set(k, row, x);
                }
                if let (Some(yield_branches), Some(yield_branch)) =
                    (&mut yield_branches, one.yield_branch)
                {
                    yield_branches.bending.push((j as u32, yield_branch));
                }
            }
        }
        energy
    }

    /// Appends the joints that may change their branch of twist. Couples must still be the elastic
    /// ones.
    fn find_twist_branches(&self, laws: &Laws, yield_branches: &mut Vec<(u32, YieldBranch)>) {
        let law = &laws.twist;
        for (block, (answers, state)) in
            (self.answer.blocks().iter().zip(self.state.blocks())).enumerate()
        {
            let [_, near] = self.near[block];
            if !near {
                continue;
            }
            for row in 0..ROWS.min(self.edges + 1 - block * ROWS) {
                let (couple, rise) = (answers.get(COUPLE, row), state.get(TWIST_RISE, row));
                if !YieldBranch::matters(law, couple.abs(), rise) {
                    continue;
                }
                let j = block * ROWS + row;
                let before = match j {
                    0 => Turned::clamp(self.frame_before()),
                    _ => self.turned(j - 1),
                };
                let sign = 1f64.copysign(couple);
                let by = twist_by([&before, &self.turned(j)]);
                let lv = state.get(LV, row);
                let elastic = YieldBranch::elastic(couple.abs(), rise, lv, law.modulus / lv);
                let yield_branch = YieldBranch {
                    rows: by.map(|(edge, _)| edge * sign),
                    rolls: by.map(|(_, roll)| roll * sign),
                    ..elastic.at_present(law)
                };
                yield_branches.push((j as u32, yield_branch));
            }
        }
    }
}

impl Joints for TwistingJoints {
    fn blocks(&self) -> usize {
        self.edge.blocks().len()
    }

    #[inline(always)]
    fn directions<S: Simd>(&self, simd: S, block: usize, first: usize) -> Lanes3<S> {
        self.edge.blocks()[block].load3(simd, ALONG, first, 1)
    }

    #[inline(always)]
    fn edge(&self, j: usize) -> (V3, f64, f64) {
        edge_of(&self.edge, j, [ALONG, LENGTH, INVERSE])
    }

    #[inline(always)]
    fn derive<S: Simd, const HESSIAN: bool>(
        &self,
        simd: S,
        block: usize,
        first: usize,
        _near: bool,
        out: &mut RowBlock<JOINT>,
    ) {
        let all = (
            &self.edge.blocks()[block],
            &self.angle.blocks()[block],
            &self.answer.blocks()[block],
        );
        derivatives::joints::<S, HESSIAN>(simd, all, first, out);
    }
}
