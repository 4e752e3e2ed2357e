//! The rod against exact answers: the packed reference cases, and the modes stepped in time.

use crate::verified;
use coilwind::integrate::{Explicit, ExplicitMethod, highest_frequency};
use coilwind::lab::verify::{CaseFile, Manner, Record, VerifyOptions, run, run_file};
use coilwind::math::V3;
use coilwind::rod::{Rod, Section};
use coilwind::scene::Preset;
use coilwind::system::{Loads, Support, System};
use std::f64::consts::PI;

/// By the production method and by the forces of the explicit steps.
macro_rules! kinds {
    ($($kind:ident),* $(,)?) => {
        $(#[test]
        fn $kind() {
            for preset in [Preset::Default, Preset::Paper] {
                verified::all_right(stringify!($kind), preset);
            }
        })*
    };
}

kinds!(
    elastica_cantilever,
    end_couple,
    bending_modes,
    axial_wave,
    torsion,
    hanging_wire,
    helix,
    mandrel_springback,
    cyclic_bending,
    bulge_linear,
    corner_edge,
    square_loop,
);

/// What the paper's method does not know, or does by other steps.
macro_rules! default_only {
    ($($kind:ident),* $(,)?) => {
        $(#[test]
        fn $kind() {
            verified::all_right(stringify!($kind), Preset::Default);
        })*
    };
}

default_only!(rolling_path, wave_damping);

fn packed(kind: &str) -> CaseFile {
    let files = CaseFile::packed().expect("packed files are well formed");
    let found = files.into_iter().find(|f| f.kind == kind);
    found.expect("the kind is packed")
}

/// Error of a quantity of the first case at a node spacing, m.
fn error_at(kind: &str, quantity: &str, spacing: f64) -> f64 {
    let args = VerifyOptions {
        set: vec![format!("solver.spacing_near={spacing}")],
        ..VerifyOptions::default()
    };
    let manner: Manner = args.manner().expect("a known setting");
    let mut file = packed(kind);
    file.cases.truncate(1);
    let mut error = f64::NAN;
    run_file(&file, &manner, |records: &[Record], _| {
        let record = records
            .iter()
            .find(|r| r.quantity.as_deref() == Some(quantity));
        // not every set-up has the quantity
        if let Some(record) = record {
            error = record.rel_error.unwrap_or(f64::NAN);
        }
    })
    .expect("the case can be run");
    error
}

#[test]
fn the_rod_is_second_order_in_its_spacing() {
    for (kind, quantity, spacing) in [
        ("elastica_cantilever", "extensible_tip_y_m", 2e-3),
        ("helix", "axial_moment_Nm", 4e-3),
        ("torsion", "fixed_free_f2_Hz", 5e-3),
    ] {
        let (coarse, fine) = (
            error_at(kind, quantity, spacing),
            error_at(kind, quantity, 0.5 * spacing),
        );
        let ratio = coarse / fine;
        assert!((3.0..5.5).contains(&ratio), "{kind}: {coarse} to {fine}");
    }
}

/// Frequency of a motion that starts as `start` (velocity or spin over the relative position
/// along the wire) and is seen through the same shape, Hz.
fn stepped(
    mut sys: System,
    rolls: bool,
    axis: usize,
    start: impl Fn(f64) -> f64,
    method: ExplicitMethod,
) -> f64 {
    let n = sys.state.rod.edges();
    if rolls {
        for j in 0..n {
            sys.state.rod.spin[j] = start((j as f64 + 0.5) / n as f64);
        }
    } else {
        for i in 0..=n {
            sys.state.rod.v[i][axis] = 1e-3 * start(i as f64 / n as f64);
        }
    }
    let dt = 1.6 / highest_frequency(&sys.model.section, sys.state.rod.rest[0], 0.0, rolls);
    sys.evaluate(Some(dt));
    let seen = |sys: &System| -> f64 {
        if rolls {
            (0..n)
                .map(|j| sys.state.rod.spin[j] * start((j as f64 + 0.5) / n as f64))
                .sum()
        } else {
            (0..=n)
                .map(|i| sys.state.rod.v[i][axis] * start(i as f64 / n as f64))
                .sum()
        }
    };
    let mut explicit = Explicit::new(method);
    let (mut last, mut zeros) = (seen(&sys), Vec::new());
    for _ in 0..400_000 {
        explicit.step(&mut sys, dt);
        let now = seen(&sys);
        if last * now < 0.0 {
            zeros.push(sys.state.time - dt * now / (now - last));
            if zeros.len() == 3 {
                return 1.0 / (zeros[2] - zeros[0]);
            }
        }
        last = now;
    }
    f64::NAN
}

fn elastic(section: &Section) -> Section {
    let open = f64::INFINITY;
    Section {
        n_y: open,
        m_y: open,
        t_y: open,
        ..section.clone()
    }
}

/// A straight wire of `length` along +x, of which both ends are held in place.
fn held(section: &Section, length: f64, n: usize, rest: f64) -> System {
    let points: Vec<V3> = (0..=n)
        .map(|i| V3::x() * (length * i as f64 / n as f64))
        .collect();
    let rod = Rod::through(&points, Some(vec![rest / n as f64; n]));
    let mut sys = System::new(elastic(section), rod);
    sys.state.support = [Support::pinned(V3::zeros()), Support::pinned(points[n])];
    sys
}

fn expected(file: &CaseFile, case: usize, quantity: &str) -> f64 {
    file.cases[case].expected[quantity]
        .as_f64()
        .expect("a number")
}

#[test]
fn modes_stepped_in_time_have_the_frequency_of_theory() {
    for method in [ExplicitMethod::Verlet, ExplicitMethod::Rk4] {
        let file = packed("axial_wave");
        let sys = held(&file.section, 0.5, 60, 0.5);
        let f = stepped(sys, false, 0, |s| libm::sin(PI * s), method);
        let theory = expected(&file, 0, "fixed_fixed_f1_Hz");
        assert!((f / theory - 1.0).abs() < 5e-3, "axial {f} {theory}");

        let file = packed("torsion");
        let mut sys = held(&file.section, 0.1, 60, 0.1);
        sys.state.support[0].frame = Some(sys.state.rod.frame[0]);
        let f = stepped(sys, true, 0, |s| libm::sin(0.5 * PI * s), method);
        let theory = expected(&file, 0, "fixed_free_f1_Hz");
        assert!((f / theory - 1.0).abs() < 5e-3, "torsion {f} {theory}");

        // the fifth case: pinned at both ends, 5 N, 50 mm under tension
        let file = packed("bending_modes");
        assert_eq!(file.cases[4].id, "pinned-pinned_T5_L50mm");
        let mut sys = held(&file.section, 0.05, 40, 0.05 / (1.0 + 5.0 / 48900.0));
        sys.state.support[1].hold = [false, true, true];
        sys.model.loads = Loads {
            nodal: vec![(40, V3::x() * 5.0)],
            ..Loads::default()
        };
        sys.model.twist = coilwind::rod::Twist::Off;
        let f = stepped(sys, false, 1, |s| libm::sin(PI * s), method);
        let theory = expected(&file, 4, "f1_Hz");
        assert!((f / theory - 1.0).abs() < 5e-3, "bending {f} {theory}");
    }
}

/// A ring of no radius ended in a panic, and wire that nothing holds in an overflow of memory.
#[test]
fn inputs_without_a_meaning_are_told_and_not_computed() {
    let options = VerifyOptions::default();
    let manner = options.manner().expect("the default");
    for (kind, input, value, told) in [
        ("spinning_ring", "R_m", 0.0, "above 0"),
        ("spinning_ring", "R_m", -1.0, "above 0"),
        ("spinning_ring", "R_m", 1e2, "edges"),
        ("spinning_ring", "R_m", 1e9, "at most 700"),
        ("capstan", "F0_N", 0.0, "from 0.0489"),
        ("capstan", "R_m", 1e2, "edges"),
        ("bending_modes", "T_N", 1e9, "at most 4890"),
        ("bending_modes", "T_N", 1e4, "at most 4890"),
        ("live_pair", "R_m", 1e9, "at most 0.7"),
        ("live_pair", "drawn_m", -1.0, "above 0"),
        ("helix", "twist_density_1_per_m", 1e9, "at most 1428"),
        ("frozen_helix", "mu", -1.0, "from 0 to 10"),
        ("capstan", "mu", -0.2, "from 0 to 10"),
        ("feed_tension", "line_mass_kg", -1.0, "from 0"),
        ("groove_seat", "pitch_m", 0.0, "above 0"),
    ] {
        let mut file = packed(kind);
        file.cases.truncate(1);
        file.cases[0].inputs.insert(input.to_owned(), value.into());
        let mut said = String::new();
        let run = run_file(&file, &manner, |records, _| {
            let errors = records.iter().filter_map(|record| record.error.as_deref());
            said.extend(errors);
        });
        let said = run.map_or_else(|error| error.to_string(), |()| said);
        assert!(said.contains(told), "{kind} {input} = {value}: {said}");
    }
}

/// A wire that is let go slowly springs back to the same curvature in steps of any tolerance; let go at once it swings, and yields once more.
#[test]
fn springback_does_not_hang_on_the_tolerance() {
    for tolerance in ["2e-7", "1e-8"] {
        let args = VerifyOptions {
            kinds: vec!["mandrel_springback".to_owned()],
            set: vec![format!("solver.tolerance={tolerance}")],
            ..VerifyOptions::default()
        };
        assert_eq!(run(&args, |_| ()), Ok(true), "{tolerance}");
    }
}

/// Nodes lay too far apart for wire that tension straightens right behind an edge, and drag had thick wire bend too sharply.
#[test]
fn sharp_bends_of_thick_fine_and_hard_wire_are_as_exact_as_those_of_the_packed_one() {
    let once = |name: &str| format!("tests/reference/once_wrong/{name}.json").into();
    let args = VerifyOptions {
        files: [
            "corner_edge_steel",
            "corner_edge_hardly_yields",
            "corner_edge_slack",
            "square_loop_fine",
            "square_loop_thick",
        ]
        .map(once)
        .to_vec(),
        ..VerifyOptions::default()
    };
    let mut table = String::new();
    let right = run(&args, |line| table.push_str(&format!("{line}\n")));
    assert_eq!(right, Ok(true), "{table}");
}

/// Rounding of the places of a stiff wire moves its tension by more than a share of so small a load: it never came to rest.
#[test]
fn a_long_wire_under_a_small_torque_comes_to_rest() {
    let args = VerifyOptions {
        files: vec!["tests/reference/once_wrong/torsion_long.json".into()],
        ..VerifyOptions::default()
    };
    assert_eq!(run(&args, |_| ()), Ok(true));
}

/// Each jump of the direction at the edge set off a swing, which steps of small tolerances follow, and the wire yielded in it.
#[test]
fn the_bend_at_an_edge_does_not_hang_on_the_tolerance() {
    for tolerance in ["1e-6", "5e-8"] {
        let args = VerifyOptions {
            files: vec!["tests/reference/square_loop.json".into()],
            set: vec![format!("solver.tolerance={tolerance}")],
            ..VerifyOptions::default()
        };
        assert_eq!(run(&args, |_| ()), Ok(true), "{tolerance}");
    }
}

/// A kind that counts for the other preset only was checked by nothing, without a word of it beside others.
#[test]
fn a_kind_that_is_asked_for_and_not_judged_is_told() {
    let asked = |kinds: &[&str], preset| {
        let mut said = String::new();
        let args = VerifyOptions {
            kinds: kinds.iter().map(|&kind| kind.to_owned()).collect(),
            preset,
            ..VerifyOptions::default()
        };
        assert_eq!(run(&args, |line| said.push_str(line)), Ok(true));
        said.contains("not judged") && said.contains("penalty_impact;")
    };
    assert!(asked(&["penalty_impact"], Preset::Default));
    assert!(asked(&["end_couple", "penalty_impact"], Preset::Default));
    assert!(!asked(&["penalty_impact"], Preset::Paper));
}
