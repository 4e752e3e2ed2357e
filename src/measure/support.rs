//! What a wire was laid over: the core, wire of earlier rows below it, or the climb to its own row.

use super::below::Lower;
use super::coil::{Coil, Record, STEP_UP};
use super::passes::Pass;
use super::{STATION_STEP, STATIONS_PER_TURN};

use super::row::{Row, RowPlace};

/// Axial distance up to which wire of an earlier row lies below a wire, diameters: cos 30 degrees, the largest at
/// which wire that rests on it stands half a diameter above it.
pub(super) const BELOW: f64 = 0.866_025_403_784_438_6;

/// The same for wire of the same row, which a wire can only have climbed on, diameters. In a groove of its own row, between two
/// turns of it, a wire is as far from them as that is wide.
const CLIMBED: f64 = 0.5;

/// Way aside from one station to the next that is rounding, diameters.
const JITTER: f64 = 1e-9;

/// Rise over a wire from which on another lies in the layer above it, diameters: half of a wire on a wire. In the
/// groove of touching wires it is 0.866.
pub(super) const NEXT_LAYER: f64 = 0.5;

/// Axial distance from a wire below up to which a wire stands on it and not in a groove, diameters. Chosen: halfway between
/// the top of the wire and the groove of touching wires.
const ON_WIRE: f64 = 0.25;

/// Room between a turn and a flange from which on another turn has its place there, diameters. Chosen: halfway between the whole place
/// of a last turn that has to squeeze in and the half place that every second layer in grooves leaves.
pub(super) const PLACE: f64 = 0.75;

/// What lies below a wire at one polar angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Support {
    /// height over the core at which the wire would rest if it were pushed straight down, m
    pub(crate) level: f64,
    /// it would rest on the top of a wire and not in a groove
    pub(crate) stands_on_wire: bool,
    /// one more than the layer of the wire below, 1 where there is none
    pub(crate) layer: u32,
    /// row of the wire that it would rest on
    pub(crate) row: Option<u32>,
    /// the wire that it was laid over; none where it was laid over the core, also where its own row holds it up beside a flange
    pub(super) laid_on: Option<LaidOn>,
    /// it would rest on the climb of its own row, which it crosses
    pub(super) on_climb: bool,
    /// its place along y from that climb's, m, where it passes over it
    pub(super) beside_climb: Option<f64>,
    /// rise over wire of its own row that it has climbed on, m
    pub(crate) own_row: Option<f64>,
    /// the same as `level` where wire of its own row and a flange hold it between them as well, m
    pub(crate) held: f64,
    /// the same as `level` where wire of its own row carries it too, from below or wedged beside a flange, m
    pub(crate) highest: f64,
}

/// Wire that another was laid over: of earlier rows, or the climb to its own row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LaidOn {
    /// height over the core at which that carries it, m
    pub(super) level: f64,
    /// its station
    pub(super) station: usize,
}

impl Support {
    /// The same where wire leaves its row, and has not climbed on it to stay.
    pub(crate) fn without_own_row(self) -> Self {
        Self {
            own_row: None,
            ..self
        }
    }
}

impl Coil {
    /// Whether wire that passes over the climb of its own row, `beside` that (m) along y, goes across it fast enough to be over its top within
    /// a climb's length.
    fn goes_across_climb(&self, beside: f64) -> bool {
        let before = self.records.last().and_then(|last| last.beside_climb);
        let least = 2.0 * ON_WIRE * self.spec.diameter * STATION_STEP / STEP_UP;
        before.is_some_and(|before| (beside - before).abs() >= least)
    }

    /// Row of the next station in this pass, what lies below it, and whether it is pressed up beside a flange or on its way to the next row.
    pub(crate) fn row_and_support(&self, pass: Pass, at: &RowPlace) -> (Row, Support, bool) {
        let RowPlace { angle, y, .. } = *at;
        let last = self.records.last();
        let row = last.map_or_else(|| Row::first(pass, y), |last| last.row);
        let row = self.come_down(row, pass, at).unwrap_or(row);
        // Once the nozzle has turned, wire of the row itself may be what the next one lies on.
        let least = row.number + u32::from(row.is_over_in(pass));
        let has_no_room = at.has_no_room_in(row, self.spec.diameter);
        let squeezed = has_no_room && self.has_place_beside_turn_before(row);
        let leaves = || self.support(row.number + 1, at).layer > self.layer_of(row);
        let is_certain = self.steps_up_next();
        let climbed = row.is_over_in(pass)
            && (is_certain
                || !squeezed
                    && (self.support(least, at).layer > last.map_or(1, |last| last.station.layer)
                        || self.climbs_by_plan(row, at)));
        let climbs_at_flange = !row.is_over_in(pass)
            && !self.is_pressed_up_next()
            && (is_certain
                || row.sense == pass.sense
                    && has_no_room
                    && !squeezed
                    && self.may_climb(self.layer_of(row), angle)
                    && leaves()
                    && self.stands_on_own(row, at));
        let rises = squeezed && leaves();
        let next = match climbs_at_flange {
            true => row.beside_flange(pass, (angle, y), self.layer_of(row)),
            false => row.next(pass, angle, y, climbed, self.spec.diameter),
        };
        let support = self.support(next.number, at);
        let sinks = next.number == row.number && support.layer < self.layer_of(row);
        let next = match sinks {
            true => next.no_farther_than(row),
            false => next,
        };
        (next, support, rises)
    }

    /// The row that wire goes on in if it had climbed beside a flange before the nozzle turned, and has come down to its layer again: it
    /// was pressed up there, and its row has a place left.
    fn come_down(&self, row: Row, pass: Pass, at: &RowPlace) -> Option<Row> {
        let (left, layer) = row.left_in(pass)?;
        if self.is_slow_climb(self.records.len()) {
            return None;
        }
        let (above, of_left) = (self.support(row.number, at), self.support(left.number, at));
        let off = at.height - of_left.held;
        let is_down = above.layer <= layer
            && of_left
                .own_row
                .is_none_or(|rise| rise < NEXT_LAYER * self.spec.diameter)
            && off < self.spec.limits.overlap_height * self.spec.diameter;
        is_down.then_some(left)
    }

    /// Whether the turn before, of this row, has left a place beside a flange: wire that stands high there is the last turn of the row, which is
    /// pressed up between that turn and the flange.
    fn has_place_beside_turn_before(&self, row: Row) -> bool {
        let before = self.records.len().checked_sub(STATIONS_PER_TURN);
        before
            .map(|index| &self.records[index])
            .filter(|before| before.row.number == row.number)
            .and_then(|before| before.station.flange_gap)
            .is_some_and(|gap| gap >= PLACE * self.spec.diameter)
    }

    /// Whether wire stands on its own row. Wire may also lie as high in its place beside a flange, over the climbs of the rows below.
    fn stands_on_own(&self, row: Row, at: &RowPlace) -> bool {
        let on = self.support(row.number, at).own_row;
        on.is_some_and(|rise| rise >= NEXT_LAYER * self.spec.diameter)
    }

    /// Whether wire climbs on its own row where a layer is a turn long by plan: there each turn lies on the one before.
    fn climbs_by_plan(&self, row: Row, at: &RowPlace) -> bool {
        self.has_planned_passes() && self.stands_on_own(row, at)
    }

    /// Layer that wire of this row, the row of the last station, leaves where it climbs: that of the station, or of the turn
    /// before at this angle where that lies higher. Wire that sank into a hole beside the flange comes back to its own layer.
    fn layer_of(&self, row: Row) -> u32 {
        let last = self.records.last().map_or(1, |last| last.station.layer);
        let before = self.records.len().checked_sub(STATIONS_PER_TURN);
        let before = before.map(|index| &self.records[index]);
        match before {
            Some(before) if before.row.number == row.number => last.max(before.station.layer),
            _ => last,
        }
    }

    /// What lies below wire at `y` (m) and `height` over the core (m), on wire that passes the same polar angle beside it. Only
    /// rows before number `row` carry it, and the first part of this row where it climbed, if the turn after crosses that. On other
    /// wire it has climbed.
    ///
    /// Down is the direction of the wire's height: what lies beside the wire does not carry it, unless a flange leaves no room for the
    /// wire to fall between the two.
    fn support(&self, row: u32, at: &RowPlace) -> Support {
        let above = Above::new(self, row, at);
        let mut found = Found::default();
        for bin in at.bucket.1 - 1..=at.bucket.1 + 1 {
            let mut next = self.buckets.get((at.bucket.0, bin));
            while let Some(index) = next {
                next = self.records[index].beneath;
                let below = above.over(index);
                found.take_own_row(&below, self.spec.diameter);
                found.take_layer(&below, self.spec.diameter);
                found.take_levels(&below, self.spec.diameter);
            }
        }
        found.support(
            at.height,
            self.spec.limits.overlap_height * self.spec.diameter,
        )
    }
}

/// Wire whose support is asked for.
struct Above<'a> {
    coil: &'a Coil,
    /// number of its row
    row: u32,
    at: &'a RowPlace,
    /// the last station, where it lay on the climb of its own row
    on_climb: Option<&'a Record>,
    /// it comes down from that climb
    comes_down: bool,
}

/// Wire below it, and how the two lie to each other.
struct Below<'a> {
    /// its station
    index: usize,
    record: &'a Record,
    /// way along y from it to the wire above, m
    along: f64,
    /// the same without its sign, diameters
    aside: f64,
    /// height of the wire above over it, m
    rise: f64,
    /// its own height over the core, m
    height: f64,
    /// of an earlier row
    earlier: bool,
    /// it climbs to its own row
    climbing: bool,
    /// a climb that the wire above passes over
    is_passed: bool,
    /// it carries the wire above
    carries: bool,
    /// the wire above comes down from the climb of its own row
    comes_down: bool,
    /// height over the core at which it and a flange hold the wire above between them, m
    wedge: Option<f64>,
    /// the wire above is in its place there
    in_place: bool,
    /// layer of wire that lies over it
    layer_over: u32,
}

impl<'a> Above<'a> {
    fn new(coil: &'a Coil, row: u32, at: &'a RowPlace) -> Self {
        let on_climb = coil.records.last().filter(|last| last.on_climb);
        Self {
            coil,
            row,
            at,
            on_climb,
            comes_down: on_climb.is_some_and(|last| at.height < last.station.height),
        }
    }

    /// How it lies over the wire of the station at `index`.
    fn over(&self, index: usize) -> Below<'a> {
        let (coil, at, d) = (self.coil, self.at, self.coil.spec.diameter);
        let lower = coil.straight_below(&at.plumb, at.height, index);
        let (station, of) = (&lower.record.station, lower.record.row);
        let (aside, rise) = ((at.y - lower.y).abs() / d, at.height - lower.height);
        let earlier = of.number < self.row;
        let one_turn_back = index + STATIONS_PER_TURN == coil.records.len();
        let comes_down = self.comes_down || (one_turn_back && self.goes_away(aside));
        // on a long face it comes down for longer than what it has crossed counts as a climb
        let climb = if comes_down { 2.0 } else { 1.0 } * STEP_UP;
        let climbing = of.number > 1 && station.angle < of.from + climb;
        let is_passed = climbing && one_turn_back && aside <= 1.0 && rise > 0.0;
        let goes_across = is_passed && coil.goes_across_climb(at.y - lower.y);
        // what lies along the climb of its own row, and not across it, has ridden up
        let crossed = climbing && (at.crosses || aside >= ON_WIRE || goes_across);
        let wedge = self.wedged(&lower);
        // pressed up between a flange and the turn before, it is in its place there as long as that is a place and it lies in it
        let off = coil.spec.limits.overlap_height * d;
        let in_place = wedge.is_some_and(|(level, room)| room >= PLACE && at.height - level < off);
        // what crosses the slow climb of its own row lies in that row's layer
        let is_over = !one_turn_back || !coil.is_slow_climb(index);
        Below {
            index,
            record: lower.record,
            along: at.y - lower.y,
            aside,
            rise,
            height: lower.height,
            earlier,
            climbing,
            is_passed,
            carries: earlier || (one_turn_back && crossed),
            comes_down,
            wedge: wedge.map(|(level, _)| level),
            in_place,
            layer_over: station.layer + u32::from(is_over),
        }
    }

    /// Whether it goes away from the climb of its own row, `aside` of it (diameters): on a bowed face without coming nearer to the core.
    fn goes_away(&self, aside: f64) -> bool {
        let d = self.coil.spec.diameter;
        let beside = self
            .on_climb
            .and_then(|last| last.beside_climb)
            .map(f64::abs);
        beside.is_some_and(|beside| (beside..d).contains(&(aside * d - JITTER * d)))
    }

    /// Where it would lie if it fell along the flange as far as other wire lets it, m over the core, and the room there, diameters.
    fn wedged(&self, lower: &Lower) -> Option<(f64, f64)> {
        let (at, d) = (self.at, self.coil.spec.diameter);
        let way = at.flange?;
        let farthest = at.y + way - (0.5 * d).copysign(way);
        let room = (farthest - lower.y) * way.signum() / d;
        let between = (at.y - lower.y) * way > 0.0;
        let holds = between && at.height > lower.height && (CLIMBED..1.0).contains(&room);
        let level = |room: f64| lower.height + d * (1.0 - room * room).sqrt();
        holds.then(|| (level(room), room))
    }
}

/// What the wires below come to together.
struct Found {
    support: Support,
    /// layers of the highest wire of its own row below it, towards -y and +y
    groove: [u32; 2],
    /// height at which wire of earlier rows alone carries it, m
    on_earlier: f64,
}

impl Default for Found {
    fn default() -> Self {
        Self {
            support: Support {
                level: 0.0,
                stands_on_wire: false,
                layer: 1,
                row: None,
                laid_on: None,
                on_climb: false,
                beside_climb: None,
                own_row: None,
                held: 0.0,
                highest: 0.0,
            },
            groove: [0; 2],
            on_earlier: f64::NEG_INFINITY,
        }
    }
}

impl Found {
    /// How it has climbed on wire of its own row, and where it passes over the climb of that; `d` is the diameter, m.
    fn take_own_row(&mut self, below: &Below, d: f64) {
        if below.is_passed {
            self.support.beside_climb = Some(below.along);
        }
        if below.earlier || below.aside > BELOW || below.rise <= 0.0 || below.in_place {
            return;
        }
        // what it stands higher than it lies on that turn is a bulge
        let rise = below.rise.min(d * (1.0 - below.aside * below.aside).sqrt());
        self.support.own_row = Some(match self.support.own_row {
            // it stands on the higher of two turns below it
            Some(other) if other.min(rise) >= NEXT_LAYER * d => other.min(rise),
            other => rise.max(other.unwrap_or(0.0)),
        });
    }

    /// Layer over wire straight below it, and over a groove of its own row.
    fn take_layer(&mut self, below: &Below, d: f64) {
        if below.rise < NEXT_LAYER * d {
            return;
        }
        if below.aside <= if below.earlier { BELOW } else { CLIMBED } {
            self.support.layer = self.support.layer.max(below.layer_over);
        } else if below.aside <= BELOW {
            let side = &mut self.groove[usize::from(below.along < 0.0)];
            *side = below.record.station.layer.max(*side);
        }
    }

    /// Heights at which the wire below carries it, or holds it up with a flange.
    fn take_levels(&mut self, below: &Below, d: f64) {
        let support = &mut self.support;
        // it leans on the climb from the side as long as it touches it
        let leans = below.comes_down && !below.earlier && below.carries;
        let reach = if leans { 1.0 } else { BELOW };
        let (aside, station) = (below.aside, &below.record.station);
        let on = (aside <= reach).then(|| below.height + d * (1.0 - aside * aside).sqrt());
        if let (true, Some(level)) = (below.earlier, on) {
            self.on_earlier = self.on_earlier.max(level);
        }
        let carried = on.filter(|_| below.carries);
        let laid_on = carried.or(below.wedge.filter(|_| below.earlier));
        let lowest = support.laid_on.map_or(0.0, |laid_on| laid_on.level);
        if let Some(level) = laid_on.filter(|level| *level > lowest) {
            support.laid_on = Some(LaidOn {
                level,
                station: below.index,
            });
        }
        // what a flange and another wire hold between them cannot drop, whichever row that is of
        let held = carried.or(below.wedge);
        if let Some(level) = on.or(held)
            && below.rise > 0.0
        {
            support.highest = support.highest.max(level);
            // what leans on wire lies in the layer of that wire at least
            support.layer = support.layer.max(station.layer);
        }
        support.held = support.held.max(held.unwrap_or(0.0));
        // what stands on its own row has left its place, also where a flange holds it there
        if let Some(level) = carried.or(held.filter(|_| below.in_place || on.is_none()))
            && level > support.level
        {
            support.level = level;
            support.stands_on_wire = aside < ON_WIRE;
            support.on_climb = !below.earlier && below.carries;
            let is_told = below.earlier || below.climbing;
            support.row = is_told.then_some(below.record.row.number);
        }
    }

    /// All of it together, for wire at this height over the core, m; `overlaps` is the height over its place from which on wire has left it, m.
    fn support(self, height: f64, overlaps: f64) -> Support {
        let mut support = self.support;
        let [one, other] = self.groove;
        if one.min(other) > 0 {
            support.layer = support.layer.max(one.min(other) + 1);
        }
        // beside a turn that has sunk into a hole, wire in its own groove stands high over that turn, and not on it
        if height - self.on_earlier < overlaps {
            support.own_row = None;
        }
        support
    }
}
