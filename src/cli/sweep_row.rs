//! What a run of a sweep leaves in `sweep.csv`: the values that were swept, then this.

use coilwind::measure::{UNJUDGED, Verdict};
use coilwind::simulation::SimError;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Rows by the number of their run.
pub(super) type Rows = BTreeMap<usize, Row>;

/// Columns after those of the swept variables, in the order of the fields.
pub(super) const COLUMNS: [&str; 24] = [
    "member",
    "verdict",
    "defect",
    "outcome",
    "reason",
    "gap_mean_d",
    "bulge_excess_d",
    "defects_bulge",
    "defects_gap",
    "defects_overlap",
    "defects_break",
    "defects_slack",
    "defects_double_turn",
    "defects_skipped_groove",
    "defects_early_jump",
    "defects_late_jump",
    "defects_loose_turn",
    "defects_overstretch",
    "defects_collision",
    "defects_runaway",
    "tension_min_N",
    "tension_max_N",
    "turns_settled",
    "cpu_s",
];

/// What came of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Row {
    /// of the ensemble, from 1
    pub(super) member: u32,
    pub(super) verdict: String,
    /// there is a defect, or the verdict names one
    pub(super) defect: bool,
    /// `done` or `failed`
    pub(super) outcome: String,
    /// why it failed
    pub(super) reason: String,
    /// largest mean gap of a turn over the wire's diameter
    pub(super) gap_mean_d: Option<f64>,
    /// largest bulge over what wire at rest has, over the wire's diameter
    pub(super) bulge_excess_d: Option<f64>,
    pub(super) defects_bulge: usize,
    pub(super) defects_gap: usize,
    pub(super) defects_overlap: usize,
    pub(super) defects_break: usize,
    pub(super) defects_slack: usize,
    pub(super) defects_double_turn: usize,
    pub(super) defects_skipped_groove: usize,
    pub(super) defects_early_jump: usize,
    pub(super) defects_late_jump: usize,
    pub(super) defects_loose_turn: usize,
    pub(super) defects_overstretch: usize,
    pub(super) defects_collision: usize,
    pub(super) defects_runaway: usize,
    /// least tension at the nozzle, N
    #[serde(rename = "tension_min_N")]
    pub(super) tension_min: Option<f64>,
    /// largest tension at the nozzle, N
    #[serde(rename = "tension_max_N")]
    pub(super) tension_max: Option<f64>,
    pub(super) turns_settled: f64,
    /// processor time, s; the only column that depends on the machine
    pub(super) cpu_s: f64,
}

impl Row {
    /// A run that could not start.
    pub(super) fn failed_to_start(member: u32, reason: &SimError) -> Self {
        Self {
            member,
            verdict: UNJUDGED.to_owned(),
            defect: false,
            outcome: "failed".to_owned(),
            reason: reason.to_string(),
            gap_mean_d: None,
            bulge_excess_d: None,
            defects_bulge: 0,
            defects_gap: 0,
            defects_overlap: 0,
            defects_break: 0,
            defects_slack: 0,
            defects_double_turn: 0,
            defects_skipped_groove: 0,
            defects_early_jump: 0,
            defects_late_jump: 0,
            defects_loose_turn: 0,
            defects_overstretch: 0,
            defects_collision: 0,
            defects_runaway: 0,
            tension_min: None,
            tension_max: None,
            turns_settled: 0.0,
            cpu_s: 0.0,
        }
    }

    /// The solver gave up.
    pub(super) fn failed(&self) -> bool {
        self.outcome != "done"
    }

    /// It ended as planned, and no turn could be measured, or none against another.
    pub(super) fn is_unjudged(&self) -> bool {
        let without = [Verdict::Unsettled, Verdict::Single].map(Verdict::as_str);
        !self.failed() && without.contains(&self.verdict.as_str())
    }
}
