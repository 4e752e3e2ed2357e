//! Joints of a rod without twist: what [`bent`](crate::rod::bent()) does for one.

use super::{CROSS, GRADIENT, JOINT, Joints, LEAD, OWN, edge_of, put_places, series};
use crate::math::V3;
use crate::math::simd::{Columns, Lanes, Lanes3, ROWS, RowBlock, WithSimd, run};
use crate::rod::bending::{FOLD, SERIES, SLOPE_TERMS, TERMS, angle_over_tangent, respond};
use crate::rod::plasticity::{Bend, Law};
use crate::rod::yield_branch::YieldBranch;
use pulp::Simd;

/// Columns of an edge: direction, inverse length, length.
const ALONG: usize = 0;
const INVERSE: usize = 3;
const LENGTH: usize = 4;

/// Columns of a joint's angle: curvature binormal over the length, `2/chi`, and what the angle is
/// over its length with the derivative of that, see [`crate::rod::bent()`].
const KB: usize = 0;
const F: usize = 3;
const RATIO: usize = 4;
const SLOPE: usize = 5;

/// Columns of a joint's answer: moment, stiffness across it and how much more there is along it,
/// direction of the moment where that matters.
const ANSWER: usize = 8;
const MOMENT: usize = 0;
const ACROSS: usize = 3;
const MORE: usize = 4;
const DIRECTION: usize = 5;

/// All edges and joints of a rod without twist.
#[derive(Clone, Debug, Default)]
pub struct BendingJoints {
    edges: usize,
    clamps: [Option<V3>; 2],
    places: Columns<3>,
    edge: Columns<5>,
    angle: Columns<6>,
    answer: Columns<ANSWER>,
}

impl BendingJoints {
    /// Takes over the number of edges and the unit directions of the clamps.
    pub fn begin(&mut self, edges: usize, clamps: [Option<V3>; 2]) {
        self.edges = edges;
        self.clamps = clamps;
        let rows = edges + 1;
        self.places.fit(rows);
        self.edge.fit(rows);
        self.angle.fit(rows);
        self.answer.fit(rows);
    }

    /// Computes edges and angles with the nodes at `q`, m.
    pub fn place(&mut self, q: &[V3]) {
        put_places(&mut self.places, q);
        run(Edges(self));
        // the pass over the edges goes over the far clamp's row; without a clamp there is no joint,
        // and any direction will do
        for end in 0..2 {
            let along = self.clamps[end].unwrap_or(V3::z());
            for (k, x) in [along.x, along.y, along.z, 0.0].into_iter().enumerate() {
                if end == 0 {
                    self.edge.set_before(k, x);
                } else {
                    self.edge.set(k, self.edges, x);
                }
            }
        }
        self.edge.join();
        run(Angles(self));
        for j in 0..=self.edges {
            let kb2 = self.angle.vector(KB, j).norm_squared();
            if 0.25 * kb2 >= SERIES {
                let (ratio, slope) = angle_over_tangent(kb2);
                self.angle.set(RATIO, j, ratio);
                self.angle.set(SLOPE, j, slope);
            }
        }
    }

    /// Computes the moments and stiffnesses of all joints by their law; returns their energy, J.
    ///
    /// `set` is the plastic curvature of each joint as a vector, 1/m, `length` its Voronoi length,
    /// m. Joints that may change their branch are appended to `yield_branches`, for
    /// [`Joints::joints`] to complete.
    pub fn respond(
        &mut self,
        law: &Law,
        (set, bend): (&[V3], &[Bend]),
        length: impl Fn(usize) -> f64,
        yield_branches: &mut Vec<(u32, YieldBranch)>,
    ) -> f64 {
        let first = usize::from(self.clamps[0].is_none());
        let last = self.edges - usize::from(self.clamps[1].is_none());
        let mut energy = 0.0;
        for j in 0..=self.edges {
            let (block, row) = (j / ROWS, j % ROWS);
            let answers = &mut self.answer.blocks_mut()[block];
            if j < first || j > last {
                for k in 0..ANSWER {
                    answers.set(k, row, 0.0);
                }
                continue;
            }
            let (lv, rise) = (length(j), bend[j].rise);
            let inv = 1.0 / lv;
            let kb = self.angle.vector(KB, j);
            let ratio = self.angle.get(RATIO, j);
            let trial = (kb * (ratio * inv) - set[j]) * law.modulus;
            let (moment, own, along, across, dir) = respond(law, trial, rise);
            energy += own * lv;
            let rest = [across * inv, (along - across) * inv];
            for (k, x) in (moment.iter().chain(&rest).chain(dir.iter())).enumerate() {
                answers.set(k, row, *x);
            }
            if dir != V3::zeros() {
                let yield_branch = YieldBranch {
                    rows: [V3::zeros(); 2],
                    rolls: [0.0; 2],
                    trial: trial.dot(&dir),
                    length: lv,
                    rise,
                    moment: moment.dot(&dir),
                    stiffness: along * inv,
                    branch: i8::from(along != law.modulus),
                };
                yield_branches.push((j as u32, yield_branch));
            }
        }
        energy
    }
}

/// First pass: directions and lengths of the edges.
struct Edges<'a>(&'a mut BendingJoints);

impl WithSimd for Edges<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let b = self.0;
        for (q, edge) in b.places.blocks().iter().zip(b.edge.blocks_mut()) {
            for j in (0..ROWS).step_by(Lanes::<S>::COUNT) {
                let d = q.load3(simd, 0, j, 2) - q.load3(simd, 0, j, 1);
                let length = d.dot(d).sqrt();
                let inverse = length.recip();
                edge.store3(ALONG, j, d * inverse);
                edge.store(INVERSE, j, inverse);
                edge.store(LENGTH, j, length);
            }
        }
    }
}

/// Second pass: angles of the joints; large ones are put right afterwards.
struct Angles<'a>(&'a mut BendingJoints);

impl WithSimd for Angles<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let b = self.0;
        for (edge, angle) in b.edge.blocks().iter().zip(b.angle.blocks_mut()) {
            for j in (0..ROWS).step_by(Lanes::<S>::COUNT) {
                let before = edge.load3(simd, ALONG, j, 0);
                let after = edge.load3(simd, ALONG, j, 1);
                let chi = (before.dot(after) + 1.0).at_least(FOLD);
                let f = chi.recip() * 2.0;
                let kb = before.cross(after) * f;
                let z2 = kb.dot(kb) * 0.25;
                angle.store3(KB, j, kb);
                angle.store(F, j, f);
                angle.store(RATIO, j, series(&TERMS, z2));
                angle.store(SLOPE, j, series(&SLOPE_TERMS, z2));
            }
        }
    }
}

impl Joints for BendingJoints {
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

    /// Third pass; see [`crate::rod::bent()`] for the formulas.
    #[inline(always)]
    fn derive<S: Simd, const HESSIAN: bool>(
        &self,
        simd: S,
        block: usize,
        j: usize,
        near: bool,
        out: &mut RowBlock<JOINT>,
    ) {
        let (edge, angle) = (&self.edge.blocks()[block], &self.angle.blocks()[block]);
        let law = &self.answer.blocks()[block];
        let t = [edge.load3(simd, ALONG, j, 0), edge.load3(simd, ALONG, j, 1)];
        let il = [
            edge.load(simd, INVERSE, j, 0),
            edge.load(simd, INVERSE, j, 1),
        ];
        let kb = angle.load3(simd, KB, j, 1);
        let [f, ratio, slope] = angle.load_all(simd, F, j, 1);
        let moment = law.load3(simd, MOMENT, j, 1);
        let twice = slope + slope;
        let g = moment * ratio + kb * (twice * kb.dot(moment));
        let mean = (t[0] + t[1]) * (f * 0.5);
        let along = mean * kb.dot(g);
        let root = f.sqrt();
        let share = (root * (root + 1.0)).recip() * ratio * 0.25;
        let more = turned(moment, kb, mean, share);
        out.store3(GRADIENT[0], j, (t[1].cross(g) * f - along + more) * il[0]);
        out.store3(
            GRADIENT[1],
            j,
            -((t[0].cross(g) * f + along + more) * il[1]),
        );
        if !HESSIAN {
            return;
        }
        // S (c I + (c' - c) d d^T) S with S = s I + 2 s' kb kb^T
        // is c1 I + c2 kb kb^T + c3 (S d)(S d)^T
        let across = law.load(simd, ACROSS, j, 1);
        let kb2 = kb.dot(kb);
        let c1 = ratio * ratio * across;
        let c2 = twice * 2.0 * (ratio + slope * kb2) * across;
        let side = [kb.cross(t[1]), kb.cross(t[0])];
        let u = on((mean, f, il), kb2, side);
        let cf = c1 * f;
        let cf2 = cf * f;
        let ck = c1 * kb2;
        let scale = [il[0] * il[0], il[0] * il[1], il[1] * il[1]];
        let (m, uc) = (mean.components(), [u[0] * c2, u[1] * c2]);
        let (binormal, less) = (kb.components(), kb * (c1 * 0.25));
        let own_less = (less * (f + 1.0)).components();
        let cross_less = (less * (f + -1.0)).components();
        let mut dir = [u[0]; 2];
        let mut strong = dir;
        if near {
            // (elsewhere the direction of the moment does not matter: it is 0)
            let more = law.load(simd, MORE, j, 1);
            let d = law.load3(simd, DIRECTION, j, 1);
            let turned = turned(d, kb, mean, share);
            let d = d * ratio + kb * (twice * kb.dot(d));
            let side = [d.cross(t[1]), d.cross(t[0])];
            dir = on((mean, f, il), kb.dot(d), side);
            dir = [dir[0] + turned * il[0], dir[1] - turned * il[1]];
            strong = [dir[0] * more, dir[1] * more];
            out.store3(LEAD[0], j, dir[0]);
            out.store3(LEAD[1], j, dir[1]);
        }
        for k in 0..2 {
            let s = scale[2 * k];
            let stiff = cf2 * s;
            let other = t[1 - k];
            let sign = if k == 0 { cf } else { -cf };
            let w = ((side[k] * sign + mean * (ck * 0.5)) * s).components();
            let (o, os) = (other.components(), (other * stiff).components());
            let (v, c) = (u[k].components(), uc[k].components());
            let (e, es) = (dir[k].components(), strong[k].components());
            let mut at = OWN[k];
            for a in 0..3 {
                for b in 0..a + 1 {
                    let mut sum = w[a] * m[b] + m[a] * w[b] + c[a] * v[b] - os[a] * o[b];
                    sum = sum - own_less[a] * binormal[b] * s;
                    if a == b {
                        sum += stiff;
                    }
                    if near {
                        sum += es[a] * e[b];
                    }
                    out.store(at, j, sum);
                    at += 1;
                }
            }
        }
        let s = scale[1];
        let stiff = cf2 * s;
        let diagonal = stiff * t[0].dot(t[1]);
        let (p, q) = (t[0].components(), (t[1] * stiff).components());
        let w = ((side[0] * cf + mean * ck) * s).components();
        let back = (mean * (cf * s)).components();
        let other = side[1].components();
        let (c, v) = (uc[0].components(), u[1].components());
        let (e, es) = (dir[1].components(), strong[0].components());
        for a in 0..3 {
            for b in 0..3 {
                let mut sum = p[a] * q[b] + w[a] * m[b] + c[a] * v[b] - back[a] * other[b];
                sum = sum - cross_less[a] * binormal[b] * s;
                if a == b {
                    sum = sum - diagonal;
                }
                if near {
                    sum += es[a] * e[b];
                }
                out.store(CROSS + 3 * a + b, j, sum);
            }
        }
    }
}

/// What the turn of the plastic curvature adds to a derivative along `v`, see [`SetCurvature`](crate::rod::SetCurvature).
///
/// No closure: used at two places it is a function of its own, without the lanes of its caller, that calls a function for
/// every product.
#[inline(always)]
fn turned<S: Simd>(v: Lanes3<S>, kb: Lanes3<S>, mean: Lanes3<S>, share: Lanes<S>) -> Lanes3<S> {
    kb * (mean.dot(kb.cross(v)) * share)
}

/// Derivatives of the binormal by the edge vectors, transposed, on a vector: `kv` is its product
/// with the binormal, `side` those with the directions.
#[inline(always)]
fn on<S: Simd>(
    (mean, f, il): (Lanes3<S>, Lanes<S>, [Lanes<S>; 2]),
    kv: Lanes<S>,
    side: [Lanes3<S>; 2],
) -> [Lanes3<S>; 2] {
    let along = mean * kv;
    [
        -((side[0] * f + along) * il[0]),
        (side[1] * f - along) * il[1],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rod::bent;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    const LV: f64 = 0.5e-3;

    /// All blocks of joints.
    struct All<'a, const HESSIAN: bool>(&'a BendingJoints, &'a mut [(u32, YieldBranch)]);

    impl<const HESSIAN: bool> WithSimd for All<'_, HESSIAN> {
        type Output = Vec<RowBlock<JOINT>>;

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
            let Self(joints, mut yield_branches) = self;
            let mut all = vec![RowBlock::default(); joints.blocks()];
            for (block, out) in all.iter_mut().enumerate() {
                joints.joints::<S, HESSIAN>(simd, block, out, &mut yield_branches);
            }
            assert!(yield_branches.is_empty());
            all
        }
    }

    /// The slow twin is one joint at a time.
    #[test]
    fn each_joint_is_that_of_the_rod_one_by_one() {
        let law = Law::new(3.06e-3, 1.13e-4, 5.72e-3, f64::INFINITY);
        let elastic = Law::new(3.06e-3, 3.06e-3, f64::INFINITY, f64::INFINITY);
        let mut near = [0; 2];
        for (seed, edges, crooked, law) in [
            (1, 30, 0.03, law),
            (2, 7, 0.5, law),
            (3, 1, 1.0, law),
            (4, 16, 0.3, elastic),
        ] {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let mut number = move || rng.next_u32() as f64 / f64::from(u32::MAX) * 2.0 - 1.0;
            let mut some = |size: f64| V3::new(number(), number(), number()) * size;
            let mut q = vec![V3::zeros()];
            for j in 0..edges {
                q.push(q[j] + V3::new(0.0, 0.0, LV) + some(crooked * LV));
            }
            if edges > 10 {
                // as good as folded
                q[5] = q[3] + some(1e-9);
            }
            let clamps = [(seed != 2).then_some(V3::z()), None];
            let set: Vec<V3> = (0..=edges).map(|_| some(100.0)).collect();
            let bend: Vec<Bend> = (0..=edges)
                .map(|_| Bend {
                    curvature: [0.0; 2],
                    rise: some(1e-4).x.abs(),
                })
                .collect();
            let mut all = BendingJoints::default();
            let mut yield_branches = Vec::new();
            all.begin(edges, clamps);
            all.place(&q);
            let energy = all.respond(&law, (&set, &bend), |_| LV, &mut yield_branches);
            let forces = run(All::<false>(&all, &mut yield_branches.clone()));
            let joints = run(All::<true>(&all, &mut yield_branches));
            let (mut sum, mut count) = (0.0, 0);
            for j in 0..edges {
                let edge = |k: usize| {
                    let d = q[k + 1] - q[k];
                    (d.normalize(), 1.0 / d.norm())
                };
                let before = match (j, clamps[0]) {
                    (0, None) => continue,
                    (0, Some(t)) => (t, 0.0),
                    _ => edge(j - 1),
                };
                let after = edge(j);
                let t = [&before.0, &after.0];
                let one = bent(&law, &set[j], bend[j].rise, LV, t, [before.1, after.1]);
                sum += one.energy;
                let get = |k: usize| joints[j / ROWS].get(k, j % ROWS);
                let compare = |at: usize, want: &[f64]| {
                    let size = want.iter().fold(0.0, |s: f64, x| s.max(x.abs()));
                    for (k, want) in want.iter().enumerate() {
                        let off = (get(at + k) - want).abs();
                        assert!(
                            off <= 1e-9 * size + 1e-14,
                            "joint {j} of {edges}: {}, {want}",
                            get(at + k)
                        );
                    }
                };
                for e in 0..2 {
                    compare(OWN[e], &one.own[e]);
                    compare(GRADIENT[e], [one.before, one.after][e].as_slice());
                    for k in GRADIENT[e]..GRADIENT[e] + 3 {
                        let alone = forces[j / ROWS].get(k, j % ROWS);
                        assert!(alone.to_bits() == get(k).to_bits());
                    }
                }
                compare(CROSS, one.cross.as_flattened());
                near[usize::from(one.yield_branch.is_some())] += 1;
                if let Some(yield_branch) = one.yield_branch {
                    let (number, own) = &yield_branches[count];
                    assert_eq!(*number, j as u32);
                    count += 1;
                    for e in 0..2 {
                        let off = (own.rows[e] - yield_branch.rows[e]).norm();
                        assert!(off <= 1e-9 * yield_branch.rows[e].norm() + 1e-12);
                    }
                    assert!(
                        (own.moment - yield_branch.moment).abs()
                            <= 1e-9 * yield_branch.moment.abs()
                    );
                }
            }
            assert!((energy - sum).abs() <= 1e-9 * sum.abs());
            assert_eq!(count, yield_branches.len());
        }
        assert!(near[0] > 5 && near[1] > 5, "{near:?}");
    }
}
