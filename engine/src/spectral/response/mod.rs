//! Relative responses of bands to wavelengths.

mod smooth_rule;

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::band::value_at;
use super::{BandWindow, LONGEST_NM, OutsideSpectrum, SHORTEST_NM, band_mean};
use smooth_rule::smooth_rule;

/// Point of a curve: wavelength, nm, and value.
type Point = (f64, f64);

/// Largest part of a response that may lie where a spectrum is not given: the spectrum goes on there as it ends.
const MOST_OUTSIDE: f64 = 0.01;

/// Full widths at half maximum from the centre to where a normal curve is taken as 0: it is 1.5e-11 there.
const GAUSSIAN_REACH: f64 = 3.0;

/// Points of a normal curve per full width: values between them are not used, integrals are those of the curve.
const GAUSSIAN_STEPS: f64 = 8.0;

/// Relative response of a band to the wavelengths.
#[derive(Clone, Debug, PartialEq)]
pub enum BandResponse {
    /// Alike within a window.
    Window(BandWindow),
    /// A curve.
    Curve(Arc<ResponseCurve>),
}

/// Response that differs from wavelength to wavelength.
#[derive(Clone, Debug, PartialEq)]
pub struct ResponseCurve {
    shape: CurveShape,
    /// Wavelengths between which the response is smooth, nm, rising.
    nodes: Vec<f64>,
    center: f64,
    width: f64,
    /// Wavelengths, nm, and weights, of which the sum is 1, for means of smooth functions.
    smooth: Vec<Point>,
}

/// Shape of a curve.
#[derive(Clone, Debug, PartialEq)]
enum CurveShape {
    /// Normal curve of this full width at half maximum.
    Gaussian { center: f64, fwhm: f64 },
    /// Straight lines between points, 0 beyond.
    Lines(Vec<Point>),
}

/// Response as files of results hold it.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub enum ResponseRecord {
    /// Alike within a window.
    Window {
        /// Centre, nm.
        center_nm: f64,
        /// Width, nm.
        width_nm: f64,
    },
    /// Normal curve.
    Gaussian {
        /// Centre, nm.
        center_nm: f64,
        /// Full width at half maximum, nm.
        fwhm_nm: f64,
    },
    /// Straight lines between points (wavelength nm, relative response).
    Points(Vec<Point>),
}

impl From<&BandResponse> for ResponseRecord {
    fn from(response: &BandResponse) -> Self {
        match response {
            BandResponse::Window(BandWindow { center, width }) => {
                Self::Window { center_nm: *center, width_nm: *width }
            }
            BandResponse::Curve(curve) => match &curve.shape {
                CurveShape::Gaussian { center, fwhm } => {
                    Self::Gaussian { center_nm: *center, fwhm_nm: *fwhm }
                }
                CurveShape::Lines(points) => Self::Points(points.clone()),
            },
        }
    }
}

impl TryFrom<ResponseRecord> for BandResponse {
    type Error = InvalidResponse;

    fn try_from(record: ResponseRecord) -> Result<Self, InvalidResponse> {
        Ok(match record {
            ResponseRecord::Window { center_nm, width_nm } => {
                Self::Window(BandWindow { center: center_nm, width: width_nm })
            }
            ResponseRecord::Gaussian { center_nm, fwhm_nm } => Self::gaussian(center_nm, fwhm_nm),
            ResponseRecord::Points(points) => return Self::from_points(points),
        })
    }
}

/// Points that are no response.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum InvalidResponse {
    /// Fewer than two points.
    #[error("a response has at least two points")]
    TooShort,
    /// A wavelength beyond all spectra.
    #[error("wavelengths of a response are {SHORTEST_NM} to {LONGEST_NM} nm, not {0}")]
    NoLight(f64),
    /// Wavelengths that do not rise.
    #[error("wavelengths of a response rise from point to point")]
    NotRising,
    /// A negative value, or one that is not finite.
    #[error("values of a response are 0 or above")]
    Negative,
    /// Zero everywhere.
    #[error("a response is above 0 somewhere")]
    Zero,
}

impl BandResponse {
    /// Normal curve around a wavelength, nm, with a full width at half maximum, nm, above 0.
    #[must_use]
    pub fn gaussian(center: f64, fwhm: f64) -> Self {
        let steps = (2.0 * GAUSSIAN_REACH * GAUSSIAN_STEPS) as u32;
        let node = |step: u32| center + fwhm * (f64::from(step) / GAUSSIAN_STEPS - GAUSSIAN_REACH);
        let nodes = (0..=steps).map(node).collect();
        Self::from_shape(CurveShape::Gaussian { center, fwhm }, nodes, center, fwhm)
    }

    /// Straight lines between points (wavelength nm, relative response), 0 beyond.
    ///
    /// # Errors
    /// Points that are no response.
    pub fn from_points(points: Vec<Point>) -> Result<Self, InvalidResponse> {
        if points.len() < 2 {
            return Err(InvalidResponse::TooShort);
        }
        let is_light = |wavelength: f64| (SHORTEST_NM..=LONGEST_NM).contains(&wavelength);
        if let Some(&(wavelength, _)) = points.iter().find(|point| !is_light(point.0)) {
            return Err(InvalidResponse::NoLight(wavelength));
        }
        if !points.windows(2).all(|pair| pair[0].0 < pair[1].0) {
            return Err(InvalidResponse::NotRising);
        }
        if !points.iter().all(|(_, value)| *value >= 0.0 && value.is_finite()) {
            return Err(InvalidResponse::Negative);
        }
        let nodes: Vec<f64> = points.iter().map(|(wavelength, _)| *wavelength).collect();
        let shape = CurveShape::Lines(points);
        let integral = shape.integral(&nodes, |_| 1.0);
        if integral <= 0.0 {
            return Err(InvalidResponse::Zero);
        }
        let center = shape.integral(&nodes, |wavelength| wavelength) / integral;
        let width = shape.width();
        Ok(Self::from_shape(shape, nodes, center, width))
    }

    fn from_shape(shape: CurveShape, nodes: Vec<f64>, center: f64, width: f64) -> Self {
        let smooth = smooth_rule(&shape, &nodes);
        Self::Curve(Arc::new(ResponseCurve { shape, nodes, center, width, smooth }))
    }

    /// Centre of the window; centroid of a curve, nm.
    #[must_use]
    pub fn center(&self) -> f64 {
        match self {
            Self::Window(window) => window.center,
            Self::Curve(curve) => curve.center,
        }
    }

    /// Width of the window; distance of the outermost halves of the maximum of a curve, nm.
    #[must_use]
    pub fn width(&self) -> f64 {
        match self {
            Self::Window(window) => window.width,
            Self::Curve(curve) => curve.width,
        }
    }

    /// First and last wavelength that it sees, nm.
    #[must_use]
    pub fn range(&self) -> (f64, f64) {
        match self {
            Self::Window(BandWindow { center, width }) => {
                (center - 0.5 * width, center + 0.5 * width)
            }
            Self::Curve(curve) => curve.range(),
        }
    }

    /// Mean of a spectrum, `∫ f S dλ / ∫ S dλ` with the response S: in a window and under a normal curve exact for the
    /// straight lines that join its points; of a table of responses by the trapezoidal rule over the wavelengths of both.
    ///
    /// - `points`: (wavelength nm, value), shape `[points]`, wavelengths rising
    ///
    /// # Errors
    /// A response that reaches outside the wavelengths of the points: a window at all, a curve with more than 1 %.
    pub fn mean(&self, points: &[Point]) -> Result<f64, OutsideSpectrum> {
        match self {
            Self::Window(window) => band_mean(points, window.center, window.width),
            Self::Curve(curve) => curve.mean(points, None),
        }
    }

    /// Mean of a reflectance or transmittance: of a curve weighted by an irradiance E too, `∫ f E S dλ / ∫ E S dλ`, so
    /// that times the mean irradiance it is what is reflected of it. Beyond its ends the irradiance goes on as it ends. A
    /// window has no weights.
    ///
    /// # Errors
    /// As those of [`Self::mean`].
    pub fn mean_of_fraction(
        &self,
        points: &[Point],
        irradiance: Option<&[Point]>,
    ) -> Result<f64, OutsideSpectrum> {
        match self {
            Self::Window(_) => self.mean(points),
            Self::Curve(curve) => curve.mean(points, irradiance),
        }
    }
}

impl ResponseCurve {
    fn range(&self) -> (f64, f64) {
        let end = |node: Option<&f64>| node.copied().unwrap_or(self.center);
        (end(self.nodes.first()), end(self.nodes.last()))
    }

    /// Wavelengths, nm, and weights whose sum is 1: for smooth functions the mean is `Σ w f(λ)`.
    pub(super) fn smooth_rule(&self) -> &[Point] {
        &self.smooth
    }

    fn mean(&self, points: &[Point], weight: Option<&[Point]>) -> Result<f64, OutsideSpectrum> {
        let (low, high) = self.range();
        let (Some(&(first, _)), Some(&(last, _))) = (points.first(), points.last()) else {
            return Err(OutsideSpectrum { low, high, first: f64::NAN, last: f64::NAN });
        };
        let outside = || 1.0 - self.part(first.max(low), last.min(high)) / self.part(low, high);
        if (first > low || last < high) && outside() > MOST_OUTSIDE {
            return Err(OutsideSpectrum { low, high, first, last });
        }
        let ones = [(first, 1.0)];
        let weight = weight.unwrap_or(&ones);
        let within = |&&(at, _): &&Point| at > low && at < high;
        let mut nodes: Vec<f64> = self.nodes.clone();
        nodes.extend(points.iter().chain(weight).filter(within).map(|&(at, _)| at));
        nodes.sort_by(f64::total_cmp);
        nodes.dedup();
        let (mut sum, mut norm) = (0.0, 0.0);
        let mut add = |at: f64, part: f64| {
            let weight = part * value_at(weight, at);
            sum += weight * value_at(points, at);
            norm += weight;
        };
        match &self.shape {
            CurveShape::Gaussian { .. } => self.shape.for_each_node(&nodes, add),
            CurveShape::Lines(_) => {
                for (index, &at) in nodes.iter().enumerate() {
                    let before = index.checked_sub(1).map_or(at, |before| nodes[before]);
                    let after = nodes.get(index + 1).copied().unwrap_or(at);
                    add(at, 0.5 * (after - before) * self.shape.at(at));
                }
            }
        }
        Ok(sum / norm)
    }

    /// Integral of the response over a range.
    fn part(&self, low: f64, high: f64) -> f64 {
        if low >= high {
            return 0.0;
        }
        let within = self.nodes.iter().copied().filter(|node| (low..high).contains(node));
        let nodes: Vec<f64> = [low].into_iter().chain(within).chain([high]).collect();
        self.shape.integral(&nodes, |_| 1.0)
    }
}

impl CurveShape {
    /// Response between two nodes.
    fn at(&self, wavelength: f64) -> f64 {
        match self {
            Self::Gaussian { center, fwhm } => {
                let distance = (wavelength - center) / fwhm;
                (-4.0 * std::f64::consts::LN_2 * distance * distance).exp()
            }
            Self::Lines(points) => value_at(points, wavelength),
        }
    }

    /// Calls a function with the wavelengths of a quadrature, rising, and the response times their weights. Between nodes
    /// it is exact to rounding for the response times a cubic.
    fn for_each_node(&self, nodes: &[f64], mut take: impl FnMut(f64, f64)) {
        for pair in nodes.windows(2) {
            let (middle, half) = (0.5 * (pair[0] + pair[1]), 0.5 * (pair[1] - pair[0]));
            for (node, weight) in GAUSS {
                let at = middle + half * node;
                take(at, half * weight * self.at(at));
            }
        }
    }

    /// Integral of the response times a function.
    fn integral(&self, nodes: &[f64], function: impl Fn(f64) -> f64) -> f64 {
        let mut sum = 0.0;
        self.for_each_node(nodes, |at, part| sum += part * function(at));
        sum
    }

    /// Distance of the outermost wavelengths with half of the maximum.
    fn width(&self) -> f64 {
        let points = match self {
            Self::Gaussian { fwhm, .. } => return *fwhm,
            Self::Lines(points) => points,
        };
        let half = 0.5 * points.iter().map(|(_, value)| *value).fold(0.0, f64::max);
        let is_high = |point: &Point| point.1 >= half;
        let crossing = |high: usize, low: Option<&Point>| {
            let high = points[high];
            low.map_or(high.0, |low| low.0 + (high.0 - low.0) * (half - low.1) / (high.1 - low.1))
        };
        let (Some(first), Some(last)) =
            (points.iter().position(is_high), points.iter().rposition(is_high))
        else {
            return 0.0;
        };
        let before = first.checked_sub(1).and_then(|before| points.get(before));
        crossing(last, points.get(last + 1)) - crossing(first, before)
    }
}

/// Four-point Gauss-Legendre rule on [-1, 1]: exact for polynomials of degree 7; an eighth of the width of a normal curve
/// times straight lines comes out to 1e-13.
const GAUSS: [(f64, f64); 4] = [
    (-0.861_136_311_594_052_6, 0.347_854_845_137_453_86),
    (-0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
    (0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
    (0.861_136_311_594_052_6, 0.347_854_845_137_453_86),
];

#[cfg(test)]
mod tests;
