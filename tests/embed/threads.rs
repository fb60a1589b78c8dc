//! Sixteen renderers on eight threads of one device, two hundred frames each, into one queue behind a lock of the
//! host's: each picture is the one that is drawn alone.

use crate::embed_shared::{Host, HostImage, Stage};
use ash::vk;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use stratavox::embed::{FrameInfo, Renderer, RendererDesc, Volume};
use stratavox::gpu::Load;
use stratavox::technique::{Mode, Settings, Technique};

const FORMAT: vk::Format = vk::Format::R16G16B16A16_SFLOAT;
const RENDERERS: usize = 16;
const THREADS: usize = 8;
const FRAMES: usize = 200;
/// What a renderer shows in turn: as many cameras.
const VIEWS: usize = 5;
const EXTENT: [u32; 2] = [24, 20];

fn settings(renderer: usize) -> Settings {
    let technique = match renderer % 3 {
        0 => Technique::Raycast,
        1 => Technique::Slices3d,
        _ => Technique::Slices2d,
    };
    Settings {
        technique,
        mode: if renderer % 6 == 3 {
            Mode::Mip
        } else {
            Mode::Composite
        },
        ..Settings::default()
    }
}

/// A renderer with what it draws into, and the commands for it.
struct Drawn<'h> {
    renderer: Renderer,
    stage: Stage,
    image: HostImage<'h>,
    cmd: vk::CommandBuffer,
    pool: vk::CommandPool,
    fence: vk::Fence,
    host: &'h Host,
}

impl<'h> Drawn<'h> {
    fn new(host: &'h Host, number: usize, volumes: &[Arc<Volume>]) -> Self {
        let mut stage = Stage::new(settings(number));
        stage.settings.conformance = false;
        stage.extent = EXTENT;
        let class = RendererDesc {
            settings: stage.settings.clone(),
            target: FORMAT.into(),
            frames_in_flight: 1,
            host_depth: false,
            gives_depth: false,
            picks: false,
            slice_blending: Default::default(),
        };
        let volume = &volumes[number % 3];
        let function = Some(&stage.transfer);
        let renderer = Renderer::new(host.gpu(), volume, function, class, EXTENT, &[]).unwrap();
        let info = vk::CommandPoolCreateInfo::default()
            .flags(vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER);
        // SAFETY: pools, buffers and fences of this renderer alone, destroyed by `drop`.
        unsafe {
            let pool = host.device.create_command_pool(&info, None).unwrap();
            let info = vk::CommandBufferAllocateInfo::default()
                .command_pool(pool)
                .command_buffer_count(1);
            let cmd = host.device.allocate_command_buffers(&info).unwrap()[0];
            let info = vk::FenceCreateInfo::default();
            let fence = host.device.create_fence(&info, None).unwrap();
            let image = HostImage::new(host, FORMAT, EXTENT);
            Self {
                renderer,
                stage,
                image,
                cmd,
                pool,
                fence,
                host,
            }
        }
    }

    /// The picture of one of the views.
    fn draw(&mut self, view: usize, queue: &Mutex<vk::Queue>) -> Vec<[f64; 4]> {
        let mut camera = self.stage.camera;
        camera.zoom *= 1.0 + 0.1 * view as f64;
        camera.eye.z += view as f64;
        let shot = FrameInfo {
            frame: 0,
            camera: &camera,
            depth: None,
        };
        let target = self.image.target();
        let (device, renderer) = (&self.host.device, &mut self.renderer);
        let cmds = [self.cmd];
        self.host.record(self.cmd, |cmd| {
            // SAFETY: the frame before is done; the picture goes to where the CPU reads it.
            unsafe {
                let load = Load::Clear([0.0; 4]);
                renderer.record_into(cmd, &shot, &target, load).unwrap();
                self.image
                    .copy_from(cmd, vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
            }
        });
        let submit = [vk::SubmitInfo::default().command_buffers(&cmds)];
        // SAFETY: the queue is used under its lock; the fence is of this submission.
        unsafe {
            let queue = queue.lock().unwrap();
            device.queue_submit(*queue, &submit, self.fence).unwrap();
            drop(queue);
            device
                .wait_for_fences(&[self.fence], true, u64::MAX)
                .unwrap();
            device.reset_fences(&[self.fence]).unwrap();
        }
        self.image.numbers()
    }
}

impl Drop for Drawn<'_> {
    fn drop(&mut self) {
        // SAFETY: each frame was waited for.
        unsafe {
            self.host.device.destroy_fence(self.fence, None);
            self.host.device.destroy_command_pool(self.pool, None);
        }
    }
}

#[test]
fn renderers_on_many_threads_draw_what_each_draws_alone() {
    let host = Host::new();
    let volumes: Vec<_> = (0..3)
        .map(|technique| {
            let mut stage = Stage::new(settings(technique));
            stage.settings.conformance = false;
            let mut volume = Volume::new(host.gpu(), &stage.volume, &stage.settings).unwrap();
            // SAFETY: outside rendering; `run` waits.
            host.run(|cmd| unsafe { volume.record_upload(host.gpu(), cmd).unwrap() });
            Arc::new(volume)
        })
        .collect();
    let queue = Mutex::new(host.queue);
    let all = (0..RENDERERS).map(|number| Drawn::new(&host, number, &volumes));
    let mut all: Vec<_> = all.collect();
    let alone: Vec<Vec<_>> = all
        .iter_mut()
        .map(|drawn| (0..VIEWS).map(|view| drawn.draw(view, &queue)).collect())
        .collect();
    for (number, views) in alone.iter().enumerate() {
        let seen = views[0].iter().filter(|pixel| pixel[3] > 0.1).count();
        assert!(seen > 50, "renderer {number} shows {seen} pixels");
        assert!(views.windows(2).all(|pair| pair[0] != pair[1]));
    }
    let compared = AtomicUsize::new(0);
    std::thread::scope(|scope| {
        let (queue, alone, compared) = (&queue, &alone, &compared);
        for (thread, drawn) in all.chunks_mut(RENDERERS / THREADS).enumerate() {
            scope.spawn(move || {
                for frame in 0..FRAMES {
                    for (k, drawn) in drawn.iter_mut().enumerate() {
                        let number = thread * (RENDERERS / THREADS) + k;
                        let view = (frame * 3 + number) % VIEWS;
                        let found = drawn.draw(view, queue);
                        let is_same = found == alone[number][view];
                        assert!(is_same, "renderer {number}, frame {frame}, view {view}");
                        compared.fetch_add(1, Ordering::Relaxed);
                    }
                }
            });
        }
    });
    assert_eq!(compared.into_inner(), RENDERERS * FRAMES);
}
