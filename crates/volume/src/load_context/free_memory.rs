//! Memory still available to this process: the least of the machine's free memory, the limit of its control group
//! (container), and the limit on address space (`ulimit -v`).

use std::fs;
use std::path::{Path, PathBuf};

/// Returns the bytes that may still be allocated, if the system reports any limit.
pub(super) fn free_bytes() -> Option<u64> {
    let root = Path::new("/");
    [machine_bytes_available(root), cgroup_bytes_left(root), address_space_left(root)]
        .into_iter()
        .flatten()
        .min()
}

/// Returns the bytes of address space left under the limit of this process; `None` without a limit.
pub fn address_bytes_left() -> Option<u64> {
    address_space_left(Path::new("/"))
}

/// Reads `MemAvailable` of `/proc/meminfo`, in bytes.
fn machine_bytes_available(root: &Path) -> Option<u64> {
    kibibytes(&read_text(&root.join("proc/meminfo"))?, "MemAvailable:")
}

/// Returns the limit of address space (`RLIMIT_AS`) minus the part in use, in bytes.
fn address_space_left(root: &Path) -> Option<u64> {
    let limits = read_text(&root.join("proc/self/limits"))?;
    let soft = limits.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    // The word `unlimited` fails to parse.
    let limit: u64 = soft.split_whitespace().next()?.parse().ok()?;
    let used = kibibytes(&read_text(&root.join("proc/self/status"))?, "VmSize:")?;
    Some(limit.saturating_sub(used))
}

/// Returns the bytes left in the control groups of this process, version 1 or 2.
fn cgroup_bytes_left(root: &Path) -> Option<u64> {
    let groups = read_text(&root.join("proc/self/cgroup"))?;
    let left = |line: &str| {
        // `4:memory:/path` in version 1, `0::/path` in version 2.
        let (kinds, path) = line.split_once(':')?.1.split_once(':')?;
        let (mount, limit, used) = if kinds.is_empty() {
            ("sys/fs/cgroup", "memory.max", "memory.current")
        } else if kinds.split(',').any(|kind| kind == "memory") {
            ("sys/fs/cgroup/memory", "memory.limit_in_bytes", "memory.usage_in_bytes")
        } else {
            return None;
        };
        let mount = root.join(mount);
        let own = mount.join(path.trim_start_matches('/'));
        // A group is limited by all its ancestors, too. A container may see its own group as the root, under a
        // foreign path.
        let of = |group: &Path| {
            let number = |name: &str| read_text(&group.join(name))?.trim().parse::<u64>().ok();
            // The page cache is reclaimed on demand, so inactive file pages count as free.
            let stat = read_text(&group.join("memory.stat")).unwrap_or_default();
            let of_files =
                stat.lines().find_map(|line| line.strip_prefix("inactive_file ")?.trim().parse().ok());
            let used = number(used)?.saturating_sub(of_files.unwrap_or(0));
            Some(number(limit)?.saturating_sub(used))
        };
        let groups: Vec<PathBuf> =
            own.ancestors().take_while(|group| group.starts_with(&mount)).map(Path::to_owned).collect();
        groups.iter().filter_map(|group| of(group)).min()
    };
    groups.lines().filter_map(left).min()
}

/// Parses a number in KiB after a name at the start of a line; returns bytes.
fn kibibytes(text: &str, name: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?.checked_mul(1024)
}

fn read_text(path: &Path) -> Option<String> {
    fs::read_to_string(path).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Creates a temporary directory with files laid out like Linux's /proc and /sys.
    fn fake_proc_files(files: &[(&str, &str)]) -> tempfile::TempDir {
        let root = tempfile::tempdir().unwrap();
        for (name, text) in files {
            let path = root.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        root
    }

    #[test]
    fn the_machine_says_what_is_available() {
        let root = fake_proc_files(&[("proc/meminfo", "MemTotal: 9 kB\nMemAvailable:    2048 kB\n")]);
        assert_eq!(machine_bytes_available(root.path()), Some(2 << 20));
        assert_eq!(
            machine_bytes_available(fake_proc_files(&[("proc/meminfo", "MemTotal: 9 kB\n")]).path()),
            None
        );
        assert_eq!(machine_bytes_available(fake_proc_files(&[]).path()), None);
    }

    #[test]
    fn limits_of_addresses_count_what_is_in_use() {
        let status = ("proc/self/status", "Name:\tx\nVmSize:\t    1024 kB\n");
        let of = |soft: &str| {
            let limits =
                format!("Limit  Soft  Hard  Units\nMax address space         {soft}   unlimited   bytes\n");
            address_space_left(fake_proc_files(&[("proc/self/limits", &limits), status]).path())
        };
        assert_eq!((of("3145728"), of("1000"), of("unlimited")), (Some(2 << 20), Some(0), None));
    }

    #[test]
    fn containers_of_both_versions_leave_what_they_leave() {
        let second = fake_proc_files(&[
            ("proc/self/cgroup", "0::/a/b\n"),
            ("sys/fs/cgroup/a/memory.max", "1000000\n"),
            ("sys/fs/cgroup/a/memory.current", "900000\n"),
            ("sys/fs/cgroup/a/memory.stat", "anon 1\ninactive_file 50000\n"),
            ("sys/fs/cgroup/a/b/memory.max", "max\n"),
            ("sys/fs/cgroup/a/b/memory.current", "5\n"),
        ]);
        assert_eq!(cgroup_bytes_left(second.path()), Some(150_000));
        let first = fake_proc_files(&[
            ("proc/self/cgroup", "5:devices:/\n4:cpu,memory:/not/seen/from/inside\n0::/\n"),
            ("sys/fs/cgroup/memory/memory.limit_in_bytes", "1000\n"),
            ("sys/fs/cgroup/memory/memory.usage_in_bytes", "400\n"),
        ]);
        assert_eq!(cgroup_bytes_left(first.path()), Some(600));
        assert_eq!(cgroup_bytes_left(fake_proc_files(&[("proc/self/cgroup", "0::/\n")]).path()), None);
        assert_eq!(cgroup_bytes_left(fake_proc_files(&[]).path()), None);
    }
}
