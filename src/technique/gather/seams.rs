//! Seams of the executor, each with a technique that no picture has: a sum over frames, in chunks. And pictures that go
//! on from what a box of bricks has left.

use super::super::blend::Drawn;
use super::super::merge::Merge;
use super::super::{
    DepthAccess, InPixel, Order, Recording, Settings, ShaderVariant, Skip, Technique, View,
    accumulation, parameter_ring,
};
use super::slices::batch_image;
use super::*;
use crate::camera::{Camera, Projection};
use crate::gpu::{
    Bindings, Buffer, Caps, DeviceChoice, Headless, Load, Memory, Options, Region, Use,
    image_to_buffer,
};
use crate::picture::ColorSpace;
use crate::resident::{GpuTransfer, GpuVolume, TextureLayout};
use crate::transfer::{Classified, Window};
use crate::volume::{Rescale, Volume, Voxels};
use ash::vk;
use glam::{DAffine3, DVec3};

const EXTENT: [u32; 2] = [24, 16];

fn device(caps: Caps) -> Headless {
    let options = Options {
        caps,
        ..Options::default()
    };
    Headless::new(&DeviceChoice::Default, &options)
        .expect("a Vulkan device (`make test` installs one)")
}

/// What an image of four f32 holds.
fn pixels(device: &mut Headless, canvas: &mut Canvas) -> Vec<[f32; 4]> {
    let gpu = Arc::clone(device.gpu());
    let [width, height] = canvas.extent();
    let mut pixels = vec![[0.0; 4]; (width * height) as usize];
    let usage = vk::BufferUsageFlags::TRANSFER_DST;
    let bytes = 16 * pixels.len() as u64;
    let back = Buffer::new(&gpu, bytes, usage, Memory::Readback, "back").expect("a buffer");
    let copied = device.run(|cmd| {
        let mut player = Player {
            gpu: &gpu,
            cmd,
            canvas,
        };
        let region = Region {
            origin: [0; 3],
            extent: [width, height, 1],
        };
        // SAFETY: outside rendering; `run` waits.
        unsafe {
            player.bring([(PICTURE, Use::TransferRead)]);
            image_to_buffer(&gpu, cmd, player.image(PICTURE), region, &back, 0)?;
            player.bring([(PICTURE, Use::FragmentSampled)]);
        }
        Ok::<_, Error>(())
    });
    copied.expect("copied");
    back.read(0, bytemuck::cast_slice_mut(&mut pixels))
        .expect("read");
    pixels
}

/// Adds 1/4 to the picture in each of its steps, and keeps what frames before have added.
#[derive(Debug)]
struct Sum {
    gpu: Arc<Gpu>,
    merge: Arc<Merge>,
}

#[derive(Debug)]
struct BoundSum {
    merge: Arc<Merge>,
    set: Bindings,
}

const ADDED: usize = 1;
const STEPS: u64 = 5;

impl Gather for Sum {
    fn canvas(&self, desc: &CanvasDesc) -> Result<Canvas, Error> {
        let picture = accumulation(&self.gpu, desc.extent, "sum")?;
        Ok(Canvas::new(
            desc.extent,
            [picture, batch_image(&self.gpu, desc.extent)?],
        ))
    }

    fn bind(
        &self,
        canvas: &Canvas,
        _: &[Inputs],
        _: Option<Resource>,
    ) -> Result<Box<dyn Bound>, Error> {
        let (added, picture) = (canvas.image(ADDED), canvas.image(PICTURE));
        Ok(Box::new(BoundSum {
            merge: Arc::clone(&self.merge),
            set: self.merge.bind(added, picture)?,
        }))
    }
}

impl Bound for BoundSum {
    fn steps(&self, _: &Canvas, _: &[BrickPass], _: u32) -> Option<u64> {
        Some(STEPS)
    }

    unsafe fn record(
        &self,
        player: &mut Player,
        _: &[BrickPass],
        part: &Part,
    ) -> Result<(), Error> {
        let extent = player.canvas.extent();
        // SAFETY: the caller's promises.
        unsafe {
            if part.is_first && !player.canvas.resumes() {
                player.clear(PICTURE);
            }
            for _ in part.steps.clone() {
                player.bring([(ADDED, Use::ColorTarget)]);
                let load = Load::Clear([0.25; 4]);
                player.render((ADDED, load), None, Tile::whole(extent), |_| ());
                player.bring([(ADDED, Use::ComputeSampled), (PICTURE, Use::ComputeWrite)]);
                self.merge.record(player.cmd, &self.set, extent)?;
            }
            if part.is_last {
                player.bring([(PICTURE, Use::FragmentSampled)]);
            }
        }
        Ok(())
    }
}

#[test]
fn what_frames_add_up_is_kept_until_a_picture_begins_and_chunks_of_any_size_add_the_same() {
    let mut device = device(Caps::UNLIMITED);
    let gpu = Arc::clone(device.gpu());
    let merge = Merge::new(&gpu, Drawn::Count, Order::BackToFront).expect("a pipeline");
    let sum = Sum {
        gpu: Arc::clone(&gpu),
        merge: Arc::new(merge),
    };
    let desc = CanvasDesc {
        intermediate_room: [1; 2],
        extent: EXTENT,
        dims: [1; 3],
        keeps_layers: false,
        beside: None,
    };
    let mut canvas = sum.canvas(&desc).expect("images");
    let bound = sum.bind(&canvas, &[], None).expect("sets");
    let count = bound.steps(&canvas, &[], 1).expect("it takes steps");
    for (chunk, frame, wanted) in [(5, 0, 1.25), (2, 1, 2.5), (1, 2, 3.75), (3, 0, 1.25)] {
        match frame {
            0 => canvas.begin(),
            _ => canvas.resume(),
        }
        for first in (0..count).step_by(chunk) {
            let end = count.min(first + chunk as u64);
            let part = Part {
                tiles: &[],
                steps: first..end,
                bands: 1,
                is_first: first == 0,
                is_last: end == count,
            };
            let done = device.run(|cmd| {
                let mut player = Player {
                    gpu: &gpu,
                    cmd,
                    canvas: &mut canvas,
                };
                // SAFETY: outside rendering, parts in order; `run` waits.
                unsafe { bound.record(&mut player, &[], &part) }
            });
            done.expect("recorded");
        }
        let found = pixels(&mut device, &mut canvas);
        assert!(found.iter().all(|&pixel| pixel == [wanted; 4]), "{frame}");
    }
}

#[test]
fn a_picture_goes_on_from_what_a_box_of_bricks_has_left() {
    let mut device = device(Caps {
        max_image_dimension_3d: 11,
        ..Caps::UNLIMITED
    });
    let gpu = Arc::clone(device.gpu());
    let dims = [20, 14, 17];
    let number = |i: u32| ((i % 20) * 7 + i / 20 % 14 * 5 + i / 280 * 3) as u8;
    let voxels = Voxels::U8((0..dims.iter().product()).map(number).collect());
    let place = DAffine3::from_translation(DVec3::splat(-8.0));
    let volume = Volume::from_voxels(dims, place, voxels, Rescale::default(), None);
    let volume = volume.expect("a right volume");
    let there = GpuVolume::new(&gpu, &volume, TextureLayout::Texture3d).expect("textures");
    let staging = there.stage(&volume).expect("staged");
    let function = Window::of_range([0.0, 255.0]).grey(Classified::Samples);
    let transfer = GpuTransfer::new(&gpu, &function, 1.0, ColorSpace::Linear).expect("a table");
    let uploaded = device.run(|cmd| {
        // SAFETY: outside rendering; `run` waits.
        unsafe {
            there.record_upload_all(cmd, &staging)?;
            transfer.record_upload(cmd)
        }
    });
    uploaded.expect("uploaded");
    let camera = Camera {
        eye: DVec3::new(40.0, -31.0, 17.0),
        target: DVec3::ZERO,
        up: DVec3::Z,
        projection: Projection::Perspective { fov_degrees: 30.0 },
        zoom: 1.0,
    };
    for technique in [Technique::Raycast, Technique::Slices3d] {
        let settings = Settings {
            technique,
            ..Settings::default()
        };
        let view = View {
            grid: there.grid(),
            camera: &camera,
            extent_pixels: EXTENT,
            in_pixel: InPixel::CENTER,
            settings: &settings,
        };
        let recordings = view.recordings(&there, Some(&transfer)).expect("right");
        let ring = parameter_ring(&gpu, recordings.len() as u32).expect("a ring");
        let inputs = |recording: &Recording| Inputs {
            ring: &ring,
            volume: &there,
            brick: &there.bricks()[recording.brick],
            transfer: Some(&transfer),
            beside: &[],
            light: None,
            points: None,
            field: None,
            sky: None,
            skip: Skip::Nothing,
        };
        let inputs: Vec<_> = recordings.iter().map(inputs).collect();
        let brick = |(number, recording): (usize, &Recording)| BrickPass {
            number,
            offset: recording.write(&ring, number as u32).expect("a slot"),
            slices: recording.slices,
            order: recording.order,
            seen: None,
        };
        let bricks: Vec<_> = recordings.iter().enumerate().map(brick).collect();
        assert!(bricks.len() > 7, "{} bricks", bricks.len());
        let variant = ShaderVariant::of(&settings, &there);
        let desc = GatherDesc {
            gpu: &gpu,
            settings: &settings,
            variant: &variant,
            drawn: Drawn::Picture(settings.mode),
            depth_access: DepthAccess::None,
            is_patched: false,
        };
        let gather = (technique.desc().gather)(&desc).expect("pipelines");
        let mut canvas = gather
            .canvas(&CanvasDesc {
                intermediate_room: [1; 2],
                extent: EXTENT,
                dims,
                keeps_layers: true,
                beside: None,
            })
            .expect("images");
        let bound = gather.bind(&canvas, &inputs, None).expect("sets");
        let mut picture = |boxes: &[&[BrickPass]]| {
            for (number, bricks) in boxes.iter().enumerate() {
                match number {
                    0 => canvas.begin(),
                    _ => canvas.resume(),
                }
                let part = Part {
                    tiles: &[Tile::whole(EXTENT)],
                    steps: 0..0,
                    bands: 1,
                    is_first: true,
                    is_last: true,
                };
                let done = device.run(|cmd| {
                    let mut player = Player {
                        gpu: &gpu,
                        cmd,
                        canvas: &mut canvas,
                    };
                    // SAFETY: outside rendering, parts in order; `run` waits.
                    unsafe { bound.record(&mut player, bricks, &part) }
                });
                done.expect("recorded");
            }
            pixels(&mut device, &mut canvas)
        };
        let wanted = picture(&[&bricks]);
        assert!(wanted.iter().any(|pixel| pixel[3] > 0.1), "{technique}");
        let (near, far) = bricks.split_at(3);
        assert!(picture(&[near, far]) == wanted, "{technique} in two boxes");
        let one_by_one: Vec<_> = bricks.chunks(1).collect();
        assert!(
            picture(&one_by_one) == wanted,
            "{technique}, brick by brick"
        );
        // What is left depends on the boxes: they were drawn.
        assert!(
            picture(&[near]) != wanted,
            "{technique} without the far box"
        );
    }
}
