//! Which stations a defect covers: for lists of defects, for what is told of them, and for pictures of the coil.

use super::coil::Coil;
use super::defect::DefectKind;
use super::runs::Run;

/// Stations in a row of which a defect is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct CountedRun {
    pub(crate) kind: DefectKind,
    /// first and last station
    pub(crate) first: usize,
    pub(crate) last: usize,
    /// the station from which on the run is long enough to count
    pub(crate) counts_at: usize,
}

impl Coil {
    /// Kinds of defect at each station, in the order of [`Self::stations`], as a sum of [`DefectKind::code`]: every
    /// station of a run that is long enough to count (linear in the wire).
    pub fn defect_marks(&self) -> Vec<u16> {
        let mut marks = vec![0; self.records.len()];
        for kind in DefectKind::MEASURED {
            self.mark(kind, &mut marks);
        }
        marks
    }

    /// Adds the code of a kind at each station of its runs that are long enough to count.
    pub(crate) fn mark(&self, kind: DefectKind, marks: &mut [u16]) {
        let code = kind.code() as u16;
        for run in self.counted_runs(kind, 0) {
            marks[run.first..=run.last]
                .iter_mut()
                .for_each(|m| *m |= code);
        }
    }

    /// True where a defect of this kind, which once counted from the station `at` on, is not in the settled wire there. Wire that
    /// is not settled, and a run that may still grow long enough to count, leave that open.
    pub(crate) fn has_come_to_nothing(&self, kind: DefectKind, at: usize) -> bool {
        for index in at..self.records.len() {
            let run = self.records[index].runs[kind as usize];
            let (_, _, least) = self.criterion(kind, &self.records[index]);
            if run == Run::default() {
                return true;
            }
            if run.counts(least) {
                return false;
            }
        }
        false
    }

    /// True where no defect of this kind counts, by now, in the settled wire of the station `at`, though the run may still grow. Wire
    /// that is not settled leaves that open.
    pub(crate) fn counts_no_more(&self, kind: DefectKind, at: usize) -> bool {
        let runs = self.counted_runs(kind, at);
        let there = |run: &CountedRun| (run.first..=run.last).contains(&at);
        at < self.records.len() && !runs.iter().any(there)
    }

    /// Runs of a kind that are long enough to count and reach the station `from` or beyond, along the wire.
    pub(crate) fn counted_runs(&self, kind: DefectKind, from: usize) -> Vec<CountedRun> {
        let run_at = |index: usize| self.records[index].runs[kind as usize];
        let goes_on = |index: &usize| run_at(*index) != Run::default();
        let before = (0..from.min(self.records.len())).rev();
        let begin = from - before.take_while(goes_on).count();
        let mut found = Vec::new();
        let (mut first, mut counts_at) = (begin, None);
        for index in begin..self.records.len() {
            let run = run_at(index);
            if run == Run::default() {
                (first, counts_at) = (index + 1, None);
                continue;
            }
            let (_, _, least) = self.criterion(kind, &self.records[index]);
            if counts_at.is_none() && run.counts(least) {
                counts_at = Some(index);
            }
            let ends = index + 1 == self.records.len() || !goes_on(&(index + 1));
            found.extend(counts_at.filter(|_| ends).map(|counts_at| CountedRun {
                kind,
                first,
                last: index,
                counts_at,
            }));
        }
        found
    }
}
