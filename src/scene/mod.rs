//! The immutable description of a run, in SI units.
//!
//! [`SceneSettings`] holds the leaves as the user gives them (defaults, then a TOML file or a
//! packed scene, then single values); its `build` validates them into a [`Scene`], which
//! everything else reads.

mod build;
mod error;
mod file;
mod key;
mod material;
mod saved;
mod settings;
mod skip;
mod write;

pub use error::{Place, SceneError, Warning};
pub use file::packed_names;
pub use key::{assignment, unit_suffixes};
pub use settings::{CoreSettings, SceneSettings, SolverSettings, WireSettings};
pub use skip::{LiveContact, Parts};

use crate::integrate::Twist;
use crate::rod::Section;
use std::path::PathBuf;

/// Everything a run needs to know; does not change while it runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// packed name or file stem
    pub name: String,
    /// which solver set-up
    pub preset: Preset,
    /// wire section and yield limits
    pub wire: Section,
    /// `copper`, `table1` or `custom`
    pub wire_material: String,
    /// core geometry
    pub core: Core,
    /// nozzle
    pub nozzle: Nozzle,
    /// tensioner and the line to the nozzle
    pub tensioner: Tensioner,
    /// where the wire begins
    pub start: Start,
    /// spindle programme of `coilwind run`
    pub spindle: Spindle,
    /// traverse programme of `coilwind run`
    pub traverse: Traverse,
    /// contact law
    pub contact: Contact,
    /// friction law
    pub friction: Friction,
    /// solver settings
    pub solver: Solver,
    /// what was left to the program, and what it does without
    pub skipped: Vec<Decision>,
    /// when wire at rest leaves the computation
    pub freeze: Freeze,
    /// limits of the defect flags
    pub defects: Defects,
    /// what is recorded
    pub output: Output,
}

/// Solver set-up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Preset {
    /// the best this version has
    Default,
    /// the paper's method, mended (RK4, triangle meshes, uniform spacing)
    Paper,
}

/// Core geometry; the axis is +y through the origin, the core spans `-length/2 ..= length/2`.
#[derive(Clone, Debug, PartialEq)]
pub enum Core {
    /// Rounded rectangle in x-z, extruded along y.
    RoundedBox {
        /// full width along x, m
        width_x: f64,
        /// full height along z, m
        height_z: f64,
        /// full length along y, m
        length_y: f64,
        /// radius of the four long edges, m
        corner_radius: f64,
    },
    /// Circular cylinder about y.
    Cylinder {
        /// radius, m
        radius: f64,
        /// full length along y, m
        length_y: f64,
    },
    /// Triangle mesh from an STL file.
    Mesh {
        /// path of the file, already resolved
        path: PathBuf,
        /// metres per file unit
        unit: f64,
    },
}

/// Eyelet on +x: position fixed, direction free, wire slides through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nozzle {
    /// distance of the exit from the core axis, m
    pub distance: f64,
    /// start position along the core axis, m
    pub y_start: f64,
    /// friction force at the exit as a share of tension per rad of deflection
    pub exit_friction: f64,
}

/// Constant pull through an equivalent mass and an elastic line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tensioner {
    /// set pull, N
    pub tension: f64,
    /// equivalent mass per wire speed, kg; 0 with a rigid line: constant pull at the nozzle
    pub mass: f64,
    /// wire between tensioner and nozzle, m
    pub line_length: f64,
    /// damping ratio of mass on line
    pub line_damping_ratio: f64,
}

/// Where the wire begins: clamped to the middle of the +x face, tangent to it, straight to the
/// nozzle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// wire end along the core axis, m
    pub clamp_y: f64,
}

impl Start {
    /// Core angle at which the wire runs straight from clamp to nozzle, rad: `acos((h + r)/D)`.
    /// The spindle angle counts from here.
    ///
    /// `half_width` of the core along x at angle zero, radius of the wire and distance of the
    /// nozzle from the axis in m, `h + r <= D`.
    pub fn core_angle(half_width: f64, wire_radius: f64, nozzle_distance: f64) -> f64 {
        libm::acos((half_width + wire_radius) / nozzle_distance)
    }
}

/// Spindle programme of a native run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spindle {
    /// final speed about +y, rad/s
    pub speed: f64,
    /// turns over which the speed rises with constant acceleration
    pub ramp_turns: f64,
    /// turns of the spindle until the run ends
    pub turns: f64,
}

/// Traverse programme of a native run: nozzle y proportional to the core angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Traverse {
    /// nozzle travel per turn of the spindle, m (sign: direction along y)
    pub per_turn: f64,
    /// constant lead of the nozzle over the law, m
    pub lead: f64,
}

/// Penalty contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// line load per depth, N/m^2
    pub stiffness: f64,
    /// rebound over impact speed of a single node
    pub restitution: f64,
}

/// Stick-slip friction, wire on core and wire on wire.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// coefficient at rest
    pub static_: f64,
    /// coefficient at high slip speed
    pub kinetic: f64,
    /// slip speed over which one turns into the other, m/s
    pub slip_speed: f64,
}

/// Method that moves the wire in time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Integrator {
    /// classical Runge-Kutta, four evaluations a step
    Rk4,
    /// velocity Verlet (staggered), one evaluation a step
    Verlet,
    /// implicit, second order, error-controlled
    Implicit,
}

/// What became of a setting that left the choice to the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Decision {
    /// name of the setting
    pub name: &'static str,
    /// what it was set to
    pub setting: &'static str,
    /// what was taken
    pub decision: &'static str,
    /// the reason
    pub why: &'static str,
}

/// Solver settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solver {
    /// time integrator
    pub integrator: Integrator,
    /// how the wire's twist is carried
    pub twist: Twist,
    /// node spacing near the core, m
    pub spacing_near: f64,
    /// node spacing in the free span, m
    pub spacing_free: f64,
    /// distance from the core at which free-span edges are split to the near spacing, m
    pub refine_distance: f64,
    /// time step as a share of the stability limit, 0..1
    pub step_share: f64,
    /// fixed time step, s; 0: from the stability limit or the error
    pub step: f64,
    /// error that one step of the implicit method may have, m
    pub tolerance: f64,
    /// what a step contains
    pub parts: Parts,
}

/// When wire leaves the computation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Freeze {
    /// off keeps all wire live
    pub enabled: bool,
    /// window of core angle over which motion is judged, rad
    pub window: f64,
    /// window of time instead, while the spindle stands, s
    pub time: f64,
    /// largest motion in the core frame per core angle, m/rad
    pub creep: f64,
    /// turns behind lift-off from which on that limit grows
    pub patience: f64,
    /// settled wire kept live behind lift-off, m; 0: 1.75 sqrt(EI/T)
    pub keep_length: f64,
    /// region: largest distance of the wire's surface from the core, m
    pub margin: f64,
}

/// Limits of the defect flags, lengths in wire diameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Defects {
    /// gap above this ...
    pub gap: f64,
    /// ... over at least this fraction of a turn in one run
    pub gap_fraction: f64,
    /// height over the quasi-static height
    pub bulge_excess: f64,
    /// absolute bulge limit, m; 0: use `bulge_excess`
    pub bulge_absolute: f64,
    /// axial distance to the neighbour below this ...
    pub overlap_axial: f64,
    /// ... while standing above its layer by this
    pub overlap_height: f64,
    /// polar angle after the clamp that is left out, rad
    pub skip_angle: f64,
}

/// What is recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// core angle between rows of `history.csv`, rad
    pub history_interval: f64,
    /// directory of the FMU's files; empty: none
    pub directory: String,
}
