//! Landings as impulses: what touches neither sinks in nor opens faster than its landing gives back.
//!
//! A blow lasts one or two microseconds, a step ten times as long or longer. The solve holds the wire at the surface; how fast it goes on
//! would be left to the formula of time. So the accepted velocities are set: of every touch, the speed along its
//! normal is 0, or what the landing gives back. The impulses that do so act along the forces of the touches, friction
//! across the wire included, and none of them pulls.
//!
//! A touch that began within the step also rewrites the history of its nodes. After it, the formula of time has to see a wire
//! that moved all the time as it does now, or it would take the fall for part of the motion.

mod landings;

use super::scheme::StepFormula;
use crate::contact::AcceptedTouch;
use crate::math::{Spin, V3, spin_velocity};
use crate::system::{Spindle, System};

/// Sweeps over the touches that are enough.
const SWEEPS: usize = 50;
/// Way in a step that no sweep has to mend, as a share of the tolerance.
const UNSEEN: f64 = 0.01;

/// The velocities now, those at the step's start, and the places there.
const PARTS: usize = 3;

/// The nodes as a step solved for them, without its impulses.
#[derive(Clone, Copy, Debug)]
pub(super) struct Solved<'a> {
    /// lumped masses, kg
    pub(super) mass: &'a [f64],
    /// velocities `v*`, m/s
    pub(super) star: &'a [V3],
    /// forces at the step's start, N
    pub(super) force: &'a [V3],
}

/// Adds to what friction and blows took, J.
fn book(sys: &mut System, rubbed: f64, stopped: f64) {
    sys.state.balance.friction += rubbed;
    sys.state.balance.damping += stopped;
    if let Some(line) = sys.line_contact() {
        line.state.loss.friction += rubbed;
        line.state.loss.damping += stopped;
    }
}

/// Impulses of touches, and what they are computed with.
#[derive(Debug, Default)]
pub(super) struct Impacts {
    /// node by node, core frame, see [`PARTS`]
    motion: [Vec<V3>; PARTS],
    /// the same before any impulse
    start: [Vec<V3>; PARTS],
    /// velocity that an impulse gives to a node, 1/kg
    mobility: Vec<f64>,
    /// forces that came with landings, see [`landings`]
    came: landings::Came,
    impulses: Vec<Impulse>,
}

/// The impulse of one touch.
#[derive(Clone, Copy, Debug)]
struct Impulse {
    touch: AcceptedTouch,
    /// nodes that it moves, and their weights; those of an older live wire have negative ones
    nodes: [usize; 6],
    weights: [f64; 6],
    /// change of the nodes' speeds by an impulse there, 1/kg
    shares: [f64; 6],
    /// how many they are
    count: usize,
    /// direction, whose part along the normal is 1
    along: V3,
    /// what the solve gave along the normal, N s
    given: f64,
    /// change of speed along the normal by an impulse there, 1/kg
    inverse: f64,
    /// least and largest speed, m/s, or place, m, along the normal
    range: [[f64; 2]; PARTS],
    /// the impulse added, N s, and N s^2 for the places
    added: [f64; PARTS],
}

impl Impulse {
    /// None yet, of a touch of the wire at `places` (m) in a step that ends with forces acting over `gamma` (s); `None` where
    /// nothing pushes or can move.
    ///
    /// What pulls along the wire is left to the solve: an edge is so stiff that it moves with all wire that a wave reaches in the step.
    fn of(touch: &AcceptedTouch, gamma: f64, mobility: &[f64], places: &[V3]) -> Option<Self> {
        let pressed = touch.force.dot(&touch.normal);
        let (mut nodes, mut weights, mut shares) = ([0; 6], [0.0; 6], [0.0; 6]);
        let mut count = 0;
        for place in [Some(touch.point.weights()), touch.old]
            .into_iter()
            .flatten()
        {
            for (i, w) in place.iter().filter(|(_, w)| *w != 0.0) {
                (nodes[count], weights[count], shares[count]) = (i, w, w * mobility[i]);
                count += 1;
            }
        }
        let mobile = |(i, w): (usize, f64)| w * w * mobility[i];
        let parts = nodes.into_iter().zip(weights).take(count);
        let inverse: f64 = parts.map(mobile).sum();
        let young = touch.point.weights().nodes;
        let tangent = (places[young[2]] - places[young[0]]).normalize();
        let of_wire = |v: V3| v - tangent * v.dot(&tangent);
        let touch = AcceptedTouch {
            surplus: of_wire(touch.surplus),
            ..*touch
        };
        let friction = touch.force - touch.normal * pressed;
        (pressed > 0.0 && inverse > 0.0).then(|| Self {
            touch,
            nodes,
            weights,
            shares,
            count,
            along: touch.normal + of_wire(friction) / pressed,
            given: gamma * pressed,
            inverse,
            range: [[0.0; 2]; PARTS],
            added: [0.0; PARTS],
        })
    }

    /// Nodes that the touch moves with, and their weights.
    #[inline]
    fn nodes(&self) -> impl Iterator<Item = (usize, f64)> + use<'_> {
        let nodes = self.nodes[..self.count].iter().copied();
        nodes.zip(self.weights[..self.count].iter().copied())
    }

    /// The same, with the change of each node's speed by an impulse there, 1/kg.
    #[inline]
    fn shares(&self) -> impl Iterator<Item = (usize, f64)> + use<'_> {
        let nodes = self.nodes[..self.count].iter().copied();
        nodes.zip(self.shares[..self.count].iter().copied())
    }

    /// What the touch sees of a motion of the nodes, along its normal.
    #[inline]
    fn along_normal(&self, motion: &[V3]) -> f64 {
        let normal = self.touch.normal;
        let part = |(i, w): (usize, f64)| w * motion[i].dot(&normal);
        self.nodes().map(part).sum()
    }
}

/// Motion energy, J, and moment of momentum about the core's axis, N m s, before impulses of the core.
struct Carried {
    kinetic: f64,
    momentum: f64,
}

impl Carried {
    fn of(sys: &System) -> Self {
        Self {
            kinetic: sys.kinetic(),
            momentum: sys.momentum_about_core(),
        }
    }

    /// Motion energy that impulses have brought since then, J, as the turning core sees it; what the core gave with
    /// them becomes work of the spindle.
    fn gained(&self, sys: &mut System) -> f64 {
        let now = Self::of(sys);
        let work = sys.state.spindle.speed * (now.momentum - self.momentum);
        sys.state.balance.spindle += work;
        now.kinetic - self.kinetic - work
    }
}

impl Impacts {
    /// Takes the speed out of what touches, after a step from the motion `old` of the spindle with the `solved` nodes.
    pub(super) fn stop(
        &mut self,
        sys: &mut System,
        step: &StepFormula,
        solved: Solved,
        old: Spindle,
        tolerance: f64,
    ) {
        let Some(line) = sys.line_contact() else {
            return;
        };
        if line.scratch.accepted.is_empty() {
            return;
        }
        let restitution = line.model.restitution;
        let touches = std::mem::take(&mut line.scratch.accepted);
        let parts = if touches.iter().any(|t| t.began) {
            PARTS
        } else {
            1
        };
        self.look(sys, old, solved.mass, parts);
        self.list(&touches, &sys.state.past.q[0], step, restitution);
        if let Some(line) = sys.line_contact() {
            line.scratch.accepted = touches;
        }
        self.book_landings(sys, step, solved, old);
        self.give_back_friction(sys, step, parts);
        let before = Carried::of(sys);
        let unseen = UNSEEN * tolerance;
        let bounds = [unseen / step.h, unseen / step.h, unseen];
        for (part, bound) in bounds.into_iter().enumerate().take(parts) {
            for sweep in 0..SWEEPS {
                if self.sweep(part, sweep % 2 == 1) < bound {
                    break;
                }
            }
        }
        self.take_over(sys, step, old, parts);
        let rubbed = self.rubbed();
        let stopped = -before.gained(sys) - rubbed;
        book(sys, rubbed, stopped);
        if restitution > 0.0
            && let Some(line) = sys.line_contact()
        {
            for impulse in &self.impulses {
                let speed = impulse.range[0][1];
                line.state.keep_rebound(impulse.touch.owner, speed);
            }
        }
    }

    /// Work of friction in the impulses, J: each acts on the mean of the motion before and after.
    fn rubbed(&self) -> f64 {
        let of_touch = |impulse: &Impulse| {
            let rubs = impulse.along - impulse.touch.normal;
            let mean =
                |(i, w): (usize, f64)| 0.5 * w * (self.motion[0][i] + self.start[0][i]).dot(&rubs);
            -impulse.added[0] * impulse.nodes().map(mean).sum::<f64>()
        };
        self.impulses.iter().map(of_touch).sum()
    }

    /// Puts down how the wire moves, in `parts` of the [`PARTS`].
    fn look(&mut self, sys: &System, old: Spindle, mass: &[f64], parts: usize) {
        let (rod, past, now) = (&sys.state.rod, &sys.state.past, sys.state.spindle);
        let free = sys.free_nodes();
        self.mobility.clear();
        let of_node = |(i, m): (usize, &f64)| if free.contains(&i) { 1.0 / m } else { 0.0 };
        self.mobility.extend(mass.iter().enumerate().map(of_node));
        for motion in &mut self.motion {
            motion.clear();
        }
        let relative = |spindle: Spindle, v: &[V3], x: &[V3], to: &mut Vec<V3>| {
            let spin = Spin::new(spindle.angle);
            let carried = |x: &V3| spin_velocity(spindle.speed, *x);
            to.extend(v.iter().zip(x).map(|(v, x)| spin.to_core(v - carried(x))));
        };
        relative(now, &rod.v, &rod.x, &mut self.motion[0]);
        if parts > 1 {
            relative(old, &past.v, &past.x, &mut self.motion[1]);
            self.motion[2].extend_from_slice(&past.q[1]);
        }
        for (start, motion) in self.start.iter_mut().zip(&self.motion) {
            start.clone_from(motion);
        }
    }

    /// Lists the touches; `places` are those of the nodes now, core frame, m.
    fn list(
        &mut self,
        touches: &[AcceptedTouch],
        places: &[V3],
        step: &StepFormula,
        restitution: f64,
    ) {
        self.impulses.clear();
        let began = !self.motion[1].is_empty();
        for touch in touches {
            let Some(mut impulse) = Impulse::of(touch, step.gamma, &self.mobility, places) else {
                continue;
            };
            impulse.range[0] = [0.0, touch.rebound];
            if touch.began {
                let approach = -impulse.along_normal(&self.motion[1]);
                let speed = restitution * approach.max(0.0);
                let there = impulse.along_normal(places) - step.h * speed;
                impulse.range = [[speed; 2], [speed; 2], [there; 2]];
            } else if began {
                for (part, motion) in self.motion.iter().enumerate().skip(1) {
                    impulse.range[part] = [impulse.along_normal(motion); 2];
                }
            }
            self.impulses.push(impulse);
        }
    }

    /// Gives back what the solve took too much of friction, or takes what it left, by no more than the wire slides.
    fn give_back_friction(&mut self, sys: &mut System, step: &StepFormula, parts: usize) {
        let before = Carried::of(sys);
        let spin = Spin::new(sys.state.spindle.angle);
        for impulse in &mut self.impulses {
            let of_nodes = impulse.nodes();
            let speed: V3 = of_nodes.map(|(i, w)| self.motion[0][i] * w).sum();
            let slide = speed - impulse.touch.normal * speed.dot(&impulse.touch.normal);
            let change = impulse.touch.surplus.norm() * impulse.inverse * step.gamma;
            if change > slide.norm() {
                impulse.touch.surplus *= slide.norm() / change;
            }
            for (i, share) in impulse.shares() {
                let speed = impulse.touch.surplus * (share * step.gamma);
                sys.state.rod.v[i] += spin.to_lab(speed);
                self.motion[0][i] += speed;
                self.start[0][i] += speed;
                if parts > 1 {
                    self.motion[2][i] -= speed * step.gamma;
                }
            }
        }
        sys.state.balance.numerical -= before.gained(sys);
    }

    /// Mends the speed, or place, of each touch in turn; returns the largest change along a normal.
    fn sweep(&mut self, part: usize, backwards: bool) -> f64 {
        let motion = &mut self.motion[part];
        let count = self.impulses.len();
        let mut largest: f64 = 0.0;
        for k in 0..count {
            let k = if backwards { count - 1 - k } else { k };
            let impulse = &mut self.impulses[k];
            let now = impulse.along_normal(motion);
            let alone = now - impulse.added[part] * impulse.inverse;
            let [low, high] = impulse.range[part];
            let wanted = (alone.clamp(low, high) - alone) / impulse.inverse;
            // a touch pushes: all that it gives along the normal is at least 0, and what the wire would have fallen
            // since it began lies behind its surface
            let allowed = match part {
                0 => wanted.max(-impulse.given),
                1 => wanted.max(0.0),
                _ => wanted.min(0.0),
            };
            let change = allowed - impulse.added[part];
            impulse.added[part] = allowed;
            for (i, share) in impulse.shares() {
                motion[i] += impulse.along * (share * change);
            }
            largest = largest.max((change * impulse.inverse).abs());
        }
        largest
    }

    /// Makes the motion that of the wire, now and at the step's start.
    fn take_over(&mut self, sys: &mut System, step: &StepFormula, old: Spindle, parts: usize) {
        let (now, before) = (Spin::new(sys.state.spindle.angle), Spin::new(old.angle));
        for (i, (v, start)) in self.motion[0].iter().zip(&self.start[0]).enumerate() {
            sys.state.rod.v[i] += now.to_lab(v - start);
        }
        let past = &mut sys.state.past;
        if parts > 1 {
            for i in 0..past.x.len() {
                let way = before.to_lab(self.motion[2][i] - self.start[2][i]);
                let faster = before.to_lab(self.motion[1][i] - self.start[1][i]);
                past.x[i] += way;
                past.v[i] += faster + spin_velocity(old.speed, way);
            }
        }
        // the way of a touch that opened too fast stays; the speed that it would stand for does not
        for impulse in self.impulses.iter().filter(|i| !i.touch.began) {
            for (i, share) in impulse.shares() {
                let speed = impulse.along * (share * impulse.added[0]);
                past.x[i] -= before.to_lab(speed * step.gamma);
            }
        }
        if parts == 1 {
            for impulse in &self.impulses {
                for (i, share) in impulse.shares() {
                    let speed = impulse.touch.surplus * (share * step.gamma);
                    past.x[i] -= before.to_lab(speed * step.gamma);
                }
            }
        }
    }
}
