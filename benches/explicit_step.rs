//! Nanoseconds per point and step of the explicit method, free and in contact.
//!
//! `cargo bench` prints time per step and throughput in points per second; the reciprocal of the
//! throughput is the time per point and step.
#![allow(missing_docs)]

use coilwind::contact::{ContactLaw, NodalModel, damping_for_restitution};
use coilwind::geometry::Surface;
use coilwind::geometry::generate::cylinder;
use coilwind::integrate::{Explicit, ExplicitMethod, highest_frequency};
use coilwind::math::V3;
use coilwind::rod::Rod;
use coilwind::scene::Scene;
use coilwind::settings::SceneSettings;
use coilwind::system::System;
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use std::sync::Arc;

const SPACING: f64 = 0.5e-3;

fn scene() -> Scene {
    SceneSettings::load("fig8")
        .expect("packed")
        .build()
        .expect("valid")
}

/// A gently waving wire in free space.
fn free(points: usize) -> System {
    let x: Vec<V3> = (0..points)
        .map(|i| {
            let s = SPACING * i as f64;
            V3::new(s, 1e-4 * (s * 300.0).sin(), 0.0)
        })
        .collect();
    System::new(scene().wire, Rod::through(&x, None))
}

/// A wire lying along a cylinder, every point in contact with it.
fn lying(points: usize) -> System {
    let scene = scene();
    let radius = 20e-3;
    let surface = Arc::new(Surface::new(
        cylinder(radius, SPACING * points as f64 + 0.1, 400).expect("a mesh"),
    ));
    // along the axis, pressed in by the depth of a 15 N corner
    let x: Vec<V3> = (0..points)
        .map(|i| {
            V3::new(
                radius + scene.wire.radius() - 1e-6,
                SPACING * (i as f64 - 0.5 * points as f64),
                0.0,
            )
        })
        .collect();
    let mut sys = System::new(scene.wire.clone(), Rod::through(&x, None));
    let law = ContactLaw {
        stiffness: scene.contact.stiffness,
        damping_ratio: damping_for_restitution(scene.contact.restitution),
        mu_static: scene.friction.static_,
        mu_kinetic: scene.friction.kinetic,
        slip_speed: scene.friction.slip_speed,
    };
    sys.touch_at_nodes(NodalModel {
        surface,
        law,
        radius: scene.wire.radius(),
        diameter: scene.wire.diameter,
    });
    // a body force that balances the contact keeps it there
    let load = scene.contact.stiffness * 1e-6 / scene.wire.mass_per_length();
    sys.model.loads.gravity = V3::new(-load, 0.0, 0.0);
    sys
}

fn steps(c: &mut Criterion) {
    let wire = scene().wire;
    let frequency = highest_frequency(&wire, SPACING, scene().contact.stiffness, true);
    let kinds: [(&str, ExplicitMethod); 2] = [
        ("verlet", ExplicitMethod::Verlet),
        ("rk4", ExplicitMethod::Rk4),
    ];
    for (place, make) in [("free", free as fn(usize) -> System), ("contact", lying)] {
        for (name, method) in kinds {
            let mut group = c.benchmark_group(format!("{name}/{place}"));
            for points in [50, 200, 800] {
                group.throughput(Throughput::Elements(points as u64));
                group.bench_with_input(
                    BenchmarkId::from_parameter(points),
                    &points,
                    |b, &points| {
                        let mut sys = make(points);
                        let dt = 0.5 * method.limit() / frequency;
                        sys.evaluate(Some(dt));
                        let mut explicit = Explicit::new(method);
                        b.iter(|| explicit.step(black_box(&mut sys), dt));
                        assert!(
                            sys.state.rod.x.iter().all(|p| p.sum().is_finite()),
                            "the bench must stay stable"
                        );
                    },
                );
            }
            group.finish();
        }
    }
}

criterion_group!(benches, steps);
criterion_main!(benches);
