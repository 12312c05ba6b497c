//! The scene of an import: its text, its checks and its report.

use std::fmt::Write as _;
use std::path::Path;

use anyhow::{Result, bail};
use sunfleck::{document, output, run};

use super::report::Report;
use super::source::SourceProgram;
use super::text::quoted;

/// Name of a scene in its folder.
pub(super) const SCENE: &str = "scene.ron";

/// Parts of the text of a scene.
#[derive(Debug)]
pub(super) struct ImportedScene {
    pub(super) title: String,
    pub(super) bands: String,
    pub(super) materials: String,
    pub(super) meshes: String,
    pub(super) terrain: String,
    pub(super) instances: String,
    pub(super) boundary: &'static str,
    pub(super) report: Report,
}

impl ImportedScene {
    /// An empty scene from a program.
    pub(super) fn new(program: SourceProgram, boundary: &'static str) -> Self {
        Self {
            title: String::new(),
            bands: String::new(),
            materials: String::new(),
            meshes: String::new(),
            terrain: String::new(),
            instances: String::new(),
            boundary,
            report: Report::new(program.name()),
        }
    }

    /// Writes the scene into its folder, makes sure that `sunfleck check` accepts it, and returns the table of its report.
    pub(super) fn finish(
        self,
        folder: &Path,
        from: &Path,
        program: SourceProgram,
    ) -> Result<String> {
        let Self { title, bands, materials, meshes, terrain, instances, boundary, report } = self;
        let name = program.name();
        report.assumed("sun", "", "zenith 30°, azimuth 180°: the files hold no light");
        report.assumed("sensors", "", "BRF in the principal plane: the files hold no sensor");
        let title = quoted(&title);
        let text = format!(
            "Scene(format: 1, title: {title}, bands: [{bands}], materials: {{\n{materials}}}, meshes: {{\n{meshes}}}, \
             terrain: {terrain}, instances: [\n{instances}], sun: (zenith_deg: 30.0, azimuth_deg: 180.0), boundary: \
             {boundary}, sensors: {{ \"brf\": Directions(views: PrincipalPlane(max_deg: 60.0, step_deg: 10.0), until: \
             RelError(0.02)) }})"
        );
        write_scene(folder, SCENE, &format!("From {name}."), &report, &text, from)?;
        Ok(report.table())
    }
}

/// Writes a scene in normal form below the lines of its report, and makes sure that `sunfleck check` accepts it.
pub(super) fn write_scene(
    folder: &Path,
    file: &str,
    heading: &str,
    report: &Report,
    text: &str,
    from: &Path,
) -> Result<()> {
    let mut remarks = format!("// {heading}\n");
    for line in report.lines() {
        writeln!(remarks, "// {}", line.trim_end())?;
    }
    let path = folder.join(file);
    let shown = path.display().to_string();
    let text = document::format(&shown, &(remarks + text))?;
    output::replace(&path, &text)?;
    if let Err(failure) = run::check_file(&path, &run::Options::default()) {
        bail!("{}: the scene of this project is not sound:\n{failure}", from.display());
    }
    Ok(())
}
