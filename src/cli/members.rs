//! How the members of an ensemble differ: in the nozzle's distance, which no machine sets to the tenth of a millimetre.

use coilwind::scene::SceneError;
use coilwind::settings::SceneSettings;

/// Nozzle distances of the outer members about that of the scene, wire diameters: what setting a machine up leaves open.
const SPREAD: f64 = 0.5;
/// Digits of a distance: it reads as people write it, and no member is moved by rounding.
const DIGITS: usize = 9;
/// What is set, with its unit.
const VARIABLE: &str = "nozzle.distance_mm";

/// The setting that makes member `member` (from 1) of `count` out of these settings; `None` for an ensemble of one.
pub(super) fn setting(
    settings: &SceneSettings,
    member: u32,
    count: u32,
) -> Option<(String, String)> {
    if count < 2 {
        return None;
    }
    let share = 2.0 * f64::from(member - 1) / f64::from(count - 1) - 1.0;
    let distance =
        1e3 * (settings.nozzle.distance + SPREAD * settings.wire.outer_diameter() * share);
    Some((VARIABLE.to_owned(), rounded(distance, DIGITS).to_string()))
}

/// Makes these settings those of a member.
///
/// # Errors
/// A distance outside the range of the variable.
pub(super) fn vary(
    settings: &mut SceneSettings,
    member: u32,
    count: u32,
) -> Result<(), SceneError> {
    match setting(settings, member, count) {
        Some((name, value)) => settings.set_text(&name, &value),
        None => Ok(()),
    }
}

/// A number to so many significant digits.
pub(super) fn rounded(x: f64, digits: usize) -> f64 {
    let text = format!("{x:.*e}", digits - 1);
    text.parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn members_are_evenly_spread_about_the_scene() {
        let settings = SceneSettings::default();
        let set = |k| setting(&settings, k, 8).unwrap().1;
        let distances: Vec<String> = (1..=8).map(set).collect();
        let expected = [
            "59.65", "59.75", "59.85", "59.95", "60.05", "60.15", "60.25", "60.35",
        ];
        assert_eq!(distances, expected);
        assert_eq!(setting(&settings, 1, 1), None);
        assert_eq!(setting(&settings, 2, 3).unwrap().1, "60");
    }
}
