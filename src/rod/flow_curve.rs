//! From points of a stress-strain curve to laws of a round section.
//!
//! The section is integrated exactly: plane sections stay plane, each fibre follows the curve, and torsion shears it by the
//! von Mises rule. Each exact law is replaced by a bilinear one with the same elastic stiffness
//! and the same work up to the last point. In tension it yields where the curve does, in bending and torsion, where a section
//! yields bit by bit, it ends at the exact load. Bending and torsion can also follow the exact law in straight pieces.

use super::pieces::Pieces;
use super::section::Hardening;
use std::f64::consts::PI;

/// Nominal stress over nominal strain, straight from the origin to the first point, and straight between points.
#[derive(Clone, Debug, PartialEq)]
pub struct FlowCurve {
    points: Vec<[f64; 2]>,
}

/// What is wrong with points of a curve.
#[derive(Clone, Debug, PartialEq)]
pub enum FlowCurveError {
    /// less than two of them
    TooFew,
    /// the point of this number, from 1, is not above 0, or not finite
    NotPositive(usize),
    /// the strain of this point is not above that of the point before
    StrainFalls(usize),
    /// the stress of this point is not above that of the point before
    StressFalls(usize),
    /// the curve is steeper up to this point than up to the point before
    Steepens(usize),
    /// the strain of this point is above [`MOST_STRAIN`]
    TooFar(usize),
}

/// Largest strain of a point: beyond it nominal stress and strain no longer describe a bent wire.
pub const MOST_STRAIN: f64 = 1.0;

/// A load over a deformation: straight to the limit, then straight with the tangent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bilinear {
    /// stiffness up to the limit
    pub elastic: f64,
    /// load at the limit
    pub limit: f64,
    /// stiffness beyond it
    pub tangent: f64,
    /// largest difference to the exact law up to the last point, over the load there; where the section follows pieces that of
    /// those, over the load at the same place
    pub error: f64,
}

/// Laws of a round section made of one material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundLaws {
    /// axial force, N, over strain
    pub stretch: Bilinear,
    /// bending moment, N m, over curvature, 1/m
    pub bend: Bilinear,
    /// torque, N m, over twist, 1/m
    pub twist: Bilinear,
    /// moment of a section in which every fibre has the last stress, N m
    pub moment_cap: f64,
    /// pieces that bending and torsion follow in place of their bilinear laws, which give the elastic stiffness, the limit and a
    /// mean tangent
    pub hardening: Hardening,
}

/// Which laws of a section follow the exact one in pieces; the others are bilinear.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct InPieces {
    /// moment over curvature
    pub bend: bool,
    /// torque over twist
    pub twist: bool,
}

/// Places at which a fit is compared with the exact law, besides its own corner. Chosen: kinks lie at a handful of places.
const COMPARED: u32 = 400;

impl FlowCurve {
    /// A curve through these points of strain and stress, Pa.
    ///
    /// # Errors
    ///
    /// Less than two points, values that are not positive, points out of order, stress that does not rise, and
    /// hardening that grows.
    pub fn new(points: Vec<[f64; 2]>) -> Result<Self, FlowCurveError> {
        if points.len() < 2 {
            return Err(FlowCurveError::TooFew);
        }
        let mut before = [0.0, 0.0];
        let mut slope = f64::INFINITY;
        for (number, &[strain, stress]) in (1..).zip(&points) {
            if !(strain > 0.0 && stress > 0.0 && strain.is_finite() && stress.is_finite()) {
                return Err(FlowCurveError::NotPositive(number));
            }
            if strain > MOST_STRAIN {
                return Err(FlowCurveError::TooFar(number));
            }
            if strain <= before[0] {
                return Err(FlowCurveError::StrainFalls(number));
            }
            if stress <= before[1] {
                return Err(FlowCurveError::StressFalls(number));
            }
            let steeper = (stress - before[1]) / (strain - before[0]);
            // Points of a straight line may differ in the last digits; two on the elastic line would have no yield.
            let most = if number == 2 {
                slope * (1.0 - 1e-6)
            } else {
                slope * (1.0 + 1e-9)
            };
            if steeper > most {
                return Err(FlowCurveError::Steepens(number));
            }
            (before, slope) = ([strain, stress], steeper);
        }
        Ok(Self { points })
    }

    /// Young's modulus, Pa: the slope up to the first point.
    pub fn modulus(&self) -> f64 {
        self.points[0][1] / self.points[0][0]
    }

    /// Stress at the first point, Pa.
    pub fn yield_stress(&self) -> f64 {
        self.points[0][1]
    }

    /// Stress at the last point, Pa.
    pub fn last_stress(&self) -> f64 {
        self.last()[1]
    }

    /// Laws of a round section of this radius, m, with this shear modulus, Pa.
    pub fn round(&self, radius: f64, shear_modulus: f64, in_pieces: InPieces) -> RoundLaws {
        let [strain, stress] = self.last();
        let modulus = self.modulus();
        let (square, cube) = (radius * radius, radius * radius * radius);
        let area = PI * square;
        let stretch = fit_from(
            area * self.yield_stress(),
            modulus * area,
            strain,
            |e| area * self.stress(e),
            area * self.work(strain),
        );
        let (bend, bend_pieces) = law(
            in_pieces.bend,
            modulus * 0.25 * area * square,
            [self.points[0][0] / radius, strain / radius],
            |curvature| 4.0 * cube * self.mean(curvature * radius, BENT),
            4.0 * square * self.mean_work(strain, BENT),
        );
        let shear = self.sheared(shear_modulus);
        let most = shear.last()[0];
        let (twist, twist_pieces) = law(
            in_pieces.twist,
            shear_modulus * 0.5 * area * square,
            [shear.points[0][0] / radius, most / radius],
            |twist| 2.0 * PI * cube * shear.mean(twist * radius, TWISTED),
            2.0 * PI * square * shear.mean_work(most, TWISTED),
        );
        RoundLaws {
            hardening: Hardening {
                bend: bend_pieces,
                twist: twist_pieces,
            },
            stretch,
            bend,
            twist,
            moment_cap: 4.0 / 3.0 * stress * cube,
        }
    }

    fn last(&self) -> [f64; 2] {
        self.points[self.points.len() - 1]
    }

    /// Shear stress over shear strain: `tau = sigma / sqrt(3)`, plastic shear `sqrt(3)` times the plastic strain.
    fn sheared(&self, shear_modulus: f64) -> Self {
        let root = 3.0_f64.sqrt();
        let modulus = self.modulus();
        let point = |&[strain, stress]: &[f64; 2]| {
            let tau = stress / root;
            [
                tau / shear_modulus + root * (strain - stress / modulus),
                tau,
            ]
        };
        let mut points: Vec<_> = self.points.iter().map(point).collect();
        // no plastic strain at yield, whatever rounding says
        points[0][0] = points[0][1] / shear_modulus;
        Self { points }
    }

    /// Straight pieces: strain at either end, stress at strain 0 of the line, its slope, and the work up to its beginning.
    fn pieces(&self) -> impl Iterator<Item = Piece> + '_ {
        let mut work = 0.0;
        let mut before = [0.0, 0.0];
        self.points.iter().map(move |&[strain, stress]| {
            let slope = (stress - before[1]) / (strain - before[0]);
            let piece = Piece {
                from: before[0],
                to: strain,
                level: before[1] - slope * before[0],
                slope,
                work: work - before[1] * before[0] + 0.5 * slope * before[0] * before[0],
            };
            work += 0.5 * (stress + before[1]) * (strain - before[0]);
            before = [strain, stress];
            piece
        })
    }

    /// Stress at a strain up to the last one, Pa.
    fn stress(&self, strain: f64) -> f64 {
        let piece = self.pieces().find(|piece| strain <= piece.to);
        piece.map_or(self.last_stress(), |piece| {
            piece.level + piece.slope * strain
        })
    }

    /// Work per volume up to a strain, J/m^3.
    fn work(&self, strain: f64) -> f64 {
        let piece = self.pieces().find(|piece| strain <= piece.to);
        piece.map_or(0.0, |piece| piece.work_at(strain))
    }

    /// Integral of stress times lever times width over the section of radius 1, for this strain at its rim.
    fn mean(&self, rim: f64, [_, first, second]: Moments) -> f64 {
        self.pieces()
            .filter(|piece| piece.from < rim)
            .map(|piece| {
                let over = |moment: fn(f64) -> f64| {
                    moment((piece.to / rim).min(1.0)) - moment(piece.from / rim)
                };
                piece.level * over(first) + piece.slope * rim * over(second)
            })
            .sum()
    }

    /// Integral of work times width over the section of radius 1, for this strain at its rim.
    fn mean_work(&self, rim: f64, [zeroth, first, second]: Moments) -> f64 {
        self.pieces()
            .filter(|piece| piece.from < rim)
            .map(|piece| {
                let over = |moment: fn(f64) -> f64| {
                    moment((piece.to / rim).min(1.0)) - moment(piece.from / rim)
                };
                piece.work * over(zeroth)
                    + piece.level * rim * over(first)
                    + 0.5 * piece.slope * rim * rim * over(second)
            })
            .sum()
    }
}

/// A straight piece of a curve. Its stress is `level + slope * strain`, its work
/// `work + level * strain + slope / 2 * strain^2`.
struct Piece {
    from: f64,
    to: f64,
    level: f64,
    slope: f64,
    work: f64,
}

impl Piece {
    fn work_at(&self, strain: f64) -> f64 {
        self.work + self.level * strain + 0.5 * self.slope * strain * strain
    }
}

/// Antiderivatives of width, width times place, and width times place squared, over the place u from 0 to 1.
type Moments = [fn(f64) -> f64; 3];

/// Bending: the width at height u over the neutral axis is `sqrt(1 - u^2)` (a quarter of the circle).
const BENT: Moments = [
    |u| 0.5 * (u * root(u) + libm::asin(u)),
    |u| -root(u).powi(3) / 3.0,
    |u| 0.125 * (libm::asin(u) - u * root(u) * (1.0 - 2.0 * u * u)),
];

/// Torsion: the width at radius u is u (the ring over 2 pi).
const TWISTED: Moments = [
    |u| u * u / 2.0,
    |u| u * u * u / 3.0,
    |u| u * u * u * u / 4.0,
];

fn root(u: f64) -> f64 {
    (1.0 - u * u).max(0.0).sqrt()
}

/// The bilinear law with this stiffness and limit that takes the exact work up to the end.
fn fit_from(limit: f64, elastic: f64, end: f64, exact: impl Fn(f64) -> f64, work: f64) -> Bilinear {
    let yielded = end - limit / elastic;
    let to_limit = 0.5 * limit * limit / elastic;
    let tangent = 2.0 * (work - to_limit - limit * yielded) / (yielded * yielded);
    with_error(elastic, limit, tangent, end, exact)
}

/// The bilinear law with this stiffness that ends at the exact load after the exact work.
///
/// Limit `L` and tangent follow from `2 W = F x + L (x - F/K)`, the area below two straight lines.
fn fit(elastic: f64, end: f64, exact: impl Fn(f64) -> f64, work: f64) -> Bilinear {
    let load = exact(end);
    let limit = (2.0 * work - load * end) / (end - load / elastic);
    let tangent = (load - limit) / (end - limit / elastic);
    with_error(elastic, limit, tangent, end, exact)
}

/// The bilinear law, and where asked for the pieces between the ends of `yielding`, from first yield to the last point.
fn law(
    in_pieces: bool,
    elastic: f64,
    yielding: [f64; 2],
    exact: impl Fn(f64) -> f64,
    work: f64,
) -> (Bilinear, Option<Pieces>) {
    let [first, last] = yielding;
    let bilinear = fit(elastic, last, &exact, work);
    if !in_pieces {
        return (bilinear, None);
    }
    let (pieces, error) = Pieces::of(first, last, exact);
    let limit = pieces.limit();
    let law = Bilinear {
        limit,
        error,
        ..bilinear
    };
    (law, Some(pieces))
}

/// A law with its largest difference to the exact one.
fn with_error(
    elastic: f64,
    limit: f64,
    tangent: f64,
    end: f64,
    exact: impl Fn(f64) -> f64,
) -> Bilinear {
    let load = exact(end);
    let places = (1..=COMPARED).map(|k| end * f64::from(k) / f64::from(COMPARED));
    let error = std::iter::once(limit / elastic)
        .chain(places)
        .map(|at| {
            let law = (elastic * at).min(limit + tangent * (at - limit / elastic));
            (law - exact(at)).abs() / load
        })
        .fold(0.0, f64::max);
    Bilinear {
        elastic,
        limit,
        tangent,
        error,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const R: f64 = 0.35e-3;
    const E: f64 = 115e9;
    const G: f64 = 43e9;

    fn curve(points: &[[f64; 2]]) -> FlowCurve {
        FlowCurve::new(points.to_vec()).expect("a curve")
    }

    fn annealed() -> FlowCurve {
        curve(&[[70e6 / E, 70e6], [0.02, 110e6], [0.1, 180e6], [0.3, 220e6]])
    }

    /// Integral by the midpoint rule.
    fn sum(to: f64, count: u32, f: impl Fn(f64) -> f64) -> f64 {
        let h = to / f64::from(count);
        (0..count).map(|k| h * f((f64::from(k) + 0.5) * h)).sum()
    }

    #[test]
    fn two_points_are_the_bilinear_law_itself() {
        let (stress, last, end) = (100e6, 220e6, 0.2);
        let laws = curve(&[[stress / E, stress], [end, last]]).round(R, G, InPieces::default());
        let area = PI * R * R;
        let tangent = (last - stress) / (end - stress / E);
        let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-10, "{a} {b}");
        close(laws.stretch.limit, stress * area);
        close(laws.stretch.tangent, tangent * area);
        close(laws.stretch.elastic, E * area);
        assert!(laws.stretch.error < 1e-12);
        close(laws.bend.elastic, E * PI * R.powi(4) / 4.0);
        close(laws.twist.elastic, G * PI * R.powi(4) / 2.0);
        close(laws.moment_cap, last * (2.0 * R).powi(3) / 6.0);
    }

    /// Elastic, then perfectly plastic in all but name: the moment tends to `s d^3/6`, and is
    /// `s d^3 pi/32` where the rim begins to yield.
    #[test]
    fn bending_of_hardly_hardening_wire_is_that_of_the_textbook() {
        let stress = 200e6;
        let hardly = curve(&[[stress / E, stress], [0.5, stress * (1.0 + 1e-9)]]);
        let moment = |rim: f64| 4.0 * R.powi(3) * hardly.mean(rim, BENT);
        let d3 = (2.0 * R).powi(3);
        let close = |a: f64, b: f64, off: f64| assert!((a / b - 1.0).abs() < off, "{a} {b}");
        close(moment(stress / E), stress * d3 * PI / 32.0, 1e-12);
        close(moment(0.5), stress * d3 / 6.0, 1e-4);
        let laws = hardly.round(R, G, InPieces::default());
        close(laws.bend.limit, stress * d3 / 6.0, 5e-3);
        close(laws.moment_cap, stress * d3 / 6.0, 1e-8);
        close(
            laws.twist.limit,
            stress / 3.0_f64.sqrt() * PI * d3 / 12.0,
            5e-3,
        );
    }

    #[test]
    fn sections_are_integrated_exactly() {
        let curve = annealed();
        for rim in [0.0003, 0.003, 0.05, 0.3] {
            let bent = 4.0 * sum(1.0, 200_000, |u| curve.stress(rim * u) * u * root(u));
            let exact = 4.0 * curve.mean(rim, BENT);
            assert!((exact / bent - 1.0).abs() < 1e-6, "{rim}: {exact} {bent}");
            let work = 4.0 * sum(1.0, 200_000, |u| curve.work(rim * u) * root(u));
            let exact = 4.0 * curve.mean_work(rim, BENT);
            assert!((exact / work - 1.0).abs() < 1e-6, "{rim}: {exact} {work}");
            let twisted = sum(1.0, 200_000, |u| curve.stress(rim * u) * u * u);
            let exact = curve.mean(rim, TWISTED);
            assert!((exact / twisted - 1.0).abs() < 1e-6, "{rim}");
            let work = sum(1.0, 200_000, |u| curve.work(rim * u) * u);
            let exact = curve.mean_work(rim, TWISTED);
            assert!((exact / work - 1.0).abs() < 1e-6, "{rim}");
        }
    }

    #[test]
    fn fits_take_the_exact_work_and_keep_yield_or_last_load() {
        let curve = annealed();
        let laws = curve.round(R, G, InPieces::default());
        let [strain, stress] = curve.last();
        let shear = curve.sheared(G);
        let area = PI * R * R;
        let ends = [
            (laws.stretch, strain, area * stress),
            (
                laws.bend,
                strain / R,
                4.0 * R.powi(3) * curve.mean(strain, BENT),
            ),
            (
                laws.twist,
                shear.last()[0] / R,
                2.0 * PI * R.powi(3) * shear.mean(shear.last()[0], TWISTED),
            ),
        ];
        let works = [
            sum(strain, 200_000, |e| area * curve.stress(e)),
            sum(strain / R, 20_000, |k| {
                4.0 * R.powi(3) * curve.mean(k * R, BENT)
            }),
            sum(shear.last()[0] / R, 20_000, |k| {
                2.0 * PI * R.powi(3) * shear.mean(k * R, TWISTED)
            }),
        ];
        for ((law, end, load), work) in ends.into_iter().zip(works) {
            let yielded = end - law.limit / law.elastic;
            let last = law.limit + law.tangent * yielded;
            if law == laws.stretch {
                assert_eq!(law.limit, area * 70e6);
            } else {
                assert!((last / load - 1.0).abs() < 1e-10, "{law:?}");
            }
            let below = 0.5 * law.limit * (end - yielded) + 0.5 * (law.limit + last) * yielded;
            assert!((below / work - 1.0).abs() < 1e-4, "{law:?} {below} {work}");
            assert!(law.tangent > 0.0 && law.tangent < law.elastic, "{law:?}");
            assert!(law.error > 0.02 && law.error < 0.35, "{law:?}");
        }
        // one that ends at the moment of the last point stays below that of the section yielding whole
        assert!(ends[1].2 < laws.moment_cap);
    }

    /// Soft metals yield at a 340th of their last strain, before the first of evenly spaced places, and their laws were told to be
    /// off by less than half of what they are.
    #[test]
    fn a_law_is_compared_at_its_corner() {
        let soft = curve(&[[100e6 / E, 100e6], [0.3, 220e6]]);
        let laws = soft.round(R, G, InPieces::default());
        let bend = |k: f64| 4.0 * R.powi(3) * soft.mean(k * R, BENT);
        let shear = soft.sheared(G);
        let twist = |k: f64| 2.0 * PI * R.powi(3) * shear.mean(k * R, TWISTED);
        let ends = [0.3 / R, shear.last()[0] / R];
        let off = |law: Bilinear, end: f64, exact: &dyn Fn(f64) -> f64| {
            let at = |k: f64| {
                (law.elastic * k).min(law.limit + law.tangent * (k - law.limit / law.elastic))
            };
            let places = (0..20_000).map(|n| end * 1e-5_f64.powf(f64::from(n) / 2e4));
            places.map(|k| (at(k) - exact(k)).abs()).fold(0.0, f64::max) / exact(end)
        };
        for (law, off) in [
            (laws.bend, off(laws.bend, ends[0], &bend)),
            (laws.twist, off(laws.twist, ends[1], &twist)),
        ] {
            assert!((law.error / off - 1.0).abs() < 0.01, "{law:?}: {off}");
        }
    }

    #[test]
    fn points_that_are_no_curve_are_refused() {
        use FlowCurveError::*;
        let refused = |points: &[[f64; 2]]| FlowCurve::new(points.to_vec()).unwrap_err();
        assert_eq!(refused(&[[1e-3, 1e8]]), TooFew);
        assert_eq!(refused(&[[0.0, 1e8], [0.1, 2e8]]), NotPositive(1));
        assert_eq!(refused(&[[1e-3, 1e8], [0.1, -2e8]]), NotPositive(2));
        assert_eq!(refused(&[[1e-3, 1e8], [0.1, f64::NAN]]), NotPositive(2));
        assert_eq!(refused(&[[1e-3, 1e8], [1e-3, 2e8]]), StrainFalls(2));
        assert_eq!(refused(&[[1e-3, 1e8], [0.1, 1e8]]), StressFalls(2));
        assert_eq!(refused(&[[1e-3, 1e8], [2e-3, 2e8]]), Steepens(2));
        assert_eq!(
            refused(&[[1e-3, 1e8], [0.1, 1.1e8], [0.2, 2e8]]),
            Steepens(3)
        );
        assert_eq!(refused(&[[1e-3, 1e8], [1.5, 2e8]]), TooFar(2));
    }
}
