//! Whole coils between flanges: layers are counted, lie in grooves, and stay out of flange and each other.

use crate::bobbin::{DIAMETER, STRAIGHT, TURNS, small_bobbin};
use coilwind::measure::{Defect, DefectKind, STATIONS_PER_TURN, Verdict};
use coilwind::settings::{NozzleFollows, SceneSettings};
use coilwind::signals::{EventKind, Inputs};
use coilwind::simulation::Simulation;
use std::f64::consts::{PI, TAU};
use std::path::Path;

fn started(text: &str) -> Simulation {
    let settings = SceneSettings::from_toml_str(text, "bobbin.toml", Path::new("")).expect("reads");
    let (scene, _) = settings.build_for(NozzleFollows::Input).expect("a scene");
    Simulation::new(&scene).expect("starts")
}

fn wound(sim: &mut Simulation, turns: f64) {
    let end = sim.motion_profile().time_at(turns * TAU);
    sim.advance_profile(end - sim.time())
        .expect("the run goes on");
}

#[test]
fn three_layers_lie_in_their_grooves_between_the_flanges() {
    let mut sim = started(&small_bobbin(3, 20.0));
    let law_turns = sim.scene().nozzle_law.turns();
    assert_eq!(law_turns, 18.0);
    // a state on the way, with wire in the corner between core and flange
    wound(&mut sim, 6.4);
    let saved = sim.to_bytes().expect("a state");
    wound(&mut sim, 7.0);
    let mut other = Simulation::from_bytes(sim.scene(), &saved).expect("restores");
    wound(&mut other, 7.0);
    assert!(
        other.to_bytes().unwrap() == sim.to_bytes().unwrap(),
        "goes on to the bit"
    );
    wound(&mut sim, law_turns);

    for turn in sim.turns().iter().filter(|turn| turn.settled == 1.0) {
        let (layer, in_layer) = (
            (turn.turn as usize - 1) / TURNS + 1,
            (turn.turn as usize - 1) % TURNS + 1,
        );
        assert_eq!(
            (turn.layer as usize, turn.turn_in_layer as usize),
            (layer, in_layer),
            "{turn:?}"
        );
    }
    // the climb to the next layer is none of these, nor is wire beside a flange a gap
    let wrong = |kind| {
        kind == DefectKind::Overlap || kind == DefectKind::Bulge || kind == DefectKind::Slack
    };
    let defects = sim.defects();
    assert!(
        !defects.iter().any(|defect| wrong(defect.kind)),
        "{defects:?}"
    );

    // in the grooves of a layer whose turns lie a pitch apart
    let pitch = sim.scene().nozzle_law.position(TAU) - sim.scene().nozzle_law.position(0.5 * TAU);
    let rise = (DIAMETER * DIAMETER - 0.25 * pitch * pitch).sqrt();
    let mut seen = 0;
    for (index, station) in sim.coil().stations().enumerate() {
        let (turn, degree) = (index / STATIONS_PER_TURN, index % STATIONS_PER_TURN);
        let (layer, in_layer) = (turn / TURNS, turn % TURNS);
        if !STRAIGHT.contains(&degree) || in_layer == 0 || in_layer == TURNS - 1 {
            continue;
        }
        let off = (station.height - layer as f64 * rise) / DIAMETER;
        assert!(
            off.abs() < 0.05,
            "turn {}, {degree} degrees: {off} d beside its groove",
            turn + 1
        );
        seen += 1;
    }
    assert!(seen > 1500, "{seen}");

    // and so full is the coil
    let coil = sim.product().coil.expect("wire");
    let height = DIAMETER + 2.0 * rise;
    assert!((coil.height_m / height - 1.0).abs() < 0.005, "{coil:?}");
    let section = sim.product().turns * 0.25 * PI * DIAMETER * DIAMETER;
    let full = section / ((TURNS as f64 + 0.5) * pitch * height);
    assert!(
        (coil.fill_bare / full - 1.0).abs() < 0.005,
        "{coil:?} {full}"
    );

    let window = 0.5 * (4.65e-3 - DIAMETER);
    for station in sim.coil().stations() {
        assert!(
            station.position.y.abs() < window + 0.02 * DIAMETER,
            "in the flange: {station:?}"
        );
    }
    let summary = sim.summary();
    let energy = &summary.energy;
    assert!(
        summary.penetration.largest_over_d < 0.02,
        "{:?}",
        summary.penetration
    );
    assert!(energy.residual_over_dissipated.abs() < 0.005, "{energy:?}");
    assert!(energy.damping_J > 0.0, "{energy:?}");
    let remeshing = energy.remeshing_J / energy.plastic_J;
    assert!(
        remeshing.abs() < 0.005 && energy.numerical_over_dissipated.abs() < 0.005,
        "{energy:?}"
    );
}

/// A nozzle that stood after a step across went on as fast as it had come.
#[test]
fn the_nozzle_is_where_its_law_says_however_long_the_steps_are() {
    for turns in [&[0.5, 1.0, 1.5][..], &[1.5]] {
        let mut sim = started(&small_bobbin(3, 20.0));
        for &end in turns {
            wound(&mut sim, end);
            let law = sim.scene().nozzle_law.position(sim.outputs().spindle_angle);
            let off = sim.inputs().nozzle_position - law;
            assert!(
                off.abs() < 1e-12,
                "{off} m beside the law after {end} turns"
            );
        }
    }
}

/// Wire piled up in one place until it met the nozzle: energy was off by a sixth, wire 0.2 diameters deep in wire, and the run said
/// that the wire broke.
#[test]
fn a_coil_that_grows_into_the_nozzle_ends_the_winding() {
    let text = "[core]\nshape = 'cylinder'\nradius_mm = 3\n[core.flange]\ninner_distance_mm = 1.5\nheight_mm = 1\n\
                [nozzle]\ndistance_mm = 5.6\ny_start_mm = -0.4\n[start]\nclamp_y_mm = -0.4\n\
                [spindle]\nspeed = 100\nturns = 22\n[traverse]\nper_turn_mm = 0\n[solver]\ntolerance_um = 2\n";
    let mut sim = started(text);
    let end = sim.motion_profile().end();
    sim.advance_profile(end).expect("the machine goes on");
    let defects = sim.defects();
    let [collision] = &defects
        .iter()
        .filter(|d| d.kind == DefectKind::Collision)
        .collect::<Vec<_>>()[..]
    else {
        panic!("one collision: {defects:?}");
    };
    assert!(collision.turn > 2 && collision.layer > 2, "{collision:?}");
    assert_eq!(sim.verdict(), Verdict::Collision);
    assert!(sim.outputs().defect_code & DefectKind::Collision.code() != 0);
    assert!(!sim.outputs().defect_break);
    let events = sim.drain_events();
    let told = events.iter().filter(|e| e.kind == EventKind::Collision);
    let texts: Vec<_> = told.map(|e| &e.text).collect();
    assert!(
        texts.len() == 1 && texts[0].contains("the coil has grown into the nozzle"),
        "{texts:?}"
    );
    let summary = sim.summary();
    assert!(summary.turns_wound > 2.0, "{}", summary.turns_wound);
    assert!(
        summary.penetration.largest_over_d < 0.02,
        "{:?}",
        summary.penetration
    );
    assert!(
        summary.energy.residual_over_dissipated.abs() < 0.005,
        "{:?}",
        summary.energy
    );
}

/// Turns on turns of which none had come to rest grew past the nozzle: 7 % of the energy was unexplained, and the run said slack alone.
#[test]
fn a_coil_that_is_not_at_rest_grows_into_the_nozzle_too() {
    let text = "[wire]\nmaterial = 'copper'\ndiameter_mm = 2.7\n[core]\nshape = 'cylinder'\nradius_mm = 0.9\nlength_y_mm = 30\n\
                [nozzle]\ndistance_mm = 9\n[tensioner]\ntension = 22\n[friction]\nstatic = 0.8\nkinetic = 0.5\n\
                [spindle]\nspeed = 1030\nturns = 3\n[traverse]\nper_turn_mm = 0\n";
    let mut sim = started(text);
    let end = sim.motion_profile().end();
    sim.advance_profile(end).expect("the machine goes on");
    assert_eq!(sim.summary().turns_settled, 0.0);
    let met = sim.defects();
    let met = met.iter().find(|d| d.kind == DefectKind::Collision);
    assert_eq!(met.map(|d| d.turn), Some(3));
    let energy = &sim.summary().energy;
    assert!(energy.residual_over_dissipated.abs() < 0.005, "{energy:?}");
}

/// Wire that came round while a single edge had frozen at the clamp went 0.26 diameters into it, and got energy from nowhere when the next
/// edges froze: a fifteenth of what the run dissipated.
#[test]
fn wire_that_comes_round_to_a_lone_frozen_edge_touches_it() {
    for start in ["-0.38", "-0.33"] {
        let text = format!(
            "[core]\nshape = 'cylinder'\nradius_mm = 3\n[core.flange]\ninner_distance_mm = 1.5\nheight_mm = 1\n\
             [nozzle]\ndistance_mm = 5.6\ny_start_mm = {start}\n[start]\nclamp_y_mm = -0.4\n\
             [spindle]\nspeed = 100\nturns = 1.3\n[traverse]\nper_turn_mm = 0\n"
        );
        let mut sim = started(&text);
        let end = sim.motion_profile().end();
        sim.advance_profile(end).expect("the machine goes on");
        let summary = sim.summary();
        let depth = summary.penetration.largest_over_d;
        assert!(depth < 0.02, "{depth} diameters deep from {start} mm");
        let energy = summary.energy;
        let lost = energy.numerical_J.abs() + energy.remeshing_J.abs();
        assert!(lost < 1e-3, "{energy:?} from {start} mm");
    }
}

/// Where a coil was higher than the region in which wire may freeze, its outer layers stayed in the computation for good.
#[test]
fn wire_freezes_on_a_coil_of_any_height() {
    let text = format!("{}[freeze]\nmargin_mm = 0.3\n", small_bobbin(3, 20.0));
    let mut sim = started(&text);
    wound(&mut sim, 9.5);
    let outputs = sim.outputs();
    assert_eq!(outputs.layer, 2);
    let live = outputs.turns_wound - outputs.turns_settled;
    assert!(live < 1.5, "{live} turns are live");
}

/// The nozzle begins near a flange, and wire touches its edge before it comes to the core: that was taken for the coil, and
/// `turns_wound` fell once the nozzle had left the flange.
#[test]
fn wire_that_passes_a_flange_is_not_wound_there() {
    let mut sim = started(&small_bobbin(1, 20.0));
    let mut before: f64 = 0.0;
    let on_core = 6e-3 + 0.5 * DIAMETER;
    for tenth in 1..=9 {
        wound(&mut sim, 0.1 * f64::from(tenth));
        let o = *sim.outputs();
        let off = libm::hypot(o.layon_x, o.layon_z);
        assert!((off - on_core).abs() < 0.02e-3, "turn 0.{tenth}: {off}");
        assert!(o.turns_wound > before, "turn 0.{tenth}: {o:?}");
        before = o.turns_wound;
    }
}

/// Of a window that holds one turn and no half, a single layer was wound, whatever the scene asked for; with as many as it asked
/// for, turns from the third on were told as double.
#[test]
fn a_disc_coil_lies_turn_on_turn() {
    for (inner, first) in [(0.55, 0.0), (0.8, -0.15)] {
        let mut sim = started(&format!(
            "[wire]\nmaterial = 'copper'\ndiameter_mm = 0.5\n[core]\nshape = 'cylinder'\nradius_mm = 8\n\
             [core.flange]\ninner_distance_mm = {inner}\nheight_mm = 4\nedge_radius_mm = 0.2\n\
             [nozzle]\ndistance_mm = 40\ny_start_mm = {first}\n[start]\nclamp_y_mm = {first}\n\
             [tensioner]\ntension = 6\n[spindle]\nspeed = 100\nramp_turns = 0.5\n\
             [traverse]\nmode = 'orthocyclic'\n[winding]\nturns_per_layer = 1\nlayers = 5\n"
        ));
        wound(&mut sim, 2.6);
        let saved = sim.to_bytes().expect("a state");
        let mut other = Simulation::from_bytes(sim.scene(), &saved).expect("restores");
        for sim in [&mut sim, &mut other] {
            wound(sim, 5.0);
        }
        assert!(other.to_bytes().unwrap() == sim.to_bytes().unwrap());
        let layers: Vec<u32> = sim.turns().iter().map(|turn| turn.layer).collect();
        assert_eq!(layers, [1, 2, 3, 4, 5], "{inner} mm");
        assert_eq!(sim.defects(), [], "{inner} mm");
        // a single turn leaves no groove for the turn that lies on it
        let out: Vec<f64> = sim.turns().iter().map(|turn| turn.out_of_groove).collect();
        assert_eq!(out, [0.0; 5], "{inner} mm");
        assert_eq!(sim.verdict(), Verdict::Single, "{:?}", sim.reasons());
        let deepest = sim.product().coil.expect("a coil").height_m;
        assert!(deepest > 4.0 * 0.35e-3, "{deepest}");
    }
}

/// Turns on the rim of a flange were told as overlaps and bulges of layers, and nothing said that wire had left its room.
#[test]
fn wire_that_gets_over_a_rim_is_told() {
    let wound = |height_mm: f64| {
        let text = format!(
            "wire.material = 'copper'\nwire.diameter_mm = 0.5\ncore.shape = 'cylinder'\ncore.radius_mm = 8\n\
             core.flange.inner_distance_mm = 4.52\ncore.flange.height_mm = {height_mm}\nnozzle.distance_mm = 20\n\
             nozzle.y_start_mm = -2.01\nstart.clamp_y_mm = -2.01\ntensioner.tension = 6.25\nspindle.speed = 100\n\
             traverse.mode = 'helical'\nwinding.layers = 3\n"
        );
        let settings =
            SceneSettings::from_toml_str(&text, "rim.toml", Path::new("")).expect("reads");
        let mut sim = Simulation::new(&settings.build().expect("a scene")).expect("starts");
        sim.advance_profile(sim.motion_profile().end())
            .expect("goes on");
        sim.reasons()
            .into_iter()
            .any(|why| why.contains("got over the rim of a flange"))
    };
    assert!(wound(1.2));
    assert!(!wound(2.5));
}

/// A coil with its last wire on the rim of a flange was "aligned, exit 0": what lies there is measured as if it lay on the core.
#[test]
fn a_coil_over_a_rim_without_a_defect_is_not_judged() {
    let mut sim = started(
        "wire.material = 'copper'\nwire.diameter_mm = 0.5\ncore.shape = 'cylinder'\ncore.radius_mm = 8\n\
         core.flange.inner_distance_mm = 6\ncore.flange.height_mm = 0.6\nnozzle.distance_mm = 20\n\
         tensioner.tension = 7\nspindle.speed = 40\nspindle.turns = 7\ntraverse.per_turn_mm = 0.52\n",
    );
    wound(&mut sim, 6.0);
    assert_eq!(sim.doubt(), None);
    wound(&mut sim, 7.0);
    assert_eq!(sim.defects(), [], "{:?}", sim.reasons());
    let doubt = sim.doubt().expect("wire on the rim");
    assert!(doubt.contains("got over the rim of a flange"), "{doubt}");
}

/// Slack at the end of a layer was told in the next one, or in the one before: the layer was guessed when it happened.
#[test]
fn slack_lies_in_the_layer_in_which_its_wire_came_to_rest() {
    let mut sim = started(
        "[wire]\nmaterial = 'copper-soft'\ndiameter_mm = 0.7\n[core]\nwidth_x_mm = 8\nheight_z_mm = 24\n\
         corner_radius_mm = 1\n[core.flange]\ninner_distance_mm = 2.9\nheight_mm = 4\n[nozzle]\ndistance_mm = 20\n\
         y_start_mm = -1.1\n[start]\nclamp_y_mm = -1.1\n[tensioner]\ntension = 15\n[spindle]\nspeed = 100\n\
         ramp_turns = 0.5\n[traverse]\nmode = 'orthocyclic'\ncrossover_deg = 60\n[winding]\nlayers = 3\n",
    );
    let profile = sim.motion_profile().clone();
    let step = 5e-4;
    while sim.time() < profile.time_at(9.8 * TAU) {
        let time = sim.time();
        let lets_go = time > 0.02 && (time + 0.025) % 0.035 < 0.004;
        let inputs = Inputs {
            spindle_speed: profile.speed(time),
            nozzle_position: profile.nozzle(time),
            tension_setpoint: if lets_go { 0.0 } else { 15.0 },
            ..sim.inputs()
        };
        sim.advance(inputs, step).expect("the run goes on");
    }
    let layers: Vec<u32> = sim.coil().stations().map(|s| s.layer).collect();
    let slack = |defect: &Defect| defect.kind == DefectKind::Slack;
    let mut compared = Vec::new();
    for defect in sim.defects().into_iter().filter(slack) {
        let station = (defect.turn as usize - 1) * STATIONS_PER_TURN;
        if let Some(layer) = layers.get(station + defect.angle_deg.round() as usize) {
            assert_eq!(defect.layer, *layer, "{defect:?}");
            compared.push(*layer);
        }
    }
    assert!(
        compared.contains(&1) && compared.contains(&3),
        "{compared:?}"
    );
}

/// Messages of a turn that came to rest all at once counted it twice, and named a turn that was not begun.
#[test]
fn messages_of_a_turn_that_comes_to_rest_at_once_name_the_turn_that_is_wound() {
    let mut settings = SceneSettings::default();
    for (name, value) in [
        ("wire.material", "aluminium"),
        ("wire.diameter_mm", "0.5"),
        ("core.shape", "cylinder"),
        ("core.radius_mm", "6"),
        ("core.flange.inner_distance_mm", "4.3"),
        ("core.flange.height_mm", "3"),
        ("nozzle.distance_mm", "20"),
        ("nozzle.y_start_mm", "-1.9"),
        ("start.clamp_y_mm", "-1.9"),
        ("tensioner.tension", "4"),
        ("spindle.speed", "100"),
        ("traverse.mode", "helical"),
        ("traverse.lead_mm", "0.6"),
        ("winding.layers", "2"),
    ] {
        settings.set_text(name, value).expect("a valid setting");
    }
    let scene = settings.build().expect("a valid scene");
    let mut sim = Simulation::new(&scene).expect("starts");
    let mut at_once = 0.0_f64;
    while sim.time() < 0.66 {
        let (before, settled) = (sim.outputs().turns_wound, sim.outputs().turns_settled);
        sim.advance_profile(1e-3).expect("goes on");
        at_once = at_once.max(sim.outputs().turns_settled - settled);
        for event in sim.drain_events() {
            // wire that goes slack leaves up to a turn of the coil within a step
            let most = before.max(sim.outputs().turns_wound) + 0.2;
            assert!(event.turn < most, "{event:?}, {most} turns wound");
        }
    }
    let settled = sim.outputs().turns_settled;
    assert!(settled > 9.0 && at_once > 0.8, "{settled} {at_once}");
}

/// Each turn crosses before the clamp's angle, and the last one has no place from where the turn before has: it overlapped without a word of why.
#[test]
fn a_last_turn_without_a_place_says_where_the_coil_should_end() {
    let text = "[wire]\ndiameter_mm = 0.5\n[core]\nshape = \"cylinder\"\nradius_mm = 6\n\
        [core.flange]\ninner_distance_mm = 2.275\nheight_mm = 3\n[nozzle]\ndistance_mm = 16\n\
        [tensioner]\ntension = 8\n[spindle]\nspeed = 200\nturns = 4.9\n[traverse]\nmode = \"orthocyclic\"\n\
        crossover_deg = 60\nadvance_deg = 90\n[winding]\nlayers = 1\ndirection = \"-y\"\n";
    let mut sim = started(text);
    let said = |sim: &Simulation| {
        let told = sim.reasons().into_iter();
        told.filter(|reason| reason.contains("wire lies on the turn before"))
            .collect::<Vec<_>>()
    };
    wound(&mut sim, 4.25);
    assert!(said(&sim).is_empty(), "{:?}", said(&sim));
    wound(&mut sim, 4.9);
    let [reason] = &said(&sim)[..] else {
        panic!("{:?}", sim.reasons());
    };
    assert!(reason.starts_with("From turn 4 at 337 deg on"), "{reason}");
    assert!(reason.contains("spindle.turns = 3.90"), "{reason}");
}

/// Wire beside a flange that is lower than the coil leaned on its edge, less than half a wire beyond its face: a double turn without a reason.
#[test]
fn wire_that_leans_on_the_edge_of_a_rim_is_told() {
    let text = |height_mm: f64| {
        format!(
            "[wire]\ndiameter_mm = 0.5\n[core]\nshape = \"cylinder\"\nradius_mm = 6\n\
             [core.flange]\ninner_distance_mm = 2.275\nheight_mm = {height_mm}\n[nozzle]\ndistance_mm = 16\n\
             [tensioner]\ntension = 8\n[spindle]\nspeed = 200\n[traverse]\nmode = \"orthocyclic\"\n\
             crossover_deg = 60\nadvance_deg = 90\n[winding]\nlayers = 2\ndirection = \"-y\"\n"
        )
    };
    for (height_mm, leans) in [(0.4, true), (3.0, false)] {
        let mut sim = started(&text(height_mm));
        wound(&mut sim, 5.6);
        let told = sim.reasons();
        let rim = told.iter().any(|reason| {
            reason.starts_with("Wire lies on the edge of a flange's rim from turn 4 at 3")
                && reason.ends_with("raise core.flange.height")
        });
        assert_eq!(rim, leans, "{told:?}");
    }
}
