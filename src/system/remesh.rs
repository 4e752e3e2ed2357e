//! Changes of the wire between steps: halving and joining edges, letting settled wire go and taking
//! it back.

use super::{ContactModel, Support, System};
use crate::contact::Memory;
use crate::contact::spline_point;
use crate::math::PersistentVec;
use crate::math::turn_about_y;
use crate::math::{Quat, Spin, V3, spin_velocity};
use crate::math::{align, rotate};
use crate::rod::Twist;
use crate::rod::{Bend, Joint, Scalar};
use serde::{Deserialize, Serialize};

/// A frozen node with the edge after it: all it takes to let them move again where they lie.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrozenNodeRecord {
    /// place, core frame, m
    place: V3,
    /// frame of the edge, core frame
    frame: Quat,
    /// frame that a clamp at this node has, core frame
    clamp: Quat,
    /// unstretched length from the clamp to the node, m
    arc: f64,
    /// unstretched length of the edge, m
    rest: f64,
    spin: f64,
    stretch: Scalar,
    bend: Bend,
    twist: Scalar,
    memory: Memory,
}

impl FrozenNodeRecord {
    /// Whether it can come back to life; bytes from elsewhere may say anything.
    pub(crate) fn is_sound(&self) -> bool {
        self.memory.is_sound()
    }
}

/// Frozen wire; a chunk is about half a turn of fine wire.
pub type FrozenHistory = PersistentVec<FrozenNodeRecord, 64>;

impl System {
    /// Splits edge `j` in two halves at the same stretch.
    ///
    /// The new node lies on the cubic through both ends, so that the curvature stays smooth, and
    /// moves with their mean velocity, which keeps the momentum. Last edge: on the chord, since
    /// the wire leaves the nozzle straight.
    pub fn split(&mut self, j: usize) {
        let last = self.rod.edges() - 1;
        let (a, b) = (self.rod.x[j], self.rod.x[j + 1]);
        let chord = b - a;
        let at_nozzle = j == last && self.feed.is_some();
        let kinetic = if at_nozzle { self.kinetic() } else { 0.0 };
        let mid = if j == last || j == 0 {
            (a + b) * 0.5
        } else {
            // on an arc an edge has the direction at its middle: at a node between edges of different
            // length the shorter one counts more
            let before = a - self.rod.x[j - 1];
            let after = self.rod.x[j + 2] - b;
            let l = [before.norm(), chord.norm(), after.norm()];
            let ta = (before * (l[1] / l[0]) + chord * (l[0] / l[1])).normalize();
            let tb = (chord * (l[2] / l[1]) + after * (l[1] / l[2])).normalize();
            (a + b) * 0.5 + (ta - tb) * (l[1] / 8.0)
        };
        let v = if at_nozzle {
            // at the nozzle the material moves in along the wire at the feed rate
            let stretch = chord.norm() / self.rod.rest[j];
            let rate = self.feed.as_ref().map_or(0.0, |(_, f)| f.rate);
            let inlet = self.rod.v[j + 1] - chord.normalize() * (rate * stretch);
            (self.rod.v[j] + inlet) * 0.5
        } else {
            (self.rod.v[j] + self.rod.v[j + 1]) * 0.5
        };
        let quarter_turn = if j == last {
            // wire leaves the nozzle untwisted
            0.0
        } else {
            0.25 * self.rod.rest[j] * self.twist_along(j)
        };
        let rod = &mut self.rod;
        let half = 0.5 * rod.rest[j];
        rod.x.insert(j + 1, mid);
        rod.v.insert(j + 1, v);
        rod.rest[j] = half;
        rod.rest.insert(j + 1, half);
        let frame = rod.frame[j];
        rod.frame[j] = align(&frame, &((mid - a) / (mid - a).norm()), -quarter_turn);
        rod.frame.insert(
            j + 1,
            align(&frame, &((b - mid) / (b - mid).norm()), quarter_turn),
        );
        rod.spin.insert(j + 1, rod.spin[j]);
        rod.stretch.insert(j + 1, rod.stretch[j]);
        let mut bend = rod.bend[j + 1];
        let mut twist = rod.twist[j + 1];
        for k in 0..2 {
            bend.curvature[k] = 0.5 * (rod.bend[j].curvature[k] + rod.bend[j + 1].curvature[k]);
        }
        bend.rise = 0.5 * (rod.bend[j].rise + rod.bend[j + 1].rise);
        twist.strain = 0.5 * (rod.twist[j].strain + rod.twist[j + 1].strain);
        twist.rise = 0.5 * (rod.twist[j].rise + rod.twist[j + 1].rise);
        if at_nozzle {
            // new wire is straight: what set the node before has stays its own
            let own = rod.voronoi(j);
            let scale = (own + 0.5 * half) / own;
            rod.bend[j].curvature = rod.bend[j].curvature.map(|k| k * scale);
            rod.twist[j].strain *= scale;
            (bend, twist) = (Bend::default(), Scalar::default());
        }
        rod.bend.insert(j + 1, bend);
        rod.twist.insert(j + 1, twist);
        match &mut self.contact {
            ContactModel::None => {}
            ContactModel::Nodal(nodal) => nodal.split(j, half),
            ContactModel::Line(line) => line.split(j),
        }
        self.split_past(j, mid, v);
        self.roll.insert(j + 1, self.roll[j]);
        if at_nozzle {
            // the half edge at the nozzle was not in the books before
            self.balance.inflow += self.kinetic() - kinetic;
        }
    }

    /// Twist per length along edge `j`, the mean of its two joints, 1/m. Only the implicit method, whose
    /// edges roll by what is asked of them, spreads twist over the halves of an edge.
    fn twist_along(&self, j: usize) -> f64 {
        if !self.contact.is_line() || !self.twist.is_carried() {
            return 0.0;
        }
        let rod = &self.rod;
        let at = |i: usize| {
            let before = if i == 0 {
                self.clamp_frame(0)
            } else {
                Some(rod.frame[i - 1])
            };
            before.map(|p| Joint::between(&p, &rod.frame[i]).twist / rod.voronoi(i))
        };
        let next = at(j + 1).unwrap_or(0.0);
        0.5 * (at(j).unwrap_or(next) + next)
    }

    /// The same for the instants before, if the method keeps any.
    fn split_past(&mut self, j: usize, mid: V3, v: V3) {
        let rest = 2.0 * self.rod.rest[j];
        let grown = match &self.feed {
            Some((_, f)) if j + 2 == self.rod.nodes() - 1 => self
                .past
                .fed
                .map(|fed| ((rest - (f.fed - fed)) / rest).max(0.05)),
            _ => [1.0; 2],
        };
        let back = self.spindle.before(self.past.h[0]);
        let now = Spin::new(self.spindle.angle).to_core(mid);
        self.past.split(j, now, grown, Spin::new(back.angle));
        if let (Some(a), Some(b)) = (self.past.v.get(j).copied(), self.past.v.get(j + 2)) {
            // the same change of velocity over the last step as the wire on either side
            let change = (self.rod.v[j] - a + self.rod.v[j + 2] - b) * 0.5;
            self.past.v[j + 1] = v - change;
        }
    }

    /// Takes the first `count` nodes out of the computation; the node after them becomes the clamp.
    ///
    /// The wire just behind the new clamp keeps its direction such that the curvature and moment
    /// there stay what they are.
    pub fn freeze_front(&mut self, count: usize) {
        let spin = Spin::new(self.spindle.angle);
        let back = turn_about_y(-self.spindle.angle);
        let stored = self.stored();
        let mut handed = 0.0;
        for i in 1..=count {
            let v = spin_velocity(self.spindle.speed, self.rod.x[i]);
            handed += 0.5 * self.rod.mass(&self.section, i) * v.norm_squared();
        }
        let frame = self.frame_to_clamp(count);
        self.lay_to_rest(count);
        self.support[0] = Support {
            hold: [true; 3],
            point: spin.to_core(self.rod.x[count]),
            velocity: V3::zeros(),
            frame: Some(back * frame),
            turning: true,
        };
        self.arc0 += self.rod.rest[..count].iter().sum::<f64>();
        let rod = &mut self.rod;
        rod.x.drain(..count);
        rod.v.drain(..count);
        rod.rest.drain(..count);
        rod.frame.drain(..count);
        rod.spin.drain(..count);
        rod.stretch.drain(..count);
        rod.bend.drain(..count);
        rod.twist.drain(..count);
        self.roll.drain(..count);
        match &mut self.contact {
            ContactModel::None => {}
            ContactModel::Nodal(nodal) => nodal.remove_front(count),
            ContactModel::Line(line) => line.remove_front(count),
        }
        self.past.remove_front(count);
        self.place_supports();
        self.balance.frozen_kinetic += handed;
        self.balance.frozen_stored += stored - self.stored();
    }

    /// Frame of a clamp at an inner node that leaves curvature and moment there what they are.
    fn frame_to_clamp(&self, node: usize) -> Quat {
        let rod = &self.rod;
        let joint = Joint::between(&rod.frame[node - 1], &rod.frame[node]);
        let share = rod.rest[node] / (rod.rest[node - 1] + rod.rest[node]);
        let rel = crate::math::relative(
            [joint.bend[0] * share, joint.bend[1] * share],
            joint.twist * share,
        );
        rod.frame[node] * rel.conjugate()
    }

    /// Puts the first `count` nodes on record for [`Self::thaw_front`].
    fn lay_to_rest(&mut self, count: usize) {
        let Some(line) = self.contact.as_line() else {
            return;
        };
        let spin = Spin::new(self.spindle.angle);
        let back = turn_about_y(-self.spindle.angle);
        let mut arc = self.arc0;
        for i in 0..count {
            let clamp = match self.support[0].frame {
                Some(frame) if i == 0 => frame,
                _ if i == 0 => back * self.rod.frame[0],
                _ => back * self.frame_to_clamp(i),
            };
            let rod = &self.rod;
            self.frozen_history.push(FrozenNodeRecord {
                place: spin.to_core(rod.x[i]),
                frame: back * rod.frame[i],
                clamp,
                arc,
                rest: rod.rest[i],
                spin: rod.spin[i],
                stretch: rod.stretch[i],
                bend: rod.bend[i],
                twist: rod.twist[i],
                memory: line.memory(i),
            });
            arc += rod.rest[i];
        }
    }

    /// Unstretched lengths of the frozen edges, the last to freeze first, m.
    pub fn frozen_lengths(&self) -> impl Iterator<Item = f64> {
        self.frozen_history.iter().rev().map(|d| d.rest)
    }

    /// Takes the last `count` frozen nodes back into the computation, the reverse of
    /// [`Self::freeze_front`]: at rest on the core, with the plastic state, stress and friction anchors
    /// they froze with. The first of them becomes the clamp. Only wire of the implicit method is kept
    /// for this; returns how many nodes came back.
    pub fn thaw_front(&mut self, count: usize) -> usize {
        let count = count.min(self.frozen_history.len());
        if count == 0 {
            return 0;
        }
        let back = self.frozen_history.split_off(count);
        let stored = self.stored();
        let spin = Spin::new(self.spindle.angle);
        let turn = turn_about_y(self.spindle.angle);
        self.support[0] = Support {
            hold: [true; 3],
            point: back[0].place,
            velocity: V3::zeros(),
            frame: Some(back[0].clamp),
            turning: true,
        };
        self.arc0 = back[0].arc;
        let places: Vec<V3> = back.iter().map(|d| d.place).collect();
        let lab = places.iter().map(|p| spin.to_lab(*p));
        let speed = self.spindle.speed;
        let rod = &mut self.rod;
        rod.v
            .splice(0..0, lab.clone().map(|x| spin_velocity(speed, x)));
        rod.x.splice(0..0, lab);
        rod.rest.splice(0..0, back.iter().map(|d| d.rest));
        rod.frame.splice(0..0, back.iter().map(|d| turn * d.frame));
        rod.spin.splice(0..0, back.iter().map(|d| d.spin));
        rod.stretch.splice(0..0, back.iter().map(|d| d.stretch));
        rod.bend.splice(0..0, back.iter().map(|d| d.bend));
        rod.twist.splice(0..0, back.iter().map(|d| d.twist));
        self.roll.splice(0..0, std::iter::repeat_n(0.0, count));
        if let Some(l) = self.contact.as_line_mut() {
            l.insert_front(back.into_iter().map(|d| d.memory));
        }
        let before = self.spindle.before(self.past.h[0]);
        self.past
            .insert_front(&places, Spin::new(before.angle), before.speed);
        self.roll_with_core(count);
        self.place_supports();
        for i in 1..=count {
            let m = self.rod.mass(&self.section, i);
            self.balance.frozen_kinetic -= 0.5 * m * self.rod.v[i].norm_squared();
        }
        self.balance.frozen_stored += stored - self.stored();
        count
    }

    /// Gives the first `count` edges the spin of the turning core, now and in the instants before.
    fn roll_with_core(&mut self, count: usize) {
        if self.twist == Twist::Dynamic {
            for j in 0..count {
                self.rod.spin[j] = self.spindle.speed * self.rod.tangent(j).y;
            }
        }
        if self.past.roll[0].len() + count != self.rod.edges() {
            return;
        }
        let [h, h1] = self.past.h;
        let times = [0.0, h, h + h1].map(|dt| self.spindle.before(dt));
        for k in 0..2 {
            let [now, back] = [times[k].angle, times[k + 1].angle];
            let away = [now, back].map(|angle| turn_about_y(angle - self.spindle.angle));
            let frames = self.rod.frame[..count].iter();
            let rolls = frames.map(|f| roll_between(&(away[1] * f), &(away[0] * f)));
            self.past.roll[k].splice(0..0, rolls);
        }
        let spin = self.rod.spin[..count].iter();
        let share = if self.spindle.speed == 0.0 {
            1.0
        } else {
            times[1].speed / self.spindle.speed
        };
        self.past.spin.splice(0..0, spin.map(|s| s * share));
    }

    /// Takes inner node `i` out and joins its edges; plastic state is shared out by length.
    ///
    /// The joined edge is as stretched as the two were on average: the chord is shorter than they
    /// were. At the nozzle the difference counts as wire that went back through it.
    pub fn merge(&mut self, i: usize) {
        let nodes = self.rod.nodes();
        debug_assert!(i > 0 && i + 1 < nodes, "an inner node");
        let at_nozzle = i + 2 == nodes && self.feed.is_some();
        let kinetic = if at_nozzle { self.kinetic() } else { 0.0 };
        let rod = &mut self.rod;
        let [a, b] = [rod.rest[i - 1], rod.rest[i]];
        let length = (rod.x[i] - rod.x[i - 1]).norm() + (rod.x[i + 1] - rod.x[i]).norm();
        let chord = rod.x[i + 1] - rod.x[i - 1];
        let joined = (a + b) * chord.norm() / length;
        for (end, gain) in [(i - 1, 0.5 * b), (i + 1, 0.5 * a)] {
            if at_nozzle && end == i + 1 {
                // set that has gone into the nozzle is forgotten: what comes out again is straight
                continue;
            }
            let own = rod.voronoi(end);
            let mix = |x: f64, y: f64| (x * own + y * gain) / (own + gain);
            let (gone, gone_twist) = (rod.bend[i], rod.twist[i]);
            let (bend, twist) = (&mut rod.bend[end], &mut rod.twist[end]);
            for k in 0..2 {
                bend.curvature[k] = mix(bend.curvature[k], gone.curvature[k]);
            }
            bend.rise = mix(bend.rise, gone.rise);
            twist.strain = mix(twist.strain, gone_twist.strain);
            twist.rise = mix(twist.rise, gone_twist.rise);
        }
        let share = |x: f64, y: f64| (x * a + y * b) / (a + b);
        rod.stretch[i - 1] = Scalar {
            strain: share(rod.stretch[i - 1].strain, rod.stretch[i].strain),
            rise: share(rod.stretch[i - 1].rise, rod.stretch[i].rise),
        };
        rod.spin[i - 1] = share(rod.spin[i - 1], rod.spin[i]);
        rod.rest[i - 1] = joined;
        // the joined edge's middle is this far from that of its first part
        let roll = if self.twist.is_carried() {
            share(0.0, Joint::between(&rod.frame[i - 1], &rod.frame[i]).twist)
        } else {
            0.0
        };
        rod.frame[i - 1] = align(&rod.frame[i - 1], &chord.normalize(), roll);
        rod.x.remove(i);
        rod.v.remove(i);
        rod.bend.remove(i);
        rod.twist.remove(i);
        rod.rest.remove(i);
        rod.frame.remove(i);
        rod.spin.remove(i);
        rod.stretch.remove(i);
        self.roll.remove(i);
        match &mut self.contact {
            ContactModel::None => {}
            ContactModel::Nodal(nodal) => nodal.merge(i),
            ContactModel::Line(line) => line.merge(i),
        }
        self.past.merge(i, b / (a + b));
        self.move_points(i);
        if at_nozzle {
            let lost = joined - a - b;
            if let Some((_, f)) = &mut self.feed {
                // wire and tensioner shift alike, so that the line between them pulls as before
                f.fed += lost;
                f.paid += lost;
            }
            self.past.fed.iter_mut().for_each(|fed| *fed += lost);
            self.past.paid += lost;
            self.balance.inflow += self.kinetic() - kinetic;
        } else {
            self.joined_away += a + b - joined;
        }
    }

    /// The wire's spline runs elsewhere round a node taken out at `i`: its contact points move along with
    /// their anchors.
    fn move_points(&mut self, i: usize) {
        let Some(line) = self.contact.as_line_mut() else {
            return;
        };
        let q = &self.past.q[0];
        if q.len() != self.rod.nodes() {
            return;
        }
        if i > 1 {
            line.carry(2 * (i - 1), spline_point(q, i - 1));
        }
        line.carry(2 * i - 1, (q[i - 1] + q[i]) * 0.5);
        if i + 1 < q.len() {
            line.carry(2 * i, spline_point(q, i));
        }
    }

    /// The edge at the nozzle has grown by `grown`: it is straight wire that came or went, so the set
    /// at the node before stays, spread over the node's new length.
    pub(crate) fn keep_set_at_nozzle(&mut self, grown: f64) {
        let rod = &mut self.rod;
        let i = rod.nodes() - 2;
        let own = rod.voronoi(i);
        let scale = (own - 0.5 * grown) / own;
        rod.bend[i].curvature = rod.bend[i].curvature.map(|k| k * scale);
        rod.twist[i].strain *= scale;
    }

    /// Elastic energy per length of bending and twist at the node before the nozzle, J/m.
    pub(crate) fn bent_at_nozzle(&self) -> f64 {
        let rod = &self.rod;
        let i = rod.nodes() - 2;
        let joint = Joint::between(&rod.frame[i - 1], &rod.frame[i]);
        let own = rod.voronoi(i);
        let bent: f64 = (0..2)
            .map(|k| {
                0.5 * self.laws.bend.modulus
                    * (joint.bend[k] / own - rod.bend[i].curvature[k]).powi(2)
            })
            .sum();
        if self.twist.is_carried() {
            let twist = joint.twist / own - rod.twist[i].strain;
            return bent + 0.5 * self.laws.twist.modulus * twist * twist;
        }
        bent
    }
}

/// Angle by which a frame has rolled on its way, against the shortest way of its edge, rad.
fn roll_between(from: &Quat, to: &Quat) -> f64 {
    let carried = align(from, &rotate(to, &V3::z()), 0.0);
    let roll = carried.conjugate() * to;
    2.0 * libm::atan2(roll.k, roll.w)
}
