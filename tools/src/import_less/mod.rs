//! A project folder of LESS 1.8.8 to a scene.
//!
//! Files are read as their formats are documented; LESS counts x to the east and y to the south from
//! the north-west corner, its models have x to the west, y up and z to the north.

mod batch;
mod conf;
mod instances;
mod light;
mod objects;
mod optics;
mod photons;
mod report;
mod sensor;
mod swept;
mod term;
mod terrain;
mod text;

use std::collections::HashSet;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, bail};
use sunfleck::{document, output};

use batch::Batch;
use conf::Node;
use light::Band;
use optics::Materials;
use report::Report;
use swept::Swept;

/// The scene of `input.conf` itself.
const SCENE: &str = "scene.ron";

/// A project on its way to a scene.
#[derive(Debug)]
struct Project {
    conf: Node,
    /// Where its files are.
    parameters: PathBuf,
    /// Where the scene goes.
    out: PathBuf,
    bands: Vec<Band>,
    /// Extent to the east and to the south, m.
    size: (f64, f64),
    is_thermal: bool,
    materials: Materials,
    /// Names of files of meshes, in small letters.
    mesh_files: HashSet<String>,
    report: Report,
}

/// Parts of a scene that no batch varies.
#[derive(Debug, Default)]
struct Section {
    meshes: String,
    terrain: String,
    instances: String,
}

/// Turns the project in `folder` to scenes in `out`, and says what became of it.
pub(crate) fn import(folder: &Path, out: &Path) -> Result<String> {
    let parameters = folder.join("Parameters");
    let file = parameters.join("input.conf");
    if !file.is_file() {
        bail!("{} is no LESS project: there is no {}", folder.display(), file.display());
    }
    let written = out.join(SCENE);
    if written.exists() {
        bail!("{} is there already: name another folder with `--out`", written.display());
    }
    let conf = Node::read(&file)?;
    let (scene, sensor) = (conf.need("scene")?, conf.need("sensor")?);
    let bands = light::bands(sensor)?;
    let report = Report::default();
    let mut project = Project {
        materials: Materials::read(scene, bands.len(), &report)?,
        size: Project::extent(scene)?,
        is_thermal: sensor.get("thermal_radiation").map_or(Ok(false), Node::flag)?,
        parameters,
        out: out.to_owned(),
        bands,
        mesh_files: HashSet::new(),
        report,
        conf,
    };
    let batches = batch::read_all(&project.parameters)?;
    let assets = out.join("assets");
    fs::create_dir_all(&assets).with_context(|| format!("cannot make {}", assets.display()))?;
    project.scenes(folder, batches)
}

impl Project {
    fn scenes(&mut self, folder: &Path, batches: Vec<Batch>) -> Result<String> {
        let mut section = self.terrain_ron()?;
        let objects = self.objects_ron(&mut section)?;
        self.instances_ron(&objects, &mut section)?;
        if self.needs_solar_table() {
            self.write(light::SOLAR_FILE, light::SOLAR)?;
        }
        let name = folder.file_name().unwrap_or_default().to_string_lossy();
        let mut texts = vec![(SCENE.to_owned(), self.scene(&name, None, &section)?)];
        for mut batch in batches {
            let mut swept = Swept::new(Some(&batch));
            self.light_ron(&mut swept)?;
            self.sensor_ron(&mut swept)?;
            for axis in batch.axes().filter(|axis| !swept.params.contains_key(&axis.name)) {
                let what = "not varied: the scene has no number of this name";
                let place = axis.place.rsplit(['/', '\\']).next().unwrap_or_default();
                self.report.add(place, &axis.name, what);
            }
            let followed = swept.params;
            batch.keep(|name| followed.contains_key(name));
            let mut file = format!("{}.ron", batch.name);
            if texts.iter().any(|(other, _)| *other == file) {
                file = format!("batch_{file}");
            }
            texts.push((file, self.scene(&name, Some(&batch), &section)?));
        }
        for node in self.conf.unread() {
            self.report.add(&node.path, &node.shown(), "not known: not imported");
        }
        for (file, text) in &texts {
            self.finish(file, text)?;
        }
        let files: Vec<_> = texts.iter().map(|(file, _)| file.as_str()).collect();
        let mut told = format!("{}: {}\n", self.out.display(), files.join(", "));
        let table = self.report.table();
        if !table.is_empty() {
            write!(told, "what is not as in LESS:\n{table}")?;
        }
        Ok(told)
    }

    /// The text of a scene, but for the remarks above it.
    fn scene(&mut self, name: &str, batch: Option<&Batch>, section: &Section) -> Result<String> {
        let mut swept = Swept::new(batch);
        let light = self.light_ron(&mut swept)?;
        let sensor = self.sensor_ron(&mut swept)?;
        let mut text = format!("Scene(\nformat: 1,\ntitle: {},\n", text::quoted(name));
        if !swept.params.is_empty() {
            text += "params: {\n";
            for (name, value) in &swept.params {
                writeln!(text, "{}: {value:?},", text::quoted(name))?;
            }
            text += "},\n";
        }
        text += &self.bands_ron()?;
        text += &self.materials.ron()?;
        if !section.meshes.is_empty() {
            write!(text, "meshes: {{\n{}}},\n", section.meshes)?;
        }
        text += &section.terrain;
        text += &section.instances;
        text += &light;
        text += &sensor;
        if let Some(sweep) = batch.and_then(Batch::sweep) {
            writeln!(text, "sweep: {sweep},")?;
        }
        Ok(text + ")\n")
    }

    /// Writes a scene in normal form, once it reads.
    fn finish(&self, file: &str, text: &str) -> Result<()> {
        let mut remarks =
            "// From a project of LESS 1.8.8. What is not as it was there:\n".to_owned();
        for line in self.report.lines() {
            writeln!(remarks, "// {}", line.trim_end())?;
        }
        let path = self.out.join(file);
        let shown = path.display().to_string();
        let text = document::format(&shown, &(remarks + text))?;
        let reading = document::read_text(&shown, &text, &document::Options::default())?;
        if !reading.is_sound() {
            bail!("{}", reading.render());
        }
        output::replace(&path, &text)?;
        Ok(())
    }

    /// Writes a small file beside the scene.
    fn write(&self, file: &str, text: &str) -> Result<()> {
        output::replace(&self.out.join(file), text)?;
        Ok(())
    }
}
