//! Why nothing is drawn.

/// Why nothing is drawn. Nothing was recorded then, unless it says so.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The picture cannot be made as asked.
    #[error(transparent)]
    Technique(#[from] crate::technique::Error),
    /// The device refused.
    #[error(transparent)]
    Gpu(#[from] crate::gpu::Error),
    /// The camera sees nothing.
    #[error(transparent)]
    Camera(#[from] crate::camera::Error),
    /// What is not drawn inside a host's frame.
    #[error("{what} is not drawn inside a host's frame: {hint}")]
    NotEmbedded {
        /// What was asked for.
        what: &'static str,
        /// What to do.
        hint: &'static str,
    },
    /// Pipelines are of another kind of picture.
    #[error("the renderer was made for {made}, and {wanted} needs another one")]
    OtherDescription {
        /// What pipelines and textures are for.
        made: String,
        /// What was asked for.
        wanted: String,
    },
    /// The voxels, or the shapes of geometry, are not there yet.
    #[error("not uploaded: `record_upload` comes before the first frame that shows it")]
    NotUploaded,
    /// The voxels, or the shapes of geometry, have been recorded once.
    #[error("uploaded already: make another one for other voxels or shapes")]
    Uploaded,
    /// A vertex that is none.
    #[error("vertex {number} of {shapes}: its {what}: wanted {wanted}, found {found}")]
    Geometry {
        /// Round cones or triangles.
        shapes: &'static str,
        /// The vertex, in the order in which they were added.
        number: usize,
        /// What of it.
        what: &'static str,
        /// What would do.
        wanted: &'static str,
        /// What was given.
        found: String,
    },
    /// A target that loses what it holds.
    #[error("a target in layout {found:?}: wanted {wanted}")]
    TargetState {
        /// What would do.
        wanted: &'static str,
        /// The layout that was given.
        found: ash::vk::ImageLayout,
    },
    /// No frame is recorded in parts, or what it shows has changed since.
    #[error(
        "no frame {frame} is recorded in parts: `begin_parts` comes before `record_part_into`, and once more after a change"
    )]
    NotBegun {
        /// The frame in flight.
        frame: u32,
    },
    /// New voxels that the volume does not take.
    #[error("an update of a volume: wanted {wanted}, found {found}")]
    Update {
        /// What would do.
        wanted: String,
        /// What was given.
        found: String,
    },
    /// Updates of a volume that are not recorded as they were staged.
    #[error("an update of a volume out of its order: wanted {wanted}, found {found}")]
    UpdateOrder {
        /// What would do.
        wanted: &'static str,
        /// What was given.
        found: String,
    },
    /// Voxels of which a part is new.
    #[error(
        "voxels from {:?} to before {:?} are half changed: record the rest of their update, or one of all of them",
        region.min, region.max
    )]
    HalfUpdated {
        /// What the update changes.
        region: crate::volume::VoxelBox,
    },
    /// No frame in flight, or more than any host has.
    #[error("wanted 1 to {most} frames in flight, found {found}")]
    FramesInFlight {
        /// What was asked for.
        found: u32,
        /// What there may be.
        most: u32,
    },
    /// A frame in flight that there is none of.
    #[error("frame {found} of {of} frames in flight")]
    NoFrame {
        /// What was asked for.
        found: u32,
        /// How many there are.
        of: u32,
    },
    /// Nothing of this frame in flight has been recorded.
    #[error("nothing was recorded for frame {frame}: `record` comes before `{what}`")]
    NotRecorded {
        /// The frame in flight.
        frame: u32,
        /// What was called.
        what: &'static str,
    },
    /// This pixel was not copied since the frame was recorded.
    #[error("pixel ({}, {}) of frame {frame}: `record_pick` comes after `record` and before `pick`", pixel[0], pixel[1])]
    NotPicked {
        /// The frame in flight.
        frame: u32,
        /// What was asked for.
        pixel: [u32; 2],
    },
    /// The class and the shots, or the images, tell different stories of the host's depth.
    #[error("the host's depth: wanted {wanted}, found {found}")]
    HostDepth {
        /// What would do.
        wanted: String,
        /// What was given.
        found: String,
    },
    /// There is no depth in such pictures.
    #[error(
        "{what} has no depth to give back: modes with a place of their own have, with `RendererDesc::gives_depth` or `RendererDesc::picks`"
    )]
    NoDepth {
        /// Technique and mode.
        what: String,
    },
    /// A pixel outside of the picture.
    #[error("pixel ({}, {}) of a picture of {} x {}", found[0], found[1], extent[0], extent[1])]
    NoPixel {
        /// What was asked for.
        found: [u32; 2],
        /// The picture.
        extent: [u32; 2],
    },
}
