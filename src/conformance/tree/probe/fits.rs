//! Whether something large fits the device, before it is made: what does not is not supported, by the name of the limit.

use crate::conformance::case::Stop;
use crate::conformance::need::Found;
use crate::gpu::{self, DeviceKind, Gpu};

/// A limit of the library's checks as a lack of the device; all else stays an error.
pub fn lacking(error: gpu::Error) -> Stop {
    match error {
        gpu::Error::Limit {
            limit,
            wanted,
            allowed,
            ..
        } => less(limit, wanted, allowed),
        error => error.into(),
    }
}

/// Refuses to take so many bytes where memory is short: a quarter more than that has to be free, in the largest heap of
/// the device, and of the machine where the device has no memory of its own.
pub fn memory(gpu: &Gpu, bytes: u64) -> Result<(), Stop> {
    // What a driver pads an image by is known once it is made.
    let padded = bytes + bytes / 16;
    let allowed = gpu.limits().max_allocation_bytes;
    if padded > allowed {
        return Err(less("maxMemoryAllocationSize", padded, allowed));
    }
    let wanted = bytes + bytes / 4;
    let heaps = gpu.memory().heaps;
    let free = heaps
        .iter()
        .filter(|heap| heap.is_device_local)
        .map(|heap| heap.budget_bytes.saturating_sub(heap.used_bytes))
        .max()
        .unwrap_or(gpu.limits().max_heap_bytes);
    if free < wanted {
        return Err(less("free memory of the device in bytes", wanted, free));
    }
    let is_shared = gpu.identity().kind != DeviceKind::Discrete;
    match free_of_machine() {
        Some(free) if is_shared && free < wanted => {
            Err(less("free memory of the machine in bytes", wanted, free))
        }
        _ => Ok(()),
    }
}

fn less(name: &str, wanted: u64, found: u64) -> Stop {
    Stop::Lacking(Box::new(Found {
        name: name.to_owned(),
        wanted: format!("{wanted} or more"),
        device_says: found.to_string(),
        library_says: found.to_string(),
        device_has: false,
        library_has: false,
    }))
}

/// `MemAvailable` of Linux; none elsewhere.
fn free_of_machine() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = text
        .lines()
        .find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kib: u64 = line.trim().strip_suffix(" kB")?.parse().ok()?;
    kib.checked_mul(1024)
}
