//! Where the nozzle stands along the core axis at every angle of the spindle, as straight pieces over the angle.

use crate::measure::LayerStart;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Travel of a crossover over that of a nozzle that goes evenly, at least: it takes less than half a turn.
const STEEP: f64 = 2.0;

/// A stretch of even travel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// spindle angle at its start, rad, without sign
    pub from: f64,
    /// nozzle position there, m
    pub y: f64,
    /// travel per angle turned, m/rad
    pub travel: f64,
}

/// Nozzle position over the angle that the spindle has turned, whichever way round.
#[derive(Clone, Debug, PartialEq)]
pub struct NozzleLaw {
    /// by rising angle, the first from 0; the last goes on
    pieces: Arc<[Piece]>,
    /// turns after which it ends
    turns: f64,
    /// angles between which wire is meant to climb to the next layer, rad, one pair a layer
    jumps: Arc<[[f64; 2]]>,
    /// angle at which the last layer is full, rad, where layers are planned
    full: Option<f64>,
    /// turns that these layers hold
    held: Option<f64>,
    /// way from turn to turn of a layer, m, where layers are planned
    pitch: Option<f64>,
    /// way (m) and angle (rad) in which each turn steps to its next place, where it does so in steps
    crossover: Option<[f64; 2]>,
    /// where each layer begins between flanges, where it is known
    layer_starts: Arc<[LayerStart]>,
}

impl NozzleLaw {
    /// Even travel without end; `turns` of it are wound.
    pub(super) fn even(y: f64, travel: f64, turns: f64) -> Self {
        let piece = Piece {
            from: 0.0,
            y,
            travel,
        };
        Self {
            pieces: Arc::new([piece]),
            turns,
            jumps: Arc::new([]),
            full: None,
            held: None,
            pitch: None,
            crossover: None,
            layer_starts: Arc::new([]),
        }
    }

    /// Straight from point to point: turns and place, m. There are two at least, by rising turns from 0.
    pub(super) fn through(points: &[[f64; 2]]) -> Self {
        let piece = |pair: &[[f64; 2]]| {
            let [[from, y], [to, end]] = [pair[0], pair[1]];
            Piece {
                from: from * TAU,
                y,
                travel: (end - y) / ((to - from) * TAU),
            }
        };
        let last = points[points.len() - 1];
        let mut pieces: Vec<Piece> = points.windows(2).map(piece).collect();
        // beyond its end the nozzle stands
        pieces.push(Piece {
            from: last[0] * TAU,
            y: last[1],
            travel: 0.0,
        });
        Self {
            pieces: pieces.into(),
            turns: last[0],
            jumps: Arc::new([]),
            full: None,
            held: None,
            pitch: None,
            crossover: None,
            layer_starts: Arc::new([]),
        }
    }

    /// The same law, ahead by this angle, rad: it starts from where it would be by then.
    pub(super) fn advanced(self, angle: f64) -> Self {
        if angle == 0.0 {
            return self;
        }
        let start = Piece {
            from: 0.0,
            y: self.position(angle),
            travel: self.piece_at(angle).travel,
        };
        let later = self.pieces.iter().filter(|piece| piece.from > angle);
        let later = later.map(|piece| Piece {
            from: piece.from - angle,
            ..*piece
        });
        Self {
            pieces: std::iter::once(start).chain(later).collect(),
            turns: self.turns,
            jumps: self.jumps,
            full: self.full,
            held: self.held,
            pitch: self.pitch,
            crossover: self.crossover,
            layer_starts: self.layer_starts,
        }
    }

    /// The same law, with the turns between which wire is meant to climb to each next layer, those after which the last is full, and
    /// those that all layers hold.
    pub(super) fn with_layers(self, jumps: &[[f64; 2]], full: f64, held: f64) -> Self {
        let jumps = jumps
            .iter()
            .map(|pair| pair.map(|turn| turn * TAU))
            .collect();
        Self {
            jumps,
            full: Some(full * TAU),
            held: Some(held),
            ..self
        }
    }

    /// The same law, which lays the turns of a layer so far (m) from each other.
    pub(super) fn with_pitch(self, pitch: f64) -> Self {
        Self {
            pitch: Some(pitch),
            ..self
        }
    }

    /// The same law, in which each turn steps by a pitch (m) to its next place within so much of the core's angle (rad).
    pub(super) fn with_crossovers(self, pitch: f64, angle: f64) -> Self {
        Self {
            crossover: Some([pitch, angle]),
            ..self.with_pitch(pitch)
        }
    }

    /// The law of a table, which plans so many `turns` a pitch (m) apart. Its steps are crossovers where at least half of the turns
    /// step: by half a pitch to one and a half, more than [`STEEP`] times as fast as a nozzle that goes evenly. The angle is that of the
    /// middle one.
    pub(super) fn with_steps_as_crossovers(self, pitch: f64, turns: f64) -> Self {
        let mut steps: Vec<f64> = Vec::new();
        let (mut angle, mut way) = (0.0, 0.0);
        for pair in self.pieces.windows(2) {
            let (length, travel) = (pair[1].from - pair[0].from, pair[0].travel);
            if travel.abs() * TAU > STEEP * pitch {
                angle += length;
                way += length * travel;
                continue;
            }
            if (0.5..=1.5).contains(&(way.abs() / pitch)) {
                steps.push(angle);
            }
            (angle, way) = (0.0, 0.0);
        }
        steps.sort_by(f64::total_cmp);
        let most = 2.0 * steps.len() as f64 >= turns;
        let middle = steps.get(steps.len() / 2).filter(|_| most);
        Self {
            crossover: middle.map(|angle| [pitch, *angle]),
            ..self
        }
    }

    /// The same law, with where each layer begins between flanges.
    pub(super) fn with_layer_starts(self, starts: Vec<LayerStart>) -> Self {
        Self {
            layer_starts: starts.into(),
            ..self
        }
    }

    /// Where each layer begins between flanges; none where it is not known.
    pub fn layer_starts(&self) -> &[LayerStart] {
        &self.layer_starts
    }

    /// Way from turn to turn of a layer, m; none where layers are not planned, or by the points of a table.
    pub fn pitch(&self) -> Option<f64> {
        self.pitch
    }

    /// Step (m) and angle (rad) of the crossover of each turn; none where turns do not cross in steps.
    pub fn crossover(&self) -> Option<[f64; 2]> {
        self.crossover
    }

    /// Angles between which wire is meant to climb to the next layer, rad; none where layers are not planned.
    pub fn jumps(&self) -> &[[f64; 2]] {
        &self.jumps
    }

    /// Angle at which the last layer is full, rad; none where layers are not planned.
    pub fn full(&self) -> Option<f64> {
        self.full
    }

    /// Turns that the planned layers hold; none where layers are not planned.
    pub fn held(&self) -> Option<f64> {
        self.held
    }

    /// The piece at an angle turned, rad.
    fn piece_at(&self, angle: f64) -> Piece {
        let next = self.pieces.partition_point(|piece| piece.from <= angle);
        self.pieces[next.max(1) - 1]
    }

    /// Travel per angle, m/rad, from this angle on outwards (1) or back (-1), and the angle up to which it holds, rad.
    pub(crate) fn towards(&self, angle: f64, outward: f64) -> (f64, f64) {
        if outward > 0.0 {
            let next = self.pieces.partition_point(|piece| piece.from <= angle);
            let end = self
                .pieces
                .get(next)
                .map_or(f64::INFINITY, |next| next.from);
            return (self.pieces[next.max(1) - 1].travel, end);
        }
        let next = self.pieces.partition_point(|piece| piece.from < angle);
        let piece = self.pieces[next.max(1) - 1];
        (piece.travel, piece.from.min(angle))
    }

    /// Position before the spindle turns, m.
    pub fn start(&self) -> f64 {
        self.pieces[0].y
    }

    /// Turns of the whole law.
    pub fn turns(&self) -> f64 {
        self.turns
    }

    /// Angle of the whole law, rad.
    pub fn end(&self) -> f64 {
        self.turns * TAU
    }

    /// Angle from which on the nozzle goes as it goes for good, rad.
    pub(super) fn travel_ends(&self) -> f64 {
        self.pieces.last().map_or(0.0, |last| last.from)
    }

    /// Its pieces by rising angle; the last goes on without end.
    pub fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// Position at this angle turned, rad, in m.
    pub fn position(&self, angle: f64) -> f64 {
        let piece = self.piece_at(angle);
        piece.y + piece.travel * (angle - piece.from)
    }

    /// Direction along y in which it sets off; 0 where it stands.
    pub fn sense(&self) -> f64 {
        let moving = self.pieces.iter().find(|piece| piece.travel != 0.0);
        moving.map_or(0.0, |piece| piece.travel.signum())
    }

    /// Least and largest position up to its end, m.
    pub(super) fn range(&self) -> [f64; 2] {
        let end = self.end();
        let within = self.pieces.iter().filter(|piece| piece.from <= end);
        let ends = within.map(|piece| piece.y).chain([self.position(end)]);
        ends.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], y| {
            [low.min(y), high.max(y)]
        })
    }

    /// How often it passes a place at most, as wire of diameter `d` (m) is laid turn by turn: a way that turns back goes over the
    /// turns that it has laid. Where it stands nothing is counted.
    pub(super) fn passes(&self, d: f64) -> u32 {
        let mut turned = 0;
        let mut last = (self.start(), 0.0);
        for turn in 0..self.turns.floor() as u32 {
            let y = self.position((f64::from(turn) + 0.5) * TAU);
            let step = y - last.0;
            if step.abs() < 0.5 * d {
                continue;
            }
            if step * last.1 < 0.0 {
                turned += 1;
            }
            last = (y, step);
        }
        turned + 1
    }

    /// The same law for so many turns.
    pub(super) fn for_turns(self, turns: f64) -> Self {
        Self { turns, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PITCH: f64 = 0.6e-3;

    /// A coil by the table of its orthocyclic law had gaps where the law itself had crossovers.
    #[test]
    fn a_table_that_steps_has_crossovers() {
        let places = [0.0, 1.0, 2.0, 3.0, 2.5, 1.5, 0.5];
        let table = |step: f64| {
            let mut points = vec![[0.0, 0.0]];
            for (turn, pair) in places.windows(2).enumerate() {
                let end = (turn + 1) as f64;
                // a step that begins and ends gently, as a drive makes it
                for share in [0.0, 0.2, 0.8, 1.0] {
                    let way = [0.0, 0.05, 0.95, 1.0][(3.0 * share + 0.5) as usize];
                    let y = pair[0] + way * (pair[1] - pair[0]);
                    points.push([end - (1.0 - share) * step, PITCH * y]);
                }
            }
            let law = NozzleLaw::through(&points);
            law.with_steps_as_crossovers(PITCH, places.len() as f64)
        };
        let [step, angle] = table(1.0 / 6.0).crossover().expect("crossovers");
        assert_eq!(step, PITCH);
        assert!((angle - 0.6 / 6.0 * TAU).abs() < 1e-9, "{angle}");
        // most of a turn is no crossover, nor is even travel
        assert_eq!(table(0.9).crossover(), None);
        let even = NozzleLaw::through(&[[0.0, 0.0], [7.0, 7.0 * PITCH], [14.0, 0.0]]);
        let even = even.with_steps_as_crossovers(PITCH, 14.0);
        assert_eq!(even.crossover(), None);
    }
}
