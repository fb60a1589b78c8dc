//! The loader that a host gives away: what submits, waits or takes a queue ends the process.
//!
//! stratavox reaches Vulkan through the host's `vkGetInstanceProcAddr` only, so this proves that it never
//! calls such a function, whatever the host does with the real ones.

use ash::vk;
use std::ffi::{CStr, c_char};
use std::sync::OnceLock;

const FORBIDDEN: [&CStr; 10] = [
    c"vkQueueSubmit",
    c"vkQueueSubmit2",
    c"vkQueueBindSparse",
    c"vkQueueWaitIdle",
    c"vkDeviceWaitIdle",
    c"vkWaitForFences",
    c"vkWaitSemaphores",
    c"vkGetDeviceQueue",
    c"vkGetDeviceQueue2",
    c"vkDestroyDevice",
];

const TRAPS: [unsafe extern "system" fn(); 10] = [
    trap::<0>, trap::<1>, trap::<2>, trap::<3>, trap::<4>, trap::<5>, trap::<6>, trap::<7>,
    trap::<8>, trap::<9>,
];

unsafe extern "system" fn trap<const N: usize>() {
    eprintln!("stratavox called {:?}, which is the host's", FORBIDDEN[N]);
    std::process::abort();
}

/// The loader, once a process: unloaded, its functions would be gone.
pub fn entry() -> &'static ash::Entry {
    static ENTRY: OnceLock<ash::Entry> = OnceLock::new();
    // SAFETY: the loader is trusted.
    ENTRY.get_or_init(|| unsafe { ash::Entry::load() }.expect("a Vulkan loader"))
}

/// The real `vkGetDeviceProcAddr`: the loader's own, the same for every instance.
static REAL: OnceLock<vk::PFN_vkGetDeviceProcAddr> = OnceLock::new();

/// `vkGetInstanceProcAddr` that gives traps for what only a host may call.
///
/// # Safety
/// As `vkGetInstanceProcAddr`.
pub unsafe extern "system" fn guarded(
    instance: vk::Instance,
    name: *const c_char,
) -> vk::PFN_vkVoidFunction {
    let real = entry().static_fn().get_instance_proc_addr;
    // SAFETY: the caller's arguments are handed on.
    let (found, name) = unsafe { (real(instance, name), CStr::from_ptr(name)) };
    if name == c"vkGetDeviceProcAddr" {
        let found = found.expect("every loader has it");
        // SAFETY: this is the function of that name.
        REAL.get_or_init(|| unsafe { std::mem::transmute(found) });
        // SAFETY: back to the type of any function.
        return Some(unsafe {
            std::mem::transmute::<vk::PFN_vkGetDeviceProcAddr, unsafe extern "system" fn()>(
                device_proc_addr,
            )
        });
    }
    found
}

unsafe extern "system" fn device_proc_addr(
    device: vk::Device,
    name: *const c_char,
) -> vk::PFN_vkVoidFunction {
    let real = REAL
        .get()
        .expect("`guarded` gives this function, and sets that");
    // SAFETY: the caller's arguments are handed on.
    let (found, name) = unsafe { (real(device, name), CStr::from_ptr(name)) };
    match FORBIDDEN.iter().position(|forbidden| *forbidden == name) {
        Some(which) => Some(TRAPS[which]),
        None => found,
    }
}
