//! What is solved for at a node, and all that depends on it.
//!
//! Without twist the unknowns of a node are its place ([`Places`](super::places::Places)). Twist adds the roll of the edge
//! behind it ([`PlacesAndRolls`](super::places_and_rolls::PlacesAndRolls)). The stages of a step are written once, for any
//! [`Unknowns`]: what rolls add to one of them stands in a method here, and does nothing where there are none.

use super::scheme::{Scheme, StepFormula};
use crate::linalg::Banded;
use crate::math::V3;
use crate::math::simd::{ROWS, RowBlock};
use crate::rod::batch::{JOINT, Joints};
use crate::rod::{Laws, Rod, YieldBranch, YieldBranches};
use crate::system::{Spindle, Support, System};
use pulp::Simd;
use std::fmt::Debug;

/// Numbers of a node's row of the matrix: lower half of its own block, blocks with the next node and the one after.
///
/// They have room for four unknowns a node.
pub(super) const ROW: usize = 10 + 16 + 16;
/// Where the block with the next node begins ...
pub(super) const NEAR: usize = 10;
/// ... and that with the one after.
pub(super) const FAR: usize = 26;

/// Joints that go with the `D` unknowns of a node, with their state, and the rolls if there are any.
///
/// A method with a body is that of a wire without rolls. (`D` follows from the type, but a constant of a type can't be
/// the width of a matrix.)
pub(super) trait Unknowns<const D: usize>: Debug + Default {
    /// All joints of the wire.
    type Joints: Joints;

    /// Newton steps that a static solve may take.
    const STATIC_STEPS: usize;

    /// Joints, laid out by [`prepare`](Self::prepare) and [`respond`](Self::respond).
    fn joints(&self) -> &Self::Joints;

    /// Lays out the joints for a step from `guess`, places in the core frame, m; rolls are without inertia where not
    /// `inert`.
    fn prepare(
        &mut self,
        sys: &System,
        step: &StepFormula,
        ends: (&Spindle, &[Support; 2]),
        guess: &[V3],
        inert: bool,
    );

    /// Goes along with a better `guess` of an equilibrium.
    fn follow(&mut self, _sys: &System, _ends: (&Spindle, &[Support; 2]), _guess: &[V3]) {}

    // evaluation of the potential

    /// Places the joints at `q` and finds their moments, with `HESSIAN` the joints that may change their branch; returns
    /// their energy, J. The `wire` has this state and these laws, and its edge at the nozzle has grown by so much, m.
    fn respond<const HESSIAN: bool>(
        &mut self,
        wire: (&Rod, &Laws, f64),
        q: &[V3],
        yield_branches: &mut YieldBranches,
    ) -> f64;

    /// Adds inertia and drag of the rolls, to the matrix if there is one; returns their potential, J.
    fn add_inertia(&mut self, _gamma: f64, _drag: f64, _matrix: Option<&mut Banded<D>>) -> f64 {
        0.0
    }

    /// What a dead `moment`, N m, on edge `j` of this direction and length makes of its ends: the force on the last, N.
    /// Also the work on the roll, J.
    fn couple(&mut self, _j: usize, moment: &V3, along: &V3, length: f64) -> (V3, f64) {
        (moment.cross(along) / length, 0.0)
    }

    /// Takes what is no unknown out of gradient and `matrix`.
    fn pin(&mut self, _matrix: Option<&mut Banded<D>>) {}

    /// Nodes whose roll is no unknown, each with its number among the unknowns of the node.
    fn pinned(&self) -> impl Iterator<Item = (usize, usize)> {
        std::iter::empty()
    }

    // assembly, many nodes side by side

    /// Makes room for the torques of `nodes` nodes.
    fn fit(&mut self, _nodes: usize) {}

    /// Puts the torques of as many nodes as there are lanes, from row `first` of `joints` and node `start` on.
    #[inline(always)]
    fn put_torques<S: Simd>(
        &mut self,
        _simd: S,
        _joints: &RowBlock<JOINT>,
        _first: usize,
        _start: usize,
    ) {
    }

    /// Puts what rolls have in the matrix into the rows of these nodes.
    #[inline(always)]
    fn put_rolls<S: Simd>(
        _simd: S,
        _joints: &RowBlock<JOINT>,
        _first: usize,
        _row: &mut [[f64; ROWS]; ROW],
    ) {
    }

    // Newton's method

    /// Derivative of the potential by the unknowns of node `i`, of which those by its place are `places`.
    fn gradient(&self, i: usize, places: &V3) -> [f64; D];

    /// Largest way that the gradient allows a roll, as a way of the wire's surface, m.
    fn bound(&self, _gamma: f64, _radius: f64) -> f64 {
        0.0
    }

    /// Share of `update` that twists no joint by more than `turn`, rad; may be above 1.
    fn share(_update: &[f64], _turn: f64) -> f64 {
        f64::INFINITY
    }

    /// Keeps the rolls as those at the start of an update.
    fn keep_start(&mut self) {}

    /// Takes this share of `update` from the start.
    fn take(&mut self, _update: &[f64], _share: f64) {}

    /// Sum of inertia times the square of what the guess of the rolls was off by, kg m^2.
    fn difference(&self) -> f64 {
        0.0
    }

    /// Derivative of a joint's angle by the rolls of the edges before and after.
    fn by_rolls(_yield_branch: &YieldBranch) -> [f64; 2] {
        [0.0; 2]
    }

    /// Roll of the edge behind node `i` in an `update`, rad.
    fn roll(_update: &[f64], _i: usize) -> f64 {
        0.0
    }

    /// Takes a torque from the right-hand side, at node `i`.
    fn relieve(_load: &mut [f64], _i: usize, _torque: f64) {}

    /// Adds the stiffness of an angle between nodes `i` and `i + k`, as far as rolls have a share in it. `a` and `b` are
    /// the derivatives of the angle by place and roll of either.
    fn add_stiffness(
        _matrix: &mut Banded<D>,
        _i: usize,
        _k: usize,
        _a: (&V3, f64),
        _b: (&V3, f64),
        _stiffness: f64,
    ) {
    }

    // end of a step

    /// Hands rolls and spins of a step over to the system.
    fn hand_over(&mut self, _sys: &mut System, _scheme: Scheme, _step: &StepFormula) {}

    /// Hands the rolls of an equilibrium over to the system.
    fn hand_over_equilibrium(&self, _sys: &mut System) {}

    /// Work of the torques on the rolls in the step just committed, J.
    fn work(&self, _sys: &System) -> f64 {
        0.0
    }

    /// Torques on the edges about themselves, N m.
    #[cfg(feature = "lab")]
    fn torques(&self) -> Vec<f64> {
        Vec::new()
    }
}

/// Adds a block between nodes `i` and `i + k`.
#[inline(always)]
pub(super) fn add_at<const D: usize, const B: usize>(
    matrix: &mut Banded<D>,
    i: usize,
    k: usize,
    block: &[[f64; B]; B],
) {
    if k == 0 {
        matrix.add_diagonal(i, block);
    } else {
        matrix.add(i, k, block);
    }
}
