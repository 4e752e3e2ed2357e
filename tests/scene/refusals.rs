//! What is refused or warned of, and what the message says.

use crate::common::{assert_says, parse, refused, unread};
use coilwind::settings::SceneSettings;
use coilwind::variables::{Causality, Kind, by_name, table};

#[test]
fn unknown_names_come_with_a_suggestion() {
    for (text, parts) in [
        (
            "[wire]\n\n diametr_mm = 0.7",
            &[
                "test.toml:3",
                "wire.diametr_mm",
                "value 0.7",
                "wire.diameter_mm?",
            ][..],
        ),
        ("[wire]\ndiametr = 0.7", &["test.toml:2", "wire.diameter?"]),
        (
            "[wire]\ntension = 15",
            &["wire.tension", "tensioner.tension?", "keys of [wire]"],
        ),
        (
            "[spindle]\nspeed_rmp = 15",
            &["spindle.speed_rmp", "spindle.speed?"],
        ),
        (
            "\n[wier]\ndiameter = 1",
            &["test.toml:2", "[wier]", "[wire]?", "tensioner"],
        ),
        ("presett = 'paper'", &["test.toml:1", "presett", "preset?"]),
        ("diameter = 0.7", &["diameter", "wire.diameter?"]),
        ("[scene]\nfile = 'fig8'", &["[scene]"]),
    ] {
        assert_says(&unread(text), parts);
    }
}

/// `core.diameter_mm` was answered with `wire.diameter`, which is of another section and without the unit.
#[test]
fn a_key_of_the_same_section_is_suggested_first() {
    for (key, meant) in [
        ("core.diameter_mm", "core.radius_mm, half the diameter?"),
        ("core.diameter", "core.radius, half the diameter?"),
        ("wire.radius_um", "wire.diameter_um, twice the radius?"),
        ("nozzle.diameter_mm", "nozzle.outer_diameter_mm?"),
        ("core.flange.distance_mm", "core.flange.inner_distance_mm?"),
        // the side that the letter names, and not the one that the word does on another axis
        ("core.width_z_mm", "core.height_z_mm?"),
        ("core.depth_z", "core.height_z?"),
        ("core.size_z", "core.height_z?"),
        ("core.width_y", "core.length_y?"),
        ("core.lenght_y", "core.length_y?"),
        ("core.height_x_mm", "core.width_x_mm?"),
        ("core.widht_x", "core.width_x?"),
        ("core.width", "core.width_x?"),
        ("core.flange.height_z_mm", "core.flange.height_mm?"),
        ("start.clamp_z", "start.clamp_y?"),
        // no key of the section has such a word
        ("core.tension", "tensioner.tension?"),
    ] {
        let (section, leaf) = key.split_once('.').unwrap();
        let said = unread(&format!("[{section}]\n{leaf} = 3"));
        assert_says(&said, &[&format!("did you mean {meant}")]);
    }
}

/// `core.width_z` was answered with `core.width_x`. Of a key with one letter wrong the right one is guessed.
#[test]
fn one_wrong_letter_in_a_key_leads_to_the_key() {
    let (mut tried, mut wrong) = (0, Vec::new());
    let leaves = table().iter().filter(|v| v.kind == Kind::Real);
    for leaf in leaves.filter(|v| v.causality == Causality::Parameter) {
        let table = leaf.name.rsplit_once('.').map_or("", |(table, _)| table);
        let Some((section, key)) = leaf.name.split_once('.') else {
            continue;
        };
        let letters: Vec<char> = key.chars().collect();
        // (of `EI` one letter less is as near to others)
        if letters.len() < 4 {
            continue;
        }
        let inside = |at: &usize| letters[at - 1] != '.' && letters[*at] != '.';
        for at in (1..letters.len()).filter(inside) {
            let (mut without, mut swapped, mut twice) =
                (letters.clone(), letters.clone(), letters.clone());
            without.remove(at);
            swapped.swap(at - 1, at);
            twice.insert(at, letters[at]);
            for typo in [without, swapped, twice] {
                let typo: String = typo.into_iter().collect();
                if by_name(&format!("{section}.{typo}")).is_some() {
                    continue;
                }
                let said = parse(&format!("[{section}]\n{typo} = 3"));
                let said = said.expect_err("no such key").to_string();
                tried += 1;
                let meant = [leaf.name, table].map(|name| format!("did you mean {name}?"));
                if !meant.iter().any(|name| said.contains(name)) {
                    wrong.push(format!("{section}.{typo}: {said:.120}"));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{} of {tried}: {wrong:#?}", wrong.len());
}

/// The range stood in SI only, beside a value in the unit of the key; metres for millimetres got no question back.
#[test]
fn a_range_is_told_in_the_unit_of_the_key() {
    for (text, says) in [
        (
            "[core]\nradius_mm = -9",
            "core.radius_mm = -9 is out of range; allowed: 5e-5 to 1 m, which is 0.05 to 1000 mm",
        ),
        (
            "[spindle]\nspeed_rpm = -500",
            "rad/s, which is 0.95493 to 19098.6 rpm; spindle.direction = -y turns it the other way round",
        ),
        (
            "[wire]\ndiameter = 0.7",
            "allowed: 2e-5 to 0.005 m; did you mean wire.diameter_mm?",
        ),
        (
            "[spindle]\nspeed = 3000",
            "rad/s; did you mean spindle.speed_rpm?",
        ),
        (
            "[wire]\ndiameter_mm = '0.7'",
            "is a text; allowed is 2e-5 to 0.005 m, which is 0.02 to 5 mm",
        ),
        (
            "wire = 3",
            "unknown key wire (value 3); did you mean [wire] with keys under it?",
        ),
    ] {
        assert_says(&unread(text), &[says]);
    }
    let said = unread("scene = 'fig8'");
    assert!(!said.contains("did you mean scene.file"), "{said}");
}

/// Between flanges that leave the wire no room the place of the clamp was refused too, with a range that ran backwards.
#[test]
fn what_follows_from_flanges_too_close_is_not_told_again() {
    let said = refused("[core.flange]\ninner_distance_mm = 0.5");
    assert_says(&said, &["core.flange.inner_distance", "at least 0.0007 m"]);
    assert!(!said.contains("start.clamp_y"), "{said}");
}

#[test]
fn wrong_units_types_and_repeats_are_refused() {
    for (text, parts) in [
        (
            "[wire]\ndiameter_rpm = 3",
            &[
                "test.toml:2",
                "wire.diameter_rpm = 3",
                "wire.diameter_mm, wire.diameter_um",
            ][..],
        ),
        (
            "[wire]\ndiameter = 'thick'",
            &["\"thick\" is a text", "2e-5 to 0.005 m"],
        ),
        (
            "[wire]\nelastic = 1",
            &["wire.elastic = 1 is a number", "true or false"],
        ),
        ("[wire]\ndiameter = [1, 2]", &["a list"]),
        ("[wire.diameter]\nmm = 2", &["a section"]),
        (
            "[wire]\ndiameter = 7e-4\ndiameter_mm = 0.7",
            &[
                "test.toml:3",
                "wire.diameter was already given as wire.diameter",
            ],
        ),
        (
            "[wire]\nmaterial = 'steel'",
            &["\"steel\"", "copper, table1, custom"],
        ),
        ("[wire]\ndiameter = ", &["test.toml:2", "not valid TOML"]),
        (
            "[wire]\ndiameter_mm = 0,7\n",
            &[
                "test.toml:2",
                "not valid TOML",
                "write a point for a decimal comma",
            ],
        ),
        ("wire = 3", &["test.toml:1", "wire"]),
    ] {
        assert_says(&unread(text), parts);
    }
}

#[test]
fn numbers_out_of_range_name_their_range() {
    for (text, parts) in [
        (
            "[wire]\ndiameter_mm = -0.7",
            &["test.toml:2", "= -0.7", "2e-5 to 0.005 m"][..],
        ),
        (
            "[wire]\ndiameter = nan",
            &["wire.diameter = nan", "2e-5 to 0.005 m"],
        ),
        (
            "[tensioner]\ntension = inf",
            &["tensioner.tension = inf", "0 to 10000 N"],
        ),
        (
            "[contact]\nrestitution = 1.5",
            &["contact.restitution = 1.5", "0 to 1"],
        ),
        ("[contact]\nrestitution = -0.1", &["allowed: 0 to 1"]),
        (
            "[spindle]\nspeed = 0",
            &["spindle.speed = 0", "0.1 to 2000 rad/s"],
        ),
        ("[spindle]\nramp_turns = 0", &["spindle.ramp_turns = 0"]),
    ] {
        assert_says(&unread(text), parts);
    }
}

#[test]
fn impossible_scenes_say_what_would_do() {
    for (text, parts) in [
        (
            "[nozzle]\ndistance_mm = 15",
            &[
                "test.toml:2",
                "nozzle.distance = 0.015 m",
                "inside the circle",
                "more than 0.016",
            ][..],
        ),
        (
            "[wire]\ndiameter_mm = 2\n[core]\nlength_y_mm = 1",
            &[
                "test.toml:2",
                "wire.diameter = 0.002 m",
                "wider than the core is long",
                "0.001 m",
            ],
        ),
        (
            "[core]\ncorner_radius_mm = 6.5",
            &[
                "test.toml:2",
                "core.corner_radius = 0.0065 m",
                "0 to 0.006 m",
            ],
        ),
        (
            "[friction]\nstatic = 0.1",
            &[
                "test.toml:2",
                "friction.static = 0.1",
                "at least friction.kinetic, 0.17",
            ],
        ),
        (
            "[friction]\nkinetic = 0.3",
            &["friction.kinetic = 0.3", "at most friction.static, 0.23"],
        ),
        (
            "[tensioner]\ntension = 100",
            &[
                "test.toml:2",
                "tensioner.tension = 100 N",
                "breaks at 84.66",
                "less than",
            ],
        ),
        (
            "[solver]\nspacing_near_um = 50",
            &["too fine", "7e-5 to 0.007 m"],
        ),
        (
            "[wire]\ndiameter_um = 30\n[tensioner]\ntension = 0.1\n[solver]\nspacing_near_mm = 0.4",
            &["spacing_near", "solver.spacing_near", "too coarse"],
        ),
        (
            "[solver]\nspacing_near_mm = 0.4\nspacing_free_mm = 0.3",
            &["cannot be finer", "solver.spacing_near, 0.0004 m"],
        ),
        ("[solver]\nspacing_free_mm = 20", &["at least three edges"]),
        (
            "[spindle]\nturns = 0.1",
            &[
                "test.toml:2: spindle.turns",
                "at least spindle.ramp_turns, 0.25",
            ],
        ),
        (
            "[start]\nclamp_y_mm = 15",
            &["start.clamp_y", "-0.01465 to 0.01465 m"],
        ),
        (
            "[nozzle]\ny_start = 0.2",
            &["nozzle.y_start", "-0.075 to 0.075 m"],
        ),
        (
            "[wire]\nmaterial = 'table1'\ndiameter_mm = 0.8",
            &[
                "test.toml:3",
                "wire.diameter = 0.0008 m",
                "table1",
                "0.0007 m",
            ],
        ),
        (
            "[wire]\nmaterial = 'custom'\nEA = 1\nEAp = 0.1\nEI = 1\n",
            &["wire.EIp", "needs every rigidity", "more than 0"],
        ),
        (
            "[wire]\nEIp = 0.5",
            &["test.toml:2", "wire.EIp = 0.5 N.m2", "less than wire.EI"],
        ),
        (
            "[wire]\nyield_stress_MPa = 300",
            &[
                "wire.flow_stress",
                "moment cap",
                "at most wire.flow_stress, 2.2e8 Pa",
            ],
        ),
        (
            "[wire]\nmoment_cap = 1e-3",
            &["wire.moment_cap = 0.001 N.m", "0.00571667"],
        ),
        (
            "[core]\nshape = 'mesh'",
            // a file was not named where it leaves out the key
            &[
                "test.toml, by default: core.file = \"\" is impossible",
                "needs a file",
            ],
        ),
        (
            "[core]\nshape = 'mesh'\nfile = 'none.stl'",
            &["test.toml:3", "none.stl", "cannot be opened"],
        ),
    ] {
        assert_says(&refused(text), parts);
    }
}

#[test]
fn fields_written_directly_are_checked_too() {
    let mut settings = SceneSettings::default();
    settings.freeze.creep = f64::NAN;
    assert_says(
        &settings.build().unwrap_err().to_string(),
        &["freeze.creep = NaN", "0 to 1 m/rad"],
    );
}

#[test]
fn odd_scenes_build_with_a_warning() {
    let warnings = |text: &str| -> Vec<String> {
        let (_, warnings) = parse(text).unwrap().build_with_warnings().unwrap();
        for warning in &warnings {
            assert!(by_name(warning.key).is_some(), "{warning}");
        }
        warnings.iter().map(ToString::to_string).collect()
    };
    assert!(warnings("").is_empty());
    assert_eq!(
        SceneSettings::default().build_with_warnings().unwrap().1,
        []
    );
    for (text, part) in [
        ("[nozzle]\ny_start_mm = 20", "starts beside the core"),
        ("[spindle]\nturns = 25", "ends beside the core"),
        ("[tensioner]\ntension = 40", "yields in the free span"),
        (
            "[core]\ncorner_radius = 0\n[solver]\nspacing_near_mm = 0.4\n",
            "coarser than the tightest bend",
        ),
        // turns were told as loose, and gaps and bulges of chords as those of wire
        (
            "[core]\nshape = 'cylinder'\nradius_mm = 7\n[solver]\nspacing_near_mm = 2.5\nspacing_free_mm = 2.5",
            "cuts its tightest bend, radius 0.00735 m, by 0.000106293 m",
        ),
        ("[contact]\nstiffness = 1e8", "1 % of its diameter"),
        (
            "[solver]\ntwist = 'off'",
            "without twist its bends do not come to rest",
        ),
        // it sprang off, and was called slack
        (
            "[wire]\nelastic = true\n[core]\nshape = 'cylinder'\nradius_mm = 6\n[tensioner]\ntension = 5",
            "springs off this core",
        ),
        // nothing was said of a coil that reaches into the neighbouring one
        (
            "[core]\nwindow_height_mm = 1\n[traverse]\nmode = 'helical'\n\
             [winding]\nturns_per_layer = 5\nlayers = 2",
            "stands 0.00130622 m high, beyond the limit line",
        ),
    ] {
        let found = warnings(text);
        assert_eq!(found.len(), 1, "{found:?}");
        assert_says(&found[0], &[part]);
    }
}

/// "at most spindle.turns, 10" was said where that is 0 and the turns are those of the layers or of a table.
#[test]
fn a_ramp_is_too_long_for_the_turns_of_what_gives_them() {
    let layers =
        "[traverse]\nmode = 'helical'\n[winding]\nturns_per_layer = 5\nlayers = 2\n[spindle]\n";
    for (text, most) in [
        ("[spindle]\nturns = 3\n", "at most spindle.turns, 3"),
        (layers, "at most the turns of the planned layers, 10"),
    ] {
        let message = refused(&format!("{text}ramp_turns = 20\n"));
        assert_says(
            &message,
            &["spindle.ramp_turns", "still accelerating", most],
        );
    }
    let message = refused(&format!("{layers}turns = 0\nramp_turns = 20\n"));
    assert!(!message.contains("spindle.turns"), "{message}");
}

#[test]
fn scenes_that_are_not_there() {
    let message = SceneSettings::load("fig9").unwrap_err().to_string();
    assert_says(
        &message,
        &[
            "fig9",
            "packed scene (fig8, fig8_gap, tooth, bobbin, fine)",
            "did you mean fig8?",
        ],
    );
    let folder = tempfile::tempdir().unwrap();
    let message = SceneSettings::load(folder.path().to_str().unwrap())
        .unwrap_err()
        .to_string();
    assert_says(&message, &["cannot be read"]);
}

/// A nozzle that travels evenly went 4.7 mm past a flange, and `check` called that valid with a warning.
#[test]
fn an_even_way_past_a_flange_is_refused() {
    let built = |y_start_mm: f64, per_turn_mm: f64| {
        let text = format!(
            "[core]\nshape = 'cylinder'\nradius_mm = 8\n[core.flange]\ninner_distance_mm = 7.385\nheight_mm = 4\n[nozzle]\n\
             distance_mm = 20\ny_start_mm = {y_start_mm}\n[traverse]\nper_turn_mm = {per_turn_mm}\n[spindle]\nturns = 10\n"
        );
        parse(&text).unwrap().build()
    };
    let said = |y_start_mm, per_turn_mm| built(y_start_mm, per_turn_mm).unwrap_err().to_string();
    let far = "at most 0.000742777 m for 10 turns from nozzle.y_start = -0.0033425 m on";
    assert_says(
        &said(0.0, 0.8),
        &["traverse.per_turn", "past a flange", far],
    );
    let elsewhere = "-0.0033425 to -0.0029575 m";
    assert_says(
        &said(0.0, 0.7),
        &["nozzle.y_start", "past a flange", elsewhere],
    );
    // the last of its turns ends beside the flange, and the nozzle a turn behind it
    assert!(built(-3.3425, 0.74).is_ok() && built(-3.0, 0.7).is_ok());
    assert!(built(3.3425, -0.74).is_ok() && built(3.0, -0.75).is_err());
}

/// A folder named `~` or `file:` was made.
#[test]
fn a_folder_that_only_a_shell_would_find_is_refused() {
    for folder in ["~/coils", "~", "file:///tmp/coils"] {
        let message = refused(&format!("[output]\ndirectory = '{folder}'"));
        assert_says(
            &message,
            &[
                "test.toml:2",
                "output.directory",
                folder,
                "the path of a folder",
            ],
        );
    }
}
