//! What is stored comes out: every code of every integer type, every finite half, and the corners of f32,
//! by the layer `value` of a nearest MIP, in every technique.
//!
//! A volume of one slice, seen along that axis, each voxel in a pixel of its own.

use crate::shared::{device, ramps};
use glam::{DAffine3, DVec3, dvec3};
use half::f16;
use stratavox::camera::{Camera, Projection};
use stratavox::offscreen::{Renderer, reference};
use stratavox::picture::LayerKind;
use stratavox::scene::Scene;
use stratavox::technique::{Filter, Lattice, Mode, Settings, Technique};
use stratavox::volume::{Rescale, Volume, Voxels};

/// Along x, y or z: a picture of the slice, and the voxels in the order of its pixels.
struct Sheet {
    volume: Volume,
    camera: Camera,
    extent: [u32; 2],
}

/// `width` numbers a row, lying across `axis`.
fn sheet(voxels: Voxels, rescale: Rescale, fill: Option<f64>, width: u32, axis: usize) -> Sheet {
    let height = voxels.len() as u32 / width;
    // x fastest: whichever axis has one voxel, the numbers run across first and down second.
    let mut dims = [1; 3];
    let [across, down] = [[1, 2], [0, 2], [0, 1]][axis];
    (dims[across], dims[down]) = (width, height);
    let volume = Volume::from_voxels(dims, DAffine3::IDENTITY, voxels, rescale, fill).unwrap();
    let center = volume.grid().center();
    // Up is against the second axis, so that it runs down; right is then along the first or against it.
    let forward = DVec3::AXES[axis];
    let up = -DVec3::AXES[down];
    let forward = if forward.cross(up) == DVec3::AXES[across] {
        forward
    } else {
        -forward
    };
    let camera = Camera {
        eye: center - 4.0 * forward,
        target: center,
        up,
        projection: Projection::Orthographic {
            view_height: height.into(),
        },
        zoom: 1.0,
    };
    Sheet {
        volume,
        camera,
        extent: [width, height],
    }
}

const PLACEMENTS: [(Technique, Lattice); 4] = [
    (Technique::Raycast, Lattice::Ray),
    (Technique::Raycast, Lattice::Planes),
    (Technique::Slices3d, Lattice::Planes),
    (Technique::Slices2d, Lattice::Planes),
];

/// Every pixel, in every technique, as MIP and as MinIP, with and without conformance, on the device and on
/// the CPU, shows what `is_right` accepts. The plane in the middle of one voxel is k = -1/2: the planes need
/// an even number of them.
fn check(what: &str, sheet: &Sheet, is_right: impl Fn(usize, f32) -> bool) {
    let transfer = ramps();
    let mut renderer = Renderer::new(device(), &sheet.volume).unwrap();
    for (technique, lattice) in PLACEMENTS {
        for mode in [Mode::Mip, Mode::Minip] {
            for conformance in [true, false] {
                let settings = Settings {
                    technique,
                    lattice,
                    mode,
                    filter: Filter::Nearest,
                    samples_per_voxel: 2.0,
                    conformance,
                    ..Settings::default()
                };
                let scene = Scene {
                    beside: Default::default(),
                    volume: &sheet.volume,
                    transfer: Some(&transfer),
                    camera: &sheet.camera,
                    extent_pixels: sheet.extent,
                    settings: &settings,
                };
                let rendered = renderer.render(&scene, &[LayerKind::Value]).unwrap();
                let mut pictures = vec![("device", rendered.picture)];
                if conformance {
                    pictures.push(("reference", reference::render::<f32>(&scene).unwrap()));
                }
                for (way, picture) in pictures {
                    let layer = picture.layers.iter().find(|l| l.kind == LayerKind::Value);
                    let found = &layer.expect("the layer value").values;
                    assert_eq!(found.len(), sheet.volume.voxels.len());
                    let wrong = (0..found.len()).find(|&i| !is_right(i, found[i]));
                    assert!(
                        wrong.is_none(),
                        "{what}, {technique:?} {lattice:?} {mode:?} conformance {conformance}, {way}: \
                         voxel {wrong:?}, stored {}, shows {:e}",
                        sheet.volume.voxels.stored(wrong.unwrap()),
                        found[wrong.unwrap()]
                    );
                }
            }
        }
    }
}

/// All of `voxels` exactly, across one axis or the other, plain and with slopes and intercepts that f32 knows exactly.
fn check_codes(what: &str, width: u32, voxels: &Voxels) {
    let rescales = [(1.0, 0.0), (1.0, -1024.0), (2.5, -1000.25), (-0.5, 3.0)];
    for (i, (slope, intercept)) in rescales.into_iter().enumerate() {
        let axis = i % 3;
        let rescale = Rescale { slope, intercept };
        let sheet = sheet(voxels.clone(), rescale, None, width, axis);
        check(
            &format!("{what} {rescale:?} axis {axis}"),
            &sheet,
            |i, found| f64::from(found) == f64::from(voxels.stored(i)) * slope + intercept,
        );
    }
}

#[test]
fn all_codes_of_u16_come_out_exactly() {
    check_codes("u16", 256, &Voxels::U16((0..=u16::MAX).collect()));
}

#[test]
fn all_codes_of_i16_come_out_exactly() {
    check_codes("i16", 256, &Voxels::I16((i16::MIN..=i16::MAX).collect()));
}

#[test]
fn all_codes_of_u8_and_i8_come_out_exactly() {
    check_codes("u8", 16, &Voxels::U8((0..=u8::MAX).collect()));
    check_codes("i8", 16, &Voxels::I8((i8::MIN..=i8::MAX).collect()));
}

#[test]
fn all_finite_halves_come_out_exactly() {
    let finite = (0..=u16::MAX).map(f16::from_bits).filter(|x| x.is_finite());
    let halves: Vec<f16> = finite.collect();
    assert_eq!(halves.len(), 2 * 31 * 1024);
    let voxels = Voxels::F16(halves);
    for axis in 0..3 {
        let sheet = sheet(voxels.clone(), Rescale::default(), None, 248, axis);
        check("f16", &sheet, |i, found| found == voxels.stored(i));
    }
}

#[test]
fn the_corners_of_f32_come_out_exactly() {
    let corners = [
        0.0,
        1.0,
        1.0 + f32::EPSILON,
        1.0 - f32::EPSILON / 2.0,
        f32::MIN_POSITIVE,
        f32::MAX,
        16_777_215.0,
        16_777_217.0,
        0.1,
        1e-30,
        1e30,
        std::f32::consts::PI,
    ];
    let voxels = Voxels::F32(corners.iter().flat_map(|&x| [x, -x]).collect());
    for axis in 0..3 {
        let sheet = sheet(voxels.clone(), Rescale::default(), None, 6, axis);
        check("f32", &sheet, |i, found| found == voxels.stored(i));
    }
}

#[test]
fn a_subnormal_f32_comes_out_as_itself_or_as_zero() {
    // Vulkan lets a device take subnormal numbers for zero.
    let smallest = f32::from_bits(1);
    let voxels = Voxels::F32(vec![smallest, -smallest, f32::MIN_POSITIVE / 2.0, -1e-40]);
    let sheet = sheet(voxels.clone(), Rescale::default(), None, 2, 2);
    check("subnormal", &sheet, |i, found| {
        found == voxels.stored(i) || found == 0.0
    });
}

#[test]
fn holes_never_win() {
    // The fill is the largest, then the smallest number there is; a column of nothing else stays empty.
    for fill in [i16::MAX, i16::MIN] {
        let codes: Vec<i16> = (0..64)
            .map(|i| if i % 3 == 0 { fill } else { i - 30 })
            .collect();
        for axis in 0..3 {
            let sheet = sheet(
                Voxels::I16(codes.clone()),
                Rescale::default(),
                Some(f64::from(fill)),
                8,
                axis,
            );
            check("holes", &sheet, |i, found| {
                if i % 3 == 0 {
                    found.is_nan()
                } else {
                    found == f32::from(codes[i])
                }
            });
        }
    }
}

#[test]
fn holes_never_win_along_a_ray() {
    // Along the ray lie holes and values: the extremes are those of the values.
    let fill = 255u8;
    let code = |x: u32, y: u32, z: u32| match (x + y + z) % 4 {
        0 => fill,
        _ => (37 * x + 11 * y + 53 * z) as u8 % 200,
    };
    let dims = [8u32, 6, 10];
    let voxels: Vec<u8> = (0..dims[2])
        .flat_map(|z| (0..dims[1]).flat_map(move |y| (0..dims[0]).map(move |x| code(x, y, z))))
        .collect();
    let volume = Volume::from_voxels(
        dims,
        DAffine3::IDENTITY,
        Voxels::U8(voxels),
        Rescale::default(),
        Some(fill.into()),
    )
    .unwrap();
    let center = volume.grid().center();
    let camera = Camera {
        eye: center + dvec3(0.0, 0.0, 20.0),
        target: center,
        up: DVec3::Y,
        projection: Projection::Orthographic { view_height: 6.0 },
        zoom: 1.0,
    };
    let mut renderer = Renderer::new(device(), &volume).unwrap();
    for (technique, lattice) in PLACEMENTS {
        for mode in [Mode::Mip, Mode::Minip] {
            let settings = Settings {
                technique,
                lattice,
                mode,
                filter: Filter::Nearest,
                conformance: true,
                ..Settings::default()
            };
            let scene = Scene {
                beside: Default::default(),
                volume: &volume,
                transfer: None,
                camera: &camera,
                extent_pixels: [8, 6],
                settings: &settings,
            };
            let picture = renderer
                .render(&scene, &[LayerKind::Value])
                .unwrap()
                .picture;
            for y in 0..6 {
                for x in 0..8 {
                    let column = (0..dims[2])
                        .map(|z| code(x, 5 - y, z))
                        .filter(|&c| c != fill);
                    let wanted = match mode {
                        Mode::Mip => column.max(),
                        _ => column.min(),
                    };
                    let found = picture.layers[0].values[(y * 8 + x) as usize];
                    assert_eq!(
                        found,
                        f32::from(wanted.unwrap()),
                        "{technique:?} {lattice:?} {mode:?} at {x}, {y}"
                    );
                }
            }
        }
    }
}
