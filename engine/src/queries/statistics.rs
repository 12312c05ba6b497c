//! Numbers of plants, their sizes and their leaf area, by mesh.

use std::collections::{BTreeMap, BTreeSet};

use hecs::World;

use super::cell_grid::round_number;
use super::stretched_area::StretchedArea;
use crate::components::{
    Instance, InstanceCount, LeafArea, Mesh, Name, PartMaterials, Placement, SceneId,
};
use crate::document::Material;

/// Plants of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct PlantStatistics {
    /// Meshes of which instances are placed, in the order of the scene.
    pub meshes: Vec<MeshStatistics>,
    /// Heights of all instances; `None` without any.
    pub heights: Option<HeightHistogram>,
}

/// Instances of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshStatistics {
    /// Name of the mesh.
    pub name: String,
    /// Number of instances.
    pub instances: u64,
    /// Triangles of one.
    pub triangles: u64,
    /// Discs of one.
    pub discs: u64,
    /// Heights of the instances.
    pub height: HeightSpan,
    /// One-sided area of surfaces of `Leaf` materials of all instances, m².
    pub leaf_area: f64,
}

/// Heights of some plants, m: vertical extent of the mesh times the vertical scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeightSpan {
    /// Lowest.
    pub least: f64,
    /// Mean.
    pub mean: f64,
    /// Highest.
    pub most: f64,
}

/// Number of plants by classes of height.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightHistogram {
    /// Heights of all.
    pub span: HeightSpan,
    /// Lower end of the lowest class, m.
    pub start: f64,
    /// Width of a class, m.
    pub step: f64,
    /// Number of plants in each class, from low to high.
    pub counts: Vec<u64>,
}

/// Classes of a histogram, about.
const CLASSES: f64 = 10.0;

/// Properties that all instances of a mesh share.
struct MeshSize {
    statistics: MeshStatistics,
    height: f64,
    heights: f64,
    leaves: LeafAreas,
}

/// Leaf area of a mesh under the scales of its instances.
enum LeafAreas {
    /// Area under equal scales of 1, m², as no instance has others.
    Uniform(f64),
    /// Area by the ratio of the vertical scale to the horizontal one.
    Stretched(StretchedArea),
}

impl LeafAreas {
    /// Area of an instance, m².
    fn of_instance(&self, placement: &Placement) -> f64 {
        let area = match self {
            Self::Uniform(area) => *area,
            Self::Stretched(stretched) => stretched.at(placement.scale.ratio()),
        };
        area * f64::from(placement.scale.horizontal).powi(2)
    }
}

/// Statistics of all instances. Reads the components of instances, [`Mesh`], [`PartMaterials`], [`LeafArea`],
/// [`InstanceCount`] and [`Material`].
#[must_use]
pub fn plant_statistics(world: &World) -> PlantStatistics {
    let instances = Instance::in_order(world);
    let mut sizes = mesh_sizes(world, &instances);
    let height_of = |size: &MeshSize, instance: &Instance| {
        size.height * f64::from(instance.placement.scale.vertical).abs()
    };
    for instance in &instances {
        let Some(size) = sizes.get_mut(&instance.placement.prototype.0) else { continue };
        let height = height_of(size, instance);
        size.heights += height;
        let MeshStatistics { instances, height: span, leaf_area, .. } = &mut size.statistics;
        *instances += 1;
        (span.least, span.most) = (span.least.min(height), span.most.max(height));
        *leaf_area += size.leaves.of_instance(&instance.placement);
    }
    let placed = || sizes.values().filter(|size| size.statistics.instances > 0);
    let count = placed().map(|size| size.statistics.instances).sum::<u64>();
    let span = HeightSpan {
        least: placed().map(|size| size.statistics.height.least).fold(f64::INFINITY, f64::min),
        mean: placed().map(|size| size.heights).sum::<f64>() / count as f64,
        most: placed().map(|size| size.statistics.height.most).fold(0.0, f64::max),
    };
    let heights = (count > 0).then(|| {
        let mut histogram = HeightHistogram::new(span);
        for instance in &instances {
            if let Some(size) = sizes.get(&instance.placement.prototype.0) {
                histogram.add(height_of(size, instance));
            }
        }
        histogram
    });
    let meshes = sizes.into_values().map(|MeshSize { mut statistics, heights, .. }| {
        statistics.height.mean = heights / (statistics.instances as f64).max(1.0);
        if statistics.instances == 0 {
            statistics.height = HeightSpan { least: 0.0, mean: 0.0, most: 0.0 };
        }
        statistics
    });
    PlantStatistics { meshes: meshes.collect(), heights }
}

/// Components of a mesh that statistics need.
type MeasuredMesh<'a> = (&'a SceneId, &'a Name, &'a Mesh, &'a PartMaterials, &'a LeafArea);

fn mesh_sizes(world: &World, instances: &[Instance]) -> BTreeMap<u32, MeshSize> {
    let mut ratios: BTreeMap<u32, (f64, f64)> = BTreeMap::new();
    for Instance { placement, .. } in instances {
        let (ratio, nothing) = (placement.scale.ratio(), (f64::INFINITY, 0.0));
        let (low, high) = ratios.entry(placement.prototype.0).or_insert(nothing);
        (*low, *high) = (low.min(ratio), high.max(ratio));
    }
    let mut materials = world.query::<(&SceneId, &Material)>();
    let leaves: BTreeSet<u32> =
        materials.iter().filter(|(_, material)| material.is_leaf()).map(|(id, _)| id.0).collect();
    let mut query = world.query::<(MeasuredMesh<'_>, &InstanceCount)>();
    let placed = query.iter().filter(|(.., count)| count.0 > 0).map(|(placed, _)| placed);
    let size = |(id, name, mesh, materials, leaf_area): MeasuredMesh<'_>| {
        let leaves = match ratios.get(&id.0) {
            Some(&(low, high)) if low > 0.0 && (low, high) != (1.0, 1.0) => {
                let parts = mesh.parts.iter().zip(&materials.0);
                let parts = parts.filter(|(_, material)| leaves.contains(&material.0));
                let vectors = parts.flat_map(|(part, _)| mesh.area_vectors(part));
                LeafAreas::Stretched(StretchedArea::new(vectors, (low, high)))
            }
            _ => LeafAreas::Uniform(leaf_area.0),
        };
        let statistics = MeshStatistics {
            name: name.0.clone(),
            instances: 0,
            triangles: mesh.triangles.len() as u64,
            discs: mesh.discs.len() as u64,
            height: HeightSpan { least: f64::INFINITY, mean: 0.0, most: 0.0 },
            leaf_area: 0.0,
        };
        let height = mesh.bounds().map_or(0.0, |(low, high)| f64::from(high.z - low.z));
        (id.0, MeshSize { statistics, height, heights: 0.0, leaves })
    };
    placed.map(size).collect()
}

impl HeightHistogram {
    fn new(span: HeightSpan) -> Self {
        let step = round_number(((span.most - span.least) / CLASSES).max(span.most * 1e-3));
        let start = (span.least / step).floor() * step;
        let count = ((span.most - start) / step).floor() as usize + 1;
        Self { span, start, step, counts: vec![0; count] }
    }

    fn add(&mut self, height: f64) {
        let class = ((height - self.start) / self.step).max(0.0) as usize;
        let last = self.counts.len() - 1;
        self.counts[class.min(last)] += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_of_a_histogram_hold_all_plants() {
        for (least, most) in [(3.0, 27.0), (5.0, 5.0), (0.02, 0.31), (0.0, 0.0)] {
            let span = HeightSpan { least, mean: least, most };
            let mut histogram = HeightHistogram::new(span);
            for step in 0..=100 {
                histogram.add(least + (most - least) * f64::from(step) / 100.0);
            }
            assert_eq!(histogram.counts.iter().sum::<u64>(), 101);
            assert!(histogram.counts.len() <= 22 && histogram.start <= least, "{histogram:?}");
            let end = histogram.start + histogram.step * histogram.counts.len() as f64;
            assert!(end >= most, "{histogram:?}");
        }
    }
}
