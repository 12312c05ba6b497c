//! The project as a whole: its settings, its scenes, and the report.

use std::collections::HashSet;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use anyhow::Result;
use sunfleck::output;

use super::batch::{self, Batch};
use super::conf::Node;
use super::light::{self, Band};
use super::optics::Materials;
use super::report::Report;
use super::sensor::Kind;
use super::settings::Rule;
use super::swept::Swept;
use super::text;
use crate::import::scene::write_scene;

/// The scene of `input.conf` itself.
pub(super) use crate::import::scene::SCENE;

/// Objects that a project has, possibly with no keys.
const SECTIONS: [&[&str]; 7] = [
    &["Advanced"],
    &["illumination", "sun"],
    &["illumination", "atmosphere"],
    &["observation"],
    &["sensor"],
    &["scene", "terrain"],
    &["scene", "forest"],
];

/// A project that becomes a scene.
#[derive(Debug)]
pub(super) struct Project {
    pub(super) conf: Node,
    /// Folder of its files.
    pub(super) parameters: PathBuf,
    /// Folder that the scene is written to.
    pub(super) out: PathBuf,
    pub(super) bands: Vec<Band>,
    pub(super) kind: Kind,
    /// Extent to the east and to the south, m.
    pub(super) size: (f64, f64),
    pub(super) is_thermal: bool,
    pub(super) materials: Materials,
    /// Names of files in `assets`, without extension and in small letters.
    pub(super) asset_names: HashSet<String>,
    pub(super) report: Report,
}

/// Parts of a scene that no batch varies.
#[derive(Debug, Default)]
pub(super) struct Section {
    pub(super) meshes: String,
    pub(super) terrain: String,
    pub(super) instances: String,
}

impl Project {
    /// The project in `folder`, whose scene is to be written to `out`.
    pub(super) fn read(folder: &Path, out: &Path) -> Result<Self> {
        let parameters = folder.join("Parameters");
        let file = parameters.join("input.conf");
        let mut conf = Node::read(&file)?;
        for keys in SECTIONS {
            conf.ensure_object(keys)?;
        }
        let report = Report::new("LESS");
        let kind = Kind::read(conf.need("sensor")?, &report)?;
        conf.ensure_object(&["sensor", kind.key()])?;
        let (scene, sensor) = (conf.need("scene")?, conf.need("sensor")?);
        let terrain = scene.need("terrain")?;
        let bands = light::bands(sensor, &report)?;
        let is_thermal = sensor.flag_of("thermal_radiation")?;
        let extent = |key| Rule::EXTENT.read(terrain, key, &report);
        Ok(Self {
            materials: Materials::read(scene, bands.len(), is_thermal),
            size: (extent("extent_width")?, extent("extent_height")?),
            is_thermal,
            parameters,
            out: out.to_owned(),
            bands,
            kind,
            asset_names: HashSet::new(),
            report,
            conf,
        })
    }

    /// Writes the scenes and returns the report; `out` is the name that it gives the folder.
    pub(super) fn import(&mut self, folder: &Path, out: &Path) -> Result<String> {
        let batches = batch::read_all(&self.parameters, &self.report)?;
        let mut section = self.terrain_ron()?;
        let objects = self.objects_ron(&mut section)?;
        self.instances_ron(&objects, &mut section)?;
        if self.needs_solar_table() {
            self.write(light::SOLAR_FILE, light::SOLAR)?;
        }
        let folder = std::path::absolute(folder)?;
        let name = folder.file_name().unwrap_or_default().to_string_lossy();
        let mut texts = vec![(SCENE.to_owned(), self.scene(&name, None, &section)?)];
        for batch in batches {
            let (file, text) = self.batch_scene(&name, batch, &section)?;
            let is_taken = texts.iter().any(|(other, _)| other.eq_ignore_ascii_case(&file));
            texts.push((if is_taken { format!("batch_{file}") } else { file }, text));
        }
        for node in self.conf.unread() {
            self.report.left_out(&node.path, &node.shown(), "not known");
        }
        for (file, text) in &texts {
            self.finish(file, text)?;
        }
        let files: Vec<_> = texts.iter().map(|(file, _)| file.as_str()).collect();
        Ok(format!("{}: {}\n{}", out.display(), files.join(", "), self.report.table()))
    }

    /// Name and text of a scene that sweeps over the values of a batch.
    fn batch_scene(
        &mut self,
        name: &str,
        mut batch: Batch,
        section: &Section,
    ) -> Result<(String, String)> {
        let mut swept = Swept::new(Some(&batch));
        self.light_ron(&mut swept)?;
        self.sensor_ron(&mut swept)?;
        let followed = swept.params;
        for axis in batch.axes().filter(|axis| !followed.contains_key(&axis.name)) {
            let what = "not varied: the scene has no number of this name";
            let place = axis.place.rsplit(['/', '\\']).next().unwrap_or_default();
            self.report.left_out(place, &axis.name, what);
        }
        batch.keep(|name| followed.contains_key(name));
        Ok((format!("{}.ron", batch.name), self.scene(name, Some(&batch), section)?))
    }

    /// The text of a scene, without the remarks above it.
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
        text += &self.materials.ron(&self.report)?;
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

    /// Writes a scene in normal form and makes sure that `sunfleck check` accepts it.
    fn finish(&self, file: &str, text: &str) -> Result<()> {
        let heading = "From a project of LESS 1.8.8.";
        let conf = self.parameters.join("input.conf");
        write_scene(&self.out, file, heading, &self.report, text, &conf)
    }

    /// Writes a small file beside the scene.
    pub(super) fn write(&self, file: &str, text: &str) -> Result<()> {
        output::replace(&self.out.join(file), text)?;
        Ok(())
    }

    /// A name for a file in `assets` that no other has, without extension.
    pub(super) fn asset_name(&mut self, name: &str) -> String {
        let mut name = text::file_name(name);
        while !self.asset_names.insert(name.to_ascii_lowercase()) {
            name.push('_');
        }
        name
    }
}
