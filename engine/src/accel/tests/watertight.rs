use std::collections::HashMap;

use glam::{DMat3, DVec3, Vec3};
use rayon::prelude::*;

use super::random::{Random, at, isolated, mesh, scene};
use crate::{
    accel::{InstanceInput, Ray, TwoLevelBvh},
    components::Mesh,
};

/// A sphere of 20 · 4ⁿ triangles.
fn icosphere(times: u32, radius: f32) -> Mesh {
    let t = 0.5 * (1.0 + 5_f32.sqrt());
    let mut vertices: Vec<Vec3> = [(-1.0, t), (1.0, t), (-1.0, -t), (1.0, -t)]
        .iter()
        .flat_map(|&(a, b)| [Vec3::new(a, b, 0.0), Vec3::new(0.0, a, b), Vec3::new(b, 0.0, a)])
        .collect();
    let edge = 2.0_f32;
    let mut triangles = Vec::new();
    for a in 0..12_u32 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                let [p, q, r] = [a, b, c].map(|i| vertices[i as usize]);
                let near = |p: Vec3, q: Vec3| (p.distance(q) - edge).abs() < 1e-3;
                if near(p, q) && near(q, r) && near(r, p) {
                    let out = (q - p).cross(r - p).dot(p) > 0.0;
                    triangles.push(if out { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    assert_eq!(triangles.len(), 20);
    for _ in 0..times {
        let mut halves = HashMap::new();
        let mut half = |a: u32, b: u32, vertices: &mut Vec<Vec3>| {
            *halves.entry((a.min(b), a.max(b))).or_insert_with(|| {
                vertices.push(0.5 * (vertices[a as usize] + vertices[b as usize]));
                vertices.len() as u32 - 1
            })
        };
        triangles = triangles
            .iter()
            .flat_map(|&[a, b, c]| {
                let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(p, q)| half(p, q, &mut vertices));
                [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
            })
            .collect();
    }
    for v in &mut vertices {
        *v *= radius / v.length();
    }
    mesh(vertices, triangles, Vec::new())
}

fn leaks(scene: &TwoLevelBvh, rays: u64, center: DVec3, radius: f64) -> usize {
    (0..rays / 1000)
        .into_par_iter()
        .map(|chunk| {
            let mut random = Random(chunk + 7);
            (0..1000)
                .filter(|_| {
                    let origin = center + random.vector(0.5 * radius);
                    let ray = Ray { origin, direction: random.direction(), from: None };
                    scene.closest(&ray).is_none() || !scene.occluded(&ray)
                })
                .count()
        })
        .sum()
}

#[test]
fn no_ray_leaves_a_closed_sphere() {
    for (times, radius, place) in [(3, 1.0, DVec3::ZERO), (1, 10.0, DVec3::new(5e5, 5.5e6, 100.0))]
    {
        let sphere = icosphere(times, radius);
        let turned = InstanceInput {
            mesh: 0,
            linear: DMat3::from_rotation_z(0.3) * DMat3::from_diagonal(DVec3::new(1.0, 2.0, 0.7)),
            translation: place,
        };
        let scene = scene(&[sphere], &[turned], isolated(1.0));
        assert_eq!(leaks(&scene, 500_000, place, 0.7 * f64::from(radius)), 0);
    }
}

/// Run by hand, in release: 10⁸ rays.
#[test]
fn no_ray_of_a_hundred_million_leaves_a_closed_sphere() {
    let scene = scene(&[icosphere(4, 1.0)], &[at(0, DVec3::ZERO)], isolated(1.0));
    assert_eq!(leaks(&scene, 100_000_000, DVec3::ZERO, 0.9), 0);
}

#[test]
fn no_ray_leaves_through_a_corner_or_an_edge() {
    let sphere = icosphere(3, 1.0);
    let corners: Vec<_> = sphere.vertices.iter().map(|v| v.as_dvec3()).collect();
    let halves: Vec<_> = sphere
        .triangles
        .iter()
        .map(|t| 0.5 * (corners[t[0] as usize] + corners[t[1] as usize]))
        .collect();
    let scene = scene(&[sphere], &[at(0, DVec3::ZERO)], isolated(1.0));
    let mut random = Random(5);
    for _ in 0..20 {
        let inside = random.vector(0.5);
        for origin in [DVec3::ZERO, inside, inside.round()] {
            for target in corners.iter().chain(&halves) {
                let Some(direction) = (target - origin).try_normalize() else { continue };
                let ray = Ray { origin, direction, from: None };
                assert!(scene.closest(&ray).is_some(), "{ray:?}");
                assert!(scene.occluded(&ray), "{ray:?}");
            }
        }
    }
}

/// A closed box of squares, each one parallelogram, with rays along its edges' planes.
#[test]
fn no_ray_leaves_a_box_of_parallelograms() {
    let vertices: Vec<_> = (0..8_u8)
        .map(|i| Vec3::new(f32::from(i & 1), f32::from(i >> 1 & 1), f32::from(i >> 2)) * 0.1)
        .collect();
    let faces =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let cube = mesh(vertices.clone(), triangles, Vec::new());
    let mut random = Random(6);
    let linear = random.linear();
    let one = InstanceInput { mesh: 0, linear, translation: DVec3::new(3.0, 5.0, 7.0) };
    let scene = scene(&[cube], &[one], isolated(1.0));
    for _ in 0..20_000 {
        let object = DVec3::splat(0.05) + random.vector(0.045);
        let origin = linear * object + one.translation;
        let corner = linear * vertices[random.below(8)].as_dvec3() + one.translation;
        let direction = (corner - origin).try_normalize().unwrap();
        let ray = Ray { origin, direction, from: None };
        assert!(scene.closest(&ray).is_some() && scene.occluded(&ray), "{ray:?}");
    }
}
