//! Areas of the surfaces of a tree under a scale.

use glam::DVec3;

use crate::queries::surfaces::SurfaceTree;

/// Areas of the surfaces of a tree whose heights are scaled by a ratio, and whose widths are not; m².
#[derive(Debug)]
pub(super) struct ScaledAreas {
    /// Area of each surface, in the order of the tree.
    pub(super) surfaces: Vec<f64>,
    /// Area of all surfaces of each node.
    pub(super) nodes: Vec<f64>,
}

impl ScaledAreas {
    /// Areas under a ratio of the vertical scale to the horizontal one.
    ///
    /// A scale `diag(1, 1, r)` turns the vector `a` of an area into `(r a_x, r a_y, a_z)`.
    pub(super) fn new(tree: &SurfaceTree<'_>, ratio: f64) -> Self {
        let scale = DVec3::new(ratio, ratio, 1.0);
        let area = |place: usize| (tree.area_vector(place) * scale).length();
        let surfaces: Vec<f64> = (0..tree.len()).map(area).collect();
        let mut nodes = vec![0.0; tree.nodes().len()];
        // Children stand behind their parents.
        for (index, node) in tree.nodes().iter().enumerate().rev() {
            nodes[index] = match node.children(index as u32) {
                Some([left, right]) => nodes[left as usize] + nodes[right as usize],
                None => surfaces[node.places()].iter().sum(),
            };
        }
        Self { surfaces, nodes }
    }
}
