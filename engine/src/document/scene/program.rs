//! Included files, and the points of a sweep.

use super::super::leaves::{LeafValue, visit_leaves};
use super::super::path::ScenePath;
use super::super::schema::ReadKeys as _;
use super::{Band, Map, Param, Scene, Terrain};

record! {
    /// A file whose definitions are part of the scene, by names that start with the include's own:
    /// `birch.leaf`. In place of `(file: "species/birch.ron")`, `"species/birch.ron"` will do.
    pub struct Include ("an included file") {
        /// Path, relative to the file that includes it.
        file: String => r#""species/birch.ron""#,
        /// Values for its `params`; they go before the file's own and before its variant's.
        params: Map<Param> = Map::new(),
        /// The variant of the file that is meant.
        variant: Option<String> = None,
    }
}

choice! {
    /// Points that `sunfleck sweep` runs a scene at.
    pub enum Sweep ("a sweep") {
        /// Every combination of the parameters' values; the last parameter varies fastest.
        Grid(Map<Vec<Param>> => r#"{ "sza": [0.0, 30.0, 60.0] }"#),
        /// The first values of all parameters, then the second ones, and so on.
        Zip(Map<Vec<Param>> => r#"{ "sza": [30.0, 60.0], "vza": [0.0, 45.0] }"#),
    }
}

impl Scene {
    /// Bare ground that nothing lights and nothing measures, to which everything else can be added.
    #[must_use]
    pub fn new(bands: Vec<Band>, terrain: Terrain) -> Self {
        Self { format: 1, bands, terrain, ..Self::start() }
    }

    /// Paths of all files that it names, each with its path in the document.
    #[must_use]
    pub fn files(&self) -> Vec<(ScenePath, &str)> {
        let mut files = Vec::new();
        visit_leaves(self, &mut |path, leaf| {
            if let LeafValue::File(file) = leaf {
                files.push((path.clone(), file));
            }
        });
        files
    }

    /// The scene without what has been settled: parameters, variants and sweep. It gives the same
    /// results, and it is what `sunfleck expand` prints.
    #[must_use]
    pub fn resolved(&self) -> Self {
        let (params, variants) = (Map::new(), Map::new());
        Self { params, variants, sweep: None, ..self.clone() }
    }
}

impl Sweep {
    /// Number of points.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Grid(axes) => {
                axes.values().fold(1, |points, values| points.saturating_mul(values.len()))
            }
            Self::Zip(axes) => axes.values().map(Vec::len).min().unwrap_or(0),
        }
    }

    /// Returns whether there is no point.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Parameters that it varies.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        let (Self::Grid(axes) | Self::Zip(axes)) = self;
        axes.keys().map(String::as_str)
    }

    /// The parameters at a point, in the order of [`Sweep::names`].
    ///
    /// # Panics
    /// If there is no such point.
    #[must_use]
    pub fn point(&self, index: usize) -> Vec<(String, Param)> {
        assert!(index < self.len(), "the sweep has such a point");
        match self {
            Self::Zip(axes) => {
                axes.iter().map(|(name, values)| (name.clone(), values[index].clone())).collect()
            }
            Self::Grid(axes) => {
                let mut rest = index;
                let mut point: Vec<_> = axes
                    .iter()
                    .rev()
                    .map(|(name, values)| {
                        let value = values[rest % values.len()].clone();
                        rest /= values.len();
                        (name.clone(), value)
                    })
                    .collect();
                point.reverse();
                point
            }
        }
    }

    /// The sweep with each of these parameters at one value, where it varies them.
    #[must_use]
    pub fn fixed(&self, set: &[(String, Param)]) -> Self {
        let mut sweep = self.clone();
        let points = self.len();
        let (axes, copies) = match &mut sweep {
            Self::Grid(axes) => (axes, 1),
            Self::Zip(axes) => (axes, points),
        };
        for (name, value) in set {
            if let Some(values) = axes.get_mut(name) {
                let value = values.first().and_then(|own| value.like(own)).unwrap_or(value.clone());
                *values = vec![value; copies];
            }
        }
        sweep
    }
}
