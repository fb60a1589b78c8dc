//! A host records the patches of slices: lists outside its rendering, draws inside. Nothing is made meanwhile, and the
//! picture is that of whole slices.

use crate::embed_shared::{Host, HostImage, OnDevice, Stage};
use ash::vk;
use stratavox::resident::{EmptySpace, MacroCells};
use stratavox::technique::blend::Drawn;
use stratavox::technique::{
    Inputs, Mode, PatchSlicer, Patches, Settings, ShaderVariant, Skip, Skippable, Slicer,
    Technique, parameter_ring,
};

const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const DRAWN: [f32; 4] = [0.25, 0.0, 0.5, 1.0];

#[test]
fn patches_inside_the_hosts_rendering_are_the_picture_of_whole_slices() {
    for technique in [Technique::Slices3d, Technique::Slices2d] {
        let host = Host::new();
        let gpu = host.gpu();
        let mut stage = Stage::new(Settings {
            technique,
            ..Settings::default()
        });
        // Only the highest values are seen.
        let high = stage.volume.value_range[1];
        for point in &mut stage.transfer.opacity {
            point.opacity = if point.value > 0.8 * high { 0.7 } else { 0.0 };
        }
        let there = OnDevice::new(&host, &stage);
        let words = ShaderVariant::of(&stage.settings, &there.volume);
        let picture = Drawn::Picture(Mode::Composite);
        let order = stage.settings.order;
        let ring = parameter_ring(gpu, 1).unwrap();
        let view = stage.view();
        let range = stage.volume.value_range;
        let mix = stratavox::technique::SampleInputs::Scalar;
        let skippable = stage
            .settings
            .skippable(mix, Some(&stage.transfer), range, None);
        let Skippable::Unseen(seen) = skippable else {
            panic!("{skippable:?}");
        };
        let cells = MacroCells::new(gpu, &there.volume, view.halo().unwrap()).unwrap();
        let empty = EmptySpace::new(gpu, &cells, &seen).unwrap();
        let skip = Skip::Unseen(&cells, &empty);
        let mut recording = view
            .recordings(&there.volume, Some(&there.transfer))
            .unwrap()[0];
        recording.skip(skip);
        let offset = recording.write(&ring, 0).unwrap();
        let inputs = Inputs {
            beside: &[],
            light: None,
            points: None,
            field: None,
            sky: None,
            skip,
            ring: &ring,
            volume: &there.volume,
            brick: &there.volume.bricks()[0],
            transfer: Some(&there.transfer),
        };
        let whole = Slicer::new(gpu, technique, picture, order, &words, FORMAT).unwrap();
        let slicer = PatchSlicer::new(gpu, technique, picture, order, &words, FORMAT).unwrap();
        let room = view.patch_room().unwrap();
        let patches = Patches::new(gpu, room).unwrap();
        let of_whole = whole.bind(&inputs).unwrap();
        let bound = slicer.bind(&inputs, &patches, None).unwrap();
        let (extent, slices) = (stage.extent, recording.slices);
        let images = [(); 2].map(|()| HostImage::new(&host, FORMAT, extent));
        // SAFETY: draws are inside the host's rendering, all else outside; all of it lives until `run` has waited.
        host.run(|cmd| unsafe {
            cells.record(cmd).unwrap();
            empty.record(cmd).unwrap();
        });
        let made = || {
            (
                gpu.live_objects(),
                gpu.pipelines_made(),
                gpu.memory().reserved_bytes,
            )
        };
        let before = made();
        // SAFETY: as above.
        host.run(|cmd| unsafe {
            patches.record_start(cmd);
            let squares = room.squares;
            slicer
                .record_lists(cmd, &bound, offset, &patches, squares, slices)
                .unwrap();
            for image in &images {
                image.make_target(cmd);
            }
            host.begin_rendering(cmd, images[0].view, extent, DRAWN);
            slicer.record(cmd, &bound, offset, extent, &patches, 0..slices);
            host.device.cmd_end_rendering(cmd);
            host.begin_rendering(cmd, images[1].view, extent, DRAWN);
            whole.record(cmd, &of_whole, offset, extent, 0..slices);
            host.device.cmd_end_rendering(cmd);
            for image in &images {
                image.fetch_drawn(cmd);
            }
        });
        assert_eq!(made(), before, "recording made something");
        let [patched, whole] = images.map(|image| image.numbers());
        assert!(patched == whole, "{technique:?}");
        let is_drawn = |pixel: &[f64; 4]| *pixel != DRAWN.map(f64::from);
        assert!(whole.iter().any(is_drawn), "an empty picture");
    }
}
