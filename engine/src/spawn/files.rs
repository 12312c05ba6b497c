use std::path::Path;

use crate::document::{
    Area, Diagnostic, Instances, Material, Mesh, Scene, Sky, Spectrum, Stems, Terrain, ThermalSky,
};

/// Every file that a scene names and that is not there, used or not.
///
/// It needs nothing but names, so it serves scenes that cannot be spawned as well: whatever is wrong
/// with a scene is reported at once.
#[must_use]
pub fn missing_files(scene: &Scene, folder: &Path) -> Vec<Diagnostic> {
    let mut missing = Vec::new();
    for (path, file) in named_files(scene) {
        let full = folder.join(file);
        let message = if full.is_dir() {
            format!("{} is a folder", full.display())
        } else if !full.exists() {
            format!("no file {}", full.display())
        } else {
            continue;
        };
        let help = match file {
            _ if file.contains('\\') && !full.is_dir() => "write `/` between folders",
            _ if file.starts_with('~') => "write the path in full: `~` is not expanded",
            _ => "paths are relative to the folder of the scene file",
        };
        missing.push(Diagnostic::error(path, message).help(help));
    }
    missing
}

/// Files that a scene names, each with its path in the document.
pub(crate) fn named_files(scene: &Scene) -> Vec<(String, &str)> {
    let mut files = Vec::new();
    for (index, instances) in scene.instances.iter().enumerate() {
        match instances {
            Instances::Table { file, .. } | Instances::CanopyHeights { file, .. } => {
                files.push((format!("instances[{index}].file"), file.as_str()));
            }
            Instances::List { .. } => {}
            Instances::Scatter { inside, outside, stems, .. } => {
                if let Stems::Raster { file, .. } = stems {
                    files.push((format!("instances[{index}].stems.file"), file.as_str()));
                }
                for (key, areas) in [("inside", inside), ("outside", outside)] {
                    for (number, area) in areas.iter().enumerate() {
                        if let Area::GeoJson { file, .. } | Area::Table { file, .. } = area {
                            let path = format!("instances[{index}].{key}[{number}].file");
                            files.push((path, file.as_str()));
                        }
                    }
                }
            }
        }
    }
    if let Terrain::Raster { file, land_cover, .. } = &scene.terrain {
        files.push(("terrain.file".to_owned(), file.as_str()));
        if let Some(cover) = land_cover {
            files.push(("terrain.land_cover.file".to_owned(), cover.file.as_str()));
        }
    }
    for (name, mesh) in &scene.meshes {
        if let Mesh::Obj { file, .. } | Mesh::Gltf { file, .. } | Mesh::Discs { file, .. } = mesh {
            files.push((format!("meshes.{name}.file"), file.as_str()));
        }
    }
    let mut spectrum = |path: String, spectrum| {
        if let Some(file) = table(spectrum) {
            files.push((format!("{path}.file"), file));
        }
    };
    for (name, value) in &scene.spectra {
        spectrum(format!("spectra.{name}"), value);
    }
    for (name, material) in &scene.materials {
        let (reflectance, transmittance, back) = match material {
            Material::Lambertian { reflectance, back_reflectance, .. } => {
                (reflectance, None, back_reflectance)
            }
            Material::Leaf { reflectance, transmittance, back_reflectance, .. } => {
                (reflectance, Some(transmittance), back_reflectance)
            }
        };
        spectrum(format!("materials.{name}.reflectance"), reflectance);
        if let Some(transmittance) = transmittance {
            spectrum(format!("materials.{name}.transmittance"), transmittance);
        }
        if let Some(back) = back {
            spectrum(format!("materials.{name}.back_reflectance"), back);
        }
    }
    if let Some(sun) = &scene.sun {
        spectrum("sun.irradiance".to_owned(), &sun.irradiance);
    }
    if let Sky::Isotropic { irradiance } = &scene.sky {
        spectrum("sky.irradiance".to_owned(), irradiance);
    }
    if let ThermalSky::Radiance(radiance) = &scene.thermal_sky {
        spectrum("thermal_sky".to_owned(), radiance);
    }
    files
}

fn table(spectrum: &Spectrum) -> Option<&str> {
    match spectrum {
        Spectrum::Table { file, .. } => Some(file),
        _ => None,
    }
}
