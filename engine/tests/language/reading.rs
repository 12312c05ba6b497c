//! Reading, writing and reading again.

use sunfleck::document::{
    Material, Options, Reading, Scene, Sensor, Sky, Spectrum, Sun, read_text,
};

const DESIGN: &str = include_str!("design.ron");

fn read(text: &str) -> Reading {
    read_text("scene.ron", text, &Options::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn sound(text: &str) -> Scene {
    let reading = read(text);
    assert!(reading.diagnostics.is_empty(), "{}", reading.render());
    reading.scene
}

#[test]
fn the_example_of_the_design_reads_as_written() {
    let scene = sound(DESIGN);
    assert_eq!(scene.title, "Birch stand");
    assert_eq!(scene.bands[1].name, "nir");
    assert_eq!(
        scene.materials["soil"],
        Material::Lambertian {
            reflectance: Spectrum::Named("soil".to_owned()),
            back_reflectance: None
        }
    );
    let irradiance = Spectrum::Bands(vec![1.0, 1.0]);
    assert_eq!(scene.sun, Some(Sun { zenith_deg: 30.0, azimuth_deg: 270.0, irradiance }));
    assert_eq!(scene.sky, Sky::Fraction(vec![0.1, 0.05]));
    let names: Vec<_> = scene.sensors.keys().collect();
    assert_eq!(names, ["nadir", "brf", "flux"]);
    assert!(matches!(scene.sensors["flux"], Sensor::Photons { per_m2: 2500.0, .. }));
}

#[test]
fn what_is_written_reads_back_as_equal() {
    let scene = sound(DESIGN);
    assert_eq!(sound(&scene.to_ron()), scene);
}
