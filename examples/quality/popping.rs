//! Popping: what changes where 2D slicing goes from one stack to another at 45 degrees.
//!
//! ```text
//! J = mean |Ia - Ib| / mean I            both stacks at exactly 45 degrees, in per cent; also the maximum of |Ia - Ib|
//! K = c(switching frame) / median of c over its 12 neighbours,   half a degree apart
//! c = mean |(I' - I) - (R' - R)|         the change of a frame less that of a reference, 8 samples a voxel
//! ```
//!
//! The published numbers are of a 2D analogue with one switching axis, 128 wide; here are the same scenes in 3D, 64
//! wide, seen 12 degrees from above, so that no mirror symmetry hides a jump.

use super::studio::{Studio, transfer_of, volume_of};
use glam::{DVec3, dvec3};
use std::error::Error;
use stratavox::camera::{Camera, Projection};
use stratavox::picture::ColorSpace;
use stratavox::technique::preclassified::preclassified;
use stratavox::technique::splat::{Sheets, Splat};
use stratavox::technique::{Intermediate, Settings, Technique};
use stratavox::transfer::TransferFunction;
use stratavox::volume::Volume;

const N: u32 = 64;
const CENTER: f64 = 32.0;
pub const EXTENT: [u32; 2] = [96, 96];
const STEP_DEGREES: f64 = 0.5;

pub struct Scene {
    pub name: &'static str,
    pub volume: Volume,
    pub transfer: TransferFunction,
    /// J by the 2D analogue: one sample a voxel, one slice more, 8 a voxel, pre-integrated, view-aligned.
    published: [f64; 5],
}

pub fn print() -> Result<(), Box<dyn Error>> {
    let scenes = scenes()?;
    println!(
        "\n### Popping: J in per cent of the mean (largest change of a pixel), 2D analogue -> here\n"
    );
    println!(
        "| scene | 1 a voxel | 2 a voxel | 8 a voxel | pre-integrated, 1 a voxel | smooth, pre-integrated | shear-warp | shear-warp, pre-integrated | the same, 2 rays a voxel | view-aligned over .2 degrees |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    for scene in &scenes {
        let mut studio = Studio::new(&scene.volume, scene.transfer.clone(), EXTENT)?;
        let [one, two, eight, slabs, aligned] = scene.published;
        // The slope of rays to the axis of a stack: planes are counted by it.
        let slope = 0.5f64.sqrt() * tilt().cos();
        let of_planes = |planes: f64| (planes - 0.1) * slope;
        let columns = [
            (Some(one), stack(false, None)),
            (Some(two), stack(false, Some(of_planes(2.0)))),
            (Some(eight), stack(false, Some(of_planes(8.0)))),
            (Some(slabs), stack(true, None)),
            (None, stack(true, Some(of_planes(2.0)))),
            (None, warp(false, 1.0)),
            (None, warp(true, 1.0)),
            (None, warp(true, 2.0)),
        ];
        print!("| {} |", scene.name);
        for (published, settings) in columns {
            let [a, b] = of_both_stacks(&mut studio, &settings)?;
            print_jump(published, &a, &b);
        }
        let planes = || Settings {
            technique: Technique::Slices3d,
            ..Settings::default()
        };
        let a = studio.picture(&camera(44.9), planes())?;
        let b = studio.picture(&camera(45.1), planes())?;
        print_jump(Some(aligned), &a, &b);
        println!();
    }
    println!("\n### Popping: K\n");
    println!(
        "| scene | classic | classic, pre-integrated | smooth | smooth, pre-integrated | shear-warp | shear-warp, pre-integrated |\n|---|---|---|---|---|---|---|"
    );
    for scene in &scenes {
        let mut studio = Studio::new(&scene.volume, scene.transfer.clone(), EXTENT)?;
        let reference = film(&mut studio, &reference())?;
        print!("| {} |", scene.name);
        for settings in [
            stack(false, None),
            stack(true, None),
            stack(false, Some(1.0)),
            stack(true, Some(1.0)),
            warp(false, 1.0),
            warp(true, 1.0),
        ] {
            let found = film(&mut studio, &settings)?;
            print!(" {:.2} |", excess(&found, &reference));
        }
        println!();
    }
    print_splats(&scenes)
}

/// Sheets along an axis switch as stacks do. Sheets that face the eye turn with it: what is printed of them is by how much
/// the change over .2 degrees across 45 is larger than that beside it.
fn print_splats(scenes: &[Scene]) -> Result<(), Box<dyn Error>> {
    println!("\n### Popping of splats: J, and K\n");
    println!(
        "| scene | axis sheets, J | image sheets, J beyond its neighbours | axis, pre-classified | image, pre-classified | axis, K | image, K | axis, pre-classified, K | image, pre-classified, K |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for scene in scenes {
        let (volume, transfer) = (&scene.volume, &scene.transfer);
        let classified = preclassified(volume, transfer, 1.0, ColorSpace::Display)?;
        let mut studios = [
            Studio::new(volume, transfer.clone(), EXTENT)?,
            Studio::of_classified(&classified, transfer.clone(), EXTENT)?,
        ];
        print!("| {} |", scene.name);
        for studio in &mut studios {
            for jump in splat_jumps(studio)? {
                match jump.is_nan() {
                    true => print!(" nothing is seen |"),
                    false => print!(" {jump:.3} |"),
                }
            }
        }
        let reference = film(&mut studios[0], &reference())?;
        for studio in &mut studios {
            for sheets in [Sheets::Axis, Sheets::Image] {
                let found = film(studio, &splats(sheets))?;
                print!(" {:.2} |", excess(&found, &reference));
            }
        }
        println!();
    }
    Ok(())
}

/// J of sheets along an axis, and what sheets that face the eye have of it beyond their neighbours.
pub fn splat_jumps(studio: &mut Studio) -> Result<[f64; 2], Box<dyn Error>> {
    let of_axis = stack_jump(studio, &splats(Sheets::Axis))?;
    let mut turned = |from: f64| -> Result<f64, Box<dyn Error>> {
        let a = studio.picture(&camera(from), splats(Sheets::Image))?;
        let b = studio.picture(&camera(from + 0.2), splats(Sheets::Image))?;
        Ok(jump(&a, &b))
    };
    let beside = 0.5 * (turned(44.7)? + turned(45.1)?);
    Ok([of_axis, turned(44.9)? - beside])
}

/// J of what is drawn by stacks.
pub fn stack_jump(studio: &mut Studio, settings: &Settings) -> Result<f64, Box<dyn Error>> {
    let [a, b] = of_both_stacks(studio, settings)?;
    Ok(jump(&a, &b))
}

/// At exactly 45 degrees, by the stacks of both axes.
fn of_both_stacks(
    studio: &mut Studio,
    settings: &Settings,
) -> Result<[Vec<[f64; 2]>; 2], Box<dyn Error>> {
    let mut of_stack = |stack| {
        let settings = Settings {
            stack: Some(stack),
            ..settings.clone()
        };
        studio.picture(&camera(45.0), settings)
    };
    Ok([of_stack(0)?, of_stack(1)?])
}

fn splats(sheets: Sheets) -> Settings {
    Settings {
        technique: Technique::Splat,
        splat: Splat {
            sheets,
            ..Splat::default()
        },
        ..Settings::default()
    }
}

/// What K is measured against: rays, 8 samples a voxel.
pub fn reference() -> Settings {
    Settings {
        samples_per_voxel: 8.0,
        ..Settings::default()
    }
}

/// 2D stacks, classic, or smooth with so many samples a voxel.
pub fn stack(preintegrated: bool, smooth_samples: Option<f64>) -> Settings {
    Settings {
        technique: Technique::Slices2d,
        preintegrated,
        smooth: smooth_samples.is_some(),
        samples_per_voxel: smooth_samples.unwrap_or(1.0),
        ..Settings::default()
    }
}

/// Shear-warp with so many rays a voxel along each side of its base plane.
pub fn warp(preintegrated: bool, rays_per_voxel: f64) -> Settings {
    Settings {
        technique: Technique::ShearWarp,
        preintegrated,
        intermediate: Intermediate::PerVoxel(rays_per_voxel),
        ..Settings::default()
    }
}

fn tilt() -> f64 {
    12f64.to_radians()
}

/// The eye, so many degrees from the first axis towards the second.
fn camera(degrees: f64) -> Camera {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let center = DVec3::splat(CENTER);
    let direction = dvec3(cos * tilt().cos(), sin * tilt().cos(), -tilt().sin());
    Camera {
        eye: center - 200.0 * direction,
        target: center,
        up: DVec3::Z,
        projection: Projection::Orthographic { view_height: 76.0 },
        zoom: 1.0,
    }
}

/// J of two pictures.
fn jump(a: &[[f64; 2]], b: &[[f64; 2]]) -> f64 {
    let mean = a.iter().map(|pixel| pixel[0]).sum::<f64>();
    let changes = a.iter().zip(b).map(|(a, b)| (a[0] - b[0]).abs());
    100.0 * changes.sum::<f64>() / mean
}

fn print_jump(published: Option<f64>, a: &[[f64; 2]], b: &[[f64; 2]]) {
    let changes = a.iter().zip(b).map(|(a, b)| (a[0] - b[0]).abs());
    let (jump, largest) = (jump(a, b), changes.fold(0.0, f64::max));
    match published {
        Some(published) => print!(" {published} -> {jump:.3} ({largest:.3}) |"),
        None => print!(" {jump:.3} ({largest:.3}) |"),
    }
}

/// Seven degrees and a half to both sides of the switch.
pub fn film(
    studio: &mut Studio,
    settings: &Settings,
) -> Result<Vec<Vec<[f64; 2]>>, Box<dyn Error>> {
    let angles = (0..=14).map(|i| 45.0 + STEP_DEGREES * (f64::from(i) - 7.5));
    angles
        .map(|angle| studio.picture(&camera(angle), settings.clone()))
        .collect()
}

/// K of a film: the switch is in its middle.
pub fn excess(found: &[Vec<[f64; 2]>], reference: &[Vec<[f64; 2]>]) -> f64 {
    let change = |i: usize| {
        let pixels = 0..found[0].len();
        let of_film = |film: &[Vec<[f64; 2]>], p: usize| film[i + 1][p][0] - film[i][p][0];
        pixels
            .map(|p| (of_film(found, p) - of_film(reference, p)).abs())
            .sum::<f64>()
    };
    let switch = found.len() / 2 - 1;
    let mut others: Vec<f64> = (0..found.len() - 1)
        .filter(|&i| i != switch && i.abs_diff(switch) <= 6)
        .map(change)
        .collect();
    others.sort_by(f64::total_cmp);
    let median = 0.5 * (others[others.len() / 2 - 1] + others[others.len() / 2]);
    change(switch) / median
}

pub fn scenes() -> Result<Vec<Scene>, Box<dyn Error>> {
    let cube = |field: &dyn Fn(DVec3) -> f64| volume_of([N; 3], |p| field(p - CENTER));
    let tent = |v: f64, at: f64, half: f64| (1.0 - (v - at).abs() / half).max(0.0);
    let radius = |p: DVec3| (p + dvec3(3.65, -1.55, 0.8)).length();
    let ellipse = |p: DVec3| {
        let across = (p.x + 2.5) * 0.8 + p.y * 0.35;
        dvec3(across, (p.y - 4.5) * 1.5, (p.z - 1.3) * 1.1).length()
    };
    let plate = |p: DVec3| match p.y.floor() as i32 {
        0 => 1.0,
        10 => 0.9,
        _ => 0.0,
    };
    let mut seed = 5u64;
    let mut noise = || {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (seed >> 40) as f64 / 16_777_216.0
    };
    Ok(vec![
        Scene {
            name: "homogeneous",
            volume: cube(&|p| ((25.0 - radius(p)) / 2.0 + 0.5).clamp(0.0, 1.0))?,
            transfer: transfer_of([0.0, 1.0], |v| 0.02 * v, |_| 0.8),
            published: [0.0, 0.0, 0.0, 0.0, 0.018],
        },
        Scene {
            name: "thin shell",
            volume: cube(&radius)?,
            transfer: transfer_of(
                [0.0, 30.0],
                |v| 0.25 * tent(v, 17.5, 1.5) + 0.25 * tent(v, 10.0, 1.5),
                |v| if v > 14.0 { 1.0 } else { 0.3 },
            ),
            published: [1.043, 0.49, 0.04, 0.006, 0.18],
        },
        Scene {
            name: "off-centre ellipse shell",
            volume: cube(&ellipse)?,
            transfer: transfer_of(
                [0.0, 40.0],
                |v| 0.3 * tent(v, 15.0, 1.2),
                |v| 0.3 + 0.7 * (v / 20.0).clamp(0.0, 1.0),
            ),
            published: [5.92, 2.01, 0.09, 0.049, 0.71],
        },
        Scene {
            name: "rings",
            volume: cube(&|p| 0.5 + 0.5 * (0.9 * radius(p)).cos() * (-radius(p) / 60.0).exp())?,
            transfer: transfer_of(
                [0.0, 1.0],
                |v| 0.12 * (3.0 * (v - 0.55)).clamp(0.0, 1.0),
                |v| v,
            ),
            published: [0.581, 0.164, 0.02, 0.32, 0.1],
        },
        Scene {
            name: "one-voxel plate",
            volume: cube(&plate)?,
            transfer: transfer_of([0.0, 1.0], |v| if v > 0.75 { 0.5 } else { 0.0 }, |_| 1.0),
            published: [98.0, 14.5, 9.2, 74.0, 24.0],
        },
        Scene {
            name: "white noise",
            volume: volume_of([N; 3], |_| noise())?,
            transfer: transfer_of([0.0, 1.0], |v| 0.05 * v, |v| v),
            published: [1.7, 0.42, 0.071, 0.99, 1.25],
        },
    ])
}
