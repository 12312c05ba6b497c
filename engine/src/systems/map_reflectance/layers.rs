use crate::assets::{BandDescription, LayerTerm};
use crate::counts::counted;
use crate::document::{Diagnostic, Param, RasterBands, ReflectanceMap, ScenePath, suggestion};
use crate::spectral::BandResponse;
use crate::systems::Resources;

/// Layers of a map, and the layer of each band of the scene.
pub(super) struct MapLayers {
    /// Bands of the raster that the layers are made of.
    pub(super) terms: Vec<LayerTerm>,
    /// Layer of each band of the scene.
    pub(super) of_bands: Vec<u32>,
    /// Reflectance elsewhere, by layer.
    pub(super) elsewhere: Option<Vec<f32>>,
}

/// Values of a layer, which bands of the scene can share.
#[derive(PartialEq)]
struct DistinctLayer<'s> {
    /// Bands of the raster and factors on them.
    sum: &'s [(usize, f64)],
    elsewhere: Option<f32>,
}

/// Part of the weights of a band that a band of the raster may be without, as their sum is 1.
const NEGLIGIBLE: f64 = 1e-9;

/// Chooses the bands of a raster that the bands of the scene have their reflectance from. Bands of the scene share a layer
/// if all their values are the same.
pub(super) fn choose_layers(
    map: &ReflectanceMap,
    raster: &[BandDescription],
    elsewhere: Option<&[f64]>,
    path: &ScenePath,
    resources: &mut Resources,
) -> Option<MapLayers> {
    let path = path.key("bands");
    let names: Vec<String> = resources.bands.iter().map(|band| band.name.clone()).collect();
    let sums: Vec<Vec<(usize, f64)>> = match &map.bands {
        RasterBands::All(band) => {
            let band = band_of(band, raster, &path, resources)?;
            vec![vec![(band, 1.0)]; names.len()]
        }
        RasterBands::Each(bands) => {
            let of_name = |name: &String| {
                let band =
                    bands.get(name).expect("`document::check` knows that each band is there");
                Some(vec![(band_of(band, raster, &path.name(name), resources)?, 1.0)])
            };
            // All bands that are unknown are reported.
            let sums: Vec<_> = names.iter().map(of_name).collect();
            sums.into_iter().collect::<Option<_>>()?
        }
        RasterBands::Wavelengths => by_wavelength(raster, &path, resources)?,
    };
    let value = |band: usize| elsewhere.map(|values| values[band] as f32);
    let mut distinct: Vec<DistinctLayer<'_>> = Vec::new();
    let mut of_bands = Vec::new();
    for (band, sum) in sums.iter().enumerate() {
        let layer = DistinctLayer { sum, elsewhere: value(band) };
        let place = distinct.iter().position(|known| *known == layer).unwrap_or_else(|| {
            distinct.push(layer);
            distinct.len() - 1
        });
        of_bands.push(place as u32);
    }
    let terms = distinct.iter().enumerate().flat_map(|(layer, DistinctLayer { sum, .. })| {
        sum.iter().map(move |&(band, factor)| LayerTerm { layer, band, factor })
    });
    let terms = terms.collect();
    let elsewhere = distinct.iter().map(|layer| layer.elsewhere).collect();
    Some(MapLayers { terms, of_bands, elsewhere })
}

/// Band of a raster that the scene names; `None` after an error.
fn band_of(
    band: &Param,
    raster: &[BandDescription],
    path: &ScenePath,
    resources: &mut Resources,
) -> Option<usize> {
    let count = counted(raster.len(), "band");
    let name = match band {
        Param::Number(number) => {
            // `document::check` takes whole numbers from 1 alone.
            let index = *number as usize - 1;
            if index >= raster.len() {
                let message = format!("the raster has {count}, and no band {number}");
                resources.report(Diagnostic::error(path, message));
                return None;
            }
            return Some(index);
        }
        Param::Text(name) => name,
    };
    let is_named = |index: &usize| raster[*index].name.as_deref() == Some(name);
    let mut named = (0..raster.len()).filter(is_named);
    match (named.next(), named.next()) {
        (Some(index), None) => return Some(index),
        (Some(first), Some(second)) => {
            let (first, second) = (first + 1, second + 1);
            let message =
                format!("bands {first} and {second} of the raster are both called `{name}`");
            let help = "name the band by its number, from 1";
            resources.report(Diagnostic::error(path, message).help(help));
        }
        (None, _) => {
            let known: Vec<&str> = raster.iter().filter_map(|band| band.name.as_deref()).collect();
            let problem = if known.is_empty() {
                let message = format!("the raster has {count} without names, and none `{name}`");
                Diagnostic::error(path, message).help("name the band by its number, from 1")
            } else {
                let message = format!("the raster has no band `{name}`");
                Diagnostic::error(path, message).help(suggestion(name, &known, "its bands"))
            };
            resources.report(problem);
        }
    }
    None
}

/// Factors on the bands of a raster whose sum is the mean over each band of the scene of the straight lines that join the
/// raster's values.
fn by_wavelength(
    raster: &[BandDescription],
    path: &ScenePath,
    resources: &mut Resources,
) -> Option<Vec<Vec<(usize, f64)>>> {
    if let Some(index) = raster.iter().position(|band| band.wavelength_nm.is_none()) {
        let message = format!("the file does not say which wavelength its band {} has", index + 1);
        let help = "name the bands: `Each({ \"red\": 3 })`, or `All(1)` to take one for all";
        resources.report(Diagnostic::error(path, message).help(help));
        return None;
    }
    let mut bands: Vec<(f64, usize)> = raster
        .iter()
        .zip(0..)
        .filter_map(|(band, index)| Some((band.wavelength_nm?, index)))
        .collect();
    bands.sort_by(|a, b| a.0.total_cmp(&b.0));
    if let Some(pair) = bands.windows(2).find(|pair| pair[0].0.to_bits() == pair[1].0.to_bits()) {
        let (first, second) = (pair[0].1 + 1, pair[1].1 + 1);
        let message =
            format!("bands {first} and {second} of the raster are both at {} nm", pair[0].0);
        let help = "name the bands: `Each({ \"red\": 3 })`";
        resources.report(Diagnostic::error(path, message).help(help));
        return None;
    }
    let mut sums = Vec::new();
    for (band, response) in resources.bands.iter().zip(resources.responses.all()) {
        match factors(&bands, response, resources.responses.irradiance()) {
            Ok(sum) => sums.push(sum),
            Err(error) => {
                let message = format!("band `{}`: {error}", band.name);
                let help =
                    "name a band of the raster for each band of the scene: `Each({ \"red\": 3 })`";
                resources.report(Diagnostic::error(path, message).help(help));
                return None;
            }
        }
    }
    Some(sums)
}

/// Factors on bands at rising wavelengths for one response.
fn factors(
    bands: &[(f64, usize)],
    response: &BandResponse,
    irradiance: Option<&[(f64, f64)]>,
) -> Result<Vec<(usize, f64)>, crate::spectral::OutsideSpectrum> {
    let (low, high) = response.range();
    // The bands about the response alone: there may be hundreds.
    let first = bands.partition_point(|band| band.0 <= low);
    let end = bands.partition_point(|band| band.0 < high);
    // An error names the range of all.
    let is_within = first > 0 && end < bands.len();
    let near = if is_within { &bands[first - 1..=end] } else { bands };
    let mut sum = Vec::new();
    for &(wavelength, index) in near {
        let hat: Vec<(f64, f64)> = near
            .iter()
            .map(|&(at, _)| (at, f64::from(at.to_bits() == wavelength.to_bits())))
            .collect();
        let factor = response.mean_of_fraction(&hat, irradiance)?;
        if factor > NEGLIGIBLE {
            sum.push((index, factor));
        }
    }
    Ok(sum)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectral::BandWindow;

    /// The mean of any spectrum by factors is that of a table of its points.
    #[test]
    fn factors_give_the_mean_of_the_straight_lines_between_bands() {
        let bands: Vec<(f64, usize)> = [443.0, 490.0, 560.0, 665.0, 705.0, 740.0, 865.0]
            .into_iter()
            .zip([3, 1, 0, 2, 6, 5, 4])
            .collect();
        let values = [0.1, 0.35, 0.2, 0.05, 0.4, 0.9, 0.7];
        let points: Vec<(f64, f64)> =
            bands.iter().map(|&(nm, index)| (nm, values[index])).collect();
        for (center, width) in
            [(500.0, 0.0), (490.0, 0.0), (600.0, 200.0), (443.0, 0.0), (654.0, 422.0)]
        {
            let response = BandResponse::Window(BandWindow { center, width });
            let factors = factors(&bands, &response, None).expect("it lies within the bands");
            let mean: f64 = factors.iter().map(|(index, factor)| factor * values[*index]).sum();
            let expected = response.mean(&points).expect("it lies within the points");
            assert!((mean - expected).abs() < 1e-12, "{center} {width}: {mean} for {expected}");
            assert!((factors.iter().map(|one| one.1).sum::<f64>() - 1.0).abs() < 1e-12);
        }
        let response = BandResponse::Window(BandWindow { center: 900.0, width: 10.0 });
        assert!(factors(&bands, &response, None).is_err());
    }
}
