use std::fs;
use std::path::Path;
use std::sync::Arc;

use super::super::tests::{image, report, sensor, views};
use super::super::write;
use super::record::{IN_SUMMARY, unpacked};
use super::*;
use crate::document::FileFormat;
use crate::products::{InputFile, Recipe, Report, SceneSource};

/// A report of an image and a table in all formats, whose scene is this text.
fn report_of(scene: &str) -> Report {
    let mut report = report(vec![sensor("nadir", image()), sensor("plane", views())]);
    report.formats = FileFormat::ALL.to_vec();
    report.recipe = Some(Arc::new(Recipe {
        scene: scene.to_owned(),
        folder: "/there/scenes".into(),
        files: vec![InputFile { path: "a b.csv".into(), hash: "abc".to_owned() }],
        quality: 0.1 + 0.2,
        keeps_coefficients: false,
        is_joint: false,
    }));
    report.source = Some(SceneSource {
        file: "/there/scenes/plot.ron".into(),
        variant: Some("winter".to_owned()),
        set: vec![("sza".to_owned(), (1.0 / 3.0).into())],
        quality: 1.0,
    });
    report
}

/// Text that formats would change or split if it were not packed.
const ODD: &str = "Scene(title: \"<a> & {b}; 'c', = \\\" ö \u{1f332}, ]]> # +\")";

/// *Expected*: every file of every format gives the record that was written, of a short scene, of a long one, and of one
/// that is in the summary alone.
#[test]
fn every_file_says_how_to_repeat_its_run() {
    let noise = |length: u32| {
        (0..length).map(|i| char::from(b'a' + (blake3::hash(&i.to_le_bytes()).as_bytes()[0] % 26)))
    };
    for (length, is_in_summary) in [(0, false), (6000, false), (2_000_000, true)] {
        let scene = format!("{ODD}{}", noise(length).collect::<String>());
        let folder = tempfile::tempdir().unwrap();
        let report = report_of(&scene);
        let files = write(&report, folder.path()).unwrap();
        assert_eq!(files.len(), 16, "{files:?}");
        for file in &files {
            let record = read_record(file).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(record.scene, scene, "{}", file.display());
            assert_eq!(record.quality.to_bits(), (0.1_f64 + 0.2).to_bits());
            assert_eq!(record.files["a b.csv"], "abc");
            assert_eq!(record.scene_folder(), Path::new("/there/scenes"), "{}", record.folder);
            assert_eq!(record.set["sza"], (1.0 / 3.0).into());
            assert_eq!(record.hash, "c0ffee");
        }
        let csv = fs::read_to_string(folder.path().join("plane_brf.csv")).unwrap();
        assert_eq!(csv.contains(IN_SUMMARY), is_in_summary);
        let record = read_record(folder.path()).unwrap();
        assert_eq!(record.scene, scene, "a folder of results");
    }
}

fn message(path: &Path) -> String {
    let text = read_record(path).unwrap_err().to_string();
    text.replace(&path.display().to_string(), "FILE")
}

#[test]
fn what_is_no_result_or_damaged_is_refused_with_a_reason() {
    let folder = tempfile::tempdir().unwrap();
    let put = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        path
    };
    let no_result = "FILE is none of the files that sunfleck writes: name a result of `sunfleck run`, such as its summary.json";
    for bytes in [&b""[..], b"x", b"Scene()", &[0; 100]] {
        assert_eq!(message(&put("a", bytes)), no_result);
    }
    assert_eq!(message(&folder.path().join("none")), "cannot read FILE");
    assert_eq!(message(folder.path()), "cannot read FILE");
    let missing = |kind: &str| {
        format!(
            "FILE does not say how it was made: it is {kind} of another program, or of a command that has no single run, such as `sweep`; name a result of `sunfleck run`"
        )
    };
    assert_eq!(message(&put("a", b"{}")), missing("JSON"));
    assert_eq!(message(&put("a", b"# x\na,b\n")), missing("a table"));
    assert_eq!(message(&put("a", b"<svg></svg>")), missing("a drawing"));
    assert_eq!(message(&put("a", b"ENVI\ndescription = {x}\n")), missing("a raster of ENVI"));
    assert_eq!(
        message(&put("a", b"ply\nformat ascii 1.0\ncomment x\nend_header\n")),
        missing("a PLY file")
    );
    assert_eq!(
        message(&put("a", br#"{"command": "sweep"}"#)),
        "FILE holds results of `sunfleck sweep`, which `rerun` does not repeat: run `sunfleck sweep` again"
    );
    let newer = message(&put("a", br#"{"recipe": {"format": 2, "version": "9.1.0", "new": 1}}"#));
    assert!(newer.starts_with("FILE was written by sunfleck 9.1.0, whose recipes"), "{newer}");
    for text in
        ["# recipe: zlib:!", "# recipe: zlib:AAAA", "# recipe: {", "# recipe: {\"format\": 1}"]
    {
        let message = message(&put("a", text.as_bytes()));
        assert!(message.starts_with("FILE is damaged: its recipe: "), "{message}");
        assert!(message.ends_with("; name another file of the same run"), "{message}");
    }
}

/// *Expected*: files that end anywhere, or have bits turned, give a record or an error, and nothing else happens.
#[test]
fn damaged_files_are_read_without_a_panic() {
    let folder = tempfile::tempdir().unwrap();
    let files = write(&report_of(ODD), folder.path()).unwrap();
    let other = tempfile::tempdir().unwrap();
    for file in files.iter().filter(|file| file.is_file()) {
        let bytes = fs::read(file).unwrap();
        let path = other.path().join("damaged");
        for step in 1..40 {
            let mut some = bytes[..bytes.len() * step / 40].to_vec();
            fs::write(&path, &some).unwrap();
            drop(read_record(&path));
            some = bytes.clone();
            let place = blake3::hash(&step.to_le_bytes()).as_bytes()[0] as usize * 7 % some.len();
            some[place] ^= 1 << (step % 8);
            fs::write(&path, &some).unwrap();
            drop(read_record(&path));
        }
    }
}

#[test]
fn long_texts_are_packed_and_read_back() {
    assert_eq!(unpacked("{}").unwrap(), "{}");
    assert!(unpacked("zlib:A").is_err());
}
