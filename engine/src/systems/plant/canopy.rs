use super::{Site, rectangle_of};
use crate::components::Placement;
use crate::counts::{agreeing, counted};
use crate::document::{CanopyHeights, Diagnostic, Prototype, Ref};
use crate::geometry::{millimetres, place_text};
use crate::placement::canopy::{Crown, Model, Window, crowns, fit};
use crate::systems::georeference::{RasterQuantity, RasterSource, read_raster_on_terrain};
use crate::terrain::Ground;

/// Heights beyond this are no trees, m: the tallest on Earth is 116 m high.
const HIGHEST: f64 = 118.0;

/// Few trees are higher than this, m.
const TALL: f64 = 70.0;

/// Trees of a canopy height model; `None` after an error.
pub(super) fn plant_canopy(
    canopy: &CanopyHeights,
    ground: &Ground,
    site: &mut Site<'_>,
) -> Option<Vec<Placement>> {
    let CanopyHeights { file, of, height_unit_m, min_height_m, window, sink_m, name } = canopy;
    let terrain = rectangle_of(ground);
    let models = models(of, site)?;
    let at = site.path.key("file");
    let source = RasterSource {
        height_unit_m: *height_unit_m,
        ..RasterSource::new(file, &at, RasterQuantity::Heights)
    };
    let model = read_raster_on_terrain(&source, terrain, &mut site.map, site.resources)?;
    let beyond = |height: &&f64| height.abs() > HIGHEST;
    if let Some(height) = model.values.iter().find(beyond) {
        let message = format!("a tree of {height} m is not of this Earth");
        let help = "heights of a canopy are those above the ground: if these are above sea level (a \
                        surface model), subtract the terrain (`gdal_calc.py -A surface.tif -B \
                        terrain.tif --calc=A-B`); if they are in centimetres, write `height_unit_m: \
                        0.01`; if it stands for no data, name it in the file's header";
        site.report(Diagnostic::error(at, message).help(help));
        return None;
    }
    let highest = model.values.iter().copied().fold(0.0, f64::max);
    if highest > TALL {
        let message = format!("its highest tree is {highest} m high");
        let help = "few trees on Earth are: if the heights are in decimetres, write `height_unit_m: 0.1`, \
                        in feet `height_unit_m: 0.3048`; if they are above sea level, subtract the terrain";
        site.report(Diagnostic::warning(at.clone(), message).help(help));
    }
    let window = Window { a: window.0, b: window.1 };
    let found = crowns(&model, window, *min_height_m);
    let heights: Vec<Option<f64>> = found.iter().map(|crown| ground.height(crown.place)).collect();
    let (trees, heights): (Vec<Crown>, Vec<f64>) =
        found.iter().zip(heights).filter_map(|(&crown, height)| Some((crown, height?))).unzip();
    if trees.is_empty() {
        let message = format!("no tree of {min_height_m} m stands on the terrain");
        let high = model.values.iter().copied().fold(0.0, f64::max);
        let end = model.corner + model.size;
        let help = format!(
            "its highest cell is {} m, and it reaches from {} to {} m",
            millimetres(high),
            place_text(model.corner),
            place_text(end)
        );
        site.report(Diagnostic::error(at, message).help(help));
    } else if trees.len() < found.len() {
        let beside = found.len() - trees.len();
        let message = format!(
            "{beside} of {} {} no terrain below",
            counted(found.len(), "tree"),
            agreeing(beside, "has", "have")
        );
        let help = "they are left out";
        site.report(Diagnostic::warning(at, message).help(help));
    }
    let stream = site.stream(name.as_deref(), None);
    Some(fit(&trees, &heights, &models, *sink_m, stream))
}

/// Meshes that may stand for trees; `None` if there is none.
fn models(of: &[Ref<Prototype>], site: &mut Site<'_>) -> Option<Vec<Model>> {
    let mut models = Vec::new();
    for (index, name) in of.iter().enumerate() {
        let path = site.path.key("of").index(index);
        let Some(prototype) = site.resources.prototype(name, &path) else { continue };
        // One that is hidden everywhere or could not be loaded stands for no tree.
        let Some(shape) = site.shapes.get(&prototype.0) else { continue };
        let (low, high) = shape.bounds.map(|box_| (box_.low, box_.high)).unwrap_or_default();
        let size = (high - low).as_dvec3();
        let (height, diameter) = (f64::from(high.z), (size.x * size.y).sqrt());
        if height > 0.0 && diameter > 0.0 {
            models.push(Model { prototype, height, diameter });
        } else {
            let message = format!("`{name}` has no height above its origin, or no width");
            let help = "add `origin: BaseCenter` to the mesh, or take another";
            site.report(Diagnostic::error(path, message).help(help));
        }
    }
    (!models.is_empty()).then_some(models)
}
