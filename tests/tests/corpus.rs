//! Files that were once too much for a reader, and those that the fuzzer starts from
//! (`tests/src/fuzz`): each is answered soon, in little memory and without a panic.

use std::fmt::Write as _;
use std::fs;

use peak_alloc::PeakAlloc;
use sunfleck_tests::fuzz::{READERS, files_below, hush, judge, project};

/// Counts what the readers ask for: so there is one test in this file.
#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

/// What a person reads first of each file.
#[test]
fn every_file_of_the_corpus_has_its_answer() {
    hush();
    for reader in READERS {
        let corpus = project().join("tests/corpus").join(reader.name);
        let folder = tempfile::tempdir().expect("a folder");
        let mut answers = String::new();
        for file in files_below(&corpus, reader.extensions) {
            let name = file.file_name().expect("a name");
            // A copy, beside which a reader may leave something.
            let copy = folder.path().join(name);
            fs::copy(&file, &copy).expect("a copy");
            let shown = match judge(&reader, folder.path(), &copy) {
                Ok(answer) => answer.text.lines().next().unwrap_or_default().to_owned(),
                Err(fault) => panic!("{}: {fault:?}", file.display()),
            };
            let _infallible = writeln!(answers, "{}: {shown}", name.to_string_lossy());
        }
        insta::assert_snapshot!(reader.name, answers);
    }
}
