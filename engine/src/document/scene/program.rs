//! Included files, and the points of a sweep.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::super::decode::{Decode, Reader};
use super::super::describe::Book;
use super::super::encode::Encode;
use super::super::leaves::{LeafValue, Walk, visit_leaves};
use super::super::path::ScenePath;
use super::super::ron_text::{Node, Text, Value};
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
        /// The scene as it is, and at both sides of it in each parameter: `derivatives.csv` has the derivatives of results
        /// with respect to them, central differences with standard errors. `["cab", "lai"]` takes steps of 1 % of the
        /// parameters; `{ "sza": 0.5 }` names the steps, for parameters that may be 0.
        Derivatives(DerivativeSteps => r#"["cab", "lai"]"#),
    }
}

/// Parameters of derivatives, and how far from the scene's own values the scene is run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum DerivativeSteps {
    /// Steps of 1 % of these parameters.
    Relative(Vec<String>),
    /// Step of each parameter, in its own unit.
    Absolute(Map<f64>),
}

impl DerivativeSteps {
    /// Step as a fraction of a parameter, where none is named.
    pub const RELATIVE: f64 = 0.01;

    /// Parameters, in the order of the document.
    #[must_use]
    pub fn names(&self) -> Vec<&str> {
        match self {
            Self::Relative(names) => names.iter().map(String::as_str).collect(),
            Self::Absolute(steps) => steps.keys().map(String::as_str).collect(),
        }
    }

    /// Step of the parameter at a place in [`Self::names`], whose own value is given.
    #[must_use]
    pub fn step(&self, index: usize, own: f64) -> f64 {
        match self {
            Self::Relative(_) => Self::RELATIVE * own.abs(),
            Self::Absolute(steps) => steps.get_index(index).map_or(f64::NAN, |(_, step)| *step),
        }
    }

    /// Path of the parameter at a place in [`Self::names`] below that of the sweep.
    #[must_use]
    pub fn path(&self, index: usize) -> ScenePath {
        let sweep = ScenePath::from("sweep");
        match self {
            Self::Relative(_) => sweep.index(index),
            Self::Absolute(steps) => {
                let name = steps.get_index(index).map(|(name, _)| name.clone());
                sweep.name(name.unwrap_or_default())
            }
        }
    }
}

impl Decode for DerivativeSteps {
    fn expected() -> Cow<'static, str> {
        "a list of parameters, or a map of parameters to steps".into()
    }

    fn example() -> String {
        r#"["cab", "lai"]"#.to_owned()
    }

    fn schema(book: &mut Book) -> serde_json::Value {
        serde_json::json!({ "anyOf": [Vec::<String>::schema(book), Map::<f64>::schema(book)] })
    }

    fn decode<'a>(node: &'a Node, reader: &mut Reader<'a>) -> Self {
        match &node.value {
            Value::List(_) => Self::Relative(Vec::decode(node, reader)),
            Value::Map(_) => Self::Absolute(Map::decode(node, reader)),
            _ => reader.mismatch(node),
        }
    }

    fn placeholder() -> Self {
        Self::Relative(Vec::new())
    }
}

impl Encode for DerivativeSteps {
    fn encode(&self) -> Text {
        match self {
            Self::Relative(names) => names.encode(),
            Self::Absolute(steps) => steps.encode(),
        }
    }

    fn visit<'a>(&'a self, walk: &mut Walk<'_, 'a>) {
        match self {
            Self::Relative(names) => names.visit(walk),
            Self::Absolute(steps) => steps.visit(walk),
        }
    }
}

impl Scene {
    /// Bare ground that nothing lights and nothing measures, to which everything else can be added.
    #[must_use]
    pub fn new(bands: Vec<Band>, terrain: Terrain) -> Self {
        Self { format: 1, bands: bands.into(), terrain, ..Self::start() }
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
            Self::Derivatives(steps) => 1 + 2 * steps.names().len(),
        }
    }

    /// Returns whether there is no point.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Parameters that it varies.
    #[must_use]
    pub fn names(&self) -> Vec<&str> {
        match self {
            Self::Grid(axes) | Self::Zip(axes) => axes.keys().map(String::as_str).collect(),
            Self::Derivatives(steps) => steps.names(),
        }
    }

    /// The parameters at a point, in the order of [`Sweep::names`]; of derivatives, the one that differs from the scene's
    /// own value, which is in `params`.
    ///
    /// # Panics
    /// If there is no such point.
    #[must_use]
    pub fn point(&self, index: usize, params: &Map<Param>) -> Vec<(String, Param)> {
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
            Self::Derivatives(_) if index == 0 => Vec::new(),
            Self::Derivatives(steps) => {
                let (place, is_high) = ((index - 1) / 2, index.is_multiple_of(2));
                let name = steps.names()[place];
                let own = params.get(name).and_then(Param::number).unwrap_or(f64::NAN);
                let step = steps.step(place, own);
                let value = if is_high { own + step } else { own - step };
                vec![(name.to_owned(), Param::Number(value))]
            }
        }
    }

    /// The sweep with each of these parameters at one value, where it varies them. Derivatives are those at that value.
    #[must_use]
    pub fn fixed(&self, set: &[(String, Param)]) -> Self {
        let mut sweep = self.clone();
        let points = self.len();
        let (axes, copies) = match &mut sweep {
            Self::Grid(axes) => (axes, 1),
            Self::Zip(axes) => (axes, points),
            Self::Derivatives(_) => return sweep,
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
