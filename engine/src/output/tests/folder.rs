//! Names of files, and folders that are written as a whole.

use super::*;

#[test]
fn exactly_the_promised_files_are_written() {
    let (folder, paths) = written();
    let found = names(&folder.path().join("deep/er"));
    let expected = [
        "nadir_brf.exr",
        "nadir_brf.img",
        "nadir_brf.img.hdr",
        "nadir_brf.pixels.png",
        "nadir_brf.png",
        "nadir_brf_se.img",
        "nadir_brf_se.img.hdr",
        "plane_brf.csv",
        "plane_brf.svg",
        "summary.json",
    ];
    assert_eq!(found, expected);
    assert_eq!(paths.len(), 10);
    assert_eq!(paths[9], folder.path().join("deep/er/summary.json"));
    assert_eq!(names(folder.path()), ["deep"]);
    assert_eq!(names(&folder.path().join("deep")), ["er"]);
}

#[test]
fn no_header_stands_beside_another_file_of_its_stem() {
    let (folder, _) = written();
    let found = names(&folder.path().join("deep/er"));
    for header in found.iter().filter_map(|name| name.strip_suffix(".hdr")) {
        let stems = found.iter().filter_map(|name| name.rsplit_once('.').map(|(stem, _)| stem));
        assert!(
            !stems.into_iter().any(|stem| stem == header && !found.contains(&header.to_owned()))
        );
        assert!(found.contains(&header.to_owned()), "{header}.hdr is that of {header}");
    }
}

#[test]
fn files_of_the_same_run_are_the_same_bytes() {
    let read = || {
        let (_folder, paths) = written();
        paths.iter().map(|path| fs::read(path).unwrap()).collect::<Vec<_>>()
    };
    let first = read();
    for _ in 0..8 {
        assert!(read() == first);
    }
}

#[test]
fn hostile_names_stay_inside_the_folder_and_apart() {
    let root = tempfile::tempdir().unwrap();
    let folder = root.path().join("out");
    let hostile = ["../x", "a/b", "a b", "A b", "CON", "summary.json", "", "/etc/x", "\u{0}", ".."];
    let sensors = hostile.map(|name| sensor(name, views())).into();
    let paths = write(&report(sensors), &folder).unwrap();
    assert_eq!(names(root.path()), ["out"]);
    let found = names(&folder);
    // A table and a chart each, and the summary.
    assert_eq!(found.len(), 2 * hostile.len() + 1, "{found:?}");
    for path in &paths {
        assert_eq!(path.parent(), Some(folder.as_path()));
        assert!(path.is_file());
    }
    let mut distinct: Vec<_> = found.iter().map(|name| name.to_lowercase()).collect();
    distinct.dedup();
    assert_eq!(distinct.len(), found.len(), "{found:?}");
    assert!(found.iter().all(|name| !name.starts_with('.') && !name.starts_with("CON.")));
    let text = fs::read_to_string(folder.join("summary.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(json["sensors"].as_object().unwrap().len(), hostile.len());
    let files = serde_json::json!(["A_b_brf_3.csv", "A_b_brf_3.svg"]);
    assert_eq!(json["sensors"]["A b"]["brf"]["files"], files);
}

#[test]
fn a_folder_that_cannot_be_is_an_error_with_its_path_and_cause() {
    let root = tempfile::tempdir().unwrap();
    let file = root.path().join("file");
    fs::write(&file, "mine").unwrap();
    let report = report(vec![sensor("plane", views())]);
    assert!(matches!(probe(&file), Err(OutputError::NotAFolder { .. })));
    assert!(matches!(probe(&file.join("below")), Err(OutputError::Folder { .. })));
    probe(&root.path().join("new/er")).unwrap();
    let error = write(&report, &file).unwrap_err();
    let expected = format!("{} is a file: name a folder for the output", file.display());
    assert_eq!(error.to_string(), expected);
    let error = write(&report, &file.join("below")).unwrap_err();
    assert!(matches!(&error, OutputError::Folder { path, .. } if path == &file.join("below")));
    assert!(std::error::Error::source(&error).is_some());
    assert_eq!(fs::read_to_string(&file).unwrap(), "mine");
    assert_eq!(names(root.path()), ["file"]);
}

#[cfg(unix)]
#[test]
#[allow(clippy::print_stderr, reason = "a test that cannot be made says so")]
fn a_folder_without_permission_stays_as_it_was() {
    use std::os::unix::fs::PermissionsExt as _;
    let root = tempfile::tempdir().unwrap();
    fs::set_permissions(root.path(), fs::Permissions::from_mode(0o500)).unwrap();
    if fs::write(root.path().join("probe"), "").is_ok() {
        eprintln!("skipped: this user may write everywhere");
        return;
    }
    let report = report(vec![sensor("plane", views())]);
    assert!(matches!(write(&report, root.path()), Err(OutputError::Write { .. })));
    assert!(matches!(write(&report, &root.path().join("new")), Err(OutputError::Folder { .. })));
    assert!(names(root.path()).is_empty());
}

#[test]
fn a_write_that_fails_leaves_no_file_and_an_older_report_whole() {
    let root = tempfile::tempdir().unwrap();
    let good = report(vec![sensor("plane", views())]);
    write(&good, root.path()).unwrap();
    let before = fs::read(root.path().join("summary.json")).unwrap();
    fs::create_dir(root.path().join("late_brf.csv")).unwrap();
    let mut other = views();
    other.values[0] = 0.9;
    let blocked = report(vec![sensor("plane", other), sensor("late", views())]);
    let error = write(&blocked, root.path()).unwrap_err();
    assert!(
        matches!(&error, OutputError::Taken { path } if path.ends_with("late_brf.csv")),
        "{error}"
    );
    assert_eq!(
        names(root.path()),
        ["late_brf.csv", "plane_brf.csv", "plane_brf.svg", "summary.json"]
    );
    assert_eq!(fs::read(root.path().join("summary.json")).unwrap(), before);
    let csv = fs::read_to_string(root.path().join("plane_brf.csv")).unwrap();
    assert!(!csv.contains("0.9"), "{csv}");
}

#[test]
fn a_product_that_contradicts_its_axes_is_an_error_before_any_file() {
    let root = tempfile::tempdir().unwrap();
    let folder = root.path().join("out");
    let mut short = views();
    short.values.pop();
    let error = write(&report(vec![sensor("plane", short)]), &folder).unwrap_err();
    assert_eq!(error.to_string(), "plane.brf has 5 values, but its axes say 6");
    let mut empty = image();
    empty.image.as_mut().unwrap().width = 0;
    assert!(write(&report(vec![sensor("nadir", empty)]), &folder).is_err());
    assert!(names(root.path()).is_empty());
}
