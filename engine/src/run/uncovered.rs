//! Bands that no representative band covers.

use crate::extract::Stage;
use crate::products::Context;

/// Ratio of a band to its representative above which paths end too early for it.
const MUCH_BRIGHTER: f32 = 1.5;

/// Number of bands that the warning names.
const NAMED: usize = 3;

/// Warning about bands that are much brighter on some surface than the bands that decide where paths end.
pub(super) fn warning(stage: &Stage, context: &Context) -> Option<String> {
    let chosen = stage.models.spectra.representative_bands();
    let bands: Vec<(usize, f32)> = chosen.brighter_than(MUCH_BRIGHTER).collect();
    let most = bands.iter().map(|(_, ratio)| *ratio).reduce(f32::max)?;
    let names = bands.iter().take(NAMED).map(|(band, _)| format!("`{}`", context.bands[*band]));
    let mut names = names.collect::<Vec<_>>().join(", ");
    if bands.len() > NAMED {
        names = format!("{names} and {} more", bands.len() - NAMED);
    }
    Some(format!(
        "bands differ so much that {} of them cannot stand for all where paths are ended: {names} are up to \
         {most:.1} times as bright on some surface as the band that stands for them, and their errors may be \
         larger than their standard errors say; measure them in a run of their own",
        chosen.bands().len()
    ))
}
