//! What was recorded before something was replaced is drawn and picked no more: its descriptor sets are gone.

use crate::embed_shared::{Host, HostImage, Stage};
use ash::vk;
use std::sync::Arc;
use stratavox::embed::{Error, FrameInfo, Renderer, RendererDesc, Volume};
use stratavox::gpu::Load;
use stratavox::technique::{Level, Mode, Order, Settings, Technique};

const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const FRAMES: u32 = 2;
const PIXEL: [u32; 2] = [20, 15];

fn uploaded(host: &Host, stage: &Stage) -> Arc<Volume> {
    let mut volume = Volume::new(host.gpu(), &stage.volume, &stage.settings).unwrap();
    // SAFETY: outside rendering; `run` waits.
    host.run(|cmd| unsafe { volume.record_upload(host.gpu(), cmd).unwrap() });
    Arc::new(volume)
}

fn renderer(host: &Host, stage: &Stage) -> Renderer {
    let class = RendererDesc {
        settings: stage.settings.clone(),
        target: FORMAT.into(),
        frames_in_flight: FRAMES,
        host_depth: false,
        gives_depth: false,
        picks: true,
        slice_blending: Default::default(),
    };
    let (volume, function) = (uploaded(host, stage), Some(&stage.transfer));
    Renderer::new(host.gpu(), &volume, function, class, stage.extent, &[]).unwrap()
}

fn shot(stage: &Stage, frame: u32) -> FrameInfo<'_> {
    FrameInfo {
        frame,
        camera: &stage.camera,
        depth: None,
    }
}

/// Something that a host changes.
type Change<'a> = Box<dyn Fn(&mut Renderer) + 'a>;

/// A frame by level B.
fn drawn(host: &Host, renderer: &mut Renderer, stage: &Stage) -> Vec<[f64; 4]> {
    let image = HostImage::new(host, FORMAT, renderer.extent());
    let target = image.target();
    // SAFETY: recorded in order; `run` waits.
    host.run(|cmd| unsafe {
        let load = Load::Clear([0.0; 4]);
        renderer
            .record_into(cmd, &shot(stage, 0), &target, load)
            .unwrap();
        image.copy_from(cmd, vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
    });
    image.numbers()
}

/// What draws a frame that was recorded, or picks from it.
fn uses(renderer: &mut Renderer, frame: u32) -> [Result<(), Error>; 3] {
    let nothing = vk::CommandBuffer::null();
    // SAFETY: what is refused records nothing; what is not would end here.
    unsafe {
        [
            renderer.draw(nothing, frame),
            renderer.draw_depth(nothing, frame),
            renderer.record_pick(nothing, frame, PIXEL),
        ]
    }
}

#[test]
fn a_frame_of_what_was_replaced_is_drawn_no_more() {
    let host = Host::new();
    for (technique, mode) in [
        (Technique::Raycast, Mode::Composite),
        (Technique::Raycast, Mode::Iso),
        (Technique::Slices3d, Mode::Composite),
        (Technique::Slices2d, Mode::Mip),
    ] {
        let level = |value| Level {
            value,
            srgb: [0.9, 0.6, 0.3],
            opacity: 1.0,
        };
        let mut settings = Settings {
            technique,
            mode,
            order: Order::BackToFront,
            ..Settings::default()
        };
        settings
            .per_mode
            .levels
            .extend((mode == Mode::Iso).then(|| level(0.5)));
        let mut stage = Stage::new(settings);
        stage.settings.conformance = false;
        let mut renderer = renderer(&host, &stage);
        let other = uploaded(&host, &stage);
        let function = stage.transfer.clone();
        let mut changes: Vec<(&str, Change)> = vec![
            (
                "set_function",
                Box::new(|renderer| renderer.set_function(Some(&function)).unwrap()),
            ),
            (
                "set_volume",
                Box::new(|renderer| renderer.set_volume(&other, Some(&function)).unwrap()),
            ),
            (
                "resize",
                Box::new(|renderer| renderer.resize(renderer.extent(), &[]).unwrap()),
            ),
        ];
        if mode == Mode::Iso {
            let mut settings = stage.settings.clone();
            settings.per_mode.levels = vec![level(0.55)];
            let there = stage.settings.clone();
            let change = move |renderer: &mut Renderer| {
                renderer.set_settings(settings.clone()).unwrap();
                renderer.set_settings(there.clone()).unwrap();
            };
            changes.push(("set_settings", Box::new(change)));
        }
        let wanted = drawn(&host, &mut renderer, &stage);
        for (what, change) in changes {
            for frame in 0..FRAMES {
                // SAFETY: outside rendering; `run` waits.
                host.run(|cmd| unsafe { renderer.record(cmd, &shot(&stage, frame)).unwrap() });
            }
            change(&mut renderer);
            for frame in 0..FRAMES {
                for found in uses(&mut renderer, frame) {
                    let is_told = matches!(&found, Err(Error::NotRecorded { .. }));
                    assert!(
                        is_told,
                        "{technique}, {mode}, {what}, frame {frame}: {found:?}"
                    );
                }
            }
            let found = drawn(&host, &mut renderer, &stage);
            assert!(found == wanted, "{technique}, {mode}, after {what}");
            // The frame that was not recorded anew is still none.
            let found = uses(&mut renderer, 1);
            let is_told =
                |found: &Result<(), Error>| matches!(found, Err(Error::NotRecorded { .. }));
            assert!(
                found.iter().all(is_told),
                "{technique}, {mode}, {what}: {found:?}"
            );
        }
    }
}
