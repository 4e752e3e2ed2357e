//! From settings to a scene: every leaf in range, and no two that contradict each other.

use super::error::Warning;
use super::features::Decisions;
use super::impossible::si;
use super::material::section;
use super::{Core, Features, Integrator, LiveContact, Preset, Scene, SceneError, Solver};
use crate::rod::Section;
use crate::rod::Twist;
use crate::settings::SceneSettings;
use std::path::{Path, PathBuf};

/// Node spacing near the core that goes with a tolerance, m: 0.3 mm to 2e-6 m.
///
/// Above, steps are as the cube root of the tolerance, and both time and space are of second order.
/// A spacing as that root too keeps the shares of the error that come from either. (`fig8` at 1e-5 m
/// and 0.4 mm: nearly all was from the steps. At 2e-6 m, 500 rad/s, 0.4 mm: the mean gap of turn 2 is 0.008 d from
/// that of half the spacing, with 0.3 mm 0.002 d.)
fn spacing_for(tolerance: f64) -> f64 {
    0.3e-3 * libm::cbrt((tolerance / 2e-6).max(1.0))
}

impl SceneSettings {
    /// Checks the settings and derives the scene from them.
    ///
    /// # Errors
    /// Names the first leaf that is out of range or contradicts another.
    pub fn build(&self) -> Result<Scene, SceneError> {
        self.build_with_warnings().map(|(scene, _)| scene)
    }

    /// [`Self::build`], with warnings of values that are possible but perhaps not meant.
    ///
    /// # Errors
    ///
    /// Those of [`build`](Self::build).
    pub fn build_with_warnings(&self) -> Result<(Scene, Vec<Warning>), SceneError> {
        self.check_ranges()?;
        let mut wire = section(self)?;
        let (core, extent) = self.core()?;
        self.check_core(&wire, &extent)?;
        self.check_nozzle(&wire, &extent)?;
        self.check_wire_and_friction(&wire)?;
        let preset = match self.preset.as_str() {
            "paper" => Preset::Paper,
            _ => Preset::Default,
        };
        let integrator = match (self.solver.integrator.as_str(), preset) {
            ("rk4", _) | ("auto", Preset::Paper) => Integrator::Rk4,
            ("verlet", _) => Integrator::Verlet,
            _ => Integrator::Implicit,
        };
        let mut decisions = Decisions::default();
        self.plasticity(&mut wire, &mut decisions);
        let twist = self.twist(integrator, &wire, &mut decisions)?;
        let span = self.nozzle.distance - extent.turning_radius;
        let solver = self.solver_for(integrator, twist, (wire.diameter, span));
        self.check_spacing(&solver, &wire, &extent)?;
        let warnings = self.warnings(&solver, &wire, &core, &extent);

        let mut scene = Scene {
            name: self.name.clone(),
            preset,
            wire,
            wire_material: self.wire.material.clone(),
            core,
            nozzle: self.nozzle,
            tensioner: self.tensioner,
            start: self.start,
            spindle: self.spindle,
            traverse: self.traverse,
            contact: self.contact,
            friction: self.friction,
            solver,
            skipped: Vec::new(),
            freeze: self.freeze,
            defects: self.defects,
            output: self.output.clone(),
        };
        self.skip(&mut scene, &mut decisions)?;
        scene.skipped = decisions.0;
        Ok((scene, warnings))
    }

    fn core(&self) -> Result<(Core, Extent), SceneError> {
        let c = &self.core;
        match c.shape.as_str() {
            "cylinder" => {
                let half = 0.5 * c.length_y;
                let core = Core::Cylinder {
                    radius: c.radius,
                    length_y: c.length_y,
                };
                Ok((
                    core,
                    Extent {
                        turning_radius: c.radius,
                        y_min: -half,
                        y_max: half,
                    },
                ))
            }
            "mesh" => {
                let unit = match c.unit.as_str() {
                    "m" => 1.0,
                    "um" => 1e-6,
                    "inch" => 0.0254,
                    _ => 1e-3,
                };
                let extent = self.mesh_extent(unit)?;
                Ok((
                    Core::Mesh {
                        path: PathBuf::from(&c.file),
                        unit,
                    },
                    extent,
                ))
            }
            _ => {
                let (half_x, half_z) = (0.5 * c.width_x, 0.5 * c.height_z);
                let r = c.corner_radius;
                if r > half_x.min(half_z) {
                    return Err(self.impossible(
                        "core.corner_radius",
                        "the corner is larger than half the core's smaller side",
                        format!("0 to {} m", si(half_x.min(half_z))),
                    ));
                }
                let core = Core::RoundedBox {
                    width_x: c.width_x,
                    height_z: c.height_z,
                    length_y: c.length_y,
                    corner_radius: r,
                };
                let turning_radius = libm::hypot(half_x - r, half_z - r) + r;
                let half = 0.5 * c.length_y;
                Ok((
                    core,
                    Extent {
                        turning_radius,
                        y_min: -half,
                        y_max: half,
                    },
                ))
            }
        }
    }

    /// Reads a mesh for its extent alone; its topology is checked where it is wound on.
    fn mesh_extent(&self, unit: f64) -> Result<Extent, SceneError> {
        let problem = |reason: String| {
            self.impossible(
                "core.file",
                reason,
                "an STL file, relative to the scene file",
            )
        };
        if self.core.file.is_empty() {
            return Err(problem("core.shape = mesh needs a file".to_owned()));
        }
        let mut file = std::fs::File::open(Path::new(&self.core.file))
            .map_err(|e| problem(format!("the mesh cannot be opened ({e})")))?;
        let mesh = stl_io::read_stl(&mut file)
            .map_err(|e| problem(format!("the mesh cannot be read ({e})")))?;
        let mut extent = Extent {
            turning_radius: 0.0,
            y_min: f64::INFINITY,
            y_max: f64::NEG_INFINITY,
        };
        for vertex in &mesh.vertices {
            let [x, y, z] = vertex.0.map(|c| f64::from(c) * unit);
            if !(x.is_finite() && y.is_finite() && z.is_finite()) {
                return Err(problem(
                    "the mesh has a vertex that is not finite".to_owned(),
                ));
            }
            extent.turning_radius = extent.turning_radius.max(libm::hypot(x, z));
            extent.y_min = extent.y_min.min(y);
            extent.y_max = extent.y_max.max(y);
        }
        if mesh.faces.is_empty() || extent.turning_radius <= 0.0 || extent.y_min >= extent.y_max {
            return Err(problem("the mesh encloses nothing".to_owned()));
        }
        Ok(extent)
    }

    fn check_core(&self, wire: &Section, extent: &Extent) -> Result<(), SceneError> {
        let length = extent.y_max - extent.y_min;
        if wire.diameter > length {
            return Err(self.impossible(
                "wire.diameter",
                format!("the wire is wider than the core is long, {} m", si(length)),
                format!("at most {} m", si(length)),
            ));
        }
        let (low, high) = (extent.y_min + wire.radius(), extent.y_max - wire.radius());
        if !(low..=high).contains(&self.start.clamp_y) {
            return Err(self.impossible(
                "start.clamp_y",
                "the wire end is clamped beside the core",
                format!("{} to {} m", si(low), si(high)),
            ));
        }
        Ok(())
    }

    fn check_nozzle(&self, wire: &Section, extent: &Extent) -> Result<(), SceneError> {
        let distance = self.nozzle.distance;
        let clear = extent.turning_radius + wire.diameter;
        if distance <= clear {
            return Err(self.impossible(
                "nozzle.distance",
                format!(
                    "the nozzle is inside the circle the turning core needs, {} m and the wire",
                    si(extent.turning_radius)
                ),
                format!("more than {} m", si(clear)),
            ));
        }
        // Further out the wire would leave the core at more than 45 degrees.
        let (low, high) = (extent.y_min - distance, extent.y_max + distance);
        if !(low..=high).contains(&self.nozzle.y_start) {
            return Err(self.impossible(
                "nozzle.y_start",
                "the nozzle is farther beside the core than in front of it",
                format!("{} to {} m", si(low), si(high)),
            ));
        }
        if self.spindle.ramp_turns > self.spindle.turns {
            return Err(self.impossible(
                "spindle.ramp_turns",
                format!(
                    "the run ends after {} turns, still accelerating",
                    si(self.spindle.turns)
                ),
                format!("at most spindle.turns, {}", si(self.spindle.turns)),
            ));
        }
        Ok(())
    }

    fn check_wire_and_friction(&self, wire: &Section) -> Result<(), SceneError> {
        if self.tensioner.tension >= wire.strength {
            return Err(self.impossible(
                "tensioner.tension",
                format!("the wire breaks at {} N", si(wire.strength)),
                format!("less than {} N", si(wire.strength)),
            ));
        }
        if self.friction.kinetic > self.friction.static_ {
            let kinetic_given = self.origins.contains_key("friction.kinetic");
            let (key, allowed) = match kinetic_given {
                true => (
                    "friction.kinetic",
                    ("at most friction.static", self.friction.static_),
                ),
                false => (
                    "friction.static",
                    ("at least friction.kinetic", self.friction.kinetic),
                ),
            };
            return Err(self.impossible(
                key,
                "static friction below kinetic friction",
                format!("{}, {}", allowed.0, si(allowed.1)),
            ));
        }
        Ok(())
    }

    /// Solver settings with the spacing that suits the method where none is given.
    fn solver_for(
        &self,
        integrator: Integrator,
        twist: Twist,
        (diameter, span): (f64, f64),
    ) -> Solver {
        // the explicit step falls with the square of the finest spacing wherever it is, so a coarse
        // free span saves little there and costs a refinement front
        let s = &self.solver;
        let given = |x: f64, otherwise: f64| if x > 0.0 { x } else { otherwise };
        let implicit = integrator == Integrator::Implicit;
        let (near, refine) = if implicit {
            let near = spacing_for(s.tolerance).min(8.0 * diameter);
            (near, 3e-3)
        } else {
            (0.5e-3, 6e-3)
        };
        let spacing_near = given(s.spacing_near, near.min(given(s.spacing_free, near)));
        let mut free = if implicit { 8.0 * spacing_near } else { 1e-3 };
        while implicit && 3.0 * free > span && free > spacing_near {
            // a power of two still, since edges are halved
            free *= 0.5;
        }
        Solver {
            integrator,
            twist,
            spacing_near,
            spacing_free: given(s.spacing_free, free.max(spacing_near)),
            refine_distance: given(s.refine_distance, refine),
            step_share: s.step_share,
            step: s.step,
            tolerance: s.tolerance,
            features: Features {
                live_contact: LiveContact::Always,
                inertia: true,
                coarse_settled: false,
            },
        }
    }

    fn check_spacing(
        &self,
        solver: &Solver,
        wire: &Section,
        extent: &Extent,
    ) -> Result<(), SceneError> {
        // Below a tenth of the diameter a rod is no model of the wire any more and the explicit
        // step falls with the square; above ten diameters no turn is resolved.
        let d = wire.diameter;
        let (finest, coarsest) = (0.1 * d, 10.0 * d);
        let range = format!(
            "{} to {} m (0.1 to 10 wire diameters)",
            si(finest),
            si(coarsest)
        );
        let near = solver.spacing_near;
        if near < finest {
            return Err(self.impossible("solver.spacing_near", "too fine for a rod", range));
        }
        if near > coarsest {
            return Err(self.impossible("solver.spacing_near", "too coarse for this wire", range));
        }
        // Contact of stiffness 1e10 N/m2 that is wrong by so much pushes harder than most wire is
        // pulled.
        let most = 0.1 * d;
        if solver.tolerance > most * (1.0 + 1e-9) && solver.integrator == Integrator::Implicit {
            return Err(self.impossible(
                "solver.tolerance",
                "steps may be wrong by more than a tenth of the wire's diameter",
                format!("at most {} m", si(most)),
            ));
        }
        let span = self.nozzle.distance - extent.turning_radius;
        let free = solver.spacing_free;
        if free < near || 3.0 * free > span {
            let reason = match free < near {
                true => "the free span cannot be finer than the wire near the core",
                false => "the free span needs at least three edges",
            };
            return Err(self.impossible(
                "solver.spacing_free",
                reason,
                format!(
                    "solver.spacing_near, {} m, to {} m",
                    si(near),
                    si(span / 3.0)
                ),
            ));
        }
        Ok(())
    }

    fn warnings(
        &self,
        solver: &Solver,
        wire: &Section,
        core: &Core,
        extent: &Extent,
    ) -> Vec<Warning> {
        let mut warnings = Vec::new();
        let mut warn = |key: &'static str, message: String| {
            let (origin, value) = (self.origin(key), self.shown(key));
            warnings.push(Warning {
                origin,
                key,
                value,
                message,
            });
        };
        let beside = |y: f64| y < extent.y_min || y > extent.y_max;
        let ends = format!(
            "the core ends at {} and {} m",
            si(extent.y_min),
            si(extent.y_max)
        );
        if beside(self.nozzle.y_start) {
            warn(
                "nozzle.y_start",
                format!("the nozzle starts beside the core; {ends}"),
            );
        }
        let travel = self.traverse.lead + self.traverse.per_turn * self.spindle.turns;
        let last = self.nozzle.y_start + travel;
        if beside(last) && !beside(self.nozzle.y_start) {
            let message = format!("the nozzle ends beside the core, at {} m; {ends}", si(last));
            warn("traverse.per_turn", message);
        }
        let tension = self.tensioner.tension;
        if tension >= wire.n_y {
            let message = format!(
                "the wire yields in the free span; N_y is {} N",
                si(wire.n_y)
            );
            warn("tensioner.tension", message);
        }
        if solver.twist == Twist::Off
            && solver.integrator == Integrator::Implicit
            && wire.m_y.is_finite()
        {
            let message = "the set of wire that yields turns with its roll; without twist its bends do not come to \
                           rest, and the method adds energy where they are sharp"
                .to_owned();
            warn("solver.twist", message);
        }
        let corner = match *core {
            Core::RoundedBox { corner_radius, .. } => Some(corner_radius),
            Core::Cylinder { radius, .. } => Some(radius),
            Core::Mesh { .. } => None,
        };
        if let Some(corner) = corner {
            let bend = corner + wire.radius();
            let near = solver.spacing_near;
            if near > bend {
                let message = format!(
                    "coarser than the tightest bend of the wire, radius {} m",
                    si(bend)
                );
                warn("solver.spacing_near", message);
            }
            let depth = tension / bend / self.contact.stiffness;
            if depth > 0.01 * wire.diameter {
                let message = format!(
                    "the wire sinks about {} m into the tightest bend, more than 1 % of its \
                     diameter",
                    si(depth)
                );
                warn("contact.stiffness", message);
            }
        }
        warnings
    }
}

/// Room the core takes up.
struct Extent {
    /// largest distance from the axis, m
    turning_radius: f64,
    /// ends along the axis, m
    y_min: f64,
    y_max: f64,
}
