//! What each instance and each triangle absorbs, in the report and in the PLY.

use std::fs;
use std::path::Path;

use sunfleck::output;
use sunfleck::products::{Faces, Product, Report};
use sunfleck::run::{Options, Unwatched, run};
use sunfleck::transport::EnergyCounter;
use sunfleck_tests::{Estimate, SceneText, product};

/// Sixteen trees and a cloud of discs, of 77 000 values of triangles in two bands: more than a block
/// of packets holds as a whole.
fn grove(options: &Options, boundary: &str, plane: &str) -> Report {
    let discs = "0.5,0,0,1,0,0,1\n0.4,0,0,2,0.6,0,0.8\n";
    let at = r#"List(of: "tree", at_m: [
            (0.0, 3.0, 0.0), (2.0, 3.0, 0.0), (4.0, 3.0, 0.0), (6.0, 3.0, 0.0),
            (0.0, 5.0, 0.0), (2.0, 5.0, 0.0), (4.0, 5.0, 0.0), (6.0, 5.0, 0.0),
            (0.0, 7.0, 0.0), (2.0, 7.0, 0.0), (4.0, 7.0, 0.0), (6.0, 7.0, 0.0),
            (0.0, 9.0, 0.0), (2.0, 9.0, 0.0), (4.0, 9.0, 0.0), (6.0, 9.5, 0.0),
        ]), List(of: "discs", at_m: [(5.0, 8.0, 0.5)])"#;
    SceneText::trees_in_daylight(boundary)
        .with("frame", "origin_m: (600000.0, 5000000.0, 0.0)")
        .with("bands", r#"(name: "red", center_nm: 660.0), (name: "near infrared", center_nm: 865.0)"#)
        .with_discs("discs", "leaf", discs)
        .with("terrain", r#"Plane(size_m: (9.0, 8.0), corner_m: (-1.0, 2.0), material: "soil")"#)
        .with("instances", at)
        .with("sun", "zenith_deg: 50.0, azimuth_deg: 10.0, irradiance: Bands([1.5, 0.9])")
        .with("sensors", format!(r#""photons": Photons({plane} per_m2: 2000.0, measure: [Absorbed(per: Triangle), Fapar])"#))
        .measure_with(options)
}

fn faces(report: &Report) -> &Faces {
    product(report, "photons", "absorbed_by_triangle").faces.as_ref().expect("faces")
}

/// Sum of every second value from `band` on.
fn sum(values: &[f64], band: usize) -> f64 {
    values.iter().skip(band).step_by(2).sum()
}

fn near(one: f64, other: f64, tolerance: f64) -> bool {
    (one / other - 1.0).abs() < tolerance
}

/// *Scene*: the grove, with and without a virtual plane. *Expected*: instances sum to what the ledger
/// of energy and fAPAR say that materials absorb, to 1e-9; triangles times their areas sum to the
/// instances, to the rounding of f32; the mean over all is their sum over their area.
#[test]
fn instances_sum_to_the_absorbed_energy_and_triangles_to_instances() {
    let plane = "virtual_plane: (center_m: (2.0, 5.0), size_m: (3.0, 4.0), height_m: 2.0),";
    for (boundary, plane, area) in
        [("Periodic", "", 72.0), ("Isolated", "", 72.0), ("Periodic", plane, 12.0)]
    {
        let report = grove(&Options::default(), boundary, plane);
        let by_instance = product(&report, "photons", "absorbed_by_instance");
        assert_eq!(by_instance.unit, "W nm-1");
        let energy = product(&report, "photons", "energy");
        let fapar = product(&report, "photons", "fapar_material");
        let mean = product(&report, "photons", "absorbed_by_triangle");
        let faces = faces(&report);
        let areas: Vec<f64> = faces.inventory.faces().map(|face| face.area).collect();
        // Twelve square metres of leaves on each tree, discs of 0.5 and 0.4 m, and the ground.
        let surface: f64 = areas.iter().sum();
        let known = 72.0 + 16.0 * 12.0 + std::f64::consts::PI * 0.41;
        assert!(near(surface, known, 0.01), "{surface} m2, {known}");
        let starts = faces.inventory.starts();
        for (band, sun) in [1.5, 0.9].into_iter().enumerate() {
            let irradiance = sun * 50_f64.to_radians().cos();
            let all = sum(&by_instance.values, band);
            assert!(near(all, irradiance * area * sum(&fapar.values, band), 1e-9), "{all}");
            if plane.is_empty() {
                let absorbed = sum(&energy.values[2 * EnergyCounter::ABSORBED..], band);
                assert!(near(all, irradiance * area * absorbed, 1e-9), "{all}, {absorbed}");
            }
            assert!(near(mean.values[band] * surface, all, 1e-9));
            for (instance, range) in starts.windows(2).enumerate() {
                let parts: f64 = (range[0]..range[1])
                    .map(|face| f64::from(faces.values[2 * face + band]) * areas[face])
                    .sum();
                let whole = by_instance.values[2 * instance + band];
                assert!((parts - whole).abs() <= 1e-6 * whole, "{instance}: {parts} {whole}");
            }
        }
        let errors = &by_instance.standard_error;
        let small = |(error, value): (&f64, &f64)| *error < 0.2 * value;
        assert!(!plane.is_empty() || errors.iter().zip(&by_instance.values).all(small));
    }
}

/// *Scene*: the grove on one thread and on seven. *Expected*: the same bits.
#[test]
fn absorption_does_not_depend_on_threads() {
    let of = |threads| {
        let options = Options { threads: Some(threads), quality: 0.2, ..Options::default() };
        let report = grove(&options, "Periodic", "");
        let narrow = |values: &[f32]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
        let (values, errors) = (&faces(&report).values, &faces(&report).standard_error);
        let by_instance = product(&report, "photons", "absorbed_by_instance");
        let wide = by_instance.values.iter().chain(&by_instance.standard_error);
        (narrow(values), narrow(errors), wide.map(|v| v.to_bits()).collect::<Vec<_>>())
    };
    assert!(of(1) == of(7));
}

/// *Scene*: a Lambertian plain of reflectance 0.37, two triangles, under sun and sky. *Expected*: each
/// absorbs 0.63 of the irradiance, within four standard errors of less than 1 %.
#[test]
fn both_triangles_of_a_plain_absorb_what_they_do_not_reflect() {
    let report =
        SceneText::bare(0.37, "size_m: (10.0, 7.3), corner_m: (-3.1, 2.0), height_m: 12.7")
            .with("sun", "zenith_deg: 40.0, azimuth_deg: 200.0, irradiance: Constant(2.0)")
            .with("sky", "Fraction([0.25])")
            .with(
                "sensors",
                r#""photons": Photons(per_m2: 500.0, measure: [Absorbed(per: Triangle)])"#,
            )
            .measure();
    let truth = 0.63 * 2.0 * 40_f64.to_radians().cos();
    let faces = faces(&report);
    assert_eq!(faces.values.len(), 2);
    for (value, error) in faces.values.iter().zip(&faces.standard_error) {
        let one = Estimate { value: f64::from(*value), error: f64::from(*error) };
        assert!(one.z(truth).abs() < 4.0 && one.error < 0.01 * truth, "{one:?} {truth}");
        assert!(one.error > 0.0, "{one:?}");
    }
    let whole = Estimate::of(product(&report, "photons", "absorbed_by_instance"), 0);
    assert!(near(whole.value, truth * 73.0, 1e-6), "{whole:?}");
}

/// A PLY file: its comments, and of each element its name, the names of its numbers and its rows.
#[derive(Debug)]
struct Ply {
    comments: Vec<String>,
    elements: Vec<(String, Vec<String>, Vec<Vec<f64>>)>,
}

/// A strict reader of binary PLY; a list stands as its length and its numbers.
fn read_ply(bytes: &[u8]) -> Ply {
    let end = b"end_header\n";
    let header = bytes.windows(end.len()).position(|part| part == end).expect("a header");
    let text = std::str::from_utf8(&bytes[..header]).expect("text");
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("ply"));
    assert_eq!(lines.next(), Some("format binary_little_endian 1.0"));
    let (mut comments, mut layout) = (Vec::new(), Vec::<(String, usize, Vec<Vec<String>>)>::new());
    for line in lines {
        let words: Vec<String> = line.split(' ').map(str::to_owned).collect();
        match words[0].as_str() {
            "comment" => comments.push(words[1..].join(" ")),
            "element" => {
                layout.push((words[1].clone(), words[2].parse().expect("a count"), Vec::new()));
            }
            "property" => layout.last_mut().expect("an element").2.push(words[1..].to_vec()),
            other => panic!("{other}"),
        }
    }
    let mut rest = &bytes[header + end.len()..];
    let mut number = |kind: &str| {
        let size = if kind == "uchar" { 1 } else { 4 };
        let (first, others) = rest.split_at(size);
        rest = others;
        match kind {
            "uchar" => f64::from(first[0]),
            "int" => i32::from_le_bytes(first.try_into().expect("four bytes")).into(),
            "float" => f32::from_le_bytes(first.try_into().expect("four bytes")).into(),
            other => panic!("{other}"),
        }
    };
    let mut elements = Vec::new();
    for (name, count, properties) in layout {
        let mut rows = Vec::new();
        for _ in 0..count {
            let mut row = Vec::new();
            for property in &properties {
                if property[0] == "list" {
                    let length = number(&property[1]);
                    row.push(length);
                    row.extend((0..length as usize).map(|_| number(&property[2])));
                } else {
                    row.push(number(&property[0]));
                }
            }
            rows.push(row);
        }
        let names = properties.iter().map(|words| words.last().expect("a name").clone()).collect();
        elements.push((name, names, rows));
    }
    assert!(rest.is_empty(), "{} bytes too many", rest.len());
    Ply { comments, elements }
}

/// *Scene*: the grove, written to a folder. *Expected*: a PLY with a polygon for each face at its
/// place, its values bit by bit, the same colour on a face and its corners, dark where little is
/// absorbed and bright where much is; and a table of instances.
#[test]
fn a_ply_holds_every_face_with_its_values_and_colour() {
    let report = grove(&Options { quality: 0.2, ..Options::default() }, "Periodic", "");
    let dir = tempfile::tempdir().expect("a temporary folder");
    output::write(&report, dir.path()).expect("files");
    let bytes = fs::read(dir.path().join("photons_absorbed_by_triangle.ply")).expect("a PLY");
    let Ply { comments, elements } = read_ply(&bytes);
    let says = |text: &str| comments.iter().any(|comment| comment.starts_with(text));
    assert!(says("origin_m: 600000.0 5000000.0") && says("unit: W m-2 nm-1"), "{comments:?}");
    let [(vertex, of_vertex, corners), (face, of_face, polygons)] = &elements[..] else {
        panic!("two elements");
    };
    assert_eq!((vertex.as_str(), face.as_str()), ("vertex", "face"));
    assert_eq!(of_vertex[..], ["x", "y", "z", "red", "green", "blue"]);
    let bands =
        ["absorbed_red", "se_red", "absorbed_near_infrared", "se_near_infrared"].map(str::to_owned);
    assert_eq!(of_face[..4], ["vertex_indices", "red", "green", "blue"]);
    assert_eq!(of_face[4..], bands);
    let faces = faces(&report);
    assert_eq!(polygons.len(), faces.inventory.faces().count());
    assert_eq!(polygons.len(), 2 + 16 * 2400 + 2, "ground, leaves of two triangles, discs");
    let (mut brightness, mut octagons) = (Vec::new(), 0);
    for (index, (polygon, known)) in polygons.iter().zip(faces.inventory.faces()).enumerate() {
        let count = polygon[0] as usize;
        assert_eq!(count, known.corners.len());
        octagons += usize::from(count == 8);
        let (indices, rest) = polygon[1..].split_at(count);
        for (corner, place) in indices.iter().zip(&known.corners) {
            let row = &corners[*corner as usize];
            let off = (0..3).map(|axis| (row[axis] - place[axis]).abs()).fold(0.0, f64::max);
            assert!(off < 1e-6 && row[3..] == rest[..3], "{index}: {row:?} {place}");
        }
        for band in 0..2 {
            let values = (faces.values[2 * index + band], faces.standard_error[2 * index + band]);
            assert_eq!(
                (rest[3 + 2 * band], rest[4 + 2 * band]),
                (values.0.into(), values.1.into())
            );
        }
        // Rec. 709 luma rises along viridis.
        let luma = 0.2126 * rest[0] + 0.7152 * rest[1] + 0.0722 * rest[2];
        brightness.push((rest[3] + rest[5], luma));
    }
    assert_eq!(octagons, 2);
    brightness.sort_by(|a, b| a.0.total_cmp(&b.0));
    assert!(brightness.windows(2).all(|pair| pair[1].1 >= pair[0].1 - 1.0), "brighter is more");
    assert!(brightness[0].1 < 30.0 && brightness[brightness.len() - 1].1 > 200.0);
    let table =
        fs::read_to_string(dir.path().join("photons_absorbed_by_instance.csv")).expect("a table");
    let lines: Vec<&str> = table.lines().filter(|line| !line.starts_with('#')).collect();
    assert_eq!(lines[0], "instance,x_m,y_m,z_m,red,red_se,near infrared,near infrared_se");
    assert!(lines[1].starts_with("terrain,-1.0,2.0,0.0,"), "{}", lines[1]);
    assert!(lines[17].starts_with("tree[15],6.0,9.5,0.0,"), "{}", lines[17]);
    assert!(lines[18].starts_with("discs[0],5.0,8.0,0.5,"), "{}", lines[18]);
}

/// *Scene*: 26 million triangles in two bands. *Expected*: an error with the numbers; instances are
/// few enough.
#[test]
fn more_than_memory_holds_is_refused_with_numbers() {
    let run = |per: &str| -> Result<Vec<Product>, String> {
        let measure = format!("measure: [Absorbed(per: {per})]");
        let reading = SceneText::two_trees()
            .with("materials", r#""leaf": Lambertian(reflectance: Constant(0.2))"#)
            .with("terrain", r#"Plane(size_m: (100.0, 110.0), material: "leaf")"#)
            .with("instances", r#"Scatter(of: { "tree": 1.0 }, rule: Grid(spacing_m: (1.0, 1.0)))"#)
            .with("sun", "zenith_deg: 50.0, irradiance: Constant(1.0)")
            .with("sensors", format!(r#""photons": Photons(per_m2: 0.01, {measure})"#))
            .read();
        match run(&reading.scene, Path::new("."), &Options::default(), &Unwatched) {
            Ok(report) => Ok(report.sensors[0].products.clone()),
            Err(failure) => Err(failure.with_source(&reading.source).to_string()),
        }
    };
    let error = run("Triangle").expect_err("too many");
    let what = "absorption by 26400002 triangles in 2 bands takes 3.1 GiB; at most 2 are allowed";
    assert!(error.contains(what), "{error}");
    assert!(error.contains("measure `Absorbed(per: Instance)`"), "{error}");
    assert!(error.contains("test.ron:9"), "{error}");
    let products = run("Instance").expect("a report");
    assert_eq!(products[0].values.len(), 2 * 11_001);
}
