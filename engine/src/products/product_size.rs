//! Size of a product before it is measured.

use super::components::component_count;
use super::denoising;
use super::image::bytes_of_block;
use super::{Context, Product};
use crate::components::{ImageMeasure, ImageSensor, System};
use crate::extract::Stage;
use crate::transport::{ComponentColumns, ScatteringOrder};

/// Number of values of a product.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProductSize {
    /// Pixels of an image in each of its bands.
    Image {
        /// Columns.
        width: u64,
        /// Columns times rows.
        pixels: u64,
        /// Number of bands.
        bands: u64,
        /// True if its pixels are in memory; those of paths are computed when they are written.
        is_kept: bool,
        /// True if its pixels are filtered when they are written.
        is_denoised: bool,
    },
    /// Rows of a table.
    Table {
        /// Number of points.
        rows: u64,
        /// Number of axes without the bands: numbers or names beside each point.
        axes: u64,
        /// Number of bands.
        bands: u64,
    },
    /// Triangles and discs.
    Faces {
        /// Number of triangles and discs.
        faces: u64,
        /// Number of bands.
        bands: u64,
    },
}

impl ProductSize {
    /// Size of a product that was measured.
    #[must_use]
    pub fn new(product: &Product) -> Self {
        let count = |values: usize, bands: usize| (values / bands.max(1)) as u64;
        if let Some(image) = &product.image {
            let (pixels, bands) = ((image.width * image.height) as u64, image.bands.len() as u64);
            return Self::Image {
                width: image.width as u64,
                pixels,
                bands,
                is_kept: true,
                is_denoised: false,
            };
        }
        if let Some(faces) = &product.faces {
            let bands = faces.bands.len();
            return Self::Faces { faces: count(faces.values.len(), bands), bands: bands as u64 };
        }
        let points =
            |dimension: &[super::ProductAxis]| dimension.first().map_or(1, |one| one.points.len());
        let (bands, axes) = match product.dimensions.split_last() {
            Some((last, others)) => (points(last), others.iter().flatten().count() as u64),
            None => (1, 0),
        };
        Self::Table { rows: count(product.values.len(), bands), axes, bands: bands as u64 }
    }

    /// Size of the denoised image beside an image.
    const fn denoised(self) -> Self {
        match self {
            Self::Image { width, pixels, bands, is_kept, .. } => {
                Self::Image { width, pixels, bands, is_kept, is_denoised: true }
            }
            other => other,
        }
    }

    /// Number of values, each with an error.
    #[must_use]
    pub const fn values(self) -> u64 {
        match self {
            Self::Image { pixels: count, bands, .. }
            | Self::Table { rows: count, bands, .. }
            | Self::Faces { faces: count, bands } => count.saturating_mul(bands),
        }
    }

    /// Memory, bytes; `u64::MAX` if it is too large to count.
    #[must_use]
    pub const fn memory(self) -> u64 {
        if let Self::Image { is_kept: false, .. } = self { 0 } else { self.bytes() }
    }

    /// Size of all values in memory, bytes; `u64::MAX` if it is too large to count.
    #[must_use]
    pub const fn bytes(self) -> u64 {
        match self {
            // Values and errors as f32, and the coverage.
            Self::Image { pixels, bands, .. } => pixels.saturating_mul(8 * bands + 4),
            Self::Table { rows, axes, bands } => rows.saturating_mul(16 * bands + 8 * axes),
            Self::Faces { faces, bands } => faces.saturating_mul(8 * bands),
        }
    }

    /// Additional memory for making its files, bytes. An image takes that of a block of rows: as they are computed, band by
    /// band, and compressed; and of the values among which percentiles are sought.
    #[must_use]
    pub fn memory_of_files(self) -> u64 {
        match self {
            Self::Image { width, pixels, bands, is_denoised, .. } => {
                let block = bytes_of_block(width, bands).min(self.bytes());
                let filter = if is_denoised {
                    denoising::bytes(width, pixels.div_ceil(width.max(1)), bands)
                } else {
                    0
                };
                COPIES * block + (RANKS * pixels).min(MOST_RANKS) + filter
            }
            Self::Table { .. } | Self::Faces { .. } => 0,
        }
    }
}

/// Copies of a block of rows while its files are written: by pixels, by bands, and as rows of an EXR and compressed.
const COPIES: u64 = 4;

/// Memory of values that are sorted for a percentile, bytes per pixel and at most.
const RANKS: u64 = 16;
const MOST_RANKS: u64 = 20 << 20;

/// Maximum number of leaf area indices of a fisheye.
const LEAF_AREA_INDICES: usize = 3;

/// Light that a measurement estimates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeasuredLight {
    /// True if it estimates reflected light.
    pub reflected: bool,
    /// True if it estimates emitted light.
    pub emitted: bool,
}

/// Sizes of the results of [`image_products`](super::image_products) and
/// [`image_components`](super::image_components).
#[must_use]
pub fn image_sizes(
    sensor: &ImageSensor,
    light: MeasuredLight,
    has_zones: bool,
    stage: &Stage,
    context: &Context,
) -> Vec<ProductSize> {
    let pixels = u64::from(sensor.size.x) * u64::from(sensor.size.y);
    let is_kept = sensor.system == System::Forward || context.scenes > 1;
    let width = u64::from(sensor.size.x);
    let image = |bands: usize| {
        let (bands, is_denoised) = (bands as u64, false);
        ProductSize::Image { width, pixels, bands, is_kept, is_denoised }
    };
    let index = ProductSize::Table { rows: 1, axes: 0, bands: 1 };
    let of = |measure: &ImageMeasure| match measure {
        ImageMeasure::FourComponents => {
            let components = component_count(stage, context);
            vec![image(components), image(components / ComponentColumns::COMPONENTS)]
        }
        ImageMeasure::GapFraction => {
            [vec![image(1)], vec![index; usize::from(has_zones) * LEAF_AREA_INDICES]].concat()
        }
        measure => {
            let mut sizes = light_sizes(*measure, light, context, image);
            if sensor.is_denoised {
                let filtered = sizes.iter().map(|size| size.denoised()).collect::<Vec<_>>();
                sizes.extend(filtered);
            }
            sizes
        }
    };
    sensor.measure.iter().flat_map(of).collect()
}

/// Sizes of the results of [`direction_products`](super::direction_products) and
/// [`direction_components`](super::direction_components), but for single numbers.
#[must_use]
pub fn direction_sizes(
    views: usize,
    measures: &[ImageMeasure],
    light: MeasuredLight,
    stage: &Stage,
    context: &Context,
) -> Vec<ProductSize> {
    let table =
        |bands: usize| ProductSize::Table { rows: views as u64, axes: 2, bands: bands as u64 };
    let of = |measure: &ImageMeasure| match measure {
        ImageMeasure::FourComponents => vec![table(component_count(stage, context))],
        // The share of gaps, and Beer's index.
        ImageMeasure::GapFraction => vec![table(1); 2],
        measure => light_sizes(*measure, light, context, table),
    };
    measures.iter().flat_map(of).collect()
}

/// Sizes of the products of light; `size` is that of a product of a number of bands.
fn light_sizes(
    measure: ImageMeasure,
    MeasuredLight { reflected, emitted }: MeasuredLight,
    context: &Context,
    size: impl Fn(usize) -> ProductSize,
) -> Vec<ProductSize> {
    let bands = context.bands.len();
    match measure {
        ImageMeasure::Radiance => vec![size(bands); usize::from(reflected || emitted)],
        ImageMeasure::Brf => vec![size(bands); usize::from(reflected)],
        ImageMeasure::Orders => {
            vec![size(bands); usize::from(reflected) * ScatteringOrder::ALL.len()]
        }
        ImageMeasure::BrightnessTemperature => {
            vec![size(context.emitting().len()); usize::from(emitted)]
        }
        ImageMeasure::FourComponents | ImageMeasure::GapFraction => Vec::new(),
    }
}
