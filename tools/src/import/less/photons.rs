//! Photon tracing.

use std::fmt::Write as _;

use anyhow::Result;

use super::conf::{self, Node};
use super::project::Project;
use super::report::Report;
use super::settings::Rule;
use super::swept::Swept;

/// No more layers than this.
const MOST_LAYERS: f64 = 100_000.0;
/// Layers of a project that names none: those of LESS's program.
const USUAL_LAYERS: &str = "0:2:20";

/// A `Photons` sensor.
pub(super) fn photons(project: &Project, swept: &mut Swept<'_>) -> Result<String> {
    let own = project.conf.need("sensor")?.need("PhotonTracing")?;
    let report = &project.report;
    let key = "sunRayResolution";
    let per_m2 = swept.term(own, key, &Rule::RESOLUTION, report)?.inverse_square();
    let mut measures = Vec::new();
    if own.flag_of("BRFProduct")? {
        measures.extend(directional(project, own, swept)?);
    } else {
        for key in ["virtualDirections", "virtualDetectorDirections", "NumberOfDirections"] {
            not_asked_for(own, key, "BRFProduct", report);
        }
    }
    measures.extend(fluxes(project, own)?);
    measures.extend(layers(project, own)?);
    if measures.is_empty() {
        let measure = if project.is_thermal { "Exitance" } else { "Albedo" };
        report.differs("sensor.PhotonTracing", "no product", format!("{measure} is measured"));
        measures.push(measure.to_owned());
    }
    let mut text = format!("Photons(\nper_m2: {per_m2},\nmeasure: [{}],\n", measures.join(", "));
    if let Some(node) = own.get(key) {
        let what = "photons per m² of the ground; LESS counts that of the box around all objects";
        report.differs(&node.path, &node.shown(), what);
    }
    if let Some((plane, _)) = project.virtual_plane()? {
        writeln!(text, "virtual_plane: {plane},")?;
    }
    Ok(text + ")")
}

/// Marks a setting as read whose product is not chosen.
fn not_asked_for(own: &Node, key: &str, product: &str, report: &Report) {
    if let Some(node) = own.get(key) {
        report.unneeded(&node.path, &node.shown(), format!("`{product}` is not chosen"));
        node.settle();
    }
}

/// Sensors of quantities by direction.
fn directional(project: &Project, own: &Node, swept: &mut Swept<'_>) -> Result<Vec<String>> {
    let quantity = if project.is_thermal { "Radiance" } else { "Brf" };
    let cells = swept.term(own, "NumberOfDirections", &Rule::CELLS, &project.report)?;
    let mut measures = vec![format!("{quantity}Cells({})", cells.whole())];
    if let Some(node) = own.get("virtualDirections") {
        let what = "neither a list `zenith:azimuth;..` nor angles to combine `z1,z2;a1,a2`";
        let views = views(&list_text(node)?).ok_or_else(|| misread(node, what))?;
        if !views.is_empty() {
            for (zenith, azimuth) in &views {
                check_direction(node, *zenith, *azimuth)?;
            }
            measures.push(format!("{quantity}Views(List({views:?}))"));
        }
    }
    if let Some(node) = own.get("virtualDetectorDirections") {
        let what =
            "neither a list `zenith,azimuth,angle;..` nor angles to combine `z1,z2;a1,a2;angle`";
        let mut cones = cones(&list_text(node)?).ok_or_else(|| misread(node, what))?;
        for Cone(zenith, azimuth, angle) in &mut cones {
            check_direction(node, *zenith, *azimuth)?;
            if *angle <= 0.0 {
                return Err(node.wrong(&format!("a cone of {angle}° holds no direction")));
            }
            let most = 2.0 * (90.0 - *zenith);
            if *angle > most {
                let what = format!(
                    "a cone of {angle}° about zenith {zenith}°: {most}°, down to the horizon"
                );
                project.report.differs(&node.path, &node.shown(), what);
                *angle = most;
            }
        }
        if !cones.is_empty() {
            let cones: Vec<_> = cones.iter().map(|Cone(z, a, angle)| (z, a, angle)).collect();
            measures.push(format!("{quantity}Cones({cones:?})"));
        }
    }
    measures.push(if project.is_thermal { "BrightnessTemperature" } else { "Albedo" }.to_owned());
    Ok(measures)
}

/// Maps of fluxes, if they are chosen.
fn fluxes(project: &Project, own: &Node) -> Result<Option<String>> {
    let sensor = project.conf.need("sensor")?;
    if !own.flag_of("UpDownProduct")? {
        return Ok(None);
    }
    let across = Rule::PIXELS.read(sensor, "image_width", &project.report)?;
    let down = Rule::PIXELS.read(sensor, "image_height", &project.report)?;
    let (width, height) = (project.size.0 / across, project.size.1 / down);
    let what = "flux densities in square pixels; LESS has W nm⁻¹ per pixel";
    project.report.differs("sensor.PhotonTracing.UpDownProduct", "true", what);
    Ok(Some(format!("Fluxes(pixel_m: {:?})", width.min(height))))
}

/// Absorbed light by layers, if it is chosen.
fn layers(project: &Project, own: &Node) -> Result<Option<String>> {
    let (product, key) = ("sensor.PhotonTracing.fPARProduct", "LayerDefinition");
    if !own.flag_of("fPARProduct")? {
        not_asked_for(own, key, "fPARProduct", &project.report);
        return Ok(None);
    }
    if project.is_thermal {
        project.report.left_out(product, "true", "thermal projects have no light of the sun");
        not_asked_for(own, key, "fPARProduct", &project.report);
        return Ok(None);
    }
    let layers = if let Some(node) = own.get(key) {
        let text = list_text(node)?;
        borders(&text).ok_or_else(|| misread(node, "not `from:step:to` in m"))?
    } else {
        let what = format!("{USUAL_LAYERS} (from:step:to in m), as LESS has it");
        project.report.assumed(&own.path_of(key), own.lack_of(key), what);
        borders(USUAL_LAYERS).expect("the usual layers are from:step:to")
    };
    let what = "band by band, by material; LESS reports the integral over the bands";
    project.report.differs(product, "true", what);
    Ok(Some(format!("Fapar(layer_m: {layers})")))
}

fn misread(node: &Node, what: &str) -> anyhow::Error {
    node.wrong(&format!("{} is {what}", node.shown()))
}

fn check_direction(node: &Node, zenith: f64, azimuth: f64) -> Result<()> {
    match Rule::VIEW_ZENITH.fault(zenith).or_else(|| Rule::VIEW_AZIMUTH.fault(azimuth)) {
        Some(fault) => Err(node.wrong(&fault)),
        None => Ok(()),
    }
}

/// A text with lists of lists; marks of Chinese keyboards are those of others.
fn list_text(node: &Node) -> Result<String> {
    let marks = |letter| match letter {
        '，' => ',',
        '；' => ';',
        '：' => ':',
        other => other,
    };
    Ok(node.text()?.chars().map(marks).collect())
}

/// `zenith:azimuth;..`, or zeniths and azimuths to combine: `z1,z2;a1,a2`.
fn views(text: &str) -> Option<Vec<(f64, f64)>> {
    if text.contains(':') {
        let pair = |part: &str| {
            let (zenith, azimuth) = part.split_once(':')?;
            Some((conf::finite(zenith)?, conf::finite(azimuth)?))
        };
        return parts(text).map(pair).collect();
    }
    let lists: Vec<Vec<f64>> = parts(text).map(conf::numbers).collect::<Result<_, _>>().ok()?;
    match &lists[..] {
        [] => Some(Vec::new()),
        [zeniths, azimuths] => {
            Some(zeniths.iter().flat_map(|&z| azimuths.iter().map(move |&a| (z, a))).collect())
        }
        _ => None,
    }
}

/// Zenith, azimuth and full angle, degrees.
struct Cone(f64, f64, f64);

/// `zenith,azimuth,angle;..`, or zeniths and azimuths to combine at one angle: `z1,z2;a1,a2;angle`.
fn cones(text: &str) -> Option<Vec<Cone>> {
    let lists: Vec<Vec<f64>> = parts(text).map(conf::numbers).collect::<Result<_, _>>().ok()?;
    match &lists[..] {
        [zeniths, azimuths, angle] if angle.len() == 1 => {
            let cones =
                zeniths.iter().flat_map(|&z| azimuths.iter().map(move |&a| Cone(z, a, angle[0])));
            Some(cones.collect())
        }
        all => all
            .iter()
            .map(|cone| match cone[..] {
                [zenith, azimuth, angle] => Some(Cone(zenith, azimuth, angle)),
                _ => None,
            })
            .collect(),
    }
}

fn parts(text: &str) -> impl Iterator<Item = &str> {
    text.split(';').map(str::trim).filter(|part| !part.is_empty())
}

/// `from:step:to` as the heights of borders; a last layer that would not be whole is left out, as in
/// LESS. A number alone is a thickness.
fn borders(text: &str) -> Option<String> {
    let numbers: Option<Vec<f64>> = text.split(':').map(conf::finite).collect();
    match numbers.as_deref() {
        Some(&[step]) if step > 0.0 => Some(format!("{step:?}")),
        Some(&[from, step, to]) if step > 0.0 && to > from && (to - from) / step < MOST_LAYERS => {
            let count = ((to - from) / step + 1e-9) as u32;
            let borders: Vec<f64> = (0..=count).map(|i| from + f64::from(i) * step).collect();
            (count > 0).then(|| super::text::list(&borders))
        }
        _ => None,
    }
}
