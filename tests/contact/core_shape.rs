//! Contact geometry against analytic distances and against its own slow twins.

use coilwind::geometry::generate::{cylinder, rounded_box, sagitta};
use coilwind::geometry::{Bvh, Nearest, Surface, Touch, TriMesh};
use coilwind::math::V3;
use proptest::prelude::*;

/// Radius of the wire, m.
const R: f64 = 0.35e-3;
/// Rounded box of the tests, m: 12 by 30 by 40, corners 2.
const BOX: [f64; 4] = [0.012, 0.03, 0.04, 0.002];
/// Chords per corner.
const CHORDS: usize = 8;

fn box_surface() -> Surface {
    Surface::new(rounded_box(BOX[0], BOX[1], BOX[2], BOX[3], CHORDS).unwrap())
}

/// Exact signed distance of the rounded box, m.
fn box_distance(p: V3) -> f64 {
    let [w, h, l, r] = BOX;
    let qx = p.x.abs() - (0.5 * w - r);
    let qz = p.z.abs() - (0.5 * h - r);
    let section = qx.max(0.0).hypot(qz.max(0.0)) + qx.max(qz).min(0.0) - r;
    extruded_distance(section, p.y, l)
}

/// Signed distance of an extrusion along y from that of its section.
fn extruded_distance(section: f64, y: f64, length: f64) -> f64 {
    let end = y.abs() - 0.5 * length;
    section.max(end).min(0.0) + section.max(0.0).hypot(end.max(0.0))
}

/// Extrudes a section (x, z; from +x to +z counted positive) along y.
fn extrude(section: &[[f64; 2]], cap: &[[u32; 3]], length: f64) -> TriMesh {
    let n = section.len() as u32;
    let ring = |y: f64| section.iter().map(move |s| V3::new(s[0], y, s[1]));
    let vertices = ring(-0.5 * length).chain(ring(0.5 * length)).collect();
    let mut triangles = Vec::new();
    for i in 0..n {
        let j = (i + 1) % n;
        triangles.extend([[i, i + n, j + n], [i, j + n, j]]);
    }
    for &[a, b, c] in cap {
        triangles.extend([[a, b, c], [c + n, b + n, a + n]]);
    }
    TriMesh::new(vertices, triangles).unwrap()
}

/// An L of 1 mm thick legs, inner corner at (1, 1) mm.
fn angle_iron() -> Surface {
    let section = [[0., 0.], [2., 0.], [2., 1.], [1., 1.], [1., 2.], [0., 2.]].map(millimetres);
    let cap = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]];
    Surface::new(extrude(&section, &cap, 0.01))
}

/// A channel, 0.3 mm wide (less than `R`) and 1 mm deep, with its floor at z = 1 mm.
fn channel() -> Surface {
    let section = [
        [0., 0.],
        [2.3, 0.],
        [2.3, 2.],
        [1.3, 2.],
        [1.3, 1.],
        [1., 1.],
        [1., 2.],
        [0., 2.],
    ]
    .map(millimetres);
    let cap = [
        [0, 1, 4],
        [1, 2, 3],
        [1, 3, 4],
        [0, 4, 5],
        [0, 5, 6],
        [0, 6, 7],
    ];
    Surface::new(extrude(&section, &cap, 0.01))
}

fn millimetres(p: [f64; 2]) -> [f64; 2] {
    p.map(|x| 1e-3 * x)
}

/// A bobbin with a bore: hub of 5 mm, flanges of 8 mm that are thinner than the wire's radius.
fn bobbin() -> Surface {
    let profile = [
        [3.0, -5.2],
        [8.0, -5.2],
        [8.0, -5.0],
        [5.0, -5.0],
        [5.0, 5.0],
        [8.0, 5.0],
        [8.0, 5.2],
        [3.0, 5.2],
    ]
    .map(millimetres);
    let (n, m) = (48u32, profile.len() as u32);
    let mut vertices = Vec::new();
    let mut triangles = Vec::new();
    for i in 0..n {
        let angle = std::f64::consts::TAU * f64::from(i) / f64::from(n);
        let (sin, cos) = angle.sin_cos();
        vertices.extend(profile.map(|[r, y]| V3::new(r * cos, y, r * sin)));
        for j in 0..m {
            let (a, b) = (i * m + j, i * m + (j + 1) % m);
            let next = ((i + 1) % n) * m;
            let (c, d) = (next + (j + 1) % m, next + j);
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    Surface::new(TriMesh::new(vertices, triangles).unwrap())
}

fn touches(surface: &Surface, p: V3) -> Vec<Touch> {
    let (mut near, mut out) = (Vec::new(), Vec::new());
    surface.near(p, R, &mut near);
    surface.touching(p, R, &near, &mut out);
    out
}

/// A point in the bounding box grown by `margin`, from three numbers in 0..1.
fn in_bounds(surface: &Surface, margin: f64, u: [f64; 3]) -> V3 {
    let (low, high) = surface.bounds();
    let size = high - low + V3::repeat(2.0 * margin);
    low - V3::repeat(margin) + V3::from(u).component_mul(&size)
}

/// A point `height` over triangle `pick` at weights `u`, `v` (on an edge or vertex where 0 or 1).
fn over_triangle(surface: &Surface, pick: usize, u: f64, v: f64, height: f64) -> V3 {
    let mesh = surface.mesh();
    let index = pick % mesh.len();
    let [a, b, c] = mesh.triangles[index].map(|i| mesh.vertices[i as usize]);
    let foot = a + u * ((b - a) + v * (c - b));
    foot + height * mesh.normal(index as u32)
}

/// A weight that is often exactly 0 or 1.
fn weight() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), Just(1.0), Just(0.5), 0.0..1.0f64]
}

fn unit() -> impl Strategy<Value = [f64; 3]> {
    [0.0..1.0f64, 0.0..1.0, 0.0..1.0]
}

/// Closest point of a triangle, as plainly as can be: foot on the plane, else on the sides.
fn closest_plain([a, b, c]: [V3; 3], p: V3) -> V3 {
    let n = (b - a).cross(&(c - a)).normalize();
    let foot = p - (p - a).dot(&n) * n;
    let sides = [(a, b), (b, c), (c, a)];
    if sides
        .iter()
        .all(|(s, e)| (e - s).cross(&(foot - s)).dot(&n) >= 0.0)
    {
        return foot;
    }
    let on_side = |(s, e): (V3, V3)| {
        s + ((p - s).dot(&(e - s)) / (e - s).norm_squared()).clamp(0.0, 1.0) * (e - s)
    };
    let nearer = |q: V3, r: V3| {
        if (p - r).norm() < (p - q).norm() {
            r
        } else {
            q
        }
    };
    sides.map(on_side).into_iter().reduce(nearer).unwrap()
}

/// Feet closer than this are one, m: aside of the true foot by this much, the distance grows by
/// 1e-13 m only, little more than what rounding leaves of it.
const SAME: f64 = 1e-8;

/// Points of the surface within `R` of an outside point `p` that are closer than all around them.
fn local_minima(mesh: &TriMesh, p: V3) -> Vec<V3> {
    let corners = |t: usize| mesh.triangles[t].map(|i| mesh.vertices[i as usize]);
    let mut found: Vec<V3> = Vec::new();
    for t in 0..mesh.len() {
        let q = closest_plain(corners(t), p);
        let here: Vec<usize> = (0..mesh.len())
            .filter(|&s| (closest_plain(corners(s), q) - q).norm() < 1e-12)
            .collect();
        let lowest = here
            .iter()
            .all(|&s| (closest_plain(corners(s), p) - p).norm() > (q - p).norm() - 1e-14);
        let seen = here
            .iter()
            .any(|&s| (p - q).dot(&mesh.normal(s as u32)) > 0.0);
        let new = found.iter().all(|known| (known - q).norm() > SAME);
        if (q - p).norm() < R && lowest && seen && new {
            found.push(q);
        }
    }
    found
}

/// What must hold at any point of any mesh.
fn check_touches(surface: &Surface, p: V3) -> Result<(), TestCaseError> {
    let found = touches(surface, p);
    let nearest = surface.mesh().nearest_brute(p);
    let deepest = found.iter().map(|t| t.depth).fold(0.0, f64::max);
    if nearest.distance.abs() < R * (1.0 - 1e-12) {
        prop_assert!(
            (deepest - (R - nearest.distance)).abs() < 1e-14,
            "{found:?} {nearest:?}"
        );
    } else if nearest.distance.abs() > R * (1.0 + 1e-12) {
        prop_assert!(found.is_empty(), "{found:?} {nearest:?}");
    }
    for touch in &found {
        prop_assert!((touch.normal.norm() - 1.0).abs() < 1e-12);
        prop_assert!(touch.depth > 0.0);
        // The point, the normal and the depth tell the same story.
        let centre = touch.point + (R - touch.depth) * touch.normal;
        prop_assert!((centre - p).norm() < 1e-12, "{touch:?} {p:?}");
    }
    let mut brute = Vec::new();
    surface.mesh().touching_brute(p, R, &mut brute);
    prop_assert_eq!(&found, &brute);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn rounded_box_gives_its_analytic_distance(u in unit(), over in -0.5..1.0f64, pick in 0usize..1000, v in unit()) {
        let surface = box_surface();
        let error = sagitta(BOX[3], 4 * CHORDS);
        for p in [in_bounds(&surface, 2.0 * R, u), over_triangle(&surface, pick, v[0], v[1], over * R)] {
            let exact = box_distance(p);
            let found = touches(&surface, p);
            if exact.abs() < R - error {
                prop_assert_eq!(found.len(), 1);
                // The mesh lies inside the true surface by at most the sagitta.
                let short = (R - exact) - found[0].depth;
                prop_assert!((-1e-14..error + 1e-14).contains(&short), "{}", short);
            } else if exact > R || exact < -R - error {
                prop_assert!(found.is_empty());
            }
            check_touches(&surface, p)?;
        }
    }

    #[test]
    fn convex_cores_touch_exactly_once(
        pick in 0usize..1000, u in weight(), v in weight(),
        height in prop_oneof![Just(0.0), -0.9..0.99f64, -1e-12..1e-12f64],
        shape in 0usize..3,
    ) {
        let surface = match shape {
            0 => box_surface(),
            1 => Surface::new(cylinder(0.01, 0.02, 36).unwrap()),
            _ => Surface::new(rounded_box(0.01, 0.02, 0.03, 0.0, 1).unwrap()),
        };
        prop_assert!(surface.is_convex());
        let p = over_triangle(&surface, pick, u, v, height * R);
        prop_assert_eq!(touches(&surface, p).len(), 1, "at {:?}", p);
        check_touches(&surface, p)?;
    }

    #[test]
    fn concave_cores_keep_the_distance(
        pick in 0usize..1000, u in weight(), v in weight(), height in -0.99..0.99f64,
        any in unit(), shape in 0usize..3,
    ) {
        let surface = [angle_iron, channel, bobbin][shape]();
        prop_assert!(!surface.is_convex());
        check_touches(&surface, over_triangle(&surface, pick, u, v, height * R))?;
        check_touches(&surface, in_bounds(&surface, R, any))?;
    }

    #[test]
    fn touches_are_the_local_minima_of_the_distance(
        pick in 0usize..1000, u in 0.0..1.0f64, v in 0.0..1.0f64, height in 0.0..1.0f64,
        aside in [-1.0..1.0f64, -1.0..1.0, -1.0..1.0], shape in 0usize..3,
    ) {
        // No concave edge of these is a seam, so nothing is merged.
        let surface = [angle_iron, channel, box_surface][shape]();
        let p = over_triangle(&surface, pick, u, v, height * R) + 0.8 * R * V3::from(aside);
        if surface.nearest(p).distance <= 1e-9 {
            return Ok(());
        }
        let found = touches(&surface, p);
        let expected = local_minima(surface.mesh(), p);
        prop_assert_eq!(found.len(), expected.len(), "{:?} {:?}", found, expected);
        for q in expected {
            prop_assert!(found.iter().any(|t| (t.point - q).norm() < SAME));
        }
    }

    #[test]
    fn single_precision_noise_and_tilt_change_nothing(
        pick in 0usize..1000, u in weight(), v in weight(), height in 0.0..0.99f64,
    ) {
        // Turned and rounded to f32 the flats are no longer flat: diagonals bend both ways.
        let exact = rounded_box(BOX[0], BOX[1], BOX[2], BOX[3], CHORDS).unwrap();
        let turn = nalgebra::Rotation3::from_euler_angles(0.3, 0.7, -0.4);
        let rounded = exact.vertices.iter().map(|p| (turn * p).map(|x| f64::from(x as f32)));
        let mesh = TriMesh::new(rounded.collect(), exact.triangles.clone()).unwrap();
        let surface = Surface::new(mesh);
        prop_assert!(surface.is_convex());
        let p = over_triangle(&surface, pick, u, v, height * R);
        prop_assert_eq!(touches(&surface, p).len(), 1);
        check_touches(&surface, p)?;
    }

    #[test]
    fn search_tree_agrees_with_asking_everyone(
        u in unit(), radius in 0.0..0.02f64, shape in 0usize..4, guess in 0u32..2000,
    ) {
        let surface = [box_surface, angle_iron, channel, bobbin][shape]();
        let p = in_bounds(&surface, 0.005, u);
        let (mut fast, mut slow) = (Vec::new(), Vec::new());
        surface.near(p, radius, &mut fast);
        surface.mesh().near_brute(p, radius, &mut slow);
        prop_assert_eq!(&fast, &slow);
        let (fast, slow): (Nearest, Nearest) = (surface.nearest(p), surface.mesh().nearest_brute(p));
        prop_assert_eq!(fast, slow);
        let tree = Bvh::new(surface.mesh());
        prop_assert_eq!(tree.nearest_from(surface.mesh(), p, guess).0, slow);
    }

    #[test]
    fn normal_is_the_gradient_of_the_distance(
        pick in 0usize..1000, u in 0.0..1.0f64, v in 0.0..1.0f64, side in [-1.0..1.0f64, -1.0..1.0, -1.0..1.0],
        shape in 0usize..4,
    ) {
        let surface = [box_surface, angle_iron, channel, bobbin][shape]();
        let p = over_triangle(&surface, pick, u, v, 0.5 * R) + 0.4 * R * V3::from(side);
        let step = 1e-9;
        let at = |q: V3| touches(&surface, q);
        let here = at(p);
        // Where another touch is about to take over, the depth has a kink and no gradient.
        let shifted: Vec<V3> = (0..6)
            .map(|i| {
                let mut q = p;
                q[i / 2] += if i % 2 == 0 { step } else { -step };
                q
            })
            .collect();
        let around: Vec<Vec<Touch>> = shifted.iter().map(|&q| at(q)).collect();
        prop_assume!(!here.is_empty() && around.iter().all(|t| t.len() == here.len()));
        for (index, touch) in here.iter().enumerate() {
            let near = |t: &Touch| (t.normal - touch.normal).norm() < 1e-3;
            if !around.iter().all(|t| near(&t[index])) {
                continue;
            }
            for axis in 0..3 {
                let slope = (around[2 * axis][index].depth - around[2 * axis + 1][index].depth) / (2.0 * step);
                prop_assert!((slope + touch.normal[axis]).abs() < 2e-6, "{} {:?}", slope, touch);
            }
        }
    }

    #[test]
    fn depth_follows_a_path_without_jumps(from in unit(), to in unit(), shape in 0usize..4) {
        let surface = [box_surface, angle_iron, channel, bobbin][shape]();
        let (a, b) = (in_bounds(&surface, R, from), in_bounds(&surface, R, to));
        let steps = 400;
        let path_step = (b - a).norm() / f64::from(steps);
        let mut last: Option<f64> = None;
        for i in 0..=steps {
            let p = a + f64::from(i) / f64::from(steps) * (b - a);
            let found = touches(&surface, p);
            let deepest = found.iter().map(|t| t.depth).reduce(f64::max);
            if surface.is_convex() {
                prop_assert!(found.len() <= 1);
            }
            // Deeper than r inside there is no contact any more, by design.
            if let Some(before) = last.filter(|&d| d + path_step < 2.0 * R) {
                let jump = deepest.unwrap_or(0.0) - before;
                prop_assert!(jump.abs() <= path_step * (1.0 + 1e-9) + 1e-15, "{} at {:?}", jump, p);
            }
            let gone_inside = deepest.is_none() && surface.nearest(p).distance < 0.0;
            last = if gone_inside { None } else { Some(deepest.unwrap_or(0.0)) };
        }
    }
}

#[test]
fn an_inner_corner_touches_both_walls() {
    let p = V3::new(1.2e-3, 0.0, 1.3e-3);
    let mut found = touches(&angle_iron(), p);
    found.sort_by(|a, b| a.depth.total_cmp(&b.depth));
    assert_eq!(found.len(), 2, "{found:?}");
    assert!((found[0].normal - V3::z()).norm() < 1e-12);
    assert!((found[0].depth - (R - 0.3e-3)).abs() < 1e-15);
    assert!((found[1].normal - V3::x()).norm() < 1e-12);
    assert!((found[1].depth - (R - 0.2e-3)).abs() < 1e-15);
}

#[test]
fn a_narrow_channel_touches_floor_and_both_walls() {
    let found = touches(&channel(), V3::new(1.16e-3, 1e-3, 1.3e-3));
    let sum: V3 = found.iter().map(|t| t.normal).sum();
    assert_eq!(found.len(), 3, "{found:?}");
    assert!((sum - V3::z()).norm() < 1e-12, "the walls face each other");
}

#[test]
fn inside_one_wall_the_other_still_touches() {
    // 0.05 mm deep in the wall at x = 1 mm, 0.35 mm less a hair from the wall across the gap.
    let found = touches(&channel(), V3::new(0.9501e-3, 1e-3, 1.7e-3));
    assert_eq!(found.len(), 2, "{found:?}");
    assert!((found[0].normal + V3::x()).norm() < 1e-12);
    assert!((found[0].depth - 1e-7).abs() < 1e-15);
    assert!((found[1].normal - V3::x()).norm() < 1e-12);
    assert!((found[1].depth - (R + 0.0499e-3)).abs() < 1e-15);
}

#[test]
fn a_spike_and_a_wall_both_touch() {
    // Two cubes: the face x = 0 of one, and a vertex of the other pointing at it from 0.4 mm.
    let cube = rounded_box(0.01, 0.01, 0.01, 0.0, 1).unwrap();
    let diagonal = V3::new(-1.0, -1.0, -1.0).normalize();
    let turn = nalgebra::Rotation3::rotation_between(&diagonal, &-V3::x()).unwrap();
    let spike = V3::new(0.4e-3, 0.001, 0.002);
    let mut vertices: Vec<V3> = cube
        .vertices
        .iter()
        .map(|v| v - V3::new(0.005, 0.0, 0.0))
        .collect();
    vertices.extend(
        cube.vertices
            .iter()
            .map(|v| spike + turn * (v + V3::repeat(0.005))),
    );
    let mut triangles = cube.triangles.clone();
    triangles.extend(
        cube.triangles
            .iter()
            .map(|t| t.map(|v| v + cube.vertices.len() as u32)),
    );
    let surface = Surface::new(TriMesh::new(vertices, triangles).unwrap());

    let found = touches(&surface, spike - V3::new(0.15e-3, 1e-5, -2e-5));
    assert_eq!(found.len(), 2, "{found:?}");
    assert!((found[0].normal - V3::x()).norm() < 1e-12);
    assert!((found[0].depth - 0.1e-3).abs() < 1e-15);
    assert!((found[1].point - spike).norm() < 1e-15);
    let arm = V3::new(-0.15e-3, -1e-5, 2e-5);
    assert!((found[1].normal - arm.normalize()).norm() < 1e-10);
    assert!((found[1].depth - (R - arm.norm())).abs() < 1e-15);
}

#[test]
fn under_the_floor_of_a_corner_the_edge_still_pushes_out() {
    // Behind both walls no prism holds the centre; the concave edge is nearest.
    let p = V3::new(0.9e-3, 0.0, 0.8e-3);
    let found = touches(&angle_iron(), p);
    assert_eq!(found.len(), 1);
    let way_out = V3::new(0.1e-3, 0.0, 0.2e-3);
    assert!((found[0].normal - way_out.normalize()).norm() < 1e-12);
    assert!((found[0].depth - (R + way_out.norm())).abs() < 1e-15);
}

#[test]
fn a_thin_flange_does_not_pull_the_wire_through() {
    // The flange is 0.2 mm thick, so its far face, too, is within r.
    let bobbin = bobbin();
    let outside = touches(&bobbin, V3::new(0.0065, 0.0049, 0.0));
    assert_eq!(outside.len(), 1);
    assert!((outside[0].normal + V3::y()).norm() < 1e-9, "{outside:?}");
    assert!((outside[0].depth - (R - 0.1e-3)).abs() < 1e-12);
    let inside = touches(&bobbin, V3::new(0.0065, 0.00505, 0.0));
    assert_eq!(inside.len(), 1);
    assert!((inside[0].normal + V3::y()).norm() < 1e-9, "{inside:?}");
}

#[test]
fn hub_and_flange_both_hold_the_wire() {
    // Hub facets are chords, so the hub's depth is read from the section at the facet's middle.
    let angle = std::f64::consts::PI / 48.0;
    let rho = 0.005 * angle.cos() + 0.9 * R;
    let p = V3::new(rho * angle.cos(), 0.005 - 0.8 * R, rho * angle.sin());
    let found = touches(&bobbin(), p);
    assert_eq!(found.len(), 2, "{found:?}");
    let depths: Vec<f64> = found.iter().map(|t| t.depth / R).collect();
    assert!(depths.iter().any(|d| (d - 0.1).abs() < 1e-9), "{depths:?}");
    assert!(depths.iter().any(|d| (d - 0.2).abs() < 1e-9), "{depths:?}");
}

#[test]
fn a_tessellated_bore_is_one_surface() {
    // Prisms of neighbouring facets overlap inside a bore; the 7.5 degree seams must not count twice.
    let bobbin = bobbin();
    for i in 0..2000 {
        let angle = 0.00317 * f64::from(i);
        let rho = 0.003 - 0.8 * R;
        let p = V3::new(rho * angle.cos(), 1e-4, rho * angle.sin());
        assert_eq!(touches(&bobbin, p).len(), 1, "at {angle} rad");
    }
}

#[test]
fn on_a_sharp_edge_of_a_concave_core_rounding_makes_no_copies() {
    let turn = nalgebra::Rotation3::from_euler_angles(0.3, 0.7, -0.4);
    let level = angle_iron();
    let vertices = level.mesh().vertices.iter().map(|v| turn * v).collect();
    let surface = Surface::new(TriMesh::new(vertices, level.mesh().triangles.clone()).unwrap());
    for i in 1..1000 {
        let p = turn * V3::new(0.0, 1e-5 * f64::from(i) - 5e-3, 0.0);
        let found = touches(&surface, p);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!((found[0].depth - R).abs() < 1e-15);
    }
}

#[test]
fn every_way_over_a_flat_counts_once() {
    // Across the diagonal, along it, and over the hub of a cap.
    let surface = Surface::new(rounded_box(0.01, 0.02, 0.03, 0.0, 1).unwrap());
    let face = |s: f64, t: f64| V3::new(0.005 + 0.5 * R, 0.03 * (s - 0.5), 0.02 * (t - 0.5));
    for i in 0..=1000 {
        let s = f64::from(i) / 1000.0;
        for p in [face(s, s), face(s, 1.0 - s), face(s, 0.37)] {
            let found = touches(&surface, p);
            assert_eq!(found.len(), 1, "at {p:?}");
            assert!((found[0].normal - V3::x()).norm() < 1e-12);
            assert!((found[0].depth - 0.5 * R).abs() < 1e-15);
        }
        let cap = V3::new(
            1e-17 * f64::from(i - 500),
            0.015 + 0.5 * R,
            3e-18 * f64::from(i % 7),
        );
        assert_eq!(touches(&surface, cap).len(), 1, "at {cap:?}");
    }
}

#[test]
fn nonsense_touches_nothing() {
    let surface = box_surface();
    let nan = V3::new(f64::NAN, 0.0, 0.0);
    assert!(touches(&surface, nan).is_empty());
    let mut out = vec![3];
    surface.near(nan, R, &mut out);
    surface.near(V3::zeros(), f64::NAN, &mut out);
    assert!(out.is_empty());
    surface
        .mesh()
        .touching_brute(V3::new(0.006, 0.0, 0.0), -1.0, &mut Vec::new());
}

#[test]
fn radius_and_bounds() {
    let surface = box_surface();
    let (low, high) = surface.bounds();
    assert_eq!(high, V3::new(0.006, 0.02, 0.015));
    assert_eq!(low, -high);
    // The chord's end nearest the diagonal is on the arc, half a chord away at most.
    let exact = 2e-3 + 4e-3f64.hypot(13e-3);
    assert!(surface.radius_max() <= exact + 1e-15);
    assert!(surface.radius_max() > exact - sagitta(2e-3, 4 * CHORDS));
}

/// The paper's inside test as printed (eq. 3-4): `a_j = n x e_j` with `e_j = P_(j-1) - P_j`,
/// taken the other way round where the centroid lies at positive `(C - P_j) . a_j`.
fn published_inside_test(p: [V3; 3], n: V3, x: V3) -> bool {
    let centroid = (p[0] + p[1] + p[2]) / 3.0;
    (0..3).all(|j| {
        let (before, here, after) = (p[(j + 2) % 3], p[j], p[(j + 1) % 3]);
        let mut a = n.cross(&(before - here));
        if (centroid - here).dot(&a) >= 0.0 {
            a = n.cross(&(here - after));
        }
        (x - here).dot(&a) >= 0.0
    })
}

#[test]
fn the_published_sign_misses_the_face() {
    // A counterclockwise triangle and a point right over its centroid, half a radius up.
    let surface = box_surface();
    let mesh = surface.mesh();
    let widest = |&a: &u32, &b: &u32| {
        let area = |t: u32| {
            let [p, q, r] = mesh.triangles[t as usize].map(|i| mesh.vertices[i as usize]);
            (q - p).cross(&(r - p)).norm()
        };
        area(a).total_cmp(&area(b))
    };
    let triangle = (0..mesh.len() as u32).max_by(widest).unwrap();
    let corners = mesh.triangles[triangle as usize].map(|i| mesh.vertices[i as usize]);
    let normal = mesh.normal(triangle);
    let x = (corners[0] + corners[1] + corners[2]) / 3.0 + 0.5 * R * normal;
    assert!(!published_inside_test(corners, normal, x));
    let found = touches(&surface, x);
    assert_eq!(found.len(), 1);
    assert!((found[0].depth - 0.5 * R).abs() < 1e-15);
}
