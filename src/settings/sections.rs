//! Sections of a scene whose leaves a run reads as they are given.

use serde::{Deserialize, Serialize};

/// Eyelet on +x: position fixed, direction free, wire slides through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nozzle {
    /// distance of the exit from the core axis, m
    pub distance: f64,
    /// start position along the core axis, m
    pub y_start: f64,
    /// friction force at the exit as a share of tension per rad of deflection
    pub exit_friction: f64,
    /// whether inputs without a rate say where the nozzle is at the start of a communication step, not at its end
    pub position_at_start: bool,
    /// outer diameter of the body, which goes from the exit outwards along +x, m; 0: the nozzle is a point
    pub outer_diameter: f64,
    /// length of the body, m; 0: without end
    pub length: f64,
    /// radius of the rim of the body's faces, m
    pub edge_radius: f64,
    /// diameter of the hole, m; 0: not said
    pub bore: f64,
    /// radius of the edge of the hole at the exit, m; 0: bending over it does not count
    pub exit_radius: f64,
}

impl Nozzle {
    /// Largest curvature, 1/m, that the edge of the exit bends the centreline of wire of this radius, m, to; 0: it does not count.
    pub fn exit_curvature(&self, wire_radius: f64) -> f64 {
        match self.exit_radius > 0.0 {
            true => 1.0 / (self.exit_radius + wire_radius),
            false => 0.0,
        }
    }
}

/// Constant pull through an equivalent mass and an elastic line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tensioner {
    /// set pull, N
    pub tension: f64,
    /// equivalent mass per wire speed, kg; 0 with a rigid line: constant pull at the nozzle
    pub mass: f64,
    /// wire between tensioner and nozzle, m
    pub line_length: f64,
    /// damping ratio of mass on line
    pub line_damping_ratio: f64,
    /// damper on the tensioner, N s/m
    pub damping: f64,
    /// radius of the wheel on which a brake acts, m
    pub radius: f64,
    /// largest torque of that brake, N m; 0: none
    pub brake_torque_max: f64,
    /// whether the wire between tensioner and nozzle has its mass
    pub line_inertia: bool,
    /// moment of inertia of the guide pulley over the square of its radius, kg
    pub pulley_mass: f64,
    /// friction of the guide pulley's bearing, as a force on the wire, N
    pub pulley_friction: f64,
    /// share of the line between nozzle and guide pulley
    pub pulley_place: f64,
}

impl Tensioner {
    /// The largest torque of the brake, N m.
    pub fn most_torque(&self) -> f64 {
        if self.brake_torque_max > 0.0 {
            self.brake_torque_max
        } else {
            f64::INFINITY
        }
    }

    /// Whether a pulley guides the line.
    pub fn has_pulley(&self) -> bool {
        self.pulley_mass > 0.0 || self.pulley_friction > 0.0
    }
}

/// Where the wire begins: clamped to the middle of the +x face, tangent to it, straight to the
/// nozzle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// wire end along the core axis, m
    pub clamp_y: f64,
}

impl Start {
    /// Core angle at which the wire runs straight from clamp to nozzle, rad: `acos((h + r)/D)`.
    /// The spindle angle counts from here.
    ///
    /// `half_width` of the core along x at angle zero, radius of the wire and distance of the
    /// nozzle from the axis in m, `h + r <= D`.
    pub fn core_angle(half_width: f64, wire_radius: f64, nozzle_distance: f64) -> f64 {
        libm::acos((half_width + wire_radius) / nozzle_distance)
    }
}

/// Spindle motion profile of a native run.
#[derive(Clone, Debug, PartialEq)]
pub struct Spindle {
    /// final speed, rad/s; in a [`Scene`](crate::scene::Scene) about +y, with its sign
    pub speed: f64,
    /// axis about which it winds: `+y`, `-y`, or `auto`: by the speed at the start, +y where that is 0
    pub direction: String,
    /// revolutions over which the speed rises with constant acceleration
    pub ramp_turns: f64,
    /// revolutions until the run ends; 0: those of the winding, or 2.5 with traverse.mode = by-angle
    pub turns: f64,
    /// path of a CSV file of speed over angle, already resolved against the folder of the scene file; empty: none
    pub file: String,
    /// revolutions after which the table in the file begins again; 0: it does not
    pub repeat_turns: f64,
    /// largest speed while wire climbs to the next layer, as a share of `speed`
    pub flange_share: f64,
    /// revolutions over which the speed falls to that before a climb, and rises again after it
    pub flange_turns: f64,
}

impl Spindle {
    /// 1 where it winds about +y, -1 where it winds about -y, from this speed at the start, rad/s.
    pub fn sense_from(&self, speed: f64) -> f64 {
        match self.direction.as_str() {
            "+y" => 1.0,
            "-y" => -1.0,
            _ if speed < 0.0 => -1.0,
            _ => 1.0,
        }
    }
}

/// Two flanges beside the core; none where the inner distance is 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlangeSettings {
    /// distance of their inner faces, m; 0: no flanges
    pub inner_distance: f64,
    /// how far their rim stands above the core, m
    pub height: f64,
    /// thickness of each along the axis, m
    pub thickness: f64,
    /// radius of the edges of the rim, m
    pub edge_radius: f64,
    /// thickness of the insulation on the inner faces, m
    pub insulation: f64,
}

/// Law of the traverse: nozzle y over the core angle.
#[derive(Clone, Debug, PartialEq)]
pub struct Traverse {
    /// how the nozzle moves (one of `by-input`, `by-angle`, `orthocyclic`, `helical`, `table`)
    pub mode: String,
    /// by-angle: nozzle travel per turn of the spindle, m (sign: direction along y)
    pub per_turn: f64,
    /// constant lead of the nozzle over the law, m; in layers, in the direction of each
    pub lead: f64,
    /// orthocyclic: core angle of the step to the next turn, rad
    pub crossover: f64,
    /// orthocyclic: core angle after that of the clamp at which crossovers end, rad
    pub crossover_delay: f64,
    /// orthocyclic: whether wire trails behind a nozzle on the law, or is led onto it (one of `free`, `led`)
    pub trail: String,
    /// core angle by which the nozzle is ahead of the law, rad
    pub advance: f64,
    /// helical: turns that the nozzle stands at the end of a layer
    pub dwell_turns: f64,
    /// table: path of the CSV file, already resolved against the folder of the scene file
    pub file: String,
}

/// What the layered traverse modes wind.
#[derive(Clone, Debug, PartialEq)]
pub struct Winding {
    /// turns of the first layer; 0: as many as fit between the flanges
    pub turns_per_layer: f64,
    /// layers
    pub layers: f64,
    /// direction of the first layer along y (one of `+y`, `-y`)
    pub direction: String,
    /// distance of neighbouring turns, m; 0: fills the window, or the wire's outer diameter where there is none
    pub pitch: f64,
}

/// Penalty contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// line load per depth, N/m^2
    pub stiffness: f64,
    /// rebound over impact speed of a single node
    pub restitution: f64,
}

/// Stick-slip friction, wire on core and wire on wire.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Friction {
    /// coefficient at rest
    pub static_: f64,
    /// coefficient at high slip speed
    pub kinetic: f64,
    /// slip speed over which one turns into the other, m/s
    pub slip_speed: f64,
}

/// When wire leaves the computation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Freeze {
    /// off keeps all wire live
    pub enabled: bool,
    /// window of core angle over which motion is judged, rad
    pub window: f64,
    /// window of time instead, while the spindle stands, s; 0: ten periods of the free span's slowest ringing
    pub time: f64,
    /// largest motion in the core frame per core angle, m/rad; 0: in proportion to the outer diameter, 2 um/rad for 0.7 mm
    pub creep: f64,
    /// turns behind lift-off from which on that limit grows
    pub patience: f64,
    /// settled wire kept live behind lift-off, m; 0: 1.75 sqrt(EI/T)
    pub keep_length: f64,
    /// region: largest distance of the wire's surface from the core or the layer below up to the patience, m; 0: in proportion to
    /// the outer diameter, 5 mm for 0.7 mm
    pub margin: f64,
}

/// What is recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// core angle between rows of `history.csv`, rad
    pub history_interval: f64,
    /// directory of the FMU's files; empty: none
    pub directory: String,
}
