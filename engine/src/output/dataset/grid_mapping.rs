//! Coordinate reference system of maps as a grid mapping of the CF conventions.
//!
//! Source: CF conventions 1.10, appendix F.

use super::Attributes;
use crate::components::Projection;
use crate::products::Report;

/// A projection in well-known text and its name in the conventions.
const PROJECTIONS: [(&str, &str); 9] = [
    ("transverse_mercator", "transverse_mercator"),
    ("lambert_azimuthal_equal_area", "lambert_azimuthal_equal_area"),
    ("lambert_conformal_conic_2sp", "lambert_conformal_conic"),
    ("lambert_conformal_conic_1sp", "lambert_conformal_conic"),
    ("lambert_conformal_conic", "lambert_conformal_conic"),
    ("albers_conic_equal_area", "albers_conical_equal_area"),
    ("albers", "albers_conical_equal_area"),
    ("mercator_1sp", "mercator"),
    ("polar_stereographic", "polar_stereographic"),
];

/// Parameters whose names do not depend on the projection.
const PARAMETERS: [(&str, &str); 4] = [
    ("false_easting", "false_easting"),
    ("false_northing", "false_northing"),
    ("latitude_of_origin", "latitude_of_projection_origin"),
    ("latitude_of_center", "latitude_of_projection_origin"),
];

/// Attributes of a grid mapping; `None` if the scene names no system, or one that neither it nor the registry of EPSG
/// defines.
pub(super) fn grid_mapping(report: &Report) -> Option<Attributes> {
    let projection = report.projection.as_ref()?;
    let wkt = well_known_text(projection)?;
    let mut attributes = Attributes::default();
    let system = Wkt(&wkt);
    if let Some((projection, name)) = system.projection() {
        attributes.text("grid_mapping_name", name);
        system.parameters(projection, name, &mut attributes);
        if let [Some(axis), Some(flattening)] = [1, 2].map(|item| system.number("SPHEROID", item)) {
            attributes.number("semi_major_axis", axis);
            attributes.number("inverse_flattening", flattening);
        }
        attributes.number("longitude_of_prime_meridian", system.number("PRIMEM", 1).unwrap_or(0.0));
    }
    attributes.text("crs_wkt", wkt.as_str());
    // GDAL and its users know this name.
    attributes.text("spatial_ref", wkt);
    if let Some(epsg) = projection.epsg {
        attributes.text("epsg_code", format!("EPSG:{epsg}"));
    }
    Some(attributes)
}

/// Definition of a system: that of the registry, or that of the scene's raster.
fn well_known_text(projection: &Projection) -> Option<String> {
    let registered = projection
        .epsg
        .and_then(|code| u16::try_from(code).ok())
        .and_then(crs_definitions::from_code)
        .map(|definition| definition.wkt.to_owned());
    let text = registered.or_else(|| projection.wkt.clone())?;
    Some(text.split_whitespace().collect::<Vec<_>>().join(" "))
}

/// Well-known text, version 1.
struct Wkt<'a>(&'a str);

impl Wkt<'_> {
    /// Items of the first element of this name, without what is nested in it.
    fn items(&self, name: &str) -> Option<Vec<&str>> {
        let start = self.0.find(&format!("{name}["))? + name.len() + 1;
        let rest = &self.0[start..];
        let end = rest.find([']', '[']).unwrap_or(rest.len());
        Some(rest[..end].split(',').map(|item| item.trim().trim_matches('"')).collect())
    }

    fn number(&self, name: &str, item: usize) -> Option<f64> {
        self.items(name)?.get(item)?.parse().ok()
    }

    /// Its projection, and the name of that in the conventions.
    fn projection(&self) -> Option<(&str, &'static str)> {
        let name = *self.items("PROJECTION")?.first()?;
        let known = PROJECTIONS.iter().find(|(known, _)| name.eq_ignore_ascii_case(known))?;
        Some((name, known.1))
    }

    /// Adds the parameters of its projection.
    fn parameters(&self, projection: &str, name: &str, attributes: &mut Attributes) {
        let found = self.0.split("PARAMETER[").skip(1).filter_map(|text| {
            let (name, rest) = text.strip_prefix('"')?.split_once('"')?;
            let value = rest.trim_start_matches(',').split(']').next()?.trim().parse().ok()?;
            Some((name.to_lowercase(), value))
        });
        let found: Vec<(String, f64)> = found.collect();
        let is_secant = !projection.to_lowercase().ends_with("_1sp");
        let parallels: Vec<f64> = found
            .iter()
            .filter(|(name, _)| name.starts_with("standard_parallel") && is_secant)
            .map(|(_, value)| *value)
            .collect();
        for (parameter, value) in &found {
            let known = PARAMETERS.iter().find(|(known, _)| known == parameter);
            let attribute = match (parameter.as_str(), name) {
                ("latitude_of_origin", "polar_stereographic") => {
                    attributes.number("latitude_of_projection_origin", 90_f64.copysign(*value));
                    "standard_parallel"
                }
                ("central_meridian", "polar_stereographic") => {
                    "straight_vertical_longitude_from_pole"
                }
                ("central_meridian" | "longitude_of_center", "transverse_mercator")
                | ("central_meridian", "lambert_conformal_conic" | "albers_conical_equal_area") => {
                    "longitude_of_central_meridian"
                }
                ("central_meridian" | "longitude_of_center", _) => "longitude_of_projection_origin",
                ("scale_factor", "transverse_mercator") => "scale_factor_at_central_meridian",
                ("scale_factor", "mercator") => "scale_factor_at_projection_origin",
                _ => match known {
                    Some((_, attribute)) => attribute,
                    None => continue,
                },
            };
            attributes.number(attribute, *value);
        }
        // A cone that touches the earth does so at the latitude of origin.
        let tangent = found.iter().find(|(parameter, _)| parameter == "latitude_of_origin");
        match (parallels.is_empty(), name, tangent) {
            (true, "lambert_conformal_conic", Some((_, latitude))) => {
                attributes.number("standard_parallel", *latitude);
            }
            (false, ..) => attributes.numbers("standard_parallel", parallels),
            _ => {}
        }
    }
}
