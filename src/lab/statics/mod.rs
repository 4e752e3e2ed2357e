//! Static equilibrium of a system: Newton's method on the forces that the time steps use.
//!
//! Unknowns are node positions and the roll of each edge since its frame was taken over. A node's
//! force depends on two neighbours either way, so central differences of `System::evaluate` over
//! every fifth node give the whole tangent in 40 evaluations, whatever the length; it is solved as
//! a band. (Following the motion with artificial damping instead needs as many steps as the ratio
//! of highest to lowest frequency, 1e6 for a hanging wire.) Plastic state moves on only where an
//! increment has converged, so that iterates cannot leave false yielding behind.

mod band;
mod plastic_tangent;

use crate::math::V3;
use crate::system::System;
use band::Band;

/// How closely and how long to seek equilibrium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// out-of-balance force over the largest load or reaction
    pub tolerance: f64,
    /// Newton steps for one increment
    pub iterations: usize,
    /// share of the load in the first increment of a ramp
    pub first: f64,
    /// largest share of the load in one increment
    pub largest: f64,
    /// share below which a ramp gives up
    pub smallest: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            tolerance: 1e-9,
            iterations: 20,
            first: 0.1,
            largest: 0.25,
            smallest: 1e-5,
        }
    }
}

/// How equilibrium was reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relaxed {
    /// Newton steps in all
    pub iterations: usize,
    /// load increments
    pub increments: usize,
    /// out-of-balance force left over the largest load or reaction
    pub residual: f64,
}

/// Why no equilibrium was found.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum RelaxError {
    /// The iterations ran out.
    #[error(
        "no equilibrium at {share} of the load: out of balance by {residual} of it after {iterations} iterations"
    )]
    NotConverged {
        /// share of the load, 1 unless ramped
        share: f64,
        /// relative out-of-balance force
        residual: f64,
        /// Newton steps taken
        iterations: usize,
    },
    /// Nothing holds this part of the wire.
    #[error("nothing holds node {node} at {share} of the load")]
    SingularPivot {
        /// first node without stiffness
        node: usize,
        /// share of the load, 1 unless ramped
        share: f64,
    },
    /// A force is not a number.
    #[error("the forces broke down at node {node} at {share} of the load")]
    Broken {
        /// first bad node
        node: usize,
        /// share of the load, 1 unless ramped
        share: f64,
    },
}

/// Unknowns per node: three coordinates and the roll of the edge after it.
pub(crate) const PER_NODE: usize = 4;
/// Farthest unknown that a force depends on: the last coordinate of the node two further on.
const HALF_BAND: usize = 2 * PER_NODE + 2;
/// Nodes this far apart share no force.
const COLOURS: usize = 5;
/// Displacement in the central differences, in edge lengths; rad for the roll.
const NUDGE: f64 = 1e-5;
/// Largest turn or stretch of an edge in one Newton step.
const LARGEST_TURN: f64 = 0.4;
/// Newton steps up to which an increment was quick, and what happens to the next one.
const QUICK: usize = 7;
const GROWTH: f64 = 1.4;
const SHRINK: f64 = 0.5;
/// Where the wire yields, a step is cut back until the forces out of balance do no more than this
/// share of the work they began with, in at most so many tries.
const CUT: f64 = 0.5;
const MOST_CUTS: usize = 8;

/// Moves `sys` to equilibrium under its present loads and supports, and commits it.
///
/// Velocities and spins become zero. Held coordinates may start away from their supports: they go
/// there with the rest of the wire.
pub fn relax(sys: &mut System, limits: &Limits) -> Result<Relaxed, RelaxError> {
    sys.state.rod.v.fill(V3::zeros());
    sys.state.rod.spin.fill(0.0);
    sys.state.roll.clear();
    sys.state.roll.resize(sys.state.rod.edges(), 0.0);
    let target = support_places(sys);
    sys.evaluate(None);
    let mut iterations = 0;
    loop {
        let balance = Balance::of(sys)?;
        let residual = balance.worst(sys);
        if balance.holds(sys, limits.tolerance) && at_supports(sys, &target) {
            sys.evaluate(Some(0.0));
            return Ok(Relaxed {
                iterations,
                increments: 1,
                residual,
            });
        }
        if iterations == limits.iterations {
            return Err(RelaxError::NotConverged {
                share: 1.0,
                residual,
                iterations,
            });
        }
        iterations += 1;
        newton_step(sys, &target)?;
    }
}

/// Follows equilibrium while `apply` brings loads and supports from share 0 to share 1 of what
/// they shall be, in increments that shrink where Newton's method fails and grow where it is quick.
pub fn ramp(
    sys: &mut System,
    limits: &Limits,
    mut apply: impl FnMut(&mut System, f64),
) -> Result<Relaxed, RelaxError> {
    let (mut at, mut step) = (0.0, limits.first);
    let mut total = Relaxed {
        iterations: 0,
        increments: 0,
        residual: 0.0,
    };
    // how the wire moved in the last increment, and the share of the load that did it
    let mut trend: Option<(Vec<f64>, f64)> = None;
    while at < 1.0 {
        let to = if at + step > 1.0 - 1e-9 {
            1.0
        } else {
            at + step
        };
        let before = sys.clone();
        apply(sys, to);
        if let Some((moved, share)) = &trend {
            carry_on(sys, moved, (to - at) / share);
        }
        match relax(sys, limits) {
            Ok(done) => {
                let mut moved = vec![0.0; PER_NODE * sys.state.rod.nodes()];
                for (i, (x, x0)) in sys.state.rod.x.iter().zip(&before.state.rod.x).enumerate() {
                    moved[PER_NODE * i..PER_NODE * i + 3].copy_from_slice((x - x0).as_slice());
                }
                trend = Some((moved, to - at));
                at = to;
                total.iterations += done.iterations;
                total.increments += 1;
                total.residual = done.residual;
                if done.iterations <= QUICK {
                    step = (GROWTH * step).min(limits.largest);
                }
            }
            Err(error) => {
                *sys = before;
                step *= SHRINK;
                if step < limits.smallest {
                    return Err(error.at_share(to));
                }
            }
        }
    }
    Ok(total)
}

/// A first guess: the wire goes on as it went before.
fn carry_on(sys: &mut System, moved: &[f64], share: f64) {
    sys.state.roll.clear();
    sys.state.roll.resize(sys.state.rod.edges(), 0.0);
    let start = (sys.state.rod.x.clone(), sys.state.roll.clone());
    advance(sys, &start, moved, share, None);
}

impl RelaxError {
    fn at_share(self, share: f64) -> Self {
        match self {
            Self::NotConverged {
                residual,
                iterations,
                ..
            } => Self::NotConverged {
                share,
                residual,
                iterations,
            },
            Self::SingularPivot { node, .. } => Self::SingularPivot { node, share },
            Self::Broken { node, .. } => Self::Broken { node, share },
        }
    }
}

/// Whether coordinate `a` of node `i` is held.
fn held(sys: &System, i: usize, a: usize) -> bool {
    (i == 0 && sys.state.support[0].hold[a])
        || (i + 1 == sys.state.rod.nodes() && sys.state.support[1].hold[a])
}

/// Where the supports want the two end nodes; coordinates that are free stay as they are.
fn support_places(sys: &mut System) -> [V3; 2] {
    let last = sys.state.rod.nodes() - 1;
    let before = [sys.state.rod.x[0], sys.state.rod.x[last]];
    sys.place_supports();
    let target = [sys.state.rod.x[0], sys.state.rod.x[last]];
    for (i, x) in [(0, before[0]), (last, before[1])] {
        sys.state.rod.x[i] = x;
        sys.state.rod.v[i] = V3::zeros();
    }
    target
}

fn at_supports(sys: &System, target: &[V3; 2]) -> bool {
    let last = sys.state.rod.nodes() - 1;
    (0..3).all(|a| {
        (!held(sys, 0, a) || sys.state.rod.x[0][a] == target[0][a])
            && (!held(sys, last, a) || sys.state.rod.x[last][a] == target[1][a])
    })
}

/// The size of the loads, against which forces out of balance are judged.
struct Balance {
    force: f64,
    moment: f64,
}

impl Balance {
    fn of(sys: &System) -> Result<Self, RelaxError> {
        let length: f64 = sys.state.rod.rest.iter().sum();
        for i in 0..sys.state.rod.nodes() {
            let torque = sys.state.load.torque.get(i).copied().unwrap_or(0.0);
            if !(sys.state.load.force[i].norm() + torque.abs()).is_finite() {
                return Err(RelaxError::Broken {
                    node: i,
                    share: 1.0,
                });
            }
        }
        let last = sys.state.rod.nodes() - 1;
        let mut force =
            sys.model.loads.gravity.norm() * sys.model.section.mass_per_length() * length;
        for i in [0, last] {
            for a in 0..3 {
                if held(sys, i, a) {
                    force = force.max(sys.state.load.force[i][a].abs());
                }
            }
        }
        for (_, f) in &sys.model.loads.nodal {
            force = force.max(f.norm());
        }
        let couples = sys.model.loads.moments.iter().map(|(_, m)| m.norm());
        let clamps = sys.state.load.clamp_moment.iter().map(|m| m.norm());
        let moment = couples.chain(clamps).fold(force * length, f64::max);
        Ok(Self {
            force: moment / length,
            moment,
        })
    }

    /// Rounding of positions felt as force at node `i`, N.
    fn noise(sys: &System, i: usize) -> f64 {
        let after = sys.state.rod.rest.get(i).copied().unwrap_or(f64::INFINITY);
        let before = if i > 0 {
            sys.state.rod.rest[i - 1]
        } else {
            f64::INFINITY
        };
        let h = after.min(before);
        let stiffness = sys.model.section.ea / h + 4.0 * sys.model.section.ei / (h * h * h);
        16.0 * f64::EPSILON * sys.state.rod.x[i].norm().max(h) * stiffness
    }

    fn holds(&self, sys: &System, tolerance: f64) -> bool {
        let forces = (0..sys.state.rod.nodes()).all(|i| {
            let limit = tolerance * self.force + Self::noise(sys, i);
            (0..3).all(|a| held(sys, i, a) || sys.state.load.force[i][a].abs() <= limit)
        });
        let torques = (0..sys.state.rod.edges()).all(|j| {
            let noise = 64.0 * f64::EPSILON * sys.model.section.gj / sys.state.rod.rest[j];
            !sys.model.twist.is_carried()
                || sys.state.load.torque[j].abs() <= tolerance * self.moment + noise
        });
        forces && torques
    }

    /// Largest force out of balance over the load.
    fn worst(&self, sys: &System) -> f64 {
        let mut worst = 0.0_f64;
        for i in 0..sys.state.rod.nodes() {
            for a in 0..3 {
                if !held(sys, i, a) {
                    worst = worst.max(sys.state.load.force[i][a].abs());
                }
            }
        }
        if self.force > 0.0 {
            worst / self.force
        } else {
            worst
        }
    }
}

/// One Newton step, shortened where an edge would turn or stretch too far or where the wire
/// yields and a shorter step does better.
fn newton_step(sys: &mut System, target: &[V3; 2]) -> Result<(), RelaxError> {
    let nodes = sys.state.rod.nodes();
    let before = residual(sys);
    let mut step = before.clone();
    let yielding = plastic_tangent::yields(sys);
    let mut tangent = tangent(sys);
    let mut carried = false;
    for i in 0..nodes {
        for a in 0..PER_NODE {
            let k = PER_NODE * i + a;
            if a == 3 {
                if i + 1 == nodes || !sys.model.twist.is_carried() {
                    tangent.fix(k);
                    step[k] = 0.0;
                }
            } else if held(sys, i, a) {
                tangent.fix(k);
                step[k] = target[usize::from(i > 0)][a] - sys.state.rod.x[i][a];
                carried |= step[k] != 0.0;
            }
        }
    }
    tangent
        .solve(&mut step)
        .map_err(|row| RelaxError::SingularPivot {
            node: row / PER_NODE,
            share: 1.0,
        })?;
    let mut largest = 0.0_f64;
    for j in 0..nodes - 1 {
        largest = largest
            .max((part(&step, j + 1) - part(&step, j)).norm() / sys.state.rod.rest[j])
            .max(step[PER_NODE * j + 3].abs() / sys.state.rod.rest[j]);
    }
    let whole = (LARGEST_TURN / largest).min(1.0);
    if !whole.is_finite() {
        return Err(RelaxError::Broken {
            node: 0,
            share: 1.0,
        });
    }
    let start = (sys.state.rod.x.clone(), sys.state.roll.clone());
    advance(sys, &start, &step, whole, Some(target));
    sys.evaluate(None);
    // work of the forces out of balance along the step: 0 at the best share
    let work = |sys: &System| out_of_balance(sys, &residual(sys), &step);
    let gained = out_of_balance(sys, &before, &step);
    if carried || !(yielding || plastic_tangent::yields(sys)) || gained <= 0.0 {
        return Ok(());
    }
    // beyond the best share the tangent of a yielding joint has led too far: go back towards it
    let (mut low, mut high) = ((0.0, gained), (whole, work(sys)));
    for _ in 0..MOST_CUTS {
        let (share, at) = high;
        if at >= -CUT * gained {
            break;
        }
        let straight = low.0 + (share - low.0) * low.1 / (low.1 - at);
        let next = straight.clamp(low.0 + 0.1 * (share - low.0), low.0 + 0.7 * (share - low.0));
        advance(sys, &start, &step, next, Some(target));
        sys.evaluate(None);
        let found = work(sys);
        if found > CUT * gained {
            low = (next, found);
            // stay inside what is known to be too far
            let middle = 0.5 * (next + share);
            advance(sys, &start, &step, middle, Some(target));
            sys.evaluate(None);
            high = (middle, work(sys));
        } else {
            high = (next, found);
        }
    }
    Ok(())
}

/// Work of the forces `r` on the free coordinates along `step`.
fn out_of_balance(sys: &System, r: &[f64], step: &[f64]) -> f64 {
    (0..r.len())
        .filter(|k| k % PER_NODE == 3 || !held(sys, k / PER_NODE, k % PER_NODE))
        .map(|k| r[k] * step[k])
        .sum()
}

/// The part of a step that belongs to node `i`.
fn part(step: &[f64], i: usize) -> V3 {
    let k = PER_NODE * i;
    V3::new(step[k], step[k + 1], step[k + 2])
}

/// Moves from `start` by a share of `step`.
///
/// Edges turn and stretch by their part of it rather than their nodes moving straight on: a turn
/// would else stretch the edge by half its square, and the wire is far stiffer that way.
fn advance(
    sys: &mut System,
    start: &(Vec<V3>, Vec<f64>),
    step: &[f64],
    share: f64,
    target: Option<&[V3; 2]>,
) {
    let (x, roll) = start;
    let last = x.len() - 1;
    sys.state.rod.x[0] = x[0] + part(step, 0) * share;
    for j in 0..last {
        let d = x[j + 1] - x[j];
        let length = d.norm();
        let move_on = (part(step, j + 1) - part(step, j)) * share;
        let stretched = length + move_on.dot(&d) / length;
        let direction = (d + move_on).normalize();
        sys.state.rod.x[j + 1] = sys.state.rod.x[j] + direction * stretched;
        sys.state.roll[j] = roll[j] + share * step[PER_NODE * j + 3] / sys.state.rod.rest[j];
    }
    // a held far end stays where the straight step puts it; the wire shares the difference
    let mut miss = x[last] + part(step, last) * share - sys.state.rod.x[last];
    for a in 0..3 {
        if !held(sys, last, a) {
            miss[a] = 0.0;
        }
    }
    for i in 1..=last {
        sys.state.rod.x[i] += miss * (i as f64 / last as f64);
    }
    for (i, end) in [(0, 0), (last, 1)] {
        for a in 0..3 {
            if held(sys, i, a) {
                // exactly, so that the wire is seen to have arrived
                sys.state.rod.x[i][a] = match target {
                    Some(target) if share == 1.0 => target[end][a],
                    _ => x[i][a] + share * step[PER_NODE * i + a],
                };
            }
        }
    }
}

/// Forces on nodes and torques on edges, these over the edge length so that all are in N.
fn residual(sys: &System) -> Vec<f64> {
    let mut r = vec![0.0; PER_NODE * sys.state.rod.nodes()];
    for i in 0..sys.state.rod.nodes() {
        r[PER_NODE * i..PER_NODE * i + 3].copy_from_slice(sys.state.load.force[i].as_slice());
        if i < sys.state.rod.edges() {
            r[PER_NODE * i + 3] = sys.state.load.torque[i] / sys.state.rod.rest[i];
        }
    }
    r
}

/// Minus the derivative of [`residual`] with respect to positions and rolls (times edge length).
fn tangent(sys: &mut System) -> Band {
    let nodes = sys.state.rod.nodes();
    let size = PER_NODE * nodes;
    let mut band = Band::new(size, HALF_BAND);
    // a law with a kink has no difference quotient: go round it with the elastic law at the same
    // forces, and take off afterwards what the yielding joints lack of it
    let flows = plastic_tangent::Flows::of(sys);
    let plastic = flows.hide(sys);
    let (x, roll) = (sys.state.rod.x.clone(), sys.state.roll.clone());
    let nudge: Vec<f64> = (0..nodes)
        .map(|i| {
            let after = sys.state.rod.rest.get(i).copied().unwrap_or(f64::INFINITY);
            let before = if i > 0 {
                sys.state.rod.rest[i - 1]
            } else {
                f64::INFINITY
            };
            NUDGE * after.min(before)
        })
        .collect();
    for colour in 0..COLOURS {
        for a in 0..PER_NODE {
            let mut sides = [Vec::new(), Vec::new()];
            for (side, sign) in [(0, 1.0), (1, -1.0)] {
                for i in (colour..nodes).step_by(COLOURS) {
                    if a < 3 {
                        sys.state.rod.x[i][a] = x[i][a] + sign * nudge[i];
                    } else if i + 1 < nodes {
                        sys.state.roll[i] = roll[i] + sign * NUDGE;
                    }
                }
                sys.evaluate(None);
                sides[side] = residual(sys);
                sys.state.rod.x.copy_from_slice(&x);
                sys.state.roll.copy_from_slice(&roll);
            }
            for i in (colour..nodes).step_by(COLOURS) {
                let width = match (a < 3, i + 1 < nodes) {
                    (true, _) => 2.0 * nudge[i],
                    (false, true) => 2.0 * NUDGE * sys.state.rod.rest[i],
                    (false, false) => continue,
                };
                let column = PER_NODE * i + a;
                let from = column.saturating_sub(HALF_BAND);
                for row in from..(column + HALF_BAND + 1).min(size) {
                    // the band is a little wider than the reach of a node: leave the others alone
                    let node = row / PER_NODE;
                    if node + 2 >= i && node <= i + 2 {
                        *band.at(row, column) = (sides[1][row] - sides[0][row]) / width;
                    }
                }
            }
        }
    }
    plastic.restore(sys);
    flows.soften(sys, &mut band);
    band
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{align, frame_along};
    use crate::rod::{Rod, Section};
    use crate::system::Support;

    fn section() -> Section {
        Section {
            n_y: 38.5,
            m_y: 5.72e-3,
            t_y: 5.18e-3,
            ..Section::table1_elastic()
        }
    }

    /// A clamped piece that runs askew to all axes.
    fn cantilever(section: Section) -> System {
        let along = V3::new(0.6, 0.48, 0.64);
        let points: Vec<V3> = (0..=20).map(|i| along * (1e-3 * i as f64)).collect();
        let mut sys = System::new(section, Rod::through(&points, None));
        sys.state.support[0] = Support::clamped(V3::zeros(), frame_along(&along, None));
        sys
    }

    /// Bends, twists and pulls it past all limits.
    fn push(sys: &mut System, share: f64) {
        let force = V3::new(20.0, 25.0, 30.0) + V3::new(0.8, -0.6, 0.0);
        sys.model.loads.nodal = vec![(20, force * share)];
        sys.model.loads.moments = vec![(19, V3::new(4e-3, 3.2e-3, 4.2e-3) * share)];
    }

    #[test]
    fn the_tangent_is_the_derivative_of_the_forces_where_all_laws_yield() {
        let mut sys = cantilever(section());
        ramp(&mut sys, &Limits::default(), push).expect("the load is carried");
        assert!(
            sys.state.rod.stretch[5].strain > 0.0
                && sys.state.rod.twist[5].strain != 0.0
                && sys.state.rod.bend[1].rise > 0.0
        );
        push(&mut sys, 1.05);
        sys.evaluate(None);
        // move on into yield, away from the kink that the committed state sits on
        newton_step(&mut sys, &[V3::zeros(); 2]).expect("forces are finite");
        // forces are derivatives with the frames carried along from where the wire is now
        for j in 0..20 {
            let t = sys.state.rod.tangent(j);
            sys.state.rod.frame[j] = align(&sys.state.rod.frame[j], &t, sys.state.roll[j]);
            sys.state.roll[j] = 0.0;
        }
        let mut band = tangent(&mut sys);
        let (x, roll) = (sys.state.rod.x.clone(), sys.state.roll.clone());
        let mut worst = 0.0_f64;
        for k in [9usize, 10, 11] {
            for a in 0..PER_NODE {
                let mut sides = [Vec::new(), Vec::new()];
                for (side, sign) in [(0, 1.0), (1, -1.0)] {
                    if a < 3 {
                        sys.state.rod.x[k][a] += sign * 1e-10;
                    } else {
                        sys.state.roll[k] += sign * 1e-7;
                    }
                    sys.evaluate(None);
                    sides[side] = residual(&sys);
                    sys.state.rod.x.clone_from(&x);
                    sys.state.roll.clone_from(&roll);
                }
                let column = PER_NODE * k + a;
                let diagonal = band.at(column, column).abs();
                for row in PER_NODE * (k - 2)..PER_NODE * (k + 2) {
                    let by_force = (sides[1][row] - sides[0][row]) / 2e-10;
                    worst = worst.max((*band.at(row, column) - by_force).abs() / diagonal);
                }
            }
        }
        assert!(worst < 1e-3, "relative difference {worst}");
    }

    #[test]
    fn a_ramp_leaves_the_same_yielding_however_it_is_cut() {
        let strains = |largest: f64| {
            let mut sys = cantilever(section());
            let limits = Limits {
                largest,
                first: largest,
                ..Limits::default()
            };
            ramp(&mut sys, &limits, |sys, share| {
                // in one plane, where the law does not depend on the path
                sys.model.loads.nodal = vec![(20, V3::new(0.8, -0.6, 0.0).cross(&V3::z()) * share)];
            })
            .expect("the load is carried");
            (sys.state.rod.x[20], sys.state.rod.bend[0].rise)
        };
        let (coarse, fine) = (strains(0.5), strains(0.02));
        assert!(fine.1 > 1e-4, "{fine:?}");
        assert!((coarse.0 - fine.0).norm() < 1e-5, "{coarse:?} {fine:?}");
        assert!(
            (coarse.1 - fine.1).abs() < 1e-2 * fine.1,
            "{coarse:?} {fine:?}"
        );
    }

    #[test]
    fn what_has_no_equilibrium_is_an_error() {
        let mut sys = cantilever(section());
        sys.state.support[0] = Support::free();
        sys.model.loads.nodal = vec![(20, V3::x())];
        assert!(relax(&mut sys, &Limits::default()).is_err());
        let mut sys = cantilever(section());
        sys.model.loads.nodal = vec![(20, V3::x() * f64::NAN)];
        assert!(matches!(
            relax(&mut sys, &Limits::default()),
            Err(RelaxError::Broken { .. })
        ));
        let mut sys = cantilever(section());
        let hurried = Limits {
            iterations: 1,
            ..Limits::default()
        };
        push(&mut sys, 1.0);
        assert!(matches!(
            relax(&mut sys, &hurried),
            Err(RelaxError::NotConverged { iterations: 1, .. })
        ));
    }
}
