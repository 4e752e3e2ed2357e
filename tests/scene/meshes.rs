//! Cores from STL files as other programs write them, and files that make no core.

use crate::common::{assert_says, parse};
use coilwind::scene::Scene;
use std::path::Path;

/// Corners of the triangles of a box of 12 x 30 x 20 mm, mm.
fn triangles() -> Vec<[[f32; 3]; 3]> {
    of_a_box(6.0, [-15.0, 15.0], 10.0)
}

/// The same of a box of any size: half its width and height, mm, and from where to where along y.
pub(crate) fn of_a_box(half_x: f32, y: [f32; 2], half_z: f32) -> Vec<[[f32; 3]; 3]> {
    let corner = |i: u32| {
        let side = |bit: u32, half: f32| if i >> bit & 1 == 1 { half } else { -half };
        [side(0, half_x), y[(i >> 1 & 1) as usize], side(2, half_z)]
    };
    let quads = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    let halves = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]];
    quads
        .into_iter()
        .flat_map(halves)
        .map(|t| t.map(corner))
        .collect()
}

/// The text of a file whose solid has this name.
pub(crate) fn text(name: &str, triangles: &[[[f32; 3]; 3]]) -> String {
    let facet = |corners: &[[f32; 3]; 3]| {
        let vertices = corners
            .map(|[x, y, z]| format!("vertex {x} {y} {z}\n"))
            .concat();
        format!("facet normal 0 0 0\nouter loop\n{vertices}endloop\nendfacet\n")
    };
    let facets: String = triangles.iter().map(facet).collect();
    format!("solid{name}\n{facets}endsolid\n")
}

/// What is said of a core in this file, or nothing where it is wound on.
fn said_of(folder: &Path, name: &str, text: &str) -> Option<String> {
    std::fs::write(folder.join(name), text).unwrap();
    let scene = format!("[core]\nshape = 'mesh'\nfile = {:?}", folder.join(name));
    let error = parse(&scene).expect("parses").build().err()?;
    Some(error.to_string())
}

/// The file was read twice, first by a reader that knew one way of writing only: such files could not be wound on.
#[test]
fn stl_files_are_read_however_their_text_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let plain = text(" part", &triangles());
    for (name, text) in [
        ("plain.stl", plain.clone()),
        ("unnamed.stl", text("", &triangles())),
        ("capitals.stl", plain.to_uppercase()),
        ("windows.stl", plain.replace('\n', "\r\n")),
        ("marked.stl", format!("\u{feff}{plain}")),
        ("empty_line.stl", format!("\n{plain}")),
    ] {
        assert_eq!(said_of(folder.path(), name, &text), None, "{name}");
    }
}

/// Such a mesh was told at the start of the run, alone, without its key, and its hole by numbers that no STL file has.
#[test]
fn a_mesh_that_makes_no_core_is_told_with_its_key_and_place() {
    let folder = tempfile::tempdir().unwrap();
    let all = triangles();
    let turned: Vec<_> = all.iter().map(|&[a, b, c]| [a, c, b]).collect();
    for (name, text, parts) in [
        (
            "open.stl",
            text(" part", &all[1..]),
            &["the mesh is open", "x = -6.000, y = "][..],
        ),
        ("turned.stl", text(" part", &turned), &["inside out"]),
        ("none.stl", text(" part", &[]), &["no triangles"]),
        (
            "twice.stl",
            text(" part", &all).repeat(2),
            &[
                "has 4 triangles",
                "unite bodies that touch there, or move them apart",
            ],
        ),
    ] {
        let said = said_of(folder.path(), name, &text).expect("must be refused");
        assert_says(&said, &["test.toml:3: core.file = ", name, "allowed: "]);
        assert_says(&said, parts);
    }
}

/// "invalid facet header" told neither the line nor what belongs there.
#[test]
fn a_fault_in_the_text_of_an_stl_file_is_told_with_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let plain = text(" part", &triangles());
    let lines: Vec<&str> = plain.lines().collect();
    let with = |line: usize, new: &[&str]| {
        let mut changed = lines.clone();
        changed.splice(line - 1..line, new.iter().copied());
        changed.join("\n")
    };
    let whole = lines.len();
    for (name, text, parts) in [
        (
            "comma.stl",
            with(4, &["  vertex -6 -15 -10,"]),
            ["line 4: ", "vertex -6 -15 -10,"],
        ),
        (
            "infinite.stl",
            with(6, &["vertex 1 2 inf"]),
            ["line 6: ", "vertex and three finite numbers"],
        ),
        (
            "square.stl",
            with(7, &["vertex 1 2 3", "endloop"]),
            ["line 7: ", "endloop"],
        ),
        (
            "header.stl",
            with(9, &["facet"]),
            ["line 9: ", "facet normal"],
        ),
        (
            "blank.stl",
            with(3, &["", "outer lop"]),
            ["line 4: ", "outer loop"],
        ),
        (
            "cut.stl",
            lines[..whole - 2].join("\n"),
            ["line 84: ", "endfacet"],
        ),
        (
            "endless.stl",
            lines[..whole - 1].join("\r\n"),
            ["line 85: ", "endsolid"],
        ),
    ] {
        let said = said_of(folder.path(), name, &text).expect("must be refused");
        assert_says(&said, &["core.file = ", name, "ASCII"]);
        assert_says(&said, &parts);
    }
}

/// Such a surface was wound on without a word.
#[test]
fn a_body_that_crosses_itself_is_warned_of_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("crossed.stl");
    let warned = |corner: [f32; 3]| -> String {
        let mut crossed = triangles();
        for vertex in crossed.iter_mut().flatten() {
            if *vertex == [6.0, 15.0, 10.0] {
                *vertex = corner;
            }
        }
        std::fs::write(&file, text(" part", &crossed)).unwrap();
        let scene = format!(
            "[core]\nshape = 'mesh'\nfile = {file:?}\n[start]\nclamp_y_mm = -12\n[nozzle]\ny_start_mm = -12"
        );
        let built = parse(&scene).expect("parses").build_with_warnings();
        let (_, warnings) = built.expect("a core all the same");
        let warnings = warnings.iter().map(ToString::to_string);
        warnings
            .filter(|said| said.contains("crosses itself"))
            .collect()
    };
    assert_eq!(warned([6.0, 15.0, 10.0]), "");
    assert_eq!(warned([-5.9, 10.0, 5.0]), "");
    // a corner that is drawn out of the face on the other side
    let said = warned([-9.0, 10.0, 5.0]);
    assert_says(&said, &["test.toml:3: core.file = ", "x = -6.000, y = "]);
}

/// Only the volume of all bodies of a file together was looked at: a flange could be inside out.
#[test]
fn one_body_of_several_that_is_inside_out_is_told_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let inside_out = |body: Vec<[[f32; 3]; 3]>| body.into_iter().map(|[a, b, c]| [a, c, b]);
    let mut flanged = triangles();
    flanged.extend(inside_out(of_a_box(9.0, [12.0, 14.0], 13.0)));
    let said = said_of(folder.path(), "flanged.stl", &text(" part", &flanged));
    assert_says(
        &said.expect("must be refused"),
        &[
            "test.toml:3: core.file = ",
            "x = 9.000, y = 1",
            "inside out",
            "allowed: ",
        ],
    );
    // a cavity is one by right
    let mut hollow = triangles();
    hollow.extend(inside_out(of_a_box(3.0, [-12.0, 14.0], 7.0)));
    let said = said_of(folder.path(), "hollow.stl", &text(" part", &hollow));
    assert_eq!(said, None);
}

/// A core beside its axis was wound on: the wire turned round nothing, and the run asked for more turns.
#[test]
fn a_core_beside_its_axis_is_told_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let shifted = |body: Vec<[[f32; 3]; 3]>, by: [f32; 2]| {
        let corner = move |[x, y, z]: [f32; 3]| [x + by[0], y, z + by[1]];
        body.into_iter().map(move |t| t.map(corner))
    };
    let moved = |x_mm: f32| {
        let moved: Vec<_> = shifted(triangles(), [x_mm, 0.0]).collect();
        said_of(folder.path(), "moved.stl", &text(" part", &moved))
    };
    assert_says(
        &moved(8.0).expect("must be refused"),
        &[
            "test.toml:3: core.file = ",
            "x = 0.002 to 0.014 m, z = -0.01 to 0.01 m",
            "start.clamp_y",
            "move the mesh so that its axis is y",
        ],
    );
    assert_eq!(moved(5.0), None);
    // the axis goes through the hole of four walls round it
    let mut walls = Vec::new();
    for side in [-1.0, 1.0] {
        walls.extend(shifted(
            of_a_box(1.0, [-15.0, 15.0], 9.5),
            [5.0 * side, 0.0],
        ));
        walls.extend(shifted(
            of_a_box(5.0, [-14.0, 14.0], 1.0),
            [0.0, 9.0 * side],
        ));
    }
    let said = said_of(folder.path(), "walls.stl", &text(" part", &walls));
    assert_eq!(said, None);
}

/// A flange that surrounds the axis stood for the core where the clamped wire touches it; the coil was planned beside the axis.
#[test]
fn a_core_beside_its_axis_is_told_where_the_clamp_touches_a_flange_round_it() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("beside.stl");
    let build = |aside: f32, clamp_mm: f64, more: &str| {
        let mut all = of_a_box(6.0, [-6.0, 7.0], 10.0);
        for t in all.iter_mut().flatten() {
            t[0] += aside;
        }
        all.extend(of_a_box(16.0, [-5.0, -4.0], 14.0));
        all.extend(of_a_box(16.0, [5.0, 6.0], 14.0));
        std::fs::write(&file, text(" tooth", &all)).unwrap();
        let scene = format!(
            "[core]\nshape = 'mesh'\nfile = {file:?}\n[wire]\ndiameter_mm = 0.5\n[start]\nclamp_y_mm = {clamp_mm}\n\
             [nozzle]\ndistance_mm = 40\ny_start_mm = {clamp_mm}\n[traverse]\nmode = 'orthocyclic'\n[winding]\n{more}"
        );
        let built = parse(&scene).expect("parses").build();
        built.map(|_| ()).map_err(|error| error.to_string())
    };
    for more in ["", "turns_per_layer = 10"] {
        for clamp_mm in [-3.75, 0.0, 4.75] {
            let said = build(8.0, clamp_mm, more).expect_err("beside its axis");
            let clamp = format!("start.clamp_y = {} m", clamp_mm * 1e-3);
            assert_says(
                &said,
                &[
                    "test.toml:3: core.file = ",
                    "x = 0.002 to 0.014 m",
                    &clamp,
                    "move the mesh so that its axis is y",
                ],
            );
            assert!(!said.contains("turns_per_layer"), "{said}");
        }
        assert_eq!(build(0.0, -3.75, more), Ok(()));
    }
}

/// Wire of 0.5 mm on a box of 12 x 20 mm between flanges of the file's own, 3 mm high, with their faces at -4 and 5 mm.
fn between_flanges(folder: &Path, wire_mm: f64, more: &str) -> Result<Scene, String> {
    let mut all = of_a_box(6.0, [-6.0, 7.0], 10.0);
    all.extend(of_a_box(9.0, [-5.0, -4.0], 13.0));
    all.extend(of_a_box(9.0, [5.0, 6.0], 13.0));
    let file = folder.join("tooth.stl");
    std::fs::write(&file, text(" tooth", &all)).unwrap();
    let scene = format!(
        "[core]\nshape = 'mesh'\nfile = {file:?}\n[wire]\ndiameter_mm = {wire_mm}\n[start]\nclamp_y_mm = -3.75\n\
         [nozzle]\ny_start_mm = -3.75\n[traverse]\nmode = 'orthocyclic'\n[winding]\nlayers = 2\n{more}"
    );
    let settings = parse(&scene).expect("parses");
    settings.build().map_err(|error| error.to_string())
}

/// Flanges of a file were no flanges: nothing said how many turns fit, and nozzle and clamp could lie in them.
#[test]
fn flanges_of_a_file_bound_the_winding_as_those_of_a_scene_do() {
    let folder = tempfile::tempdir().unwrap();
    let wind = |wire_mm: f64, more: &str| between_flanges(folder.path(), wire_mm, more);
    let full = wind(0.5, "").expect("it can be wound");
    // 18 turns fill 9 mm; between them lie 17
    assert_eq!(full.spindle.turns, 35.0);
    let window = full.window.expect("between flanges");
    let [low, high] = window.faces.expect("both");
    assert!(
        (low + 4e-3).abs() < 1e-8 && (high - 5e-3).abs() < 1e-8,
        "{window:?}"
    );
    assert!((window.height - 3e-3).abs() < 1e-5, "{window:?}");

    let many = wind(0.5, "turns_per_layer = 19\n").expect_err("too many");
    assert_says(
        &many,
        &[
            "winding.turns_per_layer = 19",
            "0.009 m between the flanges",
            "at most 18",
            "core.file",
        ],
    );
    let fewer = wind(0.5, "turns_per_layer = 10\npitch_mm = 0.5\n");
    fewer.expect("there is room");
    let past = wind(
        0.5,
        "turns_per_layer = 10\npitch_mm = 0.5\ndirection = '-y'\n",
    )
    .expect_err("past a face");
    assert_says(&past, &["nozzle.y_start", "past a flange"]);
}

/// A scene that named a mesh and not its shape was told of turns only.
#[test]
fn a_file_without_the_shape_of_a_mesh_is_told_with_what_follows_from_it() {
    let refused = |text: &str| {
        let scene = format!("[core]\n{text}\n[traverse]\nmode = 'orthocyclic'\n");
        let error = parse(&scene).expect("parses").build();
        error.expect_err("refused").to_string()
    };
    let said = refused("file = 'tooth.stl'");
    assert_says(
        &said,
        &[
            "test.toml:2: core.file = ",
            "core.shape = rounded-box does not use it; allowed: core.shape = mesh, or no file",
            "winding.turns_per_layer",
        ],
    );
    assert!(!refused("").contains("core.file"));
}

/// Of a bobbin that stands along another axis it was told only that it has no flanges.
#[test]
fn a_bobbin_about_another_axis_is_told_with_that_axis() {
    let folder = tempfile::tempdir().unwrap();
    let mut bobbin = of_a_box(4.0, [-6.0, 6.0], 5.0);
    for y in [[-8.0, -6.0], [6.0, 8.0]] {
        bobbin.extend(of_a_box(8.0, y, 9.0));
    }
    // (flanges that touch the core are united with it by reaching into it)
    for corner in bobbin[..12].iter_mut().flatten() {
        corner[1] *= 7.0 / 6.0;
    }
    let said = |axis: usize| {
        let turned = |[x, y, z]: [f32; 3]| {
            let mut place = [0.0; 3];
            place[axis] = y;
            place[(axis + 1) % 3] = z;
            place[(axis + 2) % 3] = x;
            place
        };
        let turned: Vec<_> = bobbin.iter().map(|t| t.map(turned)).collect();
        let path = folder.path().join("bobbin.stl");
        std::fs::write(&path, text(" bobbin", &turned)).unwrap();
        let scene = format!(
            "[core]\nshape = 'mesh'\nfile = {path:?}\n[wire]\ndiameter_mm = 0.5\n[nozzle]\ndistance_mm = 30\n\
             y_start_mm = -5.75\n[start]\nclamp_y_mm = -5.75\n[traverse]\nmode = 'orthocyclic'\n"
        );
        let built = parse(&scene).expect("parses").build();
        built.err().map(|error| error.to_string())
    };
    assert_eq!(said(1), None);
    for (axis, name) in [(0, 'x'), (2, 'z')] {
        assert_says(
            &said(axis).expect("refused"),
            &[
                "winding.turns_per_layer = 0 is impossible here",
                &format!("no flanges about y, only about {name}, that"),
                &format!("core.file with the mesh turned so that its {name} is y"),
            ],
        );
    }
}
