//! What stands on a core from a file: flanges that lean, lips, shoes, collars and bosses.

use crate::common::{assert_says, parse};
use crate::meshes::{of_a_box, text};
use crate::stl::write_revolved;
use coilwind::scene::Scene;
use std::path::Path;

type Triangles = Vec<[[f32; 3]; 3]>;

/// A core of 12 x 20 mm and 20 mm long, with boxes on it, half width, from and to along y, and half height in mm.
fn core_with(boxes: &[(f32, [f32; 2], f32)]) -> Triangles {
    let mut all = of_a_box(6.0, [-10.0, 10.0], 10.0);
    for &(half_x, y, half_z) in boxes {
        all.extend(of_a_box(half_x, y, half_z));
    }
    all
}

fn written(folder: &Path, triangles: &[[[f32; 3]; 3]]) {
    std::fs::write(folder.join("core.stl"), text(" core", triangles)).unwrap();
}

/// What is said of wire of 0.6 mm on the core of a folder, clamped and begun at this place, mm: the scene and its warnings, or an error.
fn wound(folder: &Path, y: f64, more: &str) -> Result<(Scene, Vec<String>), String> {
    let scene = format!(
        "[core]\nshape = 'mesh'\nfile = {:?}\n[wire]\ndiameter_mm = 0.6\n[start]\nclamp_y_mm = {y}\n\
         [nozzle]\ny_start_mm = {y}\n[traverse]\nmode = 'orthocyclic'\n[winding]\nlayers = 2\n{more}",
        folder.join("core.stl")
    );
    let settings = parse(&scene).expect("parses");
    let (scene, warnings) = settings.build_with_warnings().map_err(|e| e.to_string())?;
    Ok((scene, warnings.iter().map(ToString::to_string).collect()))
}

fn about_the_file(warnings: &[String]) -> Vec<&String> {
    let stands = |w: &&String| w.contains("something stands on the core");
    warnings.iter().filter(stands).collect()
}

/// The wire was clamped on the lip, and the coil was wound on top of the flange and called bulging.
#[test]
fn wire_is_not_clamped_on_the_lip_of_a_flange() {
    let folder = tempfile::tempdir().unwrap();
    for (lip, refused) in [(0.25, false), (0.5, true), (0.8, true)] {
        let inner = 3.5 - lip;
        let outline = [
            [-5.0, 9.0],
            [-inner, 9.0],
            [-inner, 8.0],
            [-3.5, 8.0],
            [-3.5, 5.0],
            [3.5, 5.0],
            [3.5, 8.0],
            [inner, 8.0],
            [inner, 9.0],
            [5.0, 9.0],
        ];
        write_revolved(&folder.path().join("core.stl"), &outline, 90);
        // half a wire from the flange
        let said = wound(folder.path(), -3.2, "pitch_mm = 0.6\n").err();
        assert_eq!(said.is_some(), refused, "{lip}: {said:?}");
        if let Some(said) = said {
            assert_says(
                &said,
                &["start.clamp_y", "on the rim of a flange", "allowed: -0.00"],
            );
        }
        wound(folder.path(), -2.0, "turns_per_layer = 8\npitch_mm = 0.6\n")
            .expect("clear of the lip");
    }
}

/// Wire clamped beside a flange that leans began the coil inside that flange, or on its rim.
#[test]
fn wire_is_not_clamped_in_a_flange_that_leans_there() {
    let folder = tempfile::tempdir().unwrap();
    for degrees in [3.0_f32, 6.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let turned = core_with(&[(10.0, [-6.0, -4.0], 14.0), (10.0, [4.0, 6.0], 14.0)])
            .iter()
            .map(|corners| corners.map(|[x, y, z]| [cos * x - sin * y, sin * x + cos * y, z]))
            .collect::<Triangles>();
        written(folder.path(), &turned);
        // wire that touches core and flange on +x, and the rim there, which must not stand over it
        let [touching, rim] =
            [[6.3, -3.7], [10.0, -4.0]].map(|[x, y]| f64::from(sin * x + cos * y));
        let beside = touching.max(rim);
        let more = "turns_per_layer = 8\npitch_mm = 0.6\n";
        let said = wound(folder.path(), beside - 0.1, more).expect_err("in the flange");
        assert_says(
            &said,
            &["start.clamp_y", "stands on the core there", "allowed:"],
        );
        wound(folder.path(), beside + 0.1, more).expect("beside it");
    }
}

/// A boss as high as the wire was taken for a flange, and the coil for a part of it; without a word.
#[test]
fn a_boss_is_no_flange_and_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let flanges = [(10.0, [-6.0, -4.0], 14.0), (10.0, [4.0, 6.0], 14.0)];
    let plain = core_with(&flanges);
    written(folder.path(), &plain);
    let (without, warnings) = wound(folder.path(), -3.7, "").expect("it can be wound");
    assert_eq!(about_the_file(&warnings), Vec::<&String>::new());
    let mut with_boss = plain;
    let boss = of_a_box(0.5, [-1.0, 1.0], 2.0);
    with_boss.extend(boss.iter().map(|t| t.map(|[x, y, z]| [x + 6.3, y, z])));
    written(folder.path(), &with_boss);
    let (with, warnings) = wound(folder.path(), -3.7, "").expect("it can be wound");
    assert_eq!(with.spindle.turns, without.spindle.turns);
    let [told] = about_the_file(&warnings)[..] else {
        panic!("{warnings:?}")
    };
    assert_says(told, &["core.file", "from -0.001 m on", "boss"]);
}

/// Turns were planned into a shoe that ends flush with the end faces, into a single flange and through a collar.
#[test]
fn what_turns_are_laid_on_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let more = "turns_per_layer = 14\npitch_mm = 0.6\n";
    let shoe = [(11.0, [-8.0, -4.2], 10.0), (11.0, [4.2, 8.0], 10.0)];
    let one_flange = [(11.0, [4.2, 8.0], 15.0)];
    let collar = [(7.0, [1.0, 2.0], 11.0)];
    for (what, boxes, from, share) in [
        // 40 mm of the 65.9 mm that the centreline has round the core
        ("shoe", &shoe[..], "0.0042 m", 60..62),
        ("flange", &one_flange, "0.0042 m", 100..101),
        ("collar", &collar, "0.001 m", 100..101),
    ] {
        written(folder.path(), &core_with(boxes));
        // 14 turns and the step of half a wire need 8.7 mm
        let (_, warnings) = wound(folder.path(), -3.9, more).expect(what);
        let [told] = about_the_file(&warnings)[..] else {
            panic!("{what}: {warnings:?}")
        };
        assert_says(told, &["core.file", from, "0.0045 m"]);
        let percent = told.split(" %").next().unwrap().rsplit(' ').next().unwrap();
        assert!(share.contains(&percent.parse().unwrap()), "{what}: {told}");
        let fewer = "turns_per_layer = 8\npitch_mm = 0.6\n";
        let (_, warnings) = wound(folder.path(), -3.9, fewer).expect(what);
        assert_eq!(about_the_file(&warnings), Vec::<&String>::new(), "{what}");
    }
}
