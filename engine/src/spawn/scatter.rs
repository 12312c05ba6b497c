use std::collections::BTreeMap;

use glam::DVec2;

use super::Spawner;
use super::georaster::{Quantity, RasterSource};
use super::meshes::Prototype;
use crate::assets;
use crate::components::Placement;
use crate::document::{Area, Boundary, Diagnostic, Instances, Map, Stems};
use crate::geometry::{Polygon, Rectangle, place_text};
use crate::placement::{Amount, Habit, PlacementError, Region, Species, places, stand};
use crate::sampling::Key;
use crate::terrain::{Cells, Ground};

impl Spawner<'_> {
    /// Instances by a rule; where that cannot be, a problem is noted.
    pub(super) fn scatter(
        &mut self,
        scatter: &Instances,
        index: usize,
        meshes: &BTreeMap<u32, Prototype>,
        ground: &Ground,
    ) -> Vec<Placement> {
        let Instances::Scatter {
            of,
            rule,
            stems,
            inside,
            outside,
            yaw_deg,
            tilt_deg,
            tilt_azimuth_deg,
            height_m,
            scale,
            scale_vertical,
            sink_m,
            name,
            seed,
        } = scatter
        else {
            return Vec::new();
        };
        let path = format!("instances[{index}]");
        let species = self.species(of, meshes, height_m.is_some(), &path);
        let corner = ground.corner();
        let terrain = Rectangle { min: corner, max: corner + ground.size() };
        let Some(region) = self.region(terrain, inside, outside, &path) else {
            return Vec::new();
        };
        let stream = self.stream(index, name.as_deref(), *seed);
        let is_periodic = self.scene.boundary == Boundary::Periodic;
        let map;
        let amount = match stems {
            Stems::Count(count) => Amount::Count(*count),
            Stems::PerHectare(density) => Amount::Density(density / 1e4),
            Stems::Fill => Amount::Fill,
            Stems::Raster { file, factor } => {
                let path = format!("{path}.stems");
                let Some(found) = self.densities(file, *factor, terrain, region.bounds(), &path)
                else {
                    return Vec::new();
                };
                map = found;
                Amount::Map(&map)
            }
        };
        let places = places(rule, amount, &region, terrain, is_periodic, stream.path("places"));
        let places = match places {
            Ok(places) => places,
            Err(error) => {
                self.problems.push(Diagnostic::error(path, error.to_string()));
                return Vec::new();
            }
        };
        let habit = Habit {
            yaw_deg,
            tilt_deg,
            tilt_azimuth_deg,
            height_m: height_m.as_ref(),
            scale,
            scale_vertical: scale_vertical.as_ref(),
            sink_m: *sink_m,
        };
        let trees = stand(&places, &species, &habit, |place| ground.height(place), stream);
        if trees.len() < places.len() && !species.is_empty() {
            let count = places.len() - trees.len();
            let message = format!("{count} of {} stems fell on holes of the terrain", places.len());
            let help = "none stands there; `outside` keeps an area free and the number as it is";
            self.problems.push(Diagnostic::warning(path, message).help(help));
        }
        trees
    }

    /// Random numbers of instances, by the author's name for them or else their number.
    pub(super) fn stream(&self, index: usize, name: Option<&str>, seed: Option<u64>) -> Key {
        let seed = Key::new(seed.unwrap_or(self.scene.transport.seed)).path("instances");
        name.map_or_else(|| seed.index(index as u64), |name| seed.path(name))
    }

    /// What may stand there.
    fn species<'a>(
        &mut self,
        of: &'a Map<f64>,
        meshes: &BTreeMap<u32, Prototype>,
        is_scaled_to_height: bool,
        path: &str,
    ) -> Vec<Species<'a>> {
        let mut species = Vec::new();
        for (name, &share) in of {
            let Some(prototype) = self.prototype(name, format!("{path}.of.{name}")) else {
                continue;
            };
            // A hidden mesh is not loaded, but its stems keep their places.
            let bounds = meshes.get(&prototype.0).map(|prototype| prototype.mesh.bounds());
            let top = bounds.map_or(1.0, |bounds| bounds.map_or(0.0, |(_, top)| top.z.into()));
            if is_scaled_to_height && top <= 0.0 {
                let message = format!("`{name}` lies below its origin and has no height to scale");
                let help = "add `origin: BaseCenter` to the mesh, or take `height_m` out";
                self.problems
                    .push(Diagnostic::error(format!("{path}.of.{name}"), message).help(help));
                continue;
            }
            species.push(Species { name, share, prototype, height: top });
        }
        species
    }

    /// Stems per hectare of a raster as stems m⁻²; none where there is no data.
    fn densities(
        &mut self,
        file: &str,
        factor: f64,
        terrain: Rectangle,
        needed: Rectangle,
        path: &str,
    ) -> Option<Cells<f64>> {
        let path = format!("{path}.file");
        let mut cells = self.cells(&RasterSource::new(file, &path, Quantity::Density), terrain)?;
        if let Some(value) = cells.values.iter().find(|value| **value < 0.0) {
            let message = format!("a density of {value} stems per hectare");
            let help = "if it stands for no data, name it in the file's header";
            self.problems.push(Diagnostic::error(path, message).help(help));
            return None;
        }
        let (low, high, room) = (cells.corner, cells.corner + cells.size, 1e-6 * needed.size());
        if !(low.cmple(needed.min + room).all() && high.cmpge(needed.max - room).all()) {
            let message = format!(
                "it reaches from {} to {} m, but stems may stand from {} to {} m",
                place_text(low),
                place_text(high),
                place_text(needed.min),
                place_text(needed.max)
            );
            let help = "nothing stands beside it";
            self.problems.push(Diagnostic::warning(path, message).help(help));
        }
        cells.values.iter_mut().for_each(|value| *value *= factor / 1e4);
        Some(cells)
    }

    fn region(
        &mut self,
        terrain: Rectangle,
        inside: &[Area],
        outside: &[Area],
        path: &str,
    ) -> Option<Region> {
        let mut owners = Vec::new();
        let mut read = |key: &str, areas: &[Area], spawner: &mut Self| {
            let mut polygons = Vec::new();
            for (index, area) in areas.iter().enumerate() {
                let path = format!("{path}.{key}[{index}]");
                let found = spawner.polygons(area, &path)?;
                spawner.doubt_area(area, &found, terrain, &path);
                owners.extend(found.iter().map(|_| path.clone()));
                polygons.extend(found);
            }
            Some(polygons)
        };
        let (inside, outside) = (read("inside", inside, self), read("outside", outside, self));
        match Region::new(terrain, &inside?, &outside?) {
            Ok(region) => Some(region),
            Err(error) => {
                let (path, help) = match &error {
                    PlacementError::CrossesItself { polygon, .. } => (
                        owners.get(*polygon as usize).cloned().unwrap_or_default(),
                        "list the corners of each ring in the order of its outline".to_owned(),
                    ),
                    PlacementError::NoGround => {
                        let Rectangle { min, max } = terrain;
                        let help = format!(
                            "the terrain reaches from {} to {} m, local frame",
                            place_text(min),
                            place_text(max)
                        );
                        (path.to_owned(), help)
                    }
                    _ => (path.to_owned(), String::new()),
                };
                let problem = Diagnostic::error(path, error.to_string());
                self.problems.push(if help.is_empty() { problem } else { problem.help(help) });
                None
            }
        }
    }

    /// Polygons of an area in the local frame.
    fn polygons(&mut self, area: &Area, path: &str) -> Option<Vec<Polygon>> {
        let crs;
        let (read, is_georeferenced) = match area {
            Area::Polygon { outline_m, holes_m } => {
                let ring = |ring: &Vec<(f64, f64)>| ring.iter().copied().map(DVec2::from).collect();
                let rings = std::iter::once(outline_m).chain(holes_m).map(ring).collect();
                return Some(vec![Polygon { rings }]);
            }
            Area::GeoJson { file, georeferenced } => {
                let (areas, named) = match assets::read_geojson(&self.file(file)) {
                    Ok(areas) => (Ok(areas.polygons), areas.crs),
                    Err(error) => (Err(error), None),
                };
                crs = named.map(|crs| (crs, file));
                (areas, *georeferenced)
            }
            Area::Table { file, georeferenced } => {
                crs = None;
                (assets::read_polygons(&self.file(file)), *georeferenced)
            }
        };
        match read {
            Ok(mut polygons) => {
                if is_georeferenced {
                    if let Some((crs, file)) = &crs {
                        self.check_system(crs, file, &format!("{path}.file"))?;
                    }
                    let (x, y, _) = self.scene.frame.origin_m;
                    let corners =
                        polygons.iter_mut().flat_map(|polygon| &mut polygon.rings).flatten();
                    corners.for_each(|corner| *corner -= DVec2::new(x, y));
                }
                Some(polygons)
            }
            Err(mut error) => {
                self.name_target(&mut error);
                self.problems.push(Diagnostic::error(format!("{path}.file"), error.to_string()));
                None
            }
        }
    }
}
