//! The coil as a product: what a drawing or a bill of material says of it.

use crate::measure::LayerContour;
use crate::simulation::Winding;
use serde::Serialize;
use std::f64::consts::PI;

/// The coil as a product, over the settled wire.
///
/// The bits of these numbers do not enter a computation.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Product {
    /// turns at rest
    pub turns: f64,
    /// layers that settled wire lies in; less than two turns that climb over them are none
    pub layers: u32,
    /// name of the material
    pub material: String,
    /// diameter of the bare wire, m
    pub wire_diameter_m: f64,
    /// diameter over the enamel, m; that of the bare wire without
    pub enamelled_diameter_m: f64,
    /// least diameter over the enamel that plastic stretch leaves to settled wire, m: it keeps the volume
    pub thinnest_diameter_m: f64,
    /// unstretched length of the settled wire from the clamp, m
    pub wire_length_m: f64,
    /// mass of that wire with its enamel, kg
    pub wire_mass_kg: f64,
    /// resistivity of the wire at 20 degC, ohm m
    pub resistivity_ohm_m: f64,
    /// resistance of that wire at 20 degC, with its plastic stretch, ohm
    pub resistance_ohm: f64,
    /// wire section with its enamel over the winding section it takes up, as the output `fill_factor`
    pub fill: f64,
    /// how full the winding window is; `None` without flanges
    pub window: Option<Fill>,
    /// how full the coil is: its width, and the height of its last layer in the grooves; `None` without wire
    pub coil: Option<Fill>,
    /// outer side of each layer over the core
    pub contour: Vec<LayerContour>,
    /// least distance of the wire from the limit line, m; negative beyond it, `None` without a limit
    pub clearance_m: Option<f64>,
}

/// A rectangle over the core, and the share of it that wire takes up: turns at rest times the section of the wire. Wire that lies
/// over it, beyond the limit line or over the last layer, does not count.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Fill {
    /// along the axis, m
    pub width_m: f64,
    /// over the core, m
    pub height_m: f64,
    /// share of metal
    pub fill_bare: f64,
    /// share of wire with its enamel
    pub fill_enamelled: f64,
    /// inner faces of the flanges along y, m, of the winding window
    #[serde(skip_serializing_if = "Option::is_none")]
    pub faces_m: Option<[f64; 2]>,
}

impl Winding {
    /// Resistance of so much unstretched wire, m, at 20 degC, ohm, to which plastic stretch adds as much as `added`, m of it, would.
    ///
    /// Elastic stretch is left out: it goes with the tension and adds a few thousandths at most.
    pub(in crate::simulation) fn resistance_of(&self, length: f64, added: f64) -> f64 {
        self.scene.resistivity * (length + added) / self.scene.wire.bare_area()
    }

    /// The coil as a product.
    pub fn product(&self) -> Product {
        let wire = &self.scene.wire;
        let last = self.coil.stations().last();
        let length = last.map_or(0.0, |station| station.arc);
        let turns = self.run.outputs.turns_settled;
        let fill = |turns: f64, width_m: f64, height_m: f64| {
            let share = |d: f64| turns * 0.25 * PI * d * d / (width_m * height_m);
            Fill {
                width_m,
                height_m,
                fill_bare: share(wire.bare_diameter),
                fill_enamelled: share(wire.diameter),
                faces_m: None,
            }
        };
        let contour = self.coil.contour();
        let layers = self.coil.layers();
        let top = contour.iter().find(|layer| layer.layer == layers);
        let in_layers = turns - self.coil.turns_over(layers);
        let limit = self.scene.window;
        Product {
            turns,
            layers,
            material: self.scene.wire_material.clone(),
            wire_diameter_m: wire.bare_diameter,
            enamelled_diameter_m: wire.diameter,
            thinnest_diameter_m: wire.diameter * self.least_diameter(),
            wire_length_m: length,
            wire_mass_kg: wire.mass_per_length() * length,
            resistivity_ohm_m: self.scene.resistivity,
            resistance_ohm: self.resistance_of(length, self.coil.added_by_stretch(length)),
            fill: self.coil.fill_factor(),
            window: limit.and_then(|window| Some((window, window.size()?))).map(
                |(window, [width, height])| {
                    let beyond = self.coil.turns_beyond(window.height, window.taper);
                    Fill {
                        faces_m: window.faces,
                        ..fill(turns - beyond, width, height)
                    }
                },
            ),
            coil: top.map(|layer| fill(in_layers, self.coil.coil_width(), layer.height_groove_m)),
            contour,
            clearance_m: limit.and_then(|window| self.coil.clearance(window.height, window.taper)),
        }
    }
}
