//! The stress-strain curve that a section is integrated from: points of the scene, or a metal of the library.

use super::SceneError;
use super::impossible::si;
use crate::rod::{FlowCurve, FlowCurveError, MOST_STRAIN};
use crate::settings::SceneSettings;
use std::f64::consts::PI;

const KEY: &str = "wire.stress_strain";

/// Poisson's ratio of `wire.material = copper`: that of its E and G.
const COPPER_POISSON: f64 = 0.326;

/// The curve and the shear modulus, Pa; `None` where the material gives rigidities instead.
pub(super) fn curve(settings: &SceneSettings) -> Result<Option<(FlowCurve, f64)>, SceneError> {
    let wire = &settings.wire;
    let metal = wire.metal();
    if wire.stress_strain.is_empty() {
        let Some(elastic) = metal.elastic else {
            return Ok(None);
        };
        let curve = elastic.curve(metal.yield_stress, metal.flow_stress);
        let curve =
            curve.ok_or_else(|| no_hardening(settings, elastic.modulus * elastic.elongation))?;
        return Ok(Some((curve, elastic.shear_modulus())));
    }
    for (key, given) in [
        ("wire.yield_stress", wire.yield_stress),
        ("wire.flow_stress", wire.flow_stress),
    ] {
        if given > 0.0 {
            let reason = "the points of wire.stress_strain say it already";
            return Err(settings.impossible(key, reason, "0, or no wire.stress_strain"));
        }
    }
    let curve = points(&wire.stress_strain)
        .and_then(|points| FlowCurve::new(points.clone()).map_err(|error| words(&error, &points)))
        .map_err(|(reason, allowed)| settings.impossible(KEY, reason, allowed))?;
    let poisson = match wire.material.as_str() {
        "table1" => {
            let reason = "wire.material = table1 has the laws that the paper gives it";
            return Err(settings.impossible(KEY, reason, "another wire.material, or no points"));
        }
        // what else a custom wire needs is told with its other rigidities
        "custom" if wire.gj > 0.0 => {
            let polar_moment = PI * wire.diameter.powi(4) / 32.0;
            return Ok(Some((curve, wire.gj / polar_moment)));
        }
        "custom" => {
            let reason = "points of tension do not say how stiff a custom wire is in torsion";
            return Err(settings.impossible("wire.GJ", reason, "more than 0"));
        }
        _ => metal.elastic.map_or(COPPER_POISSON, |e| e.poisson),
    };
    let shear = 0.5 * curve.modulus() / (1.0 + poisson);
    Ok(Some((curve, shear)))
}

/// The metal's yield stress is not below the stress at break.
fn no_hardening(settings: &SceneSettings, most: f64) -> SceneError {
    let metal = settings.wire.metal();
    let key = match settings.wire.flow_stress > 0.0 && settings.wire.yield_stress == 0.0 {
        true => "wire.flow_stress",
        false => "wire.yield_stress",
    };
    let allowed = match key {
        "wire.flow_stress" => format!(
            "more than wire.yield_stress, {} Pa, and less than {} Pa",
            si(metal.yield_stress),
            si(most)
        ),
        _ => format!("less than wire.flow_stress, {} Pa", si(metal.flow_stress)),
    };
    settings.impossible(key, "the wire has to harden from yield to break", allowed)
}

/// Reason and what is allowed.
type Wrong = (String, String);

/// The numbers of `[[strain, stress], ...]`.
fn points(text: &str) -> Result<Vec<[f64; 2]>, Wrong> {
    serde_json::from_str(text).map_err(|error| {
        (
            format!("the points cannot be read ({error})"),
            "pairs of strain and stress in Pa, as [[0.0008, 90e6], [0.05, 150e6], [0.3, 220e6]]"
                .to_owned(),
        )
    })
}

fn words(error: &FlowCurveError, points: &[[f64; 2]]) -> Wrong {
    let point = |number: usize| {
        let [strain, stress] = points[number - 1];
        format!("point {number}, [{}, {}],", si(strain), si(stress))
    };
    let (reason, allowed) = match *error {
        FlowCurveError::TooFew => (
            "one point says no hardening".to_owned(),
            "two points or more: yield, and where hardening ends".to_owned(),
        ),
        FlowCurveError::NotPositive(n) => (
            format!("{} is not above 0", point(n)),
            "strains and stresses above 0; the curve begins at yield".to_owned(),
        ),
        FlowCurveError::StrainFalls(n) => (
            format!("{} is out of order", point(n)),
            format!("strains that rise, here above {}", si(points[n - 2][0])),
        ),
        FlowCurveError::StressFalls(n) => (
            format!("{} has no more stress than the one before", point(n)),
            format!("stresses that rise, here above {} Pa", si(points[n - 2][1])),
        ),
        FlowCurveError::Steepens(n) => (
            format!("the curve up to {} is not flatter than before", point(n)),
            "hardening that fades: each piece no steeper than the one before".to_owned(),
        ),
        FlowCurveError::TooFar(n) => (
            format!("{} has too large a strain", point(n)),
            format!("strains up to {MOST_STRAIN}"),
        ),
    };
    (reason, allowed)
}
