//! Passes over the pixels of a view: one ray per block of pixels, then one per pixel, again and again.

use glam::{DVec2, UVec2};
use rayon::prelude::*;

use super::shading::{Lit, PixelColour, Shading, exposed};
use crate::accel::{Hit, Ray, RayBatch};
use crate::extract::Stage;
use crate::sampling::{Key, Sampler};
use crate::transport::PerspectiveCamera;

/// Side of the blocks of the coarse pass, pixels.
const COARSE: u32 = 4;

/// Rows that are traced together.
const ROWS: usize = 8;

/// Sums of the colours of all pixels, row by row from the top left.
#[derive(Clone, Debug)]
pub(super) struct Accumulator {
    size: UVec2,
    sums: Vec<PixelColour>,
    /// Number of samples per pixel; 0 after the coarse pass alone.
    samples: u32,
}

/// Point of the film, and what its ray finds.
struct Sample {
    ray: Ray,
    numbers: [f64; 2],
}

impl Accumulator {
    pub(super) fn new(size: UVec2) -> Self {
        let pixels = (size.x * size.y) as usize;
        Self { size, sums: vec![PixelColour::default(); pixels], samples: 0 }
    }

    /// Fills each block of pixels with the colour of one ray through its middle.
    pub(super) fn add_coarse(
        &mut self,
        stage: &Stage,
        camera: &PerspectiveCamera,
        shading: &Shading,
    ) {
        let blocks = UVec2::new(self.size.x.div_ceil(COARSE), self.size.y.div_ceil(COARSE));
        let colours: Vec<PixelColour> = (0..blocks.y)
            .into_par_iter()
            .flat_map_iter(|row| {
                let samples = (0..blocks.x).map(|column| {
                    let middle =
                        (UVec2::new(column, row) * COARSE).as_dvec2() + 0.5 * f64::from(COARSE);
                    sample(
                        camera,
                        middle.min(self.size.as_dvec2() - 0.5) / self.size.as_dvec2(),
                        [0.3, 0.3],
                    )
                });
                shade(stage, shading, &samples.collect::<Vec<_>>())
            })
            .collect();
        for (index, sum) in self.sums.iter_mut().enumerate() {
            let at = UVec2::new(index as u32 % self.size.x, index as u32 / self.size.x) / COARSE;
            *sum = colours[(at.y * blocks.x + at.x) as usize];
        }
    }

    /// Adds one sample to each pixel; the first replaces the coarse pass.
    pub(super) fn add(
        &mut self,
        pass: u32,
        stage: &Stage,
        camera: &PerspectiveCamera,
        shading: &Shading,
    ) {
        if self.samples == 0 {
            self.sums.fill(PixelColour::default());
        }
        self.samples += 1;
        let Self { size, sums, .. } = self;
        let strip = ROWS * size.x as usize;
        let pixels = size.as_dvec2();
        sums.par_chunks_mut(strip).enumerate().for_each(|(index, sums)| {
            // Rays of neighbours meet the same trees: square after square, not row after row.
            let mut offsets: Vec<usize> = (0..sums.len()).collect();
            offsets.sort_by_key(|offset| offset % size.x as usize / ROWS);
            let samples: Vec<Sample> = offsets
                .iter()
                .map(|offset| {
                    let pixel = index * strip + offset;
                    let key = Key::new(0).path("preview").index(pixel as u64);
                    let [x, y, u, v] = Sampler::new(key, pass.into()).next_4d();
                    let corner =
                        DVec2::new((pixel as u32 % size.x).into(), (pixel as u32 / size.x).into());
                    sample(camera, (corner + DVec2::new(x, y)) / pixels, [u, v])
                })
                .collect();
            let colours = shade(stage, shading, &samples);
            for (offset, colour) in offsets.into_iter().zip(colours) {
                sums[offset].add(colour);
            }
        });
    }

    /// Red, green and blue of the picture so far, shape `[rows, columns, 3]`.
    pub(super) fn rgb(&self) -> Vec<u8> {
        exposed(&self.sums, self.samples.max(1))
    }
}

fn sample(camera: &PerspectiveCamera, at: DVec2, numbers: [f64; 2]) -> Sample {
    Sample { ray: camera.ray(at), numbers }
}

/// Colour of each sample.
fn shade(stage: &Stage, shading: &Shading, samples: &[Sample]) -> Vec<PixelColour> {
    let rays: Vec<Ray> = samples.iter().map(|sample| sample.ray).collect();
    let mut hits: Vec<Option<Hit>> = vec![None; rays.len()];
    stage.geometry.trace_each(RayBatch {
        shadow_rays: &[],
        occluded: &mut [],
        closest_rays: &rays,
        hits: &mut hits,
    });
    let lit: Vec<Option<Lit>> = samples
        .iter()
        .zip(&hits)
        .map(|(sample, hit)| {
            hit.as_ref().map(|hit| shading.light(stage, &sample.ray, hit, sample.numbers))
        })
        .collect();
    let shadows: Vec<Ray> = hits
        .iter()
        .zip(&lit)
        .filter_map(|(hit, lit)| Some(shading.shadow_rays(hit.as_ref()?, lit.as_ref()?)))
        .flatten()
        .collect();
    let mut occluded = vec![false; shadows.len()];
    stage.geometry.trace_each(RayBatch {
        shadow_rays: &shadows,
        occluded: &mut occluded,
        closest_rays: &[],
        hits: &mut [],
    });
    let mut next = occluded.chunks_exact(2);
    let colour = |(sample, lit): (&Sample, &Option<Lit>)| match lit {
        None => PixelColour::from_background(Shading::background(sample.ray.direction)),
        Some(lit) => {
            let of_hit = next.next().expect("two shadow rays per hit");
            PixelColour::from_surface(Shading::colour(lit, [of_hit[0], of_hit[1]]))
        }
    };
    samples.iter().zip(&lit).map(colour).collect()
}
