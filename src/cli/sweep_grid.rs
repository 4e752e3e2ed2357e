//! The runs of a sweep: every combination of the values, every member of the ensemble.

use super::failure::Failure;
use super::members;
use super::sweep_range::Range;
use coilwind::scene::Warning;
use coilwind::settings::SceneSettings;
use coilwind::variables::{Kind, by_name};

/// Most runs of a sweep: years of computing.
const MOST_RUNS: u64 = 1_000_000;

/// Points of the grid and members at each, and the scene that they vary.
pub(super) struct Grid {
    pub(super) ranges: Vec<Range>,
    pub(super) members: u32,
    base: SceneSettings,
    points: usize,
}

impl Grid {
    /// Checks every run before the first is wound.
    ///
    /// # Errors
    /// A range of what is no number, the same variable twice, too many runs, or a run whose scene is impossible.
    pub(super) fn new(
        base: SceneSettings,
        ranges: Vec<Range>,
        members: u32,
    ) -> Result<Self, Failure> {
        for (index, range) in ranges.iter().enumerate() {
            let name = &range.name;
            if by_name(name).is_some_and(|v| !matches!(v.kind, Kind::Real | Kind::Integer)) {
                return Err(Failure::sweep(format!(
                    "--over {range}: {name} is no number; allowed: variables that are numbers"
                )));
            }
            let variable = range.variable();
            let same = |other: &&Range| other.variable() == variable;
            if let Some(other) = ranges[..index].iter().find(same) {
                return Err(Failure::sweep(format!(
                    "--over {range}: {variable} has a range already, --over {other}; allowed: one range for each variable"
                )));
            }
        }
        let points = ranges
            .iter()
            .try_fold(1_u64, |n, r| n.checked_mul(u64::from(r.count)));
        let runs = points.and_then(|n| n.checked_mul(u64::from(members)));
        let points = match (points, runs) {
            (Some(points), Some(runs)) if runs <= MOST_RUNS => points as usize,
            _ => {
                return Err(Failure::sweep(format!(
                    "the sweep has more than {MOST_RUNS} runs; allowed: fewer values in --over, or a smaller --ensemble"
                )));
            }
        };
        let grid = Self {
            ranges,
            members,
            base,
            points,
        };
        for run in 0..grid.runs() {
            grid.settings(run)?.build_with_warnings()?;
        }
        Ok(grid)
    }

    /// What the scene of the last run warns of that the base does not.
    pub(super) fn warnings(&self, known: &[Warning]) -> Result<Vec<Warning>, Failure> {
        let (_, mut warnings) = self.settings(self.runs() - 1)?.build_with_warnings()?;
        warnings.retain(|warning| !known.iter().any(|other| other.key == warning.key));
        Ok(warnings)
    }

    /// What would let turns come to rest beside each other.
    pub(super) fn remedy(&self) -> &'static str {
        let ends = [0, self.runs() - 1].map(|run| self.settings(run));
        let mut ends = ends.iter().flatten();
        match self.base.freeze.enabled {
            false => "leave freeze.enabled = false out, with which none comes to rest",
            true if ends.all(|settings| settings.winding.turns_per_layer == 1.0) => {
                "give winding.turns_per_layer more than 1, since a turn alone in its layer lies beside none"
            }
            true => "wind more turns with --set spindle.turns=N",
        }
    }

    pub(super) fn points(&self) -> usize {
        self.points
    }

    pub(super) fn runs(&self) -> usize {
        self.points * self.members as usize
    }

    /// The numbers of the runs at a point.
    pub(super) fn runs_at(&self, point: usize) -> std::ops::Range<usize> {
        let members = self.members as usize;
        point * members..(point + 1) * members
    }

    /// Which member of its ensemble a run is, from 1.
    pub(super) fn member(&self, run: usize) -> u32 {
        (run % self.members as usize) as u32 + 1
    }

    /// Values of the swept variables at the point of a run, as texts; the last variable changes fastest.
    pub(super) fn values(&self, run: usize) -> Vec<String> {
        let mut rest = run / self.members as usize;
        let mut values: Vec<String> = self
            .ranges
            .iter()
            .rev()
            .map(|range| {
                let index = rest % range.count as usize;
                rest /= range.count as usize;
                range.value(index as u32).to_string()
            })
            .collect();
        values.reverse();
        values
    }

    /// The settings of a run.
    ///
    /// # Errors
    /// A variable that there is not, or a value that it cannot have.
    pub(super) fn settings(&self, run: usize) -> Result<SceneSettings, Failure> {
        let mut settings = self.base.clone();
        for (range, value) in self.ranges.iter().zip(self.values(run)) {
            settings.set_text(&range.name, &value)?;
        }
        members::vary(&mut settings, self.member(run), self.members)?;
        Ok(settings)
    }

    /// The scene that the sweep varies.
    pub(super) fn base(&self) -> &SceneSettings {
        &self.base
    }

    /// A point in words: `spindle.speed=300 tensioner.tension=15`.
    pub(super) fn name(&self, point: usize) -> String {
        let values = self.values(point * self.members as usize);
        let pairs = self.ranges.iter().zip(values);
        let pairs: Vec<String> = pairs.map(|(r, v)| format!("{}={v}", r.name)).collect();
        pairs.join(" ")
    }
}
