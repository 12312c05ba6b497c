//! SOILSPECT parameters of the ground.

use std::fmt::Write as _;
use sunfleck::counts::counted;

use anyhow::Result;
use sunfleck::components::{DirectionalOptics, SoilspectParameters};

use super::conf::Node;
use super::report::Report;
use super::text::list;

/// A parameter of the model.
#[derive(Debug)]
struct Parameter {
    /// Key of a LESS project.
    key: &'static str,
    /// Key of a sunfleck material.
    name: &'static str,
    /// Value that LESS's window starts with.
    default: f64,
    /// Minimum and maximum.
    range: [f64; 2],
}

const SIGNED: [f64; 2] = [-1000.0, 1000.0];

const PARAMETERS: [Parameter; 7] = [
    Parameter { key: "albedo", name: "albedo", default: 0.537, range: [0.0, 1.0] },
    Parameter { key: "c1", name: "b", default: 1.492, range: SIGNED },
    Parameter { key: "c2", name: "c", default: 0.56, range: SIGNED },
    Parameter { key: "c3", name: "b_prime", default: 0.238, range: SIGNED },
    Parameter { key: "c4", name: "c_prime", default: -0.06, range: SIGNED },
    Parameter { key: "h1", name: "hot_spot", default: 1.0, range: [0.0, 1000.0] },
    Parameter { key: "h2", name: "roughness", default: 0.114, range: [0.001, 1000.0] },
];

/// SOILSPECT parameters in the order of [`PARAMETERS`], shape `[7][bands]`.
///
/// Source: Jacquemoud, Baret & Hanocq (1992), Remote Sens. Environ. 41, 123–132.
#[derive(Debug)]
pub(super) struct Soil([Vec<f64>; PARAMETERS.len()]);

impl Soil {
    /// Reads `soilSpectParams` of the terrain.
    ///
    /// # Errors
    /// A value outside its range, a wrong number of values, or a soil that reflects more light than it receives.
    pub(super) fn read(terrain: &Node, bands: usize, report: &Report) -> Result<Self> {
        let node = terrain.need("soilSpectParams")?;
        let mut columns = [const { Vec::new() }; PARAMETERS.len()];
        for (column, parameter) in columns.iter_mut().zip(&PARAMETERS) {
            *column = parameter.read(node, bands, report)?;
        }
        let soil = Self(columns);
        match DirectionalOptics::new((0..bands).map(|band| soil.in_band(band)).collect()) {
            Ok(_) => Ok(soil),
            Err(fault) => Err(node.wrong(&format!(
                "the soil would reflect {:.1} % of the light from a zenith angle of {:.0}° in band {}: lower \
                 `albedo`, or bring `c1` to `c4` nearer to 0",
                100.0 * fault.dhr,
                fault.zenith.to_degrees(),
                fault.band + 1
            ))),
        }
    }

    fn in_band(&self, band: usize) -> SoilspectParameters {
        let [albedo, b, c, b_prime, c_prime, hot_spot, roughness] =
            self.0.each_ref().map(|column| column[band] as f32);
        SoilspectParameters {
            albedo,
            roughness,
            hot_spot,
            backward: [b, c],
            forward: [b_prime, c_prime],
        }
    }

    /// Writes the keys of a `Soilspect(..)`, each with a comma.
    pub(super) fn write_keys(&self, text: &mut String) -> Result<()> {
        for (parameter, values) in PARAMETERS.iter().zip(&self.0) {
            write!(text, "{}: Bands({}), ", parameter.name, list(values))?;
        }
        Ok(())
    }
}

impl Parameter {
    /// Values by band. One value holds for all bands.
    fn read(&self, parameters: &Node, bands: usize, report: &Report) -> Result<Vec<f64>> {
        let &Self { key, default, range: [minimum, maximum], .. } = self;
        let Some(node) = parameters.get(key) else {
            let what = format!("{default}, as LESS has it");
            report.assumed(&parameters.path_of(key), parameters.lack_of(key), what);
            return Ok(vec![default; bands]);
        };
        let mut values = node.numbers()?;
        if values.len() == 1 {
            values.resize(bands, values[0]);
        }
        if values.len() != bands {
            let values = counted(values.len(), "value");
            return Err(node.wrong(&format!("has {values}, `sensor.bands` has {bands}")));
        }
        match values.iter().find(|&value| !(minimum..=maximum).contains(value)) {
            Some(wrong) => {
                Err(node.wrong(&format!("{wrong} is not between {minimum} and {maximum}")))
            }
            None => Ok(values),
        }
    }
}
