//! The coil as a product: what a drawing or a bill of material says of it.

use super::Winding;
use serde::Serialize;
use std::f64::consts::PI;

/// Resistivity of annealed copper at 20 degC, ohm m: 1/58 ohm mm2/m (IEC 60028).
const COPPER_20_DEGC: f64 = 1.0 / 58.0 * 1e-6;

/// The coil as a product, over the settled wire.
///
/// The bits of these numbers do not enter a computation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Product {
    /// turns at rest
    pub turns: f64,
    /// layers that settled wire lies in
    pub layers: u32,
    /// diameter of the wire, m
    pub wire_diameter_m: f64,
    /// unstretched length of the settled wire from the clamp, m
    pub wire_length_m: f64,
    /// resistance of that wire at 20 degC, as annealed copper of its unstretched section, ohm
    pub resistance_ohm: f64,
    /// wire section over the winding section it takes up, as the output `fill_factor`
    pub fill: f64,
}

impl Winding {
    /// The coil as a product.
    pub fn product(&self) -> Product {
        let d = self.scene.wire.diameter;
        let last = self.coil.stations().last();
        let length = last.map_or(0.0, |station| station.arc);
        Product {
            turns: self.run.outputs.turns_settled,
            layers: self.coil.stations().map(|s| s.layer).max().unwrap_or(0),
            wire_diameter_m: d,
            wire_length_m: length,
            resistance_ohm: COPPER_20_DEGC * length / (0.25 * PI * d * d),
            fill: self.coil.fill_factor(),
        }
    }
}
