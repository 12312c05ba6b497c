use std::fmt::Display;
use std::path::Path;

use glam::DVec2;
use sunfleck::assets::{
    AssetError, Import, Loaded, Raster, SpectrumColumns, SpectrumTable, StemTable, read_discs,
    read_geojson, read_gltf, read_instances, read_obj, read_ply, read_polygons, read_raster,
    read_spectrum,
};
use sunfleck::components::Mesh;
use sunfleck::document::{self, Axis, Origin, PartsBy, ReadOptions, Reading};

use super::pipeline::pipeline;

/// What a person reads, and the kinds of things in it.
pub(super) type Said = (String, Vec<String>);

/// A reader that anybody's file may come to.
#[derive(Clone, Copy, Debug)]
pub struct Reader {
    /// Name, and that of its folder of the corpus.
    pub name: &'static str,
    /// Ends of the names of its files; the first is that of what the fuzzer writes.
    pub extensions: &'static [&'static str],
    /// Other folders of the project with files for it.
    pub seeds: &'static [&'static str],
    /// Reads a file and asserts what its value promises.
    pub read: fn(&Path) -> Said,
    /// Processor time, s, that it may take for one file.
    pub most_seconds: f64,
    /// Memory that it may ask for whatever the file, bytes.
    pub free_bytes: usize,
}

/// What a reader may take for one file of the fuzzer's size.
const MOST_SECONDS: f64 = 2.0;

/// What a reader may ask for, whatever the file, bytes.
const FREE_BYTES: usize = 64 << 20;

impl Reader {
    const fn new(
        name: &'static str,
        extensions: &'static [&'static str],
        seeds: &'static [&'static str],
        read: fn(&Path) -> Said,
    ) -> Self {
        Self { name, extensions, seeds, read, most_seconds: MOST_SECONDS, free_bytes: FREE_BYTES }
    }

    /// Returns whether its files go through all of sunfleck, in processes of their own with limits.
    #[must_use]
    pub fn is_pipeline(&self) -> bool {
        self.name == PIPELINE
    }
}

/// Name of the reader that runs scenes.
const PIPELINE: &str = "pipeline";

/// All readers.
pub const READERS: [Reader; 14] = [
    Reader::new("scene", &["ron"], &["scenes", "tests/scenes", "engine/tests/language"], scene),
    Reader::new("obj", &["obj"], &["tools/tests/less"], obj),
    Reader::new("discs", &["csv", "txt"], &[], discs),
    Reader::new("envi", &["hdr"], &["tools/tests/less"], raster),
    Reader::new("ascii", &["asc"], &[], raster),
    Reader::new("geotiff", &["tif"], &[], raster),
    Reader::new("gltf", &["gltf", "glb"], &[], gltf),
    Reader::new("ply", &["ply"], &[], ply),
    Reader::new("geojson", &["geojson"], &["scenes/assets"], geojson),
    Reader::new("polygons", &["csv"], &[], polygons),
    Reader::new("instances", &["csv"], &[], instances),
    Reader::new("spectrum", &["csv", "txt", "asd"], &[], spectrum),
    Reader::new("library", &["hdr"], &[], library),
    Reader {
        most_seconds: 20.0,
        free_bytes: 1 << 30,
        ..Reader::new(PIPELINE, &["ron"], &["tests/field/70-hostile"], pipeline)
    },
];

/// The reader of this name.
#[must_use]
pub fn reader(name: &str) -> Option<&'static Reader> {
    READERS.iter().find(|reader| reader.name == name)
}

/// A scene that takes everything from the file.
const HOST: &str = r#"Scene(
    format: 1,
    include: { "a": "FILE", "b": (file: "FILE", params: { "sza": "=20 + 3" }, variant: "winter") },
    bands: [(name: "red", center_nm: 660.0)],
    materials: { "soil": Lambertian(reflectance: Constant(0.2)) },
    terrain: Plane(size_m: (10.0, 10.0), material: "soil"),
)"#;

/// Reads a scene, shows all that is wrong, writes it and reads that, formats it twice, and includes
/// it in another scene.
fn scene(path: &Path) -> Said {
    let reading = match document::read_file(path, &ReadOptions::default()) {
        Ok(reading) => reading,
        Err(error) => return said(&error.to_string()),
    };
    diagnosed(&reading);
    written(&reading);
    let text = std::fs::read_to_string(path).expect("it was read as text");
    let once = document::format("scene.ron", &text).expect("it was read as RON");
    let twice = document::format("scene.ron", &once).expect("it was written as RON");
    assert_eq!(once, twice, "a file in normal form stays as it is");
    let name = path.display().to_string();
    let formatted = document::read_text(&name, &once, &ReadOptions::default()).expect("a scene");
    assert!(same(&formatted.scene, &reading.scene), "formatting keeps all values:\n{once}");
    let file =
        path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let host = path.with_file_name("host.ron").display().to_string();
    let included =
        document::read_text(&host, &HOST.replace("FILE", &file), &ReadOptions::default());
    let included = included.expect("the host is a scene");
    diagnosed(&included);
    let shown = reading.render();
    let kinds = reading.diagnostics.iter().chain(&included.diagnostics);
    let kinds = kinds.map(|one| one.message.clone()).collect();
    (if shown.is_empty() { "a scene".to_owned() } else { shown }, kinds)
}

/// Asserts what each diagnostic promises.
fn diagnosed(reading: &Reading) {
    for one in &reading.diagnostics {
        assert!(!one.message.is_empty(), "a diagnostic says something");
        assert!(one.place.is_some() || one.path.is_root(), "a place: {}", one.message);
    }
    let shown = reading.render();
    assert!(shown.len() < 1 << 20, "{} bytes are more than anybody reads", shown.len());
}

/// Asserts that what is written is what was read.
fn written(reading: &Reading) {
    let text = reading.scene.to_ron();
    let again = document::read_text("written.ron", &text, &ReadOptions::default());
    let again = again.unwrap_or_else(|error| panic!("written as RON: {error}\n{text}"));
    assert!(same(&again.scene, &reading.scene), "written and read:\n{text}\n{}", again.render());
    if reading.is_sound() {
        let text = reading.expanded();
        let again = document::read_text("expanded.ron", &text, &ReadOptions::default());
        let again = again.unwrap_or_else(|error| panic!("expanded to RON: {error}\n{text}"));
        assert!(again.is_sound(), "expanded and sound:\n{}", again.render());
        assert!(same(&again.scene, &reading.scene.resolved()), "expanded and read:\n{text}");
    }
}

/// Whether two scenes are equal, NaN to NaN.
fn same(a: &document::Scene, b: &document::Scene) -> bool {
    a == b || format!("{a:?}") == format!("{b:?}")
}

const AS_IS: Import = Import { up: Axis::Y, unit_m: 1.0, origin: Origin::BaseCenter };

fn obj(path: &Path) -> Said {
    mesh(read_obj(path, &AS_IS, &PartsBy::Group))
}

fn gltf(path: &Path) -> Said {
    mesh(read_gltf(path, &AS_IS))
}

fn ply(path: &Path) -> Said {
    mesh(read_ply(path, &AS_IS))
}

fn discs(path: &Path) -> Said {
    mesh(read_discs(path))
}

fn mesh(read: Result<Loaded<Mesh>, AssetError>) -> Said {
    let Loaded { value, warnings } = match read {
        Ok(loaded) => loaded,
        Err(error) => return said(&error),
    };
    let (triangles, discs) = (value.triangles.len(), value.discs.len());
    let mesh = value.checked().expect("a mesh holds lawful numbers");
    let mut ends = (0, 0);
    for part in &mesh.parts {
        assert_eq!((part.triangles.start, part.discs.start), ends, "parts cover all in order");
        ends = (part.triangles.end, part.discs.end);
    }
    assert_eq!(ends, (triangles as u32, discs as u32), "parts cover all");
    let said = format!("{} parts, {triangles} triangles, {discs} discs", mesh.parts.len());
    let size = format!("{} {}", bits(mesh.parts.len()), bits(triangles + discs));
    (format!("{said}\n{}", warnings.join("\n")), warnings.into_iter().chain([size]).collect())
}

/// Writes values for any header, unless they are there: small whole numbers, then bytes that are NaN as reals.
fn write_values(path: &Path) {
    let values: Vec<u8> = (0..4096_u32).map(|i| if i < 3072 { i as u8 } else { 0xff }).collect();
    if !path.is_file() {
        std::fs::write(path, values).expect("a file of values");
    }
}

fn raster(path: &Path) -> Said {
    if path.extension().is_some_and(|extension| extension == "hdr") {
        write_values(&path.with_extension(""));
    }
    let raster = match read_raster(path, None) {
        Ok(raster) => raster,
        Err(error) => return said(&error),
    };
    let Raster { columns, rows, values, place, class_names, .. } = &raster;
    assert_eq!(values.len(), columns * rows, "a value a cell");
    assert!(values.iter().all(|value| !value.is_infinite()), "no value is infinite");
    if let Some(place) = place {
        assert!(place.cell.min_element() > 0.0 && place.corner.is_finite(), "{place:?}");
        assert!((place.corner + place.cell * raster.size_in_cells()).is_finite(), "{place:?}");
    }
    let missing = raster.missing();
    let told =
        place.as_ref().map(|place| (place.corner, place.cell, &place.crs.name, &place.crs.axes));
    let text =
        format!("{columns} x {rows} cells, {missing} without data, {class_names:?}, {told:?}");
    let unit = place.as_ref().map(|place| (&place.crs.axes, place.projection.is_some()));
    let kind = format!("{} {} {} {unit:?}", bits(*columns), bits(*rows), missing > 0);
    (text, vec![kind])
}

fn geojson(path: &Path) -> Said {
    areas(read_geojson(path).map(|areas| areas.polygons))
}

fn polygons(path: &Path) -> Said {
    areas(read_polygons(path))
}

fn areas(read: Result<Vec<sunfleck::geometry::Polygon>, AssetError>) -> Said {
    let polygons = match read {
        Ok(polygons) => polygons,
        Err(error) => return said(&error),
    };
    let corners: Vec<&DVec2> = polygons.iter().flat_map(|p| &p.rings).flatten().collect();
    assert!(corners.iter().all(|corner| corner.is_finite()), "corners are finite");
    let rings: usize = polygons.iter().map(|polygon| polygon.rings.len()).sum();
    let kind = format!("{} {} {}", bits(polygons.len()), bits(rings), bits(corners.len()));
    (format!("{} polygons, {rings} rings, {} corners", polygons.len(), corners.len()), vec![kind])
}

fn instances(path: &Path) -> Said {
    match read_instances(path, None) {
        Ok(StemTable { rows, .. }) => {
            for row in &rows {
                assert!(row.position.is_finite() && row.yaw.is_finite(), "{row:?}");
                assert!(row.scale_horizontal > 0.0 && row.scale_vertical > 0.0, "{row:?}");
            }
            (format!("{} rows", rows.len()), vec![bits(rows.len())])
        }
        Err(error) => said(&error),
    }
}

/// Reads the spectrum of an ENVI library, whose header the file is.
fn library(path: &Path) -> Said {
    let values = path.with_extension("sli");
    write_values(&values);
    spectrum(&values)
}

fn spectrum(path: &Path) -> Said {
    match read_spectrum(path, &SpectrumColumns::default()) {
        Ok(SpectrumTable { points, .. }) => {
            assert!(points.is_sorted_by(|a, b| a.wavelength < b.wavelength), "wavelengths rise");
            (format!("{} points", points.len()), vec![bits(points.len())])
        }
        Err(error) => said(&error),
    }
}

fn said(error: &impl Display) -> Said {
    let text = error.to_string();
    (text.clone(), vec![text])
}

/// How large a number is, roughly.
fn bits(number: usize) -> String {
    format!("2^{}", char::from(b'a' + (usize::BITS - number.leading_zeros()) as u8))
}
