//! The same thing told in other axes is the same picture: the 48 symmetries of the cube, of data with an
//! affine that undoes them, and of data and camera together.

use crate::shared::{
    PictureCase, Worst, device, oblique_camera, projections, ramps, sheared_affine, volume_of,
    waves,
};
use glam::{DAffine3, DMat3, DVec3};
use stratavox::camera::Camera;
use stratavox::offscreen::{Renderer, reference};
use stratavox::picture::Picture;
use stratavox::technique::{Mode, Order, Settings};
use stratavox::volume::{Grid, Volume};

const DIMS: [u32; 3] = [10, 7, 13];

/// New axis i is old axis `axes[i]`, run backwards where `flips[i]`.
#[derive(Clone, Copy, Debug)]
struct Symmetry {
    axes: [usize; 3],
    flips: [bool; 3],
}

fn symmetries() -> impl Iterator<Item = Symmetry> {
    let orders = [
        [0, 1, 2],
        [0, 2, 1],
        [1, 0, 2],
        [1, 2, 0],
        [2, 0, 1],
        [2, 1, 0],
    ];
    orders.into_iter().flat_map(|axes| {
        (0..8).map(move |bits: u32| Symmetry {
            axes,
            flips: [0, 1, 2].map(|i| bits >> i & 1 == 1),
        })
    })
}

impl Symmetry {
    fn dims(&self) -> [u32; 3] {
        self.axes.map(|axis| DIMS[axis])
    }

    /// Old voxel coordinates of new ones.
    fn old_from_new(&self) -> DAffine3 {
        let mut m = DMat3::ZERO;
        let mut offset = DVec3::ZERO;
        for (new, (&old, &flip)) in self.axes.iter().zip(&self.flips).enumerate() {
            m.col_mut(new)[old] = if flip { -1.0 } else { 1.0 };
            offset[old] = if flip { DIMS[old].into() } else { 0.0 };
        }
        DAffine3 {
            matrix3: m,
            translation: offset,
        }
    }

    /// The same voxels in the new order.
    fn volume(&self, world_from_new: DAffine3) -> Volume {
        let old = self.old_from_new();
        volume_of(self.dims(), world_from_new, |p| {
            waves(old.transform_point3(p))
        })
    }
}

/// Each placement in one order.
fn placements(mode: Mode) -> impl Iterator<Item = Settings> {
    let all = crate::shared::placements().into_iter();
    let all = all.filter(|settings| settings.order == Order::BackToFront);
    all.map(move |settings| Settings { mode, ..settings })
}

/// Composite for every symmetry, MIP for every fifth of them.
fn mode_of(i: usize) -> Mode {
    if i % 5 == 4 {
        Mode::Mip
    } else {
        Mode::Composite
    }
}

fn pictures(
    volume: &Volume,
    mode: Mode,
    camera_of: impl Fn(usize) -> Camera,
    references: bool,
) -> Vec<(PictureCase, Picture)> {
    let transfer = ramps();
    let mut renderer = Renderer::new(device(), volume).unwrap();
    let mut pictures = Vec::new();
    for settings in placements(mode) {
        for i in 0..2 {
            let shot = PictureCase {
                grid: volume.grid(),
                camera: camera_of(i),
                extent: [32, 28],
                settings: settings.clone(),
            };
            let scene = shot.scene(volume, Some(&transfer));
            let picture = if references {
                reference::render::<f64>(&scene).unwrap()
            } else {
                renderer.render(&scene, &[]).unwrap().picture
            };
            pictures.push((shot, picture));
        }
    }
    pictures
}

fn compare(what: &str, wanted: &[(PictureCase, Picture)], found: &[(PictureCase, Picture)]) {
    for ((shot, wanted), (_, found)) in wanted.iter().zip(found) {
        let what = format!("{what}, {}", shot.what());
        Worst::between(what, wanted.width, &wanted.pixels, &found.pixels, 1e-5).assert_holds();
    }
}

#[test]
fn a_volume_told_in_other_axes_is_the_same_picture() {
    let grid = Grid {
        dims: DIMS,
        world_from_voxel: sheared_affine(),
    };
    let camera = |i: usize| oblique_camera(&grid, projections(&grid)[i]);
    for references in [false, true] {
        let volume = volume_of(DIMS, sheared_affine(), waves);
        let wanted = |mode| pictures(&volume, mode, camera, references);
        let wanted = [Mode::Composite, Mode::Mip].map(|mode| (mode, wanted(mode)));
        for (i, symmetry) in symmetries().enumerate() {
            let volume = symmetry.volume(sheared_affine() * symmetry.old_from_new());
            let (mode, wanted) = &wanted[usize::from(mode_of(i) == Mode::Mip)];
            let found = pictures(&volume, *mode, camera, references);
            compare(&format!("{symmetry:?}"), wanted, &found);
        }
    }
}

#[test]
fn a_volume_and_a_camera_turned_alike_are_the_same_picture_or_its_mirror_image() {
    let grid = Grid {
        dims: DIMS,
        world_from_voxel: DAffine3::IDENTITY,
    };
    let camera = |i: usize| oblique_camera(&grid, projections(&grid)[i]);
    let volume = volume_of(DIMS, DAffine3::IDENTITY, waves);
    let wanted =
        [Mode::Composite, Mode::Mip].map(|mode| (mode, pictures(&volume, mode, camera, false)));
    for (i, symmetry) in symmetries().enumerate() {
        let new_from_old = symmetry.old_from_new().inverse();
        let turned = |i: usize| {
            let camera = camera(i);
            Camera {
                eye: new_from_old.transform_point3(camera.eye),
                target: new_from_old.transform_point3(camera.target),
                up: new_from_old.transform_vector3(camera.up),
                ..camera
            }
        };
        let volume = symmetry.volume(DAffine3::IDENTITY);
        let (mode, wanted) = &wanted[usize::from(mode_of(i) == Mode::Mip)];
        let mut found = pictures(&volume, *mode, turned, false);
        if new_from_old.matrix3.determinant() < 0.0 {
            // A camera keeps its right hand: what it sees of a mirrored world is mirrored.
            for (_, picture) in &mut found {
                let width = picture.width as usize;
                picture.pixels.chunks_mut(width).for_each(<[_]>::reverse);
            }
        }
        compare(&format!("{symmetry:?}"), wanted, &found);
    }
}
