//! The picture of core and wire, `coil.png`.
//!
//! Triangles are drawn into a buffer that keeps the nearest one per pixel, at twice the size in
//! each direction. Each such pixel is lit once, and four of them make one pixel of the picture.

use super::camera::{Camera, Frame, Light};
use super::raster::{NONE, Raster};
use super::shade::{Encoding, Lighting, Material, background, shade};
use super::tube::tube_mesh;
use super::vtp::{check_mesh, turns_of_nodes};
use super::{OutputError, write_whole};
use crate::math::V3;
use crate::simulation::Centreline;
use std::collections::BTreeMap;
use std::path::Path;

/// Pixels drawn per pixel shown, in each direction.
const SUPERSAMPLING: u32 = 2;
/// Width of the view, rad: narrow, as through a long lens.
const VIEW_ANGLE: f64 = 0.40;
/// Angle between neighbouring triangles up to which the core is shaded as one round surface, rad.
const CREASE: f64 = 0.6;
/// Normals of the core's triangles that agree in so many parts of one in each component count as one. Chosen: a sixtieth of [`CREASE`].
const DIRECTIONS: f64 = 100.0;
/// Number of triangles that the wire's smoothness is kept to. More of them than pixels shows
/// nothing.
const WIRE_TRIANGLES: usize = 1_500_000;
/// Points of a wire's section: no corner shows in a short coil, and a long one has less to show.
const SIDES: usize = 24;
const FEWEST_SIDES: usize = 8;

/// Surface of the core, core frame.
#[derive(Clone, Copy, Debug)]
pub struct CoreMesh<'a> {
    /// positions, core frame, m
    pub vertices: &'a [V3],
    /// three vertex indices each, counterclockwise from outside
    pub triangles: &'a [[u32; 3]],
}

/// How the wire is coloured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Colouring {
    /// wire at rest is copper, live wire blue
    #[default]
    State,
    /// each turn its own, live wire too
    Turn,
}

/// A coil and how it is seen.
#[derive(Clone, Copy, Debug)]
pub struct Picture<'a> {
    /// core, if any
    pub core: Option<CoreMesh<'a>>,
    /// wire in the core frame
    pub wire: &'a Centreline,
    /// wire radius, m
    pub radius: f64,
    /// how the wire is coloured
    pub colouring: Colouring,
    /// width and height, pixels
    pub size: (u32, u32),
    /// direction from the coil to the viewer, core frame
    pub from: V3,
}

impl<'a> Picture<'a> {
    /// A picture of 1200 x 900 pixels, seen from the face of the clamp, a little from the side and
    /// from above.
    pub fn new(core: Option<CoreMesh<'a>>, wire: &'a Centreline, radius: f64) -> Self {
        Self {
            core,
            wire,
            radius,
            colouring: Colouring::State,
            size: (1200, 900),
            from: V3::new(1.0, 0.55, 0.62),
        }
    }
}

/// Renders the picture and writes it as PNG.
pub fn render_png(path: &Path, picture: &Picture) -> Result<(), OutputError> {
    if let Some(core) = &picture.core {
        check_mesh(path, core.vertices, core.triangles)?;
    }
    let pixels = render(picture);
    let (width, height) = picture.size;
    write_whole(path, |file| {
        let mut encoder = png::Encoder::new(file, width, height);
        encoder.set_color(png::ColorType::Rgb);
        // Not by zlib, of which there are several: the bytes would depend on what other crates ask for.
        encoder.set_compression(png::Compression::Fast);
        encoder.set_filter(png::Filter::Adaptive);
        encoder
            .write_header()
            .and_then(|mut writer| {
                writer.write_image_data(pixels.as_flattened())?;
                writer.finish()
            })
            .map_err(|source| OutputError::Image {
                path: path.to_owned(),
                source,
            })
    })
}

/// Renders the picture: red, green and blue of each pixel, row by row from the top. The core's triangles must name
/// existing vertices.
pub fn render(picture: &Picture) -> Vec<[u8; 3]> {
    let mut scene = Surface::default();
    if let Some(core) = &picture.core {
        scene.add_core(core);
    }
    scene.add_wire(picture);
    let (width, height) = picture.size;
    let (wide, high) = (width * SUPERSAMPLING, height * SUPERSAMPLING);
    let framed = framed_points(picture);
    let frame = Frame::looking_from(picture.from, V3::y());
    let size = (f64::from(wide), f64::from(high));
    let camera = Camera::framing(&framed, frame, VIEW_ANGLE, size, 0.06);
    let light = Light::on(&framed, camera.direction(0.30, 0.85, 0.75), 2048);

    let mut seen = Raster::new(wide as usize, high as usize);
    let mut shadow = Raster::new(light.texels, light.texels);
    for (id, triangle) in scene.triangles.iter().enumerate() {
        let id = id as u32;
        let points = scene.points_of(triangle);
        shadow.draw(points.map(|p| light.project(p)), id);
        let [a, b, c] = points.map(|p| camera.project(p));
        if let (Some(a), Some(b), Some(c)) = (a, b, c) {
            seen.draw([a, b, c], id);
        }
    }
    let reach = 2.5 * picture.radius;
    let view = View {
        scene: &scene,
        camera,
        light,
        seen,
        shadow,
        disc: Disc::new(),
        reach,
    };
    let encoding = Encoding::new();
    let pixel = |x, y| {
        let mean = view.pixel(x, y);
        [mean.x, mean.y, mean.z].map(|light| encoding.byte(light))
    };
    let mut pixels = vec![[0; 3]; (width * height) as usize];
    in_bands(&mut pixels, width as usize, |x, y| {
        pixel(x as u32, y as u32)
    });
    pixels
}

/// Gives each pixel of rows of this width its value by column and row, on all processors.
fn in_bands(pixels: &mut [[u8; 3]], width: usize, value: impl Fn(usize, usize) -> [u8; 3] + Sync) {
    let rows = pixels.len() / width.max(1);
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    // (rows of the background are done soon: more bands than processors)
    let of_band = rows.div_ceil(8 * threads).max(1);
    let value = &value;
    std::thread::scope(|scope| {
        for (band, pixels) in pixels.chunks_mut(of_band * width.max(1)).enumerate() {
            scope.spawn(move || {
                for (k, pixel) in pixels.iter_mut().enumerate() {
                    *pixel = value(k % width, band * of_band + k / width);
                }
            });
        }
    });
}

/// Points that must be in the picture: the core's section over the length of the coil, and the
/// wire on it. The free wire leaves the picture, and a long core is cut.
fn framed_points(picture: &Picture) -> Vec<V3> {
    let wire = picture.wire;
    let laid = wire
        .frozen
        .clamp(wire.points.len().min(1), wire.points.len());
    let mut points: Vec<V3> = wire.points[..laid].to_vec();
    let (low, high) = points
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| {
            (low.min(p.y), high.max(p.y))
        });
    if let Some(core) = &picture.core {
        // Enough core on both sides of the wire to see where on it the wire lies.
        let free = 6.0 * picture.radius;
        let (low, high) = if low <= high {
            (low - free, high + free)
        } else {
            (low, -low)
        };
        let inside = |p: &V3| {
            V3::new(
                p.x,
                if low <= high {
                    p.y.clamp(low, high)
                } else {
                    p.y
                },
                p.z,
            )
        };
        points.extend(core.vertices.iter().map(inside));
    }
    if points.is_empty() {
        points.push(V3::zeros());
    }
    points
}

/// A triangle by its corners' numbers.
struct Triangle {
    corners: [u32; 3],
    material: u32,
}

/// Everything that is drawn.
#[derive(Default)]
struct Surface {
    points: Vec<V3>,
    /// at the points
    normals: Vec<V3>,
    triangles: Vec<Triangle>,
    materials: Vec<Material>,
}

impl Surface {
    fn points_of(&self, triangle: &Triangle) -> [V3; 3] {
        triangle.corners.map(|k| self.points[k as usize])
    }

    fn normals_of(&self, triangle: &Triangle) -> [V3; 3] {
        triangle.corners.map(|k| self.normals[k as usize])
    }

    fn material(&mut self, material: Material) -> u32 {
        let known = self.materials.iter().position(|&m| m == material);
        let index = known.unwrap_or_else(|| {
            self.materials.push(material);
            self.materials.len() - 1
        });
        index as u32
    }

    fn add_core(&mut self, core: &CoreMesh) {
        let material = self.material(Material::core());
        let corners = |t: &[u32; 3]| t.map(|vertex| core.vertices[vertex as usize]);
        // Twice the area times the unit normal: large triangles count more at a vertex.
        let areas: Vec<V3> = core
            .triangles
            .iter()
            .map(|t| {
                let [a, b, c] = corners(t);
                (b - a).cross(&(c - a))
            })
            .collect();
        // Files such as STL repeat a vertex per triangle: join those at the same place.
        let place = |p: &V3| [p.x, p.y, p.z].map(|c| (c * 1e9).round() as i64);
        let units: Vec<Option<V3>> = areas.iter().map(|area| area.try_normalize(0.0)).collect();
        let direction = |n: &V3| [n.x, n.y, n.z].map(|c| (c * DIRECTIONS).round() as i32);
        // Areas at a vertex by direction: a fan of thousands of triangles round one is as soon summed as drawn.
        let mut around = BTreeMap::<[i64; 3], BTreeMap<[i32; 3], V3>>::new();
        for (index, t) in core.triangles.iter().enumerate() {
            let Some(own) = units[index] else { continue };
            for p in corners(t) {
                let areas_there = around.entry(place(&p)).or_default();
                *areas_there.entry(direction(&own)).or_insert_with(V3::zeros) += areas[index];
            }
        }
        let cos_crease = libm::cos(CREASE);
        for (index, t) in core.triangles.iter().enumerate() {
            let Some(own) = units[index] else { continue };
            let points = corners(t);
            let normals = points.map(|p| {
                let same = around[&place(&p)].values();
                let smooth = same.filter(|area| area.dot(&own) > cos_crease * area.norm());
                smooth.sum::<V3>().try_normalize(0.0).unwrap_or(own)
            });
            let first = self.points.len() as u32;
            self.points.extend(points);
            self.normals.extend(normals);
            self.triangles.push(Triangle {
                corners: [first, first + 1, first + 2],
                material,
            });
        }
    }

    fn add_wire(&mut self, picture: &Picture) {
        let wire = picture.wire;
        let rings = wire.points.len().max(1);
        let sides = (WIRE_TRIANGLES / (2 * rings)).clamp(FEWEST_SIDES, SIDES);
        let pieces = (WIRE_TRIANGLES / (2 * sides * rings)).clamp(1, 5);
        let line = smooth_line(&wire.points, pieces);
        let mesh = tube_mesh(&line, picture.radius, sides);
        let turns = turns_of_nodes(&wire.points);
        let materials: Vec<u32> = (0..wire.points.len())
            .map(|node| match picture.colouring {
                Colouring::Turn => Material::turn(turns[node]),
                Colouring::State if node + 1 < wire.frozen => Material::frozen(),
                Colouring::State => Material::live(),
            })
            .map(|material| self.material(material))
            .collect();
        let base = self.points.len() as u32;
        self.points.extend(&mesh.points);
        self.normals.extend(&mesh.normals);
        for polygon in mesh.polygons() {
            let polygon = polygon.as_ref();
            let ring = polygon.iter().copied().min().unwrap_or(0) as usize / sides;
            let node = (ring / pieces).min(materials.len() - 1);
            for k in 1..polygon.len() - 1 {
                self.triangles.push(Triangle {
                    corners: [polygon[0], polygon[k], polygon[k + 1]].map(|i| base + i),
                    material: materials[node],
                });
            }
        }
    }
}

/// The line through `points` with `pieces` straight pieces per edge, on cubic curves whose
/// directions at the points are those of the parabola through them and their neighbours.
fn smooth_line(points: &[V3], pieces: usize) -> Vec<V3> {
    let edge = |k: usize| points[k + 1] - points[k];
    let length = |k: usize| edge(k).norm().max(1e-12);
    let slope = |node: usize| match node {
        0 => edge(0) / length(0),
        _ if node + 1 == points.len() => edge(node - 1) / length(node - 1),
        _ => {
            let (before, after) = (length(node - 1), length(node));
            let (a, b) = (edge(node - 1) / before, edge(node) / after);
            (a * after + b * before) / (before + after)
        }
    };
    let mut line = Vec::with_capacity(points.len() * pieces);
    for k in 0..points.len().saturating_sub(1) {
        let (from, to, h) = (slope(k), slope(k + 1), length(k));
        for piece in 0..pieces {
            let t = piece as f64 / pieces as f64;
            let (t2, t3) = (t * t, t * t * t);
            line.push(
                points[k] * (2.0 * t3 - 3.0 * t2 + 1.0)
                    + from * (h * (t3 - 2.0 * t2 + t))
                    + points[k + 1] * (3.0 * t2 - 2.0 * t3)
                    + to * (h * (t3 - t2)),
            );
        }
    }
    line.extend(points.last());
    line
}

/// All that is needed to light a pixel.
struct View<'a> {
    scene: &'a Surface,
    camera: Camera,
    light: Light,
    seen: Raster,
    shadow: Raster,
    disc: Disc,
    /// distance within which surfaces darken each other, m
    reach: f64,
}

/// What is seen in a drawn pixel.
#[derive(Clone, Copy)]
struct Seen {
    /// column and row
    at: (usize, usize),
    material: u32,
    point: V3,
    /// towards the viewer's side
    normal: V3,
    ray: V3,
}

impl View<'_> {
    /// Colour of a pixel shown: where one even surface fills it, it is lit once.
    fn pixel(&self, x: u32, y: u32) -> V3 {
        let at = |sub: u32| {
            let (column, row) = (sub % SUPERSAMPLING, sub / SUPERSAMPLING);
            let drawn = (x * SUPERSAMPLING + column, y * SUPERSAMPLING + row);
            (drawn.0 as usize, drawn.1 as usize)
        };
        let seen: [Option<Seen>; DRAWN] = std::array::from_fn(|sub| self.seen_at(at(sub as u32)));
        if let [Some(first), .., Some(last)] = seen
            && seen.iter().flatten().all(|other| is_even(&first, other))
            && seen.iter().all(Option::is_some)
        {
            let discs = [first, last].map(|seen| self.disc.turned_for(seen.at.0, seen.at.1));
            return self.colour(&first, &discs);
        }
        let colour = |sub: usize| match &seen[sub] {
            Some(seen) => self.colour(seen, &[self.disc.turned_for(seen.at.0, seen.at.1)]),
            None => self.behind(at(sub as u32)),
        };
        (0..DRAWN).map(colour).sum::<V3>() / DRAWN as f64
    }

    /// The background in a drawn pixel.
    fn behind(&self, (column, row): (usize, usize)) -> V3 {
        let aside = (column as f64 + 0.5) / self.seen.width as f64 - 0.5;
        background((row as f64 + 0.5) / self.seen.height as f64, aside)
    }

    fn seen_at(&self, (column, row): (usize, usize)) -> Option<Seen> {
        let id = self.seen.triangle[row * self.seen.width + column];
        if id == NONE {
            return None;
        }
        let triangle = &self.scene.triangles[id as usize];
        let ray = self.camera.ray(column as f64 + 0.5, row as f64 + 0.5);
        let (point, normal) = hit(self.scene, triangle, self.camera.eye, ray);
        Some(Seen {
            at: (column, row),
            material: triangle.material,
            point,
            normal: if normal.dot(&ray) > 0.0 {
                -normal
            } else {
                normal
            },
            ray,
        })
    }

    /// Colour of a surface by samples over these discs.
    fn colour(&self, seen: &Seen, discs: &[Disc]) -> V3 {
        let mean = |share: &dyn Fn(&Disc) -> f64| {
            discs.iter().map(share).sum::<f64>() / discs.len() as f64
        };
        let lighting = Lighting {
            key: self.light.towards(),
            up: self.camera.up(),
            viewer: -seen.ray,
            lit: mean(&|disc| self.lit(seen.point, seen.normal, disc)),
            open: mean(&|disc| self.open(seen.point, seen.normal, seen.at, disc)),
        };
        shade(
            &self.scene.materials[seen.material as usize],
            seen.normal,
            &lighting,
        )
    }

    /// Share of the key light that reaches a point, over a small disc of the shadow map.
    fn lit(&self, point: V3, normal: V3, disc: &Disc) -> f64 {
        let texel = self.light.texel();
        // Off the surface by the slope across the disc, so that it does not shade itself.
        let p = self.light.project(point + normal * (3.0 * texel));
        let samples = disc.scaled(5.0).filter(|&(dx, dy)| {
            let (x, y) = (p[0] + dx, p[1] + dy);
            let size = self.light.texels as f64;
            if !(0.0..size).contains(&x) || !(0.0..size).contains(&y) {
                return true;
            }
            let texel_index = y as usize * self.light.texels + x as usize;
            f64::from(self.shadow.near[texel_index]) <= p[2] + 2.0 * texel
        });
        samples.count() as f64 / DISC as f64
    }

    /// Share of the surroundings not hidden by what is near, judged from the depths around the
    /// pixel (screen-space ambient occlusion).
    fn open(&self, point: V3, normal: V3, pixel: (usize, usize), disc: &Disc) -> f64 {
        let Some([_, _, near]) = self.camera.project(point) else {
            return 1.0;
        };
        let mut hidden = 0.0;
        for (dx, dy) in disc.scaled(self.reach * self.camera.scale(near)) {
            let (x, y) = (pixel.0 as f64 + 0.5 + dx, pixel.1 as f64 + 0.5 + dy);
            let inside = (0.0..self.seen.width as f64).contains(&x)
                && (0.0..self.seen.height as f64).contains(&y);
            if !inside {
                continue;
            }
            let other_near = self.seen.near[y as usize * self.seen.width + x as usize];
            if other_near <= 0.0 {
                continue;
            }
            let other = self.camera.unproject(x, y, f64::from(other_near)) - point;
            let distance = other.norm().max(1e-12);
            // Only what rises over the surface hides, and only nearby: crevices, not whole faces.
            let rise = (normal.dot(&other) / distance - 0.08).max(0.0);
            hidden += rise * (1.0 - distance / (2.0 * self.reach)).max(0.0);
        }
        (1.0 - 2.2 * hidden / DISC as f64).clamp(0.2, 1.0)
    }
}

/// Pixels drawn per pixel shown.
const DRAWN: usize = (SUPERSAMPLING * SUPERSAMPLING) as usize;

/// Cosine of the angle between normals up to which drawn pixels of one material show one even surface. Chosen: eight degrees, as a wire turns
/// from a drawn pixel to the next where it is 14 of them across.
const EVEN: f64 = 0.99;

fn is_even(a: &Seen, b: &Seen) -> bool {
    a.material == b.material && a.normal.dot(&b.normal) > EVEN
}

/// Samples of a disc; each pixel shown has [`SUPERSAMPLING`] squared differently turned discs.
const DISC: usize = 6;

/// Points spread evenly over the unit disc on a spiral.
struct Disc([(f64, f64); DISC]);

impl Disc {
    fn new() -> Self {
        let golden = 2.399_963_229_728_653;
        Self(std::array::from_fn(|k| {
            let (angle, r) = (golden * k as f64, ((k as f64 + 0.5) / DISC as f64).sqrt());
            (r * libm::cos(angle), r * libm::sin(angle))
        }))
    }

    /// The disc turned from pixel to pixel, so that the error is fine grain and not bands.
    fn turned_for(&self, column: usize, row: usize) -> Self {
        // Interleaved gradient noise (Jimenez 2014): evenly spread over neighbouring pixels.
        let seed = 0.067_110_56 * column as f64 + 0.005_837_15 * row as f64;
        let turn = std::f64::consts::TAU * (52.982_918_9 * seed.fract()).fract();
        let (c, s) = (libm::cos(turn), libm::sin(turn));
        Self(self.0.map(|(x, y)| (c * x - s * y, s * x + c * y)))
    }

    /// The points of a disc of this radius.
    fn scaled(&self, radius: f64) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.0.iter().map(move |&(x, y)| (radius * x, radius * y))
    }
}

/// Where a ray meets a triangle's plane, and the normal interpolated there.
fn hit(scene: &Surface, triangle: &Triangle, eye: V3, ray: V3) -> (V3, V3) {
    let [a, b, c] = scene.points_of(triangle);
    let (u, v) = (b - a, c - a);
    let plane = u.cross(&v);
    let across = plane.dot(&ray);
    let point = if across == 0.0 {
        a
    } else {
        eye + ray * (plane.dot(&(a - eye)) / across)
    };
    let area2 = plane.norm_squared();
    let wb = plane.dot(&(point - a).cross(&v)) / area2;
    let wc = plane.dot(&u.cross(&(point - a))) / area2;
    // Pixels at an edge may fall a hair outside.
    let (wb, wc) = (wb.clamp(0.0, 1.0), wc.clamp(0.0, 1.0));
    let [na, nb, nc] = scene.normals_of(triangle);
    let normal = na * (1.0 - wb - wc) + nb * wb + nc * wc;
    (
        point,
        normal
            .try_normalize(0.0)
            .unwrap_or_else(|| plane.normalize()),
    )
}
