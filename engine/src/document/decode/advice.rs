//! Advice for values of the wrong kind that tell what is meant.

use super::super::params::{entries, key};
use super::super::ron_text::{Node, Value};
use super::Reader;

/// Names of other programs for choices of the scene language: what is expected, the other name in small
/// letters, and what to write.
const OTHER_NAMES: [(&str, &[&str], &str); 14] = [
    (
        "a sensor",
        &["brf", "hdrf", "bidirectional", "reflectance", "multiangular", "goniometer"],
        "`Directions(views: .., measure: [Brf])` measures reflectance by direction",
    ),
    (
        "a sensor",
        &["camera", "pinhole", "frame", "thinlens"],
        "`Perspective(..)` is a camera, `Fisheye(..)` one that looks at the whole hemisphere",
    ),
    (
        "a sensor",
        &["nadir", "image", "satellite", "parallel", "ortho", "pushbroom", "distant"],
        "`Orthographic(..)` is an image by parallel rays",
    ),
    (
        "a sensor",
        &["fapar", "albedo", "flux", "fluxes", "absorption", "par", "radiometer", "energy"],
        "`Photons(measure: [Albedo, Fapar, ..])` counts fluxes",
    ),
    (
        "a sensor",
        &["hemispherical", "hemiphoto", "dhp", "lai", "gapfraction"],
        "`Fisheye(..)` measures gap fraction and leaf area index",
    ),
    ("a material", &["diffuse", "opaque", "lambert", "soil", "bark"], "`Lambertian(..)` is opaque"),
    (
        "a material",
        &["bilambertian", "translucent", "foliage", "twosided"],
        "`Leaf(..)` reflects and transmits",
    ),
    (
        "a terrain",
        &["dem", "dtm", "geotiff", "tiff", "heights", "grid"],
        "`Raster(..)` reads heights",
    ),
    ("a terrain", &["flat", "level", "ground"], "`Plane(..)` is level ground"),
    ("a spectrum", &["file", "csv", "tabulated", "spectrum"], "`Table(file: ..)` reads a spectrum"),
    ("a spectrum", &["uniform", "value", "flat"], "`Constant(..)` is one value in all bands"),
    (
        "a mesh",
        &["sphere", "cone", "tree", "ellipsoid", "cylinder"],
        "`Crown(shape: ..)` grows a tree",
    ),
    ("a mesh", &["ply", "stl", "fbx"], "convert the file to OBJ or glTF"),
    ("a rule of placement", &["random"], "`Uniform` is random, `PoissonDisc(..)` keeps a distance"),
];

/// Advice for a name of another program.
pub(super) fn other_name(expected: &str, name: &str) -> Option<&'static str> {
    let lower = name.to_lowercase();
    OTHER_NAMES
        .iter()
        .find(|(of, names, _)| expected.ends_with(of) && names.contains(&lower.as_str()))
        .map(|(.., advice)| *advice)
}

impl Reader<'_> {
    /// Advice for a value of the wrong kind; `None` if it does not tell what is meant.
    pub(super) fn advice(&self, expected: &str, node: &Node) -> Option<String> {
        match (&node.value, expected) {
            (Value::Text(text), "a number" | "a whole number") => self.number_advice(text, node),
            (Value::Named(named), "a number" | "a whole number") if named.body.is_none() => {
                self.is_param(&named.name, node).then(|| format!("write `\"={}\"`", named.name))
            }
            (Value::Text(text), "a spectrum") => self.spectrum_advice(text, node),
            (Value::Integer { .. } | Value::Float(_), "a spectrum") => {
                let number = self.text().get(node.span.range())?;
                Some(format!("write `Constant({number})`"))
            }
            (Value::List(items), "a spectrum") => match items.first().map(|item| &item.value) {
                Some(Value::Tuple(_)) => Some("write `Points([..])`".to_owned()),
                _ => Some("write `Bands([..])`, with one value for each band".to_owned()),
            },
            _ => None,
        }
    }

    /// Returns whether the file of a node has a parameter of this name.
    fn is_param(&self, name: &str, node: &Node) -> bool {
        self.params.contains(&format!("{}{name}", self.namespace(node)))
    }

    fn number_advice(&self, text: &str, node: &Node) -> Option<String> {
        let text = text.trim();
        if self.is_param(text, node) {
            return Some(format!("write `\"={text}\"`: a formula starts with `=`"));
        }
        if text.parse::<f64>().is_ok_and(f64::is_finite) {
            return Some(format!("write `{text}`, without quotes"));
        }
        let mut words = text.split(|c: char| c != '_' && c != '.' && !c.is_alphanumeric());
        if words.any(|word| self.is_param(word, node)) {
            return Some(format!("write `\"={text}\"`: a formula starts with `=`"));
        }
        let digits = text.trim_end_matches(|c: char| !c.is_ascii_digit());
        let is_number = digits.parse::<f64>().is_ok_and(f64::is_finite);
        is_number.then(|| format!("write `{digits}`: units are in the names of keys"))
    }

    fn spectrum_advice(&self, text: &str, node: &Node) -> Option<String> {
        let namespace = self.namespace(node);
        let is_named = self.has_spectrum(&format!("{namespace}{text}")) || self.has_spectrum(text);
        if is_named {
            return Some(format!("write `Named(\"{text}\")`"));
        }
        let ending = text.rsplit_once('.').map(|(_, ending)| ending.to_ascii_lowercase());
        if matches!(ending.as_deref(), Some("csv" | "txt" | "tsv" | "dat")) {
            return Some(format!("write `Table(file: \"{text}\")`"));
        }
        if text.parse::<f64>().is_ok_and(f64::is_finite) {
            return Some(format!("write `Constant({text})`"));
        }
        None
    }

    /// Advice for a word that is the name of a spectrum; `None` if it is none.
    pub(super) fn word_advice(&self, expected: &str, word: &str) -> Option<String> {
        let is_named = expected == "a spectrum" && self.has_spectrum(word);
        is_named.then(|| format!("write `Named(\"{word}\")`"))
    }

    fn has_spectrum(&self, name: &str) -> bool {
        self.tree.is_some_and(|tree| entries(key(tree, "spectra")).any(|(known, _)| known == name))
    }
}
