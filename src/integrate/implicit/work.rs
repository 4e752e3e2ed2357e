//! Scratch arrays of a step, shared by its stages.

use super::assembly::Assembly;
use super::beyond_band::BeyondBand;
use super::impact::Impacts;
use super::unknowns::Unknowns;
use super::{conjugate, minimal_residual};
use crate::linalg::Banded;
use crate::math::V3;
use crate::rod::YieldBranches;

/// An edge's stretch as Newton's method sees it.
///
/// A lateral move of a tenth of an edge stretches it by half a percent in the second order, which is
/// 250 N in this wire. Hessian and line search therefore take the tension that follows the
/// update linearly (mixed integration points: Magisano, Leonetti, Garcea 2017); the residual is the true one.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Axial {
    /// unit vector along the edge, core frame
    pub(super) along: V3,
    /// length, m
    pub(super) length: f64,
    /// tension, N
    pub(super) tension: f64,
    /// derivative of the tension by the length, N/m
    pub(super) stiffness: f64,
    /// energy of stretching, J
    pub(super) energy: f64,
}

/// Scratch arrays of a step with the `D` unknowns a node that `U` has, core frame.
#[derive(Debug, Default)]
pub(super) struct Work<const D: usize, U> {
    /// places of the nodes at the iterate, m
    pub(super) q: Vec<V3>,
    /// places at the start of a Newton step, m
    pub(super) start: Vec<V3>,
    /// places at which the solve starts, m
    pub(super) guess: Vec<V3>,
    /// places where inertia alone would take the nodes, m
    pub(super) target: Vec<V3>,
    /// `x*`, m, and `v*`, m/s, of each node, lab frame
    pub(super) star: [Vec<V3>; 2],
    /// lumped mass of each node, kg
    pub(super) mass: Vec<f64>,
    /// mass that couples the ends of each edge, kg; none where it is lumped
    pub(super) shared_mass: Vec<f64>,
    /// stretch of each edge at the last evaluation
    pub(super) axial: Vec<Axial>,
    /// stretch of each edge at the start of a Newton step
    pub(super) base: Vec<Axial>,
    /// stretch of each edge as the update promises it
    pub(super) expected: Vec<Axial>,
    /// joints that may change between yielding and not
    pub(super) yield_branches: YieldBranches,
    /// derivative of the potential by the places, N
    pub(super) gradient: Vec<V3>,
    /// the update, `D` numbers a node: way, m, and roll, rad, where there is one
    pub(super) update: Vec<f64>,
    /// right-hand side of the update's equations, `D` numbers a node: N, and N m of the roll
    pub(super) load: Vec<f64>,
    /// the update without a look ahead
    pub(super) plain: Vec<f64>,
    /// Hessian of the potential, factored in place
    pub(super) matrix: Banded<D>,
    /// joints, and rolls where twist is carried
    pub(super) unknowns: U,
    /// edges and nodes laid out for the assembly
    pub(super) assembly: Assembly,
    /// impulses of landings
    pub(super) impacts: Impacts,
    /// what the linear system holds beside the matrix
    pub(super) beyond: BeyondBand,
    /// vectors of the minimal residuals
    pub(super) minimal_residual: minimal_residual::Scratch,
    /// vectors of the conjugate gradients
    pub(super) conjugate: conjugate::Scratch,
    /// places after the update, m
    pub(super) there: Vec<V3>,
    /// places, m, and velocities, m/s, at the start of a step that is taken, lab frame
    pub(super) before: [Vec<V3>; 2],
    /// forces then, lab frame, N
    pub(super) force: Vec<V3>,
    /// evaluations of potential and gradient since they were last counted
    pub(super) evaluations: u64,
    /// solutions of the update's equations since they were last counted
    pub(super) solves: u64,
    /// halvings of a Newton step since they were last counted
    pub(super) line_search_halvings: u64,
}

/// Nothing in here outlives a step, so a copy starts with empty arrays.
impl<const D: usize, U: Default> Clone for Work<D, U> {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl<const D: usize, U: Unknowns<D>> Work<D, U> {
    /// The update of node `i`'s place.
    #[inline]
    pub(super) fn update_of(&self, i: usize) -> V3 {
        V3::new(
            self.update[D * i],
            self.update[D * i + 1],
            self.update[D * i + 2],
        )
    }

    /// Root mean square of the update over the wire, m.
    pub(super) fn mean_update(&self) -> f64 {
        let (sum, mass) = self.weighed(|i| self.update_of(i));
        (sum / mass).sqrt()
    }

    /// Root mean square over the wire of what Newton's method moved the guess by, m.
    pub(super) fn difference(&self) -> f64 {
        let (sum, mass) = self.weighed(|i| self.q[i] - self.guess[i]);
        ((sum + self.unknowns.difference()) / mass).sqrt()
    }

    /// Solves the equations of which [`Self::update`] is the right-hand side, N, and N m of a roll, by the factors in hand and
    /// what is beside their band; a roll counts at this `radius`, m.
    pub(super) fn solve_factored(&mut self, radius: f64) {
        let Self {
            matrix,
            beyond,
            update,
            ..
        } = self;
        if !beyond.slips.is_empty() {
            minimal_residual::solve(matrix, beyond, update, &mut self.minimal_residual, radius);
        } else if !beyond.couplings.is_empty() {
            conjugate::solve(matrix, beyond, update, &mut self.conjugate);
        } else {
            matrix.solve(update);
        }
    }

    /// Keeps places and rolls as those at the start of an update.
    pub(super) fn keep_start(&mut self) {
        self.start.clone_from(&self.q);
        self.unknowns.keep_start();
    }

    /// Takes this share of the update from the start.
    pub(super) fn take(&mut self, share: f64) {
        let places = self.q.iter_mut().zip(&self.start);
        for ((q, start), u) in places.zip(self.update.as_chunks::<D>().0) {
            *q = start + V3::new(u[0], u[1], u[2]) * share;
        }
        self.unknowns.take(&self.update, share);
    }

    /// Derivative of the potential by the unknowns, node by node.
    pub(super) fn gradients(&self) -> impl Iterator<Item = [f64; D]> {
        let places = self.gradient.iter().enumerate();
        places.map(|(i, places)| self.unknowns.gradient(i, places))
    }

    /// Sum of the squares of the nodes' ways, each times its mass, and of the masses.
    fn weighed(&self, way: impl Fn(usize) -> V3) -> (f64, f64) {
        let (mut sum, mut mass) = (0.0, 0.0);
        for (i, m) in self.mass.iter().enumerate() {
            sum += m * way(i).norm_squared();
            mass += m;
        }
        (sum, mass)
    }
}
