//! Files of spectra as other programs and libraries write them, against `SPy` and pyASDReader.
//!
//! The comparison needs a Python with `spectral` and `pyASDReader`: `python3`, or the one that `SUNFLECK_PYTHON` names.
//! Without it that test is skipped, and says so.

#![allow(clippy::print_stderr, reason = "a skipped test says why")]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod layouts;

use std::path::Path;
use std::process::Command;

use serde_json::Value;
use sunfleck::assets::{SpectrumColumns, SpectrumFormat, SpectrumTable, read_spectrum};
use sunfleck::document::{ValueUnit, WavelengthUnit};

use layouts::{LEAF, NM, SOIL, asd, ecostress, envi, usgs};

/// Exit code of the script where a module is missing.
const MISSING: i32 = 77;

const ANY: SpectrumColumns<'_> =
    SpectrumColumns { wavelength: None, value: None, unit: None, wavelengths_file: None };

fn named(value: &str) -> SpectrumColumns<'_> {
    SpectrumColumns { value: Some(value), ..ANY }
}

/// Asserts points in nm and in the file's unit, to the digits that the file has.
fn assert_points(table: &SpectrumTable, wavelengths: &[f64], values: &[f64]) {
    assert_eq!(table.points.len(), wavelengths.len());
    for ((point, &wavelength), &value) in table.points.iter().zip(wavelengths).zip(values) {
        assert!((point.wavelength - wavelength).abs() < 1e-4, "{point:?} at {wavelength}");
        let is_same = (point.value - value).abs() <= 2e-7 * value.abs().max(1e-6);
        assert!(is_same || (point.value.is_nan() && value.is_nan()), "{point:?} is {value}");
    }
}

fn error(path: &Path, columns: &SpectrumColumns<'_>) -> String {
    let error = read_spectrum(path, columns).expect_err("an error").to_string();
    let folder = format!("{}/", path.parent().unwrap().display());
    error.replace(&folder, "")
}

#[test]
fn a_spectrum_of_an_envi_library_is_chosen_by_its_name() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    for (stem, is_big, factor, more) in [
        ("little", false, 1.0, ""),
        ("big", true, 1.0, "y plot title = Reflectance\n"),
        ("scaled", false, 10000.0, "reflectance scale factor = 10000\n"),
    ] {
        let path = envi(at, stem, is_big, factor, more);
        for path in [path.clone(), path.with_extension("hdr")] {
            let table = read_spectrum(&path, &named("leaf of oak")).unwrap();
            assert_eq!((table.format, table.unit), (SpectrumFormat::EnviLibrary, None));
            assert_points(&table, &NM, &LEAF);
            assert_points(&read_spectrum(&path, &named("dry soil")).unwrap(), &NM, &SOIL);
        }
    }
    let path = envi(at, "bad", false, 1.0, "bbl = {1,1,0,1,1}\ndata ignore value = 0.46\n");
    let mut marked = LEAF;
    marked[2] = f64::NAN;
    // 0.46 as f32 is another number than 0.46, so that nothing is ignored but by the list of bad bands.
    assert_points(&read_spectrum(&path, &named("leaf of oak")).unwrap(), &NM, &marked);
}

#[test]
fn what_is_wrong_with_an_envi_library_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = envi(folder.path(), "a", false, 1.0, "");
    assert_eq!(
        error(&path, &ANY),
        "a.sli: is an ENVI spectral library of 2 spectra; write the one that is meant, `value: \"leaf of oak\"`; it \
         holds \"leaf of oak\", \"dry soil\""
    );
    assert_eq!(
        error(&path, &named("dry sail")),
        "a.sli: has no spectrum \"dry sail\"; if \"dry soil\" is meant, write `value: \"dry soil\"`; it holds \"leaf of \
         oak\", \"dry soil\""
    );
    let header = path.with_extension("hdr");
    let text = std::fs::read_to_string(&header).unwrap();
    let with = |from: &str, to: &str| {
        assert!(text.contains(from));
        std::fs::write(&header, text.replace(from, to)).unwrap();
        error(&path, &named("dry soil"))
    };
    assert_eq!(
        with("Micrometers", "Unknown"),
        "a.sli: nothing in an ENVI spectral library says in which unit its wavelengths are; it begins `wavelength units = \
         Unknown`, `wavelength = {0.4, 0.55, 0.66, ..}`; write `wavelength_unit: Nanometres` beside `file`, or \
         `Micrometres`, `Angstroms` or `Wavenumbers`"
    );
    assert_eq!(
        with("{\n 0.4,", "{\n"),
        "a.sli: is an ENVI spectral library whose header \"a.hdr\" lists 4 numbers as `wavelength` for 5 channels; list \
         one for each"
    );
    assert!(with("samples = 5", "samples = 6").contains("the file has 40"));
    assert!(with("samples = 5", "samples = 99999999999").contains("more than"));
    std::fs::remove_file(&header).unwrap();
    assert!(error(&path, &ANY).contains("a.sli.hdr, a.hdr"), "{}", error(&path, &ANY));
}

#[test]
fn texts_of_ecostress_say_their_units() {
    let folder = tempfile::tempdir().unwrap();
    let path = ecostress(folder.path(), "leaf.txt", "Reflectance (percentage)");
    let table = read_spectrum(&path, &ANY).unwrap();
    assert_eq!((table.format, table.unit), (SpectrumFormat::Ecostress, Some(ValueUnit::Percent)));
    assert_points(&table, &NM, &LEAF.map(|value| 100.0 * value));
    assert_eq!(table.value, "Quercus robur");
    assert_eq!(table.points[0].line, 31, "wavelengths fall in the file");
    let text = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, text.replace("(micrometers)", "")).unwrap();
    assert_eq!(
        error(&path, &ANY),
        "leaf.txt: nothing in a spectrum of the ECOSTRESS library says in which unit its wavelengths are; it begins `X \
         Units: Wavelength`, `Y Units: Reflectance (percentage)`; write `wavelength_unit: Nanometres` beside `file`, or \
         `Micrometres`, `Angstroms` or `Wavenumbers`"
    );
    let micrometres = SpectrumColumns { unit: Some(WavelengthUnit::Micrometres), ..ANY };
    assert_points(&read_spectrum(&path, &micrometres).unwrap(), &NM, &LEAF.map(|v| 100.0 * v));
    assert!(error(&path, &named("R")).contains("no column \"R\": take `value` out"));
}

#[test]
fn values_and_wavelengths_of_usgs_are_joined() {
    let folder = tempfile::tempdir().unwrap();
    let [path, waves] = usgs(folder.path());
    let columns = SpectrumColumns { wavelengths_file: Some(&waves), ..ANY };
    let table = read_spectrum(&path, &columns).unwrap();
    assert_eq!((table.format, table.unit), (SpectrumFormat::Usgs, Some(ValueUnit::Fraction)));
    let mut values = LEAF;
    values[4] = -1.23e34;
    assert_points(&table, &NM, &values);
    assert_eq!(
        error(&path, &ANY),
        "splib07a_Leaf_ASDFRa_AREF.txt: is a spectrum of the USGS library, whose wavelengths stand in a file of their own; \
         write its name beside `file`, `wavelengths: \"splib07a_Wavelengths_ASD_0.35-2.5_microns_5_ch.txt\"`"
    );
    assert!(error(&waves, &ANY).contains("name a file of values as `file`, and this one as"));
    let text = std::fs::read_to_string(&waves).unwrap();
    std::fs::write(&waves, text.rsplit_once("  ").unwrap().0).unwrap();
    assert!(error(&path, &columns).contains("holds 5 values, and"), "{}", error(&path, &columns));
}

#[test]
fn the_reflectance_of_an_asd_file_is_target_over_reference() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let path = asd(at, "leaf.asd", 1, true);
    let table = read_spectrum(&path, &ANY).unwrap();
    assert_eq!((table.format, table.unit), (SpectrumFormat::Asd, Some(ValueUnit::Fraction)));
    assert_points(&table, &[350.0, 351.0, 352.0, 353.0, 354.0], &LEAF);
    for (kind, has_reference, words) in [
        (2, true, "holds radiances;"),
        (0, true, "holds raw counts;"),
        (1, false, "no white reference"),
    ] {
        let path = asd(at, "other.asd", kind, has_reference);
        assert!(error(&path, &ANY).contains(words), "{}", error(&path, &ANY));
    }
    let whole = std::fs::read(&path).unwrap();
    for length in (484..whole.len() - 64).step_by(7) {
        std::fs::write(&path, &whole[..length]).unwrap();
        assert!(error(&path, &ANY).contains("it is cut off"), "{length}");
    }
}

#[test]
fn tables_say_their_units_or_the_scene_does() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("t.csv");
    let read = |text: &str, columns: &SpectrumColumns<'_>| {
        std::fs::write(&path, text).unwrap();
        read_spectrum(&path, columns)
    };
    for text in [
        "wavelength_um,R\n0.4,5.2\n0.55,12.1\n0.66,6\n0.865,46\n2.4,10\n",
        "Wavelength (µm);Reflectance\n0,4;5,2\n0,55;12,1\n0,66;6\n0,865;46\n2,4;10\n",
        "R,nm,sample\n5.2,400,a\n12.1,550,a\n6,660,a\n46,865,a\n10,2400,a\n",
        "Wavelength\tleaf.asd\n400\t5.2\n550\t12.1\n660\t6\n865\t46\n2400\t10\n",
        "Site,plot 7\nInstrument,FieldSpec\nwavelength [nm],R\n400,5.2\n550,12.1\n660,6\n865,46\n2400,10\n",
    ] {
        let table =
            read(text, &SpectrumColumns { value: text.contains("sample").then_some("R"), ..ANY });
        assert_points(&table.unwrap(), &NM, &LEAF.map(|value| 100.0 * value));
    }
    let percent = read("nm,R [%]\n400,5\n500,6\n", &ANY).unwrap();
    assert_eq!(percent.unit, Some(ValueUnit::Percent));
    read("wavelength,R\n400,5\n500,6\n", &ANY).unwrap_err();
    assert_eq!(
        error(&path, &ANY),
        "t.csv: nothing in a text table says in which unit its wavelengths are; it begins `wavelength,R`; write \
         `wavelength_unit: Nanometres` beside `file`, or `Micrometres`, `Angstroms` or `Wavenumbers`"
    );
    assert!(
        error(&path, &SpectrumColumns { wavelengths_file: Some(&path), ..ANY })
            .contains("is a text table, which holds its wavelengths")
    );
}

/// *Expected*: the values, wavelengths, names and units that `SPy` and pyASDReader find in the same files.
#[test]
fn other_programs_read_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let library = envi(at, "library", true, 1.0, "");
    let ecostress = ecostress(at, "ecostress.txt", "Reflectance (percentage)");
    let [values, waves] = usgs(at);
    let asd = asd(at, "leaf.asd", 1, true);
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("readers/spectra.py");
    let python = std::env::var_os("SUNFLECK_PYTHON").unwrap_or_else(|| "python3".into());
    let Ok(run) = Command::new(python).arg(script).arg(at).output() else {
        eprintln!("skipped: there is no Python");
        return;
    };
    let [said, wrong] = [&run.stdout, &run.stderr].map(|text| String::from_utf8_lossy(text));
    if run.status.code() == Some(MISSING) {
        eprintln!("skipped: {said}");
        return;
    }
    assert!(run.status.success(), "{said}{wrong}");
    let found: Value = serde_json::from_str(&said).unwrap();
    let numbers = |value: &Value, factor: f64| -> Vec<f64> {
        value.as_array().unwrap().iter().map(|v| v.as_f64().unwrap() * factor).collect()
    };
    let names = found["envi"]["names"].as_array().unwrap();
    assert_eq!(found["envi"]["unit"], "Micrometers");
    for (name, spectrum) in names.iter().zip(found["envi"]["spectra"].as_array().unwrap()) {
        let table = read_spectrum(&library, &named(name.as_str().unwrap())).unwrap();
        let wavelengths = numbers(&found["envi"]["wavelengths"], 1e3);
        assert_points(&table, &wavelengths, &numbers(spectrum, 1.0));
    }
    let of = |kind: &str, key: &str, factor: f64| numbers(&found[kind][key], factor);
    assert_eq!(found["ecostress"]["unit"], "reflectance (percentage)");
    let table = read_spectrum(&ecostress, &ANY).unwrap();
    assert_points(&table, &of("ecostress", "x", 1e3), &of("ecostress", "y", 1.0));
    assert_eq!(found["usgs"]["unit"], "micrometer");
    let columns = SpectrumColumns { wavelengths_file: Some(&waves), ..ANY };
    let table = read_spectrum(&values, &columns).unwrap();
    assert_points(&table, &of("usgs", "x", 1e3), &of("usgs", "y", 1.0));
    let table = read_spectrum(&asd, &ANY).unwrap();
    assert_points(&table, &of("asd", "x", 1.0), &of("asd", "y", 1.0));
}
