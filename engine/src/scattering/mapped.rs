//! Diffuse ground whose reflectance differs from cell to cell.

use std::ops::Range;
use std::sync::Arc;

use glam::DVec3;

use super::{
    BsdfSample, Importance, Interaction, Lobe, LobeSpectrum, RepresentativeBands, SceneSpectra,
};
use crate::components::{MappedReflectance, ReflectanceCells};
use crate::sampling::cosine_direction;

/// Lambertian reflection `f = ρ/π` of an opaque ground, alike on both sides, with the `ρ` of the cell around a point.
#[derive(Clone, Debug, PartialEq)]
pub struct MappedLambertian {
    cells: Arc<ReflectanceCells>,
    /// Layer of each band.
    layers: Vec<u32>,
    /// Layers of each representative band: its own first, then those of the other bands that it stands for.
    representatives: Vec<Vec<u32>>,
}

/// Cell of a map, and the fraction of its light that is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CellFraction {
    /// Number of the cell.
    pub cell: u32,
    /// True for the absorbed fraction `1 - ρ`, false for the reflected one, `ρ`.
    pub is_absorbed: bool,
}

impl CellFraction {
    fn of(self, reflectance: f32) -> f32 {
        if self.is_absorbed { 1.0 - reflectance } else { reflectance }
    }
}

/// Maximum number of cells whose spectra representative bands are chosen by.
const MOST_SHAPES: usize = 64;

impl MappedLambertian {
    /// The model of these optics.
    #[must_use]
    pub fn new(optics: &MappedReflectance, spectra: &SceneSpectra) -> Self {
        let (cells, layers) = (optics.cells().clone(), optics.layers().to_vec());
        let mut model = Self { cells, layers, representatives: Vec::new() };
        model.choose_representatives(spectra);
        model
    }

    /// Takes over the representative bands of the spectra.
    pub(super) fn choose_representatives(&mut self, spectra: &SceneSpectra) {
        let chosen = spectra.representative_bands();
        let own = |&band: &u32| vec![self.layers[band as usize]];
        let mut groups: Vec<Vec<u32>> = chosen.bands().iter().map(own).collect();
        for (band, &layer) in self.layers.iter().enumerate() {
            let group = &mut groups[chosen.of(band)];
            if !group.contains(&layer) {
                group.push(layer);
            }
        }
        self.representatives = groups;
    }

    /// Spectra of some cells, evenly over the map, by which representative bands are chosen; each of shape `[bands]`.
    pub(super) fn shapes(&self) -> Vec<Vec<f32>> {
        let step = self.cells.count().div_ceil(MOST_SHAPES);
        let shape = |cell: usize| {
            let values = self.cells.values_of(cell as u32);
            self.layers.iter().map(|&layer| values[layer as usize]).collect()
        };
        (0..self.cells.count()).step_by(step).map(shape).collect()
    }

    /// Writes a fraction of a cell in a range of lanes.
    pub(super) fn evaluate(&self, at: CellFraction, lanes: Range<usize>, values: &mut [f32]) {
        let cell = self.cells.values_of(at.cell);
        for (lane, value) in lanes.zip(values) {
            *value = self.layers.get(lane).map_or(0.0, |&layer| at.of(cell[layer as usize]));
        }
    }

    /// Writes a fraction of a cell in the representative bands: at least a part of that of any of the bands that each
    /// stands for.
    pub(super) fn evaluate_representatives(&self, at: CellFraction, values: &mut [f32]) {
        let cell = self.cells.values_of(at.cell);
        values.fill(0.0);
        for (value, layers) in values.iter_mut().zip(&self.representatives) {
            let mut fractions = layers.iter().map(|&layer| at.of(cell[layer as usize]));
            let own = fractions.next().unwrap_or(0.0);
            *value =
                fractions.fold(own, |least, other| least.max(RepresentativeBands::LEAST * other));
        }
    }

    fn lobe(&self, at: &Interaction<'_>, is_absorbed: bool) -> Lobe {
        let cell = self.cells.cell_at(at.place);
        let spectrum = LobeSpectrum::Cell(at.surface, CellFraction { cell, is_absorbed });
        Lobe { spectrum, scale: 1.0 }
    }

    /// Returns whether the cell around a point reflects nothing in any band.
    fn is_black(&self, at: &Interaction<'_>) -> bool {
        let cell = self.cells.values_of(self.cells.cell_at(at.place));
        cell.iter().all(|&value| value <= 0.0)
    }

    #[inline(never)]
    pub(super) fn f(&self, at: &Interaction<'_>, wi: DVec3) -> Option<Lobe> {
        (at.is_same_side(wi) && !self.is_black(at)).then(|| self.reflected_fraction(at))
    }

    /// ρ.
    pub(super) fn reflected_fraction(&self, at: &Interaction<'_>) -> Lobe {
        self.lobe(at, false)
    }

    /// 1 - ρ.
    pub(super) fn absorbed_fraction(&self, at: &Interaction<'_>) -> Lobe {
        self.lobe(at, true)
    }

    #[inline(never)]
    pub(super) fn sample_f(
        &self,
        at: &Interaction<'_>,
        importance: Importance<'_>,
        [_, u, v]: [f64; 3],
    ) -> Option<BsdfSample> {
        let weight = self.reflected_fraction(at);
        if at.models.power(&weight, importance) <= 0.0 {
            return None;
        }
        let outward = if at.is_front() { at.normal } else { -at.normal };
        // f |cos θ| / pdf = π f.
        Some(BsdfSample { wi: cosine_direction(outward, u, v), weight })
    }

    /// `|cos θ| / π` on the side of `wo`.
    pub(super) fn pdf(&self, at: &Interaction<'_>, wi: DVec3) -> f64 {
        if self.is_black(at) { 0.0 } else { super::directional::pdf(at, wi) }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::components::{CellLayout, SurfaceOptics};
    use crate::scattering::SurfaceModels;

    /// Two cells in two layers, over more bands than can all be representative.
    fn models(bands: usize, values: Vec<f32>) -> SurfaceModels {
        let size = DVec2::new(2.0, 1.0);
        let layout = CellLayout { columns: 2, rows: 1, corner: DVec2::ZERO, size };
        let layers = (0..bands).map(|band| u32::from(band % 2 == 1)).collect();
        let cells = Arc::new(ReflectanceCells::new(layout, 2, values));
        let mut models = SurfaceModels::new(bands);
        models.add(&SurfaceOptics::Mapped(MappedReflectance::new(cells, layers)));
        models.choose_representatives();
        models
    }

    #[test]
    fn every_cell_has_its_values_in_every_band() {
        for bands in [1, 7, 130, 300] {
            let models = models(bands, vec![0.25, 0.5, 0.75, 0.125]);
            let at = |x: f64| {
                let place = DVec2::new(x, 0.5);
                models.at(super::super::SurfaceId(0), DVec3::Z, DVec3::Z).at_place(place)
            };
            for band in 0..bands {
                let index = band % 2;
                let (west, east) = ([0.25, 0.5][index], [0.75, 0.125][index]);
                for (x, reflectance) in [(0.5, west), (1.5, east)] {
                    let value = |lobe: Lobe| models.value(&lobe, band);
                    assert_eq!(
                        value(at(x).reflected_fraction()).to_bits(),
                        f32::to_bits(reflectance)
                    );
                    assert_eq!(
                        value(at(x).absorbed_fraction()).to_bits(),
                        f32::to_bits(1.0 - reflectance)
                    );
                    let wi = DVec3::new(0.6, 0.0, 0.8);
                    assert_eq!(at(x).f(wi), Some(at(x).reflected_fraction()));
                    assert_eq!(at(x).f(-wi), None);
                }
            }
        }
    }

    /// Cells that reflect in one layer alone go on, whatever bands are representative; black ones do not.
    #[test]
    fn representatives_rule_no_layer_out() {
        for bands in [2, 128, 300] {
            let models = models(bands, vec![0.0, 0.8, 0.0, 0.0]);
            let lanes = models.spectra.representative_bands().lanes();
            let throughput = vec![1.0; lanes];
            let at = |x: f64| {
                let place = DVec2::new(x, 0.5);
                models.at(super::super::SurfaceId(0), DVec3::Z, DVec3::Z).at_place(place)
            };
            let importance = Importance::Representatives(&throughput);
            assert!(at(0.5).sample_f(importance, [0.5; 3]).is_some(), "{bands}");
            assert!(at(1.5).sample_f(importance, [0.5; 3]).is_none(), "{bands}");
            assert!(at(1.5).f(DVec3::Z).is_none());
            assert!(at(0.5).sample_f(Importance::Band(0), [0.5; 3]).is_none());
        }
    }
}
