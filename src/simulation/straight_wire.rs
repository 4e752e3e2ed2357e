//! The straight wire of the start: from the clamp past the core to the nozzle.

use super::SimError;
use crate::geometry::Surface;
use crate::math::{Spin, V3};
use crate::scene::{Scene, si};
use std::f64::consts::FRAC_PI_2;

/// Depth of straight wire in the core that is none, as a share of the wire's radius.
const GRAZES: f64 = 1e-4;

/// The same where the core is turned until the wire passes, as far as that can be. It has to be within what contact takes for
/// outside: the landing of wire that begins deeper is not booked, and its rebound is.
const PASSES: f64 = 1e-6;

/// Halvings of an angle or a way until what passes is told from what does not.
const HALVINGS: u32 = 40;

/// Places where straight wire from the `clamp` to the `nozzle` may be in the core: all core frame, m.
fn places(
    scene: &Scene,
    surface: &Surface,
    clamp: V3,
    nozzle: V3,
) -> impl Iterator<Item = V3> + use<> {
    let (way, along) = ((nozzle - clamp).norm(), (nozzle - clamp).normalize());
    let spacing = 0.5 * scene.solver.spacing_near;
    let looks = (way.min(2.0 * surface.radius_max()) / spacing) as usize;
    (1..=looks).map(move |k| clamp + along * (spacing * k as f64))
}

/// Angle of the core, rad, at which straight wire from the `clamp` (core frame, m) to the `nozzle` (m) passes the core: as near to
/// `angle(0)` as can be. Wire that is clamped in a hollow leads over its edge. `angle` is that of a core turned back by so much.
pub(super) fn clear_angle(
    scene: &Scene,
    surface: &Surface,
    (clamp, nozzle): (V3, V3),
    angle: impl Fn(f64) -> f64,
) -> f64 {
    let radius = scene.wire.radius();
    let is_clear = |back: f64, depth: f64| {
        let nozzle = Spin::new(angle(back)).to_core(nozzle);
        places(scene, surface, clamp, nozzle)
            .all(|place| surface.nearest(place).distance > radius * (1.0 - depth))
    };
    if is_clear(0.0, GRAZES) {
        return angle(0.0);
    }
    // (wire that is clamped between two walls touches both wherever it leads, as deep as it is clamped)
    let least = |depth: f64| least_clear(|back| is_clear(back, depth));
    angle(least(PASSES).or_else(|| least(GRAZES)).unwrap_or(0.0))
}

/// The least angle, rad, up to a right one, that `passes`; none passes at 0.
fn least_clear(passes: impl Fn(f64) -> bool) -> Option<f64> {
    let (mut deep, mut clear) = (0.0, 1e-3);
    while !passes(clear) {
        (deep, clear) = (clear, 2.0 * clear);
        if clear > FRAC_PI_2 {
            return None;
        }
    }
    Some(last_clear(clear, deep, passes))
}

/// The value next to `blocked` that still passes, from a `clear` one on.
fn last_clear(mut clear: f64, mut blocked: f64, passes: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (blocked + clear);
        *(if passes(middle) {
            &mut clear
        } else {
            &mut blocked
        }) = middle;
    }
    clear
}

/// Checks that straight wire leads from the `clamp` (core frame, m) to the `nozzle` (m) with the core turned to `angle`, rad: that
/// its axis goes through no part of the core, such as a flange.
///
/// # Errors
///
/// If one does, with the places of the nozzle from which wire leads past it.
pub(super) fn check_way(
    scene: &Scene,
    surface: &Surface,
    (clamp, nozzle): (V3, V3),
    angle: f64,
) -> Result<(), SimError> {
    let spin = Spin::new(angle);
    let deepest = |y: f64| {
        let nozzle = spin.to_core(V3::new(nozzle.x, y, nozzle.z));
        places(scene, surface, clamp, nozzle)
            .map(|place| (surface.nearest(place).distance, place))
            .min_by(|a, b| a.0.total_cmp(&b.0))
    };
    let passes = |y: f64| deepest(y).is_none_or(|(distance, _)| distance >= 0.0);
    let Some((distance, place)) = deepest(nozzle.y).filter(|(distance, _)| *distance < 0.0) else {
        return Ok(());
    };
    let way = format!(
        "straight wire from the clamp at y = {} m to the nozzle at y = {} m goes through the core or a flange, {} m deep at y = {} m",
        si(clamp.y),
        si(nozzle.y),
        si(-distance),
        si(place.y)
    );
    let remedy = if passes(clamp.y) {
        let last = last_clear(clamp.y, nozzle.y, passes);
        let (low, high) = (clamp.y.min(last), clamp.y.max(last));
        // a nozzle that leads begins elsewhere than its key says
        let ahead = nozzle.y - scene.nozzle.y_start;
        let leads = scene.traverse.lead != 0.0 && nozzle.y == scene.nozzle_law.position(0.0);
        if leads && scene.nozzle_law.pitch().is_some() {
            // the first turn has its place in the layers
            let sense = scene.nozzle_law.sense();
            let lead = |y: f64| scene.traverse.lead + sense * (y - nozzle.y);
            let (one, other) = (lead(low), lead(high));
            format!(
                "set traverse.lead between {} and {} m",
                si(one.min(other)),
                si(one.max(other))
            )
        } else if leads {
            format!(
                "begin with nozzle.y_start between {} and {} m, or with a smaller traverse.lead, which has the nozzle {} m from there",
                si(low - ahead),
                si(high - ahead),
                si(ahead)
            )
        } else {
            format!(
                "begin with the nozzle (nozzle.y_start, or the input nozzle_position) between {} and {} m",
                si(low),
                si(high)
            )
        }
    } else {
        "move the clamp (start.clamp_y)".to_owned()
    };
    Err(SimError::setup(format!("{way}; {remedy}")))
}

#[cfg(test)]
mod tests {
    use super::super::Simulation;
    use crate::settings::SceneSettings;
    use std::path::Path;

    /// Flanges 5 mm from the middle and 6 mm high; the wire is clamped beside the lower one.
    fn started(y: f64) -> Result<(), String> {
        let text = format!(
            "[core.flange]\ninner_distance_mm = 10\nheight_mm = 6\nthickness_mm = 2\n\
             [start]\nclamp_y_mm = -4.6\n[nozzle]\ny_start = {y:e}"
        );
        let settings =
            SceneSettings::from_toml_str(&text, "scene.toml", Path::new("")).expect("reads");
        let scene = settings.build().expect("a scene");
        Simulation::new(&scene)
            .map(|_| ())
            .map_err(|error| error.to_string())
    }

    /// It was told as deep contact and a break at 0 s.
    #[test]
    fn a_start_through_a_flange_names_the_places_that_lead_past_it() {
        let told = started(-12e-3).expect_err("wire through a flange");
        assert!(told.contains("goes through the core or a flange"), "{told}");
        let least = told
            .split_once("between ")
            .and_then(|(_, rest)| rest.split_once(" and -0.0046 m"))
            .and_then(|(least, _)| least.parse::<f64>().ok())
            .expect("a range up to the clamp");
        assert!((-12e-3..-5e-3).contains(&least), "{told}");
        started(least + 1e-6).expect("a place in that range");
        started(least - 2e-5).expect_err("a place beyond it");
    }

    /// The place of the nozzle was told for its key, which a lead sets apart, and what was advised was refused.
    #[test]
    fn a_nozzle_that_leads_is_told_its_key() {
        let start = |y_mm: f64| {
            let text = format!(
                "[core.flange]\ninner_distance_mm = 10\nheight_mm = 6\nthickness_mm = 2\n[start]\nclamp_y_mm = -4.6\n\
                 [nozzle]\ny_start_mm = {y_mm}\n[traverse]\nmode = 'by-angle'\nlead_mm = -6"
            );
            let settings =
                SceneSettings::from_toml_str(&text, "scene.toml", Path::new("")).expect("reads");
            let started = Simulation::new(&settings.build().expect("a scene"));
            started.map(|_| ()).map_err(|error| error.to_string())
        };
        let told = start(-4.6).expect_err("wire through a flange");
        let (_, rest) = told.split_once("nozzle.y_start between ").expect("a range");
        let least = rest.split(' ').next().and_then(|y| y.parse::<f64>().ok());
        start(1e3 * least.expect("a number") + 1e-3).expect("a place in that range");
        assert!(told.contains("traverse.lead"), "{told}");
    }

    /// Places of the nozzle were advised that a plan of layers refuses, since its first turn has one place.
    #[test]
    fn a_nozzle_that_leads_in_layers_is_told_its_lead() {
        let start = |lead_mm: f64| {
            let text = format!(
                "[wire]\ndiameter_mm = 0.6\n[core]\nshape = 'cylinder'\nradius_mm = 6\n[core.flange]\ninner_distance_mm = 4\nheight_mm = 3\n\
                 [nozzle]\ndistance_mm = 20\ny_start_mm = -1.7\n[start]\nclamp_y_mm = -1.7\n[winding]\nlayers = 2\n\
                 [traverse]\nmode = 'helical'\nlead_mm = {lead_mm}"
            );
            let settings =
                SceneSettings::from_toml_str(&text, "scene.toml", Path::new("")).expect("reads");
            let started = Simulation::new(&settings.build().expect("a scene"));
            started.map(|_| ()).map_err(|error| error.to_string())
        };
        let told = start(-1.5).expect_err("wire through a flange");
        assert!(!told.contains("y_start between"), "{told}");
        let (_, rest) = told
            .split_once("set traverse.lead between ")
            .expect("a range");
        let least = rest.split(' ').next().and_then(|y| y.parse::<f64>().ok());
        let least = 1e3 * least.expect("a number");
        assert!((-1.0..-0.8).contains(&least), "{told}");
        start(least + 1e-3).expect("a lead in that range");
        start(least - 2e-2).expect_err("a lead beyond it");
    }

    #[test]
    fn a_clamp_in_a_flange_is_what_has_to_move() {
        let text = "[core]\nshape = 'cylinder'\n[core.flange]\ninner_distance_mm = 10\n[start]\nclamp_y_mm = 5.5\n\
                    [nozzle]\ny_start_mm = 4.6";
        let settings =
            SceneSettings::from_toml_str(text, "scene.toml", Path::new("")).expect("reads");
        let told = settings.build().map_err(|error| error.to_string());
        let told = told.and_then(|scene| {
            Simulation::new(&scene)
                .map(|_| ())
                .map_err(|e| e.to_string())
        });
        assert!(
            told.clone()
                .is_err_and(|told| told.contains("start.clamp_y")),
            "{told:?}"
        );
    }
}
