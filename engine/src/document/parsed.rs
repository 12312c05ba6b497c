//! A scene's text as a tree, from which the scene is read at any values of its parameters.

use crate::counts::counted;
use std::collections::HashSet;
use std::path::Path;
use std::sync::Arc;

use super::check::check_readable;
use super::decode::{Decode as _, Findings, Reader};
use super::diagnostic::{Diagnostic, Place};
use super::include::{Included, fields, include};
use super::params::{settle_params, survey};
use super::path::ScenePath;
use super::read::{ReadError, ReadOptions, Reading, parse_text, refuse_odd, text_of_file};
use super::ron_text::Node;
use super::scene::Scene;
use super::source::Source;

/// A scene file whose text, and that of the files that it includes, has been parsed: many scenes are read from it, each
/// at other values of the parameters.
#[derive(Clone, Debug)]
pub struct ParsedScene {
    source: Arc<Source>,
    tree: Arc<Node>,
    included: Included,
}

impl ParsedScene {
    /// Parses a file.
    ///
    /// # Errors
    /// Where the file cannot be read, or is not RON.
    pub fn from_file(path: &Path) -> Result<Self, ReadError> {
        Self::new(&path.display().to_string(), &text_of_file(path, false)?)
    }

    /// Parses a text; `name` stands for its file in messages, and included files are sought beside it.
    ///
    /// # Errors
    /// Where the text is not RON.
    pub fn new(name: &str, text: &str) -> Result<Self, ReadError> {
        refuse_odd(name, text)?;
        let mut source = Source::new(name, text);
        let mut tree = parse_text(&source)?;
        let included = include(&mut tree, &mut source);
        let tree = Arc::new(tree);
        let source = Arc::new(source.with_tree(Arc::clone(&tree)));
        Ok(Self { source, tree, included })
    }

    /// The tree of the text, included files among it.
    pub(super) fn tree(&self) -> &Node {
        &self.tree
    }

    /// Returns the scene without the key `sweep`: a point of a sweep has no use for the list of all.
    #[must_use]
    pub fn without_sweep(&self) -> Self {
        let mut tree = Node::clone(&self.tree);
        if let Some(fields) = fields(&mut tree) {
            fields.retain(|field| field.name != "sweep");
        }
        Self { tree: Arc::new(tree), ..self.clone() }
    }

    /// Reads the scene. Whatever is wrong with it is among [`Reading::diagnostics`].
    #[must_use]
    pub fn read(&self, options: &ReadOptions) -> Reading {
        let tree = &*self.tree;
        let Included { diagnostics, lost } = self.included.clone();
        let mut reader = Reader::new(&self.source);
        reader.start_with(diagnostics, &lost);
        let params = settle_params(tree, options, lost, &mut reader);
        reader.advise_from(tree, params.values.keys());
        survey(tree, &params, &mut reader);
        let mut scene = Scene::decode(tree, &mut reader);
        let unused = params.unused();
        scene.params = params.values;
        if let Some(output) = &options.output {
            scene.output.clone_from(output);
        }
        let diagnostics = self.complete(&scene, reader.finish(), &unused);
        Reading { scene, source: Arc::clone(&self.source), diagnostics, options: options.clone() }
    }

    /// Findings of the reader and of checks of the scene, in the order of the text.
    fn complete(&self, scene: &Scene, findings: Findings, unused: &[String]) -> Vec<Diagnostic> {
        let Findings { mut diagnostics, dropped, broken, lost } = findings;
        if dropped == 0 {
            diagnostics.extend(check_readable(scene, &broken, &lost));
        }
        if !diagnostics.iter().any(Diagnostic::is_error) {
            diagnostics.extend(unused.iter().map(|name| unused_param(name)));
        }
        for diagnostic in &mut diagnostics {
            if diagnostic.place.is_none() {
                diagnostic.place = self.source.place_of_path(diagnostic);
            }
        }
        // Diagnostics without a place stand last.
        let start = |one: &Diagnostic| one.place.as_ref().map_or(u32::MAX, |p| p.span.start);
        diagnostics.sort_by_key(start);
        // A file that is included twice is wrong once.
        let mut seen = HashSet::new();
        diagnostics.retain(|Diagnostic { place, message, .. }| {
            place.as_ref().is_none_or(|Place { file, line, column, .. }| {
                seen.insert((file.clone(), *line, *column, message.clone()))
            })
        });
        if dropped > 0 {
            let message = format!("and {}", counted(dropped, "more error"));
            diagnostics.push(Diagnostic::error(ScenePath::root(), message));
        }
        diagnostics
    }
}

fn unused_param(name: &str) -> Diagnostic {
    let path = ScenePath::from("params").name(name);
    Diagnostic::warning(path, format!("no formula uses the parameter `{name}`"))
        .help(format!("write `\"={name}\"` where its value is meant, or take it out"))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
mod tests {
    use super::super::read_text;
    use super::*;
    use crate::document::Param;

    const TEXT: &str = r#"Scene(
        format: 1,
        params: { "rho": 0.3, "idle": 1.0 },
        bands: [(name: "red", center_nm: 660.0)],
        materials: { "soil": Lambertian(reflectance: Constant("=rho")) },
        terrain: Plane(size_m: (10.0, 10.0), material: "soil"),
        sun: (zenith_deg: 30.0, azimuth_deg: 0.0, irradiance: Constant(1.0)),
        sensors: { "p": Photons(per_m2: 1.0, measure: [Albedo]) },
        sweep: Grid({ "rho": [0.1, 0.2, 7.0] }),
    )"#;

    /// *Expected*: at each value of a parameter what a reading of the text gives, errors with their places among it.
    #[test]
    fn scenes_of_a_parsed_text_are_those_of_the_text() {
        let parsed = ParsedScene::new("a.ron", TEXT).unwrap();
        let points = parsed.without_sweep();
        for rho in [0.1, 7.0] {
            let point = vec![("rho".to_owned(), Param::Number(rho))];
            let options = ReadOptions { point, ..ReadOptions::default() };
            let expected = read_text("a.ron", TEXT, &options).unwrap();
            let [whole, point] = [&parsed, &points].map(|parsed| parsed.read(&options));
            assert_eq!((&whole.scene, whole.render()), (&expected.scene, expected.render()));
            let without = Scene { sweep: None, ..expected.scene.clone() };
            assert_eq!((&point.scene, point.render()), (&without, expected.render()));
            assert_eq!(point.is_sound(), rho < 1.0, "{}", point.render());
            assert!(expected.render().contains("idle") || rho > 1.0, "{}", expected.render());
        }
    }
}
