//! Optical properties and temperatures to materials.

use std::fmt::Write as _;
use sunfleck::counts::counted;

use anyhow::{Result, anyhow, bail};
use indexmap::IndexMap;
use sunfleck::document::nearest;

use super::conf::{self, Node};
use super::report::Report;
use super::soil::Soil;
use super::text::{list, quoted};

/// Highest temperature that a scene may hold, K.
pub(super) const HOTTEST_K: f64 = 10_000.0;

/// Name and value of the temperature of surfaces without one in a thermal project, as in LESS's window.
const USUAL_TEMPERATURE: (&str, Temperature) = ("T300", Temperature { mean: 300.0, range: 5.0 });

/// Sums of reflectance and transmittance up to this are rounding of LESS's four digits.
const ROUNDED_SUM: f64 = 1.001;

/// Leaves of a new project, whose transmittance the file has as 0.
const BIRCH_LEAF: &str = "birch_leaf_green";

/// Materials of the scene by name. One optical property at two temperatures is two materials.
#[derive(Debug, Default)]
pub(super) struct Materials {
    optics: IndexMap<String, Result<Optics, String>>,
    temperatures: IndexMap<String, Result<Temperature, String>>,
    /// Name of the material of each pair of optical property and temperature.
    used: IndexMap<(String, Option<String>), String>,
    is_thermal: bool,
    /// Remarks for the report.
    remarks: Vec<Remark>,
}

/// An optical property.
#[derive(Debug)]
struct Optics {
    surface: Surface,
    /// Remarks for the report if the property is used.
    remarks: Vec<Remark>,
}

/// A surface model with its parameters.
#[derive(Debug)]
enum Surface {
    Lambertian(Sides),
    Soilspect(Soil),
}

/// Spectra of a Lambertian surface, each of shape `[bands]`.
#[derive(Debug)]
struct Sides {
    /// Reflectance of the front side.
    front: Vec<f64>,
    /// Reflectance of the back side.
    back: Vec<f64>,
    transmittance: Vec<f64>,
}

/// A mean and the range between sunlit and shaded, K.
#[derive(Clone, Copy, Debug)]
struct Temperature {
    mean: f64,
    range: f64,
}

/// An error with its place, to which no further places are added.
#[derive(Debug)]
pub(super) struct Located(String);

impl std::fmt::Display for Located {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Located {}

/// Path, value and a note on its conversion.
type Remark = (String, String, String);

impl Materials {
    /// Reads the properties of a project with `bands` bands. A fault of one is an error once it is used.
    pub(super) fn read(scene: &Node, bands: usize, is_thermal: bool) -> Self {
        let mut materials = Self { is_thermal, ..Self::default() };
        for (name, node) in scene.get("optical_properties").map_or(&[][..], Node::entries) {
            let optics = optics(name, node, bands).map_err(|error| format!("{error:#}"));
            node.settle();
            materials.optics.insert(name.clone(), optics);
        }
        for (name, node) in scene.get("temperature_properties").map_or(&[][..], Node::entries) {
            let temperature = temperature(node).map_err(|error| format!("{error:#}"));
            node.settle();
            materials.temperatures.insert(name.clone(), temperature);
        }
        materials
    }

    /// Returns true if there is a sound optical property of this name.
    pub(super) fn has(&self, optics: &str) -> bool {
        matches!(self.optics.get(optics), Some(Ok(_)))
    }

    /// Adds the SOILSPECT model of the ground, and returns the name of its property.
    pub(super) fn add_soil(&mut self, soil: Soil) -> String {
        let mut name = "soilspect".to_owned();
        while self.optics.contains_key(&name) {
            name.push('_');
        }
        let optics = Optics { surface: Surface::Soilspect(soil), remarks: Vec::new() };
        self.optics.insert(name.clone(), Ok(optics));
        name
    }

    /// Name of the material of an optical property, perhaps at a temperature.
    pub(super) fn surface_material(
        &mut self,
        optics: &str,
        temperature: Option<&str>,
    ) -> Result<String> {
        match self.optics.get_mut(optics) {
            Some(Ok(optics)) => self.remarks.append(&mut optics.remarks),
            Some(Err(error)) => bail!(Located(error.clone())),
            None => bail!(unknown(
                "optical property",
                "scene.optical_properties",
                optics,
                self.optics.keys()
            )),
        }
        let (usual, kelvin) = USUAL_TEMPERATURE;
        let temperature = match temperature {
            None if self.is_thermal => {
                self.temperatures.entry(usual.to_owned()).or_insert(Ok(kelvin));
                let what = format!("no temperature: {usual}, as LESS has it");
                self.remarks.push((optics.to_owned(), String::new(), what));
                Some(usual)
            }
            temperature => temperature,
        };
        let temperature = match temperature.map(|name| (name, self.mean_temperature(name))) {
            Some((name, Ok(_))) => Some(name),
            Some((_, Err(error))) if self.is_thermal => return Err(error),
            Some((name, Err(error))) => {
                let what = format!("{error}; not needed without thermal radiation");
                self.remarks.push((optics.to_owned(), name.to_owned(), what));
                None
            }
            None => None,
        };
        let pair = (optics.to_owned(), temperature.map(str::to_owned));
        let is_first = !self.used.keys().any(|(other, _)| other == optics);
        let name = match temperature {
            Some(temperature) if !is_first => format!("{optics} {temperature}"),
            None if !is_first => format!("{optics} without temperature"),
            _ => optics.to_owned(),
        };
        Ok(self.used.entry(pair).or_insert(name).clone())
    }

    /// Mean of a temperature, K.
    pub(super) fn mean_temperature(&self, name: &str) -> Result<f64> {
        match self.temperatures.get(name) {
            Some(Ok(temperature)) => Ok(temperature.mean),
            Some(Err(error)) => bail!(Located(error.clone())),
            None => Err(anyhow!(unknown(
                "temperature",
                "scene.temperature_properties",
                name,
                self.temperatures.keys()
            ))),
        }
    }

    /// The scene's `materials`; those that no surface has too.
    pub(super) fn ron(&mut self, report: &Report) -> Result<String> {
        for (name, optics) in &self.optics {
            match optics {
                Ok(_) => {
                    if !self.used.keys().any(|(optics, _)| optics == name) {
                        self.used.insert((name.clone(), None), name.clone());
                    }
                }
                Err(error) => report.left_out(name, "not used", error),
            }
        }
        for (path, value, what) in self.remarks.drain(..) {
            report.differs(&path, &value, what);
        }
        let mut text = "materials: {\n".to_owned();
        for ((optics, temperature), name) in &self.used {
            let Some(Ok(Optics { surface, .. })) = self.optics.get(optics) else { continue };
            write!(text, "{}: ", quoted(name))?;
            match surface {
                Surface::Lambertian(sides) => sides.write(&mut text)?,
                Surface::Soilspect(soil) => {
                    text += "Soilspect(";
                    soil.write_keys(&mut text)?;
                }
            }
            let temperature = temperature.as_ref().and_then(|name| self.temperatures.get(name));
            if let Some(Ok(Temperature { mean, range })) = temperature {
                write!(text, "temperature: MeanDelta(mean_k: {mean:?}, delta_k: {range:?}), ")?;
            }
            text += "),\n";
        }
        Ok(text + "},\n")
    }
}

fn temperature(node: &Node) -> Result<Temperature> {
    let text = node.text()?;
    let parts: Option<Vec<f64>> = text.split(':').map(conf::finite).collect();
    let (mean, range) = match parts.as_deref() {
        Some([mean]) => (*mean, 0.0),
        Some([mean, range]) => (*mean, *range),
        _ => return Err(node.wrong(&format!("{text:?} is not `mean:range` in K"))),
    };
    if mean - 0.5 * range.abs() < 0.0 {
        return Err(node.wrong(&format!("{text:?} reaches below 0 K")));
    }
    if mean + 0.5 * range.abs() > HOTTEST_K {
        return Err(node.wrong(&format!("{text:?} reaches above {HOTTEST_K} K")));
    }
    Ok(Temperature { mean, range })
}

fn optics(name: &str, node: &Node, bands: usize) -> Result<Optics> {
    // Older files have the text itself in the place of an object that holds it.
    let value = if node.entries().is_empty() { node } else { node.need("value")? };
    let text = value.text()?;
    let parts: Vec<&str> = text.split(';').collect();
    let [front, back, through] = parts[..] else {
        let parts = counted(parts.len(), "part");
        return Err(value.wrong(&format!("{parts}, not three: `front;back;transmittance`")));
    };
    let read = |what: &str, part: &str| -> Result<Vec<f64>> {
        let values = conf::numbers(part)
            .map_err(|part| value.wrong(&format!("{part:?} is not a number")))?;
        if values.len() != bands {
            let values = counted(values.len(), "value");
            return Err(value.wrong(&format!("{what} has {values}, `sensor.bands` has {bands}")));
        }
        match values.iter().find(|&value| !(0.0..=1.0).contains(value)) {
            Some(wrong) => Err(value.wrong(&format!("{what} {wrong} is not between 0 and 1"))),
            None => Ok(values),
        }
    };
    let mut sides = Sides {
        front: read("reflectance of the front", front)?,
        back: read("reflectance of the back", back)?,
        transmittance: read("transmittance", through)?,
    };
    let mut remarks = sides.limit_sums(value)?;
    sides.remark_on(name, node, &mut remarks)?;
    Ok(Optics { surface: Surface::Lambertian(sides), remarks })
}

impl Sides {
    /// Writes the start of a material, up to its last spectrum.
    fn write(&self, text: &mut String) -> Result<()> {
        let Self { front, back, transmittance } = self;
        let is_leaf = transmittance.iter().any(|&value| value > 0.0);
        let kind = if is_leaf { "Leaf" } else { "Lambertian" };
        write!(text, "{kind}(reflectance: Bands({}), ", list(front))?;
        if is_leaf {
            write!(text, "transmittance: Bands({}), ", list(transmittance))?;
        }
        if front != back {
            write!(text, "back_reflectance: Bands({}), ", list(back))?;
        }
        Ok(())
    }

    /// Scales values whose sum is above 1 by rounding, and returns remarks on them.
    ///
    /// # Errors
    /// A sum above [`ROUNDED_SUM`].
    fn limit_sums(&mut self, node: &Node) -> Result<Vec<Remark>> {
        let Self { front, back, transmittance } = self;
        let mut remarks = Vec::new();
        for (band, t) in transmittance.iter_mut().enumerate() {
            let (r, before) = (front[band].max(back[band]), *t);
            let sum = r + before;
            if sum <= 1.0 {
                continue;
            }
            if sum > ROUNDED_SUM {
                return Err(node.wrong(&format!(
                    "reflectance {r} and transmittance {before} of band {} sum to more than 1",
                    band + 1
                )));
            }
            *t = 1.0 - r;
            let what = format!(
                "transmittance {before} of band {} taken as {t:?}: with reflectance {r} it sums to more than 1",
                band + 1
            );
            remarks.push((node.path.clone(), String::new(), what));
        }
        Ok(remarks)
    }

    fn remark_on(&self, name: &str, node: &Node, remarks: &mut Vec<Remark>) -> Result<()> {
        let mut remark = |path: &str, value: &str, what: &str| {
            remarks.push((path.to_owned(), value.to_owned(), what.to_owned()));
        };
        let path = &node.path;
        let is_dark = |side: &[f64]| side.iter().all(|&value| value <= 0.0);
        let Self { front, back, transmittance } = self;
        let kind = node.get("Type").map(Node::text).transpose()?;
        match kind.as_deref() {
            Some("0") => {
                let what = "values as stored here; LESS reads them again from its database";
                remark(path, name, what);
            }
            None | Some("1") => {}
            Some("2") => {
                remark(path, name, "values of PROSPECT as stored here, not its parameters");
            }
            Some(other) => remark(path, other, "unknown type; the values as stored"),
        }
        if name == BIRCH_LEAF && is_dark(transmittance) {
            let what = "transmittance 0 as stored here; LESS's database has 0.056 at 600 nm and \
                        0.486 at 900 nm";
            remark(path, name, what);
        }
        if let Some(prospect) = node.get("ProspectDParams") {
            let shown = match prospect.entries() {
                [] => prospect.shown(),
                all => {
                    let each = all.iter().map(|(k, v)| format!("{k} {}", v.shown()));
                    each.collect::<Vec<_>>().join(", ")
                }
            };
            let what = "not kept; `Prospect(..)` computes such spectra anew";
            remark(&prospect.path, &shown, what);
        }
        if is_dark(back) && is_dark(transmittance) && !is_dark(front) {
            let what = "black from behind, as in LESS; take out `back_reflectance` if not meant";
            remark(path, name, what);
        }
        Ok(())
    }
}

/// The error of a name that nothing among the entries of `key` has.
pub(super) fn unknown<'a>(
    what: &str,
    key: &str,
    name: &str,
    known: impl Iterator<Item = &'a String> + Clone,
) -> String {
    if let Some(near) = nearest(name, known.clone().map(String::as_str)) {
        return format!("there is no {what} {name:?} in `{key}`; the nearest is {near:?}");
    }
    let known: Vec<_> = known.take(10).map(String::as_str).collect();
    match known[..] {
        [] => format!("there is no {what} {name:?}: `{key}` has none"),
        _ => format!("there is no {what} {name:?} in `{key}`; there is {}", known.join(", ")),
    }
}
