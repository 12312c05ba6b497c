use super::*;
use crate::products::Rendering;
use crate::sampling::{Key, Sampler};

/// Image whose pixels have a value, a standard error and a coverage.
fn product(width: usize, height: usize, pixels: PixelRows) -> Product {
    let bands = pixels.columns();
    Product {
        name: "brf".to_owned(),
        unit: "1".to_owned(),
        dimensions: Vec::new(),
        values: vec![0.25; bands],
        standard_error: vec![0.01; bands],
        replicates: Vec::new(),
        image: Some(Image {
            width,
            height,
            bands: (0..bands).map(|band| format!("b{band}")).collect(),
            pixels: pixels.into(),
            has_errors: true,
            rendering: Rendering::Quicklook,
            georeference: None,
        }),
        faces: None,
    }
}

fn denoised_pixels(width: usize, height: usize, pixels: PixelRows) -> PixelRows {
    let product = denoised(&product(width, height, pixels)).expect("an image");
    product.image.expect("an image").load().expect("memory")
}

/// Independent standard normal numbers.
fn normal(key: Key, count: usize) -> Vec<f64> {
    let pair = |index: usize| {
        let [u, v, ..] = Sampler::new(key.index(index as u64), 0).next_4d();
        let radius = (-2.0 * (1.0 - u).ln()).sqrt();
        [radius * (std::f64::consts::TAU * v).cos(), radius * (std::f64::consts::TAU * v).sin()]
    };
    (0..count.div_ceil(2)).flat_map(pair).take(count).collect()
}

/// Images of known truth: smooth, with edges, and of texture without any correlation.
fn truth(kind: &str, width: usize, height: usize) -> Vec<f64> {
    let texture = normal(Key::new(3).path("texture"), width * height);
    let value = |at: usize| {
        let (row, column) = (at / width, at % width);
        match kind {
            "slope" => 20.0 + 0.01 * row as f64 + 0.02 * column as f64,
            "edges" => 20.0 + if (row / 20 + column / 30) % 2 == 0 { 8.0 } else { 0.0 },
            "texture" => 20.0 + texture[at],
            kind => panic!("no image of {kind}"),
        }
    };
    (0..width * height).map(value).collect()
}

/// An image with noise: the fraction of its mean squared error that is left, and the mean of
/// `(error / standard error)²`.
fn gain(kind: &str, key: Key, (width, height): (usize, usize), sigma: f64) -> (f64, f64) {
    let truth = truth(kind, width, height);
    let noise = normal(key, truth.len());
    let pixels = PixelRows {
        width,
        values: truth.iter().zip(&noise).map(|(x, n)| (x + sigma * n) as f32).collect(),
        standard_error: vec![sigma as f32; truth.len()],
        coverage: vec![1.0; truth.len()],
    };
    let filtered = denoised_pixels(width, height, pixels);
    let (mut square, mut standardised) = (0.0, 0.0);
    for ((&value, &error), truth) in
        filtered.values.iter().zip(&filtered.standard_error).zip(&truth)
    {
        let deviation = (f64::from(value) - truth).powi(2);
        square += deviation;
        standardised += deviation / f64::from(error).powi(2);
    }
    let count = truth.len() as f64;
    (square / (count * sigma * sigma), standardised / count)
}

/// *Expected*: of the squared error, the fraction of a Wiener filter is left, for texture without correlation
/// `S / (S + V)`: 1/2 and 1/1.09. Errors are those of the denoised pixels in the mean; where next to nothing is left, they
/// are too large rather than too small, since a squared bias is not estimated below 0.
#[test]
fn squared_errors_fall_to_those_of_a_wiener_filter_and_are_told() {
    for (kind, sigma, least, most) in [
        ("texture", 1.0, 0.48, 0.53),
        ("texture", 0.3, 0.89, 0.95),
        ("slope", 1.0, 0.005, 0.03),
        ("edges", 1.0, 0.4, 0.55),
    ] {
        let keys = (0..4).map(|seed| Key::new(seed).path("noise"));
        let results: Vec<_> = keys.map(|key| gain(kind, key, (140, 150), sigma)).collect();
        let mean = |of: fn(&(f64, f64)) -> f64| results.iter().map(of).sum::<f64>() / 4.0;
        let (left, standardised) = (mean(|one| one.0), mean(|one| one.1));
        assert!((least..most).contains(&left), "{kind} {sigma}: {left:.3} left");
        let least = if kind == "slope" { 0.4 } else { 0.8 };
        assert!((least..1.25).contains(&standardised), "{kind} {sigma}: z² {standardised:.3}");
        for (left, _) in results {
            assert!(left < 1.02, "{kind} {sigma}: {left:.3} left");
        }
    }
}

/// Pixels do not depend on the rows that are asked for, nor on the number of threads.
#[test]
fn parts_of_an_image_are_those_of_the_whole_for_any_threads() {
    let (width, height, bands) = (300, 270, 2);
    let noise = normal(Key::new(1), width * height * bands);
    let pixels = PixelRows {
        width,
        values: noise.iter().map(|n| (3.0 + n) as f32).collect(),
        standard_error: vec![1.0; noise.len()],
        coverage: vec![1.0; width * height],
    };
    let product = product(width, height, pixels);
    let bits = |rows: &[Range<usize>], threads: usize| -> Vec<u32> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let image = denoised(&product).and_then(|product| product.image).expect("an image");
            let parts = rows.iter().map(|rows| image.pixels.rows(rows.clone()).expect("memory"));
            let numbers =
                parts.flat_map(|part| [part.values, part.standard_error]).collect::<Vec<_>>();
            let [values, errors] =
                [0, 1].map(|which| numbers.iter().skip(which).step_by(2).flatten());
            values.chain(errors).map(|value| value.to_bits()).collect()
        })
    };
    let all = std::slice::from_ref(&(0..270));
    let whole = bits(all, 1);
    assert_eq!(whole.len(), 2 * width * height * bands);
    assert_eq!(whole, bits(all, 3));
    assert_eq!(whole, bits(&[0..16, 16..32, 32..129, 129..269, 269..270], 2));
}

/// Bands of a strip that are filtered in several chunks are those of one chunk, whatever the other bands hold.
#[test]
fn bands_are_filtered_one_by_one() {
    let (width, height, bands) = (40, 20, 3);
    let noise = normal(Key::new(5), width * height * bands);
    let pixels = PixelRows {
        width,
        values: noise.iter().map(|n| (3.0 + n) as f32).collect(),
        standard_error: vec![1.0; noise.len()],
        coverage: vec![1.0; width * height],
    };
    let one = denoised_pixels(width, height, pixels.clone().select_columns(1..2));
    let layout = Layout { chunk: 2, rows: 16, ..Layout::new(width, height, bands) };
    let strips = Strips { layout, plain: pixels.into(), last: Mutex::new(None) };
    let all = strips.rows(0..height).expect("memory").select_columns(1..2);
    assert_eq!(one.values, all.values);
    assert_eq!(one.standard_error, all.standard_error);
}

/// A single pixel stays, as do pixels that show nothing, have no error, or no noise.
#[test]
fn what_cannot_be_filtered_stays() {
    let filter = |width: usize, pixels: &[(f32, f32, f32)]| {
        let of = |f: fn(&(f32, f32, f32)) -> f32| pixels.iter().map(f).collect::<Vec<_>>();
        let (values, standard_error) = (of(|one| one.0), of(|one| one.1));
        let pixels = PixelRows { width, values, standard_error, coverage: of(|one| one.2) };
        let height = pixels.coverage.len() / width;
        let filtered = denoised_pixels(width, height, pixels);
        let pairs = filtered.values.into_iter().zip(filtered.standard_error);
        pairs.collect::<Vec<_>>()
    };
    assert_eq!(filter(1, &[(0.5, 0.1, 1.0)]), [(0.5, 0.1)]);
    let nothing = (f32::NAN, f32::NAN, 0.0);
    for (value, error) in filter(2, &[nothing; 6]) {
        assert!(value.is_nan() && error.is_nan());
    }
    let without_error = filter(3, &[(0.5, f32::NAN, 1.0), nothing, (0.25, 0.1, 0.5)]);
    assert_eq!(without_error[0].0.to_bits(), 0.5_f32.to_bits());
    assert!(without_error[0].1.is_nan());
    assert!(without_error[1].0.is_nan() && without_error[1].1.is_nan());
    assert_eq!(without_error[2], (0.25, 0.1));
    assert!(
        filter(4, &[(0.5, 0.0, 1.0), (1.0, 0.0, 1.0)].repeat(8))
            .chunks(2)
            .all(|pair| { pair == [(0.5, 0.0), (1.0, 0.0)] })
    );
    for width in [1, 3, 17] {
        let row = filter(width, &[(0.5, 0.1, 1.0), (0.6, 0.1, 1.0), (0.4, 0.1, 0.5)].repeat(17));
        let is_mean = |(value, error): &(f32, f32)| (0.35..0.65).contains(value) && *error > 0.0;
        assert!(row.iter().all(is_mean), "{width}: {row:?}");
    }
}

/// The mean of the image stays that of the plain one; its name and pixels differ.
#[test]
fn a_denoised_product_says_so_and_keeps_its_mean() {
    let pixels = PixelRows {
        width: 2,
        values: vec![1.0, 2.0, 3.0, 4.0],
        standard_error: vec![1.0; 4],
        coverage: vec![1.0; 4],
    };
    let plain = product(2, 2, pixels);
    let filtered = denoised(&plain).expect("an image");
    assert_eq!(filtered.name, "brf_denoised");
    assert_eq!((filtered.values, filtered.standard_error), (plain.values, plain.standard_error));
    assert!(denoised(&Product { image: None, ..product(1, 1, PixelRows::default()) }).is_none());
}
