//! Rectangles of numbers: convolution, sums over cells, and interpolation between their middles.

use std::ops::{AddAssign, Mul, Range};

/// Side of a cell, pixels.
pub(super) const CELL: usize = 8;

/// Width and height of a rectangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Size {
    pub(super) width: usize,
    pub(super) height: usize,
}

impl Size {
    pub(super) const fn area(self) -> usize {
        self.width * self.height
    }

    /// Columns and rows of cells that cover it.
    const fn in_cells(self) -> Self {
        Self { width: self.width.div_ceil(CELL), height: self.height.div_ceil(CELL) }
    }
}

/// Numbers of a rectangle, row by row.
#[derive(Clone, Debug)]
pub(super) struct Plane<T> {
    pub(super) size: Size,
    pub(super) values: Vec<T>,
}

impl<T: Copy + Default + Mul<Output = T> + AddAssign> Plane<T> {
    /// Convolution with a symmetric kernel along rows and columns; numbers beside the rectangle are 0.
    pub(super) fn convolved(&self, kernel: &[T]) -> Self {
        let Size { width, height } = self.size;
        let radius = kernel.len() / 2;
        let mut along_rows = vec![T::default(); self.values.len()];
        let rows = along_rows.chunks_exact_mut(width).zip(self.values.chunks_exact(width));
        for (sums, values) in rows {
            for (tap, &weight) in kernel.iter().enumerate() {
                let shift = tap.abs_diff(radius).min(width);
                if tap < radius {
                    add(&mut sums[shift..], &values[..width - shift], weight);
                } else {
                    add(&mut sums[..width - shift], &values[shift..], weight);
                }
            }
        }
        let mut convolved = vec![T::default(); self.values.len()];
        for (row, sums) in convolved.chunks_exact_mut(width).enumerate() {
            for (tap, &weight) in kernel.iter().enumerate() {
                let Some(other) = (row + tap).checked_sub(radius) else { continue };
                if other < height {
                    add(sums, &along_rows[other * width..(other + 1) * width], weight);
                }
            }
        }
        Self { size: self.size, values: convolved }
    }
}

/// Adds values times a weight.
fn add<T: Copy + Mul<Output = T> + AddAssign>(sums: &mut [T], values: &[T], weight: T) {
    for (sum, &value) in sums.iter_mut().zip(values) {
        *sum += weight * value;
    }
}

impl Plane<f64> {
    /// Plane of cells whose values are functions of those of other planes of cells.
    pub(super) fn from_cells(size: Size, value: impl FnMut(usize) -> f64) -> Self {
        Self { size, values: (0..size.area()).map(value).collect() }
    }
}

/// Sums over the cells of a rectangle; `values` returns those of a pixel.
pub(super) fn cell_sums<const N: usize>(
    size: Size,
    values: impl Fn(usize) -> [f64; N],
) -> [Plane<f64>; N] {
    let cells = size.in_cells();
    let mut sums = std::array::from_fn(|_| Plane::from_cells(cells, |_| 0.0));
    for cell in 0..cells.area() {
        let mut totals = [0.0; N];
        for row in pixels_of(cell / cells.width, size.height) {
            for column in pixels_of(cell % cells.width, size.width) {
                for (total, value) in totals.iter_mut().zip(values(row * size.width + column)) {
                    *total += value;
                }
            }
        }
        for (plane, total) in sums.iter_mut().zip(totals) {
            plane.values[cell] = total;
        }
    }
    sums
}

/// Rows or columns of pixels in a row or column of cells.
fn pixels_of(cell: usize, end: usize) -> Range<usize> {
    cell * CELL..((cell + 1) * CELL).min(end)
}

/// Bilinear interpolation between the middles of cells; constant beyond the outermost ones.
pub(super) struct Interpolation {
    cells: Size,
    columns: Vec<Place>,
    rows: Vec<Place>,
}

/// Cells on both sides of a coordinate, and the weight of the second one.
#[derive(Clone, Copy)]
struct Place {
    cells: [usize; 2],
    fraction: f64,
}

impl Interpolation {
    /// Interpolation at the pixels of a rectangle.
    pub(super) fn new(size: Size) -> Self {
        let cells = size.in_cells();
        let places = |pixels: usize, cells: usize| {
            let place = |pixel: usize| {
                let at = ((pixel as f64 + 0.5) / CELL as f64 - 0.5).clamp(0.0, cells as f64 - 1.0);
                let first = at as usize;
                Place { cells: [first, (first + 1).min(cells - 1)], fraction: at - first as f64 }
            };
            (0..pixels).map(place).collect()
        };
        let columns = places(size.width, cells.width);
        Self { cells, columns, rows: places(size.height, cells.height) }
    }

    /// Values at a pixel.
    pub(super) fn at<const N: usize>(&self, planes: &[Plane<f64>; N], pixel: usize) -> [f64; N] {
        let row = self.rows[pixel / self.columns.len()];
        let column = self.columns[pixel % self.columns.len()];
        planes.each_ref().map(|plane| {
            let [upper, lower] = row.cells.map(|row| {
                let [left, right] =
                    column.cells.map(|column| plane.values[row * self.cells.width + column]);
                left + column.fraction * (right - left)
            });
            upper + row.fraction * (lower - upper)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A point becomes the kernel, cut at the border.
    #[test]
    fn a_point_is_convolved_to_the_kernel() {
        let size = Size { width: 4, height: 3 };
        let mut plane = Plane { size, values: vec![0.0; 12] };
        plane.values[4] = 1.0;
        let kernel = [1.0, 2.0, 4.0, 2.0, 1.0];
        let expected = [8.0, 4.0, 2.0, 0.0, 16.0, 8.0, 4.0, 0.0, 8.0, 4.0, 2.0, 0.0];
        assert_eq!(plane.convolved(&kernel).values, expected);
    }

    /// A linear function of the position is interpolated to itself between the middles of the cells.
    #[test]
    fn means_of_cells_are_interpolated_linearly() {
        let size = Size { width: 40, height: 24 };
        let linear = |pixel: usize| 2.0 * (pixel % 40) as f64 - (pixel / 40) as f64;
        let [sums, counts] = cell_sums(size, |pixel| [linear(pixel), 1.0]);
        let mean = |cell: usize| sums.values[cell] / counts.values[cell];
        let means = [Plane::from_cells(sums.size, mean)];
        let interpolation = Interpolation::new(size);
        for (row, column) in [(4, 4), (10, 31), (19, 35)] {
            let pixel = row * 40 + column;
            let [value] = interpolation.at(&means, pixel);
            assert!((value - linear(pixel)).abs() < 1e-9, "{row} {column}: {value}");
        }
    }
}
