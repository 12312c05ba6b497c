//! `sunpos`: positions of the sun at a time, over a day or over a year.

use std::fmt::Write as _;
use std::path::PathBuf;

use anyhow::{anyhow, bail};
use clap::Args;
use sunfleck::document::{self, ReadOptions, Spa, SunDay, SunPosition};
use sunfleck::output;

use super::print;

#[derive(Args, Debug)]
#[command(after_help = "Examples:\n  \
        sunfleck sunpos --latitude 52.5 --longitude 13.4 --time 2026-06-21T12:00 --utc-offset 2\n  \
        sunfleck sunpos --latitude 52.5 --longitude 13.4 --day 2026-06-21 --step 30 --out day.csv\n  \
        sunfleck sunpos --latitude 52.5 --longitude 13.4 --year 2026       sunrise, noon and sunset of each day\n  \
        sunfleck sunpos scene.ron                                          the sun of a scene with `position: Spa(..)`")]
pub(crate) struct Sunpos {
    /// Scene file whose place and time are taken; other arguments replace parts of them
    #[arg(value_name = "SCENE")]
    scene: Option<PathBuf>,

    /// Latitude, degrees; north is positive
    #[arg(
        long,
        value_name = "DEG",
        allow_negative_numbers = true,
        required_unless_present = "scene"
    )]
    latitude: Option<f64>,

    /// Longitude, degrees; east is positive
    #[arg(
        long,
        value_name = "DEG",
        allow_negative_numbers = true,
        required_unless_present = "scene"
    )]
    longitude: Option<f64>,

    /// Date and time of the clock, such as 2026-06-21T12:30
    #[arg(long, value_name = "DATE-TIME", value_parser = date_time, group = "moment")]
    time: Option<DateTime>,

    /// Positions over a day as CSV, such as 2026-06-21
    #[arg(long, value_name = "DATE", value_parser = date, group = "moment")]
    day: Option<Date>,

    /// Sunrise, noon and sunset of each day of a year as CSV; with --step, positions
    #[arg(long, value_name = "YEAR", value_parser = clap::value_parser!(u32).range(..=6000), group = "moment")]
    year: Option<u32>,

    /// Minutes between two positions [default: 60 over a day]
    #[arg(long, value_name = "MINUTES", value_parser = minutes)]
    step: Option<f64>,

    /// Hours that the clock is ahead of UTC [default: 0]
    #[arg(long, value_name = "HOURS", allow_negative_numbers = true)]
    utc_offset: Option<f64>,

    /// Elevation above sea level, m [default: 0]
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    elevation_m: Option<f64>,

    /// Air pressure of the refraction, hPa; 0 leaves it out [default: 1013.25]
    #[arg(long, value_name = "HPA")]
    pressure_hpa: Option<f64>,

    /// Air temperature of the refraction, °C [default: 15]
    #[arg(long, value_name = "C", allow_negative_numbers = true)]
    temperature_c: Option<f64>,

    /// Terrestrial time less universal time, s [default: estimated from the date]
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    delta_t_s: Option<f64>,

    /// File for the text or CSV [default: print it]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// Year, month and day.
type Date = (u32, u32, u32);

/// Date and time of a clock.
#[derive(Clone, Copy, Debug, PartialEq)]
struct DateTime {
    date: Date,
    /// Hour, minute and second.
    time: (f64, f64, f64),
}

/// Hours of a day.
const DAY_H: f64 = 24.0;

pub(super) fn sunpos(arguments: &Sunpos) -> anyhow::Result<()> {
    let place = arguments.place()?;
    let step = arguments.step.map(|minutes| minutes / 60.0);
    let text = match (arguments.day, arguments.year) {
        (Some(date), _) => table(&place, &[date], step.unwrap_or(1.0)),
        (_, Some(year)) => match step {
            Some(step) => table(&place, &days(year), step),
            None => table_of_days(&place, &days(year)),
        },
        (None, None) => text(&place),
    };
    let text = text.map_err(|problem| described(&problem))?;
    match &arguments.out {
        Some(file) => Ok(output::replace(file, &text)?),
        None => print(&text),
    }
}

/// An error in the words of the command line.
fn described(problem: &document::Diagnostic) -> anyhow::Error {
    let path = problem.path.to_string();
    let key = path.rsplit_once("position.").map_or("", |(_, key)| key);
    let name = match key.split('[').next().unwrap_or(key) {
        "" => return anyhow!("{}", problem.message),
        "latitude_deg" => "--latitude",
        "longitude_deg" => "--longitude",
        "altitude_m" => "--elevation-m",
        "utc_offset_h" => "--utc-offset",
        "pressure_hpa" => "--pressure-hpa",
        "temperature_c" => "--temperature-c",
        "delta_t_s" => "--delta-t-s",
        other => other,
    };
    anyhow!("{name}: {}", problem.message)
}

impl Sunpos {
    /// Place and time that the arguments name.
    fn place(&self) -> anyhow::Result<Spa> {
        let mut place = match &self.scene {
            Some(file) => place_of_scene(file)?,
            None => Spa::new((2000, 1, 1), (12.0, 0.0, 0.0), 0.0, 0.0),
        };
        let named = self.time.is_some() || self.day.is_some() || self.year.is_some();
        if self.scene.is_none() && !named {
            bail!("name a time: --time 2026-06-21T12:30, --day 2026-06-21 or --year 2026");
        }
        if self.step.is_some() && self.day.is_none() && self.year.is_none() {
            bail!("--step goes with --day or --year");
        }
        let set = |to: &mut f64, value: Option<f64>| *to = value.unwrap_or(*to);
        set(&mut place.latitude_deg, self.latitude);
        set(&mut place.longitude_deg, self.longitude);
        set(&mut place.utc_offset_h, self.utc_offset);
        set(&mut place.altitude_m, self.elevation_m);
        set(&mut place.pressure_hpa, self.pressure_hpa);
        set(&mut place.temperature_c, self.temperature_c);
        place.delta_t_s = self.delta_t_s.or(place.delta_t_s);
        if let Some(DateTime { date, time }) = self.time {
            (place.date, place.time) = (date, time);
        }
        Ok(place)
    }
}

/// Place and time of the sun of a scene.
fn place_of_scene(file: &std::path::Path) -> anyhow::Result<Spa> {
    let reading = document::read_file(file, &ReadOptions::default())?;
    // At night a scene may be wrong, and its sun has a position all the same.
    if !reading.is_sound() && reading.darkness().is_none() {
        bail!(reading.render());
    }
    match reading.scene.sun.as_ref().map(|sun| &sun.position) {
        Some(Some(SunPosition::Spa(place))) => Ok(place.clone()),
        Some(None) => bail!(
            "{}: the sun has angles and no place: write `sun: (position: Spa(..))`, or --latitude and --longitude without a scene",
            file.display()
        ),
        None => bail!("{}: the scene has no sun", file.display()),
    }
}

type Position = Result<String, Box<document::Diagnostic>>;

/// Position at one time, and the times of its day, for a person.
fn text(place: &Spa) -> Position {
    let (zenith, azimuth) = place.angles_deg()?;
    let day = place.day()?;
    let (hour, minute, second) = place.time;
    let hours = hour + minute / 60.0 + second / 3600.0;
    Ok(format!(
        "{}, {} {}\nzenith {zenith:.5}°, azimuth {azimuth:.5}°, elevation {:.5}°\nsunrise {}, noon {}, sunset {}\n",
        place_text(place),
        date_text(place.date),
        clock(Some(hours)),
        90.0 - zenith,
        clock(day.sunrise_h),
        clock(day.noon_h),
        clock(day.sunset_h)
    ))
}

/// `39.742476° N, 105.1786° W, 1830.14 m, UTC-7`.
fn place_text(place: &Spa) -> String {
    let side = |value: f64, names: [&str; 2]| {
        format!("{}° {}", value.abs(), names[usize::from(value < 0.0)])
    };
    format!(
        "{}, {}, {} m, UTC{:+}",
        side(place.latitude_deg, ["N", "S"]),
        side(place.longitude_deg, ["E", "W"]),
        place.altitude_m,
        place.utc_offset_h
    )
}

/// Positions at equal steps from midnight on, as CSV.
fn table(place: &Spa, dates: &[Date], step_h: f64) -> Position {
    let mut text = head(place);
    text.push_str("date,time,zenith_deg,azimuth_deg,elevation_deg\n");
    for &date in dates {
        let mut place = Spa { date, ..place.clone() };
        // The first step of the next day is its own.
        let steps = (0_u32..).map(|number| f64::from(number) * step_h);
        for hours in steps.take_while(|hours| *hours < DAY_H - 1e-9) {
            place.time = (hours, 0.0, 0.0);
            let (zenith, azimuth) = place.angles_deg()?;
            let time = clock(Some(hours));
            let elevation = 90.0 - zenith;
            let date = date_text(date);
            line(&mut text, format_args!("{date},{time},{zenith:.6},{azimuth:.6},{elevation:.6}"));
        }
    }
    Ok(text)
}

/// Sunrise, noon and sunset of days, as CSV; cells are empty on days without them.
fn table_of_days(place: &Spa, dates: &[Date]) -> Position {
    let mut text = head(place);
    text.push_str("date,sunrise,noon,sunset,day_length_h,noon_zenith_deg,noon_azimuth_deg\n");
    for &date in dates {
        let mut place = Spa { date, ..place.clone() };
        let SunDay { sunrise_h, noon_h, sunset_h } = place.day()?;
        let length = sunrise_h.zip(sunset_h).map(|(rise, set)| (set - rise).rem_euclid(DAY_H));
        let length = length.map_or_else(String::new, |length| format!("{length:.4}"));
        let at_noon = match noon_h {
            Some(noon) => {
                place.time = (noon, 0.0, 0.0);
                let (zenith, azimuth) = place.angles_deg()?;
                format!("{zenith:.6},{azimuth:.6}")
            }
            None => ",".to_owned(),
        };
        let cell = |hours: Option<f64>| hours.map_or_else(String::new, |hours| clock(Some(hours)));
        let [sunrise, noon, sunset] = [sunrise_h, noon_h, sunset_h].map(cell);
        let date = date_text(date);
        line(&mut text, format_args!("{date},{sunrise},{noon},{sunset},{length},{at_noon}"));
    }
    Ok(text)
}

fn head(place: &Spa) -> String {
    format!(
        "# sun at {}\n# SPA (Reda and Andreas 2004), refraction of {} hPa and {} °C\n",
        place_text(place).replace(", ", "; "),
        place.pressure_hpa,
        place.temperature_c
    )
}

fn line(text: &mut String, cells: std::fmt::Arguments<'_>) {
    writeln!(text, "{cells}").expect("a text takes all that is written");
}

/// `06:12:43`, or `none`.
fn clock(hours: Option<f64>) -> String {
    let Some(hours) = hours else { return "none".to_owned() };
    let seconds = (hours * 3600.0).round() as u64;
    format!("{:02}:{:02}:{:02}", seconds / 3600, seconds / 60 % 60, seconds % 60)
}

fn date_text((year, month, day): Date) -> String {
    format!("{year:04}-{month:02}-{day:02}")
}

/// All days of a year.
fn days(year: u32) -> Vec<Date> {
    let is_leap = year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400));
    let length = |month: u32| match month {
        2 => 28 + u32::from(is_leap),
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    };
    (1..=12).flat_map(|month| (1..=length(month)).map(move |day| (year, month, day))).collect()
}

fn date(text: &str) -> Result<Date, String> {
    let parts: Option<Vec<u32>> = text.split('-').map(|part| part.parse().ok()).collect();
    match parts.as_deref() {
        Some(&[year, month @ 1..=12, day]) if days(year).contains(&(year, month, day)) => {
            Ok((year, month, day))
        }
        Some([_, _, _]) => Err("there is no such day".to_owned()),
        _ => Err("write year, month and day, such as 2026-06-21".to_owned()),
    }
}

fn date_time(text: &str) -> Result<DateTime, String> {
    let wrong =
        || "write date and time, such as 2026-06-21T12:30 or 2026-06-21T12:30:15".to_owned();
    let (date_part, time) = text.split_once(['T', ' ']).ok_or_else(wrong)?;
    let parts: Option<Vec<f64>> = time.split(':').map(|part| part.parse().ok()).collect();
    let time = match parts.as_deref() {
        Some(&[hour, minute]) => (hour, minute, 0.0),
        Some(&[hour, minute, second]) => (hour, minute, second),
        _ => return Err(wrong()),
    };
    let is_clock = (0.0..24.0).contains(&time.0)
        && (0.0..60.0).contains(&time.1)
        && (0.0..60.0).contains(&time.2);
    if !is_clock {
        return Err("a clock shows 0 to 23 hours, 0 to 59 minutes and seconds".to_owned());
    }
    Ok(DateTime { date: date(date_part)?, time })
}

fn minutes(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(minutes) if (0.01..=1440.0).contains(&minutes) => Ok(minutes),
        _ => Err("write a number of minutes from 0.01 to 1440, such as 15".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_and_times_are_read_as_clocks_show_them() {
        assert_eq!(date("2024-02-29"), Ok((2024, 2, 29)));
        assert_eq!(
            date_time("2003-10-17T12:30:30").map(|moment| moment.time),
            Ok((12.0, 30.0, 30.0))
        );
        assert_eq!(date_time("2003-10-17 12:30").map(|moment| moment.date), Ok((2003, 10, 17)));
        for wrong in ["2023-02-29", "2023-13-01", "2023-02", "21.6.2026"] {
            assert!(date(wrong).is_err(), "{wrong}");
        }
        for wrong in
            ["2023-02-01", "2023-02-01T25:00", "2023-02-01T12:60", "12:30", "2023-02-01T12"]
        {
            assert!(date_time(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_year_has_all_its_days() {
        assert_eq!([2023, 2024, 1900, 2000].map(|year| days(year).len()), [365, 366, 365, 366]);
    }

    #[test]
    fn clocks_round_to_seconds() {
        assert_eq!(clock(Some(6.211_9)), "06:12:43");
        assert_eq!(clock(Some(12.999_999)), "13:00:00");
        assert_eq!(clock(None), "none");
    }
}
