//! Leaf area by cells and layers against brute force, and against the gap fractions of the same scene.

mod brute_force;
mod gap_fractions;
mod stand;
mod tables;

use std::fmt::Write as _;

use brute_force::{Brute, area_of, placed};
use rayon::ThreadPoolBuilder;
use stand::{HILLS, LEVEL, Numbers, hills, scene};
use sunfleck::components::TerrainPatch;
use sunfleck::queries::{
    CellCount, CountedSurfaces, HeightReference, LayerCount, LeafAreaGrid, LeafAreaRequest,
    leaf_area,
};
use sunfleck::run::SceneWorld;
use sunfleck_tests::SceneText;

const REQUEST: LeafAreaRequest = LeafAreaRequest {
    cells: CellCount::Counts { columns: 3, rows: 4 },
    layers: LayerCount::Thickness(0.7),
    heights: HeightReference::Ground,
    surfaces: CountedSurfaces::All,
    by_material: true,
    is_periodic: true,
    memory: 1 << 30,
};

fn counted(world: &SceneWorld, request: &LeafAreaRequest) -> LeafAreaGrid {
    leaf_area(&world.world, request, &|_| ()).expect("it has leaves")
}

/// *Scene*: 48 instances of discs and triangles under all transforms. *Expected*: the area of each material is the sum
/// over its triangles and discs, whatever the cells.
#[test]
fn all_cells_together_hold_the_area_of_all_surfaces() {
    for boundary in ["Periodic", "Isolated"] {
        let world = scene(LEVEL, boundary).world();
        let exact = placed(&world, boundary == "Periodic").areas;
        let cells = [
            (CellCount::Counts { columns: 1, rows: 1 }, LayerCount::Count(1)),
            (CellCount::Counts { columns: 3, rows: 4 }, LayerCount::Thickness(0.7)),
            (CellCount::Side(0.11), LayerCount::Thickness(0.13)),
            (CellCount::Automatic, LayerCount::Automatic),
        ];
        for (cells, layers) in cells {
            let is_periodic = boundary == "Periodic";
            let found = counted(&world, &LeafAreaRequest { cells, layers, is_periodic, ..REQUEST });
            assert_eq!(found.classes, ["leaf", "red leaf", "bark"]);
            for (class, area) in exact.values().enumerate() {
                let elsewhere = found.outside[class] + found.below[class] + found.over_holes[class];
                let all = found.total(class) + elsewhere;
                assert!((all / area - 1.0).abs() < 1e-9, "{boundary} {cells:?}: {all} for {area}");
                assert_eq!(is_periodic, found.outside[class] == 0.0);
                let columns: f64 = found.columns_total().iter().skip(class).step_by(3).sum();
                let layers: f64 = found.layers_total().iter().skip(class).step_by(3).sum();
                let sum = found.total(class);
                assert!((columns / sum - 1.0).abs() < 1e-9 && (layers / sum - 1.0).abs() < 1e-9);
            }
            let of_leaves = counted(
                &world,
                &LeafAreaRequest {
                    cells,
                    layers,
                    is_periodic,
                    surfaces: CountedSurfaces::Leaves,
                    by_material: false,
                    ..REQUEST
                },
            );
            assert_eq!(of_leaves.classes, ["leaf"]);
            let leaves = found.total(0)
                + found.total(1)
                + found.outside[0]
                + found.outside[1]
                + found.below[0]
                + found.below[1];
            let all = of_leaves.total(0) + of_leaves.outside[0] + of_leaves.below[0];
            assert!((all / leaves - 1.0).abs() < 1e-9, "{all} for {leaves}");
        }
    }
}

/// *Scene*: as above, on level ground, and on hills that repeat or end. *Expected*: each cell holds what brute force finds, which quarters all
/// triangles until they lie in one cell, and says how much area it could not decide on.
#[test]
fn each_cell_holds_what_brute_force_finds() {
    let hills = scene(HILLS, "Isolated").with_file("hills.asc", &hills());
    let scenes = [
        (scene(LEVEL, "Periodic"), true),
        (hills.clone(), false),
        (hills.with("boundary", "Periodic"), true),
    ];
    for (scene, is_periodic) in scenes {
        let world = scene.world();
        let found = counted(&world, &LeafAreaRequest { is_periodic, ..REQUEST });
        let (grid, placed) = (&found.grid, placed(&world, is_periodic));
        let mut brute = Brute::default();
        for triangle in placed.all {
            let depth = if area_of(&triangle.corners) > 1e-2 { 12 } else { 6 };
            brute.add(grid, triangle, depth);
        }
        // Materials in the order of the scene, behind the soil.
        let mut compared = 0;
        for layer in 0..grid.layers {
            for (row, column) in
                (0..grid.rows).flat_map(|row| (0..grid.columns).map(move |column| (row, column)))
            {
                for class in 0..3 {
                    let key = (column as i64, row as i64, layer as i64, class as u32 + 1);
                    let expected = brute.areas.get(&key).copied().unwrap_or(0.0);
                    let room =
                        brute.uncertain.get(&key).copied().unwrap_or(0.0) + placed.lacking + 1e-12;
                    let index = ((layer * grid.rows + row) * grid.columns + column) * 3 + class;
                    let value = found.areas[index];
                    assert!(
                        (value - expected).abs() <= room,
                        "{key:?}: {value} for {expected} ± {room}"
                    );
                    compared += usize::from(expected > 100.0 * room);
                }
            }
        }
        assert!(compared > 60, "{compared} cells are known to 1 %");
    }
}

/// *Scene*: a leaning forest on a slope. *Expected*: the same bits with one thread and with three.
#[test]
fn results_do_not_depend_on_threads() {
    let world = scene(LEVEL, "Periodic").world();
    let count = |threads: usize| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| counted(&world, &REQUEST))
    };
    let (one, three) = (count(1), count(3));
    let bits =
        |grid: &LeafAreaGrid| grid.areas.iter().map(|area| area.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&one), bits(&three));
}

/// *Scene*: one horizontal sheet that lies 2 m above each of four ramps of a slope. *Expected*: heights above the ground
/// put all of it into the layer from 1.9 to 2.1 m, absolute ones spread it.
#[test]
fn heights_follow_the_ground() {
    let mut dem = String::from("ncols 12\nnrows 12\nxllcorner 0\nyllcorner 0\ncellsize 1\n");
    for row in 0..12 {
        let heights: Vec<String> = (0..12)
            .map(|column| (0.5 * f64::from(column) + 0.1 * f64::from(row)).to_string())
            .collect();
        writeln!(dem, "{}", heights.join(" ")).expect("memory");
    }
    let mut numbers = Numbers(7);
    let leaves: Vec<String> = (0..200)
        .map(|_| {
            let (x, y) = (1.0 + 10.0 * numbers.next(), 1.0 + 10.0 * numbers.next());
            // The plane through the middles of cells; rows run from north to south.
            let z = 0.5 * (x - 0.5) + 0.1 * (11.5 - y);
            format!("({x}, {y}, {})", z + 2.0)
        })
        .collect();
    let world = SceneText::bare(0.2, "size_m: (1.0, 1.0)")
        .with("terrain", r#"Raster(file: "dem.asc", material: Some("soil"))"#)
        .with_file("dem.asc", &dem)
        .with_leaf(0.1, 0.1)
        .with_discs("leaf", "leaf", "0.05,0,0,0,0,0,1")
        .with("instances", format!(r#"List(of: "leaf", at_m: [{}])"#, leaves.join(", ")))
        .with("boundary", "Isolated")
        .world();
    let patch_heights: Vec<f64> =
        world.world.query::<&TerrainPatch>().iter().map(TerrainPatch::highest).collect();
    assert!(patch_heights[0] > 5.0);
    let request =
        LeafAreaRequest { layers: LayerCount::Thickness(0.2), is_periodic: false, ..REQUEST };
    let in_layers = |heights: HeightReference| {
        let found = counted(&world, &LeafAreaRequest { heights, ..request });
        let layers = found.layers_total();
        layers.iter().filter(|&&area| area > 0.0).count()
    };
    assert!(in_layers(HeightReference::Absolute) > 15);
    assert!(in_layers(HeightReference::Ground) <= 2, "one layer, or two beside its side");
}
