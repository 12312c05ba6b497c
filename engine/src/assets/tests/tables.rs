use std::f64::consts::PI;

use glam::{DVec3, Vec3};

use super::*;
use crate::assets::{
    SpectrumColumns, SpectrumTable, StemRow, read_discs, read_instances, read_spectrum,
};
use crate::components::Disc;
use crate::document::WavelengthUnit;

fn discs(text: &str) -> Result<Vec<Disc>, AssetError> {
    let loaded = read_discs(file(text).path())?;
    assert_lawful(&loaded.value);
    assert_eq!(part_names(&loaded.value), ["discs"]);
    Ok(loaded.value.discs)
}

fn instances(text: &str) -> Result<Vec<StemRow>, AssetError> {
    let mut table = read_instances(file(text).path(), None)?;
    // Lines have tests of their own.
    table.rows.iter_mut().for_each(|row| row.line = 0);
    Ok(table.rows)
}

fn columns<'a>(wavelength: &'a str, value: Option<&'a str>) -> SpectrumColumns<'a> {
    SpectrumColumns { wavelength: Some(wavelength), value, ..SpectrumColumns::default() }
}

fn points(table: &SpectrumTable) -> Vec<(f64, f64)> {
    table.points.iter().map(|point| (point.wavelength, point.value)).collect()
}

fn spectrum(text: &str) -> Result<Vec<(f64, f64)>, AssetError> {
    let table = read_spectrum(file(text).path(), &columns("wavelength_nm", None))?;
    Ok(points(&table))
}

const ROW: StemRow = StemRow {
    position: DVec3::new(1.0, 2.0, 0.0),
    yaw: 0.0,
    tilt: 0.0,
    tilt_azimuth: 0.0,
    scale_horizontal: 1.0,
    scale_vertical: 1.0,
    height: None,
    diameter: None,
    species: None,
    line: 0,
};

#[test]
fn discs_are_read_by_header_or_from_rami_text() {
    let disc = Disc { center: Vec3::new(1.0, 2.0, 3.0), normal: Vec3::Z, radius: 0.1 };
    for text in [
        "radius,x,y,z,nx,ny,nz\n0.1,1,2,3,0,0,1\n",
        "\u{feff}# made by hand\r\nnz; ny; nx; z; y; x; radius\r\n\r\n2; 0; 0; 3; 2; 1; .1\r\n",
        "\"radius\"\t\"x\"\t\"y\"\t\"z\"\t\"nx\"\t\"ny\"\t\"nz\"\n0.1\t1\t2\t3\t0\t0\t1e-200\n",
        "  0.1  1 2 3  0 0 1e200",
        "4 0.1 1 2 3 0 0 1\n",
        "0.1,1,2,3,0,0,1\n",
    ] {
        assert_eq!(discs(text).unwrap(), [disc], "{text}");
    }
}

#[test]
fn bad_discs_are_errors_with_their_line() {
    let header = "radius,x,y,z,nx,ny,nz\n";
    for (row, expected) in [
        ("0.1,1,2,3,0,0,0\n", ":2: the normal is zero; write a direction"),
        ("0,1,2,3,0,0,1\n", ":2: the radius is 0; write a number above 0"),
        ("-0.1,1,2,3,0,0,1\n", ":2: the radius is -0.1; write a number above 0"),
        ("0.1,1,2,3,0,0\n", ":2: has 6 values for 7 columns"),
        ("0.1,1,2,3,0,0,1,5\n", ":2: has 8 values for 7 columns"),
        (
            "0.1,1,2,3,0,0,1\n\n0.1,nan,2,3,0,0,1\n",
            ":4: column \"x\" is \"nan\"; write a finite number such as 1.5 or 2e-3",
        ),
        (
            "0.1,1e300,2,3,0,0,1\n",
            ":2: coordinate 1e300 m is too large to keep; check the file and the length of its unit",
        ),
        ("", ": holds no rows"),
    ] {
        let error = discs(&format!("{header}{row}")).unwrap_err();
        assert_eq!(message(&error), expected, "{row}");
    }
    let error = discs("radius,x,y,z,nx,ny\n").unwrap_err();
    assert!(message(&error).starts_with(":1: column \"nz\" is missing among"), "{error}");
    let error = discs("radius,x,y,z,nx,ny,nz,layer\n").unwrap_err();
    assert!(matches!(error, AssetError::UnknownColumn { .. }), "{error}");
}

#[test]
fn instances_are_read_by_header_in_any_order_and_by_any_separator() {
    for text in [
        "x_m,y_m\n1,2\n",
        "y_m;x_m\n2;1\n",
        "x_m\ty_m\n1\t2\n",
        "# stand\nx_m   y_m\n  1 2\n",
        "x_m,y_m,,\n1,2,,\n",
    ] {
        assert_eq!(instances(text).unwrap(), [ROW], "{text}");
    }
    let all = "scale_vertical,scale,tilt_azimuth_deg,tilt_deg,yaw_deg,z_m,y_m,x_m\n\
               3,2,90,45,180,5,2,1\n";
    let full = StemRow {
        position: DVec3::new(1.0, 2.0, 5.0),
        yaw: PI,
        tilt: PI / 4.0,
        tilt_azimuth: PI / 2.0,
        scale_horizontal: 2.0,
        scale_vertical: 3.0,
        ..ROW
    };
    assert_eq!(instances(all).unwrap(), [full]);
    let rows = instances("x_m,y_m,scale,yaw_rad\n1,2,2,1.5\n1,2,0.5,0\n").unwrap();
    assert_eq!(rows[0], StemRow { scale_horizontal: 2.0, scale_vertical: 2.0, yaw: 1.5, ..ROW });
    assert_eq!(rows[1], StemRow { scale_horizontal: 0.5, scale_vertical: 0.5, ..ROW });
}

#[test]
fn the_scene_may_name_the_columns_of_a_table_without_header() {
    let names = ["x_m", "y_m", "yaw_rad"].map(str::to_owned);
    let rows = read_instances(file("1 2 0.5\n1 2 0\n").path(), Some(&names)).unwrap().rows;
    assert_eq!(rows, [StemRow { yaw: 0.5, line: 1, ..ROW }, StemRow { line: 2, ..ROW }]);
    // A header of other names is replaced.
    let rows = read_instances(file("X Y R\n1 2 0.5\n").path(), Some(&names)).unwrap().rows;
    assert_eq!(rows, [StemRow { yaw: 0.5, line: 2, ..ROW }]);
    let error = read_instances(file("y_m x_m R\n1 2 0.5\n").path(), Some(&names)).unwrap_err();
    assert!(
        message(&error).contains("\"y_m\" which `columns` in the scene calls \"x_m\""),
        "{error}"
    );
    let error = instances("1 2 0.5\n").unwrap_err();
    assert!(message(&error).starts_with(":1: has no header above it; write the names"), "{error}");
}

#[test]
fn bad_instances_are_errors_with_their_line_and_the_nearest_name() {
    for (text, expected) in [
        ("x_m,y_m,scale\n1,2,0\n", ":2: scale is 0; write a number above 0"),
        ("x_m,y_m,scale_vertical\n1,2,-1\n", ":2: scale_vertical is -1; write a number above 0"),
        (
            "x_m,z_m\n1,2\n",
            ":1: column \"y_m\" is missing among [\"x_m\", \"z_m\"]; add it, or list the names of all columns \
             under `columns` in the scene",
        ),
        ("x_m,y_m\n1,2\n1\n", ":3: has 1 value for 2 columns"),
        ("x_m,y_m,x_m\n1,2,3\n", ":1: columns \"x_m\" and \"x_m\" say the same; keep one"),
        (
            "x_m,y_m,yaw_deg,yaw_rad\n1,2,3,4\n",
            ":1: columns \"yaw_deg\" and \"yaw_rad\" say the same; keep one",
        ),
        (
            "x_m,y_m\n\"1,5\",2\n",
            ":2: column \"x_m\" is \"1,5\"; write `1.5` if that is its decimal comma, or save the table \
             with `;` between its columns",
        ),
        ("x_m,y_m,height_m\n1,2,0\n", ":2: height_m is 0; write a number above 0"),
        (
            "x_m,y_m,height_m,scale\n1,2,3,4\n",
            ":1: columns \"scale\" and \"height_m\" say the same; keep one",
        ),
        ("x_m,y_m\n", ": holds no rows"),
        ("# nothing\n", ": holds no rows"),
    ] {
        assert_eq!(message(&instances(text).unwrap_err()), expected, "{text}");
    }
    let error = instances("X,Y\n1,2\n").unwrap_err();
    let expected =
        "if \"X\" and \"Y\" are those in metres, write \"x_m\" and \"y_m\" in their place";
    assert!(message(&error).contains(expected), "{error}");
}

#[test]
fn columns_of_inventories_are_let_be_and_those_of_size_and_species_are_read() {
    let text = "tree_id;x_m;y_m;species;dbh_cm;height_m;crown_diameter_m;yaw\n\
                1;10,5;20;oak;30;20;6;1\n2;1;2;birch;8;9,5;2;1\n3;1;2;oak;8;9;2;1\n;;;;;;;\n";
    let table = read_instances(file(text).path(), None).unwrap();
    let [first, second, third] = table.rows.as_slice() else { panic!("three rows") };
    assert_eq!((first.position.x, first.height, first.diameter), (10.5, Some(20.0), Some(6.0)));
    assert_eq!((second.height, second.species, second.line), (Some(9.5), Some(1), 3));
    assert_eq!((first.species, third.species), (Some(0), Some(0)));
    assert_eq!(table.species, ["oak", "birch"]);
    assert!(table.diameter_is_of_crown);
    assert_eq!(table.left_out, ["tree_id", "dbh_cm", "yaw"]);
    assert_eq!(table.misspelt, [("yaw".to_owned(), "yaw_deg")]);
}

#[test]
fn spectra_are_read_by_the_names_of_their_columns() {
    let expected = [(400.0, 0.1), (500.0, 0.2)];
    assert_eq!(spectrum("wavelength_nm,value\n400,0.1\n500,0.2\n").unwrap(), expected);
    assert_eq!(spectrum("wavelength_nm\tr\tnote\n500\t0.2\tx\n400\t.1\ty\n").unwrap(), expected);
    let titled = "Soil 7, dry,,\nmeasured at noon\nwavelength_nm\tvalue\n400\t0.1\n500\t0.2\n";
    assert_eq!(spectrum(titled).unwrap(), expected);
    let titled = "2000 ASTM Standard\nwavelength_nm value\n400 0.1\n500 0.2\n";
    assert_eq!(spectrum(titled).unwrap(), expected);
    let text = file("name,dry,nm,wet\na,.1,400,9\nb,.2,500,9\n");
    for value in [Some("dry"), None] {
        let table = read_spectrum(text.path(), &columns("nm", value)).unwrap();
        assert_eq!(points(&table), expected);
        assert_eq!(table.points[1].line, 3);
    }
}

#[test]
fn units_of_wavelengths_are_turned_into_nanometres() {
    for (unit, text) in [
        (WavelengthUnit::Micrometres, "w,v\n0.4,0.1\n0.5,0.2\n"),
        (WavelengthUnit::Angstroms, "w,v\n4000,0.1\n5000,0.2\n"),
        (WavelengthUnit::Wavenumbers, "w,v\n20000,0.2\n25000,0.1\n"),
    ] {
        let columns = SpectrumColumns { unit: Some(unit), ..columns("w", None) };
        let table = read_spectrum(file(text).path(), &columns).unwrap();
        assert_eq!(points(&table), [(400.0, 0.1), (500.0, 0.2)], "{unit:?}");
    }
}

#[test]
fn bad_spectra_are_errors() {
    for (text, expected) in [
        (
            "400,0.1\n",
            ":1: has no header above it; write the names of its columns there: \
             `wavelength_nm,value`",
        ),
        (
            "wavelength_nm,v\n400,1\n500,1\n450,1\n",
            ":4: wavelength 450 follows 500; sort the rows by wavelength, each once",
        ),
        (
            "wavelength_nm,v\n400,1\n400,1\n",
            ":3: wavelength 400 follows 400; sort the rows by wavelength, each once",
        ),
        ("wavelength_nm,v\n0,1\n1,1\n", ":2: the wavelength is 0; write a number above 0"),
        ("wavelength_nm,v\n400,1\n", ": holds one wavelength; a spectrum needs two or more"),
        (
            "wavelength_nm\n400\n",
            ":1: column \"value\" is missing among [\"wavelength_nm\"]; add it",
        ),
        (
            "value,wavelength_nm\n400,1\n",
            ":1: columns \"wavelength_nm\" and \"wavelength_nm\" say the same; keep one",
        ),
        (
            "nm,value\n400,1\n",
            ":1: there is no column \"wavelength_nm\" among [\"nm\", \"value\"]; if \"nm\" is meant, \
             write `wavelength: \"nm\"` in the scene; titles may stand above a header, not in its place",
        ),
    ] {
        assert_eq!(message(&spectrum(text).unwrap_err()), expected, "{text}");
    }
}

#[test]
fn the_spectra_of_the_example_scenes_are_reflectances_of_all_solar_bands() {
    for name in ["soil.csv", "bark.csv"] {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/spectra/");
        let path = std::path::Path::new(folder).join(name);
        let points = points(&read_spectrum(&path, &columns("wavelength_nm", None)).unwrap());
        assert_eq!((points[0].0, points[points.len() - 1].0), (400.0, 2500.0));
        assert!(points.iter().all(|&(_, value)| (0.0..=1.0).contains(&value)), "{name}");
    }
}
