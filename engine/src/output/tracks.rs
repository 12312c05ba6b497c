//! Views of a product in vertical planes, as lines of a chart.

use super::view_plane::ViewPlane;

/// Maximum number of vertical planes of views in a chart of lines.
const MOST_PLANES: usize = 4;

/// Position of the sun in the sky.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SunAngles {
    pub(super) zenith_deg: f64,
    /// Clockwise from north.
    pub(super) azimuth_deg: f64,
}

/// Places along the first dimension of a product that belong to one line, in rising order.
#[derive(Clone, Debug)]
pub(super) struct Track {
    pub(super) name: String,
    /// Plane of the views, where they have positive and negative zenith angles.
    pub(super) plane: Option<ViewPlane>,
    /// Place on the axis and number along the dimension.
    pub(super) places: Vec<(f64, usize)>,
}

/// Title of the axis of zenith angles; a single plane is named there and not beside each line.
pub(super) fn axis_of_zeniths(tracks: &mut [Track]) -> String {
    match tracks {
        [Track { plane: Some(ViewPlane::Principal), name, .. }] => {
            name.clear();
            "principal plane, view zenith (°): − forward scattering, + backward scattering (side of the sun)"
                .to_owned()
        }
        [Track { plane: Some(plane @ ViewPlane::Cross), name, .. }] => {
            name.clear();
            format!("cross plane, {}", plane.axis_title())
        }
        [Track { name, .. }] if !name.is_empty() => {
            format!("view zenith (°), {}", std::mem::take(name))
        }
        _ => "view zenith (°)".to_owned(),
    }
}

/// Zenith angles and azimuths of views, with negative zenith angles turned to the other side.
pub(super) fn upright(zeniths: &[f64], azimuths: &[f64]) -> Vec<(f64, f64)> {
    let view = |(&zenith, &azimuth): (&f64, &f64)| {
        if zenith < 0.0 {
            (-zenith, (azimuth + 180.0).rem_euclid(360.0))
        } else {
            (zenith, azimuth)
        }
    };
    zeniths.iter().zip(azimuths).map(view).collect()
}

/// Views by the vertical plane that they lie in, with signed zenith angles: positive towards the azimuth of
/// the last view of the plane; in the principal plane towards the sun, and in the cross plane towards 90° clockwise of it.
/// Nadir views lie in all planes.
pub(super) fn planes(views: &[(f64, f64)], sun: Option<SunAngles>) -> Option<Vec<Track>> {
    let (zeniths, azimuths): (Vec<f64>, Vec<f64>) = views.iter().copied().unzip();
    let is_slanted = |view: usize| zeniths[view] > 1e-9;
    let across = |a: f64, b: f64| {
        let turn = (a - b).rem_euclid(180.0);
        turn.min(180.0 - turn)
    };
    // The last view of each plane first.
    let mut references: Vec<f64> = Vec::new();
    for view in (0..zeniths.len()).rev().filter(|&view| is_slanted(view)) {
        if references.iter().all(|&azimuth| across(azimuth, azimuths[view]) > 1e-6) {
            references.push(azimuths[view]);
        }
    }
    if references.len() > MOST_PLANES || references.is_empty() {
        return None;
    }
    references.reverse();
    let is_single = references.len() == 1;
    let track = |last: f64| {
        let plane = ViewPlane::new(last, sun.map(|sun| sun.azimuth_deg));
        let turned = |turn: f64| sun.map_or(last, |sun| (sun.azimuth_deg + turn).rem_euclid(360.0));
        let reference = match plane {
            ViewPlane::Principal => turned(0.0),
            ViewPlane::Cross => turned(90.0),
            ViewPlane::Other { .. } => last,
        };
        let place = |view: usize| {
            if !is_slanted(view) {
                return Some((0.0, view));
            }
            let turn = (azimuths[view] - reference).rem_euclid(360.0);
            let is_behind = (turn - 180.0).abs() < 90.0;
            let sign = if is_behind { -1.0 } else { 1.0 };
            (across(azimuths[view], last) <= 1e-6).then_some((sign * zeniths[view], view))
        };
        let mut places: Vec<(f64, usize)> = (0..zeniths.len()).filter_map(place).collect();
        places.sort_by(|a, b| a.0.total_cmp(&b.0));
        let has_sign = places.iter().any(|place| place.0 < 0.0);
        let name = match (is_single, has_sign, plane) {
            (true, false, _) => String::new(),
            (_, false, _) => format!("azimuth {}°", super::scale::tick(reference)),
            (_, _, ViewPlane::Principal) => "principal plane, + sun's side".to_owned(),
            _ => format!("+ towards {}°", super::scale::tick(reference)),
        };
        Track { name, plane: has_sign.then_some(plane), places }
    };
    Some(references.into_iter().map(track).collect())
}
