//! Checks of every raster, whatever its values are: its unit, its coordinate reference system,
//! the unit of heights, and values that stand for no data without being named.

use glam::DVec2;

use super::{MapFrame, MapTransform, check_crs};
use crate::assets::crs::TargetSystem;
use crate::assets::{
    AssetError, Assumed, Axes, Heights, Length, Raster, RasterError, RasterExtent,
    RasterGeoreference, read_raster,
};
use crate::counts::{agreeing, counted};
use crate::document::{Coordinates, Diagnostic, ScenePath};
use crate::geometry::Rectangle;
use crate::systems::Resources;

/// Quantity that the values of a raster are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::systems) enum RasterQuantity {
    /// Heights, m.
    Heights,
    /// Stems per hectare.
    Density,
    /// Classes.
    Classes,
    /// Fractions of the incident light.
    Reflectance,
}

/// Raster that the scene names.
#[derive(Clone, Debug)]
pub(in crate::systems) struct RasterSource<'a> {
    pub(in crate::systems) file: &'a str,
    /// Path of the key in the document that names the file.
    pub(in crate::systems) path: &'a ScenePath,
    pub(in crate::systems) quantity: RasterQuantity,
    /// Unit of the coordinates, if the scene says it.
    pub(in crate::systems) coordinates: Option<Coordinates>,
    /// True if the scene says how large the raster is, whatever the file says.
    pub(in crate::systems) has_size: bool,
    /// Length of the unit of heights, m, if the scene says so.
    pub(in crate::systems) height_unit_m: Option<f64>,
    /// Needed part, in the coordinates of the file.
    pub(in crate::systems) extent: Option<RasterExtent>,
}

impl<'a> RasterSource<'a> {
    /// Whole raster, with the units that its file names.
    pub(in crate::systems) fn new(
        file: &'a str,
        path: &'a ScenePath,
        quantity: RasterQuantity,
    ) -> Self {
        let (coordinates, has_size, height_unit_m, extent) = (None, false, None, None);
        Self { file, path, quantity, coordinates, has_size, height_unit_m, extent }
    }
}

/// Reads a raster whose coordinates are metres or degrees and whose heights are metres; reports an error if it is
/// another one.
pub(in crate::systems) fn read_georaster(
    source: &RasterSource<'_>,
    map: &mut MapFrame,
    resources: &mut Resources,
) -> Option<Raster> {
    let file = resources.file(source.file);
    for companion in crate::assets::companions(&file) {
        resources.messages.file(companion);
    }
    let nowhere = |error: &AssetError| {
        matches!(error, AssetError::Raster { problem: RasterError::WindowOfNowhere, .. })
    };
    let read = match read_raster(&file, source.extent.as_ref()) {
        // Classes without a place lie over the whole terrain, whose window nobody wrote.
        Err(error) if source.quantity == RasterQuantity::Classes && nowhere(&error) => {
            read_raster(&file, None)
        }
        read => read,
    };
    let mut raster = match read {
        Ok(raster) => raster,
        Err(error) => {
            resources.report(Diagnostic::error(source.path, error.to_string()));
            return None;
        }
    };
    check_georaster(&raster, source, map, resources)?;
    if source.quantity == RasterQuantity::Heights {
        convert_heights(&mut raster, source, resources)?;
    }
    Some(raster)
}

/// Refuses a raster in other coordinates than those of the scene; warns of values that may stand for no data.
pub(in crate::systems) fn check_georaster(
    raster: &Raster,
    source: &RasterSource<'_>,
    map: &mut MapFrame,
    resources: &mut Resources,
) -> Option<()> {
    if let Some(place) = &raster.place {
        check_unit(place, raster, source, map, resources)?;
        let is_projected = !raster.is_in_degrees() && source.coordinates.is_none();
        if is_projected && !source.has_size {
            check_crs(&place.crs, source.file, source.path, map, resources)?;
        }
    }
    warn_assumed(raster, source, resources);
    Some(())
}

/// Extent in the coordinates of the map of a part of the local frame.
pub(in crate::systems) fn extent_on_map(part: Rectangle, map: &MapFrame) -> Option<RasterExtent> {
    let MapTransform { from, to, scale, .. } = map.transform?;
    let back = |place: DVec2| from + (place - to) / scale;
    Some(RasterExtent { min: back(part.min), max: back(part.max) })
}

/// Refuses coordinates in another unit than metres and degrees, unless the scene says what they are.
fn check_unit(
    place: &RasterGeoreference,
    raster: &Raster,
    source: &RasterSource<'_>,
    map: &MapFrame,
    resources: &mut Resources,
) -> Option<()> {
    let is_as_terrain = map
        .transform
        .as_ref()
        .is_none_or(|reference| reference.is_given && map.axes == place.crs.axes);
    if source.has_size || source.coordinates.is_some() || is_as_terrain {
        return Some(());
    }
    let (name, target) = (&place.crs.name, target_of(raster, map));
    let (message, help) = match &place.crs.axes {
        Axes::Metres | Axes::Degrees | Axes::Unknown => return Some(()),
        Axes::Length(unit) => (
            in_unit(unit, name),
            format!(
                "a scene is in metres: reproject it to UTM (`gdalwarp -t_srs {target} -r bilinear in \
                     out`); heights stay as they are, so where they are in feet too, write \
                     `height_unit_m: 0.3048006` as well"
            ),
        ),
        Axes::World => (
            world_message(place, raster),
            format!("reproject it to UTM (`gdalwarp -t_srs {target} -r bilinear in out`)"),
        ),
        Axes::Geocentric => (
            format!("its coordinates are distances from the centre of the Earth ({name})"),
            format!("reproject it to UTM (`gdalwarp -t_srs {target} in out`)"),
        ),
    };
    let help = if *source.path == ["terrain", "file"].into() {
        format!("{help}, or write `coordinates: Metres` if they are metres after all")
    } else {
        help
    };
    resources.report(Diagnostic::error(source.path, message).help(help));
    None
}

/// System in metres to reproject a raster to: that of the scene, or the zone of UTM that the raster lies in.
pub(in crate::systems) fn target_of(raster: &Raster, map: &MapFrame) -> String {
    if let Some(code) = map.crs.as_ref().and_then(|system| system.crs.code) {
        return format!("EPSG:{code}");
    }
    let target = raster.place.as_ref().and_then(|place| {
        let middle = place.corner + 0.5 * place.cell * raster.size_in_cells();
        let is_known = raster.is_in_degrees() || place.crs.axes == Axes::World;
        let axes = if raster.is_in_degrees() { &Axes::Degrees } else { &place.crs.axes };
        is_known.then(|| TargetSystem::of_map(axes, middle))
    });
    target.map_or_else(|| "EPSG:326..".to_owned(), |target| format!("EPSG:{}", target.code))
}

/// Converts heights to metres.
fn convert_heights(
    raster: &mut Raster,
    source: &RasterSource<'_>,
    resources: &mut Resources,
) -> Option<()> {
    let path = source.path;
    if let Some(heights) = raster.heights.as_ref().filter(|heights| heights.is_depth) {
        let message =
            format!("its values are depths in {}, which count downwards", heights.unit.name);
        let help = "turn their sign and say so (`gdal_calc.py --calc=-A`), or correct the vertical \
                        system that the file names (`gdal_edit.py -a_srs`)";
        resources.report(Diagnostic::error(path, message).help(help));
        return None;
    }
    let metres = match (source.height_unit_m, &raster.heights) {
        (Some(metres), _) => metres,
        (None, Some(Heights { unit, .. })) if !unit.is_metre() => {
            let Length { name, metres } = unit;
            let message = format!(
                "its heights are in the unit {name}, as the file says; they are taken times \
                     {metres:.7} as metres"
            );
            let help = format!(
                "write `height_unit_m: {metres:.7}` to say so in the scene, or `height_unit_m: 1.0` if \
                     they are metres after all"
            );
            resources.report(Diagnostic::warning(path, message).help(help));
            *metres
        }
        _ => return Some(()),
    };
    raster.values.iter_mut().for_each(|height| *height *= metres);
    Some(())
}

/// Warns of cells that hold a value for no data which the file does not name.
fn warn_assumed(raster: &Raster, source: &RasterSource<'_>, resources: &mut Resources) {
    let Some(Assumed { value, count }) = raster.assumed else { return };
    let all = raster.columns * raster.rows;
    let message = format!(
        "{count} of its {} {} {value}, which stands for no data in other files but is not \
             named in this one; {} without data",
        counted(all, "cell"),
        agreeing(count, "holds", "hold"),
        agreeing(count, "it is taken as a cell", "they are taken as cells")
    );
    let help = format!(
        "name it in the file: `NODATA_value {value}`, `data ignore value = {value}`, or \
             `gdal_edit.py -a_nodata {value}`"
    );
    resources.report(Diagnostic::warning(source.path, message).help(help));
}

fn in_unit(unit: &Length, system: &str) -> String {
    let Length { name, metres } = unit;
    let length = if metres.is_finite() { format!(" of {metres:.7} m") } else { String::new() };
    let system = if system.is_empty() { String::new() } else { format!(" ({system})") };
    let kind = if name.contains("foot") { "feet" } else { "another unit than metres" };
    format!("its coordinates are in {kind}: {name}{length}{system}")
}

/// Message about a map of the world, with the ratio of its metres to those on the ground if it is known.
fn world_message(place: &RasterGeoreference, raster: &Raster) -> String {
    /// Radius of the sphere of Web Mercator, m.
    const RADIUS: f64 = 6_378_137.0;
    let name = &place.crs.name;
    let is_mercator = matches!(place.crs.code, Some(3857 | 3785 | 900_913 | 102_100 | 102_113))
        || name.to_lowercase().contains("mercator");
    let middle = place.corner + 0.5 * place.cell * raster.size_in_cells();
    if !is_mercator {
        return format!(
            "its coordinates are those of a map of the world ({name}), not metres on the ground"
        );
    }
    // The scale of a Mercator map is 1 / cos latitude, which is cosh of its northing.
    let longer = (middle.y / RADIUS).cosh();
    let latitude = (middle.y / RADIUS).sinh().atan().to_degrees();
    format!(
        "its coordinates are those of Web Mercator ({name}), whose metres at latitude {latitude:.1} are \
         {longer:.2} times as long as on the ground"
    )
}
