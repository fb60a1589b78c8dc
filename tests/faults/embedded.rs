//! What a host changes about a renderer may fail at every call that it makes: the host is told, nothing is left behind,
//! and the renderer draws what it drew before, to the bit. Frames themselves call nothing that can fail.

use crate::hooked::{
    FALLIBLE, FEATURES, Host, HostedDevice, Stage, Tape, codes, hooked, of_device,
};
use ash::vk;
use std::collections::BTreeMap;
use std::sync::Arc;
use stratavox::camera::Camera;
use stratavox::embed::{Error, FrameInfo, Renderer, RendererDesc, Volume};
use stratavox::gpu::{
    Buffer, Gpu, Image, Load, Memory, Region, Target, Use, buffer_barrier, image_to_buffer,
};
use stratavox::technique::{ACCUMULATION_FORMAT, Level, Mode, Settings, Technique, accumulation};

/// Memory that the host writes is looked for in a second place, and names of objects are a courtesy.
const MAY_PASS: [&str; 3] = [
    "vkAllocateMemory",
    "vkMapMemory",
    "vkSetDebugUtilsObjectNameEXT",
];

/// A renderer, and what its picture comes in.
pub struct Drawn<'d> {
    pub renderer: Renderer,
    camera: Camera,
    image: Image,
    readback: Buffer,
    gpu: Arc<Gpu>,
    device: &'d HostedDevice<'d>,
    frames: u64,
}

impl<'d> Drawn<'d> {
    pub fn new(device: &'d HostedDevice<'d>, gpu: &Arc<Gpu>, stage: &Stage) -> Self {
        let (extent, settings) = (stage.extent, stage.settings.clone());
        let volume = uploaded(device, gpu, stage);
        let class = RendererDesc {
            settings,
            target: ACCUMULATION_FORMAT.into(),
            frames_in_flight: 2,
            host_depth: false,
            // For picks alone: the target has no depth.
            gives_depth: false,
            picks: true,
            slice_blending: Default::default(),
        };
        let function = Some(&stage.transfer);
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let bytes = 16 * u64::from(extent[0]) * u64::from(extent[1]);
        Self {
            renderer: Renderer::new(gpu, &volume, function, class, extent, &[]).unwrap(),
            camera: stage.camera,
            image: accumulation(gpu, extent, "target").unwrap(),
            readback: Buffer::new(gpu, bytes, usage, Memory::Readback, "readback").unwrap(),
            gpu: Arc::clone(gpu),
            device,
            frames: 0,
        }
    }

    /// The picture, a pixel of it picked beside.
    pub fn picture(&mut self) -> Vec<u8> {
        self.frames += 1;
        self.gpu.announce(self.frames);
        let shot = FrameInfo {
            frame: 1,
            camera: &self.camera,
            depth: None,
        };
        let [width, height, _] = self.image.extent();
        let target = Target {
            image: self.image.raw(),
            view: self.image.view(),
            format: self.image.format(),
            extent: [width, height],
            before: Use::Nothing.into(),
            after: Use::TransferRead.into(),
        };
        let cmd = self.device.begin();
        // SAFETY: recorded in order; all of it lives until the device has finished.
        unsafe {
            let (gpu, load) = (&self.gpu, Load::Clear([0.0; 4]));
            self.renderer
                .record_into(cmd, &shot, &target, load)
                .unwrap();
            self.renderer.record_pick(cmd, 1, [16, 16]).unwrap();
            let whole = Region::whole(&self.image);
            image_to_buffer(gpu, cmd, &self.image, whole, &self.readback, 0).unwrap();
            buffer_barrier(gpu, cmd, &self.readback, Use::TransferWrite, Use::HostRead);
        }
        self.device.submit_and_wait(cmd);
        // SAFETY: the one submission has ended.
        unsafe { self.gpu.retire(self.frames) };
        let mut texels = vec![0; self.readback.bytes() as usize];
        self.readback.read(0, &mut texels).unwrap();
        let picked = self.renderer.pick(1, [16, 16]).unwrap();
        texels.extend(format!("{picked:?}").bytes());
        texels
    }
}

fn uploaded(device: &HostedDevice, gpu: &Arc<Gpu>, stage: &Stage) -> Arc<Volume> {
    let mut volume = Volume::new(gpu, &stage.volume, &stage.settings).unwrap();
    let cmd = device.begin();
    // SAFETY: outside rendering, and waited for.
    unsafe { volume.record_upload(gpu, cmd).unwrap() };
    device.submit_and_wait(cmd);
    Arc::new(volume)
}

/// Something that a host changes, and how it is undone.
struct Change<'a> {
    name: &'static str,
    act: &'a dyn Fn(&mut Renderer) -> Result<(), Error>,
    undo: &'a dyn Fn(&mut Renderer),
}

/// Makes the first, the second and the last call of each function that a change calls fail with each of its codes.
fn sweep(tape: &Tape, drawn: &mut Drawn, change: &Change) -> u32 {
    let wanted = drawn.picture();
    // Pools of descriptors that a change has asked for are there when it comes again.
    (change.act)(&mut drawn.renderer).unwrap();
    (change.undo)(&mut drawn.renderer);
    drawn.picture();
    let before = tape.calls();
    (change.act)(&mut drawn.renderer).unwrap();
    let called = since(tape, &before);
    assert!(drawn.picture() != wanted, "{} changes nothing", change.name);
    (change.undo)(&mut drawn.renderer);
    assert!(drawn.picture() == wanted, "{} is not undone", change.name);
    let alive = drawn.gpu.live_objects();
    let mut faults = 0;
    for (&function, &count) in &called {
        for (&result, nth) in codes(function)
            .iter()
            .flat_map(|r| numbers_of(count).into_iter().map(move |n| (r, n)))
        {
            let what = format!("{}: call {nth} of {function}, {result:?}", change.name);
            tape.fail_from_now(function, nth, result);
            let found = (change.act)(&mut drawn.renderer);
            assert!(tape.has_failed(), "{what} was not called");
            tape.mend();
            match found {
                Err(error) => {
                    let told = of_device(&error).to_string();
                    assert!(told.starts_with("cannot "), "{what}: {told}");
                }
                Ok(()) => {
                    assert!(MAY_PASS.contains(&function), "nobody heard of {what}");
                    (change.undo)(&mut drawn.renderer);
                }
            }
            assert!(drawn.picture() == wanted, "{what}: another picture");
            assert_eq!(drawn.gpu.live_objects(), alive, "left by {what}");
            faults += 1;
        }
    }
    println!("{}: {faults} faults of {:?}", change.name, called.keys());
    faults
}

/// The first, the second and the last of so many calls.
fn numbers_of(count: u32) -> Vec<u32> {
    let mut numbers = vec![0, 1, count - 1];
    numbers.retain(|&call| call < count);
    numbers.dedup();
    numbers
}

/// What may fail, and was called since.
fn since(tape: &Tape, before: &BTreeMap<&'static str, u32>) -> BTreeMap<&'static str, u32> {
    let more = |(name, count): (&'static str, u32)| {
        let more = count - before.get(name).copied().unwrap_or(0);
        (FALLIBLE.contains(&name) && more > 0).then_some((name, more))
    };
    tape.calls().into_iter().filter_map(more).collect()
}

pub fn stage(technique: Technique, mode: Mode) -> Stage {
    let mut stage = Stage::new();
    stage.settings = Settings {
        technique,
        mode,
        ..Settings::default()
    };
    stage.settings.per_mode.levels = vec![level(0.5)];
    stage
}

fn level(value: f64) -> Level {
    Level {
        value,
        srgb: [0.9, 0.6, 0.3],
        opacity: 1.0,
    }
}

#[test]
fn what_fails_to_change_leaves_a_renderer_as_it_was() {
    let tape = Tape::begin();
    let host = Host::new();
    for (technique, mode) in [
        (Technique::Raycast, Mode::Composite),
        (Technique::Raycast, Mode::Iso),
        (Technique::Slices3d, Mode::Mip),
        (Technique::Slices2d, Mode::Composite),
    ] {
        tape.rewind(None);
        let stage = stage(technique, mode);
        let device = host.device(FEATURES);
        // SAFETY: the handles are right, and everything made on the device is dropped before it.
        let gpu = unsafe { Gpu::from_host(device.handles(hooked)).unwrap() };
        let mut drawn = Drawn::new(&device, &gpu, &stage);
        let before = tape.calls();
        drawn.picture();
        let called = since(&tape, &before);
        assert!(
            called.is_empty(),
            "a frame calls {called:?}, which may fail"
        );
        let mut other = Stage {
            volume: stage.volume.clone(),
            ..Stage::new()
        };
        other.settings = stage.settings.clone();
        let stratavox::volume::Voxels::F32(values) = &mut other.volume.voxels else {
            panic!("the stage has f32 values");
        };
        values
            .iter_mut()
            .for_each(|value| *value = 0.7 - 0.8 * *value);
        let [own_volume, other_volume] =
            [&stage, &other].map(|stage| uploaded(&device, &gpu, stage));
        let mut faint = stage.transfer.clone();
        faint
            .opacity
            .iter_mut()
            .for_each(|point| point.value *= 0.7);
        let (own, other) = (Some(&stage.transfer), Some(&faint));
        let mut finer = stage.settings.clone();
        finer.crop = Some([glam::DVec3::splat(2.0), glam::DVec3::splat(13.0)]);
        finer.per_mode.levels = vec![level(0.6)];
        let mut faults = 0;
        if mode != Mode::Iso {
            let change = Change {
                name: "set_function",
                act: &|renderer| renderer.set_function(other),
                undo: &|renderer| renderer.set_function(own).unwrap(),
            };
            faults += sweep(&tape, &mut drawn, &change);
        }
        let change = Change {
            name: "set_settings",
            act: &|renderer| renderer.set_settings(finer.clone()),
            undo: &|renderer| renderer.set_settings(stage.settings.clone()).unwrap(),
        };
        faults += sweep(&tape, &mut drawn, &change);
        let change = Change {
            name: "set_volume",
            act: &|renderer| renderer.set_volume(&other_volume, own),
            undo: &|renderer| renderer.set_volume(&own_volume, own).unwrap(),
        };
        faults += sweep(&tape, &mut drawn, &change);
        faults += resized(&tape, &mut drawn);
        assert!(faults > 60, "only {faults} faults of {technique} {mode}");
        drop(drawn);
        drop((own_volume, other_volume));
        // SAFETY: every submission was waited for.
        unsafe { gpu.retire(u64::MAX) };
        drop(gpu);
        assert_eq!(tape.books(), Vec::<&str>::new(), "left on the device");
    }
}

/// The same for another size, of which there is no picture here.
fn resized(tape: &Tape, drawn: &mut Drawn) -> u32 {
    let (extent, wanted) = (drawn.renderer.extent(), drawn.picture());
    // As above.
    drawn.renderer.resize([20, 24], &[]).unwrap();
    drawn.renderer.resize(extent, &[]).unwrap();
    drawn.picture();
    let before = tape.calls();
    drawn.renderer.resize([20, 24], &[]).unwrap();
    let called = since(tape, &before);
    drawn.renderer.resize(extent, &[]).unwrap();
    assert!(drawn.picture() == wanted, "resize is not undone");
    let alive = drawn.gpu.live_objects();
    let mut faults = 0;
    for (&function, &count) in &called {
        for (&result, nth) in codes(function)
            .iter()
            .flat_map(|r| numbers_of(count).into_iter().map(move |n| (r, n)))
        {
            let what = format!("resize: call {nth} of {function}, {result:?}");
            tape.fail_from_now(function, nth, result);
            let found = drawn.renderer.resize([20, 24], &[]);
            assert!(tape.has_failed(), "{what} was not called");
            tape.mend();
            if found.is_ok() {
                assert!(MAY_PASS.contains(&function), "nobody heard of {what}");
                drawn.renderer.resize(extent, &[]).unwrap();
            }
            assert_eq!(drawn.renderer.extent(), extent, "{what}");
            assert!(drawn.picture() == wanted, "{what}: another picture");
            assert_eq!(drawn.gpu.live_objects(), alive, "left by {what}");
            faults += 1;
        }
    }
    println!("resize: {faults} faults of {:?}", called.keys());
    faults
}
