//! Advice for instances off the ground that other coordinates would put on it: those of the map where the
//! local frame's belong, or the reverse.

use glam::{DVec2, DVec3};

use hecs::World;

use super::Resources;
use super::georeference::{MapFrame, MapTransform};
use crate::components::{InstanceRange, SceneId};
use crate::document::{
    Area, InstanceList, InstanceTable, Instances, ScenePath, TableCoordinates, Terrain,
    TerrainRaster,
};
use crate::geometry::{Polygon, Rectangle, millimetres};
use crate::terrain::Ground;

/// Instances that are further than both of these from the ground cannot be meant: this, m, and this
/// many times the ground's larger extent.
const FAR_M: f64 = 1000.0;
const FAR_EXTENTS: f64 = 20.0;

/// Height above the ground from which the height of a place is one above sea level, m.
const ABOVE_SEA: f64 = 50.0;

/// Distance from the ground from which a place cannot be meant, m.
pub(super) fn far_from(ground: &Ground) -> f64 {
    FAR_M.max(FAR_EXTENTS * ground.size().max_element())
}

/// Returns whether a place is too far from the ground's rectangle to be meant.
pub(super) fn is_far(place: DVec2, ground: &Ground) -> bool {
    ground.gap(place) > far_from(ground)
}

/// Returns whether at least half of the places lie on the ground's rectangle.
fn lie_on(ground: &Ground, places: impl ExactSizeIterator<Item = DVec2>) -> bool {
    let (low, high) = (ground.corner(), ground.corner() + ground.size());
    let (room, count) = (1e-6 * ground.size(), places.len());
    let is_on = |place: &DVec2| place.cmpge(low - room).all() && place.cmple(high + room).all();
    2 * places.filter(is_on).count() >= count
}

/// Data that advice on coordinates takes.
#[derive(Clone, Copy)]
pub(super) struct AdvicePlace<'a> {
    pub(super) terrain: &'a Terrain,
    pub(super) map: &'a MapFrame,
    pub(super) ground: &'a Ground,
}

/// Planting of an instance, and the number of the instance within it.
fn planting_of(instance: SceneId, world: &World, resources: &Resources) -> Option<(usize, u32)> {
    resources.plantings.iter().enumerate().find_map(|(index, &planting)| {
        let range = world.get::<&InstanceRange>(planting).ok()?;
        range.0.contains(&instance.0).then(|| (index, instance.0 - range.0.start))
    })
}

/// Path in the document of an instance, and a name for it.
pub(crate) fn place_of_instance(
    instance: SceneId,
    world: &World,
    resources: &Resources,
) -> (ScenePath, String) {
    let Some((index, row)) = planting_of(instance, world, resources) else {
        return ("instances".into(), "an instance".to_owned());
    };
    let path = ScenePath::from("instances").index(index);
    let row = row as usize;
    match world.get::<&Instances>(resources.plantings[index]).as_deref() {
        Ok(Instances::List(_)) => (path.key("at_m").index(row), "this instance".to_owned()),
        Ok(Instances::Table(InstanceTable { file, .. })) => {
            (path.key("file"), format!("row {} of `{file}`", row + 1))
        }
        _ => (path, format!("instance {}", row + 1)),
    }
}

/// Advice for places of a list or a table, local frame, that lie off the ground; `None` if no other
/// coordinates would put them on it.
pub(super) fn other_coordinates(
    instances: &Instances,
    strays: &[DVec3],
    place: &AdvicePlace<'_>,
    resources: &Resources,
) -> Option<String> {
    let is_local = match instances {
        Instances::List(_) => true,
        Instances::Table(table) => table.coordinates != Some(TableCoordinates::Map),
        Instances::Scatter(_) | Instances::CanopyHeights(_) => false,
    };
    if !is_local {
        return None;
    }
    less_origin(instances, strays, place, resources)
        .or_else(|| raster_corner(instances, strays, place, resources))
        .or_else(|| frame_advice(instances, strays, place.ground))
}

/// Advice where subtracting `frame.origin_m` would put the places on the ground.
fn less_origin(
    instances: &Instances,
    strays: &[DVec3],
    place: &AdvicePlace<'_>,
    resources: &Resources,
) -> Option<String> {
    let ground = place.ground;
    let map = place.map.transform.unwrap_or_else(|| MapTransform::from_frame(resources));
    if !lie_on(ground, strays.iter().map(|stray| map.apply(stray.truncate()))) {
        return None;
    }
    let first = strays.first()?;
    Some(match instances {
        Instances::List(InstanceList { on_terrain, .. }) => {
            let height = if *on_terrain { 0.0 } else { resources.frame.origin_m.2 };
            let mut local = map.apply(first.truncate()).extend(first.z - height);
            let above = local.z - ground.height(local.truncate()).unwrap_or(local.z);
            let mut rest = "";
            if above > ABOVE_SEA && !on_terrain {
                local.z -= above.floor();
                rest =
                    " (its height is one above sea level: write that of the ground into the frame)";
            }
            format!(
                "places of a `List` are local: write {}, its coordinates less `frame.origin_m`{rest}",
                triple(local)
            )
        }
        _ => "its coordinates are those of the map: write `coordinates: Map`".to_owned(),
    })
}

/// Advice where the ground lies at the coordinates of its raster, and the places count from its corner.
fn raster_corner(
    instances: &Instances,
    strays: &[DVec3],
    place: &AdvicePlace<'_>,
    resources: &Resources,
) -> Option<String> {
    let Terrain::Raster(TerrainRaster { corner_m: None, lowest_m, .. }) = place.terrain else {
        return None;
    };
    let ground = place.ground;
    place.map.transform.filter(|reference| !reference.is_of_degrees)?;
    let corner = ground.corner();
    let moved = || strays.iter().map(|stray| stray.truncate() + corner);
    if !lie_on(ground, moved()) {
        return None;
    }
    let lowest = if lowest_m.is_none() { lowest_height(ground).floor() } else { 0.0 };
    let origin = DVec3::from(resources.frame.origin_m) + corner.extend(lowest);
    let kind = match instances {
        Instances::List(_) => "places of a `List` are local",
        _ => "its coordinates are local",
    };
    Some(format!(
        "{kind}, and the raster of the terrain lies at those of a map: write `frame: (origin_m: {})`, \
             the south-west corner of the raster",
        triple(origin)
    ))
}

/// Advice for an area beside the terrain, as it was read and where it lies in the local frame.
pub(super) fn area_advice(
    area: &Area,
    polygons: &[Polygon],
    terrain: Rectangle,
    resources: &Resources,
) -> String {
    let (x, y, _) = resources.frame.origin_m;
    let origin = DVec2::new(x, y);
    let corners = || polygons.iter().flat_map(|polygon| &polygon.rings).flatten().copied();
    let low = corners().fold(DVec2::INFINITY, DVec2::min);
    let high = corners().fold(DVec2::NEG_INFINITY, DVec2::max);
    let overlaps = |shift: DVec2| {
        (low + shift).cmplt(terrain.max).all() && (high + shift).cmpgt(terrain.min).all()
    };
    let place = corners().next().unwrap_or_default();
    match area {
        Area::Polygon { .. } if overlaps(-origin) => {
            let local = (place - origin).to_array().map(millimetres);
            format!(
                "corners of a `Polygon` are local: write ({:?}, {:?}) and so on, its coordinates less \
                     `frame.origin_m`",
                local[0], local[1]
            )
        }
        Area::Polygon { .. } => "corners of a `Polygon` are those of the local frame".to_owned(),
        Area::GeoJson { georeferenced: true, .. } | Area::Table { georeferenced: true, .. } => {
            let what = "`frame.origin_m` is subtracted from its coordinates";
            let advice = if overlaps(origin) { "if they are local" } else { "correct it, or" };
            format!("{what}: {advice}, write `georeferenced: false`")
        }
        Area::GeoJson { .. } | Area::Table { .. } if overlaps(-origin) => {
            "its coordinates are those of the map: write `georeferenced: true`".to_owned()
        }
        Area::GeoJson { .. } | Area::Table { .. } => {
            "its coordinates are taken as local; those of a map need `georeferenced: true` and \
                 `frame.origin_m`"
                .to_owned()
        }
    }
}

/// Advice to count the height of an instance from the ground if it would stand there, with a separator;
/// `vertical` is the lowest and the highest point of the instance.
pub(super) fn terrain_advice(
    instances: &Instances,
    vertical: [f64; 2],
    resources: &Resources,
) -> &'static str {
    // Heights of the map have lost that of the origin.
    let shifts = match instances {
        Instances::List(InstanceList { on_terrain: false, .. }) => [0.0, 0.0],
        Instances::Table(InstanceTable { on_terrain: false, .. }) => {
            [0.0, resources.frame.origin_m.2]
        }
        _ => return "",
    };
    let stands = |shift: f64| {
        let [low, high] = vertical.map(|height| height + shift);
        low <= high - low && high >= 0.5 * (high - low)
    };
    if shifts.into_iter().any(stands) {
        "; if its height is one above the ground, write `on_terrain: true`"
    } else {
        ""
    }
}

/// Advice where the places are so far from local ground that they are those of a map.
fn frame_advice(instances: &Instances, strays: &[DVec3], ground: &Ground) -> Option<String> {
    let first = strays.first().filter(|stray| is_far(stray.truncate(), ground))?;
    let places = || strays.iter().map(|stray| stray.truncate());
    let (low, high) = places()
        .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), place| {
            (low.min(place), high.max(place))
        });
    let middle = 0.5 * (low + high) - (ground.corner() + 0.5 * ground.size());
    let round = |place: DVec2, step: f64| (place / step).floor() * step;
    let origin = [100.0, 10.0, 1.0]
        .map(|step| round(middle, step))
        .into_iter()
        .find(|origin| lie_on(ground, places().map(|place| place - origin)))
        .unwrap_or_else(|| round(low - ground.corner(), 10.0));
    let local = first.truncate() - origin;
    let above = first.z - ground.height(local).unwrap_or(0.0);
    let height = if above > ABOVE_SEA { above.floor() } else { 0.0 };
    let frame = format!("`frame: (origin_m: {})`", triple(origin.extend(height)));
    Some(match instances {
        Instances::List(_) => format!(
            "if these are coordinates of a map, write {frame}, and the places of a `List` less it: {}",
            triple(local.extend(first.z - height))
        ),
        Instances::Table(InstanceTable { coordinates: Some(_), .. }) => {
            format!("if these are coordinates of a map, write {frame} and `coordinates: Map`")
        }
        _ => format!("if these are coordinates of a map, write {frame}"),
    })
}

/// Height of the lowest of some points of the ground, m; 0 if none has ground below.
fn lowest_height(ground: &Ground) -> f64 {
    const POINTS: u32 = 16;
    let part = |number: u32| f64::from(number) / f64::from(POINTS);
    let points = (0..=POINTS).flat_map(|x| (0..=POINTS).map(move |y| DVec2::new(part(x), part(y))));
    let heights = points.filter_map(|point| ground.height(ground.corner() + point * ground.size()));
    heights.reduce(f64::min).unwrap_or(0.0)
}

/// A place as the scene language writes it.
fn triple(place: DVec3) -> String {
    let DVec3 { x, y, z } = place.map(millimetres);
    format!("({x:?}, {y:?}, {z:?})")
}
