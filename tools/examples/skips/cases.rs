//! Scenes in which something can be skipped, and the same scenes in which it cannot.

#![expect(
    clippy::unnecessary_wraps,
    reason = "cases that write files can fail, and all have one type"
)]

use std::fmt::Write as _;
use std::path::Path;

use super::numbers::Same;

/// A skip.
pub(crate) struct Case {
    /// What is skipped.
    pub(crate) name: &'static str,
    /// How the scene is made to do without the skip.
    pub(crate) how: &'static str,
    /// What that does to the results.
    pub(crate) same: Same,
    /// Products whose results are compared; all if empty.
    pub(crate) products: &'static [&'static str],
    /// The scene.
    pub(crate) scene: fn(&Setting<'_>) -> anyhow::Result<String>,
}

/// How a scene is to be.
pub(crate) struct Setting<'a> {
    /// Whether things are skipped in it.
    pub(crate) skips: bool,
    /// How large it is: 1 for the table.
    pub(crate) share: f64,
    /// Where the files go that it needs.
    pub(crate) folder: &'a Path,
}

pub(crate) const CASES: &[Case] = &[
    Case {
        name: "meshes of which nothing stands",
        how: "each of eight crowns of 200 000 leaves stands once, below the ground, where no light comes",
        same: Same::Bits,
        products: &[],
        scene: unused_meshes,
    },
    Case {
        name: "materials and spectra that nothing wears",
        how: "each of 300 leaf materials by PROSPECT is worn by a triangle below the ground",
        same: Same::Bits,
        products: &[],
        scene: unused_materials,
    },
    Case {
        name: "bands that are not asked for",
        how: "200 bands in place of 2; paths choose reflection or transmission by all bands together, \
              so they are others",
        same: Same::Errors(5.0),
        products: &[],
        scene: bands,
    },
    Case {
        name: "light scattered more than once",
        how: "`Orders` splits off the first order of all, in place of `first_order_only: true`",
        same: Same::Bits,
        products: &["brf_uc", "brf_co_sgl"],
        scene: first_order,
    },
    Case {
        name: "transmission of an opaque scene",
        how: "leaves transmit 1e-30, so that paths weigh transmission and shadow rays start on both sides",
        same: Same::Bits,
        products: &[],
        scene: opaque,
    },
    Case {
        name: "shadow rays and paths of zero weight",
        how: "soil and bark reflect 1e-30 in place of 0",
        same: Same::Bits,
        products: &[],
        scene: black,
    },
    Case {
        name: "a sky that does not shine, first order",
        how: "a sky of an irradiance of 1e-30, which rays look for",
        same: Same::Bits,
        products: &[],
        scene: no_sky_first_order,
    },
    Case {
        name: "a sky that does not shine, all orders",
        how: "a sky of an irradiance of 1e-30, for whose light paths that were scattered once go on longer, so that they are others",
        same: Same::Errors(5.0),
        products: &[],
        scene: no_sky,
    },
    Case {
        name: "the tree over instances where there is one",
        how: "under the hills, which are one mesh, lies a triangle that no ray meets; of one instance alone the \
              tree is that instance, and no code of its own is needed for it",
        same: Same::Bits,
        products: &[],
        scene: one_object,
    },
    Case {
        name: "cells of terrain within its tolerance",
        how: "`tolerance_m: 0.0` in place of 0.05 on 1000 by 1000 cells of 1 m",
        same: Same::Errors(5.0),
        products: &[],
        scene: terrain,
    },
    Case {
        name: "products that are not asked for",
        how: "BRF in 300 cells, layers, flux maps and what each leaf absorbs, counted beside the albedo",
        same: Same::Bits,
        products: &["albedo"],
        scene: products,
    },
    Case {
        name: "samples beyond the accuracy asked for",
        how: "`until: Samples(32768)` in place of `RelError(0.01)`",
        same: Same::Errors(5.0),
        products: &[],
        scene: accuracy,
    },
];

/// Forty trees on 20 m by 20 m, periodic, and what a case changes about them.
struct Stand<'a> {
    bands: &'a str,
    soil: &'a str,
    leaf: &'a str,
    materials: &'a str,
    meshes: &'a str,
    terrain: &'a str,
    instances: &'a str,
    keys: &'a str,
    sensors: &'a str,
}

const STAND: Stand<'_> = Stand {
    bands: "",
    soil: "Lambertian(reflectance: Constant(0.2))",
    leaf: "Leaf(reflectance: Prospect(), transmittance: Prospect())",
    materials: "",
    meshes: "",
    terrain: r#"Plane(size_m: (20.0, 20.0), material: "soil")"#,
    instances: r#"Scatter(of: { "tree": 1.0 }, rule: PoissonDisc(min_distance_m: 1.5), stems: Count(40)),"#,
    keys: "",
    sensors: r#""views": Directions(
        system: Backward, views: PrincipalPlane(max_deg: 60.0, step_deg: 20.0), until: Samples(32768),
    ),"#,
};

impl Stand<'_> {
    fn text(&self) -> String {
        let Self { bands, soil, leaf, materials, meshes, terrain, instances, keys, sensors } = self;
        format!(
            r#"Scene(
    format: 1,
    bands: [(name: "red", center_nm: 660.0), (name: "nir", center_nm: 865.0), {bands}],
    materials: {{ "soil": {soil}, "leaf": {leaf}, {materials} }},
    meshes: {{
        "tree": Crown(
            shape: Ellipsoid(diameter_m: 2.5, height_m: 4.0), base_m: 1.0, leaf_area_m2: 20.0,
            leaf: Disc(radius_m: 0.03), leaf_material: "leaf",
            trunk: (height_m: 4.0, diameter_m: 0.2), wood_material: "soil",
        ),
        {meshes}
    }},
    terrain: {terrain},
    instances: [{instances}],
    sun: (zenith_deg: 35.0, azimuth_deg: 120.0, irradiance: Constant(1.0)),
    boundary: Periodic,
    {keys}
    sensors: {{ {sensors} }},
)"#
        )
    }
}

/// Below all ground.
const BELOW: &str = "at_m: [(10.0, 10.0, -50.0)]";
const TRIANGLE: &str = "[[(0.0, 0.0, 0.0), (0.1, 0.0, 0.0), (0.0, 0.1, 0.0)]]";

/// Sensors that are done soon, where loading is what counts.
fn briefly() -> String {
    STAND.sensors.replace("32768", "2048")
}

fn unused_meshes(Setting { skips, share, .. }: &Setting<'_>) -> anyhow::Result<String> {
    let (mut meshes, mut instances) = (String::new(), STAND.instances.to_owned());
    let area = 62.8 * share;
    for number in 0..8 {
        write!(
            meshes,
            r#""{number}": Crown(
                shape: Box(size_m: (5.0, 5.0, 5.0)), base_m: 0.0, leaf_area_m2: {area:?},
                leaf: Disc(radius_m: 0.01), leaf_material: "leaf", seed: {number},
            ),"#
        )?;
        if !*skips {
            write!(instances, r#"List(of: "{number}", {BELOW}),"#)?;
        }
    }
    let sensors = &briefly();
    Ok(Stand { meshes: &meshes, instances: &instances, sensors, ..STAND }.text())
}

fn unused_materials(Setting { skips, share, .. }: &Setting<'_>) -> anyhow::Result<String> {
    let (mut materials, mut meshes) = (String::new(), String::new());
    let mut instances = STAND.instances.to_owned();
    for number in 0..(300.0 * share) as u32 {
        let prospect =
            format!("Prospect(chlorophyll_ug_cm2: {:?})", 20.0 + 0.1 * f64::from(number));
        write!(
            materials,
            r#""{number}": Leaf(reflectance: {prospect}, transmittance: {prospect}),"#
        )?;
        if !*skips {
            write!(meshes, r#""{number}": Faces(faces_m: {TRIANGLE}, material: "{number}"),"#)?;
            write!(instances, r#"List(of: "{number}", {BELOW}),"#)?;
        }
    }
    let (materials, meshes, instances) = (&materials, &meshes, &instances);
    Ok(Stand { materials, meshes, instances, sensors: &briefly(), ..STAND }.text())
}

fn bands(Setting { skips, .. }: &Setting<'_>) -> anyhow::Result<String> {
    let mut bands = String::new();
    for number in 0..if *skips { 0 } else { 198 } {
        let nm = 410.0 + 10.0 * f64::from(number);
        write!(bands, r#"(name: "{number}", center_nm: {nm:?}, width_nm: 10.0),"#)?;
    }
    Ok(Stand { bands: &bands, ..STAND }.text())
}

fn first_order(Setting { skips, .. }: &Setting<'_>) -> anyhow::Result<String> {
    let keys = if *skips { "transport: (first_order_only: true)," } else { "" };
    let sensors = STAND.sensors.replace("until", "measure: [Orders], until");
    Ok(Stand { keys, sensors: &sensors, ..STAND }.text())
}

fn opaque(Setting { skips, .. }: &Setting<'_>) -> anyhow::Result<String> {
    let transmittance = if *skips { "0.0" } else { "1e-30" };
    let leaf = format!("Leaf(reflectance: Prospect(), transmittance: Constant({transmittance}))");
    Ok(Stand { leaf: &leaf, ..STAND }.text())
}

fn black(Setting { skips, .. }: &Setting<'_>) -> anyhow::Result<String> {
    let reflectance = if *skips { "0.0" } else { "1e-30" };
    let soil = format!("Lambertian(reflectance: Constant({reflectance}))");
    Ok(Stand { soil: &soil, ..STAND }.text())
}

/// A sky that shines so little that it changes no bit.
const FAINT: &str = "sky: Isotropic(irradiance: Constant(1e-30)),";

fn no_sky(Setting { skips, .. }: &Setting<'_>) -> anyhow::Result<String> {
    Ok(Stand { keys: if *skips { "" } else { FAINT }, ..STAND }.text())
}

fn no_sky_first_order(Setting { skips, .. }: &Setting<'_>) -> anyhow::Result<String> {
    let first = "transport: (first_order_only: true),";
    let keys = if *skips { first.to_owned() } else { format!("{first} {FAINT}") };
    Ok(Stand { keys: &keys, ..STAND }.text())
}

/// Height of the hills, m, which repeat after so many metres.
fn hills(x: f64, y: f64, period: f64) -> f64 {
    let turn = std::f64::consts::TAU / period;
    0.05 * period * ((turn * x).sin() + (3.0 * turn * y).cos() * (2.0 * turn * x).sin())
}

fn one_object(Setting { skips, .. }: &Setting<'_>) -> anyhow::Result<String> {
    let cells = 64;
    let at = |column: u32, row: u32| {
        let side = 20.0 / f64::from(cells);
        let (x, y) = (side * f64::from(column), side * f64::from(row));
        // Opposite sides are to match to the last bit.
        let z = hills(side * f64::from(column % cells), side * f64::from(row % cells), 20.0);
        format!("({x:?}, {y:?}, {z:?})")
    };
    let mut faces = String::new();
    for column in 0..cells {
        for row in 0..cells {
            let [a, b] = [at(column, row), at(column + 1, row)];
            let [c, d] = [at(column + 1, row + 1), at(column, row + 1)];
            write!(faces, "[{a}, {b}, {c}], [{a}, {c}, {d}],")?;
        }
    }
    let meshes = format!(
        r#""hills": Faces(faces_m: [{faces}], material: "soil"),
        "stone": Faces(faces_m: {TRIANGLE}, material: "soil"),"#
    );
    let stone = format!(r#"List(of: "stone", {BELOW})"#);
    let instances = if *skips { "" } else { &stone };
    let terrain = r#"Mesh(mesh: "hills")"#;
    let sensors = STAND.sensors.replace("32768", "131072");
    Ok(Stand { meshes: &meshes, terrain, instances, sensors: &sensors, ..STAND }.text())
}

fn terrain(Setting { skips, share, folder }: &Setting<'_>) -> anyhow::Result<String> {
    let cells = (1000.0 * share.sqrt()) as u32;
    let mut grid = format!("ncols {cells}\nnrows {cells}\nxllcorner 0\nyllcorner 0\ncellsize 1\n");
    for row in 0..cells {
        for column in 0..cells {
            let [x, y] = [column, row].map(|cell| f64::from(cell) + 0.5);
            let height = hills(x, y, 1000.0) + 0.2 * hills(x, y, 100.0);
            write!(grid, "{height:.4} ")?;
        }
        grid.push('\n');
    }
    std::fs::write(folder.join("hills.asc"), grid)?;
    let tolerance = if *skips { "0.05" } else { "0.0" };
    let terrain =
        format!(r#"Raster(file: "hills.asc", material: "soil", tolerance_m: {tolerance})"#);
    Ok(Stand { terrain: &terrain, instances: "", ..STAND }.text())
}

fn products(Setting { skips, .. }: &Setting<'_>) -> anyhow::Result<String> {
    let more = if *skips {
        ""
    } else {
        ", BrfCells(300), Fapar(layer_m: 0.5), Fluxes(pixel_m: 0.5), Absorbed(per: Triangle)"
    };
    let sensors = format!(r#""photons": Photons(per_m2: 1000.0, measure: [Albedo{more}]),"#);
    Ok(Stand { sensors: &sensors, ..STAND }.text())
}

fn accuracy(Setting { skips, .. }: &Setting<'_>) -> anyhow::Result<String> {
    let until = if *skips { "RelError(0.01)" } else { "Samples(32768)" };
    let sensors = STAND.sensors.replace("Samples(32768)", until);
    Ok(Stand { sensors: &sensors, ..STAND }.text())
}
