//! A hundred stands of generated trees, built in Rust: each is written as a scene file and run, and
//! one table tells how their albedo follows leaf area and spacing.
//!
//! `cargo run --release --example stands -- FOLDER`

#![allow(clippy::print_stdout, reason = "a program may print")]

use std::path::{Path, PathBuf};

use sunfleck::document::{
    Band, BandSource, Boundary, CrownShape, Instances, LeafAngle, LeafProfile, LeafShape, Material,
    Mesh, Options, PhotonMeasure, Scene, Sensor, Spectrum, Sun, Terrain, read_text,
};
use sunfleck::run::{self, Unwatched};

/// Side of the stand, m.
const SIDE: f64 = 20.0;

/// Trees in a square grid over ground that goes on without end.
fn stand(leaf_area_m2: f64, trees_a_side: u32) -> Result<Scene, Box<dyn std::error::Error>> {
    let band =
        Band { name: "nir".to_owned(), center_nm: 865.0, width_nm: 20.0, source: BandSource::Auto };
    let terrain = Terrain::Plane {
        size_m: (SIDE, SIDE),
        material: "soil".to_owned(),
        corner_m: (0.0, 0.0),
        height_m: 0.0,
    };
    let mut scene = Scene::new(vec![band], terrain);
    scene.title = format!("{leaf_area_m2} m² of leaves a tree, {trees_a_side} trees a side");
    let soil = Material::Lambertian {
        reflectance: Spectrum::Constant(0.2),
        back_reflectance: None,
        temperature: None,
    };
    let leaf = Material::Leaf {
        reflectance: Spectrum::Constant(0.45),
        transmittance: Spectrum::Constant(0.45),
        back_reflectance: None,
        temperature: None,
    };
    scene.materials.insert("soil".to_owned(), soil);
    scene.materials.insert("leaf".to_owned(), leaf);
    let crown = Mesh::Crown {
        shape: CrownShape::Ellipsoid { diameter_m: 2.0, height_m: 3.0 },
        base_m: 1.0,
        leaf_area_m2,
        leaf_profile: LeafProfile::Even,
        clumps: None,
        leaf_angle: LeafAngle::Spherical,
        leaf: LeafShape::Disc { radius_m: 0.08 },
        overlap: true,
        min_distance_m: 0.0,
        leaf_material: "leaf".to_owned(),
        trunk: None,
        branches: None,
        wood_material: None,
        seed: 1,
    };
    scene.meshes.insert("tree".to_owned(), crown);
    let step = SIDE / f64::from(trees_a_side);
    let place = |index: u32| (f64::from(index) + 0.5) * step;
    let places = |x| (0..trees_a_side).map(move |y| (place(x), place(y), 0.0));
    scene.instances.push(Instances::List {
        of: "tree".to_owned(),
        at_m: (0..trees_a_side).flat_map(places).collect(),
        yaw_deg: Vec::new(),
        scale: Vec::new(),
        on_terrain: true,
        name: None,
    });
    // What has defaults is shortest as text.
    let text = "(format: 1, bands: [(name: \"nir\", center_nm: 865.0)], \
                terrain: Plane(size_m: (1.0, 1.0), material: \"\"), \
                sun: (zenith_deg: 30.0, irradiance: Constant(1.0)), sensors: { \"light\": Photons(per_m2: 50.0) })";
    let defaults = read_text("defaults", text, &Options::default())?.scene;
    let sun: Option<Sun> = defaults.sun;
    scene.sun = sun;
    scene.boundary = Boundary::Periodic;
    for (name, mut sensor) in defaults.sensors {
        if let Sensor::Photons { measure, .. } = &mut sensor {
            *measure = vec![PhotonMeasure::Albedo];
        }
        scene.sensors.insert(name, sensor);
    }
    Ok(scene)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args_os().nth(1).map_or_else(|| PathBuf::from("stands"), PathBuf::from);
    std::fs::create_dir_all(&folder)?;
    println!("leaf_area_m2,trees_a_side,albedo,standard_error");
    for trees_a_side in 1..=10 {
        for tenth in 1..=10 {
            let leaf_area = f64::from(tenth) * 3.0;
            let scene = stand(leaf_area, trees_a_side)?;
            let file = folder.join(format!("stand_{trees_a_side}_{leaf_area}.ron"));
            std::fs::write(file, scene.to_ron())?;
            let report = run::run(&scene, Path::new(""), &run::Options::default(), &Unwatched)?;
            let products = report.sensors.iter().flat_map(|sensor| &sensor.products);
            for albedo in products.filter(|product| product.name == "albedo") {
                let (value, error) = (albedo.values[0], albedo.standard_error[0]);
                println!("{leaf_area},{trees_a_side},{value:.5},{error:.5}");
            }
        }
    }
    Ok(())
}
