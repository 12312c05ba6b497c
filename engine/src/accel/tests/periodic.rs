use glam::{DVec2, DVec3, Vec3};

use super::{
    oracle::{check, on_all_levels},
    random::{Random, at, mesh, periodic, quad, scene, square},
};
use crate::{
    accel::{Domain, InstanceInput, Ray, TwoLevelBvh},
    components::{Disc, Mesh},
};

const SIZE: DVec2 = DVec2::new(4.0, 3.0);

fn tile() -> Domain {
    let min = DVec2::new(-1.0, 2.0);
    Domain { min, max: min + SIZE, is_periodic: true }
}

fn crown(random: &mut Random) -> Mesh {
    let (mut vertices, mut triangles, mut discs) = (Vec::new(), Vec::new(), Vec::new());
    for index in 0..12 {
        let a = random.vector(0.8);
        vertices.extend([a, a + random.vector(0.6), a + random.vector(0.6)].map(DVec3::as_vec3));
        triangles.push([3 * index, 3 * index + 1, 3 * index + 2]);
        let center = random.vector(0.8).as_vec3();
        discs.push(Disc { center, normal: random.direction().as_vec3(), radius: 0.1 });
    }
    mesh(vertices, triangles, discs)
}

fn ground() -> Mesh {
    let Domain { min, max, .. } = tile();
    let corners = [(min.x, min.y), (max.x, min.y), (max.x, max.y), (min.x, max.y)];
    quad(corners.map(|(x, y)| Vec3::new(x as f32, y as f32, -1.0)))
}

fn shifts(reach: i32) -> Vec<DVec3> {
    let mut shifts = Vec::new();
    for i in -reach..=reach {
        for j in -reach..=reach {
            shifts.push((DVec2::new(f64::from(i), f64::from(j)) * SIZE).extend(0.0));
        }
    }
    shifts
}

fn crowns(random: &mut Random) -> Vec<InstanceInput> {
    (0..6)
        .map(|_| InstanceInput {
            mesh: 0,
            linear: random.linear(),
            translation: DVec3::new(random.within(-1.0, 3.0), random.within(2.0, 5.0), 0.0),
        })
        .collect()
}

#[test]
fn a_periodic_scene_is_hit_as_its_copies_side_by_side() {
    let mut random = Random(21);
    let mut hits = [0; 2];
    for with_ground in [true, false] {
        for _ in 0..4 {
            let meshes = [crown(&mut random), ground()];
            let mut instances = crowns(&mut random);
            instances.extend(with_ground.then(|| at(1, DVec3::ZERO)));
            let scenes = on_all_levels(|| scene(&meshes, &instances, tile()));
            let copies = shifts(9);
            for _ in 0..100 {
                // Steep enough to end within the copies that the oracle has.
                let mut direction = random.direction();
                direction.z = direction.z.signum() * (0.2 + direction.z.abs());
                direction /= direction.length();
                let origin = random.vector(4.0) + DVec3::new(1.0, 3.5, 0.0);
                let ray = Ray { origin, direction, from: None };
                let hit = check(&scenes, &meshes, instances.len(), &ray, &copies);
                hits[usize::from(with_ground)] += u32::from(hit);
            }
        }
    }
    assert!(hits[0] > 50 && hits[1] > 150, "{hits:?}");
}

#[test]
fn a_crown_moved_by_whole_periods_is_the_same_crown() {
    let mut random = Random(22);
    let meshes = [crown(&mut random), ground()];
    let mut near = crowns(&mut random);
    near.push(at(1, DVec3::ZERO));
    let mut far = near.clone();
    far[0].translation += (DVec2::new(3.0, -2.0) * SIZE).extend(0.0);
    far[1].translation += (DVec2::new(-1.0, 0.0) * SIZE).extend(0.0);
    let (near, far) = (scene(&meshes, &near, tile()), scene(&meshes, &far, tile()));
    let mut hits = 0;
    for _ in 0..5_000 {
        let ray = Ray { origin: random.vector(6.0), direction: random.direction(), from: None };
        let (a, b) = (near.closest(&ray), far.closest(&ray));
        assert_eq!(a.is_some(), b.is_some(), "{ray:?}");
        if let (Some(a), Some(b)) = (a, b) {
            hits += 1;
            assert!((a.distance - b.distance).abs() <= 1e-12 * (1.0 + a.distance), "{ray:?}");
            assert_eq!((a.instance, a.primitive), (b.instance, b.primitive));
            assert!((a.point - b.point).length() < 1e-11, "{} {}", a.point, b.point);
        }
    }
    assert!(hits > 2_000);
}

/// One leaf in a small tile: leaving it, a ray meets the copies at one period, never itself.
#[test]
fn a_ray_skips_the_leaf_it_leaves_but_not_its_copies() {
    let domain = periodic(1.0);
    // A vertical leaf across the plane x = 0.98, so that rays along x meet it once a period, and
    // one that is cut by the border.
    for x in [0.5, 0.0, 0.999_999, 7.25] {
        let leaf = quad(
            [(-0.1, -0.1), (0.1, -0.1), (0.1, 0.1), (-0.1, 0.1)]
                .map(|(y, z)| Vec3::new(0.05 * y, y, z)),
        );
        let one = at(0, DVec3::new(x, 0.03, 0.0));
        let scene = scene(&[leaf], &[one], domain);
        let mut ray = Ray { origin: DVec3::new(0.25, 0.05, 0.01), direction: DVec3::X, from: None };
        let mut hit = scene.closest(&ray).unwrap();
        for turn in 0..50 {
            assert!(hit.point.x >= 0.0 && hit.point.x <= 1.0 && hit.point.y <= 1.0, "{hit:?}");
            let direction = if turn % 7 == 3 { -ray.direction } else { ray.direction };
            ray = hit.leave(direction);
            assert!(scene.occluded_within(&ray, 1.1) && !scene.occluded_within(&ray, 0.9));
            hit = scene.closest(&ray).unwrap();
            assert!((hit.distance - 1.0).abs() < 1e-12, "x {x}, turn {turn}: {hit:?}");
        }
    }
}

#[test]
fn nothing_leaks_through_the_ground_at_the_seam() {
    let Domain { min, max, .. } = tile();
    let scene = scene(&[ground(), square(0.2)], &[at(0, DVec3::ZERO), at(1, DVec3::Z)], tile());
    let mut random = Random(23);
    for _ in 0..20_000 {
        let x = [min.x, max.x, random.within(min.x, max.x)][random.below(3)];
        let y = [min.y, max.y, random.within(min.y, max.y)][random.below(3)];
        let target = DVec3::new(x, y, -1.0);
        let mut direction = random.direction();
        direction.z = -direction.z.abs();
        if random.below(4) == 0 {
            direction = -DVec3::Z;
        }
        for origin in [target - direction, target - 37.5 * direction] {
            let ray = Ray { origin, direction, from: None };
            assert!(scene.closest(&ray).is_some() && scene.occluded(&ray), "{ray:?}");
        }
    }
}

#[test]
fn a_horizontal_ray_ends() {
    let scene = scene(&[square(0.2)], &[at(0, DVec3::new(1.0, 3.0, 0.0))], tile());
    let above: TwoLevelBvh =
        self::scene(&[square(0.2)], &[at(0, DVec3::ZERO), at(0, DVec3::Z)], tile());
    let level = |z: f64| Ray { origin: DVec3::new(0.0, 3.0, z), direction: DVec3::X, from: None };
    assert!(scene.closest(&level(0.0)).is_none(), "in the plane of a leaf");
    assert!(scene.closest(&level(0.1)).is_none());
    assert!(above.closest(&level(0.5)).is_none());
}
