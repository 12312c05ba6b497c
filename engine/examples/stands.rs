//! A hundred stands of generated trees, built in Rust: each is written as a scene file and run, and
//! one table tells how their albedo follows leaf area and spacing.
//!
//! `cargo run --release --example stands -- FOLDER`

#![allow(clippy::print_stdout, reason = "a program may print")]

use std::path::{Path, PathBuf};

use sunfleck::document::{
    Band, Boundary, CrownShape, GeneratedCrown, InstanceList, Instances, Lambertian, Leaf,
    LeafShape, Material, PhotonMeasure, Photons, Prototype, Scene, Sensor, Spectrum, Sun, Terrain,
    TerrainPlane,
};
use sunfleck::run::{self, Unwatched};

/// Side of the stand, m.
const SIDE: f64 = 20.0;

/// Trees in a square grid over ground that goes on without end.
fn stand(leaf_area_m2: f64, trees_a_side: u32) -> Scene {
    let band = Band { center_nm: Some(865.0), width_nm: 20.0, ..Band::new("nir".to_owned()) };
    let terrain = Terrain::Plane(TerrainPlane::new((SIDE, SIDE), "soil".into()));
    let mut scene = Scene::new(vec![band], terrain);
    scene.title = format!("{leaf_area_m2} m² of leaves a tree, {trees_a_side} trees a side");
    scene.boundary = Boundary::Periodic;
    scene.sun =
        Some(Sun { zenith_deg: Some(30.0), irradiance: Spectrum::Constant(1.0), ..Sun::default() });

    let soil = Lambertian::new(Spectrum::Constant(0.2));
    let leaf = Leaf::new(Spectrum::Constant(0.45), Spectrum::Constant(0.45));
    scene.materials.insert("soil".to_owned(), Material::Lambertian(soil));
    scene.materials.insert("leaf".to_owned(), Material::Leaf(leaf));

    let shape = CrownShape::Ellipsoid { diameter_m: 2.0, height_m: 3.0 };
    let leaf = LeafShape::Disc { radius_m: 0.08 };
    let crown = GeneratedCrown::new(shape, 1.0, leaf_area_m2, leaf, "leaf".into());
    scene.meshes.insert("tree".to_owned(), Prototype::Crown(crown));

    let step = SIDE / f64::from(trees_a_side);
    let place = |index: u32| (f64::from(index) + 0.5) * step;
    let places = |x| (0..trees_a_side).map(move |y| (place(x), place(y), 0.0));
    let places = (0..trees_a_side).flat_map(places).collect();
    scene.instances.push(Instances::List(InstanceList {
        on_terrain: true,
        ..InstanceList::new("tree".into(), places)
    }));

    let photons =
        Photons { per_m2: 50.0, measure: vec![PhotonMeasure::Albedo], ..Photons::default() };
    scene.sensors.insert("light".to_owned(), Sensor::Photons(photons));
    scene
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args_os().nth(1).map_or_else(|| PathBuf::from("stands"), PathBuf::from);
    std::fs::create_dir_all(&folder)?;
    println!("leaf_area_m2,trees_a_side,albedo,standard_error");
    for trees_a_side in 1..=10 {
        for tenth in 1..=10 {
            let leaf_area = f64::from(tenth) * 3.0;
            let scene = stand(leaf_area, trees_a_side);
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
