//! Every leaf of a scene as the user gives it: one flat set, defaults until something is set.

mod origin;
mod sections;

pub use origin::Origin;
pub use sections::{
    Contact, FlangeSettings, Freeze, Friction, Nozzle, Output, Spindle, Start, Tensioner, Traverse,
    Winding,
};

use crate::measure::DefectLimits;
use crate::signals::Inputs;
use std::collections::BTreeMap;

/// The leaves of a scene, in SI units. A rigidity, limit or length of 0 is derived when the
/// [`Scene`](crate::scene::Scene) is built; `description` in the variable table says from what.
///
/// Leaves may be written directly; [`build`](Self::build) checks all of them again.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneSettings {
    /// packed name or file stem
    pub name: String,
    /// `scene.file`: what was loaded; empty: default scene
    pub file: String,
    /// `default` or `paper`: which solver set-up
    pub preset: String,
    /// wire section, material and limits
    pub wire: WireSettings,
    /// shape and size of the core
    pub core: CoreSettings,
    /// where the wire comes from
    pub nozzle: Nozzle,
    /// pull and inertia of the tensioner
    pub tensioner: Tensioner,
    /// where the wire begins
    pub start: Start,
    /// motion of the spindle in a native run
    pub spindle: Spindle,
    /// motion of the nozzle in a native run
    pub traverse: Traverse,
    /// turns and layers that the nozzle winds in a native run
    pub winding: Winding,
    /// stiffness and damping of contact
    pub contact: Contact,
    /// coefficients of friction
    pub friction: Friction,
    /// method, spacing, steps and tolerance
    pub solver: SolverSettings,
    /// when wire at rest leaves the computation
    pub freeze: Freeze,
    /// limits of the defect flags
    pub defects: DefectLimits,
    /// what is recorded
    pub output: Output,
    /// origin of each leaf that was set, by its name
    pub(crate) origins: BTreeMap<&'static str, Origin>,
}

/// `[wire]`; 0 in a rigidity or limit: from the material.
#[derive(Clone, Debug, PartialEq)]
pub struct WireSettings {
    /// copper: section-consistent; table1: the paper's wire of 0.7 mm; custom: every rigidity given (one of `copper`, `table1`, `custom`)
    pub material: String,
    /// true: no yield, no moment cap, and no break unless wire.strength is given
    pub elastic: bool,
    /// diameter of the bare round wire, m
    pub diameter: f64,
    /// density, kg/m^3
    pub density: f64,
    /// stress at first yield, Pa; makes N_y, M_y and T_y where those are 0
    pub yield_stress: f64,
    /// stress at the end of hardening, Pa; makes strength and copper's moment cap where those are 0
    pub flow_stress: f64,
    /// stretch rigidity, N; 0: of the material
    pub ea: f64,
    /// stretch rigidity beyond yield, N; 0: of the material
    pub ea_p: f64,
    /// bending rigidity, N m^2; 0: of the material
    pub ei: f64,
    /// bending rigidity beyond yield, N m^2; 0: of the material
    pub ei_p: f64,
    /// torsional rigidity, N m^2; 0: of the material
    pub gj: f64,
    /// torsional rigidity beyond yield, N m^2; 0: of the material
    pub gj_p: f64,
    /// axial force at yield, N; 0: yield_stress times area
    pub n_y: f64,
    /// bending moment at yield, N m; 0: yield_stress d^3/6
    pub m_y: f64,
    /// torque at yield, N m; 0: yield_stress/sqrt(3) pi d^3/12
    pub t_y: f64,
    /// largest bending moment, N m; 0: flow_stress d^3/6 for copper, none for the others
    pub moment_cap: f64,
    /// tension at break, N; 0: flow_stress times area
    pub strength: f64,
}

/// `[core]`; a shape reads its own leaves only.
#[derive(Clone, Debug, PartialEq)]
pub struct CoreSettings {
    /// shape of the core (one of `rounded-box`, `cylinder`, `mesh`)
    pub shape: String,
    /// rounded box: full width along x, m
    pub width_x: f64,
    /// rounded box: full height along z, m
    pub height_z: f64,
    /// rounded box and cylinder: full length along the axis, m
    pub length_y: f64,
    /// rounded box: radius of the four long edges, m
    pub corner_radius: f64,
    /// cylinder: radius, m
    pub radius: f64,
    /// mesh: path of the STL file, already resolved against the folder of the scene file; axis along y
    pub file: String,
    /// mesh: unit of the STL file (one of `m`, `mm`, `um`, `inch`)
    pub unit: String,
    /// flanges beside a rounded box or a cylinder
    pub flange: FlangeSettings,
}

/// `[solver]`.
#[derive(Clone, Debug, PartialEq)]
pub struct SolverSettings {
    /// time integrator; auto: rk4 for preset paper, else implicit (one of `auto`, `implicit`, `rk4`, `verlet`)
    pub integrator: String,
    /// how the wire's twist is carried; auto: the least that matters; dynamic with the explicit methods (one of `auto`, `off`, `quasi-static`, `dynamic`)
    pub twist: String,
    /// node spacing near the core, m; 0: 0.5 mm explicit, implicit 0.3 mm to a tolerance of 2 um and beyond as its cube root
    pub spacing_near: f64,
    /// node spacing in the free span, m; 0: 1 mm explicit, eight times that near the core implicit
    pub spacing_free: f64,
    /// distance from the core or the layer below at which free-span edges are split, m; 0: 3 mm implicit, 6 mm explicit
    pub refine_distance: f64,
    /// time step as a share of the stability limit
    pub step_share: f64,
    /// fixed time step, s; 0: from the error (implicit) or the stability limit
    pub step: f64,
    /// estimated error that a step of the implicit method may have, root mean square over the wire, m
    pub tolerance: f64,
    /// contact of live wire with live wire; auto: from half a live turn on (one of `auto`, `on`, `off`)
    pub live_contact: String,
    /// plastic state of the wire; auto: where it can yield; off: elastic wire (one of `auto`, `on`, `off`)
    pub plasticity: String,
    /// friction; auto: where a coefficient is not 0 (one of `auto`, `on`, `off`)
    pub friction: String,
    /// mass of the wire; auto: on; off: the wire goes through states of rest (one of `auto`, `on`, `off`)
    pub inertia: String,
    /// coarser spacing in the free span; auto: where solver.spacing_free is more than solver.spacing_near (one of `auto`, `on`, `off`)
    pub coarse_span: String,
    /// coarser spacing of settled live wire; auto: with the implicit method (one of `auto`, `on`, `off`)
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
                flange: FlangeSettings {
                    inner_distance: 0.0,
                    height: 3e-3,
                    thickness: 1e-3,
                    edge_radius: 0.0,
                },
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
                turns: 0.0,
            },
            traverse: Traverse {
                mode: "by-angle".to_owned(),
                per_turn: 0.7e-3,
                lead: 0.0,
                crossover: 0.25 * std::f64::consts::PI,
                advance: 0.0,
                dwell_turns: 0.5,
                file: String::new(),
            },
            winding: Winding {
                turns_per_layer: 0.0,
                layers: 1.0,
                direction: "+y".to_owned(),
                pitch: 0.0,
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
                double_turn: 0.5,
                skipped_groove: 0.25,
                jump: 0.5,
                loose_height: 0.1,
                loose_fraction: 0.5,
                loose_tension: 0.5,
                stretch: 0.02,
            },
            output: Output {
                history_interval: std::f64::consts::PI / 180.0,
                directory: String::new(),
            },
            origins: BTreeMap::new(),
        }
    }
}
