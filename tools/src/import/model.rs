//! Parts of a scene that readers of several programs write.

use std::collections::HashSet;
use std::fmt::Write as _;
use std::fs::File;
use std::io::{BufWriter, Write as _};
use std::path::Path;
use sunfleck::counts::counted;

use anyhow::{Context as _, Result, bail};

use super::text::{self, quoted};

/// Placement of an instance: 3 x 4 numbers of a matrix, row by row, the last of each row in m.
pub(super) type Matrix = [[f64; 4]; 3];

/// Yaw, lean and scales of a matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pose {
    pub(super) at: [f64; 3],
    pub(super) yaw_deg: f64,
    pub(super) tilt_deg: f64,
    pub(super) tilt_azimuth_deg: f64,
    pub(super) scale: f64,
    pub(super) scale_vertical: f64,
}

impl Pose {
    /// The pose of a matrix that turns about the vertical after scaling and then leans; `None` if it shears, mirrors, or
    /// scales x and y differently.
    pub(super) fn from_matrix(matrix: &Matrix) -> Option<Self> {
        let column = |j: usize| [matrix[0][j], matrix[1][j], matrix[2][j]];
        let [x, y, z] = [0, 1, 2].map(column);
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let [scale, scale_y, scale_vertical] = [x, y, z].map(|axis| dot(axis, axis).sqrt());
        // Matrices in files have six digits.
        let is_alike = |a: f64, b: f64| (a - b).abs() <= 1e-5 * a.abs().max(b.abs());
        let is_lawful = [scale, scale_y, scale_vertical].iter().all(|s| s.is_finite() && *s > 0.0);
        let right =
            |a: [f64; 3], b: [f64; 3]| dot(a, b).abs() <= 1e-5 * (dot(a, a) * dot(b, b)).sqrt();
        let is_right = right(x, y) && right(y, z) && right(x, z);
        let cross =
            [y[1] * z[2] - y[2] * z[1], y[2] * z[0] - y[0] * z[2], y[0] * z[1] - y[1] * z[0]];
        if !is_lawful || !is_alike(scale, scale_y) || !is_right || dot(x, cross) <= 0.0 {
            return None;
        }
        let up = z.map(|value| value / scale_vertical);
        let tilt = up[2].clamp(-1.0, 1.0).acos();
        let azimuth = if tilt < 1e-6 { 0.0 } else { up[0].atan2(up[1]) };
        // Turned back upright, x shows the yaw: Rodrigues' formula about the horizontal axis of the lean.
        let axis = [-azimuth.cos(), azimuth.sin(), 0.0];
        let (sin, cos) = (-tilt).sin_cos();
        let x = x.map(|value| value / scale);
        let across = [
            axis[1] * x[2] - axis[2] * x[1],
            axis[2] * x[0] - axis[0] * x[2],
            axis[0] * x[1] - axis[1] * x[0],
        ];
        let along = dot(axis, x) * (1.0 - cos);
        let upright = |i: usize| x[i] * cos + across[i] * sin + axis[i] * along;
        let is_upright = tilt < 1e-6;
        let yaw = if is_upright { x[1].atan2(x[0]) } else { upright(1).atan2(upright(0)) };
        Some(Self {
            at: [matrix[0][3], matrix[1][3], matrix[2][3]],
            yaw_deg: tidy(yaw.to_degrees()),
            tilt_deg: if is_upright { 0.0 } else { tidy(tilt.to_degrees()) },
            tilt_azimuth_deg: tidy(azimuth.to_degrees().rem_euclid(360.0)),
            scale: tidy(scale),
            scale_vertical: tidy(scale_vertical),
        })
    }
}

/// A number without what rounding has left behind its ninth decimal.
fn tidy(value: f64) -> f64 {
    let rounded = (value * 1e9).round() / 1e9;
    if rounded == 0.0 { 0.0 } else { rounded }
}

/// Writes a table of places, with the columns that it needs.
pub(super) fn write_places(path: &Path, poses: &[Pose]) -> Result<()> {
    let cannot = || format!("cannot write {}", path.display());
    let mut out = BufWriter::new(File::create(path).with_context(cannot)?);
    let is_turned = poses.iter().any(|pose| pose.yaw_deg != 0.0);
    let is_leaning = poses.iter().any(|pose| pose.tilt_deg != 0.0);
    let is_scaled = poses.iter().any(|pose| (pose.scale, pose.scale_vertical) != (1.0, 1.0));
    let mut header = "x_m,y_m,z_m".to_owned();
    for (is_there, columns) in [
        (is_turned, ",yaw_deg"),
        (is_leaning, ",tilt_deg,tilt_azimuth_deg"),
        (is_scaled, ",scale,scale_vertical"),
    ] {
        header.push_str(if is_there { columns } else { "" });
    }
    writeln!(out, "{header}").with_context(cannot)?;
    for pose in poses {
        let mut numbers = pose.at.to_vec();
        if is_turned {
            numbers.push(pose.yaw_deg);
        }
        if is_leaning {
            numbers.extend([pose.tilt_deg, pose.tilt_azimuth_deg]);
        }
        if is_scaled {
            numbers.extend([pose.scale, pose.scale_vertical]);
        }
        let row: Vec<String> = numbers.iter().map(f64::to_string).collect();
        writeln!(out, "{}", row.join(",")).with_context(cannot)?;
    }
    out.flush().with_context(cannot)
}

/// Names that are given once: of files, whatever the case of their letters, and of the scene's definitions.
#[derive(Debug, Default)]
pub(super) struct Names(HashSet<String>);

impl Names {
    /// A name made of letters that every system takes, which no other has.
    pub(super) fn unique(&mut self, name: &str) -> String {
        let name = text::file_name(name);
        let mut unique = if name.is_empty() { "unnamed".to_owned() } else { name };
        while !self.0.insert(unique.to_ascii_lowercase()) {
            unique.push('_');
        }
        unique
    }
}

/// A spectrum of an imported scene.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Curve {
    Constant(f64),
    /// Wavelengths, nm, and values.
    Points(Vec<(f64, f64)>),
}

impl Curve {
    /// Points of wavelengths and values that belong together.
    pub(super) fn from_lists(wavelengths: &[f64], values: &[f64]) -> Result<Self> {
        if wavelengths.len() != values.len() {
            bail!(
                "{} and {}: list one value for each",
                counted(wavelengths.len(), "wavelength"),
                counted(values.len(), "value")
            );
        }
        let mut points: Vec<(f64, f64)> =
            wavelengths.iter().copied().zip(values.iter().copied()).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        match points[..] {
            [] => bail!("an empty list of values"),
            [(_, value)] => Ok(Self::Constant(value)),
            _ => Ok(Self::Points(points)),
        }
    }

    /// Returns whether it is 0 everywhere.
    pub(super) fn is_zero(&self) -> bool {
        match self {
            Self::Constant(value) => *value == 0.0,
            Self::Points(points) => points.iter().all(|(_, value)| *value == 0.0),
        }
    }

    /// Wavelengths of its points, nm.
    pub(super) fn wavelengths(&self) -> Vec<f64> {
        match self {
            Self::Constant(_) => Vec::new(),
            Self::Points(points) => points.iter().map(|(nm, _)| *nm).collect(),
        }
    }

    /// Text in the scene language.
    pub(super) fn ron(&self) -> String {
        match self {
            Self::Constant(value) => format!("Constant({value:?})"),
            Self::Points(points) => format!("Points({points:?})"),
        }
    }
}

/// Text of a surface that reflects and perhaps transmits.
pub(super) fn surface(name: &str, reflectance: &Curve, transmittance: Option<&Curve>) -> String {
    let name = quoted(name);
    let mut text = String::new();
    let reflectance = reflectance.ron();
    // Writing to a string cannot fail.
    let _infallible = match transmittance.filter(|curve| !curve.is_zero()) {
        Some(curve) => {
            let transmittance = curve.ron();
            writeln!(
                text,
                "{name}: Leaf(reflectance: {reflectance}, transmittance: {transmittance}),"
            )
        }
        None => writeln!(text, "{name}: Lambertian(reflectance: {reflectance}),"),
    };
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Matrix of a pose, by rotations about fixed axes.
    fn matrix(yaw: f64, tilt: f64, azimuth: f64, scale: f64, vertical: f64) -> Matrix {
        let times = |a: [[f64; 3]; 3], b: [[f64; 3]; 3]| {
            [0, 1, 2].map(|i| [0, 1, 2].map(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum::<f64>()))
        };
        let about_z = |angle: f64| {
            let (s, c) = angle.to_radians().sin_cos();
            [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]
        };
        // Leaning to the north turns about the west; azimuths run clockwise.
        let (s, c) = tilt.to_radians().sin_cos();
        let north = [[1.0, 0.0, 0.0], [0.0, c, s], [0.0, -s, c]];
        let lean = times(times(about_z(-azimuth), north), about_z(azimuth));
        let size = [[scale, 0.0, 0.0], [0.0, scale, 0.0], [0.0, 0.0, vertical]];
        let linear = times(lean, times(about_z(yaw), size));
        [0, 1, 2].map(|i| [linear[i][0], linear[i][1], linear[i][2], 10.0 + i as f64])
    }

    #[test]
    fn poses_come_back_from_their_matrices() {
        for (yaw, tilt, azimuth, scale, vertical) in [
            (0.0, 0.0, 0.0, 1.0, 1.0),
            (73.66, 0.0, 0.0, 1.0, 1.0),
            (-120.0, 0.0, 0.0, 0.5, 2.0),
            (30.0, 20.0, 250.0, 1.0, 1.0),
            (-45.0, 90.0, 10.0, 3.0, 0.7),
        ] {
            let pose =
                Pose::from_matrix(&matrix(yaw, tilt, azimuth, scale, vertical)).expect("a pose");
            assert_eq!(pose.at.map(f64::to_bits), [10.0_f64, 11.0, 12.0].map(f64::to_bits));
            let found = [
                pose.yaw_deg,
                pose.tilt_deg,
                pose.tilt_azimuth_deg,
                pose.scale,
                pose.scale_vertical,
            ];
            for (found, expected) in found.into_iter().zip([yaw, tilt, azimuth, scale, vertical]) {
                assert!((found - expected).abs() < 1e-6, "{pose:?}");
            }
        }
        let mut mirrored = matrix(0.0, 0.0, 0.0, 1.0, 1.0);
        mirrored[0][0] = -1.0;
        assert_eq!(Pose::from_matrix(&mirrored), None);
        let mut sheared = matrix(0.0, 0.0, 0.0, 1.0, 1.0);
        sheared[0][1] = 0.5;
        assert_eq!(Pose::from_matrix(&sheared), None);
    }
}
