use glam::{DMat3, DVec2, DVec3, Vec3};

use rayon::prelude::*;

use super::random::{Random, at, isolated, mesh, periodic, scene, square};
use crate::{
    accel::{BuildError, Domain, InstanceInput, MeshInput, Ray, TwoLevelBvh},
    components::{Disc, Mesh},
};

fn build(mesh: &Mesh) -> Result<TwoLevelBvh, BuildError> {
    let fine = square(1.0);
    let inputs = [MeshInput { mesh: &fine, surfaces: &[0] }, MeshInput { mesh, surfaces: &[0] }];
    TwoLevelBvh::build(&inputs, rayon::iter::once(at(1, DVec3::ZERO)), isolated(1.0))
}

#[test]
fn what_is_not_a_scene_is_named() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30] {
        let mut mesh = square(1.0);
        mesh.vertices[2].y = bad;
        let error = build(&mesh).unwrap_err();
        assert!(matches!(error, BuildError::Vertex { mesh: 1, vertex: 2, .. }), "{error}");
        assert!(error.to_string().starts_with("mesh 1: vertex 2 is (1, "), "{error}");
        let disc = Disc { center: Vec3::ZERO, normal: Vec3::Z, radius: bad };
        let error = build(&super::random::mesh(vec![], vec![], vec![disc])).unwrap_err();
        assert!(matches!(error, BuildError::Disc { mesh: 1, disc: 0, .. }), "{error}");
    }
    let mut corner = square(1.0);
    corner.triangles[1][0] = 4;
    let named = BuildError::Corner { mesh: 1, triangle: 1, vertex: 4, count: 4 };
    assert_eq!(build(&corner).unwrap_err(), named);
    let mut parts = square(1.0);
    parts.parts[0].triangles = 0..1;
    assert_eq!(build(&parts).unwrap_err(), BuildError::Parts { mesh: 1, triangles: 2, discs: 0 });
    parts.parts.clear();
    assert!(matches!(build(&parts), Err(BuildError::Surfaces { mesh: 1, parts: 0, surfaces: 1 })));

    let mesh = square(1.0);
    let inputs = [MeshInput { mesh: &mesh, surfaces: &[0] }];
    let place = |instance, domain| {
        TwoLevelBvh::build(&inputs, [at(0, DVec3::ZERO), instance].into_par_iter(), domain)
    };
    let fine = isolated(1.0);
    let named = BuildError::Mesh { instance: 1, mesh: 3, count: 1 };
    assert_eq!(place(at(3, DVec3::ZERO), fine).unwrap_err(), named);
    let flat = DMat3::from_diagonal(DVec3::new(1.0, 1.0, 0.0));
    for linear in [flat, DMat3::IDENTITY * f64::NAN, DMat3::IDENTITY * 1e-60] {
        let instance = InstanceInput { mesh: 0, linear, translation: DVec3::ZERO };
        let error = place(instance, fine).unwrap_err();
        assert_eq!(error, BuildError::Transform { instance: 1 });
    }
    let lost = at(0, DVec3::new(0.0, f64::NAN, 0.0));
    assert_eq!(place(lost, fine).unwrap_err(), BuildError::Transform { instance: 1 });
    for max in [DVec2::ZERO, DVec2::new(1.0, f64::NAN), DVec2::new(1.0, f64::INFINITY)] {
        let domain = Domain { max, ..fine };
        assert!(matches!(place(at(0, DVec3::ZERO), domain), Err(BuildError::Domain { .. })));
    }
}

#[test]
fn nothing_is_never_hit() {
    let empty = Mesh::default();
    let flat = mesh(vec![Vec3::ONE; 3], vec![[0, 1, 2]], vec![]);
    let none: &[u32] = &[];
    let inputs =
        [MeshInput { mesh: &empty, surfaces: none }, MeshInput { mesh: &flat, surfaces: &[0] }];
    for domain in [isolated(1.0), periodic(1.0)] {
        for instances in [vec![], vec![at(0, DVec3::ZERO), at(1, DVec3::ZERO)]] {
            let scene = TwoLevelBvh::build(&inputs, instances.into_par_iter(), domain).unwrap();
            let ray = Ray { origin: DVec3::Z, direction: -DVec3::Z, from: None };
            assert!(scene.closest(&ray).is_none() && !scene.occluded(&ray));
            assert_eq!((scene.bottom(), scene.top()), (0.0, 0.0));
        }
    }
}

#[test]
fn thousands_of_equal_primitives_neither_panic_nor_hide() {
    let count = 20_000;
    let leaf = square(1.0);
    let corners = leaf.corners(0);
    let same = mesh(corners.into(), vec![[0, 1, 2]; count], vec![]);
    // Each half as large as the one before: the deepest tree there is.
    let nested: Vec<Vec3> =
        (0..120).flat_map(|i| corners.map(|v| v * (-i as f32).exp2())).collect();
    let nested = mesh(nested, (0..120).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(), vec![]);
    let many = vec![at(0, DVec3::ZERO); 200];
    let ray = Ray { origin: DVec3::new(0.5, -0.5, 1.0), direction: -DVec3::Z, from: None };
    let scene = scene(&[same, nested], &many, isolated(1.0));
    let hit = scene.closest(&ray).unwrap();
    assert_eq!((hit.instance, hit.primitive), (0, 0), "the lowest of equals");
    let deep = [mesh(corners.into(), vec![[0, 1, 2]], vec![])];
    let lined: Vec<_> =
        (0..2_000).map(|i| at(0, DVec3::new(0.0, 0.0, -f64::from(i).exp2().recip()))).collect();
    let scene = self::scene(&deep, &lined, isolated(1.0));
    assert!(scene.occluded(&ray));
}

#[test]
fn bounds_hold_all_geometry_and_are_exact_in_height() {
    let tower = mesh(
        vec![Vec3::new(0.0, 0.0, -0.25), Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 0.5, 7.3)],
        vec![[0, 1, 2]],
        vec![Disc { center: Vec3::ZERO, normal: Vec3::Z, radius: 2.0 }],
    );
    let turned = InstanceInput {
        mesh: 0,
        linear: DMat3::from_rotation_z(0.7),
        translation: DVec3::new(10.0, 20.0, 100.0),
    };
    let scene = scene(&[tower], &[turned], isolated(1.0));
    assert!((scene.top() - (100.0 + f64::from(7.3_f32))).abs() < 1e-13 * 100.0, "{}", scene.top());
    assert!((scene.bottom() - 99.75).abs() < 1e-13 * 100.0);
    let (min, max) = scene.bounds();
    assert!((min.truncate() - DVec2::new(8.0, 18.0)).length() < 1.2, "{min}");
    assert!((max.truncate() - DVec2::new(12.0, 22.0)).length() < 1.2, "{max}");
}

/// Small triangles along a diagonal that is turned to the x axis: the box of the instance is as narrow as the boxes of
/// 512 parts of the mesh.
#[test]
fn turned_instances_have_narrow_boxes() {
    let count = 8_000;
    let vertices = (0..count).flat_map(|i| {
        let a = Vec3::splat(i as f32 / count as f32) * Vec3::new(1.0, 1.0, 0.0);
        [a, a + 1e-4 * Vec3::X, a + 1e-4 * Vec3::Y]
    });
    let triangles = (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let diagonal = mesh(vertices.collect(), triangles, vec![]);
    let linear = DMat3::from_rotation_z(-std::f64::consts::FRAC_PI_4);
    let turned = InstanceInput { mesh: 0, linear, translation: DVec3::ZERO };
    let (min, max) = scene(&[diagonal], &[turned], isolated(1.0)).bounds();
    assert!((max.x - min.x - 2_f64.sqrt()).abs() < 0.01, "{min} {max}");
    assert!(max.y - min.y > 1e-4 && max.y - min.y < 0.01, "{min} {max}");
}

#[test]
fn threads_do_not_change_a_bit() {
    let mut random = Random(31);
    let vertices: Vec<_> = (0..30_000)
        .flat_map(|_| {
            let a = random.vector(10.0);
            [a, a + random.vector(0.4), a + random.vector(0.4)].map(DVec3::as_vec3)
        })
        .collect();
    let cloud =
        mesh(vertices, (0..30_000).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(), vec![]);
    let instances: Vec<_> = (0..20)
        .map(|_| InstanceInput {
            mesh: 0,
            linear: random.linear(),
            translation: random.vector(20.0),
        })
        .collect();
    let scenes = [1, 3].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| scene(std::slice::from_ref(&cloud), &instances, periodic(9.0)))
    });
    let trees = scenes.each_ref().map(|scene| {
        let mesh = &scene.meshes[0];
        format!("{:?} {:?} {:?}", scene.instances, mesh.tree, mesh.planar)
    });
    assert!(trees[0] == trees[1], "the same nodes and blocks");
    for _ in 0..3_000 {
        let ray = Ray { origin: random.vector(20.0), direction: random.direction(), from: None };
        let hits = scenes.each_ref().map(|scene| scene.closest(&ray));
        let bits = hits.map(|hit| hit.map(|h| (h.distance.to_bits(), h.instance, h.primitive)));
        assert_eq!(bits[0], bits[1]);
    }
}
