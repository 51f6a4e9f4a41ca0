//! How much memory a run may still take: that of the machine, or less by a limit of its process or of its group.

use std::path::Path;

use rustix::process::{Resource, getrlimit};

/// Where the groups of processes are.
const GROUPS: &str = "/sys/fs/cgroup";

/// Memory that is free (bytes), where the system tells.
pub fn free_memory() -> Option<f64> {
    let all = [of_machine(), of_process(), of_group(Path::new(GROUPS))];
    all.into_iter().flatten().reduce(f64::min)
}

/// Memory that the process holds (bytes), where the system tells.
pub fn taken_memory() -> Option<f64> {
    kilobytes("/proc/self/status", "VmRSS:")
}

/// What the machine can give without swapping (bytes).
fn of_machine() -> Option<f64> {
    kilobytes("/proc/meminfo", "MemAvailable:")
}

/// What is left of the address space that the process may have (`ulimit -v`) (bytes).
fn of_process() -> Option<f64> {
    let limit = getrlimit(Resource::As).current? as f64;
    let taken = kilobytes("/proc/self/status", "VmSize:").unwrap_or(0.0);
    Some((limit - taken).max(0.0))
}

/// What is left of the memory of the group of the process, or of one around it (bytes): version 2 of control groups.
fn of_group(root: &Path) -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/cgroup").ok()?;
    let own = text.lines().find_map(|line| line.strip_prefix("0::/"))?;
    // In a container the path may be that outside of it
    let mut group = Some(root.join(own)).filter(|path| path.is_dir()).unwrap_or(root.to_owned());
    let mut least: Option<f64> = None;
    loop {
        if let Some(left) = left_of(&group) {
            least = Some(least.map_or(left, |least| least.min(left)));
        }
        if group == root || !group.pop() {
            return least;
        }
    }
}

/// What is left of the memory of a group with a limit (bytes): files it has read go where memory is wanted.
fn left_of(group: &Path) -> Option<f64> {
    let number = |name: &str| std::fs::read_to_string(group.join(name)).ok()?.trim().parse().ok();
    let (limit, taken): (f64, f64) = (number("memory.max")?, number("memory.current")?);
    let report = std::fs::read_to_string(group.join("memory.stat")).unwrap_or_default();
    let files = report.lines().find_map(|line| line.strip_prefix("inactive_file "));
    let files: f64 = files.and_then(|text| text.trim().parse().ok()).unwrap_or(0.0);
    Some((limit - taken + files).max(0.0))
}

/// A number of kilobytes in a report of the system, as bytes.
fn kilobytes(report: &str, name: &str) -> Option<f64> {
    let report = std::fs::read_to_string(report).ok()?;
    let line = report.lines().find_map(|line| line.strip_prefix(name))?;
    Some(line.trim().trim_end_matches(" kB").parse::<f64>().ok()? * 1024.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_group_with_a_limit_has_what_is_left_of_it() {
        let path = std::env::temp_dir().join(format!("alewife-group-{}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        let put = |name: &str, text: &str| std::fs::write(path.join(name), text).unwrap();
        put("memory.max", "max\n");
        put("memory.current", "300\n");
        assert_eq!(left_of(&path), None);
        put("memory.max", "1000\n");
        assert_eq!(left_of(&path), Some(700.0));
        put("memory.stat", "anon 5\ninactive_file 100\n");
        assert_eq!(left_of(&path), Some(800.0));
        put("memory.current", "2000\n");
        assert_eq!(left_of(&path), Some(0.0));
        std::fs::remove_dir_all(&path).unwrap();
    }
}
