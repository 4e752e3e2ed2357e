//! The straight wire of the start: from the clamp past the core to the nozzle.

use crate::geometry::Surface;
use crate::math::{Spin, V3};
use crate::scene::{Scene, si};
use crate::simulation::SimError;
use crate::simulation::winding::ROUNDING;
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

/// Checks that straight wire leads from the `clamp` (core frame, m) to the `nozzle` (m) with the core turned to `angle`, rad, past
/// the core and its flanges. What is told of wire that lies in them no deeper than contact pushes out again.
///
/// # Errors
///
/// If the axis of the wire goes through one, with the places of the nozzle from which wire leads past it.
pub(super) fn check_way(
    scene: &Scene,
    surface: &Surface,
    (clamp, nozzle): (V3, V3),
    angle: f64,
) -> Result<Option<String>, SimError> {
    let (spin, radius) = (Spin::new(angle), scene.wire.radius());
    let nearest = |y: f64| {
        let nozzle = spin.to_core(V3::new(nozzle.x, y, nozzle.z));
        places(scene, surface, clamp, nozzle)
            .map(|place| (surface.nearest(place).distance, place))
            .min_by(|a, b| a.0.total_cmp(&b.0))
    };
    // wire that is clamped between two walls is as deep in them at the clamp
    let free = radius.min(surface.nearest(clamp).distance);
    let lies_free = |y: f64, depth: f64| nearest(y).is_none_or(|(at, _)| at >= free - depth);
    // wire that is less deep is not told from wire outside
    let told = scene.solver.tolerance;
    let Some((distance, place)) = nearest(nozzle.y).filter(|_| !lies_free(nozzle.y, told)) else {
        return Ok(None);
    };
    let from_to = format!(
        "straight wire from the clamp at y = {} m to the nozzle at y = {} m",
        si(clamp.y),
        si(nozzle.y)
    );
    // (rounding does not lead an end of the advised places beyond what is told)
    let clear = |y: f64| lies_free(y, 0.5 * told);
    if distance < 0.0 {
        let passes = |y: f64| nearest(y).is_none_or(|(distance, _)| distance >= 0.0);
        let remedy = match clear(clamp.y) {
            true => remedy(scene, (clamp.y, nozzle.y), clear),
            false => remedy(scene, (clamp.y, nozzle.y), passes),
        };
        return Err(SimError::setup(format!(
            "{from_to} goes through the core or a flange, {} m deep at y = {} m; {remedy}",
            si(-distance),
            si(place.y)
        )));
    }
    let (depth, remedy) = (radius - distance, remedy(scene, (clamp.y, nozzle.y), clear));
    Ok(Some(format!(
        "{from_to} lies up to {} m ({:.2} diameters) deep in the core or a flange, at y = {} m, and is pushed out at the start; {remedy}",
        si(depth),
        0.5 * depth / radius,
        si(place.y)
    )))
}

/// What to set so that wire from the clamp `passes` on its way to the nozzle, at these places along y, m.
fn remedy(scene: &Scene, (clamp, nozzle): (f64, f64), passes: impl Fn(f64) -> bool) -> String {
    if passes(clamp) {
        let last = last_clear(clamp, nozzle, passes);
        let (low, high) = (clamp.min(last), clamp.max(last));
        // a nozzle that leads begins elsewhere than its key says
        let ahead = nozzle - scene.nozzle.y_start;
        let leads = scene.traverse.lead != 0.0 && nozzle == scene.nozzle_law.position(0.0);
        if leads && scene.nozzle_law.pitch().is_some() {
            // the first turn has its place in the layers
            let sense = scene.nozzle_law.sense();
            let lead = |y: f64| {
                let lead = scene.traverse.lead + sense * (y - nozzle);
                // (what rounding leaves of none)
                if lead.abs() > ROUNDING * nozzle.abs() {
                    lead
                } else {
                    0.0
                }
            };
            let (one, other) = (lead(low), lead(high));
            format!(
                "set traverse.lead between {} and {} m instead of {} m",
                si(one.min(other)),
                si(one.max(other)),
                si(scene.traverse.lead)
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
    }
}

#[cfg(test)]
mod tests {
    use crate::settings::{NozzleFollows, SceneSettings};
    use crate::simulation::Simulation;
    use std::path::Path;

    /// What is told of the start of a scene, or why it has none.
    fn start_of(text: &str) -> Result<Vec<String>, String> {
        let settings =
            SceneSettings::from_toml_str(text, "scene.toml", Path::new("")).expect("reads");
        let (scene, _) = settings.build_for(NozzleFollows::Input).expect("a scene");
        let mut started = Simulation::new(&scene).map_err(|error| error.to_string())?;
        let events = started.drain_events().into_iter();
        Ok(events.map(|event| event.text).collect())
    }

    /// The number after these words.
    fn number_after(told: &str, words: &str) -> f64 {
        let (_, rest) = told.split_once(words).expect(told);
        rest.split(' ')
            .next()
            .expect("a word")
            .parse()
            .expect("a number")
    }

    /// Flanges 5 mm from the middle and 6 mm high; the wire is clamped beside the lower one.
    fn started(y: f64) -> Result<Vec<String>, String> {
        let text = format!(
            "[core.flange]\ninner_distance_mm = 10\nheight_mm = 6\nthickness_mm = 2\n\
             [start]\nclamp_y_mm = -4.6\n[nozzle]\ny_start = {y:e}"
        );
        start_of(&text)
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
        // (the wire, and not its axis alone, has to pass the face at -5 mm)
        assert!((-5e-3..-4.6e-3).contains(&least), "{told}");
        assert_eq!(started(least).expect("a place in that range"), [""; 0]);
        let beyond = started(least - 2e-5).expect("a place beyond it, where the axis passes");
        assert!(beyond[0].contains("is pushed out"), "{beyond:?}");
    }

    /// The place of the nozzle was told for its key, which a lead sets apart, and what was advised was refused.
    #[test]
    fn a_nozzle_that_leads_is_told_its_key() {
        let start = |y_mm: f64| {
            let text = format!(
                "[core.flange]\ninner_distance_mm = 10\nheight_mm = 6\nthickness_mm = 2\n[start]\nclamp_y_mm = -4.6\n\
                 [nozzle]\ny_start_mm = {y_mm}\n[traverse]\nmode = 'by-angle'\nlead_mm = -6"
            );
            start_of(&text)
        };
        let told = start(-4.6).expect_err("wire through a flange");
        let least = number_after(&told, "nozzle.y_start between ");
        assert_eq!(start(1e3 * least).expect("a place in that range"), [""; 0]);
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
            start_of(&text)
        };
        let told = start(-1.5).expect_err("wire through a flange");
        assert!(!told.contains("y_start between"), "{told}");
        let least = 1e3 * number_after(&told, "set traverse.lead between ");
        assert!(told.ends_with("and 0 m instead of -0.0015 m"), "{told}");
        assert_eq!(start(least).expect("a lead in that range"), [""; 0]);
        // Wire of which less than half was in the flange was pushed out without a word.
        for (lead_mm, depth) in [(-0.85, 0.28), (-0.3, 0.1), (least - 0.01, 0.002)] {
            let told = start(lead_mm).expect("the axis passes").concat();
            let told_depth = 1e3 * number_after(&told, "lies up to ");
            assert!((depth..depth + 0.01).contains(&told_depth), "{told}");
            let advised = 1e3 * number_after(&told, "set traverse.lead between ");
            assert!((advised - least).abs() < 1e-5, "{told}");
        }
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
