//! `sunfleck` computes where the light of a forest goes.
//!
//! A scene is text; it becomes a document, a world of entities, a flat stage, and the stage is
//! traced. `ARCHITECTURE.md` beside this crate is the map of its modules.
//!
//! A program reads a scene or builds one, checks it, and runs it:
//!
//! ```
//! use std::path::Path;
//!
//! use sunfleck::document::{
//!     Band, Lambertian, Material, PhotonMeasure, Photons, Sensor, Spectrum, Sun, Terrain, TerrainPlane,
//! };
//! use sunfleck::{RunOptions, Scene, Unwatched, check, run};
//!
//! let ground = Terrain::Plane(TerrainPlane::new((10.0, 10.0), "soil".into()));
//! let mut scene = Scene::new(vec![Band { center_nm: Some(660.0), ..Band::new("red".to_owned()) }], ground);
//! let soil = Lambertian::new(Spectrum::Constant(0.2));
//! scene.materials.insert("soil".to_owned(), Material::Lambertian(soil));
//! scene.sun = Some(Sun { zenith_deg: Some(30.0), ..Sun::default() });
//! let albedo = Photons { measure: vec![PhotonMeasure::Albedo], ..Photons::default() };
//! scene.sensors.insert("albedo".to_owned(), Sensor::Photons(albedo));
//! assert!(check(&scene).is_empty());
//!
//! let report = run(&scene, Path::new(""), &RunOptions::default(), &Unwatched)?;
//! let albedo = &report.sensors[0].products[0];
//! assert!((albedo.values[0] - 0.2).abs() < 0.01);
//!
//! // The scene as a file, which reads back as equal.
//! let reading = sunfleck::read_text("scene.ron", &scene.to_ron(), &Default::default())?;
//! assert_eq!(reading.scene, scene);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod accel;
pub mod appearance;
pub mod assets;
pub mod components;
pub mod counts;
pub mod document;
pub mod export;
pub mod extract;
mod files;
pub mod geometry;
mod memory;
pub mod output;
pub mod placement;
pub mod preview;
pub mod products;
pub mod queries;
pub mod run;
pub mod sampling;
pub mod scattering;
pub mod scratch;
pub mod spawn;
pub mod spectral;
pub mod statistics;
pub mod systems;
pub mod terrain;
pub mod transport;
pub mod units;

pub use document::{Diagnostic, ReadOptions, Reading, Scene, check, read_file, read_text};
pub use output::write;
pub use products::{Product, Report};
pub use run::{Options as RunOptions, Progress, SweepRun, Unwatched, check_file, run, run_file};
