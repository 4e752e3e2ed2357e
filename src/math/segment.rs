//! Nearest places of segments of lines.

use super::V3;

/// Point of the segment `a b` nearest to `p`.
pub fn closest_point_segment(p: V3, a: V3, b: V3) -> V3 {
    a + (b - a) * share_of_nearest(p, a, b)
}

/// Share along the segment `a b` of its point nearest to `p`.
fn share_of_nearest(p: V3, a: V3, b: V3) -> f64 {
    let along = b - a;
    let length2 = along.norm_squared();
    if length2 == 0.0 {
        return 0.0;
    }
    ((p - a).dot(&along) / length2).clamp(0.0, 1.0)
}

/// Shares along two segments, from end to end each, of the places at which they are nearest to each other.
pub fn nearest_shares([a, b]: [V3; 2], [c, d]: [V3; 2]) -> [f64; 2] {
    let (along, other, apart) = (b - a, d - c, a - c);
    let (uu, uv, vv) = (
        along.norm_squared(),
        along.dot(&other),
        other.norm_squared(),
    );
    let (uw, vw) = (along.dot(&apart), other.dot(&apart));
    let parallel = uu * vv - uv * uv;
    if parallel > 0.0 {
        let shares = [
            (uv * vw - vv * uw) / parallel,
            (uu * vw - uv * uw) / parallel,
        ];
        if shares.iter().all(|share| (0.0..=1.0).contains(share)) {
            return shares;
        }
    }
    // at least one of the places is an end
    let on_other = |p: V3| share_of_nearest(p, c, d);
    let on_one = |p: V3| share_of_nearest(p, a, b);
    let from_ends = [
        [0.0, on_other(a)],
        [1.0, on_other(b)],
        [on_one(c), 0.0],
        [on_one(d), 1.0],
    ];
    let off = |[s, t]: [f64; 2]| (a.lerp(&b, s) - c.lerp(&d, t)).norm_squared();
    from_ends
        .into_iter()
        .fold([0.0; 2], |best, shares| match off(shares) < off(best) {
            true => shares,
            false => best,
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_point_lies_inside_or_at_the_ends() {
        let (a, b) = (V3::new(0.0, 0.0, 0.0), V3::new(2.0, 0.0, 0.0));
        let near = |x, y| closest_point_segment(V3::new(x, y, 0.0), a, b);
        assert_eq!(near(0.5, 3.0), V3::new(0.5, 0.0, 0.0));
        assert_eq!(near(-1.0, 3.0), a);
        assert_eq!(near(5.0, -1.0), b);
        assert_eq!(closest_point_segment(b, a, a), a);
    }

    /// Against a look at many places of both.
    #[test]
    fn segments_are_as_far_apart_as_their_nearest_places() {
        let at = |k: u32| {
            let x = |n: u32| libm::sin(f64::from(7 * k + n) * 12.9898) * 2.0;
            V3::new(x(1), x(2), x(3))
        };
        let mut inside = 0;
        for k in 0..200 {
            let (one, two) = ([at(4 * k), at(4 * k + 1)], [at(4 * k + 2), at(4 * k + 3)]);
            let place = |[a, b]: [V3; 2], share: f64| a.lerp(&b, share);
            let [s, t] = nearest_shares(one, two);
            let distance = (place(one, s) - place(two, t)).norm();
            let share = |k: u32| f64::from(k) / 200.0;
            let places = (0..=200).flat_map(|s| (0..=200).map(move |t| (s, t)));
            let off = |(s, t)| ((place(one, share(s)) - place(two, share(t))).norm(), s, t);
            let nearest = places.map(off).min_by(|a, b| a.0.total_cmp(&b.0));
            let (seen, s, t) = nearest.expect("places");
            assert!(
                distance <= seen + 1e-12 && seen < distance + 0.02,
                "{k}: {distance} {seen}"
            );
            inside += u32::from((1..200).contains(&s) && (1..200).contains(&t));
        }
        assert!(inside > 20, "{inside} with both places inside");
        // side by side, and as points
        let [x, y] = [V3::x(), V3::y()];
        let [s, t] = nearest_shares([V3::zeros(), x], [y, x + y]);
        assert_eq!(s, t);
        assert_eq!(nearest_shares([V3::zeros(); 2], [x, x]), [0.0; 2]);
    }
}
