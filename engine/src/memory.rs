//! Memory that this process can still take.

use std::{fmt, fs};

use sysinfo::{MemoryRefreshKind, ProcessRefreshKind, ProcessesToUpdate, System};

/// Memory that this process can still take, bytes: the minimum of what the system has left, what the
/// control groups of this process allow, and what is left of its resource limits (`ulimit -v`, `ulimit -d`).
/// `None` if none of them is known.
pub(crate) fn free() -> Option<u64> {
    let limits = [("Max address space", "VmSize:"), ("Max data size", "VmData:")];
    let limits = limits.into_iter().filter_map(|(limit, used)| below_limit(limit, used));
    system().into_iter().chain(limits).min()
}

/// Numbers of things up to which nobody asks for the memory that they take.
const FEW: f64 = 1e6;

/// Memory that so many things of a size take and the memory that is free, bytes, if that is less.
pub(crate) fn lacking(count: f64, bytes_each: u64) -> Option<Lack> {
    if count <= FEW {
        return None;
    }
    let needed = (count * bytes_each as f64) as u64;
    free().filter(|&free| free < needed).map(|free| Lack { needed, free })
}

/// Memory that is needed and not there, bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lack {
    /// Memory that is needed, bytes.
    pub needed: u64,
    /// Memory that is free, bytes.
    pub free: u64,
}

impl fmt::Display for Lack {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { needed, free } = *self;
        let gib = |bytes: u64| bytes as f64 / f64::from(1 << 30);
        write!(f, "{:.1} GiB of memory, and {:.1} GiB are free", gib(needed), gib(free))
    }
}

/// Returns the free memory of the system within the limits of this process's control groups, bytes.
fn system() -> Option<u64> {
    let mut system = System::new().ok()?;
    system.refresh_memory_specifics(MemoryRefreshKind::nothing().with_ram());
    let free = Some(system.available_memory()).filter(|free| *free > 0);
    let id = sysinfo::get_current_pid().ok()?;
    let own = ProcessesToUpdate::Some(&[id]);
    system.refresh_processes_specifics(own, false, ProcessRefreshKind::nothing());
    let limits = system.process(id).and_then(sysinfo::Process::cgroup_limits);
    // Files that the group has read count as used, but give way.
    let allowed = limits.map(|limits| limits.total_memory.saturating_sub(limits.rss));
    free.into_iter().chain(allowed).min()
}

/// Part of what is left of a resource limit that is counted as free: allocators and threads reserve
/// addresses that they do not use.
const USABLE: f64 = 0.9;

/// Returns the unused part of a resource limit of this process, bytes; `None` without a limit, or if the system
/// does not list limits in `/proc`.
fn below_limit(limit: &str, used: &str) -> Option<u64> {
    let limits = fs::read_to_string("/proc/self/limits").ok()?;
    let status = fs::read_to_string("/proc/self/status").ok()?;
    left_of(&limits, limit, &status, used)
}

fn left_of(limits: &str, limit: &str, status: &str, used: &str) -> Option<u64> {
    let value = |text: &str, name: &str| -> Option<u64> {
        let line = text.lines().find_map(|line| line.strip_prefix(name))?;
        line.split_whitespace().next()?.parse().ok()
    };
    // `unlimited` is no number.
    let allowed = value(limits, limit)?;
    let used = value(status, used)?.saturating_mul(1024);
    Some((allowed.saturating_sub(used) as f64 * USABLE) as u64)
}

#[cfg(test)]
mod tests {
    use super::left_of;

    const LIMITS: &str = "\
Limit                     Soft Limit           Hard Limit           Units
Max data size             unlimited            unlimited            bytes
Max address space         4096000000           8096000000           bytes
";
    const STATUS: &str = "Name:\tsunfleck\nVmSize:\t 1000000 kB\nVmData:\t  500000 kB\n";

    #[test]
    fn what_is_left_of_a_limit_is_free() {
        let left = left_of(LIMITS, "Max address space", STATUS, "VmSize:");
        assert_eq!(left, Some((3_072_000_000.0_f64 * 0.9) as u64));
        assert_eq!(left_of(LIMITS, "Max data size", STATUS, "VmData:"), None);
        let used_up = STATUS.replace("1000000", "9000000");
        assert_eq!(left_of(LIMITS, "Max address space", &used_up, "VmSize:"), Some(0));
    }
}
