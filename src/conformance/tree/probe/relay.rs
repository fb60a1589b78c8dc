//! A relay from drawing to computing to copying and back to drawing, as techniques and resolves hand on their pictures:
//! ordered by barriers in one submission, by events, by semaphores between submissions.
//!
//! ```text
//! draw      picture = before + 1        compute   after = picture of the right neighbour / 2        copy   before = after
//! ```
//!
//! What runs too early reads the round before.

use super::kit;
use super::raw::refused;
use crate::conformance::case::{Case, Stop};
use crate::conformance::measurement::{Bound, Measurement};
use crate::conformance::test_bed::TestBed;
use crate::gpu::owned::Own;
use crate::gpu::{
    Bindings, Blend, Buffer, ComputePipeline, DepthUse, Feature, Gpu, Headless, Image, ImageDesc,
    ImageKind, Item, Load, Memory, RasterDesc, RasterPipeline, Resource, Use, begin_rendering,
    end_rendering, set_area,
};
use crate::shaders::shader;
use ash::vk::{self, AccessFlags2 as Access, PipelineStageFlags2 as Stage};
use std::sync::Arc;

const DERIVATION: &str = "Whole numbers below 2^8 that are halved twelve times have twelve bits behind the point: 32-bit floats hold them, \
and each step is exact. Each depends on what the step before it wrote (Vulkan specification, synchronization).";

/// What orders a step behind the one before.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Order {
    Barriers,
    Events,
    Submissions,
}

/// One a kind of order.
pub fn cases() -> Vec<Case> {
    let target = Item::Format(
        vk::Format::R32G32B32A32_SFLOAT,
        vk::FormatFeatureFlags::COLOR_ATTACHMENT,
    );
    let case = |word, order| {
        let case = Case::new(format!("probe.relay.{word}"), move |bed| {
            measure(bed, order)
        });
        case.needing(target)
    };
    vec![
        case("barriers", Order::Barriers),
        case("events", Order::Events).wanting_events(),
        case("submissions", Order::Submissions).needing(Item::Feature(Feature::TimelineSemaphore)),
    ]
}

const ROUNDS: usize = 12;
const STEPS: usize = 3 * ROUNDS;
const EXTENT: [u32; 2] = [64, 32];
const COVER: [[f32; 4]; 3] = [
    [-1.0, -1.0, 0.0, 1.0],
    [3.0, -1.0, 0.0, 1.0],
    [-1.0, 3.0, 0.0, 1.0],
];

fn measure(bed: &mut TestBed, order: Order) -> Result<Measurement, Stop> {
    let mut random = bed.random("relay");
    let count = (EXTENT[0] * EXTENT[1]) as usize;
    let mut numbers: Vec<f32> = (0..count).map(|_| random.below(256) as f32).collect();
    let device = bed.device()?;
    let gpu = Arc::clone(device.gpu());
    let relay = Relay::new(&gpu, &numbers)?;
    match order {
        Order::Barriers => device.run(|cmd| {
            for step in 0..STEPS {
                relay.record(cmd, step, |info| {
                    // SAFETY: recorded outside rendering, here and below.
                    unsafe { gpu.device().cmd_pipeline_barrier2(cmd, info) };
                });
            }
            Ok(())
        })?,
        Order::Events => by_events(device, &gpu, &relay)?,
        Order::Submissions => by_submissions(device, &gpu, &relay)?,
    }
    for _ in 0..ROUNDS {
        let row = EXTENT[0] as usize;
        let next = |i: usize| i / row * row + (i + 1) % row;
        numbers = (0..count).map(|i| 0.5 * (numbers[next(i)] + 1.0)).collect();
    }
    let found: Vec<f32> = kit::read(&relay.before)?;
    let mut measurement = Measurement::new(Bound::new("relay", DERIVATION), count);
    for (i, (&wanted, found)) in numbers.iter().zip(found).enumerate() {
        measurement.take(|| format!("number {i}"), wanted.into(), found.into(), 0.0);
    }
    Ok(measurement)
}

fn by_events(device: &mut Headless, gpu: &Arc<Gpu>, relay: &Relay) -> Result<(), Stop> {
    let mut events = Vec::new();
    for _ in 0..STEPS {
        let info = vk::EventCreateInfo::default().flags(vk::EventCreateFlags::DEVICE_ONLY);
        // SAFETY: the device is valid.
        let event = unsafe { gpu.device().create_event(&info, None) };
        events.push(Own::new(gpu, event.map_err(refused("make an event"))?));
    }
    device.run(|cmd| {
        for (step, event) in events.iter().enumerate() {
            relay.record(cmd, step, |info| {
                // SAFETY: each event is set once and waited for once, with the same dependency; `run` waits.
                unsafe {
                    gpu.device().cmd_set_event2(cmd, event.get(), info);
                    let events = [event.get()];
                    gpu.device()
                        .cmd_wait_events2(cmd, &events, std::slice::from_ref(info));
                }
            });
        }
        Ok(())
    })?;
    Ok(())
}

/// All in one call, each step a submission of its own that waits for the one before.
fn by_submissions(device: &mut Headless, gpu: &Arc<Gpu>, relay: &Relay) -> Result<(), Stop> {
    let raw = gpu.device();
    let info = vk::CommandPoolCreateInfo::default().queue_family_index(gpu.queue_family());
    // SAFETY: the device is valid, here and below.
    let pool = unsafe { raw.create_command_pool(&info, None) };
    let pool = Own::new(gpu, pool.map_err(refused("make a command pool"))?);
    let mut kind =
        vk::SemaphoreTypeCreateInfo::default().semaphore_type(vk::SemaphoreType::TIMELINE);
    let info = vk::SemaphoreCreateInfo::default().push_next(&mut kind);
    // SAFETY: as above; the feature is a need of the case.
    let timeline = unsafe { raw.create_semaphore(&info, None) };
    let timeline = Own::new(gpu, timeline.map_err(refused("make a semaphore"))?);
    let info = vk::CommandBufferAllocateInfo::default()
        .command_pool(pool.get())
        .command_buffer_count(STEPS as u32);
    // SAFETY: as above.
    let cmds = unsafe { raw.allocate_command_buffers(&info) };
    let cmds = cmds.map_err(refused("make command buffers"))?;
    for (step, &cmd) in cmds.iter().enumerate() {
        let begin = vk::CommandBufferBeginInfo::default()
            .flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: the command buffer is ours and new.
        unsafe { raw.begin_command_buffer(cmd, &begin) }.map_err(refused("record"))?;
        relay.record(cmd, step, |info| {
            // SAFETY: as above.
            unsafe { raw.cmd_pipeline_barrier2(cmd, info) };
        });
        // SAFETY: as above.
        unsafe { raw.end_command_buffer(cmd) }.map_err(refused("record"))?;
    }
    let point = |value: usize| {
        [vk::SemaphoreSubmitInfo::default()
            .semaphore(timeline.get())
            .value(value as u64)
            .stage_mask(Stage::ALL_COMMANDS)]
    };
    let points: Vec<_> = (0..=STEPS).map(point).collect();
    let recorded = cmds
        .iter()
        .map(|&cmd| [vk::CommandBufferSubmitInfo::default().command_buffer(cmd)]);
    let recorded: Vec<_> = recorded.collect();
    let submission = |step: usize| {
        vk::SubmitInfo2::default()
            .wait_semaphore_infos(&points[step])
            .command_buffer_infos(&recorded[step])
            .signal_semaphore_infos(&points[step + 1])
    };
    let submissions: Vec<_> = (0..STEPS).map(submission).collect();
    let done = device.on_queue(|queue| {
        // SAFETY: nobody else has the queue, and it is waited for before anything goes.
        unsafe {
            let done = raw.queue_submit2(queue, &submissions, vk::Fence::null());
            done.and_then(|()| raw.queue_wait_idle(queue))
        }
    });
    done.map_err(refused("submit"))?;
    // What was copied comes to the host.
    device.run(|_| Ok(()))?;
    Ok(())
}

struct Relay {
    gpu: Arc<Gpu>,
    draw: (RasterPipeline, Bindings),
    compute: (ComputePipeline, Bindings),
    picture: Image,
    before: Buffer,
    after: Buffer,
    _given: [Buffer; 2],
}

impl Relay {
    fn new(gpu: &Arc<Gpu>, numbers: &[f32]) -> Result<Self, Stop> {
        let format = vk::Format::R32G32B32A32_SFLOAT;
        let desc = ImageDesc {
            kind: ImageKind::D2,
            extent: [EXTENT[0], EXTENT[1], 1],
            format,
            usage: vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::SAMPLED,
            name: "picture",
        };
        let picture = Image::new(gpu, &desc)?;
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER
            | vk::BufferUsageFlags::TRANSFER_SRC
            | vk::BufferUsageFlags::TRANSFER_DST;
        let bytes = size_of_val(numbers) as u64;
        let buffer = |name| Buffer::new(gpu, bytes, usage, Memory::Readback, name);
        let (before, after) = (buffer("before")?, buffer("after")?);
        before.write(0, bytemuck::cast_slice(numbers))?;
        let corners = kit::buffer(gpu, &COVER, "corners")?;
        let colors = kit::buffer(gpu, &[[1.0f32; 4]], "colors")?;
        let draw = RasterPipeline::new(
            gpu,
            &RasterDesc {
                vertex: shader("probe/shapes"),
                fragment: shader("probe/relay_draw"),
                target: format.into(),
                blend: Blend::Replace,
                depth: DepthUse::Ignored,
            },
        )?;
        let given = [
            ("corners", Resource::Storage(&corners)),
            ("colors", Resource::Storage(&colors)),
            ("before", Resource::Storage(&before)),
        ];
        let drawn = Bindings::new(gpu, draw.layout(), &given)?;
        let compute = ComputePipeline::new(gpu, shader("probe/relay_compute"))?;
        let given = [
            ("drawn", Resource::sampled(&picture)),
            ("after", Resource::Storage(&after)),
        ];
        let computed = Bindings::new(gpu, compute.layout(), &given)?;
        Ok(Self {
            gpu: Arc::clone(gpu),
            draw: (draw, drawn),
            compute: (compute, computed),
            picture,
            before,
            after,
            _given: [corners, colors],
        })
    }

    /// One step, behind a dependency that `order` records. All that is recorded lives as long as `self`.
    fn record(
        &self,
        cmd: vk::CommandBuffer,
        step: usize,
        order: impl FnOnce(&vk::DependencyInfo<'_>),
    ) {
        let gpu = &self.gpu;
        let copy = Stage::ALL_TRANSFER;
        let compute = Stage::COMPUTE_SHADER;
        let draw = Stage::FRAGMENT_SHADER;
        // Each buffer that this step uses, what was done with it, and what is.
        let (before, after): (Dependency, Dependency) = match step % 3 {
            0 => (
                (
                    copy,
                    Access::TRANSFER_WRITE,
                    draw,
                    Access::SHADER_STORAGE_READ,
                ),
                (copy, Access::TRANSFER_READ, draw, Access::NONE),
            ),
            1 => (
                (draw, Access::SHADER_STORAGE_READ, compute, Access::NONE),
                (
                    copy,
                    Access::TRANSFER_READ,
                    compute,
                    Access::SHADER_STORAGE_WRITE,
                ),
            ),
            _ => (
                (
                    draw,
                    Access::SHADER_STORAGE_READ,
                    copy,
                    Access::TRANSFER_WRITE,
                ),
                (
                    compute,
                    Access::SHADER_STORAGE_WRITE,
                    copy,
                    Access::TRANSFER_READ,
                ),
            ),
        };
        let buffers = [(&self.before, before), (&self.after, after)].map(|(buffer, of)| {
            vk::BufferMemoryBarrier2::default()
                .src_stage_mask(of.0)
                .src_access_mask(of.1)
                .dst_stage_mask(of.2)
                .dst_access_mask(of.3)
                .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
                .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
                .buffer(buffer.raw())
                .size(vk::WHOLE_SIZE)
        });
        let (from, to) = match step % 3 {
            0 => {
                let (stage, access, _) = Use::ComputeSampled.state();
                (
                    (stage, access, vk::ImageLayout::UNDEFINED),
                    Use::ColorTarget.state(),
                )
            }
            _ => (Use::ColorTarget.state(), Use::ComputeSampled.state()),
        };
        let range = vk::ImageSubresourceRange::default()
            .aspect_mask(vk::ImageAspectFlags::COLOR)
            .level_count(1)
            .layer_count(1);
        let images = [vk::ImageMemoryBarrier2::default()
            .src_stage_mask(from.0)
            .src_access_mask(from.1)
            .old_layout(from.2)
            .dst_stage_mask(to.0)
            .dst_access_mask(to.1)
            .new_layout(to.2)
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .image(self.picture.raw())
            .subresource_range(range)];
        let info = vk::DependencyInfo::default().buffer_memory_barriers(&buffers);
        let info = match step % 3 {
            // The picture is not copied.
            2 => info,
            _ => info.image_memory_barriers(&images),
        };
        order(&info);
        // SAFETY: recorded outside rendering behind the dependency; the caller waits, and all that is bound lives
        // meanwhile.
        unsafe {
            match step % 3 {
                0 => {
                    let clear = Load::Clear([0.0; 4]);
                    begin_rendering(gpu, cmd, &[(self.picture.view(), clear)], EXTENT);
                    set_area(gpu, cmd, EXTENT);
                    let (pipeline, bindings) = &self.draw;
                    pipeline.draw(cmd, bindings, &[], 3, 0..1);
                    end_rendering(gpu, cmd);
                }
                1 => {
                    let (pipeline, bindings) = &self.compute;
                    let groups = [EXTENT[0] * EXTENT[1] / 64, 1, 1];
                    pipeline.dispatch(cmd, bindings, &[], groups);
                }
                _ => {
                    let copy = [vk::BufferCopy::default().size(self.before.bytes())];
                    let (from, to) = (self.after.raw(), self.before.raw());
                    gpu.device().cmd_copy_buffer(cmd, from, to, &copy);
                }
            }
        }
    }
}

type Dependency = (Stage, Access, Stage, Access);
