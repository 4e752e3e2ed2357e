//! Leaves that contradict each other, each told with the leaf to change.

use super::extent::{Extent, ROUNDING, between_turns};
use super::impossible::{si, si_down, si_up};
use super::problems::Problems;
use super::spacing::{COARSEST, FINEST};
use super::{Core, Integrator, NozzleLaw, SceneError, Solver};
use crate::rod::Section;
use crate::settings::SceneSettings;

impl SceneSettings {
    /// The first of these leaves that somebody gave, else the first: the one to blame.
    fn given(&self, keys: &[&'static str]) -> &'static str {
        let given = keys.iter().find(|key| self.origins.contains_key(*key));
        given.unwrap_or(&keys[0])
    }

    /// The corners do not fit on a core of this smaller half side, m.
    pub(super) fn corner_too_large(&self, half: f64) -> SceneError {
        let c = &self.core;
        let smaller = if c.width_x < c.height_z {
            "core.width_x"
        } else {
            "core.height_z"
        };
        match self.given(&["core.corner_radius", smaller]) {
            "core.corner_radius" => self.impossible(
                "core.corner_radius",
                "the corner is larger than half the core's smaller side",
                format!("0 to {} m", si(half)),
            ),
            side => self.impossible(
                side,
                format!(
                    "two corners of core.corner_radius = {} m do not fit",
                    si(c.corner_radius)
                ),
                format!(
                    "at least {} m, or a smaller core.corner_radius",
                    si(2.0 * c.corner_radius)
                ),
            ),
        }
    }

    /// Paths are taken as they are: what a shell or an importer might mean by these would become folders of such names.
    pub(super) fn check_output(&self, problems: &mut Problems) {
        let directory = &self.output.directory;
        if directory == "~" || directory.starts_with("~/") || directory.contains("://") {
            problems.add(self.impossible(
                "output.directory",
                "~ and addresses are not looked up",
                "the path of a folder, from / on or from the current folder",
            ));
        }
    }

    pub(super) fn check_core(&self, diameter: f64, extent: &Extent, problems: &mut Problems) {
        let length = extent.y_max - extent.y_min;
        if diameter > length {
            let reason = "the wire is wider than the core is long";
            let blamed = match self.core.shape.as_str() {
                "mesh" => "core.unit",
                _ => self.given(&["wire.diameter", "core.length_y"]),
            };
            problems.add(match blamed {
                "core.unit" => self.impossible(
                    blamed,
                    format!(
                        "core.file is then {} m long along y, and the wire {} m wide",
                        si(length),
                        si(diameter)
                    ),
                    "the unit in which the file was written, m for instance, or thinner wire",
                ),
                "core.length_y" => {
                    self.impossible(blamed, reason, format!("at least {} m", si(diameter)))
                }
                _ => self.impossible(blamed, reason, format!("at most {} m", si(length))),
            });
            return;
        }
        let (mut low, mut high) = (extent.y_min, extent.y_max);
        if let Some(room) = extent.window {
            [low, high] = room.widest;
        }
        let rounding = ROUNDING * length;
        // (between flanges that leave the wire no room no place would do: their distance has been refused)
        let has_room = between_turns(high - low, diameter).is_some();
        let all = [low + 0.5 * diameter, high - 0.5 * diameter];
        let clamp = self.start.clamp_y;
        // (how far it is beside a stretch)
        let beside = |[low, high]: &[f64; 2]| (low - clamp).max(clamp - high);
        let places = extent.clamp_places.iter();
        let nearest = places.min_by(|a, b| beside(a).total_cmp(&beside(b)));
        let [low, high] = *nearest.unwrap_or(&all);
        if has_room && beside(&[low, high]) > rounding {
            problems.add(self.impossible(
                "start.clamp_y",
                match extent.window {
                    Some(_) if beside(&all) <= rounding => {
                        "the wire end is clamped in what stands on the core there, or on the rim of a flange"
                    }
                    Some(_) => "the wire end is clamped in a flange",
                    None => "the wire end is clamped beside the core",
                },
                format!("{} to {} m", si_up(low), si_down(high)),
            ));
        }
    }

    pub(super) fn check_nozzle(&self, diameter: f64, extent: &Extent, problems: &mut Problems) {
        let distance = self.nozzle.distance;
        let clear = extent.turning_radius + diameter;
        if distance <= clear {
            let with_flanges = extent.turning_radius > extent.winding_radius;
            let of_the_scene = self.core.flange.inner_distance != 0.0;
            let (who, or) = match (with_flanges, of_the_scene) {
                (true, true) => ("flanges need", ", or a lower core.flange.height"),
                (true, false) => (
                    "flanges need",
                    ", or a core.file with lower flanges, or the core.unit in which it was written",
                ),
                (false, _) if self.core.shape == "mesh" => (
                    "core needs",
                    ", or the core.unit in which core.file was written",
                ),
                (false, _) => ("core needs", ""),
            };
            problems.add(self.impossible(
                "nozzle.distance",
                format!(
                    "the nozzle is inside the circle the turning {who}, {} m and the wire",
                    si(extent.turning_radius)
                ),
                format!("more than {} m{or}", si(clear)),
            ));
        }
        // Further out the wire would leave the core at more than 45 degrees.
        let (low, high) = (extent.y_min - distance, extent.y_max + distance);
        if !(low..=high).contains(&self.nozzle.y_start) {
            problems.add(self.impossible(
                "nozzle.y_start",
                "the nozzle is farther beside the core than in front of it",
                format!("{} to {} m", si(low), si(high)),
            ));
        }
    }

    pub(super) fn check_strength(&self, wire: &Section, problems: &mut Problems) {
        if self.tensioner.tension >= wire.strength {
            problems.add(self.impossible(
                "tensioner.tension",
                format!("the wire breaks at {} N", si(wire.strength)),
                format!("less than {} N", si(wire.strength)),
            ));
        }
    }

    /// What guides the line, or has mass in it, needs a line with a mass at its end and the method that solves for them.
    pub(super) fn check_line(&self, integrator: Integrator, problems: &mut Problems) {
        let t = &self.tensioner;
        let keys = [
            ("tensioner.line_inertia", t.line_inertia),
            ("tensioner.pulley_mass", t.pulley_mass > 0.0),
            ("tensioner.pulley_friction", t.pulley_friction > 0.0),
        ];
        for (key, _) in keys.into_iter().filter(|(_, there)| *there) {
            let lacking = if !integrator.is_implicit() {
                "the explicit methods have nothing between tensioner and nozzle"
            } else if t.mass == 0.0 {
                "without tensioner.mass the pull acts at the nozzle"
            } else if t.line_length == 0.0 {
                "without tensioner.line_length the tensioner is at the nozzle"
            } else {
                continue;
            };
            let off = if key == "tensioner.line_inertia" {
                "false"
            } else {
                "0"
            };
            problems.add(self.impossible(key, lacking, off));
        }
    }

    pub(super) fn check_motion_and_friction(
        &self,
        law: Option<&NozzleLaw>,
        problems: &mut Problems,
    ) {
        let ramp = self.spindle.ramp_turns;
        let turns = law.map_or(self.spindle.turns, NozzleLaw::turns);
        if ramp > turns && turns > 0.0 {
            let reason = format!("the run ends after {} turns, still accelerating", si(turns));
            let of_spindle = turns == self.spindle.turns;
            let most = match law.and_then(NozzleLaw::held) {
                _ if of_spindle => format!("at most spindle.turns, {}", si(turns)),
                Some(held) if held == turns => {
                    format!("at most the turns of the planned layers, {}", si(turns))
                }
                _ => format!("at most the turns of the traverse, {}", si(turns)),
            };
            problems.add(match self.given(&["spindle.ramp_turns", "spindle.turns"]) {
                "spindle.turns" if of_spindle => self.impossible(
                    "spindle.turns",
                    reason,
                    format!(
                        "at least spindle.ramp_turns, {}, or a shorter ramp",
                        si(ramp)
                    ),
                ),
                _ => self.impossible("spindle.ramp_turns", reason, most),
            });
        }
        if self.friction.kinetic > self.friction.static_ {
            let reason = "static friction below kinetic friction";
            problems.add(match self.given(&["friction.kinetic", "friction.static"]) {
                "friction.static" => self.impossible(
                    "friction.static",
                    reason,
                    format!("at least friction.kinetic, {}", si(self.friction.kinetic)),
                ),
                key => self.impossible(
                    key,
                    reason,
                    format!("at most friction.static, {}", si(self.friction.static_)),
                ),
            });
        }
    }

    /// Contact that lets wire sink in by its radius has the centreline in the surface: a run is in doubt from its first corner on.
    pub(super) fn check_stiffness(&self, core: &Core, wire: &Section, problems: &mut Problems) {
        let Some(corner) = core.corner() else {
            return;
        };
        let least = self.tensioner.tension / (corner + wire.radius()) / wire.radius();
        if self.contact.stiffness < least {
            problems.add(self.impossible(
                "contact.stiffness",
                "the set tension draws the wire into the tightest bend by more than half its diameter",
                format!("at least {} N/m2", si(least)),
            ));
        }
    }

    pub(super) fn check_spacing(
        &self,
        solver: &Solver,
        wire: &Section,
        extent: &Extent,
        problems: &mut Problems,
    ) {
        let d = wire.diameter;
        let (finest, coarsest) = (FINEST * d, COARSEST * d);
        let near = solver.spacing_near;
        if !(finest..=coarsest).contains(&near) {
            let reason = if near < finest {
                "too fine for a rod"
            } else {
                "too coarse for this wire"
            };
            let range = format!(
                "{} to {} m ({FINEST} to {COARSEST} wire diameters)",
                si(finest),
                si(coarsest)
            );
            problems.add(self.impossible("solver.spacing_near", reason, range));
            return;
        }
        // Contact of stiffness 1e10 N/m2 that is wrong by so much pushes harder than most wire is
        // pulled.
        let most = 0.1 * d;
        if solver.tolerance < 1e-9 {
            problems.add(self.impossible(
                "solver.tolerance",
                "rounding is larger",
                "1e-9 to 0.001 m, or 0: in proportion to the outer diameter",
            ));
        }
        if solver.tolerance > most * (1.0 + 1e-9) && solver.integrator.is_implicit() {
            problems.add(self.impossible(
                "solver.tolerance",
                "steps may be wrong by more than a tenth of the wire's diameter",
                format!("at most {} m", si(most)),
            ));
        }
        let span = self.nozzle.distance - extent.turning_radius;
        if span <= d {
            // The nozzle inside the core is told already.
            return;
        }
        let free = solver.spacing_free;
        if 3.0 * near > span {
            problems.add(self.impossible(
                self.given(&["nozzle.distance", "solver.spacing_near"]),
                format!(
                    "the free span, {} m, has no room for three edges of the spacing near the core, {} m",
                    si(span),
                    si(near)
                ),
                format!(
                    "nozzle.distance at least {} m, or solver.spacing_near at most {} m",
                    si_up(extent.turning_radius + 3.0 * near),
                    si_down(span / 3.0)
                ),
            ));
        } else if free < near || 3.0 * free > span {
            let reason = match free < near {
                true => "the free span cannot be finer than the wire near the core",
                false => "the free span needs at least three edges",
            };
            problems.add(self.impossible(
                "solver.spacing_free",
                reason,
                format!(
                    "solver.spacing_near, {} m, to {} m",
                    si_up(near),
                    si_down(span / 3.0)
                ),
            ));
        }
    }
}
