//! From settings to a scene: every leaf in range, and no two that contradict each other.

use super::clamp_places::clamp_places;
use super::error::Warning;
use super::extent::{Extent, between_turns};
use super::features::Decisions;
use super::impossible::si;
use super::material::{Wire, section};
use super::problems::Problems;
use super::spacing::{coarsest_on, halved, spacing_for};
use super::{
    Core, Features, Flange, Integrator, LiveContact, Preset, Scene, SceneError, Solver, Window,
};
use crate::geometry::stl::{self, StlError};
use crate::geometry::{Crossing, Room, Surface, TriMesh};
use crate::math::{V3, scaled};
use crate::rod::Twist;
use crate::settings::{BY_INPUT, NozzleFollows, Origin, SceneSettings, Spindle};
use std::path::{Path, PathBuf};

/// How far beside the clamp the core is looked at too, diameters. Chosen: far above the rounding of an STL file's numbers.
const ASIDE: f64 = 1e-3;

impl SceneSettings {
    /// Checks the settings and derives the scene from them.
    ///
    /// # Errors
    /// Names every leaf that is out of range; where there is none, every leaf that contradicts another.
    pub fn build(&self) -> Result<Scene, SceneError> {
        self.build_with_warnings().map(|(scene, _)| scene)
    }

    /// [`Self::build`], with warnings of values that are possible but perhaps not meant.
    ///
    /// # Errors
    ///
    /// Those of [`build`](Self::build).
    pub fn build_with_warnings(&self) -> Result<(Scene, Vec<Warning>), SceneError> {
        self.build_for(NozzleFollows::Law)
    }

    /// The same for a run whose nozzle follows that.
    ///
    /// # Errors
    ///
    /// Those of [`build`](Self::build). Where the scene's own law would send the nozzle is no error where it follows an input.
    pub fn build_for(&self, follows: NozzleFollows) -> Result<(Scene, Vec<Warning>), SceneError> {
        self.check_ranges()?;
        let built = self.build_in_range(follows);
        let Err(error) = built else {
            return built;
        };
        let mut problems = Problems::default();
        if let Some(error) = self.file_of_no_mesh() {
            problems.add(error);
        }
        problems.add(error);
        problems.finish_with(None)
    }

    fn build_in_range(&self, follows: NozzleFollows) -> Result<(Scene, Vec<Warning>), SceneError> {
        let mut problems = Problems::default();
        let wire = problems.note(section(self));
        let core = self.core(&mut problems);
        let core = problems.note(core);
        let placed = core.as_ref().and_then(|(_, extent)| self.placed(extent));
        let settings = placed.as_ref().unwrap_or(self);
        let mut plan = Problems::default();
        if !follows.is_law()
            && let Some((_, extent)) = &core
        {
            let (section, way) = (wire.as_ref().map(|w| &w.section), &mut Problems::default());
            settings.nozzle_law(section, extent, (&mut plan, way), follows);
        }
        if plan.is_empty() {
            return settings.build_on(core, wire, (problems, follows));
        }
        let mut unplanned = settings.clone();
        BY_INPUT.clone_into(&mut unplanned.traverse.mode);
        let (scene, mut warnings) = unplanned.build_on(core, wire, (problems, follows))?;
        warnings.extend(
            plan.as_warnings("no layers are planned, since the nozzle follows its input and"),
        );
        Ok((scene, warnings))
    }

    /// The scene with this core and wire, where there are any.
    fn build_on(
        &self,
        core: Option<(Core, Extent)>,
        wire: Option<Wire>,
        (mut problems, follows): (Problems, NozzleFollows),
    ) -> Result<(Scene, Vec<Warning>), SceneError> {
        let (laws, resistivity) = wire
            .as_ref()
            .map_or((None, 0.0), |wire| (wire.laws, wire.resistivity));
        let wire = wire.map(|wire| wire.section);
        self.check_counts(&mut problems);
        let mut way = Problems::default();
        let law = core.as_ref().and_then(|(_, extent)| {
            let section = wire.as_ref();
            self.nozzle_law(section, extent, (&mut problems, &mut way), follows)
        });
        if follows.is_law() {
            problems.append(way);
        }
        self.check_output(&mut problems);
        self.check_motion_and_friction(law.as_ref(), &mut problems);
        let diameter = self.wire.outer_diameter();
        if let Some((_, extent)) = &core {
            self.check_core(diameter, extent, &mut problems);
            self.check_nozzle(diameter, extent, &mut problems);
        }
        if let Some(wire) = &wire {
            self.check_strength(wire, &mut problems);
        }
        let preset = match self.preset.as_str() {
            "paper" => Preset::Paper,
            _ => Preset::Default,
        };
        let integrator = match (self.solver.integrator.as_str(), preset) {
            ("rk4", _) | ("auto", Preset::Paper) => Integrator::Rk4,
            ("verlet", _) => Integrator::Verlet,
            _ => Integrator::Implicit,
        };
        self.check_line(integrator, &mut problems);
        self.check_nozzle_body(diameter, integrator, &mut problems);
        let speed_law = match &law {
            Some(law) => self.speed_law(law, &mut problems),
            None => {
                self.check_tables(&mut problems);
                None
            }
        };
        let laws_of_motion = law.zip(speed_law);
        let Some(((mut wire, (core, extent)), (nozzle_law, speed_law))) =
            wire.zip(core).zip(laws_of_motion)
        else {
            return problems.finish_with(None);
        };
        let mut decisions = Decisions::default();
        self.plasticity(&mut wire, &mut decisions);
        let twist = problems.note(self.twist(integrator, &wire, &mut decisions));
        let twist = twist.unwrap_or(Twist::Off);
        let span = self.nozzle.distance - extent.turning_radius;
        let coarsest = coarsest_on(&core, &wire, self.tensioner.tension);
        let cylinder = match core {
            Core::Cylinder { radius, .. } => radius,
            _ => 0.0,
        };
        let round = (coarsest, cylinder);
        let solver = self.solver_for(integrator, twist, (wire.diameter, span), round);
        self.check_spacing(&solver, &wire, &extent, &mut problems);
        self.check_stiffness(&core, &wire, &mut problems);
        let window = self.window(extent.window, &mut problems);
        let mut warnings = self.warnings(
            &solver,
            &wire,
            &core,
            (&extent, window),
            (&nozzle_law, follows),
        );
        warnings.extend(laws.and_then(|laws| self.rough_laws(&laws)));
        warnings.extend(self.soft_curve(&wire));
        warnings.extend(self.yielding_exit(&wire, &extent));

        let mut scene = Scene {
            name: self.name.clone(),
            preset,
            wire,
            wire_material: self.wire.material.clone(),
            wire_laws: laws,
            resistivity,
            core,
            window,
            nozzle: self.nozzle,
            tensioner: self.tensioner,
            tension_given: matches!(
                self.origin("tensioner.tension"),
                Origin::File { .. } | Origin::Set
            ),
            start: self.start,
            spindle: Spindle {
                speed: self.spindle.speed * self.spindle.sense_from(0.0),
                turns: match self.spindle.turns {
                    0.0 => nozzle_law.turns(),
                    turns => turns,
                },
                ..self.spindle.clone()
            },
            speed_law,
            traverse: self.traverse.clone(),
            winding: self.winding.clone(),
            nozzle_law,
            contact: self.contact,
            friction: self.friction,
            solver,
            skipped: Vec::new(),
            freeze: self.freeze,
            defects: self.defects,
            output: self.output.clone(),
        };
        problems.note(self.skip(&mut scene, &mut decisions));
        problems.finish()?;
        scene.skipped = decisions.0;
        Ok((scene, warnings))
    }

    /// The flanges, where there are any.
    fn flange(&self, problems: &mut Problems) -> Option<Flange> {
        let f = self.core.flange;
        if f.inner_distance == 0.0 {
            return None;
        }
        // Insulation stands on the core and on the inner faces; rim and outer faces stay where they are.
        let on_core = match self.core.shape.as_str() {
            "mesh" => 0.0,
            _ => self.core.insulation,
        };
        let (under, beside) = (on_core, f.insulation);
        if under >= f.height {
            let reason = "the insulation of the core reaches the rim of the flanges";
            let allowed = format!("less than {} m", si(f.height));
            problems.add(self.impossible("core.insulation", reason, allowed));
        }
        let height = match under < f.height {
            true => f.height - under,
            false => f.height,
        };
        let most = (0.5 * f.thickness).min(height);
        if f.edge_radius > most {
            problems.add(self.impossible(
                "core.flange.edge_radius",
                "the edges need more than the flange's height or half its thickness",
                format!("0 to {} m", si(most)),
            ));
        }
        let wire = self.wire.outer_diameter();
        if between_turns(f.inner_distance - 2.0 * beside, wire).is_none() {
            let reason = match beside > 0.0 {
                true => "the wire is wider than the insulated flanges are apart",
                false => "the wire is wider than the flanges are apart",
            };
            problems.add(self.impossible(
                "core.flange.inner_distance",
                reason,
                format!(
                    "at least {} m, or 0 for no flanges",
                    si(wire + 2.0 * beside)
                ),
            ));
        }
        Some(Flange {
            inner_distance: f.inner_distance - 2.0 * beside,
            height,
            thickness: f.thickness + beside,
            edge_radius: f.edge_radius.min(most),
        })
    }

    /// The room that the coil may take, where the scene says it.
    fn window(&self, room: Option<Room>, problems: &mut Problems) -> Option<Window> {
        let c = &self.core;
        let window = Window {
            faces: room.map(|room| room.faces),
            height: match c.window_height {
                0.0 => room?.height,
                height => height,
            },
            taper: c.window_taper,
        };
        let (height, lowest) = (window.height, window.lowest());
        if lowest <= 0.0 {
            let reason = "the limit line meets the core between the flanges";
            let least = format!(
                "more than {} m, or a smaller core.window_taper",
                si(height - lowest)
            );
            problems.add(self.impossible("core.window_height", reason, least));
        }
        Some(window)
    }

    fn core(&self, problems: &mut Problems) -> Result<(Core, Extent), SceneError> {
        let c = &self.core;
        match c.shape.as_str() {
            "cylinder" => {
                let half = 0.5 * c.length_y;
                let flange = self.flange(problems);
                let radius = c.radius + c.insulation;
                let core = Core::Cylinder {
                    radius,
                    length_y: c.length_y,
                    flange,
                };
                Ok((core, Extent::of(radius, half, flange)))
            }
            "mesh" => {
                let unit = match c.unit.as_str() {
                    "m" => 1.0,
                    "um" => 1e-6,
                    "inch" => 0.0254,
                    _ => 1e-3,
                };
                let flange = self.flange(problems);
                let extent = self.mesh_extent(unit)?;
                let reach = extent.y_max.min(-extent.y_min);
                if let Some(f) = flange.filter(|f| 0.5 * f.inner_distance > reach) {
                    let (half, [low, high]) =
                        (0.5 * f.inner_distance, [extent.y_min, extent.y_max]);
                    let reason = format!(
                        "the mesh ends before the flanges, which stand at y = -{0} and {0} m: it reaches from {1} to {2} m",
                        si(half),
                        si(low),
                        si(high)
                    );
                    let allowed = match 2.0 * half <= high - low {
                        true => "a mesh with its middle at y = 0, or 0 for no flanges".to_owned(),
                        false => format!(
                            "at most {} m, or 0 for no flanges; or the core.unit in which the mesh was written",
                            si((2.0 * reach).max(0.0))
                        ),
                    };
                    problems.add(self.impossible("core.flange.inner_distance", reason, allowed));
                }
                let wire = self.wire.outer_diameter();
                if let Some(room) = extent.window
                    && between_turns(room.widest[1] - room.widest[0], wire).is_none()
                {
                    problems.add(self.impossible(
                        "wire.diameter",
                        "the wire is wider than the flanges of core.file are apart",
                        format!("at most {} m", si(room.widest[1] - room.widest[0])),
                    ));
                }
                let core = Core::Mesh {
                    path: PathBuf::from(&c.file),
                    unit,
                    flange,
                };
                Ok((core, extent.with(flange)))
            }
            _ => {
                let (half_x, half_z) = (0.5 * c.width_x, 0.5 * c.height_z);
                let r = c.corner_radius.min(half_x.min(half_z));
                if c.corner_radius > r {
                    problems.add(self.corner_too_large(r));
                }
                let flange = self.flange(problems);
                // An even layer all round makes every corner rounder by its thickness.
                let t = c.insulation;
                let core = Core::RoundedBox {
                    width_x: c.width_x + 2.0 * t,
                    height_z: c.height_z + 2.0 * t,
                    length_y: c.length_y,
                    corner_radius: r + t,
                    flange,
                };
                let turning_radius = libm::hypot(half_x - r, half_z - r) + (r + t);
                let half = 0.5 * c.length_y;
                Ok((core, Extent::of(turning_radius, half, flange)))
            }
        }
    }

    /// Reads a mesh as the run will, and measures it.
    fn mesh_extent(&self, unit: f64) -> Result<Extent, SceneError> {
        let problem = |reason: String, allowed: &str| self.impossible("core.file", reason, allowed);
        let a_file = "an STL file, relative to the scene file";
        if self.core.file.is_empty() {
            return Err(problem("core.shape = mesh needs a file".to_owned(), a_file));
        }
        let mut file = std::fs::File::open(Path::new(&self.core.file))
            .map_err(|e| problem(format!("the mesh cannot be opened ({e})"), a_file))?;
        let mesh = stl::read(&mut file, unit).map_err(|error| match error {
            StlError::Mesh(error) => problem(
                error.to_string(),
                "a closed surface whose triangles run counter-clockwise as seen from outside",
            ),
            error => problem(format!("the mesh cannot be read ({error})"), a_file),
        })?;
        let mut extent = Extent {
            turning_radius: 0.0,
            winding_radius: 0.0,
            y_min: f64::INFINITY,
            y_max: f64::NEG_INFINITY,
            window: None,
            clamp_places: Vec::new(),
            in_the_way: None,
            flanged_about: None,
            crossing: Crossing::None,
        };
        for vertex in &mesh.vertices {
            extent.turning_radius = extent.turning_radius.max(libm::hypot(vertex.x, vertex.z));
            extent.y_min = extent.y_min.min(vertex.y);
            extent.y_max = extent.y_max.max(vertex.y);
        }
        self.check_axis(&mesh, [extent.y_min, extent.y_max])?;
        // Wire that is no wider than they are high lies between flanges; what is lower are ribs.
        let (clamp, wire) = (self.start.clamp_y, self.wire.outer_diameter());
        if self.core.flange.inner_distance == 0.0 {
            extent.window = mesh.room(clamp, wire);
            let has_to_have = self.winds_layers() && self.winding.turns_per_layer == 0.0;
            if extent.window.is_none() && has_to_have {
                extent.flanged_about = mesh.flanged_about(wire);
            }
        }
        extent.winding_radius = extent
            .window
            .map_or(extent.turning_radius, |room| room.radius);
        extent.in_the_way = mesh.in_the_way(clamp, wire);
        let surface = Surface::new(mesh);
        extent.crossing = surface.crossing();
        if let Some(room) = extent.window {
            extent.clamp_places = clamp_places(&surface, room, 0.5 * wire);
        }
        Ok(extent)
    }

    /// Refuses a core with these ends (m) that does not surround its axis where the wire is clamped: nothing would draw the wire in.
    fn check_axis(&self, mesh: &TriMesh, [low, high]: [f64; 2]) -> Result<(), SceneError> {
        let (clamp, wire) = (self.start.clamp_y, self.wire.outer_diameter());
        // (a clamp beside the core is told by itself)
        let beside = !(low..=high).contains(&clamp);
        // a step in the core has no section right at it; farther aside, a flange that the wire touches would do for the core
        let sections = [0.0, -ASIDE, ASIDE].map(|aside| clamp + aside * wire);
        if beside || sections.iter().any(|&y| mesh.section(y).is_some()) {
            return Ok(());
        }
        let points = mesh.section_points(clamp);
        let range = |along: fn(&V3) -> f64| {
            let values = || points.iter().map(along);
            let (least, most) = (values().reduce(f64::min), values().reduce(f64::max));
            Some(format!("{} to {} m", si(least?), si(most?)))
        };
        let place = match range(|p| p.x).zip(range(|p| p.z)) {
            Some((x, z)) => format!("lies beside its axis, at x = {x}, z = {z},"),
            None => "has a gap".to_owned(),
        };
        let reason = format!(
            "the core {place} where start.clamp_y = {} m clamps the wire",
            si(clamp)
        );
        let allowed = "a core that surrounds its axis there; move the mesh so that its axis is y";
        Err(self.impossible("core.file", reason, allowed))
    }

    /// Solver settings with the spacing that suits the method where none is given.
    fn solver_for(
        &self,
        integrator: Integrator,
        twist: Twist,
        (diameter, span): (f64, f64),
        (coarsest, cylinder): (f64, f64),
    ) -> Solver {
        // the explicit step falls with the square of the finest spacing wherever it is, so a coarse
        // free span saves little there and costs a refinement front
        let s = &self.solver;
        let given = |x: f64, otherwise: f64| if x > 0.0 { x } else { otherwise };
        let implicit = integrator.is_implicit();
        let (near, refine) = if implicit {
            let near =
                spacing_for(s.tolerance_for(diameter), diameter, cylinder).min(8.0 * diameter);
            (near, scaled(3e-3, diameter))
        } else {
            (scaled(0.5e-3, diameter), scaled(6e-3, diameter))
        };
        let halvings = match implicit {
            true => halved(near, coarsest, diameter),
            false => 1.0,
        };
        let near = near / halvings;
        let spacing_near = given(s.spacing_near, near.min(given(s.spacing_free, near)));
        let free_over_near = match s.spacing_near > 0.0 {
            true => 8.0,
            false => 8.0 * halvings,
        };
        let mut free = match implicit {
            true => free_over_near * spacing_near,
            false => scaled(1e-3, diameter),
        };
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
            tolerance: s.tolerance_for(diameter),
            features: Features {
                live_contact: LiveContact::Always,
                inertia: true,
                coarse_settled: false,
                steps_beyond: false,
                rows_between: false,
            },
        }
    }
}
