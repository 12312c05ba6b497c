use hecs::World;

use super::Stage;
use crate::accel::Hit;
use crate::components::{BlackBody, Emission, MaterialId, SceneId};
use crate::sampling::Sampler;
use crate::scattering::Spectrum;

/// What surfaces and the sky emit.
#[derive(Clone, Debug, PartialEq)]
pub struct Thermal {
    /// 1 in bands that hold emitted radiance, 0 in others.
    pub bands: Spectrum,
    /// Radiance of the sky, W m⁻² sr⁻¹ nm⁻¹.
    pub sky: Spectrum,
    /// Warmth of each surface, by the id that hits carry.
    pub surfaces: Vec<Warmth>,
}

/// Radiance of a black body that is as warm as a surface, W m⁻² sr⁻¹ nm⁻¹.
#[derive(Clone, Debug, PartialEq)]
pub struct Warmth {
    /// Where the sun's disc is visible.
    pub sunlit: Spectrum,
    /// Where it is not.
    pub shaded: Spectrum,
    /// Whether the two differ.
    pub knows_sun: bool,
}

impl Thermal {
    /// Of these materials, in this order; `None` where nothing measures what they emit.
    pub(super) fn of(world: &World, materials: &[MaterialId]) -> Option<Self> {
        let emission = world.query::<&Emission>().iter().next().cloned()?;
        let lanes = |values: &[f64]| Spectrum::new(values.iter().map(|&value| value as f32));
        let mut query = world.query::<(&SceneId, &BlackBody)>();
        let bodies: Vec<_> = query.iter().collect();
        let surfaces = materials
            .iter()
            .map(|material| {
                let body = bodies.iter().find(|(id, _)| id.0 == material.0);
                let (_, body) = body.expect("every material has its temperature");
                Warmth {
                    sunlit: lanes(&body.sunlit),
                    shaded: lanes(&body.shaded),
                    knows_sun: body.sunlit != body.shaded,
                }
            })
            .collect();
        Some(Self {
            bands: Spectrum::new(emission.bands.iter().map(|&emits| f32::from(emits))),
            sky: lanes(&emission.sky),
            surfaces,
        })
    }

    /// Radiance of the black body that is as warm as a surface at a point and the
    /// number of rays that it took to see whether the sun is visible from there. The side does not
    /// matter: a leaf is too thin for two temperatures.
    pub fn black_body(&self, stage: &Stage, hit: &Hit, sampler: &mut Sampler) -> (&Spectrum, u64) {
        let warmth = &self.surfaces[hit.surface as usize];
        let sun = stage.light.sun.as_ref().filter(|_| warmth.knows_sun);
        let is_sunlit =
            sun.is_some_and(|sun| !stage.geometry.occluded(&hit.leave(sun.towards(sampler))));
        (if is_sunlit { &warmth.sunlit } else { &warmth.shaded }, sun.is_some().into())
    }
}
