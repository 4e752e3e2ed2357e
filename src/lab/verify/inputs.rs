//! What each kind of case takes, in which ranges: told before anything is computed.

use super::VerifyError;
use super::file::{Case, CaseFile};
use crate::rod::Section;
use crate::scene::si;
use serde_json::Value;

/// In what a bound is counted.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Unit {
    /// the input's own unit
    Own,
    /// diameters of the wire
    Diameter,
    /// curvatures whose radius is a diameter
    Bend,
    /// stretch rigidities
    Stretch,
    /// moments that bend or twist elastic wire to a radius of a diameter
    Moment,
}

impl Unit {
    /// The unit of this wire in SI, and what it is called in a message.
    fn of(self, wire: &Section) -> (f64, &'static str) {
        match self {
            Self::Own => (1.0, ""),
            Self::Diameter => (wire.diameter, "diameter"),
            Self::Bend => (1.0 / wire.diameter, "1/diameter"),
            Self::Stretch => (wire.ea, "EA"),
            Self::Moment => (wire.ei / wire.diameter, "EI/diameter"),
        }
    }
}

/// What an input may be.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Range {
    /// above 0, at most so much
    Above0(f64, Unit),
    /// from 0 on
    From0(f64, Unit),
    /// from the first to the second
    Between(f64, f64, Unit),
    /// of either sign
    Signed(f64, Unit),
    /// a list of those, so long at most
    List(f64, Unit, usize),
    /// one of these words
    Words(&'static [&'static str]),
}

use Range::{Above0, Between, From0, List, Signed, Words};
use Unit::{Bend, Diameter, Moment, Own, Stretch};

/// Length of wire: no rod is shorter than it is thick. The number of edges is bounded on its own.
const LONG: Range = Between(1.0, 1e7, Diameter);
/// Length of wire that comes to rest, for which a longer one takes too much time.
const SPAN: Range = Between(1.0, 2000.0, Diameter);
/// Radius of a core, where the number of edges is bounded on its own.
const ROUND: Range = Above0(1e6, Diameter);
/// Radius or side of a core that a whole wind goes round. More turns than a computer has time for are needed beyond.
const CORE: Range = Above0(1000.0, Diameter);
/// Distance from a turn to the next.
const APART: Range = Between(1.0, 1000.0, Diameter);
/// Pull of wire that stays wire: no metal stretches by a tenth before it breaks. Slack wire takes too much time to come to rest.
const PULL: Range = Between(1e-6, 0.1, Stretch);
const PULL_OR_NONE: Range = From0(0.1, Stretch);
const PULL_OR_PUSH: Range = Signed(0.1, Stretch);
const FRICTION: Range = From0(10.0, Own);
/// Speed of a whole wind, rad/s: a slower one takes longer than anybody waits.
const SPEED: Range = Between(0.01, 1e5, Own);
const ANGLE: Range = Signed(100.0, Own);
const MASS: Range = From0(1000.0, Own);
const SIDEWAYS: Range = Signed(10.0, Own);
const HALF_TURN: Range = Above0(std::f64::consts::PI, Own);

type Input = (&'static str, Range);

const MU: Input = ("mu", FRICTION);
const WRAP: Input = ("wrap_rad", Above0(20.0, Own));
const RADIUS: Input = ("R_m", ROUND);
const HOLD: Input = ("F0_N", PULL);
const WIDTH: Input = ("core_w_m", CORE);
const HEIGHT: Input = ("core_h_m", CORE);
const CORNER: Input = ("corner_radius_m", From0(1000.0, Diameter));
const DISTANCE: Input = ("nozzle_distance_m", Above0(1e4, Diameter));
const TENSION: Input = ("T0_N", PULL);

/// Inputs of each kind that its answers depend on.
const TABLE: &[(&str, &[Input])] = &[
    (
        "elastica_cantilever",
        &[("alpha", Signed(1000.0, Own)), ("L_m", LONG)],
    ),
    (
        "end_couple",
        &[("fraction", Signed(10.0, Own)), ("L_m", LONG)],
    ),
    (
        "bending_modes",
        &[
            (
                "bc",
                Words(&["clamped-free", "clamped-clamped", "pinned-pinned"]),
            ),
            ("T_N", PULL_OR_PUSH),
            ("L_m", LONG),
        ],
    ),
    ("axial_wave", &[("L_m", LONG), ("P_N", PULL_OR_PUSH)]),
    (
        "torsion",
        &[("L_m", LONG), ("torque_Nm", Signed(1.0, Moment))],
    ),
    ("hanging_wire", &[("span_m", LONG), ("length_m", LONG)]),
    (
        "helix",
        &[
            ("R_m", ROUND),
            ("pitch_m", Signed(1000.0, Own)),
            ("twist_density_1_per_m", Signed(1.0, Bend)),
        ],
    ),
    ("mandrel_springback", &[("R_m", ROUND)]),
    (
        "cyclic_bending",
        &[("curvature_path_1_per_m", List(2.0, Bend, 1000))],
    ),
    (
        "bulge_linear",
        &[
            ("T_N", PULL),
            ("span_m", SPAN),
            ("M_Nm", Signed(1.0, Moment)),
        ],
    ),
    ("corner_edge", &[("T_N", PULL), ("turn_rad", HALF_TURN)]),
    ("square_loop", &[("T_N", PULL), ("side_m", SPAN)]),
    ("capstan", &[MU, WRAP, RADIUS, HOLD]),
    (
        "grooved_capstan",
        &[MU, WRAP, RADIUS, HOLD, ("groove_rad", HALF_TURN)],
    ),
    ("twist_buckling", &[("L_m", LONG), ("T_N", PULL_OR_PUSH)]),
    ("shoulder_static", &[MU, ("lam", SIDEWAYS)]),
    (
        "groove_seat",
        &[("pitch_m", Above0(2.0, Diameter)), ("lam", SIDEWAYS)],
    ),
    (
        "shoulder_drop",
        &[
            MU,
            ("lam", SIDEWAYS),
            ("start_angle_deg", Above0(90.0, Own)),
        ],
    ),
    (
        "spinning_ring",
        &[("omega_rad_per_s", Signed(1e5, Own)), RADIUS, TENSION],
    ),
    (
        "penalty_impact",
        &[
            ("mass_kg", Above0(1000.0, Own)),
            ("k_N_per_m", Above0(1e15, Own)),
            ("v_m_per_s", Above0(1e5, Own)),
            ("damping_ratio", From0(10.0, Own)),
        ],
    ),
    ("winding_feed", &[WIDTH, HEIGHT, CORNER, DISTANCE, TENSION]),
    (
        "feed_tension",
        &[
            WIDTH,
            HEIGHT,
            CORNER,
            DISTANCE,
            TENSION,
            ("omega_rad_per_s", SPEED),
            ("tensioner_mass_kg", Above0(1000.0, Own)),
            ("line_stiffness_N_per_m", Above0(1e12, Own)),
            ("line_damping_ratio", From0(100.0, Own)),
            ("line_mass_kg", MASS),
            ("pulley_mass_kg", MASS),
            ("pulley_friction_N", PULL_OR_NONE),
            ("pulley_place", Above0(1.0, Own)),
        ],
    ),
    (
        "wave_damping",
        &[
            ("L_m", LONG),
            ("mode", Between(1.0, 100.0, Own)),
            ("omega_h", Between(1e-3, 10.0, Own)),
            ("step_ratio", Between(0.01, 100.0, Own)),
        ],
    ),
    (
        "rolling_path",
        &[
            ("curvature_1_per_m", Above0(2.0, Bend)),
            ("roll_rad", ANGLE),
            ("twist_1_per_m", Signed(2.0, Bend)),
        ],
    ),
    ("helix_gap", &[("R_m", CORE), ("pitch_m", APART)]),
    (
        "frozen_helix",
        &[
            ("R_m", CORE),
            ("pitch_m", APART),
            TENSION,
            MU,
            ("omega_rad_per_s", SPEED),
        ],
    ),
    (
        "live_pair",
        &[
            ("R_m", CORE),
            TENSION,
            ("press_N_per_m", Above0(1e8, Own)),
            MU,
            ("drawn_m", Above0(100.0, Diameter)),
        ],
    ),
];

/// Checks every input of every case of a known kind.
pub(super) fn check(file: &CaseFile) -> Result<(), VerifyError> {
    let Some((_, inputs)) = TABLE.iter().find(|(kind, _)| *kind == file.kind) else {
        return Ok(());
    };
    for case in &file.cases {
        for (name, range) in *inputs {
            fits(case, name, *range, &file.section).map_err(|problem| VerifyError::File {
                file: file.name.clone(),
                key: format!("case {}, inputs.{name}", case.id),
                problem,
            })?;
        }
    }
    Ok(())
}

/// Nothing, or the value and what is wanted in its place.
fn fits(case: &Case, name: &str, range: Range, wire: &Section) -> Result<(), String> {
    let value = case.inputs.get(name);
    let good = match range {
        Words(words) => value
            .and_then(Value::as_str)
            .is_some_and(|v| words.contains(&v)),
        List(_, _, most) => value.and_then(Value::as_array).is_some_and(|list| {
            (1..=most).contains(&list.len()) && list.iter().all(|v| within(v, range, wire))
        }),
        _ => value.is_some_and(|v| within(v, range, wire)),
    };
    if good {
        return Ok(());
    }
    let given = value.map_or_else(|| "missing".to_owned(), Value::to_string);
    Err(format!("{given}: {} is wanted", wanted(range, wire)))
}

fn within(value: &Value, range: Range, wire: &Section) -> bool {
    let Some(value) = value.as_f64().filter(|v| v.is_finite()) else {
        return false;
    };
    let most = |m: f64, unit: Unit| m * unit.of(wire).0 * (1.0 + 1e-9);
    match range {
        Above0(m, unit) => value > 0.0 && value <= most(m, unit),
        From0(m, unit) => (0.0..=most(m, unit)).contains(&value),
        Between(low, high, unit) => {
            value >= low * unit.of(wire).0 * (1.0 - 1e-9) && value <= most(high, unit)
        }
        Signed(m, unit) | List(m, unit, _) => value.abs() <= most(m, unit),
        Words(_) => false,
    }
}

/// The range in words.
fn wanted(range: Range, wire: &Section) -> String {
    let most = |m: f64, unit: Unit| {
        let (size, name) = unit.of(wire);
        let so_much = si(m * size);
        match name {
            "" => so_much,
            _ => format!("{so_much} ({m} {name})"),
        }
    };
    match range {
        Above0(m, unit) => format!("a number above 0 and at most {}", most(m, unit)),
        From0(m, unit) => format!("a number from 0 to {}", most(m, unit)),
        Between(low, high, unit) => {
            format!("a number from {} to {}", most(low, unit), most(high, unit))
        }
        Signed(m, unit) => format!("a number of a size of at most {}", most(m, unit)),
        List(m, unit, length) => format!(
            "a list of 1 to {length} numbers of a size of at most {}",
            most(m, unit)
        ),
        Words(words) => format!("one of {}", words.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::super::KINDS;
    use super::*;

    #[test]
    fn every_kind_has_its_ranges_and_every_packed_case_fits_them() {
        for kind in KINDS {
            assert!(
                TABLE.iter().any(|(name, _)| *name == kind.name),
                "{}",
                kind.name
            );
        }
        for file in CaseFile::packed().expect("packed files are well formed") {
            assert_eq!(check(&file), Ok(()));
        }
    }

    /// 1e9 ended in a panic, an overflow of memory or a number without meaning, and friction below 0 in an answer.
    #[test]
    fn every_number_of_every_kind_is_refused_where_it_is_absurd() {
        for file in CaseFile::packed().expect("packed files are well formed") {
            let (_, inputs) = TABLE
                .iter()
                .find(|(kind, _)| *kind == file.kind)
                .expect("a row");
            for (name, range) in *inputs {
                for absurd in [1e30.into(), "x".into(), Value::Null, (-1e30).into()] {
                    let mut wrong = file.clone();
                    wrong.cases[0].inputs.insert((*name).to_owned(), absurd);
                    let told = check(&wrong).expect_err(name).to_string();
                    assert!(told.contains(name) && told.contains("wanted"), "{told}");
                    assert!(told.starts_with(&file.name), "{told}");
                }
                if matches!(range, Above0(..) | Between(..) | From0(..)) {
                    let mut wrong = file.clone();
                    wrong.cases[0]
                        .inputs
                        .insert((*name).to_owned(), (-0.001).into());
                    assert!(check(&wrong).is_err(), "{} {name} below 0", file.kind);
                }
            }
        }
    }
}
