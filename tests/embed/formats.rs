//! Each technique draws the offscreen picture into every format of a host's target, at each level: at most one code off,
//! or one unit in the last place of a float. Slices are blended with each other in floats, whatever the target is.

use crate::embed_shared::{Host, HostImage, Stage, offscreen, offscreen_with};
use crate::shared::device_with;
use ash::vk;
use std::sync::Arc;
use stratavox::color::encode_srgb;
use stratavox::embed::{
    FrameInfo, QueueLock, Renderer, RendererDesc, SliceBlending, Submitter, Volume,
};
use stratavox::gpu::{Caps, Load};
use stratavox::picture::ColorSpace;
use stratavox::technique::{Mode, Order, Settings, Technique};

const TECHNIQUES: [Technique; 3] = [Technique::Raycast, Technique::Slices3d, Technique::Slices2d];

/// What the numbers of a target are, in which the offscreen picture is told.
#[derive(Clone, Copy, Debug)]
pub enum Stored {
    /// Codes of linear light or of what is shown, as the settings say: 255 for 8 bits, 1023 for 10 with 3 of alpha.
    Codes([f64; 4]),
    /// Codes of 8 bits whose colours the device encodes.
    SrgbCodes,
    /// Floats with so many bits of mantissa.
    Floats([i32; 4]),
}

/// UNORM targets get what [`Settings::color_space`] says, undone by nobody: the numbers of `Display` where they are shown
/// as they are, and else linear light.
const TARGETS: [(vk::Format, ColorSpace, Stored); 8] = [
    (
        vk::Format::R8G8B8A8_UNORM,
        ColorSpace::Linear,
        Stored::Codes([255.0; 4]),
    ),
    (
        vk::Format::R8G8B8A8_UNORM,
        ColorSpace::Display,
        Stored::Codes([255.0; 4]),
    ),
    (
        vk::Format::R8G8B8A8_SRGB,
        ColorSpace::Linear,
        Stored::SrgbCodes,
    ),
    (
        vk::Format::B8G8R8A8_UNORM,
        ColorSpace::Display,
        Stored::Codes([255.0; 4]),
    ),
    (
        vk::Format::A2B10G10R10_UNORM_PACK32,
        ColorSpace::Display,
        Stored::Codes([1023.0, 1023.0, 1023.0, 3.0]),
    ),
    (
        vk::Format::R16G16B16A16_SFLOAT,
        ColorSpace::Linear,
        Stored::Floats([10; 4]),
    ),
    (
        vk::Format::B10G11R11_UFLOAT_PACK32,
        ColorSpace::Linear,
        Stored::Floats([6, 6, 5, 0]),
    ),
    (
        vk::Format::R32G32B32A32_SFLOAT,
        ColorSpace::Linear,
        Stored::Floats([23; 4]),
    ),
];

impl Stored {
    /// What a channel of the target holds for `wanted`, and how far it may be off. Offscreen and embedded pictures are
    /// gathered in the same format on one device, so that the gather itself adds nothing.
    pub fn of(self, channel: usize, wanted: f64) -> (f64, f64) {
        match self {
            Self::Codes(most) => (most[channel] * wanted.clamp(0.0, 1.0), 1.0),
            Self::SrgbCodes if channel < 3 => (255.0 * encode_srgb(wanted.clamp(0.0, 1.0)), 1.0),
            Self::SrgbCodes => (255.0 * wanted, 1.0),
            // Formats without alpha are read as 1.
            Self::Floats(mantissa) if mantissa[channel] == 0 => (1.0, 0.0),
            Self::Floats(mantissa) => {
                let exponent = wanted.abs().max(2f64.powi(-14)).log2().floor();
                (wanted, 2f64.powi(exponent as i32 - mantissa[channel]))
            }
        }
    }
}

fn stage(technique: Technique, mode: Mode, color_space: ColorSpace) -> Stage {
    let mut stage = Stage::new(Settings {
        technique,
        mode,
        color_space,
        ..Settings::default()
    });
    stage.settings.conformance = false;
    stage
}

pub fn renderer(
    host: &Host,
    stage: &Stage,
    format: vk::Format,
    slice_blending: SliceBlending,
) -> Renderer {
    let mut volume = Volume::new(host.gpu(), &stage.volume, &stage.settings).unwrap();
    // SAFETY: outside rendering; `run` waits.
    host.run(|cmd| unsafe { volume.record_upload(host.gpu(), cmd).unwrap() });
    let class = RendererDesc {
        settings: stage.settings.clone(),
        target: format.into(),
        frames_in_flight: 2,
        host_depth: false,
        gives_depth: false,
        picks: false,
        slice_blending,
    };
    let (volume, function) = (Arc::new(volume), Some(&stage.transfer));
    Renderer::new(host.gpu(), &volume, function, class, stage.extent, &[]).unwrap()
}

fn shot(stage: &Stage, frame: u32) -> FrameInfo<'_> {
    FrameInfo {
        frame,
        camera: &stage.camera,
        depth: None,
    }
}

/// The picture at one of the levels.
pub fn drawn(host: &Host, renderer: &mut Renderer, stage: &Stage, image: &HostImage, level: char) {
    let load = Load::Clear([0.0; 4]);
    match level {
        // SAFETY: recorded in order; all of it lives until `run` has waited, here and below.
        'A' => host.run(|cmd| unsafe {
            renderer.record(cmd, &shot(stage, 0)).unwrap();
            image.make_target(cmd);
            host.begin_rendering(cmd, image.view, stage.extent, [0.0; 4]);
            renderer.draw(cmd, 0).unwrap();
            host.device.cmd_end_rendering(cmd);
            image.fetch_drawn(cmd);
        }),
        // SAFETY: as above; the target leaves as the copy reads it.
        'B' => host.run(|cmd| unsafe {
            let (shot, target) = (shot(stage, 1), image.target());
            renderer.record_into(cmd, &shot, &target, load).unwrap();
            image.copy_from(cmd, vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
        }),
        // SAFETY: as above; the device is idle before anything goes.
        _ => unsafe {
            let in_lock = |submit: &mut dyn FnMut()| submit();
            let lock = QueueLock {
                queue: host.queue,
                locked: &in_lock,
            };
            let mut submitter = Submitter::new(host.gpu(), 2).unwrap();
            let (shot, target) = (shot(stage, 0), image.target());
            submitter
                .submit(renderer, &shot, &target, load, lock, &[], &[])
                .unwrap();
            let fetch = |cmd| {
                image.copy_from(cmd, vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
                Ok(())
            };
            submitter.run(lock, 1, &[], &[], fetch).unwrap();
            host.device.device_wait_idle().unwrap();
        },
    }
}

#[test]
fn each_technique_at_each_level_draws_the_offscreen_picture_into_each_format() {
    let host = Host::that_lets_us_submit();
    for technique in TECHNIQUES {
        for (format, color_space, stored) in TARGETS {
            if !host.gpu().format_features(format).blend {
                println!("skipped: this device does not blend {format:?}");
                continue;
            }
            for mode in [Mode::Composite, Mode::Mip] {
                let stage = stage(technique, mode, color_space);
                let wanted = offscreen(&stage);
                let mut renderer = renderer(&host, &stage, format, SliceBlending::Float);
                let image = HostImage::new(&host, format, stage.extent);
                for level in ['A', 'B', 'C'] {
                    drawn(&host, &mut renderer, &stage, &image, level);
                    let mut worst = 0.0f64;
                    for (found, wanted) in image.numbers().iter().zip(&wanted) {
                        for c in 0..4 {
                            let (stored, allowed) = stored.of(c, wanted[c]);
                            let off = (found[c] - stored).abs();
                            assert!(
                                off <= allowed,
                                "{technique} {mode} at level {level} into {format:?} ({color_space:?}), channel {c}: \
                                 {} for {stored} +- {allowed}",
                                found[c]
                            );
                            worst = worst.max(off / allowed.max(f64::MIN_POSITIVE));
                        }
                    }
                    println!(
                        "{technique} {mode} {level} {format:?} {color_space:?}: {worst:.2} of what is allowed"
                    );
                }
            }
        }
    }
}

/// Batches of 16-bit floats, merged in 32 bits, where the device does not blend 32: to the bit what offscreen gathers there,
/// and in parts the same.
#[test]
fn where_32_bit_floats_are_not_blended_slices_are_gathered_in_batches() {
    let caps = Caps {
        float32_blend: false,
        ..Caps::UNLIMITED
    };
    let host = Host::with_caps(caps);
    let format = vk::Format::R16G16B16A16_SFLOAT;
    for technique in [Technique::Slices3d, Technique::Slices2d] {
        for order in [Order::BackToFront, Order::FrontToBack] {
            let mut stage = stage(technique, Mode::Composite, ColorSpace::Linear);
            stage.settings.order = order;
            // More than one batch of 64.
            stage.settings.samples_per_voxel = 4.0;
            let wanted = offscreen_with(&stage, device_with(caps));
            let mut renderer = renderer(&host, &stage, format, SliceBlending::Float);
            let image = HostImage::new(&host, format, stage.extent);
            drawn(&host, &mut renderer, &stage, &image, 'B');
            let whole = image.numbers();
            for (found, wanted) in whole.iter().zip(&wanted) {
                for c in 0..4 {
                    let (stored, allowed) = Stored::Floats([10; 4]).of(c, wanted[c]);
                    let off = (found[c] - stored).abs();
                    assert!(off <= allowed, "{technique} {order:?}: {off} of {allowed}");
                }
            }
            let parts = HostImage::new(&host, format, stage.extent);
            let mut left = renderer.begin_parts(&shot(&stage, 0)).unwrap();
            while left > 0 {
                // SAFETY: one part a submission, in order; `run` waits.
                host.run(|cmd| unsafe {
                    let (target, load) = (parts.target(), Load::Clear([0.0; 4]));
                    left = renderer.record_part_into(cmd, 0, 1, &target, load).unwrap();
                });
            }
            // SAFETY: the target is as it was said to leave.
            host.run(|cmd| unsafe {
                parts.copy_from(cmd, vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
            });
            assert!(parts.numbers() == whole, "{technique} {order:?} in parts");
        }
    }
}

/// A fog of slices of which each is fainter than half a code of 8 bits: floats add them up, and blending in the target
/// loses each of them, which is why it has a name of its own. View-aligned slices are eight a voxel.
#[test]
fn faint_slices_add_up_in_floats_and_vanish_where_they_are_blended_in_8_bits() {
    let host = Host::new();
    // Opacity of the densest slice: under 1 / 510.
    for (technique, opacity) in [(Technique::Slices3d, 0.01), (Technique::Slices2d, 0.0018)] {
        let fog = || {
            let mut stage = stage(technique, Mode::Composite, ColorSpace::Linear);
            for point in &mut stage.transfer.opacity {
                point.opacity *= opacity;
            }
            stage.settings.samples_per_voxel = 8.0;
            stage
        };
        let fog = fog();
        let alpha = |format, blending, most: f64| {
            let mut renderer = renderer(&host, &fog, format, blending);
            let image = HostImage::new(&host, format, fog.extent);
            drawn(&host, &mut renderer, &fog, &image, 'B');
            let numbers = image.numbers();
            numbers.iter().map(|p| p[3] / most).fold(0.0, f64::max)
        };
        let exact = alpha(
            vk::Format::R32G32B32A32_SFLOAT,
            SliceBlending::InTarget,
            1.0,
        );
        let format = vk::Format::R8G8B8A8_UNORM;
        let gathered = alpha(format, SliceBlending::Float, 255.0);
        let in_target = alpha(format, SliceBlending::InTarget, 255.0);
        println!("{technique}: {exact:.4}, gathered {gathered:.4}, in the target {in_target:.4}");
        assert!(exact > 2.0 / 255.0, "a fog that nobody sees: {exact}");
        assert!(
            (gathered - exact).abs() <= 1.0 / 255.0,
            "{gathered} for {exact}"
        );
        assert_eq!(in_target, 0.0);
    }
}
