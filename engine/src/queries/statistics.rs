//! Numbers of plants, their sizes and their leaf area, by mesh.

use std::collections::BTreeMap;

use hecs::World;

use super::cell_grid::round_number;
use crate::components::{Instance, InstanceCount, LeafArea, Mesh, Name, SceneId};

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
    /// One-sided area of surfaces of `Leaf` materials of all instances, m². Where vertical and horizontal scale of an
    /// instance differ, it holds for leaves of all directions.
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
    leaf_area: f64,
    heights: f64,
}

/// Statistics of all instances. Reads the components of instances, [`Mesh`], [`LeafArea`] and [`InstanceCount`].
#[must_use]
pub fn plant_statistics(world: &World) -> PlantStatistics {
    let mut sizes = mesh_sizes(world);
    let instances = Instance::in_order(world);
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
        *leaf_area += size.leaf_area * instance.placement.area_factor();
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

fn mesh_sizes(world: &World) -> BTreeMap<u32, MeshSize> {
    let mut query = world.query::<(&SceneId, &Name, &Mesh, &LeafArea, &InstanceCount)>();
    let placed = query.iter().filter(|(.., count)| count.0 > 0);
    let size = |(id, name, mesh, leaf_area, _): (&SceneId, &Name, &Mesh, &LeafArea, _)| {
        let statistics = MeshStatistics {
            name: name.0.clone(),
            instances: 0,
            triangles: mesh.triangles.len() as u64,
            discs: mesh.discs.len() as u64,
            height: HeightSpan { least: f64::INFINITY, mean: 0.0, most: 0.0 },
            leaf_area: 0.0,
        };
        let height = mesh.bounds().map_or(0.0, |(low, high)| f64::from(high.z - low.z));
        (id.0, MeshSize { statistics, height, leaf_area: leaf_area.0, heights: 0.0 })
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
