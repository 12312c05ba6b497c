//! Sensors of a map: footprints of parallel projections, fields of view and positions of cameras, planes of photons.

use glam::{DVec2, DVec3};
use hecs::World;

use super::drawing::{Anchor, DrawnItem, Ink, Paint};
use super::page::PageProjection;
use crate::components::{
    CameraPlacement, CountingPlane, Footprint, Name, Optics, OrthographicOptics, ResolvedSensor,
    SceneId, View,
};
use crate::geometry::{PixelGrid, Rectangle};
use crate::output::Letters;
use crate::terrain::Ground;
use crate::transport::{CameraPose, view_axes};

/// Colour of sensors.
const SENSOR: [u8; 3] = [150, 0, 70];

/// Sensor, and what a map shows of it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SensorMark {
    pub(super) name: String,
    pub(super) kind: &'static str,
    pub(super) shape: SensorShape,
    /// Directions towards the sensor, if it is far away.
    pub(super) views: Vec<View>,
}

/// Part of the ground that a sensor looks at, or the place that it looks from; m, local frame.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum SensorShape {
    /// The whole scene.
    Whole,
    /// Corners of a part of the ground.
    Footprint(Vec<DVec2>),
    /// Position, horizontal part of the viewing direction, and corners of the field of view on the ground, if it has any.
    Camera { at: DVec2, ahead: DVec2, field: Vec<DVec2> },
}

/// Ground that footprints lie on.
struct Site<'a> {
    ground: Option<&'a Ground>,
    /// Height beside the ground and in its holes, m.
    lowest: f64,
    /// Length beyond which a field of view is cut, m.
    reach: f64,
}

impl Site<'_> {
    fn height(&self, at: DVec2) -> f64 {
        self.ground.and_then(|ground| ground.height(at)).unwrap_or(self.lowest)
    }

    /// Place where a line meets the level of the ground below its target, cut at the reach; a line that rises has the place
    /// at the reach.
    fn meet(&self, from: DVec3, direction: DVec3, level: f64) -> DVec2 {
        let horizontal = direction.truncate().length();
        let longest = if horizontal > 1e-9 { self.reach / horizontal } else { self.reach };
        let distance = (level - from.z) / direction.z;
        let is_met = direction.z < -1e-9 && distance > 0.0;
        (from + direction * if is_met { distance.min(longest) } else { longest }).truncate()
    }
}

/// Sensors of a world in document order.
pub(super) fn sensors(
    world: &World,
    ground: Option<&Ground>,
    tile: Rectangle,
    lowest: f64,
) -> Vec<SensorMark> {
    let site = Site { ground, lowest, reach: 2.0 * tile.size().max_element() };
    let mut query = world.query::<(&SceneId, &Name, &ResolvedSensor)>();
    let mut sensors: Vec<_> = query.iter().collect();
    sensors.sort_unstable_by_key(|(id, ..)| **id);
    sensors.into_iter().map(|(_, name, sensor)| mark(&name.0, sensor, &site)).collect()
}

fn mark(name: &str, sensor: &ResolvedSensor, site: &Site<'_>) -> SensorMark {
    let (kind, shape, views) = match sensor {
        ResolvedSensor::Image(image) => match &image.optics {
            Optics::Orthographic(optics) => {
                ("orthographic", parallel(optics, site), vec![optics.view])
            }
            Optics::Perspective(optics) => {
                let half = (0.5 * optics.field).map(f64::tan);
                ("perspective", camera(&optics.placement, Some(half), site), Vec::new())
            }
            Optics::Fisheye(optics) => {
                ("fisheye", camera(&optics.placement, None, site), Vec::new())
            }
        },
        ResolvedSensor::Directions(sensor) => {
            ("directions", plane(sensor.plane.as_ref()), sensor.views.clone())
        }
        ResolvedSensor::Photons(sensor) => {
            let views = sensor.products.iter().flat_map(|product| product.views.iter().copied());
            ("photons", plane(sensor.plane.as_ref()), views.collect())
        }
    };
    SensorMark { name: name.to_owned(), kind, shape, views }
}

/// Footprint of a parallel projection on the level of the ground in its middle.
fn parallel(optics: &OrthographicOptics, site: &Site<'_>) -> SensorShape {
    let Footprint::Rectangle { extent, center } = optics.footprint else {
        return SensorShape::Whole;
    };
    let extent = optics.pixel.map_or(extent, |side| PixelGrid::covering(extent, side).extent);
    let middle = center.extend(site.height(center));
    let (right, down) = view_axes(optics.view);
    let corner = |x: f64, y: f64| {
        let point = middle + x * extent.x * right + y * extent.y * down;
        // From this side of the ground or the other: the line has no ends.
        let towards = optics.view.direction();
        let distance = (point.z - middle.z) / towards.z.max(1e-3);
        (point - towards * distance).truncate()
    };
    SensorShape::Footprint(vec![
        corner(-0.5, -0.5),
        corner(0.5, -0.5),
        corner(0.5, 0.5),
        corner(-0.5, 0.5),
    ])
}

/// A camera; `tangents` are those of half the fields of view of a perspective.
fn camera(placement: &CameraPlacement, tangents: Option<DVec2>, site: &Site<'_>) -> SensorShape {
    let pose = CameraPose::new(placement, |at| site.height(at));
    let level = site.height(pose.eye.truncate());
    let field = tangents.map_or_else(Vec::new, |tangents| {
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let ray = |(x, y): (f64, f64)| {
            let through = pose.ahead + x * tangents.x * pose.right + y * tangents.y * pose.down;
            site.meet(pose.eye, through.normalize_or_zero(), level)
        };
        // A camera that looks above the horizon shows no ground.
        let looks_up =
            corners.iter().all(|&(_, y)| (pose.ahead + y * tangents.y * pose.down).z > 0.0);
        if looks_up { Vec::new() } else { corners.map(ray).to_vec() }
    });
    SensorShape::Camera { at: pose.eye.truncate(), ahead: pose.ahead.truncate(), field }
}

fn plane(plane: Option<&CountingPlane>) -> SensorShape {
    plane.map_or(SensorShape::Whole, |plane| {
        let corner = |x: f64, y: f64| plane.center + 0.5 * DVec2::new(x, y) * plane.size;
        SensorShape::Footprint(vec![
            corner(-1.0, -1.0),
            corner(1.0, -1.0),
            corner(1.0, 1.0),
            corner(-1.0, 1.0),
        ])
    })
}

/// Draws the sensors that have a place, each with its number in the list.
pub(super) fn draw(
    marks: &[SensorMark],
    projection: &PageProjection,
    letters: Letters,
) -> Vec<DrawnItem> {
    let mut items = Vec::new();
    let mut labels: Vec<(DVec2, String)> = Vec::new();
    for (index, mark) in marks.iter().enumerate() {
        let label = match &mark.shape {
            SensorShape::Whole => continue,
            SensorShape::Footprint(corners) => {
                let ring: Vec<DVec2> = corners.iter().map(|&at| projection.page(at)).collect();
                let at = ring.iter().copied().reduce(leftmost).unwrap_or_default();
                let paint = Paint::line(Ink::solid(SENSOR), 1.8);
                items.push(DrawnItem::Path { lines: vec![ring], is_closed: true, paint });
                at
            }
            SensorShape::Camera { at, ahead, field } => {
                camera_items(*at, *ahead, field, projection, &mut items)
            }
        };
        // Labels of sensors at one place would cover each other.
        let near = |(at, _): &&mut (DVec2, String)| at.distance(label) < letters.height() as f64;
        match labels.iter_mut().find(near) {
            Some((_, text)) => *text = format!("{text},{}", index + 1),
            None => labels.push((label, (index + 1).to_string())),
        }
    }
    items.extend(labels.iter().flat_map(|(at, text)| plate(*at, text, projection, letters)));
    items
}

/// The one further up and left on the page.
fn leftmost(a: DVec2, b: DVec2) -> DVec2 {
    if a.x + a.y <= b.x + b.y { a } else { b }
}

/// Draws a camera; returns its place on the page.
fn camera_items(
    at: DVec2,
    ahead: DVec2,
    field: &[DVec2],
    projection: &PageProjection,
    items: &mut Vec<DrawnItem>,
) -> DVec2 {
    let ink = Ink::solid(SENSOR);
    let eye = projection.page(at);
    if !field.is_empty() {
        let ring: Vec<DVec2> = field.iter().map(|&at| projection.page(at)).collect();
        let edges = ring.iter().map(|&corner| vec![eye, corner]).collect();
        let faint = Paint::line(Ink::with_opacity(SENSOR, 0.5), 0.9);
        items.push(DrawnItem::Path { lines: edges, is_closed: false, paint: faint });
        let paint =
            Paint { fill: Some(Ink::with_opacity(SENSOR, 0.05)), ..Paint::dashes(ink, 1.4) };
        items.push(DrawnItem::Path { lines: vec![ring], is_closed: true, paint });
    }
    if ahead.length() > 0.05 {
        let along = DVec2::new(ahead.x, -ahead.y).normalize();
        items.extend(DrawnItem::arrow(eye, eye + 26.0 * along, ink, 2.0));
    }
    let white = Some(Ink::solid([255; 3]));
    items.push(DrawnItem::Circle {
        centre: eye,
        radius: 5.0,
        paint: Paint { fill: white, ..Paint::line(ink, 2.0) },
    });
    eye
}

/// A text beside a place, on a plate, within the frame.
fn plate(at: DVec2, text: &str, projection: &PageProjection, letters: Letters) -> Vec<DrawnItem> {
    let half = 0.5 * DVec2::new((letters.width_of(text) + 6) as f64, letters.height() as f64);
    let [low, high] = projection.frame;
    let middle = (at + half + 6.0).clamp(low + half, (high - half).max(low + half));
    let plate = Paint {
        fill: Some(Ink::with_opacity([255; 3], 0.85)),
        ..Paint::line(Ink::solid(SENSOR), 1.0)
    };
    vec![
        DrawnItem::rectangle(middle - half, middle + half, plate),
        DrawnItem::text(middle, text, Anchor::Middle),
    ]
}
