//! The mechanical system that a step advances: rod, supports, loads, contact, feed.
//!
//! Lab frame; the core turns about +y. Nothing here knows scenes or files.

mod contact;
mod drive;
mod energy;
mod energy_balance;
mod folded_clamp;
mod forces;
mod frozen_history;
mod frozen_pull;
mod history;
mod line_forces;
mod model;
mod nozzle_edge;
mod remesh;
mod saved;
mod scratch;
mod slip;
mod state;
mod support;
mod touchable;

pub(crate) use contact::line_contact;
pub use contact::{ContactModel, ContactState};
use contact::{ContactScratch, nodal_contact};
pub use drive::{Drive, NozzleDrive};
pub use energy_balance::EnergyBalance;
pub(crate) use folded_clamp::HALF_TURN;
pub use frozen_history::{FrozenHistory, FrozenNodeRecord};
pub use frozen_pull::{Beside, FrozenPull, FrozenPulls};
pub use history::Past;
pub use model::{Loads, Mass, Model};
use scratch::Scratch;
pub(crate) use slip::FrozenSlip;
pub use state::State;
pub use support::{Spindle, Support};

use crate::feed::{EdgeStep, Feed, FeedSpec};
use crate::math::turn_about_y;
use crate::math::{Quat, Spin, V3, spin_velocity};
use crate::rod::{ExitBend, Laws, Rod, Section, Twist};

/// Rod with everything that acts on it.
#[derive(Clone, Debug)]
pub struct System {
    /// what does not change in a run
    pub model: Model,
    /// what a step changes
    pub state: State,
    pub(crate) scratch: Scratch,
}

impl System {
    /// A rod with nothing acting on it.
    pub fn new(section: Section, rod: Rod) -> Self {
        let radius = section.radius();
        Self {
            model: Model {
                laws: Laws::new(&section),
                section,
                mass: Mass::default(),
                twist: Twist::Dynamic,
                loads: Loads::default(),
                feed: None,
                contact: ContactModel::None,
                core: None,
            },
            state: State::of(rod, radius),
            scratch: Scratch::default(),
        }
    }

    /// Takes over the state of another system of the same model, and keeps its own work space.
    pub(crate) fn take_over_from(&mut self, other: &Self) {
        self.state.copy_from(&other.state);
        self.scratch.contact.serve(&other.scratch.contact);
    }

    /// Lets wire in at the last node; `feed` is the state it begins in.
    pub fn set_feed(&mut self, spec: FeedSpec, feed: Feed) {
        (self.model.feed, self.state.feed) = (Some(spec), Some(feed));
    }

    /// Puts a damper on the tensioner beside its own, N s/m.
    pub(crate) fn damp_tensioner(&mut self, damping: f64) {
        if let Some(feed) = &mut self.state.feed {
            feed.damping = damping;
        }
    }

    /// Set pull of the tensioner `dt` from now, N; it never pushes.
    pub fn set_tension_after(&self, dt: f64) -> f64 {
        (self.state.set_tension + self.state.set_rate * dt).max(0.0)
    }

    /// Direction in which the wire leaves a clamped end, lab frame.
    #[cfg(feature = "lab")]
    pub fn clamp_direction(&self, end: usize) -> Option<V3> {
        self.clamp_frame(end)
            .map(|f| crate::math::rotate(&f, &V3::z()))
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

    /// Tension after over tension before the nozzle's exit while wire comes out, by friction over the
    /// deflection there and by bending over its edge.
    pub(crate) fn exit_grip(&self) -> f64 {
        let Some(spec) = &self.model.feed else {
            return 1.0;
        };
        if spec.exit_friction == 0.0 && spec.exit_curvature == 0.0 {
            return 1.0;
        }
        let n = self.state.rod.nodes() - 1;
        let d = self.state.rod.x[n] - self.state.rod.x[n - 1];
        let out = V3::new(self.state.rod.x[n].x, 0.0, self.state.rod.x[n].z).normalize();
        let deflection = libm::acos((d.dot(&out) / d.norm()).clamp(-1.0, 1.0));
        let grip = libm::exp(spec.exit_friction * deflection);
        let before = self.state.feed.map_or(0.0, |feed| feed.line_tension);
        if spec.exit_curvature == 0.0 || before <= 0.0 {
            return grip;
        }
        let bend = ExitBend::over(
            &self.model.laws.bend,
            spec.exit_curvature,
            deflection,
            before,
        );
        grip + bend.work / before
    }

    /// Lets the wire through the nozzle for `dt`; call after the nodes have moved.
    pub(crate) fn feed_step(&mut self, dt: f64) {
        self.tighten_line_wire();
        let (Some(spec), Some(feed)) = (&self.model.feed, &mut self.state.feed) else {
            return;
        };
        let n = self.state.rod.nodes() - 1;
        let e = n - 1;
        let d = self.state.rod.x[n] - self.state.rod.x[e];
        let length = d.norm();
        let rest = self.state.rod.rest[e];
        let plastic = self.state.rod.stretch[e].strain;
        let coming = self.state.line_wire.next(feed.fed).strain;
        let law = self.model.laws.stretch;
        let yields = self
            .state
            .line_wire
            .yields(&law, spec.line_length, feed.fed);
        // the line comes from beyond the nozzle, radially
        let out = V3::new(self.state.rod.x[n].x, 0.0, self.state.rod.x[n].z).normalize();
        let deflection = libm::acos((d.dot(&out) / length).clamp(-1.0, 1.0));
        let step = EdgeStep {
            dt,
            set: self.state.set_tension,
            rest,
            length,
            plastic: [plastic, coming],
            deflection,
            yields: &yields,
        };
        let grown = feed.step(spec, &law, &step);
        let passing = self.pass_nozzle(grown);
        let (after, plastic) = (self.state.rod.rest[e], self.state.rod.stretch[e].strain);
        // the edge stretches and grows in the same step: its tension runs from the old to the new value
        let tension =
            0.5 * (self.state.load.tension[e] + law.modulus * (length / after - 1.0 - plastic));
        // wire arrives stretched, so it brings its elastic energy along
        self.state.balance.nozzle -=
            (tension * (1.0 + passing) + 0.5 * tension * tension / law.modulus) * grown;
        let gained = 0.5 * self.model.section.mass_per_length() * grown;
        self.state.balance.inflow += 0.5 * gained * self.state.rod.v[e].norm_squared();
    }
}
