//! A host records our techniques into its own command buffer and finds the CPU reference's picture in its own image.

use crate::embed_shared::{Host, HostImage, OnDevice, Stage, assert_close, over};
use ash::vk;
use stratavox::gpu::{Blend, Caps, Image, ParameterRing, Use, image_barrier};
use stratavox::picture::ColorSpace;
use stratavox::resolve::Resolve;
use stratavox::technique::blend::Drawn;
use stratavox::technique::projection::Projection;
use stratavox::technique::raycast::Raycast;
use stratavox::technique::{
    Inputs, Mode, Order, RayBindings, RayTiles, Settings, ShaderVariant, Slicer, Technique,
    accumulation, parameter_ring,
};

/// Behind the volume, in numbers that 8 bits and halves hold exactly where they are not sRGB.
const DRAWN: [f32; 4] = [51.0 / 255.0, 0.0, 1.0, 1.0];

const FLOATS: [vk::Format; 2] = [
    vk::Format::R16G16B16A16_SFLOAT,
    vk::Format::R32G32B32A32_SFLOAT,
];

/// What a host draws that stands behind the volume, and its format.
fn targets() -> [(vk::Format, ColorSpace); 3] {
    [
        (vk::Format::R8G8B8A8_SRGB, ColorSpace::Linear),
        (vk::Format::R16G16B16A16_SFLOAT, ColorSpace::Linear),
        // Shown as it is, as swapchains without sRGB are.
        (vk::Format::B8G8R8A8_UNORM, ColorSpace::Display),
    ]
}

fn inputs<'a>(ring: &'a ParameterRing, there: &'a OnDevice, brick: usize) -> Inputs<'a> {
    Inputs {
        beside: &[],
        light: None,
        points: None,
        field: None,
        sky: None,
        skip: stratavox::technique::Skip::Nothing,
        ring,
        volume: &there.volume,
        brick: &there.volume.bricks()[brick],
        transfer: Some(&there.transfer),
    }
}

/// A compute pass and its resolve over the host's own drawing. How many bricks the volume took.
fn over_the_hosts_drawing(host: &Host, stage: &Stage, format: vk::Format) -> usize {
    let gpu = host.gpu();
    let there = OnDevice::new(host, stage);
    let Settings { mode, .. } = stage.settings;
    let words = ShaderVariant::of(&stage.settings, &there.volume);
    let bricks = there.volume.bricks().len();
    let ring = parameter_ring(gpu, bricks as u32).unwrap();
    let gathered = accumulation(gpu, stage.extent, "gathered").unwrap();
    let layers = accumulation(gpu, stage.extent, "layers").unwrap();
    let gather = Gather::new(host, mode, &words);
    let tiles = RayTiles::new(gpu, stage.extent).unwrap();
    let bind = |brick| gather.bind(&inputs(&ring, &there, brick), &gathered, &layers, &tiles);
    let bound: Vec<_> = (0..bricks).map(bind).collect();
    let resolve = Resolve::new(gpu, mode, Blend::Over, format).unwrap();
    let resolved = resolve
        .bind(&ring, &gathered, Some(&there.transfer))
        .unwrap();
    let image = HostImage::new(host, format, stage.extent);

    let recordings = stage
        .view()
        .recordings(&there.volume, Some(&there.transfer));
    let slots = (0..).zip(recordings.unwrap());
    let slots = slots.map(|(slot, r)| (r.brick, r.write(&ring, slot).unwrap()));
    let slots: Vec<_> = slots.collect();
    // SAFETY: barriers stand between the passes, and all of it lives until `run` has waited.
    host.run(|cmd| unsafe {
        let mut before = Use::Nothing;
        for &(brick, offset) in &slots {
            for written in [&gathered, &layers] {
                image_barrier(gpu, cmd, written, before, Use::ComputeWrite);
            }
            gather.record(cmd, &bound[brick], offset, stage.extent);
            before = Use::ComputeWrite;
        }
        image_barrier(gpu, cmd, &gathered, Use::ComputeWrite, Use::FragmentSampled);
        image.make_target(cmd);
        host.begin_rendering(cmd, image.view, stage.extent, DRAWN);
        resolve.record(cmd, &resolved, slots[0].1, stage.extent);
        host.device.cmd_end_rendering(cmd);
        image.fetch_drawn(cmd);
    });
    let wanted: Vec<_> = stage.reference().iter().map(|&p| over(p, DRAWN)).collect();
    let what = format!("{mode:?}, {bricks} bricks, into {format:?}");
    assert_close(&image, &wanted, 1, &what);
    bricks
}

enum Gather {
    Raycast(Raycast),
    Projection(Projection),
}

impl Gather {
    fn new(host: &Host, mode: Mode, words: &ShaderVariant) -> Self {
        match mode {
            Mode::Composite => Self::Raycast(Raycast::new(host.gpu(), words).unwrap()),
            mode => Self::Projection(Projection::new(host.gpu(), mode, words).unwrap()),
        }
    }

    fn bind(
        &self,
        inputs: &Inputs,
        gathered: &Image,
        layers: &Image,
        tiles: &RayTiles,
    ) -> RayBindings {
        match self {
            Self::Raycast(pass) => pass.bind(inputs, gathered, layers, tiles).unwrap(),
            Self::Projection(pass) => pass.bind(inputs, gathered, tiles).unwrap(),
        }
    }

    unsafe fn record(
        &self,
        cmd: vk::CommandBuffer,
        bound: &RayBindings,
        at: u32,
        extent: [u32; 2],
    ) {
        // SAFETY: the caller's promises.
        unsafe {
            match self {
                Self::Raycast(pass) => pass.record(cmd, bound, at, extent).unwrap(),
                Self::Projection(pass) => pass.record(cmd, bound, at, extent).unwrap(),
            }
        }
    }
}

#[test]
fn a_ray_cast_volume_stands_before_what_the_host_has_drawn() {
    let host = Host::new();
    for (format, color_space) in targets() {
        let stage = Stage::new(Settings {
            color_space,
            ..Settings::default()
        });
        over_the_hosts_drawing(&host, &stage, format);
    }
}

#[test]
fn a_projected_maximum_stands_before_what_the_host_has_drawn() {
    let host = Host::new();
    for (format, color_space) in targets() {
        let stage = Stage::new(Settings {
            mode: Mode::Mip,
            color_space,
            ..Settings::default()
        });
        over_the_hosts_drawing(&host, &stage, format);
    }
}

#[test]
fn a_volume_too_large_for_one_texture_is_staged_and_drawn_in_bricks() {
    let host = Host::with_caps(Caps {
        max_image_dimension_3d: 11,
        ..Caps::UNLIMITED
    });
    for mode in [Mode::Composite, Mode::Mip] {
        let stage = Stage::new(Settings {
            mode,
            ..Settings::default()
        });
        let bricks = over_the_hosts_drawing(&host, &stage, FLOATS[1]);
        assert!(bricks > 8, "only {bricks} bricks");
    }
}

/// Slices of either kind, drawn straight into the host's image; `drawn` stands behind them.
fn slices_into_the_hosts_image(stage: &Stage, format: vk::Format, drawn: [f32; 4]) {
    let host = Host::new();
    let gpu = host.gpu();
    let there = OnDevice::new(&host, stage);
    let Settings {
        technique, order, ..
    } = stage.settings;
    let words = ShaderVariant::of(&stage.settings, &there.volume);
    let ring = parameter_ring(gpu, 1).unwrap();
    let image = HostImage::new(&host, format, stage.extent);
    let recordings = stage
        .view()
        .recordings(&there.volume, Some(&there.transfer));
    let recording = recordings.unwrap()[0];
    let offset = recording.write(&ring, 0).unwrap();
    let (extent, slices) = (stage.extent, recording.slices);
    let picture = Drawn::Picture(Mode::Composite);
    let pass = Slicer::new(gpu, technique, picture, order, &words, format).unwrap();
    let bound = pass.bind(&inputs(&ring, &there, 0)).unwrap();
    // SAFETY: recorded inside the host's rendering; all of it lives until `run` has waited.
    host.run(|cmd| unsafe {
        image.make_target(cmd);
        host.begin_rendering(cmd, image.view, extent, drawn);
        pass.record(cmd, &bound, offset, extent, 0..slices);
        host.device.cmd_end_rendering(cmd);
        image.fetch_drawn(cmd);
    });
    let wanted: Vec<_> = stage.reference().iter().map(|&p| over(p, drawn)).collect();
    let what = format!("{technique:?} {order:?} into {format:?}");
    assert_close(&image, &wanted, slices, &what);
}

#[test]
fn slices_are_drawn_over_the_hosts_drawing_inside_its_rendering() {
    for technique in [Technique::Slices3d, Technique::Slices2d] {
        let stage = Stage::new(Settings {
            technique,
            order: Order::BackToFront,
            ..Settings::default()
        });
        for format in FLOATS {
            slices_into_the_hosts_image(&stage, format, DRAWN);
        }
    }
}

#[test]
fn slices_from_front_to_back_begin_with_an_empty_target() {
    for technique in [Technique::Slices3d, Technique::Slices2d] {
        let stage = Stage::new(Settings {
            technique,
            order: Order::FrontToBack,
            ..Settings::default()
        });
        slices_into_the_hosts_image(&stage, FLOATS[1], [0.0; 4]);
    }
}

#[test]
fn a_volume_that_lies_in_another_way_than_the_view_reads_it_is_refused() {
    let host = Host::new();
    let stage = Stage::new(Settings::default());
    let there = OnDevice::new(&host, &stage);
    let slicing = Settings {
        technique: Technique::Slices2d,
        ..stage.settings.clone()
    };
    let view = stratavox::technique::View {
        settings: &slicing,
        ..stage.view()
    };
    let refused = view.recordings(&there.volume, Some(&there.transfer));
    let found = refused.expect_err("a 3D texture is no stack").to_string();
    let wanted = "the volume lies on the device as Texture3d, this view reads it as Stack(";
    assert!(found.starts_with(wanted), "{found}");
}
