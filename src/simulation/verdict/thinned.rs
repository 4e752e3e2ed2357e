//! Wire that plastic stretch has made thinner than contact and measures take it for.

use crate::measure::OnTurn;
use crate::simulation::Winding;

/// Share by which wire may be thinner than contact takes it for, before that is told. Turns then seem to lie apart, and lie, by that
/// share of a diameter too much: half of the rms gap that parts `aligned` from `marginal`, 0.05 diameters.
const THINNER: f64 = 0.025;

/// Diameter of wire with this plastic stretch over that before: plastic flow keeps the volume.
fn share_left(stretch: f64) -> f64 {
    1.0 / (1.0 + stretch.max(0.0)).sqrt()
}

impl Winding {
    /// Least diameter of settled wire over that of wire that has not been stretched.
    pub(super) fn least_diameter(&self) -> f64 {
        let stretched = self.coil.largest_stretch();
        stretched.map_or(1.0, |(stretch, _)| share_left(stretch))
    }

    /// How much thinner stretched wire is than the wire that lies and is measured, in words, where that matters.
    pub(super) fn thinned_wire(&self) -> Option<String> {
        let (stretch, at) = self.coil.largest_stretch()?;
        let left = share_left(stretch);
        let d = 1e3 * self.scene.wire.diameter;
        (1.0 - left > THINNER).then(|| {
            format!(
                "No part of the verdict: plastic stretch of {:.1} % in {} leaves {:.3} mm of the diameter of {d:.3} mm; contact, gaps and heights are those of wire that is not thinner",
                1e2 * stretch,
                OnTurn::of_station(at),
                left * d
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::share_left;

    #[test]
    fn stretched_wire_keeps_its_volume() {
        for stretch in [0.0, 0.02, 0.21] {
            let volume = share_left(stretch).powi(2) * (1.0 + stretch);
            assert!((volume - 1.0).abs() < 1e-15, "{stretch}: {volume}");
        }
        assert!((share_left(0.21) - 1.0 / 1.1).abs() < 1e-15);
        assert_eq!(share_left(-0.01), 1.0, "pressed wire is told of nowhere");
    }
}
