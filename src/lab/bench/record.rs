//! The line that a benchmark prints.

use super::problem::{Method, Problem};
use super::watch::Spent;
use serde::Serialize;

/// What one run came to.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// edges
    pub n: Option<usize>,
    /// step that was held, s
    pub dt: Option<f64>,
    /// tolerance of the implicit method, m
    pub tol: Option<f64>,
    /// distance from the reference in the problem's own measure; `None` without one
    pub error: Option<f64>,
    /// how long it took
    pub spent: Spent,
    /// accepted steps
    pub steps: u64,
    /// factorisations, or evaluations of an explicit method
    pub iterations: u64,
    /// why it did not get to its end, if so
    pub failure: Option<String>,
    /// what only some problems tell
    pub details: Details,
}

/// What only some problems tell.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Details {
    /// P1: load P L^2/EI
    #[serde(skip_serializing_if = "Option::is_none")]
    pub a: Option<f64>,
    /// P2: share of the amplitude lost over the ten periods
    #[serde(skip_serializing_if = "Option::is_none")]
    pub amplitude_loss: Option<f64>,
    /// P3: ratio of the end forces while the wire slips
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ratio: Option<f64>,
    /// P3: error against the ratio that knows the bending stiffness left, relative
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stiff_error: Option<f64>,
    /// P4: wire drawn in, m
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fed_length_m: Option<f64>,
    /// P5: CPU time per node and step, ns
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ns_per_node_step: Option<f64>,
    /// P5: CPU time per node and iteration, ns
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ns_per_node_iteration: Option<f64>,
    /// scene
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scene: Option<String>,
    /// spindle speed, rad/s
    #[serde(skip_serializing_if = "Option::is_none")]
    pub omega: Option<f64>,
    /// what only a whole scene tells; null where there is nothing to compare with
    #[serde(flatten)]
    pub winding: Option<WindingDetails>,
}

/// What only a whole scene tells.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct WindingDetails {
    /// turns laid from the clamp
    pub turns: f64,
    /// simulated over CPU time: above 1 is faster than the machine
    pub rtf: f64,
    /// live nodes, mean over time
    pub nodes_mean: f64,
    /// root mean square over the stations of turn 2, m
    pub bulge_error_m: Option<f64>,
    /// root mean square over the stations of turn 2 that have a neighbour, m
    pub gap_error_m: Option<f64>,
    /// largest deviation of a turn's tension extremes, N
    #[serde(rename = "tension_error_N")]
    pub tension_error: Option<f64>,
    /// largest CPU time over a millisecond of simulated time, s
    pub worst_ms_cpu_s: f64,
    /// simulated time with the ramp, s
    pub simulated_s: f64,
    /// steps thrown away
    pub rejects: u64,
}

/// The line.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Record {
    /// always `coilwind`
    pub peer: &'static str,
    /// which problem
    pub problem: Problem,
    /// which method
    pub integrator: Method,
    /// edges
    pub n: Option<usize>,
    /// step that was held, s
    pub dt: Option<f64>,
    /// tolerance of the implicit method, m
    pub tol: Option<f64>,
    /// distance from the reference in the problem's own measure
    pub error: Option<f64>,
    /// CPU time, s: median of the runs
    pub cpu_s: f64,
    /// wall time, s: median of the runs
    pub wall_s: f64,
    /// accepted steps
    pub steps: u64,
    /// factorisations, or evaluations of an explicit method
    pub iterations: u64,
    /// whether the computation got to its end with a finite error
    pub ok: bool,
    /// why it did not
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// what only some problems tell
    #[serde(flatten)]
    pub details: Details,
}

impl Record {
    /// The line of some runs of the same thing; they differ in their times only.
    pub(super) fn of(problem: Problem, method: Method, outcomes: Vec<Outcome>) -> Self {
        let median_of = |time: fn(&Spent) -> f64| {
            let times = outcomes.iter().map(|o| time(&o.spent)).collect();
            median(times)
        };
        let (cpu_s, wall_s) = (median_of(|s| s.cpu), median_of(|s| s.wall));
        let factor = |own: f64| if own > 0.0 { cpu_s / own } else { 1.0 };
        let last = outcomes.into_iter().next_back().unwrap_or_default();
        // rates follow the median, not the last run
        let share = factor(last.spent.cpu);
        let mut details = last.details;
        for rate in [
            &mut details.ns_per_node_step,
            &mut details.ns_per_node_iteration,
        ] {
            *rate = rate.map(|r| r * share);
        }
        if let Some(w) = &mut details.winding {
            w.rtf /= share;
        }
        Self {
            peer: "coilwind",
            problem,
            integrator: method,
            n: last.n,
            dt: last.dt,
            tol: last.tol,
            error: last.error.filter(|e| e.is_finite()),
            cpu_s,
            wall_s,
            steps: last.steps,
            iterations: last.iterations,
            ok: last.failure.is_none() && last.error.is_none_or(f64::is_finite),
            reason: last.failure,
            details,
        }
    }

    /// As JSON, without a line break.
    pub fn line(&self) -> String {
        // fields are numbers, texts and options of them: nothing that JSON could refuse
        serde_json::to_string(self).unwrap_or_default()
    }
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    let n = times.len();
    match n {
        0 => 0.0,
        _ => 0.5 * (times[(n - 1) / 2] + times[n / 2]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_medians_and_rates_follow() {
        let outcome = |cpu: f64| Outcome {
            spent: Spent { cpu, wall: cpu },
            details: Details {
                ns_per_node_step: Some(1e9 * cpu),
                ..Details::default()
            },
            ..Outcome::default()
        };
        let outcomes = vec![outcome(3.0), outcome(1.0), outcome(2.0), outcome(5.0)];
        let record = Record::of(Problem::P5, Method::Implicit, outcomes);
        assert_eq!(record.cpu_s, 2.5);
        assert!((record.details.ns_per_node_step.unwrap() - 2.5e9).abs() < 1.0);
        assert!(record.ok);
        let line: serde_json::Value = serde_json::from_str(&record.line()).unwrap();
        assert_eq!(line["peer"], "coilwind");
        assert_eq!(line["problem"], "P5");
        assert!(line["error"].is_null() && line.get("reason").is_none());
    }
}
