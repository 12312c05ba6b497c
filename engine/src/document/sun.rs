use solar_positioning::time::JulianDate;
use solar_positioning::{
    Horizon, Location, RefractionCorrection, SolarEvents, SolarPositions, delta_t,
};

use super::read::Reading;
use super::scene::{Scene, Sky, Spa, Sun, SunPosition};
use super::{Diagnostic, ScenePath};

/// Path to the place and time that a position is computed from.
fn position_path() -> ScenePath {
    ScenePath::from(["sun", "position"])
}

/// Zenith angle of the horizon, degrees.
const HORIZON_DEG: f64 = 90.0;

impl Sun {
    /// Zenith angle and azimuth clockwise from north, degrees; `None` where the scene does not say,
    /// or where its disc is not wholly above the horizon.
    #[must_use]
    pub fn angles_deg(&self) -> Option<(f64, f64)> {
        match &self.position {
            None => self.zenith_deg.map(|zenith| (zenith, self.azimuth_deg)),
            Some(_) => self.placed().ok().filter(|(zenith, _)| *zenith < self.lowest_deg()),
        }
    }

    /// Azimuth clockwise from north, degrees, above and below the horizon; `None` where the scene does
    /// not say.
    #[must_use]
    pub fn known_azimuth_deg(&self) -> Option<f64> {
        match &self.position {
            None => self.zenith_deg.map(|_| self.azimuth_deg),
            Some(_) => self.placed().ok().map(|(_, azimuth)| azimuth),
        }
    }

    /// Angle of its middle below the horizon, degrees; `None` where its disc is wholly above it, or where
    /// no place and time are known.
    #[must_use]
    pub fn depth_deg(&self) -> Option<f64> {
        let (zenith, _) = self.position.is_some().then(|| self.placed().ok())??;
        (zenith >= self.lowest_deg()).then_some(zenith - HORIZON_DEG)
    }

    /// Zenith angle at which its disc touches the horizon, degrees.
    fn lowest_deg(&self) -> f64 {
        HORIZON_DEG - 0.5 * self.disc_deg
    }

    /// Time of day of its position, hours of its clock.
    #[must_use]
    pub fn hour(&self) -> Option<f64> {
        let SunPosition::Spa(Spa { time: (hour, minute, second), .. }) = self.position.as_ref()?;
        Some(hour + minute / 60.0 + second / 3600.0)
    }

    /// Returns the sun at another time of its day, hours of its clock.
    #[must_use]
    pub fn at_hour(&self, new_hour: f64) -> Self {
        let mut sun = self.clone();
        if let Some(SunPosition::Spa(Spa { time, .. })) = &mut sun.position {
            // A clock may show 24 hours and some minutes.
            *time = (new_hour.min(24.0), 60.0 * (new_hour - 24.0).max(0.0), 0.0);
        }
        sun
    }

    /// Time of day between `low` and `high` at which it crosses the horizon, by bisection; it is above the
    /// horizon at one of the two.
    #[must_use]
    pub fn hour_of_horizon(&self, low: f64, high: f64) -> f64 {
        let is_up = |hour: f64| self.at_hour(hour).depth_deg().is_none();
        let is_up_first = is_up(low);
        let (mut low, mut high) = (low, high);
        // 2⁻⁴⁰ of a day is less than a microsecond.
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            if is_up(middle) == is_up_first {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    }

    /// Zenith angle and azimuth from place and time, degrees, also below the horizon.
    pub(super) fn placed(&self) -> Result<(f64, f64), Box<Diagnostic>> {
        let Some(SunPosition::Spa(position)) = &self.position else {
            return Err(Box::new(Diagnostic::error(position_path(), "there is no position")));
        };
        spa(position)
    }
}

impl Scene {
    /// Returns whether there is light to measure without the sun: a sky with an irradiance of its own, or
    /// emission in the bands.
    #[must_use]
    pub fn has_light_at_night(&self) -> bool {
        matches!(self.sky, Sky::Isotropic { .. }) || self.measures_emission()
    }

    /// A diagnostic if the sun is below the horizon: a warning where other light is left, an error where
    /// none is.
    pub(super) fn night(&self) -> Option<Diagnostic> {
        let below = self.sun.as_ref().and_then(Sun::depth_deg)?;
        let message = if below < 0.0 {
            "the horizon cuts the disc of the sun then".to_owned()
        } else {
            format!("the sun is {below:.2}° below the horizon then")
        };
        Some(if self.has_light_at_night() {
            let message = format!("{message}: the scene is traced without it");
            Diagnostic::warning(position_path(), message).help(
                "sky and emission are what is left; where neither lights a band, reflectance factors, albedo \
                 and absorbed fractions have no value",
            )
        } else {
            let help = "write a time of day, or leave the sun out and write a sky";
            Diagnostic::error(position_path(), message).help(help)
        })
    }
}

impl Reading {
    /// Returns why a scene without any other error cannot be traced at night: the sun is below the horizon
    /// and nothing else gives light.
    #[must_use]
    pub fn darkness(&self) -> Option<String> {
        let mut errors = self.diagnostics.iter().filter(|one| one.is_error());
        let (first, None) = (errors.next()?, errors.next()) else { return None };
        let night = self.scene.night().filter(Diagnostic::is_error)?;
        (first.path == position_path() && first.message == night.message).then_some(night.message)
    }

    /// Returns what a scene that is traced without its sun warns of.
    #[must_use]
    pub fn night_warning(&self) -> Option<String> {
        self.scene.night().filter(|night| !night.is_error()).map(|night| night.message)
    }
}

/// Times of a day at which the sun rises, culminates and sets, hours of the clock of its place and time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SunDay {
    /// Time at which its upper edge rises above the horizon, with a refraction of 34'; `None` if it does not.
    pub sunrise_h: Option<f64>,
    /// Time at which it crosses the meridian above the pole.
    pub noon_h: Option<f64>,
    /// Time at which its upper edge sets.
    pub sunset_h: Option<f64>,
}

impl Spa {
    /// Topocentric zenith angle, refraction included, and azimuth clockwise from north, degrees.
    ///
    /// # Errors
    /// If a number is out of its range, or the date does not exist.
    pub fn angles_deg(&self) -> Result<(f64, f64), Box<Diagnostic>> {
        spa(self)
    }

    /// Sunrise, noon and sunset of its date.
    ///
    /// # Errors
    /// If a number is out of its range, or the date does not exist.
    pub fn day(&self) -> Result<SunDay, Box<Diagnostic>> {
        let Moment { midnight, delta_t, location, .. } = Moment::new(self)?;
        let wrong = |error: solar_positioning::Error| {
            Box::new(Diagnostic::error(position_path(), error.to_string()))
        };
        let start = midnight - self.utc_offset_h / 24.0;
        let (end, events) = (start + 1.0, SolarEvents::new());
        let horizon = Horizon::SunriseSunset;
        let hour = |date: Option<f64>| date.map(|date| (date - start) * 24.0);
        let rise = events.next_rise_from_julian(start, end, location, delta_t, horizon);
        let set = events.next_set_from_julian(start, end, location, delta_t, horizon);
        let noon = events.next_transit_from_julian(start, end, location.longitude, delta_t);
        Ok(SunDay {
            sunrise_h: hour(rise.map_err(wrong)?),
            noon_h: hour(noon.map_err(wrong)?),
            sunset_h: hour(set.map_err(wrong)?),
        })
    }
}

/// Topocentric zenith angle, refraction included, and azimuth clockwise from north, degrees.
///
/// Source: Reda and Andreas (2004), Solar Energy 76, 577-589.
fn spa(position: &Spa) -> Result<(f64, f64), Box<Diagnostic>> {
    let Moment { midnight, hours, delta_t, location, refraction } = Moment::new(position)?;
    let wrong = |error: solar_positioning::Error| {
        Box::new(Diagnostic::error(position_path(), error.to_string()))
    };
    let time = JulianDate::new(midnight + hours / 24.0, delta_t).map_err(wrong)?;
    let sun = SolarPositions::new()
        .at_from_julian(time, location, position.altitude_m, refraction)
        .map_err(wrong)?;
    Ok((sun.zenith_angle(), sun.azimuth()))
}

/// A place and a time as the algorithm takes them.
struct Moment {
    /// Julian date of the midnight at which the date begins in Greenwich.
    midnight: f64,
    /// Hours of universal time since that.
    hours: f64,
    /// Terrestrial time less universal time, s.
    delta_t: f64,
    location: Location,
    refraction: Option<RefractionCorrection>,
}

impl Moment {
    fn new(position: &Spa) -> Result<Self, Box<Diagnostic>> {
        let &Spa {
            date: (year, month, day),
            time: (hour, minute, second),
            utc_offset_h,
            latitude_deg,
            longitude_deg,
            altitude_m,
            pressure_hpa,
            temperature_c,
            delta_t_s,
        } = position;
        let at = position_path();
        let within = |path: ScenePath, value: f64, (low, high): (f64, f64)| {
            if (low..=high).contains(&value) {
                return Ok(());
            }
            let message = format!("expected a number from {low} to {high}, found {value}");
            Err(Box::new(Diagnostic::error(path, message)))
        };
        within(at.key("date").index(0), f64::from(year), (0.0, 6000.0))?;
        within(at.key("date").index(1), f64::from(month), (1.0, 12.0))?;
        within(at.key("date").index(2), f64::from(day), (1.0, 31.0))?;
        within(at.key("time").index(0), hour, (0.0, 24.0))?;
        within(at.key("time").index(1), minute, (0.0, 60.0))?;
        within(at.key("time").index(2), second, (0.0, 60.0))?;
        within(at.key("utc_offset_h"), utc_offset_h, (-18.0, 18.0))?;
        within(at.key("latitude_deg"), latitude_deg, (-90.0, 90.0))?;
        within(at.key("longitude_deg"), longitude_deg, (-180.0, 180.0))?;
        within(at.key("altitude_m"), altitude_m, (-500.0, 100_000.0))?;
        within(at.key("pressure_hpa"), pressure_hpa, (0.0, 1200.0))?;
        within(at.key("temperature_c"), temperature_c, (-150.0, 100.0))?;
        within(at.key("delta_t_s"), delta_t_s.unwrap_or(0.0), (-8000.0, 8000.0))?;
        let no = |path: ScenePath| {
            move |error: solar_positioning::Error| {
                Box::new(Diagnostic::error(path, error.to_string()))
            }
        };
        let delta_t = delta_t_s
            .map_or_else(|| delta_t::estimate_from_date(year as i32, month), Ok)
            .map_err(no(at.key("date")))?;
        let midnight = JulianDate::from_utc(year as i32, month, day, 0, 0, 0.0, delta_t)
            .map_err(no(at.key("date")))?
            .julian_date();
        let hours = hour + minute / 60.0 + second / 3600.0 - utc_offset_h;
        let refraction = (pressure_hpa > 0.0)
            .then(|| RefractionCorrection::new(pressure_hpa, temperature_c))
            .transpose()
            .map_err(no(at.key("pressure_hpa")))?;
        let location = Location { latitude: latitude_deg, longitude: longitude_deg };
        Ok(Self { midnight, hours, delta_t, location, refraction })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
mod tests {
    use super::*;

    fn denver() -> Spa {
        Spa {
            date: (2003, 10, 17),
            time: (12.0, 30.0, 30.0),
            utc_offset_h: -7.0,
            latitude_deg: 39.742_476,
            longitude_deg: -105.1786,
            altitude_m: 1830.14,
            pressure_hpa: 820.0,
            temperature_c: 11.0,
            delta_t_s: Some(67.0),
        }
    }

    /// The worked example of the report, appendix A.5: zenith 50.11162°, azimuth 194.34024°.
    #[test]
    fn the_sun_is_where_the_worked_example_of_the_report_has_it() {
        let (zenith, azimuth) = spa(&denver()).unwrap();
        assert!((zenith - 50.11162).abs() < 1e-5, "{zenith}");
        assert!((azimuth - 194.34024).abs() < 1e-5, "{azimuth}");
    }

    /// A day has 24 hours, an hour 60 minutes, and clocks ahead of UTC show more.
    #[test]
    fn a_moment_may_be_written_in_many_ways() {
        let same = spa(&denver()).unwrap();
        for (new_date, new_time, new_offset) in [
            ((2003, 10, 17), (19.0, 30.0, 30.0), 0.0),
            ((2003, 10, 17), (12.5 + 30.0 / 3600.0, 0.0, 0.0), -7.0),
            ((2003, 10, 18), (1.0, 0.0, 30.0), 5.5),
        ] {
            let mut other = denver();
            (other.date, other.time, other.utc_offset_h) = (new_date, new_time, new_offset);
            let (zenith, azimuth) = spa(&other).unwrap();
            assert!((zenith - same.0).abs() < 1e-6 && (azimuth - same.1).abs() < 1e-6);
        }
    }

    #[test]
    fn an_estimated_delta_t_moves_the_sun_by_less_than_the_algorithm_errs() {
        let mut estimated = denver();
        estimated.delta_t_s = None;
        let (given, estimated) = (spa(&denver()).unwrap(), spa(&estimated).unwrap());
        assert!((given.0 - estimated.0).abs() < 3e-4 && (given.1 - estimated.1).abs() < 3e-4);
    }

    /// *Expected*: in the same example the report's program prints sunrise 6:12:43 and sunset 17:20:19. It looks for events within the
    /// day in Greenwich, so that its sunset is that of the day before on the clock of Denver.
    #[test]
    fn the_sun_rises_and_sets_when_the_worked_example_of_the_report_says() {
        let day = denver().day().unwrap();
        let before = Spa { date: (2003, 10, 16), ..denver() }.day().unwrap();
        let seconds =
            |hours: f64, minutes: f64, seconds: f64| 3600.0 * hours + 60.0 * minutes + seconds;
        for (found, expected) in [
            (day.sunrise_h, seconds(6.0, 12.0, 43.0)),
            (day.noon_h, seconds(11.0, 46.0, 5.0)),
            (before.sunset_h, seconds(17.0, 20.0, 19.0)),
        ] {
            let found = 3600.0 * found.unwrap();
            assert!((found - expected).abs() < 2.0, "{found} s for {expected} s");
        }
        // In autumn the sun sets earlier from day to day.
        let later = 3600.0 * (before.sunset_h.unwrap() - day.sunset_h.unwrap());
        assert!((80.0..100.0).contains(&later), "{later}");
        let polar = |month: u32| Spa { latitude_deg: 80.0, date: (2003, month, 21), ..denver() };
        for month in [6, 12] {
            let day = polar(month).day().unwrap();
            assert!(day.sunrise_h.is_none() && day.sunset_h.is_none() && day.noon_h.is_some());
        }
    }

    #[test]
    fn a_day_that_no_month_has_is_an_error_at_its_place() {
        let mut wrong = denver();
        wrong.date = (2003, 2, 30);
        assert_eq!(spa(&wrong).unwrap_err().path, position_path().key("date"));
    }
}
