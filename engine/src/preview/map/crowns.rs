//! Crowns of a map: a circle for each instance, in the colour of its mesh.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use hecs::World;

use super::drawing::{DrawnItem, Ink, Paint, PixelLayer, Stroke};
use super::page::PageProjection;
use crate::components::{
    Instance, InstanceCount, MeshBounds, Name, Placement, PrototypeId, SceneId,
};
use crate::geometry::Rectangle;
use crate::preview::palette::{CLASSES, OTHERS};

/// Circles that a map draws as such; of more, each pixel has the mean colour of the crowns on it.
const MOST_CIRCLES: usize = 5000;

/// Opacity of pixels of crowns.
const PIXEL_OPACITY: u8 = 190;

/// Smallest radius of a crown, pixels.
const SMALLEST: f64 = 0.9;

/// Meshes of a map and their colours.
#[derive(Clone, Debug)]
pub(super) struct MeshClasses {
    /// Names and numbers of instances, most frequent first; those that share a colour are one entry.
    pub(super) entries: Vec<MeshEntry>,
    colours: BTreeMap<u32, [u8; 3]>,
    boxes: BTreeMap<u32, MeshBounds>,
}

/// Meshes of one colour.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct MeshEntry {
    pub(super) name: String,
    pub(super) colour: [u8; 3],
    pub(super) instances: u64,
}

/// Outline of an instance seen from above, m, local frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum CrownOutline {
    Circle {
        centre: DVec2,
        radius: f64,
    },
    /// Corners of the box around a mesh that is no single plant, but a plot.
    Plot([DVec2; 4]),
}

impl MeshClasses {
    pub(super) fn new(world: &World) -> Self {
        let mut query = world.query::<(&SceneId, &Name, &InstanceCount, &MeshBounds)>();
        let mut meshes: Vec<_> = query.iter().filter(|(_, _, count, _)| count.0 > 0).collect();
        meshes.sort_unstable_by_key(|(id, _, count, _)| (std::cmp::Reverse(count.0), **id));
        let boxes = meshes.iter().map(|(id, _, _, bounds)| (id.0, **bounds)).collect();
        let mut colours = BTreeMap::new();
        let mut entries: Vec<MeshEntry> = Vec::new();
        for (index, (id, name, count, _)) in meshes.iter().enumerate() {
            let colour = CLASSES.get(index).copied().unwrap_or(OTHERS);
            colours.insert(id.0, colour);
            match entries.get_mut(CLASSES.len()) {
                Some(others) => {
                    others.instances += count.0;
                    others.name = format!("{} other meshes", index + 1 - CLASSES.len());
                }
                None => {
                    entries.push(MeshEntry { name: name.0.clone(), colour, instances: count.0 });
                }
            }
        }
        Self { entries, colours, boxes }
    }

    fn colour(&self, mesh: PrototypeId) -> [u8; 3] {
        self.colours.get(&mesh.0).copied().unwrap_or(OTHERS)
    }

    /// Outline of an instance; `None` if its mesh has no primitive. Boxes wider than `widest`, m, are plots.
    pub(super) fn outline(&self, placement: &Placement, widest: f64) -> Option<CrownOutline> {
        let MeshBounds { low, high } = self.boxes.get(&placement.prototype.0)?;
        let (low, high) = (low.as_dvec3(), high.as_dvec3());
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let turn = placement.world_from_object();
        let scale = f64::from(placement.scale.horizontal);
        let place = |point: DVec3| (placement.position + turn * point).truncate();
        if 2.0 * scale * half.truncate().max_element() > widest {
            let corner = |x: f64, y: f64| place(middle + DVec3::new(x * half.x, y * half.y, 0.0));
            let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
            return Some(CrownOutline::Plot(corners.map(|(x, y)| corner(x, y))));
        }
        let radius = scale * half.truncate().max_element();
        let (sin, cos) = f64::from(placement.lean.tilt).sin_cos();
        let height = half.z * f64::from(placement.scale.vertical);
        // Along the lean, a cylinder of this radius and height reaches further than across.
        let radius = radius.max(radius * cos.abs() + height * sin.abs());
        Some(CrownOutline::Circle { centre: place(middle), radius })
    }
}

/// Crowns as items of a drawing.
pub(super) struct DrawnCrowns {
    pub(super) items: Vec<DrawnItem>,
    /// True if they are pixels, which show mean colours.
    pub(super) are_pixels: bool,
}

/// Draws the crowns of a world. In a periodic scene, those on the border of the `tile` are drawn on both sides.
pub(super) fn crowns(
    world: &World,
    classes: &MeshClasses,
    tile: Rectangle,
    is_periodic: bool,
    projection: &PageProjection,
) -> DrawnCrowns {
    let widest = 0.5 * tile.size().min_element();
    let instances = Instance::in_order(world);
    let are_pixels = instances.len() > MOST_CIRCLES;
    let mut layer = CrownPixels::new(projection);
    let mut items = Vec::new();
    for Instance { placement, .. } in &instances {
        let Some(outline) = classes.outline(placement, widest) else { continue };
        let colour = classes.colour(placement.prototype);
        for shift in shifts(&outline, tile, is_periodic) {
            match outline {
                CrownOutline::Circle { centre, radius } => {
                    let centre = projection.page(centre + shift);
                    let radius = (radius * projection.scale).max(SMALLEST);
                    if are_pixels {
                        layer.add_disc(centre, radius, colour);
                    } else {
                        items.push(DrawnItem::Circle {
                            centre,
                            radius,
                            paint: crown_paint(colour),
                        });
                    }
                }
                CrownOutline::Plot(corners) => {
                    let ring = corners.map(|corner| projection.page(corner + shift)).to_vec();
                    // Many plots would hide everything.
                    if items.len() < MOST_CIRCLES {
                        let paint = crown_paint(colour);
                        items.push(DrawnItem::Path { lines: vec![ring], is_closed: true, paint });
                    }
                }
            }
        }
    }
    if are_pixels {
        items.push(DrawnItem::Pixels(layer.layer()));
    } else {
        // Small crowns lie on large ones, else they were hidden.
        items.sort_by(|a, b| radius_of(b).total_cmp(&radius_of(a)));
    }
    DrawnCrowns { items, are_pixels }
}

fn radius_of(item: &DrawnItem) -> f64 {
    match item {
        DrawnItem::Circle { radius, .. } => *radius,
        _ => f64::INFINITY,
    }
}

fn crown_paint(colour: [u8; 3]) -> Paint {
    let dark = colour.map(|channel| (u16::from(channel) * 3 / 5) as u8);
    Paint {
        fill: Some(Ink::with_opacity(colour, 0.62)),
        stroke: Some(Stroke { ink: Ink::with_opacity(dark, 0.9), width: 0.8, is_dashed: false }),
    }
}

/// Displacements of the copies of an outline that reach into the tile, m.
fn shifts(
    outline: &CrownOutline,
    tile: Rectangle,
    is_periodic: bool,
) -> impl Iterator<Item = DVec2> + use<> {
    let (centre, radius, count) = match *outline {
        CrownOutline::Circle { centre, radius } if is_periodic => (centre, radius, 9),
        CrownOutline::Circle { .. } | CrownOutline::Plot(_) => (tile.min, 0.0, 1),
    };
    let size = tile.size();
    // Its middle in the tile, then its copies around.
    let home = if count == 1 {
        DVec2::ZERO
    } else {
        (centre - tile.min).rem_euclid(size) + tile.min - centre
    };
    let steps = [0.0, -1.0, 1.0];
    let all =
        (0..count).map(move |index| home + DVec2::new(steps[index % 3], steps[index / 3]) * size);
    all.filter(move |shift| {
        let at = centre + *shift;
        (at + radius).cmpge(tile.min).all() && (at - radius).cmple(tile.max).all()
    })
}

/// Crowns as pixels of the map.
struct CrownPixels {
    corner: DVec2,
    extent: DVec2,
    columns: usize,
    rows: usize,
    /// Sums of red, green and blue of the crowns on each pixel, and their number.
    sums: Vec<[u32; 4]>,
}

impl CrownPixels {
    fn new(projection: &PageProjection) -> Self {
        let [corner, high] = projection.frame;
        let extent = high - corner;
        let (columns, rows) =
            (extent.x.ceil().max(1.0) as usize, extent.y.ceil().max(1.0) as usize);
        Self { corner, extent, columns, rows, sums: vec![[0; 4]; columns * rows] }
    }

    /// Adds a crown to the pixels whose middles lie on its disc, and to that of its centre.
    fn add_disc(&mut self, centre: DVec2, radius: f64, [r, g, b]: [u8; 3]) {
        let Self { corner, extent, columns, rows, sums } = self;
        let scale = DVec2::new(*columns as f64, *rows as f64) / *extent;
        let at = (centre - *corner) * scale;
        let range = |middle: f64, count: usize| {
            let low = (middle - radius).floor().clamp(0.0, count as f64) as usize;
            let high = (middle + radius).ceil().clamp(0.0, count as f64) as usize;
            low..high
        };
        for row in range(at.y, *rows) {
            for column in range(at.x, *columns) {
                let middle = DVec2::new(column as f64 + 0.5, row as f64 + 0.5);
                let is_home = (at - middle).abs().max_element() <= 0.5;
                if is_home || middle.distance_squared(at) <= radius * radius {
                    let sum = &mut sums[row * *columns + column];
                    let added = [r.into(), g.into(), b.into(), 1];
                    *sum =
                        std::array::from_fn(|channel| sum[channel].saturating_add(added[channel]));
                }
            }
        }
    }

    /// Mean colour of each pixel, through which the ground is visible.
    fn layer(self) -> PixelLayer {
        let Self { corner, extent, columns, rows, sums } = self;
        let pixel = |&[r, g, b, count]: &[u32; 4]| match count {
            0 => [0; 4],
            count => {
                let [r, g, b] = [r, g, b].map(|sum| ((sum + count / 2) / count) as u8);
                [r, g, b, PIXEL_OPACITY]
            }
        };
        let rgba = sums.iter().flat_map(pixel).collect();
        PixelLayer { corner, extent, columns, rows, rgba, is_smooth: false }
    }
}
