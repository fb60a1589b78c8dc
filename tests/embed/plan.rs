//! What a volume will take is known before its voxels are read, and is what it takes then.

use crate::embed_shared::{Host, Stage};
use stratavox::embed::Volume;
use stratavox::gpu::Caps;
use stratavox::technique::{Filter, Settings, Technique};

#[test]
fn a_plan_tells_bytes_and_bricks_of_what_is_made_later() {
    let small = Caps {
        max_image_dimension_3d: 11,
        max_image_array_layers: 9,
        ..Caps::UNLIMITED
    };
    for caps in [Caps::UNLIMITED, small] {
        let host = Host::with_caps(caps);
        let gpu = host.gpu();
        for (technique, filter) in [
            (Technique::Raycast, Filter::Linear),
            (Technique::Raycast, Filter::Cubic),
            (Technique::Slices3d, Filter::Linear),
            (Technique::Slices2d, Filter::Linear),
        ] {
            let stage = Stage::new(Settings {
                technique,
                filter,
                ..Settings::default()
            });
            let (dims, stored) = (stage.volume.dims, stage.volume.voxels.voxel_type());
            let holes = stage.volume.validity.is_some();
            let plan = Volume::plan(gpu, dims, stored, holes, &stage.settings).unwrap();
            let before = gpu.memory().used_bytes;
            let made = Volume::new(gpu, &stage.volume, &stage.settings).unwrap();
            let took = gpu.memory().used_bytes - before;
            let what = format!("{technique:?} {filter:?}: {plan:?}, took {took}");
            let layout = stage.view().texture_layout();
            let bricks = made.copy(layout).unwrap().bricks().len();
            assert!(plan.bricks >= bricks, "{what}: {bricks} bricks");
            // Each object is padded to what the driver wants, pages at most, which graphics cards have larger; some small
            // buffers come to it.
            let page = if gpu.is_cpu() { 4096 } else { 65_536 };
            let objects = 2 * plan.bricks as u64 * 3 + 16;
            let planned = plan.device_bytes + plan.staging_bytes;
            assert!(took >= plan.staging_bytes, "{what}");
            assert!(
                took >= planned && took <= planned + page * objects,
                "{what}"
            );
        }
    }
}
