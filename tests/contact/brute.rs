//! Slow, obvious twins of the contact search: no grid, no tree, no memory.

use coilwind::geometry::{Shape, Surface, TriMesh, generate};
use coilwind::math::V3;
use std::sync::Arc;

/// Samples per segment. Chosen: two minima a thirtieth of a millimetre apart are still two.
const SAMPLES: usize = 32;

/// A local minimum of the distance from a wire.
#[derive(Clone, Copy, Debug)]
pub struct Minimum {
    /// segment plus share
    pub t: f64,
    pub distance: f64,
    /// from the wire to the point
    pub normal: V3,
}

/// The three points that shape the wire at `t`, segment plus share, and the share.
fn shaped_by(q: &[V3], t: f64) -> ([V3; 3], f64) {
    let last = q.len() - 1;
    let k = (t.floor() as usize).min(last);
    let before = if k == 0 { q[0] * 2.0 - q[1] } else { q[k - 1] };
    let after = if k == last {
        q[last] * 2.0 - q[last - 1]
    } else {
        q[k + 1]
    };
    ([before, q[k], after], t - k as f64)
}

/// The wire's quadratic spline at `t`, segment plus share; straight halves at both ends.
pub fn on_wire(q: &[V3], t: f64) -> V3 {
    let ([before, here, after], s) = shaped_by(q, t);
    before * (0.5 * (1.0 - s) * (1.0 - s)) + here * (0.5 + s - s * s) + after * (0.5 * s * s)
}

/// Its derivative by `t`.
fn along_wire(q: &[V3], t: f64) -> V3 {
    let ([before, here, after], s) = shaped_by(q, t);
    before * (s - 1.0) + here * (1.0 - 2.0 * s) + after * s
}

/// All local minima nearer than `reach`, both ends of the wire included: where the slope of the distance changes its sign from one sample
/// to the next, halved. Distances alone miss a shallow minimum at a joint of segments, and find the place of one to the root of rounding.
pub fn minima(q: &[V3], p: V3, reach: f64) -> Vec<Minimum> {
    let first = SAMPLES / 2;
    let last = (q.len() - 1) * SAMPLES + SAMPLES / 2;
    let at = |i: usize| i as f64 / SAMPLES as f64;
    let slope = |t: f64| (on_wire(q, t) - p).dot(&along_wire(q, t));
    let longest = q
        .windows(2)
        .map(|e| (e[1] - e[0]).norm())
        .fold(0.0, f64::max);
    let mut found = Vec::new();
    // a segment stays within an edge of its node
    let near = |k: usize| (q[k] - p).norm() < reach + longest;
    for k in (0..q.len()).filter(|k| near(*k)) {
        for i in (k * SAMPLES).max(first)..=((k + 1) * SAMPLES - 1).min(last) {
            let falls = slope(at(i)) < 0.0;
            let (mut a, mut b) = if i == last && falls || i == first && !falls {
                (at(i), at(i))
            } else if i < last && falls && slope(at(i + 1)) >= 0.0 {
                (at(i), at(i + 1))
            } else {
                continue;
            };
            for _ in 0..60 {
                let middle = 0.5 * (a + b);
                match slope(middle) < 0.0 {
                    true => a = middle,
                    false => b = middle,
                }
            }
            let t = 0.5 * (a + b);
            let arm = p - on_wire(q, t);
            if arm.norm() < reach {
                found.push(Minimum {
                    t,
                    distance: arm.norm(),
                    normal: arm.normalize(),
                });
            }
        }
    }
    found
}

/// Signed distance of a core and its gradient: by formula, or from every triangle of a convex mesh.
pub fn core(shape: &Shape, p: V3) -> (f64, V3) {
    match shape {
        Shape::RoundedBox {
            half_x,
            half_z,
            half_y,
            corner_radius,
        } => {
            // a ball of the corner radius rolls round a sharp rectangle
            let (x, z) = (half_x - corner_radius, half_z - corner_radius);
            let nearest = V3::new(p.x.clamp(-x, x), 0.0, p.z.clamp(-z, z));
            let off = V3::new(p.x, 0.0, p.z) - nearest;
            let side = if off.norm() > 0.0 {
                (off.norm() - corner_radius, off.normalize())
            } else if half_x - p.x.abs() < half_z - p.z.abs() {
                (p.x.abs() - half_x, V3::x() * p.x.signum())
            } else {
                (p.z.abs() - half_z, V3::z() * p.z.signum())
            };
            ends(side, *half_y, p)
        }
        Shape::Cylinder { radius, half_y } => {
            let out = V3::new(p.x, 0.0, p.z);
            ends((out.norm() - radius, out.normalize()), *half_y, p)
        }
        Shape::Mesh(surface) => convex_mesh(&surface.mesh().vertices, &surface.mesh().triangles, p),
    }
}

fn ends((side, out): (f64, V3), half_y: f64, p: V3) -> (f64, V3) {
    let (end, up) = (p.y.abs() - half_y, V3::y() * p.y.signum());
    if side > 0.0 && end > 0.0 {
        let way = out * side + up * end;
        (way.norm(), way.normalize())
    } else if side > end {
        (side, out)
    } else {
        (end, up)
    }
}

fn convex_mesh(vertices: &[V3], triangles: &[[u32; 3]], p: V3) -> (f64, V3) {
    let corners = |t: &[u32; 3]| t.map(|v| vertices[v as usize]);
    // inside a convex solid the nearest surface is the highest plane
    let highest = triangles
        .iter()
        .map(|t| {
            let [a, b, c] = corners(t);
            let n = (b - a).cross(&(c - a)).normalize();
            (n.dot(&(p - a)), n)
        })
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .expect("a mesh has triangles");
    if highest.0 <= 0.0 {
        return highest;
    }
    let nearest = triangles
        .iter()
        .map(|t| on_triangle(corners(t), p))
        .min_by(|a, b| (a - p).norm().total_cmp(&(b - p).norm()))
        .expect("a mesh has triangles");
    ((p - nearest).norm(), (p - nearest).normalize())
}

/// The point of a triangle nearest to `p`: its foot on the plane, if inside, or one on the rim.
fn on_triangle([a, b, c]: [V3; 3], p: V3) -> V3 {
    let n = (b - a).cross(&(c - a)).normalize();
    let foot = p - n * n.dot(&(p - a));
    let sides = [(a, b), (b, c), (c, a)];
    if sides
        .iter()
        .all(|(s, e)| n.dot(&(e - s).cross(&(foot - s))) >= 0.0)
    {
        return foot;
    }
    sides
        .map(|(s, e)| {
            s + (e - s) * ((p - s).dot(&(e - s)) / (e - s).norm_squared()).clamp(0.0, 1.0)
        })
        .into_iter()
        .min_by(|x, y| (x - p).norm().total_cmp(&(y - p).norm()))
        .expect("three sides")
}

/// Chords of a round, as coarse as a scene may have it.
const CHORDS: usize = 16;

/// Cores to wind on: 0 box, 1 cylinder, 2 box of triangles, 3 cylinder of triangles.
pub fn a_core(kind: usize) -> Shape {
    let mesh = |m: Result<TriMesh, _>| Shape::Mesh(Arc::new(Surface::new(m.expect("a mesh"))));
    match kind {
        0 => Shape::RoundedBox {
            half_x: 6e-3,
            half_z: 10e-3,
            half_y: 8e-3,
            corner_radius: 2e-3,
        },
        1 => Shape::Cylinder {
            radius: 7e-3,
            half_y: 8e-3,
        },
        2 => mesh(generate::rounded_box(12e-3, 20e-3, 16e-3, 2e-3, CHORDS)),
        _ => mesh(generate::cylinder(7e-3, 16e-3, 4 * CHORDS)),
    }
}

/// A wire wound round a core, and what bends it out of shape.
#[derive(Clone, Copy, Debug)]
pub struct Coil {
    pub kind: usize,
    pub diameter: f64,
    /// per turn, m
    pub pitch: f64,
    /// gap between wire and core, and amplitude of waves on it, m
    pub gap: f64,
    pub wave: f64,
    pub phase: f64,
    /// longest edge, m; the shortest is 0.4 mm
    pub longest: f64,
    pub turns: f64,
    /// turns in the first layer, the rest lies on top and goes back
    pub layer: f64,
}

impl Coil {
    /// Nodes from the clamp on, and the arc length at each, m.
    pub fn wound(&self) -> (Vec<V3>, Vec<f64>) {
        let shape = a_core(self.kind);
        let (mut q, mut arc) = (Vec::<V3>::new(), Vec::new());
        let mut angle = 0.0;
        while angle < self.turns * std::f64::consts::TAU {
            let turn = angle / std::f64::consts::TAU;
            let (along, up) = if turn < self.layer {
                (turn, 0.0)
            } else {
                (2.0 * self.layer - turn, 0.9 * self.diameter)
            };
            let y = self.pitch * (along - 0.5 * self.layer)
                + self.wave * libm::cos(5.1 * angle + self.phase);
            let height = 0.5 * self.diameter
                + self.gap
                + up
                + self.wave * libm::sin(7.3 * angle + self.phase);
            let out = V3::new(libm::cos(angle), 0.0, libm::sin(angle));
            // walk out until the core is that far away
            let mut r = 6e-3;
            for _ in 0..60 {
                r += height - shape.nearness(out * r).distance;
            }
            let p = out * r + V3::y() * y;
            let edge = q.last().map_or(0.0, |last| (p - last).norm());
            arc.push(arc.last().copied().unwrap_or(0.0) + edge);
            q.push(p);
            let share = 0.5 + 0.5 * libm::sin(1.7 * q.len() as f64 + self.phase);
            angle += (0.4e-3 + (self.longest - 0.4e-3) * share * share) / r;
        }
        (q, arc)
    }
}
