//! One run of a sweep: wound as `coilwind run` winds it, judged, no files.

use super::drive::{Drive, Motion};
use super::failure::Failure;
use super::sweep_row::Row;
use coilwind::measure::{DefectKind, UNJUDGED};
use coilwind::settings::{NozzleFollows, SceneSettings};
use coilwind::simulation::{SimError, Simulation};
use cpu_time::ThreadTime;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Winds a scene from start to end and says what came of it; `None` where the flag went up before.
///
/// # Errors
/// A scene that cannot be built. A solver that gives up is a result.
pub(super) fn wind(
    settings: &SceneSettings,
    member: u32,
    stop: &Arc<AtomicBool>,
) -> Result<Option<Row>, Failure> {
    let clock = ThreadTime::now();
    let (scene, _) = settings.build_with_warnings()?;
    let mut row = match Simulation::new(&scene) {
        Err(reason) => Row::failed_to_start(member, &reason),
        Ok(mut simulation) => {
            simulation.stop_on(Arc::clone(stop));
            simulation.step_beyond(scene.solver.features.rows_between);
            let motion = Motion {
                inputs: None,
                stop_time: None,
            };
            let mut drive = Drive::new(&motion, &scene, NozzleFollows::Law)?;
            let mut tension = simulation.outputs().wire_tension;
            let mut extremes = (tension, tension);
            let failed = loop {
                if stop.load(Ordering::SeqCst) {
                    return Ok(None);
                }
                match drive.advance(&mut simulation) {
                    None => break None,
                    Some(Err(_)) if stop.load(Ordering::SeqCst) => return Ok(None),
                    Some(Err(reason)) => break Some(reason),
                    Some(Ok(_)) => {}
                }
                simulation.drain_events();
                let outputs = simulation.outputs();
                tension = outputs.wire_tension_min;
                extremes.0 = extremes.0.min(tension);
                tension = outputs.wire_tension_max;
                extremes.1 = extremes.1.max(tension);
            };
            judge(&simulation, member, extremes, failed)
        }
    };
    row.cpu_s = clock.elapsed().as_secs_f64();
    Ok(Some(row))
}

fn judge(
    simulation: &Simulation,
    member: u32,
    (least, most): (f64, f64),
    failed: Option<SimError>,
) -> Row {
    let d = simulation.scene().wire.diameter;
    let (turns, defects) = (simulation.turns(), simulation.defects());
    let count = |kind| defects.iter().filter(|defect| defect.kind == kind).count();
    let gaps = turns.iter().filter_map(|turn| turn.gap_mean);
    let bulges = turns.iter().filter_map(|turn| turn.bulge_excess_max);
    let failed = failed.map(|reason| reason.to_string());
    let failed = failed.or_else(|| simulation.doubt());
    Row {
        member,
        verdict: match failed {
            Some(_) => UNJUDGED.to_owned(),
            None => simulation.verdict().as_str().to_owned(),
        },
        defect: !defects.is_empty() || simulation.verdict().is_defect(),
        outcome: if failed.is_some() { "failed" } else { "done" }.to_owned(),
        reason: failed.unwrap_or_default(),
        gap_mean_d: gaps.reduce(f64::max).map(|gap| gap / d),
        bulge_excess_d: bulges.reduce(f64::max).map(|bulge| bulge / d),
        defects_bulge: count(DefectKind::Bulge),
        defects_gap: count(DefectKind::Gap),
        defects_overlap: count(DefectKind::Overlap),
        defects_break: count(DefectKind::Break),
        defects_slack: count(DefectKind::Slack),
        defects_double_turn: count(DefectKind::DoubleTurn),
        defects_skipped_groove: count(DefectKind::SkippedGroove),
        defects_early_jump: count(DefectKind::EarlyJump),
        defects_late_jump: count(DefectKind::LateJump),
        defects_loose_turn: count(DefectKind::LooseTurn),
        defects_overstretch: count(DefectKind::Overstretch),
        defects_collision: count(DefectKind::Collision),
        defects_runaway: count(DefectKind::Runaway),
        tension_min: Some(least),
        tension_max: Some(most),
        turns_settled: simulation.outputs().turns_settled,
        cpu_s: 0.0,
    }
}
