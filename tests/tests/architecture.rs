//! The invariants of `engine/ARCHITECTURE.md`, held by reading the engine's source.

use std::fs;
use std::path::{Path, PathBuf};

/// All Rust files of the engine, by their path below `src`.
fn sources() -> Vec<(String, String)> {
    let root = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../engine/src"));
    let mut folders: Vec<PathBuf> = vec![root.to_owned()];
    let mut sources = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let name = path.strip_prefix(root).expect("below the root").display().to_string();
                sources.push((name, fs::read_to_string(path).expect("a text")));
            }
        }
    }
    sources.sort();
    assert!(sources.len() > 50, "the engine is there");
    sources
}

/// Lines of code that name a word, outside the places where they may.
fn trespasses(word: &str, allowed: &[&str]) -> Vec<String> {
    let mut found = Vec::new();
    for (file, text) in sources() {
        if allowed.iter().any(|place| file.starts_with(place)) {
            continue;
        }
        for (number, line) in text.lines().enumerate() {
            let code = line.split("//").next().unwrap_or_default();
            if code.contains(word) {
                found.push(format!("{file}:{}: {}", number + 1, line.trim()));
            }
        }
    }
    found
}

#[test]
fn only_the_stages_that_touch_the_world_name_hecs() {
    let allowed = ["components/", "spawn/", "systems/", "accel/", "extract/", "run/"];
    assert_eq!(trespasses("hecs", &allowed), Vec::<String>::new());
}

#[test]
fn only_the_ray_engine_names_obvhs() {
    assert_eq!(trespasses("obvhs", &["accel/"]), Vec::<String>::new());
}

#[test]
fn unsafe_code_lives_in_one_folder() {
    for word in ["unsafe {", "unsafe fn", "unsafe impl", "unsafe_code"] {
        assert_eq!(trespasses(word, &["accel/simd/"]), Vec::<String>::new(), "{word}");
    }
}

#[test]
fn the_library_neither_prints_nor_ends_the_process() {
    for word in ["println!", "eprintln!", "print!(", "process::exit", "dbg!("] {
        // Tests that skip say so.
        let found: Vec<String> =
            trespasses(word, &[]).into_iter().filter(|line| !line.contains("tests")).collect();
        assert_eq!(found, Vec::<String>::new(), "{word}");
    }
}

#[test]
fn transport_sees_the_stage_and_nothing_before_it() {
    let transport: Vec<(String, String)> =
        sources().into_iter().filter(|(file, _)| file.starts_with("transport/")).collect();
    assert!(!transport.is_empty());
    for (file, text) in transport {
        for word in ["crate::document", "crate::spawn", "crate::assets", "crate::output"] {
            assert!(!text.contains(word), "{file} names {word}");
        }
    }
}
