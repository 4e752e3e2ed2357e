//! What `--find-max` found, or why it found nothing: in words, and as `find_max.json`.

use super::failure::Failure;
use super::sweep_files;
use super::sweep_find_max::{Limit, Look};
use super::sweep_range::Range;
use coilwind::output::write_summary;
use serde::Serialize;
use std::path::Path;

/// What `--find-max` does not know, where so many of the values below the answer were wound.
fn on_trust(wound: usize, below: usize) -> String {
    format!(
        "of the {below} values below {wound} were wound; the others are taken to be free, and those above not; a sweep without --find-max shows whether they are"
    )
}

/// The same where the ends of the bracket are free of defects.
const FREE_ON_TRUST: &str = "values between them that were not wound are taken to be free; a sweep without --find-max shows whether they are";

/// What the search came to.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Outcome {
    /// there is a highest value without a defect
    Found,
    /// all that was wound has a defect
    NoneFree,
    /// nothing that was wound has a defect
    AllFree,
    /// the lowest value has a defect and a higher one has none
    Band,
    /// runs at a value cannot be judged
    Unjudged,
    /// the solver gave up runs at a value
    Failed,
}

/// The runs at a value, and what they say.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Seen {
    value: f64,
    runs: usize,
    #[serde(flatten)]
    look: Look,
}

impl Seen {
    pub(super) fn new(value: f64, runs: usize, look: Look) -> Self {
        Self { value, runs, look }
    }
}

/// `find_max.json`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Answer {
    variable: String,
    unit: &'static str,
    outcome: Outcome,
    /// the highest value without a defect, where there is an answer
    value: Option<f64>,
    /// the answer in words, or why there is none and what to do
    words: String,
    /// what an answer takes on trust
    pub(super) assumes: Option<String>,
    /// the lowest and the highest value that could be chosen
    bracket: [f64; 2],
    /// how many there are, evenly from end to end
    values: u32,
    /// the highest value that was wound and is free of defects
    highest_free: Option<f64>,
    /// the lowest value above it that was wound and has a defect
    lowest_defect: Option<f64>,
    /// runs at all values that were looked at
    runs: usize,
    /// the values in the order in which they were looked at
    looks: Vec<Seen>,
}

impl Answer {
    /// What follows from the limit among the values of a range, and from a look at the lowest; with the remedy where runs cannot be
    /// judged.
    pub(super) fn new(
        (range, remedy): (&Range, &str),
        limit: &Limit,
        lowest: Look,
        looks: Vec<Seen>,
    ) -> Self {
        let (name, value) = (&range.name, |index: usize| range.value(index as u32));
        let free = limit.free.checked_sub(1).map(value);
        let defect = (limit.end < range.count as usize).then(|| value(limit.end));
        let first = value(0);
        let open = match limit.unknown {
            Some((index, look)) => Some((value(index), look)),
            None => Some((first, lowest)),
        };
        let open =
            open.and_then(|(at, look)| open_question((name, remedy), at, look, free, defect));
        let (outcome, words) = match (open, free, defect) {
            (Some(open), ..) => open,
            (None, Some(free), _) if lowest == Look::Defect => (
                Outcome::Band,
                format!(
                    "{name} = {free} is free of defects and {first}, the lowest, is not: those without a defect are a band; a sweep without --find-max shows where it begins and ends"
                ),
            ),
            (None, None, _) => (
                Outcome::NoneFree,
                format!(
                    "no value of {name} is free of defects: {first}, the lowest, is not; try a lower bracket"
                ),
            ),
            (None, Some(free), None) => (
                Outcome::AllFree,
                format!(
                    "no highest value of {name} was found: {first} and {free}, the ends of the bracket, are free of defects; try a higher bracket"
                ),
            ),
            (None, Some(free), Some(defect)) => (
                Outcome::Found,
                format!(
                    "{name} = {free} is the highest value found without a defect; {defect} is not free of them"
                ),
            ),
        };
        let assumed = match outcome {
            Outcome::Found => {
                let below = |seen: &&Seen| free.is_some_and(|free| seen.value < free);
                Some(on_trust(looks.iter().filter(below).count(), limit.free - 1))
            }
            Outcome::AllFree if looks.len() < range.count as usize => {
                Some(FREE_ON_TRUST.to_owned())
            }
            _ => None,
        };
        Self {
            variable: name.clone(),
            unit: range.unit(),
            value: free.filter(|_| outcome == Outcome::Found),
            assumes: assumed,
            outcome,
            words,
            bracket: [range.from, range.to],
            values: range.count,
            highest_free: free,
            lowest_defect: defect,
            runs: looks.iter().map(|seen| seen.runs).sum(),
            looks,
        }
    }

    /// Leaves it in the folder of the sweep.
    pub(super) fn write(&self, directory: &Path) -> Result<(), Failure> {
        Ok(write_summary(&directory.join(sweep_files::ANSWER), self)?)
    }

    /// The answer in words.
    ///
    /// # Errors
    /// Where there is none: why, and what to do.
    pub(super) fn words(&self) -> Result<&str, Failure> {
        match self.outcome {
            Outcome::Found => Ok(&self.words),
            outcome => Err(Failure::NoMaximum {
                reason: match &self.assumes {
                    Some(trust) => format!("{}; {trust}", self.words),
                    None => self.words.clone(),
                },
                failed: outcome == Outcome::Failed,
            }),
        }
    }
}

/// Why a look ends the search without an answer, and what to do; `None` where the look says enough.
fn open_question(
    (name, remedy): (&str, &str),
    value: f64,
    look: Look,
    free: Option<f64>,
    defect: Option<f64>,
) -> Option<(Outcome, String)> {
    let Look::Unknown {
        unjudged,
        failed,
        of,
    } = look
    else {
        return None;
    };
    let (outcome, what) = match failed {
        0 => (
            Outcome::Unjudged,
            format!(
                "is not judged: in {unjudged} of {of} runs no turn came to rest beside another; {remedy}"
            ),
        ),
        _ => (
            Outcome::Failed,
            format!(
                "failed: the solver gave up {failed} of {of} runs, and column reason of sweep.csv says why; leave the value out with another bracket, or wind with a smaller solver.tolerance"
            ),
        ),
    };
    let up_to = free.map(|free| format!("{free} is free of defects"));
    let from = defect.map(|defect| format!("{defect} has some"));
    let known: Vec<String> = up_to.into_iter().chain(from).collect();
    let known = match known.is_empty() {
        true => "nothing is known of other values".to_owned(),
        false => known.join(" and "),
    };
    let words = format!("no highest value of {name} was found: {value} {what}; {known}");
    Some((outcome, words))
}
