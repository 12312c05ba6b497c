//! Reported standard errors are right: estimates lie about the truth as their errors say.
//!
//! Each of many sensors, which differ in nothing but their name and so in their random numbers,
//! measures the same values; z = (estimate - truth) / error of each must have a standard deviation of
//! about 1, a mean of 0 and few values beyond 3. The truth is an independent measurement of far more
//! samples, whose own error is added in quadrature.
//!
//! With n randomisations z follows Student's t with n - 1 degrees of freedom: of 32, standard
//! deviation 1.034 and 0.53 % beyond 3; of 16, 1.074 and 0.90 %.

use std::fmt::Write as _;

use sunfleck::products::{Product, Report};
use sunfleck_tests::{Estimate, SceneText, product};

/// A tile of 1 m² with two small crowns over soil, without end, in red, near infrared and 10.5 µm.
fn grove(sensors: &str) -> Report {
    SceneText::bare(0.0, "size_m: (1.0, 1.0)")
        .with("bands", r#"(name: "red", center_nm: 660.0), (name: "nir", center_nm: 865.0), (name: "tir", center_nm: 10500.0)"#)
        .with("materials", r#"
        "soil": Lambertian(
            reflectance: Bands([0.127, 0.2, 0.06]), temperature: SunlitShaded(sunlit_k: 315.0, shaded_k: 300.0),
        ),
        "leaf": Leaf(
            reflectance: Bands([0.05, 0.5, 0.02]), transmittance: Bands([0.03, 0.45, 0.0]),
            temperature: SunlitShaded(sunlit_k: 300.0, shaded_k: 297.0),
        )"#)
        .with("meshes", r#""crown": Crown(
        shape: Ellipsoid(diameter_m: 0.5, height_m: 0.8), base_m: 0.1, leaf_area_m2: 0.8,
        leaf: Square(side_m: 0.06), leaf_material: "leaf",
    )"#)
        .with("instances", r#"List(of: "crown", at_m: [(0.3, 0.3, 0.0), (0.8, 0.7, 0.0)])"#)
        .with("sun", "zenith_deg: 40.0, azimuth_deg: 150.0, irradiance: Constant(1.0)")
        .with("sky", "Fraction([0.2, 0.1, 0.0])")
        .with("thermal_sky", "BlackBody(240.0)")
        .with("boundary", "Periodic")
        .with("sensors", sensors)
        .measure()
}

/// A sensor that measures the truth, and behind it so many of each other kind, named by numbers; their
/// random streams have these names.
fn crowd(truth: &str, count: usize, others: &[(&str, String)]) -> Report {
    let mut sensors = format!("\"truth\": {truth},\n");
    for (kind, text) in others {
        for number in 0..count {
            writeln!(sensors, "\"{kind}{number}\": {text},").expect("memory");
        }
    }
    grove(&sensors)
}

/// Numbers of a product in one of the three bands.
fn in_band(product: &Product, band: usize) -> Vec<Estimate> {
    (band..product.values.len()).step_by(3).map(|at| Estimate::of(product, at)).collect()
}

/// Pixels of a product in one of its bands.
fn pixels_in_band(product: &Product, band: usize) -> Vec<Estimate> {
    let image = product.image.as_ref().expect("pixels");
    let pixels = image.load().expect("pixels can be read");
    let pairs = pixels.values.iter().zip(&pixels.standard_error);
    let in_band = pairs.skip(band).step_by(image.bands.len());
    in_band.map(|(&value, &error)| Estimate { value: value.into(), error: error.into() }).collect()
}

/// Deviations from the truth, in standard errors, of what `values` picks of a product of all sensors
/// whose names start with `kind`, each with the share in it that the truth's own error has: that is the
/// same in all of one value. Nothing is said of values that are 0 for certain.
fn deviations(
    report: &Report,
    (kind, name): (&str, &str),
    values: impl Fn(&Product) -> Vec<Estimate>,
) -> Vec<[f64; 2]> {
    let truth = values(product(report, "truth", name));
    let of_kind = report.sensors.iter().filter(|one| one.name.starts_with(kind));
    let found: Vec<_> = of_kind.map(|one| values(product(report, &one.name, name))).collect();
    let pairs = found.iter().flat_map(|found| found.iter().zip(&truth));
    let pairs = pairs.filter(|(_, truth)| truth.error > 0.0);
    let of_truth =
        |estimate: &Estimate, truth: &Estimate| truth.error / estimate.error.hypot(truth.error);
    pairs.map(|(one, truth)| [one.z_against(*truth), of_truth(one, truth)]).collect()
}

/// Asserts that deviations in standard errors are spread as they should be: all together exactly so,
/// each product's but for three standard errors of what is asserted, as there are dozens of them.
#[expect(clippy::print_stdout, reason = "`--nocapture` shows the table")]
fn assert_calibrated(products: &[(String, Vec<[f64; 2]>)]) {
    let all: Vec<[f64; 2]> = products.iter().flat_map(|(_, z)| z).copied().collect();
    let together = ("together".to_owned(), all);
    for (margin, (what, z)) in
        products.iter().map(|product| (3.0, product)).chain([(0.0, &together)])
    {
        let n = z.len() as f64;
        let of_truth = z.iter().map(|[_, share]| share).sum::<f64>() / n;
        let z: Vec<f64> = z.iter().map(|[z, _]| *z).collect();
        let mean = z.iter().sum::<f64>() / n;
        let deviation = (z.iter().map(|z| (z - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt();
        let far = z.iter().filter(|z| z.abs() > 3.0).count() as f64 / n;
        let found = format!(
            "{what}: {n} values, mean {mean:.3}, standard deviation {deviation:.3}, {:.2} % beyond 3",
            100.0 * far
        );
        println!("{found}");
        assert!(n >= 1000.0, "{found}");
        let more = margin / (2.0 * n).sqrt();
        assert!(deviation > 0.9 - more && deviation < 1.1 + more, "{found}");
        assert!(far < 0.01 + margin * (0.0053 / n).sqrt(), "{found}");
        // Four standard errors of the mean of 1000 values (of more, bands and places in one run depend
        // on each other) that are all off by what the truth is off.
        assert!(mean.abs() < 4.0 * (1.0 / 1000_f64 + of_truth * of_truth).sqrt(), "{found}");
    }
}

/// *Scene*: 1000 times 1000 photon packets on the grove. *Expected*: calibrated albedo, absorption by
/// layer and material, transmission, fluxes by pixel, and emitted exitance.
#[test]
fn errors_of_photons_are_right() {
    let photons = |per_m2: u32| {
        format!(
            "Photons(per_m2: {per_m2}.0, measure: [Albedo, Fapar(layer_m: 0.3), Fluxes(pixel_m: 0.5), Exitance])"
        )
    };
    let report = crowd(&photons(300_000), 1000, &[("a", photons(1000))]);
    let mut z = Vec::new();
    let mut add = |name: &str, band, of: fn(&Product, usize) -> Vec<Estimate>| {
        let deviations = deviations(&report, ("a", name), |product| of(product, band));
        z.push((format!("{name}, band {band}"), deviations));
    };
    for band in 0..2 {
        for name in ["albedo", "fapar", "fapar_vegetation", "ftran"] {
            add(name, band, in_band);
        }
    }
    for band in 0..3 {
        for name in ["downwelling_terrain", "upwelling_terrain", "upwelling_top"] {
            add(name, band, pixels_in_band);
        }
    }
    add("exitance", 2, in_band);
    assert_calibrated(&z);
}

/// *Scene*: four views of the grove, 250 times each, of a fixed number of samples in both systems and
/// until they are good enough. *Expected*: calibrated radiances, reflected and emitted.
#[test]
fn errors_of_directions_are_right() {
    let views = |view: &str, until: &str, system: &str| {
        format!(
            "Directions(views: List([{view}]), until: {until}, system: {system}, measure: [Radiance])"
        )
    };
    let kinds = [
        ("samples", "Samples(512)", "Backward"),
        ("error", "RelError(0.04)", "Backward"),
        ("packets", "Samples(512)", "Forward"),
    ];
    let mut z = vec![Vec::new(); 8];
    // Views of one sensor see the same light, and would not be independent: nor would those of sensors
    // of the same name.
    for (letter, view) in
        [("a", "(0.0, 0.0)"), ("b", "(40.0, 150.0)"), ("c", "(30.0, 330.0)"), ("d", "(70.0, 60.0)")]
    {
        let names = kinds.map(|(kind, ..)| format!("{kind} {letter}"));
        let others: Vec<_> = kinds
            .iter()
            .zip(&names)
            .map(|((_, until, system), name)| (name.as_str(), views(view, until, system)))
            .collect();
        let report = crowd(&views(view, "Samples(65536)", "Backward"), 250, &others);
        // Of 512 lines along which packets of emitted light start, few reach the crowns: these radiances
        // have a skew, and z of them a mean of -0.16 (standard deviation 1.08).
        for (index, z) in z.iter_mut().enumerate() {
            let of = (names[index / 3].as_str(), "radiance");
            z.extend(deviations(&report, of, |product| in_band(product, index % 3)));
        }
    }
    let named = |(index, z): (usize, _)| (format!("{}, band {}", kinds[index / 3].0, index % 3), z);
    assert_calibrated(&z.into_iter().enumerate().map(named).collect::<Vec<_>>());
}

/// *Scene*: an oblique image of the grove, 400 times each of 2, 3, 4 and 32 samples per pixel. *Expected*: calibrated means over
/// the image, reflected and emitted. The sum of z² over 400 images has the χ² distribution with 400 degrees of freedom,
/// as the errors themselves have one degree of freedom per pixel: mean of z² 1, standard deviation √(2 / 400), of which four
/// are allowed. The errors of rows with one sample per pixel each had z² of 2.5 at 4 samples.
#[test]
fn errors_of_means_over_images_are_right_at_few_samples() {
    let image = |samples: u32| {
        format!(
            "Orthographic(size_px: (16, 16), cover: Some(WholeScene), zenith_deg: 30.0, azimuth_deg: 80.0, samples_per_px: {samples}, measure: [Radiance])"
        )
    };
    let kinds = [2, 3, 4, 32].map(|samples| (format!("{samples} samples"), image(samples)));
    let others: Vec<_> = kinds.iter().map(|(kind, text)| (kind.as_str(), text.clone())).collect();
    let report = crowd(&image(4096), 400, &others);
    for (kind, _) in &others {
        for band in 0..3 {
            let z = deviations(&report, (kind, "radiance"), |product| in_band(product, band));
            let n = z.len() as f64;
            let mean_square = z.iter().map(|[z, _]| z * z).sum::<f64>() / n;
            let bound = 4.0 * (2.0 / n).sqrt();
            assert!(
                z.len() == 400 && (mean_square - 1.0).abs() < bound,
                "{kind}, band {band}: {mean_square:.3}"
            );
        }
    }
}

/// *Scene*: an oblique image of the grove, 6 times each of 16 and of 256 samples a pixel. *Expected*:
/// calibrated radiances of pixels, reflected and emitted.
#[test]
fn errors_of_pixels_are_right() {
    let image = |samples: u32| {
        format!(
            "Orthographic(size_px: (16, 16), cover: Some(WholeScene), zenith_deg: 30.0, azimuth_deg: 80.0, samples_per_px: {samples}, measure: [Radiance])"
        )
    };
    let report = crowd(&image(2048), 6, &[("few", image(16)), ("many", image(256))]);
    let of = |kind: &str, band: usize| {
        let of_band = |product: &Product| pixels_in_band(product, band);
        (format!("{kind}, band {band}"), deviations(&report, (kind, "radiance"), of_band))
    };
    for kind in ["few", "many"] {
        assert_calibrated(&[0, 1, 2].map(|band| of(kind, band)));
    }
}
