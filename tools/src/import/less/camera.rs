//! Images: parallel projections, cameras and fisheye cameras.

use std::fmt::Write as _;

use anyhow::Result;

use super::project::Project;
use super::settings::{Choice, Rule};
use super::swept::Swept;
use super::term::Term;

/// Height that a camera on the ground itself is lifted to, m.
const LIFTED: f64 = 0.001;

/// Largest horizontal part of a vertical view, as a share of the distance.
const VERTICAL: f64 = 1e-5;

/// Position and target of a camera.
struct Pose {
    position: [Term; 3],
    target: [Term; 3],
    /// `above_ground: true` if heights are above the ground.
    above: &'static str,
}

impl Pose {
    /// Height of the target above the camera if it lies on the vertical through the camera.
    fn vertical(&self) -> Option<f64> {
        let numbers = |point: &[Term; 3]| match point {
            [Term::Number(x), Term::Number(y), Term::Number(z)] => Some([*x, *y, *z]),
            _ => None,
        };
        match (numbers(&self.position), numbers(&self.target)) {
            (Some(from), Some(to)) => {
                let rise = to[2] - from[2];
                let aside = (to[0] - from[0]).hypot(to[1] - from[1]);
                (aside <= VERTICAL * rise.abs()).then_some(rise)
            }
            _ => (self.position[..2] == self.target[..2]).then_some(f64::NAN),
        }
    }
}

impl Project {
    pub(super) fn orthographic(&self, swept: &mut Swept<'_>) -> Result<String> {
        let own = self.conf.need("sensor")?.need("orthographic")?;
        let view = self.conf.need("observation")?;
        let zenith = swept.term(view, "obs_zenith", &Rule::VIEW_ZENITH, &self.report)?;
        let azimuth = swept.term(view, "obs_azimuth", &Rule::VIEW_AZIMUTH, &self.report)?;
        let mut text = format!("Orthographic(\n{}", self.size_px(swept)?);
        let is_upright = match (&zenith, &azimuth) {
            (Term::Number(zenith), Term::Number(azimuth)) => {
                *zenith == 0.0 && azimuth.rem_euclid(90.0) == 0.0
            }
            _ => false,
        };
        let covers = own.flag_of("cover_whole_scene")? && !is_upright;
        if covers {
            text += "cover: WholeScene,\n";
            let what = "the rectangle around all that stands on the ground";
            self.report.differs("sensor.orthographic.cover_whole_scene", "true", what);
            for key in ["sub_region_width", "sub_region_height"] {
                if let Some(node) = own.get(key) {
                    node.settle();
                }
            }
        } else {
            let width = swept.term(own, "sub_region_width", &Rule::EXTENT, &self.report)?;
            let height = swept.term(own, "sub_region_height", &Rule::EXTENT, &self.report)?;
            writeln!(text, "extent_m: ({width}, {height}),")?;
        }
        if let Some((plane, (x, y))) = self.virtual_plane()? {
            if !covers {
                writeln!(text, "center_m: ({x:?}, {y:?}),")?;
                let what =
                    "in the middle of the image, which keeps its extent; LESS made it a square";
                self.report.differs("sensor.virtualPlane", "", what);
            }
            writeln!(text, "virtual_plane: {plane},")?;
        }
        writeln!(text, "zenith_deg: {zenith},\nazimuth_deg: {azimuth},")?;
        self.finish_image(own, &mut text, swept)?;
        Ok(text + ")")
    }

    pub(super) fn perspective(&self, swept: &mut Swept<'_>) -> Result<String> {
        let own = self.conf.need("sensor")?.need("perspective")?;
        let pose = self.pose(swept)?;
        let mut text = format!("Perspective(\n{}", self.size_px(swept)?);
        writeln!(text, "position_m: {},", triple(&pose.position))?;
        writeln!(text, "target_m: {},", triple(&pose.target))?;
        if pose.vertical().is_some() {
            text += "up: (0.0, 1.0, 0.0),\n";
        }
        let across = swept.term(own, "fovx", &Rule::FOV_X, &self.report)?;
        let down = swept.term(own, "fovy", &Rule::FOV_Y, &self.report)?;
        writeln!(text, "fov_deg: ({across}, {down}),")?;
        text += pose.above;
        self.finish_image(own, &mut text, swept)?;
        Ok(text + ")")
    }

    pub(super) fn fisheye(&self, swept: &mut Swept<'_>) -> Result<String> {
        let own = self.conf.need("sensor")?.need("CircularFisheye")?;
        let pose = self.pose(swept)?;
        let mut text = format!("Fisheye(\n{}", self.size_px(swept)?);
        writeln!(text, "position_m: {},", triple(&pose.position))?;
        let look = match pose.vertical() {
            Some(rise) if rise > 0.0 => "Up".to_owned(),
            Some(rise) if rise < 0.0 => "Down".to_owned(),
            _ => format!("Target(at_m: {})", triple(&pose.target)),
        };
        writeln!(text, "look: {look},")?;
        let up_to = |most: f64| match most {
            180.0 => Rule::fisheye("an angle above 0 and up to 180°", |v| v > 0.0 && v <= 180.0),
            350.0 => Rule::fisheye("an angle above 0 and up to 350°", |v| v > 0.0 && v <= 350.0),
            _ => Rule::fisheye("an angle above 0 and up to 360°", |v| v > 0.0 && v <= 360.0),
        };
        let projections = [
            ("equisolid", ("Equisolid", 360.0)),
            ("orthographic", ("Orthographic", 180.0)),
            ("equidistant", ("Equidistant", 360.0)),
            ("stereographic", ("Stereographic", 350.0)),
        ];
        let choice = Choice { choices: &projections, may_be_absent: false };
        let (projection, most) = choice.read(own, "projection_type", &self.report)?;
        let fov = swept.term(own, "angular_fov", &up_to(most), &self.report)?;
        writeln!(text, "fov_deg: {fov},\nprojection: {projection},")?;
        if !matches!(fov, Term::Number(fov) if fov >= 180.0) {
            let what = "fills the image; LESS draws it smaller, as a part of 180°";
            self.report.differs("sensor.CircularFisheye.angular_fov", &fov.to_string(), what);
        }
        text += pose.above;
        self.finish_image(own, &mut text, swept)?;
        Ok(text + ")")
    }

    fn pose(&self, swept: &mut Swept<'_>) -> Result<Pose> {
        let view = self.conf.need("observation")?;
        let report = &self.report;
        // The window's defaults for a camera are of no use: it would lie on the ground at a corner.
        let (middle_x, middle_y) = (0.5 * self.size.0, 0.5 * self.size.1);
        let mut point = |keys: [&str; 3], defaults: [f64; 3]| -> Result<[Term; 3]> {
            let mut term = |axis: usize| {
                swept.term(view, keys[axis], &Rule::coordinate(defaults[axis]), report)
            };
            Ok([term(0)?, term(1)?.subtracted_from(self.size.1), term(2)?])
        };
        let mut position = point(["obs_o_x", "obs_o_y", "obs_o_z"], [middle_x, middle_y, 1.5])?;
        let target = point(["obs_t_x", "obs_t_y", "obs_t_z"], [middle_x, middle_y, 0.0])?;
        let is_above = view.flag_of("relative_height")? || view.get("obs_o_z").is_none();
        if let Term::Number(height) = &mut position[2]
            && (is_above || self.is_flat()?)
            && *height <= 0.0
        {
            if *height < 0.0 {
                let node = view.need("obs_o_z")?;
                return Err(node.wrong(&format!("a camera at {height} m lies below the ground")));
            }
            *height = LIFTED;
            let what = format!("lifted to {LIFTED} m: a camera is above the ground");
            report.differs("observation.obs_o_z", "0", what);
        }
        if position == target {
            let what = "the camera's own position: it looks nowhere";
            let node = view.get("obs_t_z").unwrap_or(view);
            return Err(node.wrong(&format!("the target is {what}")));
        }
        Ok(Pose { position, target, above: if is_above { "above_ground: true,\n" } else { "" } })
    }

    fn size_px(&self, swept: &mut Swept<'_>) -> Result<String> {
        let sensor = self.conf.need("sensor")?;
        let width = swept.term(sensor, "image_width", &Rule::PIXELS, &self.report)?.whole();
        let height = swept.term(sensor, "image_height", &Rule::PIXELS, &self.report)?.whole();
        Ok(format!("size_px: ({width}, {height}),\n"))
    }
}

fn triple([x, y, z]: &[Term; 3]) -> String {
    format!("({x}, {y}, {z})")
}
