//! How near cases came to each limit: the worst of them by number, and how many are beyond a mark.

use super::{Case, Measures, Verdict};

/// Cases listed of each measure.
const LISTED: usize = 5;

/// A measure of which large is bad.
struct Row {
    name: &'static str,
    of: fn(&Measures) -> f64,
    /// beyond it a case is counted
    mark: f64,
    /// whether a case beyond it breaks an invariant
    limit: bool,
    /// in percent, or as a bare number
    percent: bool,
}

const ROWS: &[Row] = &[
    row(
        "unexplained energy, of what went through",
        |m| m.energy,
        0.05,
        true,
        true,
    ),
    row(
        "numerical energy, of what was dissipated",
        |m| m.numerical.abs(),
        0.05,
        false,
        true,
    ),
    row(
        "remeshing energy, of what was dissipated",
        |m| m.remeshing.abs(),
        0.05,
        false,
        true,
    ),
    row(
        "energy that blows or friction gave, of what was dissipated",
        |m| m.given,
        1e-3,
        true,
        false,
    ),
    row(
        "numerical energy, of what is allowed",
        |m| m.own[0],
        1.0,
        true,
        false,
    ),
    row(
        "remeshing energy, of what is allowed",
        |m| m.own[1],
        1.0,
        true,
        false,
    ),
    row("deepest touch, d", |m| m.depth, 0.5, true, false),
    row("centreline in the core, d", |m| m.sunk, 0.3, true, false),
    row("wire in wire, d", |m| m.crossed, 0.5, true, false),
    row("friction over its limit", |m| m.cone, 1.01, true, false),
    row("plastic work not booked", |m| m.plastic, 1e-6, false, false),
    row(
        "compression at the nozzle, of the pull",
        |m| m.pushed,
        1e-3,
        true,
        false,
    ),
    row(
        "steps tried, of those that are enough",
        |m| m.work,
        1.0,
        true,
        false,
    ),
];

const fn row(
    name: &'static str,
    of: fn(&Measures) -> f64,
    mark: f64,
    limit: bool,
    percent: bool,
) -> Row {
    Row {
        name,
        of,
        mark,
        limit,
        percent,
    }
}

/// The worst cases of each measure so far.
#[derive(Clone, Debug, PartialEq)]
pub struct Worst {
    /// value and number of the worst, worst first
    of: Vec<Vec<(f64, u64)>>,
    beyond: Vec<u64>,
    numbers: Vec<Vec<u64>>,
}

impl Worst {
    /// Nothing yet.
    pub fn new() -> Self {
        Self {
            of: vec![Vec::new(); ROWS.len()],
            beyond: vec![0; ROWS.len()],
            numbers: vec![Vec::new(); ROWS.len()],
        }
    }

    /// Takes a case in.
    pub fn add(&mut self, case: &Case, verdict: &Verdict) {
        for (k, row) in ROWS.iter().enumerate() {
            let value = (row.of)(&verdict.measures);
            if value > row.mark {
                self.beyond[k] += 1;
                self.numbers[k].push(case.number);
            }
            let at = self.of[k].partition_point(|(other, _)| *other >= value);
            self.of[k].insert(at, (value, case.number));
            self.of[k].truncate(LISTED);
        }
    }

    /// Markdown: a row a measure.
    pub fn table(&self) -> String {
        let mut text =
            "| measure | mark | beyond it | worst (scene) |\n|---|---:|---:|---|\n".to_owned();
        for (k, row) in ROWS.iter().enumerate() {
            let shown = |x: f64| match row.percent {
                true => format!("{:.2} %", 100.0 * x),
                false => format!("{x:.3}"),
            };
            let worst: Vec<String> = self.of[k]
                .iter()
                .map(|(value, number)| format!("{} ({number})", shown(*value)))
                .collect();
            let kind = if row.limit { "" } else { ", reported" };
            text += &format!(
                "| {}{kind} | {} | {} | {} |\n",
                row.name,
                if row.mark < 1e-3 {
                    format!("{:e}", row.mark)
                } else {
                    shown(row.mark)
                },
                self.beyond[k],
                worst.join(", ")
            );
        }
        text
    }

    /// Numbers of the cases beyond marks that break no invariant, Markdown.
    pub fn beyond(&self) -> String {
        let mut text = String::new();
        for (k, row) in ROWS.iter().enumerate().filter(|(_, row)| !row.limit) {
            let numbers: Vec<String> = self.numbers[k].iter().map(u64::to_string).collect();
            let all = if numbers.is_empty() {
                "none".to_owned()
            } else {
                numbers.join(", ")
            };
            let count = numbers.len();
            text += &format!(
                "\n**{}**, {count} scenes:\n\n```text\n{all}\n```\n",
                row.name
            );
        }
        text
    }
}

impl Default for Worst {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::stress::{Outcome, draw};

    #[test]
    fn the_worst_come_first_with_their_numbers() {
        let mut worst = Worst::new();
        for number in 0..9 {
            let case = draw::case(1, number).unwrap();
            let measures = Measures {
                remeshing: -0.01 * number as f64,
                ..Measures::default()
            };
            let outcome = Outcome::Completed;
            worst.add(&case, &Verdict { outcome, measures });
        }
        let table = worst.table();
        let line = table.lines().find(|l| l.contains("remeshing")).unwrap();
        assert!(
            line.contains("| 3 | 8.00 % (8), 7.00 % (7), 6.00 % (6), 5.00 % (5)"),
            "{line}"
        );
        assert!(
            worst
                .beyond()
                .contains("3 scenes:\n\n```text\n6, 7, 8\n```")
        );
    }
}
