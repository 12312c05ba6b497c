//! Ray rate of the ray engine on a scene.

use std::fmt::Write as _;
use std::hint::black_box;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::Instant;

use sunfleck::accel::{Ray, RayBatch};
use sunfleck::extract::Stage;
use sunfleck::run;
use sunfleck::sampling::Key;
use sunfleck::transport::{OrthographicCamera, TracedRay, path_rays};

use crate::arguments::Rays;

/// Rays that a thread takes at a time: enough that taking them costs nothing.
const SHARE: usize = 4096;

/// Rays of all paths that go on side by side.
const TOGETHER: usize = 128;

/// Rates of closest-hit and any-hit rays of paths that start straight down over the middle half of
/// the scene, build time and memory.
pub(crate) fn rays(arguments: &Rays) -> anyhow::Result<String> {
    let threads = match arguments.threads {
        Some(threads) => threads.get(),
        None => thread::available_parallelism()?.get(),
    };
    let options = run::Options {
        document: arguments.scene.options(),
        threads: Some(threads),
        ..run::Options::default()
    };
    let ready = run::stage_file(&arguments.scene.file, &options)?;
    let stage = &ready.stage;
    let rays =
        path_rays(stage, &OrthographicCamera::from_middle(stage), arguments.paths, Key::new(1));
    let (any, closest): (Vec<TracedRay>, Vec<TracedRay>) = rays.iter().partition(|ray| ray.any);
    let memory = stage.geometry.memory();
    let mut text = String::new();
    writeln!(text, "load         {:9.3} s", ready.load_seconds)?;
    writeln!(text, "build        {:9.3} s", ready.build_seconds)?;
    writeln!(
        text,
        "triangles    {:9} in meshes, {:.1} bytes each",
        memory.primitives,
        memory.mesh_bytes as f64 / memory.primitives.max(1) as f64
    )?;
    writeln!(
        text,
        "instances    {:9}, {:.1} bytes each",
        memory.instances,
        memory.instance_bytes as f64 / memory.instances.max(1) as f64
    )?;
    if let Some(peak) = peak_memory() {
        writeln!(text, "peak memory  {:9.1} MiB", peak / f64::from(1 << 20))?;
    }
    let one = |stage: &Stage, rays: &[TracedRay]| {
        for TracedRay { ray, any } in rays {
            if *any {
                black_box(stage.geometry.occluded(ray));
            } else {
                black_box(stage.geometry.closest(ray));
            }
        }
    };
    let measured: [(&str, &[TracedRay], &Work); 4] = [
        ("closest hit", &closest, &one),
        ("any hit", &any, &one),
        ("one by one", &rays, &one),
        ("paths", &rays, &as_paths),
    ];
    for (name, rays, work) in measured {
        let mut rates: Vec<f64> =
            (0..arguments.rounds.max(1)).map(|_| rate(stage, rays, threads, work)).collect();
        rates.sort_by(f64::total_cmp);
        writeln!(
            text,
            "{name:12} {:9.3} Mrays/s, median of {} rounds ({:.3} to {:.3}) of {} rays on {threads} threads",
            rates[rates.len() / 2],
            rates.len(),
            rates[0],
            rates[rates.len() - 1],
            rays.len(),
        )?;
    }
    Ok(text)
}

/// Traces rays as paths do: many at a time, those to the sun and those onwards.
fn as_paths(stage: &Stage, rays: &[TracedRay]) {
    for together in rays.chunks(TOGETHER) {
        let of_kind = |any: bool| -> Vec<Ray> {
            together.iter().filter(|one| one.any == any).map(|one| one.ray).collect()
        };
        let (shadows, rays) = (of_kind(true), of_kind(false));
        let (mut dark, mut hits) = (vec![false; shadows.len()], vec![None; rays.len()]);
        stage.geometry.trace_each(RayBatch {
            shadow_rays: &shadows,
            occluded: &mut dark,
            closest_rays: &rays,
            hits: &mut hits,
        });
        black_box((dark, hits));
    }
}

/// A way to trace rays.
type Work = dyn Fn(&Stage, &[TracedRay]) + Sync;

/// Million rays a second.
fn rate(stage: &Stage, rays: &[TracedRay], threads: usize, work: &Work) -> f64 {
    let shares: Vec<&[TracedRay]> = rays.chunks(SHARE).collect();
    let next = AtomicUsize::new(0);
    let start = Instant::now();
    thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some(share) = shares.get(next.fetch_add(1, Ordering::Relaxed)) {
                    work(stage, share);
                }
            });
        }
    });
    rays.len() as f64 / start.elapsed().as_secs_f64() / 1e6
}

/// Maximum memory of this process, bytes, where the system reports it (Linux).
fn peak_memory() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kibibytes: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kibibytes * 1024.0)
}
