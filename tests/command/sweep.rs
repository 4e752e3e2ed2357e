//! `coilwind sweep` and `coilwind run --ensemble` through their front door.

use crate::command::{SHORT, coilwind, complaint, finished, rows};
use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

/// A table without its last column, which is a clock.
fn without_clock(path: &Path) -> Vec<String> {
    let text = std::fs::read_to_string(path).unwrap();
    let lines = text
        .lines()
        .map(|line| line.rsplit_once(',').unwrap().0.to_owned());
    lines.collect()
}

const GRID: [&str; 6] = [
    "--over",
    "spindle.speed=60:120:2",
    "--over",
    "tensioner.tension=10:15:2",
    "--ensemble",
    "2",
];

/// Rows stood in the order in which runs ended, and another number of threads made another table.
/// A run that failed had the verdict of what had settled until then.
#[test]
fn a_run_that_fails_has_no_verdict() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let mut sweep = Command::new(env!("CARGO_BIN_EXE_coilwind"));
    sweep.args(["sweep", "fig8", "--over", "solver.step=5e-4:5e-4:1"]);
    sweep
        .args(["--set", "spindle.turns=1.2", "--out"])
        .arg(&out);
    // (the reason stood in the table alone)
    let said = complaint(sweep, 0);
    assert!(
        said.contains("the solver gave up 1 of 1 runs, one with this reason: at t = 0.0159"),
        "{said}"
    );
    let rows = rows(&out.join("sweep.csv"));
    assert_eq!(rows[0]["outcome"], "failed");
    assert_eq!(rows[0]["verdict"], "unjudged");
}

/// Such a sweep told nothing: its runs were all the same.
#[test]
fn a_range_of_a_key_without_effect_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let mut sweep = Command::new(env!("CARGO_BIN_EXE_coilwind"));
    sweep.args(["sweep", "fig8", "--over", "winding.layers=1:2:2"]);
    sweep.args(["--set", "spindle.turns=0.3", "--out"]);
    sweep.arg(folder.path().join("out"));
    let said = complaint(sweep, 0);
    assert!(
        said.contains("warning: set by name: winding.layers = 2: has no effect"),
        "{said}"
    );
}

#[test]
fn rows_stand_in_the_order_of_the_grid_whatever_the_threads() {
    let folder = tempfile::tempdir().unwrap();
    let (one, three) = (folder.path().join("1"), folder.path().join("3"));
    for (out, threads) in [(&one, "1"), (&three, "3")] {
        finished(
            coilwind("sweep", out, &[&GRID[..], &["--threads", threads]].concat()),
            0,
        );
    }
    assert_eq!(
        without_clock(&one.join("sweep.csv")),
        without_clock(&three.join("sweep.csv"))
    );
    assert_eq!(
        std::fs::read(one.join("ensemble.csv")).unwrap(),
        std::fs::read(three.join("ensemble.csv")).unwrap()
    );
    let found = rows(&one.join("sweep.csv"));
    let place = |row: &BTreeMap<String, String>| {
        ["spindle.speed", "tensioner.tension", "member"].map(|name| row[name].clone())
    };
    let places: Vec<[String; 3]> = found.iter().map(place).collect();
    let mut expected = Vec::new();
    for speed in ["60", "120"] {
        for tension in ["10", "15"] {
            for member in ["1", "2"] {
                expected.push([speed, tension, member].map(str::to_owned));
            }
        }
    }
    assert_eq!(places, expected);
    for row in &found {
        assert_eq!(row["outcome"], "done");
        let (least, most): (f64, f64) = (
            row["tension_min_N"].parse().unwrap(),
            row["tension_max_N"].parse().unwrap(),
        );
        let set: f64 = row["tensioner.tension"].parse().unwrap();
        assert!(least <= set && set <= most && least > 0.0, "{row:?}");
    }
    // The nozzle's distance tells the members apart.
    assert_ne!(found[0]["tension_max_N"], found[1]["tension_max_N"]);
    let map = std::fs::read_to_string(one.join("map.svg")).unwrap();
    assert_eq!(map, std::fs::read_to_string(three.join("map.svg")).unwrap());
    assert_eq!(
        map.matches("\nnot judged\n").count(),
        4,
        "a cell a point: {map}"
    );
    for part in [
        "spindle.speed [rad/s]",
        "tensioner.tension [N]",
        "\n120\n",
        "\n15\n",
    ] {
        assert!(map.contains(part), "{part}: {map}");
    }
    let page = std::fs::read_to_string(one.join("map.html")).unwrap();
    assert_eq!(
        page,
        std::fs::read_to_string(three.join("map.html")).unwrap()
    );
    let (_, data) = page.split_once("application/json\" id=\"data\">").unwrap();
    let (data, _) = data.split_once("</script>").unwrap();
    let map: serde_json::Value = serde_json::from_str(data).unwrap();
    let cells = map["cells"].as_array().unwrap();
    assert_eq!(cells.len(), 4);
    // A page that is handed on says what it is of.
    let facts: BTreeMap<String, String> = serde_json::from_value(
        map["facts"]
            .as_array()
            .unwrap()
            .iter()
            .map(|f| (f[0].as_str().unwrap().to_owned(), f[1].clone()))
            .collect::<serde_json::Map<_, _>>()
            .into(),
    )
    .unwrap();
    for (name, words) in [
        ("scene", "fig8"),
        ("core", "rounded-box, 12 mm x 30 mm"),
        ("wire", "table1, 0.7 mm"),
        ("ensemble", "2 runs a point"),
        ("solver.tolerance", "1e-5 m"),
        ("version", env!("CARGO_PKG_VERSION")),
    ] {
        assert!(facts[name].contains(words), "{name}: {facts:?}");
    }
    let settings = map["settings"].as_array().unwrap();
    let has = |name: &str, value: &str, by: &str| {
        let is = |s: &serde_json::Value| s[0] == name && s[1] == value && s[3] == by;
        settings.iter().any(is)
    };
    assert!(has("spindle.turns", "0.3", "--set"), "{settings:?}");
    assert!(has("core.width_x", "0.012", "scene"), "{settings:?}");
    for swept in ["spindle.speed", "tensioner.tension"] {
        assert!(settings.iter().all(|s| s[0] != swept), "{settings:?}");
    }
    for (cell, runs) in cells.iter().zip(found.chunks(2)) {
        let (x, y) = (&map["x"]["values"], &map["y"]["values"]);
        let value = |axis: &serde_json::Value, key: &str| {
            axis[cell[key].as_u64().unwrap() as usize].to_string()
        };
        let is = |a: &str, b: String| a.parse::<f64>().unwrap() == b.parse::<f64>().unwrap();
        assert!(is(&runs[0]["spindle.speed"], value(x, "x")));
        assert!(is(&runs[0]["tensioner.tension"], value(y, "y")));
        assert_eq!((&cell["members"], &cell["defects"]), (&2.into(), &0.into()));
        let most = cell["runs"][1]["tension_max_N"].to_string();
        assert!(is(&runs[1]["tension_max_N"], most));
    }
    let ensembles = rows(&one.join("ensemble.csv"));
    assert_eq!(ensembles.len(), 4);
    assert!(ensembles.iter().all(|e| e["members"] == "2"));
}

/// A row of a sweep says what a run of the same scene says.
#[test]
fn a_row_equals_a_run_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let (many, single) = (folder.path().join("many"), folder.path().join("single"));
    // Long enough for gaps between wire at rest.
    let long = ["--set", "spindle.turns=2.2"];
    let more = ["--over", "spindle.speed=60:120:3", "--ensemble", "3"];
    finished(coilwind("sweep", &many, &[&long[..], &more].concat()), 0);
    let set = ["spindle.speed=90", "nozzle.distance_mm=59.65"];
    let more = ["--no-geometry", "--set", set[0], "--set", set[1]];
    finished(coilwind("run", &single, &[&long[..], &more].concat()), 0);
    let row = &rows(&many.join("sweep.csv"))[3];
    assert_eq!((&*row["spindle.speed"], &*row["member"]), ("90", "1"));
    let history = rows(&single.join("history.csv"));
    let column = |name: &str| {
        let cells: Vec<f64> = history
            .iter()
            .map(|row| row[name].parse().unwrap())
            .collect();
        cells
    };
    let least = column("wire_tension_min")
        .into_iter()
        .fold(f64::INFINITY, f64::min);
    let most = column("wire_tension_max").into_iter().fold(0.0, f64::max);
    assert_eq!(row["tension_min_N"].parse(), Ok(least));
    assert_eq!(row["tension_max_N"].parse(), Ok(most));
    let settled = *column("turns_settled").last().unwrap();
    assert_eq!(row["turns_settled"].parse(), Ok(settled));
    let text = std::fs::read_to_string(single.join("summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(summary["verdict"], *row["verdict"]);
    let turns = summary["turns"].as_array().unwrap();
    let gaps = turns.iter().filter_map(|turn| turn["gap_mean"].as_f64());
    let gap = gaps.fold(0.0, f64::max) / 0.7e-3;
    assert!(gap > 0.0);
    assert_eq!(row["gap_mean_d"].parse(), Ok(gap));
    // Mean and deviation over the three members of this speed.
    let gaps: Vec<f64> = rows(&many.join("sweep.csv"))[3..6]
        .iter()
        .map(|row| row["gap_mean_d"].parse().unwrap())
        .collect();
    let mean = gaps.iter().sum::<f64>() / 3.0;
    let squares: f64 = gaps.iter().map(|gap| (gap - mean).powi(2)).sum();
    let ensemble = &rows(&many.join("ensemble.csv"))[1];
    let column = |name: &str| ensemble[name].parse::<f64>().unwrap();
    assert!((column("gap_mean_d") - mean).abs() < 1e-12);
    assert!((column("gap_deviation_d") - (squares / 2.0).sqrt()).abs() < 1e-12);
}

/// A sweep that went on wound everything again.
#[test]
fn what_is_wound_is_not_wound_again() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    let over = ["--over", "spindle.speed=60:120:3"];
    finished(coilwind("sweep", out, &over), 0);
    let table = out.join("sweep.csv");
    let whole = std::fs::read_to_string(&table).unwrap();
    // A row that is kept keeps its clock; one that is missing is wound again.
    let mut lines: Vec<&str> = whole.lines().collect();
    lines.remove(2);
    std::fs::write(&table, lines.join("\n") + "\n").unwrap();
    finished(coilwind("sweep", out, &over), 0);
    let again = std::fs::read_to_string(&table).unwrap();
    let kept = |text: &str| [1, 3].map(|line| text.lines().nth(line).unwrap().to_owned());
    assert_eq!(kept(&again), kept(&whole));
    let without = |text: &str| {
        text.lines()
            .nth(2)
            .unwrap()
            .rsplit_once(',')
            .unwrap()
            .0
            .to_owned()
    };
    assert_eq!(without(&again), without(&whole));

    for (other, part) in [
        (&["--over", "spindle.speed=60:120:2"][..], "another over"),
        (
            &[over[0], over[1], "--set", "wire.material=copper"],
            "another scene: wire.material",
        ),
        (&[over[0], over[1], "--ensemble", "2"], "another ensemble"),
    ] {
        let said = complaint(coilwind("sweep", out, other), 2);
        assert!(said.contains(part) && said.contains("--force"), "{said}");
        assert_eq!(std::fs::read_to_string(&table).unwrap(), again);
    }
    // a last row that is torn was refused
    std::fs::write(&table, &again[..again.len() - 5]).unwrap();
    finished(coilwind("sweep", out, &over), 0);
    assert_eq!(rows(&table).len(), 3);
    let plan = out.join("sweep.json");
    let text = std::fs::read_to_string(&plan).unwrap();
    std::fs::write(&plan, &text[..text.len() / 2]).unwrap();
    let said = complaint(coilwind("sweep", out, &over), 2);
    assert!(said.contains("its sweep.json is not whole"), "{said}");
    std::fs::write(&plan, &text).unwrap();
    std::fs::write(&table, again.replace("60,1,", "61,1,")).unwrap();
    let said = complaint(coilwind("sweep", out, &over), 2);
    assert!(said.contains("sweep.csv:2: no row of this sweep"), "{said}");
    std::fs::write(&table, &again[..12]).unwrap();
    let said = complaint(coilwind("sweep", out, &over), 2);
    assert!(said.contains("sweep.csv:1: not the header"), "{said}");
    let force = ["--force", "--over", "spindle.speed=60:60:1"];
    finished(coilwind("sweep", out, &force), 0);
    assert_eq!(rows(&table).len(), 1);
}

/// The page said 0 m where the tolerance was left to the program.
#[test]
fn the_map_tells_the_tolerance_that_was_used() {
    let folder = tempfile::tempdir().unwrap();
    let tension = ["--over", "tensioner.tension=10:15:2"];
    let speed = ["--over", "spindle.speed=60:70:2"];
    let width = ["--over", "wire.diameter_mm=0.6:0.7:2"];
    for (name, over, more, told) in [
        ("default", speed, &[][..], "2e-6 m"),
        ("thin", speed, &["wire.diameter_mm=0.35"], "1e-6 m"),
        ("given", speed, &["solver.tolerance=1e-5"], "1e-5 m"),
        ("swept", width, &[], "1.71428571e-6 to 2e-6 m"),
        ("explicit", speed, &["solver.integrator=rk4"], "not used"),
    ] {
        let out = folder.path().join(name);
        let mut sweep = Command::new(env!("CARGO_BIN_EXE_coilwind"));
        sweep.args(["sweep", "fig8", "--quiet", "--set", "spindle.turns=0.02"]);
        sweep.args(["--set", "spindle.ramp_turns=0.01"]);
        sweep.args(["--set", "wire.material=copper"]);
        sweep.args(tension).args(over);
        more.iter().for_each(|set| {
            sweep.args(["--set", set]);
        });
        sweep.arg("--out").arg(&out);
        finished(sweep, 0);
        let page = std::fs::read_to_string(out.join("map.html")).unwrap();
        let (_, rest) = page.split_once("[\"solver.tolerance\",\"").unwrap();
        assert!(rest.starts_with(told), "{name}: {}", &rest[..60]);
    }
}

/// Cells of such runs were blue, free of defects.
#[test]
fn runs_that_judge_nothing_are_not_free_of_defects_on_the_map() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let mut sweep = Command::new(env!("CARGO_BIN_EXE_coilwind"));
    sweep.args(["sweep", "fig8", "--set", "spindle.turns=0.3"]);
    sweep.args(["--over", "spindle.speed=60:61:4"]);
    sweep.args(["--over", "tensioner.tension=10:15:2", "--out"]);
    sweep.arg(&out);
    let said = complaint(sweep, 0);
    assert!(
        said.contains("in 8 of 8 runs no turn came to rest"),
        "{said}"
    );
    let table = rows(&out.join("ensemble.csv"));
    assert!(table.iter().all(|row| row["unjudged_share"] == "1"));
    let map = std::fs::read_to_string(out.join("map.svg")).unwrap();
    assert!(map.contains("\nnot judged\n"), "{map}");
    assert!(
        map.contains("#969696") && !map.contains("#D6E8F4"),
        "grey, not blue"
    );
    // (a third of a step is no number that anyone reads)
    assert!(map.contains("60.3333") && !map.contains("60.33333"));
}

#[test]
fn what_no_sweep_can_do_is_told_before_anything_is_wound() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    for (more, parts) in [
        (
            &["--over", "spindle.speed=300:100:3"][..],
            &["spindle.speed", "reversed", "100:300:3"][..],
        ),
        (&["--over", "spindle.speed=100:100:3"], &["empty"]),
        (&["--over", "spindle.speed=100:200:0"], &["N = 0"]),
        (&["--over", "spindle.speed=100:200"], &["NAME=A:B:N"]),
        (
            &["--over", "spindle.sped=100:200:3"],
            &["did you mean spindle.speed?"],
        ),
        (
            &["--over", "nozzle.distance_mm=60:20000:3"],
            &["nozzle.distance_mm = 10030", "out of range"],
        ),
        (
            &["--over", "core.corner_radius_mm=1:7:2"],
            &["core.corner_radius = 0.007 m", "0 to 0.006 m"],
        ),
        (&["--over", "wire.material=1:2:2"], &["is no number"]),
        (
            &[
                "--over",
                "spindle.speed=1:2:2",
                "--over",
                "spindle.speed=3:4:2",
            ],
            &["has a range already"],
        ),
        // Two spellings of one variable made rows that named a value and were wound at another.
        (
            &[
                "--over",
                "spindle.speed=100:200:2",
                "--over",
                "spindle.speed_rpm=1000:2000:2",
            ],
            &["spindle.speed has a range already, --over spindle.speed=100:200:2"],
        ),
        (
            &[
                "--set",
                "spindle.speed_rpm=900",
                "--over",
                "spindle.speed=100:200:2",
            ],
            &["--set spindle.speed_rpm=900", "leave out one of them"],
        ),
        (
            &["--over", "spindle.speed=1:2:100000", "--ensemble", "1000"],
            &["more than 1000000 runs"],
        ),
        (
            &[
                "--over",
                "spindle.speed=1:2:2",
                "--find-max",
                "wire.diameter",
            ],
            &["--over wire.diameter=A:B:N"],
        ),
        (&[], &["--over"]),
    ] {
        let said = complaint(coilwind("sweep", &out, more), 2);
        for part in parts {
            assert!(said.contains(part), "{more:?}: {said}");
        }
        // Without any range the usage follows.
        assert!(more.is_empty() || said.lines().count() == 1, "{said}");
    }
    assert!(!out.exists());
}

/// It keeps its rows and says how to go on. It built the scenes of all runs that were left, one by one, before it did.
#[cfg(unix)]
#[test]
fn an_interrupted_sweep_begins_no_more_runs() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    let mut command = coilwind("sweep", out, &["--over", "spindle.speed=60:300:100000"]);
    command.stderr(std::process::Stdio::piped());
    let mut process = command.spawn().unwrap();
    let table = out.join("sweep.csv");
    let lines = || std::fs::read_to_string(&table).map_or(0, |text| text.lines().count());
    let patience = std::time::Instant::now();
    while lines() < 2 && patience.elapsed().as_secs() < 60 {
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    let id = process.id().to_string();
    let kill = Command::new("kill").args(["-INT", &id]).status().unwrap();
    assert!(kill.success());
    // (what is left takes many minutes)
    let patience = std::time::Instant::now();
    while process.try_wait().unwrap().is_none() {
        assert!(patience.elapsed().as_secs() < 60, "it goes on");
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    let output = process.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(
        said.contains("go on with: coilwind sweep fig8 --quiet"),
        "{said}"
    );
    let kept = rows(&table).len();
    assert!((1..200).contains(&kept), "{kept}");
    assert!(said.contains(&format!("{kept} runs are kept")), "{said}");
}

/// Two of them wound every run, each of them all, and replaced each other's table.
#[cfg(unix)]
#[test]
fn sweeps_that_begin_at_the_same_moment_in_one_folder_wind_each_run_once() {
    let folder = tempfile::tempdir().unwrap();
    for round in 0..8 {
        let out = folder.path().join(round.to_string());
        let begun = (0..6).map(|_| {
            let mut sweep = Command::new(env!("CARGO_BIN_EXE_coilwind"));
            sweep.args(["sweep", "fig8", "--over", "spindle.speed=60:61:4"]);
            sweep.args(["--set", "spindle.turns=0.02"]);
            sweep.args(["--set", "spindle.ramp_turns=0.02", "--threads", "1"]);
            sweep.arg("--out").arg(&out);
            sweep.stdout(std::process::Stdio::piped());
            sweep.stderr(std::process::Stdio::piped());
            sweep.spawn().unwrap()
        });
        let begun: Vec<_> = begun.collect();
        let mut new = 0;
        for process in begun {
            let output = process.wait_with_output().unwrap();
            let text = |bytes| String::from_utf8(bytes).unwrap();
            let (told, said) = (text(output.stdout), text(output.stderr));
            if output.status.success() {
                // `4 runs, 4 of them new`; one that came after the end of another winds none
                let count = told.split_once("4 runs, ").unwrap().1;
                new += count.split_once(' ').unwrap().0.parse::<u32>().unwrap();
            } else {
                assert!(said.contains("a sweep is going on here"), "{said}");
            }
        }
        assert_eq!(new, 4, "round {round}");
        assert_eq!(rows(&out.join("sweep.csv")).len(), 4);
    }
}

/// The command that goes on was put together from words that are text, and a folder need not be one.
#[cfg(target_os = "linux")]
#[test]
fn a_sweep_says_how_to_go_on_in_a_folder_whose_name_is_no_text() {
    use std::os::unix::ffi::OsStrExt;
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join(std::ffi::OsStr::from_bytes(b"out\xff"));
    std::fs::create_dir(&out).unwrap();
    // a folder where the table is to be
    std::fs::create_dir(out.join("ensemble.csv")).unwrap();
    let said = complaint(
        coilwind("sweep", &out, &["--over", "spindle.speed=60:60:1"]),
        3,
    );
    assert!(said.contains("go on with: coilwind sweep fig8"), "{said}");
}

#[test]
fn an_ensemble_of_a_run_leaves_a_folder_a_member() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let run = |more: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_coilwind"));
        command.args(["run", "fig8", "--ensemble", "3", "--no-geometry"]);
        command.args(&SHORT[2..]).arg("--out").arg(&out).args(more);
        command
    };
    let said = String::from_utf8(finished(run(&[]), 0).stdout).unwrap();
    assert!(said.contains("3 of 3 (100 %)"), "{said}");
    let mut distances = Vec::new();
    for member in ["1", "2", "3"] {
        let scene = std::fs::read_to_string(out.join(member).join("scene.toml")).unwrap();
        let scene: toml::Table = scene.parse().unwrap();
        distances.push(scene["nozzle"]["distance"].as_float().unwrap());
        assert!(out.join(member).join("summary.json").exists());
    }
    assert_eq!(distances, [0.05965, 0.06, 0.06035]);
    std::fs::remove_dir_all(out.join("1")).unwrap();
    let said = complaint(run(&[]), 2);
    assert!(said.contains("--force"), "{said}");
    assert!(!out.join("1").exists(), "nothing is wound");
    finished(run(&["--force"]), 0);
}

/// `--force` removed the very scene that it was to wind.
#[test]
fn a_scene_in_the_folder_is_not_removed_with_the_run() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    let text = "[spindle]\nturns = 0.4\n";
    std::fs::write(&scene, text).unwrap();
    let ensemble = ["run", "--ensemble", "2", "--force"];
    let sweep = ["sweep", "--over", "spindle.speed=60:70:2", "--force"];
    for words in [&ensemble[..], &sweep[..]] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_coilwind"));
        command
            .args(words)
            .arg(&scene)
            .arg("--out")
            .arg(folder.path());
        let said = complaint(command, 2);
        assert!(said.contains("copy the scene"), "{said}");
        assert_eq!(std::fs::read_to_string(&scene).unwrap(), text);
    }
}

/// A run in the folder of a sweep and a sweep in that of a run left files of both, and each was gone on with.
#[test]
fn runs_and_sweeps_do_not_share_a_folder() {
    let folder = tempfile::tempdir().unwrap();
    let (swept, run) = (folder.path().join("swept"), folder.path().join("run"));
    let over = ["--over", "spindle.speed=60:60:1"];
    let files = |folder: &Path| {
        let entries = std::fs::read_dir(folder).unwrap();
        let mut names: Vec<String> = entries
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    };
    finished(coilwind("sweep", &swept, &over), 0);
    finished(coilwind("run", &run, &["--no-geometry"]), 0);
    let (of_sweep, of_run) = (files(&swept), files(&run));
    for (command, out, more, holds) in [
        ("run", &swept, &["--no-geometry"][..], "holds a sweep"),
        ("run", &swept, &["--ensemble", "2"], "holds a sweep"),
        ("sweep", &run, &over, "holds another run"),
    ] {
        let before = files(out);
        let said = complaint(coilwind(command, out, more), 2);
        assert!(said.contains(holds) && said.contains("--force"), "{said}");
        assert_eq!(files(out), before);
    }
    let force = ["--force", "--no-geometry"];
    finished(coilwind("run", &swept, &force), 0);
    assert_eq!(files(&swept), of_run);
    finished(
        coilwind("sweep", &run, &[&over[..], &["--force"]].concat()),
        0,
    );
    assert_eq!(files(&run), of_sweep);
}
