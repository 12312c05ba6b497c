//! Photon tracing.

use std::fmt::Write as _;

use anyhow::Result;

use super::Project;
use super::conf::{self, Node};
use super::swept::Swept;

/// Cells of the hemisphere where a project says nothing.
const CELLS: &str = "150";
/// No more layers than this.
const MOST_LAYERS: f64 = 100_000.0;

/// A `Photons` sensor.
pub(super) fn photons(project: &Project, swept: &mut Swept<'_>) -> Result<String> {
    let sensor = project.conf.need("sensor")?;
    let own = sensor.need("PhotonTracing")?;
    let resolution = own.need("sunRayResolution")?;
    if resolution.number()? <= 0.0 {
        return Err(resolution.wrong("is not above 0 m"));
    }
    let per_m2 = swept.term(resolution)?.inverse_square();
    let is_on = |key| own.get(key).map_or(Ok(false), Node::flag);
    let (brf, radiance) = (is_on("BRFProduct")?, project.is_thermal);
    let mut measures = Vec::new();
    let quantity = if radiance { "Radiance" } else { "Brf" };
    let mut directed = |node: Option<&Node>, kind: &str, read: Reader| -> Result<()> {
        let Some(node) = node else { return Ok(()) };
        let text = node.text()?;
        if !text.is_empty() && brf {
            let list = read(&text).ok_or_else(|| {
                node.wrong(&format!(
                    "{text:?} is neither a list of directions nor angles to combine"
                ))
            })?;
            measures.push(format!("{quantity}{kind}({list})"));
        }
        Ok(())
    };
    directed(own.get("virtualDirections"), "Views", views)?;
    directed(own.get("virtualDetectorDirections"), "Cones", cones)?;
    let cells = own.get("NumberOfDirections").map(|node| swept.term(node)).transpose()?;
    if brf {
        let cells = cells.map_or_else(|| CELLS.to_owned(), |cells| cells.whole());
        measures.insert(0, format!("{quantity}Cells({cells})"));
        measures.push(if radiance { "BrightnessTemperature" } else { "Albedo" }.to_owned());
    }
    if is_on("UpDownProduct")? {
        let size = [sensor.need("image_width")?, sensor.need("image_height")?];
        let [across, down] = [size[0].number()?, size[1].number()?];
        if across < 1.0 || down < 1.0 {
            return Err(size[0].wrong("an image has pixels"));
        }
        let (width, height) = (project.size.0 / across, project.size.1 / down);
        measures.push(format!("Fluxes(pixel_m: {:?})", width.min(height)));
        let what = "flux densities in square pixels; LESS has W nm⁻¹ a pixel";
        project.report.add("sensor.PhotonTracing.UpDownProduct", "true", what);
    } else {
        ["image_width", "image_height"]
            .into_iter()
            .filter_map(|key| sensor.get(key))
            .for_each(Node::settle);
    }
    let layers = own.get("LayerDefinition");
    if is_on("fPARProduct")? {
        let layers = match layers {
            Some(node) => layers_of(node)?,
            None => "1.0".to_owned(),
        };
        measures.push(format!("Fapar(layer_m: {layers})"));
        let what = "band by band, by material; LESS reports the integral over the bands";
        project.report.add("sensor.PhotonTracing.fPARProduct", "true", what);
    } else if let Some(layers) = layers {
        layers.settle();
    }
    if measures.is_empty() {
        measures.push(if radiance { "Exitance" } else { "Albedo" }.to_owned());
    }
    let mut text = format!("Photons(\nper_m2: {per_m2},\nmeasure: [{}],\n", measures.join(", "));
    let what =
        "photons a square metre of the ground; LESS counts that of the box around all objects";
    project.report.add(&resolution.path, &resolution.shown(), what);
    if let Some((plane, _)) = project.virtual_plane()? {
        writeln!(text, "virtual_plane: {plane},")?;
    }
    Ok(text + ")")
}

type Reader = fn(&str) -> Option<String>;

/// `zenith:azimuth;..`, or zeniths and azimuths to combine: `z1,z2;a1,a2`.
fn views(text: &str) -> Option<String> {
    let pairs: Vec<(f64, f64)> = if text.contains(':') {
        let pair = |part: &str| {
            let (zenith, azimuth) = part.split_once(':')?;
            Some((conf::finite(zenith)?, conf::finite(azimuth)?))
        };
        parts(text).map(pair).collect::<Option<_>>()?
    } else {
        let lists: Vec<Vec<f64>> = parts(text).map(conf::numbers).collect::<Result<_, _>>().ok()?;
        let [zeniths, azimuths] = &lists[..] else { return None };
        zeniths.iter().flat_map(|&z| azimuths.iter().map(move |&a| (z, a))).collect()
    };
    Some(format!("List({pairs:?})"))
}

/// `zenith,azimuth,angle;..`, or zeniths and azimuths to combine at one angle: `z1,z2;a1,a2;angle`.
fn cones(text: &str) -> Option<String> {
    let lists: Vec<Vec<f64>> = parts(text).map(conf::numbers).collect::<Result<_, _>>().ok()?;
    let cones: Vec<(f64, f64, f64)> = match &lists[..] {
        [zeniths, azimuths, angle] if angle.len() == 1 => {
            zeniths.iter().flat_map(|&z| azimuths.iter().map(move |&a| (z, a, angle[0]))).collect()
        }
        all => all
            .iter()
            .map(|cone| {
                <[f64; 3]>::try_from(cone.as_slice()).ok().map(|[z, a, angle]| (z, a, angle))
            })
            .collect::<Option<_>>()?,
    };
    Some(format!("{cones:?}"))
}

fn parts(text: &str) -> impl Iterator<Item = &str> {
    text.split(';').map(str::trim).filter(|part| !part.is_empty())
}

/// `from:step:to` as the heights of borders; a last layer that would not be whole is left out, as in
/// LESS. A number alone is a thickness.
fn layers_of(node: &Node) -> Result<String> {
    let text = node.text()?;
    let numbers: Option<Vec<f64>> = text.split(':').map(conf::finite).collect();
    match numbers.as_deref() {
        Some(&[step]) if step > 0.0 => Ok(format!("{step:?}")),
        Some(&[from, step, to]) if step > 0.0 && to > from && (to - from) / step < MOST_LAYERS => {
            let count = ((to - from) / step + 1e-9) as u32;
            let borders: Vec<f64> = (0..=count).map(|i| from + f64::from(i) * step).collect();
            Ok(super::text::list(&borders))
        }
        _ => Err(node.wrong(&format!("{text:?} is not `from:step:to` in m"))),
    }
}
