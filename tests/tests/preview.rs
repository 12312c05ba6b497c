//! Maps and views of scenes: what stands where on them, read from their SVG and their pixels.

use std::fs;
use std::io::Cursor;

use sunfleck::components::View;
use sunfleck::preview::{SceneMap, SceneView, ViewSettings, map_svg, replace_by_boxes};
use sunfleck::run::{LoadedScene, Options, Unwatched};
use tempfile::TempDir;

/// Two slabs, one of which stands on the border of a periodic tile, a polygon and two sensors.
const SCENE: &str = r#"Scene(
    format: 1,
    title: "Plot & <two> slabs",
    frame: (origin_m: (400000.0, 5600000.0, 100.0)),
    bands: [(name: "red", center_nm: 660.0)],
    materials: { "soil": Lambertian(reflectance: Constant(0.2)) },
    meshes: {
        "slab": Faces(faces_m: [[(-2.0, -2.0, 5.0), (2.0, -2.0, 5.0), (2.0, 2.0, 5.0), (-2.0, 2.0, 5.0)]], material: "soil"),
    },
    terrain: Plane(size_m: (40.0, 20.0), material: "soil"),
    instances: [
        List(of: "slab", at_m: [(10.0, 10.0, 0.0), (40.0, 5.0, 0.0)], scale: [1.0, 1.0]),
        Scatter(of: { "slab": 1.0 }, rule: Uniform, stems: Count(1), tilt_deg: Fixed(30.0), tilt_azimuth_deg: Fixed(90.0),
            inside: [Polygon(outline_m: [(24.0, 9.0), (24.002, 9.0), (24.001, 9.002)])]),
    ],
    sun: (zenith_deg: 45.0, azimuth_deg: 90.0),
    boundary: Periodic,
    sensors: {
        "top": Orthographic(size_px: (10, 10), extent_m: (10.0, 10.0), center_m: (10.0, 10.0)),
        "mast": Perspective(size_px: (10, 10), position_m: (30.0, 10.0, 5.0), target_m: (30.0, 15.0, 0.0), fov_deg: (30.0, 30.0)),
    },
)"#;

fn load(edits: &[(&str, &str)]) -> (TempDir, LoadedScene) {
    let folder = tempfile::tempdir().expect("a folder");
    let mut text = SCENE.to_owned();
    for (old, new) in edits {
        assert!(text.contains(old), "{old}");
        text = text.replace(old, new);
    }
    let file = folder.path().join("plot.ron");
    fs::write(&file, text).expect("a file");
    let loaded = LoadedScene::from_file(&file, &Options::default(), &Unwatched);
    let loaded = loaded.unwrap_or_else(|failure| panic!("{failure}"));
    (folder, loaded)
}

/// Text of an SVG without the pixels in it.
fn without_pixels(svg: &str) -> String {
    let mut parts = svg.split("base64,");
    let mut text = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        text.push_str("..");
        text.push_str(&part[part.find('"').expect("the attribute ends")..]);
    }
    text
}

/// A number in an attribute of an element.
fn attribute(element: &str, name: &str) -> f64 {
    let from = element.find(&format!(" {name}=\"")).expect("it has the attribute") + name.len() + 3;
    let text = &element[from..];
    text[..text.find('"').expect("it ends")].parse().expect("a number")
}

/// Circles in the frame of a map 400 pixels wide, m: x, y and radius.
fn circles(edits: &[(&str, &str)]) -> Vec<[f64; 3]> {
    let (_folder, loaded) = load(edits);
    let svg = SceneMap::new(&loaded, 400).svg();
    let clip = svg.lines().find(|line| line.starts_with("<clipPath")).expect("a frame");
    let (left, top) = (attribute(clip, "x"), attribute(clip, "y"));
    // Periodic maps show the tile of 40 m x 20 m, isolated ones 1.6 m around.
    let [room, scale] = if svg.contains("periodic") { [0.0, 10.0] } else { [1.6, 400.0 / 43.2] };
    let inside = svg.split("</g>").next().expect("a group");
    let circles = inside
        .lines()
        .filter(|line| line.starts_with("<circle") && line.contains("fill=\"#009e73\""));
    circles
        .map(|line| {
            let x = (attribute(line, "cx") - left) / scale - room;
            let y = 20.0 + room - (attribute(line, "cy") - top) / scale;
            [x, y, attribute(line, "r") / scale]
        })
        .collect()
}

#[test]
fn a_map_is_this_text() {
    let (_folder, loaded) = load(&[]);
    let map = SceneMap::new(&loaded, 400);
    insta::assert_snapshot!(without_pixels(&map.svg()));
    let expected = [
        "periodic, 40 m x 20 m",
        "stems stand inside",
        "slab: 3",
        "1 top (orthographic)",
        "2 mast (perspective)",
        "sun 45.0° from zenith, 90.0°",
    ];
    assert_eq!(map.contents, expected);
    assert!(map_svg(&loaded).contains("Plot &amp; &lt;two&gt; slabs"));
}

/// *Expected*: a slab of 4 m has a circle of radius 2 m where it stands, and its copy on the other side of a periodic tile;
/// a slab 5 m above its stem that leans 30° to the east is 2.5 m to the east of it.
#[test]
fn crowns_are_circles_where_they_stand() {
    let known = |found: &[[f64; 3]], x: f64, y: f64| {
        let near =
            |[cx, cy, r]: &&[f64; 3]| (cx - x).hypot(cy - y) < 0.01 && (r - 2.0).abs() < 0.01;
        found.iter().filter(near).count()
    };
    let periodic = circles(&[]);
    let places = [(10.0, 10.0), (40.0, 5.0), (0.0, 5.0), (26.5, 9.0)];
    assert_eq!(places.map(|(x, y)| known(&periodic, x, y)), [1, 1, 1, 1], "{periodic:?}");
    assert_eq!(periodic.len(), 4);
    let isolated = circles(&[("boundary: Periodic", "boundary: Isolated")]);
    assert_eq!(places.map(|(x, y)| known(&isolated, x, y)), [1, 1, 0, 1], "{isolated:?}");
    let scaled = circles(&[("scale: [1.0, 1.0]", "scale: [2.0, 1.0]")]);
    assert!(scaled.iter().any(|[x, _, r]| (x - 10.0).abs() < 0.01 && (r - 4.0).abs() < 0.01));
}

/// *Expected*: the colour of the crown over that of the ground where the SVG has its circle, the ground's beside it.
#[test]
fn pixels_show_what_the_text_says() {
    let (_folder, loaded) = load(&[]);
    let map = SceneMap::new(&loaded, 400);
    let svg = map.svg();
    let clip = svg.lines().find(|line| line.starts_with("<clipPath")).expect("a frame");
    let png = map.png().expect("memory");
    let mut reader = png::Decoder::new(Cursor::new(png)).read_info().expect("a PNG");
    let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
    let info = reader.next_frame(&mut pixels).expect("pixels");
    assert_eq!(info.width, attribute(&svg, "width") as u32);
    let colour = |x: f64, y: f64| {
        let column = (attribute(clip, "x") + 10.0 * x) as usize;
        let row = (attribute(clip, "y") + 10.0 * (20.0 - y)) as usize;
        let at = 3 * (row * info.width as usize + column);
        pixels[at..at + 3].to_vec()
    };
    let (ground, crown) = ([240, 236, 228], [91, 188, 158]);
    assert_eq!(colour(17.0, 10.0), ground);
    let mixed = colour(11.0, 11.0);
    assert!(mixed.iter().zip(crown).all(|(found, known)| found.abs_diff(known) <= 2), "{mixed:?}");
    assert_eq!(colour(1.0, 5.0), mixed, "its copy");
}

/// *Expected*: of six thousand crowns pixels and no circles, and what the legend says of them.
#[test]
fn many_crowns_are_pixels() {
    let (_folder, loaded) = load(&[
        ("stems: Count(1)", "stems: Count(6000)"),
        (", (24.002, 9.0), (24.001, 9.002)", ", (34.0, 9.0), (24.001, 19.0)"),
    ]);
    let svg = SceneMap::new(&loaded, 400).svg();
    assert!(svg.len() < 200_000 && svg.matches("<circle").count() < 20, "{}", svg.len());
    assert!(svg.contains("pixels show their mean"));
}

/// *Expected*: the same bytes of both files for one thread as for all.
#[test]
fn maps_do_not_depend_on_threads() {
    let draw = || {
        let (_folder, loaded) = load(&[]);
        let map = SceneMap::new(&loaded, 300);
        (map.svg(), map.png())
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool");
    assert!(pool.install(draw) == draw());
}

/// Pixels of a picture, row by row.
struct Pixels {
    width: usize,
    rgb: Vec<u8>,
}

impl Pixels {
    fn new(png: &[u8]) -> Self {
        let mut reader = png::Decoder::new(Cursor::new(png)).read_info().expect("a PNG");
        let mut rgb = vec![0; reader.output_buffer_size().expect("a size")];
        let info = reader.next_frame(&mut rgb).expect("pixels");
        Self { width: info.width as usize, rgb }
    }

    /// Colour at film coordinates, from `(0, 0)` top left to `(1, 1)` bottom right.
    fn at(&self, x: f64, y: f64) -> [u8; 3] {
        let rows = self.rgb.len() / 3 / self.width;
        let at = 3 * ((y * rows as f64) as usize * self.width + (x * self.width as f64) as usize);
        [self.rgb[at], self.rgb[at + 1], self.rgb[at + 2]]
    }
}

/// Pictures of a view from above of a scene with these edits.
fn views(edits: &[(&str, &str)], has_boxes: bool) -> Vec<Vec<u8>> {
    let (_folder, mut loaded) = load(edits);
    if has_boxes {
        replace_by_boxes(&mut loaded);
    }
    let options = Options::default();
    let stage = loaded.isolated_stage(&options, &Unwatched).unwrap_or_else(|e| panic!("{e}"));
    let towards = Some(View::from_degrees(0.0, 180.0));
    let view = SceneView::new(&loaded, &stage, ViewSettings { width: 240, samples: 2, towards });
    let mut pictures = Vec::new();
    let shown: Result<(), ()> = view.trace(|png| {
        pictures.push(png);
        Ok(())
    });
    shown.expect("nothing fails");
    pictures
}

/// A plate of 10 m in the middle of 40 m x 20 m, 5 m high, under a sun in the east.
const PLATE: [(&str, &str); 3] = [
    ("boundary: Periodic", "boundary: Isolated"),
    (
        "List(of: \"slab\", at_m: [(10.0, 10.0, 0.0), (40.0, 5.0, 0.0)], scale: [1.0, 1.0])",
        "List(of: \"slab\", at_m: [(20.0, 10.0, 0.0)])",
    ),
    ("stems: Count(1)", "stems: Count(0)"),
];

/// *Expected*: three pictures, the last complete; the plate is as bright as the ground, which has the same material, its
/// shadow lies to the west and is darker, but not black; beside the ground is none of its colour.
#[test]
fn views_show_light_and_shadow() {
    let pictures = views(&PLATE, false);
    assert_eq!(pictures.len(), 3, "coarse, first and last");
    let last = Pixels::new(&pictures[2]);
    assert_eq!(last.rgb.len(), 3 * 240 * 150);
    // The plate is 4 m of a picture that is 43 m wide or so: its middle and the ground to the east are sunlit.
    let (plate, ground) = (last.at(0.5, 0.5), last.at(0.65, 0.5));
    let shadow = last.at(0.5 - 5.0 / 42.0, 0.5);
    let brightness =
        |colour: [u8; 3]| colour.iter().map(|&channel| u32::from(channel)).sum::<u32>();
    assert!(brightness(plate).abs_diff(brightness(ground)) < 30, "{plate:?} {ground:?}");
    assert!(brightness(shadow) + 100 < brightness(ground), "{shadow:?} {ground:?}");
    assert!(shadow.iter().all(|&channel| channel > 20), "{shadow:?}");
    let beside = last.at(0.01, 0.01);
    assert!(beside[2] > ground[2] || beside[0].abs_diff(ground[0]) > 10, "{beside:?}");
    // A level plate is its own box.
    assert!(views(&PLATE, true)[2] == pictures[2]);
}

/// *Expected*: a picture without black pixels for scenes without instances, without a sun and with a thermal band alone.
#[test]
fn any_scene_has_a_view() {
    let thermal = [
        ("(name: \"red\", center_nm: 660.0)", "(name: \"tir\", center_nm: 10000.0)"),
        (
            "Lambertian(reflectance: Constant(0.2))",
            "Lambertian(reflectance: Constant(0.05), temperature: Uniform(300.0))",
        ),
        (
            "sun: (zenith_deg: 45.0, azimuth_deg: 90.0),",
            "sky: Isotropic(irradiance: Constant(1.0)),",
        ),
    ];
    let bare = [PLATE[1], PLATE[2], ("List(of: \"slab\", at_m: [(20.0, 10.0, 0.0)]),", "")];
    for edits in [&thermal[..], &bare, &[thermal[2]]] {
        let last = Pixels::new(views(edits, false).last().expect("a picture"));
        assert!(last.rgb.chunks_exact(3).all(|pixel| pixel.iter().any(|&channel| channel > 15)));
    }
}

/// *Expected*: the same bytes for one thread as for all.
#[test]
fn views_do_not_depend_on_threads() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool");
    assert!(pool.install(|| views(&PLATE, false)) == views(&PLATE, false));
}
