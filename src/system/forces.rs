//! Forces of the paper's method, joint by joint and node by node, and loads besides contact.

use super::{Loads, System, nodal_contact};
use crate::contact::{Body, LiveConditions, NodalState};
use crate::math::{Spin, V3, spin_velocity};
use crate::rod::{ForceParts, internal_forces};

impl System {
    /// All forces at the present state into `self.load`. With `commit = Some(dt)` plastic state,
    /// frames and friction anchors move on and the energy balance grows by what happens in `dt`.
    pub fn evaluate(&mut self, commit: Option<f64>) {
        self.internal(commit.is_some());
        if commit.is_some() {
            self.state.depth = 0.0;
        }
        let spin = Spin::new(self.state.spindle.angle);
        let torque_from_contact = self.contact_forces(spin, commit);
        self.live_forces(spin, commit);
        self.state.torque_on_core = torque_from_contact + self.clamp_torque();
        if let Some(dt) = commit {
            self.state.deepest = self.state.deepest.max(self.state.depth);
            let nodal = self.state.contact.as_nodal();
            let touch = nodal.map_or(Default::default(), |n| n.loss);
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
        let Some(mut contact) = nodal_contact(
            &self.model.contact,
            &mut self.state.contact,
            &self.state.frozen,
            &mut self.scratch.contact,
        ) else {
            return 0.0;
        };
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
            let f = contact.force(i, &body, commit);
            if f != V3::zeros() {
                let f = spin.to_lab(f);
                self.state.load.force[i] += f;
                moment -= x.z * f.x - x.x * f.z;
                if commit.is_some() {
                    self.state.depth = self.state.depth.max(contact.state.nodes[i].depth());
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
        let Some(contact) = nodal_contact(
            &self.model.contact,
            &mut self.state.contact,
            &self.state.frozen,
            &mut self.scratch.contact,
        ) else {
            return;
        };
        let NodalState {
            live: Some(live),
            wire,
            ..
        } = contact.state
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
        let around = LiveConditions {
            law: &contact.model.law,
            diameter: self.model.section.diameter,
            per_length: self.model.section.mass_per_length(),
            commit,
        };
        let added = &mut contact.scratch.force;
        live.evaluate(wire, &around, added);
        for (force, f) in self.state.load.force.iter_mut().zip(added) {
            if *f != V3::zeros() {
                *force += spin.to_lab(*f);
            }
        }
        if commit.is_some() {
            self.state.depth = self.state.depth.max(live.deepest);
        }
    }
}
