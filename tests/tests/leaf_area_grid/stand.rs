//! A stand of discs and triangles under all transforms.

use std::fmt::Write as _;

use sunfleck_tests::SceneText;

/// Uniform numbers from 0 to 1 of a linear congruential generator.
pub(crate) struct Numbers(pub(crate) u64);

impl Numbers {
    pub(crate) fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Discs and triangles in three materials, tilted, turned, unequally scaled, over the sides of the rectangle.
pub(crate) fn scene(terrain: &str, boundary: &str) -> SceneText {
    let mut numbers = Numbers(1);
    let (mut discs, mut obj, mut stems) = (
        String::new(),
        String::new(),
        String::from("x_m,y_m,z_m,yaw_deg,scale,scale_vertical,tilt_deg,tilt_azimuth_deg\n"),
    );
    let mut line = |text: &mut String, columns: usize, scales: &[f64]| {
        let values: Vec<String> = (0..columns)
            .map(|column| {
                let scale = scales[column % scales.len()];
                if scale < 0.0 {
                    (-scale * (2.0 * numbers.next() - 1.0)).to_string()
                } else {
                    (scale * (0.2 + 0.8 * numbers.next())).to_string()
                }
            })
            .collect();
        values.join(",").chars().for_each(|letter| text.push(letter));
    };
    for _ in 0..25 {
        line(&mut discs, 7, &[0.4, -0.8, -0.8, 2.5, -1.0, -1.0, -1.0]);
        discs.push('\n');
    }
    // A horizontal, a vertical and an oblique disc along the axes.
    discs.push_str("0.3,0,0,1,0,0,1\n0.3,0.1,0,1.5,1,0,0\n0.3,0,0.1,2,0,0.6,0.8\n");
    for corner in 0..60 {
        if corner % 3 == 0 {
            writeln!(obj, "g {}", if corner < 30 { "green" } else { "wood" }).expect("memory");
        }
        let mut row = String::new();
        line(&mut row, 3, &[-0.7, -0.7, 3.0]);
        writeln!(obj, "v {}", row.replace(',', " ")).expect("memory");
        if corner % 3 == 2 {
            writeln!(obj, "f {} {} {}", corner - 1, corner, corner + 1).expect("memory");
        }
    }
    for stem in 0..24 {
        let tilt = if stem % 2 == 0 { 0.0 } else { 25.0 };
        let mut row = String::new();
        line(&mut row, 8, &[6.0, 5.0, 0.3, 360.0, 1.2, 1.5, 1.0, 360.0]);
        let mut cells: Vec<String> = row.split(',').map(str::to_owned).collect();
        for (cell, corner) in cells.iter_mut().zip([100.0, -20.0, 3.0]) {
            let place: f64 = cell.parse().expect("a number");
            *cell = (place + corner).to_string();
        }
        cells[6] = tilt.to_string();
        if stem % 3 == 0 {
            let scale = cells[4].clone();
            cells[5] = scale;
        }
        writeln!(stems, "{}", cells.join(",")).expect("memory");
    }
    SceneText::bare(0.2, "size_m: (6.0, 5.0)")
        .with("terrain", terrain)
        .with_leaf(0.1, 0.1)
        .with_more("materials", r#""red leaf": Leaf(reflectance: Constant(0.3), transmittance: Constant(0.1)), "bark": Lambertian(reflectance: Constant(0.2))"#)
        .with_discs("discs", "leaf", &discs)
        .with_more("meshes", r#""faces": Obj(file: "faces.obj", up: Z, unit_m: 1.0, parts: { "green": "red leaf", "wood": "bark" })"#)
        .with_file("faces.obj", &obj)
        .with("instances", r#"Table(file: "stems.csv", of: "discs"), Table(file: "stems.csv", of: "faces")"#)
        .with_file("stems.csv", &stems)
        .with("boundary", boundary)
}

pub(crate) const LEVEL: &str =
    r#"Plane(size_m: (6.0, 5.0), corner_m: (100.0, -20.0), height_m: 3.0, material: "soil")"#;

pub(crate) const HILLS: &str = r#"Raster(file: "hills.asc", material: "soil")"#;

/// Raster of ground that rises and falls by some metres, about as high as [`LEVEL`].
pub(crate) fn hills() -> String {
    let mut raster =
        String::from("ncols 12\nnrows 10\nxllcorner 100\nyllcorner -20\ncellsize 0.5\n");
    for (row, column) in (0..10).flat_map(|row| (0..12).map(move |column| (row, column))) {
        let (x, y) = (f64::from(column) * 0.5, f64::from(row) * 0.5);
        writeln!(raster, "{}", 2.0 + (1.1 * x).sin() + 0.7 * (1.7 * y + 0.5 * x).cos())
            .expect("memory");
    }
    raster
}
