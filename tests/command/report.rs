//! The report of a run, as a file: what it holds and what keeps it from being made. tests/report/ opens it in a browser.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use coilwind::math::V3;
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};

fn coilwind(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_coilwind"))
        .args(arguments)
        .output()
        .unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn wind(out: &Path, more: &[&str]) {
    let out = out.to_str().unwrap();
    let words = [
        "run",
        "fig8",
        "--quiet",
        "--out",
        out,
        "--set",
        "spindle.turns=1.6",
        "--set",
        "solver.spacing_near_mm=0.5",
    ];
    let output = coilwind(&[&words, more].concat());
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
}

/// The data of a page.
fn data(page: &Path) -> Value {
    let text = std::fs::read_to_string(page).unwrap();
    let (_, rest) = text.split_once("id=\"data\">").unwrap();
    let (json, _) = rest.split_once("</script>").unwrap();
    serde_json::from_str(json).unwrap()
}

fn reals(array: &Value) -> Vec<f32> {
    let text = array.as_str().unwrap().strip_prefix("f32:").unwrap();
    let bytes = STANDARD.decode(text).unwrap();
    bytes
        .chunks(4)
        .map(|c| f32::from_le_bytes(c.try_into().unwrap()))
        .collect()
}

fn column(path: &Path, name: &str) -> Vec<f64> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let place = reader
        .headers()
        .unwrap()
        .iter()
        .position(|h| h == name)
        .unwrap();
    reader
        .records()
        .map(|row| row.unwrap()[place].parse().unwrap_or(f64::NAN))
        .collect()
}

#[test]
fn the_page_holds_the_numbers_of_the_run() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("a <script> b");
    wind(&out, &["--frames", "4"]);
    let page = out.join("report.html");
    let first = std::fs::read(&page).unwrap();
    let found = data(&page);
    let run = &found["runs"][0];
    assert_eq!(run["name"], "a <script> b");
    assert_eq!(run["summary"]["status"], "done");

    let tension = column(&out.join("history.csv"), "wire_tension");
    let shown = reals(&run["history"]["tension"]);
    assert_eq!(shown.len(), tension.len(), "a short history is not thinned");
    assert!(shown.iter().zip(&tension).all(|(a, b)| *a == *b as f32));
    let arc = column(&out.join("stations.csv"), "arc");
    assert_eq!(reals(&run["stations"]["arc"]).len(), arc.len());

    // The centreline lies where the stations of the same arc do. Both are chords of the wire, with nodes 0.5 mm apart when a station
    // was measured and 1 mm or more where edges were joined since: 1 mm^2 / (8 * 2.35 mm) above each other round a corner of the core.
    // Along the wire arcs differ as corners stretch it between nodes: by less than the shortest edge.
    let (points, node_arc) = (reals(&run["wire"]["points"]), reals(&run["wire"]["arc"]));
    let [x, y, z] = ["x", "y", "z"].map(|name| column(&out.join("stations.csv"), name));
    let place = |node: usize| V3::from_fn(|axis, _| f64::from(points[3 * node + axis]));
    assert!(arc.len() > 100, "{} stations", arc.len());
    for k in 0..arc.len() {
        let after = node_arc.partition_point(|&a| f64::from(a) < arc[k]).max(1);
        let (a, b) = (f64::from(node_arc[after - 1]), f64::from(node_arc[after]));
        let edge = place(after) - place(after - 1);
        let off = place(after - 1) + (arc[k] - a) / (b - a) * edge - V3::new(x[k], y[k], z[k]);
        let along = off.dot(&edge.normalize());
        let across = (off.norm_squared() - along * along).max(0.0).sqrt();
        let sagitta = edge.norm().max(1e-3).powi(2) / (8.0 * 2.35e-3);
        assert!(
            across < sagitta && along.abs() < 0.5e-3,
            "station {k}: {across} m beside its place and {along} m along the wire"
        );
    }
    let frames = run["frames"].as_array().unwrap();
    assert_eq!(frames.len(), 4);
    let kept: Vec<u64> = frames.iter().map(|f| f["keep"].as_u64().unwrap()).collect();
    // (how far a frame is kept hangs on a bound that wire may pass and pass back by moving a little later)
    assert!(
        kept[0] < kept[3] && kept[3] as usize == node_arc.len(),
        "{kept:?}"
    );
    assert!(kept.iter().all(|k| *k <= kept[3]), "{kept:?}");
    assert!(frames[0]["time"].as_f64() < frames[3]["time"].as_f64());

    // Made again it is the same page.
    let output = coilwind(&["report", out.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    assert_eq!(std::fs::read(&page).unwrap(), first);

    let other = folder.path().join("other");
    wind(&other, &["--no-report"]);
    assert!(!other.join("report.html").exists());
    let output = coilwind(&["report", out.to_str().unwrap(), other.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    assert_eq!(
        data(&out.join("compare.html"))["runs"]
            .as_array()
            .unwrap()
            .len(),
        2
    );
}

/// Kinds of defect with codes above 255 became all kinds at once: stretched wire had the colour of a double turn.
#[test]
fn the_page_knows_every_kind_of_defect() {
    let folder = tempfile::tempdir().unwrap();
    let soft = [
        "--set",
        "wire.material=aluminium",
        "--set",
        "wire.yield_stress=28e6",
        "--set",
        "spindle.speed=100",
    ];
    wind(folder.path(), &soft);
    let page = data(&folder.path().join("report.html"));
    let summary = &page["runs"][0]["summary"];
    let kinds: Vec<&str> = summary["defects"]
        .as_array()
        .unwrap()
        .iter()
        .map(|defect| defect["kind"].as_str().unwrap())
        .collect();
    assert!(
        !kinds.is_empty() && kinds.iter().all(|kind| *kind == "overstretch"),
        "{kinds:?}"
    );
    let text = page["runs"][0]["wire"]["defect"].as_str().unwrap();
    let bytes = STANDARD.decode(text.strip_prefix("u16:").unwrap()).unwrap();
    let codes: std::collections::BTreeSet<u16> = bytes
        .chunks(2)
        .map(|c| u16::from_le_bytes(c.try_into().unwrap()))
        .collect();
    assert_eq!(codes, [0, 1024].into());
}

#[test]
fn a_product_has_the_length_and_resistance_of_its_wire() {
    let folder = tempfile::tempdir().unwrap();
    wind(folder.path(), &["--no-geometry"]);
    let text = std::fs::read_to_string(folder.path().join("summary.json")).unwrap();
    let product = &serde_json::from_str::<Value>(&text).unwrap()["product"];
    let length = product["wire_length_m"].as_f64().unwrap();
    let turns = product["turns"].as_f64().unwrap();
    // A turn lies round a box of 12 x 30 mm with corners of 2 mm, half a wire off it, and bulges by a little.
    let round = 2.0 * (8.0 + 26.0) + std::f64::consts::TAU * 2.35;
    assert!(
        (length / (1e-3 * round * turns) - 1.0).abs() < 0.08,
        "{length} m in {turns} turns"
    );
    let area = std::f64::consts::PI * 0.35 * 0.35;
    let expected = length / 58.0 / area;
    let got = product["resistance_ohm"].as_f64().unwrap();
    assert!(
        (got / expected - 1.0).abs() < 1e-12,
        "{got} ohm for {expected}"
    );
    assert!(!folder.path().join("report.html").exists());
}

#[test]
fn a_file_is_no_folder_of_a_run() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("summary.json");
    std::fs::write(&file, "{}").unwrap();
    let output = coilwind(&["report", file.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        said(&output).contains("summary.json is a file; name the folder of a run"),
        "{}",
        said(&output)
    );
}

#[test]
fn a_folder_without_a_whole_run_is_named_with_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let refused = |part: &str| {
        let output = coilwind(&["report", out.to_str().unwrap()]);
        assert_eq!(output.status.code(), Some(2));
        assert_eq!(said(&output).lines().count(), 1, "{}", said(&output));
        assert!(said(&output).contains(part), "{part}: {}", said(&output));
    };
    refused("wind one with: coilwind run SCENE");
    std::fs::create_dir_all(out.join("1")).unwrap();
    std::fs::write(out.join("1/summary.json"), "{}").unwrap();
    refused(out.join("1").to_str().unwrap());
    std::fs::write(out.join("sweep.json"), "{}").unwrap();
    // a sweep over one variable has no page
    refused("sweep.csv");
    std::fs::write(out.join("map.html"), "").unwrap();
    refused("map.html");
    std::fs::remove_dir_all(&out).unwrap();
    wind(&out, &["--no-report"]);
    for name in [
        "summary.json",
        "coil.vtp",
        "history.csv",
        "stations.csv",
        "core.vtp",
    ] {
        let path = out.join(name);
        let whole = std::fs::read(&path).unwrap();
        std::fs::write(&path, &whole[..whole.len() / 2]).unwrap();
        if name.ends_with("csv") {
            // Half a table may still be a table: a row that breaks off is not.
            let mut half = whole[..whole.len() / 2].to_vec();
            half.extend(b"\n1,2\n");
            std::fs::write(&path, half).unwrap();
        }
        refused(name);
        if name.ends_with("csv") {
            // cut between two rows: the page told of a run wound to its end
            let rows: Vec<&[u8]> = whole.split_inclusive(|byte| *byte == b'\n').collect();
            std::fs::write(&path, rows[..rows.len() / 2].concat()).unwrap();
            refused(name);
        }
        std::fs::write(&path, whole).unwrap();
    }
    assert!(!out.join("report.html").exists(), "no half page");
    assert_eq!(
        coilwind(&["report", out.to_str().unwrap()]).status.code(),
        Some(0)
    );
}

/// The page that compares two runs, made in a folder.
fn compared(one: &Path, other: &Path) -> Value {
    let page = one.join("compare.html");
    let output = coilwind(&["report", one.to_str().unwrap(), other.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    data(&page)
}

/// Names and values of what differs.
fn differing(data: &Value) -> Vec<(&str, [&str; 2])> {
    fn text(value: &Value) -> &str {
        value.as_str().unwrap()
    }
    let all = data["differences"].as_array().unwrap().iter();
    all.map(|d| (text(&d["name"]), [0, 1].map(|run| text(&d["values"][run]))))
        .collect()
}

/// Such runs were told to have the same scene, and nothing more.
#[test]
fn options_that_differ_are_told_in_a_comparison() {
    let folder = tempfile::tempdir().unwrap();
    let [whole, cut, led] = ["whole", "cut", "led"].map(|name| folder.path().join(name));
    let table = folder.path().join("my motion.csv");
    std::fs::write(&table, "time,spindle_speed\n0,10\n0.004,10\n").unwrap();
    let table = std::path::absolute(&table).unwrap();
    let table = table.to_str().unwrap();
    wind(&whole, &["--no-geometry"]);
    wind(&cut, &["--no-report", "--stop-time", "0.004"]);
    wind(
        &led,
        &["--no-geometry", "--inputs", table, "--step", "0.002"],
    );
    let data = compared(&whole, &cut);
    assert_eq!(differing(&data), [("--stop-time", ["", "0.004 s"])]);
    let data = compared(&cut, &led);
    let expected = [
        ("--inputs", ["", table]),
        ("--step", ["", "0.002 s"]),
        ("--stop-time", ["0.004 s", ""]),
    ];
    assert_eq!(differing(&data), expected);
    assert!(differing(&compared(&led, &led)).is_empty());
    // How far each was wound, for the words of the page.
    let wound: Vec<&Value> = data["runs"].as_array().unwrap().iter().collect();
    assert_eq!(wound[0]["wound_to"], "wound until --stop-time 0.004 s");
    assert_eq!(wound[1]["wound_to"], "wound to the end of its inputs");
}

/// A run that was cut short was told to be wound to its end.
#[test]
fn a_run_that_was_cut_short_is_told_so() {
    let folder = tempfile::tempdir().unwrap();
    for (name, more, told) in [
        ("whole", &[][..], "wound to its end"),
        ("late", &["--stop-time", "1000"], "wound to its end"),
        (
            "cut",
            &["--stop-time", "0.004"],
            "wound until --stop-time 0.004 s",
        ),
    ] {
        let out = folder.path().join(name);
        wind(&out, more);
        let data = data(&out.join("report.html"));
        assert_eq!(data["runs"][0]["wound_to"], told, "{name}");
    }
}
