use std::io;
use std::sync::Arc;

use super::convergence::{Measurement, PacedFilm, add_replicate};
use super::sensors::MeasureContext;
use crate::components::{Cone, PhotonMeasure, PhotonProduct, PhotonSensor, System, View};
use crate::extract::{Inventory, Stage};
use crate::products::{self, BandSources, Context, Product, ProductSize};
use crate::sampling::Key;
use crate::statistics::Spread;
use crate::transport::{
    AbsorbedCounter, AlbedoCounter, CellCounter, ConeCounter, Counter, EnergyCounter, FluxCounter,
    FluxLevel, GROUND_TERMS, Hemisphere, LayerCounter, LightSource, OrderCounter,
    OrthographicCamera, PacketOptions, PhotonKind, Randomisations, ReferencePlane, ReplicateSums,
    RouletteThreshold, ScatteringOrder, ViewCounter, photon_film,
};

/// Measurement by photon packets of sun and sky, and of emission.
pub(super) struct PhotonRun<'a> {
    sensor: &'a PhotonSensor,
    measured: MeasureContext<'a>,
    kinds: Vec<(&'a PhotonMeasure, ProductCounter)>,
    reflected: Option<Counted<'a>>,
    emitted: Option<Counted<'a>>,
}

impl<'a> PhotonRun<'a> {
    /// Measurement before its first packet.
    pub(super) fn new(sensor: &'a PhotonSensor, measured: MeasureContext<'a>, key: Key) -> Self {
        let MeasureContext { stage, context, .. } = measured;
        let plane = ReferencePlane::new(sensor.plane.as_ref(), stage);
        let kinds: Vec<(&PhotonMeasure, ProductCounter)> = sensor
            .products
            .iter()
            .filter_map(|product| {
                Some((&product.measure, ProductCounter::new(product, &plane, stage)?))
            })
            .collect();
        let kind = if sensor.system == System::Analog {
            PhotonKind::Photon
        } else {
            PhotonKind::Packet(RouletteThreshold::Low)
        };
        let film = |source, asked: Vec<(usize, Option<ScatteringOrder>)>, key| {
            (!asked.is_empty()).then(|| {
                let counters = asked.iter().map(|&(index, part)| -> Box<dyn Counter> {
                    let counter = kinds[index].1.with_roulette(source, key);
                    match part {
                        None => counter,
                        Some(part) => Box::new(OrderCounter { counter, part }),
                    }
                });
                let options = PacketOptions { source, beam: 0, kind, plane: plane.clone() };
                let film = photon_film(stage, options, counters, key);
                Counted { asked, film }
            })
        };
        let holds = |of: fn(&BandSources) -> bool| context.sources.iter().any(of);
        let (reflects, emits) = (holds(|source| source.reflects), holds(|source| source.emits));
        let numbered = || kinds.iter().enumerate();
        let wholes = numbered().filter(|(_, (measure, _))| reflects || !measure.is_absolute());
        let split = numbered()
            .filter(|(_, (measure, kind))| !measure.is_absolute() && kind.is_of_reflection());
        let parts = parts(sensor);
        let asked = wholes
            .map(|(index, _)| (index, None))
            .chain(split.flat_map(|(index, _)| parts.iter().map(move |&part| (index, Some(part)))));
        let reflected = film(LightSource::Reflected, asked.collect(), key);
        let asked = numbered().filter(|(_, (measure, _))| emits && measure.is_absolute());
        let asked = asked.map(|(index, _)| (index, None)).collect();
        let emitted = film(LightSource::Emitted, asked, key.path("emission"));
        Self { sensor, measured, kinds, reflected, emitted }
    }
}

/// Returns whether a sensor asks for a measure.
fn measures(sensor: &PhotonSensor, measure: &PhotonMeasure) -> bool {
    sensor.products.iter().any(|product| product.measure == *measure)
}

/// Parts of the light that are reported separately.
fn parts(sensor: &PhotonSensor) -> &'static [ScatteringOrder] {
    if measures(sensor, &PhotonMeasure::Orders) { &ScatteringOrder::ALL } else { &[] }
}

impl Measurement for PhotonRun<'_> {
    fn films(&mut self) -> Vec<PacedFilm<'_>> {
        let both = [&mut self.reflected, &mut self.emitted].into_iter().flatten();
        both.map(|counted| PacedFilm::evenly(&mut counted.film)).collect()
    }

    fn largest(&self) -> usize {
        let largest = self.kinds.iter().max_by_key(|(_, kind)| kind.counter().cells());
        let is_largest =
            |one: &&PhotonProduct| largest.is_some_and(|(most, _)| **most == one.measure);
        self.sensor.products.iter().take_while(|one| !is_largest(one)).count()
    }

    fn product_sizes(&self) -> Vec<ProductSize> {
        let MeasureContext { stage, context, .. } = self.measured;
        let Self { sensor, kinds, reflected, emitted, .. } = self;
        let films: Vec<_> = [reflected, emitted].into_iter().flatten().collect();
        let bands = context.bands.len() as u64;
        let of = |(index, (measure, kind)): (usize, &(&PhotonMeasure, ProductCounter))| {
            // Sources add up to one product; each part of the light is one.
            let asked = |part| films.iter().any(|film| film.asked.contains(&(index, part)));
            let parts = parts(sensor).iter().filter(|&&part| asked(Some(part))).count();
            let count = usize::from(asked(None)) + parts;
            let mut sizes = vec![kind.product_sizes(bands); count].concat();
            let kelvin = measures(sensor, &PhotonMeasure::BrightnessTemperature);
            if kelvin && measure.is_absolute() && kind.is_of_radiance() {
                sizes.extend(kind.product_sizes(context.emitting().len() as u64));
            }
            sizes
        };
        let rows = (EnergyCounter::ABSORBED + stage.models.surface_count()) as u64;
        let energy = vec![ProductSize::Table { rows, axes: 1, bands }; films.len()];
        kinds.iter().enumerate().flat_map(of).chain(energy).collect()
    }

    fn context(&self) -> &Context {
        self.measured.context
    }

    fn products(&self) -> io::Result<Vec<Product>> {
        Ok(self.products_of(Randomisations::All))
    }

    fn add_replicates(&self, products: &mut [Product]) -> io::Result<()> {
        Randomisations::each().for_each(|of| add_replicate(products, &self.products_of(of)));
        Ok(())
    }
}

impl PhotonRun<'_> {
    /// Products of some randomisations.
    fn products_of(&self, randomisations: Randomisations) -> Vec<Product> {
        let MeasureContext { stage, context, .. } = self.measured;
        let Self { sensor, kinds, reflected, emitted, .. } = self;
        let parts = parts(sensor);
        let mut found = Vec::new();
        let unit = context.with_unit_irradiance();
        for (index, (measure, kind)) in kinds.iter().enumerate() {
            let of = |counted: &Option<Counted<'_>>, part, context: &Context| -> Vec<Product> {
                let spread = counted
                    .as_ref()
                    .and_then(|counted| counted.spread(index, part, randomisations));
                spread.map_or_else(Vec::new, |spread| kind.products(&spread, stage, context))
            };
            if !measure.is_absolute() {
                found.extend(of(reflected, None, context));
                for &part in parts {
                    let products = of(reflected, Some(part), context).into_iter();
                    found.extend(products.map(|product| Product {
                        name: format!("{}_{}", product.name, part.suffix()),
                        ..product
                    }));
                }
                continue;
            }
            let (mut reflected, mut emitted) =
                (of(reflected, None, &unit).into_iter(), of(emitted, None, &unit).into_iter());
            for _ in 0..reflected.len().max(emitted.len()) {
                let (reflected, emitted) = (reflected.next(), emitted.next());
                let product =
                    products::combine_sources(reflected.as_ref(), emitted.as_ref(), context);
                let kelvin = measures(sensor, &PhotonMeasure::BrightnessTemperature);
                let kelvin =
                    kelvin.then(|| products::brightness_product(&product, context)).flatten();
                found.extend(std::iter::once(product).chain(kelvin));
            }
        }
        for (counted, context, name) in
            [(reflected, context, "energy"), (emitted, &unit, "emitted_energy")]
        {
            let Some(Counted { film, .. }) = counted else { continue };
            let energy = products::energy(&film.spread_of(0, randomisations), stage, context);
            let unit = if name == "energy" { energy.unit.clone() } else { "W m-2 nm-1".to_owned() };
            found.push(Product { name: name.to_owned(), unit, ..energy });
        }
        found
    }
}

/// Counters of one source: the index of the measure and the part of the light of each, and their sums.
struct Counted<'a> {
    asked: Vec<(usize, Option<ScatteringOrder>)>,
    film: ReplicateSums<'a>,
}

impl Counted<'_> {
    fn spread(
        &self,
        index: usize,
        part: Option<ScatteringOrder>,
        randomisations: Randomisations,
    ) -> Option<Spread> {
        let at = self.asked.iter().position(|asked| *asked == (index, part))?;
        // The first sums are those of the energy.
        Some(self.film.spread_of(at + 1, randomisations))
    }
}

/// Counter of a measure, with the data that its products take.
enum ProductCounter {
    Albedo(AlbedoCounter),
    Cells(CellCounter),
    Cones(ConeCounter),
    Views(ViewCounter, Vec<View>),
    Layers(LayerCounter),
    Absorbed(AbsorbedCounter, Arc<Inventory>),
    Fluxes(FluxCounter),
}

impl ProductCounter {
    fn new(product: &PhotonProduct, plane: &ReferencePlane, stage: &Stage) -> Option<Self> {
        let PhotonProduct { measure, views } = product;
        let plane = plane.clone();
        Some(match measure {
            PhotonMeasure::Orders | PhotonMeasure::BrightnessTemperature => return None,
            PhotonMeasure::BrfCones(cones) | PhotonMeasure::RadianceCones(cones) => {
                let cone = |&(zenith, azimuth, opening): &(f64, f64, f64)| {
                    Cone::from_degrees(zenith, azimuth, opening)
                };
                Self::Cones(ConeCounter::new(cones.iter().map(cone).collect(), plane))
            }
            PhotonMeasure::Albedo | PhotonMeasure::Exitance => {
                Self::Albedo(AlbedoCounter { plane })
            }
            PhotonMeasure::BrfCells(cells) | PhotonMeasure::RadianceCells(cells) => {
                Self::Cells(CellCounter { hemisphere: Hemisphere::new(*cells as usize), plane })
            }
            PhotonMeasure::BrfViews(_) | PhotonMeasure::RadianceViews(_) => {
                let camera = |&view: &View| OrthographicCamera::from_plane(view, &plane, stage);
                Self::Views(ViewCounter::new(views.iter().map(camera).collect()), views.clone())
            }
            PhotonMeasure::Absorbed { per } => {
                let inventory = stage.inventory.clone()?;
                Self::Absorbed(AbsorbedCounter::new(&inventory, *per, plane), inventory)
            }
            PhotonMeasure::Fapar { layer_m } => {
                Self::Layers(LayerCounter::new(stage, layer_m, plane))
            }
            PhotonMeasure::Fluxes { pixel_m, heights_m } => {
                let mut levels = vec![FluxLevel::Terrain];
                if stage.has_relief() {
                    levels.push(FluxLevel::TerrainSurface);
                }
                levels.push(FluxLevel::Top);
                levels.extend(heights_m.iter().map(|&height| FluxLevel::Height(height)));
                Self::Fluxes(FluxCounter::new(plane, *pixel_m, levels))
            }
        })
    }

    /// Returns whether it counts only light that leaves the scene.
    const fn is_of_reflection(&self) -> bool {
        match self {
            Self::Albedo(_) | Self::Cells(_) | Self::Cones(_) | Self::Views(..) => true,
            Self::Layers(_) | Self::Absorbed(..) | Self::Fluxes(_) => false,
        }
    }

    /// Returns whether it counts radiance, which has a brightness temperature.
    const fn is_of_radiance(&self) -> bool {
        matches!(self, Self::Cells(_) | Self::Cones(_) | Self::Views(..))
    }

    /// Extents of its products.
    fn product_sizes(&self, bands: u64) -> Vec<ProductSize> {
        let table =
            |rows: usize, axes: u64| vec![ProductSize::Table { rows: rows as u64, axes, bands }];
        match self {
            Self::Albedo(_) => table(1, 0),
            Self::Cells(counter) => table(counter.hemisphere.len(), 3),
            Self::Views(_, views) => table(views.len(), 2),
            Self::Cones(counter) => table(counter.cones.len(), 3),
            Self::Layers(counter) => {
                let layers = table(counter.totals(), 3);
                let whole = [table(counter.surfaces, 1), table(1, 0), table(GROUND_TERMS.len(), 1)];
                [layers, whole.concat()].concat()
            }
            Self::Absorbed(counter, _) => {
                let faces = (counter.cells() - counter.total() - 1) as u64;
                let faces =
                    vec![ProductSize::Faces { faces, bands }; usize::from(counter.has_faces())];
                [table(counter.instances, 4), faces].concat()
            }
            Self::Fluxes(counter) => {
                let pixels = u64::from(counter.size.x) * u64::from(counter.size.y);
                let width = u64::from(counter.size.x);
                let size =
                    ProductSize::Image { width, pixels, bands, is_kept: true, is_denoised: false };
                vec![size; 2 * counter.levels.len()]
            }
        }
    }

    /// Products of its sums.
    fn products(&self, spread: &Spread, stage: &Stage, context: &Context) -> Vec<Product> {
        match self {
            Self::Albedo(albedo) => vec![products::albedo(spread, albedo, context)],
            Self::Cells(cells) => {
                vec![products::brf_cells(spread, &cells.hemisphere, cells.plane.gain, context)]
            }
            Self::Cones(cones) => vec![products::brf_cones(spread, cones, context)],
            Self::Views(counter, views) => {
                vec![products::brf_views(spread, counter, views, stage, context)]
            }
            Self::Layers(layers) => products::fapar(spread, layers, stage, context),
            Self::Absorbed(counter, inventory) => {
                products::absorbed(spread, counter, inventory, stage, context)
            }
            Self::Fluxes(fluxes) => products::fluxes(spread, fluxes, context),
        }
    }

    /// Counter for packets of a source.
    fn with_roulette(&self, source: LightSource, key: Key) -> Box<dyn Counter> {
        match self {
            Self::Views(counter, _) => Box::new(counter.clone().with_roulette(source, key)),
            _ => self.counter(),
        }
    }

    fn counter(&self) -> Box<dyn Counter> {
        match self {
            Self::Albedo(counter) => Box::new(counter.clone()),
            Self::Cells(counter) => Box::new(counter.clone()),
            Self::Views(counter, _) => Box::new(counter.clone()),
            Self::Layers(counter) => Box::new(counter.clone()),
            Self::Cones(counter) => Box::new(counter.clone()),
            Self::Absorbed(counter, _) => Box::new(counter.clone()),
            Self::Fluxes(counter) => Box::new(counter.clone()),
        }
    }
}
