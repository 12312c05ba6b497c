//! Virtual planes.

use super::super::scene::{Scene, Terrain, TerrainPlane, VirtualPlane};
use super::{Report, ScenePath};

/// Beyond the terrain by less than this share of its extent is rounding.
const ROUNDING: f64 = 1e-9;

pub(super) fn check_plane(
    sensor: &ScenePath,
    plane: Option<&VirtualPlane>,
    scene: &Scene,
    report: &mut Report<'_>,
) {
    let Some(VirtualPlane { center_m, size_m, height_m }) = plane else { return };
    let path = sensor.key("virtual_plane");
    if let Some((x, y)) = center_m {
        report.finite(path.key("center_m"), &[*x, *y]);
    }
    if let Some((width, depth)) = size_m {
        report.above_zero(path.key("size_m").index(0), *width);
        report.above_zero(path.key("size_m").index(1), *depth);
    }
    if !report.is_whole("terrain") {
        return;
    }
    let Terrain::Plane(TerrainPlane { size_m: terrain, corner_m, height_m: ground, .. }) =
        &scene.terrain
    else {
        // Where other terrain lies is known only when its file is read.
        return report.finite(path.key("height_m"), height_m.as_slice());
    };
    if let Some(height) = height_m
        && !(*height >= *ground && height.is_finite())
    {
        let message =
            format!("nothing leaves through a plane at {height} m: the ground lies at {ground} m");
        let help = "leave `height_m` out: the plane then lies on the highest point of the scene";
        report.error(path.key("height_m"), message, help);
    }
    let middle = (corner_m.0 + 0.5 * terrain.0, corner_m.1 + 0.5 * terrain.1);
    let (center, size) = (center_m.unwrap_or(middle), size_m.unwrap_or(*terrain));
    let along = [
        Span::new(center.0, size.0, corner_m.0, terrain.0),
        Span::new(center.1, size.1, corner_m.1, terrain.1),
    ];
    if size.0.min(size.1) > 0.0 && along.iter().any(Span::is_beyond) {
        let [x, y] = &along;
        let message = format!(
            "the virtual plane, from ({:?}, {:?}) to ({:?}, {:?}), is not on the terrain, from \
             ({:?}, {:?}) to ({:?}, {:?})",
            x.low, y.low, x.high, y.high, x.least, y.least, x.most, y.most
        );
        let [(x, width), (y, depth)] = along.map(|span| span.on_terrain());
        let help = format!(
            "write `virtual_plane: (center_m: ({x:?}, {y:?}), size_m: ({width:?}, {depth:?}))`"
        );
        report.error(path, message, help);
    }
}

/// Intervals of a plane and of the terrain along one axis, m.
struct Span {
    low: f64,
    high: f64,
    least: f64,
    most: f64,
}

impl Span {
    fn new(center: f64, size: f64, corner: f64, terrain: f64) -> Self {
        let (low, high) = (center - 0.5 * size, center + 0.5 * size);
        Self { low, high, least: corner, most: corner + terrain }
    }

    fn is_beyond(&self) -> bool {
        let room = ROUNDING * (self.most - self.least);
        !(self.low >= self.least - room && self.high <= self.most + room)
    }

    /// Middle and extent of the part on the terrain; of all the terrain if there is none.
    fn on_terrain(&self) -> (f64, f64) {
        let (low, high) = (self.low.max(self.least), self.high.min(self.most));
        let (low, high) = if low < high { (low, high) } else { (self.least, self.most) };
        (0.5 * (low + high), high - low)
    }
}
