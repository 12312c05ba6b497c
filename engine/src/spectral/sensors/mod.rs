//! Bands of sensors that sunfleck knows by name. Sources are in the heads of the files and in `../NOTICE`.

use std::sync::LazyLock;

use super::{BandResponse, BandWindow};

/// A band of a known sensor.
#[derive(Clone, Debug, PartialEq)]
pub struct SensorBand {
    /// Its name, such as `B8A`.
    pub name: String,
    /// Its response.
    pub response: BandResponse,
}

/// Bands of a sensor; `None` if no sensor has this name.
#[must_use]
pub fn sensor_bands(sensor: &str) -> Option<&'static [SensorBand]> {
    SENSORS.iter().find(|(name, _)| *name == sensor).map(|(_, bands)| bands.as_slice())
}

/// Names of all known sensors.
pub fn sensor_names() -> impl Iterator<Item = &'static str> {
    SENSORS.iter().map(|(name, _)| *name)
}

macro_rules! sensors {
    ($($name:literal: $file:literal;)*) => {
        /// Name and bands of each sensor; a table is read when its sensor is first asked for.
        static SENSORS: [(&str, LazyLock<Vec<SensorBand>>); [$($name),*].len()] =
            [$(($name, LazyLock::new(|| bands(include_str!($file))))),*];
    };
}

sensors! {
    "Sentinel-2A MSI": "sentinel-2a-msi.csv";
    "Sentinel-2B MSI": "sentinel-2b-msi.csv";
    "Sentinel-2C MSI": "sentinel-2c-msi.csv";
    "Landsat 5 TM": "landsat-5-tm.csv";
    "Landsat 7 ETM+": "landsat-7-etm.csv";
    "Landsat 8 OLI": "landsat-8-oli.csv";
    "Landsat 8 TIRS": "landsat-8-tirs.csv";
    "Landsat 9 OLI-2": "landsat-9-oli-2.csv";
    "Landsat 9 TIRS-2": "landsat-9-tirs-2.csv";
    "Terra MODIS": "terra-modis.csv";
    "Aqua MODIS": "aqua-modis.csv";
    "Terra ASTER": "terra-aster.csv";
    "RapidEye MSI": "rapideye-msi.csv";
    "EnMAP HSI": "enmap.csv";
    "PRISMA HYC": "prisma.csv";
}

/// Reads a table: rows `band,nm,response` of curves, `band,center_nm,fwhm_nm` of normal curves, or
/// `band,center_nm,width_nm` of windows, as its header says.
fn bands(text: &str) -> Vec<SensorBand> {
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    let header = lines.next().expect("a table has a header");
    let number = |text: &str| text.parse::<f64>().expect("the tables hold numbers");
    let rows: Vec<(&str, f64, f64)> = lines
        .map(|line| {
            let (band, numbers) = line.split_once(',').expect("rows have three columns");
            let (first, second) = numbers.split_once(',').expect("rows have three columns");
            (band, number(first), number(second))
        })
        .collect();
    let of_one = |rows: &[(&str, f64, f64)]| {
        let (name, center, width) = rows[0];
        let response = match header {
            "band,center_nm,width_nm" => BandResponse::Window(BandWindow { center, width }),
            "band,center_nm,fwhm_nm" => BandResponse::gaussian(center, width),
            _ => {
                let points = rows.iter().map(|&(_, wavelength, value)| (wavelength, value));
                BandResponse::from_points(points.collect()).expect("the tables hold responses")
            }
        };
        SensorBand { name: name.to_owned(), response }
    };
    rows.chunk_by(|a, b| a.0 == b.0).map(of_one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers of bands, and centroids that ESA, USGS and NASA publish, nm.
    #[test]
    fn the_tables_hold_the_published_bands() {
        let counts = [13, 13, 13, 7, 8, 9, 2, 9, 2, 36, 16, 15, 5, 224, 232];
        for (index, name) in sensor_names().enumerate() {
            let bands = sensor_bands(name).expect("the names are known");
            assert_eq!(bands.len(), counts[index], "{name}");
        }
        let center = |sensor: &str, band: &str| {
            let bands = sensor_bands(sensor).expect("the name is known");
            bands.iter().find(|one| one.name == band).expect("the band is known").response.center()
        };
        for (sensor, band, published, tolerance) in [
            ("Sentinel-2A MSI", "B4", 664.6, 0.1),
            ("Sentinel-2A MSI", "B8A", 864.7, 0.1),
            ("Sentinel-2B MSI", "B12", 2185.7, 0.1),
            ("Landsat 8 OLI", "B5", 864.7, 1.0),
            ("Landsat 8 TIRS", "B10", 10_895.0, 30.0),
            ("Terra MODIS", "B1", 646.5, 1.5),
            ("Terra MODIS", "B31", 11_030.0, 60.0),
        ] {
            let center = center(sensor, band);
            assert!((center - published).abs() < tolerance, "{sensor} {band}: {center}");
        }
    }

    #[test]
    fn an_unknown_name_has_no_bands() {
        assert!(sensor_bands("Sentinel-2 MSI").is_none());
    }
}
