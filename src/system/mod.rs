//! The mechanical system that a step advances: rod, supports, loads, contact, feed.
//!
//! Lab frame; the core turns about +y. Nothing here knows scenes or files.

mod contact_model;
mod drive;
mod energy_balance;
mod history;
mod model;
mod nozzle_edge;
mod remesh;
mod saved;
mod scratch;
mod state;
mod support;

pub use contact_model::{ContactModel, FrozenWire, NodalContact};
pub use drive::{Drive, NozzleDrive};
pub use energy_balance::EnergyBalance;
pub use history::Past;
pub use model::{Loads, Mass, Model};
pub use remesh::FrozenHistory;
pub(crate) use saved::SavedSystem;
use scratch::Scratch;
pub use state::State;
pub use support::{Spindle, Support};

use crate::contact::Body;
use crate::feed::{Feed, FeedSpec};
use crate::math::rotate;
use crate::math::turn_about_y;
use crate::math::{Quat, Spin, V3, spin_velocity};
use crate::rod::Twist;
use crate::rod::{ForceParts, Laws, Rod, Section, internal_forces};

/// Rod with everything that acts on it.
#[derive(Clone, Debug)]
pub struct System {
    /// what does not change in a run
    pub model: Model,
    /// what a step changes
    pub state: State,
    /// what the wire touches
    pub contact: ContactModel,
    /// core mesh and frozen wire where `contact` is along the wire
    pub frozen_wire: Option<FrozenWire>,
    pub(crate) scratch: Scratch,
}

impl System {
    /// A rod with nothing acting on it.
    pub fn new(section: Section, rod: Rod) -> Self {
        Self {
            model: Model {
                laws: Laws::new(&section),
                section,
                mass: Mass::default(),
                twist: Twist::Dynamic,
                loads: Loads::default(),
                feed: None,
            },
            state: State::of(rod),
            contact: ContactModel::None,
            frozen_wire: None,
            scratch: Scratch::default(),
        }
    }

    /// Lets wire in at the last node; `feed` is the state it begins in.
    pub fn set_feed(&mut self, spec: FeedSpec, feed: Feed) {
        (self.model.feed, self.state.feed) = (Some(spec), Some(feed));
    }

    /// Set pull of the tensioner `dt` from now, N; it never pushes.
    pub fn set_tension_after(&self, dt: f64) -> f64 {
        (self.state.set_tension + self.state.set_rate * dt).max(0.0)
    }

    /// Direction in which the wire leaves a clamped end, lab frame.
    pub fn clamp_direction(&self, end: usize) -> Option<V3> {
        self.clamp_frame(end).map(|f| rotate(&f, &V3::z()))
    }

    /// Frame of a clamp in the lab, if that end is clamped.
    pub fn clamp_frame(&self, end: usize) -> Option<Quat> {
        let s = &self.state.support[end];
        s.frame.map(|f| {
            if s.turning {
                turn_about_y(self.state.spindle.angle) * f
            } else {
                f
            }
        })
    }

    fn end_node(&self, end: usize) -> usize {
        if end == 0 {
            0
        } else {
            self.state.rod.nodes() - 1
        }
    }

    /// Puts held coordinates of the end nodes where their supports are now.
    pub fn place_supports(&mut self) {
        for end in 0..2 {
            let s = self.state.support[end];
            let i = self.end_node(end);
            if s.turning && s.holds_all() {
                let x = Spin::new(self.state.spindle.angle).to_lab(s.point);
                self.state.rod.x[i] = x;
                self.state.rod.v[i] = spin_velocity(self.state.spindle.speed, x);
            } else {
                for a in 0..3 {
                    if s.hold[a] {
                        self.state.rod.x[i][a] = s.point[a];
                        self.state.rod.v[i][a] = s.velocity[a];
                    }
                }
            }
        }
    }

    /// Moves supports with a velocity of their own.
    pub(crate) fn carry_supports(&mut self, dt: f64) {
        for s in &mut self.state.support {
            s.point += s.velocity * dt;
        }
    }

    /// First and one past the last node that is free in at least one coordinate.
    pub fn free_nodes(&self) -> std::ops::Range<usize> {
        let from = usize::from(self.state.support[0].holds_all());
        let to = self.state.rod.nodes() - usize::from(self.state.support[1].holds_all());
        from..to
    }

    /// All forces at the present state into `self.load`. With `commit = Some(dt)` plastic state,
    /// frames and friction anchors move on and the energy balance grows by what happens in `dt`.
    pub fn evaluate(&mut self, commit: Option<f64>) {
        self.internal(commit.is_some());
        let spin = Spin::new(self.state.spindle.angle);
        let torque_from_contact = self.contact_forces(spin, commit);
        self.live_forces(spin, commit);
        self.state.torque_on_core = torque_from_contact + self.clamp_torque();
        if let Some(dt) = commit {
            let nodal = self.contact.as_nodal();
            let touch = nodal.map_or(Default::default(), |n| n.contacts.loss);
            let live = nodal.and_then(|n| n.live.as_ref());
            let between = live.map_or(Default::default(), |l| l.loss);
            self.state.balance.friction = touch.friction + between.friction;
            self.state.balance.damping = touch.damping + between.damping;
            self.state.balance.spindle -= self.state.torque_on_core * self.state.spindle.speed * dt;
            if self.state.feed.is_some() {
                // a traversing nozzle does work across the wire
                let n = self.state.rod.nodes() - 1;
                self.state.balance.nozzle -=
                    self.state.load.force[n].dot(&self.state.support[1].velocity) * dt;
            }
        }
    }

    /// Internal forces and loads into a fresh `load`; with `commit` frames and plastic state move on.
    pub(crate) fn internal(&mut self, commit: bool) {
        self.internal_with(commit, false);
    }

    /// The same with many joints at once, as the implicit method has them.
    pub(crate) fn internal_at_once(&mut self, commit: bool) {
        self.internal_with(commit, true);
    }

    fn internal_with(&mut self, commit: bool, at_once: bool) {
        self.state.load.fit(&self.state.rod);
        self.state.roll.resize(self.state.rod.edges(), 0.0);
        let clamp = [self.clamp_frame(0), self.clamp_frame(1)];
        let parts = ForceParts {
            commit,
            twist: self.model.twist.is_carried(),
        };
        let (rod, laws, load) = (&mut self.state.rod, &self.model.laws, &mut self.state.load);
        if at_once {
            (self.scratch.forces).add(rod, laws, &clamp, &self.state.roll, parts, load);
        } else {
            internal_forces(rod, laws, &clamp, &self.state.roll, parts, load);
        }
        self.external_forces();
        if commit {
            self.state.roll.iter_mut().for_each(|r| *r = 0.0);
            for k in 0..3 {
                self.state.balance.plastic[k] += self.state.load.plastic[k];
            }
        }
    }

    /// Moment that the clamp's force and moment put on the core about +y, N m.
    pub(crate) fn clamp_torque(&self) -> f64 {
        if !self.state.support[0].turning {
            return 0.0;
        }
        // what the wire puts on the clamp: its force there and the opposite of the clamp's moment
        let (x, f) = (self.state.rod.x[0], self.state.load.force[0]);
        x.z * f.x - x.x * f.z - self.state.load.clamp_moment[0].y
    }

    /// Tension after over tension before the nozzle's exit while wire comes out, by friction over the
    /// deflection there.
    pub(crate) fn exit_grip(&self) -> f64 {
        let Some(spec) = &self.model.feed else {
            return 1.0;
        };
        if spec.exit_friction == 0.0 {
            return 1.0;
        }
        let n = self.state.rod.nodes() - 1;
        let d = self.state.rod.x[n] - self.state.rod.x[n - 1];
        let out = V3::new(self.state.rod.x[n].x, 0.0, self.state.rod.x[n].z).normalize();
        let deflection = libm::acos((d.dot(&out) / d.norm()).clamp(-1.0, 1.0));
        libm::exp(spec.exit_friction * deflection)
    }

    /// Whether node `i` touches core or frozen wire.
    pub fn touches(&self, i: usize) -> bool {
        match &self.contact {
            ContactModel::Line(line) => line.touches(i),
            ContactModel::Nodal(nodal) => nodal.contacts.nodes[i].touches(),
            ContactModel::None => false,
        }
    }

    /// Depth of node `i` in what it touches, m.
    pub fn depth(&self, i: usize) -> f64 {
        match &self.contact {
            ContactModel::Line(line) => line.depth(i),
            ContactModel::Nodal(nodal) => nodal.contacts.nodes[i].depth(),
            ContactModel::None => 0.0,
        }
    }

    /// Signed distance of a point from the core, core frame, m; far away without a core.
    pub fn distance_to_core(&self, p: V3) -> f64 {
        match &self.contact {
            ContactModel::Line(line) => line.shape.nearness(p).distance,
            ContactModel::Nodal(nodal) => nodal.contacts.surface.nearest(p).distance,
            ContactModel::None => f64::INFINITY,
        }
    }

    /// Where the wire at node `i` lies: on its smooth centreline where contact is of the line kind.
    pub fn centre(&self, i: usize) -> V3 {
        let x = &self.state.rod.x;
        if self.contact.is_line() && i > 0 && i + 1 < x.len() {
            crate::contact::spline_point(x, i)
        } else {
            x[i]
        }
    }

    fn external_forces(&mut self) {
        let Loads {
            gravity,
            nodal,
            moments,
            drag,
        } = &self.model.loads;
        if *gravity != V3::zeros() || *drag != 0.0 {
            for i in 0..self.state.rod.nodes() {
                let m = self.state.rod.mass(&self.model.section, i);
                self.state.load.force[i] += (gravity - self.state.rod.v[i] * *drag) * m;
            }
            let inertia = self.model.section.spin_inertia_per_length();
            for j in 0..self.state.rod.edges() {
                self.state.load.torque[j] -=
                    drag * inertia * self.state.rod.rest[j] * self.state.rod.spin[j];
            }
        }
        for (i, f) in nodal {
            self.state.load.force[*i] += f;
        }
        for (j, m) in moments {
            let d = self.state.rod.x[j + 1] - self.state.rod.x[*j];
            let length = d.norm();
            let t = d / length;
            let couple = m.cross(&t) / length;
            self.state.load.torque[*j] += m.dot(&t);
            self.state.load.force[j + 1] += couple;
            self.state.load.force[*j] -= couple;
        }
    }

    /// Contact forces on the free nodes; returns the moment on the core about +y.
    fn contact_forces(&mut self, spin: Spin, commit: Option<f64>) -> f64 {
        let free = self.free_nodes();
        let ContactModel::Nodal(nodal) = &mut self.contact else {
            return 0.0;
        };
        let contacts = &mut nodal.contacts;
        let mut moment = 0.0;
        let mut arc = self.state.arc0 + self.state.rod.rest[..free.start].iter().sum::<f64>();
        let per_length = self.model.section.mass_per_length();
        // relative velocity in the pose that belongs to it: half a step back, the turning core would
        // look like an approach at omega^2 R dt / 2
        let lag = self.scratch.velocity_lag;
        let before = Spin::new(self.state.spindle.angle - self.state.spindle.speed * lag);
        for i in free {
            let x = self.state.rod.x[i];
            let v = self.state.rod.v[i];
            let length = self.state.rod.voronoi(i);
            let body = Body {
                position: spin.to_core(x),
                velocity: before.to_core(v - spin_velocity(self.state.spindle.speed, x - v * lag)),
                length,
                mass: per_length * length,
                arc,
            };
            let f = contacts.force(i, &body, commit);
            if f != V3::zeros() {
                let f = spin.to_lab(f);
                self.state.load.force[i] += f;
                moment -= x.z * f.x - x.x * f.z;
                if commit.is_some() {
                    self.state.deepest = self.state.deepest.max(contacts.nodes[i].depth());
                }
            }
            if i < self.state.rod.edges() {
                arc += self.state.rod.rest[i];
            }
        }
        moment
    }

    /// Forces of live wire on live wire. The held nodes take part as partners.
    fn live_forces(&mut self, spin: Spin, commit: Option<f64>) {
        let ContactModel::Nodal(nodal) = &mut self.contact else {
            return;
        };
        let NodalContact {
            contacts,
            live: Some(live),
            wire,
        } = &mut **nodal
        else {
            return;
        };
        let rod = &self.state.rod;
        let mut arc = 0.0;
        wire.position.clear();
        wire.velocity.clear();
        wire.length.clear();
        wire.arc.clear();
        for i in 0..rod.nodes() {
            let x = rod.x[i];
            wire.position.push(spin.to_core(x));
            wire.velocity
                .push(spin.to_core(rod.v[i] - spin_velocity(self.state.spindle.speed, x)));
            wire.length.push(rod.voronoi(i));
            wire.arc.push(arc);
            arc += rod.rest.get(i).copied().unwrap_or(0.0);
        }
        let per_length = self.model.section.mass_per_length();
        live.evaluate(
            wire,
            &contacts.law,
            self.model.section.diameter,
            per_length,
            commit,
        );
        for (force, f) in self.state.load.force.iter_mut().zip(&live.force) {
            if *f != V3::zeros() {
                *force += spin.to_lab(*f);
            }
        }
        if commit.is_some() {
            self.state.deepest = self.state.deepest.max(live.deepest);
        }
    }

    /// Lets the wire through the nozzle for `dt`; call after the nodes have moved.
    pub(crate) fn feed_step(&mut self, dt: f64) {
        let (Some(spec), Some(feed)) = (&self.model.feed, &mut self.state.feed) else {
            return;
        };
        let n = self.state.rod.nodes() - 1;
        let e = n - 1;
        let d = self.state.rod.x[n] - self.state.rod.x[e];
        let length = d.norm();
        let rest = self.state.rod.rest[e];
        let plastic = self.state.rod.stretch[e].strain;
        // the line comes from beyond the nozzle, radially
        let out = V3::new(self.state.rod.x[n].x, 0.0, self.state.rod.x[n].z).normalize();
        let deflection = libm::acos((d.dot(&out) / length).clamp(-1.0, 1.0));
        let law = self.model.laws.stretch;
        let step = feed.step(
            spec,
            &law,
            self.state.set_tension,
            dt,
            rest,
            length,
            plastic,
            deflection,
        );
        let after = rest + step.grown;
        // the edge stretches and grows in the same step: its tension runs from the old to the new value
        let tension =
            0.5 * (self.state.load.tension[e] + law.modulus * (length / after - 1.0 - plastic));
        // wire arrives stretched, so it brings its elastic energy along
        self.state.balance.nozzle -=
            (tension * (1.0 + plastic) + 0.5 * tension * tension / law.modulus) * step.grown;
        let gained = 0.5 * self.model.section.mass_per_length() * step.grown;
        self.state.balance.inflow += 0.5 * gained * self.state.rod.v[e].norm_squared();
        self.state.rod.rest[e] = after;
    }
}
