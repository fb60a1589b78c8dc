//! What the tests of the gpu floor share: a device, and shaders of a few lines.
#![allow(dead_code, reason = "each test file uses a part")]

use naga::{back::spv, front::wgsl, valid};
use std::sync::Arc;
use stratavox::gpu::{
    Buffer, Caps, DeviceChoice, Gpu, Headless, Memory, Options, PipelineCache, Validation,
};
use stratavox::shaders::{BindingKind, BindingSlot, Code, Shader, Stage};

/// A device with the limits of its own, without a cache file.
pub fn headless() -> Headless {
    clamped(Caps::UNLIMITED)
}

/// A device with stricter limits.
pub fn clamped(caps: Caps) -> Headless {
    let options = Options {
        caps,
        pipeline_cache: PipelineCache::Off,
        validation: Validation::default(),
    };
    Headless::new(&DeviceChoice::Default, &options)
        .expect("these tests need a Vulkan 1.3 device; lavapipe will do")
}

/// A buffer that shaders write and the host reads.
pub fn readback(gpu: &Arc<Gpu>, bytes: u64) -> Buffer {
    use ash::vk::BufferUsageFlags as Usage;
    let usage = Usage::STORAGE_BUFFER | Usage::TRANSFER_DST;
    Buffer::new(gpu, bytes, usage, Memory::Readback, "readback").unwrap()
}

/// All of a buffer as numbers.
pub fn numbers<T: bytemuck::Pod>(buffer: &Buffer) -> Vec<T> {
    let mut numbers = vec![T::zeroed(); buffer.bytes() as usize / size_of::<T>()];
    buffer
        .read(0, bytemuck::cast_slice_mut(&mut numbers))
        .unwrap();
    numbers
}

/// A binding slot.
pub const fn slot(binding: u32, name: &'static str, kind: BindingKind) -> BindingSlot {
    BindingSlot {
        name,
        binding,
        kind,
    }
}

/// Compiles WGSL whose entry point is `main`, as `build.rs` does.
pub fn shader(
    name: &'static str,
    stage: Stage,
    bindings: &'static [BindingSlot],
    text: &str,
) -> Shader {
    let module =
        wgsl::parse_str(text).unwrap_or_else(|error| panic!("{}", error.emit_to_string(text)));
    let info = valid::Validator::new(valid::ValidationFlags::all(), valid::Capabilities::empty())
        .validate(&module)
        .unwrap_or_else(|error| panic!("{}", error.emit_to_string(text)));
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
        shader_stage: match stage {
            Stage::Compute { .. } => naga::ShaderStage::Compute,
            Stage::Vertex => naga::ShaderStage::Vertex,
            Stage::Fragment => naga::ShaderStage::Fragment,
        },
        entry_point: "main".into(),
    };
    let spirv = spv::write_vec(&module, &info, &options, Some(&entry))
        .expect("a shader that SPIR-V can say");
    Shader {
        name,
        stage,
        code: Code::Words(spirv.leak()),
        constants: &[],
        bindings,
    }
}

const EIGHT: Stage = Stage::Compute {
    workgroup: [8, 1, 1],
};

/// `numbers.d[i] = params.factor * i + params.term`, for 64 numbers.
pub fn ramp() -> Shader {
    const BINDINGS: &[BindingSlot] = &[
        slot(0, "params", BindingKind::Uniform(8)),
        slot(1, "numbers", BindingKind::Storage),
    ];
    let text = "
        struct Params { factor: u32, term: u32 }
        struct Numbers { d: array<u32> }
        @group(0) @binding(0) var<uniform> params: Params;
        @group(0) @binding(1) var<storage, read_write> numbers: Numbers;
        @compute @workgroup_size(8)
        fn main(@builtin(global_invocation_id) id: vec3<u32>) {
            numbers.d[id.x] = params.factor * id.x + params.term;
        }";
    shader("test.ramp", EIGHT, BINDINGS, text)
}

/// `sums.d[i] = numbers.d[i + shift] + 1`, for 64 numbers.
pub fn shifted() -> Shader {
    const BINDINGS: &[BindingSlot] = &[
        slot(0, "params", BindingKind::Uniform(4)),
        slot(1, "numbers", BindingKind::Storage),
        slot(2, "sums", BindingKind::Storage),
    ];
    let text = "
        struct Params { shift: u32 }
        struct Numbers { d: array<u32> }
        @group(0) @binding(0) var<uniform> params: Params;
        @group(0) @binding(1) var<storage, read> numbers: Numbers;
        @group(0) @binding(2) var<storage, read_write> sums: Numbers;
        @compute @workgroup_size(8)
        fn main(@builtin(global_invocation_id) id: vec3<u32>) {
            sums.d[id.x] = numbers.d[id.x + params.shift] + 1u;
        }";
    shader("test.shifted", EIGHT, BINDINGS, text)
}

/// A triangle that covers the whole target.
pub fn cover() -> Shader {
    let text = "
        @vertex
        fn main(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
            let corner = vec2<f32>(f32((index << 1u) & 2u), f32(index & 2u));
            return vec4<f32>(2.0 * corner - 1.0, 0.0, 1.0);
        }";
    shader("test.cover", Stage::Vertex, &[], text)
}

/// One color, from the parameters.
pub fn flat() -> Shader {
    const BINDINGS: &[BindingSlot] = &[slot(0, "params", BindingKind::Uniform(16))];
    let text = "
        struct Params { color: vec4<f32> }
        @group(0) @binding(0) var<uniform> params: Params;
        @fragment
        fn main() -> @location(0) vec4<f32> { return params.color; }";
    shader("test.flat", Stage::Fragment, BINDINGS, text)
}
