//! The sensor, the boundary, and the limits of light paths.

use std::fmt::Write as _;

use anyhow::Result;

use super::conf::Node;
use super::project::Project;
use super::report::Report;
use super::settings::{Choice, Rule};
use super::swept::Swept;

/// Depth of paths that LESS's window writes for paths of any length.
const INFINITE_DEPTH: f64 = 200.0;

/// Types of sensors.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Kind {
    Orthographic,
    Perspective,
    Fisheye,
    Photons,
}

impl Kind {
    const ALL: [Self; 4] = [Self::Orthographic, Self::Perspective, Self::Fisheye, Self::Photons];

    /// Name in LESS, which is also the key of its settings.
    pub(super) const fn key(self) -> &'static str {
        match self {
            Self::Orthographic => "orthographic",
            Self::Perspective => "perspective",
            Self::Fisheye => "CircularFisheye",
            Self::Photons => "PhotonTracing",
        }
    }

    /// The type of `sensor`. Where it is absent or unknown, it is the one whose settings are there.
    pub(super) fn read(sensor: &Node, report: &Report) -> Result<Self> {
        let likely = [Self::Perspective, Self::Fisheye, Self::Photons, Self::Orthographic];
        let likely = likely.into_iter().find(|kind| sensor.get(kind.key()).is_some());
        let likely = likely.unwrap_or(Self::Orthographic);
        let mut choices = vec![(likely.key(), likely)];
        choices.extend(Self::ALL.into_iter().filter(|kind| *kind != likely).map(|k| (k.key(), k)));
        let choice = Choice { choices: &choices, may_be_absent: false };
        choice.read(sensor, "sensor_type", report)
    }
}

impl Project {
    /// The scene's `boundary`, `sensors` and `transport`.
    pub(super) fn sensor_ron(&self, swept: &mut Swept<'_>) -> Result<String> {
        let mut text = self.boundary()?.to_owned();
        let (name, body) = match self.kind {
            Kind::Orthographic => ("image", self.orthographic(swept)?),
            Kind::Perspective => ("image", self.perspective(swept)?),
            Kind::Fisheye => ("image", self.fisheye(swept)?),
            Kind::Photons => ("photons", super::photons::photons(self, swept)?),
        };
        writeln!(text, "sensors: {{\n\"{name}\": {body},\n}},")?;
        text += &self.transport(swept)?;
        for (path, why) in UNNEEDED {
            for node in self.conf.at(path).map(Node::unread).unwrap_or_default() {
                self.report.unneeded(&node.path, &node.shown(), why);
                node.settle();
            }
        }
        Ok(text)
    }

    fn boundary(&self) -> Result<&'static str> {
        let sensor = self.conf.need("sensor")?;
        let Some(node) = sensor.get("RepetitiveScene") else {
            let what = "0: the scene stands alone";
            let lack = sensor.lack_of("RepetitiveScene");
            self.report.assumed(&sensor.path_of("RepetitiveScene"), lack, what);
            return Ok("boundary: Isolated,\n");
        };
        let copies = node.number()?;
        if copies > 0.0 {
            let what = "without end; LESS counts borders that a ray crosses";
            self.report.differs(&node.path, &node.shown(), what);
            return Ok("boundary: Periodic,\n");
        }
        if copies < 0.0 {
            self.report.differs(&node.path, &node.shown(), "taken as 0: the scene stands alone");
        }
        Ok("boundary: Isolated,\n")
    }

    fn transport(&self, swept: &mut Swept<'_>) -> Result<String> {
        let mut text = String::new();
        if let Some(node) = self.conf.at(&["sensor", "record_only_direct"]) {
            // Files written by hand hold the state of the window's box "Only First Order".
            let depth = match node.text()?.to_ascii_lowercase().as_str() {
                "true" => 2.0,
                "false" => -1.0,
                _ => node.number()?,
            };
            if depth.fract() != 0.0 || (0.0..2.0).contains(&depth) {
                return Err(node.wrong(&format!(
                    "{depth} is no depth of paths: 2 for the first order only, -1 for no limit"
                )));
            }
            if depth < 3.0 && depth > 0.0 {
                text += "first_order_only: true,\n";
            } else if depth > 0.0 && depth < INFINITE_DEPTH {
                writeln!(text, "max_order: {},", depth - 1.0)?;
            }
        }
        let advanced = self.conf.need("Advanced")?;
        if advanced.get("minimum_iteration").is_some() || swept.varies("minimum_iteration") {
            let rule = Rule::ROULETTE_ORDER;
            let order = swept.term(advanced, "minimum_iteration", &rule, &self.report)?;
            writeln!(text, "roulette: (after_order: {}),", order.whole())?;
        }
        Ok(if text.is_empty() { text } else { format!("transport: (\n{text}),\n") })
    }

    /// The virtual plane, cut to the terrain, and the middle that the project gives it.
    pub(super) fn virtual_plane(&self) -> Result<Option<(String, (f64, f64))>> {
        let Some(plane) = self.conf.at(&["sensor", "virtualPlane"]) else { return Ok(None) };
        if let Ok(text) = plane.text() {
            // A flag in its place: no plane, or that of the window's defaults.
            if !plane
                .flag()
                .map_err(|_error| plane.wrong(&format!("{text:?} is not {{ vx, vy, .. }}")))?
            {
                return Ok(None);
            }
        }
        let (width, depth) = self.size;
        let number = |key, default| Rule::coordinate(default).read(plane, key, &self.report);
        let center = (number("vx", 0.5 * width)?, depth - number("vy", 0.5 * depth)?);
        let length = |key, side: f64| -> Result<f64> {
            let length = Rule::coordinate(side).read(plane, key, &self.report)?;
            if length > 0.0 {
                return Ok(length);
            }
            Err(plane.need(key)?.wrong(&format!("{length} is not a length above 0 m")))
        };
        let size = (length("sizex", width)?, length("sizey", depth)?);
        if let Some(z) = plane.get("vz")
            && !z.text()?.eq_ignore_ascii_case("MAX")
        {
            let what = "the top of the scene, as in LESS; `height_m` sets another height";
            self.report.differs(&z.path, &z.shown(), what);
        }
        let along = [span(center.0, size.0, width), span(center.1, size.1, depth)];
        let [Some(x), Some(y)] = along else {
            return Err(
                plane.wrong("`vx`, `vy`, `sizex` and `sizey` put the plane beside the scene")
            );
        };
        if (x.length, y.length) != size {
            let what = format!(
                "cut to the scene: {:?} m x {:?} m around ({:?}, {:?})",
                x.length, y.length, x.center, y.center
            );
            self.report.differs(&plane.path, "", what);
        }
        let middle = (x.center, y.center);
        let text = format!("(center_m: {middle:?}, size_m: {:?})", (x.length, y.length));
        Ok(Some((text, center)))
    }

    /// Measures and picture of an image with pixels.
    pub(super) fn finish_image(
        &self,
        own: &Node,
        text: &mut String,
        swept: &mut Swept<'_>,
    ) -> Result<()> {
        let sensor = self.conf.need("sensor")?;
        let key = "sample_per_square_meter";
        let holder = if own.get(key).is_none() && sensor.get(key).is_some() { sensor } else { own };
        writeln!(text, "samples_per_px: {},", swept.samples(holder, key, &self.report)?.whole())?;
        if let Some(node) = holder.get(key) {
            let what = "per pixel, as in the program LESS, not its manual";
            self.report.differs(&node.path, &node.shown(), what);
        }
        let mut measures = if self.is_thermal {
            vec!["Radiance", "BrightnessTemperature"]
        } else if self.kind == Kind::Fisheye {
            vec!["Radiance"]
        } else {
            vec!["Radiance", "Brf"]
        };
        if sensor.flag_of("hasFourComponentProduct")? {
            measures.push("FourComponents");
            let what = "sunlit is where the sun is seen from the side that is seen";
            self.report.differs("sensor.hasFourComponentProduct", "true", what);
        }
        writeln!(text, "measure: [{}],", measures.join(", "))?;
        let film = Choice { choices: &[("spectrum", false), ("rgb", true)], may_be_absent: true };
        if film.read(sensor, "film_type", &self.report)? {
            let what = if self.visible_bands() >= 10 && !self.is_thermal {
                text.push_str("picture: Cie,\n");
                "coloured by the wavelengths of the bands; LESS takes them for equal parts"
            } else {
                "true colours need ten visible bands: a quick look of those there are"
            };
            self.report.differs("sensor.film_type", "rgb", what);
        }
        Ok(())
    }
}

/// Middle and length of an interval, m.
struct Span {
    center: f64,
    length: f64,
}

/// The part of an interval that lies between 0 and `end`.
fn span(center: f64, length: f64, end: f64) -> Option<Span> {
    let (low, high) = (center - 0.5 * length, center + 0.5 * length);
    if low >= 0.0 && high <= end {
        return Some(Span { center, length });
    }
    let (low, high) = (low.max(0.0), high.min(end));
    (low < high).then_some(Span { center: 0.5 * (low + high), length: high - low })
}

/// Settings that nothing reads, and why.
const UNNEEDED: [(&[&str], &str); 21] = [
    (&["sensor", "NoDataValue"], "pixels without data are NaN"),
    (&["sensor", "perspective", "fovAxis"], "both angles are kept, each its own"),
    (&["observation", "obs_R"], "a parallel projection has no distance"),
    (&["observation"], "not of this sensor"),
    (&["sensor", "orthographic"], "not of this sensor"),
    (&["sensor", "perspective"], "not of this sensor"),
    (&["sensor", "CircularFisheye"], "not of this sensor"),
    (&["sensor", "PhotonTracing"], "not of this sensor"),
    (&["sensor", "virtualPlane"], "not of this sensor"),
    (&["sensor", "film_type"], "not of this sensor"),
    (&["sensor", "image_width"], "not of this sensor"),
    (&["sensor", "image_height"], "not of this sensor"),
    (&["sensor", "hasFourComponentProduct"], "not of this sensor"),
    (&["sensor", "sample_per_square_meter"], "not of this sensor"),
    (&["Advanced", "network_sim"], "sunfleck runs on one machine"),
    (&["Advanced", "number_of_cores"], "all; `--threads` of `sunfleck run`"),
    (&["Advanced", "external_py_interpreter"], "there is none"),
    (&["Advanced", "virtual_plane"], "`sensor.virtualPlane` alone says whether there is one"),
    (&["scene", "forest", "CacheOBJFile"], "models are read once"),
    (&["scene", "extra_scene"], "not part of LESS's own scenes"),
    (&["scene", "terrain", "optical_scale"], "LESS does not use it"),
];
