//! Gradient and Hessian of a rod with twist, gathered node by node from its joints and edges.
//!
//! Nothing is added up in memory: each block of the matrix is put once, as the sum of what the
//! joints and edges around its node have ([`Batch`]), many nodes side by side.

use super::Work;
use crate::integrate::Banded;
use crate::lanes::{Columns, Lanes, Lanes3, WithSimd, run};
use crate::math::V3;
use crate::rod::Batch;
use pulp::Simd;

/// Columns of a node: where it would go without forces, and its mass.
const TARGET: usize = 0;
const MASS: usize = 3;

/// Columns of an edge: tension, tangent stiffness along and across itself.
const TENSION: usize = 0;
const STIFF: usize = 1;
const ACROSS: usize = 2;

/// Columns of an edge with the joints at its ends: lower half of the Hessian, gradient.
const OWN: usize = 0;
const GRADIENT: usize = 6;

/// Lanes there may be.
const MOST: usize = 8;
/// Numbers of a node's row of the matrix: lower half of its own block, blocks with the next node and the one after.
const ROW: usize = 10 + 16 + 16;

/// What an evaluation has laid out in columns.
#[derive(Clone, Debug, Default)]
pub(super) struct Sheet {
    pub(super) batch: Batch,
    nodes: Columns<4>,
    stretch: Columns<3>,
    /// row 0 is before the first edge
    edges: Columns<9>,
    places: Columns<3>,
    energy: Columns<1>,
}

impl Sheet {
    /// Targets and masses of all nodes.
    pub(super) fn begin(&mut self, target: &[V3], mass: &[f64]) {
        let rows = target.len() + 2;
        self.nodes.fit(rows);
        self.stretch.fit(rows);
        self.edges.fit(rows);
        self.places.fit(rows);
        self.energy.fit(rows);
        for (i, (t, m)) in target.iter().zip(mass).enumerate() {
            self.nodes.set_vector(TARGET, i, t);
            self.nodes.set(MASS, i, *m);
        }
    }

    /// Edge `j` pulls with `tension` and has these stiffnesses along and across itself.
    #[inline(always)]
    pub(super) fn stretch(&mut self, j: usize, tension: f64, stiff: f64, across: f64) {
        self.stretch.set(TENSION, j, tension);
        self.stretch.set(STIFF, j, stiff);
        self.stretch.set(ACROSS, j, across);
    }
}

/// Puts gradient and matrix of rod and inertia; returns the energy of inertia and `gravity`.
pub(super) fn gather<const D: usize>(work: &mut Work<D>, weight: f64, gravity: V3) -> f64 {
    let nodes = work.q.len();
    let Work {
        sheet,
        q,
        gradient,
        matrix,
        rolls,
        ..
    } = work;
    for (i, p) in q.iter().enumerate() {
        sheet.places.set_vector(0, i, p);
    }
    run(Edges(sheet, nodes - 1));
    for k in 0..9 {
        // there is no edge behind the last node
        sheet.edges.set(k, nodes, 0.0);
    }
    matrix.resize(nodes);
    gradient.resize(nodes, V3::zeros());
    rolls.gradient.resize(nodes, 0.0);
    run(Nodes {
        sheet,
        gradient,
        torque: &mut rolls.gradient,
        matrix,
        weight,
        gravity,
    });
    sheet.energy.at(0, 0)[..nodes].iter().sum()
}

/// Sums of an edge and the two joints at its ends.
struct Edges<'a>(&'a mut Sheet, usize);

impl WithSimd for Edges<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self(sheet, edges) = self;
        for j in (0..edges).step_by(Lanes::<S>::COUNT) {
            let (t, _) = sheet.batch.edges(simd, j);
            let pull = sheet.stretch.load(simd, TENSION, j);
            let across = sheet.stretch.load(simd, ACROSS, j);
            let along = sheet.stretch.load(simd, STIFF, j) - across;
            let (start, end) = (
                sheet.batch.own(simd, 1, j + 1),
                sheet.batch.own(simd, 0, j + 2),
            );
            let (t, t_along) = (t.components(), (t * along).components());
            let mut k = 0;
            for r in 0..3 {
                for s in 0..r + 1 {
                    let mut sum = t_along[r] * t[s] + (start[k] + end[k]);
                    if r == s {
                        sum += across;
                    }
                    sheet.edges.store(OWN + k, j + 1, sum);
                    k += 1;
                }
            }
            let (start, end) = (
                sheet.batch.gradient(simd, 1, j + 1),
                sheet.batch.gradient(simd, 0, j + 2),
            );
            let t = Lanes3::new(t[0], t[1], t[2]);
            sheet
                .edges
                .store3(GRADIENT, j + 1, t * pull + (start + end));
        }
    }
}

/// Rows of the matrix and the gradient, node by node.
struct Nodes<'a, const D: usize> {
    sheet: &'a mut Sheet,
    gradient: &'a mut [V3],
    torque: &'a mut [f64],
    matrix: &'a mut Banded<D>,
    weight: f64,
    gravity: V3,
}

impl<const D: usize> WithSimd for Nodes<'_, D> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self {
            sheet,
            gradient,
            torque,
            matrix,
            weight,
            gravity,
        } = self;
        let nodes = gradient.len();
        let mut row = [[0.0; MOST]; ROW];
        let mut force = [[0.0; MOST]; 4];
        for i in (0..nodes).step_by(Lanes::<S>::COUNT) {
            let b = &sheet.batch;
            let mass = sheet.nodes.load(simd, MASS, i);
            let k = mass * weight;
            let place = sheet.places.load3(simd, 0, i);
            let d = place - sheet.nodes.load3(simd, TARGET, i);
            let pull = Lanes3::new(mass * gravity.x, mass * gravity.y, mass * gravity.z);
            sheet
                .energy
                .store(0, i, d.dot(d) * (k * 0.5) - pull.dot(place));
            let g = sheet.edges.load3(simd, GRADIENT, i) - sheet.edges.load3(simd, GRADIENT, i + 1)
                + (d * k - pull);
            g.x.store(&mut force[0]);
            g.y.store(&mut force[1]);
            g.z.store(&mut force[2]);
            (b.torque(simd, 1, i + 1) + b.torque(simd, 0, i + 2)).store(&mut force[3]);

            let own: [[_; 6]; 2] = [
                sheet.edges.load_all(simd, OWN, i),
                sheet.edges.load_all(simd, OWN, i + 1),
            ];
            let (here, next) = (b.cross(simd, i + 1), b.cross(simd, i + 2));
            for r in 0..3 {
                for s in 0..r + 1 {
                    let n = r * (r + 1) / 2 + s;
                    let mut sum = own[0][n] + own[1][n] - (here[3 * r + s] + here[3 * s + r]);
                    if r == s {
                        sum += k;
                    }
                    sum.store(&mut row[n]);
                }
                for s in 0..3 {
                    let n = if r > s {
                        r * (r + 1) / 2 + s
                    } else {
                        s * (s + 1) / 2 + r
                    };
                    let near = here[3 * r + s] + next[3 * r + s] - own[1][n];
                    near.store(&mut row[10 + 4 * r + s]);
                    (-next[3 * r + s]).store(&mut row[26 + 4 * r + s]);
                }
            }
            let (back, ahead) = (
                b.roll_with(simd, 1, 0, i + 1),
                b.roll_with(simd, 1, 1, i + 1),
            );
            let (from, to) = (
                b.roll_with(simd, 0, 0, i + 2),
                b.roll_with(simd, 0, 1, i + 2),
            );
            let other = b.roll_with(simd, 1, 0, i + 2);
            let own = (back - ahead - from).components();
            let near = (ahead + (from - to)).components();
            let (far, column) = (to.components(), other.components());
            for s in 0..3 {
                own[s].store(&mut row[6 + s]);
                near[s].store(&mut row[10 + 12 + s]);
                (-column[s]).store(&mut row[10 + 4 * s + 3]);
                far[s].store(&mut row[26 + 12 + s]);
            }
            (b.roll(simd, 2, i + 1) + b.roll(simd, 0, i + 2)).store(&mut row[9]);
            b.roll(simd, 1, i + 2).store(&mut row[10 + 15]);

            for l in 0..Lanes::<S>::COUNT.min(nodes - i) {
                gradient[i + l] = V3::new(force[0][l], force[1][l], force[2][l]);
                torque[i + l] = force[3][l];
                matrix.put(
                    i + l,
                    |r, s| row[r * (r + 1) / 2 + s][l],
                    |r, s| row[10 + 4 * r + s][l],
                    |r, s| row[26 + 4 * r + s][l],
                );
            }
        }
    }
}
