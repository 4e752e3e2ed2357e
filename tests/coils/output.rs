//! Files of a made coil, read back.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use coilwind::math::V3;
use coilwind::measure::{Coil, CoilSpec, SettledNode};
use coilwind::output::{
    Colouring, CoreMesh, OutputError, Picture, WireFields, render, render_png, write_core_vtp,
    write_stations, write_summary, write_turns, write_vtp,
};
use coilwind::settings::SceneSettings;
use coilwind::simulation::Centreline;
use quick_xml::Reader;
use quick_xml::events::Event;
use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::path::{Path, PathBuf};

const D: f64 = 0.7e-3;

/// Point and outward normal at length `s` round a 12 x 30 mm rectangle with 2 mm corners.
fn outline(s: f64) -> (V3, V3) {
    let (a, b, r) = (4e-3, 13e-3, 2e-3);
    let corner = FRAC_PI_2 * r;
    let lengths = [
        b,
        corner,
        2.0 * a,
        corner,
        2.0 * b,
        corner,
        2.0 * a,
        corner,
        b,
    ];
    let mut s = s.rem_euclid(lengths.iter().sum());
    let mut piece = 0;
    while s > lengths[piece] {
        s -= lengths[piece];
        piece += 1;
    }
    let at = |x: f64, z: f64| V3::new(x, 0.0, z);
    let arc = |x, z, from: f64| {
        let n = at(libm::cos(from + s / r), libm::sin(from + s / r));
        (at(x, z) + n * r, n)
    };
    match piece {
        0 => (at(a + r, s), at(1.0, 0.0)),
        1 => arc(a, b, 0.0),
        2 => (at(a - s, b + r), at(0.0, 1.0)),
        3 => arc(-a, b, FRAC_PI_2),
        4 => (at(-a - r, b - s), at(-1.0, 0.0)),
        5 => arc(-a, -b, PI),
        6 => (at(-a + s, -b - r), at(0.0, -1.0)),
        7 => arc(a, -b, 1.5 * PI),
        _ => (at(a + r, s - b), at(1.0, 0.0)),
    }
}

const AROUND: f64 = 4.0 * (4e-3 + 13e-3) + TAU * 2e-3;

fn core_mesh() -> (Vec<V3>, Vec<[u32; 3]>) {
    let n = 240;
    let mut vertices: Vec<V3> = [-15e-3, 15e-3]
        .into_iter()
        .flat_map(|y| {
            (0..n).map(move |k| outline(AROUND * f64::from(k) / f64::from(n)).0 + V3::y() * y)
        })
        .collect();
    vertices.extend([V3::y() * -15e-3, V3::y() * 15e-3]);
    let n = n as u32;
    let mut triangles = Vec::new();
    for k in 0..n {
        let next = (k + 1) % n;
        triangles.push([k, n + k, next]);
        triangles.push([next, n + k, n + next]);
        triangles.push([2 * n, k, next]);
        triangles.push([2 * n + 1, n + next, n + k]);
    }
    (vertices, triangles)
}

/// `turns` turns at a pitch of 1.02 d with a gap in the second, then a free span; the last half
/// turn on the core is live.
fn wire(turns: f64) -> Centreline {
    let step = 0.4e-3;
    let laid = (turns * AROUND / step) as usize;
    let mut points: Vec<V3> = (0..laid)
        .map(|node| {
            let s = node as f64 * step;
            let turn = s / AROUND;
            let (p, n) = outline(s);
            let aside = if (1.3..1.6).contains(&turn) {
                0.5 * D * libm::sin((turn - 1.3) / 0.3 * PI).powi(2)
            } else {
                0.0
            };
            // Stands off the long faces as stiff wire does.
            let off = 0.5e-3 * (1.0 - (p.z / 13e-3).powi(2)).max(0.0);
            p + n * (0.5 * D + off) + V3::y() * (1.02 * D * turn + aside)
        })
        .collect();
    let (last, before) = (points[laid - 1], points[laid - 2]);
    let along = (last - before).normalize();
    points.extend((1..20).map(|k| last + along * (3e-3 * f64::from(k))));
    let count = points.len();
    Centreline {
        frames: vec![nalgebra::Quaternion::identity(); count],
        arc: (0..count).map(|node| node as f64 * step).collect(),
        plastic_stretch: vec![0.0; count],
        plastic_strain: (0..count).map(|node| 1e-5 * node as f64).collect(),
        tension: vec![15.0; count],
        frozen: laid - (0.5 * AROUND / step) as usize,
        points,
    }
}

fn coil(wire: &Centreline) -> Coil {
    let mut coil = Coil::new(CoilSpec {
        diameter: D,
        limits: SceneSettings::default().defects,
        profile: None,
        tension: 15.0,
        jumps: [].into(),
        full: None,
        planned: None,
        layer_starts: [].into(),
        crossover: None,
        start_angle: 0.0,
        direction: 1.0,
        traverse: 1.0,
        clamp_arc: 0.0,
        corner_angle: libm::atan2(15.0, 6.0),
    });
    for node in 0..wire.frozen {
        coil.settle(SettledNode {
            flange: None,
            position: wire.points[node],
            arc: wire.arc[node],
            height: 0.0,
            plastic_strain: wire.plastic_stretch[node],
            tension: wire.tension[node],
            time: 0.0,
        });
    }
    coil
}

/// Pictures go where they can be looked at.
fn kept(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)
}

/// The numbers of an array in base64, after their length in bytes.
fn numbers(text: &str, kind: &str) -> Vec<f64> {
    let bytes = STANDARD.decode(text).unwrap();
    let (length, bytes) = bytes.split_at(8);
    assert_eq!(
        u64::from_le_bytes(length.try_into().unwrap()),
        bytes.len() as u64
    );
    let each = |size: usize, number: fn(&[u8]) -> f64| bytes.chunks(size).map(number).collect();
    match kind {
        "Float64" => each(8, |c| f64::from_le_bytes(c.try_into().unwrap())),
        "Float32" => each(4, |c| f32::from_le_bytes(c.try_into().unwrap()).into()),
        "Int32" => each(4, |c| i32::from_le_bytes(c.try_into().unwrap()).into()),
        "UInt8" => each(1, |c| c[0].into()),
        other => panic!("numbers of type {other}"),
    }
}

/// Numbers of each array of a VTK file by name, and the attributes of its piece.
fn read_vtp(path: &Path) -> (BTreeMap<String, Vec<f64>>, BTreeMap<String, String>) {
    let mut reader = Reader::from_file(path).unwrap();
    let (mut arrays, mut piece, mut buffer) = (BTreeMap::new(), BTreeMap::new(), Vec::new());
    let mut array = None;
    loop {
        match reader.read_event_into(&mut buffer).unwrap() {
            Event::Start(element) => {
                let attributes: BTreeMap<String, String> = element
                    .attributes()
                    .map(|a| a.unwrap())
                    .map(|a| (a.key.as_ref().to_owned(), a.value.into_owned()))
                    .collect();
                match element.name().as_ref() {
                    "DataArray" => {
                        assert_eq!(attributes["format"], "binary");
                        array = Some((attributes["Name"].clone(), attributes["type"].clone()));
                    }
                    "VTKFile" => assert_eq!(attributes["header_type"], "UInt64"),
                    "Piece" => piece = attributes,
                    _ => {}
                }
            }
            Event::Text(text) => {
                if let Some((name, kind)) = array.take() {
                    arrays.insert(name, numbers(text.trim(), &kind));
                }
            }
            Event::Eof => return (arrays, piece),
            _ => {}
        }
        buffer.clear();
    }
}

#[test]
fn wire_written_for_paraview_reads_back() {
    let wire = wire(2.3);
    let nodes = wire.points.len();
    let heights: Vec<f64> = (0..nodes).map(|k| 1e-6 * k as f64).collect();
    let fields = WireFields {
        height: heights.clone(),
        layer: (0..nodes).map(|k| (k % 3) as u8).collect(),
        gap: (0..nodes)
            .map(|k| if k < 9 { f64::NAN } else { 1e-7 * k as f64 })
            .collect(),
        bulge: vec![2e-5; nodes],
        defect: (0..nodes).map(|k| if k == 20 { 2 } else { 0 }).collect(),
    };
    let path = kept("coil.vtp");
    write_vtp(&path, &wire, D / 2.0, Some(&fields), 0.25).unwrap();
    let (arrays, piece) = read_vtp(&path);

    let points = arrays["Points"].len() / 3;
    assert_eq!(piece["NumberOfPoints"], points.to_string());
    let sides = points / nodes;
    assert!(sides >= 12 && sides * nodes == points);
    for (k, xyz) in arrays["Points"].chunks(3).enumerate() {
        let r = (V3::new(xyz[0], xyz[1], xyz[2]) - wire.points[k / sides]).norm();
        assert!((r - D / 2.0).abs() < 1e-15);
    }
    let per_node = |name: &str| -> Vec<f64> {
        assert_eq!(arrays[name].len(), points, "{name}");
        arrays[name].iter().copied().step_by(sides).collect()
    };
    assert_eq!(per_node("tension"), wire.tension);
    assert_eq!(
        per_node("plastic_strain"),
        wire.plastic_strain,
        "to the bit"
    );
    assert_eq!(per_node("height"), heights);
    assert_eq!(per_node("layer")[..4], [0.0, 1.0, 2.0, 0.0]);
    let gaps = per_node("gap");
    assert!(gaps[8].is_nan() && gaps[9..] == fields.gap[9..]);
    assert_eq!(per_node("bulge"), fields.bulge);
    assert_eq!(
        per_node("defect").iter().position(|&bits| bits == 2.0),
        Some(20)
    );
    assert_eq!(arrays["TimeValue"], [0.25]);
    assert_eq!(per_node("arc"), wire.arc);
    assert_eq!(
        per_node("frozen").iter().filter(|&&f| f == 1.0).count(),
        wire.frozen
    );
    let turns = per_node("turn");
    assert_eq!((turns[0], turns[nodes - 30]), (1.0, 3.0));
    assert!(turns.windows(2).all(|pair| pair[0] <= pair[1]));

    let offsets = &arrays["offsets"];
    assert_eq!(piece["NumberOfPolys"], offsets.len().to_string());
    assert_eq!(
        *offsets.last().unwrap() as usize,
        arrays["connectivity"].len()
    );
    assert!(
        arrays["connectivity"]
            .iter()
            .all(|&i| (i as usize) < points)
    );
}

#[test]
fn core_written_for_paraview_reads_back() {
    let (vertices, triangles) = core_mesh();
    let path = kept("core.vtp");
    write_core_vtp(&path, &vertices, &triangles).unwrap();
    let (arrays, _) = read_vtp(&path);
    let flat: Vec<f64> = vertices.iter().flat_map(|v| [v.x, v.y, v.z]).collect();
    assert_eq!(arrays["Points"], flat);
    let indices: Vec<f64> = triangles.iter().flatten().map(|&i| f64::from(i)).collect();
    assert_eq!(arrays["connectivity"], indices);
}

#[test]
fn arrays_that_do_not_match_are_refused() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("coil.vtp");
    let mut short = wire(1.0);
    short.tension.pop();
    let error = write_vtp(&path, &short, D / 2.0, None, 0.0).unwrap_err();
    assert!(
        matches!(
            error,
            OutputError::Length {
                name: "tension",
                ..
            }
        ),
        "{error}"
    );
    assert!(!path.exists());
    let error = write_core_vtp(&path, &[V3::zeros()], &[[0, 0, 0], [0, 1, 0]]).unwrap_err();
    assert!(
        matches!(
            error,
            OutputError::Mesh {
                triangle: 1,
                vertices: 1,
                ..
            }
        ),
        "{error}"
    );
}

#[test]
fn wire_that_has_not_begun_makes_valid_files() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("coil.vtp");
    let one = Centreline {
        points: vec![V3::x()],
        arc: vec![0.0],
        plastic_strain: vec![0.0],
        tension: vec![0.0],
        ..Centreline::default()
    };
    for wire in [&Centreline::default(), &one] {
        write_vtp(&path, wire, D / 2.0, None, 0.0).unwrap();
        let (arrays, piece) = read_vtp(&path);
        assert_eq!(piece["NumberOfPoints"], "0");
        let of_points = arrays.iter().filter(|(name, _)| *name != "TimeValue");
        assert!(of_points.into_iter().all(|(_, values)| values.is_empty()));
        let picture = Picture {
            size: (40, 30),
            ..Picture::new(None, wire, D / 2.0)
        };
        render(&picture);
    }
}

/// Width and height of a PNG, and its pixels.
fn pixels_of(path: &Path) -> ((u32, u32), Vec<[u8; 3]>) {
    let file = std::io::BufReader::new(std::fs::File::open(path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    assert_eq!(
        reader.output_color_type(),
        (png::ColorType::Rgb, png::BitDepth::Eight)
    );
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut bytes).unwrap();
    (reader.info().size(), bytes.as_chunks().0.to_vec())
}

#[test]
fn picture_shows_core_wire_and_background() {
    let (vertices, triangles) = core_mesh();
    let core = Some(CoreMesh {
        vertices: &vertices,
        triangles: &triangles,
    });
    let wire = wire(2.4);
    let path = kept("coil.png");
    render_png(&path, &Picture::new(core, &wire, D / 2.0)).unwrap();
    let picture = Picture::new(core, &wire, D / 2.0);
    assert_eq!(pixels_of(&path), ((1200, 900), render(&picture)));
    let picture = render(&picture);
    // Copper is clearly red, live wire clearly blue, the core neither.
    let share = |test: &dyn Fn([i32; 3]) -> bool| {
        let hits = picture.iter().filter(|p| test(p.map(i32::from))).count();
        hits as f64 / (1200.0 * 900.0)
    };
    assert!(share(&|[r, _, b]| r > b + 50) > 0.03, "copper");
    assert!(share(&|[r, _, b]| b > r + 50) > 0.005, "live wire");
    let corner = picture[3 * 1200 + 3];
    assert!(corner.iter().all(|&c| c > 150), "background {corner:?}");

    let by_turn = Picture {
        colouring: Colouring::Turn,
        size: (600, 450),
        ..Picture::new(core, &wire, D / 2.0)
    };
    render_png(&kept("coil_by_turn.png"), &by_turn).unwrap();
    assert_eq!(
        render(&by_turn),
        render(&by_turn),
        "same input, same picture"
    );
}

#[test]
fn a_picture_without_wire_or_without_core_is_drawn() {
    let (vertices, triangles) = core_mesh();
    let core = Some(CoreMesh {
        vertices: &vertices,
        triangles: &triangles,
    });
    let size = (60, 45);
    let nothing = Centreline::default();
    let background = render(&Picture {
        size,
        ..Picture::new(None, &nothing, D / 2.0)
    });
    let only_core = render(&Picture {
        size,
        ..Picture::new(core, &nothing, D / 2.0)
    });
    let wire = wire(1.2);
    let only_wire = render(&Picture {
        size,
        ..Picture::new(None, &wire, D / 2.0)
    });
    assert_ne!(background, only_core);
    assert_ne!(background, only_wire);
}

#[test]
fn tables_have_a_row_per_turn_and_station() {
    let directory = tempfile::tempdir().unwrap();
    let coil = coil(&wire(2.8));
    let turns_file = directory.path().join("turns.csv");
    write_turns(&turns_file, &coil.turns()).unwrap();
    let mut reader = csv::Reader::from_path(&turns_file).unwrap();
    let header = reader.headers().unwrap().clone();
    let column = |name: &str| header.iter().position(|h| h == name).unwrap();
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    assert_eq!(rows.len(), coil.turns().len());
    assert_eq!(&rows[0][column("gap_mean")], "", "turn 1 has no neighbour");
    let gap: f64 = rows[1][column("gap_mean")].parse().unwrap();
    assert_eq!(Some(gap), coil.turns()[1].gap_mean);
    assert_eq!(
        &rows[1][column("verdict")],
        coil.turns()[1].verdict.as_str()
    );

    let stations_file = kept("stations.csv");
    write_stations(&stations_file, coil.stations()).unwrap();
    let mut reader = csv::Reader::from_path(&stations_file).unwrap();
    let header = reader.headers().unwrap().clone();
    let column = |name: &str| header.iter().position(|h| h == name).unwrap();
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    assert_eq!(rows.len(), coil.stations().len());
    let station = coil.stations().nth(400).unwrap();
    assert_eq!(
        (&rows[400][column("turn")], &rows[400][column("station")]),
        ("2", "40")
    );
    assert_eq!(
        rows[400][column("y")].parse::<f64>().unwrap(),
        station.position.y
    );
}

#[test]
fn tables_without_rows_still_have_their_header() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("t.csv");
    write_turns(&path, &[]).unwrap();
    assert!(
        std::fs::read_to_string(&path)
            .unwrap()
            .starts_with("turn,layer,turn_in_layer,verdict,")
    );
    write_stations(&path, [].iter()).unwrap();
    assert!(
        std::fs::read_to_string(&path)
            .unwrap()
            .starts_with("turn,station,angle,")
    );
}

#[test]
fn summary_is_replaced_whole_or_not_at_all() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("summary.json");
    write_summary(&path, &BTreeMap::from([("turns", 2.5)])).unwrap();
    // A map whose keys are no strings cannot become JSON.
    let unwritable = BTreeMap::from([((1, 2), 3)]);
    let error = write_summary(&path, &unwritable).unwrap_err();
    assert!(matches!(error, OutputError::Json { .. }), "{error}");
    assert_eq!(
        std::fs::read_to_string(&path).unwrap(),
        "{\n  \"turns\": 2.5\n}\n"
    );
    let left: Vec<_> = std::fs::read_dir(directory.path()).unwrap().collect();
    assert_eq!(left.len(), 1, "no partial file is left");

    let turns = coil(&wire(2.8)).turns();
    write_summary(&path, &turns).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    let value: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(value[1]["verdict"], turns[1].verdict.as_str());
    assert!(value[0]["gap_mean"].is_null());
    let error = write_summary(&directory.path().join("no/such/summary.json"), &1).unwrap_err();
    assert!(error.to_string().contains("summary.json"), "{error}");
}

/// Gaps of half a diameter in the second turn are marked on the wire from where they begin to where they end.
#[test]
fn a_defect_is_marked_over_its_whole_run() {
    let coil = coil(&wire(2.8));
    let marks = coil.defect_marks();
    assert_eq!(marks.len(), coil.stations().len());
    let marked: Vec<usize> = (0..marks.len()).filter(|&k| marks[k] & 2 != 0).collect();
    let gap = |k: usize| {
        coil.stations()
            .nth(k)
            .unwrap()
            .neighbour
            .map_or(0.0, |n| n.gap)
    };
    assert!(marked.len() >= 36, "{} stations", marked.len());
    assert!(marked.iter().all(|&k| gap(k) > 0.8 * 0.15 * D));
    let defects = coil.defects();
    assert!(!defects.is_empty());
    for defect in defects {
        let station = (defect.turn as usize - 1) * 360 + defect.angle_deg.round() as usize;
        assert!(marks[station] != 0, "{defect:?} is not marked");
    }
}
