//! Shear-warp: what its rays leave out, and into how many bricks a volume is cut, changes no bit of a picture; steep beside
//! the slices and pre-integrated too, where both ends of a slab lie far from its middle.

use crate::shared::{device, device_with, oblique_camera, projections, share};
use crate::skipping_shared::{Numbers, balls, hills, samples_of_same_pictures};
use stratavox::camera::{Camera, Projection};
use stratavox::gpu::Caps;
use stratavox::offscreen::{Error, Renderer};
use stratavox::scene::Scene;
use stratavox::technique::{self, Filter, FilterBy, Intermediate, Mode, Settings, Technique};
use stratavox::volume::Grid;

fn settings(numbers: &mut Numbers) -> Settings {
    let modes = [Mode::Composite, Mode::Composite, Mode::Mip, Mode::Xray];
    let mode = modes[numbers.below(modes.len())];
    let preintegrated = mode == Mode::Composite && numbers.below(2) == 0;
    let filters = [Filter::Linear, Filter::Nearest, Filter::CatmullRom];
    Settings {
        technique: Technique::ShearWarp,
        mode,
        preintegrated,
        filter: filters[numbers.below(if preintegrated { 2 } else { 3 })],
        stack: [None, Some(numbers.below(3))][numbers.below(2)],
        intermediate: Intermediate::PerVoxel([0.7, 1.0, 1.6][numbers.below(3)]),
        samples_per_voxel: [1.0, 2.3][numbers.below(2)],
        // A device's sampler has places in a texture to some bits.
        filter_by: FilterBy::Fetch,
        conformance: numbers.below(3) == 0,
        ..Settings::default()
    }
}

/// Both projections, and from near with rays far off the axis.
fn cameras(grid: &Grid) -> [Camera; 3] {
    let [parallel, perspective] = projections(grid).map(|p| oblique_camera(grid, p));
    let towards = perspective.target - perspective.eye;
    let near = Camera {
        eye: perspective.target - 0.62 * towards,
        projection: Projection::Perspective { fov_degrees: 95.0 },
        ..perspective
    };
    [parallel, perspective, near]
}

/// As many pictures as are not refused: an eye may stand among the slices of a stack.
fn is_refused(error: &Error) -> bool {
    use technique::Error::{EyeAmongSlices, IntermediateTooLarge, SlabsTooLong};
    matches!(
        error,
        Error::Technique(EyeAmongSlices | IntermediateTooLarge { .. } | SlabsTooLong { .. })
    )
}

#[test]
fn what_rays_through_a_base_plane_leave_out_and_bricks_change_no_bit() {
    let small = || Caps {
        max_image_dimension_3d: 19,
        ..Caps::UNLIMITED
    };
    let mut numbers = Numbers(23);
    let (mut pictures, mut of_bricks) = (0, 0);
    let mut sums = [0.0; 2];
    for as_bytes in [true, false] {
        let volume = balls(&mut numbers, as_bytes);
        let cameras = cameras(&volume.grid());
        let mut whole = Renderer::new(device(), &volume).expect("a renderer");
        let mut bricked = Renderer::new(device_with(small()), &volume).expect("a renderer");
        for _ in 0..share(40) {
            let function = hills(&mut numbers, volume.value_range);
            let settings = settings(&mut numbers);
            let scene = Scene {
                volume: &volume,
                transfer: Some(&function),
                beside: Default::default(),
                camera: &cameras[numbers.below(3)],
                extent_pixels: [36, 28],
                settings: &settings,
            };
            let wanted = match whole.render(&scene, &[]) {
                Ok(wanted) => wanted.picture,
                Err(error) => {
                    assert!(is_refused(&error), "{error}");
                    continue;
                }
            };
            let found = samples_of_same_pictures(&mut whole, &scene);
            sums = [sums[0] + found[0], sums[1] + found[1]];
            pictures += 1;
            match bricked.render(&scene, &[]) {
                Ok(found) => {
                    assert!(
                        found.picture.pixels == wanted.pixels,
                        "in bricks: {settings:?}"
                    );
                    of_bricks += 1;
                }
                Err(error) => assert!(is_refused(&error), "{error}"),
            }
        }
    }
    println!("{pictures} pictures, {of_bricks} in bricks, {sums:?} samples");
    assert!(
        pictures > share(50) && of_bricks > share(40),
        "{pictures}, {of_bricks} in bricks"
    );
    assert!(
        sums[0] < 0.9 * sums[1],
        "hardly anything was left out: {sums:?}"
    );
}
