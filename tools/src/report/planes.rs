//! Vertical planes that views lie in.

use sunfleck::output::{ViewPlane, tick};

use super::quantity::Quantity;

/// Maximum number of planes; more views than that are drawn as a hemisphere.
const MOST: usize = 4;

/// Views in one vertical plane.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Plane {
    pub(super) name: String,
    /// Title of the axis of signed zenith angles.
    pub(super) axis: &'static str,
    /// In rising order of the signed zenith angle.
    pub(super) places: Vec<Place>,
    /// Signed zenith angle at which the sun is behind the sensor.
    pub(super) hot_spot: Option<f64>,
}

/// A view of a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place {
    /// Zenith angle, positive on the side of the sun, degrees.
    pub(super) signed_zenith: f64,
    /// Number along the dimension of views.
    pub(super) index: usize,
}

/// Planes of a product by direction; `None` if its views lie in more than a few, or it has further dimensions.
///
/// - `sun`: zenith angle and azimuth of the sun, degrees, if they are known
pub(super) fn planes(quantity: &Quantity, sun: Option<[f64; 2]>) -> Option<Vec<Plane>> {
    let (zeniths, azimuths) = (quantity.numbers("zenith_deg")?, quantity.numbers("azimuth_deg")?);
    if quantity.places().len() > 1 {
        return None;
    }
    let signed = quantity.numbers("signed_zenith_deg").unwrap_or(zeniths);
    let is_slanted = |view: usize| zeniths[view].abs() > 1e-9;
    let mut references: Vec<f64> = Vec::new();
    for view in (0..zeniths.len()).filter(|&view| is_slanted(view)) {
        if references.iter().all(|&azimuth| !is_along(azimuth, azimuths[view])) {
            references.push(azimuths[view]);
        }
        if references.len() > MOST {
            return None;
        }
    }
    let plane = |azimuth: &f64| {
        let is_in = |view: &usize| !is_slanted(*view) || is_along(*azimuth, azimuths[*view]);
        let place = |index: usize| Place { signed_zenith: signed[index], index };
        let mut places: Vec<Place> = (0..zeniths.len()).filter(is_in).map(place).collect();
        places.sort_by(|a, b| a.signed_zenith.total_cmp(&b.signed_zenith));
        let plane = ViewPlane::new(*azimuth, sun.map(|[_, sun]| sun));
        let name = match plane {
            ViewPlane::Principal => "principal plane".to_owned(),
            ViewPlane::Cross => "cross plane".to_owned(),
            ViewPlane::Other { azimuth_deg } => {
                format!(
                    "plane of azimuths {}° and {}°",
                    tick(azimuth_deg),
                    tick(azimuth_deg + 180.0)
                )
            }
        };
        let is_principal = plane == ViewPlane::Principal;
        let hot_spot = sun.filter(|_| is_principal).map(|[zenith, _]| zenith);
        Plane { name, axis: plane.axis_title(), places, hot_spot }
    };
    let all: Vec<Plane> = references.iter().map(plane).collect();
    (!all.is_empty()).then_some(all)
}

/// Returns whether two azimuths are of the same vertical plane, degrees.
fn is_along(a: f64, b: f64) -> bool {
    let turn = (a - b).rem_euclid(180.0);
    turn.min(180.0 - turn) < 1e-6
}

#[cfg(test)]
mod tests {
    use super::super::summary::Points;
    use super::*;

    fn views(azimuths: &[f64]) -> Quantity {
        let zeniths = azimuths.iter().enumerate().map(|(at, _)| 10.0 * at as f64).collect();
        let axes = [("zenith_deg", zeniths), ("azimuth_deg", azimuths.to_vec())];
        let axes = axes.map(|(name, numbers)| (name.to_owned(), Points::Numbers(numbers)));
        Quantity {
            sensor: String::new(),
            name: "brf".to_owned(),
            unit: "1".to_owned(),
            dimensions: vec![axes.to_vec()],
            values: vec![0.0; azimuths.len()],
            errors: vec![0.0; azimuths.len()],
            files: Vec::new(),
        }
    }

    #[test]
    fn the_plane_of_the_sun_is_the_principal_plane_and_has_the_hot_spot() {
        let planes =
            planes(&views(&[0.0, 40.0, 220.0, 130.0]), Some([35.0, 40.0])).expect("planes");
        let names: Vec<&str> = planes.iter().map(|plane| plane.name.as_str()).collect();
        assert_eq!(names, ["principal plane", "cross plane"]);
        assert_eq!([planes[0].hot_spot, planes[1].hot_spot], [Some(35.0), None]);
        // The nadir is in both.
        assert_eq!([planes[0].places.len(), planes[1].places.len()], [3, 2]);
    }

    #[test]
    fn views_all_over_the_hemisphere_are_no_planes() {
        assert_eq!(planes(&views(&[0.0, 30.0, 60.0, 90.0, 120.0, 150.0]), None), None);
    }
}
