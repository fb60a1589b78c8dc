//! Shaders in place of shaders: put together as `build.rs` does, with one text changed.

use super::{Function, Lie, count, lie, real};
use ash::vk;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::collections::{BTreeMap, BTreeSet};
use std::ffi::CStr;
use std::path::{Path, PathBuf};
use stratavox::shaders::SHADERS;

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
        let other = match lie() {
            Some(Lie::Shader(file, from, to)) => mutated(words, file, from, to),
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
    let name = SHADERS.iter().find(|shader| shader.spirv == words)?.name;
    let (entry, fills) = entry_of(name);
    let mut source = Source {
        change: (file, from, to),
        fills,
        seen: BTreeSet::new(),
        text: String::new(),
        is_changed: false,
    };
    source.append(Path::new("shaders").join(entry).with_extension("wgsl"));
    source.is_changed.then(|| compiled(&source.text))
}

/// The file and the words of a variant.
fn entry_of(name: &str) -> (&'static str, BTreeMap<&'static str, &'static str>) {
    for (file, slots) in variants::ENTRIES.iter().chain(variants::PROBES) {
        let mut all: Vec<BTreeMap<&str, &str>> = vec![BTreeMap::new()];
        let mut names = vec![(*file).to_owned()];
        for (slot, words) in *slots {
            let (mut next, mut next_names) = (Vec::new(), Vec::new());
            for (fills, name) in all.iter().zip(&names) {
                for word in *words {
                    let mut fills = fills.clone();
                    fills.insert(*slot, *word);
                    next.push(fills);
                    let is_silent = variants::SILENT.contains(word);
                    let end = if is_silent {
                        String::new()
                    } else {
                        format!(".{word}")
                    };
                    next_names.push(format!("{name}{end}"));
                }
            }
            (all, names) = (next, next_names);
        }
        if let Some(at) = names.iter().position(|found| found == name) {
            return (file, all.swap_remove(at));
        }
    }
    panic!("no variant {name}");
}

struct Source<'a> {
    change: (&'a str, &'a str, &'a str),
    fills: BTreeMap<&'static str, &'static str>,
    seen: BTreeSet<PathBuf>,
    text: String,
    is_changed: bool,
}

impl Source<'_> {
    fn append(&mut self, path: PathBuf) {
        if !self.seen.insert(path.clone()) {
            return;
        }
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let mut text = std::fs::read_to_string(root.join(&path)).expect("a shader");
        let (file, from, to) = self.change;
        if path == Path::new("shaders").join(file) {
            assert!(
                text.contains(from),
                "{file} has no {from:?}: the lie is out of date"
            );
            text = text.replace(from, to);
            self.is_changed = true;
        }
        for line in text.lines() {
            match line.strip_prefix("#import ") {
                Some(name) => {
                    let name = variants::filled(name, &self.fills);
                    self.append(Path::new("shaders/lib").join(name).with_extension("wgsl"));
                }
                None => {
                    self.text += line;
                    self.text.push('\n');
                }
            }
        }
    }
}

fn compiled(text: &str) -> Vec<u32> {
    use naga::back::spv;
    let module =
        naga::front::wgsl::parse_str(text).unwrap_or_else(|e| panic!("{}", e.emit_to_string(text)));
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
    spv::write_vec(&module, &info, &options, Some(&entry)).expect("a valid module")
}
