//! Places as the only unknowns: a wire that bends and carries no twist.

use super::lengths::{set_share, voronoi};
use super::scheme::StepFormula;
use super::unknowns::Unknowns;
use crate::math::{Spin, V3, align, rotate, turn_about_y};
use crate::rod::batch::Joints;
use crate::rod::{BendingJoints, Laws, Rod, SetCurvature, YieldBranches, mid_frame_vector};
use crate::system::{Spindle, Support, System};

/// Joints that bend.
#[derive(Debug, Default)]
pub(super) struct Places {
    joints: BendingJoints,
    /// directions of the clamped ends in the core frame
    clamps: [Option<V3>; 2],
    /// joints with a plastic curvature, and how it goes along with the wire
    bent: Vec<(usize, SetCurvature)>,
    /// plastic curvature per joint as a vector at the last evaluation, 1/m
    set: Vec<V3>,
}

impl Unknowns<3> for Places {
    type Joints = BendingJoints;

    const STATIC_STEPS: usize = 40;

    #[inline(always)]
    fn joints(&self) -> &BendingJoints {
        &self.joints
    }

    fn prepare(
        &mut self,
        sys: &System,
        step: &StepFormula,
        ends: (&Spindle, &[Support; 2]),
        guess: &[V3],
        _inert: bool,
    ) {
        let (spindle, support) = ends;
        self.clamps = clamp_directions(support, spindle);
        self.joints.begin(sys.state.rod.edges(), self.clamps);
        self.carry_plastic_curvature(sys, ends, guess, step.grown);
    }

    fn follow(&mut self, sys: &System, ends: (&Spindle, &[Support; 2]), guess: &[V3]) {
        self.carry_plastic_curvature(sys, ends, guess, 0.0);
    }

    #[inline(always)]
    fn respond<const HESSIAN: bool>(
        &mut self,
        (rod, laws, grown): (&Rod, &Laws, f64),
        q: &[V3],
        yield_branches: &mut YieldBranches,
    ) -> f64 {
        self.joints.place(q);
        self.turn_plastic_curvature();
        let state = (&self.set[..], &rod.bend[..]);
        let own = |j| voronoi(rod, grown, j);
        let near = &mut yield_branches.bending;
        let energy = self.joints.respond(&laws.bend, state, own, near);
        if !HESSIAN {
            near.clear();
        }
        energy
    }

    #[inline(always)]
    fn gradient(&self, _i: usize, places: &V3) -> [f64; 3] {
        [places.x, places.y, places.z]
    }
}

impl Places {
    /// Carries the plastic curvature of each joint along to `guess`, as a vector in the core frame.
    fn carry_plastic_curvature(
        &mut self,
        sys: &System,
        (spindle, support): (&Spindle, &[Support; 2]),
        guess: &[V3],
        grown: f64,
    ) {
        let rod = &sys.state.rod;
        let back = turn_about_y(-spindle.angle);
        self.bent.clear();
        self.set.clear();
        self.set.resize(rod.nodes(), V3::zeros());
        for i in 0..rod.nodes() {
            let k = rod.bend[i].curvature;
            if k == [0.0; 2] {
                continue;
            }
            let frame = |j: usize| {
                let d = guess[j + 1] - guess[j];
                align(&(back * rod.frame[j]), &(d / d.norm()), 0.0)
            };
            let clamp = |s: &Support| s.frame.map(|f| if s.turning { f } else { back * f });
            let before = if i > 0 {
                Some(frame(i - 1))
            } else {
                clamp(&support[0])
            };
            let after = if i < rod.edges() {
                Some(frame(i))
            } else {
                clamp(&support[1])
            };
            let (Some(p), Some(n)) = (before, after) else {
                continue;
            };
            let vector = mid_frame_vector(&p, &n, k) * set_share(rod, grown, i);
            let along = [p, n].map(|f| rotate(&f, &V3::z()));
            let carried = SetCurvature::new(vector, [&along[0], &along[1]]);
            self.bent.push((i, carried));
        }
    }

    /// Turns plastic curvature along to where the joints are placed.
    fn turn_plastic_curvature(&mut self) {
        for (i, carried) in &self.bent {
            // (a clamp's direction stands behind that of the last edge)
            let after = self.joints.edge(*i).0;
            self.set[*i] = carried.at([&self.along_before(*i), &after]);
        }
    }

    /// Direction of the wire before joint `i`.
    fn along_before(&self, i: usize) -> V3 {
        match i {
            0 => self.clamps[0].unwrap_or(V3::z()),
            _ => self.joints.edge(i - 1).0,
        }
    }
}

/// Directions of the clamped ends in the core frame.
fn clamp_directions(support: &[Support; 2], spindle: &Spindle) -> [Option<V3>; 2] {
    let spin = Spin::new(spindle.angle);
    let of = |s: &Support| {
        s.frame.map(|f| {
            let t = rotate(&f, &V3::z());
            if s.turning { t } else { spin.to_core(t) }
        })
    };
    [of(&support[0]), of(&support[1])]
}
