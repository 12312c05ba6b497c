//! The sensor, where it is, and how light is traced.

use std::fmt::Write as _;

use anyhow::Result;

use super::Project;
use super::conf::Node;
use super::swept::Swept;
use super::term::Term;

/// Depth of paths that LESS takes for infinite.
const INFINITE_DEPTH: f64 = 200.0;

impl Project {
    /// The scene's `boundary`, `sensors` and `transport`.
    pub(super) fn sensor_ron(&self, swept: &mut Swept<'_>) -> Result<String> {
        let sensor = self.conf.need("sensor")?;
        let mut text = String::new();
        if let Some(node) = sensor.get("RepetitiveScene") {
            let copies = node.number()?;
            if copies > 0.0 {
                text += "boundary: Periodic,\n";
                let what = "without end; LESS counts borders that a ray crosses";
                self.report.add(&node.path, &node.shown(), what);
            }
        }
        let kind = sensor.need("sensor_type")?;
        let (name, body) = match kind.text()?.as_str() {
            "orthographic" => ("image", self.orthographic(swept)?),
            "perspective" => ("image", self.perspective(swept)?),
            "CircularFisheye" => ("image", self.fisheye(swept)?),
            "PhotonTracing" => ("photons", super::photons::photons(self, swept)?),
            other => {
                return Err(kind.wrong(&format!(
                    "{other:?} is none of orthographic, perspective, CircularFisheye and PhotonTracing"
                )));
            }
        };
        writeln!(text, "sensors: {{\n\"{name}\": {body},\n}},")?;
        text += &self.transport(swept)?;
        self.leave_out(&[
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
            (&["sensor", "hasFourComponentProduct"], "not of this sensor"),
            (&["sensor", "sample_per_square_meter"], "not of this sensor"),
            (&["Advanced", "network_sim"], "sunfleck runs on one machine"),
            (&["Advanced", "number_of_cores"], "all; `--threads` of `sunfleck run`"),
            (&["Advanced", "external_py_interpreter"], "there is none"),
            (&["scene", "forest", "CacheOBJFile"], "not needed"),
        ]);
        Ok(text)
    }

    /// Says of settings that nothing has read why.
    fn leave_out(&self, keys: &[(&[&str], &str)]) {
        for (path, why) in keys {
            for node in self.conf.at(path).map(Node::unread).unwrap_or_default() {
                self.report.add(&node.path, &node.shown(), *why);
                node.settle();
            }
        }
    }

    fn orthographic(&self, swept: &mut Swept<'_>) -> Result<String> {
        let sensor = self.conf.need("sensor")?;
        let own = sensor.need("orthographic")?;
        let view = self.conf.need("observation")?;
        let (zenith, azimuth) = (view.need("obs_zenith")?, view.need("obs_azimuth")?);
        let mut text = format!("Orthographic(\n{}", self.size_px(swept)?);
        let is_upright = zenith.number()? == 0.0 && azimuth.number()?.rem_euclid(90.0) == 0.0;
        let covers = own.get("cover_whole_scene").map_or(Ok(false), Node::flag)?;
        if covers && !is_upright {
            text += "cover: WholeScene,\n";
            if let Some(node) = own.get("cover_whole_scene") {
                let what = "the rectangle around all that stands on the ground";
                self.report.add(&node.path, "true", what);
            }
        } else {
            let extent = [own.need("sub_region_width")?, own.need("sub_region_height")?];
            let [width, height] = [swept.term(extent[0])?, swept.term(extent[1])?];
            writeln!(text, "extent_m: ({width}, {height}),")?;
        }
        let plane = self.virtual_plane()?;
        if let Some((plane, (x, y))) = plane {
            if !text.contains("WholeScene") {
                writeln!(text, "center_m: ({x:?}, {y:?}),")?;
                let what =
                    "in the middle of the image, which keeps its extent; LESS made it a square";
                self.report.add("sensor.virtualPlane", "", what);
            }
            writeln!(text, "virtual_plane: {plane},")?;
        }
        writeln!(text, "zenith_deg: {},", swept.term(zenith)?)?;
        writeln!(text, "azimuth_deg: {},", swept.term(azimuth)?)?;
        self.finish_image(own, &mut text, swept)?;
        Ok(text + ")")
    }

    fn perspective(&self, swept: &mut Swept<'_>) -> Result<String> {
        let own = self.conf.need("sensor")?.need("perspective")?;
        let (position, target, above) = self.pose(swept)?;
        let mut text = format!("Perspective(\n{}", self.size_px(swept)?);
        writeln!(text, "position_m: {},", triple(&position))?;
        writeln!(text, "target_m: {},", triple(&target))?;
        if position[..2] == target[..2] {
            text += "up: (0.0, 1.0, 0.0),\n";
        }
        let fov = [swept.term(own.need("fovx")?)?, swept.term(own.need("fovy")?)?];
        writeln!(text, "fov_deg: ({}, {}),", fov[0], fov[1])?;
        text += above;
        self.finish_image(own, &mut text, swept)?;
        Ok(text + ")")
    }

    fn fisheye(&self, swept: &mut Swept<'_>) -> Result<String> {
        let own = self.conf.need("sensor")?.need("CircularFisheye")?;
        let (position, target, above) = self.pose(swept)?;
        let mut text = format!("Fisheye(\n{}", self.size_px(swept)?);
        writeln!(text, "position_m: {},", triple(&position))?;
        let is_upright = position[..2] == target[..2];
        let look = match (&position[2], &target[2]) {
            (Term::Number(from), Term::Number(to)) if is_upright && to > from => "Up".to_owned(),
            (Term::Number(_), Term::Number(_)) if is_upright => "Down".to_owned(),
            _ => format!("Target(at_m: {})", triple(&target)),
        };
        writeln!(text, "look: {look},")?;
        if let Some(fov) = own.get("angular_fov") {
            writeln!(text, "fov_deg: {},", swept.term(fov)?)?;
            if fov.number()? < 180.0 {
                let what = "fills the image; LESS draws it smaller, as a part of 180°";
                self.report.add(&fov.path, &fov.shown(), what);
            }
        }
        if let Some(node) = own.get("projection_type") {
            let projection = match node.text()?.to_ascii_lowercase().as_str() {
                "equisolid" => "Equisolid",
                "orthographic" => "Orthographic",
                "equidistant" => "Equidistant",
                "stereographic" => "Stereographic",
                other => {
                    return Err(node.wrong(&format!(
                        "{other:?} is none of equisolid, orthographic, equidistant and stereographic"
                    )));
                }
            };
            writeln!(text, "projection: {projection},")?;
        }
        text += above;
        self.finish_image(own, &mut text, swept)?;
        Ok(text + ")")
    }

    /// Position and target of a camera, and whether heights are above the ground.
    fn pose(&self, swept: &mut Swept<'_>) -> Result<([Term; 3], [Term; 3], &'static str)> {
        let view = self.conf.need("observation")?;
        let mut point = |keys: [&str; 3]| -> Result<[Term; 3]> {
            let [x, y, z] = keys.map(|key| view.need(key).and_then(|node| swept.term(node)));
            Ok([x?, y?.subtracted_from(self.size.1), z?])
        };
        let position = point(["obs_o_x", "obs_o_y", "obs_o_z"])?;
        let target = point(["obs_t_x", "obs_t_y", "obs_t_z"])?;
        let is_above = view.get("relative_height").map_or(Ok(false), Node::flag)?;
        Ok((position, target, if is_above { "above_ground: true,\n" } else { "" }))
    }

    fn size_px(&self, swept: &mut Swept<'_>) -> Result<String> {
        let sensor = self.conf.need("sensor")?;
        let [width, height] = [sensor.need("image_width")?, sensor.need("image_height")?];
        let [width, height] = [swept.term(width)?.whole(), swept.term(height)?.whole()];
        Ok(format!("size_px: ({width}, {height}),\n"))
    }

    /// Samples, measures and picture.
    fn finish_image(&self, own: &Node, text: &mut String, swept: &mut Swept<'_>) -> Result<()> {
        let sensor = self.conf.need("sensor")?;
        if let Some(node) =
            own.get("sample_per_square_meter").or(sensor.get("sample_per_square_meter"))
        {
            let samples = swept.term(node)?.whole();
            writeln!(text, "samples_per_px: {samples},")?;
            self.report.add(
                &node.path,
                &node.shown(),
                "a pixel, as in the program LESS, not its manual",
            );
        }
        let mut measures = if self.is_thermal {
            vec!["Radiance", "BrightnessTemperature"]
        } else {
            vec!["Radiance", "Brf"]
        };
        if sensor.get("hasFourComponentProduct").map_or(Ok(false), Node::flag)? {
            measures.push("FourComponents");
            let what = "sunlit is where the sun is seen from the side that is seen";
            self.report.add("sensor.hasFourComponentProduct", "true", what);
        }
        if text.starts_with("Fisheye") {
            measures.retain(|&measure| measure != "Brf");
        }
        writeln!(text, "measure: [{}],", measures.join(", "))?;
        if let Some(node) = sensor.get("film_type") {
            match node.text()?.as_str() {
                "spectrum" => {}
                "rgb" if self.visible_bands() >= 10 && !self.is_thermal => {
                    text.push_str("picture: Cie,\n");
                    let what =
                        "coloured by the wavelengths of the bands; LESS takes them for equal parts";
                    self.report.add(&node.path, "rgb", what);
                }
                "rgb" => {
                    let what =
                        "true colours need ten visible bands: a quick look of those there are";
                    self.report.add(&node.path, "rgb", what);
                }
                other => return Err(node.wrong(&format!("{other:?} is neither spectrum nor rgb"))),
            }
        }
        Ok(())
    }

    /// The virtual plane and its middle.
    pub(super) fn virtual_plane(&self) -> Result<Option<(String, (f64, f64))>> {
        let Some(plane) = self.conf.need("sensor")?.get("virtualPlane") else { return Ok(None) };
        let number = |key| plane.need(key)?.number();
        let center = (number("vx")?, self.size.1 - number("vy")?);
        let size = (number("sizex")?, number("sizey")?);
        if let Some(z) = plane.get("vz")
            && z.text()? != "MAX"
        {
            let what = "the top of the scene, as in LESS; `height_m` sets another height";
            self.report.add(&z.path, &z.shown(), what);
        }
        Ok(Some((format!("(center_m: {center:?}, size_m: {size:?})"), center)))
    }

    fn transport(&self, swept: &mut Swept<'_>) -> Result<String> {
        let mut text = String::new();
        if let Some(node) = self.conf.at(&["sensor", "record_only_direct"]) {
            let depth = node.number()?;
            if depth < 2.0 || depth.fract() != 0.0 {
                return Err(node.wrong(&format!("{depth} is no depth of paths: 2 or more")));
            }
            if depth < 3.0 {
                text += "first_order_only: true,\n";
            } else if depth < INFINITE_DEPTH {
                writeln!(text, "max_order: {},", depth - 1.0)?;
            }
        }
        if let Some(node) = self.conf.at(&["Advanced", "minimum_iteration"]) {
            writeln!(text, "roulette: (after_order: {}),", swept.term(node)?.whole())?;
        }
        Ok(if text.is_empty() { text } else { format!("transport: (\n{text}),\n") })
    }
}

fn triple([x, y, z]: &[Term; 3]) -> String {
    format!("({x}, {y}, {z})")
}
