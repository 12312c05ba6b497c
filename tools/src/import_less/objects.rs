//! Objects made of components, each a file of its own, to one OBJ file an object.

use std::fmt::Write as _;
use std::fs::File;
use std::io::{BufWriter, Write as _};
use std::path::Path;

use anyhow::{Context as _, Result, bail};
use indexmap::IndexMap;

use super::conf;
use super::text::{self, quoted};
use super::{Project, Section};

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
        text::lines(path, |line| {
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

/// A component of an object, as `objects.txt` has it.
struct Component {
    file: String,
    optics: String,
    temperature: Option<String>,
}

impl Project {
    /// Name of a file in `Parameters/` that a setting gives.
    pub(super) fn list_file(&self, key: &str, usual: &str) -> Result<Option<(String, String)>> {
        let Some(forest) = self.conf.at(&["scene", "forest"]) else { return Ok(None) };
        let (name, place) = match forest.get(key) {
            Some(node) => (node.text()?, &node.place),
            None => (usual.to_owned(), &forest.place),
        };
        if name.is_empty() {
            return Ok(None);
        }
        // LESS makes these files once there is something to put into them.
        let is_there = self.parameters.join(&name).exists();
        Ok((is_there || name != usual).then(|| (name, place.clone())))
    }

    /// The scene's `meshes`, and the extent of each object.
    pub(super) fn objects_ron(
        &mut self,
        section: &mut Section,
    ) -> Result<IndexMap<String, Bounds>> {
        let mut objects = IndexMap::new();
        let Some((name, place)) = self.list_file("objects_file", "objects.txt")? else {
            return Ok(objects);
        };
        let mut colours = 0;
        text::lines(&self.parameters.join(&name), |line| {
            let mut words = line.split_whitespace();
            let object = words.next().unwrap_or_default();
            if objects.contains_key(object) {
                bail!("the object {object:?} is there twice");
            }
            let components = components(words, &mut colours)?;
            if components.is_empty() {
                bail!(
                    "the object {object:?} has no components: write `{object} file.obj property`"
                );
            }
            let mesh = self.mesh_name(object);
            let file = format!("assets/{mesh}.obj");
            let mut obj = Obj::create(&self.out.join(&file))?;
            let mut parts: IndexMap<String, String> = IndexMap::new();
            for Component { file, optics, temperature } in components {
                let stem = Path::new(&file).file_stem().unwrap_or_default().to_string_lossy();
                let mut part =
                    text::file_name(stem.strip_prefix(&format!("{object}_")).unwrap_or(&stem));
                while parts.contains_key(&part) {
                    part.push('_');
                }
                obj.append(&part, &self.parameters.join(&file))?;
                parts.insert(part, self.materials.wear(&optics, temperature.as_deref())?);
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
            objects.insert(object.to_owned(), obj.finish()?);
            Ok(())
        })
        .with_context(|| place)?;
        if colours > 0 {
            let what = "not imported: colours of LESS's viewer";
            self.report.add("objects.txt", &format!("{colours} colours"), what);
        }
        Ok(objects)
    }

    /// A name for the file of a mesh that no other has.
    pub(super) fn mesh_name(&mut self, object: &str) -> String {
        let mut name = text::file_name(object);
        while !self.mesh_files.insert(name.to_ascii_lowercase()) {
            name.push('_');
        }
        name
    }
}

fn components<'a>(
    words: impl Iterator<Item = &'a str>,
    colours: &mut usize,
) -> Result<Vec<Component>> {
    let mut groups: Vec<Vec<&str>> = Vec::new();
    for word in words {
        let is_file =
            Path::new(word).extension().is_some_and(|ext| ext.eq_ignore_ascii_case("obj"));
        match groups.last_mut() {
            _ if is_file => groups.push(vec![word]),
            Some(group) => group.push(word),
            None => bail!("{word:?} is no `.obj` file"),
        }
    }
    let component = |group: &Vec<&str>| {
        let (file, rest) = (group[0], &group[1..]);
        let [optics, rest @ ..] = rest else { bail!("{file:?} has no optical property") };
        let (shades, temperatures): (Vec<&str>, Vec<&str>) =
            rest.iter().partition(|word| word.starts_with("0x") || word.starts_with('#'));
        if temperatures.len() > 1 || shades.len() > 1 {
            bail!(
                "{:?} is no component: `file.obj property temperature 0xcolour`",
                group.join(" ")
            );
        }
        *colours += shades.len();
        Ok(Component {
            file: file.to_owned(),
            optics: (*optics).to_owned(),
            temperature: temperatures.first().map(|&name| name.to_owned()),
        })
    };
    groups.iter().map(component).collect()
}
