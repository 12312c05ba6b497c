use glam::{DMat3, DVec3, Vec3};

use super::random::{Random, at, isolated, mesh, quad, scene, square};
use crate::{
    accel::{InstanceInput, MeshInput, Ray, TwoLevelBvh},
    components::{Disc, Mesh, MeshPart},
};

fn down(origin: DVec3) -> Ray {
    Ray { origin, direction: -DVec3::Z, from: None }
}

#[test]
fn two_leaves_a_tenth_of_a_millimetre_apart_are_told_apart_anywhere() {
    let gap = 1e-4;
    for place in [DVec3::ZERO, DVec3::splat(1e3), DVec3::splat(1e5), DVec3::new(5e5, 5.5e6, 300.0)]
    {
        let leaf = square(0.05);
        let both = [at(0, place), at(0, place + DVec3::new(0.0, 0.0, gap))];
        let scene = scene(&[leaf], &both, isolated(1.0));
        let mut random = Random(11);
        for _ in 0..1_000 {
            let spot =
                place + DVec3::new(random.within(-0.03, 0.03), random.within(-0.03, 0.03), 0.0);
            let ray = down(spot + DVec3::new(0.0, 0.0, 30.0));
            let upper = scene.closest(&ray).unwrap();
            assert_eq!(upper.instance, 1);
            let lower = scene.closest(&upper.leave(-DVec3::Z)).unwrap();
            assert_eq!(lower.instance, 0);
            assert!((lower.distance - gap).abs() < 1e-8, "{}", lower.distance);
            assert!(scene.closest(&lower.leave(-DVec3::Z)).is_none());
            let back = scene.closest(&lower.leave(DVec3::Z)).unwrap();
            assert_eq!(back.instance, 1);
            // Between the leaves at a slant: the path from one to the other and out at the side.
            let slant = DVec3::new(1.0, 0.2, 1e-5);
            assert!(
                !scene.occluded(&lower.leave(slant / slant.length())),
                "leaves through the gap"
            );
        }
    }
}

#[test]
fn a_far_origin_loses_nothing() {
    let scene = scene(&[square(0.05)], &[at(0, DVec3::new(1.0, 2.0, 3.0))], isolated(1.0));
    let direction = DVec3::new(0.3, -0.2, -1.0).try_normalize().unwrap();
    for off in [0.0499, 0.0501] {
        let target = DVec3::new(1.0 + off, 2.0, 3.0);
        let ray = Ray { origin: target - 1e6 * direction, direction, from: None };
        assert_eq!(scene.closest(&ray).is_some(), off < 0.05);
        assert_eq!(scene.occluded(&ray), off < 0.05);
    }
}

#[test]
fn a_hit_names_its_surface_primitive_and_front() {
    let mut leaf = square(1.0);
    let up = |v: &Vec3| *v + Vec3::Z;
    leaf.vertices = leaf.vertices.iter().map(up).chain(leaf.vertices.clone()).collect();
    leaf.triangles.extend([[4, 6, 5], [4, 7, 6]]);
    leaf.discs.push(Disc { center: Vec3::new(0.0, 0.0, 2.0), normal: -Vec3::Z, radius: 0.5 });
    leaf.parts = vec![
        MeshPart { name: "top".into(), triangles: 0..2, discs: 0..0 },
        MeshPart { name: "bottom".into(), triangles: 2..4, discs: 0..1 },
    ];
    for mirror in [1.0, -1.0] {
        let one = InstanceInput {
            mesh: 0,
            linear: DMat3::from_diagonal(DVec3::new(mirror, 1.0, 1.0)),
            translation: DVec3::ZERO,
        };
        let input = [MeshInput { mesh: &leaf, surfaces: &[7, 9] }];
        let scene = TwoLevelBvh::build(&input, rayon::iter::once(one), isolated(1.0)).unwrap();
        let disc = scene.closest(&down(DVec3::new(0.1, 0.2, 9.0))).unwrap();
        assert_eq!((disc.surface, disc.primitive, disc.instance), (9, 4, 0));
        assert_eq!((disc.normal, disc.distance), (-DVec3::Z, 7.0));
        for (x, y, primitive) in [(0.9, -0.8, 0), (-0.8, 0.9, 1)] {
            let top = scene.closest(&down(DVec3::new(mirror * x, y, 9.0))).unwrap();
            assert_eq!((top.surface, top.primitive, top.normal), (7, primitive, DVec3::Z));
            let bottom = scene.closest(&top.leave(-DVec3::Z)).unwrap();
            // The lower square's corners run clockwise, and its two triangles are split alike.
            assert_eq!((bottom.surface, bottom.normal), (9, -DVec3::Z));
            assert_eq!(bottom.primitive, primitive + 2);
        }
    }
}

#[test]
fn a_quadrilateral_is_a_parallelogram_only_if_it_is_one() {
    let corners = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y];
    let blocks = |mesh: &Mesh| {
        let scene = scene(std::slice::from_ref(mesh), &[at(0, DVec3::ZERO)], isolated(1.0));
        let block = &scene.mesh_of(0).planar[0];
        block.edge.0.iter().filter(|&&edge| edge >= 0.0).count()
    };
    assert_eq!(blocks(&quad(corners)), 1);
    let mut bent = corners;
    bent[2].z = 1e-3;
    assert_eq!(blocks(&quad(bent)), 2);
    let mut kite = corners;
    kite[2].x = 1.1;
    assert_eq!(blocks(&quad(kite)), 2);
    let mut two_parts = quad(corners);
    let part = |triangles| MeshPart { name: "half".into(), triangles, discs: 0..0 };
    two_parts.parts = vec![part(0..1), part(1..2)];
    let input = [MeshInput { mesh: &two_parts, surfaces: &[0, 1] }];
    let scene =
        TwoLevelBvh::build(&input, rayon::iter::once(at(0, DVec3::ZERO)), isolated(1.0)).unwrap();
    let surface = |x, y| scene.closest(&down(DVec3::new(x, y, 1.0))).unwrap().surface;
    assert_eq!((surface(0.9, 0.1), surface(0.1, 0.9)), (0, 1), "two materials are two primitives");
}

/// From any point of any primitive, in any direction: the plane that is left is not met again, and
/// the origin lies on the right side of it, but not far.
#[test]
fn a_ray_leaves_its_surface_on_the_side_that_it_goes_to() {
    let mut random = Random(12);
    for _ in 0..3_000 {
        let size = random.within(-6.0, 3.0).exp();
        let [a, b, c] = [0; 3].map(|_| random.vector(size).as_vec3());
        let normal = random.direction().as_vec3();
        let disc = Disc { center: a, normal, radius: size as f32 };
        let shape = if random.below(2) == 0 {
            mesh(vec![a, b, c], vec![[0, 1, 2]], Vec::new())
        } else {
            mesh(Vec::new(), Vec::new(), vec![disc])
        };
        let far = 10_f64.powf(random.within(0.0, 6.0));
        let place = random.vector(far);
        let one = InstanceInput { mesh: 0, linear: random.linear(), translation: place };
        let scene = scene(&[shape], &[one], isolated(1.0));
        let middle = one.linear * ((a + b + c) / 3.0).as_dvec3() + place;
        let direction = random.direction();
        let ray =
            Ray { origin: middle - random.within(0.1, 1e3) * direction, direction, from: None };
        let Some(hit) = scene.closest(&ray) else { continue };
        assert!(hit.error < 1e-4 * size + 1e-12 * place.length() + 1e-11, "{hit:?}");
        for _ in 0..10 {
            let away = random.direction();
            let left = hit.leave(away);
            assert!(scene.closest(&left).is_none() && !scene.occluded(&left));
            // Even a ray that has forgotten where it comes from starts beyond the plane.
            let fresh = Ray { from: None, ..left };
            let steep = hit.normal.dot(away).abs() > 1e-6;
            assert!(!steep || scene.closest(&fresh).is_none(), "{hit:?} {away}");
        }
    }
}
