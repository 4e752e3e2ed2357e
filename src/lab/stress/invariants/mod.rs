//! Runs a case and judges it at every communication point: an invariant a file.

mod broken;
mod depth;
mod energy;
mod finite;
mod friction_cone;
mod frozen;
mod frozen_tension;
mod length;
#[cfg(test)]
mod planted;
mod plastic_work;
mod tension;
mod watch;
mod wire_in_wire;
mod work;

use super::case::built;
use super::{Case, Invariant, Measures, Outcome, Verdict};
use crate::signals::{Event, EventKind};
use crate::simulation::{SimError, Simulation};
use broken::Broken;
use std::f64::consts::TAU;
use std::panic::{AssertUnwindSafe, catch_unwind};
use watch::Watch;
use work::Work;

/// Runs a case whose mesh, if it has one, is on disk.
pub fn judge(case: &Case) -> Verdict {
    let mut measures = Measures::default();
    let run = catch_unwind(AssertUnwindSafe(|| wind(case, &mut measures)));
    let outcome = run.unwrap_or_else(|panic| {
        let said = panic.downcast_ref::<String>().map(String::as_str);
        let said = said.or(panic.downcast_ref::<&str>().copied());
        let text = said.unwrap_or("without a word").to_owned();
        Broken::new(Invariant::Panic, text).at(measures.time)
    });
    Verdict { outcome, measures }
}

fn wind(case: &Case, measures: &mut Measures) -> Outcome {
    let started = built(&case.settings)
        .map_err(|e| SimError::setup(e.to_string()))
        .and_then(|scene| Simulation::starting_with(&scene, case.inputs[0]));
    let mut sim = match started {
        Ok(sim) => sim,
        Err(e) => return gave_up(&e, None),
    };
    let mut watch = Watch::new(&sim);
    let mut work = Work::default();
    let mut end = 0.0;
    for (k, inputs) in case.inputs[..case.inputs.len() - 1].iter().enumerate() {
        // times as `coilwind run --inputs` makes them, so that it repeats this run to the bit
        let start = end;
        end = (k + 1) as f64 * case.step;
        let turned = (inputs.spindle_speed * (end - start)).abs() / TAU;
        work.begin(&sim, inputs.tension_setpoint, end - start);
        sim.limit_work(work.allowed());
        let advanced = sim.advance(*inputs, end - start);
        measures.turns += turned;
        measures.time = end;
        measures.count(&sim);
        work.end(&sim, measures);
        if let Err(e) = advanced {
            if sim.work() > work.allowed() {
                let text = format!(
                    "{} steps tried in {:.3} turns, {} live nodes, {:.3} m of wire fed",
                    measures.attempts(),
                    measures.turns,
                    sim.system().state.rod.nodes(),
                    sim.outputs().fed_length
                );
                return Broken::new(Invariant::Steps, text).at(e.time);
            }
            return gave_up(&e, Some(&sim));
        }
        // parted wire stays as it is while core and nozzle go on, and nothing balances from there: the run is judged up to
        // the look before
        let ends = |event: &Event| {
            use EventKind::{Break, Collision, Runaway};
            matches!(event.kind, Break | Collision | Runaway)
        };
        if let Some(event) = sim.drain_events().into_iter().find(ends) {
            let Event { time, text, .. } = event;
            return match event.kind {
                EventKind::Break => Outcome::Broke { time, text },
                _ => Outcome::Ended { time, text },
            };
        }
        if let Err(broken) = watch.look(&sim, measures) {
            return broken.at(end);
        }
    }
    Outcome::Completed
}

fn gave_up(error: &SimError, sim: Option<&Simulation>) -> Outcome {
    let place = sim.zip(error.node).map(|(sim, node)| {
        let sys = sim.system();
        sys.state.arc0 + sys.state.rod.rest.iter().take(node).sum::<f64>()
    });
    Outcome::GaveUp {
        time: error.time,
        place,
        reason: error.reason.clone(),
    }
}

impl Measures {
    /// Counts what the solver has done so far.
    fn count(&mut self, sim: &Simulation) {
        let statistics = sim.statistics();
        self.steps = statistics.steps;
        self.rejects = statistics.rejects;
        self.newton_failures = statistics.newton_failures;
        self.evaluations = statistics.evaluations;
        self.looks += 1;
        self.defects = sim.outputs().defect_code;
        self.fed = sim.outputs().fed_length.abs().max(self.fed);
        self.nodes = self.nodes.max(sim.system().state.rod.nodes());
    }
}
