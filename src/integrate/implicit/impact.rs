//! Landings as impulses: what touches neither sinks in nor opens faster than its landing gives back.
//!
//! A blow lasts one or two microseconds, a step ten times as long or longer. The solve holds the wire at the surface; how fast it goes on
//! would be left to the formula of time. So the accepted velocities are set: of every touch, the speed along its
//! normal is 0, or what the landing gives back. The impulses that do so act along the normals, and none of them pulls.
//! Friction comes with them, across the wire: it brakes a slide and never drives one.
//!
//! A touch that began within the step also rewrites the history of its nodes. After it, the formula of time has to see a wire
//! that moved all the time as it does now, or it would take the fall for part of the motion.

use super::carried::Carried;
use super::impulse::{Impulse, NOW, PARTS, PLACE, START};
use super::landings::{Came, Solved};
use super::scheme::StepFormula;
use super::stirred::Stirred;
use crate::contact::AcceptedTouch;
use crate::math::{Spin, V3, spin_velocity};
use crate::system::{Spindle, System};

/// How often a touch is looked at until that has to be enough.
const LOOKS: u8 = 20;
/// Way in a step that no sweep has to mend, as a share of the tolerance.
const UNSEEN: f64 = 0.01;
/// Change by a touch, as a share of what is unseen, after which the touches of its nodes are looked at again before all are.
const STIRS: f64 = 0.1;

/// Adds to what friction and blows took, J.
fn book(sys: &mut System, rubbed: f64, stopped: f64) {
    sys.state.balance.friction += rubbed;
    sys.state.balance.damping += stopped;
    if let Some(line) = sys.line_contact() {
        line.state.loss.friction += rubbed;
        line.state.loss.damping += stopped;
    }
}

/// What blows and friction took, J. They act at once, and which of them took a motion cannot be told; so where they take, none gives.
fn apart(taken: [f64; 2]) -> [f64; 2] {
    let most = (taken[0] + taken[1]).max(0.0);
    match taken {
        [blow, rubbed] if blow < 0.0 && rubbed > 0.0 => [blow + rubbed - most, most],
        [blow, rubbed] if rubbed < 0.0 && blow > 0.0 => [most, blow + rubbed - most],
        _ => taken,
    }
}

/// Leaves out of what impulses took, J, the motion that the formula of time had `given` within the step, J.
///
/// A long step cannot tell the speed of wire that is held by tension and its touches. What its formula makes up, and the impulses take
/// away again, is no blow.
fn taken_back(sys: &mut System, given: f64, mut taken: [f64; 2]) -> [f64; 2] {
    let mut back = given.min(taken.iter().sum());
    for part in &mut taken {
        let of_it = back.min(*part).max(0.0);
        (*part, back) = (*part - of_it, back - of_it);
        sys.state.balance.numerical += of_it;
    }
    taken
}

/// Impulses of touches, and what they are computed with.
#[derive(Debug, Default)]
pub(super) struct Impacts {
    /// node by node, core frame, a part each: [`NOW`], [`START`] and [`PLACE`]; only the first where nothing landed
    motion: [Vec<V3>; PARTS],
    /// the same before any impulse
    start: [Vec<V3>; PARTS],
    /// velocity that an impulse gives to a node, 1/kg
    mobility: Vec<f64>,
    /// forces that came with landings, see [`Came`]
    came: Came,
    impulses: Vec<Impulse>,
    stirred: Stirred,
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
        let mut carried = solved.carried;
        let Some(line) = sys.line_contact() else {
            return;
        };
        if line.scratch.accepted.is_empty() {
            return;
        }
        let restitution = line.model.restitution;
        let touches = std::mem::take(&mut line.scratch.accepted);
        let landed = touches.iter().any(|t| t.began);
        self.look(sys, old, solved.mass, landed);
        let [places, before, _] = &sys.state.past.q;
        self.list(&touches, (places, before), step, restitution);
        if let Some(line) = sys.line_contact() {
            line.scratch.accepted = touches;
        }
        let [blow, rubbed] =
            self.came
                .in_landings(sys, step, (solved, old), (&self.impulses, &self.start[NOW]));
        sys.state.balance.numerical -= blow + rubbed;
        let by_landings = [blow, rubbed];
        self.give_back_friction(sys, step, landed, &mut carried);
        let bound = UNSEEN * tolerance;
        self.sweep_parts(step.h, bound, landed, restitution);
        self.take_over(sys, step, old, landed);
        let rubbed = self.rubbed();
        let now = Carried::of(sys);
        let stopped = -carried.gained(sys, now) - rubbed;
        if landed {
            // (a blow has no moment that a step could tell)
            sys.state.pressed = 0.0;
        } else if !sys.contact_follows(step.h) {
            sys.state.pressed += (solved.carried.momentum - now.momentum) / step.h;
        }
        let given = solved.numerical - sys.state.balance.numerical;
        let taken = apart([by_landings[0] + stopped, by_landings[1] + rubbed]);
        let [stopped, rubbed] = taken_back(sys, given, taken);
        book(sys, rubbed, stopped);
        if restitution > 0.0
            && let Some(line) = sys.line_contact()
        {
            for impulse in &self.impulses {
                let speed = impulse.range[NOW][1];
                line.state.keep_rebound(impulse.touch.owner, speed);
            }
        }
    }

    /// Impulses that stop what touches in a step of `h` (s), then those that let it rebound, and its history with them; until no way
    /// changes by `unseen`, m.
    fn sweep_parts(&mut self, h: f64, unseen: f64, landed: bool, restitution: f64) {
        self.stirred.list(&self.impulses, self.mobility.len());
        self.sweep_until(NOW, unseen / h);
        if !landed {
            return;
        }
        if restitution > 0.0 {
            let landings = self.impulses.iter_mut().filter(|i| i.touch.began);
            landings.for_each(Impulse::rebound);
            // (what a rebound is wrong by goes on over many steps)
            self.sweep_until(NOW, 0.1 * unseen / h);
            for landing in self.impulses.iter_mut().filter(|i| i.touch.began) {
                landing.rebounds_at(landing.along_normal(&self.motion[NOW]), h);
            }
        }
        self.sweep_until(START, unseen / h);
        self.sweep_until(PLACE, unseen);
        for impulse in &mut self.impulses {
            impulse.shift(&mut self.motion[PLACE]);
        }
    }

    /// Looks at the touches along the wire and back, until none changes a part of the motion by more than `unseen`.
    ///
    /// Most touches are settled soon, and long flats need many sweeps. So after a sweep over all of them, only those are looked
    /// at that share a node with one that changed since, until nothing stirs; a sweep over all has the last word.
    fn sweep_until(&mut self, part: usize, unseen: f64) {
        self.stirred.begin(LOOKS);
        let (mut all, mut backwards) = (true, false);
        loop {
            if all {
                self.stirred.all();
            }
            let largest = self.sweep(part, backwards, STIRS * unseen);
            if all && largest < unseen {
                return;
            }
            all = largest < unseen;
            backwards = !backwards;
        }
    }

    /// Work of friction in the impulses, J: each acts last, on the mean of the motion without it and the motion after all.
    fn rubbed(&self) -> f64 {
        let of_touch = |impulse: &Impulse| {
            let rubbed = impulse.rubbed[NOW];
            let alone = 0.5 * rubbed * impulse.inverse;
            rubbed * (alone - impulse.along_friction(&self.motion[NOW]))
        };
        self.impulses.iter().map(of_touch).sum()
    }

    /// Puts down how the wire moves, and where wire has `landed`, how it did at the step's start and where it was.
    fn look(&mut self, sys: &System, old: Spindle, mass: &[f64], landed: bool) {
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
        relative(now, &rod.v, &rod.x, &mut self.motion[NOW]);
        if landed {
            relative(old, &past.v, &past.x, &mut self.motion[START]);
            self.motion[PLACE].extend_from_slice(&past.q[1]);
        }
        for (start, motion) in self.start.iter_mut().zip(&self.motion) {
            start.clone_from(motion);
        }
    }

    /// Lists the touches; `places` are those of the nodes now and at the step's start, core frame, m.
    fn list(
        &mut self,
        touches: &[AcceptedTouch],
        (places, before): (&[V3], &[V3]),
        step: &StepFormula,
        restitution: f64,
    ) {
        self.impulses.clear();
        let landed = !self.motion[START].is_empty();
        for touch in touches {
            let Some(mut impulse) = Impulse::of(touch, step.gamma, &self.mobility, places) else {
                continue;
            };
            let way = impulse.along_friction(places) - impulse.along_friction(before);
            impulse.slid = (2.0 * way / step.h).min(0.0);
            impulse.range[NOW] = [0.0, touch.rebound];
            if touch.began {
                let approach = -impulse.along_normal(&self.motion[START]);
                let speed = restitution * approach.max(0.0);
                let there = impulse.along_normal(places) - step.h * speed;
                impulse.range = [[0.0; 2], [speed; 2], [there; 2]];
            } else if landed {
                for part in [START, PLACE] {
                    impulse.range[part] = [impulse.along_normal(&self.motion[part]); 2];
                }
            }
            self.impulses.push(impulse);
        }
    }

    /// Gives back what the solve took too much of friction, or takes what it left.
    fn give_back_friction(
        &mut self,
        sys: &mut System,
        step: &StepFormula,
        landed: bool,
        carried: &mut Carried,
    ) {
        let spin = Spin::new(sys.state.spindle.angle);
        for impulse in &mut self.impulses {
            let [now, start, _] = &sys.state.past.q;
            let way = impulse.seen_of(now) - impulse.seen_of(start);
            impulse.bound_surplus(step.gamma, &self.motion[NOW], (way, step.h));
            for (i, share) in impulse.shares() {
                let speed = impulse.touch.surplus * (share * step.gamma);
                sys.state.rod.v[i] += spin.to_lab(speed);
                self.motion[NOW][i] += speed;
                self.start[NOW][i] += speed;
                if landed {
                    self.motion[PLACE][i] -= speed * step.gamma;
                }
            }
        }
        let now = Carried::of(sys);
        sys.state.balance.numerical -= carried.gained(sys, now);
    }

    /// Mends the speed, or place, of each touch in turn that is to be looked at, along the wire or `backwards`, and those around one
    /// that changes by more than `stirs`; returns the largest change.
    fn sweep(&mut self, part: usize, backwards: bool, stirs: f64) -> f64 {
        let motion = &mut self.motion[part];
        let mut largest = 0.0_f64;
        let mut place = if backwards { self.impulses.len() } else { 0 };
        while let Some(k) = self.stirred.take(place, backwards) {
            place = if backwards { k } else { k + 1 };
            let impulse = &mut self.impulses[k];
            let mut change = impulse.press(part, motion);
            if part != PLACE {
                change = change.max(impulse.rub(part, motion));
            }
            if change > stirs {
                self.stirred.around(k);
            }
            largest = largest.max(change);
        }
        largest
    }

    /// Makes the motion that of the wire, now and at the step's start.
    fn take_over(&mut self, sys: &mut System, step: &StepFormula, old: Spindle, landed: bool) {
        let (now, before) = (Spin::new(sys.state.spindle.angle), Spin::new(old.angle));
        for (i, (v, start)) in self.motion[NOW].iter().zip(&self.start[NOW]).enumerate() {
            sys.state.rod.v[i] += now.to_lab(v - start);
        }
        let past = &mut sys.state.past;
        if landed {
            for i in 0..past.x.len() {
                let way = before.to_lab(self.motion[PLACE][i] - self.start[PLACE][i]);
                let faster = before.to_lab(self.motion[START][i] - self.start[START][i]);
                past.x[i] += way;
                past.v[i] += faster + spin_velocity(old.speed, way);
            }
        }
        // the way of a touch that opened too fast stays; the speed that it would stand for does not
        for impulse in self.impulses.iter().filter(|i| !i.touch.began) {
            for (i, share) in impulse.shares() {
                let speed = impulse.sum(NOW) * share;
                past.x[i] -= before.to_lab(speed * step.gamma);
            }
        }
        if !landed {
            for impulse in &self.impulses {
                for (i, share) in impulse.shares() {
                    let speed = impulse.touch.surplus * (share * step.gamma);
                    past.x[i] -= before.to_lab(speed * step.gamma);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{ContactPoint, TouchOwner};

    /// Masses of the nodes, kg.
    const MASS: f64 = 1e-6;

    /// Five nodes of straight wire along x that move at `speed`, m/s, with touches of the middle one.
    fn wedged(speed: V3, touches: &[AcceptedTouch]) -> Impacts {
        let places: Vec<V3> = (0..5).map(|i| V3::x() * f64::from(i) * 1e-3).collect();
        let motion: [Vec<V3>; PARTS] = std::array::from_fn(|_| vec![speed; 5]);
        let mobility = vec![1.0 / MASS; 5];
        let impulse = |touch: &AcceptedTouch| Impulse::of(touch, 1e-12, &mobility, &places);
        Impacts {
            impulses: touches.iter().filter_map(impulse).collect(),
            start: motion.clone(),
            motion,
            mobility,
            ..Impacts::default()
        }
    }

    fn touch(normal: V3, friction: V3) -> AcceptedTouch {
        AcceptedTouch {
            point: ContactPoint::Node(2),
            old: None,
            normal,
            force: normal + friction,
            surplus: V3::zeros(),
            began: false,
            lands: false,
            rebound: 0.0,
            owner: TouchOwner::Point { point: 4, slot: 0 },
        }
    }

    /// Friction was given back touch by touch, up to the speed of the wire in any direction. In a wedge this doubled with each touch: wire of
    /// 0.05 mm came to 1800 m/s.
    #[test]
    fn friction_given_back_in_a_wedge_gives_no_motion() {
        let (below, above) = (V3::y(), V3::new(0.0, -0.8, -0.6));
        let surplus = [V3::z(), V3::new(0.0, 0.6, -0.8)];
        for speed in [V3::z(), -V3::z(), V3::y(), V3::new(0.3, -0.8, -0.5)] {
            let touches =
                [(below, surplus[0]), (above, surplus[1])].map(|(normal, surplus)| AcceptedTouch {
                    surplus: surplus * 1e7,
                    ..touch(normal, surplus * 0.1)
                });
            let mut impacts = wedged(speed, &touches);
            let way = speed * 1e-5;
            for _ in 0..10 {
                for (impulse, surplus) in impacts.impulses.iter_mut().zip(surplus) {
                    impulse.touch.surplus = surplus * 1e7;
                    impulse.bound_surplus(1e-12, &impacts.motion[NOW], (way, 1e-5));
                    let surplus = impulse.touch.surplus;
                    for (i, share) in impulse.shares() {
                        impacts.motion[NOW][i] += surplus * (share * 1e-12);
                    }
                }
            }
            let [before, after] = [&impacts.start[NOW], &impacts.motion[NOW]].map(|v| energy(v));
            // (along either direction the wire may become twice as fast as its way says)
            assert!(after <= 5.0 * before, "{speed}: {before} J, {after} J");
        }
    }

    fn energy(motion: &[V3]) -> f64 {
        motion.iter().map(|v| 0.5 * MASS * v.norm_squared()).sum()
    }

    /// Friction was a fixed share of each impulse, whichever way the wire slid. It pushed wire along, and out of the wedge.
    #[test]
    fn friction_in_a_wedge_gives_no_motion() {
        for (opening, across, out) in [(0.05, -1.0, 1.0), (0.15, 1.0, 1.0), (0.6, 1.0, -1.0)] {
            for speed in [V3::z(), -V3::z(), V3::y(), V3::new(0.3, -0.8, -0.5)] {
                let below = V3::y();
                let above = V3::new(0.0, -libm::cos(opening), -libm::sin(opening));
                let along = V3::new(0.0, -above.z, above.y) * 0.8;
                let touches = [
                    touch(below, V3::z() * (0.8 * across)),
                    touch(above, along * out),
                ];
                let mut impacts = wedged(speed, &touches);
                impacts.sweep_parts(1e-5, 1e-12, false, 0.5);
                let [before, after] =
                    [&impacts.start[NOW], &impacts.motion[NOW]].map(|v| energy(v));
                assert!(
                    after <= before * (1.0 + 1e-9),
                    "{speed:?}, {opening}: {after:e} of {before:e} J"
                );
                let rubbed = impacts.rubbed();
                assert!(
                    rubbed >= 0.0 && rubbed <= before - after + 1e-9 * before,
                    "{rubbed:e}"
                );
                let falls = impacts
                    .impulses
                    .iter()
                    .any(|i| i.along_normal(&impacts.motion[NOW]) < -1e-2);
                assert!(!falls, "{speed:?}, {opening}: into its touch");
            }
        }
    }

    /// So many nodes of straight wire at rest, each with a touch.
    fn laid(nodes: usize) -> Impacts {
        let places: Vec<V3> = (0..nodes).map(|i| V3::x() * (i as f64) * 1e-3).collect();
        let mobility = vec![1.0 / MASS; nodes];
        let touches = (1..nodes - 1).map(|i| AcceptedTouch {
            point: ContactPoint::Node(i),
            ..touch(V3::y(), V3::z() * 0.1)
        });
        let of_touch = |touch| Impulse::of(&touch, 1e-12, &mobility, &places);
        let motion: [Vec<V3>; PARTS] = std::array::from_fn(|_| vec![V3::zeros(); nodes]);
        let mut impacts = Impacts {
            impulses: touches.filter_map(of_touch).collect(),
            start: motion.clone(),
            motion,
            mobility,
            ..Impacts::default()
        };
        impacts.stirred.list(&impacts.impulses, nodes);
        impacts
    }

    /// How often the touch of each node was looked at.
    fn looks(impacts: &Impacts) -> Vec<u8> {
        let left = impacts.stirred.left.iter();
        left.map(|left| LOOKS - left).collect()
    }

    /// Sweeps follow what stirs along the wire, and leave the rest alone; at the end nothing is left to mend.
    #[test]
    fn sweeps_follow_what_stirs() {
        let mut impacts = laid(200);
        impacts.motion[NOW][70] = V3::new(0.0, -1.0, 0.5);
        let unseen = 1e-6;
        impacts.sweep_until(NOW, unseen);
        let looks = looks(&impacts);
        // (all are looked at first and last)
        assert!(looks[67..72].iter().all(|l| *l > 3), "{looks:?}");
        assert!(
            looks[..40].iter().chain(&looks[100..]).all(|l| *l == 2),
            "{looks:?}"
        );
        impacts.stirred.begin(1);
        impacts.stirred.all();
        let left = impacts.sweep(NOW, false, 0.0);
        assert!(left < unseen, "{left}");
    }

    /// Touches that contradict each other were looked at fifty times as often as there are touches on the whole wire. The impulses there
    /// grew all the while, and a bobbin spent a quarter of its time on them.
    #[test]
    fn a_contradiction_is_left_after_a_bounded_number_of_looks() {
        let mut impacts = laid(200);
        // one touch wants its node to rise, and another one on the same node that it falls
        for (k, speed) in [(100, 1.0), (101, -1.0)] {
            let twin = impacts.impulses[100];
            impacts.impulses[k] = twin;
            impacts.impulses[k].given = 1.0;
            impacts.impulses[k].range = [[speed; 2]; PARTS];
        }
        impacts.stirred.list(&impacts.impulses, 200);
        impacts.sweep_until(NOW, 1e-6);
        let looks = looks(&impacts);
        assert_eq!(looks[100..102], [LOOKS; 2]);
        assert!(
            looks[..60].iter().chain(&looks[140..]).all(|l| *l <= 2),
            "{looks:?}"
        );
    }

    /// Friction stops a slide that it can stop, and brakes another by its share of the blow.
    #[test]
    fn friction_of_a_blow_brakes_the_slide() {
        for (slide, left) in [(-0.1, 0.0), (-2.0, -1.7)] {
            let mut impacts = wedged(V3::new(0.0, -1.0, slide), &[touch(V3::y(), V3::z() * 0.3)]);
            impacts.sweep_parts(1e-5, 1e-12, false, 0.0);
            let [impulse] = &impacts.impulses[..] else {
                panic!("one touch")
            };
            let got = impulse.along_friction(&impacts.motion[NOW]);
            assert!((got - left).abs() < 1e-9, "{slide}: {got}");
        }
    }
}
