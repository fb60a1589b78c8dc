//! What `build.rs` made of `shaders/*.wgsl`: SPIR-V, bindings, and the Rust structs of the parameters.
//!
//! Free of Vulkan: kinds of binding are words of our own that [`crate::gpu`] maps.

mod float_to_int;
mod fold;

use std::ops::Range;
use std::sync::OnceLock;

/// One entry point, compiled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Shader {
    /// `file.variant`, as error messages and object names say it.
    pub name: &'static str,
    /// Compute, vertex or fragment; its entry point is called `main`.
    pub stage: Stage,
    /// SPIR-V 1.5, of several variants, which [`Self::constants`] choose among.
    pub code: Code,
    /// `SpecId` and value of each specialization constant.
    pub constants: &'static [(u32, u32)],
    /// In order of `binding`; all of them in descriptor set 0.
    pub bindings: &'static [BindingSlot],
}

impl Shader {
    /// The words of the module, of several variants.
    pub fn spirv(&self) -> &'static [u32] {
        match self.code {
            Code::Words(words) => words,
            Code::Stored(module) => OPENED[module].get_or_init(|| opened(MODULES[module].clone())),
        }
    }

    /// The words of this variant alone, for llvmpipe or for any other driver.
    pub fn folded(&self, is_llvmpipe: bool) -> Vec<u32> {
        let software = (SOFTWARE_ID, is_llvmpipe.into());
        fold::folded(self.spirv(), &[&[software], self.constants].concat())
    }

    /// The words of this variant for llvmpipe, where that takes long over conversions: they have none of floats to
    /// whole numbers.
    pub fn without_conversions(&self) -> Vec<u32> {
        float_to_int::converting_by_shifts(&self.folded(true))
    }
}

/// Where the words of a module are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Code {
    /// In memory.
    Words(&'static [u32]),
    /// In the library, compressed, by the number of the module.
    Stored(usize),
}

/// Modules that were asked for.
static OPENED: [OnceLock<Vec<u32>>; MODULES.len()] = [const { OnceLock::new() }; MODULES.len()];

/// The words that `build.rs` has compressed to these bytes.
fn opened(bytes: Range<usize>) -> Vec<u32> {
    static STORED: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/shaders.deflate"));
    let bytes = miniz_oxide::inflate::decompress_to_vec(&STORED[bytes]);
    bytemuck::pod_collect_to_vec(&bytes.expect("what the build has compressed"))
}

/// Every variant that `build.rs` has made, by name.
pub static SHADERS: &[Shader] = TABLE;

/// The variant of that name. A name that `build.rs` has no row for is our own mistake.
pub fn shader(name: &str) -> &'static Shader {
    find(name).unwrap_or_else(|| panic!("build.rs has no shader {name}"))
}

/// The same where it may be that there is none.
pub(crate) fn find(name: &str) -> Option<&'static Shader> {
    let found = SHADERS.binary_search_by(|shader| shader.name.cmp(name));
    found.ok().map(|index| &SHADERS[index])
}

/// `SpecId` of the constant that says whether the driver is llvmpipe, whatever the variant (`shaders/opaque_predicates.rs`).
pub const SOFTWARE_ID: u32 = 0;

/// The stage of an entry point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
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
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct BindingSlot {
    /// The name in WGSL.
    pub name: &'static str,
    /// `@binding(n)`; the group is always 0.
    pub binding: u32,
    /// What it takes.
    pub kind: BindingKind,
}

/// What a binding takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
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

include!(concat!(env!("OUT_DIR"), "/shaders.rs"));
