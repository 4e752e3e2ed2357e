//! Polar angle of wire about the core axis, unwrapped along the wire.

use super::vector::V3;
use std::f64::consts::{PI, TAU};

/// Polar angle `atan2(z, x)` of a point in the core frame, rad in `[-pi, pi]`.
///
/// Wire wound with positive spindle speed runs towards +z from a clamp on +x, so its angle grows.
#[inline]
pub fn polar_angle(point: V3) -> f64 {
    libm::atan2(point.z, point.x)
}

/// Wraps an angle, rad, into `[-pi, pi)` by whole turns.
#[inline]
pub fn wrap_to_pi(angle: f64) -> f64 {
    // An angle in range passes unchanged: adding and taking pi away would cost its last digits.
    if (-PI..PI).contains(&angle) {
        angle
    } else {
        (angle + PI).rem_euclid(TAU) - PI
    }
}

/// Winding angle of every point: measured from `start` (polar angle, rad) in `direction` (+1 with
/// growing polar angle, -1 against it) and unwrapped along the wire, rad.
///
/// Neighbouring points must be less than half a turn apart.
pub fn unwrap_angles(points: &[V3], start: f64, direction: f64) -> Vec<f64> {
    let mut previous = start;
    let mut angle = 0.0;
    points
        .iter()
        .map(|&point| {
            let polar = polar_angle(point);
            angle += direction * wrap_to_pi(polar - previous);
            previous = polar;
            angle
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circle(from: f64, step: f64, n: usize) -> Vec<V3> {
        (0..n)
            .map(|k| from + step * k as f64)
            .map(|a| V3::new(libm::cos(a), 0.0, libm::sin(a)))
            .collect()
    }

    #[test]
    fn wire_of_several_turns_is_unwrapped_in_both_directions() {
        for direction in [1.0, -1.0] {
            let angles = unwrap_angles(&circle(0.2, 0.3 * direction, 100), 0.2, direction);
            for (k, angle) in angles.iter().enumerate() {
                assert!((angle - 0.3 * k as f64).abs() < 1e-12, "{k}: {angle}");
            }
        }
    }

    #[test]
    fn a_step_back_lowers_the_angle() {
        let points = [circle(3.0, 0.2, 5), circle(3.7, -0.2, 3)].concat();
        let angles = unwrap_angles(&points, 3.0, 1.0);
        assert!((angles[4] - 0.8).abs() < 1e-12);
        assert!((angles[7] - 0.3).abs() < 1e-12);
    }

    #[test]
    fn wrapping_keeps_angles_in_range_to_the_bit() {
        for angle in [-PI, -1.0, 1e-17, 3.1] {
            assert_eq!(wrap_to_pi(angle), angle);
        }
        assert!((wrap_to_pi(PI + 0.1) - (0.1 - PI)).abs() < 1e-15);
        assert!((wrap_to_pi(-7.0) - (TAU - 7.0)).abs() < 1e-15);
    }
}
