//! Which limit a station is judged by, and the runs of stations beyond it.

use super::STATIONS_PER_TURN;
use super::coil::{Coil, Record};
use super::crossover::OVER;
use super::defect::{DefectKind, FALLBACK_BULGE, MEASURED};
use super::runs::{Run, SHORT_RUN, stations_for};
use super::station::{Neighbour, Station};
use super::support::Support;

/// Rise over wire of its own row from which on wire stands on it, diameters: half of a wire on a wire. In the groove of
/// touching wires it is 0.866, beside them 0.
const STANDS: f64 = 0.5;

/// The same from which on wire lies more on the turn before than beside it, diameters: it touches it at 45 degrees.
const MORE_ON_THAN_BESIDE: f64 = std::f64::consts::FRAC_1_SQRT_2;

impl Coil {
    /// The last station up to the next one at which wire crosses, when the next one lies at `y`, m.
    pub(crate) fn last_crossing(&self, y: f64) -> Option<usize> {
        let crossover = self.spec.crossover?;
        let index = self.records.len();
        let before = index.checked_sub(OVER).map(|k| &self.records[k]);
        if before.is_some_and(|before| (y - before.station.position.y).abs() > crossover.steep()) {
            return Some(index);
        }
        self.records.last().and_then(|last| last.last_crossing)
    }

    /// Whether the next station lies in a crossover of its own turn or the one before, or beside it: wire that is drawn beyond its
    /// place comes back within as much again.
    ///
    /// `last_crossing` is that of the next station. How soon its own turn crosses is not known yet; as a rule it does so where the
    /// turn before has.
    pub(crate) fn is_in_crossover(&self, last_crossing: Option<usize>) -> bool {
        let Some(crossover) = self.spec.crossover else {
            return false;
        };
        let index = self.records.len();
        let half = crossover.beside();
        let near = |last: Option<usize>, at: usize| last.is_some_and(|last| last + 2 * half >= at);
        let turn_before = || {
            let ahead = (index + half).checked_sub(STATIONS_PER_TURN)?;
            let record = &self.records[ahead.min(index.checked_sub(1)?)];
            Some((record.last_crossing, index.checked_sub(STATIONS_PER_TURN)?))
        };
        near(last_crossing, index) || turn_before().is_some_and(|(last, from)| near(last, from))
    }

    /// Whether the scene plans crossovers, with grooves between them.
    pub(crate) fn has_crossovers(&self) -> bool {
        self.spec.crossover.is_some()
    }

    /// Whether wire of a pass is meant to lie in grooves of the layer below. A single turn has none.
    pub(crate) fn has_grooves_below(&self, pass: u32) -> bool {
        self.has_crossovers() && !self.passes.lies_on_single_turn(pass)
    }

    /// Whether there is more room beside a turn than a crossover leaves.
    pub(crate) fn is_hole(&self, neighbour: Option<Neighbour>) -> bool {
        let crossover = self.spec.crossover.zip(neighbour);
        crossover.is_some_and(|(crossover, neighbour)| neighbour.gap > crossover.hole())
    }

    /// Whether the station at `index` is part of a double turn.
    pub(crate) fn is_double(&self, index: usize) -> bool {
        let kind = DefectKind::DoubleTurn;
        let runs = (index..self.records.len()).map(|k| self.records[k].runs[kind as usize]);
        let least = stations_for(self.spec.limits.double_turn);
        runs.take_while(|run| *run != Run::default())
            .any(|run| run.counts(least))
    }

    /// Whether wire at `height` over the core, m, stands higher than `at_rest` over what it was laid on, or on the turn before, its
    /// `neighbour`, where that is no climb that it crosses. A loop at rest stands higher than wound wire, and says nothing of the turn
    /// before. Wire that touches nothing and hangs more beside the turn before than over it bulges.
    pub(crate) fn has_ridden_up(
        &self,
        (height, neighbour): (f64, Option<Neighbour>),
        at_rest: Option<f64>,
        support: &Support,
    ) -> bool {
        let (d, limits) = (self.spec.diameter, &self.spec.limits);
        let stands_off = height - support.level.max(at_rest.unwrap_or(0.0));
        let touches = |neighbour: Neighbour| neighbour.gap <= limits.loose_height * d;
        let hangs_beside =
            neighbour.is_some_and(|turn| !touches(turn) && turn.axial >= MORE_ON_THAN_BESIDE * d);
        let stands = support
            .own_row
            .is_some_and(|rise| rise > MORE_ON_THAN_BESIDE * d);
        stands_off > limits.overlap_height * d && !hangs_beside
            || stands && neighbour.is_some_and(touches) && !support.on_climb
    }

    /// Diameter minus axial distance where the wire has ridden up on its neighbour, else 0, m; a diameter where it has changed
    /// places with it.
    pub(crate) fn overlap_depth(&self, station: &Station, has_ridden_up: bool) -> f64 {
        let (d, limits) = (self.spec.diameter, &self.spec.limits);
        let Some(Neighbour { axial, .. }) = station.neighbour else {
            return 0.0;
        };
        let stands_on = axial < limits.overlap_axial * d && has_ridden_up;
        if stands_on || axial < 0.0 {
            (d - axial).min(d)
        } else {
            0.0
        }
    }

    /// The record of a station, with the runs and sums carried on from the one before.
    pub(crate) fn judge(&self, mut record: Record) -> Record {
        let mut runs_before = [Run::default(); MEASURED];
        let mut goes_on = false;
        if let Some(last) = self.records.last() {
            goes_on = !record.station.measured && last.row.number == record.row.number;
            runs_before = last.runs;
            record.raised = last.raised;
            record.last_defect = last.last_defect;
            record.axial_sum = last.axial_sum;
            record.axial_count = last.axial_count;
        }
        for kind in DefectKind::MEASURED {
            let (value, limit, least) = self.criterion(kind, &record);
            let k = kind as usize;
            // beside the clamp, or where wire may climb, nothing is judged; a run goes on behind that, in the same row
            let goes_on = goes_on || !self.is_free_of_clamp(record.station.angle);
            record.runs[k] = match value {
                None if goes_on => runs_before[k],
                _ => runs_before[k].next(value, limit),
            };
            if record.runs[k].counts(least) && !runs_before[k].counts(least) {
                record.raised[k] += 1;
                record.last_defect = Some(self.records.len());
            }
        }
        if let (true, Some(neighbour)) = (record.station.measured, record.station.neighbour) {
            record.axial_sum += neighbour.axial;
            record.axial_count += 1;
        }
        record
    }

    /// Value of a defect at a station (`None`: nothing to judge), its limit, and the least length of a run, in stations.
    /// Value and limit are in m, but in turns for jumps, a share for loose turns, and strain for stretch.
    pub(crate) fn criterion(&self, kind: DefectKind, record: &Record) -> (Option<f64>, f64, u32) {
        let (d, limits) = (self.spec.diameter, &self.spec.limits);
        let (station, signs) = (&record.station, &record.signs);
        let measured = |value: Option<f64>| value.filter(|_| station.measured);
        let (value, limit, least) = match kind {
            DefectKind::Bulge if limits.bulge_absolute > 0.0 => (
                measured(Some(station.bulge)),
                limits.bulge_absolute,
                SHORT_RUN,
            ),
            DefectKind::Bulge if self.spec.profile.is_none() => {
                (measured(Some(station.bulge)), FALLBACK_BULGE * d, SHORT_RUN)
            }
            DefectKind::Bulge => (
                measured(station.bulge_excess),
                limits.bulge_excess * d,
                SHORT_RUN,
            ),
            DefectKind::Gap => (
                measured(self.gap_at(record).filter(|_| !station.crosses)),
                limits.gap * d,
                limits.gap_fraction,
            ),
            DefectKind::Overlap => (
                measured(Some(station.overlap_depth)),
                (1.0 - limits.overlap_axial) * d,
                SHORT_RUN,
            ),
            // Wire that climbs at the end of a pass, as meant, begins its own row before it stands on half a turn of this one.
            DefectKind::DoubleTurn => (
                signs.rise.filter(|_| self.is_free_of_clamp(station.angle)),
                STANDS * d,
                limits.double_turn,
            ),
            DefectKind::SkippedGroove => (measured(signs.empty_groove), 0.0, limits.skipped_groove),
            DefectKind::EarlyJump => (signs.early, limits.jump, SHORT_RUN),
            DefectKind::LateJump => (signs.late, limits.jump, SHORT_RUN),
            DefectKind::LooseTurn => (signs.loose, 1.0, SHORT_RUN),
            DefectKind::Overstretch => (
                Some(signs.strain).filter(|_| self.is_free_of_clamp(station.angle)),
                limits.stretch,
                SHORT_RUN,
            ),
            DefectKind::Slack | DefectKind::Collision | DefectKind::Runaway | DefectKind::Break => {
                (None, f64::INFINITY, 0.0)
            }
        };
        (value, limit, stations_for(least))
    }
}
