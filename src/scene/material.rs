//! From a material's name and a diameter to the rigidities and limits of a round section.

use super::SceneError;
use super::impossible::si;
use super::problems::Problems;
use super::stress_strain::curve;
use crate::rod::{Hardening, InPieces, RoundLaws, Section};
use crate::settings::{SceneSettings, WireSettings};
use std::f64::consts::PI;

/// Stretch, bend and twist rigidities: elastic, then beyond yield.
#[derive(Clone, Copy)]
struct Rigidities {
    ea: f64,
    ea_p: f64,
    ei: f64,
    ei_p: f64,
    gj: f64,
    gj_p: f64,
}

/// A wire's section, and what else of its metal a run needs.
pub(super) struct Wire {
    pub(super) section: Section,
    /// laws that were integrated over the section; `None` where the material gives rigidities
    pub(super) laws: Option<RoundLaws>,
    /// at 20 degC, ohm m
    pub(super) resistivity: f64,
}

/// The paper's Table 1: EA, EA', EI, EI', GJ, GJ' of its 0.7 mm wire. EI is 2.0 and GJ 3.8 times
/// that of a solid section, so there is no law to scale them with.
const TABLE1: Rigidities = Rigidities {
    ea: 48.9e3,
    ea_p: 1.10e3,
    ei: 3.06e-3,
    ei_p: 1.13e-4,
    gj: 4.32e-3,
    gj_p: 9.0e-5,
};
const TABLE1_DIAMETER: f64 = 0.7e-3;

/// Copper, Young's modulus, Pa: EA of Table 1 over its area, and EI = E I to the digits printed.
const COPPER_E: f64 = 127.0e9;
/// Copper, shear modulus, Pa: Poisson's ratio 0.326.
const COPPER_G: f64 = 47.9e9;
/// Copper, tangent modulus beyond yield, Pa: EA' of Table 1 over its area.
const COPPER_ET: f64 = 2.86e9;
/// Copper, tangent shear modulus beyond yield, Pa: a third of the tangent modulus (no change of
/// volume in plastic flow).
const COPPER_GT: f64 = COPPER_ET / 3.0;

fn copper(d: f64) -> Rigidities {
    let area = PI * d * d / 4.0;
    let second_moment = PI * d.powi(4) / 64.0;
    let polar_moment = 2.0 * second_moment;
    Rigidities {
        ea: COPPER_E * area,
        ea_p: COPPER_ET * area,
        ei: COPPER_E * second_moment,
        ei_p: COPPER_ET * second_moment,
        gj: COPPER_G * polar_moment,
        gj_p: COPPER_GT * polar_moment,
    }
}

/// `given` where it is not 0, else `derived`.
fn or(given: f64, derived: f64) -> f64 {
    if given > 0.0 { given } else { derived }
}

/// What a section of this radius has by its laws.
fn of_laws(laws: &RoundLaws) -> Rigidities {
    Rigidities {
        ea: laws.stretch.elastic,
        ea_p: laws.stretch.tangent,
        ei: laws.bend.elastic,
        ei_p: laws.bend.tangent,
        gj: laws.twist.elastic,
        gj_p: laws.twist.tangent,
    }
}

/// Thickest enamel: the outer diameter over the bare one. Chosen: grade 3 of the finest wire of IEC 60317-0-1 has 1.6.
const THICKEST: f64 = 2.0;

/// Everything that is wrong with single leaves of the wire.
fn check_leaves(settings: &SceneSettings) -> Result<(), SceneError> {
    let wire = &settings.wire;
    let mut problems = Problems::default();
    // 0 stands for that of the material
    for (key, value, least, unit) in [
        ("wire.density", wire.density, 100.0, "kg/m3"),
        ("wire.yield_stress", wire.yield_stress, 1e5, "Pa"),
        ("wire.flow_stress", wire.flow_stress, 1e5, "Pa"),
        ("wire.resistivity", wire.resistivity, 1e-9, "Ohm.m"),
    ] {
        if value > 0.0 && value < least {
            let allowed = format!(
                "at least {} {unit}, or 0 for that of the material",
                si(least)
            );
            problems.add(settings.impossible(key, "less than any metal has", allowed));
        }
    }
    let (outer, most) = (wire.enamelled_diameter, THICKEST * wire.diameter);
    if outer > 0.0 && !(wire.diameter..=most).contains(&outer) {
        let reason = match outer < wire.diameter {
            true => "thinner than the bare wire",
            false => "the enamel would be thicker than the bare wire's radius",
        };
        let allowed = format!(
            "{} to {} m (one to {THICKEST} bare diameters), or 0 for bare wire",
            si(wire.diameter),
            si(most)
        );
        problems.add(settings.impossible("wire.enamelled_diameter", reason, allowed));
    }
    problems.finish()
}

/// The section of a wire, or what contradicts itself.
///
/// Rigidities and limits go with the bare diameter. Those of `copper` and `table1` have the limits of a
/// rigid-perfectly-plastic round section at the yield stress `s`: `N_y = s A`, `M_y = s d^3/6`,
/// `T_y = s/sqrt(3) pi d^3/12`. Those of the other metals, and of points of a curve, are integrated.
pub(super) fn section(settings: &SceneSettings) -> Result<Wire, SceneError> {
    let mut problems = Problems::default();
    problems.note(check_leaves(settings));
    let curve = problems.note(curve(settings)).flatten();
    problems.finish()?;
    let wire = &settings.wire;
    let d = wire.diameter;
    let metal = wire.metal();
    let laws = curve.map(|(curve, shear)| {
        // what was given for a law makes it bilinear; the metals of the library have two points
        let points = !wire.stress_strain.is_empty();
        let in_pieces = InPieces {
            bend: points && [wire.ei, wire.ei_p, wire.m_y] == [0.0; 3],
            // (custom wire gives its shear modulus so)
            twist: points
                && (wire.gj == 0.0 || wire.material == "custom")
                && [wire.gj_p, wire.t_y] == [0.0; 2],
        };
        let laws = curve.round(0.5 * d, shear, in_pieces);
        (laws, curve.yield_stress(), curve.last_stress())
    });
    let of_material = match (wire.material.as_str(), &laws) {
        (_, Some((laws, ..))) => Some(of_laws(laws)),
        ("copper", _) => Some(copper(d)),
        ("table1", _) if (d - TABLE1_DIAMETER).abs() > 1e-12 => {
            return Err(settings.impossible(
                "wire.diameter",
                "the paper gives the rigidities of wire.material = table1 for 0.7 mm only",
                "0.0007 m, or wire.material copper or custom",
            ));
        }
        ("table1", _) => Some(TABLE1),
        _ => None,
    };
    let rigidities = rigidities(settings, of_material)?;

    let area = PI * d * d / 4.0;
    let d3 = d * d * d;
    let elastic = |limit: f64| if wire.elastic { f64::INFINITY } else { limit };
    let (yield_stress, flow_stress) = match laws {
        Some((_, first, last)) => (first, last),
        None => (metal.yield_stress, metal.flow_stress),
    };
    let [n_y, m_y, t_y, cap] = match laws {
        Some((laws, ..)) => [
            laws.stretch.limit,
            laws.bend.limit,
            laws.twist.limit,
            laws.moment_cap,
        ],
        None => [
            yield_stress * area,
            yield_stress * d3 / 6.0,
            yield_stress / 3.0_f64.sqrt() * PI * d3 / 12.0,
            match wire.material.as_str() {
                "copper" => flow_stress * d3 / 6.0,
                _ => f64::INFINITY,
            },
        ],
    };
    let section = Section {
        diameter: wire.outer_diameter(),
        bare_diameter: d,
        density: metal.density,
        enamel_density: wire.enamel_density,
        ea: rigidities.ea,
        ea_p: rigidities.ea_p,
        ei: rigidities.ei,
        ei_p: rigidities.ei_p,
        gj: rigidities.gj,
        gj_p: rigidities.gj_p,
        n_y: elastic(or(wire.n_y, n_y)),
        m_y: elastic(or(wire.m_y, m_y)),
        t_y: elastic(or(wire.t_y, t_y)),
        moment_cap: elastic(or(wire.moment_cap, cap)),
        strength: or(wire.strength, elastic(flow_stress * area)),
        hardening: laws.map_or(Hardening::default(), |(laws, ..)| laws.hardening),
    };
    if section.moment_cap < section.m_y {
        let (key, allowed) = if wire.moment_cap > 0.0 {
            (
                "wire.moment_cap",
                format!("at least {} N.m", si(section.m_y)),
            )
        } else if wire.m_y <= 0.0
            && settings.origins.contains_key("wire.yield_stress")
            && !settings.origins.contains_key("wire.flow_stress")
        {
            let most = format!("at most wire.flow_stress, {} Pa", si(flow_stress));
            ("wire.yield_stress", most)
        } else if wire.m_y > 0.0 && laws.is_some() {
            ("wire.M_y", format!("at most {} N.m", si(cap)))
        } else {
            (
                "wire.flow_stress",
                format!("at least {} Pa", si(6.0 * section.m_y / d3)),
            )
        };
        return Err(settings.impossible(
            key,
            "the wire would reach its moment cap before it yields",
            allowed,
        ));
    }
    Ok(Wire {
        section,
        laws: laws.map(|(laws, ..)| laws),
        resistivity: metal.resistivity,
    })
}

/// What was given, else of the material; the tangent beyond yield must be the softer one.
fn rigidities(
    settings: &SceneSettings,
    of_material: Option<Rigidities>,
) -> Result<Rigidities, SceneError> {
    let wire: &WireSettings = &settings.wire;
    if of_material.is_none() {
        let all = [
            ("wire.EA", wire.ea),
            ("wire.EAp", wire.ea_p),
            ("wire.EI", wire.ei),
            ("wire.EIp", wire.ei_p),
            ("wire.GJ", wire.gj),
            ("wire.GJp", wire.gj_p),
        ];
        let mut problems = Problems::default();
        for (key, _) in all.into_iter().filter(|(_, x)| *x <= 0.0) {
            let reason = "wire.material = custom needs every rigidity";
            problems.add(settings.impossible(key, reason, "more than 0"));
        }
        problems.finish()?;
    }
    let material = of_material.unwrap_or(Rigidities {
        ea: 0.0,
        ea_p: 0.0,
        ei: 0.0,
        ei_p: 0.0,
        gj: 0.0,
        gj_p: 0.0,
    });
    let found = Rigidities {
        ea: or(wire.ea, material.ea),
        ea_p: or(wire.ea_p, material.ea_p),
        ei: or(wire.ei, material.ei),
        ei_p: or(wire.ei_p, material.ei_p),
        gj: or(wire.gj, material.gj),
        gj_p: or(wire.gj_p, material.gj_p),
    };
    // H = EI EI'/(EI - EI') has a pole where the two are equal. An elastic wire never gets there.
    let pairs = [
        ("wire.EAp", "wire.EA", found.ea_p, found.ea, "N"),
        ("wire.EIp", "wire.EI", found.ei_p, found.ei, "N.m2"),
        ("wire.GJp", "wire.GJ", found.gj_p, found.gj, "N.m2"),
    ];
    let mut problems = Problems::default();
    for (key_p, key, tangent, elastic, unit) in pairs {
        if tangent >= elastic && !wire.elastic {
            // Blame the one the user gave.
            let (blamed, allowed) = match settings.origins.contains_key(key_p) {
                true => (key_p, format!("less than {key}, {} {unit}", si(elastic))),
                false => (key, format!("more than {key_p}, {} {unit}", si(tangent))),
            };
            let reason = "beyond yield the wire must be softer than before";
            problems.add(settings.impossible(blamed, reason, allowed));
        }
    }
    problems.finish()?;
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `x` at the number of significant digits that were printed.
    fn digits(x: f64, n: usize) -> String {
        format!("{x:.*e}", n - 1)
    }

    #[test]
    fn copper_reproduces_the_published_variant() {
        let s = section(&SceneSettings::default()).unwrap().section;
        for (x, printed, n) in [
            (s.ea, 48900.0, 3),
            (s.ea_p, 1100.0, 3),
            (s.ei, 0.001497, 4),
            (s.ei_p, 3.37e-5, 3),
            (s.gj, 0.00113, 3),
            (s.gj_p, 2.25e-5, 3),
            (s.moment_cap, 0.0126, 3),
        ] {
            assert_eq!(digits(x, n), digits(printed, n));
        }
        assert!((s.strength - 84.67).abs() < 0.01);
    }

    #[test]
    fn copper_scales_with_the_diameter() {
        let mut settings = SceneSettings::default();
        let thin = section(&settings).unwrap().section;
        settings
            .set("wire.diameter_mm", crate::variables::Value::Real(1.4))
            .unwrap();
        let thick = section(&settings).unwrap().section;
        for (ratio, power) in [
            (thick.ea / thin.ea, 2),
            (thick.ei_p / thin.ei_p, 4),
            (thick.gj / thin.gj, 4),
            (thick.m_y / thin.m_y, 3),
            (thick.moment_cap / thin.moment_cap, 3),
            (thick.strength / thin.strength, 2),
        ] {
            assert!(
                (ratio / 2.0_f64.powi(power) - 1.0).abs() < 1e-12,
                "{ratio} {power}"
            );
        }
    }

    #[test]
    fn elastic_wire_has_no_limits_but_a_given_strength() {
        let mut settings = SceneSettings::default();
        settings.wire.elastic = true;
        let s = section(&settings).unwrap().section;
        assert!(
            [s.n_y, s.m_y, s.t_y, s.moment_cap, s.strength]
                .iter()
                .all(|x| x.is_infinite())
        );
        settings.wire.strength = 50.0;
        assert_eq!(section(&settings).unwrap().section.strength, 50.0);
    }
}
