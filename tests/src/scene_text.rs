//! Texts of scenes for tests: shared pieces, and keys that a test adds or replaces.

use std::collections::BTreeMap;
use std::fmt;
use std::fs;
use std::path::Path;

use sunfleck::document::{self, ReadOptions, Reading};
use sunfleck::products::Report;
use sunfleck::run::{Failure, Options, SceneWorld, SweepRun, Unwatched};

use crate::SheetOptics;

/// A sensor, for scenes of which nothing is measured.
const VIEW: &str = r#""view": Directions(views: List([(0.0, 0.0)]))"#;

/// Keys of a scene in the order of the language, each with the brackets around its entries.
const KEYS: [(&str, [&str; 2]); 14] = [
    ("params", ["{ ", " }"]),
    ("frame", ["(", ")"]),
    ("bands", ["[", "]"]),
    ("materials", ["{ ", " }"]),
    ("meshes", ["{ ", " }"]),
    ("terrain", ["", ""]),
    ("instances", ["[", "]"]),
    ("sun", ["(", ")"]),
    ("sky", ["", ""]),
    ("thermal_sky", ["", ""]),
    ("boundary", ["", ""]),
    ("sensors", ["{ ", " }"]),
    ("transport", ["(", ")"]),
    ("sweep", ["", ""]),
];

/// Band `a` in the red.
pub const BAND: &str = r#"(name: "a", center_nm: 660.0)"#;

/// Band `a` in the red and band `b` in the near infrared.
pub const BANDS: &str = r#"(name: "a", center_nm: 660.0), (name: "b", center_nm: 865.0)"#;

/// Material `leaf` in the red and the near infrared.
pub const LEAF: &str =
    r#""leaf": Leaf(reflectance: Bands([0.05, 0.5]), transmittance: Bands([0.03, 0.45]))"#;

/// Leaf shape of the trees of [`SceneText::two_trees`].
pub const LEAF_SHAPE: &str = "Square(side_m: 0.1)";

/// Mesh `tree`: an ellipsoidal crown of the material `leaf`, with leaves of this shape.
#[must_use]
pub fn tree(leaf_shape: &str) -> String {
    format!(
        r#""tree": Crown(shape: Ellipsoid(diameter_m: 2.0, height_m: 3.0), base_m: 0.5, leaf_area_m2: 12.0, leaf: {leaf_shape}, leaf_material: "leaf")"#
    )
}

/// Bands `b0`, `b1`, .. from 400 nm on, 1 nm apart.
#[must_use]
pub fn many_bands(count: usize) -> String {
    let band = |band| format!(r#"(name: "b{band}", center_nm: {}.0)"#, 400 + band);
    (0..count).map(band).collect::<Vec<_>>().join(", ")
}

/// Text of a scene, and of the files that it names; `Display` writes the scene file.
///
/// Values of keys are written without the outer brackets of lists, maps and records:
/// `.with("bands", BAND).with("sun", "zenith_deg: 50.0")`.
#[derive(Clone, Debug, Default)]
pub struct SceneText {
    /// Values by index in [`KEYS`].
    values: BTreeMap<usize, String>,
    /// Files beside the scene: names and contents.
    files: Vec<(String, String)>,
}

impl SceneText {
    /// Level Lambertian ground in one band, without light and sensors; `plane` has the keys of its rectangle.
    #[must_use]
    pub fn bare(reflectance: f64, plane: &str) -> Self {
        Self::default()
            .with("bands", BAND)
            .with(
                "materials",
                format!(r#""soil": Lambertian(reflectance: Constant({reflectance:?}))"#),
            )
            .with("terrain", format!(r#"Plane({plane}, material: "soil")"#))
    }

    /// Two leafy trees on a square of 5 m, one of them over its edge, in two bands, without light and sensors.
    #[must_use]
    pub fn two_trees() -> Self {
        Self::bare(0.0, "size_m: (5.0, 5.0)")
            .with("bands", BANDS)
            .with(
                "materials",
                format!(r#""soil": Lambertian(reflectance: Bands([0.1, 0.3])), {LEAF}"#),
            )
            .with_two_trees(LEAF_SHAPE)
    }

    /// [`SceneText::two_trees`] under sun and sky.
    #[must_use]
    pub fn trees_in_daylight(boundary: &str) -> Self {
        Self::two_trees()
            .with("sun", "zenith_deg: 50.0, azimuth_deg: 10.0, irradiance: Constant(1.0)")
            .with("sky", "Fraction([0.3, 0.1])")
            .with("boundary", boundary)
    }

    /// Horizontal sheets of leaf at these heights over soil, wider than the tile that repeats, under the sun, in one
    /// band for each of these optics.
    #[must_use]
    pub fn sheets(optics: &[SheetOptics], heights_m: &[f64]) -> Self {
        let spectrum = |of: fn(&SheetOptics) -> f64| optics.iter().map(of).collect::<Vec<_>>();
        let [r, t, s] = [spectrum(|one| one.0), spectrum(|one| one.1), spectrum(|one| one.2)];
        let at: Vec<_> = heights_m.iter().map(|height| (4.0, 4.0, *height)).collect();
        Self::bare(0.0, "size_m: (8.0, 8.0)")
            .with("bands", many_bands(optics.len()))
            .with("materials", format!(r#""soil": Lambertian(reflectance: Bands({s:?})), "leaf": Leaf(reflectance: Bands({r:?}), transmittance: Bands({t:?}))"#))
            .with("meshes", r#""sheet": Faces(faces_m: [[(-10.0, -10.0, 0.0), (10.0, -10.0, 0.0), (10.0, 10.0, 0.0), (-10.0, 10.0, 0.0)]], material: "leaf")"#)
            .with("instances", format!(r#"List(of: "sheet", at_m: {at:?})"#))
            .with("sun", "zenith_deg: 35.0, azimuth_deg: 10.0, irradiance: Constant(1.0)")
            .with("boundary", "Periodic")
    }

    /// Sets a key, in place of the value that it had.
    #[must_use]
    pub fn with(mut self, key: &str, value: impl Into<String>) -> Self {
        self.values.insert(index(key), value.into());
        self
    }

    /// Adds entries at the end of a list or map.
    #[must_use]
    pub fn with_more(mut self, key: &str, entries: impl Into<String>) -> Self {
        let value = self.values.entry(index(key)).or_default();
        if !value.is_empty() {
            value.push_str(", ");
        }
        value.push_str(&entries.into());
        self
    }

    /// Adds the material `leaf`, alike in all bands.
    #[must_use]
    pub fn with_leaf(self, reflectance: f64, transmittance: f64) -> Self {
        let optics = format!(
            "reflectance: Constant({reflectance:?}), transmittance: Constant({transmittance:?})"
        );
        self.with_more("materials", format!(r#""leaf": Leaf({optics})"#))
    }

    /// Adds the trees of [`SceneText::two_trees`], with leaves of another shape.
    #[must_use]
    pub fn with_two_trees(self, leaf_shape: &str) -> Self {
        self.with_more("meshes", tree(leaf_shape))
            .with_more("instances", r#"List(of: "tree", at_m: [(0.2, 2.0, 0.0), (3.0, 4.9, 0.0)])"#)
    }

    /// Adds a mesh of one material that is read from an OBJ file of this text.
    #[must_use]
    pub fn with_obj(self, name: &str, material: &str, obj: &str) -> Self {
        let mesh = format!(
            r#""{name}": Obj(file: "{name}.obj", up: Z, unit_m: 1.0, material: Some("{material}"))"#
        );
        self.with_more("meshes", mesh).with_file(&format!("{name}.obj"), obj)
    }

    /// Adds a mesh of discs of one material; a line of the table has radius, centre and normal of one of them.
    #[must_use]
    pub fn with_discs(self, name: &str, material: &str, table: &str) -> Self {
        let mesh = format!(r#""{name}": Discs(file: "{name}.csv", material: "{material}")"#);
        let table = format!("radius,x,y,z,nx,ny,nz\n{}\n", table.trim_end());
        self.with_more("meshes", mesh).with_file(&format!("{name}.csv"), &table)
    }

    /// Adds a file beside the scene.
    #[must_use]
    pub fn with_file(mut self, name: &str, text: &str) -> Self {
        self.files.push((name.to_owned(), text.to_owned()));
        self
    }

    /// Reads the scene.
    ///
    /// # Panics
    /// If the text is no scene at all; errors in it are diagnostics of the result.
    #[must_use]
    pub fn read(&self) -> Reading {
        document::read_text("test.ron", &self.to_string(), &ReadOptions::default())
            .unwrap_or_else(|error| panic!("{error}"))
    }

    /// Runs the scene.
    ///
    /// # Panics
    /// If the scene is wrong: the message is what its author would read.
    #[must_use]
    pub fn measure(&self) -> Report {
        self.measure_with(&Options::default())
    }

    /// Runs the scene with options.
    ///
    /// # Panics
    /// If the scene is wrong: the message is what its author would read.
    #[must_use]
    pub fn measure_with(&self, options: &Options) -> Report {
        if self.files.is_empty() {
            return crate::measure(&self.to_string(), Path::new("."), options);
        }
        crate::measure(&self.to_string(), self.written_files().path(), options)
    }

    /// Makes the world of the scene; it has a sun and a sensor if the text has none.
    ///
    /// # Panics
    /// If the scene is wrong: the message is what its author would read.
    #[must_use]
    pub fn world(&self) -> SceneWorld {
        let mut text = self.clone();
        for (key, value) in [("sun", "zenith_deg: 30.0"), ("sensors", VIEW)] {
            text.values.entry(index(key)).or_insert_with(|| value.to_owned());
        }
        let reading = text.read();
        assert!(reading.is_sound(), "{}", reading.render());
        let folder = self.written_files();
        SceneWorld::from_scene(&reading.scene, folder.path())
            .unwrap_or_else(|problems| panic!("{}", reading.source.render(&problems)))
    }

    /// A folder that holds the files beside the scene.
    fn written_files(&self) -> tempfile::TempDir {
        let folder = tempfile::tempdir().expect("a temporary folder");
        for (name, text) in &self.files {
            fs::write(folder.path().join(name), text).expect("a file");
        }
        folder
    }
}

impl SceneText {
    /// Runs the scene at all points of its sweep; returns the groups that were traced on the same paths, and the reports of
    /// all points in their order.
    ///
    /// # Panics
    /// If the scene is wrong: the message is what its author would read.
    #[must_use]
    pub fn sweep(&self) -> (Vec<Vec<usize>>, Vec<Report>) {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = folder.path().join("test.ron");
        fs::write(&file, self.to_string()).expect("a file");
        let mut sweep = SweepRun::read(&file, &Options::default(), &Unwatched)
            .unwrap_or_else(|failure| panic!("{failure}"));
        let groups = sweep.groups().to_vec();
        let mut reports: Vec<Option<Report>> = sweep.points().iter().map(|_| None).collect();
        for (group, places) in groups.iter().enumerate() {
            let run = sweep.run(group, &Unwatched, |part, found| {
                for (&place, report) in places[part].iter().zip(found) {
                    reports[place] = Some(report);
                }
                Ok::<_, Failure>(())
            });
            run.unwrap_or_else(|failure| panic!("{failure}"));
        }
        (
            groups,
            reports.into_iter().map(|report| report.expect("a report of each point")).collect(),
        )
    }
}

impl fmt::Display for SceneText {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "Scene(\n    format: 1,")?;
        for (&index, value) in &self.values {
            let (key, [open, close]) = KEYS[index];
            writeln!(f, "    {key}: {open}{value}{close},")?;
        }
        f.write_str(")")
    }
}

fn index(key: &str) -> usize {
    KEYS.iter().position(|(name, _)| *name == key).unwrap_or_else(|| panic!("no key `{key}`"))
}
