//! Optical properties and temperatures to materials.

use std::fmt::Write as _;

use anyhow::{Result, anyhow, bail};
use indexmap::IndexMap;
use sunfleck::document::nearest;

use super::conf::{self, Node};
use super::report::Report;
use super::text::{list, quoted};

/// Materials of the scene by name. One optical property at two temperatures is two materials.
#[derive(Debug, Default)]
pub(super) struct Materials {
    optics: IndexMap<String, Optics>,
    /// Mean and range of temperatures, K, by name.
    temperatures: IndexMap<String, (f64, f64)>,
    /// Name of the material of each pair of optical property and temperature.
    worn: IndexMap<(String, Option<String>), String>,
}

/// Reflectance of front and back, and transmittance, band by band.
#[derive(Debug)]
struct Optics([Vec<f64>; 3]);

impl Materials {
    /// Those of a project with so many bands.
    pub(super) fn read(scene: &Node, bands: usize, report: &Report) -> Result<Self> {
        let mut materials = Self::default();
        for (name, node) in scene.get("optical_properties").map_or(&[][..], Node::entries) {
            materials.optics.insert(name.clone(), optics(name, node, bands, report)?);
        }
        for (name, node) in scene.get("temperature_properties").map_or(&[][..], Node::entries) {
            let text = node.text()?;
            let parts: Option<Vec<f64>> = text.split(':').map(conf::finite).collect();
            let (mean, range) = match parts.as_deref() {
                Some([mean]) => (*mean, 0.0),
                Some([mean, range]) => (*mean, *range),
                _ => return Err(node.wrong(&format!("{text:?} is not `mean:range` in K"))),
            };
            materials.temperatures.insert(name.clone(), (mean, range));
        }
        Ok(materials)
    }

    /// Name of the material of an optical property, perhaps at a temperature.
    pub(super) fn wear(&mut self, optics: &str, temperature: Option<&str>) -> Result<String> {
        if !self.optics.contains_key(optics) {
            bail!(unknown("optical property", optics, self.optics.keys()));
        }
        if let Some(name) = temperature {
            self.mean_temperature(name)?;
        }
        let pair = (optics.to_owned(), temperature.map(str::to_owned));
        let is_first = !self.worn.keys().any(|(other, _)| other == optics);
        let name = match temperature {
            Some(temperature) if !is_first => format!("{optics} {temperature}"),
            None if !is_first => format!("{optics} without temperature"),
            _ => optics.to_owned(),
        };
        Ok(self.worn.entry(pair).or_insert(name).clone())
    }

    /// Mean of a temperature, K.
    pub(super) fn mean_temperature(&self, name: &str) -> Result<f64> {
        let known = self.temperatures.get(name).map(|&(mean, _)| mean);
        known.ok_or_else(|| anyhow!(unknown("temperature", name, self.temperatures.keys())))
    }

    /// The scene's `materials`; those that nothing wears too.
    pub(super) fn ron(&mut self) -> Result<String> {
        for name in self.optics.keys().cloned().collect::<Vec<_>>() {
            if !self.worn.keys().any(|(optics, _)| *optics == name) {
                self.wear(&name, None)?;
            }
        }
        let mut text = "materials: {\n".to_owned();
        for ((optics, temperature), name) in &self.worn {
            let Optics([front, back, through]) = &self.optics[optics];
            let is_leaf = through.iter().any(|&value| value > 0.0);
            let kind = if is_leaf { "Leaf" } else { "Lambertian" };
            write!(text, "{}: {kind}(reflectance: Bands({}), ", quoted(name), list(front))?;
            if is_leaf {
                write!(text, "transmittance: Bands({}), ", list(through))?;
            }
            if front != back {
                write!(text, "back_reflectance: Bands({}), ", list(back))?;
            }
            if let Some(temperature) = temperature {
                let (mean, range) = self.temperatures[temperature];
                write!(text, "temperature: MeanDelta(mean_k: {mean:?}, delta_k: {range:?}), ")?;
            }
            text += "),\n";
        }
        Ok(text + "},\n")
    }
}

fn optics(name: &str, node: &Node, bands: usize, report: &Report) -> Result<Optics> {
    let value = node.need("value")?;
    let text = value.text()?;
    let parts: Vec<&str> = text.split(';').collect();
    let [front, back, through] = parts[..] else {
        let n = parts.len();
        return Err(value.wrong(&format!("{n} parts, not three: `front;back;transmittance`")));
    };
    let read = |what: &str, part: &str| -> Result<Vec<f64>> {
        let values = conf::numbers(part)
            .map_err(|part| value.wrong(&format!("{part:?} is not a number")))?;
        if values.len() != bands {
            let n = values.len();
            let values = if n == 1 { "value" } else { "values" };
            return Err(
                value.wrong(&format!("{what} has {n} {values}, `sensor.bands` has {bands}"))
            );
        }
        match values.iter().find(|&value| !(0.0..=1.0).contains(value)) {
            Some(wrong) => Err(value.wrong(&format!("{what} {wrong} is not between 0 and 1"))),
            None => Ok(values),
        }
    };
    let sides = [
        read("reflectance of the front", front)?,
        read("reflectance of the back", back)?,
        read("transmittance", through)?,
    ];
    for side in &sides[..2] {
        for (band, (r, t)) in side.iter().zip(&sides[2]).enumerate() {
            if r + t > 1.0 {
                return Err(value.wrong(&format!(
                    "reflectance {r} and transmittance {t} of band {} sum to more than 1",
                    band + 1
                )));
            }
        }
    }
    let path = &node.path;
    if let Some(kind) = node.get("Type") {
        match kind.text()?.as_str() {
            "0" => report.add(
                path,
                name,
                "values as stored here; LESS read them again from its database",
            ),
            "1" => {}
            "2" => report.add(path, name, "values of PROSPECT as stored here, not its parameters"),
            other => report.add(path, other, "unknown type; the values as stored"),
        }
    }
    if let Some(prospect) = node.get("ProspectDParams") {
        let shown = match prospect.entries() {
            [] => prospect.shown(),
            all => {
                all.iter().map(|(k, v)| format!("{k} {}", v.shown())).collect::<Vec<_>>().join(", ")
            }
        };
        report.add(&prospect.path, &shown, "not kept; `Prospect(..)` computes such spectra anew");
        prospect.settle();
    }
    let is_dark = |side: &[f64]| side.iter().all(|&value| value <= 0.0);
    if is_dark(&sides[1]) && is_dark(&sides[2]) && !is_dark(&sides[0]) {
        report.add(
            path,
            name,
            "black from behind, as in LESS; take out `back_reflectance` if not meant",
        );
    }
    Ok(Optics(sides))
}

/// What a person reads of a name that nothing has.
pub(super) fn unknown<'a>(
    what: &str,
    name: &str,
    known: impl Iterator<Item = &'a String> + Clone,
) -> String {
    if let Some(near) = nearest(name, known.clone().map(String::as_str)) {
        return format!("there is no {what} {name:?}; the nearest is {near:?}");
    }
    let known: Vec<_> = known.take(10).map(String::as_str).collect();
    format!("there is no {what} {name:?}; there is {}", known.join(", "))
}
