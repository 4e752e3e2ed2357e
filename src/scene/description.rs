//! The checked scene of a run, in SI units; nothing changes it while the run goes on.

use super::nozzle_law::NozzleLaw;
use super::speed_law::SpeedLaw;
use crate::measure::DefectLimits;
use crate::rod::{RoundLaws, Section, Twist};
use crate::settings::{
    Contact, Freeze, Friction, Nozzle, Output, Spindle, Start, Tensioner, Traverse, Winding,
};
use crate::signals::Inputs;
use std::path::PathBuf;

/// The description of a run, which does not change while it runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// packed name or file stem
    pub name: String,
    /// which solver set-up
    pub preset: Preset,
    /// wire section and yield limits
    pub wire: Section,
    /// name of the material, as given
    pub wire_material: String,
    /// laws that were integrated over the section, before single limits replaced them; `None` where the material gives
    /// rigidities
    pub wire_laws: Option<RoundLaws>,
    /// resistivity of the wire at 20 degC, ohm m
    pub resistivity: f64,
    /// core geometry, with its insulation
    pub core: Core,
    /// room that the coil may take
    pub window: Option<Window>,
    /// nozzle
    pub nozzle: Nozzle,
    /// tensioner and the line to the nozzle
    pub tensioner: Tensioner,
    /// the scene gives its tension; else coils are judged by the input at the start
    pub tension_given: bool,
    /// where the wire begins
    pub start: Start,
    /// spindle motion profile of `coilwind run`, as given
    pub spindle: Spindle,
    /// the spindle's speed that follows from it
    pub speed_law: SpeedLaw,
    /// traverse motion profile of `coilwind run`, as given
    pub traverse: Traverse,
    /// turns and layers of `coilwind run`, as given
    pub winding: Winding,
    /// the nozzle's way that follows from both
    pub nozzle_law: NozzleLaw,
    /// contact law
    pub contact: Contact,
    /// friction law
    pub friction: Friction,
    /// solver settings
    pub solver: Solver,
    /// the program's decisions on settings that are `auto`
    pub skipped: Vec<Decision>,
    /// when wire at rest leaves the computation
    pub freeze: Freeze,
    /// limits of the defect flags
    pub defects: DefectLimits,
    /// what is recorded
    pub output: Output,
}

impl Scene {
    /// Inputs before the first step: core at rest, nozzle where its law begins, set tension.
    pub fn start_inputs(&self) -> Inputs {
        Inputs {
            spindle_speed: 0.0,
            nozzle_position: self.nozzle_law.start(),
            tension_setpoint: self.tensioner.tension,
            ..Inputs::HELD
        }
    }
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
        /// flanges beside it
        flange: Option<Flange>,
    },
    /// Circular cylinder about y.
    Cylinder {
        /// radius, m
        radius: f64,
        /// full length along y, m
        length_y: f64,
        /// flanges beside it
        flange: Option<Flange>,
    },
    /// Triangle mesh from an STL file.
    Mesh {
        /// path of the file, already resolved
        path: PathBuf,
        /// metres per file unit
        unit: f64,
        /// flanges beside it, if it has none of its own
        flange: Option<Flange>,
    },
}

/// The winding window over one flank of the core: from flange to flange, and up to the limit line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// inner faces of the flanges along y, m; `None` without flanges
    pub faces: Option<[f64; 2]>,
    /// height of the limit line over the core at y = 0, m
    pub height: f64,
    /// angle of the limit line to the axis, rad; it rises towards +y
    pub taper: f64,
}

impl Window {
    /// Height of the limit line over the core at `y`, m.
    fn height_at(&self, y: f64) -> f64 {
        self.height + y * libm::tan(self.taper)
    }

    /// Height of the limit line at its lowest place between the flanges, m; without flanges that at y = 0.
    pub(super) fn lowest(&self) -> f64 {
        let [low, high] = self.faces.unwrap_or_default();
        self.height_at(low).min(self.height_at(high))
    }

    /// Distance of the flanges and mean height between them, m; none without flanges.
    pub fn size(&self) -> Option<[f64; 2]> {
        let [low, high] = self.faces?;
        Some([high - low, self.height_at(0.5 * (low + high))])
    }
}

/// Two flanges beside a core, the same on both sides of y = 0. Their rim stands the same height above it all round.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flange {
    /// distance of the inner faces, m
    pub inner_distance: f64,
    /// how far the rim stands above the core, m
    pub height: f64,
    /// thickness of each along y, m
    pub thickness: f64,
    /// radius of the edges of the rim, m
    pub edge_radius: f64,
}

impl Core {
    /// Radius of its corners, or of a round core, m; a mesh does not tell.
    pub(super) fn corner(&self) -> Option<f64> {
        match self {
            Self::RoundedBox { corner_radius, .. } => Some(*corner_radius),
            Self::Cylinder { radius, .. } => Some(*radius),
            Self::Mesh { .. } => None,
        }
    }

    /// Whether there may be flanges beside what wire is wound on.
    pub fn may_have_flanges(&self) -> bool {
        matches!(self, Self::Mesh { .. }) || self.flange().is_some()
    }

    /// Flanges that the scene has keys for.
    // Inlined, the flag of one shape's flanges is read before the shape is known: harmless, but memory checkers tell of it.
    #[inline(never)]
    pub fn flange(&self) -> Option<Flange> {
        match self {
            Self::RoundedBox { flange, .. }
            | Self::Cylinder { flange, .. }
            | Self::Mesh { flange, .. } => *flange,
        }
    }
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

impl Integrator {
    /// Whether it is the implicit method, which has contact along the wire and finds its own steps.
    pub fn is_implicit(self) -> bool {
        self == Self::Implicit
    }
}

/// The program's decision on a setting that is `auto`.
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
    /// distance from the core or the layer below at which free-span edges are split to the near spacing, m
    pub refine_distance: f64,
    /// time step as a share of the stability limit, 0..1
    pub step_share: f64,
    /// fixed time step, s; 0: from the stability limit or the error
    pub step: f64,
    /// error that one step of the implicit method may have, m
    pub tolerance: f64,
    /// what a step contains
    pub features: Features,
}

/// Features of a step that can be left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Features {
    /// contact of live wire with live wire
    pub live_contact: LiveContact,
    /// the mass of the wire; without it the wire follows the core through states of rest
    pub inertia: bool,
    /// settled wire behind lift-off gets a coarser spacing
    pub coarse_settled: bool,
    /// steps may reach beyond communication points
    pub steps_beyond: bool,
    /// steps along the scene's own motion may reach beyond the rows of its history
    pub rows_between: bool,
}

/// Since when live wire is looked for near live wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LiveContact {
    /// from the first step
    Always,
    /// from half a laid live turn on, before which it cannot meet itself
    WhenHalfATurnIsLive,
    /// never: live wire passes through live wire
    Never,
}
