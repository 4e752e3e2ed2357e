//! Nanoseconds per node of the implicit method, free and in contact: its residual with gradient and
//! Hessian, the search for contact, and a whole step.
//!
//! `cargo bench --bench implicit_step` prints time per call and throughput in nodes per second; the
//! reciprocal of the throughput is the time per node. Factorisation alone is in `kernels`.
#![allow(missing_docs)]

use coilwind::contact::{ContactLaw, LineModel};
use coilwind::geometry::Shape;
use coilwind::integrate::{Implicit, Scheme};
use coilwind::math::V3;
use coilwind::rod::Rod;
use coilwind::rod::Twist;
use coilwind::scene::Scene;
use coilwind::settings::SceneSettings;
use coilwind::system::{Support, System};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use std::f64::consts::TAU;
use std::hint::black_box;

const NODES: [usize; 6] = [50, 100, 200, 400, 800, 1600];
const SPACING: f64 = 0.5e-3;
const CORE: f64 = 20e-3;
/// Step of the whole-step bench, s: that of winding at 300 rad/s.
const STEP: f64 = 20e-6;
/// Depth at which the lying wire stands, m: contact of a 15 N corner.
const DEPTH: f64 = 1e-6;

fn scene() -> Scene {
    SceneSettings::load("fig8")
        .expect("packed")
        .build()
        .expect("valid")
}

/// A rod through these points, at the set tension between pinned ends.
fn tight(scene: &Scene, x: &[V3]) -> System {
    let stretch = 1.0 + scene.tensioner.tension / scene.wire.ea;
    let rest = x.windows(2).map(|e| (e[1] - e[0]).norm() / stretch);
    let rod = Rod::through(x, Some(rest.collect()));
    let mut sys = System::new(scene.wire.clone(), rod);
    sys.state.support = [Support::pinned(x[0]), Support::pinned(x[x.len() - 1])];
    sys.model.twist = Twist::Off;
    sys
}

/// A gently waving wire in free space.
fn free(scene: &Scene, nodes: usize) -> System {
    let x: Vec<V3> = (0..nodes)
        .map(|i| {
            let s = SPACING * i as f64;
            V3::new(s, 1e-4 * (s * 300.0).sin(), 0.0)
        })
        .collect();
    let mut sys = tight(scene, &x);
    sys.refresh();
    sys
}

/// A helix on a cylinder, in touch with it and with `frozen` nodes of frozen wire beside it.
fn lying(scene: &Scene, nodes: usize, frozen: usize) -> System {
    let r = scene.wire.radius();
    let wind = |radius: f64, pitch: f64, y0: f64, i: usize| {
        let angle = SPACING * i as f64 / radius;
        let p = V3::new(
            radius * angle.cos(),
            y0 + pitch * angle / TAU,
            radius * angle.sin(),
        );
        (p, SPACING * i as f64)
    };
    let law = ContactLaw {
        stiffness: scene.contact.stiffness,
        damping_ratio: 0.0,
        mu_static: scene.friction.static_,
        mu_kinetic: scene.friction.kinetic,
        slip_speed: scene.friction.slip_speed,
    };
    let shape = Shape::Cylinder {
        radius: CORE,
        half_y: 1.0,
    };
    // turns two diameters apart, so that both wires lie on the core, side by side
    let (pitch, around) = (4.0 * r, CORE + r - DEPTH);
    let x: Vec<V3> = (0..nodes).map(|i| wind(around, pitch, 0.0, i).0).collect();
    let mut sys = tight(scene, &x);
    sys.touch_along(LineModel::new(shape, law, r));
    let mut line = sys.line_contact().expect("contact");
    for i in 0..frozen {
        let (p, arc) = wind(around, pitch, 2.0 * r - DEPTH, i);
        line.lay(p, arc);
    }
    sys.state.arc0 = 1e3;
    sys.refresh();
    sys
}

fn made(scene: &Scene, kind: &str, nodes: usize) -> System {
    match kind {
        "free" => free(scene, nodes),
        "core" => lying(scene, nodes, 0),
        _ => lying(scene, nodes, nodes),
    }
}

const KINDS: [&str; 3] = ["free", "core", "core_and_wire"];

fn group(
    c: &mut Criterion,
    name: &str,
    kinds: &[&str],
    mut run: impl FnMut(&mut criterion::Bencher, System),
) {
    let scene = scene();
    let mut group = c.benchmark_group(name);
    group.sample_size(20);
    group.warm_up_time(std::time::Duration::from_millis(300));
    group.measurement_time(std::time::Duration::from_secs(1));
    for kind in kinds {
        for nodes in NODES {
            group.throughput(Throughput::Elements(nodes as u64));
            group.bench_function(BenchmarkId::new(*kind, nodes), |b| {
                run(b, made(&scene, kind, nodes));
            });
        }
    }
    group.finish();
}

fn assembly(c: &mut Criterion) {
    group(c, "assembly", &KINDS, |b, mut sys| {
        let mut method = Implicit::new(Scheme::Bdf2, 2e-6, 1e-9, 0.1);
        method.evaluating(&mut sys, STEP, |evaluate| b.iter(|| black_box(evaluate())));
    });
}

/// Every point's push with its surroundings known, and with all of them to look up.
fn search(c: &mut Criterion) {
    for (name, cold) in [("push", false), ("look_up_and_push", true)] {
        group(c, name, &KINDS[1..], |b, mut sys| {
            let x = std::mem::take(&mut sys.state.rod.x);
            let mut line = sys.line_contact().expect("contact");
            b.iter(|| {
                if cold {
                    line.state.forget_surroundings();
                }
                line.begin();
                let mut sum = V3::zeros();
                for (j, e) in x.windows(2).enumerate() {
                    for (point, p) in [(2 * j, e[0]), (2 * j + 1, (e[0] + e[1]) * 0.5)] {
                        if let Some(push) = line.push(point, p, || 0.25e-3, || 1e3, STEP) {
                            sum += push.gradient;
                        }
                    }
                }
                black_box(sum)
            });
        });
    }
}

/// Gathering the passages near each node, and their feet.
fn tube(c: &mut Criterion) {
    group(c, "gather", &KINDS[2..], |b, sys| {
        let tube = &sys.line_scratch().expect("contact").tube;
        let mut starts = Vec::new();
        b.iter(|| {
            let mut count = 0;
            for x in &sys.state.rod.x {
                tube.gather(*x, 2.3 * tube.radius(), 1e3, &mut starts);
                count += starts.len();
            }
            black_box(count)
        });
    });
    group(c, "foot", &KINDS[2..], |b, sys| {
        let tube = &sys.line_scratch().expect("contact").tube;
        let mut starts = Vec::new();
        let known: Vec<(V3, u32)> = (sys.state.rod.x.iter())
            .filter_map(|x| {
                tube.gather(*x, 2.3 * tube.radius(), 1e3, &mut starts);
                starts.first().map(|s| (*x, *s))
            })
            .collect();
        b.iter(|| {
            let feet = known.iter().map(|(x, s)| tube.foot(*x, *s).distance);
            black_box(feet.sum::<f64>())
        });
    });
}

fn step(c: &mut Criterion) {
    group(c, "step", &KINDS, |b, mut sys| {
        // its own choice of step, up to the usual one; the start's transient is over after some
        let mut method = Implicit::new(Scheme::Bdf2, 2e-6, 1e-9, STEP);
        for _ in 0..30 {
            method.step(&mut sys, 1.0).expect("a step");
        }
        b.iter_batched_ref(
            || (sys.clone(), method.clone()),
            |(sys, method)| method.step(sys, 1.0).expect("a step"),
            criterion::BatchSize::LargeInput,
        );
    });
}

criterion_group!(benches, assembly, search, tube, step);
criterion_main!(benches);
