//! The mechanical system that a step advances: rod, supports, loads, contact, feed.
//!
//! Lab frame; the core turns about +y. Nothing here knows scenes or files.

use crate::contact::{Body, Contacts, LiveContact, Wire};
use crate::feed::{Feed, FeedSpec};
use crate::math::{Quat, Spin, V3, spin_velocity};
use crate::rod::{
    ForceParts, Laws, Load, Rod, Section, align, internal_forces, rotate, stored_energy,
};

/// How an end of the wire is held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Support {
    /// which coordinates of the end node are held (all three where the support turns)
    pub hold: [bool; 3],
    /// the place it is held at, m; core frame where `turning`, else lab frame
    pub point: V3,
    /// its velocity in that frame, m/s
    pub velocity: V3,
    /// the direction (and roll) it holds, as a frame with z along the wire; `None`: free to turn
    pub frame: Option<Quat>,
    /// fixed to the core
    pub turning: bool,
}

impl Support {
    /// Not held at all.
    pub fn free() -> Self {
        Self {
            hold: [false; 3],
            point: V3::zeros(),
            velocity: V3::zeros(),
            frame: None,
            turning: false,
        }
    }

    /// Position held, direction free.
    pub fn pinned(point: V3) -> Self {
        Self {
            hold: [true; 3],
            point,
            ..Self::free()
        }
    }

    /// Position and direction held.
    pub fn clamped(point: V3, frame: Quat) -> Self {
        Self {
            hold: [true; 3],
            point,
            frame: Some(frame),
            ..Self::free()
        }
    }

    fn holds_all(&self) -> bool {
        self.hold == [true; 3]
    }
}

/// The core's motion at this instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spindle {
    /// angle, rad
    pub angle: f64,
    /// speed, rad/s
    pub speed: f64,
    /// acceleration, rad/s^2
    pub acceleration: f64,
}

impl Spindle {
    /// The same motion `dt` later.
    pub fn after(&self, dt: f64) -> Self {
        Self {
            angle: self.angle + dt * (self.speed + 0.5 * dt * self.acceleration),
            speed: self.speed + dt * self.acceleration,
            acceleration: self.acceleration,
        }
    }
}

/// Loads besides contact.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Loads {
    /// acceleration on every mass point, m/s^2
    pub gravity: V3,
    /// dead forces on nodes, N
    pub nodal: Vec<(usize, V3)>,
    /// dead moments on edges, N m, lab frame
    pub moments: Vec<(usize, V3)>,
    /// drag per mass, 1/s (verification only: lets a static answer settle)
    pub drag: f64,
}

/// Where energy came from and went, J, since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Books {
    /// work of the spindle on the wire
    pub spindle: f64,
    /// work of the feed on the wire (negative: the wire pulls against the tensioner)
    pub nozzle: f64,
    /// motion energy of wire that came in
    pub inflow: f64,
    /// plastic work: bending, twist, stretch
    pub plastic: [f64; 3],
    /// slip against friction
    pub friction: f64,
    /// contact dashpots
    pub damping: f64,
    /// losses of the method itself: splitting and freezing
    pub numerical: f64,
    /// elastic energy locked into frozen wire
    pub frozen_stored: f64,
    /// motion energy handed to the core with frozen wire
    pub frozen_kinetic: f64,
    /// stored and motion energy at the start
    pub initial: f64,
}

/// Rod with everything that acts on it.
#[derive(Clone, Debug)]
pub struct System {
    /// section
    pub section: Section,
    /// its laws
    pub laws: Laws,
    /// the live wire
    pub rod: Rod,
    /// supports at the first and last node
    pub support: [Support; 2],
    /// core motion
    pub spindle: Spindle,
    /// other loads
    pub loads: Loads,
    /// contact, if there is anything to touch
    pub contacts: Option<Contacts>,
    /// live wire against live wire, where it may meet
    pub live: Option<LiveContact>,
    wire: Wire,
    /// feed at the last node
    pub feed: Option<(FeedSpec, Feed)>,
    /// set pull of the tensioner, N
    pub set_tension: f64,
    /// carry twist
    pub twist: bool,
    /// never move the plastic state on (monotonic loading only)
    pub holonomic: bool,
    /// unstretched length from the clamp to the first live node, m
    pub arc0: f64,
    /// energy books
    pub books: Books,
    /// deepest penetration met, m
    pub deepest: f64,
    /// moment of the wire on the core about +y at the last evaluation, N m
    pub torque_on_core: f64,
    /// elapsed time, s
    pub time: f64,
    /// forces of the last evaluation
    pub load: Load,
    pub(super) roll: Vec<f64>,
    pub(super) stages: super::rk4::Stages,
}

impl System {
    /// A rod with nothing acting on it.
    pub fn new(section: Section, rod: Rod) -> Self {
        let laws = Laws::new(&section);
        let edges = rod.edges();
        Self {
            section,
            laws,
            rod,
            support: [Support::free(), Support::free()],
            spindle: Spindle::default(),
            loads: Loads::default(),
            contacts: None,
            live: None,
            wire: Wire::default(),
            feed: None,
            set_tension: 0.0,
            twist: true,
            holonomic: false,
            arc0: 0.0,
            books: Books::default(),
            deepest: 0.0,
            torque_on_core: 0.0,
            time: 0.0,
            load: Load::default(),
            roll: vec![0.0; edges],
            stages: super::rk4::Stages::default(),
        }
    }

    /// Frame of a clamp in the lab, if that end is clamped.
    pub fn clamp_frame(&self, end: usize) -> Option<Quat> {
        let s = &self.support[end];
        s.frame.map(|f| {
            if s.turning {
                turn_about_y(self.spindle.angle) * f
            } else {
                f
            }
        })
    }

    fn end_node(&self, end: usize) -> usize {
        if end == 0 { 0 } else { self.rod.nodes() - 1 }
    }

    /// Puts held coordinates of the end nodes where their supports are now.
    pub fn place_supports(&mut self) {
        for end in 0..2 {
            let s = self.support[end];
            let i = self.end_node(end);
            if s.turning && s.holds_all() {
                let x = Spin::new(self.spindle.angle).to_lab(s.point);
                self.rod.x[i] = x;
                self.rod.v[i] = spin_velocity(self.spindle.speed, x);
            } else {
                for a in 0..3 {
                    if s.hold[a] {
                        self.rod.x[i][a] = s.point[a];
                        self.rod.v[i][a] = s.velocity[a];
                    }
                }
            }
        }
    }

    /// Moves supports with a velocity of their own.
    pub(super) fn carry_supports(&mut self, dt: f64) {
        for s in &mut self.support {
            s.point += s.velocity * dt;
        }
    }

    /// First and one past the last node that is free in at least one coordinate.
    pub fn free_nodes(&self) -> std::ops::Range<usize> {
        let from = usize::from(self.support[0].holds_all());
        let to = self.rod.nodes() - usize::from(self.support[1].holds_all());
        from..to
    }

    /// All forces at the present state into `self.load`. With `commit = Some(dt)` plastic state,
    /// frames and friction anchors move on and the books grow by what happens in `dt`.
    pub fn evaluate(&mut self, commit: Option<f64>) {
        self.load.fit(&self.rod);
        self.roll.resize(self.rod.edges(), 0.0);
        let clamp = [self.clamp_frame(0), self.clamp_frame(1)];
        let parts = ForceParts {
            commit: commit.is_some(),
            holonomic: self.holonomic,
            twist: self.twist,
        };
        internal_forces(
            &mut self.rod,
            &self.laws,
            &clamp,
            &self.roll,
            parts,
            &mut self.load,
        );
        self.external_forces();
        let spin = Spin::new(self.spindle.angle);
        let torque_from_contact = self.contact_forces(spin, commit);
        self.live_forces(spin, commit);
        let at_clamp = if self.support[0].turning {
            // what the wire puts on the clamp: its force there and the opposite of the clamp's moment
            let (x, f) = (self.rod.x[0], self.load.force[0]);
            x.z * f.x - x.x * f.z - self.load.clamp_moment[0].y
        } else {
            0.0
        };
        self.torque_on_core = torque_from_contact + at_clamp;
        if let Some(dt) = commit {
            self.roll.iter_mut().for_each(|r| *r = 0.0);
            for k in 0..3 {
                self.books.plastic[k] += self.load.plastic[k];
            }
            let touch = self
                .contacts
                .as_ref()
                .map_or(Default::default(), |c| c.loss);
            let between = self.live.as_ref().map_or(Default::default(), |l| l.loss);
            self.books.friction = touch.friction + between.friction;
            self.books.damping = touch.damping + between.damping;
            self.books.spindle -= self.torque_on_core * self.spindle.speed * dt;
            if self.feed.is_some() {
                // a traversing nozzle does work across the wire
                let n = self.rod.nodes() - 1;
                self.books.nozzle -= self.load.force[n].dot(&self.support[1].velocity) * dt;
            }
        }
    }

    fn external_forces(&mut self) {
        let Loads {
            gravity,
            nodal,
            moments,
            drag,
        } = &self.loads;
        if *gravity != V3::zeros() || *drag != 0.0 {
            for i in 0..self.rod.nodes() {
                let m = self.rod.mass(&self.section, i);
                self.load.force[i] += (gravity - self.rod.v[i] * *drag) * m;
            }
            let inertia = self.section.spin_inertia_per_length();
            for j in 0..self.rod.edges() {
                self.load.torque[j] -= drag * inertia * self.rod.rest[j] * self.rod.spin[j];
            }
        }
        for (i, f) in nodal {
            self.load.force[*i] += f;
        }
        for (j, m) in moments {
            let d = self.rod.x[j + 1] - self.rod.x[*j];
            let length = d.norm();
            let t = d / length;
            let couple = m.cross(&t) / length;
            self.load.torque[*j] += m.dot(&t);
            self.load.force[j + 1] += couple;
            self.load.force[*j] -= couple;
        }
    }

    /// Contact forces on the free nodes; returns the moment on the core about +y.
    fn contact_forces(&mut self, spin: Spin, commit: Option<f64>) -> f64 {
        let free = self.free_nodes();
        let Some(contacts) = &mut self.contacts else {
            return 0.0;
        };
        let mut moment = 0.0;
        let mut arc = self.arc0 + self.rod.rest[..free.start].iter().sum::<f64>();
        let per_length = self.section.mass_per_length();
        for i in free {
            let x = self.rod.x[i];
            let length = self.rod.voronoi(i);
            let body = Body {
                position: spin.to_core(x),
                velocity: spin.to_core(self.rod.v[i] - spin_velocity(self.spindle.speed, x)),
                length,
                mass: per_length * length,
                arc,
            };
            let f = contacts.force(i, &body, commit);
            if f != V3::zeros() {
                let f = spin.to_lab(f);
                self.load.force[i] += f;
                moment -= x.z * f.x - x.x * f.z;
                if commit.is_some() {
                    self.deepest = self.deepest.max(contacts.nodes[i].depth());
                }
            }
            if i < self.rod.edges() {
                arc += self.rod.rest[i];
            }
        }
        moment
    }

    /// Forces of live wire on live wire. The held nodes take part as partners.
    fn live_forces(&mut self, spin: Spin, commit: Option<f64>) {
        let (Some(live), Some(contacts)) = (&mut self.live, &self.contacts) else {
            return;
        };
        let (rod, wire) = (&self.rod, &mut self.wire);
        let mut arc = 0.0;
        wire.position.clear();
        wire.velocity.clear();
        wire.length.clear();
        wire.arc.clear();
        for i in 0..rod.nodes() {
            let x = rod.x[i];
            wire.position.push(spin.to_core(x));
            wire.velocity
                .push(spin.to_core(rod.v[i] - spin_velocity(self.spindle.speed, x)));
            wire.length.push(rod.voronoi(i));
            wire.arc.push(arc);
            arc += rod.rest.get(i).copied().unwrap_or(0.0);
        }
        let per_length = self.section.mass_per_length();
        live.evaluate(
            wire,
            &contacts.law,
            self.section.diameter,
            per_length,
            commit,
        );
        for (force, f) in self.load.force.iter_mut().zip(&live.force) {
            if *f != V3::zeros() {
                *force += spin.to_lab(*f);
            }
        }
        if commit.is_some() {
            self.deepest = self.deepest.max(live.deepest);
        }
    }

    /// Lets the wire through the nozzle for `dt`; call after the nodes have moved.
    pub(super) fn feed_step(&mut self, dt: f64) {
        let Some((spec, feed)) = &mut self.feed else {
            return;
        };
        let n = self.rod.nodes() - 1;
        let e = n - 1;
        let d = self.rod.x[n] - self.rod.x[e];
        let length = d.norm();
        let rest = self.rod.rest[e];
        let plastic = self.rod.stretch[e].strain;
        // the line comes from beyond the nozzle, radially
        let out = V3::new(self.rod.x[n].x, 0.0, self.rod.x[n].z).normalize();
        let deflection = libm::acos((d.dot(&out) / length).clamp(-1.0, 1.0));
        let law = self.laws.stretch;
        let step = feed.step(
            spec,
            &law,
            self.set_tension,
            dt,
            rest,
            length,
            plastic,
            deflection,
        );
        let after = rest + step.grown;
        // the edge stretches and grows in the same step: its tension runs from the old to the new value
        let tension = 0.5 * (self.load.tension[e] + law.modulus * (length / after - 1.0 - plastic));
        // wire arrives stretched, so it brings its elastic energy along
        self.books.nozzle -=
            (tension * (1.0 + plastic) + 0.5 * tension * tension / law.modulus) * step.grown;
        let gained = 0.5 * self.section.mass_per_length() * step.grown;
        self.books.inflow += 0.5 * gained * self.rod.v[e].norm_squared();
        self.rod.rest[e] = after;
    }

    /// Elastic energy of the live wire and its touches, J.
    pub fn stored(&self) -> f64 {
        let clamp = [self.clamp_frame(0), self.clamp_frame(1)];
        let rod: f64 = stored_energy(&self.rod, &self.laws, &clamp, self.twist)
            .iter()
            .sum();
        let touch: f64 = match &self.contacts {
            Some(c) => self
                .free_nodes()
                .map(|i| c.stored(i, self.rod.voronoi(i)))
                .sum(),
            None => 0.0,
        };
        let between = match (&self.live, &self.contacts) {
            (Some(l), Some(c)) => l.stored(&c.law, &self.wire.length),
            _ => 0.0,
        };
        rod + touch + between
    }

    /// Motion energy of the free nodes and spinning edges, J.
    pub fn kinetic(&self) -> f64 {
        let free = self.free_nodes();
        let spin: f64 = (0..self.rod.edges())
            .map(|j| {
                0.5 * self.section.spin_inertia_per_length()
                    * self.rod.rest[j]
                    * self.rod.spin[j].powi(2)
            })
            .sum();
        free.map(|i| 0.5 * self.rod.mass(&self.section, i) * self.rod.v[i].norm_squared())
            .sum::<f64>()
            + spin
    }

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
            let ta = (self.rod.x[j + 1] - self.rod.x[j - 1]).normalize();
            let tb = (self.rod.x[j + 2] - self.rod.x[j]).normalize();
            (a + b) * 0.5 + (ta - tb) * (chord.norm() / 8.0)
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
        let rod = &mut self.rod;
        let half = 0.5 * rod.rest[j];
        rod.x.insert(j + 1, mid);
        rod.v.insert(j + 1, v);
        rod.rest[j] = half;
        rod.rest.insert(j + 1, half);
        let frame = rod.frame[j];
        rod.frame[j] = align(&frame, &((mid - a) / (mid - a).norm()), 0.0);
        rod.frame
            .insert(j + 1, align(&frame, &((b - mid) / (b - mid).norm()), 0.0));
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
        rod.bend.insert(j + 1, bend);
        rod.twist.insert(j + 1, twist);
        if let Some(c) = &mut self.contacts {
            c.nodes.insert(j + 1, crate::contact::NodeContact::new());
        }
        if let Some(l) = &mut self.live {
            l.insert(j + 1);
            self.wire.length.insert(j + 1, half);
        }
        self.roll.insert(j + 1, self.roll[j]);
        if at_nozzle {
            // the half edge at the nozzle was not in the books before
            self.books.inflow += self.kinetic() - kinetic;
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
        let joint = crate::rod::Joint::between(&self.rod.frame[count - 1], &self.rod.frame[count]);
        let share = self.rod.rest[count] / (self.rod.rest[count - 1] + self.rod.rest[count]);
        let rel = crate::rod::relative(
            [joint.bend[0] * share, joint.bend[1] * share],
            joint.twist * share,
        );
        let frame = self.rod.frame[count] * rel.conjugate();
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
        if let Some(c) = &mut self.contacts {
            c.nodes.drain(..count);
        }
        if let Some(l) = &mut self.live {
            l.remove_front(count);
            self.wire.length.drain(..count.min(self.wire.length.len()));
        }
        self.place_supports();
        self.books.frozen_kinetic += handed;
        self.books.frozen_stored += stored - self.stored();
    }

    /// Energy that the books cannot explain, J: what should be there minus what is.
    ///
    /// With a staggered step of `dt` the motion energy is the product of the velocities before and
    /// after this instant, which is the quantity the scheme conserves; `None` where velocities
    /// belong to the present time.
    pub fn energy_residual(&self, staggered: Option<f64>) -> f64 {
        let b = self.books;
        let supply = b.initial + b.spindle + b.nozzle + b.inflow;
        let lost = b.plastic.iter().sum::<f64>() + b.friction + b.damping + b.numerical;
        let kinetic = match staggered {
            Some(dt) => self.staggered_kinetic(dt),
            None => self.kinetic(),
        };
        supply - lost - b.frozen_stored - b.frozen_kinetic - self.stored() - kinetic
    }

    fn staggered_kinetic(&self, dt: f64) -> f64 {
        let mut e = 0.0;
        for i in self.free_nodes() {
            let m = self.rod.mass(&self.section, i);
            let v = self.rod.v[i];
            e += 0.5 * m * v.dot(&(v + self.load.force[i] * (dt / m)));
        }
        let inertia = self.section.spin_inertia_per_length();
        for j in 0..self.rod.edges() {
            let i = inertia * self.rod.rest[j];
            e += 0.5 * i * self.rod.spin[j] * (self.rod.spin[j] + self.load.torque[j] * (dt / i));
        }
        e
    }

    /// Direction in which the wire leaves a clamped end, lab frame.
    pub fn clamp_direction(&self, end: usize) -> Option<V3> {
        self.clamp_frame(end).map(|f| rotate(&f, &V3::z()))
    }
}

/// Rotation about +y as a quaternion.
pub fn turn_about_y(angle: f64) -> Quat {
    Quat::new(libm::cos(0.5 * angle), 0.0, libm::sin(0.5 * angle), 0.0)
}
