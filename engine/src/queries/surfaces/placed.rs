//! Trees over the meshes of a world, and placements of them.

use std::collections::BTreeMap;

use glam::{DMat3, DVec2, DVec3};
use rayon::prelude::*;

use super::planted::PlantedMesh;
use super::{FlatPatch, SurfaceTree};
use crate::components::{MaterialId, Placement};

/// Surfaces of a mesh that belong to one class.
#[derive(Debug)]
pub(in crate::queries) struct MaterialTree<'a> {
    pub(in crate::queries) tree: SurfaceTree<'a>,
    /// Class of its material.
    pub(in crate::queries) class: usize,
}

/// Trees of each mesh prototype, by its id, over the surfaces that have a class.
pub(in crate::queries) fn prototype_trees<'a>(
    meshes: &[PlantedMesh<'a>],
    class_of: impl Fn(MaterialId) -> Option<usize> + Sync,
) -> BTreeMap<u32, Vec<MaterialTree<'a>>> {
    let trees = |&(id, mesh, materials): &PlantedMesh<'a>| {
        let parts = || mesh.parts.iter().zip(&materials.0);
        let mut classes: Vec<usize> = parts().filter_map(|part| class_of(*part.1)).collect();
        classes.sort_unstable();
        classes.dedup();
        let tree = |class: usize| {
            let of_class = parts().filter(|part| class_of(*part.1) == Some(class));
            let tree = SurfaceTree::new(mesh, of_class.map(|part| part.0))?;
            Some(MaterialTree { tree, class })
        };
        (id.0, classes.into_iter().filter_map(tree).collect())
    };
    meshes.par_iter().map(trees).collect()
}

/// Transformation of a prototype to where an instance of it stands.
#[derive(Clone, Copy, Debug)]
pub(in crate::queries) struct PlacementTransform {
    linear: DMat3,
    absolute: DMat3,
    position: DVec3,
}

/// A box in the world.
#[derive(Clone, Copy, Debug)]
pub(in crate::queries) struct PlacedBox {
    /// Lowest corner, m.
    pub(in crate::queries) low: DVec3,
    /// Highest corner, m.
    pub(in crate::queries) high: DVec3,
}

impl PlacementTransform {
    pub(in crate::queries) fn new(placement: &Placement) -> Self {
        let linear = placement.world_from_object();
        let absolute =
            DMat3::from_cols(linear.x_axis.abs(), linear.y_axis.abs(), linear.z_axis.abs());
        Self { linear, absolute, position: placement.position }
    }

    /// Box around a box in object space, given by its middle and half its extent.
    pub(in crate::queries) fn bounds(&self, (middle, half): (DVec3, DVec3)) -> PlacedBox {
        let (middle, half) = (self.linear * middle + self.position, self.absolute * half);
        PlacedBox { low: middle - half, high: middle + half }
    }

    /// Box around what an upright instance has above a rectangle in object space, given by its middle and half its
    /// extent; its heights are left out.
    pub(in crate::queries) fn footprint(&self, (middle, half): (DVec2, DVec2)) -> PlacedBox {
        self.bounds((middle.extend(0.0), half.extend(0.0)))
    }

    /// A surface at its place.
    pub(in crate::queries) fn patch(&self, patch: &FlatPatch) -> FlatPatch {
        FlatPatch {
            origin: self.linear * patch.origin + self.position,
            u: self.linear * patch.u,
            v: self.linear * patch.v,
            is_ellipse: patch.is_ellipse,
        }
    }
}
