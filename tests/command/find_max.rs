//! `coilwind sweep --find-max` through its front door.

use crate::command::{coilwind, complaint, finished, rows};
use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

/// What the search left in its folder.
fn answer(directory: &Path) -> serde_json::Value {
    let bytes = std::fs::read(directory.join("find_max.json")).unwrap();
    serde_json::from_slice(&bytes).unwrap()
}

/// The highest tension below that which draws wire too long, found by bisection and by winding all.
#[test]
fn the_maximum_is_that_of_a_sweep_through_everything() {
    let folder = tempfile::tempdir().unwrap();
    let (all, some) = (folder.path().join("all"), folder.path().join("some"));
    let wound = |out: &Path, more: &[&str]| {
        // Long enough for turns at rest beside each other, without which nothing is judged.
        let set = ["--set", "spindle.speed=300", "--set", "spindle.turns=2.6"];
        let ensemble = ["--ensemble", "2"];
        let sweep = coilwind("sweep", out, &[&set[..], &ensemble, more].concat());
        let told = String::from_utf8(finished(sweep, 0).stdout).unwrap();
        (rows(&out.join("sweep.csv")), told)
    };
    let name = "tensioner.tension";
    let (every, told) = wound(&all, &["--over", "tensioner.tension=33:68:8"]);
    assert_eq!(told, "");
    let (looked, told) = wound(
        &some,
        &["--over", "tensioner.tension=33:68:8", "--find-max", name],
    );
    let highest = |rows: &[BTreeMap<String, String>]| {
        let value = |row: &BTreeMap<String, String>| row[name].parse::<f64>().unwrap();
        let bad = rows
            .iter()
            .filter(|row| row["defect"] == "true" || row["outcome"] == "failed");
        let least_bad = bad.map(value).fold(f64::INFINITY, f64::min);
        let good = rows.iter().map(value).filter(|v| *v < least_bad);
        (good.fold(0.0, f64::max), least_bad)
    };
    assert_eq!(highest(&every), highest(&looked));
    let (free, not_free) = highest(&every);
    assert!(33.0 < free && not_free == free + 5.0, "{free} {not_free}");
    // A result is told also where progress is not.
    let says = format!(
        "{name} = {free} is the highest value found without a defect; {not_free} is not free of them\n"
    );
    assert_eq!(told, says);
    // three looks of the bisection, and one at the lowest value
    assert_eq!((every.len(), looked.len()), (16, 8));
    let answer = answer(&some);
    assert_eq!(answer["outcome"], "found");
    let assumes = answer["assumes"].as_str().unwrap();
    let below = ((free - 33.0) / 5.0).round() as usize;
    let wound = looked
        .iter()
        .filter(|row| row[name].parse::<f64>().unwrap() < free);
    let says = format!(
        "of the {below} values below {} were wound; the others",
        wound.count() / 2
    );
    assert!(assumes.starts_with(&says), "{assumes}");
    assert_eq!(
        (answer["value"].as_f64(), answer["unit"].as_str()),
        (Some(free), Some("N"))
    );
    assert_eq!(answer["lowest_defect"], not_free);
    assert_eq!((&answer["values"], &answer["runs"]), (&8.into(), &8.into()));
    assert_eq!(answer["bracket"], serde_json::json!([33.0, 68.0]));
}

/// Runs that nothing was known of counted as free of defects, and runs that failed as defective: both were told as an answer.
#[test]
fn a_maximum_among_values_that_are_not_judged_or_failed_is_no_answer() {
    let folder = tempfile::tempdir().unwrap();
    let find_max = |out: &str, over: &str, sets: &[&str], code: i32| {
        let mut sweep = Command::new(env!("CARGO_BIN_EXE_coilwind"));
        sweep.args(["sweep", "fig8", "--find-max", "spindle.speed"]);
        sweep.args(["--over", over, "--out"]);
        sweep.arg(folder.path().join(out));
        sets.iter().for_each(|set| {
            sweep.args(["--set", set]);
        });
        let output = finished(sweep, code);
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        let (told, said) = (text(output.stdout), text(output.stderr));
        for answer in ["is free of defects", "try a", "highest value without"] {
            assert!(!told.contains(answer), "{told}");
        }
        let kept = answer(&folder.path().join(out));
        assert!(kept["value"].is_null(), "{kept}");
        let words = kept["words"].as_str().unwrap();
        assert!(
            said.ends_with(&format!("sweep: {words}\n")),
            "{words}: {said}"
        );
        (told, said)
    };
    let (told, said) = find_max(
        "unjudged",
        "spindle.speed=300:302:2",
        &["spindle.turns=0.5"],
        4,
    );
    assert!(told.contains("unsettled 1"), "{told}");
    for part in [
        "no highest value of spindle.speed was found: 302 is not judged",
        "--set spindle.turns=N; nothing is known of other values",
    ] {
        assert!(said.contains(part), "{part}: {said}");
    }
    // More turns were advised where no number of them is judged.
    let layers = ["winding.layers=2", "winding.turns_per_layer=1"];
    for (out, sets, remedy) in [
        (
            "no-rest",
            &["spindle.turns=0.5", "freeze.enabled=false"][..],
            "leave freeze.enabled = false out",
        ),
        (
            "alone",
            &["traverse.mode=helical", layers[0], layers[1]],
            "give winding.turns_per_layer more than 1",
        ),
    ] {
        let (_, said) = find_max(out, "spindle.speed=100:102:2", sets, 4);
        assert!(said.contains(remedy), "{said}");
        assert!(!said.contains("spindle.turns=N"), "{said}");
    }
    // A turn and a bit: that turn lies beside none, and was told as free of gaps.
    let (told, said) = find_max(
        "single",
        "spindle.speed=100:102:2",
        &["spindle.turns=1.3"],
        4,
    );
    assert!(told.contains("single 1"), "{told}");
    assert!(
        said.contains("in 1 of 1 runs no turn came to rest beside another"),
        "{said}"
    );
    let sets = ["solver.step_us=400", "spindle.turns=1.2"];
    let (told, said) = find_max("failed", "spindle.speed=300:400:2", &sets, 3);
    assert!(told.contains("failed 1"), "{told}");
    assert!(said.contains("failed: the solver gave up 1 of 1"), "{said}");
    assert_eq!(rows(&folder.path().join("failed/sweep.csv")).len(), 1);
}

/// The two values that bisection winds were free of defects, and the whole bracket was told to be; the lowest is not.
#[test]
fn free_values_above_a_defect_are_told_to_be_a_band() {
    let folder = tempfile::tempdir().unwrap();
    let mut sweep = Command::new(env!("CARGO_BIN_EXE_coilwind"));
    sweep.args(["sweep", "fig8", "--find-max", "traverse.per_turn_mm"]);
    sweep.args(["--over", "traverse.per_turn_mm=0.1:0.7:3"]);
    sweep.args(["--set", "spindle.turns=3.2", "--set", "spindle.speed=60"]);
    sweep.arg("--out").arg(folder.path());
    let told = complaint(sweep, 4);
    for part in [
        "= 0.7 is free of defects and 0.1, the lowest, is not",
        "are a band",
    ] {
        assert!(told.contains(part), "{told}");
    }
    assert!(!told.contains("bracket"), "{told}");
    let kept = answer(folder.path());
    assert_eq!(
        (kept["outcome"].as_str(), kept["highest_free"].as_f64()),
        (Some("band"), Some(0.7))
    );
}

/// Such a search ended with code 0 and, with `--quiet`, without a word.
#[test]
fn a_bracket_that_is_free_or_defective_from_end_to_end_is_no_answer() {
    let folder = tempfile::tempdir().unwrap();
    let all = ["--set", "spindle.speed=300", "--set", "spindle.turns=2.6"];
    for (over, outcome, said, assumes) in [
        (
            "tensioner.tension=30:33:2",
            "all_free",
            "30 and 33, the ends of the bracket, are free of defects; try a higher bracket",
            false,
        ),
        // the one between was taken to be free without a word
        (
            "tensioner.tension=30:33:7",
            "all_free",
            "30 and 33, the ends of the bracket, are free of defects; try a higher bracket",
            true,
        ),
        (
            "tensioner.tension=65:68:2",
            "none_free",
            "65, the lowest, is not; try a lower bracket",
            false,
        ),
    ] {
        let out = folder.path().join(over);
        let search = ["--over", over, "--find-max", "tensioner.tension"];
        let sweep = || coilwind("sweep", &out, &[&all[..], &search].concat());
        let output = finished(sweep(), 4);
        assert_eq!(output.stdout, b"");
        let told = String::from_utf8(output.stderr).unwrap();
        assert!(told.contains(said), "{told}");
        let trust = "values between them that were not wound are taken to be free";
        assert_eq!(told.contains(trust), assumes, "{told}");
        let kept = answer(&out);
        assert_eq!(kept["assumes"].is_null(), !assumes);
        assert_eq!(kept["outcome"], outcome);
        assert!(kept["value"].is_null(), "{kept}");
        assert!(kept["words"].as_str().unwrap().contains(said), "{kept}");
        // Asked again, it answers from its rows, and from no answer that it finds.
        std::fs::write(out.join("find_max.json"), "{}").unwrap();
        finished(sweep(), 4);
        assert_eq!(answer(&out), kept);
        let mut resume = Command::new(env!("CARGO_BIN_EXE_coilwind"));
        resume.args(["run", "--resume"]).arg(&out);
        assert!(complaint(resume, 2).contains("holds a sweep; it goes on by the command"));
        // A sweep in its place leaves none of it.
        let plain = ["--over", "tensioner.tension=30:30:1", "--force"];
        finished(coilwind("sweep", &out, &plain), 0);
        assert!(!out.join("find_max.json").exists());
    }
}
