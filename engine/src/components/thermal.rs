/// Radiance of a black body that is as warm as a material, W m⁻² sr⁻¹ nm⁻¹, shape `[bands]`; 0 in
/// bands that hold no emission.
#[derive(Clone, Debug, PartialEq)]
pub struct BlackBody {
    /// Where the sun's disc is visible.
    pub sunlit: Vec<f64>,
    /// Where it is not.
    pub shaded: Vec<f64>,
}

/// Which bands hold emitted radiance, and what the sky emits.
#[derive(Clone, Debug, PartialEq)]
pub struct Emission {
    /// Whether the band holds it, shape `[bands]`.
    pub bands: Vec<bool>,
    /// Radiance of the sky, W m⁻² sr⁻¹ nm⁻¹, shape `[bands]`.
    pub sky: Vec<f64>,
}
