//! Metals that wire is made of, at 20 degC, each number with its source.
//!
//! | source | says |
//! |---|---|
//! | Wieland, data sheet K32 (Cu-ETP, C11000) | strength, yield, elongation of the tempers of ASTM B152; modulus, Poisson's ratio, density |
//! | IEC 60028 | resistivity of annealed copper, 1/58 ohm mm2/m |
//! | ASTM B2, ASTM B1 | resistivity of medium-hard and of hard drawn copper wire: 96.66 % and 96.16 % IACS |
//! | The Aluminum Association, Aluminum Standards and Data (1350-O) | yield, strength, elongation, modulus |
//! | ASTM B233 (1350-O) | resistivity and density of electrical aluminium |

use super::flow_curve::FlowCurve;

/// A metal with its temper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// density, kg/m^3
    pub density: f64,
    /// stress at first yield, Pa
    pub yield_stress: f64,
    /// stress at break over the section at the start, Pa
    pub flow_stress: f64,
    /// resistivity, ohm m
    pub resistivity: f64,
    /// what the section's laws are integrated from; `None` where they are given otherwise
    pub elastic: Option<Elastic>,
}

/// Elastic constants, and where hardening ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elastic {
    /// Young's modulus, Pa
    pub modulus: f64,
    /// Poisson's ratio
    pub poisson: f64,
    /// strain at break; hardening runs straight from yield to it
    pub elongation: f64,
}

/// Resistivity of annealed copper, ohm m: IEC 60028.
const ANNEALED_COPPER: f64 = 1.0 / 58.0 * 1e-6;

/// The default copper; its rigidities are those of the source paper's Table 1. Yield stress and flow stress are
/// annealed copper's, rounded.
const COPPER: Material = Material {
    density: 8960.0,
    yield_stress: 100e6,
    flow_stress: 220e6,
    resistivity: ANNEALED_COPPER,
    elastic: None,
};

/// Cu-ETP of one temper; strengths are the middle of the data sheet's range.
const fn copper(yield_mpa: f64, strength_mpa: f64, elongation: f64, resistivity: f64) -> Material {
    Material {
        density: 8940.0,
        yield_stress: yield_mpa * 1e6,
        flow_stress: strength_mpa * 1e6,
        resistivity,
        elastic: Some(Elastic {
            modulus: 115e9,
            poisson: 0.34,
            elongation,
        }),
    }
}

impl Material {
    /// The metal of this name; `table1` and `custom` are copper where they leave something open.
    pub fn named(name: &str) -> Self {
        match name {
            // annealed: 180 to 260 MPa
            "copper-soft" => copper(70.0, 220.0, 0.35, ANNEALED_COPPER),
            // H02: 255 to 315 MPa
            "copper-half-hard" => copper(255.0, 285.0, 0.20, 1.7837e-8),
            // H04: 295 to 360 MPa
            "copper-hard" => copper(310.0, 330.0, 0.09, 1.7930e-8),
            // 1350-O: 4 and 12 ksi, 23 % in 10 inches, 10,000 ksi
            "aluminium" => Self {
                density: 2705.0,
                yield_stress: 28e6,
                flow_stress: 83e6,
                resistivity: 2.7899e-8,
                elastic: Some(Elastic {
                    modulus: 69e9,
                    poisson: 0.33,
                    elongation: 0.23,
                }),
            },
            _ => COPPER,
        }
    }
}

impl Elastic {
    /// Shear modulus, Pa.
    pub fn shear_modulus(&self) -> f64 {
        0.5 * self.modulus / (1.0 + self.poisson)
    }

    /// Straight to the yield stress, and straight to the stress at break, Pa; `None` where that is no hardening.
    pub fn curve(&self, yield_stress: f64, flow_stress: f64) -> Option<FlowCurve> {
        let points = [
            [yield_stress / self.modulus, yield_stress],
            [self.elongation, flow_stress],
        ];
        FlowCurve::new(points.to_vec()).ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_metal_hardens_from_yield_to_break() {
        let names = [
            "copper-soft",
            "copper-half-hard",
            "copper-hard",
            "aluminium",
        ];
        for name in names {
            let metal = Material::named(name);
            let elastic = metal.elastic.unwrap();
            let curve = elastic
                .curve(metal.yield_stress, metal.flow_stress)
                .unwrap();
            assert!((curve.modulus() / elastic.modulus - 1.0).abs() < 1e-12);
            assert!(elastic.shear_modulus() < 0.4 * elastic.modulus);
        }
        // harder wire conducts less
        let resistivity = names.map(|name| Material::named(name).resistivity);
        assert!(resistivity.is_sorted(), "{resistivity:?}");
        assert_eq!(Material::named("copper"), Material::named("table1"));
    }
}
