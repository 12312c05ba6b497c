//! The products of one of several scenes that rode on the same paths.

use std::sync::Arc;

use super::{AxisPoints, Faces, Image, Product, ProductAxis, Rendering};

impl Product {
    /// The values of one of the scenes; what does not have some for each is the same for all.
    #[must_use]
    pub fn of_scene(&self, scene: usize, scenes: usize) -> Self {
        let (Some(joined), Some((bands, others))) =
            (self.joined(scenes).filter(|_| scenes > 1), self.dimensions.split_last())
        else {
            return self.clone();
        };
        let part = BandsOfScene { joined, start: scene * (joined / scenes), len: joined / scenes };
        // The labels of thousands of bands are copied for none but their scene.
        let own = |axis: &ProductAxis| ProductAxis {
            name: axis.name.clone(),
            points: match &axis.points {
                AxisPoints::Labels(labels) => AxisPoints::Labels(part.of(labels)),
                AxisPoints::Numbers(numbers) => AxisPoints::Numbers(part.of(numbers)),
            },
        };
        let mut dimensions = others.to_vec();
        dimensions.push(bands.iter().map(own).collect());
        Self {
            name: self.name.clone(),
            unit: self.unit.clone(),
            dimensions,
            values: part.of(&self.values),
            standard_error: part.of(&self.standard_error),
            replicates: part.of(&self.replicates),
            image: self.image.as_ref().map(|image| part.of_image(image)),
            faces: self.faces.as_ref().map(|faces| part.of_faces(faces)),
        }
    }

    /// Length of its last dimension, if that is of all scenes: of bands, or of the components of each sun.
    fn joined(&self, scenes: usize) -> Option<usize> {
        let is_joined = |axis: &&ProductAxis| match &axis.points {
            AxisPoints::Labels(labels) if axis.name == "component" => {
                let own = labels.len() / scenes;
                let is_whole = own > 0 && own * scenes == labels.len();
                is_whole && labels[own..] == labels[..labels.len() - own]
            }
            _ => axis.name == "band",
        };
        self.dimensions.last()?.iter().find(is_joined).map(|axis| axis.points.len())
    }
}

/// Bands of one scene among those of all.
#[derive(Clone, Copy)]
struct BandsOfScene {
    joined: usize,
    start: usize,
    len: usize,
}

impl BandsOfScene {
    /// Values of the scene, of shape `[.., bands]`.
    fn of<T: Clone>(self, values: &[T]) -> Vec<T> {
        let rows = values.chunks_exact(self.joined.max(1));
        let mut own = Vec::with_capacity(rows.len() * self.len);
        rows.for_each(|row| own.extend_from_slice(&row[self.start..][..self.len]));
        own
    }

    fn of_image(self, image: &Image) -> Image {
        let columns = self.start..self.start + self.len;
        Image {
            bands: self.of(&image.bands),
            pixels: image.pixels.select_columns(columns),
            rendering: match &image.rendering {
                Rendering::Colours { channels, exposure, white } => Rendering::Colours {
                    channels: *channels,
                    exposure: *exposure,
                    white: self.of(white),
                },
                other => other.clone(),
            },
            ..image.clone()
        }
    }

    fn of_faces(self, faces: &Faces) -> Faces {
        let Faces { inventory, origin, bands, values, standard_error } = faces;
        Faces {
            inventory: Arc::clone(inventory),
            origin: *origin,
            bands: self.of(bands),
            values: self.of(values),
            standard_error: self.of(standard_error),
        }
    }
}
