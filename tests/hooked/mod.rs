//! A `vkGetInstanceProcAddr` that stands between stratavox and Vulkan: it counts calls, makes the n-th of a function
//! fail, hides what a device has, and keeps the books of what was made and not destroyed.
#![allow(dead_code, unused_imports, reason = "each test file uses its part")]

mod codes;
mod functions;
mod host;
mod stage;
mod told;

pub use codes::codes;
pub use functions::FALLIBLE;
pub use host::{Host, HostedDevice};
pub use stage::Stage;
pub use told::{FEATURES, headless, of_device};

use ash::vk;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::ffi::{CStr, c_char};
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

/// Fails one call.
#[derive(Clone, Copy, Debug)]
pub struct Fault {
    pub function: &'static str,
    /// Counted from 0.
    pub call: u32,
    pub result: vk::Result,
}

/// What a physical device is said to lack.
#[derive(Clone, Copy, Debug, Default)]
pub struct Lacking {
    pub format: (vk::Format, vk::FormatFeatureFlags),
    pub timestamps: bool,
    pub device_extensions: bool,
    /// It lists `VK_KHR_portability_subset`: parts of Vulkan may be missing.
    pub parts: bool,
}

#[derive(Default)]
struct State {
    real: HashMap<&'static str, usize>,
    calls: BTreeMap<&'static str, u32>,
    fault: Option<Fault>,
    has_failed: bool,
    is_lost: bool,
    after_loss: Vec<&'static str>,
    alive: BTreeSet<(&'static str, u64)>,
    /// Destroyed, and never made.
    strangers: Vec<&'static str>,
    lacking: Lacking,
}

static STATE: Mutex<Option<State>> = Mutex::new(None);

fn with<T>(act: impl FnOnce(&mut State) -> T) -> T {
    let mut state = STATE.lock().unwrap_or_else(PoisonError::into_inner);
    act(state.get_or_insert_default())
}

/// All that was heard since [`Tape::begin`]. One at a time in a process: functions have no other state than this.
pub struct Tape(MutexGuard<'static, ()>);

impl Tape {
    pub fn begin() -> Self {
        static ONE: Mutex<()> = Mutex::new(());
        let tape = Self(ONE.lock().unwrap_or_else(PoisonError::into_inner));
        tape.rewind(None);
        tape
    }

    /// Forgets everything and makes `fault` fail.
    pub fn rewind(&self, fault: Option<Fault>) {
        with(|state| {
            *state = State {
                fault,
                real: std::mem::take(&mut state.real),
                ..State::default()
            }
        });
    }

    pub fn hide(&self, lacking: Lacking) {
        with(|state| state.lacking = lacking);
    }

    /// The device is lost from now on: calls are noted.
    pub fn lose(&self) {
        with(|state| state.is_lost = true);
    }

    /// The next call of `function` loses the device.
    pub fn lose_at_next(&self, function: &'static str) {
        with(|state| {
            state.fault = Some(Fault {
                function,
                call: state.calls.get(function).copied().unwrap_or(0),
                result: vk::Result::ERROR_DEVICE_LOST,
            })
        });
    }

    /// Makes the `nth` call of `function` from now on fail, and keeps the books.
    pub fn fail_from_now(&self, function: &'static str, nth: u32, result: vk::Result) {
        with(|state| {
            let before = state.calls.get(function).copied().unwrap_or(0);
            state.has_failed = false;
            state.fault = Some(Fault {
                function,
                call: before + nth,
                result,
            });
        });
    }

    /// Nothing fails any more.
    pub fn mend(&self) {
        with(|state| state.fault = None);
    }

    pub fn calls(&self) -> BTreeMap<&'static str, u32> {
        with(|state| state.calls.clone())
    }

    pub fn has_failed(&self) -> bool {
        with(|state| state.has_failed)
    }

    /// What was called on the device once it was lost, but to end things.
    pub fn after_loss(&self) -> Vec<&'static str> {
        with(|state| state.after_loss.clone())
    }

    /// What was made and not destroyed, and what was destroyed and not made.
    pub fn books(&self) -> Vec<&'static str> {
        with(|state| {
            let alive = state.alive.iter().map(|(kind, _)| *kind);
            alive.chain(state.strangers.iter().copied()).collect()
        })
    }
}

/// Ends things, or asks no device.
fn is_allowed_after_loss(function: &str) -> bool {
    let ends = ["vkDestroy", "vkFree", "vkUnmapMemory", "vkDeviceWaitIdle"];
    let asks = ["vkGetPhysicalDevice", "vkEnumerate", "vkCreateInstance"];
    let mut allowed = ends.iter().chain(&asks);
    allowed.any(|start| function.starts_with(start))
}

/// Notes a call, and says where it is to fail.
fn enter(function: &'static str) -> Option<vk::Result> {
    with(|state| {
        let calls = state.calls.entry(function).or_default();
        let call = *calls;
        *calls += 1;
        if state.is_lost && !is_allowed_after_loss(function) {
            state.after_loss.push(function);
        }
        let fault = state.fault?;
        if fault.function != function || fault.call != call {
            return None;
        }
        state.has_failed = true;
        state.is_lost |= fault.result == vk::Result::ERROR_DEVICE_LOST;
        Some(fault.result)
    })
}

fn made(kind: &'static str, handle: impl vk::Handle) {
    let is_new = with(|state| state.alive.insert((kind, handle.as_raw())));
    assert!(is_new, "{kind} made twice");
}

fn gone(kind: &'static str, handle: impl vk::Handle + Copy) {
    with(|state| {
        if !handle.is_null() && !state.alive.remove(&(kind, handle.as_raw())) {
            state.strangers.push(kind);
        }
    });
}

fn lacking() -> Lacking {
    with(|state| state.lacking)
}

fn real_of(function: &str) -> usize {
    with(|state| state.real[function])
}

/// The loader, once a process: unloaded, its functions would be gone.
pub fn entry() -> &'static ash::Entry {
    static ENTRY: OnceLock<ash::Entry> = OnceLock::new();
    // SAFETY: the loader is trusted.
    ENTRY.get_or_init(|| unsafe { ash::Entry::load() }.expect("a Vulkan loader"))
}

/// The real `vkGetDeviceProcAddr`: the loader's own, the same for every instance.
static REAL: OnceLock<vk::PFN_vkGetDeviceProcAddr> = OnceLock::new();

/// Stands for the loader's `vkGetInstanceProcAddr`.
///
/// # Safety
/// As `vkGetInstanceProcAddr`.
pub unsafe extern "system" fn hooked(
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
            type Function = unsafe extern "system" fn();
            type Ours = vk::PFN_vkGetDeviceProcAddr;
            REAL.get_or_init(|| std::mem::transmute::<Function, Ours>(found));
            return Some(std::mem::transmute::<Ours, Function>(device_proc_addr));
        }
    }
    in_place_of(found, name)
}

unsafe extern "system" fn device_proc_addr(
    device: vk::Device,
    name: *const c_char,
) -> vk::PFN_vkVoidFunction {
    let real = REAL.get().expect("`hooked` gives this, and sets that");
    // SAFETY: the caller's arguments are handed on.
    let (found, name) = unsafe { (real(device, name)?, CStr::from_ptr(name)) };
    in_place_of(found, name)
}

fn in_place_of(real: unsafe extern "system" fn(), name: &CStr) -> vk::PFN_vkVoidFunction {
    let (name, hook) = functions::hook(name.to_str().ok()?)?;
    with(|state| state.real.insert(name, real as usize));
    Some(hook)
}
