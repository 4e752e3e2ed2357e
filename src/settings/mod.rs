//! Every leaf of a scene as the user gives it: one flat set, defaults until something is set.

mod origin;
mod sections;

pub use origin::Origin;
pub use sections::{
    Contact, FlangeSettings, Freeze, Friction, Nozzle, Output, Spindle, Start, Tensioner, Traverse,
    Winding,
};

use crate::math::scaled;
use crate::measure::DefectLimits;
use crate::rod::{ENAMEL_DENSITY, Material};
use crate::signals::Inputs;
use std::collections::BTreeMap;

/// Choice of `traverse.mode` in which the nozzle follows its input.
pub const BY_INPUT: &str = "by-input";

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
    /// copper: section-consistent; table1: the paper's wire of 0.7 mm; custom: every rigidity given; the others: metals of the library (one of `copper`, `table1`, `custom`, `copper-soft`, `copper-half-hard`, `copper-hard`, `aluminium`)
    pub material: String,
    /// true: no yield, no moment cap, and no break unless wire.strength is given
    pub elastic: bool,
    /// diameter of the bare round wire, m: stiffness, yield, mass of the metal and resistance go with it
    pub diameter: f64,
    /// outer diameter over the enamel, m: contact, gaps, heights and pitch go with it; 0: bare wire
    pub enamelled_diameter: f64,
    /// density of the enamel, kg/m^3
    pub enamel_density: f64,
    /// density of the metal, kg/m^3; 0: of the material
    pub density: f64,
    /// stress at first yield, Pa; makes N_y, M_y and T_y where those are 0; 0: of the material
    pub yield_stress: f64,
    /// stress at the end of hardening, Pa; makes strength and moment cap where those are 0; 0: of the material
    pub flow_stress: f64,
    /// resistivity at 20 degC, ohm m; 0: of the material
    pub resistivity: f64,
    /// points `[[strain, stress in Pa], ...]` of the metal's stress-strain curve from yield on; empty: of the material
    pub stress_strain: String,
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
    /// axial force at yield, N; 0: of the material
    pub n_y: f64,
    /// bending moment at yield, N m; 0: of the material
    pub m_y: f64,
    /// torque at yield, N m; 0: of the material
    pub t_y: f64,
    /// largest bending moment, N m; 0: flow_stress d^3/6, none for table1 and custom
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
    /// rounded box and cylinder: thickness of the insulation round the core, m
    pub insulation: f64,
    /// height over the insulated core that the coil may take, m; 0: to the rim of the flanges
    pub window_height: f64,
    /// angle of the limit line at that height to the axis, rad; it rises towards +y
    pub window_taper: f64,
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
    /// node spacing near the core, m; 0: 0.5 mm explicit, implicit 0.3 mm for wire of 0.7 mm and in proportion to its diameter
    ///
    /// The implicit one is coarser as the cube root of a tolerance above its own. It is halved until it resolves how
    /// the core's corners bend the wire under its tension.
    pub spacing_near: f64,
    /// node spacing in the free span, m; 0: 1 mm explicit, eight times that near the core implicit
    pub spacing_free: f64,
    /// distance from the core or the layer below at which free-span edges are split, m; 0: 3 mm implicit, 6 mm explicit
    pub refine_distance: f64,
    /// time step as a share of the stability limit
    pub step_share: f64,
    /// fixed time step, s; 0: from the error (implicit) or the stability limit
    pub step: f64,
    /// estimated error that a step of the implicit method may have, root mean square over the wire, m; 0: [`Self::tolerance_for`]
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
    /// steps that reach beyond a communication point while inputs go on as they did; auto: where the method finds its own steps; on: beyond rows of a run of the scene's own motion too (one of `auto`, `on`, `off`)
    pub steps_beyond: String,
}

impl SolverSettings {
    /// The error, m, that a step may have with wire of this outer diameter, m.
    pub fn tolerance_for(&self, diameter: f64) -> f64 {
        if self.tolerance > 0.0 {
            self.tolerance
        } else {
            scaled(2e-6, diameter)
        }
    }
}

impl WireSettings {
    /// Diameter over the enamel, m; of bare wire its own.
    pub fn outer_diameter(&self) -> f64 {
        self.enamelled_diameter.max(self.diameter)
    }

    /// The metal: what was given, else of the material. Points of a stress-strain curve are not among it.
    pub(crate) fn metal(&self) -> Material {
        let of = Material::named(&self.material);
        let or = |given: f64, known: f64| if given > 0.0 { given } else { known };
        Material {
            density: or(self.density, of.density),
            yield_stress: or(self.yield_stress, of.yield_stress),
            flow_stress: or(self.flow_stress, of.flow_stress),
            resistivity: or(self.resistivity, of.resistivity),
            ..of
        }
    }
}

/// What the nozzle of a run follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NozzleFollows {
    /// the scene's own law of the core's angle, in a run of the scene's own motion
    Law,
    /// that law, in a run whose inputs turn the core as far as they like
    LawByInputs,
    /// the input `nozzle_position`
    Input,
}

impl NozzleFollows {
    /// Whether it is the scene's own law.
    pub fn is_law(self) -> bool {
        self != Self::Input
    }
}

impl SceneSettings {
    /// Inputs before the first step: core at rest, nozzle where the motion profile starts, set
    /// tension.
    pub fn start_inputs(&self) -> Inputs {
        Inputs {
            spindle_speed: 0.0,
            nozzle_position: self.nozzle.y_start + self.traverse.lead,
            tension_setpoint: self.tensioner.tension,
            ..Inputs::HELD
        }
    }

    /// Paths of the files that the scene names beside its own: core, traverse, spindle; empty where it names none.
    pub fn files(&self) -> [&String; 3] {
        [&self.core.file, &self.traverse.file, &self.spindle.file]
    }

    /// The same, to change them.
    pub fn files_mut(&mut self) -> [&mut String; 3] {
        [
            &mut self.core.file,
            &mut self.traverse.file,
            &mut self.spindle.file,
        ]
    }

    /// Whether the nozzle of a run that is driven by inputs follows the law of `traverse.mode`: where that was set by
    /// name. A scene file's mode is for runs of its own motion.
    pub fn nozzle_follows_law(&self) -> bool {
        self.traverse.mode != BY_INPUT && self.origin("traverse.mode") == Origin::Set
    }

    /// What the nozzle of a run follows that is driven by inputs.
    pub fn nozzle_follows(&self) -> NozzleFollows {
        match self.nozzle_follows_law() {
            true => NozzleFollows::LawByInputs,
            false => NozzleFollows::Input,
        }
    }

    /// Where the value of a leaf came from, by the name of its variable.
    pub fn origin(&self, name: &str) -> Origin {
        self.origins.get(name).cloned().unwrap_or_default()
    }

    /// The same for a message, which names the scene also where that leaves the leaf out.
    pub(crate) fn told_origin(&self, name: &str) -> Origin {
        match self.origin(name) {
            Origin::Default if !self.file.is_empty() => Origin::LeftOut {
                file: self.file.as_str().into(),
            },
            origin => origin,
        }
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
                enamelled_diameter: 0.0,
                enamel_density: ENAMEL_DENSITY,
                density: 0.0,
                yield_stress: 0.0,
                flow_stress: 0.0,
                resistivity: 0.0,
                stress_strain: String::new(),
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
                insulation: 0.0,
                window_height: 0.0,
                window_taper: 0.0,
                flange: FlangeSettings {
                    inner_distance: 0.0,
                    insulation: 0.0,
                    height: 3e-3,
                    thickness: 1e-3,
                    edge_radius: 0.0,
                },
            },
            nozzle: Nozzle {
                distance: 60e-3,
                y_start: 0.0,
                exit_friction: 0.0,
                position_at_start: false,
                outer_diameter: 0.0,
                length: 0.0,
                edge_radius: 0.0,
                bore: 0.0,
                exit_radius: 0.0,
            },
            tensioner: Tensioner {
                tension: 15.0,
                mass: 1e-3,
                line_length: 0.5,
                line_damping_ratio: 0.1,
                damping: 0.0,
                radius: 50e-3,
                brake_torque_max: 0.0,
                line_inertia: false,
                pulley_mass: 0.0,
                pulley_friction: 0.0,
                pulley_place: 0.5,
            },
            start: Start { clamp_y: 0.0 },
            spindle: Spindle {
                speed: 500.0,
                direction: "auto".to_owned(),
                ramp_turns: 0.25,
                turns: 0.0,
                file: String::new(),
                repeat_turns: 0.0,
                flange_share: 1.0,
                flange_turns: 1.0,
            },
            traverse: Traverse {
                mode: "by-angle".to_owned(),
                per_turn: 0.7e-3,
                lead: 0.0,
                crossover: 0.25 * std::f64::consts::PI,
                crossover_delay: 0.0,
                trail: "free".to_owned(),
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
                tolerance: 0.0,
                live_contact: "auto".to_owned(),
                plasticity: "auto".to_owned(),
                friction: "auto".to_owned(),
                inertia: "auto".to_owned(),
                coarse_span: "auto".to_owned(),
                coarse_settled: "auto".to_owned(),
                steps_beyond: "auto".to_owned(),
            },
            freeze: Freeze {
                enabled: true,
                window: 1.0,
                time: 0.0,
                creep: 0.0,
                patience: 0.75,
                keep_length: 0.0,
                margin: 0.0,
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
