//! What tests of pictures share: a device that fails on any validation message, small volumes, and a
//! comparison that cannot pass when it is empty.

#![allow(dead_code, unused_imports, reason = "each test file uses its part")]

mod agree;
mod chord;
mod limits;
pub mod oracle;
pub mod sweep;
mod way;
mod worst;

pub use agree::compare;
pub use chord::Chord;
pub use limits::allowed;
pub use sweep::share;
pub use way::{Device, Matter, Reference, Way};
pub use worst::Worst;

pub use stratavox::conformance::oracle::PictureCase;
pub use stratavox::conformance::tree::{oblique_camera, ramps, waves};

use glam::{DAffine3, DVec3, dvec3};
use std::sync::OnceLock;
use stratavox::camera::{Camera, Projection};
use stratavox::conformance::tree::{PLACEMENTS, Placement, grid};
use stratavox::gpu::{
    Caps, DeviceChoice, Headless, Options, PipelineCache, SharedDevice, Validation,
};
use stratavox::technique::{Lattice, Mode, Settings};
use stratavox::volume::{Grid, Rescale, Volume, Voxels};

const INSTALLED: &str = "a Vulkan device (`make test` installs one)";

/// The one device of the tests' process: drivers compile each of its pipelines once, and not once a test.
static SHARED: OnceLock<SharedDevice> = OnceLock::new();

/// A share in it, without a pipeline cache; dropping it panics on a validation message.
pub fn device() -> Headless {
    device_with(Caps::UNLIMITED)
}

/// The same with stricter limits.
pub fn device_with(caps: Caps) -> Headless {
    let make = || SharedDevice::new(&DeviceChoice::Default, Validation::FromEnvironment, 1);
    let shared = SHARED.get_or_init(|| make().expect(INSTALLED));
    shared.headless(0, &options(caps)).expect(INSTALLED)
}

/// A device that has no pipelines yet.
pub fn new_device() -> Headless {
    Headless::new(&DeviceChoice::Default, &options(Caps::UNLIMITED)).expect(INSTALLED)
}

fn options(caps: Caps) -> Options {
    Options {
        caps: allowed(caps),
        pipeline_cache: PipelineCache::Off,
        ..Options::default()
    }
}

/// A grid that is neither axis-aligned nor orthogonal nor isotropic, far from the origin.
pub fn sheared_affine() -> DAffine3 {
    grid().world_from_voxel
}

/// A volume of `dims` voxels of a field over voxel space, sampled at voxel centres.
pub fn volume_of(dims: [u32; 3], affine: DAffine3, field: impl Fn(DVec3) -> f64) -> Volume {
    let [nx, ny, nz] = dims;
    let at = |x: u32, y: u32, z: u32| field(dvec3(x.into(), y.into(), z.into()) + 0.5) as f32;
    let voxels = (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| (x, y, z))));
    let values: Vec<f32> = voxels.map(|(x, y, z)| at(x, y, z)).collect();
    Volume::from_voxels(dims, affine, Voxels::F32(values), Rescale::default(), None)
        .expect("a right volume")
}

/// Both projections, framing about the same.
pub fn projections(grid: &Grid) -> [Projection; 2] {
    let size = (grid.world_from_voxel.matrix3 * grid.far_corner()).length();
    [
        Projection::Orthographic {
            view_height: 0.9 * size,
        },
        Projection::Perspective { fov_degrees: 36.0 },
    ]
}

/// Every place where samples can lie, and both orders of blending, but for the main axes of rays, which have tests of their
/// own: `exact/main_axis.rs`.
pub fn placements() -> Vec<Settings> {
    let settings = |placement: Placement| Settings {
        technique: placement.technique,
        lattice: placement.lattice,
        order: placement.order,
        conformance: true,
        ..Settings::default()
    };
    let along_axes = |placement: &Placement| placement.lattice == Lattice::Bresenham;
    let all = PLACEMENTS.into_iter();
    all.filter(|placement| !along_axes(placement))
        .map(settings)
        .collect()
}

/// Each placement in both projections, seen from where no axis is: all of `grid` in the picture.
pub fn oblique_shots(grid: Grid, mode: Mode) -> Vec<PictureCase> {
    let views = projections(&grid).map(|projection| oblique_camera(&grid, projection));
    shots(grid, mode, &views)
}

/// Each placement along the last axis, every pixel through the centre of a column of voxels: so long as
/// dims[2] is even, every sample of every placement is a voxel centre.
pub fn straight_shots(grid: Grid, mode: Mode) -> Vec<PictureCase> {
    let [nx, ny, nz] = grid.dims.map(f64::from);
    assert_eq!(
        grid.world_from_voxel,
        DAffine3::IDENTITY,
        "voxels of side 1 at the origin"
    );
    let center = grid.center();
    let camera = Camera {
        eye: center - dvec3(0.0, 0.0, nz),
        target: center,
        up: DVec3::Y,
        projection: Projection::Orthographic { view_height: ny },
        zoom: 1.0,
    };
    let extent = [nx as u32, ny as u32];
    let shots = shots(grid, mode, &[camera]).into_iter();
    shots.map(|shot| PictureCase { extent, ..shot }).collect()
}

fn shots(grid: Grid, mode: Mode, cameras: &[Camera]) -> Vec<PictureCase> {
    let all = cameras.iter().flat_map(|&camera| {
        placements().into_iter().map(move |settings| PictureCase {
            grid,
            camera,
            extent: [40, 36],
            settings: Settings { mode, ..settings },
        })
    });
    all.collect()
}

/// The middle of the grid: more than half a voxel is cut off all around, so that trilinear interpolation of a
/// linear field is the field itself.
pub fn inner_box(grid: &Grid) -> [DVec3; 2] {
    [DVec3::splat(0.625), grid.far_corner() - 0.625]
}

/// How far two lists of numbers are apart. Says nothing until asked.
#[must_use = "call `at_most`: a comparison alone checks nothing"]
pub struct Comparison {
    worst: f32,
    worst_index: usize,
    count: usize,
}

impl Comparison {
    /// NaN equals NaN; else a NaN is infinitely far away.
    pub fn of(wanted: &[f32], found: &[f32]) -> Self {
        assert_eq!(wanted.len(), found.len(), "pictures of different size");
        let mut comparison = Self {
            worst: 0.0,
            worst_index: 0,
            count: wanted.len(),
        };
        for (i, (wanted, found)) in wanted.iter().zip(found).enumerate() {
            let both_nan = wanted.is_nan() && found.is_nan();
            let error = if both_nan || wanted == found {
                0.0
            } else {
                (wanted - found).abs()
            };
            let error = if error.is_nan() { f32::INFINITY } else { error };
            if error > comparison.worst {
                comparison.worst = error;
                comparison.worst_index = i;
            }
        }
        comparison
    }

    /// The largest difference.
    pub fn worst(&self) -> f32 {
        self.worst
    }

    #[track_caller]
    pub fn at_most(self, limit: f32, what: &str) {
        assert!(self.count > 0, "{what}: nothing was compared");
        assert!(
            self.worst <= limit,
            "{what}: off by {} at number {}, allowed {limit}",
            self.worst,
            self.worst_index
        );
    }
}
