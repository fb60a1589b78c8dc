//! Barriers in two words: what was done before, what is done after.
//!
//! One table gives the stage, the access and the layout of each word ([`Use::state`]).

use super::{Buffer, Gpu, Image, image::WHOLE_COLOR, image::whole};
use ash::vk::{self, AccessFlags2 as Access, ImageLayout as Layout, PipelineStageFlags2 as Stage};

/// What a pass does with an image or a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Use {
    /// Nothing that counts: as `before`, the content is given up.
    Nothing,
    /// A compute shader reads a texture.
    ComputeSampled,
    /// A compute shader reads a storage buffer or storage image.
    ComputeRead,
    /// A compute shader writes (and may read) a storage buffer or storage image.
    ComputeWrite,
    /// A fragment shader reads a texture.
    FragmentSampled,
    /// Any shader reads a texture.
    Sampled,
    /// A vertex or fragment shader reads a storage buffer.
    DrawRead,
    /// The parameters of a draw or of a dispatch.
    DrawIndirect,
    /// As `before`: a compute shader has used it, and the content is given up.
    ComputeDone,
    /// As `before`: compute and fragment shaders have used it, and the content is given up.
    ShadersDone,
    /// A color target, blended or not.
    ColorTarget,
    /// A depth attachment, tested and written.
    DepthTarget,
    /// As `before`: a depth attachment, whose content is given up.
    DepthDone,
    /// The source of a copy.
    TransferRead,
    /// The destination of a copy, a fill or a clear.
    TransferWrite,
    /// The host reads mapped memory after the submission.
    HostRead,
    /// The host has written the texels of an image before the submission ([`Image::written_by_host`]).
    HostWrite,
    /// Any shader reads a texture, or the same as a storage image.
    SampledOrRead,
}

impl Use {
    /// Whether it leaves the content as it is.
    pub(crate) const fn is_read(self) -> bool {
        matches!(
            self,
            Self::ComputeSampled
                | Self::ComputeRead
                | Self::FragmentSampled
                | Self::Sampled
                | Self::SampledOrRead
                | Self::DrawRead
                | Self::DrawIndirect
                | Self::TransferRead
        )
    }

    /// The one table. Sampling is `SHADER_READ`: the layer's best practices do not know the finer word.
    pub const fn state(self) -> (Stage, Access, Layout) {
        match self {
            Self::Nothing => (Stage::NONE, Access::NONE, Layout::UNDEFINED),
            Self::ComputeSampled => (
                Stage::COMPUTE_SHADER,
                Access::SHADER_READ,
                Layout::SHADER_READ_ONLY_OPTIMAL,
            ),
            Self::ComputeRead => (
                Stage::COMPUTE_SHADER,
                Access::SHADER_STORAGE_READ,
                Layout::GENERAL,
            ),
            Self::ComputeWrite => (Stage::COMPUTE_SHADER, STORAGE, Layout::GENERAL),
            Self::FragmentSampled => (
                Stage::FRAGMENT_SHADER,
                Access::SHADER_READ,
                Layout::SHADER_READ_ONLY_OPTIMAL,
            ),
            Self::Sampled => (
                Stage::from_raw(DRAW.as_raw() | Stage::COMPUTE_SHADER.as_raw()),
                Access::SHADER_SAMPLED_READ,
                Layout::SHADER_READ_ONLY_OPTIMAL,
            ),
            Self::DrawRead => (DRAW, Access::SHADER_STORAGE_READ, Layout::GENERAL),
            Self::DrawIndirect => (
                Stage::DRAW_INDIRECT,
                Access::INDIRECT_COMMAND_READ,
                Layout::GENERAL,
            ),
            Self::ComputeDone => (Stage::COMPUTE_SHADER, STORAGE, Layout::UNDEFINED),
            Self::ShadersDone => (
                Stage::from_raw(Stage::COMPUTE_SHADER.as_raw() | Stage::FRAGMENT_SHADER.as_raw()),
                STORAGE,
                Layout::UNDEFINED,
            ),
            Self::ColorTarget => (
                Stage::COLOR_ATTACHMENT_OUTPUT,
                COLOR,
                Layout::COLOR_ATTACHMENT_OPTIMAL,
            ),
            Self::DepthTarget => (DEPTH_TESTS, DEPTH, Layout::DEPTH_ATTACHMENT_OPTIMAL),
            Self::DepthDone => (DEPTH_TESTS, DEPTH, Layout::UNDEFINED),
            Self::TransferRead => (
                Stage::ALL_TRANSFER,
                Access::TRANSFER_READ,
                Layout::TRANSFER_SRC_OPTIMAL,
            ),
            Self::TransferWrite => (
                Stage::ALL_TRANSFER,
                Access::TRANSFER_WRITE,
                Layout::TRANSFER_DST_OPTIMAL,
            ),
            Self::HostWrite => (Stage::HOST, Access::HOST_WRITE, Layout::PREINITIALIZED),
            Self::SampledOrRead => (
                Stage::from_raw(DRAW.as_raw() | Stage::COMPUTE_SHADER.as_raw()),
                Access::from_raw(
                    Access::SHADER_SAMPLED_READ.as_raw() | Access::SHADER_STORAGE_READ.as_raw(),
                ),
                Layout::GENERAL,
            ),
            Self::HostRead => (Stage::HOST, Access::HOST_READ, Layout::GENERAL),
        }
    }
}

/// Textures too: what is written may stand in for one that is not looked at.
const STORAGE: Access = Access::from_raw(
    Access::SHADER_STORAGE_READ.as_raw()
        | Access::SHADER_STORAGE_WRITE.as_raw()
        | Access::SHADER_SAMPLED_READ.as_raw(),
);
const COLOR: Access = Access::from_raw(
    Access::COLOR_ATTACHMENT_READ.as_raw() | Access::COLOR_ATTACHMENT_WRITE.as_raw(),
);
const DEPTH_TESTS: Stage =
    Stage::from_raw(Stage::EARLY_FRAGMENT_TESTS.as_raw() | Stage::LATE_FRAGMENT_TESTS.as_raw());
const DEPTH: Access = Access::from_raw(
    Access::DEPTH_STENCIL_ATTACHMENT_READ.as_raw()
        | Access::DEPTH_STENCIL_ATTACHMENT_WRITE.as_raw(),
);
const DRAW: Stage =
    Stage::from_raw(Stage::VERTEX_SHADER.as_raw() | Stage::FRAGMENT_SHADER.as_raw());

/// Orders two uses of all of an image of ours and brings it into the layout of the second.
///
/// # Safety
///
/// - `cmd` is recording on `gpu`'s device, outside rendering, and `image` lives until it has run;
/// - `before` is what was last done with the image ([`Use::Nothing`]: nothing unfinished uses it).
pub unsafe fn image_barrier(
    gpu: &Gpu,
    cmd: vk::CommandBuffer,
    image: &Image,
    before: Use,
    after: Use,
) {
    // SAFETY: the caller's promises.
    unsafe { barriers(gpu, cmd, [], [], [(image, before, after)]) };
}

/// Orders two uses of all of a buffer.
///
/// # Safety
///
/// As [`image_barrier`].
pub unsafe fn buffer_barrier(
    gpu: &Gpu,
    cmd: vk::CommandBuffer,
    buffer: &Buffer,
    before: Use,
    after: Use,
) {
    // SAFETY: the caller's promises.
    unsafe { barriers(gpu, cmd, [], [(buffer, before, after)], []) };
}

/// Orders in one command two uses of everything that they use, which keeps its layout; of buffers; and of images, as
/// [`image_barrier`]: a device stops once.
///
/// # Safety
///
/// As [`image_barrier`].
pub(crate) unsafe fn barriers<const A: usize, const B: usize, const I: usize>(
    gpu: &Gpu,
    cmd: vk::CommandBuffer,
    all: [(Use, Use); A],
    buffers: [(&Buffer, Use, Use); B],
    images: [(&Image, Use, Use); I],
) {
    let all = all.map(|(before, after)| {
        let ((stage, access, _), (next_stage, next_access, _)) = (before.state(), after.state());
        vk::MemoryBarrier2::default()
            .src_stage_mask(stage)
            .src_access_mask(access)
            .dst_stage_mask(next_stage)
            .dst_access_mask(next_access)
    });
    let buffers = buffers.map(|(buffer, before, after)| {
        let ((stage, access, _), (next_stage, next_access, _)) = (before.state(), after.state());
        vk::BufferMemoryBarrier2::default()
            .src_stage_mask(stage)
            .src_access_mask(access)
            .dst_stage_mask(next_stage)
            .dst_access_mask(next_access)
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .buffer(buffer.raw())
            .size(vk::WHOLE_SIZE)
    });
    let images = images.map(|(image, before, after)| {
        let range = whole(image.format());
        transition(gpu, image.raw(), range, before.into(), after.into())
    });
    let info = vk::DependencyInfo::default()
        .memory_barriers(&all)
        .buffer_memory_barriers(&buffers)
        .image_memory_barriers(&images);
    // SAFETY: the caller's promises; synchronization2 was required of the device.
    gpu.record(|device| unsafe { device.cmd_pipeline_barrier2(cmd, &info) });
}

/// The same for up to `N` images in one command; none for no image.
///
/// # Safety
///
/// As [`image_barrier`], of each of them.
pub(crate) unsafe fn image_barriers<'a, const N: usize>(
    gpu: &Gpu,
    cmd: vk::CommandBuffer,
    moved: impl Iterator<Item = (&'a Image, Use, Use)>,
) {
    let mut barriers = [vk::ImageMemoryBarrier2::default(); N];
    let mut count = 0;
    for (barrier, (image, before, after)) in barriers.iter_mut().zip(moved) {
        let range = whole(image.format());
        *barrier = transition(gpu, image.raw(), range, before.into(), after.into());
        count += 1;
    }
    if count > 0 {
        let info = vk::DependencyInfo::default().image_memory_barriers(&barriers[..count]);
        // SAFETY: the caller's promises; synchronization2 was required of the device.
        gpu.record(|device| unsafe { device.cmd_pipeline_barrier2(cmd, &info) });
    }
}

/// The state of a host's image at one moment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TargetState {
    /// Its layout; `UNDEFINED` before our use gives its content up.
    pub layout: vk::ImageLayout,
    /// What uses it, before or after us.
    pub stage: vk::PipelineStageFlags2,
    /// How.
    pub access: vk::AccessFlags2,
    /// Who owns it; `QUEUE_FAMILY_IGNORED`: the family that we record for.
    pub queue_family: u32,
}

impl From<Use> for TargetState {
    fn from(word: Use) -> Self {
        let (stage, access, layout) = word.state();
        Self {
            layout,
            stage,
            access,
            queue_family: vk::QUEUE_FAMILY_IGNORED,
        }
    }
}

/// A host's color image that we draw or write into: one level, one layer, one sample.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// The image.
    pub image: vk::Image,
    /// A view of it.
    pub view: vk::ImageView,
    /// The format of the view.
    pub format: vk::Format,
    /// Pixels across and down.
    pub extent: [u32; 2],
    /// How it arrives.
    pub before: TargetState,
    /// How it must leave.
    pub after: TargetState,
}

impl Target {
    /// From how the target arrives to our first use of it.
    ///
    /// # Safety
    ///
    /// `cmd` is recording on `gpu`'s device, outside rendering; the target is in the state `before`.
    pub unsafe fn enter(&self, gpu: &Gpu, cmd: vk::CommandBuffer, first: Use) {
        // SAFETY: the caller's promises.
        unsafe { self.pass(gpu, cmd, self.before, first.into()) };
    }

    /// From our last use of the target to how it must leave.
    ///
    /// # Safety
    ///
    /// `cmd` is recording on `gpu`'s device, outside rendering; `last` is what was last recorded for the target.
    pub unsafe fn leave(&self, gpu: &Gpu, cmd: vk::CommandBuffer, last: Use) {
        // SAFETY: the caller's promises.
        unsafe { self.pass(gpu, cmd, last.into(), self.after) };
    }

    /// # Safety
    /// As [`Self::enter`], in the state `before`.
    unsafe fn pass(
        &self,
        gpu: &Gpu,
        cmd: vk::CommandBuffer,
        before: TargetState,
        after: TargetState,
    ) {
        let barriers = [transition(gpu, self.image, WHOLE_COLOR, before, after)];
        let info = vk::DependencyInfo::default().image_memory_barriers(&barriers);
        // SAFETY: the caller's promises; synchronization2 was required of the device.
        gpu.record(|device| unsafe { device.cmd_pipeline_barrier2(cmd, &info) });
    }
}

fn transition(
    gpu: &Gpu,
    image: vk::Image,
    range: vk::ImageSubresourceRange,
    before: TargetState,
    after: TargetState,
) -> vk::ImageMemoryBarrier2<'static> {
    let family = |state: TargetState| match state.queue_family {
        vk::QUEUE_FAMILY_IGNORED => gpu.queue_family(),
        family => family,
    };
    // Equal families: no transfer of ownership.
    vk::ImageMemoryBarrier2::default()
        .src_stage_mask(before.stage)
        .src_access_mask(before.access)
        .old_layout(before.layout)
        .dst_stage_mask(after.stage)
        .dst_access_mask(after.access)
        .new_layout(after.layout)
        .src_queue_family_index(family(before))
        .dst_queue_family_index(family(after))
        .image(image)
        .subresource_range(range)
}
