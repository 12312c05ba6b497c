//! Memory and files as they are foretold and as they are.

use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use glam::UVec2;
use peak_alloc::PeakAlloc;
use sunfleck::components::{Footprint, OrthographicOptics, System, View};
use sunfleck::output;
use sunfleck::products::{Forecast, Report};
use sunfleck::run::{
    Checkpoint, Failure, Options, Partition, Progress, SaveRule, SensorProgress, run, stage_file,
};
use sunfleck::sampling::Key;
use sunfleck::scratch::ScratchSpace;
use sunfleck::transport::{
    Camera, DirectionsFilm, DirectionsSettings, Film, ImageFilm, LightSettings, LightSource,
    OrthographicCamera, ReferencePlane,
};
use sunfleck_tests::SceneText;
use sunfleck_tests::scene_text::many_bands;

/// Counts what is held: so there is one test in this file.
#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

/// A grove with one sensor.
fn scene(bands: usize, sensor: &str) -> SceneText {
    SceneText::bare(0.2, "size_m: (5.0, 5.0)")
        .with("bands", many_bands(bands))
        .with_leaf(0.4, 0.3)
        .with_two_trees("Rhombus(length_m: 0.1, width_m: 0.07)")
        .with("sun", "zenith_deg: 50.0, azimuth_deg: 10.0, irradiance: Constant(1.0)")
        .with("boundary", "Periodic")
        .with("sensors", format!(r#""it": {sensor}"#))
}

/// Memory at the start of tracing, and the most of it afterwards.
#[derive(Default)]
struct Meter {
    before: AtomicUsize,
}

impl Progress for Meter {
    fn stage(&self, name: &str) {
        if name == "tracing" {
            self.before.store(PeakAlloc.current_usage(), Ordering::Relaxed);
            PeakAlloc.reset_peak_usage();
        }
    }
    fn sensor(&self, _: &SensorProgress<'_>) {}
    fn forecast(&self, _: &str, _: &Forecast) {}
}

/// Runs a scene; returns its report and the most memory that it took while it was traced.
fn traced(bands: usize, sensor: &str, options: &Options) -> Result<(Report, u64), Failure> {
    let reading = scene(bands, sensor).read();
    if !reading.is_sound() {
        return Err(Failure::Scene(reading.render()));
    }
    let meter = Meter::default();
    let report = run(&reading.scene, Path::new(""), options, &meter)
        .map_err(|failure| failure.with_source(&reading.source));
    let most = PeakAlloc.peak_usage().saturating_sub(meter.before.load(Ordering::Relaxed));
    report.map(|report| (report, most as u64))
}

const SENSORS: [(&str, usize, &str); 8] = [
    (
        "image",
        2,
        "Orthographic(size_px: (700, 500), extent_m: (5.0, 5.0), samples_per_px: 2, measure: [Brf, Radiance])",
    ),
    (
        "orders",
        30,
        "Orthographic(size_px: (120, 90), extent_m: (5.0, 5.0), samples_per_px: 2, measure: [Brf, Orders])",
    ),
    (
        "components",
        1,
        "Orthographic(size_px: (500, 500), extent_m: (5.0, 5.0), samples_per_px: 2, measure: [FourComponents, GapFraction])",
    ),
    (
        "views",
        400,
        "Directions(views: PrincipalPlane(max_deg: 80.0, step_deg: 2.0), measure: [Brf, Orders], until: Samples(32))",
    ),
    // Each randomisation touches most cells with so many packets: those that it does not touch take no memory.
    ("cells", 40, "Photons(per_m2: 20000.0, measure: [Albedo, BrfCells(3000)])"),
    ("faces", 3, "Photons(per_m2: 100.0, measure: [Absorbed(per: Triangle)])"),
    ("folded", 2, "Photons(per_m2: 20.0, measure: [Fluxes(pixel_m: 0.0045)])"),
    ("fluxes", 2, "Photons(per_m2: 20000.0, measure: [Fluxes(pixel_m: 0.05)])"),
];

/// Scenes that no memory holds, or not this much of it: what their author reads, and the text that is to
/// be written otherwise.
const HOPELESS: [(usize, &str, &str); 7] = [
    (
        60,
        "Orthographic(size_px: (1000, 500), extent_m: (5.0, 5.0), system: Forward, samples_per_px: 2)",
        "size_px: (1000, 500)",
    ),
    (
        2100,
        "Directions(views: PrincipalPlane(max_deg: 80.0, step_deg: 0.01), until: RelErrors({\"brf\": 0.01}))",
        "",
    ),
    (2, "Photons(per_m2: 4.0, measure: [Fapar(layer_m: 1e-9)])", "layer_m: 1e-9"),
    (2100, "Photons(per_m2: 4.0, measure: [Albedo, Fluxes(pixel_m: 0.01)])", "pixel_m: 0.01"),
    (2100, "Photons(per_m2: 4.0, measure: [Albedo, BrfCells(90000)])", "BrfCells(90000)"),
    (700, "Photons(per_m2: 4.0, measure: [Absorbed(per: Triangle)])", "per: Triangle"),
    (2100, "Orthographic(size_px: (100000, 100000), extent_m: (5.0, 5.0))", ""),
];

/// Memory of what is not worth a forecast, bytes: lists of jobs and names, and a path in each thread.
fn small() -> u64 {
    (1 << 16) + (1 << 14) * rayon::current_num_threads() as u64
}

/// The most memory for these.
const LITTLE: u64 = 256 << 20;

/// Memory that a film holds when it is traced is what it says before, to the byte.
fn films_hold_what_they_say() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("scene.ron");
    let views = "Directions(views: PrincipalPlane, until: Samples(32))";
    fs::write(&file, scene(3, views).to_string()).expect("a scene");
    let stage = &stage_file(&file, &Options::default()).expect("a stage").stage;
    let optics = OrthographicOptics {
        footprint: Footprint::WholeScene,
        pixel: None,
        view: View { zenith: 0.3, azimuth: 0.0 },
        plane: None,
    };
    let camera =
        Camera::Orthographic(OrthographicCamera::from_sensor(&optics, UVec2::new(77, 45), stage));
    let plane = ReferencePlane::new(None, stage);
    let key = Key::new(1);
    let light = |system, separates_orders| LightSettings {
        system,
        source: LightSource::Reflected,
        separates_orders,
    };
    let image = |system, orders| ImageFilm::new(stage, &camera, light(system, orders), key);
    let views = [optics.view; 7];
    let directions = || {
        let light = light(System::Backward, true);
        let settings = DirectionsSettings { views: &views, plane: &plane, light };
        DirectionsFilm::new(stage, settings, key).film
    };
    for share in [Partition::ALL, Partition { index: 1, count: 3 }] {
        check_bytes("directions", &mut directions(), share);
        for (system, orders) in
            [(System::Backward, false), (System::Backward, true), (System::Forward, true)]
        {
            match image(system, orders) {
                ImageFilm::Paths(mut tiles) => check_bytes("paths", &mut *tiles, share),
                ImageFilm::Packets(mut packets) => check_bytes("packets", &mut packets.sums, share),
            }
        }
    }
}

/// Memory of the threshold of Russian roulette of virtual photons, which a pilot run finds before the first
/// packet: representative bands of one group of lanes, bytes.
const THRESHOLD: u64 = 8 * 4;

fn check_bytes(name: &str, film: &mut dyn Film, share: Partition) {
    film.restrict(share);
    let before = PeakAlloc.current_usage();
    film.trace(16, &|_| ()).expect("memory");
    let held = (PeakAlloc.current_usage() - before) as u64;
    let threshold = if name == "packets" { THRESHOLD } else { 0 };
    assert_eq!(film.bytes() + threshold, held, "{name}, {share:?}");
}

#[test]
fn memory_is_what_was_foretold_and_what_is_too_much_is_refused() {
    // Threads that are not there yet would count.
    traced(1, SENSORS[0].2, &Options::default()).expect("it fits");
    films_hold_what_they_say();
    let mut shares = Vec::new();
    for (name, bands, sensor) in SENSORS {
        let (report, most) = traced(bands, sensor, &Options::default()).expect("it fits");
        let foretold = report.sensors[0].forecast.memory;
        shares.push((name, most as f64 / foretold as f64, most.saturating_sub(foretold)));
    }
    for (name, share, beyond) in &shares {
        assert!(*share > 0.5 && *beyond < small(), "{name}: {shares:?}");
    }
    let mut texts = String::new();
    let two = rayon::ThreadPoolBuilder::new().num_threads(2).build().expect("a pool");
    for (bands, sensor, key) in HOPELESS {
        let options = Options { memory: Some(LITTLE), ..Options::default() };
        let before = PeakAlloc.current_usage();
        PeakAlloc.reset_peak_usage();
        // With more threads more results wait for their turn.
        let failure = two.install(|| traced(bands, sensor, &options)).expect_err("it is refused");
        let most = PeakAlloc.peak_usage() - before;
        assert!(most < 64 << 20, "{sensor}: {most} bytes");
        let text = failure.to_string();
        if !key.is_empty() {
            let advice = text.split("write `").nth(1).and_then(|rest| rest.split('`').next());
            let advised = sensor.replace(key, advice.expect("advice"));
            let (_, most) =
                two.install(|| traced(bands, &advised, &options)).expect("what is advised fits");
            assert!(most < LITTLE + small(), "{advised}: {most} bytes");
        }
        texts += &text;
        texts.push('\n');
    }
    insta::assert_snapshot!(texts);
    large_images_take_little_memory();
}

/// *Scene*: an image whose sums take 150 MB, of which 1 MiB may be in memory. *Expected*: a run and its files take a small
/// part of them, as foretold; pixels, means and checkpoints are bit for bit those of sums in memory; no temporary file is
/// left, and one that the disk cannot hold is refused.
fn large_images_take_little_memory() {
    const SENSOR: &str = "Orthographic(size_px: (1500, 500), extent_m: (5.0, 5.0), samples_per_px: 2, measure: [Brf, FourComponents])";
    let folder = tempfile::tempdir().expect("a folder");
    let scratch = |memory, disk| ScratchSpace { folder: folder.path().to_owned(), memory, disk };
    let with = |scratch, name: &str| {
        let checkpoint = Checkpoint {
            file: folder.path().join(name),
            saves: SaveRule::Every(1e9),
            share: Partition::ALL,
        };
        Options { scratch, checkpoint: Some(checkpoint), ..Options::default() }
    };
    let names = || fs::read_dir(folder.path()).expect("the folder").count();
    let (large, held) =
        traced(2, SENSOR, &with(scratch(1 << 30, None), "memory")).expect("it fits");
    let (small, most) = traced(2, SENSOR, &with(scratch(1 << 20, None), "file")).expect("it fits");
    assert!(held > 120 << 20 && most < 12 << 20, "{held} and {most} bytes");
    let foretold = small.sensors[0].forecast.memory;
    assert!(most < foretold + self::small() && foretold < 20 << 20, "{most} of {foretold} bytes");
    let bits = |report: &Report| report.sensors[0].bits().expect("pixels can be read");
    assert!(bits(&large) == bits(&small), "the same numbers");
    let read = |name| fs::read(folder.path().join(name)).expect("a checkpoint");
    // Seconds differ, and the checksum with them.
    let differing = |(a, b): (&Vec<u8>, &Vec<u8>)| a.iter().zip(b).filter(|(a, b)| a != b).count();
    let [memory, file] = [read("memory"), read("file")];
    assert!(memory.len() == file.len() && differing((&memory, &file)) <= 40, "the same state");
    assert_eq!(names(), 2, "two checkpoints, and no temporary file");
    let before = PeakAlloc.current_usage();
    PeakAlloc.reset_peak_usage();
    output::write(&small, &folder.path().join("out")).expect("files");
    let most = PeakAlloc.peak_usage() - before;
    assert!(most < 24 << 20, "{most} bytes to write 37 MB of values");
    denoised_images_are_filtered_in_parts(&folder.path().join("denoised"));
    let options = with(scratch(1 << 20, Some(10 << 20)), "refused");
    let failure = traced(2, SENSOR, &options).expect_err("the disk is full").to_string();
    assert!(failure.contains("of temporary files, and 10.0 MiB are free in"), "{failure}");
    let resumed = traced(2, SENSOR, &with(scratch(1 << 20, None), "memory")).expect("it fits").0;
    assert!(
        bits(&large) == bits(&resumed),
        "nothing is traced again, and the numbers are the same"
    );
}

/// *Scene*: an image of 2.6 million values, and a denoised one beside it. *Expected*: writing both takes no more memory
/// than foretold.
fn denoised_images_are_filtered_in_parts(out: &Path) {
    const SENSOR: &str = "Orthographic(size_px: (320, 4000), extent_m: (5.0, 5.0), samples_per_px: 2, denoised: true)";
    let scratch = ScratchSpace { folder: std::env::temp_dir(), memory: 1 << 20, disk: None };
    let options = Options { scratch, ..Options::default() };
    let (report, _) = traced(2, SENSOR, &options).expect("it fits");
    let foretold = report.sensors[0].forecast.memory;
    let before = PeakAlloc.current_usage();
    PeakAlloc.reset_peak_usage();
    output::write(&report, out).expect("files");
    let most = (PeakAlloc.peak_usage() - before) as u64;
    assert!(most < foretold + small(), "{most} of {foretold} bytes to write");
}
