//! Measures and verdict of each turn.

use super::coil::{Coil, Record};
use super::defect::{DefectKind, MEASURED};
use super::runs::Run;
use super::{STATION_STEP, STATIONS_PER_TURN};
use serde::Serialize;
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

/// Limits of an aligned turn, from the default scene: gap within this many diameters ...
const ALIGNED_GAP: f64 = 0.10;
/// ... at this share of the stations ...
const ALIGNED_SHARE: f64 = 0.95;
/// ... and its root mean square below this many diameters.
pub(crate) const ALIGNED_RMS: f64 = 0.05;
/// Share of a turn that may stand on wire of the layer below. Chosen: a sixth, as much again as a long crossover takes, for the wire
/// before and after it.
const OUT_OF_GROOVE: f64 = 1.0 / 6.0;

/// Verdict on a turn, mildest first. A turn with several defects gets the worst.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// nothing has come to rest where it could be measured
    #[default]
    Unsettled,
    /// no defect, and no neighbour to judge most of the turn by
    Single,
    /// gap within 0.10 d at 95 % of the stations, root mean square below 0.05 d, in its groove but for a sixth of the turn, no
    /// defect
    Aligned,
    /// anything between
    Marginal,
    /// the wire went slack on the way
    Slack,
    /// touches nothing over a good part of the turn, or has hardly any tension
    LooseTurn,
    /// stands off further than allowed
    Bulge,
    /// lies beside its place over a run of stations
    Gap,
    /// climbed to the next layer after the turn that the scene plans
    LateJump,
    /// climbed to the next layer before the turn that the scene plans
    EarlyJump,
    /// leaves a groove of the layer below empty beside it
    SkippedGroove,
    /// rides on its neighbour, or has changed places with it, over a run of stations
    Overlap,
    /// stands on turns of its own row
    DoubleTurn,
    /// has been drawn longer for good by more than allowed
    Overstretch,
    /// the coil has grown into the nozzle
    Collision,
    /// the wire shot out of the nozzle
    Runaway,
    /// the wire broke
    Break,
}

impl Verdict {
    /// The word for it, as in `summary.json`.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Unsettled => "unsettled",
            Self::Single => "single",
            Self::Aligned => "aligned",
            Self::Marginal => "marginal",
            Self::Slack => DefectKind::Slack.as_str(),
            Self::LooseTurn => DefectKind::LooseTurn.as_str(),
            Self::Bulge => DefectKind::Bulge.as_str(),
            Self::Gap => DefectKind::Gap.as_str(),
            Self::LateJump => DefectKind::LateJump.as_str(),
            Self::EarlyJump => DefectKind::EarlyJump.as_str(),
            Self::SkippedGroove => DefectKind::SkippedGroove.as_str(),
            Self::Overlap => DefectKind::Overlap.as_str(),
            Self::DoubleTurn => DefectKind::DoubleTurn.as_str(),
            Self::Overstretch => DefectKind::Overstretch.as_str(),
            Self::Collision => DefectKind::Collision.as_str(),
            Self::Runaway => DefectKind::Runaway.as_str(),
            Self::Break => DefectKind::Break.as_str(),
        }
    }

    /// Whether it names a defect.
    pub fn is_defect(self) -> bool {
        self >= Self::Slack
    }
}

impl From<DefectKind> for Verdict {
    fn from(kind: DefectKind) -> Self {
        match kind {
            DefectKind::Bulge => Self::Bulge,
            DefectKind::Gap => Self::Gap,
            DefectKind::Overlap => Self::Overlap,
            DefectKind::DoubleTurn => Self::DoubleTurn,
            DefectKind::SkippedGroove => Self::SkippedGroove,
            DefectKind::EarlyJump => Self::EarlyJump,
            DefectKind::LateJump => Self::LateJump,
            DefectKind::LooseTurn => Self::LooseTurn,
            DefectKind::Overstretch => Self::Overstretch,
            DefectKind::Slack => Self::Slack,
            DefectKind::Collision => Self::Collision,
            DefectKind::Runaway => Self::Runaway,
            DefectKind::Break => Self::Break,
        }
    }
}

impl std::fmt::Display for Verdict {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.as_str())
    }
}

/// Measures of one turn over its settled stations, without the neighbourhood of the clamp.
///
/// Lengths in m. Gaps are signed (negative: closer than a diameter) and `None` for a turn without
/// neighbour.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct TurnMeasures {
    /// turn, from 1
    pub turn: u32,
    /// layer of most of its stations, from 1
    pub layer: u32,
    /// which of the turns of that layer it is, from 1
    pub turn_in_layer: u32,
    /// settled fraction, 0..1
    pub settled: f64,
    /// stations measured
    pub stations: u32,
    /// mean gap
    pub gap_mean: Option<f64>,
    /// root mean square of the gap
    pub gap_rms: Option<f64>,
    /// largest gap
    pub gap_max: Option<f64>,
    /// share of the stations with a neighbour whose gap is above the limit
    pub gap_over: f64,
    /// longest run above the limit, as a fraction of a whole turn
    pub gap_run: f64,
    /// median room along y to the flange beside it; `None` but for the first and the last turn of a layer
    pub flange_gap: Option<f64>,
    /// mean axial distance to the neighbour, positive in the direction of the traverse
    pub axial_mean: Option<f64>,
    /// largest bulge on the faces on +x, +z, -x, -z; 0 where nothing is measured
    pub bulge_faces: [f64; 4],
    /// largest bulge on all faces
    pub bulge_max: f64,
    /// largest bulge over the quasi-static height; `None` without a profile
    pub bulge_excess_max: Option<f64>,
    /// largest overlap depth
    pub overlap_max: f64,
    /// largest geometric layer
    pub layer_max: u32,
    /// share of the turn that stands on a wire of the layer below and not in a groove, beside no crossover; 0 where no
    /// crossovers are planned
    pub out_of_groove: f64,
    /// verdict on the turn
    pub verdict: Verdict,
}

impl TurnMeasures {
    /// Whether it lies in grooves of the layer below as far as it is meant to.
    pub(super) fn is_in_groove(&self) -> bool {
        self.out_of_groove <= OUT_OF_GROOVE
    }
}

impl Coil {
    /// Measures of every turn that has begun to settle, first turn first (linear in the wire).
    pub fn turns(&self) -> Vec<TurnMeasures> {
        let turns = self.records.chunks().enumerate();
        let mut turns: Vec<TurnMeasures> = turns
            .map(|(turn, records)| self.measure_turn(turn, records))
            .collect();
        let mut in_layer = BTreeMap::new();
        for turn in &mut turns {
            let count = in_layer.entry(turn.layer).or_insert(0);
            *count += 1;
            turn.turn_in_layer = *count;
        }
        let layers: Vec<u32> = turns.iter().map(|turn| turn.layer).collect();
        let is_last = |k: usize| layers.get(k + 1) != Some(&layers[k]);
        for (k, (turn, records)) in turns.iter_mut().zip(self.records.chunks()).enumerate() {
            if turn.turn_in_layer == 1 || is_last(k) {
                turn.flange_gap = room_at_flange(records);
            }
        }
        // The station at the end of a turn says how loose it is.
        let mut loose = vec![0; self.records.len()];
        self.mark(DefectKind::LooseTurn, &mut loose);
        let ends = loose.chunks(STATIONS_PER_TURN).skip(1);
        for (turn, next) in turns.iter_mut().zip(ends) {
            if next[0] != 0 {
                turn.verdict = turn.verdict.max(Verdict::LooseTurn);
            }
        }
        // A run may be long enough in two turns together only.
        for defect in self.defects() {
            let turn = &mut turns[defect.turn as usize - 1];
            turn.verdict = turn.verdict.max(defect.kind.into());
        }
        turns
    }

    fn measure_turn(&self, turn: usize, records: &[Record]) -> TurnMeasures {
        let d = self.spec.diameter;
        let mut result = TurnMeasures {
            turn: turn as u32 + 1,
            layer: most_common(records.iter().map(|record| record.station.layer)),
            settled: records.len() as f64 / STATIONS_PER_TURN as f64,
            ..TurnMeasures::default()
        };
        let mut gaps = GapSums::default();
        let mut out_of_groove = 0;
        let mut runs = [Run::default(); MEASURED];
        let mut has = [false; MEASURED];
        for record in records {
            let station = &record.station;
            for kind in DefectKind::MEASURED {
                let (value, limit, least) = self.criterion(kind, record);
                let run = &mut runs[kind as usize];
                *run = run.next(value, limit);
                has[kind as usize] |= run.counts(least);
                if kind == DefectKind::Gap {
                    result.gap_run = result.gap_run.max(run.fraction());
                    gaps.over += u32::from(value.is_some_and(|gap| gap > limit));
                }
            }
            if !station.measured {
                continue;
            }
            result.stations += 1;
            gaps.beside += u32::from(station.neighbour.is_some());
            if let Some(neighbour) = station.neighbour.filter(|_| !station.crosses) {
                gaps.add(neighbour.gap, neighbour.axial, ALIGNED_GAP * d);
            }
            let face = &mut result.bulge_faces[self.face(station.angle)];
            *face = face.max(station.bulge);
            result.bulge_max = result.bulge_max.max(station.bulge);
            result.bulge_excess_max = match (result.bulge_excess_max, station.bulge_excess) {
                (Some(a), Some(b)) => Some(f64::max(a, b)),
                (a, b) => a.or(b),
            };
            result.overlap_max = result.overlap_max.max(station.overlap_depth);
            result.layer_max = result.layer_max.max(station.layer);
            out_of_groove += u32::from(station.out_of_groove);
        }
        result.out_of_groove = f64::from(out_of_groove) / STATIONS_PER_TURN as f64;
        gaps.write(&mut result);
        result.verdict = gaps.verdict(&result, has, d);
        result
    }

    /// Polar angle at this winding angle, rad, not wrapped.
    pub(crate) fn polar_at(&self, angle: f64) -> f64 {
        self.spec.start_angle + self.spec.direction * angle
    }

    /// Face at a winding angle: 0 on +x, 1 on +z, 2 on -x, 3 on -z.
    fn face(&self, angle: f64) -> usize {
        let polar = self.polar_at(angle);
        let c = self.spec.corner_angle;
        // The hair keeps a station right at a corner from changing sides by rounding.
        let from_corner = (polar + c + 1e-6 * STATION_STEP).rem_euclid(TAU);
        [2.0 * c, PI, PI + 2.0 * c]
            .iter()
            .filter(|&&edge| from_corner >= edge)
            .count()
    }
}

/// Median room to the flange beside a turn over its measured stations, m; none without a flange.
fn room_at_flange(records: &[Record]) -> Option<f64> {
    let measured = records
        .iter()
        .map(|record| &record.station)
        .filter(|s| s.measured);
    let mut rooms: Vec<f64> = measured.filter_map(|station| station.flange_gap).collect();
    rooms.sort_by(f64::total_cmp);
    rooms.get(rooms.len() / 2).copied()
}

/// The layer that most stations have, the lowest of several; 1 without any.
fn most_common(layers: impl Iterator<Item = u32>) -> u32 {
    let mut counts = BTreeMap::new();
    for layer in layers {
        *counts.entry(layer).or_insert(0) += 1;
    }
    let most = counts.iter().rev().max_by_key(|(_, count)| **count);
    most.map_or(1, |(layer, _)| *layer)
}

/// Sums over the stations that have a neighbour, without crossovers.
#[derive(Default)]
struct GapSums {
    /// stations beside a neighbour, in crossovers too
    beside: u32,
    /// the others of them, which everything else is of
    count: u32,
    sum: f64,
    squares: f64,
    most: f64,
    axial: f64,
    over: u32,
    within: u32,
}

impl GapSums {
    fn add(&mut self, gap: f64, axial: f64, aligned: f64) {
        self.most = if self.count == 0 {
            gap
        } else {
            self.most.max(gap)
        };
        self.count += 1;
        self.sum += gap;
        self.squares += gap * gap;
        self.axial += axial;
        self.within += u32::from(gap.abs() <= aligned);
    }

    fn write(&self, result: &mut TurnMeasures) {
        if self.count == 0 {
            return;
        }
        let n = f64::from(self.count);
        result.gap_mean = Some(self.sum / n);
        result.gap_rms = Some((self.squares / n).sqrt());
        result.gap_max = Some(self.most);
        result.axial_mean = Some(self.axial / n);
        result.gap_over = f64::from(self.over) / n;
    }

    fn verdict(&self, turn: &TurnMeasures, has: [bool; MEASURED], d: f64) -> Verdict {
        let aligned = f64::from(self.within) >= ALIGNED_SHARE * f64::from(self.count)
            && turn.gap_rms.is_none_or(|rms| rms < ALIGNED_RMS * d);
        let present = DefectKind::MEASURED
            .into_iter()
            .filter(|kind| has[*kind as usize] && kind.lies_where_it_shows());
        let worst = present.map(Verdict::from).max();
        if let Some(worst) = worst {
            worst
        } else if turn.stations == 0 {
            Verdict::Unsettled
        } else if !turn.is_in_groove() {
            Verdict::Marginal
        } else if 2 * self.beside < turn.stations || self.count == 0 {
            Verdict::Single
        } else if aligned {
            Verdict::Aligned
        } else {
            Verdict::Marginal
        }
    }
}
