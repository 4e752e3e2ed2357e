//! Landings as impulses: what touches neither sinks in nor opens faster than its landing gives back.
//!
//! A blow lasts one or two microseconds, a step ten times as long or longer. The solve holds the wire at the surface; how fast it goes on
//! would be left to the formula of time. So the accepted velocities are set: of every touch, the speed along its
//! normal is 0, or what the landing gives back. The impulses that do so act along the forces of the touches, friction
//! across the wire included, and none of them pulls.
//!
//! A touch that began within the step also rewrites the history of its nodes. After it, the formula of time has to see a wire
//! that moved all the time as it does now, or it would take the fall for part of the motion.

use super::impulse::{Impulse, PARTS};
use super::landings::{Came, Solved};
use super::scheme::StepFormula;
use crate::contact::AcceptedTouch;
use crate::math::{Spin, V3, spin_velocity};
use crate::system::{Spindle, System};

/// Sweeps over the touches that are enough.
const SWEEPS: usize = 50;
/// Times by which impulses may raise the motion energy. Chosen: `verify shoulder_drop` comes to rest with less, a wedge
/// brings a hundred times and more.
const GIVEN: f64 = 10.0;
/// Way in a step that no sweep has to mend, as a share of the tolerance.
const UNSEEN: f64 = 0.01;

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
    /// forces that came with landings, see [`Came`]
    came: Came,
    impulses: Vec<Impulse>,
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
        let [blow, rubbed] =
            self.came
                .in_landings(sys, step, (solved, old), (&self.impulses, &self.start[0]));
        sys.state.balance.numerical -= blow + rubbed;
        book(sys, rubbed, blow);
        self.give_back_friction(sys, step, parts);
        let before = Carried::of(sys);
        let bound = UNSEEN * tolerance;
        self.settle(step.h, bound, parts);
        if self.gives_motion() {
            // where wire is wedged, friction of one touch can press another, and that one the first, without end
            self.forget_friction();
            self.settle(step.h, bound, parts);
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

    /// Sweeps over the touches in a step of `h` (s), until no way changes by `unseen`, m.
    fn settle(&mut self, h: f64, unseen: f64, parts: usize) {
        let bounds = [unseen / h, unseen / h, unseen];
        for (part, bound) in bounds.into_iter().enumerate().take(parts) {
            for sweep in 0..SWEEPS {
                if self.sweep(part, sweep % 2 == 1) < bound {
                    break;
                }
            }
        }
    }

    /// Whether impulses brought more motion, as the core sees it, than landings give back.
    fn gives_motion(&self) -> bool {
        let energy = |motion: &[V3]| -> f64 {
            let nodes = motion.iter().zip(&self.mobility).filter(|(_, m)| **m > 0.0);
            nodes.map(|(v, m)| 0.5 * v.norm_squared() / m).sum()
        };
        let before = energy(&self.start[0]);
        let back = |i: &Impulse| i.range[0][0] * i.range[0][0] / i.inverse;
        let given_back: f64 = self.impulses.iter().map(back).sum();
        energy(&self.motion[0]) > before * GIVEN + given_back
    }

    /// Goes back to the start, with impulses along the normals only. They are a projection, which never gives motion.
    fn forget_friction(&mut self) {
        for impulse in &mut self.impulses {
            (impulse.along, impulse.added) = (impulse.touch.normal, [0.0; PARTS]);
        }
        for (start, motion) in self.start.iter().zip(&mut self.motion) {
            motion.clone_from(start);
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
