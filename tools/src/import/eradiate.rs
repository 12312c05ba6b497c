//! Canopy scenarios of Eradiate: `scenario.json` with meshes and placements; scenes of RAMI-V come that way.
//!
//! Source: Eradiate's documentation, "Canopy scene loader", and the parameters of its `DiscreteCanopy`, `MeshTree`,
//! `LeafCloud`, `LambertianBSDF` and `RPVBSDF`.

mod spectrum;

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use sunfleck::counts::counted;

use anyhow::{Context as _, Result, bail};
use serde_json::{Map, Value};

use super::model::{Curve, Matrix, Names, Pose, surface, write_places};
use super::report::Report;
use super::scene::ImportedScene;
use super::source::{SCENARIO, SourceProgram};
use super::text::{self, quoted};

/// Largest scenario, bytes: a million matrices take some hundred megabytes.
const LARGEST: u64 = 4 << 30;

/// Wavelength of the band of a scene whose spectra are constant, nm.
const ANY_NM: f64 = 560.0;

type Object = Map<String, Value>;

/// Imports a scenario, or that of a folder, into a folder.
pub(super) fn import(path: &Path, out: &Path) -> Result<ImportedScene> {
    let file = if path.is_dir() { path.join(SCENARIO) } else { path.to_owned() };
    let text = text::whole(&file, LARGEST)?;
    let json: Value =
        serde_json::from_str(&text).with_context(|| format!("{}: is no JSON", file.display()))?;
    drop(text);
    let folder = file.parent().unwrap_or(Path::new("")).to_owned();
    let place = |error: anyhow::Error| error.context(file.display().to_string());
    let mut reader = Reader {
        folder,
        out,
        names: Names::default(),
        scene: ImportedScene::new(SourceProgram::Eradiate, "Periodic"),
        wavelengths: Vec::new(),
    };
    reader.read(&json).map_err(place)?;
    let name = std::path::absolute(&file)
        .ok()
        .and_then(|path| Some(path.parent()?.file_name()?.to_string_lossy().into_owned()));
    reader.scene.title = name.unwrap_or_else(|| "Eradiate scenario".to_owned());
    Ok(reader.scene)
}

struct Reader<'a> {
    folder: PathBuf,
    out: &'a Path,
    names: Names,
    scene: ImportedScene,
    /// Wavelengths of the first spectrum that has any, nm: the bands of the scene.
    wavelengths: Vec<f64>,
}

impl Reader<'_> {
    fn report(&self) -> &Report {
        &self.scene.report
    }

    fn read(&mut self, json: &Value) -> Result<()> {
        let scenario = object(json, "the scenario")?;
        self.leave_out(scenario, "", &["surface", "canopy"]);
        let canopy = object(needed(scenario, "canopy", "the scenario")?, "canopy")?;
        let size = numbers(needed(canopy, "size", "canopy")?, "canopy.size")?;
        let &[width, depth, _] = size.as_slice() else {
            bail!("canopy.size: expected three lengths, m, found {}", size.len());
        };
        let surface =
            scenario.get("surface").map(|surface| object(surface, "surface")).transpose()?;
        self.ground(surface)?;
        self.scene.terrain = format!("Plane(size_m: ({width:?}, {depth:?}), material: \"ground\")");
        self.report().assumed("boundary", "", "Periodic: RAMI's scenes are repeated without end");
        let known = ["type", "id", "size", "instanced_canopy_elements", "padding"];
        self.leave_out(canopy, "canopy", &known);
        if let Some(padding) = canopy.get("padding") {
            self.report().unneeded(
                "canopy.padding",
                &shown(padding),
                "a periodic scene has no end",
            );
        }
        let elements = needed(canopy, "instanced_canopy_elements", "canopy")?;
        for (index, element) in
            array(elements, "canopy.instanced_canopy_elements")?.iter().enumerate()
        {
            let at = format!("canopy.instanced_canopy_elements[{index}]");
            self.element(object(element, &at)?, &at)?;
        }
        if self.scene.meshes.is_empty() {
            bail!("it holds no canopy element that can be converted:\n{}", self.report().table());
        }
        self.bands();
        Ok(())
    }

    /// The material of the ground.
    fn ground(&mut self, surface: Option<&Object>) -> Result<()> {
        let Some(ground) = surface else {
            self.report().assumed("surface", "", "reflectance 0.5, Eradiate's default");
            self.scene.materials += "\"ground\": Lambertian(reflectance: Constant(0.5)),\n";
            return Ok(());
        };
        let bsdf = match ground.get("bsdf") {
            Some(bsdf) => object(bsdf, "surface.bsdf")?,
            None => ground,
        };
        let kind = bsdf.get("type").and_then(Value::as_str).unwrap_or("lambertian");
        let mut curve =
            |key: &str, default: f64| self.curve(bsdf, key, &format!("surface.{key}"), default);
        let text = match kind {
            "lambertian" => {
                let reflectance = curve("reflectance", 0.5)?;
                super::model::surface("ground", &reflectance, None)
            }
            "rpv" => {
                let rho0 = curve("rho_0", 0.183)?;
                let (k, g) = (curve("k", 0.780)?, curve("g", -0.1)?);
                let rho_c = match bsdf.get("rho_c") {
                    None | Some(Value::Null) => String::new(),
                    Some(_) => format!(", rho_c: {}", curve("rho_c", 0.183)?.ron()),
                };
                format!(
                    "\"ground\": Rpv(rho0: {}, k: {}, asymmetry: {}{rho_c}),\n",
                    rho0.ron(),
                    k.ron(),
                    g.ron()
                )
            }
            "black" => super::model::surface("ground", &Curve::Constant(0.0), None),
            other => bail!(
                "surface: its type is {other:?}, which has no counterpart; `lambertian`, `rpv` and `black` can be converted"
            ),
        };
        self.scene.materials += &text;
        let known = ["type", "id", "bsdf", "shape", "reflectance", "rho_0", "rho_c", "k", "g"];
        self.leave_out(bsdf, "surface", &known);
        Ok(())
    }

    fn element(&mut self, instanced: &Object, at: &str) -> Result<()> {
        self.leave_out(instanced, at, &["canopy_element", "instance_positions"]);
        let place = format!("{at}.canopy_element");
        let element = object(needed(instanced, "canopy_element", at)?, &place)?;
        let kind = element.get("type").and_then(Value::as_str).unwrap_or("mesh_tree");
        let name = element.get("id").and_then(Value::as_str).unwrap_or(kind);
        let meshes = match kind {
            "mesh_tree" => self.mesh_tree(element, name, &place)?,
            "leaf_cloud" if element.get("filename").is_some() => {
                vec![self.leaf_cloud(element, name, &place)?]
            }
            _ => {
                let what = "only `mesh_tree` and a `leaf_cloud` from a file can be converted";
                self.report().left_out(&format!("{place}.type"), kind, what);
                return Ok(());
            }
        };
        let places = array(
            needed(instanced, "instance_positions", at)?,
            &format!("{at}.instance_positions"),
        )?;
        let mut poses = Vec::with_capacity(places.len());
        let mut bent = 0_usize;
        for (index, value) in places.iter().enumerate() {
            let at = format!("{at}.instance_positions[{index}]");
            match Pose::from_matrix(&matrix(value, &at)?) {
                Some(pose) => poses.push(pose),
                None => bent += 1,
            }
        }
        if bent > 0 {
            let what = "matrices that shear, mirror, or scale x and y differently";
            self.report().left_out(&format!("{at}.instance_positions"), &bent.to_string(), what);
        }
        if poses.iter().any(|pose| pose.yaw_deg != 0.0 || pose.tilt_deg != 0.0) {
            let what = "rotations hold, as in RAMI; Eradiate itself takes the translations alone";
            self.report().differs(&format!("{at}.instance_positions"), name, what);
        }
        if poses.is_empty() {
            self.report().left_out(&place, name, "stands nowhere");
            return Ok(());
        }
        let file = format!("assets/places_{}.csv", self.names.unique(&format!("places {name}")));
        write_places(&self.out.join(&file), &poses)?;
        for mesh in meshes {
            writeln!(
                self.scene.instances,
                "Table(file: {}, of: {}),",
                quoted(&file),
                quoted(&mesh)
            )?;
        }
        Ok(())
    }

    /// Meshes of a tree, each a file with a material of its own; returns their names.
    fn mesh_tree(&mut self, tree: &Object, name: &str, at: &str) -> Result<Vec<String>> {
        self.leave_out(tree, at, &["type", "id", "mesh_tree_elements"]);
        let parts = needed(tree, "mesh_tree_elements", at)?;
        let parts = match parts {
            Value::Array(parts) => parts.iter().collect(),
            one => vec![one],
        };
        let mut meshes = Vec::new();
        for (index, part) in parts.into_iter().enumerate() {
            let at = format!("{at}.mesh_tree_elements[{index}]");
            let part = object(part, &at)?;
            let known = ["id", "mesh_filename", "mesh_units", "reflectance", "transmittance"];
            self.leave_out(part, &at, &known);
            let id = part.get("id").and_then(Value::as_str).unwrap_or("part");
            let unique = self.names.unique(&format!("{name}_{id}"));
            let source = needed(part, "mesh_filename", &at)?;
            let source =
                source.as_str().with_context(|| format!("{at}.mesh_filename: expected a path"))?;
            let ending =
                Path::new(source).extension().unwrap_or_default().to_string_lossy().to_lowercase();
            let model = match ending.as_str() {
                "ply" => "Ply",
                "obj" => "Obj",
                _ => bail!("{at}.mesh_filename: {source:?} is neither a PLY nor an OBJ file"),
            };
            let file = format!("assets/{unique}.{ending}");
            self.copy(source, &file, &at)?;
            let unit = unit_of_length(part.get("mesh_units"), &at)?;
            self.material(part, &unique, &at, ["reflectance", "transmittance"])?;
            let (mesh, file) = (quoted(&unique), quoted(&file));
            writeln!(
                self.scene.meshes,
                "{mesh}: {model}(file: {file}, up: Z, unit_m: {unit:?}, material: {mesh}),"
            )?;
            meshes.push(unique);
        }
        Ok(meshes)
    }

    /// A cloud of discs from a file of rows `r x y z nx ny nz`; returns its name.
    fn leaf_cloud(&mut self, cloud: &Object, name: &str, at: &str) -> Result<String> {
        let known =
            ["type", "id", "construct", "filename", "leaf_reflectance", "leaf_transmittance"];
        self.leave_out(cloud, at, &known);
        let unique = self.names.unique(name);
        let source = needed(cloud, "filename", at)?;
        let source = source.as_str().with_context(|| format!("{at}.filename: expected a path"))?;
        let file = format!("assets/{unique}.def");
        self.copy(source, &file, at)?;
        self.material(cloud, &unique, at, ["leaf_reflectance", "leaf_transmittance"])?;
        let (mesh, file) = (quoted(&unique), quoted(&file));
        writeln!(self.scene.meshes, "{mesh}: Discs(file: {file}, material: {mesh}),")?;
        Ok(unique)
    }

    /// Adds a material under a name, with Eradiate's defaults of what is not there.
    fn material(&mut self, part: &Object, name: &str, at: &str, keys: [&str; 2]) -> Result<()> {
        let [reflectance, transmittance] = keys;
        let reflectance = self.curve(part, reflectance, &format!("{at}.{reflectance}"), 0.5)?;
        let transmittance = match part.get(transmittance) {
            None | Some(Value::Null) => None,
            Some(_) => {
                Some(self.curve(part, transmittance, &format!("{at}.{transmittance}"), 0.0)?)
            }
        };
        self.scene.materials += &surface(name, &reflectance, transmittance.as_ref());
        Ok(())
    }

    fn curve(&mut self, owner: &Object, key: &str, at: &str, default: f64) -> Result<Curve> {
        let Some(value) = owner.get(key).filter(|value| !value.is_null()) else {
            self.report().assumed(at, "", format!("{default}, Eradiate's default"));
            return Ok(Curve::Constant(default));
        };
        let curve = spectrum::curve(value, at)?;
        if self.wavelengths.is_empty() {
            self.wavelengths = curve.wavelengths();
        }
        Ok(curve)
    }

    /// Bands at the wavelengths of the first spectrum.
    fn bands(&mut self) {
        let what = if self.wavelengths.is_empty() {
            self.wavelengths = vec![ANY_NM];
            "one at 560 nm: no spectrum has wavelengths"
        } else {
            "at the wavelengths of the first spectrum"
        };
        self.report().assumed("bands", "", what);
        let bands = self.wavelengths.iter().enumerate().map(|(index, nm)| {
            let name = quoted(&format!("b{}_{nm:.0}nm", index + 1));
            format!("(name: {name}, center_nm: {nm:?})")
        });
        self.scene.bands = bands.collect::<Vec<_>>().join(", ");
    }

    /// Copies a file that the scenario names, relative to itself.
    fn copy(&self, source: &str, file: &str, at: &str) -> Result<()> {
        let portable = source.replace('\\', "/");
        let path = self.folder.join(&portable);
        if !path.is_file() {
            bail!("{at}: there is no file {}", path.display());
        }
        fs::copy(&path, self.out.join(file))
            .with_context(|| format!("{at}: cannot copy {}", path.display()))?;
        Ok(())
    }

    /// Reports the keys that are not known.
    fn leave_out(&self, owner: &Object, at: &str, known: &[&str]) {
        for (key, value) in owner.iter().filter(|(key, _)| !known.contains(&key.as_str())) {
            let place = if at.is_empty() { key.clone() } else { format!("{at}.{key}") };
            self.report().left_out(&place, &shown(value), "has no counterpart, or is not known");
        }
    }
}

/// Length of the unit of a mesh, m.
fn unit_of_length(unit: Option<&Value>, at: &str) -> Result<f64> {
    let name = match unit {
        None | Some(Value::Null) => return Ok(1.0),
        Some(unit) => unit.as_str().unwrap_or_default(),
    };
    Ok(match name {
        "m" | "metre" | "meter" | "metres" | "meters" => 1.0,
        "cm" | "centimetre" | "centimeter" | "centimetres" | "centimeters" => 0.01,
        "mm" | "millimetre" | "millimeter" | "millimetres" | "millimeters" => 0.001,
        "km" | "kilometre" | "kilometer" | "kilometres" | "kilometers" => 1000.0,
        _ => bail!("{at}.mesh_units: {name:?} is no unit that is known; write m, cm, mm or km"),
    })
}

/// A placement: a matrix of four rows, or a place.
fn matrix(value: &Value, at: &str) -> Result<Matrix> {
    let rows = array(value, at)?;
    if rows.iter().all(Value::is_number) {
        let &[x, y, z] = numbers(value, at)?.as_slice() else {
            bail!("{at}: expected three coordinates or a matrix of 4 x 4 numbers");
        };
        return Ok([[1.0, 0.0, 0.0, x], [0.0, 1.0, 0.0, y], [0.0, 0.0, 1.0, z]]);
    }
    let mut matrix = [[0.0; 4]; 3];
    if rows.len() != 4 {
        bail!("{at}: expected a matrix of 4 x 4 numbers, found {}", counted(rows.len(), "row"));
    }
    for (row, value) in matrix.iter_mut().zip(rows) {
        let numbers = numbers(value, at)?;
        *row = numbers
            .try_into()
            .ok()
            .with_context(|| format!("{at}: expected four numbers in a row"))?;
    }
    Ok(matrix)
}

fn object<'v>(value: &'v Value, at: &str) -> Result<&'v Object> {
    value.as_object().with_context(|| format!("{at}: expected an object, found {}", shown(value)))
}

fn array<'v>(value: &'v Value, at: &str) -> Result<&'v Vec<Value>> {
    value.as_array().with_context(|| format!("{at}: expected a list, found {}", shown(value)))
}

fn needed<'v>(owner: &'v Object, key: &str, at: &str) -> Result<&'v Value> {
    owner.get(key).with_context(|| format!("{at}: has no `{key}`"))
}

/// A list of finite numbers.
fn numbers(value: &Value, at: &str) -> Result<Vec<f64>> {
    let number = |value: &Value| {
        let number = value.as_f64().filter(|number| number.is_finite());
        number.with_context(|| format!("{at}: expected a number, found {}", shown(value)))
    };
    array(value, at)?.iter().map(number).collect()
}

/// The beginning of a value as text.
fn shown(value: &Value) -> String {
    match value {
        Value::String(text) => text::excerpt(text),
        Value::Array(items) => format!("a list of {}", items.len()),
        Value::Object(keys) => format!("an object of {}", counted(keys.len(), "key")),
        other => other.to_string(),
    }
}
