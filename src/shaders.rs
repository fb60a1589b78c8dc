//! What `build.rs` made of `shaders/*.wgsl`: SPIR-V, bindings, and the Rust structs of the parameters.
//!
//! Free of Vulkan: kinds of binding are words of our own that [`crate::gpu`] maps.

/// One entry point, compiled.
#[derive(Clone, Copy, Debug)]
pub struct Shader {
    /// `file.variant`, as error messages and object names say it.
    pub name: &'static str,
    /// Compute, vertex or fragment; its entry point is called `main`.
    pub stage: Stage,
    /// SPIR-V 1.3 or later.
    pub spirv: &'static [u32],
    /// In order of `binding`; all of them in descriptor set 0.
    pub bindings: &'static [BindingSlot],
}

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
