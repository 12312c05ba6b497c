//! The ground.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use anyhow::{Context as _, Result, bail};

use super::conf::Node;
use super::objects::Obj;
use super::project::{Project, Section};
use super::settings::Choice;
use super::soil::Soil;
use super::text::{self, quoted};

/// Largest ENVI header, bytes.
const LARGEST_HEADER: u64 = 1 << 20;

/// Heights of a flat ground with classes.
const FLAT: &str = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n0 0\n0 0\n";

/// Optical property of the ground of a new project.
const USUAL_SOIL: &str = "dark_soil_mollisol";

/// Types of terrain.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Ground {
    Plane,
    Raster,
    Mesh,
}

/// Reflection models of the ground.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Brdf {
    Lambertian,
    Soilspect,
    AlbedoMap,
}

impl Project {
    fn terrain(&self) -> Result<&Node> {
        self.conf.need("scene")?.need("terrain")
    }

    /// The type of the ground; a plane where a file is needed and none is named.
    fn ground(&self) -> Result<Ground> {
        let terrain = self.terrain()?;
        let choices =
            [("PLANE", Ground::Plane), ("RASTER", Ground::Raster), ("MESH", Ground::Mesh)];
        let choice = Choice { choices: &choices, may_be_absent: false };
        let ground = choice.read(terrain, "terrain_type", &self.report)?;
        let key = "terr_file";
        match terrain.get(key) {
            None if ground != Ground::Plane => {
                let what = "a plane: the terrain needs a file, and none is named";
                self.report.differs(&terrain.path_of(key), terrain.lack_of(key), what);
                Ok(Ground::Plane)
            }
            Some(file) if ground == Ground::Plane => {
                self.report.unneeded(&file.path, &file.shown(), "a plane has no file");
                file.settle();
                Ok(ground)
            }
            _ => Ok(ground),
        }
    }

    /// Returns true if the ground is a plane at height 0.
    pub(super) fn is_flat(&self) -> Result<bool> {
        Ok(self.ground()? == Ground::Plane)
    }

    /// The scene's `terrain`, and the mesh that it may need.
    pub(super) fn terrain_ron(&mut self) -> Result<Section> {
        let ground = self.ground()?;
        let temperature = match self.terrain()?.get("temperature") {
            Some(node) => Some(node.text()?),
            None => None,
        };
        let (width, height) = self.size;
        let mut section = Section::default();
        if let Some(cover) = self.land_cover(ground, temperature.as_deref())? {
            let file = match ground {
                Ground::Raster => self.heights()?,
                Ground::Plane | Ground::Mesh => {
                    // Classes need a raster of heights to lie on.
                    let name = self.asset_name("plane");
                    self.write(&format!("assets/{name}.asc"), FLAT)?;
                    format!("assets/{name}.asc")
                }
            };
            section.terrain = self.stretched(&file, &cover);
            return Ok(section);
        }
        let material = quoted(&self.soil_material(ground, temperature.as_deref())?);
        match ground {
            Ground::Plane => {
                section.terrain = format!(
                    "terrain: Plane(size_m: ({width:?}, {height:?}), material: {material}),\n"
                );
            }
            Ground::Raster => {
                let file = self.heights()?;
                section.terrain = self.stretched(&file, &format!("material: {material},\n"));
            }
            Ground::Mesh => self.ground_mesh(&material, &mut section)?,
        }
        Ok(section)
    }

    /// A raster laid over the whole extent.
    fn stretched(&self, file: &str, surface: &str) -> String {
        let (width, height) = self.size;
        format!(
            "terrain: Raster(\nfile: {},\n{surface}coordinates: Metres,\n\
             corner_m: (0.0, 0.0),\nsize_m: ({width:?}, {height:?}),\nlowest_m: 0.0,\n),\n",
            quoted(file)
        )
    }

    /// Copies the raster of heights, and returns its name beside the scene.
    fn heights(&mut self) -> Result<String> {
        let node = self.terrain()?.need("terr_file")?;
        let (file, place) = (node.text()?, format!("{}: {}", node.place, node.path));
        let what = "stretched over the extent as in LESS, heights at the cells' own centres";
        self.report.differs(&node.path, &file, what);
        self.copy_raster(&file).context(place)
    }

    fn ground_mesh(&mut self, material: &str, section: &mut Section) -> Result<()> {
        let node = self.terrain()?.need("terr_file")?;
        let (file, place) = (node.text()?, format!("{}: {}", node.place, node.path));
        let path = self.locate(&file).with_context(|| place.clone())?;
        let name = self.asset_name("terrain");
        let mut obj = Obj::create(&self.out.join(format!("assets/{name}.obj")))?;
        obj.append("terrain", &path).context(place)?;
        obj.finish()?;
        let (x, y) = (0.5 * self.size.0, 0.5 * self.size.1);
        writeln!(
            section.meshes,
            "{}: Obj(file: \"assets/{name}.obj\", up: Z, unit_m: 1.0, material: {material}),",
            quoted(GROUND)
        )?;
        section.terrain =
            format!("terrain: Mesh(mesh: {}, at_m: ({x:?}, {y:?}, 0.0)),\n", quoted(GROUND));
        Ok(())
    }

    /// The material of a ground that has one.
    fn soil_material(&mut self, ground: Ground, temperature: Option<&str>) -> Result<String> {
        let place = self.terrain()?.place.clone();
        let optics = match self.brdf()? {
            Brdf::Lambertian => self.usual_optics()?,
            Brdf::AlbedoMap => self.albedo_stand_in()?,
            Brdf::Soilspect => self.soilspect(ground)?,
        };
        let place = self.terrain()?.get("optical").map_or(place, |node| node.place.clone());
        self.materials
            .surface_material(&optics, temperature)
            .with_context(|| format!("{place}: scene.terrain.optical"))
    }

    /// The reflection model. Maps of albedo have had several names.
    fn brdf(&self) -> Result<Brdf> {
        let terrain = self.terrain()?;
        let choices = [
            ("Lambertian", Brdf::Lambertian),
            ("Soilspect", Brdf::Soilspect),
            ("Land Albedo Map", Brdf::AlbedoMap),
            ("LandAlbedoMap", Brdf::AlbedoMap),
            ("landalbedo", Brdf::AlbedoMap),
        ];
        let choice = Choice { choices: &choices, may_be_absent: true };
        let brdf = choice.read(terrain, "terrBRDFType", &self.report)?;
        for (key, own) in [("soilSpectParams", Brdf::Soilspect), ("landalbedo", Brdf::AlbedoMap)] {
            if let Some(node) = terrain.get(key).filter(|_| brdf != own) {
                self.report.unneeded(&node.path, &node.shown(), "`terrBRDFType` is another one");
                node.settle();
            }
        }
        Ok(brdf)
    }

    fn usual_optics(&self) -> Result<String> {
        let terrain = self.terrain()?;
        if let Some(node) = terrain.get("optical") {
            return node.text();
        }
        if !self.materials.has(USUAL_SOIL) {
            terrain.need("optical").context("the ground has no optical property")?;
        }
        let lack = terrain.lack_of("optical");
        self.report.assumed("scene.terrain.optical", lack, format!("{USUAL_SOIL}, as LESS has it"));
        Ok(USUAL_SOIL.to_owned())
    }

    /// The unit and the bands of a map of albedos are not known: the optical property of the ground stands in for it.
    fn albedo_stand_in(&self) -> Result<String> {
        let optics = self.usual_optics()?;
        let shown = match self.terrain()?.get("landalbedo") {
            Some(node) => {
                node.settle();
                node.shown()
            }
            None => String::new(),
        };
        let what = format!(
            "STAND-IN: {optics:?} covers all of the ground; write the map as a `ReflectanceMap`"
        );
        self.report.differs("scene.terrain.landalbedo", &shown, what);
        Ok(optics)
    }

    /// Reads the SOILSPECT parameters, and returns the name of their optical property.
    fn soilspect(&mut self, ground: Ground) -> Result<String> {
        self.conf.ensure_object(&["scene", "terrain", "soilSpectParams"])?;
        let terrain = self.terrain()?;
        let soil = Soil::read(terrain, self.bands.len(), &self.report)?;
        for key in ["optical", "soilSpectParams"] {
            if let Some(node) = terrain.get(key) {
                node.settle();
            }
        }
        if ground == Ground::Mesh {
            let what = "reflects on both sides of the mesh; in LESS on the front side only";
            self.report.differs("scene.terrain.terrBRDFType", "Soilspect", what);
        }
        Ok(self.materials.add_soil(soil))
    }

    /// `land_cover` of the ground, if the project has classes.
    fn land_cover(&mut self, ground: Ground, temperature: Option<&str>) -> Result<Option<String>> {
        let terrain = self.terrain()?;
        let Some(node) = terrain.get("landcover") else { return Ok(None) };
        let named = node.text()?;
        if named.eq_ignore_ascii_case("false") {
            return Ok(None);
        }
        if ground == Ground::Mesh {
            self.report.left_out(&node.path, &node.shown(), "a mesh has no classes");
            return Ok(None);
        }
        let place = format!("{}: {}", node.place, node.path);
        self.report.differs(&node.path, &node.shown(), "imported; LESS 1.8.8 itself failed on it");
        for key in ["optical", "terrBRDFType", "soilSpectParams", "landalbedo"] {
            if let Some(node) = terrain.get(key) {
                self.report.unneeded(&node.path, &node.shown(), "classes are given in its place");
                node.settle();
            }
        }
        let named = if named.eq_ignore_ascii_case("true") { "landcover" } else { named.as_str() };
        let file = self.copy_raster(named).with_context(|| place.clone())?;
        let list = self.locate("landcover.txt").context(place)?;
        let mut classes = Vec::new();
        let materials = &mut self.materials;
        text::lines(&list, |line| {
            let Some((class, optics)) = line.split_once(char::is_whitespace) else {
                bail!("not `class property`: {:?}", text::excerpt(line));
            };
            let material = materials.surface_material(optics.trim(), temperature)?;
            classes.push(format!("{}: {}", quoted(class), quoted(&material)));
            Ok(())
        })?;
        let classes = classes.join(", ");
        Ok(Some(format!("land_cover: (file: {}, classes: {{ {classes} }}),\n", quoted(&file))))
    }

    /// Copies a raster, and of ENVI's its header without what says where on Earth it lies: LESS lays
    /// it over the scene.
    fn copy_raster(&mut self, name: &str) -> Result<String> {
        let from = self.locate(name)?;
        let stem = from.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let stem = self.asset_name(&stem);
        let extension = from.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        let is_envi = !["tif", "tiff", "asc"].contains(&extension.as_str());
        let copy = format!("assets/{stem}.{}", if is_envi { "img" } else { &extension });
        fs::copy(&from, self.out.join(&copy))
            .with_context(|| format!("cannot copy {}", from.display()))?;
        if is_envi {
            let header = without_location(&text::whole_lossy(&header_of(&from)?, LARGEST_HEADER)?);
            self.write(&format!("assets/{stem}.hdr"), &header)?;
        }
        Ok(copy)
    }
}

/// Name of the mesh of the ground; objects of LESS have no spaces in their names.
const GROUND: &str = "the ground";

/// The header of an ENVI raster.
fn header_of(raster: &Path) -> Result<std::path::PathBuf> {
    let mut appended = raster.to_owned().into_os_string();
    appended.push(".hdr");
    let candidates = [Path::new(&appended).to_owned(), raster.with_extension("hdr")];
    let header = candidates.into_iter().find(|header| header.is_file() && header != raster);
    header.with_context(|| format!("{} has no ENVI header (.hdr)", raster.display()))
}

/// The text of a header without its georeference.
fn without_location(text: &str) -> String {
    let located = ["map info", "coordinate system string", "projection info"];
    let mut is_left_out = false;
    let mut kept = String::new();
    for line in text.lines() {
        let key = line.split('=').next().unwrap_or_default().trim().to_ascii_lowercase();
        is_left_out |= located.contains(&key.as_str());
        if !is_left_out {
            kept.extend([line, "\n"]);
        }
        // Values in braces may go over several lines.
        let ends = line.contains('}') || line.contains('=') && !line.contains('{');
        is_left_out &= !ends;
    }
    kept
}
