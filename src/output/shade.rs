//! Light and colour of a surface point; colours are linear red, green, blue.

use crate::math::V3;

/// How a surface looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Material {
    /// colour in diffuse light
    pub(crate) colour: V3,
    /// colour and strength of highlights
    pub(crate) shine: V3,
    /// width of highlights: large is narrow
    pub(crate) polish: i32,
}

impl Material {
    /// Core: matt light grey, so that wire and its shadow stand out.
    pub(crate) fn core() -> Self {
        Self {
            colour: V3::new(0.42, 0.44, 0.47),
            shine: V3::repeat(0.06),
            polish: 24,
        }
    }

    /// Metal of a given colour.
    pub(crate) fn metal(colour: V3) -> Self {
        Self {
            colour,
            shine: colour * 0.75 + V3::repeat(0.08),
            polish: 48,
        }
    }

    /// Wire at rest: copper.
    pub(crate) fn frozen() -> Self {
        Self::metal(V3::new(0.50, 0.16, 0.06))
    }

    /// Wire in motion: pale blue.
    pub(crate) fn live() -> Self {
        Self::metal(V3::new(0.08, 0.26, 0.50))
    }

    /// Wire of a turn (from 1), in six colours that neighbours do not share.
    pub(crate) fn turn(turn: u32) -> Self {
        const COLOURS: [[f64; 3]; 6] = [
            [0.50, 0.16, 0.06],
            [0.07, 0.33, 0.42],
            [0.66, 0.42, 0.07],
            [0.36, 0.11, 0.36],
            [0.19, 0.40, 0.12],
            [0.09, 0.18, 0.52],
        ];
        Self::metal(V3::from(
            COLOURS[(turn.max(1) as usize - 1) % COLOURS.len()],
        ))
    }
}

/// Light at a surface point.
pub(crate) struct Lighting {
    /// to the light that casts shadows
    pub(crate) key: V3,
    /// upwards, where the sky is
    pub(crate) up: V3,
    /// to the viewer
    pub(crate) viewer: V3,
    /// share of the key light that arrives, 0..1
    pub(crate) lit: f64,
    /// share of the sky that is seen, 0..1
    pub(crate) open: f64,
}

/// Colour of a point with a unit normal towards the viewer's side (Blinn-Phong).
pub(crate) fn shade(material: &Material, normal: V3, light: &Lighting) -> V3 {
    let sky = V3::new(0.50, 0.54, 0.60);
    let ground = V3::new(0.26, 0.24, 0.22);
    let upward = 0.5 + 0.5 * normal.dot(&light.up);
    let ambient = (ground + (sky - ground) * upward) * light.open;
    let facing = normal.dot(&light.key).max(0.0) * light.lit;
    // A weak light from the viewer keeps what is turned away readable.
    let head = 0.16 * normal.dot(&light.viewer).max(0.0) * light.open;
    let diffuse = ambient + V3::new(1.22, 1.17, 1.09) * facing + V3::repeat(head);
    let half = (light.key + light.viewer).normalize();
    let highlight = normal.dot(&half).max(0.0).powi(material.polish) * light.lit * 1.6;
    // Edges seen at a grazing angle mirror the sky.
    let grazing = (1.0 - normal.dot(&light.viewer).clamp(0.0, 1.0)).powi(4) * 0.22 * light.open;
    material.colour.component_mul(&diffuse) + material.shine * highlight + sky * grazing
}

/// Colour of the background at a height in the picture, 0 at the top to 1 at the bottom.
pub(crate) fn background(height: f64, aside: f64) -> V3 {
    let (top, bottom) = (V3::new(0.90, 0.92, 0.95), V3::new(0.62, 0.66, 0.72));
    let vignette = 1.0 - 0.22 * (aside * aside + (height - 0.45) * (height - 0.45));
    (top + (bottom - top) * height * height) * vignette
}

/// [`to_srgb`] from a table: a picture has millions of numbers to encode, and a byte has 256.
pub(crate) struct Encoding {
    /// the least light of each byte but the first
    least: [f64; 255],
}

impl Encoding {
    pub(crate) fn new() -> Self {
        let least = std::array::from_fn(|byte| {
            // positive numbers have the order of their bits
            let (mut below, mut from) = (0.0_f64.to_bits(), f64::MAX.to_bits());
            while from - below > 1 {
                let middle = below.midpoint(from);
                if usize::from(to_srgb(f64::from_bits(middle))) > byte {
                    from = middle;
                } else {
                    below = middle;
                }
            }
            f64::from_bits(from)
        });
        Self { least }
    }

    /// The byte of linear light.
    pub(crate) fn byte(&self, linear: f64) -> u8 {
        // (at most 255)
        self.least.partition_point(|least| *least <= linear) as u8
    }
}

/// Linear light to an sRGB byte (IEC 61966-2-1), with bright light rolled off instead of cut.
fn to_srgb(linear: f64) -> u8 {
    const KNEE: f64 = 0.75;
    let linear = if linear <= KNEE {
        linear.max(0.0)
    } else {
        let over = (linear - KNEE) / (1.0 - KNEE);
        KNEE + (1.0 - KNEE) * over / (1.0 + over)
    };
    let encoded = if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055
    };
    (encoded * 255.0).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    fn light(lit: f64) -> Lighting {
        Lighting {
            key: V3::y(),
            up: V3::y(),
            viewer: V3::y(),
            lit,
            open: 1.0,
        }
    }

    #[test]
    fn shadow_darkens_and_light_brightens() {
        let core = Material::core();
        let (lit, shaded) = (
            shade(&core, V3::y(), &light(1.0)),
            shade(&core, V3::y(), &light(0.0)),
        );
        assert!((lit - shaded).min() > 0.1);
        assert!(shaded.min() > 0.05, "shadow is not black");
    }

    #[test]
    fn encoding_is_monotone_and_meets_the_standard_at_middle_grey() {
        assert_eq!((to_srgb(0.0), to_srgb(-1.0)), (0, 0));
        assert_eq!(to_srgb(0.2140), 127);
        let bytes: Vec<u8> = (0..400).map(|k| to_srgb(f64::from(k) * 0.01)).collect();
        assert!(bytes.windows(2).all(|pair| pair[0] <= pair[1]));
    }

    #[test]
    fn the_table_encodes_as_the_formula() {
        let table = Encoding::new();
        for k in 0..40_000 {
            let linear = f64::from(k) * 1e-4 - 0.1;
            assert_eq!(table.byte(linear), to_srgb(linear), "{linear}");
        }
        for least in table.least {
            let (below, at) = (to_srgb(least.next_down()), to_srgb(least));
            assert!(below < at, "{least}");
            assert_eq!(
                (table.byte(least.next_down()), table.byte(least)),
                (below, at)
            );
        }
    }
}
