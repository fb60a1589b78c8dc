//! Several views of several volumes in one frame of a host: each is drawn as if it were alone.

use crate::embed_shared::{Host, HostImage, Stage};
use ash::vk;
use std::sync::Arc;
use stratavox::camera::Camera;
use stratavox::embed::{FrameInfo, Renderer, RendererDesc, Volume};
use stratavox::gpu::{Load, Target, Use};
use stratavox::technique::{Mode, Order, Settings, Technique};

const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

fn target(image: &HostImage, before: Use) -> Target {
    Target {
        image: image.raw,
        view: image.view,
        format: image.format,
        extent: image.extent,
        before: before.into(),
        after: Use::TransferRead.into(),
    }
}

fn renderer(host: &Host, stage: &Stage, volume: &Arc<Volume>) -> Renderer {
    let class = RendererDesc {
        settings: stage.settings.clone(),
        target: FORMAT.into(),
        frames_in_flight: 1,
        host_depth: false,
        gives_depth: false,
        picks: false,
        slice_blending: Default::default(),
    };
    let function = Some(&stage.transfer);
    Renderer::new(host.gpu(), volume, function, class, stage.extent, &[]).unwrap()
}

/// Volumes, cameras and settings that differ.
fn stages() -> Vec<Stage> {
    let ways = [
        (Technique::Raycast, Mode::Composite),
        (Technique::Raycast, Mode::Mip),
        (Technique::Slices3d, Mode::Composite),
        (Technique::Slices2d, Mode::Composite),
        (Technique::ShearWarp, Mode::Composite),
    ];
    let made = (1..).zip(ways).map(|(n, (technique, mode))| {
        let mut stage = Stage::new(Settings {
            technique,
            mode,
            order: Order::BackToFront,
            ..Settings::default()
        });
        let stratavox::volume::Voxels::F32(values) = &mut stage.volume.voxels else {
            panic!("the stage has f32 values");
        };
        values
            .iter_mut()
            .for_each(|value| *value *= 1.0 - 0.1 * n as f32);
        stage
    });
    made.collect()
}

#[test]
fn several_volumes_each_seen_twice_are_recorded_at_once_and_drawn_as_if_alone() {
    let host = Host::new();
    let stages = stages();
    let views = |stage: &Stage| {
        [1.8, 1.2].map(|zoom| Camera {
            zoom,
            ..stage.camera
        })
    };
    let mut volumes = Vec::new();
    for stage in &stages {
        volumes.push(Volume::new(host.gpu(), &stage.volume, &stage.settings).unwrap());
    }
    // All uploads in one recording too.
    // SAFETY: outside rendering; `run` waits.
    host.run(|cmd| unsafe {
        for volume in &mut volumes {
            volume.record_upload(host.gpu(), cmd).unwrap();
        }
    });
    let volumes: Vec<_> = volumes.into_iter().map(Arc::new).collect();
    // One renderer a view: they share the volume.
    let of_stage = |(stage, volume)| [(); 2].map(|()| renderer(&host, stage, volume));
    let mut renderers: Vec<_> = stages.iter().zip(&volumes).map(of_stage).collect();
    let image = || HostImage::new(&host, FORMAT, stages[0].extent);
    let draw = |cmd, renderer: &mut Renderer, camera: &Camera, image: &HostImage| {
        let (frame, depth) = (0, None);
        let shot = FrameInfo {
            frame,
            camera,
            depth,
        };
        let (target, load) = (target(image, Use::Nothing), Load::Clear([0.0; 4]));
        // SAFETY: recorded in order; `run` waits.
        unsafe {
            renderer.record_into(cmd, &shot, &target, load).unwrap();
            image.copy_from(cmd, vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
        }
    };
    let together: Vec<_> = stages.iter().map(|_| [image(), image()]).collect();
    host.run(|cmd| {
        for ((stage, pair), images) in stages.iter().zip(&mut renderers).zip(&together) {
            for ((camera, renderer), image) in views(stage).iter().zip(pair).zip(images) {
                draw(cmd, renderer, camera, image);
            }
        }
    });
    for ((stage, pair), images) in stages.iter().zip(&mut renderers).zip(&together) {
        let mut pictures = Vec::new();
        for ((camera, renderer), there) in views(stage).iter().zip(pair).zip(images) {
            let alone = image();
            host.run(|cmd| draw(cmd, renderer, camera, &alone));
            let what = format!("{:?}", stage.settings);
            assert!(there.numbers() == alone.numbers(), "{what}");
            pictures.push(there.numbers());
        }
        assert!(pictures[0] != pictures[1], "two views");
    }
}

#[test]
fn one_volume_is_drawn_over_another_in_the_order_of_recording() {
    let host = Host::new();
    let stages = stages();
    let pair = [&stages[2], &stages[0]];
    let mut renderers = pair.map(|stage| {
        let mut volume = Volume::new(host.gpu(), &stage.volume, &stage.settings).unwrap();
        // SAFETY: outside rendering; `run` waits.
        host.run(|cmd| unsafe { volume.record_upload(host.gpu(), cmd).unwrap() });
        renderer(&host, stage, &Arc::new(volume))
    });
    let images = [(); 3].map(|()| HostImage::new(&host, FORMAT, pair[0].extent));
    let mut draw = |which: &[usize], image: &HostImage| {
        // SAFETY: in order; `run` waits; what is there is kept for the second.
        host.run(|cmd| unsafe {
            let mut before = (Use::Nothing, Load::Clear([0.0; 4]));
            for &k in which {
                let shot = FrameInfo {
                    frame: 0,
                    camera: &pair[k].camera,
                    depth: None,
                };
                let target = target(image, before.0);
                let renderer = &mut renderers[k];
                renderer.record_into(cmd, &shot, &target, before.1).unwrap();
                before = (Use::TransferRead, Load::Keep);
            }
            image.copy_from(cmd, vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
        });
        image.numbers()
    };
    let [back, front] = [draw(&[0], &images[0]), draw(&[1], &images[1])];
    let both = draw(&[0, 1], &images[2]);
    // Rays that end in one resolve are blended once: c + (1 - a) old.
    for ((both, back), front) in both.iter().zip(&back).zip(&front) {
        for c in 0..4 {
            let wanted = front[c] + (1.0 - front[3]) * back[c];
            // A product and a sum of numbers up to 1, each rounded once in f32.
            assert!((both[c] - wanted).abs() <= 3.0 * 2f64.powi(-23), "{both:?}");
        }
    }
    assert!(both != front && both != back);
}
