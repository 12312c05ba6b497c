use glam::DVec3;

/// The sun: a disc of even radiance, or a parallel beam.
#[derive(Clone, Debug, PartialEq)]
pub struct SunLight {
    /// Unit vector from the scene towards the sun.
    pub direction: DVec3,
    /// Angular radius of the disc, rad; 0 is a parallel beam.
    pub radius: f64,
    /// Irradiance on a plane perpendicular to the beam at the top of the scene, W m⁻² nm⁻¹,
    /// shape `[bands]`.
    pub irradiance: Vec<f64>,
}

/// An isotropic sky.
#[derive(Clone, Debug, PartialEq)]
pub struct SkyLight {
    /// Irradiance on the horizontal plane at the top of the scene, W m⁻² nm⁻¹, shape `[bands]`;
    /// its radiance is this over π.
    pub irradiance: Vec<f64>,
}
