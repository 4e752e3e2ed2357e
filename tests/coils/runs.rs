//! Whole runs through the front door.

use crate::common::fig8;
use coilwind::math::V3;
use coilwind::measure::Verdict;
use coilwind::scene::Scene;
use coilwind::settings::SceneSettings;
use coilwind::signals::{EventKind, Inputs};
use coilwind::simulation::{Centreline, Simulation, core_surface};
use std::f64::consts::TAU;

/// Runs the scene's motion profile for this many turns of the spindle.
fn wind(scene: &Scene, turns: f64) -> Simulation {
    let mut sim = Simulation::new(scene).expect("the scene starts");
    let mut time = 0.0;
    let pieces = (turns * 72.0).ceil() as usize;
    for k in 1..=pieces {
        let next = sim
            .motion_profile()
            .time_at(turns * TAU * k as f64 / pieces as f64);
        sim.advance_profile(next - time).expect("the run goes on");
        time = next;
    }
    sim
}

#[test]
fn starts_as_the_reference_scene_says() {
    let sim = Simulation::new(&fig8(&[])).expect("starts");
    let sys = sim.system();
    assert!(
        (sys.state.spindle.angle - 1.464764).abs() < 1e-6,
        "core angle at the start"
    );
    assert_eq!(
        sim.outputs().spindle_angle,
        0.0,
        "the spindle counts from here"
    );
    let rod = &sys.state.rod;
    let (first, last) = (rod.x[0], rod.x[rod.nodes() - 1]);
    // mid-face, so that the wire leaves on the -z side; nozzle on +x
    assert!((first.norm() - 6.35e-3).abs() < 1e-12 && first.z < 0.0 && first.y == 0.0);
    assert!((last - V3::new(0.06, 0.0, 0.0)).norm() < 1e-15);
    let t = (last - first).normalize();
    for j in 0..rod.edges() {
        assert!((rod.tangent(j) - t).norm() < 1e-9, "straight");
        assert!(
            (sys.state.load.tension[j] - 15.0).abs() < 1e-6,
            "at the set tension"
        );
        assert_eq!(rod.stretch[j].strain, 0.0, "unyielded");
    }
    assert!(t.dot(&first).abs() < 1e-12, "tangent to the face");
    assert!(
        sys.state.load.force[1..rod.nodes() - 1]
            .iter()
            .all(|f| f.norm() < 1e-6),
        "in equilibrium"
    );
}

#[test]
fn direction_of_winding_and_signs() {
    let sim = wind(&fig8(&[("spindle.speed", "500")]), 0.35);
    let o = sim.outputs();
    let line = sim.centreline();
    // from the clamp the wire runs towards +z in the core frame, on the +x face
    let p = line.points[8];
    assert!(p.z > 3e-3 && (p.x - 6.35e-3).abs() < 2e-3, "{p:?}");
    assert!(o.turns_wound > 0.15 && o.layon_angle > 0.0);
    assert!(
        o.spindle_torque < -0.05,
        "resists positive speed: {}",
        o.spindle_torque
    );
    assert!(o.feed_speed > 0.0 && o.fed_length > 0.01);
    // the nozzle traverses towards +y and the wire follows, behind it
    let nozzle = sim.inputs().nozzle_position;
    assert!((nozzle - 0.35 * 0.7e-3).abs() < 1e-9);
    assert!(o.layon_position > 1e-6 && o.layon_position < nozzle);
}

/// Place of the wire `s` along it, a straight line between nodes.
fn at(line: &Centreline, s: f64) -> V3 {
    let k = line
        .arc
        .partition_point(|a| *a <= s)
        .clamp(1, line.arc.len() - 1);
    let share = (s - line.arc[k - 1]) / (line.arc[k] - line.arc[k - 1]);
    line.points[k - 1] + (line.points[k] - line.points[k - 1]) * share
}

/// Root mean square and largest distance between the laid wire of two runs, m.
fn distance_between(a: &Simulation, b: &Simulation) -> (f64, f64) {
    let (p, q) = (a.centreline(), b.centreline());
    let free = a.outputs().free_length.max(b.outputs().free_length);
    let end = p.arc[p.arc.len() - 1] - free - 1e-3;
    // settled wire may have lost nodes, and not the same ones
    let d: Vec<f64> = (0..(end / 4e-4) as usize)
        .map(|k| (at(&p, 4e-4 * k as f64) - at(&q, 4e-4 * k as f64)).norm())
        .collect();
    let rms = (d.iter().map(|x| x * x).sum::<f64>() / d.len() as f64).sqrt();
    (rms, d.into_iter().fold(0.0, f64::max))
}

/// The paper's central saving: wire at rest leaves the computation, and live wire must not notice.
///
/// What is left of a difference is wire that would have gone on creeping, by less than the policy's limit: 2 um/rad
/// over the 0.9 turns, 11 um. This is a mean of three, since single pairs of runs scatter. With nozzle
/// distances 0.1 um apart they differ by 7.9 to 10.3 um rms, at most by 17 to 23 um where a bow moves as a whole. Two runs without
/// freezing differ by 1.6 um rms.
#[test]
fn live_wire_does_not_notice_a_correct_exclusion() {
    // the production method's is in freezing.rs
    let pair = |distance: &str| {
        let all = |freeze: &'static str| {
            let scene = fig8(&[
                ("spindle.speed", "300"),
                ("solver.integrator", "verlet"),
                ("nozzle.distance", distance),
                ("freeze.enabled", freeze),
            ]);
            wind(&scene, 0.9)
        };
        let (with, without) = (all("true"), all("false"));
        let frozen = |sim: &Simulation| sim.system().state.frozen.len();
        assert!(frozen(&with) > 40, "wire did freeze");
        assert_eq!(frozen(&without), 0);
        let (t, u) = (with.outputs(), without.outputs());
        assert!(
            (t.fed_length - u.fed_length).abs() < 20e-6,
            "{} {}",
            t.fed_length,
            u.fed_length
        );
        let (p, q) = (with.energy().plastic_J, without.energy().plastic_J);
        assert!((p - q).abs() < 0.01 * q, "plastic work {p} {q}");
        distance_between(&with, &without)
    };
    let distances = ["0.06", "0.0600001", "0.0599999"];
    let all = distances.map(pair);
    let mean = |of: fn(&(f64, f64)) -> f64| all.iter().map(of).sum::<f64>() / all.len() as f64;
    let (rms, worst) = (mean(|d| d.0), mean(|d| d.1));
    let creep = 2e-6 * 0.9 * TAU;
    assert!(
        rms < creep && worst < 2.0 * creep,
        "{rms:.2e} m rms, {worst:.2e} m at most, of {all:?}"
    );
}

/// Without freezing the second turn lands on live wire and is held off by it just the same.
#[test]
fn live_wire_holds_live_wire_off() {
    let sim = wind(
        &fig8(&[
            ("spindle.speed", "500"),
            ("freeze.enabled", "false"),
            ("solver.spacing_near", "0.001"),
        ]),
        1.6,
    );
    assert!(sim.system().state.frozen.is_empty());
    let turns = sim.coil_with_live_wire().turns();
    let gap = turns[1].gap_mean.expect("the second turn has a neighbour");
    assert!(
        gap > -5e-6 && gap < 3e-4,
        "centre distance less the diameter: {gap:.2e} m"
    );
    assert!(sim.summary().penetration.largest_over_d < 0.05);
    // "wind more turns" was the advice
    let told = sim.summary().reasons.remove(0);
    assert!(told.contains("freeze.enabled = false"), "{told}");
    assert!(
        sim.energy().residual_over_dissipated.abs() < 0.01,
        "{:?}",
        sim.energy()
    );
}

#[test]
fn two_turns_balance_their_energy_and_stay_out_of_the_core() {
    for (method, speed, residual) in [("verlet", "500", 0.01), ("implicit", "30", 0.005)] {
        let scene = fig8(&[("spindle.speed", speed), ("solver.integrator", method)]);
        let sim = wind(&scene, 2.0);
        let e = sim.energy();
        let dissipated = e.plastic_J + e.friction_J + e.damping_J;
        assert!(dissipated > 0.1, "two turns bend the wire plastically");
        assert!(
            e.residual_over_dissipated.abs() < residual,
            "{method} {e:?}"
        );
        assert!(e.numerical_over_dissipated.abs() < 0.01, "{method} {e:?}");
        // splits and freezes have a line of their own; Verlet's steps lose nothing
        assert_eq!(e.numerical_J == 0.0, method == "verlet", "{e:?}");
        assert!(e.remeshing_J != 0.0 && e.remeshing_J.abs() < 0.01 * dissipated);
        let p = sim.summary().penetration;
        // 1 % at 15 N, and the wire pulls up to 16.5 N
        assert!(
            p.largest_over_d < 0.05 && p.at_rest_over_d < 0.011,
            "{method} {p:?}"
        );
        assert!(p.largest_m > 0.0);
    }
}

/// Edges of 1 mm were halved down to 0.25 mm where 0.3 mm was asked for, and the step was the longest stable one of 0.3 mm: the
/// wire broke by energy from nowhere.
#[test]
fn explicit_steps_go_with_the_shortest_edge_and_not_with_the_spacing() {
    for method in ["rk4", "verlet"] {
        let scene = fig8(&[
            ("solver.integrator", method),
            ("solver.spacing_near", "3e-4"),
            ("solver.spacing_free", "1e-3"),
            ("spindle.speed", "500"),
            ("spindle.ramp_turns", "0.02"),
        ]);
        let sim = wind(&scene, 0.4);
        let rest = &sim.system().state.rod.rest;
        assert!(
            rest.iter().any(|rest| *rest < 2.6e-4),
            "no edge is that short"
        );
        assert!(!sim.outputs().defect_break, "{method}: {:?}", sim.energy());
        assert!(
            sim.energy().residual_over_dissipated.abs() < 0.01,
            "{method}: {:?}",
            sim.energy()
        );
    }
}

#[test]
fn a_loose_tolerance_does_not_show_in_the_books_of_slow_winding() {
    let scene = fig8(&[("spindle.speed", "100"), ("solver.tolerance", "1e-5")]);
    let e = wind(&scene, 2.0).energy();
    assert!(e.residual_over_dissipated.abs() < 0.005, "{e:?}");
    assert!(e.numerical_over_dissipated.abs() < 0.01, "{e:?}");
}

/// Wire that lies on a round core has its place: a chord would be pressed into the core and pushed out again.
#[test]
fn coarser_wire_keeps_tension_and_energy() {
    let wound = |shape: &[(&str, &str)], coarse: &str| {
        let common = [
            ("wire.material", "copper"),
            ("spindle.speed", "30"),
            ("solver.coarse_settled", coarse),
        ];
        wind(&fig8(&[&common, shape].concat()), 2.0)
    };
    let round = [
        ("core.shape", "cylinder"),
        ("core.radius_mm", "30"),
        ("nozzle.distance_mm", "150"),
        ("traverse.per_turn_mm", "1.12"),
    ];
    let [with, without] = ["on", "off"].map(|coarse| wound(&round, coarse));
    let laid = |sim: &Simulation| {
        let line = sim.centreline();
        line.tension[..line.frozen].iter().sum::<f64>() / line.frozen as f64
    };
    let (a, b) = (laid(&with), laid(&without));
    assert!((a / b - 1.0).abs() < 0.01, "{a} N, {b} N without");
    let e = with.energy();
    assert!(e.residual_over_dissipated.abs() < 0.01, "{e:?}");
    assert!(e.numerical_over_dissipated.abs() < 0.01, "{e:?}");
    // bows between corners touch nothing and are coarser as before
    let [with, without] = ["on", "off"].map(|coarse| wound(&[], coarse).work());
    assert!(
        (with as f64) < 0.95 * without as f64,
        "{with} nodes stepped, {without} without"
    );
}

#[test]
fn runge_kutta_and_verlet_agree() {
    let a = wind(
        &fig8(&[("spindle.speed", "500"), ("solver.integrator", "verlet")]),
        0.4,
    );
    let b = wind(
        &fig8(&[("spindle.speed", "500"), ("solver.integrator", "rk4")]),
        0.4,
    );
    assert!((a.outputs().fed_length - b.outputs().fed_length).abs() < 2e-6);
    assert!((a.energy().plastic_J / b.energy().plastic_J - 1.0).abs() < 0.01);
    let (p, q) = (a.centreline(), b.centreline());
    for i in 0..40 {
        assert!((p.points[i] - q.points[i]).norm() < 10e-6, "node {i}");
    }
}

#[test]
fn same_input_same_output() {
    let scene = fig8(&[("spindle.speed", "500")]);
    let run = || {
        let mut sim = Simulation::new(&scene).expect("starts");
        for k in 0..200 {
            let inputs = Inputs {
                spindle_speed: 2.0 * f64::from(k),
                nozzle_position: 1e-7 * f64::from(k),
                tension_setpoint: 15.0,
                ..Inputs::HELD
            };
            sim.advance(inputs, 1e-5).expect("goes on");
        }
        sim
    };
    let (a, b) = (run(), run());
    assert_eq!(a.outputs(), b.outputs());
    assert_eq!(a.centreline().points, b.centreline().points);
    // in another thread too
    let c = std::thread::scope(|s| s.spawn(run).join()).expect("no panic");
    assert_eq!(a.outputs(), c.outputs());
}

/// A long coil was to be wound a second time for a gap of its turn 2.
#[test]
fn a_doubt_of_an_early_gap_asks_for_few_turns() {
    let words = |turns: f64| {
        let sim = wind(&fig8(&[]), turns);
        let reasons = sim.reasons();
        let doubt = reasons.iter().find(|text| text.contains("the tolerance"));
        doubt.expect("a gap near its limit").clone()
    };
    assert!(words(5.0).ends_with("; 3.5 turns are enough for that"));
    assert!(!words(2.5).contains("enough"));
}

/// Steps damp the shaking that lays wire beside its neighbour: the default tells gaps that finer steps do not.
#[test]
fn a_gap_near_its_limit_is_told_to_be_in_doubt() {
    let doubts = |more: &[(&str, &str)]| {
        let sim = wind(&fig8(more), 2.5);
        let doubts = |reason: &String| reason.contains("may come of the tolerance");
        (sim.verdict(), sim.reasons().iter().any(doubts))
    };
    assert_eq!(doubts(&[]), (Verdict::Gap, true));
    let wide = doubts(&[("defects.gap", "0.05"), ("traverse.per_turn_mm", "0.9")]);
    assert_eq!(wide, (Verdict::Gap, false));
    let none = doubts(&[("defects.gap", "0.5")]);
    assert_eq!(none, (Verdict::Marginal, false));
    // turns that land on the one before, on a round core too
    let round = [
        ("core.shape", "cylinder"),
        ("core.radius_mm", "8"),
        ("defects.gap", "0.05"),
    ];
    let half = [
        &round[..],
        &[("traverse.per_turn_mm", "0.35"), ("spindle.speed", "200")],
    ]
    .concat();
    assert_eq!(doubts(&half), (Verdict::Gap, true));
    let whole = [
        &round[..],
        &[("traverse.per_turn_mm", "0.9"), ("spindle.speed", "200")],
    ]
    .concat();
    assert_eq!(doubts(&whole), (Verdict::Gap, false));
}

/// 15 of 16 runs of a scene were marginal without a word, and 15 of 16 had a gap at a finer tolerance.
#[test]
fn a_gap_just_below_its_limit_is_told_to_be_in_doubt() {
    let wound = |limit: f64| {
        let limit = format!("{limit}");
        let sim = wind(&fig8(&[("defects.gap", &limit)]), 2.5);
        let doubts = |reason: &String| reason.contains("may pass at a finer tolerance");
        let d = sim.scene().wire.diameter;
        let lasting = sim.coil().lasting_gap(2).expect("turn 2 is there") / d;
        (lasting, sim.verdict(), sim.reasons().iter().any(doubts))
    };
    let (lasting, ..) = wound(0.5);
    let (_, verdict, doubts) = wound(lasting + 0.01);
    assert_eq!((verdict, doubts), (Verdict::Marginal, true), "{lasting}");
    let (_, verdict, doubts) = wound(lasting + 0.05);
    assert_eq!((verdict, doubts), (Verdict::Marginal, false), "{lasting}");
}

#[test]
fn sudden_stop_goes_slack_and_nothing_is_pushed_out() {
    let mut sim = Simulation::new(&fig8(&[])).expect("starts");
    let mut inputs = sim.inputs();
    for k in 0..600 {
        inputs.spindle_speed = if k < 400 { f64::from(k) * 2.0 } else { 0.0 };
        sim.advance(inputs, 1e-5).expect("goes on");
        assert!(sim.outputs().wire_tension_min >= 0.0);
    }
    let events = sim.drain_events();
    assert!(
        events.iter().any(|e| e.kind == EventKind::Slack),
        "{events:?}"
    );
    assert!(sim.centreline().points.iter().all(|p| p.norm() < 0.1));
}

#[test]
fn tension_above_strength_breaks_the_wire() {
    let mut sim = Simulation::new(&fig8(&[])).expect("starts");
    let mut inputs = sim.inputs();
    inputs.tension_setpoint = 200.0;
    inputs.spindle_speed = 100.0;
    for _ in 0..400 {
        sim.advance(inputs, 1e-5)
            .expect("a broken wire is a result, not an error");
    }
    assert!(sim.outputs().defect_break && sim.outputs().defect_code & 8 == 8);
    assert!(
        sim.drain_events()
            .iter()
            .any(|e| e.kind == EventKind::Break)
    );
}

#[test]
fn bad_input_is_refused_with_a_reason() {
    let scene = fig8(&[("solver.step", "1e-5"), ("solver.integrator", "verlet")]);
    let error = Simulation::new(&scene).expect_err("unstable").to_string();
    assert!(
        error.contains("solver.step") && error.contains("limit"),
        "{error}"
    );
    let mut sim = Simulation::new(&fig8(&[])).expect("starts");
    let good = sim.inputs();
    for bad in [f64::NAN, f64::INFINITY] {
        let error = sim
            .advance(
                Inputs {
                    spindle_speed: bad,
                    ..good
                },
                1e-5,
            )
            .expect_err("refused");
        assert!(error.to_string().contains("spindle_speed"), "{error}");
    }
    assert!(
        sim.advance(
            Inputs {
                tension_setpoint: -1.0,
                ..good
            },
            1e-5
        )
        .is_err()
    );
    sim.advance(good, 1e-6)
        .expect("the refusals changed nothing");
}

#[test]
fn an_stl_core_winds_like_the_generated_one() {
    // at the default tolerance the swing of wire that has just landed differs by 20 um from one run to the next
    let plain = fig8(&[("spindle.speed", "500"), ("solver.tolerance", "1e-6")]);
    let surface = core_surface(&plain).expect("a box");
    let mesh = surface.mesh();
    let triangles: Vec<stl_io::Triangle> = (0..mesh.len())
        .map(|t| {
            let v = mesh.triangles[t].map(|i| {
                let p = mesh.vertices[i as usize] * 1e3;
                stl_io::Vertex::new([p.x as f32, p.y as f32, p.z as f32])
            });
            stl_io::Triangle {
                normal: stl_io::Normal::new([0.0; 3]),
                vertices: v,
            }
        })
        .collect();
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, triangles: &[stl_io::Triangle]| {
        let path = folder.path().join(name);
        let mut file = std::fs::File::create(&path).expect("a file");
        stl_io::write_stl(&mut file, triangles.iter()).expect("written");
        path
    };
    let load = |path: &std::path::Path| {
        let text = format!(
            "[core]\nshape = \"mesh\"\nfile = {path:?}\nunit = \"mm\"\n[wire]\nmaterial = \"table1\"\n[spindle]\nspeed = 500\n[solver]\ntolerance = 1e-6\n"
        );
        SceneSettings::from_toml_str(&text, "stl.toml", folder.path())
            .expect("parsed")
            .build()
    };
    let scene = load(&write("core.stl", &triangles)).expect("a scene");
    let (a, b) = (wind(&plain, 0.3), wind(&scene, 0.3));
    let (p, q) = (a.centreline(), b.centreline());
    for s in &p.arc {
        assert!((at(&p, *s) - at(&q, *s)).norm() < 10e-6);
    }
    let open = load(&write("open.stl", &triangles[1..])).map_err(|e| e.to_string());
    let refused = open.and_then(|s| Simulation::new(&s).map(|_| ()).map_err(|e| e.to_string()));
    let text = refused.expect_err("an open mesh has no inside");
    assert!(text.contains("open.stl") && text.contains("open"), "{text}");
    let flipped: Vec<_> = triangles
        .iter()
        .map(|t| stl_io::Triangle {
            normal: t.normal,
            vertices: [t.vertices[0], t.vertices[2], t.vertices[1]],
        })
        .collect();
    let inside_out = load(&write("flipped.stl", &flipped)).map_err(|e| e.to_string());
    let refused =
        inside_out.and_then(|s| Simulation::new(&s).map(|_| ()).map_err(|e| e.to_string()));
    assert!(refused.expect_err("no inside").contains("inside out"));
}
