//! What a device must have, told before there is one.

use super::host::{caps, features, sv_host_device};
use super::status::{Failure, guard, sv_diagnostic, sv_status};
use super::structure;
use crate::gpu::{
    API_VERSION, Enabled, Finding, HostPhysicalDevice, Need, REQUIREMENTS, Requirement,
    check_device,
};
use ash::vk::{self, Handle};
use std::ffi::{c_char, c_void};

/// One thing that a device has or lacks. Texts are UTF-8 that end with a zero.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct sv_requirement {
    /// Its name in the Vulkan specification.
    pub name: [c_char; 64],
    /// What is wanted of it.
    pub wanted: [c_char; 128],
    /// What was found; empty where no device was asked.
    pub found: [c_char; 128],
    /// What it is for.
    pub unlocks: [c_char; 256],
    /// Not 0: a device that lacks it is refused. 0: it draws less, or slower.
    pub is_required: u32,
    /// Not 0: it was found to be enough.
    pub is_met: u32,
}

/// All that is required and recommended, before there is a device. With `requirements` NULL, `count` is set to how many
/// there are; else as many are written, where `count` says that there is room for them. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_requirements(
    requirements: *mut sv_requirement,
    count: *mut u64,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        let all = REQUIREMENTS.iter();
        let all: Vec<_> = all.map(|asked| told(asked, "", false)).collect();
        // SAFETY: the caller's promise.
        unsafe { write(&all, requirements, count) }
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

/// The same, and what a physical device has of it: `instance`, `physical_device` and `get_instance_proc_addr` of `host`
/// are asked, and `device`, which may be NULL, is not. Where it is not NULL, `features` are those enabled; else those
/// that the device supports count. A version that is too old is all that is told of a device. Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sv_check_device(
    host: *const sv_host_device,
    requirements: *mut sv_requirement,
    count: *mut u64,
    diagnostic: *mut sv_diagnostic,
) -> sv_status {
    let body = || {
        // SAFETY: the caller's promise.
        let (host, limits) = unsafe {
            let host = structure::read(host)?;
            (host, structure::read_or_zero(host.limits)?)
        };
        let (Some(proc_addr), false, false) = (
            host.get_instance_proc_addr,
            host.instance.is_null(),
            host.physical_device.is_null(),
        ) else {
            return Err(Failure::argument(
                "sv_host_device: instance, physical_device or get_instance_proc_addr is NULL",
            ));
        };
        let features = features(host.features)?;
        let is_made = !host.device.is_null();
        // SAFETY: the same function, with handles where C has pointers to them; they belong together.
        let report = unsafe {
            check_device(&HostPhysicalDevice {
                get_instance_proc_addr: std::mem::transmute::<
                    unsafe extern "C" fn(*mut c_void, *const c_char) -> super::host::sv_vk_function,
                    vk::PFN_vkGetInstanceProcAddr,
                >(proc_addr),
                instance: vk::Instance::from_raw(host.instance as u64),
                api_version: match host.api_version {
                    0 => API_VERSION,
                    version => version,
                },
                physical_device: vk::PhysicalDevice::from_raw(host.physical_device as u64),
                queue_family: is_made.then_some(host.queue_family),
                enabled: is_made.then_some(Enabled {
                    features,
                    debug_utils: host.has_debug_utils != 0,
                }),
                caps: caps(&limits),
            })
        };
        let all = report
            .findings
            .iter()
            .map(|finding: &Finding| told(&finding.requirement, &finding.found, finding.is_met));
        // SAFETY: the caller's promise.
        unsafe { write(&all.collect::<Vec<_>>(), requirements, count) }
    };
    // SAFETY: the caller's promise.
    unsafe { guard(diagnostic, body) }
}

fn told(asked: &Requirement, found: &str, is_met: bool) -> sv_requirement {
    sv_requirement {
        name: text(&asked.item.to_string()),
        wanted: text(&asked.item.wanted()),
        found: text(found),
        unlocks: text(asked.unlocks),
        is_required: (asked.need == Need::Required).into(),
        is_met: is_met.into(),
    }
}

/// Cut where it is longer.
fn text<const N: usize>(text: &str) -> [c_char; N] {
    let mut end = text.len().min(N - 1);
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    let mut bytes = [0; N];
    for (to, from) in bytes.iter_mut().zip(text[..end].bytes()) {
        *to = from as c_char;
    }
    bytes
}

/// # Safety
/// `to` is NULL or has room for as many as `count` says.
unsafe fn write(
    all: &[sv_requirement],
    to: *mut sv_requirement,
    count: *mut u64,
) -> Result<(), Failure> {
    structure::out("the place of the number of requirements", count)?;
    // SAFETY: not NULL; the caller's promise.
    unsafe {
        let room = count.replace(all.len() as u64);
        if to.is_null() {
            return Ok(());
        }
        structure::out("the place of the requirements", to)?;
        if room < all.len() as u64 {
            let doing = "write all requirements";
            return Err(Failure::limit(doing, all.len() as u64, room));
        }
        to.copy_from_nonoverlapping(all.as_ptr(), all.len());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_text_of_the_list_is_cut() {
        for asked in REQUIREMENTS {
            assert!(asked.item.to_string().len() < 64, "{}", asked.item);
            assert!(asked.item.wanted().len() < 128, "{}", asked.item);
            assert!(asked.unlocks.len() < 256, "{}", asked.unlocks);
        }
    }
}
