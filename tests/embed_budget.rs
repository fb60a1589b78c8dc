//! A budget of memory is obeyed: what does not fit is refused by name, and what fits draws the same picture.

mod embed_shared;
mod shared;

use ash::vk;
use embed_shared::{Host, HostImage, Stage};
use std::sync::Arc;
use stratavox::embed::{self, Class, Renderer, Shot, Volume};
use stratavox::gpu::{self, Load, Target, Use};
use stratavox::technique::{Settings, Technique};

const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

fn stage(technique: Technique) -> Stage {
    Stage::new(Settings {
        technique,
        ..Settings::default()
    })
}

/// All that a picture takes, or the first refusal.
fn picture(host: &Host, stage: &Stage) -> Result<Vec<[f64; 4]>, embed::Error> {
    let gpu = host.gpu();
    let mut volume = Volume::new(gpu, &stage.volume, &stage.settings)?;
    // SAFETY: outside rendering; `run` waits.
    host.run(|cmd| unsafe { volume.record_upload(gpu, cmd).unwrap() });
    let class = Class {
        settings: stage.settings.clone(),
        target: FORMAT.into(),
        frames_in_flight: 1,
        host_depth: false,
        gives_depth: false,
    };
    let (volume, function) = (Arc::new(volume), Some(&stage.transfer));
    let mut renderer = Renderer::new(gpu, &volume, function, class, stage.extent, &[])?;
    let image = HostImage::new(host, FORMAT, stage.extent);
    let target = Target {
        image: image.raw,
        view: image.view,
        format: image.format,
        extent: image.extent,
        before: Use::Nothing.into(),
        after: Use::TransferRead.into(),
    };
    let shot = Shot {
        frame: 0,
        camera: &stage.camera,
        depth: None,
    };
    // SAFETY: recorded in order; `run` waits.
    host.run(|cmd| unsafe {
        let load = Load::Clear([0.0; 4]);
        renderer.record_into(cmd, &shot, &target, load).unwrap();
        image.copy_from(cmd, vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
    });
    Ok(image.numbers())
}

#[test]
fn twenty_budgets_give_the_picture_or_a_refusal_and_are_never_passed() {
    for technique in [Technique::Raycast, Technique::Slices2d] {
        let stage = stage(technique);
        // What it takes where each object has memory of its own.
        let host = Host::new();
        host.gpu().set_memory_budget(Some(60 << 20));
        let wanted = picture(&host, &stage).unwrap();
        let most = host.gpu().memory().peak_bytes;
        let mut refusals = 0;
        for part in 1..=20 {
            let budget = most * part / 20;
            let host = Host::new();
            host.gpu().set_memory_budget(Some(budget));
            match picture(&host, &stage) {
                Ok(found) => assert!(found == wanted, "{technique:?} in {budget} bytes"),
                Err(embed::Error::Gpu(gpu::Error::Limit {
                    limit,
                    wanted,
                    allowed,
                    ..
                })) => {
                    assert_eq!(limit, "the memory budget of the host");
                    assert!(allowed == budget && wanted > budget, "{wanted} in {budget}");
                    refusals += 1;
                }
                Err(other) => panic!("{technique:?} in {budget} bytes: {other}"),
            }
            let memory = host.gpu().memory();
            assert_eq!(memory.budget_bytes, Some(budget));
            assert!(memory.peak_bytes <= budget, "{memory:?}");
            assert!(memory.used_bytes <= memory.reserved_bytes, "{memory:?}");
        }
        assert!((1..20).contains(&refusals), "{refusals} refusals");
    }
}

#[test]
fn a_volume_beyond_the_budget_is_refused_before_anything_is_made() {
    let host = Host::new();
    let (gpu, stage) = (host.gpu(), stage(Technique::Raycast));
    let (dims, stored) = (stage.volume.dims, stage.volume.voxels.voxel_type());
    let plan = Volume::plan(gpu, dims, stored, false, &stage.settings).unwrap();
    let needed = plan.device_bytes + plan.staging_bytes;
    gpu.set_memory_budget(Some(needed - 1));
    let refused = Volume::new(gpu, &stage.volume, &stage.settings).map(drop);
    let Err(embed::Error::Gpu(gpu::Error::Limit {
        doing,
        wanted,
        allowed,
        ..
    })) = refused
    else {
        panic!("{refused:?}");
    };
    assert_eq!((wanted, allowed), (needed, needed - 1));
    assert_eq!(doing, "make a volume of [19, 22, 16] voxels");
    assert!(gpu.live_objects().is_empty() && gpu.memory().allocations == 0);
    // Without the budget it is there, and counted.
    gpu.set_memory_budget(None);
    let made = Volume::new(gpu, &stage.volume, &stage.settings).unwrap();
    let memory = gpu.memory();
    assert!(
        memory.allocations > 0 && memory.used_bytes >= needed,
        "{memory:?}"
    );
    assert!(
        memory.used_bytes <= memory.reserved_bytes && memory.reserved_bytes <= memory.peak_bytes
    );
    // No driver here has the extension, or it tells of every heap.
    assert!(memory.heaps.iter().all(|heap| heap.budget_bytes > 0));
    drop(made);
}

#[test]
fn what_no_longer_fits_leaves_a_renderer_as_it_was() {
    let host = Host::new();
    let (gpu, stage) = (host.gpu(), stage(Technique::Raycast));
    let wanted = picture(&host, &stage).unwrap();
    let volume = {
        let mut volume = Volume::new(gpu, &stage.volume, &stage.settings).unwrap();
        // SAFETY: outside rendering; `run` waits.
        host.run(|cmd| unsafe { volume.record_upload(gpu, cmd).unwrap() });
        Arc::new(volume)
    };
    let class = Class {
        settings: stage.settings.clone(),
        target: FORMAT.into(),
        frames_in_flight: 1,
        host_depth: false,
        gives_depth: false,
    };
    let function = Some(&stage.transfer);
    let mut renderer = Renderer::new(gpu, &volume, function, class, stage.extent, &[]).unwrap();
    gpu.set_memory_budget(Some(gpu.memory().reserved_bytes + 4096));
    let refused = renderer.resize([1000, 1000], &[]);
    assert!(
        matches!(refused, Err(embed::Error::Gpu(gpu::Error::Limit { .. }))),
        "{refused:?}"
    );
    assert_eq!(renderer.extent(), stage.extent);
    let image = HostImage::new(&host, FORMAT, stage.extent);
    let target = Target {
        image: image.raw,
        view: image.view,
        format: image.format,
        extent: image.extent,
        before: Use::Nothing.into(),
        after: Use::TransferRead.into(),
    };
    let shot = Shot {
        frame: 0,
        camera: &stage.camera,
        depth: None,
    };
    // SAFETY: recorded in order; `run` waits.
    host.run(|cmd| unsafe {
        let load = Load::Clear([0.0; 4]);
        renderer.record_into(cmd, &shot, &target, load).unwrap();
        image.copy_from(cmd, vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
    });
    assert!(image.numbers() == wanted);
}
