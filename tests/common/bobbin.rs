//! A small bobbin between flanges: six turns of 0.7 mm and half a turn's room, layers as asked.

/// Outer diameter of its wire, m.
pub const DIAMETER: f64 = 0.7e-3;
/// Turns that are planned in a layer.
pub const TURNS: usize = 6;
/// Polar angles between crossovers, degrees.
pub const STRAIGHT: std::ops::Range<usize> = 45..200;

/// The scene as TOML, for more keys behind it; its last table is `[winding]`.
pub fn small_bobbin(layers: usize, tension_n: f64) -> String {
    format!(
        "
[core]
shape = 'cylinder'
radius_mm = 6
[core.flange]
inner_distance_mm = 4.65
height_mm = 3
thickness_mm = 1
edge_radius_mm = 0.3
[nozzle]
distance_mm = 25
y_start_mm = -1.975
[start]
clamp_y_mm = -1.975
[tensioner]
tension = {tension_n}
[spindle]
speed = 100
[solver]
tolerance_um = 5
[traverse]
mode = 'orthocyclic'
crossover_deg = 60
advance_deg = 90
[winding]
layers = {layers}
"
    )
}
