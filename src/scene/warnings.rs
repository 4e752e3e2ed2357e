//! Values that are possible but perhaps not meant.

use super::build::Extent;
use super::error::Warning;
use super::impossible::si;
use super::{Core, Integrator, NozzleLaw, Solver};
use crate::rod::{Section, Twist};
use crate::settings::SceneSettings;

/// Keys of each shape of core.
const KEYS_OF_SHAPES: [(&str, &[&str]); 3] = [
    (
        "rounded-box",
        &[
            "core.width_x",
            "core.height_z",
            "core.length_y",
            "core.corner_radius",
            "core.flange.inner_distance",
            "core.flange.height",
            "core.flange.thickness",
            "core.flange.edge_radius",
        ],
    ),
    (
        "cylinder",
        &[
            "core.radius",
            "core.length_y",
            "core.flange.inner_distance",
            "core.flange.height",
            "core.flange.thickness",
            "core.flange.edge_radius",
        ],
    ),
    ("mesh", &["core.file", "core.unit"]),
];

impl SceneSettings {
    pub(super) fn warnings(
        &self,
        solver: &Solver,
        wire: &Section,
        core: &Core,
        extent: &Extent,
        law: &NozzleLaw,
    ) -> Vec<Warning> {
        let mut warnings = self.keys_without_effect();
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
        let last = law.position(law.end());
        if self.traverse.mode == "by-angle" && beside(last) && !beside(self.nozzle.y_start) {
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
    /// Keys that were given for a core of another shape.
    fn keys_without_effect(&self) -> Vec<Warning> {
        let shape = self.core.shape.as_str();
        let used = |of: &str| {
            let keys = KEYS_OF_SHAPES.iter().find(|(shape, _)| *shape == of);
            keys.map_or(&[][..], |(_, keys)| *keys)
        };
        let mut warnings = Vec::new();
        for (other, keys) in KEYS_OF_SHAPES {
            for &key in keys {
                let told = warnings.iter().any(|w: &Warning| w.key == key);
                if used(shape).contains(&key) || told || !self.origins.contains_key(key) {
                    continue;
                }
                warnings.push(Warning {
                    origin: self.origin(key),
                    key,
                    value: self.shown(key),
                    message: format!(
                        "has no effect: core.shape = {shape} does not use it; set core.shape = {other}, or leave the key out"
                    ),
                });
            }
        }
        warnings
    }
}
