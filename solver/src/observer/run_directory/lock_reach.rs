//! Whether a lock of a file is known to processes on other computers.

use std::path::Path;

/// Types of file systems that several computers write to, and whose locks may be those of one computer alone:
/// NFS, SMB, CIFS, SMB2, AFS, Lustre, GPFS, BeeGFS, Ceph, FUSE (`statfs(2)`, and the sources of Lustre and BeeGFS).
#[cfg(target_os = "linux")]
const SHARED: [u64; 10] = [
    0x6969,
    0x517B,
    0xFF53_4D42,
    0xFE53_4D42,
    0x5346_414F,
    0x0BD0_0BD0,
    0x4750_4653,
    0x1983_0326,
    0x00C3_6400,
    0x6573_5546,
];

/// Whether all computers that write to a directory see its locks: certain where this one alone does.
#[cfg(target_os = "linux")]
pub fn sees_other_hosts(directory: &Path) -> bool {
    let Ok(found) = rustix::fs::statfs(directory) else { return false };
    // Of numbers with a sign the bits matter
    u64::try_from(found.f_type & 0xFFFF_FFFF).is_ok_and(|kind| !SHARED.contains(&kind))
}

/// The same where it is not known.
#[cfg(not(target_os = "linux"))]
pub fn sees_other_hosts(_directory: &Path) -> bool {
    true
}
