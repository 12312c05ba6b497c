use glam::{DMat3, DVec3, Vec3};

use super::{
    oracle::{check, on_all_levels},
    random::{Random, isolated, mesh, scene},
};
use crate::{
    accel::{InstanceInput, Ray},
    components::{Disc, Mesh},
};

/// Triangles, parallelograms and discs of one size in a cube, with duplicates, slivers, points,
/// coplanar overlaps and primitives a million times smaller.
fn soup(random: &mut Random, size: f64, count: usize) -> Mesh {
    let (mut vertices, mut triangles, mut discs) = (Vec::new(), Vec::new(), Vec::new());
    while triangles.len() + discs.len() < count {
        let scale = if random.below(10) == 0 { size * 1e-6 } else { size * 0.8 };
        let start = vertices.len() as u32;
        let a = random.vector(size).as_vec3();
        let (b, c) = (a + random.vector(scale).as_vec3(), a + random.vector(scale).as_vec3());
        match random.below(8) {
            0 | 1 => {
                vertices.extend([a, b, c]);
                triangles.push([start, start + 1, start + 2]);
            }
            2 => {
                // On a lattice, so that the fourth corner is exact.
                let step = (scale as f32).log2().floor().exp2() * (-12_f32).exp2();
                let on = |v: Vec3| (v / step).round() * step;
                let [a, ab, ac] = [on(a), on(b - a), on(c - a)];
                let [b, c] = [a + ab, a + ac];
                vertices.extend([a, b, b + ac, c]);
                triangles.extend([[start, start + 1, start + 2], [start, start + 2, start + 3]]);
            }
            3 => {
                let normal = random.direction().as_vec3();
                discs.push(Disc { center: a, normal, radius: (0.5 * scale) as f32 });
            }
            4 => {
                vertices.extend([a, a, b]);
                triangles.extend([[start, start + 1, start + 2], [start, start, start]]);
                discs.push(Disc { center: a, normal: Vec3::ZERO, radius: 1.0 });
                discs.push(Disc { center: a, normal: Vec3::Z, radius: 0.0 });
            }
            5 => {
                vertices.extend([a, b, a + (b - a) * 0.5, a + (b - a) * 2.0]);
                triangles.extend([[start, start + 1, start + 2], [start, start + 1, start + 3]]);
            }
            6 => {
                vertices.extend([a, b, c]);
                triangles.extend([[start, start + 1, start + 2]; 2]);
            }
            _ => {
                let level = |v: Vec3| Vec3::new(v.x, v.y, (size * 0.25) as f32);
                vertices.extend([level(a), level(b), level(c)]);
                triangles.push([start, start + 1, start + 2]);
            }
        }
    }
    mesh(vertices, triangles, discs)
}

fn any_ray(random: &mut Random, size: f64) -> Ray {
    let origin = random.vector(size * 2.0);
    let target = random.vector(size);
    let direction = match random.below(4) {
        0 => [DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z][random.below(6)],
        1 => random.direction(),
        _ => (target - origin).try_normalize().unwrap_or(DVec3::X),
    };
    Ray { origin, direction, from: None }
}

#[test]
fn random_soups_are_hit_as_by_brute_force() {
    let mut random = Random(1);
    let mut hits = 0;
    for (size, count) in
        [(1.0, 1), (1.0, 7), (1.0, 40), (20.0, 300), (1e-6, 40), (1e6, 40), (1e-3, 300)]
    {
        for _ in 0..4 {
            let meshes = [soup(&mut random, size, count)];
            let scenes = on_all_levels(|| {
                let one =
                    InstanceInput { mesh: 0, linear: DMat3::IDENTITY, translation: DVec3::ZERO };
                scene(&meshes, &[one], isolated(1.0))
            });
            for _ in 0..500 {
                let ray = any_ray(&mut random, size);
                hits += u32::from(check(&scenes, &meshes, 1, &ray, &[DVec3::ZERO]));
            }
        }
    }
    assert!(hits > 2_000, "only {hits} rays hit anything");
}

#[test]
fn turned_scaled_and_mirrored_instances_are_hit_as_by_brute_force() {
    let mut random = Random(2);
    let mut hits = 0;
    for _ in 0..12 {
        let meshes =
            [soup(&mut random, 1.0, 20), soup(&mut random, 0.1, 5), soup(&mut random, 3.0, 2)];
        let instances: Vec<_> = (0..60)
            .map(|_| InstanceInput {
                mesh: random.below(3) as u32,
                linear: random.linear(),
                translation: random.vector(2.0),
            })
            .collect();
        let scenes = on_all_levels(|| scene(&meshes, &instances, isolated(1.0)));
        for _ in 0..500 {
            let ray = any_ray(&mut random, 2.0);
            hits += u32::from(check(&scenes, &meshes, instances.len(), &ray, &[DVec3::ZERO]));
        }
    }
    assert!(hits > 2_000, "only {hits} rays hit anything");
}

/// Everything lies on whole numbers, so that rays run in faces of boxes, in planes of primitives,
/// along edges and through corners.
#[test]
fn rays_on_a_lattice_are_hit_as_by_brute_force() {
    let mut random = Random(3);
    let whole = |random: &mut Random| random.vector(4.0).round();
    let (mut vertices, mut triangles, mut discs) = (Vec::new(), Vec::new(), Vec::new());
    for index in 0..60 {
        let a = whole(&mut random);
        let axis = random.below(3);
        let (b, c) = (DVec3::AXES[(axis + 1) % 3], DVec3::AXES[(axis + 2) % 3]);
        vertices.extend([a, a + b, a + c].map(DVec3::as_vec3));
        triangles.push([3 * index, 3 * index + 1, 3 * index + 2]);
        if index % 5 == 0 {
            let center = whole(&mut random).as_vec3();
            discs.push(Disc { center, normal: Vec3::AXES[axis], radius: 1.0 });
        }
    }
    let meshes = [mesh(vertices, triangles, discs)];
    let scenes = on_all_levels(|| {
        let one = InstanceInput { mesh: 0, linear: DMat3::IDENTITY, translation: DVec3::ZERO };
        scene(&meshes, &[one], isolated(1.0))
    });
    for _ in 0..20_000 {
        let origin = 0.5 * whole(&mut random);
        let axis = DVec3::AXES[random.below(3)];
        let direction = match random.below(3) {
            0 => axis,
            1 => -axis,
            _ => match whole(&mut random).try_normalize() {
                Some(direction) => direction,
                None => continue,
            },
        };
        check(&scenes, &meshes, 1, &Ray { origin, direction, from: None }, &[DVec3::ZERO]);
    }
}
