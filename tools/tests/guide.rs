//! Every snippet and every command of `README.md` and of the guide in `scenes/README.md` works as it stands there.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use tempfile::{TempDir, tempdir};

/// Folder of the repository.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn page(name: &str) -> String {
    fs::read_to_string(root().join(name)).unwrap()
}

/// A fenced block of a page, with the link that stands before it.
struct Block {
    language: String,
    text: String,
    /// The file that the page has linked to last, below `scenes`.
    file: Option<String>,
}

/// Fenced blocks of a page.
fn blocks(page: &str) -> Vec<Block> {
    let (mut blocks, mut file, mut lines) = (Vec::new(), None, page.lines());
    while let Some(line) = lines.next() {
        if let Some(language) = line.strip_prefix("```") {
            let text: Vec<&str> =
                lines.by_ref().take_while(|line| !line.starts_with("```")).collect();
            let (language, text) = (language.to_owned(), text.join("\n"));
            blocks.push(Block { language, text, file: file.clone() });
        } else if let Some((_, link)) = line.split_once("](guide/") {
            file = link.split_once(')').map(|(name, _)| name.to_owned());
        }
    }
    blocks
}

/// Lines without indents, empty ones and comments left out.
fn bare(text: &str) -> Vec<&str> {
    let lines = text.lines().map(str::trim);
    lines.filter(|line| !line.is_empty() && !line.starts_with("//")).collect()
}

/// Commands of a block, with arguments in quotes kept together.
fn commands(block: &str) -> impl Iterator<Item = Vec<String>> {
    let lines = block.lines().filter_map(|line| line.trim().strip_prefix("sunfleck "));
    lines.map(|line| {
        let line = line.split(" # ").next().unwrap();
        line.split_whitespace().map(str::to_owned).collect()
    })
}

/// A folder with the scenes, as a fresh clone has them.
fn clone() -> TempDir {
    fn copy(from: &Path, to: &Path) {
        fs::create_dir_all(to).unwrap();
        for entry in fs::read_dir(from).unwrap() {
            let (from, to) = (entry.as_ref().unwrap().path(), to.join(entry.unwrap().file_name()));
            if from.is_dir() {
                copy(&from, &to);
            } else {
                fs::copy(&from, &to).unwrap();
            }
        }
    }
    let folder = tempdir().unwrap();
    copy(&root().join("scenes"), &folder.path().join("scenes"));
    folder
}

/// Runs a command at a hundredth of its samples; it must succeed.
fn succeeds(folder: &Path, command: &[String]) {
    let is_traced = ["run", "sweep", "compare"].contains(&command[0].as_str());
    let quality: &[&str] = if is_traced { &["--quality", "0.01"] } else { &[] };
    let mut sunfleck = Command::new(env!("CARGO_BIN_EXE_sunfleck"));
    let output = sunfleck.args(command).args(quality).current_dir(folder).output().unwrap();
    assert!(output.status.success(), "{command:?}: {}", String::from_utf8_lossy(&output.stderr));
}

/// *Expected*: what the guide shows of a scene are lines of its file that follow each other, and a whole scene is the whole
/// file.
#[test]
fn snippets_of_the_guide_are_parts_of_its_scenes() {
    let blocks = blocks(&page("scenes/README.md"));
    let snippets: Vec<&Block> = blocks.iter().filter(|block| block.language == "ron").collect();
    assert!(snippets.len() > 15, "{}", snippets.len());
    for Block { text, file, .. } in snippets {
        let name = file.as_ref().expect("a link to the scene stands before its snippets");
        let scene = page(&format!("scenes/guide/{name}"));
        let (snippet, scene) = (bare(text), bare(&scene));
        let is_part = scene.windows(snippet.len()).any(|lines| lines == snippet);
        assert!(is_part, "{name} has no lines\n{text}");
        assert!(snippet[0] != "Scene(" || snippet == scene, "{name} is not shown whole");
    }
}

#[test]
fn commands_of_the_guide_succeed() {
    let folder = clone();
    let (blocks, mut count) = (blocks(&page("scenes/README.md")), 0);
    for block in blocks.iter().filter(|block| block.language == "console") {
        for command in commands(&block.text) {
            succeeds(folder.path(), &command);
            count += 1;
        }
    }
    assert!(count >= 12, "{count}");
}

/// *Expected*: each of the ten scenes is checked without a warning, and has its place on the page.
#[test]
fn scenes_of_the_guide_are_without_warnings() {
    let guide = page("scenes/README.md");
    let entries = fs::read_dir(root().join("scenes/guide")).unwrap();
    let files = entries.map(|entry| entry.unwrap().path());
    let scenes = files.filter(|file| file.extension().is_some_and(|ending| ending == "ron"));
    let name = |file: PathBuf| file.file_name().unwrap().to_str().unwrap().to_owned();
    let mut names: Vec<String> = scenes.map(name).collect();
    names.sort();
    assert_eq!(names.len(), 10);
    for name in names {
        assert!(guide.contains(&format!("](guide/{name})")), "{name}");
        let mut sunfleck = Command::new(env!("CARGO_BIN_EXE_sunfleck"));
        let output =
            sunfleck.arg("check").arg(root().join("scenes/guide").join(&name)).output().unwrap();
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && !stderr.contains("warning"), "{name}: {stderr}");
    }
}
