//! Names of files: from names of sensors and products, safe on every file system, and distinct.

use std::collections::HashSet;

use crate::document::FileFormat;
use crate::products::Report;

/// Longest name of a folder, bytes.
pub(super) const FOLDER_LENGTH: usize = 100;

/// Name of a folder that is safe on every file system. A hash of `identity` distinguishes names that are cut.
#[must_use]
pub fn folder_name(name: &str, identity: &str) -> String {
    let safe = |letter: char| {
        if letter.is_alphanumeric() || "-_.=,+".contains(letter) { letter } else { '_' }
    };
    let mut name: String = name.chars().map(safe).collect();
    if name.len() > FOLDER_LENGTH {
        let hash = blake3::hash(identity.as_bytes()).to_hex();
        name.truncate(name.floor_char_boundary(FOLDER_LENGTH - 17));
        name = format!("{name},{}", &hash[..16]);
    }
    name
}

/// Names for one sensor.
#[derive(Debug)]
pub(super) struct SensorNames {
    /// Key in the summary.
    pub(super) key: String,
    /// Names for its products, in order.
    pub(super) products: Vec<ProductNames>,
    /// Name of its data sets without extension.
    stem: String,
}

impl SensorNames {
    /// Name of the file or folder of its data set in a format; `None` if the format is of images alone.
    pub(super) fn dataset(&self, format: FileFormat) -> Option<String> {
        dataset_name(&self.stem, format)
    }

    /// Names of its data sets in these formats.
    pub(super) fn datasets(&self, formats: &[FileFormat]) -> impl Iterator<Item = String> {
        let asked = FileFormat::ALL.into_iter().filter(|format| formats.contains(format));
        asked.filter_map(|format| self.dataset(format))
    }
}

/// Name of the file or folder of a data set in a format; `None` if the format is of images alone.
pub(super) fn dataset_name(stem: &str, format: FileFormat) -> Option<String> {
    match format {
        FileFormat::Zarr => Some(format!("{stem}.zarr")),
        FileFormat::NetCdf => Some(format!("{stem}.nc")),
        FileFormat::Exr | FileFormat::Envi | FileFormat::GeoTiff | FileFormat::Png => None,
    }
}

/// Stems of the names of data sets.
#[derive(Debug, Default)]
pub(super) struct DatasetStems(Distinct);

impl DatasetStems {
    /// Stem for a sensor, which no other one has.
    pub(super) fn take(&mut self, sensor: &str) -> String {
        self.0.take_ignoring_case(&sanitise(sensor))
    }
}

/// Names for one product.
#[derive(Debug)]
pub(super) struct ProductNames {
    /// Key in the summary.
    pub(super) key: String,
    /// Name of its files without extension.
    pub(super) stem: String,
    /// Name of the file of an image's standard errors, without extension; `None` if it has none.
    errors: Option<String>,
}

impl ProductNames {
    pub(super) fn csv(&self) -> String {
        format!("{}.csv", self.stem)
    }

    pub(super) fn ply(&self) -> String {
        format!("{}.ply", self.stem)
    }

    /// Chart of values by direction or height.
    pub(super) fn svg(&self) -> String {
        format!("{}.svg", self.stem)
    }

    /// Picture without a legend.
    pub(super) fn bare(&self) -> String {
        format!("{}{BARE}", self.stem)
    }

    pub(super) fn exr(&self) -> String {
        format!("{}.exr", self.stem)
    }

    pub(super) fn png(&self) -> String {
        format!("{}.png", self.stem)
    }

    /// ENVI pixels.
    pub(super) fn img(&self) -> String {
        format!("{}.img", self.stem)
    }

    /// ENVI pixels of standard errors and coverage; `None` of exact values.
    pub(super) fn errors(&self) -> Option<String> {
        Some(format!("{}.img", self.errors.as_ref()?))
    }

    /// `GeoTIFF` of values, and of standard errors and coverage unless values are exact.
    pub(super) fn geotiffs(&self) -> Vec<String> {
        let stems = [Some(&self.stem), self.errors.as_ref()];
        stems.into_iter().flatten().map(|stem| format!("{stem}.tif")).collect()
    }

    /// All files of an image in these formats.
    pub(super) fn image(&self, formats: &[FileFormat]) -> Vec<String> {
        let files = |format| match format {
            FileFormat::Exr => vec![self.exr()],
            FileFormat::Envi => {
                let pixels = [Some(self.img()), self.errors()].into_iter().flatten();
                pixels.flat_map(|pixels| [pixels.clone(), header(&pixels)]).collect()
            }
            FileFormat::GeoTiff => self.geotiffs(),
            FileFormat::Png => vec![self.png(), self.bare()],
            FileFormat::Zarr | FileFormat::NetCdf => Vec::new(),
        };
        let asked = FileFormat::ALL.into_iter().filter(|format| formats.contains(format));
        asked.flat_map(files).collect()
    }
}

/// Header of ENVI pixels. It is called `x.img.hdr` and not `x.hdr`, which readers would take for the
/// header of `x.exr` and `x.png` too.
pub(super) fn header(pixels: &str) -> String {
    format!("{pixels}.hdr")
}

/// End of the name of a picture without a legend: its pixels are those of the image. No product ends so.
const BARE: &str = ".pixels.png";

/// Names for all that `report` holds, in its order.
pub(super) fn plan(report: &Report) -> Vec<SensorNames> {
    let mut stems = Distinct::default();
    let mut sensors = Distinct::default();
    let mut datasets = DatasetStems::default();
    let names = report.sensors.iter().map(|sensor| {
        let mut keys = Distinct::default();
        let products = sensor.products.iter().map(|product| {
            // Some file systems take `Nadir` and `nadir` for one name.
            let stem = format!("{}_{}", sanitise(&sensor.name), sanitise(&product.name));
            let stem = stems.take_ignoring_case(&stem);
            let has_errors = product.image.as_ref().is_some_and(|image| image.has_errors);
            let errors = has_errors.then(|| stems.take_ignoring_case(&format!("{stem}_se")));
            ProductNames { key: keys.take(&product.name), stem, errors }
        });
        SensorNames {
            key: sensors.take(&sensor.name),
            products: products.collect(),
            stem: datasets.take(&sensor.name),
        }
    });
    names.collect()
}

/// Hands out each name once; a repeated one gets a number.
#[derive(Debug, Default)]
pub(super) struct Distinct {
    taken: HashSet<String>,
}

impl Distinct {
    /// Returns true if a name was not given yet.
    pub(super) fn is_free(&self, name: &str) -> bool {
        !self.taken.contains(name)
    }

    pub(super) fn take(&mut self, name: &str) -> String {
        self.take_by(name, str::to_owned)
    }

    fn take_ignoring_case(&mut self, name: &str) -> String {
        self.take_by(name, str::to_lowercase)
    }

    fn take_by(&mut self, name: &str, identity: fn(&str) -> String) -> String {
        let mut candidate = name.to_owned();
        let mut number = 2_u64;
        while !self.taken.insert(identity(&candidate)) {
            candidate = format!("{name}_{number}");
            number += 1;
        }
        candidate
    }
}

/// `name` with letters, digits, `-` and `_` alone. It holds no dot, so it is neither hidden nor
/// `..`, and with the product's name appended it is no reserved name (`CON`) of Windows.
fn sanitise(name: &str) -> String {
    // File systems allow 255 bytes for stem, product, number and extension together.
    const LONGEST: usize = 80;
    let mut safe = String::with_capacity(name.len().min(LONGEST));
    for letter in name.chars() {
        let letter = if letter.is_alphanumeric() || letter == '-' { letter } else { '_' };
        if safe.len() + letter.len_utf8() > LONGEST {
            break;
        }
        safe.push(letter);
    }
    if safe.is_empty() { "_".to_owned() } else { safe }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn unsafe_letters_become_underscores() {
        assert_eq!(sanitise("../x"), "___x");
        assert_eq!(sanitise("a/b"), "a_b");
        assert_eq!(sanitise("C:\\x"), "C__x");
        assert_eq!(sanitise("top view.2"), "top_view_2");
        assert_eq!(sanitise("kärki-1"), "kärki-1");
        assert_eq!(sanitise(""), "_");
    }

    #[test]
    fn a_number_is_never_given_twice() {
        let mut names = Distinct::default();
        let given: Vec<_> =
            ["a", "a_2", "a", "A"].map(|name| names.take_ignoring_case(name)).into();
        assert_eq!(given, ["a", "a_2", "a_3", "A_4"]);
    }

    proptest! {
        #[test]
        fn any_name_is_safe(name in "\\PC{0,200}") {
            let safe = sanitise(&name);
            prop_assert!(!safe.is_empty() && safe.len() <= 80);
            prop_assert!(safe.chars().all(|c| c.is_alphanumeric() || c == '-' || c == '_'));
        }
    }
}
