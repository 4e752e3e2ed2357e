//! What a message says would do, does.

use crate::common::{assert_says, parse, refused};

/// Three layers between flanges of 4 mm, led onto their places.
const LED: &str = "[wire]\ndiameter_mm = 0.5\nenamelled_diameter_mm = 0.56\nmaterial = 'copper-soft'\n\
                   [core]\nshape = 'cylinder'\nradius_mm = 7\n\
                   [core.flange]\ninner_distance_mm = 8.1\nheight_mm = 4\nthickness_mm = 1.5\n\
                   [nozzle]\ndistance_mm = 14\ny_start_mm = -3.77\n[start]\nclamp_y_mm = -3.77\n\
                   [tensioner]\ntension = 8\n[winding]\nlayers = 3\n\
                   [traverse]\nmode = 'orthocyclic'\ntrail = 'led'\ncrossover_deg = 120\n";

fn led(distance: &str, crossover: &str) -> String {
    LED.replace("distance_mm = 14\ny", &format!("distance{distance}\ny"))
        .replace("crossover_deg = 120", &format!("crossover{crossover}"))
}

/// The number after some words of a message.
fn number_after<'a>(said: &'a str, words: &str) -> &'a str {
    let rest = said.split(words).nth(1).expect("the words");
    rest.split(' ').next().expect("a number")
}

/// The way out was a distance below that which was given, whatever it was.
#[test]
fn a_distance_from_which_a_trail_can_be_led_is_one() {
    for distance in ["_mm = 100", "_mm = 99", "_mm = 300"] {
        let said = refused(&led(distance, "_deg = 120"));
        assert_says(&said, &["traverse.trail = led", "allowed: free; or a "]);
        let most = number_after(&said, "nozzle.distance of at most ");
        assert!(most.starts_with("0.02"), "{said}");
        let text = led(&format!(" = {most}"), "_deg = 120");
        parse(&text).unwrap().build().expect("near enough");
    }
    // wire that crosses at once is led from nowhere
    let said = refused(&led("_mm = 100", "_deg = 20"));
    let words = "nozzle.distance of at most ";
    let most = number_after(&said, words);
    assert_says(&said, &["m with a traverse.crossover of 6 rad, or a core"]);
    let text = led(&format!(" = {most}"), " = 6");
    parse(&text).unwrap().build().expect("near enough");
}

/// A nozzle that leads swings the farther the farther it is from the core; to move it there was the advice.
#[test]
fn a_nozzle_that_leads_past_a_flange_is_told_to_swing_less() {
    let warned = |text: &str| -> Vec<String> {
        let (_, warnings) = parse(text).unwrap().build_with_warnings().unwrap();
        let warnings = warnings.iter().map(ToString::to_string);
        warnings.filter(|said| said.contains("rim")).collect()
    };
    let said = warned(LED);
    assert_eq!(said.len(), 1, "{said:?}");
    assert_says(&said[0], &["traverse.crossover", "nearer to the core"]);
    assert!(!said[0].contains("farther"), "{}", said[0]);
    let goes_to = |said: &str| -> f64 { number_after(said, "goes to ").parse().expect("a place") };
    let nearer = warned(&led("_mm = 12", "_deg = 120"));
    assert!(goes_to(&nearer[0]) < goes_to(&said[0]), "{nearer:?}");
    for better in [
        led("_mm = 14", "_deg = 180"),
        LED.replace("'led'", "'free'"),
    ] {
        assert!(warned(&better).is_empty(), "{better}");
    }
}

/// Flanges of a file were to be lowered by a key of the flanges that the scene does not have.
#[test]
fn lower_flanges_are_those_of_the_scene_or_of_the_file() {
    let inside = "the nozzle is inside the circle the turning flanges need";
    let of_the_scene = refused(&led("_mm = 11.2", "_deg = 120"));
    assert_says(&of_the_scene, &[inside, "or a lower core.flange.height"]);

    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("bobbin.stl");
    let outline = [
        [-6.0, 11.0],
        [-4.0, 11.0],
        [-4.0, 7.0],
        [4.0, 7.0],
        [4.0, 11.0],
        [6.0, 11.0],
    ];
    crate::stl::write_revolved(&file, &outline, 90);
    let scene = format!("[core]\nshape = 'mesh'\nfile = {file:?}\n[nozzle]\ndistance_mm = 11.2\n");
    let of_the_file = refused(&scene);
    assert_says(&of_the_file, &[inside, "or a core.file with lower flanges"]);
    assert!(!of_the_file.contains("core.flange"), "{of_the_file}");
}

/// A single allowed place was named, and neither why there is one nor what gives more room.
#[test]
fn a_pitch_of_0_leaves_one_start_and_its_refusal_says_why() {
    let text = |more: &str| {
        format!(
            "[core]\nshape = 'cylinder'\n[core.flange]\ninner_distance_mm = 4.3\n[wire]\ndiameter_mm = 0.5\n\
             [traverse]\nmode = 'orthocyclic'\n[winding]\nturns_per_layer = 8\nlayers = 3\n{more}"
        )
    };
    assert_says(
        &refused(&text("[nozzle]\ny_start = 0\n")),
        &[
            "nozzle.y_start = 0 m",
            "allowed: -0.0019 m, since winding.pitch = 0 spreads the turns over the whole window; \
             or -0.0019 to -0.00185 m with winding.pitch = 0.0005 m",
        ],
    );
    assert_says(
        &refused(&text("pitch_mm = 0.5\n[nozzle]\ny_start = 0\n")),
        &["allowed: -0.0019 to -0.00185 m"],
    );
    let place = "pitch_mm = 0.5\n[nozzle]\ny_start_mm = -1.87\n[start]\nclamp_y_mm = -1.87\n";
    assert!(parse(&text(place)).is_ok_and(|settings| settings.build().is_ok()));
}

/// A travel was refused with one that was refused in turn: the whole window holds it only from the flange on.
#[test]
fn a_travel_that_fits_is_named_with_where_it_begins() {
    let text = |per_turn: f64, start: f64| {
        format!(
            "[core]\nshape = 'cylinder'\n[core.flange]\ninner_distance_mm = 4.3\n[wire]\ndiameter_mm = 0.5\n\
             [spindle]\nturns = 12\n[traverse]\nper_turn = {per_turn}\n\
             [nozzle]\ny_start = {start}\n[start]\nclamp_y = {start}\n"
        )
    };
    for (per_turn, first, fits) in [
        (0.7e-3, "-0.0019", 0.345_454e-3),
        (-0.7e-3, "0.0019", -0.345_454e-3),
    ] {
        let way = format!("at most 0.000345454 m for 12 turns from nozzle.y_start = {first} m on");
        assert_says(&refused(&text(per_turn, 0.0)), &["traverse.per_turn", &way]);
        let fits = text(fits, first.parse().expect("a number"));
        assert!(
            parse(&fits).is_ok_and(|settings| settings.build().is_ok()),
            "{fits}"
        );
    }
}

/// At the default distance turn 2 of a small box was laid on turn 1 and fell off with slack, and nothing said so before the run.
#[test]
fn a_nozzle_so_far_that_turn_2_begins_on_turn_1_is_told() {
    let box_of = |more: &str, nozzle: &str| -> Option<String> {
        let text = format!(
            "[core]\nwidth_x_mm = 20\nheight_z_mm = 11\ncorner_radius_mm = 2\n[core.flange]\ninner_distance_mm = 6.8\nheight_mm = 4\n\
             [wire]\ndiameter_mm = 0.56\n[winding]\nlayers = 1\n[nozzle]\n{nozzle}\n[traverse]\nmode = 'orthocyclic'\n{more}\n"
        );
        let (_, warnings) = parse(&text).unwrap().build_with_warnings().unwrap();
        let mut told = warnings.into_iter();
        let told = told.find(|w| w.key == "nozzle.distance")?;
        assert!(told.message.contains("turn 2 begins"), "{}", told.message);
        Some(told.message)
    };
    let told = box_of("", "").unwrap();
    // what it says to do is enough, and no more than needed
    let after = |words: &str| -> f64 { number_after(&told, words).parse().unwrap() };
    let [most, least] = [after("bring it to "), after("traverse.advance to ")];
    let (near, less) = (1e3 * most, least - 2.0);
    assert_eq!(box_of("", &format!("distance_mm = {near}")), None);
    let beyond = format!("distance_mm = {}", near + 1.0);
    assert!(box_of("", &beyond).is_some());
    assert_eq!(box_of(&format!("advance_deg = {least}"), ""), None);
    assert!(box_of(&format!("advance_deg = {less}"), "").is_some());
    // without friction wire slides off at any place
    let slippery = "[friction]\nstatic = 0\nkinetic = 0";
    assert_eq!(box_of(slippery, ""), None);
}
