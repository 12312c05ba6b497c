//! Kernels of the engine on a generated tree: `stage/function/parameter`, in rays or primitives a
//! second. `cargo bench -p sunfleck --bench kernels`.
#![allow(missing_docs, reason = "criterion's macros make public functions")]

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use glam::{DMat3, DVec2, DVec3};
use rayon::prelude::*;
use sunfleck::accel::{Domain, InstanceInput, MeshInput, Ray, TwoLevelBvh};
use sunfleck::assets::grow_crown;
use sunfleck::components::Mesh;
use sunfleck::document::{CrownShape, GeneratedCrown, LeafShape};
use sunfleck::sampling::{Key, sobol4};

/// An ellipsoid of leaves, 4 m wide and 6 m high.
fn crown(leaves: f64, leaf: LeafShape, leaf_area: f64) -> Mesh {
    let shape = CrownShape::Ellipsoid { diameter_m: 4.0, height_m: 6.0 };
    grow_crown(&GeneratedCrown::new(shape, 1.0, leaves * leaf_area, leaf, "leaf".into()))
        .expect("a lawful crown")
}

fn scene(mesh: &Mesh) -> TwoLevelBvh {
    let instances: Vec<_> = (0..25)
        .map(|i| InstanceInput {
            mesh: 0,
            linear: DMat3::from_rotation_z(f64::from(i)),
            translation: DVec3::new(
                f64::from(i % 5) * 4.0 + 2.0,
                f64::from(i / 5) * 4.0 + 2.0,
                0.0,
            ),
        })
        .collect();
    let domain = Domain { min: DVec2::ZERO, max: DVec2::splat(20.0), is_periodic: true };
    let surfaces = vec![0; mesh.parts.len()];
    TwoLevelBvh::build(
        &[MeshInput { mesh, surfaces: &surfaces }],
        instances.into_par_iter(),
        domain,
    )
    .expect("a lawful scene")
}

/// Rays from random points of the canopy in random directions.
fn rays(count: u64) -> Vec<Ray> {
    let key = Key::new(1);
    (0..count)
        .map(|i| {
            let u: [f64; 5] = std::array::from_fn(|d| key.uniform(i * 5 + d as u64));
            let z = 2.0 * u[3] - 1.0;
            let (sin, cos) = (u[4] * std::f64::consts::TAU).sin_cos();
            let r = (1.0 - z * z).sqrt();
            Ray {
                origin: DVec3::new(u[0] * 20.0, u[1] * 20.0, 1.0 + u[2] * 6.0),
                direction: DVec3::new(r * cos, r * sin, z),
                from: None,
            }
        })
        .collect()
}

fn traversal(c: &mut Criterion) {
    let rays = rays(4096);
    let shapes = [
        ("discs", crown(20_000.0, LeafShape::Disc { radius_m: 0.03 }, 0.0028)),
        ("parallelograms", crown(20_000.0, LeafShape::Square { side_m: 0.05 }, 0.0025)),
    ];
    let mut group = c.benchmark_group("accel");
    group.throughput(Throughput::Elements(rays.len() as u64));
    for (name, mesh) in &shapes {
        let scene = scene(mesh);
        group.bench_with_input(BenchmarkId::new("closest", name), &scene, |b, scene| {
            b.iter(|| rays.iter().filter(|ray| scene.closest(black_box(ray)).is_some()).count());
        });
        group.bench_with_input(BenchmarkId::new("occluded", name), &scene, |b, scene| {
            b.iter(|| rays.iter().filter(|ray| scene.occluded(black_box(ray))).count());
        });
    }
    group.finish();
}

fn build(c: &mut Criterion) {
    let mut group = c.benchmark_group("accel");
    group.sample_size(10);
    for leaves in [1_000_u32, 25_000] {
        let mesh = crown(leaves.into(), LeafShape::Square { side_m: 0.05 }, 0.0025);
        group.throughput(Throughput::Elements(mesh.triangles.len() as u64));
        group.bench_with_input(BenchmarkId::new("build", leaves), &mesh, |b, mesh| {
            b.iter(|| scene(black_box(mesh)));
        });
    }
    group.finish();
}

fn points(c: &mut Criterion) {
    let mut group = c.benchmark_group("sampling");
    group.throughput(Throughput::Elements(1024));
    group.bench_function("sobol4", |b| {
        b.iter(|| (0..1024).map(|i| sobol4(black_box(i), 7)[3]).sum::<f64>());
    });
    group.finish();
}

criterion_group!(benches, traversal, build, points);
criterion_main!(benches);
