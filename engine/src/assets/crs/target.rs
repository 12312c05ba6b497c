//! Systems in metres that files in other units can be converted to.

use glam::DVec2;

use super::Axes;

/// Radius of the sphere of Web Mercator, m.
const MERCATOR_RADIUS: f64 = 6_378_137.0;

/// System in metres to convert a file to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TargetSystem {
    /// Number in the registry of EPSG.
    pub code: u32,
    /// Its name, or what asks for it.
    pub reason: String,
}

impl TargetSystem {
    /// Zone of UTM that a longitude and a latitude lie in, degrees.
    pub(crate) fn of_degrees(place: DVec2) -> Self {
        // Six degrees a zone, from the date line eastwards.
        let zone = ((place.x + 180.0) / 6.0).floor().clamp(0.0, 59.0) as u32 + 1;
        let (first, half) = if place.y < 0.0 { (32_700, "south") } else { (32_600, "north") };
        Self { code: first + zone, reason: format!("UTM zone {zone} {half}") }
    }

    /// Zone of UTM of a place in degrees or on a map of the world; an example where the longitude is not known.
    pub(crate) fn of_map(axes: &Axes, place: DVec2) -> Self {
        if *axes == Axes::Degrees {
            return Self::of_degrees(place);
        }
        if *axes == Axes::World {
            let longitude = (place.x / MERCATOR_RADIUS).to_degrees();
            return Self::of_degrees(DVec2::new(longitude, place.y));
        }
        Self { code: 32_633, reason: "UTM zone 33 north, for example".to_owned() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_zone_follows_from_the_longitude() {
        let code = |x, y| TargetSystem::of_degrees(DVec2::new(x, y)).code;
        assert_eq!(code(8.08, 48.86), 32_632);
        assert_eq!(code(-60.0, -3.0), 32_721);
        assert_eq!([code(-180.0, 1.0), code(180.0, 1.0)], [32_601, 32_660]);
        let mercator = TargetSystem::of_map(&Axes::World, DVec2::new(899_461.0, 6_250_000.0));
        assert_eq!(mercator.code, 32_632);
    }
}
