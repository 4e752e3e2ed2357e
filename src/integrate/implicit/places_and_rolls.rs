//! Places and rolls as unknowns: a wire that bends and twists.
//!
//! The unknowns of a node are its place and the roll of the edge behind it.

use super::lengths::{set_share, voronoi};
use super::rolls::{MOST_TWIST, Rolls, within};
use super::scheme::{Scheme, StepFormula};
use super::unknowns::{FAR, NEAR, ROW, Unknowns, add_at};
use crate::linalg::Banded;
use crate::math::V3;
use crate::math::simd::{Lanes, ROWS, RowBlock};
use crate::rod::batch::{JOINT, ROLL_OWN, ROLL_WITH, TORQUE, TwistingJoints};
use crate::rod::{Laws, Rod, YieldBranch, YieldBranches};
use crate::system::{Spindle, Support, System};
use pulp::Simd;

/// Joints that bend and twist, and the rolls of the edges between them.
#[derive(Debug, Default)]
pub(super) struct PlacesAndRolls {
    joints: TwistingJoints,
    rolls: Rolls,
}

impl Unknowns<4> for PlacesAndRolls {
    type Joints = TwistingJoints;

    /// Wire bent and twisted far from its free shape converges by a factor, not by squares: what the Hessian leaves out
    /// is not small there.
    const STATIC_STEPS: usize = 200;

    #[inline(always)]
    fn joints(&self) -> &TwistingJoints {
        &self.joints
    }

    fn prepare(
        &mut self,
        sys: &System,
        step: &StepFormula,
        (spindle, support): (&Spindle, &[Support; 2]),
        _guess: &[V3],
        inert: bool,
    ) {
        let rod = &sys.state.rod;
        self.rolls.prepare(sys, step, spindle, support, inert);
        self.rolls.lay_out(&mut self.joints);
        let (state, ends) = ((&rod.bend[..], &rod.twist[..]), self.rolls.joints());
        self.joints.lay(&sys.model.laws, state, ends, |j| {
            (voronoi(rod, step.grown, j), set_share(rod, step.grown, j))
        });
    }

    #[inline(always)]
    fn respond<const HESSIAN: bool>(
        &mut self,
        (_, laws, _): (&Rod, &Laws, f64),
        q: &[V3],
        yield_branches: &mut YieldBranches,
    ) -> f64 {
        self.joints.place(q, &self.rolls.angle);
        let near = HESSIAN.then_some(yield_branches);
        self.joints.respond(laws, near)
    }

    #[inline(always)]
    fn add_inertia(&mut self, gamma: f64, drag: f64, matrix: Option<&mut Banded<4>>) -> f64 {
        self.rolls.add_inertia(gamma, drag, matrix)
    }

    fn couple(&mut self, j: usize, moment: &V3, along: &V3, _length: f64) -> (V3, f64) {
        let about = moment.dot(along);
        self.rolls.gradient[j] -= about;
        let work = about * (self.rolls.angle[j] - self.rolls.guess[j]);
        (self.joints.turned(j).derivative(moment).0, work)
    }

    fn pin(&mut self, matrix: Option<&mut Banded<4>>) {
        self.rolls.pin(matrix);
    }

    fn pinned(&self) -> impl Iterator<Item = (usize, usize)> {
        self.rolls.pinned().into_iter().flatten().map(|i| (i, 3))
    }

    fn fit(&mut self, nodes: usize) {
        self.rolls.gradient.resize(nodes, 0.0);
    }

    #[inline(always)]
    fn put_torques<S: Simd>(
        &mut self,
        simd: S,
        joints: &RowBlock<JOINT>,
        first: usize,
        start: usize,
    ) {
        let behind = joints.load(simd, TORQUE + 1, first, 1);
        let torques = behind + joints.load(simd, TORQUE, first, 2);
        let to = &mut self.rolls.gradient[start..];
        if to.len() >= Lanes::<S>::COUNT {
            torques.store(to);
        } else {
            let mut all = [0.0; ROWS];
            torques.store(&mut all);
            to.copy_from_slice(&all[..to.len()]);
        }
    }

    /// The roll of the edge before a joint is an unknown of the node before it.
    #[inline(always)]
    fn put_rolls<S: Simd>(
        simd: S,
        joints: &RowBlock<JOINT>,
        first: usize,
        row: &mut [[f64; ROWS]; ROW],
    ) {
        let back = joints.load3(simd, ROLL_WITH[1][0], first, 1);
        let on = joints.load3(simd, ROLL_WITH[1][1], first, 1);
        let from = joints.load3(simd, ROLL_WITH[0][0], first, 2);
        let to = joints.load3(simd, ROLL_WITH[0][1], first, 2);
        let other = (-joints.load3(simd, ROLL_WITH[1][0], first, 2)).components();
        let own = (back - on - from).components();
        let near = (on + (from - to)).components();
        let far = to.components();
        for s in 0..3 {
            own[s].store(&mut row[6 + s]);
            near[s].store(&mut row[NEAR + 12 + s]);
            other[s].store(&mut row[NEAR + 4 * s + 3]);
            far[s].store(&mut row[FAR + 12 + s]);
        }
        let corner =
            joints.load(simd, ROLL_OWN + 2, first, 1) + joints.load(simd, ROLL_OWN, first, 2);
        corner.store(&mut row[9]);
        joints
            .load(simd, ROLL_OWN + 1, first, 2)
            .store(&mut row[NEAR + 15]);
    }

    #[inline(always)]
    fn gradient(&self, i: usize, places: &V3) -> [f64; 4] {
        [places.x, places.y, places.z, self.rolls.gradient[i]]
    }

    fn bound(&self, gamma: f64, radius: f64) -> f64 {
        self.rolls.bound(gamma, radius)
    }

    /// A joint must stay clear of half a turn.
    fn share(update: &[f64], turn: f64) -> f64 {
        let edges = update.len() / 4 - 1;
        within(
            turn.min(MOST_TWIST),
            (0..edges).map(|j| Self::roll(update, j)),
        )
    }

    fn keep_start(&mut self) {
        self.rolls.start.clone_from(&self.rolls.angle);
    }

    fn take(&mut self, update: &[f64], share: f64) {
        let rolls = self.rolls.angle.iter_mut().zip(&self.rolls.start);
        for ((angle, start), [.., roll]) in rolls.zip(update.as_chunks::<4>().0) {
            *angle = start + roll * share;
        }
    }

    fn difference(&self) -> f64 {
        self.rolls.difference()
    }

    #[inline(always)]
    fn by_rolls(yield_branch: &YieldBranch) -> [f64; 2] {
        yield_branch.rolls
    }

    #[inline(always)]
    fn roll(update: &[f64], i: usize) -> f64 {
        update[4 * i + 3]
    }

    #[inline(always)]
    fn relieve(load: &mut [f64], i: usize, torque: f64) {
        load[4 * i + 3] -= torque;
    }

    #[inline(always)]
    fn add_stiffness(
        matrix: &mut Banded<4>,
        i: usize,
        k: usize,
        (by_place, by_roll): (&V3, f64),
        (by_other_place, by_other_roll): (&V3, f64),
        stiffness: f64,
    ) {
        let (own, other) = (by_roll * stiffness, by_other_roll * stiffness);
        let (column, row) = (by_place * other, by_other_place * own);
        add_at(matrix, i, k, &framed(column, row, own * by_other_roll));
    }

    fn hand_over(&mut self, sys: &mut System, scheme: Scheme, step: &StepFormula) {
        self.rolls.keep_torques(sys);
        self.rolls.hand_over(sys, scheme, step);
    }

    fn hand_over_equilibrium(&self, sys: &mut System) {
        sys.state.roll.clone_from(&self.rolls.angle);
    }

    fn work(&self, sys: &System) -> f64 {
        self.rolls.work(sys)
    }

    #[cfg(feature = "lab")]
    fn torques(&self) -> Vec<f64> {
        let edges = self.rolls.angle.len();
        self.rolls.gradient.iter().take(edges).map(|g| -g).collect()
    }
}

/// A block of nothing but a last column, a last row and their corner.
#[inline]
fn framed(column: V3, row: V3, corner: f64) -> [[f64; 4]; 4] {
    [
        [0.0, 0.0, 0.0, column.x],
        [0.0, 0.0, 0.0, column.y],
        [0.0, 0.0, 0.0, column.z],
        [row.x, row.y, row.z, corner],
    ]
}
