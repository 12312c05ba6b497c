//! Photon packets and the quantities that they are counted for.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::super::super::decode::{Decode, Reader};
use super::super::super::describe::Book;
use super::super::super::encode::Encode;
use super::super::super::leaves::Walk;
use super::super::super::ron_text::{Node, Text, Value};
use super::{Ends, System, Views, VirtualPlane};

record! {
    /// Photon packets from all sources of light.
    pub struct Photons ("photons") {
        /// Packets per m² of the terrain's rectangle; of emitted light, lines through the
        /// scene along each of which several start.
        per_m2: f64 = 1000.0,
        /// Criteria that end the measurement; `per_m2` then is no limit.
        until: Option<Ends> = None,
        /// Quantities to report.
        measure: Vec<PhotonMeasure> = vec![PhotonMeasure::Albedo],
        /// Only light that leaves through it counts as reflected, and only what lies below it
        /// absorbs; all is normalised to its area.
        virtual_plane: Option<VirtualPlane> = None,
        /// Transport system: packets (`Forward`) or photons (`Analog`).
        system: System = System::Forward,
    }
}

choice! {
    /// Quantity that photons are counted for.
    pub enum PhotonMeasure ("a measure of photons") {
        /// BRF in this number of equal-area cells of the hemisphere.
        BrfCells(u32 => "150"),
        /// BRF towards directions, by virtual photons.
        BrfViews(Views => "PrincipalPlane"),
        /// BRF within cones: (zenith, azimuth, full opening angle), degrees.
        BrfCones(Vec<(f64, f64, f64)> => "[(30.0, 90.0, 5.0)]"),
        /// Reflected over incident flux.
        Albedo,
        /// Radiance in this number of equal-area cells of the hemisphere, W m⁻² sr⁻¹ nm⁻¹, from the sources
        /// that the band names; of an isolated scene, over the terrain's rectangle.
        RadianceCells(u32 => "150"),
        /// Radiance towards directions, by virtual photons.
        RadianceViews(Views => "PrincipalPlane"),
        /// Radiance within cones: (zenith, azimuth, full opening angle), degrees.
        RadianceCones(Vec<(f64, f64, f64)> => "[(30.0, 90.0, 5.0)]"),
        /// Flux density that leaves upwards, W m⁻² nm⁻¹, from the sources that the band names.
        Exitance,
        /// Temperature of the black body of each radiance that this sensor measures, K, in bands that
        /// hold emission.
        BrightnessTemperature,
        /// Splits this sensor's albedo and BRF as RAMI does: `_uc` (scattered once, by the ground),
        /// `_co_sgl` (once, by anything else) and `_mlt` (more often).
        Orders,
        /// Share of the incident flux that each material absorbs in each layer and in all, and what
        /// reaches the ground.
        Fapar {
            /// Thickness of a layer from the lowest ground up, m, or the heights of all borders between layers in
            /// the local frame, m.
            layer_m: Layers = Layers::Thickness(1.0),
        },
        /// Power of sun and sky that each instance absorbs, W nm⁻¹, the terrain as the first of them.
        Absorbed {
            /// `Triangle` reports what each triangle and disc absorbs too, as a coloured PLY.
            per: Per = Per::Instance,
        },
        /// Down- and upwelling flux density, W m⁻² nm⁻¹, on the terrain and at the top of the scene,
        /// from the sources that the band names: per m² of horizontal area and, on relief, also per m²
        /// of the inclined ground (`_terrain_surface`).
        Fluxes {
            /// Side of a square pixel, m.
            pixel_m: f64 = 1.0,
            /// Further heights in the local frame, m.
            heights_m: Vec<f64> = Vec::new(),
        },
    }
}

impl PhotonMeasure {
    /// Returns whether a transport system estimates it: photons that are followed as a whole never leave in
    /// the very direction of a view.
    #[must_use]
    pub const fn is_measured_by(&self, system: System) -> bool {
        match self {
            Self::BrfViews(_) | Self::RadianceViews(_) => matches!(system, System::Forward),
            Self::BrfCells(_)
            | Self::BrfCones(_)
            | Self::Albedo
            | Self::RadianceCells(_)
            | Self::RadianceCones(_)
            | Self::Exitance
            | Self::BrightnessTemperature
            | Self::Orders
            | Self::Fapar { .. }
            | Self::Absorbed { .. }
            | Self::Fluxes { .. } => matches!(system, System::Forward | System::Analog),
        }
    }
}

choice! {
    /// Resolution of absorbed power, from coarse to fine.
    #[derive(Copy, Eq, PartialOrd, Ord)]
    pub enum Per ("`Instance` or `Triangle`") {
        /// Each instance.
        Instance,
        /// Each instance, and each of its triangles and discs.
        Triangle,
    }
}

/// Horizontal layers: `1.0` or `[0.0, 2.0, 8.0]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Layers {
    /// Thickness of all, from the ground up, m.
    Thickness(f64),
    /// Heights of their borders, m.
    Borders(Vec<f64>),
}

impl Decode for Layers {
    fn expected() -> Cow<'static, str> {
        "a thickness or a list of heights".into()
    }

    fn example() -> String {
        "1.0".to_owned()
    }

    fn schema(book: &mut Book) -> serde_json::Value {
        serde_json::json!({ "anyOf": [f64::schema(book), Vec::<f64>::schema(book)] })
    }

    fn decode<'a>(node: &'a Node, reader: &mut Reader<'a>) -> Self {
        match &node.value {
            Value::List(_) => Self::Borders(Vec::decode(node, reader)),
            _ => Self::Thickness(f64::decode(node, reader)),
        }
    }

    fn placeholder() -> Self {
        Self::Thickness(f64::placeholder())
    }
}

impl Encode for Layers {
    fn encode(&self) -> Text {
        match self {
            Self::Thickness(thickness) => thickness.encode(),
            Self::Borders(borders) => borders.encode(),
        }
    }

    fn visit<'a>(&'a self, walk: &mut Walk<'_, 'a>) {
        match self {
            Self::Thickness(thickness) => thickness.visit(walk),
            Self::Borders(borders) => borders.visit(walk),
        }
    }
}
