//! XML geometry of Helios: patches and triangles with their transforms and radiative properties.
//!
//! A primitive is a unit square around the origin, or the triangle (0, 0), (0, 1), (1, 1), moved by a matrix of 16 numbers,
//! row by row; x to the east, z up, m. Properties are `data_float` labelled `reflectivity_BAND` and `transmissivity_BAND`,
//! as the radiation model names them. Source: Helios documentation, "Context: file input and output" and "Radiation model".

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs::File;
use std::io::{BufReader, BufWriter, Write as _};
use std::path::Path;

use anyhow::{Context as _, Result, bail};
use indexmap::{IndexMap, IndexSet};
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

use super::scene::ImportedScene;
use super::source::SourceProgram;
use super::text::{self, quoted};

/// Longest text of an element that is kept, bytes.
const LONGEST: usize = 1 << 16;

/// Most primitives of a file.
const MOST_PRIMITIVES: usize = 100_000_000;

/// Most labels of data that the report names.
const MOST_LABELS: usize = 100;

/// Corners of a patch before its transform.
const PATCH: [[f64; 2]; 4] = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]];

/// Corners of a triangle before its transform.
const TRIANGLE: [[f64; 2]; 3] = [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0]];

/// Depth of the ground below the lowest corner, m: a file may hold a ground of its own.
const BELOW_M: f64 = 0.01;

/// Radiative properties by their labels, as they are written.
type Properties = Vec<(String, String)>;

/// Imports a file into a folder.
pub(super) fn import(path: &Path, out: &Path) -> Result<ImportedScene> {
    if !path.is_file() {
        bail!("{} is not a file", path.display());
    }
    let file = File::open(path).with_context(|| format!("cannot read {}", path.display()))?;
    let mut xml = Reader::from_reader(BufReader::new(file));
    let mesh = out.join("assets/geometry.obj");
    let cannot = format!("cannot write {}", mesh.display());
    let writer = BufWriter::new(File::create(&mesh).with_context(|| cannot.clone())?);
    let mut geometry = Geometry::new(writer);
    let read = geometry.read(&mut xml);
    read.with_context(|| format!("{}: byte {}", path.display(), xml.buffer_position()))?;
    geometry.mesh.flush().context(cannot)?;
    geometry.scene(path)
}

/// A primitive whose element is being read.
#[derive(Debug, Default)]
struct Primitive {
    transform: Option<Vec<f64>>,
    properties: Properties,
    object: Option<String>,
    has_texture: bool,
}

struct Geometry {
    mesh: BufWriter<File>,
    scene: ImportedScene,
    vertices: u64,
    primitives: usize,
    low: [f64; 3],
    high: [f64; 3],
    /// Each set of properties is a material.
    materials: IndexSet<Properties>,
    /// Material of the primitives that were written last.
    current: Option<usize>,
    /// Objects that have primitives.
    objects: BTreeSet<String>,
    /// Number of objects by kind, of those without primitives; of elements that have no counterpart.
    without: IndexMap<String, usize>,
    textured: usize,
    unknown_data: BTreeSet<String>,
}

impl Geometry {
    fn new(mesh: BufWriter<File>) -> Self {
        Self {
            mesh,
            scene: ImportedScene::new(SourceProgram::Helios, "Isolated"),
            vertices: 0,
            primitives: 0,
            low: [f64::INFINITY; 3],
            high: [f64::NEG_INFINITY; 3],
            materials: IndexSet::new(),
            current: None,
            objects: BTreeSet::new(),
            without: IndexMap::new(),
            textured: 0,
            unknown_data: BTreeSet::new(),
        }
    }

    fn read(&mut self, xml: &mut Reader<BufReader<File>>) -> Result<()> {
        let mut buffer = Vec::new();
        let mut is_helios = false;
        loop {
            buffer.clear();
            match xml.read_event_into(&mut buffer)? {
                Event::Start(start) => {
                    let name = name(&start);
                    match name.as_str() {
                        "helios" => is_helios = true,
                        _ if !is_helios => bail!("the element <{name}> where <helios> is expected"),
                        "patch" | "triangle" => self.primitive(xml, &name)?,
                        "tile" | "box" | "cone" | "disk" | "sphere" | "tube" | "polymesh" => {
                            self.object(xml, &name)?;
                        }
                        "date" | "time" => {
                            skip(xml, &start)?;
                            self.scene.report.unneeded(&name, "", "the sun is a key of the scene");
                        }
                        _ => {
                            skip(xml, &start)?;
                            *self.without.entry(name).or_insert(0) += 1;
                        }
                    }
                }
                Event::Eof if is_helios => return Ok(()),
                Event::Eof => bail!("there is no element <helios>"),
                _ => {}
            }
        }
    }

    /// Reads a patch or a triangle and writes its face.
    fn primitive(&mut self, xml: &mut Reader<BufReader<File>>, kind: &str) -> Result<()> {
        let mut found = Primitive::default();
        children(xml, |key, label, text| {
            match key {
                "transform" => found.transform = Some(numbers(text)?),
                "objID" => found.object = Some(text.trim().to_owned()),
                "texture" => found.has_texture = true,
                "data_float" | "data_double" if is_property(label) => {
                    let value: Option<f64> = text.trim().parse().ok();
                    let value = value.filter(|value| (0.0..=1.0).contains(value));
                    let value = value.with_context(|| {
                        format!(
                            "{label} is {:?}; expected a fraction from 0 to 1",
                            text::excerpt(text)
                        )
                    })?;
                    found.properties.push((label.to_owned(), format!("{value:?}")));
                }
                _ if key.starts_with("data_") && self.unknown_data.len() < MOST_LABELS => {
                    self.unknown_data.insert(label.to_owned());
                }
                _ => {}
            }
            Ok(())
        })?;
        let Some(transform) = found.transform else {
            *self.without.entry(format!("{kind} without a transform")).or_insert(0) += 1;
            return Ok(());
        };
        let Ok(transform) = <[f64; 16]>::try_from(transform) else {
            bail!("the transform of a <{kind}> has not 16 numbers");
        };
        if self.primitives == MOST_PRIMITIVES {
            bail!("the file holds more than {MOST_PRIMITIVES} primitives");
        }
        self.primitives += 1;
        self.textured += usize::from(found.has_texture);
        self.objects.extend(found.object);
        found.properties.sort();
        let (material, _) = self.materials.insert_full(found.properties);
        if self.current != Some(material) {
            writeln!(self.mesh, "g surface_{}", material + 1)?;
            self.current = Some(material);
        }
        if kind == "patch" {
            self.face(&transform, &PATCH)
        } else {
            self.face(&transform, &TRIANGLE)
        }
    }

    fn face(&mut self, transform: &[f64; 16], corners: &[[f64; 2]]) -> Result<()> {
        let mut face = "f".to_owned();
        for &[x, y] in corners {
            let at = |row: usize| {
                transform[4 * row] * x + transform[4 * row + 1] * y + transform[4 * row + 3]
            };
            let corner = [at(0), at(1), at(2)];
            for (axis, value) in corner.into_iter().enumerate() {
                if !value.is_finite() {
                    bail!("a transform whose numbers are not finite");
                }
                self.low[axis] = self.low[axis].min(value);
                self.high[axis] = self.high[axis].max(value);
            }
            self.vertices += 1;
            writeln!(self.mesh, "v {} {} {}", corner[0], corner[1], corner[2])?;
            write!(face, " {}", self.vertices)?;
        }
        writeln!(self.mesh, "{face}")?;
        Ok(())
    }

    /// Reads an object: a group whose primitives stand in the file too, or one that was written by hand.
    fn object(&mut self, xml: &mut Reader<BufReader<File>>, kind: &str) -> Result<()> {
        let mut id = None;
        children(xml, |key, _, text| {
            if key == "objID" {
                id = Some(text.trim().to_owned());
            }
            Ok(())
        })?;
        if id.is_some_and(|id| self.objects.contains(&id)) {
            let what = "objects whose patches and triangles stand in the file";
            self.scene.report.unneeded(kind, "", what);
        } else {
            *self.without.entry(kind.to_owned()).or_insert(0) += 1;
        }
        Ok(())
    }

    /// The scene of what was read.
    fn scene(mut self, path: &Path) -> Result<ImportedScene> {
        if self.primitives == 0 {
            bail!("{}: holds no patch and no triangle", path.display());
        }
        let report = &self.scene.report;
        for (kind, count) in &self.without {
            let what = "only patches and triangles with a transform are converted: write the file with Helios' writeXML";
            report.left_out(kind, &count.to_string(), what);
        }
        for label in &self.unknown_data {
            report.left_out("data", label, "no reflectivity or transmissivity of a band");
        }
        if self.textured > 0 {
            let what = "textures and their transparency are not read: whole patches and triangles are opaque";
            report.differs("texture", &self.textured.to_string(), what);
        }
        let labels: BTreeSet<&str> =
            self.materials.iter().flatten().filter_map(|(label, _)| band_of(label)).collect();
        let bands: Vec<String> = labels.into_iter().map(str::to_owned).collect();
        self.scene.bands = bands_text(&bands, report);
        for (index, properties) in self.materials.iter().enumerate() {
            self.scene.materials += &material(index + 1, properties, &bands);
        }
        if self.materials.iter().any(Vec::is_empty) {
            let what = "black, as in Helios: no reflectivity and no transmissivity";
            report.assumed("primitives without properties", "", what);
        }
        let parts = (1..=self.materials.len()).map(|n| format!("\"surface_{n}\": \"surface_{n}\""));
        writeln!(
            self.scene.meshes,
            "\"geometry\": Obj(file: \"assets/geometry.obj\", up: Z, unit_m: 1.0, parts: {{ {} }}),",
            parts.collect::<Vec<_>>().join(", ")
        )?;
        self.scene.instances += "List(of: \"geometry\", at_m: [(0.0, 0.0, 0.0)]),";
        let ([west, south, bottom], [east, north, _]) = (self.low, self.high);
        let size = [(east - west).max(1.0), (north - south).max(1.0)];
        self.scene.materials += "\"below\": Lambertian(reflectance: Constant(0.0)),\n";
        self.scene.terrain = format!(
            "Plane(size_m: ({:?}, {:?}), material: \"below\", corner_m: ({west:?}, {south:?}), height_m: {:?})",
            size[0],
            size[1],
            bottom - BELOW_M
        );
        report.assumed(
            "ground",
            "",
            "black, 0.01 m below the lowest corner: Helios has none of its own",
        );
        report.assumed("boundary", "", "Isolated");
        self.scene.title = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        Ok(self.scene)
    }
}

/// Band of a label of the radiation model.
fn band_of(label: &str) -> Option<&str> {
    let band =
        label.strip_prefix("reflectivity_").or_else(|| label.strip_prefix("transmissivity_"));
    band.filter(|band| !band.is_empty())
}

fn is_property(label: &str) -> bool {
    band_of(label).is_some()
}

/// Bands by the names of Helios, whose wavelengths are the user's: those of names that are common.
fn bands_text(bands: &[String], report: &super::report::Report) -> String {
    if bands.is_empty() {
        report.assumed("bands", "", "one at 560 nm: the file names none");
        return "(name: \"band\", center_nm: 560.0)".to_owned();
    }
    let texts = bands.iter().map(|band| {
        let (from, to) = match band.to_uppercase().as_str() {
            "PAR" | "VIS" => (400.0, 700.0),
            "NIR" => (700.0, 1100.0),
            "SW" => (300.0, 2500.0),
            "RED" | "R" => (620.0, 700.0),
            "GREEN" | "G" => (500.0, 570.0),
            "BLUE" | "B" => (450.0, 500.0),
            _ => (560.0, 560.0),
        };
        let what = format!("{from} to {to} nm: Helios keeps wavelengths of bands in its program");
        report.assumed(&format!("band {band}"), "", what);
        let (center, width) = (0.5 * (from + to), to - from);
        format!("(name: {}, center_nm: {center:?}, width_nm: {width:?})", quoted(band))
    });
    texts.collect::<Vec<_>>().join(", ")
}

/// Text of a material by its values in all bands; what is not there is 0.
fn material(number: usize, properties: &Properties, bands: &[String]) -> String {
    let values = |prefix: &str| -> Vec<f64> {
        let value = |band: &String| {
            let label = format!("{prefix}_{band}");
            let found = properties.iter().find(|(known, _)| *known == label);
            found.and_then(|(_, value)| value.parse().ok()).unwrap_or(0.0)
        };
        if bands.is_empty() { vec![0.0] } else { bands.iter().map(value).collect() }
    };
    let (reflectance, transmittance) = (values("reflectivity"), values("transmissivity"));
    if transmittance.iter().all(|value| *value == 0.0) {
        format!("\"surface_{number}\": Lambertian(reflectance: Bands({reflectance:?})),\n")
    } else {
        format!(
            "\"surface_{number}\": Leaf(reflectance: Bands({reflectance:?}), transmittance: Bands({transmittance:?})),\n"
        )
    }
}

fn name(start: &BytesStart<'_>) -> String {
    start.name().as_ref().to_owned()
}

/// Reads past the end of an element.
fn skip(xml: &mut Reader<BufReader<File>>, start: &BytesStart<'_>) -> Result<()> {
    let mut buffer = Vec::new();
    xml.read_to_end_into(start.to_owned().name(), &mut buffer)?;
    Ok(())
}

/// Calls `each` with the name, the label and the text of each child of the element that has begun, to its end.
fn children(
    xml: &mut Reader<BufReader<File>>,
    mut each: impl FnMut(&str, &str, &str) -> Result<()>,
) -> Result<()> {
    let mut buffer = Vec::new();
    let (mut key, mut label, mut text) = (String::new(), String::new(), String::new());
    let mut depth = 0_usize;
    loop {
        buffer.clear();
        match xml.read_event_into(&mut buffer)? {
            Event::Start(start) => {
                depth += 1;
                if depth == 1 {
                    (key, label) = (name(&start), String::new());
                    text.clear();
                    if let Some(found) = start.try_get_attribute("label")? {
                        label = text::excerpt(&found.value);
                    }
                }
            }
            Event::Text(part) if depth == 1 => {
                text.push_str(&part);
                if text.len() > LONGEST {
                    bail!("the text of <{key}> is longer than {LONGEST} bytes");
                }
            }
            Event::End(_) if depth == 0 => return Ok(()),
            Event::End(_) => {
                if depth == 1 {
                    each(&key, &label, &text)?;
                }
                depth -= 1;
            }
            Event::Eof => bail!("the file ends within an element: it is cut off"),
            _ => {}
        }
    }
}

fn numbers(text: &str) -> Result<Vec<f64>> {
    let number = |word: &str| {
        let number: Option<f64> = word.parse().ok();
        number.with_context(|| format!("{:?} is no number", text::excerpt(word)))
    };
    text.split_whitespace().map(number).collect()
}
