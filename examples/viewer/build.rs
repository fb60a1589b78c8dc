//! The three shader files of the window, from WGSL to SPIR-V: `shaders/NAME.wgsl` has the entry points `vertex` and
//! `fragment`, each becomes `NAME.vertex.spv` and `NAME.fragment.spv` with an entry point `main`.

use naga::back::spv;
use std::{env, fs, path::Path};

fn main() {
    let out = env::var("OUT_DIR").expect("cargo says it");
    for name in ["picture", "panel", "marks"] {
        let path = format!("shaders/{name}.wgsl");
        println!("cargo::rerun-if-changed={path}");
        let text = fs::read_to_string(&path).expect("a shader beside build.rs");
        let mut module = naga::front::wgsl::parse_str(&text)
            .unwrap_or_else(|error| panic!("{}", error.emit_to_string_with_path(&text, &path)));
        for stage in [naga::ShaderStage::Vertex, naga::ShaderStage::Fragment] {
            let words = spirv(&mut module, stage);
            let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_ne_bytes()).collect();
            let file = format!("{name}.{}.spv", format!("{stage:?}").to_lowercase());
            fs::write(Path::new(&out).join(file), bytes).expect("cargo's folder can be written");
        }
    }
}

fn spirv(module: &mut naga::Module, stage: naga::ShaderStage) -> Vec<u32> {
    use naga::valid::{Capabilities, ValidationFlags, Validator};
    let options = spv::Options {
        lang_version: (1, 5),
        // The default also flips y and clamps depth, which is not Vulkan's way.
        flags: spv::WriterFlags::empty(),
        // Group is set and binding is binding, unchanged.
        fake_missing_bindings: true,
        ..Default::default()
    };
    let entry = module.entry_points.iter_mut();
    let mut entry = entry
        .filter(|entry| entry.stage == stage)
        .collect::<Vec<_>>();
    let [entry] = &mut entry[..] else {
        panic!("a shader file has one entry point a stage")
    };
    let name = std::mem::replace(&mut entry.name, "main".into());
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(module)
        .expect("a valid shader");
    let pipeline = spv::PipelineOptions {
        shader_stage: stage,
        entry_point: "main".into(),
    };
    let words = spv::write_vec(module, &info, &options, Some(&pipeline));
    let entries = module.entry_points.iter_mut();
    for entry in entries.filter(|entry| entry.stage == stage) {
        entry.name.clone_from(&name);
    }
    words.expect("a valid module can be written")
}
