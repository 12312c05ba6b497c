//! Transport systems that share as little as can be find the same values.

use sunfleck::products::Product;
use sunfleck_tests::{Estimate, SceneText, product};

/// Two trees of three bands on soil, without a sky.
fn grove() -> SceneText {
    SceneText::two_trees()
        .with("bands", r#"(name: "red", center_nm: 660.0), (name: "nir", center_nm: 865.0), (name: "tir", center_nm: 10000.0)"#)
        .with("materials", r#"
        "soil": Lambertian(reflectance: Bands([0.1, 0.3, 0.1]), temperature: Uniform(310.0)),
        "leaf": Leaf(
            reflectance: Bands([0.05, 0.5, 0.02]), transmittance: Bands([0.03, 0.4, 0.01]),
            temperature: Uniform(295.0),
        )"#)
        .with("sun", "zenith_deg: 50.0, azimuth_deg: 10.0, disc_deg: 3.0, irradiance: Bands([1.0, 1.0, 0.0])")
}

/// Compares all values of two products of the same shape; returns how many of them are known well in
/// both, to 3 %. What has no noise in either must be equal.
///
/// Values of one sensor are correlated: bands, cells and parts ride on the same paths. So no mean of
/// scores is looked at, only the largest: the chance that any of some hundred is beyond 5.5 is at most the
/// sum of theirs, however they hang together: 5e-6 each (t with 31 degrees of freedom, Bonferroni).
fn agreeing(a: &Product, b: &Product) -> usize {
    assert_eq!((&a.name, &a.dimensions), (&b.name, &b.dimensions));
    let mut known = 0;
    for index in 0..a.values.len() {
        let (one, other) = (Estimate::of(a, index), Estimate::of(b, index));
        let scale = one.value.abs().max(other.value.abs());
        let error = one.error.hypot(other.error) / scale;
        let is_known = |one: Estimate| one.error < 0.2 * one.value.abs();
        if one.value.is_nan() {
            assert!(other.value.is_nan(), "{}[{index}]: {one:?} {other:?}", a.name);
        } else if scale == 0.0 || error <= 1e-6 {
            let off = (one.value - other.value).abs();
            assert!(off <= 4e-6 * scale, "{}[{index}]: {one:?} {other:?}", a.name);
        } else if is_known(one) && is_known(other) {
            // Of fewer photons the error itself is not known well enough.
            let z = one.z_against(other);
            assert!(z.abs() < 5.5, "{}[{index}]: {one:?} {other:?}, z = {z:.2}", a.name);
            known += usize::from(error < 0.03);
        }
    }
    known
}

/// *Scene*: the grove, periodic under sun and sky, or isolated under the sun; light of sun and sky and,
/// in the thermal band, of surfaces and sky. *Expected*: photons that are absorbed or scattered as a
/// whole and packets that count expected values find the same albedo, cells, cones, orders, fAPAR,
/// absorbed power, fluxes and emitted light.
#[test]
fn photons_followed_as_a_whole_find_what_packets_find() {
    let photons = |per_m2: f64, system: &str| {
        format!(
            "Photons(per_m2: {per_m2:?}, system: {system}, measure: [
                Albedo, BrfCells(20), BrfCones([(40.0, 100.0, 20.0)]), Orders, Fapar(layer_m: 1.0),
                Absorbed(per: Instance), Fluxes(pixel_m: 5.0, heights_m: [1.5]), Exitance,
                RadianceCells(12), RadianceCones([(40.0, 100.0, 20.0)]), BrightnessTemperature,
            ])"
        )
    };
    let endless = grove()
        .with("sky", "Isotropic(irradiance: Bands([0.2, 0.1, 0.0]))")
        .with("thermal_sky", "BlackBody(260.0)")
        .with("boundary", "Periodic");
    let isolated = grove().with("boundary", "Isolated").with("transport", "max_order: 4");
    for (light, scene) in [("sun and sky", endless), ("sun", isolated)] {
        let sensors = format!(
            "\"packets\": {}, \"photons\": {}",
            photons(4e3, "Forward"),
            photons(4e4, "Analog")
        );
        let report = scene.with("sensors", sensors).measure();
        let is_expected = |warning: &String| {
            warning.starts_with("boundary: ") || warning.contains("in band `tir`")
        };
        assert!(report.warnings.iter().all(is_expected), "{:?}", report.warnings);
        let [packets, photons] = report.sensors.as_slice() else { panic!("two sensors") };
        assert!(photons.energy_imbalance.is_some_and(|off| off < 1e-9), "{photons:?}");
        let mut known = 0;
        for one in &packets.products {
            // What roulette takes is no physics.
            if one.name.ends_with("energy") {
                continue;
            }
            known += agreeing(one, product(&report, "photons", &one.name));
        }
        assert!(known >= 70, "{light}: {known} values");
    }
}

/// *Scene*: the grove under a sun with a disc and a sky; images and directions, a camera in the scene
/// and a virtual plane. *Expected*: what is integrated is what random walks and packets find of light
/// that was scattered once, by the ground or by the canopy; where no other counts, it is all there is.
#[test]
fn light_of_the_first_order_is_what_walks_and_packets_find_of_it() {
    let sky = grove().with("sky", "Isotropic(irradiance: Bands([0.3, 0.1, 0.2]))");
    let once = sky.clone().with("boundary", "Periodic").with("transport", "first_order_only: true");
    for (scene, measure, products) in [
        (once, "Brf, Orders", &["hdrf", "hdrf_uc", "hdrf_co_sgl"][..]),
        (sky.with("boundary", "Isolated"), "Orders", &["hdrf_uc", "hdrf_co_sgl"]),
    ] {
        let views = "views: List([(0.0, 0.0), (40.0, 100.0), (60.0, 190.0)])";
        let sensors = |(system, more): (&str, u32)| {
            let keys = format!("measure: [{measure}], system: {system}");
            let until = format!("until: Samples({}), {keys}", 20_000 * more);
            let per_px = format!("samples_per_px: {}, {keys}", 512 * more);
            let camera = format!(
                r#""camera {system}": Perspective(size_px: (8, 6), position_m: (2.0, 0.0, 3.0), target_m: (2.5, 2.5, 1.0),
            fov_deg: (50.0, 40.0), sees_sky: true, {per_px}),"#
            );
            format!(
                r#"
        "views {system}": Directions({views}, {until}),
        "plane {system}": Directions({views}, {until},
            virtual_plane: (center_m: (2.0, 2.0), size_m: (2.0, 3.0), height_m: 2.0)),
        "image {system}": Orthographic(size_px: (4, 4), extent_m: (4.0, 4.0), {per_px}),
        {}"#,
                if system == "Forward" { "" } else { &camera }
            )
        };
        let systems = [("FirstOrder", 1), ("Backward", 2), ("Forward", 8)];
        let report = scene.with("sensors", systems.map(sensors).concat()).measure();
        let of = |sensor: &str, name: &str| whole(product(&report, sensor, name));
        let mut known = 0;
        for sensor in ["views", "plane", "image", "camera"] {
            let once = format!("{sensor} FirstOrder");
            let names = report.sensors.iter().find(|one| one.name == once).expect("a sensor");
            let names = names.products.iter().map(|one| one.name.as_str());
            assert_eq!(names.collect::<Vec<_>>(), products);
            for system in ["Backward", "Forward"] {
                if (sensor, system) == ("camera", "Forward") {
                    continue;
                }
                for name in products {
                    let other = of(&format!("{sensor} {system}"), name);
                    known += agreeing(&of(&once, name), &other);
                }
            }
        }
        assert!(known >= 70, "{measure}: {known} values");
    }
}

/// *Scene*: the grove under a sun with a disc and a sky, periodic and isolated. *Expected*: the reference integrator,
/// one plain loop without roulette by throughput, batches or lobes evaluated later, agrees with backward paths and
/// with packets: images, cameras and directions.
#[test]
fn the_reference_integrator_finds_what_the_others_find() {
    for (boundary, transport) in [("Periodic", ""), ("Isolated", "max_order: 3")] {
        let sensors = |(system, more): (&str, u32)| {
            let keys = format!("measure: [Brf], system: {system}");
            let camera = format!(
                r#""camera {system}": Perspective(size_px: (4, 3), position_m: (2.0, 0.0, 3.0), target_m: (2.5, 2.5, 1.0),
            fov_deg: (50.0, 40.0), sees_sky: true, samples_per_px: {}, {keys}),"#,
                1024 * more
            );
            format!(
                r#"
        "views {system}": Directions(views: List([(0.0, 0.0), (40.0, 100.0), (60.0, 190.0)]), until: Samples({}), {keys}),
        "image {system}": Orthographic(size_px: (3, 3), extent_m: (4.0, 4.0), samples_per_px: {}, {keys}),
        {}"#,
                20_000 * more,
                1024 * more,
                if system == "Forward" { "" } else { &camera }
            )
        };
        let systems = [("Reference", 1), ("Backward", 1), ("Forward", 4)];
        let report = grove()
            .with("sky", "Isotropic(irradiance: Bands([0.3, 0.1, 0.2]))")
            .with("boundary", boundary)
            .with("transport", transport)
            .with("sensors", systems.map(sensors).concat())
            .measure();
        let hdrf = |sensor: &str| whole(product(&report, sensor, "hdrf"));
        let mut known = 0;
        for (sensor, system) in [
            ("views", "Backward"),
            ("image", "Backward"),
            ("camera", "Backward"),
            ("views", "Forward"),
            ("image", "Forward"),
        ] {
            let reference = hdrf(&format!("{sensor} Reference"));
            known += agreeing(&reference, &hdrf(&format!("{sensor} {system}")));
        }
        assert!(known >= 40, "{boundary}: {known} values");
    }
}

/// The values of a product and, of an image, those of its pixels.
fn whole(product: &Product) -> Product {
    let mut product = product.clone();
    if let Some(image) = product.image.take() {
        let image = image.load().expect("pixels can be read");
        product.values.extend(image.values.iter().map(|&value| f64::from(value)));
        product.standard_error.extend(image.standard_error.iter().map(|&error| f64::from(error)));
    }
    product
}

/// *Scene*: as above. *Expected*: a photon carries the whole power of all bands in one of them, so
/// whatever it does is counted in units of that: no two values that one photon brings differ.
#[test]
fn a_photon_is_counted_whole_or_not_at_all() {
    let measure = "Albedo, Absorbed(per: Instance)";
    let sensor = format!("\"few\": Photons(per_m2: 5.12, system: Analog, measure: [{measure}])");
    let report = grove().with("boundary", "Periodic").with("sensors", sensor).measure();
    // 128 photons: each is three shares, its band one in three, of which two hold light.
    let packets = 128.0;
    for name in ["albedo", "energy"] {
        for value in &product(&report, "few", name).values {
            let photons = value * packets / 2.0;
            assert!(
                value.is_nan() || (photons - photons.round()).abs() < 1e-4,
                "{name}: {photons}"
            );
        }
    }
}
