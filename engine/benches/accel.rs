//! Ray rate of the engine on paths through a stand of 700 trees: the rays of a nadir orthographic
//! view in the near infrared, with next-event estimation to the sun and roulette after order 5.
//!
//! `cargo bench -p sunfleck --bench accel -- [SAMPLES [PIXELS [SIDE_M]]]` prints the BRF, which must be near
//! 0.3516, and the ray rate. With `SIDE_M` the stand is repeated over a square of that side.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a bench reports on the terminal")]
#![allow(missing_docs, reason = "a program, not an interface")]

use std::{error::Error, f64::consts::PI, fs, path::Path, time::Instant};

use glam::{DMat3, DVec2, DVec3, Vec3};
use rayon::prelude::*;
use sunfleck::{
    accel::{Domain, Hit, InstanceInput, MeshInput, Ray, RayBatch, TwoLevelBvh},
    components::{Mesh, MeshPart},
    geometry::basis,
};

const LEAF: u32 = 0;
const TRUNK: u32 = 1;
const SOIL: u32 = 2;
const REFLECTANCE: [f64; 3] = [0.4957, 0.24, 0.159];
const TRANSMITTANCE: [f64; 3] = [0.4409, 0.0, 0.0];

fn main() -> Result<(), Box<dyn Error>> {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data/stand"));
    let folder = std::env::var("STAND").map_or(folder.to_path_buf(), Into::into);
    if !folder.exists() {
        eprintln!("no stand at {}: nothing to do", folder.display());
        return Ok(());
    }
    let numbers: Vec<f64> = std::env::args().skip(1).filter_map(|a| a.parse().ok()).collect();
    let number = |place: usize, default: f64| numbers.get(place).copied().unwrap_or(default);
    let (samples, pixels, side) =
        (number(0, 16.0) as u32, number(1, 128.0) as u32, number(2, 100.0));

    let tree = read_tree(&folder.join("tree.obj"))?;
    let ground = rectangle(side as f32);
    let stems = read_stems(&folder.join("instances.txt"))?;
    let repeats = (side / 100.0).round() as u32;
    let tiles = (0..repeats * repeats)
        .map(|t| 100.0 * DVec3::new(f64::from(t % repeats), f64::from(t / repeats), 0.0));
    let mut instances: Vec<_> = tiles
        .flat_map(|tile| {
            stems.iter().map(move |&[x, y, yaw]| InstanceInput {
                mesh: 0,
                linear: DMat3::from_rotation_z(yaw),
                translation: tile + DVec3::new(x, y, 0.0),
            })
        })
        .collect();
    instances.push(InstanceInput { mesh: 1, linear: DMat3::IDENTITY, translation: DVec3::ZERO });
    let meshes = [
        MeshInput { mesh: &tree, surfaces: &[LEAF, TRUNK] },
        MeshInput { mesh: &ground, surfaces: &[SOIL] },
    ];
    let domain = Domain { min: DVec2::ZERO, max: DVec2::splat(side), is_periodic: false };
    let start = Instant::now();
    let scene = TwoLevelBvh::build(&meshes, instances.par_iter().copied(), domain)?;
    println!("build {:.3} s, {} instances", start.elapsed().as_secs_f64(), instances.len());

    let corner = DVec2::splat((side / 200.0).floor() * 100.0 + 25.0);
    let start = Instant::now();
    let (sum, rays) = (0..pixels)
        .into_par_iter()
        .map(|row| trace_row(&scene, corner, row, pixels, samples))
        .collect::<Vec<_>>()
        .into_iter()
        .fold((0.0, 0), |(sum, rays), (more, traced)| (sum + more, rays + traced));
    let seconds = start.elapsed().as_secs_f64();
    let paths = f64::from(pixels).powi(2) * f64::from(samples);
    println!(
        "BRF {:.5}  t {seconds:.2} s  Mrays/s {:.3}  rays/path {:.2}",
        sum / paths / sun().z,
        rays as f64 / seconds / 1e6,
        rays as f64 / paths
    );
    Ok(())
}

fn sun() -> DVec3 {
    let (sin, cos) = 30_f64.to_radians().sin_cos();
    DVec3::new(-sin, 0.0, cos)
}

struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 40) as f64 / f64::from(1 << 24)
    }
}

/// Sum of the radiances of one row of pixels for unit irradiance across the beam, times π, and the
/// number of rays.
fn trace_row(
    scene: &TwoLevelBvh,
    corner: DVec2,
    row: u32,
    pixels: u32,
    samples: u32,
) -> (f64, u64) {
    let mut random = Random(0x9E37_79B9_7F4A_7C15_u64.wrapping_mul(u64::from(row) + 1));
    for _ in 0..8 {
        random.next();
    }
    let (mut sum, mut rays) = (0.0, 0);
    let all: Vec<u32> = (0..pixels * samples).collect();
    for together in all.chunks(64) {
        let mut flights: Vec<Flight> = together
            .iter()
            .map(|sample| {
                let across = DVec2::new(f64::from(sample / samples), f64::from(row));
                let jitter = DVec2::new(random.next(), random.next());
                let origin = (corner + 50.0 * (across + jitter) / f64::from(pixels)).extend(30.0);
                let ray = Ray { origin, direction: -DVec3::Z, from: None };
                Flight { order: 0, throughput: 1.0, light: 0.0, shadow: None, onward: Some(ray) }
            })
            .collect();
        while !flights.is_empty() {
            let shadows: Vec<Ray> = flights.iter().filter_map(|flight| flight.shadow).collect();
            let onwards: Vec<Ray> = flights.iter().filter_map(|flight| flight.onward).collect();
            let (mut dark, mut hits) = (vec![false; shadows.len()], vec![None; onwards.len()]);
            scene.trace_each(RayBatch {
                shadow_rays: &shadows,
                occluded: &mut dark,
                closest_rays: &onwards,
                hits: &mut hits,
            });
            rays += (shadows.len() + onwards.len()) as u64;
            let (mut dark, mut hits) = (dark.into_iter(), hits.into_iter());
            flights.retain_mut(|flight| {
                if flight.shadow.is_some() && dark.next() == Some(false) {
                    sum += flight.light;
                }
                let Some(ray) = flight.onward else { return false };
                let hit = hits.next().flatten();
                hit.is_some_and(|hit| flight.meet(&hit, ray.direction, &mut random))
            });
        }
    }
    (sum, rays)
}

/// A path and the rays that it waits for.
struct Flight {
    order: u32,
    throughput: f64,
    /// What the sun adds if nothing is on the shadow ray.
    light: f64,
    shadow: Option<Ray>,
    onward: Option<Ray>,
}

impl Flight {
    /// Is scattered; whether it waits for more.
    fn meet(&mut self, hit: &Hit, from: DVec3, random: &mut Random) -> bool {
        let (rho, tau) = (REFLECTANCE[hit.surface as usize], TRANSMITTANCE[hit.surface as usize]);
        let normal = if hit.normal.dot(from) > 0.0 { -hit.normal } else { hit.normal };
        let cos = normal.dot(sun());
        let weight = if cos > 0.0 { rho * cos } else { -tau * cos };
        self.light = self.throughput * weight;
        self.shadow = (weight > 0.0).then(|| hit.leave(sun()));
        self.throughput *= rho + tau;
        let mut goes_on = true;
        if self.order >= 5 {
            goes_on = random.next() >= 0.05;
            self.throughput /= 0.95;
        }
        self.order += 1;
        self.onward = (goes_on && self.throughput >= 1e-6).then(|| {
            let through = random.next() * (rho + tau) >= rho;
            let (u, turn) = (random.next(), 2.0 * PI * random.next());
            let (sin, cos) = (turn as f32).sin_cos();
            let up = if through { -(1.0 - u).sqrt() } else { (1.0 - u).sqrt() };
            let (x, y) = basis(normal);
            let direction = u.sqrt() * (f64::from(cos) * x + f64::from(sin) * y) + up * normal;
            hit.leave(direction / direction.length())
        });
        self.shadow.is_some() || self.onward.is_some()
    }
}

fn read_tree(path: &Path) -> Result<Mesh, Box<dyn Error>> {
    let mut mesh = Mesh::default();
    let mut starts = Vec::new();
    for line in fs::read_to_string(path)?.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let v: Vec<f32> = words.map(str::parse).collect::<Result<_, _>>()?;
                mesh.vertices.push(Vec3::new(v[0], v[1], v[2]));
            }
            Some("f") => {
                let f: Vec<u32> = words.map(str::parse).collect::<Result<_, _>>()?;
                mesh.triangles.push([f[0] - 1, f[1] - 1, f[2] - 1]);
            }
            Some("g") => starts.push(mesh.triangles.len() as u32),
            _ => {}
        }
    }
    starts.push(mesh.triangles.len() as u32);
    mesh.parts = ["leaf", "trunk"]
        .iter()
        .zip(starts.windows(2))
        .map(|(&name, w)| MeshPart { name: name.into(), triangles: w[0]..w[1], discs: 0..0 })
        .collect();
    Ok(mesh)
}

fn rectangle(side: f32) -> Mesh {
    Mesh {
        vertices: [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)]
            .map(|(x, y)| Vec3::new(x, y, 0.0))
            .into(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        discs: Vec::new(),
        parts: vec![MeshPart { name: "ground".into(), triangles: 0..2, discs: 0..0 }],
    }
}

fn read_stems(path: &Path) -> Result<Vec<[f64; 3]>, Box<dyn Error>> {
    let numbers = fs::read_to_string(path)?
        .split_whitespace()
        .map(str::parse)
        .collect::<Result<Vec<f64>, _>>()?;
    Ok(numbers.chunks_exact(3).map(|n| [n[0], n[1], n[2]]).collect())
}
