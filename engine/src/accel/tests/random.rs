use glam::{DMat3, DVec3, Vec3};
use rayon::prelude::*;

use crate::{
    accel::{Domain, InstanceInput, MeshInput, TwoLevelBvh},
    components::{Disc, Mesh, MeshPart},
};

/// `SplitMix64`: tests need numbers that are alike everywhere.
pub(super) struct Random(pub u64);

impl Random {
    pub(super) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1).
    pub(super) fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * (-53_f64).exp2()
    }

    pub(super) fn below(&mut self, n: usize) -> usize {
        (self.unit() * n as f64) as usize
    }

    pub(super) fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Uniform in a cube around zero.
    pub(super) fn vector(&mut self, reach: f64) -> DVec3 {
        DVec3::new(
            self.within(-reach, reach),
            self.within(-reach, reach),
            self.within(-reach, reach),
        )
    }

    pub(super) fn direction(&mut self) -> DVec3 {
        loop {
            let v = self.vector(1.0);
            if v.length_squared() > 1e-4 && v.length_squared() <= 1.0 {
                return v / v.length();
            }
        }
    }

    pub(super) fn rotation(&mut self) -> DMat3 {
        DMat3::from_axis_angle(self.direction(), self.within(0.0, 6.3))
    }

    /// Turned, scaled unevenly, sometimes mirrored.
    pub(super) fn linear(&mut self) -> DMat3 {
        let mut scale = self.vector(1.0).map(f64::exp);
        if self.below(3) == 0 {
            scale.x = -scale.x;
        }
        self.rotation() * DMat3::from_diagonal(scale) * self.rotation()
    }
}

pub(super) fn mesh(vertices: Vec<Vec3>, triangles: Vec<[u32; 3]>, discs: Vec<Disc>) -> Mesh {
    let parts = vec![MeshPart {
        name: "all".into(),
        triangles: 0..triangles.len() as u32,
        discs: 0..discs.len() as u32,
    }];
    Mesh { vertices, triangles, discs, parts }
}

pub(super) fn quad(corners: [Vec3; 4]) -> Mesh {
    mesh(corners.into(), vec![[0, 1, 2], [0, 2, 3]], Vec::new())
}

/// A horizontal square of side `2 half` around the origin, facing up.
pub(super) fn square(half: f32) -> Mesh {
    quad(
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(x, y)| Vec3::new(x * half, y * half, 0.0)),
    )
}

pub(super) fn isolated(size: f64) -> Domain {
    Domain { min: glam::DVec2::ZERO, max: glam::DVec2::splat(size), is_periodic: false }
}

pub(super) fn periodic(size: f64) -> Domain {
    Domain { is_periodic: true, ..isolated(size) }
}

pub(super) fn at(mesh: u32, translation: DVec3) -> InstanceInput {
    InstanceInput { mesh, linear: DMat3::IDENTITY, translation }
}

/// A scene whose meshes have one part each, of the mesh's own number as surface.
pub(super) fn scene(meshes: &[Mesh], instances: &[InstanceInput], domain: Domain) -> TwoLevelBvh {
    let surfaces: Vec<u32> = (0..meshes.len() as u32).collect();
    let inputs: Vec<_> = meshes
        .iter()
        .zip(surfaces.chunks(1))
        .map(|(mesh, surfaces)| MeshInput { mesh, surfaces })
        .collect();
    TwoLevelBvh::build(&inputs, instances.par_iter().copied(), domain).unwrap()
}
