//! Which stations a defect covers, for pictures of the coil.

use super::coil::Coil;
use super::defect::DefectKind;
use super::runs::Run;

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
        let (mut start, mut counts) = (0, false);
        for (index, record) in self.records.iter().enumerate() {
            let run = record.runs[kind as usize];
            if run == Run::default() {
                (start, counts) = (index + 1, false);
                continue;
            }
            let (_, _, least) = self.criterion(kind, record);
            if !counts && run.counts(least) {
                counts = true;
                marks[start..index].iter_mut().for_each(|m| *m |= code);
            }
            if counts {
                marks[index] |= code;
            }
        }
    }
}
