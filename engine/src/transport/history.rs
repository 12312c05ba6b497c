//! What happens on a path, written down before any spectrum is looked at.

use std::ops::Range;

use crate::scattering::{LANES, add_lit, add_seen, multiply};

/// Bands that are worked on at a time: so few that what is summed in them stays in registers and in the
/// first cache, however many a scene has.
pub(super) const BLOCK: usize = 64;

/// A value in each of at most so many bands.
pub(super) type Block = [f64; BLOCK];

/// These bands, block by block.
pub(super) fn blocks(bands: Range<usize>) -> impl Iterator<Item = Range<usize>> {
    let end = bands.end;
    bands.step_by(BLOCK).map(move |start| start..(start + BLOCK).min(end))
}

/// The spectra that light on a path is multiplied with, in order. The light of all bands is found from them
/// at the path's end, block by block of bands: no spectrum is carried from event to event.
///
/// With the throughput `T`, 1 at the start: `L = Σ T f S` over all light that the path gathers.
#[derive(Clone, Debug, Default)]
pub(super) struct History<'a> {
    steps: Vec<Step<'a>>,
}

/// Spectra of shape `[lanes]`, and a factor that all bands share.
#[derive(Clone, Copy, Debug)]
enum Step<'a> {
    /// `T ← T f c`.
    Scattering(&'a [f32], f32),
    /// `L ← L + T f S c` of a source `S`.
    Lit(&'a [f32], &'a [f32], f32),
    /// `L ← L + T S c`: the source itself is seen.
    Seen(&'a [f32], f32),
}

impl<'a> History<'a> {
    /// Forgets all.
    pub(super) fn clear(&mut self) {
        self.steps.clear();
    }

    /// Number of steps so far.
    pub(super) const fn len(&self) -> usize {
        self.steps.len()
    }

    /// The path is scattered, `f c`.
    pub(super) fn scatter(&mut self, spectrum: &'a [f32], scale: f32) {
        self.steps.push(Step::Scattering(spectrum, scale));
    }

    /// A surface sends light of a source along the path, `f S c`.
    pub(super) fn light(&mut self, spectrum: &'a [f32], source: &'a [f32], scale: f32) {
        self.steps.push(Step::Lit(spectrum, source, scale));
    }

    /// The path sees a source, `S c`.
    pub(super) fn see(&mut self, source: &'a [f32], scale: f32) {
        self.steps.push(Step::Seen(source, scale));
    }

    /// Light of the first `steps` in at most [`BLOCK`] bands.
    #[inline(always)]
    pub(super) fn light_of(&self, steps: usize, bands: Range<usize>, found: &mut Block) {
        // Spectra go on to the end of a group of lanes.
        let lanes = bands.start..bands.start + bands.len().next_multiple_of(LANES);
        let (mut throughput, mut light) = ([1.0; BLOCK], [0.0; BLOCK]);
        for step in &self.steps[..steps] {
            match *step {
                Step::Scattering(f, c) => multiply(&mut throughput, &f[lanes.clone()], c),
                Step::Lit(f, s, c) => {
                    let (f, s) = (&f[lanes.clone()], &s[lanes.clone()]);
                    add_lit(&mut light, &throughput, (f, s, c));
                }
                Step::Seen(s, c) => add_seen(&mut light, &throughput, (&s[lanes.clone()], c)),
            }
        }
        for (found, light) in found[..lanes.len()].iter_mut().zip(&light) {
            *found = f64::from(*light);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In whichever bands it is asked for, light is the sum of what each step says, band by band.
    #[test]
    fn blocks_of_bands_hold_the_light_of_all_steps() {
        for bands in [1, 8, 63, 64, 65, 200_usize] {
            let spectrum = |seed: usize| -> Vec<f32> {
                let value = |band: usize| {
                    if band < bands { ((band * 31 + seed * 17) % 7) as f32 / 7.0 } else { 0.0 }
                };
                (0..bands.next_multiple_of(LANES)).map(value).collect()
            };
            let [a, b, source, black] = [1, 2, 3, 4].map(spectrum);
            let mut history = History::default();
            history.light(&a, &source, 0.5);
            history.scatter(&a, 2.0);
            history.light(&black, &b, 1.0);
            history.scatter(&b, 0.25);
            history.see(&source, 3.0);
            let mut seen = 0;
            for block in blocks(0..bands) {
                let mut found = [f64::NAN; BLOCK];
                history.light_of(history.len(), block.clone(), &mut found);
                for (band, found) in block.zip(found) {
                    let [a, b, s, black] = [&a, &b, &source, &black].map(|of| f64::from(of[band]));
                    let light = a * s * 0.5 + 2.0 * a * (b * black + 0.25 * b * s * 3.0);
                    assert!((found - light).abs() < 1e-6, "{bands}: {band}: {found} for {light}");
                    seen += 1;
                }
            }
            assert_eq!(seen, bands);
        }
    }
}
