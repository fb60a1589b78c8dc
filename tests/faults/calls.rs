//! How often a renderer calls what costs.

use crate::embedded::{Drawn, stage};
use crate::hooked::{FEATURES, Host, Tape, hooked};
use crate::shared::ramps;
use stratavox::gpu::{Caps, Gpu, HostDevice};
use stratavox::technique::{Mode, Technique};

/// What is asserted of a renderer of volumes in bricks of so many voxels at most.
fn with_bricks(max_image_dimension_3d: u32, assert: impl FnOnce(&mut Drawn, &dyn Fn(&str) -> u32)) {
    let tape = Tape::begin();
    let (host, stage) = (Host::new(), stage(Technique::Raycast, Mode::Composite));
    let device = host.device(FEATURES);
    let caps = Caps {
        max_image_dimension_3d,
        ..Caps::UNLIMITED
    };
    // SAFETY: the handles are right, and everything made on the device is dropped before it.
    let gpu = unsafe {
        let handles = device.handles(hooked);
        Gpu::from_host(HostDevice { caps, ..handles }).unwrap()
    };
    let mut drawn = Drawn::new(&device, &gpu, &stage);
    assert(&mut drawn, &|name| {
        tape.calls().get(name).copied().unwrap_or(0)
    });
    drop(drawn);
    // SAFETY: every submission was waited for.
    unsafe { gpu.retire(u64::MAX) };
    drop(gpu);
    assert_eq!(tape.books(), Vec::<&str>::new(), "left on the device");
}

#[test]
fn functions_of_many_bricks_one_after_the_other_take_no_new_pool_and_free_no_set_in_use() {
    with_bricks(8, |drawn, calls| {
        let own = ramps();
        let mut faint = own.clone();
        faint.opacity.iter_mut().for_each(|at| at.value *= 0.7);
        let mut pools = 0;
        for turn in 0..12 {
            if turn == 2 {
                pools = calls("vkCreateDescriptorPool");
            }
            let [taken, freed] = ["vkAllocateDescriptorSets", "vkFreeDescriptorSets"].map(calls);
            let function = [&faint, &own][turn % 2];
            drawn.renderer.set_function(Some(function)).unwrap();
            let early = calls("vkFreeDescriptorSets") - freed;
            assert_eq!(early, 0, "turn {turn}: freed in use");
            drawn.picture();
            let taken = calls("vkAllocateDescriptorSets") - taken;
            assert!(taken > 100, "only {taken} sets of all bricks");
            assert_eq!(calls("vkFreeDescriptorSets") - freed, taken, "turn {turn}");
        }
        assert_eq!(calls("vkCreateDescriptorPool"), pools);
    });
}

#[test]
fn a_picture_by_rays_has_few_barriers() {
    // Three a brick around its tiles, and those of images, target, pick and readback.
    for (side, bricks, most) in [(64, 1, 15), (14, 8, 36)] {
        with_bricks(side, |drawn, calls| {
            // A function is uploaded with the first.
            drawn.picture();
            let names = ["vkCmdDispatchIndirect", "vkCmdPipelineBarrier2"];
            let before = names.map(calls);
            drawn.picture();
            let [drawn, barriers] = [0, 1].map(|k| calls(names[k]) - before[k]);
            assert_eq!(drawn, bricks);
            assert!(barriers <= most, "{barriers} barriers of {bricks} bricks");
        });
    }
}
