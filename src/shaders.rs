//! What `build.rs` made of `shaders/*.wgsl`: SPIR-V, bindings, and the Rust structs of the parameters.
//!
//! Free of Vulkan: kinds of binding are words of our own that [`crate::gpu`] maps.

use std::sync::LazyLock;

/// One entry point, compiled.
#[derive(Clone, Copy, Debug)]
pub struct Shader {
    /// `file.variant`, as error messages and object names say it.
    pub name: &'static str,
    /// Compute, vertex or fragment; its entry point is called `main`.
    pub stage: Stage,
    /// SPIR-V 1.5; that of several variants, which [`Self::constants`] choose among.
    pub spirv: &'static [u32],
    /// `SpecId` and value of each specialization constant.
    pub constants: &'static [(u32, u32)],
    /// In order of `binding`; all of them in descriptor set 0.
    pub bindings: &'static [BindingSlot],
}

/// Every variant that `build.rs` has made, by name.
pub static SHADERS: LazyLock<Vec<Shader>> =
    LazyLock::new(|| shaders(bytemuck::cast_slice(&SPIRV.bytes)));

/// The variant of that name. A name that `build.rs` has no row for is our own mistake.
pub fn shader(name: &str) -> &'static Shader {
    find(name).unwrap_or_else(|| panic!("build.rs has no shader {name}"))
}

/// The same where it may be that there is none.
pub(crate) fn find(name: &str) -> Option<&'static Shader> {
    let found = SHADERS.binary_search_by(|shader| shader.name.cmp(name));
    found.ok().map(|index| &SHADERS[index])
}

/// `SpecId` of the constant that says whether the driver is llvmpipe, whatever the variant (`shaders/opaque.rs`).
pub const SOFTWARE_ID: u32 = 0;

/// The stage of an entry point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// With its workgroup size.
    Compute {
        /// Invocations along x, y, z.
        workgroup: [u32; 3],
    },
    /// Makes positions.
    Vertex,
    /// Makes colours.
    Fragment,
}

/// One variable of a shader that a host fills.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BindingSlot {
    /// The name in WGSL.
    pub name: &'static str,
    /// `@binding(n)`; the group is always 0.
    pub binding: u32,
    /// What it takes.
    pub kind: BindingKind,
}

/// What a binding takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BindingKind {
    /// A uniform buffer with a dynamic offset: one slot of the parameter ring, of this many bytes.
    Uniform(u32),
    /// A storage buffer.
    Storage,
    /// A sampled image.
    Texture,
    /// A sampler.
    Sampler,
    /// A storage image.
    StorageImage,
}

/// `include_bytes!` alone is aligned to one byte.
#[repr(C)]
struct Aligned<Bytes: ?Sized> {
    align: [u32; 0],
    bytes: Bytes,
}

static SPIRV: &Aligned<[u8]> = &Aligned {
    align: [],
    bytes: *include_bytes!(concat!(env!("OUT_DIR"), "/shaders.spv")),
};

include!(concat!(env!("OUT_DIR"), "/shaders.rs"));
