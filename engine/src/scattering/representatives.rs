//! Choice of the bands that decide for all bands of a path.

use super::{LANES, padded};

/// Real bands that stand for all: each band has one that is as bright in every spectrum that paths are multiplied by,
/// but for 5 %, and no more than four times as bright.
///
/// A path ends by Russian roulette in proportion to its throughput in the brightest representative. A band that is brighter
/// than all of them along some paths receives few of these with large weights: a noise that its standard error does not
/// show until such a path comes. A band that is darker is traced with more rays than it needs.
#[derive(Clone, Debug, PartialEq)]
pub struct RepresentativeBands {
    /// The representative bands.
    bands: Vec<u32>,
    /// Index in `bands` of the representative of each band, shape `[all bands]`.
    of: Vec<u32>,
    /// Largest ratio of a band to its representative in any spectrum, shape `[all bands]`; empty if each
    /// represents itself.
    excess: Vec<f32>,
}

/// Largest ratio of a band to its representative that is aimed at.
const DARKER: f32 = 1.05;

/// Largest ratio of a representative to a band of its own that is aimed at.
const BRIGHTER: f32 = 4.0;

/// Values below this fraction of a spectrum's largest one differ by nothing that counts.
const NEGLIGIBLE: f32 = 0.01;

impl RepresentativeBands {
    /// Maximum number of representative bands.
    pub const MOST: usize = 128;

    /// Minimum value of a representative over the largest of the bands that it represents.
    pub(super) const LEAST: f32 = 1.0 / 16.0;

    /// Each band represents itself; of more than [`Self::MOST`], the first represents all until they are chosen.
    pub(super) fn all(bands: usize) -> Self {
        let is_few = bands <= Self::MOST;
        let of = (0..bands as u32).map(|band| if is_few { band } else { 0 }).collect();
        let bands = if is_few { (0..bands as u32).collect() } else { vec![0] };
        Self { bands, of, excess: Vec::new() }
    }

    /// Chooses bands for these spectra, each of shape `[bands]`.
    ///
    /// Source: Gonzalez (1985), Theor. Comput. Sci. 38, 293–306: the next centre is the point farthest from all centres so far.
    pub(super) fn choose(bands: usize, spectra: &[&[f32]]) -> Self {
        let logarithms: Vec<Vec<f32>> = spectra.iter().filter_map(|row| logarithms(row)).collect();
        let brightness =
            |band: usize| logarithms.iter().map(|row| f64::from(row[band])).sum::<f64>();
        let by_brightness = |a: &usize, b: &usize| brightness(*a).total_cmp(&brightness(*b));
        let mut next = (0..bands).max_by(by_brightness);
        let mut chosen = Self { bands: Vec::new(), of: vec![0; bands], excess: vec![0.0; bands] };
        let mut distances = vec![f32::INFINITY; bands];
        while let Some(band) = next {
            let index = chosen.bands.len() as u32;
            chosen.bands.push(band as u32);
            for (other, distance) in distances.iter_mut().enumerate() {
                let difference = Difference::between(&logarithms, other, band);
                if difference.distance() < *distance {
                    *distance = difference.distance();
                    (chosen.of[other], chosen.excess[other]) = (index, difference.above.exp());
                }
            }
            let farthest = (0..bands).max_by(|&a, &b| distances[a].total_cmp(&distances[b]));
            let is_full = chosen.bands.len() == Self::MOST;
            next = farthest.filter(|&band| !is_full && distances[band] > 1.0);
        }
        chosen
    }

    /// Length of a row of values in the representative bands, padding included.
    #[must_use]
    pub const fn lanes(&self) -> usize {
        self.bands.len().next_multiple_of(LANES)
    }

    /// The representative bands.
    #[must_use]
    pub fn bands(&self) -> &[u32] {
        &self.bands
    }

    /// Index among the representative bands of the one that stands for a band.
    #[must_use]
    pub fn of(&self, band: usize) -> usize {
        self.of[band] as usize
    }

    /// Values of a spectrum in the representative bands, padded with zeros to whole groups of lanes.
    pub(crate) fn values_of(&self, spectrum: &[f32]) -> Box<[f32]> {
        let least = self.least_of(spectrum);
        padded(
            self.bands.iter().zip(least).map(|(&band, least)| spectrum[band as usize].max(least)),
        )
    }

    /// Minimum values in the representative bands: a part of the largest value of the bands that each stands for; 0 if it
    /// stands for itself alone.
    pub(super) fn least_of(&self, spectrum: &[f32]) -> Vec<f32> {
        let mut largest = vec![0.0_f32; self.bands.len()];
        let mut has_others = vec![false; self.bands.len()];
        for (band, (&of, &value)) in self.of.iter().zip(spectrum).enumerate() {
            let of = of as usize;
            largest[of] = largest[of].max(value);
            has_others[of] |= self.bands[of] as usize != band;
        }
        let least = |(largest, has_others)| if has_others { Self::LEAST * largest } else { 0.0 };
        largest.into_iter().zip(has_others).map(least).collect()
    }

    /// Returns whether each band represents itself.
    pub(super) const fn are_all(&self) -> bool {
        self.bands.len() == self.of.len()
    }

    /// Bands that are more than this many times as bright as their representative in some spectrum, each with that
    /// ratio: their errors may be larger than their standard errors say.
    pub fn brighter_than(&self, factor: f32) -> impl Iterator<Item = (usize, f32)> {
        let excess = self.excess.iter().copied().enumerate();
        excess.filter(move |(_, excess)| *excess > factor)
    }
}

/// Natural logarithms of a spectrum; `None` if it is 0 throughout.
fn logarithms(spectrum: &[f32]) -> Option<Vec<f32>> {
    let largest = spectrum.iter().copied().fold(0.0, f32::max);
    let least = largest * NEGLIGIBLE;
    (largest > 0.0).then(|| spectrum.iter().map(|value| value.max(least).ln()).collect())
}

/// Largest differences between a band and its representative over all spectra, of logarithms.
#[derive(Clone, Copy)]
struct Difference {
    /// By which the band is brighter.
    above: f32,
    /// By which the representative is brighter.
    below: f32,
}

impl Difference {
    fn between(logarithms: &[Vec<f32>], band: usize, representative: usize) -> Self {
        let mut most = Self { above: 0.0, below: 0.0 };
        for row in logarithms {
            let difference = row[band] - row[representative];
            most.above = most.above.max(difference);
            most.below = most.below.max(-difference);
        }
        most
    }

    /// At most 1 if both are within their aims.
    fn distance(self) -> f32 {
        (self.above / DARKER.ln()).max(self.below / BRIGHTER.ln())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scattering::{SceneSpectra, SpectrumId};

    /// Spectra of leaves and soils that differ from band to band, in an order given by a step.
    fn uneven(bands: usize, step: usize) -> (SceneSpectra, [SpectrumId; 3]) {
        let mut table = SceneSpectra::new(bands);
        let ids = [(0.3, 0.5_f64), (0.7, 0.45), (1.9, 0.3)].map(|(seed, scale)| {
            let value = |band: usize| {
                let place = (band * step % bands) as f64;
                (scale * (0.55 + 0.4 * (place * seed).sin())) as f32
            };
            table.add((0..bands).map(value))
        });
        table.choose_representatives(&[]);
        (table, ids)
    }

    #[test]
    fn representatives_rule_no_band_out_and_are_the_spectrum_if_bands_are_few() {
        for bands in [0, 1, 7, 64, 127, 128, 129, 256, 257, 2100] {
            for only in (0..bands).step_by(bands / 40 + 1) {
                let mut table = SceneSpectra::new(bands);
                let value = |band: usize| if band == only { 0.7 } else { 0.0 };
                let id = table.add((0..bands).map(value));
                // A spectrum that does not decide is not ruled out either.
                let counted = table.add_counted((0..bands).map(|band| value((band + 1) % bands)));
                table.choose_representatives(&[]);
                let chosen = table.representative_bands();
                assert!(chosen.bands().len() <= RepresentativeBands::MOST);
                let (values, others) = (table.representatives(id), table.representatives(counted));
                assert!(values[chosen.of(only)] >= 0.7 / 16.0, "{bands}: {only}");
                assert!(others[chosen.of((only + bands - 1) % bands)] >= 0.7 / 16.0);
                let is_whole = values == table.lanes(id);
                assert!(bands > RepresentativeBands::MOST || is_whole, "{bands}: {only}");
            }
        }
    }

    /// Every band has a representative within the aims in every spectrum, whatever the order of bands; few do.
    #[test]
    fn every_band_has_a_representative_that_is_like_it() {
        let mut counts = Vec::new();
        for step in [1, 7, 1011] {
            let (table, ids) = uneven(2000, step);
            let chosen = table.representative_bands();
            counts.push(chosen.bands().len());
            for id in ids {
                let (spectrum, largest) = (table.lanes(id), table.largest(id));
                for band in 0..2000 {
                    let value = |band: usize| spectrum[band].max(NEGLIGIBLE * largest);
                    let ratio = value(band) / value(chosen.bands()[chosen.of(band)] as usize);
                    assert!((1.0 / 4.001..1.051).contains(&ratio), "{band}: {ratio}");
                }
            }
            assert_eq!(chosen.brighter_than(1.051).count(), 0);
        }
        assert!(counts.iter().all(|count| *count == counts[0] && *count < 100), "{counts:?}");
    }

    /// Bands that no representative covers are known if spectra differ too much.
    #[test]
    fn bands_that_no_representative_covers_are_known() {
        let bands = 3000;
        let mut table = SceneSpectra::new(bands);
        // Each spectrum is bright in bands of its own.
        for spectrum in 0..300 {
            let value = |band: usize| if band % 300 == spectrum { 0.5 } else { 0.05 };
            table.add((0..bands).map(value));
        }
        table.choose_representatives(&[]);
        let chosen = table.representative_bands();
        assert_eq!(chosen.bands().len(), RepresentativeBands::MOST);
        assert!(chosen.brighter_than(2.0).next().is_some());
    }
}
