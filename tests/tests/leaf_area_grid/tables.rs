//! Tables by height, which upright instances of one scale share, against instances without tables.

use std::fmt::Write as _;

use sunfleck::queries::{CellCount, LayerCount, LeafAreaGrid, LeafAreaRequest};
use sunfleck_tests::SceneText;

use crate::stand::{LEVEL, Numbers};
use crate::{REQUEST, counted};

/// Number of instances; from 64 on they share tables.
const COUNT: usize = 160;

/// Instances of a bush of 700 triangles, some of them level or vertical, and of 150 discs.
///
/// - `instances`: their numbers
fn bushes(instances: std::ops::Range<usize>, boundary: &str) -> SceneText {
    let mut numbers = Numbers(5);
    let (mut obj, mut discs) = (String::from("g green\n"), String::new());
    for triangle in 0..700 {
        let mut center = [0.0; 3].map(|_: f64| numbers.next());
        for corner in 0..3 {
            let mut offset = [0.0; 3].map(|_: f64| 0.16 * numbers.next());
            match triangle % 7 {
                0 => offset[2] = 0.0,
                1 => offset[0] = 0.0,
                // Corners of the same height.
                2 if corner > 0 => offset[2] = 0.1,
                _ => {}
            }
            center[2] = center[2].clamp(0.01, 0.99);
            let [x, y, z] = [0, 1, 2].map(|axis| center[axis] + offset[axis]);
            writeln!(obj, "v {} {} {}", 2.0 * x - 1.0, 2.0 * y - 1.0, 3.0 * z).expect("memory");
        }
        writeln!(obj, "f -3 -2 -1").expect("memory");
    }
    for disc in 0..150 {
        let [radius, x, y, z, nx, ny] = [0.0; 6].map(|_: f64| numbers.next());
        let nz = f64::from(disc % 3);
        let (x, y, z) = (2.0 * x - 1.0, 2.0 * y - 1.0, 3.0 * z);
        writeln!(discs, "{},{x},{y},{z},{nx},{ny},{nz}", 0.1 * radius + 0.01).expect("memory");
    }
    let mut stems = String::from("x_m,y_m,z_m,yaw_deg,scale,scale_vertical\n");
    let mut numbers = Numbers(9);
    for stem in 0..COUNT {
        let [x, y, z, yaw] = [0.0; 4].map(|_: f64| numbers.next());
        // Scales whose ratio is 1 to the last bit, and another one.
        let scale = 0.75 + 0.25 * (stem % 4) as f64;
        let vertical = if stem % 2 == 0 { scale } else { 1.5 * scale };
        if instances.contains(&stem) {
            let (x, y, z, yaw) = (100.0 + 6.0 * x, -20.0 + 5.0 * y, 3.0 + 0.3 * z, 360.0 * yaw);
            writeln!(stems, "{x},{y},{z},{yaw},{scale},{vertical}").expect("memory");
        }
    }
    SceneText::bare(0.2, "size_m: (6.0, 5.0)")
        .with("terrain", LEVEL)
        .with_leaf(0.1, 0.1)
        .with_more(
            "materials",
            r#""red leaf": Leaf(reflectance: Constant(0.3), transmittance: Constant(0.1))"#,
        )
        .with_discs("discs", "leaf", &discs)
        .with_more(
            "meshes",
            r#""bush": Obj(file: "bush.obj", up: Z, unit_m: 1.0, parts: { "green": "red leaf" })"#,
        )
        .with_file("bush.obj", &obj)
        .with(
            "instances",
            r#"Table(file: "stems.csv", of: "discs"), Table(file: "stems.csv", of: "bush")"#,
        )
        .with_file("stems.csv", &stems)
        .with("boundary", boundary)
}

/// *Scene*: 160 upright bushes of two ratios of scales, whose columns and layers come from tables, in large and in small
/// cells. *Expected*: each cell holds the same as of groups of 40, which share no table: their surfaces are cut one by
/// one.
#[test]
fn areas_from_tables_are_those_of_cut_surfaces() {
    let requests = [
        (CellCount::Counts { columns: 1, rows: 1 }, 0.31),
        (CellCount::Counts { columns: 3, rows: 4 }, 0.7),
        (CellCount::Counts { columns: 40, rows: 30 }, 0.2),
        (CellCount::Counts { columns: 2, rows: 1 }, 1000.0),
    ];
    for (boundary, (cells, thickness)) in
        ["Periodic", "Isolated"].into_iter().flat_map(|name| requests.map(|cells| (name, cells)))
    {
        let layers = LayerCount::Thickness(thickness);
        let is_periodic = boundary == "Periodic";
        let request = LeafAreaRequest { cells, layers, is_periodic, ..REQUEST };
        let of = |instances| counted(&bushes(instances, boundary).world(), &request);
        let with_tables = of(0..COUNT);
        let parts: Vec<LeafAreaGrid> =
            (0..COUNT).step_by(40).map(|first| of(first..first + 40)).collect();
        let whole: f64 = with_tables.areas.iter().sum();
        assert!(whole > 100.0);
        let kinds: [fn(&LeafAreaGrid) -> &[f64]; 3] =
            [|grid| &grid.areas, |grid| &grid.outside, |grid| &grid.below];
        for values in kinds {
            for (index, area) in values(&with_tables).iter().enumerate() {
                let expected: f64 = parts.iter().filter_map(|part| values(part).get(index)).sum();
                assert!((area - expected).abs() < 1e-11 * whole, "{area} for {expected}");
            }
        }
        assert!(is_periodic || with_tables.outside[0] > 1.0);
    }
}
