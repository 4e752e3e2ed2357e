//! Pieces that several contact checks share: straight frozen wires, a piece of wire over them,
//! the step, and averages.

use super::case::no_answer;
use super::{Context, VerifyError};
use crate::contact::{ContactLaw, LineModel, NodalModel};
use crate::geometry::{FrozenNode, SIDES};
use crate::geometry::{Shape, Surface, Touch, TriMesh, generate};
use crate::integrate::{
    Explicit, ExplicitMethod, Implicit, Scheme, VERLET_LIMIT, highest_frequency,
};
use crate::math::V3;
use crate::math::{align, frame_along};
use crate::rod::Twist;
use crate::rod::{Rod, Section};
use crate::scene::Integrator;
use crate::system::{ContactModel, Support, System};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// Edges of the straight piece.
const EDGES: usize = 32;

/// Edge length of the piece in wire diameters: that of a wind by the explicit method.
const SPACING_EXPLICIT: f64 = 0.7;

/// Facets by which the frozen wire rolls about itself along the piece.
///
/// A frozen wire is a prism of [`SIDES`] facets and may lie at any roll. A piece over an unrolled
/// one touches a facet or a ridge along its whole length. Its normal is then off by up to
/// `pi / (2 SIDES)` = 2.8 degrees, which is 22 % of the angle of friction. Over a prism rolled by
/// a few whole facets, the piece rides on the ridges that point at it, as on a circle. The number
/// is coprime to [`EDGES`], so touches spread evenly and the piece neither bends nor tilts.
const ROLL: f64 = 7.0;

/// Step as a share of the stability limit.
const SHARE: f64 = 0.7;

/// Longest step of the production method, in units of time: a master that looks often.
const LONGEST: f64 = 0.05;

/// Shortest step of the production method, s: that of a winding run.
const SHORTEST: f64 = 1e-9;

/// Units of time over which the load rises, and the steady loads that the production method sees then.
const RISE: f64 = 0.3;
const RISE_PARTS: usize = 30;

/// Mean depth under the load as a share of the wire radius: 5 nm, 30 nm under the touching nodes.
const DEPTH: f64 = 1.5e-5;

/// How steps are taken.
pub(super) enum Stepper {
    /// steps of a given length
    Explicit(Explicit),
    /// the production method, with its own choice of step
    Implicit(Box<Implicit>),
}

impl Stepper {
    /// The production method with the `tolerance`, m, in steps of at most `longest`, s.
    pub(super) fn implicit(tolerance: f64, longest: f64) -> Self {
        Self::Implicit(Box::new(Implicit::new(
            Scheme::Bdf2,
            tolerance,
            SHORTEST,
            longest,
        )))
    }

    /// Lowers the tolerance of the production method to a tenth.
    pub(super) fn tighten(&mut self) {
        if let Self::Implicit(method) = self {
            method.tolerance *= 0.1;
        }
    }

    /// Goes through `time`, in steps of `dt` where they are explicit; how many steps that took.
    pub(super) fn through(
        &mut self,
        sys: &mut System,
        time: f64,
        dt: f64,
    ) -> Result<usize, VerifyError> {
        let mut steps = 0;
        match self {
            Self::Explicit(explicit) => {
                steps = (time / dt).ceil() as usize;
                for _ in 0..steps {
                    explicit.step(sys, dt);
                }
            }
            Self::Implicit(method) => {
                let mut left = time;
                while left > 0.0 {
                    let taken = method.step(sys, left).map_err(no_answer)?;
                    left = if taken >= left { 0.0 } else { left - taken };
                    steps += 1;
                }
            }
        }
        Ok(steps)
    }
}

/// A piece of straight wire along x under a line load, over straight frozen wire along x.
///
/// Down is -z, sideways y. Times are told in `sqrt(m' r / q)`.
pub(super) struct Bench {
    /// the piece and what acts on it
    pub(super) sys: System,
    /// vertical line load, N/m
    pub(super) load: f64,
    /// height of the frozen wires' axes, m
    pub(super) height: f64,
    /// unit of time, s
    pub(super) unit: f64,
    /// step, s
    pub(super) dt: f64,
    /// how to take it
    pub(super) step: Stepper,
    full: V3,
}

impl Bench {
    /// The piece with its axis at `offset` along y and `above` over the axes of frozen wires,
    /// which lie at the places `neighbours` along y. A load `q` acts down and `sideways q` along y,
    /// none of it yet. The frozen wires lie on the flat top of a box.
    pub(super) fn new(
        ctx: &Context,
        neighbours: &[f64],
        offset: f64,
        above: f64,
        sideways: f64,
        law: ContactLaw,
    ) -> Result<Self, VerifyError> {
        let section = &ctx.elastic();
        let r = section.radius();
        let implicit = ctx.integrator == Integrator::Implicit;
        let spacing = ctx.spacing.unwrap_or(SPACING_EXPLICIT * section.diameter);
        let length = EDGES as f64 * spacing;
        let (half_height, reach) = (10.0 * r, 1000.0 * r);
        let height = half_height + r;
        let points: Vec<V3> = (0..=EDGES)
            .map(|i| {
                let x = spacing * i as f64 - 0.5 * length;
                V3::new(x, offset, height + above)
            })
            .collect();
        let mut sys = System::new(section.clone(), Rod::through(&points, None));
        // the wire is elastic, and a wind carries no twist of such wire
        sys.model.twist = Twist::Off;
        if implicit {
            let floor = Shape::RoundedBox {
                half_x: 2.0 * length,
                half_z: half_height,
                half_y: reach,
                corner_radius: 0.0,
            };
            sys.touch_along(LineModel::new(floor, law, r));
        } else {
            let floor = box_mesh(4.0 * length, 2.0 * half_height, 2.0 * reach)?;
            sys.touch_at_nodes(NodalModel {
                surface: Arc::new(floor),
                law,
                radius: r,
                diameter: section.diameter,
            });
        }
        for node in straight_wires(neighbours, height, length) {
            sys.lay_frozen(node);
        }
        // guided along itself: ridges of rolled wire are screws
        sys.state.support[0] = Support {
            hold: [true, false, false],
            point: points[0],
            ..Support::free()
        };
        // far along the wire, so that nothing counts as the piece's own neighbourhood
        sys.state.arc0 = 100.0 * length;
        let load = law.stiffness * DEPTH * r;
        let m = section.mass_per_length();
        let dt = stable_step(section, spacing, law.stiffness, false);
        let mut bench = Self {
            sys,
            load,
            height,
            unit: (m * r / load).sqrt(),
            dt,
            step: if implicit {
                Stepper::implicit(ctx.tolerance, LONGEST * (m * r / load).sqrt())
            } else {
                Stepper::Explicit(Explicit::new(ExplicitMethod::Verlet))
            },
            full: V3::new(0.0, sideways * load, -load) / m,
        };
        bench.sys.refresh();
        Ok(bench)
    }

    /// Raises the load smoothly from nothing, over many periods of the contact spring.
    pub(super) fn apply_load(&mut self) -> Result<(), VerifyError> {
        let steps = match self.step {
            Stepper::Explicit(_) => (RISE * self.unit / self.dt).ceil() as usize,
            Stepper::Implicit(_) => RISE_PARTS,
        };
        let dt = match self.step {
            Stepper::Explicit(_) => self.dt,
            Stepper::Implicit(_) => RISE * self.unit / steps as f64,
        };
        for i in 0..steps {
            let s = (i as f64 + 1.0) / steps as f64;
            self.sys.model.loads.gravity = self.full * (0.5 - 0.5 * libm::cos(PI * s));
            self.step.through(&mut self.sys, dt, dt)?;
        }
        Ok(())
    }

    /// Pushes along y as well, with this share of the load.
    pub(super) fn push_aside(&mut self, share: f64) {
        self.sys.model.loads.gravity.y = -share * self.full.z;
    }

    /// Goes on for `units` of time.
    pub(super) fn run(&mut self, units: f64) -> Result<(), VerifyError> {
        let time = units * self.unit;
        self.step.through(&mut self.sys, time, self.dt).map(|_| ())
    }

    /// Centre of mass.
    pub(super) fn centre(&self) -> V3 {
        self.mean(|i| self.sys.state.rod.x[i])
    }

    /// Its velocity.
    pub(super) fn velocity(&self) -> V3 {
        self.mean(|i| self.sys.state.rod.v[i])
    }

    fn mean(&self, of: impl Fn(usize) -> V3) -> V3 {
        let rod = &self.sys.state.rod;
        let length: f64 = rod.rest.iter().sum();
        (0..rod.nodes())
            .map(|i| of(i) * (rod.voronoi(i) / length))
            .sum()
    }

    /// Unstretched length of the piece, m.
    pub(super) fn length(&self) -> f64 {
        self.sys.state.rod.rest.iter().sum()
    }
}

/// Frozen wires along x at the places `y` and height `z`, one chain that turns back
/// beyond the ends of a piece of `length` about the origin.
fn straight_wires(y: &[f64], z: f64, length: f64) -> Vec<FrozenNode> {
    let mut nodes = Vec::new();
    let rings = 2 * EDGES;
    let step = length / rings as f64;
    let beyond = 16;
    let mut arc = 0.0;
    for (passage, y) in y.iter().enumerate() {
        let forth = passage % 2 == 0;
        let direction = if forth { V3::x() } else { -V3::x() };
        let base = frame_along(&direction, None);
        for k in 0..=rings + 2 * beyond {
            let along = k as f64 * step - beyond as f64 * step - 0.5 * length;
            let roll = ROLL * TAU / SIDES as f64 * along / length;
            nodes.push(FrozenNode {
                point: V3::new(if forth { along } else { -along }, *y, z),
                frame: align(&base, &direction, roll),
                arc,
                tension: 0.0,
                plastic_strain: 0.0,
                plastic_bend: 0.0,
            });
            arc += step;
        }
    }
    nodes
}

/// A law with one friction coefficient.
pub(super) fn law(stiffness: f64, damping_ratio: f64, mu: f64) -> ContactLaw {
    ContactLaw {
        stiffness,
        damping_ratio,
        mu_static: mu,
        mu_kinetic: mu,
        slip_speed: 1.0,
    }
}

/// Box with sharp edges.
pub(super) fn box_mesh(x: f64, z: f64, y: f64) -> Result<Surface, VerifyError> {
    mesh(generate::rounded_box(x, z, y, 0.0, 1))
}

/// Surface of a generated shape.
pub(super) fn mesh(
    made: Result<TriMesh, crate::geometry::MeshError>,
) -> Result<Surface, VerifyError> {
    made.map(Surface::new)
        .map_err(|e| VerifyError::NoAnswer(e.to_string()))
}

/// A step well inside the stability limit of a rod of spacing `h` on a contact spring, s.
pub(super) fn stable_step(section: &Section, h: f64, stiffness: f64, twist: bool) -> f64 {
    SHARE * VERLET_LIMIT / highest_frequency(section, h, stiffness, twist)
}

/// Force of each touch of node `i` at rest, from the law that moves the wire, N.
pub(super) fn touch_forces(sys: &System, i: usize) -> Vec<V3> {
    if let (Some(model), Some(line)) = (sys.model.contact.as_line(), sys.state.contact.as_line()) {
        // the node's own point and the middle of the edge after it
        let rod = &sys.state.rod;
        let mut forces = Vec::new();
        if i > 0 && i < rod.edges() {
            forces.extend(line.normal_forces(model, 2 * i, 0.5 * rod.voronoi(i)));
        }
        if i < rod.edges() {
            forces.extend(line.normal_forces(model, 2 * i + 1, 0.5 * rod.rest[i]));
        }
        return forces;
    }
    let ContactModel::Nodal(model) = &sys.model.contact else {
        return Vec::new();
    };
    let p = crate::math::Spin::new(sys.state.spindle.angle).to_core(sys.state.rod.x[i]);
    let (mut triangles, mut segments, mut touches) = (Vec::new(), Vec::new(), Vec::new());
    let (core, frozen, r) = (&model.surface, &sys.state.frozen, model.radius);
    core.near(p, r, &mut triangles);
    core.touching(p, r, &triangles, &mut touches);
    frozen.near(p, r, f64::INFINITY, &mut segments);
    frozen.touching(p, r, &segments, &mut touches);
    let force = |t: &Touch| {
        let (length, mass) = (
            sys.state.rod.voronoi(i),
            sys.state.rod.mass(&sys.model.section, i),
        );
        model
            .law
            .force(t.normal, t.depth, V3::zeros(), V3::zeros(), length, mass)
            .force
    };
    touches.iter().map(force).collect()
}

/// A mean over a run that does not see oscillations: weights rise and fall as a squared sine.
pub(super) struct SmoothMean {
    samples: usize,
    seen: usize,
    sum: f64,
}

impl SmoothMean {
    /// Over so many samples.
    pub(super) fn over(samples: usize) -> Self {
        Self {
            samples,
            seen: 0,
            sum: 0.0,
        }
    }

    /// The next sample.
    pub(super) fn add(&mut self, value: f64) {
        let s = libm::sin(PI * (self.seen as f64 + 0.5) / self.samples as f64);
        self.sum += value * 2.0 * s * s / self.samples as f64;
        self.seen += 1;
    }

    /// The mean, once all samples are in.
    pub(super) fn value(&self) -> f64 {
        self.sum
    }
}
