//! Keys that were given although nothing reads them.

use super::SceneError;
use super::error::Warning;
use super::{Integrator, Window};
use crate::settings::{BY_INPUT, NozzleFollows, Origin, SceneSettings};
use std::collections::BTreeSet;

/// What decides which keys a run reads.
pub(super) struct Reader<'a> {
    pub(super) settings: &'a SceneSettings,
    pub(super) integrator: Integrator,
    pub(super) window: Option<Window>,
    pub(super) follows: NozzleFollows,
}

/// Keys that only some values of a choice read: of the shape of the core, or of how the nozzle moves.
struct KeysOf {
    choice: &'static str,
    values: &'static [&'static str],
    keys: &'static [&'static str],
}

/// Keys of the values of a choice.
const fn keys_of(
    choice: &'static str,
    values: &'static [&'static str],
    keys: &'static [&'static str],
) -> KeysOf {
    KeysOf {
        choice,
        values,
        keys,
    }
}

const SHAPE: &str = "core.shape";
const MODE: &str = "traverse.mode";
const PER_TURN: &str = "traverse.per_turn";

/// All keys that depend on a choice.
static KEYS_OF_CHOICES: [KeysOf; 11] = [
    keys_of(
        SHAPE,
        &["rounded-box"],
        &["core.width_x", "core.height_z", "core.corner_radius"],
    ),
    keys_of(SHAPE, &["cylinder"], &["core.radius"]),
    keys_of(
        SHAPE,
        &["rounded-box", "cylinder"],
        &["core.length_y", "core.insulation"],
    ),
    keys_of(SHAPE, &["mesh"], &["core.file", "core.unit"]),
    keys_of(MODE, &["by-input", "by-angle"], &[PER_TURN]),
    keys_of(
        MODE,
        &["orthocyclic"],
        &[
            "traverse.crossover",
            "traverse.crossover_delay",
            "traverse.trail",
        ],
    ),
    keys_of(MODE, &["helical"], &["traverse.dwell_turns"]),
    keys_of(MODE, &["table"], &["traverse.file"]),
    keys_of(
        MODE,
        &["orthocyclic", "helical", "table"],
        &["traverse.advance"],
    ),
    keys_of(
        MODE,
        &["orthocyclic", "helical", "table"],
        &["winding.turns_per_layer", "winding.layers"],
    ),
    keys_of(
        MODE,
        &["orthocyclic", "helical"],
        &["winding.direction", "winding.pitch"],
    ),
];

/// Keys of a part that a scene may lack.
struct KeysOfPart {
    keys: &'static [&'static str],
    lacks: fn(&Reader<'_>) -> bool,
    /// why nothing reads the keys then
    why: &'static str,
}

/// All keys of parts. Where several lacks hold for a key, the first one is told.
const KEYS_OF_PARTS: &[KeysOfPart] = &[
    KeysOfPart {
        keys: &[PER_TURN],
        lacks: |r| !r.follows.is_law() && r.settings.origin(PER_TURN) == Origin::Set,
        why: "the nozzle follows its input; set traverse.mode = by-angle",
    },
    KeysOfPart {
        keys: &["spindle.repeat_turns"],
        lacks: |r| r.settings.spindle.file.is_empty(),
        why: "there is no table without spindle.file",
    },
    KeysOfPart {
        keys: &["spindle.flange_turns"],
        lacks: |r| r.settings.spindle.flange_share == 1.0,
        why: "with spindle.flange_share = 1 the spindle does not slow down",
    },
    KeysOfPart {
        keys: &["spindle.flange_share"],
        lacks: |r| !r.settings.plans_layers(),
        why: "no layers are planned; set winding.turns_per_layer, or a traverse.mode that winds layers",
    },
    KeysOfPart {
        keys: &["core.length_y"],
        lacks: |r| r.has_flanges() && r.settings.core.shape != "mesh",
        why: "between flanges the core ends at their outer faces",
    },
    KeysOfPart {
        keys: &[
            "core.flange.height",
            "core.flange.thickness",
            "core.flange.edge_radius",
            "core.flange.insulation",
        ],
        lacks: |r| !r.has_flanges(),
        why: "there are no flanges without core.flange.inner_distance",
    },
    KeysOfPart {
        keys: &["core.window_taper"],
        lacks: |r| r.window.is_none(),
        why: "there is no limit line without core.window_height or flanges",
    },
    KeysOfPart {
        keys: &["nozzle.length", "nozzle.edge_radius"],
        lacks: |r| r.settings.nozzle.outer_diameter == 0.0,
        why: "a nozzle without nozzle.outer_diameter is a point",
    },
    KeysOfPart {
        keys: &["tensioner.line_damping_ratio"],
        lacks: |r| r.settings.tensioner.mass == 0.0,
        why: "without tensioner.mass nothing swings on the line",
    },
    KeysOfPart {
        keys: &["tensioner.line_damping_ratio"],
        lacks: |r| r.settings.tensioner.line_length == 0.0,
        why: "without tensioner.line_length the tensioner is at the nozzle",
    },
    KeysOfPart {
        keys: &["tensioner.pulley_place"],
        lacks: |r| !r.settings.tensioner.has_pulley(),
        why: "there is no pulley without tensioner.pulley_mass or tensioner.pulley_friction",
    },
    KeysOfPart {
        keys: &["wire.enamel_density"],
        lacks: |r| r.settings.wire.enamelled_diameter == 0.0,
        why: "wire without wire.enamelled_diameter is bare",
    },
    KeysOfPart {
        keys: &[
            "wire.yield_stress",
            "wire.flow_stress",
            "wire.N_y",
            "wire.M_y",
            "wire.T_y",
            "wire.moment_cap",
        ],
        lacks: |r| r.settings.wire.elastic,
        why: "wire with wire.elastic = true does not yield",
    },
    KeysOfPart {
        // custom wire has to say them
        keys: &["wire.EAp", "wire.EIp", "wire.GJp"],
        lacks: |r| r.settings.wire.elastic && r.settings.wire.material != "custom",
        why: "wire with wire.elastic = true does not yield",
    },
    KeysOfPart {
        keys: &["friction.static", "friction.kinetic", "friction.slip_speed"],
        lacks: |r| r.settings.solver.friction == "off",
        why: "with solver.friction = off nothing rubs",
    },
    KeysOfPart {
        keys: &["solver.step_share"],
        lacks: |r| r.integrator.is_implicit(),
        why: "the implicit method has no stability limit; set solver.tolerance for shorter steps, or solver.integrator = rk4 or verlet",
    },
    KeysOfPart {
        keys: &["solver.step_share"],
        lacks: |r| r.settings.solver.step > 0.0,
        why: "solver.step fixes the time step",
    },
    KeysOfPart {
        keys: &["solver.tolerance"],
        lacks: |r| !r.integrator.is_implicit(),
        why: "the explicit methods estimate no error; set solver.step_share",
    },
];

impl Reader<'_> {
    fn has_flanges(&self) -> bool {
        self.settings.core.flange.inner_distance > 0.0
    }

    /// The settings come from a scene that a run kept, so that a default among them says nothing. Such a scene has all keys of its
    /// version, and later versions add some. Half of them tells it apart: choices exclude each other, and nobody writes both sides.
    fn is_kept(&self) -> bool {
        let keys: BTreeSet<&str> = all_keys().collect();
        let of_file = keys.iter().filter(|key| {
            let origin = self.settings.origins.get(*key);
            matches!(origin, Some(Origin::File { .. }))
        });
        2 * of_file.count() >= keys.len()
    }

    /// What a run has chosen, in words. A nozzle that follows its input leaves the scene's own mode to say what is wound.
    fn chosen(&self, choice: &str, now: &str) -> String {
        match choice {
            MODE if !self.follows.is_law() && now != BY_INPUT => {
                format!("{BY_INPUT} in a scene of {now}")
            }
            _ => now.to_owned(),
        }
    }

    /// Keys that were given although nothing reads them.
    pub(super) fn warnings(&self) -> Vec<Warning> {
        let settings = self.settings;
        let by_law = self.follows.is_law();
        let usual = SceneSettings::default();
        let is_kept = self.is_kept();
        // (an importer writes every start value, but perhaps for texts and files; nobody sets half of all keys by hand)
        let by_name = |key: &&str| settings.origins.get(*key) == Some(&Origin::Set);
        let by_an_importer = 2 * all_keys().filter(by_name).count() >= all_keys().count();
        let mut warnings: Vec<Warning> = Vec::new();
        let mut warn = |key: &'static str, why: &str| {
            let (origin, value) = (settings.told_origin(key), settings.shown(key));
            let says_nothing = match settings.origins.get(key) {
                Some(Origin::File { .. }) => is_kept,
                _ => by_an_importer,
            };
            let is_given =
                settings.origins.contains_key(key) && !(says_nothing && value == usual.shown(key));
            if is_given && !warnings.iter().any(|w| w.key == key) {
                warnings.push(Warning {
                    origin,
                    key,
                    value,
                    message: format!("has no effect: {why}"),
                });
            }
        };
        for (of, now) in unread(settings) {
            let choice = of.choice;
            let others = of.values.join(" or ");
            let keys = of.keys.iter().filter(|key| by_law || **key != PER_TURN);
            for &key in keys {
                let chosen = self.chosen(choice, now);
                let why = format!(
                    "{choice} = {chosen} does not use it; set {choice} = {others}, or leave the key out"
                );
                warn(key, &why);
            }
        }
        for part in KEYS_OF_PARTS.iter().filter(|part| (part.lacks)(self)) {
            part.keys.iter().for_each(|key| warn(key, part.why));
        }
        warnings
    }
}

/// The groups of keys that the choices of a scene leave unread, and what was chosen instead.
fn unread(settings: &SceneSettings) -> impl Iterator<Item = (&'static KeysOf, &str)> {
    let chosen = |of: &'static KeysOf| match of.choice {
        SHAPE => (of, settings.core.shape.as_str()),
        _ => (of, settings.traverse.mode.as_str()),
    };
    let all = KEYS_OF_CHOICES.iter().map(chosen);
    all.filter(|(of, now)| !of.values.contains(now))
}

impl SceneSettings {
    /// Keys that nothing reads in a run of the scene's own motion, given or not. Of a scene that is refused, those that its choices
    /// leave unread.
    pub fn idle_keys(&self) -> BTreeSet<&'static str> {
        let mut keys: BTreeSet<_> = unread(self).flat_map(|(of, _)| of.keys).copied().collect();
        let follows = NozzleFollows::Law;
        if let Ok((scene, _)) = self.build_for(follows) {
            let reader = Reader {
                settings: self,
                integrator: scene.solver.integrator,
                window: scene.window,
                follows,
            };
            let lacks = KEYS_OF_PARTS.iter().filter(|part| (part.lacks)(&reader));
            keys.extend(lacks.flat_map(|part| part.keys));
        }
        keys
    }

    /// The error of a file that would be the core if the scene said so. What else is wrong may follow from that, and comes alone
    /// without the warnings.
    pub(super) fn file_of_no_mesh(&self) -> Option<SceneError> {
        let shape = &self.core.shape;
        let is_none = self.core.file.is_empty() || shape == "mesh";
        (!is_none).then(|| {
            let reason = format!("{SHAPE} = {shape} does not use it");
            self.impossible("core.file", reason, format!("{SHAPE} = mesh, or no file"))
        })
    }
}

fn all_keys() -> impl Iterator<Item = &'static str> {
    let of_choices = KEYS_OF_CHOICES.iter().flat_map(|of| of.keys);
    let of_parts = KEYS_OF_PARTS.iter().flat_map(|of| of.keys);
    of_choices.chain(of_parts).copied()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::variables::by_name;

    #[test]
    fn every_key_is_a_variable() {
        let unknown: Vec<&str> = all_keys().filter(|key| by_name(key).is_none()).collect();
        assert!(unknown.is_empty(), "{unknown:?}");
    }
}
