//! Filter of one band of a block of pixels.

use super::plane::{Interpolation, Plane, Size, cell_sums};
use super::solve::inverse;

/// Number of Gaussian filters.
const FILTERS: usize = 4;

/// Their standard deviations, pixels.
const SIGMAS: [f64; FILTERS] = [0.5, 1.0, 2.0, 4.0];

/// Radii of the windows in which risks are summed, cells; their weights fall linearly.
const NEAR: usize = 3;
const WIDE: usize = 6;

/// Weight of the wide window over that of the near one, for the weights of the filters and for the errors. A wide window
/// brings less noise, a near one less of what is different elsewhere.
const WIDE_OF_WEIGHTS: f64 = 0.1;
const WIDE_OF_ERRORS: f64 = 1.0;

/// Ridge of the normal equations, as a fraction of their trace.
const RIDGE: f64 = 1e-3;

/// Minimum variance of a filtered pixel as a fraction of that of the pixel.
const LEAST_VARIANCE: f64 = 1e-3;

/// Number of pairs of filters.
const PAIRS: usize = FILTERS * (FILTERS + 1) / 2;

/// Values of a band, their variances, and the weights of the pixels.
pub(super) struct FilterBlock {
    pub(super) size: Size,
    /// NaN where nothing was seen.
    pub(super) values: Vec<f32>,
    /// Standard errors; NaN where there is none.
    pub(super) errors: Vec<f32>,
    /// Fraction of each pixel that shows the scene, in proportion to its number of samples.
    pub(super) coverage: Vec<f32>,
}

/// Pixels of a block that take part, with values from which their mean is subtracted; all numbers of others are 0.
struct Pixels {
    mean: f64,
    value: Plane<f32>,
    variance: Vec<f32>,
    weight: Plane<f32>,
}

impl Pixels {
    fn new(block: &FilterBlock) -> Self {
        let FilterBlock { size, values, errors, coverage } = block;
        let takes_part = |at: usize| coverage[at] > 0.0 && (values[at] + errors[at]).is_finite();
        let (mut sum, mut count) = (0.0, 0_u32);
        for at in (0..values.len()).filter(|&at| takes_part(at)) {
            sum += f64::from(values[at]);
            count += 1;
        }
        let mean = sum / f64::from(count.max(1));
        let of = |value: &dyn Fn(usize) -> f32| -> Vec<f32> {
            (0..values.len()).map(|at| if takes_part(at) { value(at) } else { 0.0 }).collect()
        };
        let value = of(&|at| (f64::from(values[at]) - mean) as f32);
        let (variance, weight) = (of(&|at| errors[at] * errors[at]), of(&|at| coverage[at]));
        let plane = |values| Plane { size: *size, values };
        Self { mean, value: plane(value), variance, weight: plane(weight) }
    }
}

/// A filter: what it changes, and how much of a pixel it takes from others.
struct Filtered {
    /// Filtered less plain value.
    change: Vec<f32>,
    /// One minus the pixel's own weight.
    from_others: Vec<f32>,
    /// Sum of the kernel's weights over those of a pixel without borders or gaps around it.
    support: Vec<f32>,
}

impl Filtered {
    /// Mean with the weights of a Gaussian times those of the pixels.
    fn new(pixels: &Pixels, sigma: f64) -> Self {
        let Pixels { value, weight, .. } = pixels;
        let kernel = gaussian(sigma);
        let own = kernel[kernel.len() / 2].powi(2);
        let weighted =
            value.values.iter().zip(&weight.values).map(|(value, weight)| value * weight);
        let weighted = Plane { size: value.size, values: weighted.collect() };
        let (sums, norms) = (weighted.convolved(&kernel), weight.convolved(&kernel));
        let count = value.values.len();
        let of = |f: &dyn Fn(usize, f32) -> f32| -> Vec<f32> {
            let each = |at: usize| match weight.values[at] {
                weight if weight > 0.0 => f(at, weight),
                _ => 0.0,
            };
            (0..count).map(each).collect()
        };
        Self {
            change: of(&|at, _| sums.values[at] / norms.values[at] - value.values[at]),
            from_others: of(&|at, weight| 1.0 - weight * own / norms.values[at]),
            support: of(&|at, weight| norms.values[at] / weight),
        }
    }
}

/// Gaussian kernel whose weights sum to 1, cut at three standard deviations.
fn gaussian(sigma: f64) -> Vec<f32> {
    let radius = (3.0 * sigma).ceil() as i32;
    let weights: Vec<f64> =
        (-radius..=radius).map(|x| (-0.5 * (f64::from(x) / sigma).powi(2)).exp()).collect();
    let sum: f64 = weights.iter().sum();
    weights.iter().map(|weight| (weight / sum) as f32).collect()
}

/// Kernel whose weights fall linearly to 0 and sum to 1.
fn triangle(radius: usize) -> Vec<f64> {
    let top = radius + 1;
    let weight = |at: usize| (top - at.abs_diff(radius)) as f64 / (top * top) as f64;
    (0..=2 * radius).map(weight).collect()
}

/// Sum over the near and the wide window around each cell.
fn windowed(sums: &Plane<f64>, wide: f64) -> Plane<f64> {
    let (near, far) = (sums.convolved(&triangle(NEAR)), sums.convolved(&triangle(WIDE)));
    Plane::from_cells(sums.size, |cell| near.values[cell] + wide * far.values[cell])
}

/// Returns `a / b`, or 0 where `b` is 0.
fn ratio(a: f64, b: f64) -> f64 {
    if b > 0.0 { a / b } else { 0.0 }
}

/// Sums over cells that weights and errors are made of.
struct CellSums {
    /// Number of pixels that take part.
    count: Plane<f64>,
    /// Variances of the pixels.
    variance: Plane<f64>,
    /// Mean variance of a pixel around each cell.
    level: Plane<f64>,
    /// Normal equations: products of changes, and variances times what comes from others.
    products: [Plane<f64>; PAIRS],
    gains: [Plane<f64>; FILTERS],
    /// Sum of the weights of each kernel that its pixels have, over that of all.
    support: [Plane<f64>; FILTERS],
    overlaps: Overlaps,
}

impl CellSums {
    fn new(pixels: &Pixels, filters: &[Filtered; FILTERS]) -> Self {
        let size = pixels.value.size;
        let is_in = |at: usize| f64::from(u8::from(pixels.weight.values[at] > 0.0));
        let [count, variance] = cell_sums(size, |at| [is_in(at), pixels.variance[at].into()]);
        let products = cell_sums(size, |at| {
            let changes = filters.each_ref().map(|filter| f64::from(filter.change[at]));
            let mut products = [0.0; PAIRS];
            for (product, (row, column)) in products.iter_mut().zip(pairs()) {
                *product = changes[row] * changes[column];
            }
            products
        });
        let gains = cell_sums(size, |at| {
            filters.each_ref().map(|filter| f64::from(filter.from_others[at] * pixels.variance[at]))
        });
        let support =
            cell_sums(size, |at| filters.each_ref().map(|filter| f64::from(filter.support[at])));
        let near = [&variance, &count].map(|sums| sums.convolved(&triangle(NEAR)).values);
        let level = Plane::from_cells(count.size, |cell| ratio(near[0][cell], near[1][cell]));
        let overlaps = Overlaps::new();
        Self { count, variance, level, products, gains, support, overlaps }
    }

    /// Weights of the filters that minimise the estimated risk around each cell.
    fn fit(&self) -> Fit {
        // Cells count by the information of their pixels, bright ones no more than dark ones.
        let relative = |sums: &Plane<f64>| {
            Plane::from_cells(sums.size, |cell| ratio(sums.values[cell], self.level.values[cell]))
        };
        let (products, gains) =
            (self.products.each_ref().map(relative), self.gains.each_ref().map(relative));
        let around = |sums: &Plane<f64>| windowed(sums, WIDE_OF_WEIGHTS).values;
        let (all_products, all_gains) =
            (products.each_ref().map(around), gains.each_ref().map(around));
        let cells = self.count.size;
        let plane = || Plane::from_cells(cells, |_| 0.0);
        let mut weights: [Plane<f64>; FILTERS] = std::array::from_fn(|_| plane());
        let mut inverses = vec![[[0.0; FILTERS]; FILTERS]; cells.area()];
        for cell in 0..cells.area() {
            let mut matrix = symmetric(|pair| all_products[pair][cell]);
            let ridge = RIDGE * (0..FILTERS).map(|row| matrix[row][row]).sum::<f64>();
            (0..FILTERS).for_each(|row| matrix[row][row] += ridge);
            let Some(inverse) = inverse(&matrix) else { continue };
            let solution: [f64; FILTERS] = std::array::from_fn(|row| {
                (0..FILTERS).map(|column| inverse[row][column] * all_gains[column][cell]).sum()
            });
            // A filter that makes more noise is no help to an image that has no bias.
            if self.variance_ratio(&solution, cell) < 1.0 {
                for (weights, weight) in weights.iter_mut().zip(solution) {
                    weights.values[cell] = weight;
                }
                inverses[cell] = inverse;
            }
        }
        let spread = spread_of_scores(&products, &gains, &weights);
        let pixels = around(&self.count);
        let risk = Plane::from_cells(cells, |cell| {
            let spread = symmetric(|pair| spread[pair].values[cell]);
            let trace: f64 = (0..FILTERS)
                .flat_map(|row| (0..FILTERS).map(move |column| (row, column)))
                .map(|(row, column)| inverses[cell][row][column] * spread[column][row])
                .sum();
            trace / pixels[cell].max(1.0)
        });
        let variance = Plane::from_cells(cells, |cell| {
            self.variance_ratio(&weights.each_ref().map(|plane| plane.values[cell]), cell)
        });
        Fit { weights, risk, variance }
    }

    /// Variance of a filtered pixel over that of a plain one: `Σ k²` of the kernel that the filters make together. Near
    /// borders and gaps fewer pixels have the weights of all.
    fn variance_ratio(&self, weights: &[f64; FILTERS], cell: usize) -> f64 {
        let count = self.count.values[cell];
        let plain = 1.0 - weights.iter().sum::<f64>();
        let filled = self.support.each_ref().map(|support| ratio(count, support.values[cell]));
        let mut sum = plain * plain;
        for row in 0..FILTERS {
            sum += 2.0 * plain * weights[row] * self.overlaps.with_pixel[row] * filled[row];
            for column in 0..FILTERS {
                let fill = (filled[row] * filled[column]).sqrt();
                sum += weights[row] * weights[column] * self.overlaps.of_pairs[row][column] * fill;
            }
        }
        sum
    }
}

/// Spread of the sums that weights are solved from, around each cell: products of what cells contribute to the gradient
/// of the risk, which is 0 in all.
///
/// Source: White (1980), "A heteroskedasticity-consistent covariance matrix estimator", Econometrica 48, 817-838.
fn spread_of_scores(
    products: &[Plane<f64>; PAIRS],
    gains: &[Plane<f64>; FILTERS],
    weights: &[Plane<f64>; FILTERS],
) -> [Plane<f64>; PAIRS] {
    let cells = gains[0].size;
    let scores: Vec<[f64; FILTERS]> = (0..cells.area())
        .map(|cell| {
            let matrix = symmetric(|pair| products[pair].values[cell]);
            std::array::from_fn(|row| {
                let change = (0..FILTERS).map(|at| matrix[row][at] * weights[at].values[cell]);
                change.sum::<f64>() - gains[row].values[cell]
            })
        })
        .collect();
    let window = triangle(NEAR).into_iter().map(|weight| weight * weight).collect::<Vec<_>>();
    let mut pairs = pairs();
    std::array::from_fn(|_| {
        let (row, column) = pairs.next().expect("there are as many planes as pairs");
        let product = |cell: usize| scores[cell][row] * scores[cell][column];
        Plane::from_cells(cells, product).convolved(&window)
    })
}

/// Sums of products of the kernels of two filters, and of one and a single pixel.
struct Overlaps {
    of_pairs: [[f64; FILTERS]; FILTERS],
    with_pixel: [f64; FILTERS],
}

impl Overlaps {
    fn new() -> Self {
        let kernels: [Vec<f32>; FILTERS] = SIGMAS.map(gaussian);
        let overlap = |a: &[f32], b: &[f32]| -> f64 {
            let (short, long) = if a.len() < b.len() { (a, b) } else { (b, a) };
            let middle = &long[(long.len() - short.len()) / 2..];
            let sum: f32 = short.iter().zip(middle).map(|(a, b)| a * b).sum();
            f64::from(sum).powi(2)
        };
        let of_pairs = kernels.each_ref().map(|a| kernels.each_ref().map(|b| overlap(a, b)));
        Self { of_pairs, with_pixel: kernels.each_ref().map(|a| overlap(a, &[1.0])) }
    }
}

/// Pairs of filters, `(row, column)` with `column <= row`.
fn pairs() -> impl Iterator<Item = (usize, usize)> {
    (0..FILTERS).flat_map(|row| (0..=row).map(move |column| (row, column)))
}

/// Symmetric matrix from its numbers by pair.
fn symmetric(value: impl Fn(usize) -> f64) -> [[f64; FILTERS]; FILTERS] {
    let mut matrix = [[0.0; FILTERS]; FILTERS];
    for (pair, (row, column)) in pairs().enumerate() {
        matrix[row][column] = value(pair);
        matrix[column][row] = matrix[row][column];
    }
    matrix
}

/// Weights of the filters in each cell.
struct Fit {
    weights: [Plane<f64>; FILTERS],
    /// Risk that comes from fitting them, over the variance of a pixel.
    risk: Plane<f64>,
    /// Variance of a filtered pixel over that of a plain one.
    variance: Plane<f64>,
}

/// Filters a block: returns its values and standard errors. Pixels without an error stay as they are.
pub(super) fn denoise(block: &FilterBlock) -> (Vec<f32>, Vec<f32>) {
    let pixels = Pixels::new(block);
    let filters = SIGMAS.map(|sigma| Filtered::new(&pixels, sigma));
    let sums = CellSums::new(&pixels, &filters);
    let fit = sums.fit();
    let interpolation = Interpolation::new(block.size);
    let (mut values, mut errors) = (block.values.clone(), block.errors.clone());
    // Stein's unbiased estimate of the squared error of each pixel.
    let mut risks = vec![0.0; values.len()];
    for at in (0..values.len()).filter(|&at| pixels.weight.values[at] > 0.0) {
        let weights = interpolation.at(&fit.weights, at);
        let (mut change, mut own_weight) = (0.0, 1.0);
        for (weight, filter) in weights.iter().zip(&filters) {
            change += weight * f64::from(filter.change[at]);
            own_weight -= weight * f64::from(filter.from_others[at]);
        }
        risks[at] = change * change + f64::from(pixels.variance[at]) * (2.0 * own_weight - 1.0);
        let plain = values[at];
        let filtered = (pixels.mean + f64::from(pixels.value.values[at]) + change) as f32;
        // Light is not negative.
        values[at] = if plain >= 0.0 { filtered.max(0.0) } else { filtered };
    }
    let squares = [expected_squares(&sums, &fit, cell_sums(block.size, |at| [risks[at]]))];
    for at in (0..errors.len()).filter(|&at| pixels.weight.values[at] > 0.0) {
        let [square] = interpolation.at(&squares, at);
        errors[at] = square.sqrt() as f32;
    }
    (values, errors)
}

/// Expected squared error around each cell: variance, risk of the fit, and squared bias. The squared bias is what the
/// estimated risk has beyond the others, if that is positive.
fn expected_squares(sums: &CellSums, fit: &Fit, [risks]: [Plane<f64>; 1]) -> Plane<f64> {
    let cells = risks.size;
    let excess = Plane::from_cells(cells, |cell| {
        // A risk that was minimised is too small by as much as the fit adds.
        let known = fit.variance.values[cell] - fit.risk.values[cell];
        risks.values[cell] - known * sums.variance.values[cell]
    });
    let excess = windowed(&excess, WIDE_OF_ERRORS).values;
    let variance = windowed(&sums.variance, WIDE_OF_ERRORS).values;
    Plane::from_cells(cells, |cell| {
        let bias = ratio(excess[cell], variance[cell]).max(0.0);
        let noise = (fit.variance.values[cell] + fit.risk.values[cell]).max(LEAST_VARIANCE);
        (bias + noise) * sums.level.values[cell]
    })
}
