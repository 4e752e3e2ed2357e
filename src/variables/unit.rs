//! Units: what they are made of, what people read instead, and the suffixes of scene keys.

use std::f64::consts::PI;

/// A unit of the variable table, as FMI describes it.
#[derive(Clone, Copy, Debug)]
pub struct Unit {
    /// FMI unit name
    pub name: &'static str,
    /// what it measures, the name of its FMI type
    pub quantity: &'static str,
    /// exponents of the SI base units `kg`, `m`, `s`, `A`, `rad`; the factor is 1 throughout
    pub base: &'static [(&'static str, i32)],
    /// units shown to people: name, factor, offset, with `shown = factor * value + offset`
    pub display: &'static [(&'static str, f64, f64)],
}

/// Every unit the table uses.
pub fn units() -> &'static [Unit] {
    &[
        Unit {
            name: "1",
            quantity: "Number",
            base: &[],
            display: &[],
        },
        Unit {
            name: "m",
            quantity: "Length",
            base: &[("m", 1)],
            display: &[("mm", 1e3, 0.0), ("um", 1e6, 0.0)],
        },
        Unit {
            name: "m/s",
            quantity: "Velocity",
            base: &[("m", 1), ("s", -1)],
            display: &[("mm/s", 1e3, 0.0)],
        },
        Unit {
            name: "m/rad",
            quantity: "LengthPerAngle",
            base: &[("m", 1), ("rad", -1)],
            display: &[("um/rad", 1e6, 0.0)],
        },
        Unit {
            name: "rad",
            quantity: "Angle",
            base: &[("rad", 1)],
            display: &[("deg", 180.0 / PI, 0.0)],
        },
        Unit {
            name: "rad/s",
            quantity: "AngularVelocity",
            base: &[("rad", 1), ("s", -1)],
            display: &[("rpm", 30.0 / PI, 0.0)],
        },
        Unit {
            name: "s",
            quantity: "Time",
            base: &[("s", 1)],
            display: &[("ms", 1e3, 0.0), ("us", 1e6, 0.0)],
        },
        Unit {
            name: "kg",
            quantity: "Mass",
            base: &[("kg", 1)],
            display: &[("g", 1e3, 0.0)],
        },
        Unit {
            name: "kg/m3",
            quantity: "Density",
            base: &[("kg", 1), ("m", -3)],
            display: &[],
        },
        Unit {
            name: "N",
            quantity: "Force",
            base: &[("kg", 1), ("m", 1), ("s", -2)],
            display: &[],
        },
        Unit {
            name: "N.m",
            quantity: "Torque",
            base: &[("kg", 1), ("m", 2), ("s", -2)],
            display: &[("N.mm", 1e3, 0.0)],
        },
        Unit {
            name: "J",
            quantity: "Energy",
            base: &[("kg", 1), ("m", 2), ("s", -2)],
            display: &[],
        },
        Unit {
            name: "N.m2",
            quantity: "Rigidity",
            base: &[("kg", 1), ("m", 3), ("s", -2)],
            display: &[],
        },
        Unit {
            name: "N/m2",
            quantity: "LineLoadPerDepth",
            base: &[("kg", 1), ("m", -1), ("s", -2)],
            display: &[],
        },
        Unit {
            name: "Pa",
            quantity: "Stress",
            base: &[("kg", 1), ("m", -1), ("s", -2)],
            display: &[("MPa", 1e-6, 0.0)],
        },
        Unit {
            name: "Ohm.m",
            quantity: "Resistivity",
            base: &[("kg", 1), ("m", 3), ("s", -3), ("A", -2)],
            display: &[],
        },
        Unit {
            name: "N.s/m",
            quantity: "Damping",
            base: &[("kg", 1), ("s", -1)],
            display: &[],
        },
        Unit {
            name: "kg.m2",
            quantity: "MomentOfInertia",
            base: &[("kg", 1), ("m", 2)],
            display: &[("g.mm2", 1e9, 0.0)],
        },
        Unit {
            name: "Ohm",
            quantity: "Resistance",
            base: &[("kg", 1), ("m", 2), ("s", -3), ("A", -2)],
            display: &[("mOhm", 1e3, 0.0)],
        },
    ]
}

/// How a number with a unit suffix becomes SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Scale {
    /// times a power of ten
    Tens(i32),
    /// times a factor
    Factor(f64),
}

/// Key suffix, the unit of the row it applies to, and its size in that unit.
const SUFFIXES: &[(&str, &str, Scale)] = &[
    ("m", "m", Scale::Tens(0)),
    ("mm", "m", Scale::Tens(-3)),
    ("um", "m", Scale::Tens(-6)),
    ("m_per_s", "m/s", Scale::Tens(0)),
    ("mm_per_s", "m/s", Scale::Tens(-3)),
    ("m_per_rad", "m/rad", Scale::Tens(0)),
    ("um_per_rad", "m/rad", Scale::Tens(-6)),
    ("rad", "rad", Scale::Tens(0)),
    ("deg", "rad", Scale::Factor(PI / 180.0)),
    ("rad_per_s", "rad/s", Scale::Tens(0)),
    ("rpm", "rad/s", Scale::Factor(PI / 30.0)),
    ("s", "s", Scale::Tens(0)),
    ("ms", "s", Scale::Tens(-3)),
    ("us", "s", Scale::Tens(-6)),
    ("ns", "s", Scale::Tens(-9)),
    ("kg", "kg", Scale::Tens(0)),
    ("g", "kg", Scale::Tens(-3)),
    ("kg_per_m3", "kg/m3", Scale::Tens(0)),
    ("g_per_cm3", "kg/m3", Scale::Tens(3)),
    ("N", "N", Scale::Tens(0)),
    ("mN", "N", Scale::Tens(-3)),
    ("N_s_per_m", "N.s/m", Scale::Tens(0)),
    ("Nm", "N.m", Scale::Tens(0)),
    ("Nmm", "N.m", Scale::Tens(-3)),
    ("Nm2", "N.m2", Scale::Tens(0)),
    ("Nmm2", "N.m2", Scale::Tens(-6)),
    ("N_per_m2", "N/m2", Scale::Tens(0)),
    ("N_per_mm2", "N/m2", Scale::Tens(6)),
    ("Pa", "Pa", Scale::Tens(0)),
    ("MPa", "Pa", Scale::Tens(6)),
    ("GPa", "Pa", Scale::Tens(9)),
    ("Ohm_m", "Ohm.m", Scale::Tens(0)),
    ("Ohm_mm2_per_m", "Ohm.m", Scale::Tens(-6)),
];

/// The suffixes a key with this unit may carry.
pub(crate) fn suffixes_of(unit: &str) -> impl Iterator<Item = (&'static str, Scale)> {
    SUFFIXES
        .iter()
        .filter(move |s| s.1 == unit)
        .map(|s| (s.0, s.2))
}

/// Splits `diameter_mm` into `diameter` and the units that spell `mm`; longest suffix first, so
/// that `creep_um_per_rad` is not taken for radians.
pub(crate) fn split_suffix(key: &str) -> Option<(&str, &'static str, Scale)> {
    SUFFIXES
        .iter()
        .filter_map(|&(suffix, unit, scale)| {
            let stem = key.strip_suffix(suffix)?.strip_suffix('_')?;
            (!stem.is_empty()).then_some((stem, unit, scale))
        })
        .min_by_key(|(stem, ..)| stem.len())
}

/// A number in SI. Powers of ten shift the decimal exponent, so that `0.7` mm is the same double
/// as `0.0007`.
pub(crate) fn scaled(x: f64, scale: Scale) -> f64 {
    match scale {
        Scale::Factor(factor) => x * factor,
        Scale::Tens(0) => x,
        Scale::Tens(_) => parse_scaled(&format!("{x:e}"), scale).unwrap_or(x),
    }
}

/// Reads a decimal text in SI; `None` if it is no number.
pub(crate) fn parse_scaled(text: &str, scale: Scale) -> Option<f64> {
    let Scale::Tens(tens) = scale else {
        return Some(scaled(text.parse().ok()?, scale));
    };
    let plain: f64 = text.parse().ok()?;
    if tens == 0 || !plain.is_finite() {
        return Some(plain);
    }
    let (digits, exponent) = match text.split_once(['e', 'E']) {
        Some((digits, exponent)) => (digits, exponent.parse::<i32>().ok()?),
        None => (text, 0),
    };
    format!("{digits}e{}", exponent.checked_add(tens)?)
        .parse()
        .ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn millimetres_are_the_same_double_as_metres() {
        let mm = Scale::Tens(-3);
        for (text, si) in [
            ("0.7", 0.0007),
            ("12", 0.012),
            ("7e-1", 0.0007),
            ("+0.35", 0.00035),
        ] {
            assert_eq!(parse_scaled(text, mm), Some(si));
        }
        assert_eq!(scaled(0.7, mm), 0.0007);
        assert_eq!(scaled(100.0, Scale::Tens(6)), 1e8);
        assert!(parse_scaled("nan", mm).unwrap().is_nan());
        assert_eq!(parse_scaled("7 mm", mm), None);
    }

    #[test]
    fn longest_suffix_wins() {
        let (stem, unit, scale) = split_suffix("freeze.creep_um_per_rad").unwrap();
        assert_eq!(
            (stem, unit, scale),
            ("freeze.creep", "m/rad", Scale::Tens(-6))
        );
        assert_eq!(
            split_suffix("spindle.speed_rpm").unwrap().0,
            "spindle.speed"
        );
        assert!(split_suffix("wire.diameter").is_none());
    }

    #[test]
    fn five_thousand_rpm() {
        assert!((scaled(5000.0, Scale::Factor(PI / 30.0)) - 523.598_775_598).abs() < 1e-8);
    }
}
