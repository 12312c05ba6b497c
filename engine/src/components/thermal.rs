/// Radiance of a black body that is as warm as a material, W m⁻² sr⁻¹ nm⁻¹, shape `[bands]`; 0 in
/// bands that hold no emission.
#[derive(Clone, Debug, PartialEq)]
pub struct BlackBody {
    /// Radiance where the sun's disc is visible, W m⁻² sr⁻¹ nm⁻¹, shape `[bands]`.
    pub sunlit: Vec<f64>,
    /// Radiance where it is not, in the same unit and shape.
    pub shaded: Vec<f64>,
}

/// Bands that hold emitted radiance, and the sky's emission.
#[derive(Clone, Debug, PartialEq)]
pub struct Emission {
    /// True if the band holds it, shape `[bands]`.
    pub bands: Vec<bool>,
    /// Radiance of the sky, W m⁻² sr⁻¹ nm⁻¹, shape `[bands]`.
    pub sky: Vec<f64>,
}
