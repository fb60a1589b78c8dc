//! A Vulkan driver with injected faults: between the suite and the driver stand functions that change one thing, as a faulty driver
//! would.
//!
//! ```text
//! Fault::State     what is recorded and made is changed on its way to the driver: blend factors, samplers, viewports, draws
//! Fault::Shader    a shader is another: its WGSL with one text in place of another, compiled anew
//! ```
#![allow(dead_code, unused_imports, reason = "each test file uses its part")]

mod answers;
mod shaders;
mod states;
mod table;
mod table_geometry;
mod table_host;
mod table_probes;
mod table_scatter;
mod table_splat;
mod table_voxels;
mod table_warp;
mod transfers;

use ash::vk;
use std::collections::HashMap;
use std::ffi::{CStr, c_char};
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

pub use answers::ANSWERS;
pub use states::State;
pub use table::{CLAMPED_FAULTS, FAULTS};
pub use table_geometry::{CONE_FAULTS, END_FAULTS};
pub use table_host::{NOISE_FAULTS, TONE_FAULTS};
pub use table_probes::PROBE_FAULTS;
pub use table_scatter::{DARK_FAULT, GRAZING_FAULT, HALO_FAULT, SCATTER_FAULTS};
pub use table_splat::SPLAT_FAULTS;
pub use table_voxels::VOXEL_FAULTS;
pub use table_warp::WARP_FAULTS;

/// The real function of that name, called.
macro_rules! behind {
    ($name:ident: fn($($type:ty),*) $(-> $out:ty)?, ($($arg:expr),*)) => {{
        type Real = unsafe extern "system" fn($($type),*) $(-> $out)?;
        std::mem::transmute::<usize, Real>(real(stringify!($name)))($($arg),*)
    }};
}

/// The hook of that name, one of those of the module that asks.
macro_rules! hooks {
    ($name:expr, $($function:ident),*) => {
        match $name.to_str().ok()? {
            $(stringify!($function) => {
                // SAFETY: `vkGetDeviceProcAddr` gives functions of every type as this one.
                let hook = unsafe { std::mem::transmute::<*const (), Function>($function as *const ()) };
                Some((stringify!($function), hook))
            })*
            _ => None,
        }
    };
}

use {behind, hooks};

/// One thing that is not as it should be.
#[derive(Clone, Copy, Debug)]
pub enum Fault {
    State(State),
    /// A file under `shaders`, what stands there, and what stands there instead.
    Shader(&'static str, &'static str, &'static str),
}

static FAULT: Mutex<Option<Fault>> = Mutex::new(None);
/// One fault at a time is told in a process: held by whoever tells.
static ONE: Mutex<()> = Mutex::new(());

/// To be held while faults are told.
pub fn alone() -> MutexGuard<'static, ()> {
    ONE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// How often the fault was told.
static TOLD: Mutex<u32> = Mutex::new(0);

/// From now on this is told, or nothing but the truth.
pub fn tell(fault: Option<Fault>) {
    *FAULT.lock().unwrap_or_else(PoisonError::into_inner) = fault;
    *TOLD.lock().unwrap_or_else(PoisonError::into_inner) = 0;
}

/// How often it has been told.
pub fn told() -> u32 {
    *TOLD.lock().unwrap_or_else(PoisonError::into_inner)
}

fn fault() -> Option<Fault> {
    *FAULT.lock().unwrap_or_else(PoisonError::into_inner)
}

fn count() {
    *TOLD.lock().unwrap_or_else(PoisonError::into_inner) += 1;
}

type Function = unsafe extern "system" fn();

/// What stands behind each function that is hooked.
static REAL: Mutex<Option<HashMap<&'static str, usize>>> = Mutex::new(None);

fn real(name: &'static str) -> usize {
    let real = REAL.lock().unwrap_or_else(PoisonError::into_inner);
    real.as_ref().expect("asked for first")[name]
}

fn in_place_of(found: Function, name: &CStr) -> Function {
    let Some((name, hook)) = states::hook(name)
        .or_else(|| transfers::hook(name))
        .or_else(|| shaders::hook(name))
    else {
        return found;
    };
    let mut real = REAL.lock().unwrap_or_else(PoisonError::into_inner);
    real.get_or_insert_default().insert(name, found as usize);
    hook
}

fn entry() -> &'static ash::Entry {
    static ENTRY: OnceLock<ash::Entry> = OnceLock::new();
    // SAFETY: the loader is trusted.
    ENTRY.get_or_init(|| unsafe { ash::Entry::load() }.expect("a Vulkan loader"))
}

static DEVICE: OnceLock<vk::PFN_vkGetDeviceProcAddr> = OnceLock::new();

/// Stands for the loader's `vkGetInstanceProcAddr`.
///
/// # Safety
/// As `vkGetInstanceProcAddr`.
pub unsafe extern "system" fn faulty(
    instance: vk::Instance,
    name: *const c_char,
) -> vk::PFN_vkVoidFunction {
    // SAFETY: the caller's arguments are handed on.
    let (found, name) = unsafe {
        let real = entry().static_fn().get_instance_proc_addr;
        (real(instance, name)?, CStr::from_ptr(name))
    };
    if name == c"vkGetDeviceProcAddr" {
        // SAFETY: this is the function of that name; ours goes back as the type of any function.
        unsafe {
            type Ours = vk::PFN_vkGetDeviceProcAddr;
            DEVICE.get_or_init(|| std::mem::transmute::<Function, Ours>(found));
            return Some(std::mem::transmute::<Ours, Function>(device_proc_addr));
        }
    }
    Some(in_place_of(found, name))
}

unsafe extern "system" fn device_proc_addr(
    device: vk::Device,
    name: *const c_char,
) -> vk::PFN_vkVoidFunction {
    let real = DEVICE.get().expect("`faulty` gives this, and sets that");
    // SAFETY: the caller's arguments are handed on.
    let (found, name) = unsafe { (real(device, name)?, CStr::from_ptr(name)) };
    Some(in_place_of(found, name))
}
