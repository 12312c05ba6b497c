//! `brf` and `bt`: radiance images to reflectance factors and brightness temperatures.

use std::path::{Path, PathBuf};

use clap::Args;
use sunfleck::document::FileFormat;
use sunfleck::output::Results;
use sunfleck::run::{RadianceQuantity, convert_radiance};
use sunfleck::spectral::BandWindow;

use super::answer::write_answer;
use crate::arguments::Formats;

#[derive(Args, Debug)]
pub(crate) struct Brf {
    #[command(flatten)]
    images: Images,

    /// Irradiance of each band on the horizontal plane, W m⁻² nm⁻¹ [default: that of `summary.json` beside the image]
    #[arg(long, value_name = "E,..", value_delimiter = ',', value_parser = irradiance)]
    irradiance: Option<Vec<f64>>,
}

#[derive(Args, Debug)]
pub(crate) struct Bt {
    #[command(flatten)]
    images: Images,

    /// Centre and width of each band, nm [default: responses in `summary.json` beside the image]
    #[arg(long = "band", value_name = "NM:NM,..", value_delimiter = ',', value_parser = window)]
    bands: Option<Vec<BandWindow>>,
}

/// Images that are converted, and the place of the results.
#[derive(Args, Debug)]
struct Images {
    /// Radiance images of sunfleck (ENVI, `GeoTIFF`, EXR) or of LESS (ENVI)
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,

    #[command(flatten)]
    formats: Formats,

    /// Folder for the results [default: that of the first image, with `_<command>`]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Replace other results
    #[arg(long)]
    force: bool,
}

pub(super) fn brf(arguments: &Brf) -> anyhow::Result<()> {
    let quantity = RadianceQuantity::Brf { irradiance: arguments.irradiance.clone() };
    convert(&arguments.images, "brf", &quantity)
}

pub(super) fn bt(arguments: &Bt) -> anyhow::Result<()> {
    let quantity = RadianceQuantity::BrightnessTemperature { bands: arguments.bands.clone() };
    convert(&arguments.images, "bt", &quantity)
}

fn convert(
    images: &Images,
    command: &'static str,
    quantity: &RadianceQuantity,
) -> anyhow::Result<()> {
    let first = &images.files[0];
    let folder = images.out.clone().unwrap_or_else(|| beside(first, command));
    let results = Results::open(&folder, command, first, images.force)?;
    let formats = images.formats.chosen().unwrap_or_else(|| FileFormat::DEFAULT.to_vec());
    let report = convert_radiance(&images.files, quantity, &formats)?;
    write_answer(&results, &report)
}

/// Folder beside that of a file, which may be a folder of results itself.
fn beside(file: &Path, command: &str) -> PathBuf {
    let file = std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
    let folder = file.parent().unwrap_or(Path::new(""));
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    folder.with_file_name(format!("{name}_{command}"))
}

fn irradiance(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() && value > 0.0 => Ok(value),
        _ => Err("write a number above 0 for each band, such as 1.2,0.9".to_owned()),
    }
}

fn window(text: &str) -> Result<BandWindow, String> {
    let (center, width) = text.split_once(':').unwrap_or((text, "0"));
    match (center.trim().parse::<f64>(), width.trim().parse::<f64>()) {
        (Ok(center), Ok(width)) if center > 0.0 && width >= 0.0 && width < 2.0 * center => {
            Ok(BandWindow { center, width })
        }
        _ => Err("write centre and width in nm, such as 10500:1000".to_owned()),
    }
}
