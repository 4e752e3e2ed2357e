//! The impulse of one touch on the nodes that it moves with.

use crate::contact::AcceptedTouch;
use crate::math::V3;

/// How many parts a motion has.
pub(super) const PARTS: usize = 3;
/// The velocities now, m/s.
pub(super) const NOW: usize = 0;
/// The velocities at the step's start, m/s.
pub(super) const START: usize = 1;
/// The places at the step's start, m.
pub(super) const PLACE: usize = 2;

/// The impulse of one touch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Impulse {
    pub(super) touch: AcceptedTouch,
    /// nodes that it moves, and their weights; those of an older live wire have negative ones
    pub(super) nodes: [usize; 6],
    pub(super) weights: [f64; 6],
    /// change of the nodes' speeds by an impulse there, 1/kg
    shares: [f64; 6],
    /// how many they are
    pub(super) count: usize,
    /// whether each node follows the one before it, as those of one place do
    in_a_row: bool,
    /// direction of the touch's friction across the wire, or 0
    pub(super) rubs: V3,
    /// friction over normal force
    pub(super) friction: f64,
    /// speed along `rubs` at the end of a slide that begins at rest and goes evenly faster over the way of the step, not above 0, m/s
    pub(super) slid: f64,
    /// what the solve gave along the normal, N s
    pub(super) given: f64,
    /// change of speed along the normal by an impulse there, 1/kg
    pub(super) inverse: f64,
    /// largest impulse along the normal that makes it rebound, N s; what stops it may be more
    pub(super) most: f64,
    /// least and largest speed, m/s, or place, m, along the normal
    pub(super) range: [[f64; 2]; PARTS],
    /// the impulse added along the normal, N s, and N s^2 for the places
    pub(super) added: [f64; PARTS],
    /// that of friction, along `rubs`
    pub(super) rubbed: [f64; PARTS],
}

impl Impulse {
    /// None yet, of a touch of the wire at `places` (m) in a step that ends with forces acting over `gamma` (s); `None` where
    /// nothing pushes or can move.
    ///
    /// What pulls along the wire is left to the solve: an edge is so stiff that it moves with all wire that a wave reaches in the step.
    pub(super) fn of(
        touch: &AcceptedTouch,
        gamma: f64,
        mobility: &[f64],
        places: &[V3],
    ) -> Option<Self> {
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
        let friction = of_wire(touch.force - touch.normal * pressed);
        let size = friction.norm();
        (pressed > 0.0 && inverse > 0.0).then(|| Self {
            touch,
            nodes,
            weights,
            shares,
            count,
            in_a_row: nodes[..count].windows(2).all(|two| two[1] == two[0] + 1),
            rubs: if size > 0.0 {
                friction / size
            } else {
                friction
            },
            friction: size / pressed,
            slid: 0.0,
            given: gamma * pressed,
            inverse,
            most: f64::INFINITY,
            range: [[0.0; 2]; PARTS],
            added: [0.0; PARTS],
            rubbed: [0.0; PARTS],
        })
    }

    /// Nodes that the touch moves with, and their weights.
    #[inline]
    pub(super) fn nodes(&self) -> impl Iterator<Item = (usize, f64)> + use<'_> {
        let nodes = self.nodes[..self.count].iter().copied();
        nodes.zip(self.weights[..self.count].iter().copied())
    }

    /// The same, with the change of each node's speed by an impulse there, 1/kg.
    #[inline]
    pub(super) fn shares(&self) -> impl Iterator<Item = (usize, f64)> + use<'_> {
        let nodes = self.nodes[..self.count].iter().copied();
        nodes.zip(self.shares[..self.count].iter().copied())
    }

    /// What the touch sees of a motion of the nodes, along its normal.
    #[inline]
    pub(super) fn along_normal(&self, motion: &[V3]) -> f64 {
        self.part_of(motion, &self.touch.normal)
    }

    /// The same along its friction.
    #[inline]
    pub(super) fn along_friction(&self, motion: &[V3]) -> f64 {
        self.part_of(motion, &self.rubs)
    }

    #[inline]
    fn part_of(&self, motion: &[V3], along: &V3) -> f64 {
        let (first, count) = (self.nodes[0], self.count);
        if self.in_a_row {
            let near = motion[first..first + count].iter().zip(&self.weights);
            return near.map(|(m, w)| w * m.dot(along)).sum();
        }
        let part = |(i, w): (usize, f64)| w * motion[i].dot(along);
        self.nodes().map(part).sum()
    }

    /// Bounds what the solve took too much of friction, or left: as an impulse over `gamma` (s) it changes the slide in `motion` by no more than
    /// its speed. It drives it to no more than what a slide from rest ends with that makes its `way`, m, in a step of `h`, s.
    pub(super) fn bound_surplus(&mut self, gamma: f64, motion: &[V3], (way, h): (V3, f64)) {
        let change = self.touch.surplus.norm() * self.inverse * gamma;
        if change == 0.0 {
            return;
        }
        let across = |v: V3| v - self.touch.normal * v.dot(&self.touch.normal);
        let slide = across(self.seen_of(motion));
        let along = slide.dot(&self.touch.surplus.normalize());
        let mut most = slide.norm();
        if along >= 0.0 {
            most = most.min((2.0 * across(way).norm() / h - along).max(0.0));
        }
        if change > most {
            self.touch.surplus *= most / change;
        }
    }

    /// What the touch sees of a motion of the nodes.
    pub(super) fn seen_of(&self, motion: &[V3]) -> V3 {
        self.nodes().map(|(i, w)| motion[i] * w).sum()
    }

    /// All that was added to a part of the motion, N s or N s^2.
    pub(super) fn sum(&self, part: usize) -> V3 {
        self.touch.normal * self.added[part] + self.rubs * self.rubbed[part]
    }

    /// Adds an impulse of friction to a part of the motion.
    fn add_friction(&mut self, part: usize, across: f64, motion: &mut [V3]) {
        self.rubbed[part] += across;
        self.spread(&(self.rubs * across), motion);
    }

    /// Adds the impulse `change` to the motion of its nodes.
    #[inline]
    fn spread(&self, change: &V3, motion: &mut [V3]) {
        let (first, count) = (self.nodes[0], self.count);
        if self.in_a_row {
            let near = motion[first..first + count].iter_mut();
            near.zip(&self.shares)
                .for_each(|(m, share)| *m += change * *share);
            return;
        }
        for (i, share) in self.shares() {
            motion[i] += change * share;
        }
    }

    /// Brings the speed, or place, along the normal into its range; returns by how much it changes.
    pub(super) fn press(&mut self, part: usize, motion: &mut [V3]) -> f64 {
        let now = self.along_normal(motion);
        let alone = now - self.added[part] * self.inverse;
        let [low, high] = self.range[part];
        let wanted = (alone.clamp(low, high) - alone) / self.inverse;
        // a touch pushes: all that it gives along the normal is at least 0, and what the wire would have fallen
        // since it began lies behind its surface
        let allowed = match part {
            NOW => wanted
                .min(self.most.max(-alone / self.inverse))
                .max(-self.given),
            START => wanted.max(0.0),
            _ => wanted.min(0.0),
        };
        let change = allowed - self.added[part];
        if change == 0.0 {
            return 0.0;
        }
        self.added[part] += change;
        self.spread(&(self.touch.normal * change), motion);
        (change * self.inverse).abs()
    }

    /// Lets a landing rebound, which has been stopped: its touch gives back no more than it took to stop it.
    pub(super) fn rebound(&mut self) {
        self.most = self.added[NOW] + (self.given + self.added[NOW]);
        self.range[NOW] = self.range[START];
    }

    /// Wire that something else had slowed down rebounds by less: the history becomes that of the speed `now`, m/s, after a step
    /// of `h`, s.
    pub(super) fn rebounds_at(&mut self, now: f64, h: f64) {
        let [speed, _] = self.range[NOW];
        let slower = now.clamp(0.0, speed);
        self.range[NOW][1] = slower;
        self.range[START] = [slower; 2];
        self.range[PLACE] = self.range[PLACE].map(|there| there + h * (speed - slower));
    }

    /// Shifts the place along the surface by the share that friction has in the speed there: to where the slide that is left comes from.
    ///
    /// The places along the normals are settled by then. In a wedge, each shift would press another touch, and that one the first.
    pub(super) fn shift(&mut self, motion: &mut [V3]) {
        if self.added[START] > 0.0 {
            let shift = self.added[PLACE] * self.rubbed[START] / self.added[START];
            self.add_friction(PLACE, shift, motion);
        }
    }

    /// Friction of what is added along the normal; returns by how much the speed changes.
    ///
    /// It brakes a slide, and no more than stops it. What is taken back of the solve's push takes its friction along, as long as
    /// the slide is no faster than the way of the step explains. A touch that began in this step gives back all that the solve
    /// rubbed too much: in a step that ends deep in the surface friction is large, and would throw the wire to where it came from.
    pub(super) fn rub(&mut self, part: usize, motion: &mut [V3]) -> f64 {
        let pressed = self.added[part];
        let most = (pressed * self.friction).abs();
        let until =
            |speed: f64| self.rubbed[part] + (speed - self.along_friction(motion)) / self.inverse;
        let allowed = match part {
            _ if pressed < 0.0 => until(self.slid).clamp(-most, 0.0),
            _ => until(0.0).clamp(-most, most),
        };
        let allowed = if part == NOW && self.touch.began {
            allowed.min(until(0.0).max(-self.given * self.friction))
        } else {
            allowed
        };
        let change = allowed - self.rubbed[part];
        if change == 0.0 {
            return 0.0;
        }
        self.add_friction(part, change, motion);
        (change * self.inverse).abs()
    }
}
