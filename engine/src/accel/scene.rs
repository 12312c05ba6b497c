use glam::{DMat3, DVec2, DVec3};
use rayon::prelude::*;

use crate::geometry::Bounds;

use super::{
    Batch, BuildError, Departure, Domain, Hit, InstanceInput, Memory, MeshInput, Ray,
    instance::{self, Images, Record},
    mesh::{self, MeshTree, PARALLELOGRAM, outward},
    simd::Level,
    tile::{self, Tiles},
    trace::{Found, Query},
    tree::{self, Box3, Plan, Ref, Tree},
    types::Boundary,
};

/// Meshes and their instances, ready to be traced by any number of threads.
#[derive(Debug)]
pub struct Scene {
    meshes: Vec<MeshTree>,
    records: Vec<Record>,
    images: Images,
    instances: Tree,
    domain: Domain,
    /// All geometry, before tiling.
    bounds: Bounds,
    /// What the tree over instances covers, with room for rounding.
    covered: Bounds,
    /// Where that tree's coordinates start.
    center: DVec3,
    level: Level,
}

impl Scene {
    /// Builds the trees. The result depends on nothing but the input, whatever the number of
    /// threads.
    ///
    /// # Errors
    /// The first mesh, instance or domain that is not lawful. Degenerate primitives and meshes
    /// without any are lawful, and never hit.
    pub fn build(
        meshes: &[MeshInput<'_>],
        instances: &[InstanceInput],
        domain: Domain,
    ) -> Result<Self, BuildError> {
        let size = domain.max - domain.min;
        let lawful = domain.min.is_finite() && domain.max.is_finite() && size.min_element() > 0.0;
        if !lawful {
            let (min, max) = (domain.min, domain.max);
            let (min_x, min_y, max_x, max_y) = (min.x, min.y, max.x, max.y);
            return Err(BuildError::Domain { min_x, min_y, max_x, max_y });
        }
        let meshes = meshes
            .par_iter()
            .enumerate()
            .map(|(number, input)| MeshTree::build(number, input))
            .collect::<Result<Vec<_>, _>>()?;
        let (mut records, mut boxes) = instance::records(&meshes, instances)?;
        let bounds = boxes.par_iter().copied().reduce(|| Bounds::EMPTY, Bounds::union);
        let images = match domain.boundary {
            Boundary::Isolated => Images::default(),
            Boundary::Periodic => Images::add(&mut records, &mut boxes, &domain)?,
        };
        let covered = boxes.par_iter().copied().reduce(|| Bounds::EMPTY, Bounds::union);
        let center =
            if covered.is_empty() { DVec3::ZERO } else { 0.5 * (covered.min + covered.max) };
        let present: Vec<u32> =
            (0..boxes.len() as u32).filter(|&i| !boxes[i as usize].is_empty()).collect();
        let boxes: Vec<Box3> = present
            .par_iter()
            .map(|&i| boxes[i as usize])
            .map(|b| outward(b.min - center, b.max - center))
            .collect();
        let reach = boxes.par_iter().map(|b| b.reach()).reduce(|| 0.0, f32::max);
        let plan = Plan { leaf: 1, leaf_cost: 1.0, pad: mesh::pad(reach), reinsertion: 0.5 };
        let instances = tree::build(
            boxes,
            plan,
            |_| false,
            |_| |leaf: &[u32]| Ref(Ref::LEAF | present[leaf[0] as usize]),
        );
        // The tree's boxes are padded for f32; this is padded for f64.
        let room = DVec3::splat(f64::from(reach) * (-40_f64).exp2());
        let covered = Bounds { min: covered.min - room, max: covered.max + room };
        let level = Level::detect();
        Ok(Self { meshes, records, images, instances, domain, bounds, covered, center, level })
    }

    /// Height of the highest geometry, m; 0 if there is none.
    #[must_use]
    pub fn top(&self) -> f64 {
        self.bounds().1.z
    }

    /// Height of the lowest geometry, m; 0 if there is none.
    #[must_use]
    pub fn bottom(&self) -> f64 {
        self.bounds().0.z
    }

    /// Lowest and highest corner of a box around all geometry before tiling, m; exact in height,
    /// and around instances that are turned within a few percent. Zero if there is no geometry.
    #[must_use]
    pub fn bounds(&self) -> (DVec3, DVec3) {
        if self.bounds.is_empty() {
            return (DVec3::ZERO, DVec3::ZERO);
        }
        (self.bounds.min, self.bounds.max)
    }

    /// What the scene keeps in memory, all told.
    #[must_use]
    pub fn memory(&self) -> Memory {
        let nodes = |tree: &Tree| size_of_val(&*tree.nodes);
        Memory {
            primitives: self.meshes.iter().map(MeshTree::primitives).sum(),
            mesh_bytes: self.meshes.iter().map(|mesh| mesh.bytes() + nodes(&mesh.tree)).sum(),
            instances: self.records.len() - self.images.count(),
            instance_bytes: size_of_val(&*self.records)
                + self.images.bytes()
                + nodes(&self.instances),
        }
    }

    /// The first surface on a ray at a distance above 0.
    ///
    /// Of surfaces at one distance, the one of the lowest instance and primitive counts.
    #[must_use]
    pub fn closest(&self, ray: &Ray) -> Option<Hit> {
        self.closest_in(Tiles::new(self, ray, f64::INFINITY))
    }

    /// Whether any surface is on a ray at a distance above 0.
    #[must_use]
    pub fn occluded(&self, ray: &Ray) -> bool {
        self.occluded_within(ray, f64::INFINITY)
    }

    /// Whether any surface is on a ray at a distance above 0 and below `distance`, m.
    #[must_use]
    pub fn occluded_within(&self, ray: &Ray, distance: f64) -> bool {
        self.any_in(Tiles::new(self, ray, distance))
    }

    /// [`Self::occluded`] of some rays and [`Self::closest`] of others, in less time than one after the
    /// other: what many paths together ask for, towards the sun and onwards.
    ///
    /// # Panics
    /// If there is not one place for each answer.
    pub fn trace_each(&self, batch: Batch<'_>) {
        let Batch { shadows, dark, rays, hits } = &batch;
        assert!(shadows.len() == dark.len() && rays.len() == hits.len(), "one answer each");
        self.level.each(self, batch);
    }

    fn closest_in(&self, mut tiles: Tiles<'_>) -> Option<Hit> {
        tiles.find_map(|query| {
            let found = self.level.closest(&query)?;
            Some(self.resolve(&query, &found))
        })
    }

    fn any_in(&self, mut tiles: Tiles<'_>) -> bool {
        tiles.any(|query| self.level.occluded(&query))
    }

    pub(super) fn domain(&self) -> &Domain {
        &self.domain
    }

    pub(super) fn center(&self) -> DVec3 {
        self.center
    }

    pub(super) fn instances(&self) -> &Tree {
        &self.instances
    }

    pub(super) fn records(&self) -> &[Record] {
        &self.records
    }

    pub(super) fn mesh_of(&self, record: u32) -> &MeshTree {
        &self.meshes[self.records[record as usize].mesh as usize]
    }

    /// Where a ray enters what the tree over instances covers, if it does so before `limit`.
    #[inline(always)]
    pub(super) fn clip(&self, origin: DVec3, direction: DVec3, limit: f64) -> Option<f64> {
        let Bounds { min, max } = self.covered;
        if origin.cmpge(min).all() && origin.cmple(max).all() {
            return (limit > 0.0).then_some(0.0);
        }
        self.covered.clip(origin, direction).map(|(enter, _)| enter).filter(|&enter| enter < limit)
    }

    /// What decides between primitives at one distance.
    pub(super) fn rank(&self, found: &Found) -> (u32, u32) {
        (found.record, self.primitive(found))
    }

    fn primitive(&self, found: &Found) -> u32 {
        let first = found.id & !PARALLELOGRAM;
        if found.block.is_other() { self.mesh_of(found.record).triangles + first } else { first }
    }

    /// The block and its lanes that a ray cannot hit in this instance.
    #[inline(always)]
    pub(super) fn skipped(&self, query: &Query<'_>, record: u32) -> (u32, u32) {
        let Some(from) = query.from else { return (Ref::NONE.0, 0) };
        let (instance, offset) = self.images.original(record);
        let x = query.tile[0].wrapping_add(offset[0]) == from.tile[0];
        let y = query.tile[1].wrapping_add(offset[1]) == from.tile[1];
        // No branch: whether a ray is in the instance that it leaves cannot be foreseen.
        let lanes = u32::from((instance == from.instance) & x & y) << from.lane;
        (from.block.0, lanes)
    }

    /// What a ray meets. Always inlined: it is asked for between steps of other rays, all of whose registers a
    /// call would save and load again.
    #[inline(always)]
    pub(super) fn resolve(&self, query: &Query<'_>, found: &Found) -> Hit {
        let mesh = self.mesh_of(found.record);
        let record = &self.records[found.record as usize];
        let object_from_world = DMat3::from_cols_array(&record.object_from_world.map(f64::from));
        let mut primitive = self.primitive(found);
        // The normal, and the square of what its rounding is relative to.
        let (front, square) = if found.block.is_other() {
            let front = mesh.discs[found.block.index()].lane(found.lane.into()).1;
            (front, front.length_squared())
        } else {
            let corners = mesh.planar[found.block.index()].lane(found.lane.into());
            let (ab, ac) = (corners[1] - corners[0], corners[2] - corners[0]);
            let front = ab.cross(ac);
            if found.id & PARALLELOGRAM != 0 {
                let origin = object_from_world * (query.origin - record.translation);
                let at = origin + found.distance * (object_from_world * query.direction);
                // Beyond the diagonal, the sum of the barycentric coordinates is above 1.
                let beyond = (corners[2] - corners[1]).cross(at - corners[1]).dot(front) < 0.0;
                if beyond {
                    primitive = mesh.second(found.block, found.lane);
                }
            }
            (front, ab.length_squared() * ac.length_squared())
        };
        let up = object_from_world.transpose() * front;
        let pace = 1.0 / up.length();
        let point = query.origin + found.distance * query.direction;
        let spread = object_from_world.to_cols_array().map(|v| v * v).iter().sum::<f64>();
        let lever = (query.origin - record.translation).abs().element_sum() + found.distance;
        let place = query.origin.abs().max_element()
            + record.translation.abs().max_element()
            + found.distance;
        // Each of some 16 roundings in `exact` is relative to the lever in object space; seen along
        // the normal, it grows by how much edges that are nearly parallel tilt the plane and by how
        // much the map squeezes that direction.
        let error = f64::EPSILON * (16.0 * (spread * square).sqrt() * pace * lever + 4.0 * place);
        let (point, shift) = tile::wrap(&self.domain, point);
        let (instance, offset) = self.images.original(found.record);
        let tile = [offset[0].wrapping_sub(shift[0]), offset[1].wrapping_sub(shift[1])];
        let departure = Departure { instance, block: found.block, lane: found.lane, tile };
        Hit {
            distance: found.distance,
            point,
            normal: up * pace,
            surface: mesh.surface(primitive),
            instance,
            primitive,
            error,
            departure,
        }
    }

    /// Traces with another instruction set than the best.
    #[cfg(test)]
    pub(super) fn with_level(mut self, level: Level) -> Self {
        self.level = level;
        self
    }

    pub(super) fn size(&self) -> DVec2 {
        self.domain.max - self.domain.min
    }
}
