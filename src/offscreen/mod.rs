//! A scene to a picture, on either side: [`Renderer`] on a device of our own, [`mod@reference`] on the CPU.
//!
//! The only place that submits and waits.

mod behind;
mod denoise;
mod fade;
mod gathered;
mod gradients;
mod keyed;
mod layer_rules;
mod light;
mod passes;
mod position;
mod probe;
pub mod reference;
mod renderer;
mod stream;
mod submission;
mod sum;
mod targets;
mod time_slices;
mod upload;

pub use behind::check_geometry;
pub use denoise::denoised;
pub use probe::{Ceilings, ceilings};
pub use renderer::{Filtered, Kept, PathSums, Rendered, Renderer, Traced};
pub use stream::{Stream, StreamOptions};

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The picture cannot be made as asked.
    #[error(transparent)]
    Technique(#[from] crate::technique::Error),
    /// The device refused.
    #[error(transparent)]
    Gpu(#[from] crate::gpu::Error),
    /// A layer that this technique and mode do not have.
    #[error("{technique} has no layer `{}` in mode {mode}", layer.name())]
    NoLayer {
        /// The rendering technique.
        technique: crate::technique::Technique,
        /// What is done with them.
        mode: crate::technique::Mode,
        /// What was asked for.
        layer: crate::picture::LayerKind,
    },
    /// The layer of labels, in a picture of none.
    #[error(
        "the layer `label` is for a label map over the volume, or for one volume of labels with the filter nearest"
    )]
    NoLabels,
    /// The layer of normals, of what is no single volume in memory.
    #[error("the layer `normal` is for one volume of numbers in memory")]
    NoNormals,
    /// Layers of paths, of a picture that goes on from the sums of others.
    #[error(
        "layers of paths, and guides of the filter that takes noise out, are of all its paths, and this picture goes on from sums without them"
    )]
    NoLayersOfBegun,
    /// The layer of lines, in a picture without geometry.
    #[error("the layer `line` is for pictures with geometry")]
    NoLines,
    /// A brick of a [`Stream`] cannot be read.
    #[error(transparent)]
    Read(#[from] crate::volume::ReadError),
    /// What is for volumes in memory alone.
    #[error("a volume that is drawn brick by brick has no {what}")]
    NotStreamed {
        /// What was asked for.
        what: &'static str,
    },
    /// A scene of more volumes than its renderer was made of.
    #[error("the scene shows {wanted} volumes, and the renderer was made of {found}")]
    FewerVolumes {
        /// Of the scene.
        wanted: usize,
        /// Of the renderer.
        found: usize,
    },
    /// A scene and a renderer of different streams.
    #[error("the scene shows a stream, and the renderer is not one of that stream")]
    Outline,
}
