//! Looks for files that make a reader panic, take long or take much memory.
//!
//! `fuzz READER [--seconds 600] [--seed 1] [--out FOLDER]`: files that say something new become
//! seeds themselves. What breaks the reader is made small and saved. `fuzz pipeline` checks and runs scenes, in
//! processes of their own with limits of memory and time: a scene that ends its process is saved as well.

#![expect(clippy::print_stdout, reason = "a program for the terminal")]

use std::collections::HashSet;
use std::fs;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use cpu_time::ProcessTime;
use peak_alloc::PeakAlloc;
use sunfleck_tests::fuzz::{
    Fault, Mutator, READERS, Reader, files_below, hush, judge, project, reader,
};

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

/// A reader that has not answered after so many seconds of processor time hangs.
const HANG: u64 = 240;

/// Most files that are kept to start from.
const MOST_SEEDS: usize = 4096;

/// Processor time from which on a file is no seed: what is made of it would be slow as well.
const SLOW_SEED: Duration = Duration::from_millis(250);

/// Longest time to make one finding small.
const MINIMISING: Duration = Duration::from_secs(20);

struct Arguments {
    reader: &'static Reader,
    seconds: u64,
    seed: u64,
    out: PathBuf,
}

fn arguments() -> Option<Arguments> {
    let mut words = std::env::args().skip(1);
    let reader = reader(&words.next()?)?;
    let out = project().join("tests/corpus").join(reader.name);
    let mut arguments = Arguments { reader, seconds: 600, seed: 1, out };
    while let Some(word) = words.next() {
        let value = words.next()?;
        match word.as_str() {
            "--seconds" => arguments.seconds = value.parse().ok()?,
            "--seed" => arguments.seed = value.parse().ok()?,
            "--out" => arguments.out = value.into(),
            _ => return None,
        }
    }
    Some(arguments)
}

fn main() -> ExitCode {
    let Some(arguments) = arguments() else {
        let names: Vec<_> = READERS.iter().map(|reader| reader.name).collect();
        println!("fuzz READER [--seconds 600] [--seed 1] [--out FOLDER]; READER: {names:?}");
        return ExitCode::FAILURE;
    };
    if arguments.reader.is_pipeline() && std::env::var_os(CHILD).is_none() {
        let found = supervise(&arguments);
        return if found == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE };
    }
    hush();
    let mut hunt = Hunt::new(arguments.reader, arguments.seed);
    let found = hunt.run(&arguments);
    if std::env::var_os(CHILD).is_none() {
        fs::remove_dir_all(&hunt.folder).expect("the folder of the fuzzer can be removed");
    }
    if found == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Set in the environment of a process that runs scenes for another.
const CHILD: &str = "SUNFLECK_FUZZ_CHILD";

/// Seconds after which a process that runs scenes is followed by the next.
const BATCH: u64 = 600;

/// Address space of such a process, KiB.
const ADDRESS_SPACE: u64 = 4 << 20;

/// Runs scenes in processes of their own until the time is over; returns how many of those failed.
fn supervise(arguments: &Arguments) -> usize {
    let start = Instant::now();
    let (mut tried, mut failed) = (0_u64, 0);
    let program = std::env::current_exe().expect("this program has a path");
    for seed in arguments.seed.. {
        let left = arguments.seconds.saturating_sub(start.elapsed().as_secs());
        if left == 0 {
            break;
        }
        let seconds = left.min(BATCH);
        let limits = format!("ulimit -v {ADDRESS_SPACE}; ulimit -t {}", 2 * seconds + 2 * HANG);
        let status = Command::new("sh")
            .args(["-c", &format!("{limits}; exec \"$0\" \"$@\"")])
            .arg(&program)
            .args([arguments.reader.name, "--seconds", &seconds.to_string()])
            .args(["--seed", &seed.to_string(), "--out"])
            .arg(&arguments.out)
            .env(CHILD, "1")
            .status()
            .expect("a shell");
        let folder = folder_of(arguments.reader, seed);
        let count = fs::read_to_string(folder.join(COUNT)).ok();
        tried += count.and_then(|count| count.parse().ok()).unwrap_or(0);
        if !status.success() {
            failed += 1;
            // A panic was saved by the process itself; what ended it is still there.
            let file = folder.join("file").with_extension(arguments.reader.extensions[0]);
            if status.code() != Some(1) && file.is_file() {
                let name = format!("ended_{seed}.{}", arguments.reader.extensions[0]);
                fs::create_dir_all(&arguments.out).expect("a folder for what is found");
                fs::copy(&file, arguments.out.join(&name)).expect("what is found can be saved");
                println!("{name}: {status}");
            }
        }
        // A process that was ended left its folder.
        drop(fs::remove_dir_all(&folder));
        println!("{} s: {tried} scenes, {failed} processes failed", start.elapsed().as_secs());
    }
    failed
}

/// File that holds the number of scenes tried.
const COUNT: &str = "count";

/// Folder that files are written to.
fn folder_of(reader: &Reader, seed: u64) -> PathBuf {
    std::env::temp_dir().join(format!("fuzz-{}-{seed}", reader.name))
}

/// A reader, and the folder where its files are written.
struct Hunt {
    reader: &'static Reader,
    folder: PathBuf,
    file: PathBuf,
    /// Processor time, s, at which the present file was given to the reader.
    since: Arc<AtomicU64>,
    start: Instant,
}

impl Hunt {
    fn new(reader: &'static Reader, seed: u64) -> Self {
        let folder = folder_of(reader, seed);
        fs::create_dir_all(&folder).expect("a folder to write files to");
        let file = folder.join("file").with_extension(reader.extensions[0]);
        let (start, since) = (Instant::now(), Arc::new(AtomicU64::new(0)));
        let (watched, path) = (since.clone(), file.clone());
        std::thread::spawn(move || {
            loop {
                std::thread::sleep(Duration::from_secs(1));
                if processor_seconds() > watched.load(Ordering::Relaxed) + HANG {
                    println!("no answer in {HANG} s: {}", path.display());
                    std::process::exit(2);
                }
            }
        });
        Self { reader, folder, file, since, start }
    }

    fn try_bytes(&self, bytes: &[u8]) -> Result<Vec<String>, Fault> {
        // What ends the process stays there to be looked at.
        fs::write(&self.file, bytes).expect("a file can be written");
        self.since.store(processor_seconds(), Ordering::Relaxed);
        judge(self.reader, &self.folder, &self.file).map(|answer| answer.kinds)
    }

    /// Number of kinds of faults found.
    fn run(&mut self, arguments: &Arguments) -> usize {
        let mut pool = seeds(self.reader);
        println!("{}: {} seeds, files in {}", self.reader.name, pool.len(), self.folder.display());
        let mut mutator = Mutator::new(arguments.seed, &pool);
        let (mut known, mut faults) = (HashSet::new(), HashSet::new());
        let (mut tried, mut told) = (0_u64, 0);
        let mut waiting = pool.clone();
        while self.start.elapsed().as_secs() < arguments.seconds {
            let (bytes, is_seed) = match waiting.pop() {
                Some(seed) => (seed, true),
                // Most scenes that are changed byte by byte are refused for their syntax.
                None if self.reader.is_pipeline() && mutator.below(8) > 0 => {
                    (mutator.variant(&pool), false)
                }
                None => (mutator.mutant(&pool), false),
            };
            tried += 1;
            if self.reader.is_pipeline() {
                // Readable should this process be ended.
                fs::write(self.folder.join(COUNT), tried.to_string()).expect("a count");
            }
            let start = ProcessTime::now();
            match self.try_bytes(&bytes) {
                Ok(kinds) if start.elapsed() > SLOW_SEED => known.extend(kinds),
                Ok(kinds) => {
                    let mut is_new = false;
                    for kind in kinds {
                        is_new |= known.insert(kind);
                    }
                    if is_new && !is_seed && pool.len() < MOST_SEEDS {
                        pool.push(bytes);
                    }
                }
                Err(fault) => {
                    if faults.insert(fault.kind()) {
                        let small = self.minimised(bytes, &fault);
                        self.save(&small, &fault, &arguments.out);
                    }
                }
            }
            let minutes = self.start.elapsed().as_secs() / 60;
            if minutes > told {
                told = minutes;
                let (kinds, pool) = (known.len(), pool.len());
                println!("{minutes} min: {tried} files, {kinds} kinds, pool of {pool}");
            }
        }
        println!(
            "{}: {tried} files in {} s, {} kinds of answers, {} of faults",
            self.reader.name,
            self.start.elapsed().as_secs(),
            known.len(),
            faults.len()
        );
        faults.len()
    }

    /// Takes out whatever is not needed for the same kind of fault.
    fn minimised(&self, mut bytes: Vec<u8>, fault: &Fault) -> Vec<u8> {
        let start = Instant::now();
        let mut size = bytes.len().div_ceil(2);
        while size > 0 {
            let mut at = 0;
            while at < bytes.len() && start.elapsed() < MINIMISING {
                let mut shorter = bytes.clone();
                shorter.drain(at..(at + size).min(bytes.len()));
                match self.try_bytes(&shorter) {
                    Err(other) if other.kind() == fault.kind() => bytes = shorter,
                    _ => at += size,
                }
            }
            size /= 2;
        }
        bytes
    }

    fn save(&self, bytes: &[u8], fault: &Fault, folder: &Path) {
        let mut hasher = DefaultHasher::new();
        bytes.hash(&mut hasher);
        let name = format!("found_{:08x}", hasher.finish() as u32);
        let path = folder.join(name).with_extension(self.reader.extensions[0]);
        fs::create_dir_all(folder).expect("a folder for what is found");
        fs::write(&path, bytes).expect("what is found can be saved");
        println!("{}: {} bytes: {fault:?}", path.display(), bytes.len());
    }
}

/// Processor time of this process, s: what others take of the machine does not count.
fn processor_seconds() -> u64 {
    ProcessTime::now().as_duration().as_secs()
}

/// Files to start from: the corpus, and what the project has.
fn seeds(reader: &Reader) -> Vec<Vec<u8>> {
    let corpus = format!("tests/corpus/{}", reader.name);
    let folders = reader.seeds.iter().map(|&folder| folder.to_owned()).chain([corpus]);
    let files = folders.flat_map(|folder| files_below(&project().join(folder), reader.extensions));
    // Closed white boxes take seconds each: ten thousand orders a path.
    let files = files.filter(|file| !file.to_string_lossy().contains("closedbox"));
    let seeds: Vec<_> = files.map(|file| fs::read(file).expect("a seed")).collect();
    if seeds.is_empty() { vec![b" ".to_vec()] } else { seeds }
}
