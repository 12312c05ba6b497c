//! Map of a scene: ground, crowns, areas, sensors, the sun and the frame around them.
//!
//! | file | subject |
//! |---|---|
//! | `relief`, `crowns`, `sensors`, `sky` | entities of the world to shapes |
//! | `page`, `legend` | coordinates, scale bar, north arrow; the column beside the map |
//! | `drawing`, `svg`, `raster` | shapes on a page; the page as text and as pixels |

mod crowns;
mod drawing;
mod legend;
mod page;
mod raster;
mod relief;
mod sensors;
mod sky;
mod svg;

use glam::{DVec2, DVec3};

use crate::components::{PlantingAreas, SceneId, SunLight, TerrainPatch};
use crate::geometry::{Polygon, Rectangle};
use crate::output::{INK, Letters, png_bytes};
use crate::run::LoadedScene;
use crate::terrain::Ground;

use self::crowns::{MeshClasses, crowns};
use self::drawing::{Anchor, Drawing, DrawnItem, Ink, Paint};
use self::legend::MapLegend;
use self::page::{PageProjection, coordinates, north_arrow, scale_bar, widest_coordinate};
use self::relief::ReliefGrid;
use self::sensors::{SensorMark, SensorShape};

/// Longer side of the map in a picture, pixels, unless another is asked for.
pub const MAP_SIZE: u32 = 900;

/// Room around an isolated scene, as a fraction of its longer side.
const ROOM: f64 = 0.04;

/// Most room for positions of cameras beside the ground.
const MOST_ROOM: f64 = 0.5;

const INSIDE: [u8; 3] = [20, 90, 160];
const OUTSIDE: [u8; 3] = [190, 60, 0];

/// Map of a scene, drawn.
#[derive(Clone, Debug)]
pub struct SceneMap {
    title: String,
    drawing: Drawing,
    /// What the map shows, a line each.
    pub contents: Vec<String>,
}

/// Returns the map of a scene as SVG.
///
/// Crowns of more than 5000 instances, and hillshade, are pixels in it, so that it stays below some megabytes.
#[must_use]
pub fn map_svg(loaded: &LoadedScene) -> String {
    SceneMap::new(loaded, MAP_SIZE).svg()
}

/// Entities that a map shows.
struct MapContents {
    tile: Rectangle,
    shown: Rectangle,
    is_periodic: bool,
    relief: ReliefGrid,
    areas: PlantingAreas,
    sensors: Vec<SensorMark>,
    sun: Option<DVec3>,
    origin: DVec3,
    system: Option<String>,
}

impl MapContents {
    fn new(loaded: &LoadedScene) -> Self {
        let (world, resources) = (&loaded.world.world, &loaded.world.resources);
        let mut terrains = world.query::<(&TerrainPatch, Option<&Ground>)>();
        let (patch, ground) = terrains.iter().next().expect("a loaded scene has a terrain");
        let tile = Rectangle { min: patch.corner, max: patch.corner + patch.size };
        let derived;
        let ground = if let Some(ground) = ground {
            ground
        } else {
            derived = Ground::of(patch);
            &derived
        };
        let relief = ReliefGrid::new(ground, tile);
        let sensors = sensors::sensors(world, Some(ground), tile, patch.lowest());
        let mut suns = world.query::<&SunLight>();
        let is_periodic = resources.is_periodic();
        let (x, y, z) = resources.frame.origin_m;
        let epsg = patch.projection.as_ref().and_then(|projection| projection.epsg);
        Self {
            tile,
            shown: shown(tile, is_periodic, &sensors),
            is_periodic,
            relief,
            areas: areas(loaded),
            sensors,
            sun: suns.iter().next().map(|sun| sun.direction),
            origin: DVec3::new(x, y, z),
            system: epsg.map(|code| format!("EPSG:{code}")).or_else(|| resources.frame.crs.clone()),
        }
    }
}

/// Part of the local frame that a map shows: the tile of a periodic scene, else some room around, and cameras beside it.
fn shown(tile: Rectangle, is_periodic: bool, sensors: &[SensorMark]) -> Rectangle {
    let side = tile.size().max_element();
    let room = if is_periodic { 0.0 } else { ROOM * side };
    let most = Rectangle { min: tile.min - MOST_ROOM * side, max: tile.max + MOST_ROOM * side };
    let mut shown = Rectangle { min: tile.min - room, max: tile.max + room };
    for sensor in sensors {
        let SensorShape::Camera { at, .. } = sensor.shape else { continue };
        let is_beside = at.cmplt(tile.min).any() || at.cmpgt(tile.max).any();
        if is_beside && at.cmpge(most.min).all() && at.cmple(most.max).all() {
            shown.min = shown.min.min(at - ROOM * side);
            shown.max = shown.max.max(at + ROOM * side);
        }
    }
    shown
}

/// Polygons of all plantings in document order, each once.
fn areas(loaded: &LoadedScene) -> PlantingAreas {
    let world = &loaded.world.world;
    let mut query = world.query::<(&SceneId, &PlantingAreas)>();
    let mut plantings: Vec<_> = query.iter().collect();
    plantings.sort_unstable_by_key(|(id, _)| **id);
    let mut all = PlantingAreas::default();
    let add = |polygons: &[Polygon], to: &mut Vec<Polygon>| {
        for polygon in polygons {
            if !to.contains(polygon) {
                to.push(polygon.clone());
            }
        }
    };
    for (_, areas) in plantings {
        add(&areas.inside, &mut all.inside);
        add(&areas.outside, &mut all.outside);
    }
    all
}

impl SceneMap {
    /// Draws the map of a scene; its longer side has `size` pixels.
    #[must_use]
    pub fn new(loaded: &LoadedScene, size: u32) -> Self {
        let contents = MapContents::new(loaded);
        let letters = Letters::for_width(size as usize);
        let (line, letter) = (letters.height() as f64, letters.width() as f64);
        let digits = widest_coordinate(contents.shown, contents.origin) as f64;
        let corner = DVec2::new((digits + 3.0) * letter, 2.4 * line);
        let projection = PageProjection::new(contents.shown, corner, size.into());
        let classes = MeshClasses::new(&loaded.world.world);
        let relief = contents.relief.draw(&projection);
        let world = &loaded.world.world;
        let drawn = crowns(world, &classes, contents.tile, contents.is_periodic, &projection);
        let legend = MapLegend::new(&contents, &classes, &relief, drawn.are_pixels);
        let mut clipped = vec![relief.ground];
        // Contours are visible through circles, and would be hidden by pixels.
        let (below, above) =
            if drawn.are_pixels { (None, relief.contours) } else { (relief.contours, None) };
        clipped.extend(below);
        clipped.extend(drawn.items);
        clipped.extend(above);
        clipped.extend(area_items(&contents.areas, &projection));
        if !contents.is_periodic {
            let Rectangle { min, max } = contents.tile;
            let paint = Paint::line(Ink::solid(INK), 1.0);
            clipped.push(DrawnItem::rectangle(projection.page(min), projection.page(max), paint));
        }
        clipped.extend(sensors::draw(&contents.sensors, &projection, letters));

        let [low, high] = projection.frame;
        // The frame of a periodic scene is the border that repeats.
        let frame = if contents.is_periodic {
            Paint::dashes(Ink::solid(INK), 3.0)
        } else {
            Paint::line(Ink::solid(INK), 1.4)
        };
        let mut over = vec![DrawnItem::rectangle(low, high, frame)];
        over.extend(coordinates(&projection, contents.origin, letters));
        let foot = high.y + 2.6 * line;
        over.extend(scale_bar(&projection, DVec2::new(low.x, foot)));
        over.extend(north_arrow(DVec2::new(high.x - letter, foot + 2.2 * line), letters));
        let axes = match &contents.system {
            Some(system) => format!("{system}, m"),
            None if contents.origin == DVec3::ZERO => "m, local frame".to_owned(),
            None => "m, map coordinates of the frame".to_owned(),
        };
        over.push(DrawnItem::text(DVec2::new(low.x, foot + 1.5 * line), axes, Anchor::Start));
        let side = DVec2::new(high.x + 2.0 * letter, low.y);
        let (column, end) = legend.draw(side, letters);
        over.extend(column);
        let width = (side.x + MapLegend::width(letters) + letter).ceil();
        let title = &loaded.scene().title;
        let heading = letters.fitted(title, (width - low.x - letter).max(0.0) as usize);
        over.push(DrawnItem::text(DVec2::new(low.x, 1.2 * line), heading, Anchor::Start));
        let height = (foot + 3.2 * line).max(end + line).ceil();
        let drawing = Drawing {
            width: width as usize,
            height: height as usize,
            letters,
            frame: projection.frame,
            clipped,
            over,
        };
        Self { title: title.clone(), drawing, contents: legend.lines() }
    }

    /// The map as SVG.
    #[must_use]
    pub fn svg(&self) -> String {
        svg::svg(&self.drawing, if self.title.is_empty() { "Map of a scene" } else { &self.title })
    }

    /// The map as PNG; `None` if there is no memory for its pixels.
    #[must_use]
    pub fn png(&self) -> Option<Vec<u8>> {
        let rgb = raster::rgb(&self.drawing)?;
        Some(png_bytes(self.drawing.width, self.drawing.height, &rgb))
    }
}

fn area_items(areas: &PlantingAreas, projection: &PageProjection) -> Vec<DrawnItem> {
    let item = |polygon: &Polygon, paint: Paint| {
        let ring = |ring: &Vec<DVec2>| ring.iter().map(|&at| projection.page(at)).collect();
        DrawnItem::Path { lines: polygon.rings.iter().map(ring).collect(), is_closed: true, paint }
    };
    let inside = Paint::line(Ink::solid(INSIDE), 1.6);
    let outside = Paint {
        fill: Some(Ink::with_opacity(OUTSIDE, 0.12)),
        ..Paint::line(Ink::solid(OUTSIDE), 1.6)
    };
    let inside = areas.inside.iter().map(|polygon| item(polygon, inside));
    inside.chain(areas.outside.iter().map(|polygon| item(polygon, outside))).collect()
}
