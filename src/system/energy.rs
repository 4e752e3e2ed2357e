//! Energy in a system, and what its balance cannot explain.

use super::{ContactModel, ContactState, Mass, System};
use crate::contact::{ContactPoint, LineModel, LineState};
use crate::rod::stored_energy;

impl System {
    /// Elastic energy of the live wire and its touches, J.
    pub fn stored(&self) -> f64 {
        let clamp = [self.clamp_frame(0), self.clamp_frame(1)];
        let rod = stored_energy(
            &self.state.rod,
            &self.model.laws,
            &clamp,
            self.model.twist.is_carried(),
        );
        self.stored_with(rod.iter().sum())
    }

    /// The same with the energy of the `rod` known.
    fn stored_with(&self, rod: f64) -> f64 {
        match (&self.model.contact, &self.state.contact) {
            (ContactModel::Line(model), ContactState::Line(line)) => {
                rod + self.stored_in_points(model, line)
            }
            (ContactModel::Nodal(model), ContactState::Nodal(nodal)) => {
                let touch: f64 = self
                    .free_nodes()
                    .map(|i| nodal.stored(model, i, self.state.rod.voronoi(i)))
                    .sum();
                let live = nodal.live.as_ref();
                let between = live.map_or(0.0, |l| l.stored(&model.law, &nodal.wire.length));
                rod + touch + between
            }
            _ => rod,
        }
    }

    fn stored_in_points(&self, model: &LineModel, line: &LineState) -> f64 {
        let rod = &self.state.rod;
        let at = |point: ContactPoint| line.stored(model, point.number(), point.length(rod));
        (0..rod.edges())
            .map(|j| {
                let node = if j > 0 {
                    at(ContactPoint::Node(j))
                } else {
                    0.0
                };
                node + at(ContactPoint::Edge(j))
            })
            .sum::<f64>()
            + line.self_contact.as_ref().map_or(0.0, |pairs| {
                pairs.stored(&model.law, model.onset, |number| {
                    ContactPoint::of_number(number).length(rod)
                })
            })
    }

    /// Motion energy of the free nodes and spinning edges, J.
    pub fn kinetic(&self) -> f64 {
        let (rod, section) = (&self.state.rod, &self.model.section);
        let inertia = 0.5 * section.spin_inertia_per_length();
        let edges = rod.rest.iter().zip(&rod.spin);
        let spin: f64 = edges
            .map(|(rest, spin)| inertia * rest * spin.powi(2))
            .sum();
        let density = section.mass_per_length();
        let free = self.free_nodes();
        let nodes = free.clone().zip(&rod.v[free]);
        let motion: f64 = nodes
            .map(|(i, v)| 0.5 * (density * rod.voronoi(i)) * v.norm_squared())
            .sum();
        motion + spin - self.kinetic_between()
    }

    /// What lumped mass has too much of motion energy where it is not lumped, J.
    fn kinetic_between(&self) -> f64 {
        if self.model.mass == Mass::Lumped {
            return 0.0;
        }
        let v = &self.state.rod.v;
        (0..self.state.rod.edges())
            .map(|j| 0.5 * self.mass_between(j) * (v[j + 1] - v[j]).norm_squared())
            .sum()
    }

    /// Mass that couples the two ends of edge `j` where it is not lumped, kg.
    pub(crate) fn mass_between(&self, j: usize) -> f64 {
        self.model.section.mass_per_length() * self.state.rod.rest[j] / 6.0
    }

    /// Energy that the balance cannot explain, J: what should be there minus what is.
    ///
    /// With a staggered step of `dt` the motion energy is the product of the velocities before and
    /// after this instant, which is the quantity the scheme conserves. It is `None` where velocities
    /// belong to the present time.
    pub fn energy_residual(&self, staggered: Option<f64>) -> f64 {
        let b = self.state.balance;
        let supply = b.initial + b.spindle + b.nozzle + b.inflow;
        let lost = b.plastic.iter().sum::<f64>() + b.friction + b.damping;
        let method = b.numerical + b.remeshing;
        // (the forces are those of this instant)
        let stored = self.stored_with(self.state.load.stored);
        let kinetic = match staggered {
            Some(dt) => self.staggered_kinetic(dt),
            None => self.kinetic(),
        };
        supply - lost - method - b.frozen_stored - b.frozen_kinetic - stored - kinetic
    }

    fn staggered_kinetic(&self, dt: f64) -> f64 {
        let mut e = 0.0;
        for i in self.free_nodes() {
            let m = self.state.rod.mass(&self.model.section, i);
            let v = self.state.rod.v[i];
            e += 0.5 * m * v.dot(&(v + self.state.load.force[i] * (dt / m)));
        }
        let inertia = self.model.section.spin_inertia_per_length();
        for j in 0..self.state.rod.edges() {
            let i = inertia * self.state.rod.rest[j];
            e += 0.5
                * i
                * self.state.rod.spin[j]
                * (self.state.rod.spin[j] + self.state.load.torque[j] * (dt / i));
        }
        e
    }
}
