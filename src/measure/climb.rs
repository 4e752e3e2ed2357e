//! Slow climbs to the next row, which begin before they are certain, and climbs that were none.
//!
//! Wire beside a flange may stand on the turn before for a while and come down to its row again: it is pressed up there. Once it
//! has left its row for certain, it has been on its way since it came to stand there.

use super::coil::Coil;
use super::onset::{Onset, OnsetKind};

impl Coil {
    /// Whether a step begins with the next station, as is known from wire that was laid after it.
    pub(super) fn steps_up_next(&self) -> bool {
        let last = self.onsets.last();
        last.is_some_and(|onset| {
            onset.kind == OnsetKind::Step && onset.station == self.records.len()
        })
    }

    /// Whether the next station is known to lie where wire was pressed up beside a flange and came down again.
    pub(super) fn is_pressed_up_next(&self) -> bool {
        let last = self.onsets.last();
        last.is_some_and(|onset| {
            let stretch = onset.station..onset.certain;
            onset.kind == OnsetKind::PressedUp && stretch.contains(&self.records.len())
        })
    }

    /// Whether the station at `index` lies where the last row had begun and was not certain yet.
    pub(super) fn is_slow_climb(&self, index: usize) -> bool {
        let last = self.onsets.last();
        last.is_some_and(|onset| {
            let stretch = onset.station..onset.certain;
            onset.kind == OnsetKind::Step && stretch.contains(&index)
        })
    }

    /// Where the last station begins a row: begins that where the wire set out for it, and measures wire from there on again. False
    /// where that is no earlier.
    pub(super) fn date_step_back(&mut self) -> bool {
        let certain = self.records.len() - 1;
        let Some(before) = certain.checked_sub(1).map(|before| &self.records[before]) else {
            return false;
        };
        let row = before.row.number;
        let is_step = self.records[certain].row.number > row;
        let known = self.onsets.last().map_or(0, |onset| onset.certain + 1);
        let back = (known..certain).rev().map(|index| &self.records[index]);
        let on_its_way = back.take_while(|record| record.rises && record.row.number == row);
        let station = certain - on_its_way.count();
        if !is_step || station == certain {
            return false;
        }
        self.measure_knowing(Onset {
            kind: OnsetKind::Step,
            station,
            certain,
        });
        true
    }

    /// Where the last station comes down to a row that wire had left beside a flange: measures wire from where it left that row on again,
    /// as wire that never did. False where it does not come down.
    pub(super) fn take_step_back(&mut self) -> bool {
        let certain = self.records.len() - 1;
        let Some(before) = certain
            .checked_sub(1)
            .map(|before| self.records[before].row)
        else {
            return false;
        };
        if self.records[certain].row.number >= before.number {
            return false;
        }
        let back = (0..certain).rev().map(|index| self.records[index].row);
        let away = back.take_while(|row| row.number == before.number).count();
        self.measure_knowing(Onset {
            kind: OnsetKind::PressedUp,
            station: certain - away,
            certain,
        });
        true
    }

    /// Measures wire from the first station of a stretch on again, with what it was about.
    fn measure_knowing(&mut self, onset: Onset) {
        let nodes = self.take_from(self.node_of(onset.station));
        self.onsets.push(onset);
        for node in nodes {
            self.settle(node);
        }
    }

    /// Forgets steps that stations still there do not make certain. Returns the first node that has to be measured again without them.
    pub(super) fn forget_steps(&mut self) -> Option<usize> {
        let stations = self.records.len();
        let certain = |onset: &Onset| onset.certain < stations;
        let keep = self.onsets.partition_point(certain);
        let gone = self.onsets.split_off(keep);
        let first = gone.first().filter(|onset| onset.station < stations)?;
        Some(self.node_of(first.station))
    }

    /// First station of the last step that was dated back; none before it.
    pub(crate) fn last_step(&self) -> Option<usize> {
        self.onsets.last().map(|onset| onset.station)
    }

    /// The node with which a station was measured.
    fn node_of(&self, station: usize) -> usize {
        let back = self.nodes.iter().rev();
        let after = back.take_while(|node| node.stations_before > station);
        self.nodes.len() - 1 - after.count()
    }
}
