//! `lai`: leaf area of a scene by cells and layers.

use std::num::NonZeroUsize;

use clap::{Args, ValueEnum};
use sunfleck::queries::{CellCount, CountedSurfaces, HeightReference, LayerCount};
use sunfleck::run::{self, LeafAreaSettings};

use super::answer::Question;
use crate::arguments::{Scene, length};

#[derive(Args, Debug)]
pub(crate) struct Lai {
    #[command(flatten)]
    scene: Scene,

    /// Side of a cell on the ground, m; the nearest that divides the terrain is taken [default: a round number]
    #[arg(long, value_name = "M", value_parser = length, conflicts_with_all = ["rows", "columns"])]
    cell: Option<f64>,

    /// Number of rows of cells, from south to north
    #[arg(long, value_name = "N")]
    rows: Option<NonZeroUsize>,

    /// Number of columns of cells, from west to east
    #[arg(long, value_name = "N")]
    columns: Option<NonZeroUsize>,

    /// Height of a layer, m [default: 1 in a forest]
    #[arg(long, value_name = "M", value_parser = length, conflicts_with = "layers")]
    layer: Option<f64>,

    /// Number of layers, all of the same height
    #[arg(long, value_name = "N")]
    layers: Option<NonZeroUsize>,

    /// Heights that layers are counted by
    #[arg(long, value_name = "NAME", value_enum, default_value_t = Heights::Ground)]
    heights: Heights,

    /// Surfaces to count
    #[arg(long, value_name = "NAME", value_enum, default_value_t = Surfaces::Leaves)]
    surfaces: Surfaces,

    /// Give each material columns and bands of its own
    #[arg(long)]
    by_material: bool,

    /// Write the density of every cell of every layer too
    #[arg(long)]
    volume: bool,

    #[command(flatten)]
    question: Question,
}

/// Heights that layers are counted by.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Heights {
    /// Above the ground below each leaf
    Ground,
    /// Of the scene's local frame
    Absolute,
}

/// Surfaces that are counted.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Surfaces {
    /// Those of `Leaf` materials: leaf area index
    Leaves,
    /// All of meshes, bark too: plant area index
    All,
}

impl Lai {
    fn settings(&self) -> LeafAreaSettings {
        let count = |number: Option<NonZeroUsize>| number.map_or(1, NonZeroUsize::get);
        LeafAreaSettings {
            cells: match (self.cell, self.rows, self.columns) {
                (Some(side), ..) => CellCount::Side(side),
                (None, None, None) => CellCount::Automatic,
                (None, rows, columns) => {
                    CellCount::Counts { columns: count(columns), rows: count(rows) }
                }
            },
            layers: match (self.layer, self.layers) {
                (Some(thickness), _) => LayerCount::Thickness(thickness),
                (None, Some(count)) => LayerCount::Count(count.get()),
                (None, None) => LayerCount::Automatic,
            },
            heights: match self.heights {
                Heights::Ground => HeightReference::Ground,
                Heights::Absolute => HeightReference::Absolute,
            },
            surfaces: match self.surfaces {
                Surfaces::Leaves => CountedSurfaces::Leaves,
                Surfaces::All => CountedSurfaces::All,
            },
            by_material: self.by_material,
            with_cells: self.volume,
        }
    }
}

pub(super) fn lai(arguments: &Lai) -> anyhow::Result<()> {
    arguments.question.answer(&arguments.scene, "lai", |options, bars| {
        run::leaf_area_file(&arguments.scene.file, options, &arguments.settings(), bars)
    })
}
