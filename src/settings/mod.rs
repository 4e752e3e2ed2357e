//! Every leaf of a scene as the user gives it: one flat set, defaults until something is set.

mod origin;
mod sections;

pub use origin::Origin;
pub use sections::{
    Contact, Freeze, Friction, Nozzle, Output, Spindle, Start, Tensioner, Traverse,
};

use crate::measure::DefectLimits;
use crate::signals::Inputs;
use std::collections::BTreeMap;

/// The leaves of a scene, in SI units. A rigidity, limit or length of 0 is derived when the
/// [`Scene`](crate::scene::Scene) is built; `description` in the variable table says from what.
///
/// Leaves may be written directly; [`build`](Self::build) checks all of them again.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct SceneSettings {
    /// packed name or file stem
    pub name: String,
    /// `scene.file`: what was loaded; empty: default scene
    pub file: String,
    pub preset: String,
    pub wire: WireSettings,
    pub core: CoreSettings,
    pub nozzle: Nozzle,
    pub tensioner: Tensioner,
    pub start: Start,
    pub spindle: Spindle,
    pub traverse: Traverse,
    pub contact: Contact,
    pub friction: Friction,
    pub solver: SolverSettings,
    pub freeze: Freeze,
    pub defects: DefectLimits,
    pub output: Output,
    /// origin of each leaf that was set, by its name
    pub(crate) origins: BTreeMap<&'static str, Origin>,
}

/// `[wire]`; 0 in a rigidity or limit: from the material.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct WireSettings {
    pub material: String,
    pub elastic: bool,
    pub diameter: f64,
    pub density: f64,
    pub yield_stress: f64,
    pub flow_stress: f64,
    pub ea: f64,
    pub ea_p: f64,
    pub ei: f64,
    pub ei_p: f64,
    pub gj: f64,
    pub gj_p: f64,
    pub n_y: f64,
    pub m_y: f64,
    pub t_y: f64,
    pub moment_cap: f64,
    pub strength: f64,
}

/// `[core]`; a shape reads its own leaves only.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct CoreSettings {
    pub shape: String,
    pub width_x: f64,
    pub height_z: f64,
    pub length_y: f64,
    pub corner_radius: f64,
    pub radius: f64,
    /// already resolved against the folder of the scene file
    pub file: String,
    pub unit: String,
}

/// `[solver]`.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct SolverSettings {
    pub integrator: String,
    pub twist: String,
    pub spacing_near: f64,
    pub spacing_free: f64,
    pub refine_distance: f64,
    pub step_share: f64,
    pub step: f64,
    pub tolerance: f64,
    pub live_contact: String,
    pub plasticity: String,
    pub friction: String,
    pub inertia: String,
    pub coarse_span: String,
    pub coarse_settled: String,
}

impl SceneSettings {
    /// Inputs before the first step: core at rest, nozzle where the motion profile starts, set
    /// tension.
    pub fn start_inputs(&self) -> Inputs {
        Inputs {
            spindle_speed: 0.0,
            nozzle_position: self.nozzle.y_start + self.traverse.lead,
            tension_setpoint: self.tensioner.tension,
        }
    }

    /// Where the value of a leaf came from, by the name of its variable.
    pub fn origin(&self, name: &str) -> Origin {
        self.origins.get(name).cloned().unwrap_or_default()
    }
}

/// The scene of Fig. 8 with a section-consistent copper wire, and the settings of this program
/// that Fig. 8 leaves open.
impl Default for SceneSettings {
    fn default() -> Self {
        Self {
            name: "default".to_owned(),
            file: String::new(),
            preset: "default".to_owned(),
            wire: WireSettings {
                material: "copper".to_owned(),
                elastic: false,
                diameter: 0.7e-3,
                density: 8960.0,
                yield_stress: 100e6,
                // annealed copper at break, rounded; also the flow stress that caps its moment
                flow_stress: 220e6,
                ea: 0.0,
                ea_p: 0.0,
                ei: 0.0,
                ei_p: 0.0,
                gj: 0.0,
                gj_p: 0.0,
                n_y: 0.0,
                m_y: 0.0,
                t_y: 0.0,
                moment_cap: 0.0,
                strength: 0.0,
            },
            core: CoreSettings {
                shape: "rounded-box".to_owned(),
                width_x: 12e-3,
                height_z: 30e-3,
                length_y: 30e-3,
                corner_radius: 2e-3,
                radius: 10e-3,
                file: String::new(),
                unit: "mm".to_owned(),
            },
            nozzle: Nozzle {
                distance: 60e-3,
                y_start: 0.0,
                exit_friction: 0.0,
            },
            tensioner: Tensioner {
                tension: 15.0,
                mass: 1e-3,
                line_length: 0.5,
                line_damping_ratio: 0.1,
            },
            start: Start { clamp_y: 0.0 },
            spindle: Spindle {
                speed: 500.0,
                ramp_turns: 0.25,
                turns: 2.5,
            },
            traverse: Traverse {
                per_turn: 0.7e-3,
                lead: 0.0,
            },
            contact: Contact {
                stiffness: 1e10,
                restitution: 0.5,
            },
            friction: Friction {
                static_: 0.23,
                kinetic: 0.17,
                slip_speed: 10e-3,
            },
            solver: SolverSettings {
                integrator: "auto".to_owned(),
                twist: "auto".to_owned(),
                spacing_near: 0.0,
                spacing_free: 0.0,
                refine_distance: 0.0,
                step_share: 0.9,
                step: 0.0,
                tolerance: 2e-6,
                live_contact: "auto".to_owned(),
                plasticity: "auto".to_owned(),
                friction: "auto".to_owned(),
                inertia: "auto".to_owned(),
                coarse_span: "auto".to_owned(),
                coarse_settled: "auto".to_owned(),
            },
            freeze: Freeze {
                enabled: true,
                window: 1.0,
                // ten periods of the free span's slowest ringing (60 mm of 0.7 mm wire at 15 N: 1.8
                // ms)
                time: 0.02,
                creep: 2e-6,
                patience: 0.75,
                keep_length: 0.0,
                margin: 5e-3,
            },
            defects: DefectLimits {
                gap: 0.15,
                gap_fraction: 0.10,
                bulge_excess: 0.5,
                bulge_absolute: 0.0,
                overlap_axial: 0.9,
                overlap_height: 0.3,
                skip_angle: 1.2,
            },
            output: Output {
                history_interval: std::f64::consts::PI / 180.0,
                directory: String::new(),
            },
            origins: BTreeMap::new(),
        }
    }
}
