use super::{DiscPoint, SceneOptics, Stage};
use crate::accel::{Hit, Ray};
use crate::components::MaterialId;
use crate::sampling::Sampler;
use crate::scattering::{SceneSpectra, SpectrumId};

/// Radiance that surfaces and the sky emit.
#[derive(Clone, Debug, PartialEq)]
pub struct Thermal {
    /// 1 in bands that hold emitted radiance, 0 in others.
    pub bands: SpectrumId,
    /// Radiance of the sky, W m⁻² sr⁻¹ nm⁻¹.
    pub sky: SpectrumId,
    /// Black body of each surface, by the id that hits carry.
    pub surfaces: Vec<SurfaceBlackBody>,
}

/// Radiance of a black body with the temperature of a surface, W m⁻² sr⁻¹ nm⁻¹.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceBlackBody {
    /// Radiance where the sun's disc is visible.
    pub sunlit: SpectrumId,
    /// Radiance where it is not.
    pub shaded: SpectrumId,
    /// True if the two differ.
    pub depends_on_sun: bool,
}

impl Thermal {
    /// Emission of these materials, in this order; `None` where no sensor measures it. Adds spectra to the
    /// table.
    pub(super) fn new(
        optics: &SceneOptics,
        materials: &[MaterialId],
        spectra: &mut SceneSpectra,
    ) -> Option<Self> {
        let emission = optics.emission.as_ref()?;
        // Packets of all temperatures start in proportion to the warmest: no temperature needs a band of its own.
        let mut add =
            |values: &[f64]| spectra.add_counted(values.iter().map(|&value| value as f32));
        let surfaces = materials
            .iter()
            .map(|material| {
                let body = optics.materials.get(material).and_then(|one| one.body.as_ref());
                let body = body.expect("every material has its temperature");
                SurfaceBlackBody {
                    sunlit: add(&body.sunlit),
                    shaded: add(&body.shaded),
                    depends_on_sun: body.sunlit != body.shaded,
                }
            })
            .collect();
        let sky = add(&emission.sky);
        let bands = spectra.add_counted(emission.bands.iter().map(|&emits| f32::from(emits)));
        Some(Self { bands, sky, surfaces })
    }

    /// Shadow rays towards all suns from a point of a surface, if its temperature depends on whether they are visible
    /// from there. It is the same on both sides: a leaf is too thin for two temperatures.
    pub fn sun_rays<'s>(
        &self,
        stage: &'s Stage,
        hit: &'s Hit,
        sampler: &mut Sampler,
    ) -> impl Iterator<Item = Ray> + use<'s> {
        let depends_on_sun = self.surfaces[hit.surface as usize].depends_on_sun;
        let suns = if depends_on_sun { stage.light.suns.as_slice() } else { &[] };
        let point = DiscPoint::sample(suns, sampler);
        suns.iter().map(move |sun| hit.leave(sun.towards(point)))
    }

    /// Radiance of the black body of a surface.
    #[must_use]
    pub fn black_body(&self, hit: &Hit, is_sunlit: bool) -> SpectrumId {
        let body = &self.surfaces[hit.surface as usize];
        if is_sunlit { body.sunlit } else { body.shaded }
    }
}
