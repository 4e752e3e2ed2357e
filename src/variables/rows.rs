//! The rows. A row is one line of cells; the macros below turn them into [`Variable`]s.
//!
//! Cells of a number: reference, name, field, unit, shown unit, min, max, nominal, description.
//! Ranges of inputs and parameters are enforced; those of outputs are what a sane run stays in.

use super::{Access, Causality, Kind, Value, Variability, Variable};

/// A row without a number's cells.
macro_rules! row {
    ($reference:expr, $name:expr, $kind:ident, $causality:ident, $variability:ident, $access:expr, $description:expr) => {
        Variable {
            reference: $reference,
            name: $name,
            kind: Kind::$kind,
            causality: Causality::$causality,
            variability: Variability::$variability,
            unit: "",
            display_unit: "",
            min: None,
            max: None,
            nominal: None,
            choices: &[],
            fmu_start: None,
            native_only: false,
            description: $description,
            access: $access,
        }
    };
}

/// A row of a real number.
macro_rules! real {
    ($unit:expr, $shown:expr, $min:expr, $max:expr, $nominal:expr, $row:expr) => {
        Variable {
            unit: $unit,
            display_unit: $shown,
            min: Some($min),
            max: Some($max),
            nominal: Some($nominal),
            ..$row
        }
    };
}

macro_rules! input {
    ($reference:literal, $field:ident, $unit:literal, $shown:literal, $min:expr, $max:expr, $nominal:expr, $description:literal) => {{
        const ACCESS: Access = Access::Input {
            get: |i| i.$field,
            set: |i, x| i.$field = x,
        };
        real!(
            $unit,
            $shown,
            $min,
            $max,
            $nominal,
            row!(
                $reference,
                stringify!($field),
                Real,
                Input,
                Continuous,
                ACCESS,
                $description
            )
        )
    }};
}

/// Output or local of type Real.
macro_rules! number {
    ($causality:ident, $variability:ident, $reference:literal, $field:ident, $unit:literal, $shown:literal, $min:expr, $max:expr, $nominal:expr, $description:literal) => {{
        const ACCESS: Access = Access::Output(|o| Value::Real(o.$field));
        real!(
            $unit,
            $shown,
            $min,
            $max,
            $nominal,
            row!(
                $reference,
                stringify!($field),
                Real,
                $causality,
                $variability,
                ACCESS,
                $description
            )
        )
    }};
}

macro_rules! output {
    ($($cell:tt)*) => { number!(Output, Continuous, $($cell)*) };
}

macro_rules! local {
    ($($cell:tt)*) => { number!(Local, Continuous, $($cell)*) };
}

/// Output or local of type Integer.
macro_rules! count {
    ($causality:ident, $reference:literal, $field:ident, $description:literal) => {
        row!(
            $reference,
            stringify!($field),
            Integer,
            $causality,
            Discrete,
            Access::Output(|o| Value::Integer(o.$field)),
            $description
        )
    };
}

/// Output of type Boolean.
macro_rules! flag {
    ($reference:literal, $field:ident, $description:literal) => {
        row!(
            $reference,
            stringify!($field),
            Boolean,
            Output,
            Discrete,
            Access::Output(|o| Value::Boolean(o.$field)),
            $description
        )
    };
}

/// Accessors of a leaf whose field has the type of the value's kind.
macro_rules! leaf {
    ($kind:ident, $section:ident . $field:ident) => {
        Access::Parameter {
            get: |s| Value::$kind(s.$section.$field.clone()),
            set: |s, v| {
                if let Value::$kind(x) = v {
                    s.$section.$field = x;
                }
            },
        }
    };
    ($kind:ident, $section:ident . $part:ident . $field:ident) => {
        Access::Parameter {
            get: |s| Value::$kind(s.$section.$part.$field.clone()),
            set: |s, v| {
                if let Value::$kind(x) = v {
                    s.$section.$part.$field = x;
                }
            },
        }
    };
    ($kind:ident, $field:ident) => {
        Access::Parameter {
            get: |s| Value::$kind(s.$field.clone()),
            set: |s, v| {
                if let Value::$kind(x) = v {
                    s.$field = x;
                }
            },
        }
    };
}

/// Parameter of type Real, fixed.
macro_rules! fixed {
    ($reference:literal, $name:literal, $section:ident . $($field:ident).+, $unit:literal, $shown:literal, $min:expr, $max:expr, $nominal:expr, $description:literal) => {{
        const ACCESS: Access = leaf!(Real, $section.$($field).+);
        real!(
            $unit,
            $shown,
            $min,
            $max,
            $nominal,
            row!(
                $reference,
                $name,
                Real,
                Parameter,
                Fixed,
                ACCESS,
                $description
            )
        )
    }};
}

/// Parameter of type Real that may change between steps.
macro_rules! tunable {
    ($($cell:tt)*) => { Variable { variability: Variability::Tunable, ..fixed!($($cell)*) } };
}

/// Parameter of type Real that only the native command reads.
macro_rules! native {
    ($($cell:tt)*) => { Variable { native_only: true, ..fixed!($($cell)*) } };
}

/// Parameter of type Boolean.
macro_rules! switch {
    ($reference:literal, $name:literal, $section:ident . $field:ident, $description:literal) => {
        row!(
            $reference,
            $name,
            Boolean,
            Parameter,
            Fixed,
            leaf!(Boolean, $section.$field),
            $description
        )
    };
}

/// Parameter of type String; with choices where only those are allowed.
macro_rules! text {
    ($reference:literal, $name:literal, ($($path:tt)*), [$($choice:literal),*], $description:literal) => {
        Variable {
            choices: &[$($choice),*],
            ..row!($reference, $name, String, Parameter, Fixed, leaf!(String, $($path)*), $description)
        }
    };
}

/// Parameter of type String that only the native command reads.
macro_rules! native_text {
    ($($cell:tt)*) => { Variable { native_only: true, ..text!($($cell)*) } };
}

/// Parameter of type String whose start value in the FMU is not the scene's.
macro_rules! fmu_text {
    ($start:literal, $($cell:tt)*) => { Variable { fmu_start: Some($start), ..text!($($cell)*) } };
}

/// Number of a text's choice, for importers of the FMU that set no texts. A scene has the text only.
macro_rules! number_of {
    ($reference:literal, $name:literal, $text:literal, $count:literal, $description:literal) => {
        Variable {
            min: Some(0.0),
            max: Some($count),
            ..row!(
                $reference,
                $name,
                Integer,
                Parameter,
                Fixed,
                Access::Choice($text),
                $description
            )
        }
    };
}

macro_rules! table {
    ($($row:ident ( $($cell:tt)* ) ;)*) => {
        pub(super) static TABLE: &[Variable] = &[$($row!($($cell)*)),*];
    };
}

table! {
    input(0, spindle_speed, "rad/s", "rpm", -2000.0, 2000.0, 100.0, "angular velocity of the core about +y");
    input(1, nozzle_position, "m", "mm", -10.0, 10.0, 1e-2, "nozzle along the core axis, y");
    input(2, tension_setpoint, "N", "", 0.0, 1e4, 10.0, "pull of the tensioner");
    input(3, nozzle_offset_x, "m", "mm", -10.0, 10.0, 1e-2, "nozzle farther from the core axis than nozzle.distance, along x");
    input(4, nozzle_offset_z, "m", "mm", -10.0, 10.0, 1e-2, "nozzle beside where the scene has it, along z");
    input(5, brake_torque, "N.m", "N.mm", 0.0, 1e4, 0.1, "torque that holds the tensioner's wheel back; over tensioner.radius it adds to tension_setpoint");
    input(6, tensioner_damping, "N.s/m", "", 0.0, 1e4, 1.0, "damper on the tensioner beside tensioner.damping: pull per speed of the wire that it lets go");

    output(100, wire_tension, "N", "", -1e4, 1e5, 10.0, "tension in the free span at the nozzle exit; 0 at the end of the step in which winding ends, and from then on");
    output(101, wire_tension_min, "N", "", -1e4, 1e5, 10.0, "smallest wire_tension since the last communication point");
    output(102, wire_tension_max, "N", "", -1e4, 1e5, 10.0, "largest wire_tension since the last communication point");
    flag(103, defect_bulge, "wire stands off the core, or the layer below, by more than allowed");
    flag(104, defect_gap, "neighbouring turns lie apart by more than allowed");
    flag(105, defect_overlap, "a turn has climbed on its neighbour or changed places with it");
    flag(106, defect_break, "the wire has parted: tension above its strength, or a kink");
    flag(107, defect_slack, "tension below the weight of half the free span, for eight degrees of the core or for as long as the tensioner takes to follow");
    count(Output, 108, defect_code, "bit mask: bulge 1, gap 2, overlap 4, break 8, slack 16, double turn 32, skipped groove 64, early layer jump 128, late layer jump 256, loose turn 512, overstretch 1024, collision 2048, runaway 4096");
    count(Output, 109, defect_count, "defects of coil and wire, of every kind");
    output(110, defect_turn, "1", "", -1e6, 1e6, 1.0, "turn of the last defect, where it was found");
    output(111, defect_angle, "rad", "deg", -1e7, 1e7, 1.0, "polar angle of the last defect within its turn, where it was found");
    output(112, bulge_height, "m", "mm", -10.0, 10.0, 1e-3, "largest bulge of the last 360 settled stations");
    output(113, gap_width, "m", "mm", -10.0, 10.0, 1e-4, "widest gap to the neighbouring turn, last settled turn");
    output(114, overlap_depth, "m", "mm", -10.0, 10.0, 1e-4, "deepest overlap with the neighbouring turn, last settled turn");
    output(115, turns_wound, "1", "", -1e6, 1e6, 1.0, "turns laid, counted from the clamp");
    output(116, turns_settled, "1", "", -1e6, 1e6, 1.0, "turns come to rest; falls on reversal");
    count(Output, 117, layer, "layer that is being laid, from 1; that of the last settled wire where no layers are planned");
    output(118, spindle_angle, "rad", "deg", -1e7, 1e7, 10.0, "core angle from the start position");
    output(119, spindle_torque, "N.m", "N.mm", -1e4, 1e4, 0.1, "moment of the wire on the core about +y; negative when it resists positive speed");
    output(120, feed_speed, "m/s", "", -1e4, 1e4, 1.0, "speed of the wire leaving the nozzle; 0 at the end of the step in which winding ends, and from then on");
    output(121, fed_length, "m", "", -1e6, 1e6, 0.1, "wire that has left the nozzle since the start");
    output(122, free_length, "m", "mm", -1.0, 1e3, 5e-2, "wire between lift-off and nozzle");
    output(123, layon_position, "m", "mm", -10.0, 10.0, 1e-2, "where the wire meets the coil, along y");
    output(124, layon_angle, "rad", "deg", -1e7, 1e7, 1.0, "where the wire meets the coil: angle along the turns from the clamp, in the frame of the core; it grows whichever way the spindle turns");
    output(125, coil_width, "m", "mm", -1.0, 10.0, 1e-3, "extent of the settled wire along y");
    output(126, mean_pitch, "m", "mm", -10.0, 10.0, 1e-3, "mean axial advance per turn of the settled wire");
    output(127, fill_factor, "1", "", 0.0, 10.0, 1.0, "wire section over the winding section it takes up, settled wire");
    output(128, wire_strain, "1", "", -10.0, 10.0, 1e-2, "largest plastic stretch of the last settled turn");

    count(Output, 129, defect_count_bulge, "bulges of the settled wire");
    count(Output, 130, defect_count_gap, "gaps of the settled wire");
    count(Output, 131, defect_count_overlap, "overlaps of the settled wire");
    count(Output, 132, defect_count_break, "breaks so far");
    count(Output, 133, defect_count_slack, "how often the wire went slack so far; slack within a quarter of a turn of the last is the same");
    count(Output, 134, defect_kind, "kind of the last defect, as in defect_code; 0: none so far");
    output(135, defect_time, "s", "", -1e9, 1e9, 1.0, "time since the start of the run at which the wire of the last defect came to rest; for slack, break, collision and runaway when it happened. It is found later, when the wire beside it is at rest too");
    output(136, defect_size, "m", "mm", -10.0, 10.0, 1e-4, "size of the last defect where it was found; 0 for what befalls the wire (slack, break, collision, runaway) and for a turn that is loose by its tension alone");
    output(137, tensioner_position, "m", "mm", -1e6, 1e6, 0.1, "wire let go by the tensioner since the start");
    output(138, tensioner_speed, "m/s", "", -1e4, 1e4, 1.0, "speed of the wire at the tensioner");
    output(139, nozzle_angle, "rad", "deg", -1.6, 1.6, 0.1, "angle at the nozzle between the free span and the plane across the axis; positive where the wire on its way from the nozzle to the core goes towards larger y");
    output(140, wire_length, "m", "", 0.0, 1e6, 1.0, "wire from the clamp to where it meets the coil, unstretched");

    output(141, nozzle_y, "m", "mm", -10.0, 10.0, 1e-2, "nozzle along the core axis: that of nozzle_position, or of the traverse law, traverse.mode");
    output(142, layon_x, "m", "mm", -10.0, 10.0, 1e-2, "where the wire's centreline meets the coil, along x; the frame does not turn, the nozzle is on +x");
    output(143, layon_z, "m", "mm", -10.0, 10.0, 1e-2, "where the wire's centreline meets the coil, along z of the same frame; layon_position is along y");
    output(144, turn_in_layer, "1", "", -1e6, 1e6, 1.0, "turns of the layer that is being laid: wire laid since it climbed there, or since the nozzle reversed where no layers are planned");
    output(145, flange_clearance, "m", "mm", -10.0, 10.0, 1e-3, "from the surface of the wire where it meets the coil to the nearer flange, along y; without flanges to the nearer end of the core");
    output(146, wire_resistance, "Ohm", "mOhm", 0.0, 1e9, 0.1, "resistance of wire_length at 20 degC; plastic stretch makes it longer and thinner");
    output(147, coil_inertia, "kg.m2", "g.mm2", 0.0, 1e3, 1e-6, "moment of inertia of the settled wire about the core axis, without the core's");
    output(148, spindle_torque_total, "N.m", "N.mm", -1e6, 1e6, 0.1, "spindle_torque less coil_inertia times the mean acceleration of the last step; the core's own inertia is the drive's");
    output(149, break_position, "m", "", 0.0, 1e6, 1.0, "unstretched wire from the clamp to where it broke; 0: it is whole");

    count(Output, 150, defect_count_double_turn, "double turns of the settled wire");
    count(Output, 151, defect_count_skipped_groove, "skipped grooves of the settled wire");
    count(Output, 152, defect_count_early_jump, "early layer jumps of the settled wire");
    count(Output, 153, defect_count_late_jump, "late layer jumps of the settled wire");
    count(Output, 154, defect_count_loose_turn, "loose turns of the settled wire");
    count(Output, 155, defect_count_overstretch, "overstretched turns of the settled wire");
    count(Output, 156, defect_count_collision, "collisions of the nozzle with coil, flange or core so far");
    count(Output, 157, defect_count_runaway, "how often wire shot out of the nozzle so far");

    local(200, solver_steps, "1", "", 0.0, 1e18, 1e5, "time steps taken");
    local(201, solver_rejects, "1", "", 0.0, 1e18, 1.0, "time steps rejected");
    count(Local, 202, live_nodes, "nodes still computed");
    local(203, penetration_max, "m", "um", -1.0, 1.0, 1e-6, "deepest penetration in contact since the last communication point");
    local(204, energy_residual, "J", "", -1e9, 1e9, 1e-3, "error of the energy balance since the start");

    text(1000, "wire.material", (wire.material), ["copper", "table1", "custom", "copper-soft", "copper-half-hard", "copper-hard", "aluminium"], "copper: rigidities from modulus and section; table1: the paper's wire of 0.7 mm; custom: every rigidity given; the others: metals of the library");
    switch(1001, "wire.elastic", wire.elastic, "true: no yield, no moment cap, and no break unless wire.strength is given");
    fixed(1002, "wire.diameter", wire.diameter, "m", "mm", 2e-5, 5e-3, 1e-3, "diameter of the bare round wire: stiffness, yield, mass of the metal and resistance go with it");
    fixed(1003, "wire.density", wire.density, "kg/m3", "", 0.0, 3e4, 1e4, "density of the metal, 100 at least; 0: of the material");
    fixed(1004, "wire.yield_stress", wire.yield_stress, "Pa", "MPa", 0.0, 1e10, 1e8, "stress at first yield, 0.1 MPa at least; makes N_y, M_y and T_y where those are 0; 0: of the material");
    fixed(1005, "wire.flow_stress", wire.flow_stress, "Pa", "MPa", 0.0, 1e10, 1e8, "stress at the end of hardening, 0.1 MPa at least; makes strength and moment cap where those are 0; 0: of the material");
    fixed(1006, "wire.EA", wire.ea, "N", "", 0.0, 1e9, 1e4, "stretch rigidity; 0: of the material");
    fixed(1007, "wire.EAp", wire.ea_p, "N", "", 0.0, 1e9, 1e3, "stretch rigidity beyond yield; 0: of the material");
    fixed(1008, "wire.EI", wire.ei, "N.m2", "", 0.0, 1e3, 1e-3, "bending rigidity; 0: of the material");
    fixed(1009, "wire.EIp", wire.ei_p, "N.m2", "", 0.0, 1e3, 1e-4, "bending rigidity beyond yield; 0: of the material");
    fixed(1010, "wire.GJ", wire.gj, "N.m2", "", 0.0, 1e3, 1e-3, "torsional rigidity; 0: of the material");
    fixed(1011, "wire.GJp", wire.gj_p, "N.m2", "", 0.0, 1e3, 1e-4, "torsional rigidity beyond yield; 0: of the material");
    fixed(1012, "wire.N_y", wire.n_y, "N", "", 0.0, 1e6, 10.0, "axial force at yield; 0: of the material");
    fixed(1013, "wire.M_y", wire.m_y, "N.m", "N.mm", 0.0, 1e3, 1e-2, "bending moment at yield; 0: of the material");
    fixed(1014, "wire.T_y", wire.t_y, "N.m", "N.mm", 0.0, 1e3, 1e-2, "torque at yield; 0: of the material");
    fixed(1015, "wire.moment_cap", wire.moment_cap, "N.m", "N.mm", 0.0, 1e3, 1e-2, "largest bending moment; 0: flow_stress d^3/6, none for table1 and custom");
    fixed(1016, "wire.strength", wire.strength, "N", "", 0.0, 1e6, 100.0, "tension at break; 0: flow_stress times area");
    fixed(1017, "wire.enamelled_diameter", wire.enamelled_diameter, "m", "mm", 0.0, 1e-2, 1e-3, "outer diameter over the enamel: contact, gaps, heights and pitch go with it; 0: bare wire");
    fixed(1018, "wire.enamel_density", wire.enamel_density, "kg/m3", "", 0.0, 1e4, 1e3, "density of the enamel, which has mass and no stiffness");
    fixed(1019, "wire.resistivity", wire.resistivity, "Ohm.m", "", 0.0, 1e-4, 1e-8, "resistivity at 20 degC; 0: of the material");
    text(1020, "wire.stress_strain", (wire.stress_strain), [], "points [[strain, stress in Pa], ...] of the metal's stress-strain curve from yield on, which make rigidities and limits; empty: of the material");

    text(1100, "core.shape", (core.shape), ["rounded-box", "cylinder", "mesh"], "shape of the core");
    fixed(1101, "core.width_x", core.width_x, "m", "mm", 1e-4, 1.0, 1e-2, "rounded box: full width along x");
    fixed(1102, "core.height_z", core.height_z, "m", "mm", 1e-4, 1.0, 1e-2, "rounded box: full height along z");
    fixed(1103, "core.length_y", core.length_y, "m", "mm", 1e-4, 10.0, 1e-2, "rounded box and cylinder: full length along the axis");
    fixed(1104, "core.corner_radius", core.corner_radius, "m", "mm", 0.0, 1.0, 1e-3, "rounded box: radius of the four long edges");
    fixed(1105, "core.radius", core.radius, "m", "mm", 5e-5, 1.0, 1e-2, "cylinder: radius");
    text(1106, "core.file", (core.file), [], "mesh: STL file, relative to the scene file, set in the FMU relative to its resources or as given; axis along y");
    text(1107, "core.unit", (core.unit), ["m", "mm", "um", "inch"], "mesh: unit of the STL file");
    fixed(1108, "core.flange.inner_distance", core.flange.inner_distance, "m", "mm", 0.0, 10.0, 1e-2, "distance of the inner faces of two flanges; 0: no flanges");
    fixed(1109, "core.flange.height", core.flange.height, "m", "mm", 1e-5, 1.0, 1e-3, "how far the rim of the flanges stands above the core");
    fixed(1110, "core.flange.thickness", core.flange.thickness, "m", "mm", 1e-5, 1.0, 1e-3, "thickness of each flange along the axis");
    fixed(1111, "core.flange.edge_radius", core.flange.edge_radius, "m", "mm", 0.0, 1.0, 1e-4, "radius of the edges of the flanges' rim");
    fixed(1112, "core.flange.insulation", core.flange.insulation, "m", "mm", 0.0, 1e-2, 1e-3, "thickness of the insulation on the inner faces of the flanges");
    fixed(1113, "core.insulation", core.insulation, "m", "mm", 0.0, 1e-2, 1e-3, "rounded box and cylinder: thickness of the insulation round the core, under the wire");
    fixed(1114, "core.window_height", core.window_height, "m", "mm", 0.0, 1.0, 1e-2, "height over the insulated core that the coil may take, to the neighbouring coil's limit line; 0: to the rim of the flanges");
    fixed(1115, "core.window_taper", core.window_taper, "rad", "deg", -1.4, 1.4, 0.1, "angle of the limit line to the axis: it is window_height high at y = 0 and rises towards +y");

    fixed(1200, "nozzle.distance", nozzle.distance, "m", "mm", 1e-3, 10.0, 0.1, "nozzle exit from the core axis, on +x");
    fixed(1201, "nozzle.y_start", nozzle.y_start, "m", "mm", -10.0, 10.0, 1e-2, "nozzle along the core axis at the start; not set, with layers planned between flanges: where the first turn lies beside its flange");
    fixed(1202, "nozzle.exit_friction", nozzle.exit_friction, "1", "", 0.0, 2.0, 0.1, "friction at the exit, share of tension per rad of deflection");
    switch(1203, "nozzle.position_at_start", nozzle.position_at_start, "where the nozzle is by nozzle_position without a rate; false: there at the end of the step; true: there at its start, as in a recording, and on from there as fast as between the last two places");
    fixed(1204, "nozzle.outer_diameter", nozzle.outer_diameter, "m", "mm", 0.0, 1.0, 1e-3, "outer diameter of the nozzle's body, a round rod from the exit outwards along +x; 0: the nozzle is a point");
    fixed(1205, "nozzle.length", nozzle.length, "m", "mm", 0.0, 10.0, 1e-2, "length of the nozzle's body; 0: without end");
    fixed(1206, "nozzle.edge_radius", nozzle.edge_radius, "m", "mm", 0.0, 0.5, 1e-3, "radius of the outer rim of the nozzle's body, at its exit and at its end");
    fixed(1207, "nozzle.bore", nozzle.bore, "m", "mm", 0.0, 1.0, 1e-3, "diameter of the nozzle's hole; 0: not said");
    fixed(1208, "nozzle.exit_radius", nozzle.exit_radius, "m", "mm", 0.0, 1.0, 1e-3, "radius of the edge of the nozzle's hole at its exit, over which wire that leaves at an angle bends; 0: bending does not count");

    fixed(1300, "tensioner.tension", tensioner.tension, "N", "", 0.0, 1e4, 10.0, "set pull; start value of tension_setpoint");
    fixed(1301, "tensioner.mass", tensioner.mass, "kg", "g", 0.0, 100.0, 1e-3, "equivalent mass of the tensioner; 0: constant pull at the nozzle");
    fixed(1302, "tensioner.line_length", tensioner.line_length, "m", "", 0.0, 100.0, 1.0, "wire between tensioner and nozzle");
    fixed(1303, "tensioner.line_damping_ratio", tensioner.line_damping_ratio, "1", "", 0.0, 10.0, 0.1, "damping ratio of the mass on the line");
    fixed(1304, "tensioner.damping", tensioner.damping, "N.s/m", "", 0.0, 1e4, 1.0, "damper on the tensioner: pull per speed of the wire that it lets go");
    fixed(1305, "tensioner.radius", tensioner.radius, "m", "mm", 1e-3, 10.0, 0.1, "radius of the tensioner's wheel, on which brake_torque acts");
    fixed(1306, "tensioner.brake_torque_max", tensioner.brake_torque_max, "N.m", "N.mm", 0.0, 1e4, 0.1, "largest torque of the brake: brake_torque above it counts as this; 0: none");
    switch(1307, "tensioner.line_inertia", tensioner.line_inertia, "whether wire between tensioner and nozzle has its mass: half of each span's goes to either end");
    fixed(1308, "tensioner.pulley_mass", tensioner.pulley_mass, "kg", "g", 0.0, 100.0, 1e-3, "guide pulley: moment of inertia over the square of its radius; 0 with pulley_friction = 0: no pulley");
    fixed(1309, "tensioner.pulley_friction", tensioner.pulley_friction, "N", "", 0.0, 1e4, 1.0, "guide pulley: friction of its bearing, as a force on the wire");
    fixed(1310, "tensioner.pulley_place", tensioner.pulley_place, "1", "", 0.01, 0.99, 1.0, "guide pulley: share of the line between nozzle and pulley");

    fixed(1400, "start.clamp_y", start.clamp_y, "m", "mm", -10.0, 10.0, 1e-2, "wire end along the core axis, on the +x face; not set, with layers planned or a table: where the nozzle begins");

    native(1500, "spindle.speed", spindle.speed, "rad/s", "rpm", 0.1, 2000.0, 100.0, "final speed of the scene's own motion profile");
    native(1501, "spindle.ramp_turns", spindle.ramp_turns, "1", "", 1e-3, 1e3, 1.0, "revolutions over which the speed rises, at constant acceleration");
    native(1502, "spindle.turns", spindle.turns, "1", "", 0.0, 1e5, 1.0, "revolutions of the spindle until the scene's own motion profile ends; 0: those of the winding, or 2.5 with traverse.mode = by-angle");

    native_text(1503, "spindle.file", (spindle.file), [], "CSV file of the spindle's angle and the share of its speed that is allowed there, relative to the scene file");
    native(1504, "spindle.repeat_turns", spindle.repeat_turns, "1", "", 0.0, 1e5, 1.0, "revolutions after which the table of spindle.file begins again; 0: it does not");
    native(1505, "spindle.flange_share", spindle.flange_share, "1", "", 0.01, 1.0, 1.0, "share of the speed that is allowed while wire climbs to the next planned layer");
    native(1506, "spindle.flange_turns", spindle.flange_turns, "1", "", 1e-3, 1e3, 1.0, "revolutions over which the speed falls before a climb with spindle.flange_share below 1, and rises after it");
    text(1507, "spindle.direction", (spindle.direction), ["auto", "+y", "-y"], "axis about which the core winds, right-handed, and for which the wire is strung at the start; auto: by the sign of spindle_speed at the start, +y where that is 0");

    fixed(1600, "traverse.per_turn", traverse.per_turn, "m", "mm", -1.0, 1.0, 1e-3, "by-angle: nozzle travel per revolution; the sign is its direction along y");
    fixed(1601, "traverse.lead", traverse.lead, "m", "mm", -1.0, 1.0, 1e-3, "constant lead of the nozzle over the traverse law; in layers, in the direction of each");
    fmu_text("by-input", 1602, "traverse.mode", (traverse.mode), ["by-input", "by-angle", "orthocyclic", "helical", "table"], "nozzle travel; by-input: as nozzle_position says, without inputs as by-angle; by-angle: even with the core's angle; orthocyclic: layers with a straight part and a crossover in each turn; helical: layers of even travel; table: from a file");
    fixed(1603, "traverse.crossover", traverse.crossover, "rad", "deg", 0.01, 6.0, 1.0, "orthocyclic: core angle of the crossover to the next turn");
    fixed(1604, "traverse.dwell_turns", traverse.dwell_turns, "1", "", 0.0, 10.0, 1.0, "helical: least revolutions that the nozzle stands at the end of a layer; it stays until the layer has its turns");
    text(1605, "traverse.file", (traverse.file), [], "table: CSV file of angle and nozzle position, relative to the scene file, set in the FMU relative to its resources or as given");
    fixed(1606, "traverse.advance", traverse.advance, "rad", "deg", 0.0, 6.0, 1.0, "core angle by which the nozzle is ahead of the traverse law in layers or a table");
    text(1607, "traverse.trail", (traverse.trail), ["free", "led"], "orthocyclic: what the traverse law says; free: where the nozzle is, and the wire trails behind it; led: where the wire is laid, in smooth crossovers, and the nozzle swings ahead of it; on a cylinder");
    fixed(1608, "traverse.crossover_delay", traverse.crossover_delay, "rad", "deg", 0.0, 6.0, 1.0, "orthocyclic: core angle after that of the clamp at which crossovers end");

    fixed(1650, "winding.turns_per_layer", winding.turns_per_layer, "1", "", 0.0, 1e5, 10.0, "layered traverse modes: turns of the first layer; 0: as many as fit between the flanges");
    fixed(1651, "winding.layers", winding.layers, "1", "", 1.0, 1000.0, 1.0, "layered traverse modes: number of layers");
    text(1652, "winding.direction", (winding.direction), ["+y", "-y"], "layered traverse modes: direction of the first layer");
    fixed(1653, "winding.pitch", winding.pitch, "m", "mm", 0.0, 1.0, 1e-3, "layered traverse modes: distance of neighbouring turns; 0: fills the window, or the wire's outer diameter without flanges");

    fixed(1700, "contact.stiffness", contact.stiffness, "N/m2", "", 1e6, 1e13, 1e10, "line load per depth");
    fixed(1701, "contact.restitution", contact.restitution, "1", "", 0.0, 1.0, 1.0, "rebound over impact speed");

    tunable(1800, "friction.static", friction.static_, "1", "", 0.0, 5.0, 0.1, "coefficient at rest, wire on core and wire on wire");
    tunable(1801, "friction.kinetic", friction.kinetic, "1", "", 0.0, 5.0, 0.1, "coefficient at high slip speed");
    fixed(1802, "friction.slip_speed", friction.slip_speed, "m/s", "mm/s", 1e-5, 100.0, 1e-2, "slip speed over which static turns into kinetic");

    text(1900, "solver.integrator", (solver.integrator), ["auto", "implicit", "rk4", "verlet"], "time integrator; auto: rk4 for preset paper, else implicit");
    fixed(1901, "solver.spacing_near", solver.spacing_near, "m", "mm", 0.0, 5e-2, 1e-3, "node spacing near the core; 0: in proportion to the outer diameter, for 0.7 mm 0.5 mm explicit and 0.3 mm implicit, there coarser as the cube root of a tolerance above its own, halved until fine enough for the bends on corners");
    fixed(1902, "solver.spacing_free", solver.spacing_free, "m", "mm", 0.0, 0.1, 1e-3, "node spacing in the free span; 0: eight times that near the core implicit, in proportion to the outer diameter explicit, 1 mm for 0.7 mm");
    fixed(1903, "solver.refine_distance", solver.refine_distance, "m", "mm", 0.0, 10.0, 1e-2, "distance from the core or the layer below at which free-span edges are split; 0: in proportion to the outer diameter, for 0.7 mm 3 mm implicit and 6 mm explicit");
    fixed(1904, "solver.step_share", solver.step_share, "1", "", 1e-3, 1.0, 1.0, "time step as a share of the stability limit");
    fixed(1905, "solver.step", solver.step, "s", "us", 0.0, 1e-2, 1e-6, "fixed time step; 0: from the error (implicit) or the stability limit");
    fixed(1906, "solver.tolerance", solver.tolerance, "m", "um", 0.0, 1e-3, 1e-6, "estimated error that a step of the implicit method may have, root mean square over the wire, 1e-9 m at least; 0: in proportion to the outer diameter, 2 um for 0.7 mm");
    text(1907, "solver.twist", (solver.twist), ["auto", "off", "quasi-static", "dynamic"], "how the wire's twist is carried; auto: the least that matters; dynamic with the explicit methods");
    text(1908, "solver.live_contact", (solver.live_contact), ["auto", "on", "off"], "contact of live wire with live wire; auto: from half a live turn on");
    text(1909, "solver.plasticity", (solver.plasticity), ["auto", "on", "off"], "plastic state of the wire; auto: where it can yield; off: elastic wire");
    text(1910, "solver.friction", (solver.friction), ["auto", "on", "off"], "friction; auto: where a coefficient is not 0");
    text(1911, "solver.inertia", (solver.inertia), ["auto", "on", "off"], "mass of the wire; auto: on; off: the wire goes through states of rest");
    text(1912, "solver.coarse_span", (solver.coarse_span), ["auto", "on", "off"], "coarser spacing in the free span; auto: where solver.spacing_free is more than solver.spacing_near");
    text(1913, "solver.coarse_settled", (solver.coarse_settled), ["auto", "on", "off"], "coarser spacing of settled live wire; auto: with the implicit method");
    text(1920, "solver.steps_beyond", (solver.steps_beyond), ["auto", "on", "off"], "steps that reach beyond a communication point while inputs go on as they did; auto: where the method finds its own steps; on: beyond rows of a run of the scene's own motion too");

    switch(2000, "freeze.enabled", freeze.enabled, "false keeps all wire in the computation");
    fixed(2001, "freeze.window", freeze.window, "rad", "deg", 1e-3, 100.0, 1.0, "core angle over which motion is judged");
    fixed(2002, "freeze.creep", freeze.creep, "m/rad", "um/rad", 0.0, 1.0, 1e-6, "largest motion of wire at rest per core angle; 0: in proportion to the outer diameter, 2 um/rad for 0.7 mm");
    fixed(2003, "freeze.keep_length", freeze.keep_length, "m", "mm", 0.0, 100.0, 1e-2, "settled wire kept live behind lift-off; 0: 1.75 sqrt(EI/T)");
    fixed(2004, "freeze.margin", freeze.margin, "m", "mm", 0.0, 1.0, 1e-2, "farthest the centreline may be from a diameter over the core or the layer below, up to freeze.patience turns behind lift-off; 0: in proportion to the outer diameter, 5 mm for 0.7 mm");
    fixed(2005, "freeze.time", freeze.time, "s", "ms", 0.0, 1e6, 1e-2, "time over which motion is judged while the spindle stands; 0: ten periods of the free span's slowest ringing at the start");
    fixed(2006, "freeze.patience", freeze.patience, "1", "", 0.0, 1000.0, 1.0, "turns behind lift-off from which on creep may double each quarter of a turn, up to a twentieth of the diameter in all");

    tunable(2100, "defects.gap", defects.gap, "1", "", 0.0, 100.0, 0.1, "gap above this many diameters ...");
    tunable(2101, "defects.gap_fraction", defects.gap_fraction, "1", "", 0.0, 1.0, 0.1, "... over at least this fraction of a turn without a break");
    tunable(2102, "defects.bulge_excess", defects.bulge_excess, "1", "", 0.0, 100.0, 1.0, "bulge over the quasi-static height allowed, diameters");
    tunable(2103, "defects.bulge_absolute", defects.bulge_absolute, "m", "mm", 0.0, 1.0, 1e-3, "bulge allowed; 0: bulge_excess decides, or one diameter where no quasi-static height is known");
    tunable(2104, "defects.overlap_axial", defects.overlap_axial, "1", "", 0.0, 1.0, 1.0, "axial distance to the neighbour below this many diameters ...");
    tunable(2105, "defects.overlap_height", defects.overlap_height, "1", "", 0.0, 100.0, 1.0, "... while it stands this many diameters higher than at rest over what it was laid on");
    tunable(2106, "defects.skip_angle", defects.skip_angle, "rad", "deg", 0.0, 1e3, 1.0, "polar angle after the clamp that is left out");
    tunable(2120, "defects.double_turn", defects.double_turn, "1", "", 0.0, 10.0, 1.0, "fraction of a turn over which wire stands on its own row to be a double turn");
    tunable(2121, "defects.skipped_groove", defects.skipped_groove, "1", "", 0.0, 10.0, 1.0, "fraction of a turn over which a groove of the layer below lies empty beside the wire");
    tunable(2122, "defects.jump", defects.jump, "1", "", 0.0, 1e3, 1.0, "turns by which a layer jump may come before or after the planned one; judged where the scene has winding.turns_per_layer or a layered traverse mode");
    tunable(2123, "defects.loose_height", defects.loose_height, "1", "", 0.0, 100.0, 0.1, "bulge over the quasi-static height above which wire touches nothing, diameters ...");
    tunable(2124, "defects.loose_fraction", defects.loose_fraction, "1", "", 0.0, 1.0, 1.0, "... and the share of a turn that may do so");
    tunable(2125, "defects.loose_tension", defects.loose_tension, "1", "", 0.0, 1.0, 1.0, "least mean tension of a settled turn, as a share of tensioner.tension, or of the tension at the start where that is more or the scene gives none");
    tunable(2126, "defects.stretch", defects.stretch, "1", "", 0.0, 10.0, 1e-2, "plastic stretch allowed");

    native(2200, "output.history_interval", output.history_interval, "rad", "deg", 1e-5, 1e3, 1e-2, "core angle between rows of history.csv");
    text(2201, "output.directory", (output.directory), [], "where result files go; empty: the FMU writes none");

    text(2300, "scene.file", (file), [], "packed name or path of a scene; empty: default");
    text(2301, "preset", (preset), ["default", "paper"], "default: the production method; paper: the paper's method (rk4)");

    number_of(3000, "wire.material_number", "wire.material", 7.0, "number of wire.material; 0: as wire.material says, 1 copper, 2 table1, 3 custom, 4 copper-soft, 5 copper-half-hard, 6 copper-hard, 7 aluminium");
    number_of(3001, "core.shape_number", "core.shape", 3.0, "number of core.shape; 0: as core.shape says, 1 rounded-box, 2 cylinder, 3 mesh");
    number_of(3002, "core.unit_number", "core.unit", 4.0, "number of core.unit; 0: as core.unit says, 1 m, 2 mm, 3 um, 4 inch");
    number_of(3003, "traverse.mode_number", "traverse.mode", 5.0, "number of traverse.mode; 0: as traverse.mode says, 1 by-input, 2 by-angle, 3 orthocyclic, 4 helical, 5 table");
    number_of(3004, "winding.direction_number", "winding.direction", 2.0, "number of winding.direction; 0: as winding.direction says, 1 +y, 2 -y");
    number_of(3005, "solver.integrator_number", "solver.integrator", 4.0, "number of solver.integrator; 0: as solver.integrator says, 1 auto, 2 implicit, 3 rk4, 4 verlet");
    number_of(3006, "solver.twist_number", "solver.twist", 4.0, "number of solver.twist; 0: as solver.twist says, 1 auto, 2 off, 3 quasi-static, 4 dynamic");
    number_of(3007, "solver.live_contact_number", "solver.live_contact", 3.0, "number of solver.live_contact; 0: as solver.live_contact says, 1 auto, 2 on, 3 off");
    number_of(3008, "solver.plasticity_number", "solver.plasticity", 3.0, "number of solver.plasticity; 0: as solver.plasticity says, 1 auto, 2 on, 3 off");
    number_of(3009, "solver.friction_number", "solver.friction", 3.0, "number of solver.friction; 0: as solver.friction says, 1 auto, 2 on, 3 off");
    number_of(3010, "solver.inertia_number", "solver.inertia", 3.0, "number of solver.inertia; 0: as solver.inertia says, 1 auto, 2 on, 3 off");
    number_of(3011, "solver.coarse_span_number", "solver.coarse_span", 3.0, "number of solver.coarse_span; 0: as solver.coarse_span says, 1 auto, 2 on, 3 off");
    number_of(3012, "solver.coarse_settled_number", "solver.coarse_settled", 3.0, "number of solver.coarse_settled; 0: as solver.coarse_settled says, 1 auto, 2 on, 3 off");
    number_of(3013, "solver.steps_beyond_number", "solver.steps_beyond", 3.0, "number of solver.steps_beyond; 0: as solver.steps_beyond says, 1 auto, 2 on, 3 off");
    number_of(3014, "preset_number", "preset", 2.0, "number of preset; 0: as preset says, 1 default, 2 paper");
    number_of(3015, "traverse.trail_number", "traverse.trail", 2.0, "number of traverse.trail; 0: as traverse.trail says, 1 free, 2 led");
    number_of(3016, "spindle.direction_number", "spindle.direction", 3.0, "number of spindle.direction; 0: as spindle.direction says, 1 auto, 2 +y, 3 -y");
}
