//! What the program decides where a scene leaves it open.

use crate::common::parse;
use coilwind::scene::Twist;
use coilwind::scene::{Integrator, LiveContact, Preset, Scene};

/// What `auto` came to for a switch; nothing where the scene says it.
fn decided(text: &str, name: &str) -> Option<&'static str> {
    let skipped = parse(text).unwrap().build().unwrap().skipped;
    skipped.iter().find(|d| d.name == name).map(|d| d.decision)
}

#[test]
fn a_scene_leaves_out_what_it_does_not_need() {
    for (text, name, decision) in [
        ("", "solver.plasticity", "on"),
        ("[wire]\nelastic = true", "solver.plasticity", "off"),
        ("", "solver.friction", "on"),
        (
            "[friction]\nstatic = 0.0\nkinetic = 0.0",
            "solver.friction",
            "off",
        ),
        ("", "solver.coarse_span", "on"),
        (
            "[solver]\nspacing_near_mm = 0.8\nspacing_free_mm = 0.8",
            "solver.coarse_span",
            "off",
        ),
        ("", "solver.coarse_settled", "on"),
        ("preset = 'paper'", "solver.coarse_settled", "off"),
        ("", "solver.inertia", "on"),
        ("", "solver.live_contact", "from half a live turn on"),
    ] {
        assert_eq!(decided(text, name), Some(decision), "{name} of {text:?}");
    }
}

#[test]
fn a_switch_is_obeyed_and_no_decision() {
    let built = |line: &str| {
        parse(&format!("[solver]\n{line}"))
            .unwrap()
            .build()
            .unwrap()
    };
    let names = |scene: &Scene| scene.skipped.iter().map(|d| d.name).collect::<Vec<_>>();
    let whole = names(&built(""));
    for (line, name) in [
        ("plasticity = 'off'", "solver.plasticity"),
        ("friction = 'off'", "solver.friction"),
        ("coarse_span = 'off'", "solver.coarse_span"),
        ("coarse_settled = 'off'", "solver.coarse_settled"),
        ("inertia = 'off'", "solver.inertia"),
        ("live_contact = 'off'", "solver.live_contact"),
    ] {
        let mut rest = whole.clone();
        rest.retain(|n| *n != name);
        assert_eq!(names(&built(line)), rest, "{line}");
    }
    assert!(built("plasticity = 'off'").wire.m_y.is_infinite());
    // and a wire that cannot yield needs no twist
    assert_eq!(built("plasticity = 'off'").solver.twist, Twist::Off);
    assert_eq!(built("friction = 'off'").friction.static_, 0.0);
    let coarse = built("coarse_span = 'off'").solver;
    assert_eq!(coarse.spacing_free, coarse.spacing_near);
    let parts = |line: &str| built(line).solver.features;
    assert!(!parts("coarse_settled = 'off'").coarse_settled);
    assert!(!parts("inertia = 'off'").inertia && parts("inertia = 'on'").inertia);
    for (value, meaning) in [
        ("on", LiveContact::Always),
        ("auto", LiveContact::WhenHalfATurnIsLive),
        ("off", LiveContact::Never),
    ] {
        let line = format!("live_contact = '{value}'");
        assert_eq!(parts(&line).live_contact, meaning);
    }
}

#[test]
fn the_explicit_methods_refuse_what_they_cannot_leave_out() {
    for (line, key) in [
        ("inertia = 'off'", "solver.inertia"),
        ("coarse_settled = 'on'", "solver.coarse_settled"),
    ] {
        let text = format!("preset = 'paper'\n[solver]\n{line}");
        let refused = parse(&text).unwrap().build().unwrap_err().to_string();
        assert!(refused.contains(key), "{refused}");
        assert!(refused.contains("solver.integrator"), "{refused}");
    }
}

#[test]
fn the_integrator_decides_how_twist_is_carried_unless_it_is_set() {
    let twist = |text: &str| parse(text).unwrap().build().map(|s| s.solver.twist);
    let with = |integrator: &str, level: &str| {
        twist(&format!(
            "[solver]\nintegrator = '{integrator}'\ntwist = '{level}'"
        ))
    };
    assert_eq!(twist(""), Ok(Twist::QuasiStatic));
    assert_eq!(twist("[wire]\nelastic = true"), Ok(Twist::Off));
    let skipped = |text: &str| parse(text).unwrap().build().unwrap().skipped;
    let twist_of = |text: &str| {
        let mut decisions = skipped(text).into_iter();
        decisions.find(|d| d.name == "solver.twist")
    };
    let decision = twist_of("").unwrap();
    assert_eq!(
        (decision.setting, decision.decision),
        ("auto", "quasi-static")
    );
    assert_eq!(twist_of("[solver]\ntwist = 'off'"), None);
    assert_eq!(twist("preset = 'paper'"), Ok(Twist::Dynamic));
    assert_eq!(with("implicit", "quasi-static"), Ok(Twist::QuasiStatic));
    assert_eq!(with("implicit", "dynamic"), Ok(Twist::Dynamic));
    assert_eq!(with("verlet", "auto"), Ok(Twist::Dynamic));
    assert_eq!(with("verlet", "off"), Ok(Twist::Off));
    let text = with("rk4", "quasi-static").unwrap_err().to_string();
    for part in ["solver.twist", "quasi-static", "auto, off or dynamic"] {
        assert!(text.contains(part), "{part} in {text}");
    }
}

#[test]
fn preset_decides_the_integrator_unless_it_is_set() {
    let integrator = |text: &str| parse(text).unwrap().build().unwrap().solver.integrator;
    assert_eq!(integrator(""), Integrator::Implicit);
    assert_eq!(integrator("preset = 'paper'"), Integrator::Rk4);
    assert_eq!(
        integrator("preset = 'paper'\n[solver]\nintegrator = 'verlet'"),
        Integrator::Verlet
    );
    assert_eq!(integrator("[solver]\nintegrator = 'rk4'"), Integrator::Rk4);
    let scene = parse("preset = 'paper'").unwrap().build().unwrap();
    assert_eq!(scene.preset, Preset::Paper);
}

/// A disc coil was warned of gaps between the turns of a layer, of which each layer has one.
#[test]
fn gaps_are_warned_of_only_where_turns_lie_side_by_side() {
    let told = |mode: &str, inner_mm: f64, turns: u32| -> Vec<String> {
        let text = format!(
            "[wire]\ndiameter_mm = 0.6\n[core.flange]\ninner_distance_mm = {inner_mm}\nheight_mm = 6\n\
             [nozzle]\ny_start_mm = {0}\n[start]\nclamp_y_mm = {0}\n[tensioner]\ntension = 9\n\
             [traverse]\nmode = '{mode}'\n[winding]\nlayers = 4\nturns_per_layer = {turns}\n",
            0.3 - 0.5 * inner_mm
        );
        let (_, warnings) = parse(&text).unwrap().build_with_warnings().unwrap();
        warnings.iter().map(ToString::to_string).collect()
    };
    for mode in ["orthocyclic", "helical"] {
        for (inner_mm, turns, warned) in [(1.0, 1, false), (1.7, 1, false), (1.7, 2, true)] {
            let told = told(mode, inner_mm, turns);
            let has = |part: &str| told.iter().any(|warning| warning.contains(part));
            assert_eq!(
                has("leave gaps"),
                warned,
                "{mode}, {inner_mm} mm, {turns}: {told:?}"
            );
            // a second wire has room beside the first in 1.7 mm
            let falls = inner_mm > 1.2 && turns == 1;
            assert_eq!(
                has("falls in there"),
                falls,
                "{mode}, {inner_mm} mm, {turns}: {told:?}"
            );
        }
    }
}
