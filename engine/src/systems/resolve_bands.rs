use hecs::World;

use super::Resources;
use super::spectra::read_columns;
use crate::document::{
    Band, BandSource, Diagnostic, Response, ScenePath, SpectrumFile, THERMAL_NM,
};
use crate::spectral::{BandResponse, BandWindow};

/// Responses of all bands, and the irradiance that reflectances and transmittances are weighted with.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BandResponses {
    responses: Vec<BandResponse>,
    /// Points (wavelength nm, W m⁻² nm⁻¹) of the sun; `None` if no band is a curve, or its irradiance has no wavelengths.
    pub(super) irradiance: Option<Vec<(f64, f64)>>,
}

impl BandResponses {
    /// Response of each band.
    #[must_use]
    pub fn all(&self) -> &[BandResponse] {
        &self.responses
    }

    /// Irradiance that fractions are weighted with.
    pub(super) fn irradiance(&self) -> Option<&[(f64, f64)]> {
        self.irradiance.as_deref()
    }
}

/// Resolves the responses of all bands. Reads the resource `bands`; writes those of the resource `responses`.
pub(super) fn resolve_bands(_: &mut World, resources: &mut Resources) {
    let bands = resources.bands.clone();
    let resolve = |(index, band): (usize, &Band)| {
        let path = ScenePath::from("bands").index(index);
        resolved(band, &path, resources).unwrap_or_else(|problem| {
            resources.report(*problem);
            // A scene with an error is not run: any response will do.
            BandResponse::Window(BandWindow { center: 550.0, width: 0.0 })
        })
    };
    let responses = bands.iter().enumerate().map(resolve).collect();
    resources.responses.responses = responses;
}

fn resolved(
    band: &Band,
    path: &ScenePath,
    resources: &mut Resources,
) -> Result<BandResponse, Box<Diagnostic>> {
    let response = match (band.known_response(path)?, &band.response) {
        (None, Response::Table(file)) => response_of_file(file, path, resources)?,
        (known, _) => known.expect("responses that are no table are known"),
    };
    let center = response.center();
    if band.source == BandSource::Auto && band.nominal_nm().is_none() && center > THERMAL_NM {
        let message = format!("band `{}` lies at {center:.0} nm", band.name);
        let help = "write `source: Emission` for what surfaces emit, or `source: Sunlight`";
        return Err(Box::new(Diagnostic::error(path, message).help(help)));
    }
    Ok(response)
}

fn response_of_file(
    source: &SpectrumFile,
    path: &ScenePath,
    resources: &mut Resources,
) -> Result<BandResponse, Box<Diagnostic>> {
    let path = path.key("response").key("file");
    let table = read_columns(source, &path, resources)?;
    let points = table.points.iter().map(|point| (point.wavelength, point.value)).collect();
    BandResponse::from_points(points).map_err(|error| {
        let message = format!("{}: column {:?}: {error}", source.file, table.value);
        let help = "correct the table: noise below 0 is written as 0";
        Box::new(Diagnostic::error(&path, message).help(help))
    })
}
