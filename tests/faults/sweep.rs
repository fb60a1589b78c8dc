//! Whatever call of Vulkan fails, whoever draws is told what could not be done, nothing is left behind, and the next
//! device draws the same picture.
//!
//! Every function that returns a `VkResult` and is called fails with every code that the specification gives it
//! (`hooked/codes.rs`): its first call, its second and its last. After all faults of a function a fresh device draws,
//! not after each one, which would take four times as long.

use crate::hooked::{
    FALLIBLE, FEATURES, Fault, Host, HostedDevice, Stage, Tape, codes, headless, hooked, of_device,
};
use ash::vk;
use std::collections::BTreeSet;
use std::error::Error;
use std::sync::Arc;
use stratavox::gpu::{self, Features, Gpu};
use stratavox::offscreen::Renderer;
use stratavox::scene::Scene;
use stratavox::technique::{Mode, Settings, Technique};

type Drawn = Result<Vec<u8>, Box<dyn Error>>;

/// What may fail without a word: names of objects, the wait before a device of our own goes, after which there is
/// nobody to tell, and what gives back, which has no code of a failure.
const COURTESIES: [&str; 4] = [
    "vkSetDebugUtilsObjectNameEXT",
    "vkDeviceWaitIdle",
    "vkFreeDescriptorSets",
    // What it tells of is of use, no more.
    "vkEnumerateDeviceExtensionProperties",
];

/// What may fail once: memory that the host writes is looked for in a second place, and among the extensions of an
/// instance we look for one that is needed, and told of, and for one that gives names.
const SECOND_TRIES: [&str; 3] = [
    "vkAllocateMemory",
    "vkMapMemory",
    "vkEnumerateInstanceExtensionProperties",
];

/// What came of the faults.
struct Swept {
    called: Vec<&'static str>,
    /// The functions whose failing was heard of.
    told: BTreeSet<&'static str>,
    faults: u32,
}

/// Makes each call of `functions` that `draw` makes fail in turn. `spares` is true where some of what is made only
/// saves time: without memory for it the picture is drawn all the same.
fn sweep(tape: &Tape, functions: &[&'static str], spares: bool, draw: impl Fn() -> Drawn) -> Swept {
    tape.rewind(None);
    let wanted = draw().expect("nothing fails yet");
    assert_eq!(tape.books(), Vec::<&str>::new(), "left by a picture");
    let calls = tape.calls();
    let called = functions.iter().filter(|name| calls.contains_key(*name));
    let called: Vec<_> = called.copied().collect();
    let (mut faults, mut told) = (0, BTreeSet::new());
    for &function in &called {
        let count = calls[function];
        let mut numbers = vec![0, 1, count - 1];
        numbers.retain(|&call| call < count);
        numbers.dedup();
        for (&result, &call) in codes(function)
            .iter()
            .flat_map(|r| numbers.iter().map(move |n| (r, n)))
        {
            let fault = Fault {
                function,
                call,
                result,
            };
            println!("{fault:?}");
            tape.rewind(Some(fault));
            let drawn = draw();
            assert!(tape.has_failed(), "{function} was not called so often");
            match drawn {
                Err(error) => {
                    assert_told(&*error, fault);
                    told.insert(function);
                }
                Ok(found) => {
                    let mut may_pass = COURTESIES.iter().chain(&SECOND_TRIES);
                    let is_of_memory = [
                        vk::Result::ERROR_OUT_OF_HOST_MEMORY,
                        vk::Result::ERROR_OUT_OF_DEVICE_MEMORY,
                    ]
                    .contains(&result);
                    assert!(
                        may_pass.any(|name| *name == function) || spares && is_of_memory,
                        "nobody heard of {fault:?}"
                    );
                    assert!(found == wanted, "{fault:?}: another picture");
                }
            }
            assert_eq!(tape.after_loss(), Vec::<&str>::new(), "{fault:?}");
            assert_eq!(tape.books(), Vec::<&str>::new(), "left by {fault:?}");
            faults += 1;
        }
        if COURTESIES.contains(&function) || !SECOND_TRIES.contains(&function) {
            assert_ne!(
                told.contains(function),
                COURTESIES.contains(&function),
                "{function}"
            );
        }
        tape.rewind(None);
        assert!(draw().unwrap() == wanted, "after faults of {function}");
    }
    Swept {
        called,
        told,
        faults,
    }
}

/// The error has the type of the code, and names what was being done.
fn assert_told(error: &(dyn Error + 'static), fault: Fault) {
    use gpu::Error as E;
    use vk::Result as R;
    let told = of_device(error);
    let doing = match (fault.result, told) {
        (
            R::ERROR_OUT_OF_HOST_MEMORY,
            E::OutOfMemory {
                doing,
                memory: "host",
            },
        )
        | (
            R::ERROR_OUT_OF_DEVICE_MEMORY,
            E::OutOfMemory {
                doing,
                memory: "device",
            },
        )
        | (R::ERROR_DEVICE_LOST, E::DeviceLost { doing })
        | (R::ERROR_FORMAT_NOT_SUPPORTED, E::Format { doing, .. }) => doing,
        (found, E::Vulkan { doing, result }) if found == *result => doing,
        // The allocator has its own words.
        (_, E::Allocation { doing, .. })
            if ["vkAllocateMemory", "vkMapMemory"].contains(&fault.function) =>
        {
            doing
        }
        (R::ERROR_INCOMPATIBLE_DRIVER | R::ERROR_INITIALIZATION_FAILED, E::NoDriver) => return,
        _ => panic!("{fault:?} became {told:?}"),
    };
    assert!(doing.len() > 5, "{fault:?}: {told}");
    assert!(
        told.to_string().starts_with(&format!("cannot {doing}")),
        "{told}"
    );
}

#[test]
fn a_host_is_told_of_every_call_that_fails_and_nothing_is_left_on_its_device() {
    let tape = Tape::begin();
    let (host, stage) = (Host::new(), Stage::new());
    let Swept {
        called,
        told,
        faults,
    } = sweep(&tape, FALLIBLE, false, || {
        let device = host.device(FEATURES);
        // SAFETY: the handles are right, and everything made on the device is dropped before it.
        let gpu = unsafe { Gpu::from_host(device.handles(hooked))? };
        stage.draw(&device, &gpu)
    });
    println!("{faults} faults of {} functions: {called:?}", called.len());
    for of_a_host in [
        "vkCreateCommandPool",
        "vkQueueSubmit",
        "vkWaitForFences",
        "vkCreateFence",
    ] {
        assert!(!called.contains(&of_a_host), "{of_a_host} is the host's");
    }
    for tried_again in ["vkAllocateMemory", "vkMapMemory"] {
        assert!(told.contains(tried_again), "{tried_again}");
    }
    assert!(faults > 90, "only {faults} faults");
}

#[test]
fn a_host_that_lets_us_submit_is_told_of_every_call_that_fails() {
    let ours = [
        "vkCreateCommandPool",
        "vkEndCommandBuffer",
        "vkQueueSubmit2",
    ];
    let Swept { called, faults, .. } = submitted(Stage::submit, ours);
    // A submitter has fences, for frames in parts: of one that is whole nobody waits for them.
    for of_a_host in ["vkQueueSubmit", "vkWaitForFences", "vkDeviceWaitIdle"] {
        assert!(!called.contains(&of_a_host), "{of_a_host} is the host's");
    }
    assert!(faults > 90, "only {faults} faults");
}

#[test]
fn a_host_that_lets_us_submit_in_parts_is_told_of_every_call_that_fails() {
    let ours = ["vkQueueSubmit2", "vkWaitForFences", "vkResetFences"];
    let Swept { faults, .. } = submitted(Stage::submit_in_parts, ours);
    assert!(faults > 100, "only {faults} faults");
}

type Submit = fn(&Stage, &HostedDevice<'_>, &Arc<Gpu>) -> Drawn;

/// Every call fails in turn of those that `submit` makes, `ours` among them.
fn submitted(submit: Submit, ours: [&str; 3]) -> Swept {
    let tape = Tape::begin();
    let (host, stage) = (Host::new(), Stage::new());
    let features = Features {
        timeline_semaphore: true,
        ..FEATURES
    };
    let swept = sweep(&tape, FALLIBLE, true, || {
        let device = host.device(features);
        // SAFETY: the handles are right, and everything made on the device is dropped before it.
        let gpu = unsafe { Gpu::from_host(device.handles(hooked))? };
        submit(&stage, &device, &gpu)
    });
    let Swept { called, faults, .. } = &swept;
    println!("{faults} faults of {} functions: {called:?}", called.len());
    for ours in ours {
        assert!(called.contains(&ours), "{ours}");
    }
    swept
}

/// Renders on a device of our own, made for it.
fn rendered(stage: &Stage, settings: &Settings) -> Drawn {
    let scene = Scene {
        beside: Default::default(),
        volume: &stage.volume,
        transfer: Some(&stage.transfer),
        camera: &stage.camera,
        extent_pixels: [16, 12],
        settings,
    };
    let mut renderer = Renderer::new(headless()?, &stage.volume)?;
    let pixels = renderer.render(&scene, &[])?.picture.pixels;
    Ok(bytemuck::cast_slice(&pixels).to_vec())
}

#[test]
fn a_device_of_our_own_tells_of_every_call_that_fails_and_goes_as_a_whole() {
    let tape = Tape::begin();
    let stage = Stage::new();
    // Rays, and a resolve that draws.
    let settings = Settings {
        mode: Mode::Mip,
        skip: false,
        ..Settings::default()
    };
    let Swept { called, faults, .. } =
        sweep(&tape, FALLIBLE, false, || rendered(&stage, &settings));
    println!("{faults} faults of {} functions: {called:?}", called.len());
    let never = FALLIBLE
        .iter()
        .copied()
        .filter(|name| !called.contains(name));
    // Names are given to objects where validation listens, caches are kept in files, and hosts have timelines.
    assert_eq!(
        never.collect::<Vec<_>>(),
        [
            "vkSetDebugUtilsObjectNameEXT",
            "vkGetPipelineCacheData",
            "vkQueueSubmit2"
        ]
    );
    assert!(faults > 150, "only {faults} faults");
}

#[test]
fn empty_space_for_which_there_is_no_memory_is_drawn_and_changes_nothing() {
    let tape = Tape::begin();
    let stage = Stage::new();
    let settings = Settings {
        technique: Technique::Slices3d,
        ..Settings::default()
    };
    assert!(settings.skip);
    let functions = [
        "vkCreateBuffer",
        "vkCreateComputePipelines",
        "vkAllocateDescriptorSets",
    ];
    let draw = || rendered(&stage, &settings);
    let Swept { called, faults, .. } = sweep(&tape, &functions, true, draw);
    assert_eq!(called, functions);
    println!("{faults} faults");
}
