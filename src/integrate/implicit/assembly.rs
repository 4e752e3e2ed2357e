//! Gradient and Hessian of the rod, gathered node by node from its joints and edges.
//!
//! Nothing is added up in memory. Each block of the matrix is put once, as the sum of what the
//! joints and edges around its node have ([`Joints`]), many nodes side by side.

use super::unknowns::{FAR, NEAR, ROW, Unknowns};
use crate::linalg::Banded;
use crate::math::V3;
use crate::math::simd::{Columns, Lanes, Lanes3, ROWS, RowBlock, WithSimd, run};
use crate::rod::YieldBranch;
use crate::rod::batch::{CROSS, GRADIENT, JOINT, Joints, OWN};
use pulp::Simd;

/// Columns of a node: where it would go without forces, its mass, where it is.
const NODE: usize = 7;
const TARGET: usize = 0;
const MASS: usize = 3;
const PLACE: usize = 4;

/// Columns of an edge: tension, tangent stiffness along and across itself.
const PULL: usize = 3;
const TENSION: usize = 0;
const STIFF: usize = 1;
const ACROSS: usize = 2;

/// Columns of an edge with the joints at its ends: lower half of the Hessian, gradient.
const EDGE: usize = 9;
const EDGE_OWN: usize = 0;
const EDGE_GRADIENT: usize = 6;

/// What an evaluation has laid out in columns.
#[derive(Clone, Debug, Default)]
pub(super) struct Assembly {
    nodes: Columns<NODE>,
    stretch: Columns<PULL>,
    /// energy of each node
    energy: Vec<f64>,
}

impl Assembly {
    /// Targets and masses of all nodes.
    pub(super) fn begin(&mut self, target: &[V3], mass: &[f64]) {
        self.nodes.fit(target.len());
        self.stretch.fit(target.len());
        self.energy.resize(target.len(), 0.0);
        for (i, (t, m)) in target.iter().zip(mass).enumerate() {
            self.nodes.set_vector(TARGET, i, t);
            self.nodes.set(MASS, i, *m);
        }
    }

    /// Edge `j` pulls with `tension` and has these stiffnesses along and across itself.
    #[inline(always)]
    pub(super) fn stretch(&mut self, j: usize, tension: f64, stiff: f64, across: f64) {
        let (block, row) = self.stretch.row_mut(j);
        block.set(TENSION, row, tension);
        block.set(STIFF, row, stiff);
        block.set(ACROSS, row, across);
    }

    /// Puts the gradient of rod and inertia at `q`, and with `HESSIAN` the matrix, and completes the yield branches;
    /// returns the energy of inertia and gravity, J.
    ///
    /// Inertia weighs `weight`, 1/s^2, for each mass; `gravity`, m/s^2, and everything else are in the core frame.
    pub(super) fn gather<const D: usize, U: Unknowns<D>, const HESSIAN: bool>(
        &mut self,
        q: &[V3],
        (weight, gravity): (f64, V3),
        yield_branches: &mut [(u32, YieldBranch)],
        (gradient, unknowns, matrix): (&mut Vec<V3>, &mut U, &mut Banded<D>),
    ) -> f64 {
        let Self {
            nodes,
            stretch,
            energy,
        } = self;
        nodes.put(q, |block, row, p| {
            block.set(PLACE, row, p.x);
            block.set(PLACE + 1, row, p.y);
            block.set(PLACE + 2, row, p.z);
        });
        if HESSIAN {
            matrix.resize(q.len());
        }
        gradient.resize(q.len(), V3::zeros());
        unknowns.fit(q.len());
        let out = Out {
            nodes,
            stretch,
            energy,
            gradient,
            unknowns,
            matrix,
            weight,
            gravity,
        };
        run(Gather::<D, U, HESSIAN>(yield_branches, out));
        energy.iter().sum()
    }
}

/// Joints, edges and nodes, block by block: edges need the joints at both ends, nodes the edges on both sides, so
/// these follow one block behind.
struct Gather<'a, const D: usize, U, const HESSIAN: bool>(
    &'a mut [(u32, YieldBranch)],
    Out<'a, D, U>,
);

/// What nodes have, and what is put for them.
struct Out<'a, const D: usize, U> {
    nodes: &'a Columns<NODE>,
    stretch: &'a Columns<PULL>,
    energy: &'a mut [f64],
    gradient: &'a mut [V3],
    unknowns: &'a mut U,
    matrix: &'a mut Banded<D>,
    weight: f64,
    gravity: V3,
}

impl<const D: usize, U: Unknowns<D>, const HESSIAN: bool> WithSimd for Gather<'_, D, U, HESSIAN> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self(mut yield_branches, mut out) = self;
        let blocks = out.unknowns.joints().blocks();
        let edges = out.gradient.len() - 1;
        let mut blocks_of_joints = [RowBlock::<JOINT>::default(); 2];
        let mut blocks_of_edges = [RowBlock::<EDGE>::default(); 2];
        let [mut joints, mut next] = blocks_of_joints.each_mut();
        let [mut before, mut around] = blocks_of_edges.each_mut();
        // (made once: clearing them is a tenth of the work)
        let (mut row, mut force) = ([[0.0; ROWS]; ROW], [[0.0; ROWS]; 4]);
        let all = out.unknowns.joints();
        all.joints::<S, HESSIAN>(simd, 0, joints, &mut yield_branches);
        for block in 0..blocks {
            let all = out.unknowns.joints();
            if block + 1 < blocks {
                all.joints::<S, HESSIAN>(simd, block + 1, next, &mut yield_branches);
            } else {
                *next = RowBlock::default();
            }
            next.follow(joints);
            for first in (0..ROWS).step_by(Lanes::<S>::COUNT) {
                let along = all.directions(simd, block, first);
                let stretch = &out.stretch.blocks()[block];
                edge::<S, HESSIAN>(simd, (along, stretch, joints), first, around);
            }
            for row in edges.saturating_sub(block * ROWS)..ROWS {
                // there is no edge behind the last node
                for k in 0..EDGE {
                    around.set(k, row, 0.0);
                }
            }
            around.follow(before);
            for first in (0..ROWS).step_by(Lanes::<S>::COUNT) {
                if block * ROWS + first <= edges {
                    let scratch = (&mut row, &mut force);
                    out.node::<S, HESSIAN>(simd, (joints, around), scratch, block, first);
                }
            }
            std::mem::swap(&mut joints, &mut next);
            std::mem::swap(&mut before, &mut around);
        }
    }
}

/// Sums of edges and the two joints at their ends.
#[inline(always)]
fn edge<S: Simd, const HESSIAN: bool>(
    simd: S,
    (t, stretch, joints): (Lanes3<S>, &RowBlock<PULL>, &RowBlock<JOINT>),
    first: usize,
    out: &mut RowBlock<EDGE>,
) {
    let pull = stretch.load(simd, TENSION, first, 1);
    let start = joints.load3(simd, GRADIENT[1], first, 1);
    let end = joints.load3(simd, GRADIENT[0], first, 2);
    out.store3(EDGE_GRADIENT, first, t * pull + (start + end));
    if !HESSIAN {
        return;
    }
    let across = stretch.load(simd, ACROSS, first, 1);
    let along = stretch.load(simd, STIFF, first, 1) - across;
    let start: [_; 6] = joints.load_all(simd, OWN[1], first, 1);
    let end: [_; 6] = joints.load_all(simd, OWN[0], first, 2);
    let (a, b) = (t.components(), (t * along).components());
    for r in 0..3 {
        for s in 0..r + 1 {
            let k = lower(r, s);
            let mut sum = b[r] * a[s] + (start[k] + end[k]);
            if r == s {
                sum += across;
            }
            out.store(EDGE_OWN + k, first, sum);
        }
    }
}

/// Place of an entry in the lower half of a symmetric block.
#[inline(always)]
fn lower(r: usize, s: usize) -> usize {
    if r > s {
        r * (r + 1) / 2 + s
    } else {
        s * (s + 1) / 2 + r
    }
}

impl<const D: usize, U: Unknowns<D>> Out<'_, D, U> {
    /// Rows of the matrix and the gradient of as many nodes as there are lanes.
    #[inline(always)]
    fn node<S: Simd, const HESSIAN: bool>(
        &mut self,
        simd: S,
        (joints, edges): (&RowBlock<JOINT>, &RowBlock<EDGE>),
        (row, force): (&mut [[f64; ROWS]; ROW], &mut [[f64; ROWS]; 4]),
        block: usize,
        first: usize,
    ) {
        let node = &self.nodes.blocks()[block];
        let mass = node.load(simd, MASS, first, 1);
        let k = mass * self.weight;
        let place = node.load3(simd, PLACE, first, 1);
        let d = place - node.load3(simd, TARGET, first, 1);
        let gravity = self.gravity;
        let pull = Lanes3::new(mass * gravity.x, mass * gravity.y, mass * gravity.z);
        let behind = edges.load3(simd, EDGE_GRADIENT, first, 0);
        let g = behind - edges.load3(simd, EDGE_GRADIENT, first, 1) + (d * k - pull);
        g.x.store(&mut force[0]);
        g.y.store(&mut force[1]);
        g.z.store(&mut force[2]);
        (d.dot(d) * (k * 0.5) - pull.dot(place)).store(&mut force[3]);
        let start = block * ROWS + first;
        for l in 0..Lanes::<S>::COUNT.min(self.gradient.len() - start) {
            let (i, l) = (start + l, l & (ROWS - 1));
            self.gradient[i] = V3::new(force[0][l], force[1][l], force[2][l]);
            self.energy[i] = force[3][l];
        }
        self.unknowns.put_torques(simd, joints, first, start);
        if !HESSIAN {
            return;
        }

        let behind: [_; 6] = edges.load_all(simd, EDGE_OWN, first, 0);
        let ahead: [_; 6] = edges.load_all(simd, EDGE_OWN, first, 1);
        let here: [_; 9] = joints.load_all(simd, CROSS, first, 1);
        let next: [_; 9] = joints.load_all(simd, CROSS, first, 2);
        for r in 0..3 {
            for s in 0..r + 1 {
                let n = lower(r, s);
                let mut sum = behind[n] + ahead[n] - (here[3 * r + s] + here[3 * s + r]);
                if r == s {
                    sum += k;
                }
                sum.store(&mut row[n]);
            }
            for s in 0..3 {
                let near = here[3 * r + s] + next[3 * r + s] - ahead[lower(r, s)];
                near.store(&mut row[NEAR + 4 * r + s]);
                (-next[3 * r + s]).store(&mut row[FAR + 4 * r + s]);
            }
        }
        U::put_rolls(simd, joints, first, row);
        for l in 0..Lanes::<S>::COUNT.min(self.gradient.len() - start) {
            let (i, l) = (start + l, l & (ROWS - 1));
            self.matrix.put(
                i,
                |r, s| row[lower(r, s)][l],
                |r, s| row[NEAR + 4 * r + s][l],
                |r, s| row[FAR + 4 * r + s][l],
            );
        }
    }
}
