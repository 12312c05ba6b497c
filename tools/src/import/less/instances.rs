//! Places of objects.

use std::fmt::Write as _;
use std::fs::File;
use std::io::{BufWriter, Write as _};

use anyhow::{Context as _, Result, bail};
use indexmap::IndexMap;

use super::conf;
use super::objects::{Bounds, ListFile};
use super::optics::unknown;
use super::project::{Project, Section};
use super::text::{self, quoted};

/// Placement of an object: x, y, z (m), yaw (degrees), horizontal and vertical scale.
type Row = [f64; 6];

impl Project {
    /// The scene's `instances` and `hide`: a table for each object.
    pub(super) fn instances_ron(
        &mut self,
        objects: &IndexMap<String, Option<Bounds>>,
        section: &mut Section,
    ) -> Result<()> {
        let Some(ListFile { name, path, place }) =
            self.list_file("tree_pos_file", "instances.txt")?
        else {
            return Ok(());
        };
        let mut rows: IndexMap<String, Vec<Row>> = IndexMap::new();
        let (width, height) = self.size;
        let is_bounded = !section.terrain.starts_with("terrain: Mesh");
        let mut without = 0;
        text::lines(&path, |line| {
            let (object, rest) = name_of(line, objects);
            let bounds = match objects.get(object) {
                Some(Some(bounds)) => bounds,
                Some(None) => {
                    without += 1;
                    return Ok(());
                }
                None => {
                    bail!(unknown("object", "scene.forest.objects_file", object, objects.keys()))
                }
            };
            let numbers: Option<Vec<f64>> = rest.split_whitespace().map(conf::finite).collect();
            let (x, y, z, yaw, scale) = match numbers.as_deref() {
                Some(&[x, y, z]) => (x, y, z, 0.0, (1.0, 1.0)),
                Some(&[x, y, z, turn]) => (x, y, z, turn, (1.0, 1.0)),
                Some(&[x, y, z, diameter, tall]) if diameter > 0.0 && tall > 0.0 => {
                    (x, y, z, 0.0, (diameter / bounds.diameter(), tall / bounds.height()))
                }
                _ => bail!(
                    "{:?} is not `object x y z`, `.. rotation` or `.. diameter height`",
                    text::excerpt(line)
                ),
            };
            if !(scale.0.is_finite() && scale.1.is_finite()) {
                bail!(
                    "the object {object:?} is flat: it cannot be scaled to a diameter and a height"
                );
            }
            let north = height - y;
            if is_bounded && !((0.0..=width).contains(&x) && (0.0..=height).contains(&north)) {
                bail!("({x}, {y}) lies outside the scene of {width} m x {height} m");
            }
            rows.entry(object.to_owned()).or_default().push([x, north, z, yaw, scale.0, scale.1]);
            Ok(())
        })
        .context(place)?;
        if without > 0 {
            let what = "places of objects that have no components";
            self.report.left_out(&name, &without.to_string(), what);
        }
        if rows.values().flatten().any(|row| row[3] != 0.0) {
            let what = "taken as counter-clockwise seen from above";
            self.report.differs(&name, "rotations", what);
        }
        if rows.values().flatten().any(|row| (row[4], row[5]) != (1.0, 1.0)) {
            let what = "scaled by the extent of the whole object; LESS took its first component's";
            self.report.differs(&name, "diameters and heights", what);
        }
        let is_nowhere = |object: &&String| !rows.contains_key(*object);
        let defined = objects.iter().filter(|(_, bounds)| bounds.is_some());
        for object in defined.map(|(object, _)| object).filter(is_nowhere) {
            self.report.differs(&name, object, "stands nowhere");
        }
        section.instances.push_str("instances: [\n");
        let mut files = Vec::new();
        for (object, rows) in &rows {
            let mut file = format!("assets/places_{}.csv", text::file_name(object));
            while files.contains(&file.to_ascii_lowercase()) {
                file = file.replace(".csv", "_.csv");
            }
            files.push(file.to_ascii_lowercase());
            self.write_places(&file, rows)?;
            writeln!(
                section.instances,
                "Table(file: {}, of: {}, on_terrain: true),",
                quoted(&file),
                quoted(object)
            )?;
        }
        section.instances += "],\n";
        self.hidden(objects, &rows, section)
    }

    fn write_places(&self, file: &str, rows: &[Row]) -> Result<()> {
        let path = self.out.join(file);
        let mut out = BufWriter::new(
            File::create(&path).with_context(|| format!("cannot write {}", path.display()))?,
        );
        let is_turned = rows.iter().any(|row| row[3] != 0.0);
        let is_scaled = rows.iter().any(|row| (row[4], row[5]) != (1.0, 1.0));
        let turn = if is_turned { ",yaw_deg" } else { "" };
        let scale = if is_scaled { ",scale,scale_vertical" } else { "" };
        writeln!(out, "x_m,y_m,z_m{turn}{scale}")?;
        for [x, y, z, yaw, horizontal, vertical] in rows {
            write!(out, "{x},{y},{z}")?;
            if is_turned {
                write!(out, ",{yaw}")?;
            }
            if is_scaled {
                write!(out, ",{horizontal},{vertical}")?;
            }
            writeln!(out)?;
        }
        Ok(out.flush()?)
    }

    /// Objects that the user has hidden; LESS leaves them out of the simulation too.
    fn hidden(
        &self,
        objects: &IndexMap<String, Option<Bounds>>,
        rows: &IndexMap<String, Vec<Row>>,
        section: &mut Section,
    ) -> Result<()> {
        let file = self.parameters.join("hide_object.txt");
        if !file.exists() {
            return Ok(());
        }
        let mut hidden: Vec<String> = Vec::new();
        text::lines(&file, |line| {
            // One name on each line, or all on one.
            let names = if objects.contains_key(line) {
                vec![line]
            } else {
                line.split_whitespace().collect()
            };
            for name in names {
                if !objects.contains_key(name) {
                    self.report.left_out("hide_object.txt", name, "there is no such object");
                }
                if rows.contains_key(name) {
                    hidden.push(quoted(name));
                }
            }
            Ok(())
        })?;
        if !hidden.is_empty() {
            writeln!(section.instances, "hide: [{}],", hidden.join(", "))?;
        }
        Ok(())
    }
}

/// Splits a line into the name of an object and the rest. Names may hold spaces: the longest one of those
/// that are known is taken.
fn name_of<'a>(line: &'a str, objects: &IndexMap<String, Option<Bounds>>) -> (&'a str, &'a str) {
    let ends_name = |rest: &&str| rest.is_empty() || rest.starts_with(char::is_whitespace);
    let known = objects
        .keys()
        .filter(|name| line.strip_prefix(name.as_str()).as_ref().is_some_and(ends_name));
    match known.map(String::len).max() {
        Some(length) => line.split_at(length),
        None => line.split_once(char::is_whitespace).unwrap_or((line, "")),
    }
}
