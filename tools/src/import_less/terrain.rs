//! The ground.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use anyhow::{Context as _, Result, bail};

use super::conf::Node;
use super::objects::Obj;
use super::text::{self, quoted};
use super::{Project, Section};

/// An ENVI header is not larger, bytes.
const LARGEST_HEADER: u64 = 1 << 20;

/// The ground that a project has where it says no more.
const FLAT: &str = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n0 0\n0 0\n";

impl Project {
    /// Extent of the scene to the east and to the south, m.
    pub(super) fn extent(scene: &Node) -> Result<(f64, f64)> {
        let terrain = scene.need("terrain")?;
        let side = |key| {
            let node = terrain.need(key)?;
            let side = node.number()?;
            if side > 0.0 { Ok(side) } else { Err(node.wrong(&format!("{side} m is no extent"))) }
        };
        Ok((side("extent_width")?, side("extent_height")?))
    }

    /// The scene's `terrain`, and the mesh that it may need.
    pub(super) fn terrain_ron(&mut self) -> Result<Section> {
        let terrain = self.conf.need("scene")?.need("terrain")?;
        let temperature = match terrain.get("temperature") {
            Some(node) => Some(node.text()?).filter(|name| !name.is_empty()),
            None => None,
        };
        let wear = |materials: &mut super::optics::Materials, optics: &str, place: &str| {
            materials.wear(optics, temperature.as_deref()).with_context(|| place.to_owned())
        };
        let optical = terrain.get("optical").with_context(|| {
            format!(
                "{}: there is no `scene.terrain.optical`: name an optical property",
                terrain.place
            )
        })?;
        let material = wear(&mut self.materials, &optical.text()?, &optical.place)?;
        if let Some(model) = terrain.get("terrBRDFType") {
            let name = model.text()?;
            if name != "Lambertian" {
                let what = format!(
                    "no equal in sunfleck: Lambertian, of the optical property {material:?}"
                );
                self.report.add(&model.path, &name, what);
            }
        }
        for key in ["soilSpectParams", "landalbedo"] {
            if let Some(node) = terrain.get(key) {
                self.report.add(&node.path, &node.shown(), "not imported: see `terrBRDFType`");
                node.settle();
            }
        }
        let kind = terrain.need("terrain_type")?;
        let name = kind.text()?;
        let file =
            terrain.get("terr_file").map(Node::text).transpose()?.filter(|file| !file.is_empty());
        let (width, height) = self.size;
        let cover = self.land_cover(name == "MESH", temperature.as_deref())?;
        let terrain = self.conf.need("scene")?.need("terrain")?;
        let kind = terrain.need("terrain_type")?;
        let wears = cover.clone().unwrap_or(format!("material: {},\n", quoted(&material)));
        let stretched = |file: &str| {
            format!(
                "terrain: Raster(\nfile: {},\n{wears}coordinates: Metres,\n\
                 corner_m: (0.0, 0.0),\nsize_m: ({width:?}, {height:?}),\n\
                 lowest_m: 0.0,\n),\n",
                quoted(file)
            )
        };
        let mut section = Section::default();
        match name.as_str() {
            "PLANE" if cover.is_some() => {
                // Classes need a raster of heights to lie on.
                self.write("assets/plane.asc", FLAT)?;
                section.terrain = stretched("assets/plane.asc");
            }
            "PLANE" => {
                let material = quoted(&material);
                section.terrain = format!(
                    "terrain: Plane(size_m: ({width:?}, {height:?}), material: {material}),\n"
                );
            }
            "RASTER" => {
                let file =
                    file.with_context(|| kind.wrong("there is no `terr_file`").to_string())?;
                let place = terrain.need("terr_file")?;
                let copy = self.copy_envi(&file).with_context(|| place.place.clone())?;
                let what =
                    "stretched over the extent as in LESS, heights at the cells' own centres";
                self.report.add(&place.path, &file, what);
                section.terrain = stretched(&copy);
            }
            "MESH" => {
                let file =
                    file.with_context(|| kind.wrong("there is no `terr_file`").to_string())?;
                let place = terrain.need("terr_file")?;
                let mut obj = Obj::create(&self.out.join("assets/terrain.obj"))?;
                obj.append("terrain", &self.parameters.join(&file))
                    .with_context(|| place.place.clone())?;
                obj.finish()?;
                let (x, y) = (0.5 * width, 0.5 * height);
                let mut mesh = self.mesh_name("terrain");
                while self.conf.at(&["scene", "optical_properties", &mesh]).is_some() {
                    mesh += "_mesh";
                }
                let material = quoted(&material);
                writeln!(
                    section.meshes,
                    "{}: Obj(file: \"assets/terrain.obj\", up: Z, unit_m: 1.0, material: {material}),",
                    quoted(&mesh)
                )?;
                section.terrain =
                    format!("terrain: Mesh(mesh: {}, at_m: ({x:?}, {y:?}, 0.0)),\n", quoted(&mesh));
            }
            other => {
                let what = format!("{other:?} is none of PLANE, RASTER and MESH");
                return Err(kind.wrong(&what));
            }
        }
        Ok(section)
    }

    /// `land_cover` of the ground, if the project has classes.
    fn land_cover(&mut self, is_mesh: bool, temperature: Option<&str>) -> Result<Option<String>> {
        let terrain = self.conf.need("scene")?.need("terrain")?;
        let cover = match terrain.get("landcover") {
            Some(node) if is_mesh => {
                self.report.add(&node.path, &node.shown(), "not imported: a mesh has no classes");
                node.settle();
                None
            }
            Some(node) if !["false", ""].contains(&node.text()?.as_str()) => Some(node),
            _ => None,
        };
        match cover {
            Some(node) => {
                let named = node.text()?;
                let named = if named == "true" { "landcover" } else { named.as_str() };
                let file = self.copy_envi(named).with_context(|| node.place.clone())?;
                let mut classes = Vec::new();
                let list = self.parameters.join("landcover.txt");
                let materials = &mut self.materials;
                text::lines(&list, |line| {
                    let Some((class, optics)) = line.split_once(char::is_whitespace) else {
                        bail!("not `class property`: {:?}", text::excerpt(line));
                    };
                    let material = materials.wear(optics.trim(), temperature)?;
                    classes.push(format!("{}: {}", quoted(class), quoted(&material)));
                    Ok(())
                })?;
                let what = "imported; LESS 1.8.8 itself failed on land cover";
                self.report.add(&node.path, &node.shown(), what);
                let classes = classes.join(", ");
                Ok(Some(format!(
                    "land_cover: (file: {}, classes: {{ {classes} }}),\n",
                    quoted(&file)
                )))
            }
            None => Ok(None),
        }
    }

    /// Copies an ENVI raster, without what says where on Earth it lies: LESS lays it over the scene.
    fn copy_envi(&self, name: &str) -> Result<String> {
        let from = self.parameters.join(name);
        if !from.is_file() {
            bail!("there is no file {}", from.display());
        }
        let mut appended = from.clone().into_os_string();
        appended.push(".hdr");
        let headers = [Path::new(&appended).to_owned(), from.with_extension("hdr")];
        let header = headers.iter().find(|header| header.is_file() && **header != from);
        let header =
            header.with_context(|| format!("{} has no ENVI header (.hdr)", from.display()))?;
        let stem = text::file_name(&from.file_stem().unwrap_or_default().to_string_lossy());
        let copy = format!("assets/{stem}.img");
        fs::copy(&from, self.out.join(&copy))
            .with_context(|| format!("cannot copy {}", from.display()))?;
        let located = ["map info", "coordinate system string", "projection info"];
        let mut is_left_out = false;
        let mut kept = String::new();
        for line in text::whole(header, LARGEST_HEADER)?.lines() {
            let key = line.split('=').next().unwrap_or_default().trim().to_ascii_lowercase();
            is_left_out |= located.contains(&key.as_str());
            if !is_left_out {
                kept.extend([line, "\n"]);
            }
            // Values in braces may go over several lines.
            is_left_out &= line.contains('{') | !line.contains('=') && !line.contains('}');
        }
        self.write(&format!("assets/{stem}.hdr"), &kept)?;
        Ok(copy)
    }
}
