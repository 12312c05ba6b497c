//! Choice of the mesh that is most like a tree, and its scale.

use std::f64::consts::TAU;

use rayon::prelude::*;

use super::Crown;
use crate::components::{Lean, Placement, PrototypeId, Scale};
use crate::sampling::Key;

/// A mesh that may stand for a tree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Model {
    /// The mesh.
    pub prototype: PrototypeId,
    /// Its height above its origin, m.
    pub height: f64,
    /// Diameter of its crown, m: that of the circle with the area of an ellipse in its bounds.
    pub diameter: f64,
}

/// Each tree as the model whose ratio of height to diameter is nearest to its own, which distorts
/// least; scaled to its height and diameter, turned at random. Of equal models the first is taken.
///
/// `ground` is the height of the terrain at each tree, m; `sink` how deep the meshes' origins lie
/// below it, m. Their tops are as high above the terrain as the trees.
///
/// # Panics
/// If there is no model, or not one height of the ground a tree.
#[must_use]
pub fn fit(
    crowns: &[Crown],
    ground: &[f64],
    models: &[Model],
    sink: f64,
    stream: Key,
) -> Vec<Placement> {
    assert!(!models.is_empty() && crowns.len() == ground.len(), "every tree has models and ground");
    let stream = stream.path("yaw");
    let place = |(number, (crown, &ground)): (usize, (&Crown, &f64))| {
        let height = crown.height + sink;
        let slenderness = height / crown.diameter;
        let distortion = |model: &Model| (model.height / model.diameter / slenderness).ln().abs();
        let model = models[1..].iter().fold(models[0], |best, model| {
            if distortion(model) < distortion(&best) { *model } else { best }
        });
        Placement {
            prototype: model.prototype,
            position: crown.place.extend(ground - sink),
            yaw: (TAU * stream.uniform(number as u64)) as f32,
            scale: Scale {
                horizontal: (crown.diameter / model.diameter) as f32,
                vertical: (height / model.height) as f32,
            },
            lean: Lean::UPRIGHT,
        }
    };
    crowns.par_iter().zip(ground).enumerate().map(place).collect()
}
