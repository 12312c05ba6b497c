use glam::DVec2;
use indexmap::IndexMap;

use super::areas::region;
use super::{Site, rectangle_of};
use crate::components::Placement;
use crate::counts::counted;
use crate::document::{Diagnostic, Prototype, Ref, Scatter, Stems};
use crate::geometry::{Rectangle, place_text};
use crate::placement::{Amount, Habit, Species, instantiate_trees, places};
use crate::sampling::Key;
use crate::systems::georeference::{RasterQuantity, RasterSource, read_raster_on_terrain};
use crate::terrain::{Cells, Ground};

/// Instances that a rule of placement scatters; reports an error if there is no place for them.
pub(super) fn scatter(scatter: &Scatter, ground: &Ground, site: &mut Site<'_>) -> Vec<Placement> {
    let species = species(&scatter.of, scatter.height_m.is_some(), site);
    let stream = site.stream(scatter.name.as_deref(), scatter.seed);
    let Some(places) = stem_places(scatter, ground, stream, site) else { return Vec::new() };
    let habit = Habit {
        yaw_deg: &scatter.yaw_deg,
        tilt_deg: &scatter.tilt_deg,
        tilt_azimuth_deg: &scatter.tilt_azimuth_deg,
        height_m: scatter.height_m.as_ref(),
        scale: &scatter.scale,
        scale_vertical: scatter.scale_vertical.as_ref(),
        sink_m: scatter.sink_m,
    };
    let trees = instantiate_trees(&places, &species, &habit, |place| ground.height(place), stream);
    if trees.len() < places.len() && !species.is_empty() {
        let count = places.len() - trees.len();
        let message =
            format!("{count} of {} fell on holes of the terrain", counted(places.len(), "stem"));
        let help = "none stands there; `outside` keeps an area free and the number as it is";
        site.report(Diagnostic::warning(site.path.clone(), message).help(help));
    }
    trees
}

/// Places of stems by the rule, m, local frame; `None` after an error.
fn stem_places(
    scatter: &Scatter,
    ground: &Ground,
    stream: Key,
    site: &mut Site<'_>,
) -> Option<Vec<DVec2>> {
    let terrain = rectangle_of(ground);
    let region = region(terrain, &scatter.inside, &scatter.outside, site)?;
    let map = match &scatter.stems {
        Stems::Raster { file, factor } => {
            Some(densities(file, *factor, terrain, region.bounds(), site)?)
        }
        Stems::Count(_) | Stems::PerHectare(_) | Stems::Fill => None,
    };
    let amount = match (&scatter.stems, &map) {
        (_, Some(map)) => Amount::Map(map),
        (Stems::Count(count), None) => Amount::Count(*count),
        (Stems::PerHectare(density), None) => Amount::Density(density / 1e4),
        (Stems::Fill | Stems::Raster { .. }, None) => Amount::Fill,
    };
    let is_periodic = site.resources.is_periodic();
    let stream = stream.path("places");
    places(&scatter.rule, amount, &region, terrain, is_periodic, stream)
        .map_err(|error| {
            site.report(Diagnostic::error(site.path.clone(), error.to_string()));
        })
        .ok()
}

/// Species that compete for each stem.
fn species<'a>(
    of: &'a IndexMap<Ref<Prototype>, f64>,
    is_scaled_to_height: bool,
    site: &mut Site<'_>,
) -> Vec<Species<'a>> {
    let mut species = Vec::new();
    for (name, &share) in of {
        let path = site.path.key("of").name(name.as_str());
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
    let path = site.path.key("stems").key("file");
    let source = RasterSource::new(file, &path, RasterQuantity::Density);
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
