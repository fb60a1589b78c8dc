//! What is drawn on a host's device, and how.

use super::HostedDevice;
use crate::shared::{oblique_camera, projections, ramps, sheared_affine, volume_of, waves};
use ash::vk;
use std::error::Error;
use std::ops::ControlFlow;
use std::sync::Arc;
use stratavox::camera::Camera;
use stratavox::embed::{self, FrameInfo, Pacing, QueueLock, RendererDesc, Submitter};
use stratavox::gpu::{
    self, Blend, Buffer, Gpu, Memory, Region, Target, Timer, Use, image_barrier, image_to_buffer,
};
use stratavox::resident::{GpuTransfer, GpuVolume, TextureLayout};
use stratavox::resolve::Resolve;
use stratavox::technique::raycast::Raycast;
use stratavox::technique::{
    ACCUMULATION_FORMAT, Inputs, Mode, RayTiles, Settings, ShaderVariant, Skip, View, accumulation,
    parameter_ring,
};
use stratavox::transfer::TransferFunction;
use stratavox::volume::{Grid, Volume, VoxelBox};

/// A small picture: a volume, what it looks like, and from where.
pub struct Stage {
    pub volume: Volume,
    pub transfer: TransferFunction,
    pub camera: Camera,
    pub settings: Settings,
    pub extent: [u32; 2],
}

impl Stage {
    pub fn new() -> Self {
        let volume = volume_of([16; 3], sheared_affine(), waves);
        let grid = volume.grid();
        Self {
            camera: oblique_camera(&grid, projections(&grid)[1]),
            volume,
            transfer: ramps(),
            settings: Settings::default(),
            extent: [32; 2],
        }
    }

    /// How the volume lies in textures.
    pub fn layout(&self) -> TextureLayout {
        let grid = self.volume.grid();
        self.view(&grid).texture_layout()
    }

    fn view<'a>(&'a self, grid: &'a Grid) -> View<'a> {
        View {
            grid,
            camera: &self.camera,
            extent_pixels: self.extent,
            in_pixel: [0.0; 2].into(),
            settings: &self.settings,
        }
    }

    /// Draws as a host does that records for itself (`examples/embed`), and reads the picture and the time it took.
    pub fn draw(
        &self,
        device: &HostedDevice<'_>,
        gpu: &Arc<Gpu>,
    ) -> Result<Vec<u8>, Box<dyn Error>> {
        let (settings, extent) = (&self.settings, self.extent);
        let grid = self.volume.grid();
        let view = self.view(&grid);
        let voxels = GpuVolume::new(gpu, &self.volume, view.texture_layout())?;
        let staging = voxels.stage(&self.volume)?;
        let (length, space) = (grid.smallest_spacing(), settings.color_space);
        let transfer = GpuTransfer::new(gpu, &self.transfer, length, space)?;
        let ring = parameter_ring(gpu, voxels.bricks().len() as u32)?;
        let gathered = accumulation(gpu, extent, "gathered")?;
        let layers = accumulation(gpu, extent, "layers")?;
        let picture = accumulation(gpu, extent, "picture")?;
        let raycast = Raycast::new(gpu, &ShaderVariant::of(settings, &voxels))?;
        let inputs = Inputs {
            beside: &[],
            light: None,
            points: None,
            field: None,
            sky: None,
            skip: Skip::Nothing,
            ring: &ring,
            volume: &voxels,
            brick: &voxels.bricks()[0],
            transfer: Some(&transfer),
        };
        let tiles = RayTiles::new(gpu, extent)?;
        let bound = raycast.bind(&inputs, &gathered, &layers, &tiles)?;
        let resolve = Resolve::new(gpu, Mode::Composite, Blend::Replace, ACCUMULATION_FORMAT)?;
        let resolved = resolve.bind(&ring, &gathered, Some(&transfer))?;
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let bytes = 16 * u64::from(extent[0]) * u64::from(extent[1]);
        let readback = Buffer::new(gpu, bytes, usage, Memory::Readback, "readback")?;
        let timer = Timer::new(gpu)?;
        let recording = view.recordings(&voxels, Some(&transfer))?[0];
        let offset = recording.write(&ring, 0)?;

        gpu.announce(1);
        let cmd = device.begin();
        // SAFETY: barriers stand between the passes; all of it lives until the device has finished.
        unsafe {
            if let Some(timer) = &timer {
                timer.start(cmd);
            }
            voxels.record_upload_all(cmd, &staging)?;
            transfer.record_upload(cmd)?;
            for written in [&gathered, &layers] {
                image_barrier(gpu, cmd, written, Use::Nothing, Use::ComputeWrite);
            }
            raycast.record(cmd, &bound, offset, extent)?;
            image_barrier(gpu, cmd, &gathered, Use::ComputeWrite, Use::FragmentSampled);
            image_barrier(gpu, cmd, &picture, Use::Nothing, Use::ColorTarget);
            let targets = [(picture.view(), gpu::Load::Clear([0.0; 4]))];
            gpu::begin_rendering(gpu, cmd, &targets, extent);
            resolve.record(cmd, &resolved, offset, extent);
            gpu::end_rendering(gpu, cmd);
            image_barrier(gpu, cmd, &picture, Use::ColorTarget, Use::TransferRead);
            image_to_buffer(gpu, cmd, &picture, Region::whole(&picture), &readback, 0)?;
            gpu::buffer_barrier(gpu, cmd, &readback, Use::TransferWrite, Use::HostRead);
            if let Some(timer) = &timer {
                timer.stop(cmd);
            }
        }
        device.submit_and_wait(cmd);
        // SAFETY: the one submission has ended.
        unsafe { gpu.retire(1) };
        let mut texels = vec![0; bytes as usize];
        readback.read(0, &mut texels)?;
        if let Some(timer) = &timer {
            timer.elapsed_ms()?;
        }
        gpu.pipeline_cache_data()?;
        Ok(texels)
    }

    /// Draws as a host does that lets us submit, in frames between values of its timeline.
    pub fn submit(
        &self,
        device: &HostedDevice<'_>,
        gpu: &Arc<Gpu>,
    ) -> Result<Vec<u8>, Box<dyn Error>> {
        self.submit_in(device, gpu, false)
    }

    /// The same with each piece of upload and frame by itself, and an update of some voxels to what they are between.
    pub fn submit_in_parts(
        &self,
        device: &HostedDevice<'_>,
        gpu: &Arc<Gpu>,
    ) -> Result<Vec<u8>, Box<dyn Error>> {
        self.submit_in(device, gpu, true)
    }

    fn submit_in(
        &self,
        device: &HostedDevice<'_>,
        gpu: &Arc<Gpu>,
        in_parts: bool,
    ) -> Result<Vec<u8>, Box<dyn Error>> {
        let mut volume = embed::Volume::new(gpu, &self.volume, &self.settings)?;
        let mut submitter = Submitter::new(gpu, 3)?;
        let image = accumulation(gpu, self.extent, "target")?;
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let bytes = 16 * u64::from(self.extent[0]) * u64::from(self.extent[1]);
        let readback = Buffer::new(gpu, bytes, usage, Memory::Readback, "readback")?;
        let class = RendererDesc {
            settings: self.settings.clone(),
            target: ACCUMULATION_FORMAT.into(),
            frames_in_flight: 3,
            host_depth: false,
            gives_depth: false,
            picks: false,
            slice_blending: Default::default(),
        };
        let shot = FrameInfo {
            frame: 1,
            camera: &self.camera,
            depth: None,
        };
        let target = Target {
            image: image.raw(),
            view: image.view(),
            format: image.format(),
            extent: self.extent,
            before: Use::Nothing.into(),
            after: Use::TransferRead.into(),
        };
        let locked = |submit: &mut dyn FnMut()| submit();
        let lock = QueueLock {
            queue: device.queue,
            locked: &locked,
        };
        // SAFETY: all of it lives until the timeline has waited, which goes first.
        unsafe {
            gpu.announce(4);
            let mut renderer;
            let timeline = Timeline::new(device);
            let at = |value| [(timeline.semaphore, value)];
            let go_on = &mut |_| ControlFlow::Continue(());
            let first = &mut volume;
            match in_parts {
                false => submitter.upload(gpu, first, 0, lock, &[], &at(1))?,
                true => {
                    submitter.upload_in_parts(
                        gpu,
                        first,
                        0,
                        lock,
                        &[],
                        &at(1),
                        a_piece_each(go_on),
                    )?;
                }
            }
            let volume = Arc::new(volume);
            let function = Some(&self.transfer);
            renderer = embed::Renderer::new(gpu, &volume, function, class, self.extent, &[])?;
            if in_parts {
                let (min, max) = ([3, 0, 7], [9, 12, 10]);
                let same = (&self.volume).into();
                let mut update = volume.stage_update(VoxelBox { min, max }, same)?;
                let (waits, signals) = (at(1), at(2));
                submitter.update_in_parts(
                    &volume,
                    &mut update,
                    2,
                    lock,
                    &waits,
                    &signals,
                    a_piece_each(go_on),
                )?;
            }
            let (load, drawn) = (gpu::Load::Clear([0.0; 4]), at(3));
            let waits = at(if in_parts { 2 } else { 1 });
            match in_parts {
                false => {
                    submitter.submit(&mut renderer, &shot, &target, load, lock, &waits, &drawn)?;
                }
                true => {
                    submitter.submit_in_parts(
                        &mut renderer,
                        &shot,
                        &target,
                        load,
                        lock,
                        &waits,
                        &drawn,
                        a_piece_each(go_on),
                    )?;
                }
            }
            submitter.run(lock, 0, &drawn, &at(4), |cmd| {
                image_to_buffer(gpu, cmd, &image, Region::whole(&image), &readback, 0)?;
                gpu::buffer_barrier(gpu, cmd, &readback, Use::TransferWrite, Use::HostRead);
                Ok(())
            })?;
            timeline.wait(4);
            gpu.retire(4);
        }
        let mut texels = vec![0; bytes as usize];
        readback.read(0, &mut texels)?;
        Ok(texels)
    }
}

/// No piece is done in no time: each is a submission.
fn a_piece_each(tell: &mut dyn FnMut(f64) -> ControlFlow<()>) -> Pacing<'_> {
    Pacing {
        target_ms: 1e-6,
        tell,
    }
}

/// A timeline of the host's. Dropping it waits for the device.
struct Timeline<'d> {
    semaphore: vk::Semaphore,
    device: &'d HostedDevice<'d>,
}

impl<'d> Timeline<'d> {
    fn new(device: &'d HostedDevice<'_>) -> Self {
        let kind = vk::SemaphoreType::TIMELINE;
        let mut kind = vk::SemaphoreTypeCreateInfo::default().semaphore_type(kind);
        let info = vk::SemaphoreCreateInfo::default().push_next(&mut kind);
        // SAFETY: the device has timelines; `drop` destroys it.
        let semaphore = unsafe { device.device.create_semaphore(&info, None) }.unwrap();
        Self { semaphore, device }
    }

    fn wait(&self, value: u64) {
        let (semaphores, values) = ([self.semaphore], [value]);
        let info = vk::SemaphoreWaitInfo::default()
            .semaphores(&semaphores)
            .values(&values);
        // SAFETY: it is ours, and something that reaches the value was submitted.
        unsafe { self.device.device.wait_semaphores(&info, u64::MAX) }.unwrap();
    }
}

impl Drop for Timeline<'_> {
    fn drop(&mut self) {
        // SAFETY: nothing more is submitted.
        unsafe {
            self.device.device.device_wait_idle().unwrap();
            self.device.device.destroy_semaphore(self.semaphore, None);
        }
    }
}
