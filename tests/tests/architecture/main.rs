//! The table and the invariants of `engine/ARCHITECTURE.md`, checked against the engine's source.

mod source;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use source::{Modules, SourceFile, engine, read_engine};

/// Rows of the table of modules: the name of each, and what it may use.
fn table() -> Vec<(String, BTreeSet<String>)> {
    let page = fs::read_to_string(engine("ARCHITECTURE.md")).expect("the page exists");
    let names = |cell: &str| cell.split('`').skip(1).step_by(2).map(ToOwned::to_owned).collect();
    let rows = page.lines().skip_while(|line| !line.starts_with("| module |")).skip(2);
    rows.take_while(|line| line.starts_with('|'))
        .map(|line| {
            let cells: Vec<&str> = line.trim_matches('|').split('|').collect();
            let [module, _, may_use] = cells[..] else { panic!("three cells in {line}") };
            (module.trim().trim_matches('`').to_owned(), names(may_use))
        })
        .collect()
}

/// Modules that the files of each module use.
fn used_modules(files: &[SourceFile]) -> BTreeMap<String, BTreeSet<String>> {
    let module_of = |path: &str| path.split(['/', '.']).next().unwrap_or_default().to_owned();
    let modules: BTreeSet<String> = files.iter().map(|file| module_of(&file.path)).collect();
    let mut used: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for file in files.iter().filter(|file| file.path != "lib.rs") {
        let module = module_of(&file.path);
        let paths = file.used().into_iter().chain(file.reexports().into_values());
        let named = paths.filter_map(|path| path.first().cloned());
        let others = named.filter(|name| *name != module && modules.contains(name));
        used.entry(module.clone()).or_default().extend(others);
    }
    used
}

#[test]
fn modules_use_what_the_table_says_and_no_more() {
    let (files, table) = (read_engine(), table());
    let used = used_modules(&files);
    let in_table: BTreeSet<&String> = table.iter().map(|(module, _)| module).collect();
    assert_eq!(in_table, used.keys().collect(), "one row per module");
    for (module, may_use) in &table {
        assert_eq!(used[module], *may_use, "what `{module}` uses is not what its row says");
    }
}

/// So modules have no circles, and files of different modules have none.
#[test]
fn rows_of_the_table_use_rows_above_them() {
    let mut above = BTreeSet::new();
    for (module, may_use) in table() {
        let below: Vec<_> = may_use.difference(&above).collect();
        assert!(below.is_empty(), "`{module}` uses {below:?}, which stand below it");
        above.insert(module);
    }
}

/// Folder below a module that a file lies in, or the file itself where it lies in none.
fn room(path: &str) -> Option<String> {
    let mut parts = path.split('/');
    let (module, room) = (parts.next()?, parts.next()?);
    Some(format!("{module}/{room}"))
}

#[test]
fn folders_of_the_ray_engine_and_of_transport_have_no_circles() {
    let files = read_engine();
    let modules = Modules::new(&files);
    for module in ["accel/", "transport/"] {
        let mut uses: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        for file in files.iter().filter(|file| file.path.starts_with(module)) {
            let from = room(&file.path).expect("it lies in a folder");
            let used = file.used();
            let declaring = used.iter().filter_map(|path| modules.declaring(path));
            let to = declaring.filter(|file| file.path.starts_with(module));
            let to = to.filter_map(|file| room(&file.path)).filter(|to| *to != from);
            uses.entry(from.clone()).or_default().extend(to);
        }
        assert!(uses.len() > 3, "{module} has folders");
        // Rooms that use no other are taken away until none is left.
        while let Some(leaf) = uses.iter().find(|(_, to)| to.is_empty()) {
            let leaf = leaf.0.clone();
            uses.remove(&leaf);
            for to in uses.values_mut() {
                to.remove(&leaf);
            }
        }
        assert_eq!(uses, BTreeMap::new(), "folders that use each other in a circle");
    }
}

/// Public or not: a type that other files may use has a name of its own in the whole engine.
#[test]
fn names_of_types_are_unique() {
    let mut homes: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for file in read_engine() {
        for name in file.shared_types() {
            homes.entry(name).or_default().push(file.path.clone());
        }
    }
    assert!(homes.contains_key("Sensor") && homes.len() > 500, "declared by macros too");
    homes.retain(|_, files| files.len() > 1);
    assert_eq!(homes, BTreeMap::new());
}

/// Lines of code that name a word, outside the places where they may.
fn trespasses(word: &str, allowed: &[&str]) -> Vec<String> {
    let mut found = Vec::new();
    for SourceFile { path, text, .. } in read_engine() {
        if allowed.iter().any(|place| path.starts_with(place)) {
            continue;
        }
        for (number, line) in text.lines().enumerate() {
            let code = line.split("//").next().unwrap_or_default();
            if code.contains(word) {
                found.push(format!("{path}:{}: {}", number + 1, line.trim()));
            }
        }
    }
    found
}

#[test]
fn only_the_stages_that_touch_the_world_name_hecs() {
    let allowed = [
        "components/",
        "spawn/",
        "systems/",
        "queries/",
        "accel/",
        "extract/",
        "run/",
        "appearance",
        "export/",
        "preview/",
    ];
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
        assert_eq!(trespasses(word, &[]), Vec::<String>::new(), "{word}");
    }
}
