//! The page of all keys, and what `sunfleck keys` prints.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::fs;

use assert_cmd::Command;
use tempfile::tempdir;

const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/KEYS.md");

fn keys(arguments: &[&str]) -> (bool, String, String) {
    let mut command = Command::cargo_bin("sunfleck").unwrap();
    let output = command.arg("keys").args(arguments).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.success(), text(output.stdout), text(output.stderr))
}

#[test]
fn the_page_of_all_keys_is_current() {
    let (is_printed, printed, errors) = keys(&[]);
    assert!(is_printed, "{errors}");
    let page = fs::read_to_string(PAGE).unwrap().replace("\r\n", "\n");
    let differs = printed.lines().zip(page.lines()).find(|(printed, written)| printed != written);
    let is_current = printed == page;
    assert!(is_current, "run `sunfleck keys > scenes/KEYS.md`; the first difference: {differs:?}");
}

#[test]
fn a_name_prints_its_part_of_the_page() {
    let page = fs::read_to_string(PAGE).unwrap().replace("\r\n", "\n");
    for name in ["Orthographic", "Spectrum", "sun"] {
        let (is_printed, printed, errors) = keys(&[name]);
        assert!(is_printed && printed.len() < page.len() / 2, "{errors}");
        let line = printed.lines().find(|line| line.starts_with('|')).unwrap();
        assert!(page.contains(line), "{line}");
    }
    let (is_printed, _, errors) = keys(&["Ortographic"]);
    assert!(!is_printed);
    assert!(errors.contains("did you mean `Orthographic`?"), "{errors}");
}

/// *Scene*: `scenes/products.ron`, which measures every product of images, directions and photons.
/// *Expected*: each product has a row in `scenes/RESULTS.md` with its unit.
#[test]
fn every_product_has_its_row_on_the_page_of_results() {
    let scenes = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes");
    let page = fs::read_to_string(format!("{scenes}/RESULTS.md")).unwrap();
    let folder = tempdir().unwrap();
    let out = folder.path().join("out");
    let mut command = Command::cargo_bin("sunfleck").unwrap();
    let scene = format!("{scenes}/products.ron");
    command.args(["run", &scene, "--quality", "0.001", "--out"]).arg(&out);
    command.assert().success();
    let summary: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(out.join("summary.json")).unwrap()).unwrap();
    let mut products = 0;
    for sensor in summary["sensors"].as_object().unwrap().values() {
        for (name, product) in sensor.as_object().unwrap() {
            let named = format!("`{}`", name.replace("hdrf_", "brf_"));
            let row = page.lines().find(|line| line.contains(&named));
            let row = row.unwrap_or_else(|| panic!("{named} is not in scenes/RESULTS.md"));
            let unit = product["unit"].as_str().unwrap();
            let unit = ["-1", "-2"]
                .iter()
                .zip(["⁻¹", "⁻²"])
                .fold(unit.to_owned(), |unit, (a, b)| unit.replace(a, b));
            let is_energy = name.ends_with("energy");
            assert!(is_energy || row.contains(&format!("| {unit} |")), "{name}: {unit}: {row}");
            products += 1;
        }
    }
    assert!(products > 20, "{products} products");
}
