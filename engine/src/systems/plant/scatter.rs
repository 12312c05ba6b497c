use indexmap::IndexMap;

use super::areas::region;
use super::{Site, rectangle_of};
use crate::components::Placement;
use crate::document::{Diagnostic, Prototype, Ref, Scatter, Stems};
use crate::geometry::{Rectangle, place_text};
use crate::placement::{Amount, Habit, Species, instantiate_trees, places};
use crate::systems::georeference::{Quantity, RasterSource, read_raster_on_terrain};
use crate::terrain::{Cells, Ground};

/// Instances that a rule of placement scatters; reports an error if there is no place for them.
pub(super) fn scatter(scatter: &Scatter, ground: &Ground, site: &mut Site<'_>) -> Vec<Placement> {
    let Scatter {
        of,
        rule,
        stems,
        inside,
        outside,
        yaw_deg,
        tilt_deg,
        tilt_azimuth_deg,
        height_m,
        scale,
        scale_vertical,
        sink_m,
        name,
        seed,
    } = scatter;
    let species = species(of, height_m.is_some(), site);
    let terrain = rectangle_of(ground);
    let Some(region) = region(terrain, inside, outside, site) else {
        return Vec::new();
    };
    let stream = site.stream(name.as_deref(), *seed);
    let is_periodic = site.resources.is_periodic();
    let map;
    let amount = match stems {
        Stems::Count(count) => Amount::Count(*count),
        Stems::PerHectare(density) => Amount::Density(density / 1e4),
        Stems::Fill => Amount::Fill,
        Stems::Raster { file, factor } => {
            let Some(found) = densities(file, *factor, terrain, region.bounds(), site) else {
                return Vec::new();
            };
            map = found;
            Amount::Map(&map)
        }
    };
    let places = places(rule, amount, &region, terrain, is_periodic, stream.path("places"));
    let places = match places {
        Ok(places) => places,
        Err(error) => {
            site.report(Diagnostic::error(site.path.clone(), error.to_string()));
            return Vec::new();
        }
    };
    let habit = Habit {
        yaw_deg,
        tilt_deg,
        tilt_azimuth_deg,
        height_m: height_m.as_ref(),
        scale,
        scale_vertical: scale_vertical.as_ref(),
        sink_m: *sink_m,
    };
    let trees = instantiate_trees(&places, &species, &habit, |place| ground.height(place), stream);
    if trees.len() < places.len() && !species.is_empty() {
        let count = places.len() - trees.len();
        let message = format!("{count} of {} stems fell on holes of the terrain", places.len());
        let help = "none stands there; `outside` keeps an area free and the number as it is";
        site.report(Diagnostic::warning(site.path.clone(), message).help(help));
    }
    trees
}

/// Species that compete for each stem.
fn species<'a>(
    of: &'a IndexMap<Ref<Prototype>, f64>,
    is_scaled_to_height: bool,
    site: &mut Site<'_>,
) -> Vec<Species<'a>> {
    let mut species = Vec::new();
    for (name, &share) in of {
        let path = format!("{}.of.{name}", site.path);
        let Some(prototype) = site.resources.prototype(name, &path) else {
            continue;
        };
        // A hidden mesh is not loaded, but its stems keep their places.
        let bounds = site.shapes.get(&prototype.0).map(|shape| shape.bounds);
        let top = bounds.map_or(1.0, |bounds| bounds.map_or(0.0, |box_| box_.high.z.into()));
        if is_scaled_to_height && top <= 0.0 {
            let message = format!("`{name}` lies below its origin and has no height to scale");
            let help = "add `origin: BaseCenter` to the mesh, or take `height_m` out";
            site.report(Diagnostic::error(path, message).help(help));
            continue;
        }
        species.push(Species { name, share, prototype, height: top });
    }
    species
}

/// Stems per hectare of a raster as stems m⁻²; none where there is no data.
fn densities(
    file: &str,
    factor: f64,
    terrain: Rectangle,
    needed: Rectangle,
    site: &mut Site<'_>,
) -> Option<Cells<f64>> {
    let path = format!("{}.stems.file", site.path);
    let source = RasterSource::new(file, &path, Quantity::Density);
    let mut cells = read_raster_on_terrain(&source, terrain, &mut site.map, site.resources)?;
    if let Some(value) = cells.values.iter().find(|value| **value < 0.0) {
        let message = format!("a density of {value} stems per hectare");
        let help = "if it stands for no data, name it in the file's header";
        site.report(Diagnostic::error(path, message).help(help));
        return None;
    }
    let (low, high, room) = (cells.corner, cells.corner + cells.size, 1e-6 * needed.size());
    if !(low.cmple(needed.min + room).all() && high.cmpge(needed.max - room).all()) {
        let message = format!(
            "it reaches from {} to {} m, but stems may stand from {} to {} m",
            place_text(low),
            place_text(high),
            place_text(needed.min),
            place_text(needed.max)
        );
        let help = "nothing stands beside it";
        site.report(Diagnostic::warning(path, message).help(help));
    }
    cells.values.iter_mut().for_each(|value| *value *= factor / 1e4);
    Some(cells)
}
