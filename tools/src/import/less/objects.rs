//! Objects made of components, each a file of its own, to one OBJ file an object.

use std::fmt::Write as _;
use std::fs::File;
use std::io::{BufWriter, Write as _};
use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, bail};
use indexmap::IndexMap;

use super::components::{self, Component};
use super::conf;
use super::project::{Project, Section};
use super::text::{self, quoted};

/// Extent of an object, m.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    low: [f64; 3],
    high: [f64; 3],
}

impl Bounds {
    const NONE: Self = Self { low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3] };

    fn extend(&mut self, corner: [f64; 3]) {
        for (axis, at) in corner.into_iter().enumerate() {
            self.low[axis] = self.low[axis].min(at);
            self.high[axis] = self.high[axis].max(at);
        }
    }

    fn extent(&self, axis: usize) -> f64 {
        self.high[axis] - self.low[axis]
    }

    /// Diameter of the circle as wide as its rectangle: √(width · depth).
    pub(super) fn diameter(&self) -> f64 {
        (self.extent(0) * self.extent(1)).sqrt()
    }

    pub(super) fn height(&self) -> f64 {
        self.extent(2)
    }
}

/// An OBJ file in the frame of sunfleck, made of files in that of LESS: x to the west, y up, z to
/// the north.
#[derive(Debug)]
pub(super) struct Obj {
    file: BufWriter<File>,
    vertices: i64,
    bounds: Bounds,
}

impl Obj {
    pub(super) fn create(path: &Path) -> Result<Self> {
        let file =
            File::create(path).with_context(|| format!("cannot write {}", path.display()))?;
        Ok(Self { file: BufWriter::new(file), vertices: 0, bounds: Bounds::NONE })
    }

    /// Adds a file as a part. LESS keeps corners and faces, and nothing else.
    pub(super) fn append(&mut self, part: &str, path: &Path) -> Result<()> {
        let base = self.vertices;
        writeln!(self.file, "g {part}")?;
        text::lossy_lines(path, |line| {
            let mut words = line.split_whitespace();
            match words.next() {
                Some("v") => {
                    let numbers: Vec<f64> = words.map_while(conf::finite).take(3).collect();
                    let [x, y, z] = numbers[..] else {
                        bail!("not three numbers: {:?}", text::excerpt(line));
                    };
                    let corner = [0.0 - x, z, y];
                    self.bounds.extend(corner);
                    self.vertices += 1;
                    writeln!(self.file, "v {} {} {}", corner[0], corner[1], corner[2])?;
                }
                Some("f") => {
                    let mut face = "f".to_owned();
                    let known = self.vertices - base;
                    for word in words {
                        let number: Option<i64> =
                            word.split('/').next().and_then(|n| n.parse().ok());
                        let corner = match number {
                            Some(n) if (1..=known).contains(&n) => base + n,
                            Some(n) if (-known..0).contains(&n) => self.vertices + 1 + n,
                            _ => bail!("corner {word:?} is none of the {known} before it"),
                        };
                        write!(face, " {corner}")?;
                    }
                    writeln!(self.file, "{face}")?;
                }
                _ => {}
            }
            Ok(())
        })
    }

    pub(super) fn finish(mut self) -> Result<Bounds> {
        self.file.flush()?;
        Ok(self.bounds)
    }
}

impl Project {
    /// The list that a setting names, and `file:line: path` of the setting. LESS writes these files once
    /// there is something to put into them.
    pub(super) fn list_file(&self, key: &str, usual: &str) -> Result<Option<ListFile>> {
        let forest = self.conf.need("scene")?.need("forest")?;
        let (name, place) = match forest.get(key) {
            Some(node) => (node.text()?, format!("{}: {}", node.place, node.path)),
            None => (usual.to_owned(), format!("{}: {}", forest.place, forest.path_of(key))),
        };
        if let Ok(path) = self.locate(&name) {
            Ok(Some(ListFile { name, path, place }))
        } else {
            let what = format!("there is no file {name}: none");
            self.report.assumed(&forest.path_of(key), &name, what);
            Ok(None)
        }
    }

    /// The scene's `meshes`, and the extent of each object; none for objects that have no components yet.
    pub(super) fn objects_ron(
        &mut self,
        section: &mut Section,
    ) -> Result<IndexMap<String, Option<Bounds>>> {
        let mut objects = IndexMap::new();
        let Some(ListFile { path, place, .. }) = self.list_file("objects_file", "objects.txt")?
        else {
            return Ok(objects);
        };
        let mut colours = 0;
        text::lines(&path, |line| {
            let (object, rest) = components::object(line);
            if objects.contains_key(object) {
                bail!("the object {object:?} is there twice");
            }
            let components = components::read(rest)?;
            if components.is_empty() {
                self.report.left_out("objects.txt", object, "has no components yet");
                objects.insert(object.to_owned(), None);
                return Ok(());
            }
            colours += components.iter().filter(|component| component.has_colour).count();
            objects.insert(object.to_owned(), Some(self.object_ron(object, components, section)?));
            Ok(())
        })
        .context(place)?;
        if colours > 0 {
            let what = "colours of LESS's viewer";
            self.report.unneeded("objects.txt", &format!("{colours} colours"), what);
        }
        Ok(objects)
    }

    /// Writes the mesh of an object, and returns its extent.
    fn object_ron(
        &mut self,
        object: &str,
        components: Vec<Component>,
        section: &mut Section,
    ) -> Result<Bounds> {
        let file = format!("assets/{}.obj", self.asset_name(object));
        let mut obj = Obj::create(&self.out.join(&file))?;
        let mut parts: IndexMap<String, String> = IndexMap::new();
        for Component { file, optics, temperature, .. } in components {
            let stem = Path::new(&file).file_stem().unwrap_or_default().to_string_lossy();
            let mut part =
                text::file_name(stem.strip_prefix(&format!("{object}_")).unwrap_or(&stem));
            while parts.contains_key(&part) {
                part.push('_');
            }
            obj.append(&part, &self.locate(&file)?)?;
            parts.insert(part, self.materials.surface_material(&optics, temperature.as_deref())?);
        }
        let parts: Vec<_> = parts
            .iter()
            .map(|(part, material)| format!("{}: {}", quoted(part), quoted(material)))
            .collect();
        writeln!(
            section.meshes,
            "{}: Obj(file: {}, up: Z, unit_m: 1.0, parts: {{ {} }}),",
            quoted(object),
            quoted(&file),
            parts.join(", ")
        )?;
        obj.finish()
    }
}

/// A list of objects or places.
pub(super) struct ListFile {
    pub(super) name: String,
    pub(super) path: PathBuf,
    /// `file:line: path` of the setting that names it.
    pub(super) place: String,
}
