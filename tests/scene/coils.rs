//! Scenes of whole coils: flanges, turns in layers, nozzle ways from a table, and what cannot be wound.

use crate::common::{assert_says, parse, refused};
use coilwind::scene::{Core, Flange, NozzleLaw, Scene, Warning};
use coilwind::settings::SceneSettings;
use std::f64::consts::TAU;
use std::path::Path;

const BOBBIN: &str = "[core]\nshape = 'cylinder'\nradius_mm = 8\n[core.flange]\ninner_distance_mm = 14.5\nheight_mm = 4\n\
                      [start]\nclamp_y_mm = -6.9\n[nozzle]\ny_start_mm = -6.9\n[winding]\nlayers = 3\n[traverse]\n";

fn bobbin(more: &str) -> Scene {
    let text = format!("{BOBBIN}{more}");
    parse(&text)
        .expect("a scene")
        .build()
        .expect("it can be wound")
}

fn law(more: &str) -> NozzleLaw {
    bobbin(more).nozzle_law
}

#[test]
fn a_part_of_a_section_is_read_and_written() {
    let scene = bobbin("mode = 'helical'");
    let flange = Flange {
        inner_distance: 14.5e-3,
        height: 4e-3,
        thickness: 1e-3,
        edge_radius: 0.0,
    };
    assert_eq!(scene.core.flange(), Some(flange));
    assert!(matches!(scene.core, Core::Cylinder { .. }));
    let settings = parse(&format!("{BOBBIN}mode = 'helical'")).unwrap();
    let again = SceneSettings::from_toml_str(&settings.to_toml(), "again", Path::new("")).unwrap();
    assert_eq!(again.build().unwrap().nozzle_law, scene.nozzle_law);
    assert_eq!(again.build().unwrap().core, scene.core);
    // as written without a heading of its own
    let dotted = BOBBIN.replace(
        "[core.flange]\ninner_distance_mm",
        "flange.inner_distance_mm",
    );
    let dotted = dotted.replace("\nheight_mm", "\nflange.height_mm");
    let dotted = parse(&dotted).unwrap().build().unwrap();
    assert_eq!(dotted.core, scene.core);
}

#[test]
fn turns_that_fit_are_counted_and_fill_the_window() {
    // 14.5 mm hold twenty turns of 0.7 mm; half a turn more has room, so that every layer has twenty
    let law = law("mode = 'orthocyclic'");
    assert_eq!(law.turns(), 60.0);
    let pitch = (14.5e-3 - 0.7e-3) / 19.5;
    let first = -6.9e-3;
    let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} {b}");
    for turn in 0..60 {
        let (layer, k) = (turn / 20, f64::from(turn % 20));
        let place = match layer {
            0 | 2 => first + k * pitch,
            _ => first + 0.5 * pitch + (19.0 - k) * pitch,
        };
        // straight for 315 degrees, then a step
        for share in [0.0, 0.4, 0.87] {
            near(law.position((f64::from(turn) + share) * TAU), place);
        }
    }
    let half_way = law.position((1.0 - 0.125 / 2.0) * TAU);
    near(half_way, first + 0.5 * pitch);
}

#[test]
fn without_room_for_half_a_turn_every_other_layer_has_a_turn_less() {
    let narrow = BOBBIN.replace("14.5", "14.1").replace("-6.9", "-6.7");
    let text = format!("{narrow}mode = 'orthocyclic'");
    let scene = parse(&text).unwrap().build().unwrap();
    assert_eq!(scene.nozzle_law.turns(), 59.0);
    let pitch = (14.1e-3 - 0.7e-3) / 19.0;
    let second = scene.nozzle_law.position(20.0 * TAU);
    assert!((second - (6.7e-3 - 0.5 * pitch)).abs() < 1e-12, "{second}");
}

/// A window of one turn without room for half a turn more had one layer, whatever the scene asked for, and nothing said so.
#[test]
fn one_turn_a_layer_lies_turn_on_turn() {
    let slot = BOBBIN
        .replace("inner_distance_mm = 14.5", "inner_distance_mm = 0.75")
        .replace("-6.9", "0");
    let settings = parse(&format!("{slot}mode = 'orthocyclic'")).unwrap();
    let law = settings.build().unwrap().nozzle_law;
    assert_eq!(law.turns(), 3.0);
    for turn in 0..30 {
        assert_eq!(law.position(f64::from(turn) / 10.0 * TAU), 0.0);
    }
    // a climb a turn, over the last part of it
    let ends: Vec<_> = law.jumps().iter().map(|jump| jump[1] / TAU).collect();
    assert_eq!(ends, [1.0, 2.0]);
    // with room for half a turn, the layers lie side by side
    let wide = slot.replace("0.75", "1.1");
    let wide = parse(&format!("{wide}mode = 'orthocyclic'")).unwrap();
    let refused = wide.build().unwrap_err().to_string();
    assert_says(&refused, &["nozzle.y_start"]);
}

#[test]
fn an_even_traverse_goes_to_and_fro_and_dwells() {
    let law = law("mode = 'helical'\ndwell_turns = 0.5");
    let pitch = (14.5e-3 - 0.7e-3) / 19.5;
    let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} {b}");
    near(law.position(0.0), -6.9e-3);
    near(law.position(10.0 * TAU), -6.9e-3 + 10.0 * pitch);
    near(law.position(19.5 * TAU), 6.9e-3);
    near(law.position(20.0 * TAU), 6.9e-3);
    near(law.position(21.0 * TAU), 6.9e-3 - pitch);
    assert_eq!(law.sense(), 1.0);
    let down = BOBBIN
        .replace("-6.9", "6.9")
        .replace("layers = 3", "layers = 3\ndirection = '-y'");
    let down = parse(&format!("{down}mode = 'helical'"))
        .unwrap()
        .build()
        .unwrap();
    near(down.nozzle_law.position(10.0 * TAU), 6.9e-3 - 10.0 * pitch);
    assert_eq!(down.nozzle_law.sense(), -1.0);
}

#[test]
fn a_nozzle_ahead_of_its_law_is_where_the_law_would_be_later() {
    let plain = law("mode = 'orthocyclic'");
    let ahead = law("mode = 'orthocyclic'\nadvance_deg = 90");
    for k in 0..200 {
        let angle = 0.3 * f64::from(k);
        let later = plain.position(angle + 0.25 * TAU);
        assert!((ahead.position(angle) - later).abs() < 1e-15);
    }
    assert_eq!(ahead.turns(), plain.turns());
    assert_eq!(ahead.start(), plain.position(0.25 * TAU));
}

#[test]
fn a_lead_goes_with_the_direction_of_the_layer() {
    let plain = law("mode = 'orthocyclic'");
    let led = law("mode = 'orthocyclic'\nlead_mm = 0.5");
    for (turn, lead) in [(3.5, 0.5e-3), (25.5, -0.5e-3), (45.5, 0.5e-3)] {
        let more = led.position(turn * TAU) - plain.position(turn * TAU);
        assert!((more - lead).abs() < 1e-12, "{turn}: {more}");
    }
}

#[test]
fn a_table_gives_the_way() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write(
        "way.csv",
        "angle_deg, y_mm\n# from flange to flange\n0, -3\n720, 3\n1080, 3\n",
    );
    write("turns.csv", "turns,y\n0,-0.003\n2,0.003\n3,0.003\n");
    let scene = |file: &str| {
        let text = format!("[traverse]\nmode = 'table'\nfile = '{file}'\n");
        let settings = SceneSettings::from_toml_str(&text, "scene.toml", folder.path()).unwrap();
        settings.build()
    };
    let law = scene("way.csv").unwrap().nozzle_law;
    assert_eq!(law.turns(), 3.0);
    for (turns, y) in [(0.0, -3e-3), (1.0, 0.0), (2.0, 3e-3), (9.0, 3e-3)] {
        assert!((law.position(turns * TAU) - y).abs() < 1e-15);
    }
    assert_eq!(scene("turns.csv").unwrap().nozzle_law.turns(), 3.0);

    for (text, says) in [
        (
            "angle_deg,y_mm\n0,0\n360,1\n180,2\n",
            "line 4: the angle does not rise",
        ),
        (
            "angle_deg,y_mm\n10,0\n360,1\n",
            "line 2: the first angle is not 0",
        ),
        ("angle_deg,y_mm\n0,0\n360,x\n", "line 3: \"x\" is no number"),
        ("angle_deg,y_mm\n0,0\n", "less than two rows"),
        ("time,y_mm\n0,0\n", "its columns are time, y_mm"),
        ("turns;y_mm\n0;0,5\n", "semicolons stand between"),
        ("turns,y_mm\n0,0,5\n1,1,5\n", "decimal commas, save it"),
        (
            "turns,y_mm,y_m\n0,0,0\n1,1,1\n",
            "its columns y_mm and y_m tell the same",
        ),
        ("angle_deg,y_mm\n0,0\n360,90\n", "past an end of the core"),
    ] {
        write("bad.csv", text);
        assert_says(
            &scene("bad.csv").unwrap_err().to_string(),
            &["traverse.file", says],
        );
    }
    let missing = scene("none.csv").unwrap_err().to_string();
    assert_says(&missing, &["traverse.file", "cannot be opened"]);
}

/// What a table winds was held against the nozzle and the flanges with `[winding]` only.
#[test]
fn a_coil_of_a_table_that_grows_into_the_nozzle_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let mut way = "turns,y_mm\n".to_owned();
    for pass in 0..=9 {
        way += &format!("{},{}\n", pass * 20, if pass % 2 == 0 { -6.9 } else { 6.9 });
    }
    std::fs::write(folder.path().join("way.csv"), way).unwrap();
    let keys = |distance: &str| {
        let text = BOBBIN
            .replace("[winding]\nlayers = 3\n", "")
            .replace("[nozzle]", &format!("[nozzle]\ndistance_mm = {distance}"));
        let text = format!("{text}mode = 'table'\nfile = 'way.csv'\n");
        let settings = SceneSettings::from_toml_str(&text, "scene.toml", folder.path()).unwrap();
        let (_, warnings) = settings.build_with_warnings().unwrap();
        warnings
            .iter()
            .map(|w| (w.key, w.message.clone()))
            .collect::<Vec<_>>()
    };
    // nine layers of 0.7 mm over a radius of 8 mm stand up to 13.5 mm from the axis, above flanges of 4 mm
    let far = keys("14");
    assert!(
        far.iter().all(|(key, _)| *key != "nozzle.distance"),
        "{far:?}"
    );
    let near = keys("13.2");
    let told = near.iter().find(|(key, _)| *key == "nozzle.distance");
    let (_, message) = told.expect("the coil meets the nozzle");
    assert_says(message, &["9 times", "0.01354"]);
    assert!(near.iter().any(|(key, _)| *key == "core.flange.height"));
}

#[test]
fn what_cannot_be_wound_is_refused_with_the_key_to_change() {
    let with = |from: &str, to: &str| {
        let text = format!("{}mode = 'orthocyclic'", BOBBIN.replace(from, to));
        let built = parse(&text).and_then(|settings| settings.build());
        built.expect_err("must be refused").to_string()
    };
    for (from, to, says) in [
        (
            "inner_distance_mm = 14.5",
            "inner_distance_mm = 0.5",
            &[
                "core.flange.inner_distance",
                "the wire is wider than the flanges are apart",
                "at least 0.0007 m",
            ][..],
        ),
        (
            "height_mm = 4",
            "height_mm = 4\nedge_radius_mm = 2",
            &["core.flange.edge_radius", "0 to 0.0005 m"],
        ),
        (
            "layers = 3",
            "layers = 3\nturns_per_layer = 40",
            &["winding.turns_per_layer", "0.028 m", "at most 20"],
        ),
        (
            "layers = 3",
            "layers = 2.5",
            &["winding.layers", "not a whole number"],
        ),
        (
            "layers = 3",
            "layers = 3\npitch_mm = 0.5",
            &["winding.pitch", "0.0007 to 0.0014 m"],
        ),
        (
            "layers = 3",
            "layers = 90",
            &["nozzle.distance", "the coil meets the nozzle in layer 74"],
        ),
        (
            "y_start_mm = -6.9",
            "y_start_mm = 0",
            &["nozzle.y_start", "past a flange", "allowed: -0.0069 m"],
        ),
        (
            "clamp_y_mm = -6.9",
            "clamp_y_mm = -7.2",
            &["start.clamp_y", "clamped in a flange"],
        ),
        ("[core.flange]", "[core.flanje]", &["core.flanje"]),
        (
            "height_mm = 4",
            "heigth_mm = 4",
            &["core.flange.heigth_mm", "core.flange.height"],
        ),
    ] {
        assert_says(&with(from, to), says);
    }
    let endless = "[traverse]\nmode = 'helical'\n[winding]\nturns_per_layer = 90000\nlayers = 1000";
    assert_says(
        &refused(endless),
        &["winding.turns_per_layer", "at most 100000 turns in all"],
    );
    let open = "[traverse]\nmode = 'helical'";
    assert_says(&refused(open), &["winding.turns_per_layer", "no flanges"]);
}

/// The range was that of the nozzle's first place, which is ahead of where the first turn lies: the value that was refused lay in it.
#[test]
fn a_start_past_a_flange_is_not_within_what_is_allowed() {
    let text = "[core]\nshape = 'cylinder'\n[core.flange]\ninner_distance_mm = 9\nheight_mm = 3\n\
                [nozzle]\ny_start_mm = 4.1\n[start]\nclamp_y_mm = 4\n\
                [traverse]\nmode = 'helical'\nadvance_deg = 90\n\
                [winding]\nlayers = 2\ndirection = '-y'";
    let message = refused(text);
    assert_says(
        &message,
        &["nozzle.y_start = 0.0041 m", "allowed: 0.00415 m"],
    );
    let mended = text.replace("y_start_mm = 4.1", "y_start_mm = 4.15");
    parse(&mended).unwrap().build().expect("within the range");
}

#[test]
fn keys_of_another_way_are_told() {
    let text = "[traverse]\nmode = 'by-angle'\ncrossover_deg = 30\n[winding]\nlayers = 2\n";
    let (_, warnings) = parse(text).unwrap().build_with_warnings().unwrap();
    let keys: Vec<_> = warnings.iter().map(|w| w.key).collect();
    assert_eq!(keys, ["traverse.crossover", "winding.layers"]);
    let high = BOBBIN.replace("layers = 3", "layers = 9");
    let (_, warnings) = parse(&format!("{high}mode = 'helical'\n"))
        .unwrap()
        .build_with_warnings()
        .unwrap();
    assert!(
        warnings.iter().any(|w| w.key == "core.flange.height"),
        "{warnings:?}"
    );
}

/// Wire that is clamped in the middle of the window lies across the first layer. Without layers it came to the nozzle in two turns
/// with gaps of 2.6 mm, and nothing said so before the run.
#[test]
fn a_clamp_beside_the_first_turn_is_told() {
    let keys = |text: &str| -> Vec<&str> {
        let (_, warnings) = parse(text).unwrap().build_with_warnings().unwrap();
        warnings.iter().map(|w| w.key).collect()
    };
    let layers = format!("{BOBBIN}mode = 'helical'\n");
    assert!(!keys(&layers).contains(&"start.clamp_y"));
    let across = layers.replace("clamp_y_mm = -6.9", "clamp_y_mm = 0");
    assert!(keys(&across).contains(&"start.clamp_y"));
    let by_angle = across.replace("mode = 'helical'", "mode = 'by-angle'");
    assert!(keys(&by_angle).contains(&"start.clamp_y"));
    assert!(!keys("[traverse]\nmode = 'by-angle'\n").contains(&"start.clamp_y"));
}

/// A nozzle ahead of its wire made room for the first turn within a flange.
#[test]
fn a_lead_makes_no_room_in_a_flange() {
    let text = BOBBIN.replace("y_start_mm = -6.9", "y_start_mm = -7.1");
    for mode in ["helical", "orthocyclic"] {
        let led = format!("{text}mode = '{mode}'\nlead_mm = 0.2\n");
        assert_says(
            &refused(&led),
            &["nozzle.y_start", "past a flange", "-0.0069 m"],
        );
    }
}

/// A nozzle led 4 mm past a flange of 1 mm wound its wire over that flange until it broke, and nothing said so before the run.
#[test]
fn a_nozzle_far_past_a_flange_is_told() {
    let told = |lead_mm: f64, distance_mm: f64| -> bool {
        let text = BOBBIN.replace(
            "[nozzle]\n",
            &format!("[nozzle]\ndistance_mm = {distance_mm}\n"),
        );
        let text = format!("{text}mode = 'helical'\nlead_mm = {lead_mm}\n");
        let (_, warnings) = parse(&text).unwrap().build_with_warnings().unwrap();
        let past = |message: &str| message.contains("past the inner face");
        let mut all = warnings.iter().filter(|w| w.key == "traverse.lead");
        all.any(|w| past(&w.message))
    };
    assert!(told(4.0, 25.0));
    assert!(!told(0.3, 25.0));
    // seen from far away the wire passes over the rim
    assert!(!told(4.0, 120.0));
}

/// Changing sides after its dwell, a nozzle that leads wound up to 35 turns more than the layers hold, and nothing said so.
#[test]
fn turns_beyond_the_layers_of_a_nozzle_that_leads_are_told() {
    let wound = |keys: &str| {
        let text = format!("{BOBBIN}mode = 'helical'\n{keys}\n");
        let built = parse(&text).unwrap().build_with_warnings();
        let (scene, warnings) = built.unwrap();
        let told = warnings
            .into_iter()
            .find(|w| w.message.contains("which hold"));
        (scene.nozzle_law.turns(), told.map(|w| w.key))
    };
    let (held, told) = wound("");
    assert_eq!(told, None);
    // half a turn of dwell is enough for a little lead
    assert_eq!(wound("lead_mm = 0.1"), (held, None));
    let (more, told) = wound("lead_mm = 0.9");
    assert!(more > held + 0.5, "{more} {held}");
    assert_eq!(told, Some("traverse.lead"));
    let (more, told) = wound("dwell_turns = 2");
    assert!(more > held + 1.0, "{more} {held}");
    assert_eq!(told, Some("traverse.dwell_turns"));
}

/// Turns that are planned apart are judged as gaps, and the verdict came as a surprise.
#[test]
fn turns_planned_apart_are_told() {
    let told = |pitch: &str, words: &str| -> bool {
        let text = BOBBIN.replace(
            "[winding]\n",
            &format!("[winding]\n{pitch}\nturns_per_layer = 5\n"),
        );
        let text = format!("{text}mode = 'helical'\n");
        let (_, warnings) = parse(&text).unwrap().build_with_warnings().unwrap();
        let told = |w: &Warning| w.message.contains("leave gaps") && w.message.contains(words);
        warnings.iter().any(told)
    };
    assert!(told("pitch_mm = 1", "judged as defects"));
    assert!(told("pitch_mm = 0.75", "may be marginal"));
    assert!(!told("pitch_mm = 0.73", ""));
}

/// The scene that a run keeps has every key. `check` told of seventeen of them that they had no effect.
#[test]
fn keys_at_their_default_are_not_told() {
    let settings = parse("").unwrap();
    let (_, warnings) = parse(&settings.to_toml())
        .unwrap()
        .build_with_warnings()
        .unwrap();
    let idle: Vec<_> = warnings
        .iter()
        .filter(|w| w.message.contains("no effect"))
        .collect();
    assert!(idle.is_empty(), "{idle:?}");
}

/// The middle of the core is 0, whatever rounding leaves of it.
#[test]
fn a_way_past_a_flange_is_told_in_round_numbers() {
    let text = "[core]\nshape = 'cylinder'\n[core.flange]\ninner_distance_mm = 4.3\n[wire]\ndiameter_mm = 0.5\n\
                [nozzle]\ny_start = 0\n[traverse]\nmode = 'orthocyclic'\n[winding]\nturns_per_layer = 8\nlayers = 3\n";
    let said = refused(text);
    assert_says(&said, &["nozzle.y_start", "goes from 0 to 0.0038 m"]);
}

/// A bobbin whose nozzle swings within the outer faces of its flanges.
const NEAR: &str = "[core]\nshape = 'cylinder'\nradius_mm = 8\n[core.flange]\ninner_distance_mm = 14.5\nheight_mm = 4\n\
                    thickness_mm = 1.5\n[start]\nclamp_y_mm = -6.9\n[nozzle]\ndistance_mm = 20\ny_start_mm = -6.9\n\
                    [winding]\nlayers = 3\n[traverse]\nmode = 'orthocyclic'\ncrossover_deg = 140\n";

fn near(more: &str) -> Result<Scene, String> {
    parse(&format!("{NEAR}{more}"))
        .and_then(|settings| settings.build())
        .map_err(|e| e.to_string())
}

/// Without the key the law is the polyline of the places, as it was before there was one: all numbers to the bit.
#[test]
fn a_free_trail_is_the_law_of_the_places() {
    let pitch = (14.5e-3 - 0.7e-3) / 19.5;
    let crossover = 140_f64.to_radians();
    let law = near("").unwrap().nozzle_law;
    assert_eq!(near("trail = 'free'\n").unwrap().nozzle_law, law);
    let (mut first, mut sense) = (-6.9e-3, 1.0);
    let mut places = Vec::new();
    for _ in 0..3 {
        places.extend((0..20).map(|turn| first + sense * (f64::from(turn) * pitch)));
        first = first + sense * 19.0 * pitch + 0.5 * pitch * sense;
        sense = -sense;
    }
    for (turn, pair) in places.windows(2).enumerate() {
        let end = (turn + 1) as f64;
        let pieces = &law.pieces()[2 * turn..2 * turn + 2];
        assert_eq!(pieces[1].from, (end - crossover / TAU) * TAU);
        assert_eq!(
            (pieces[0].y, pieces[0].travel),
            (pair[0], 0.0),
            "turn {turn}"
        );
        assert_eq!(pieces[1].y, pair[0]);
    }
}

/// The way of a nozzle that leads is the wire's own at the ends of each crossover, and beyond it in between.
#[test]
fn a_led_trail_stands_at_the_places_and_swings_between_them() {
    let delay = 60.0 / 360.0;
    let free = near("crossover_delay_deg = 60\n").unwrap().nozzle_law;
    let led = near("crossover_delay_deg = 60\ntrail = 'led'\n")
        .unwrap()
        .nozzle_law;
    assert_eq!(
        (led.turns(), led.start(), led.jumps()),
        (free.turns(), free.start(), free.jumps())
    );
    let mut swing = 0.0_f64;
    for k in 0..60 * 360 {
        let angle = f64::from(k).to_radians();
        let within = (angle / TAU - delay).rem_euclid(1.0) * 360.0;
        let off = led.position(angle) - free.position(angle);
        swing = swing.max(off.abs());
        let first = angle / TAU < delay;
        assert!(
            off.abs() < 1e-15 || (within >= 220.0 && !first),
            "{off} at {k} deg"
        );
    }
    assert!((1.0e-3..2.0e-3).contains(&swing), "{swing}");
}

#[test]
fn what_cannot_be_led_is_refused_with_the_key_to_change() {
    let led = format!("{NEAR}trail = 'led'\n");
    let with = |from: &str, to: &str| refused(&led.replace(from, to));
    let boxed = with(
        "shape = 'cylinder'\nradius_mm = 8",
        "width_x_mm = 16\nheight_z_mm = 16",
    );
    assert_says(
        &boxed,
        &[
            "traverse.trail = led",
            "rounded-box",
            "allowed: free, or core.shape = cylinder",
        ],
    );
    let short = with("crossover_deg = 140", "crossover_deg = 40");
    assert_says(
        &short,
        &[
            "traverse.crossover",
            "past the outer face of a flange",
            "to 6 rad, or traverse.trail = free",
        ],
    );
    // the shortest that is allowed is
    let least = short
        .split("allowed: ")
        .nth(1)
        .unwrap()
        .split(' ')
        .next()
        .unwrap();
    let text = led.replace("crossover_deg = 140", &format!("crossover = {least}"));
    parse(&text).unwrap().build().expect("within the range");
    let wrong = parse(&led.replace("trail = 'led'", "trail = 'lead'")).unwrap_err();
    assert_says(&wrong.to_string(), &["traverse.trail", "free, led"]);
    // where wire would lie is checked as without it
    let past = with("\ny_start_mm = -6.9", "\ny_start_mm = -6");
    assert_says(&past, &["nozzle.y_start", "past a flange"]);
    let helical = led.replace("orthocyclic", "helical");
    let (_, warnings) = parse(&helical).unwrap().build_with_warnings().unwrap();
    assert!(
        warnings.iter().any(|w| w.key == "traverse.trail"),
        "{warnings:?}"
    );
}

/// Sums of decimals are off in their last digits: the message was empty, or asked for at least the distance that was given.
#[test]
fn a_window_of_one_wire_is_wide_enough() {
    let windows = (1..=20).flat_map(|d| (0..=10).map(move |insulation| (5 * d, 5 * insulation)));
    for (d, insulation) in windows {
        let disc = |window: u32| {
            let mm = |hundredths: u32| format!("{}.{:02}", hundredths / 100, hundredths % 100);
            let text = format!(
                "[core]\nshape = 'cylinder'\nradius_mm = 7\n\
                 flange = {{ inner_distance_mm = {}, insulation_mm = {} }}\n\
                 [wire]\ndiameter_mm = {}\n[tensioner]\ntension = 0.1\n[contact]\nstiffness = 1e10\n\
                 [nozzle]\ndistance_mm = 20\n[traverse]\nmode = 'orthocyclic'\n[winding]\nlayers = 3\n",
                mm(window),
                mm(insulation),
                mm(d)
            );
            parse(&text).expect("parses").build()
        };
        let one = disc(d + 2 * insulation);
        let law = one.unwrap_or_else(|error| panic!("{d} {insulation}: {error}"));
        assert_eq!(law.nozzle_law.turns(), 3.0, "{d} {insulation}");
        let narrower = disc(d + 2 * insulation - 1).expect_err("no room");
        assert_says(
            &narrower.to_string(),
            &["core.flange.inner_distance", "the wire is wider"],
        );
    }
}
