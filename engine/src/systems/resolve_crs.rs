use hecs::World;

use super::Resources;
use super::georeference::CoordinateSystem;
use crate::assets::Axes;
use crate::assets::crs::from_name;
use crate::document::Diagnostic;

/// Resolves the coordinate reference system that the frame names. Reads and writes resources: `frame`, `frame_crs`.
pub(super) fn resolve_crs(_: &mut World, resources: &mut Resources) {
    resources.frame_crs = None;
    let Some(name) = resources.frame.crs.clone() else { return };
    let utm = "write the number of a projected system in metres, such as `EPSG:32632` (UTM zone 32 \
               north on WGS 84) or `EPSG:25832` (on ETRS89)";
    let Some(crs) = from_name(&name) else {
        let message = format!("{name:?} names no coordinate reference system that is known");
        resources.report(Diagnostic::error(["frame", "crs"], message).help(utm));
        return;
    };
    let problem = match &crs.axes {
        Axes::Unknown if crs.heights.is_some() => Some("is a system of heights alone".to_owned()),
        Axes::Metres | Axes::Unknown => None,
        Axes::Degrees => Some("is in degrees, but a scene is in metres".to_owned()),
        Axes::Length(unit) => {
            Some(format!("is in the unit {}, but a scene is in metres", unit.name))
        }
        Axes::World => {
            Some("is a map of the world, whose metres are not metres on the ground".to_owned())
        }
        Axes::Geocentric => Some("has its origin in the centre of the Earth".to_owned()),
    };
    if let Some(problem) = problem {
        let message = format!("{} {problem}", crs.name);
        resources.report(Diagnostic::error(["frame", "crs"], message).help(utm));
        return;
    }
    resources.frame_crs = Some(CoordinateSystem { crs, owner: "`frame.crs`".to_owned() });
}
