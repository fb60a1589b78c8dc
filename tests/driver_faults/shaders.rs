//! Shaders in place of shaders: put together as `build.rs` does, with one text changed.

use super::{Fault, Function, count, fault, real};
use ash::vk;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::cell::Cell;
use std::ffi::CStr;
use std::path::Path;
use stratavox::shaders::{SHADERS, SOFTWARE_ID, Shader};

#[path = "../../shaders/alternatives.rs"]
mod alternatives;
#[path = "../../shaders/compose.rs"]
#[allow(dead_code, reason = "dumps want single variants")]
mod compose;
#[path = "../../shaders/constants.rs"]
#[allow(dead_code, reason = "the build marks constants of its own")]
mod constants;
#[path = "../../src/shaders/fold.rs"]
mod fold;
#[path = "../../shaders/variants.rs"]
mod variants;

type Alloc = *const vk::AllocationCallbacks<'static>;

pub fn hook(name: &CStr) -> Option<(&'static str, Function)> {
    // SAFETY: `vkGetDeviceProcAddr` gives functions of every type as this one.
    let hook = unsafe { std::mem::transmute::<*const (), Function>(create as *const ()) };
    (name == c"vkCreateShaderModule").then_some(("vkCreateShaderModule", hook))
}

unsafe extern "system" fn create(
    device: vk::Device,
    info: *const vk::ShaderModuleCreateInfo<'static>,
    alloc: Alloc,
    out: *mut vk::ShaderModule,
) -> vk::Result {
    // SAFETY: the caller's arguments; the other words live until the call is done.
    unsafe {
        let mut info = *info;
        let words = std::slice::from_raw_parts(info.p_code, info.code_size / 4);
        let other = match fault() {
            Some(Fault::Shader(file, from, to)) => mutated(words, file, from, to),
            _ => None,
        };
        if let Some(other) = &other {
            (info.p_code, info.code_size) = (other.as_ptr(), 4 * other.len());
            count();
        }
        type Real = unsafe extern "system" fn(
            vk::Device,
            *const vk::ShaderModuleCreateInfo<'static>,
            Alloc,
            *mut vk::ShaderModule,
        ) -> vk::Result;
        let behind = std::mem::transmute::<usize, Real>(real("vkCreateShaderModule"));
        behind(device, &info, alloc, out)
    }
}

/// The words of the same shader with the change; `None` where it has no part in it.
fn mutated(words: &[u32], file: &str, from: &str, to: &str) -> Option<Vec<u32>> {
    let (shader, is_llvmpipe) = variant_of(words)?;
    let is_changed = Cell::new(false);
    let read = |path: &str| {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders");
        let text = std::fs::read_to_string(root.join(path)).expect("a shader");
        if path != file {
            return text;
        }
        assert!(
            text.contains(from),
            "{file} has no {from:?}: the fault is out of date"
        );
        is_changed.set(true);
        text.replace(from, to)
    };
    let (entry, slots, words) = entry_of(shader.name);
    let fills = compose::fills(slots, &words);
    let chosen: Vec<_> = slots
        .iter()
        .filter(|slot| slot.is_constant)
        .copied()
        .collect();
    let source = alternatives::merged(entry, &chosen, &fills, &read);
    let software = (SOFTWARE_ID, is_llvmpipe.into());
    let values = [&[software], shader.constants].concat();
    let folded = || fold::folded(&compiled(&source.text), &values);
    is_changed.get().then(folded)
}

/// The variant with these words, and whether they are for llvmpipe.
fn variant_of(words: &[u32]) -> Option<(&'static Shader, bool)> {
    /// The word of the header that says how many ids there are, which folding leaves as it is.
    const BOUND: usize = 3;
    let of_module = SHADERS
        .iter()
        .filter(|shader| shader.spirv()[BOUND] == words[BOUND]);
    let same = of_module
        .flat_map(|shader| [(shader, true), (shader, false)])
        .find(|(shader, is_llvmpipe)| shader.folded(*is_llvmpipe) == words);
    // What has no conversions has more ids.
    same.or_else(|| {
        let mut fewer = SHADERS
            .iter()
            .filter(|shader| shader.spirv()[BOUND] < words[BOUND]);
        let found = fewer.find(|shader| shader.without_conversions() == words);
        found.map(|shader| (shader, true))
    })
}

/// The file, the slots and the words of a variant.
fn entry_of(name: &str) -> (&'static str, &'static [variants::Slot], Vec<&'static str>) {
    let entries = variants::ENTRIES.iter().chain(variants::PROBES);
    let mut all = entries.flat_map(|&(file, slots)| {
        let sets = compose::combinations(slots).into_iter();
        sets.map(move |words| (file, slots, words))
    });
    let found = all.find(|(file, _, words)| compose::name(file, words) == name);
    found.unwrap_or_else(|| panic!("no variant {name}"))
}

fn compiled(text: &str) -> Vec<u32> {
    use naga::back::spv;
    let mut module =
        naga::front::wgsl::parse_str(text).unwrap_or_else(|e| panic!("{}", e.emit_to_string(text)));
    constants::mark(&mut module);
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    let info = validator
        .validate(&module)
        .unwrap_or_else(|e| panic!("{}", e.emit_to_string(text)));
    let options = spv::Options {
        lang_version: (1, 5),
        flags: spv::WriterFlags::LABEL_VARYINGS,
        fake_missing_bindings: true,
        zero_initialize_workgroup_memory: spv::ZeroInitializeWorkgroupMemoryMode::None,
        force_loop_bounding: false,
        emit_int_div_checks: false,
        use_storage_input_output_16: false,
        ..Default::default()
    };
    let entry = spv::PipelineOptions {
        shader_stage: module.entry_points[0].stage,
        entry_point: "main".into(),
    };
    let words = spv::write_vec(&module, &info, &options, Some(&entry)).expect("a valid module");
    constants::specialized(&words).0
}
