//! Wood-grain: how far a thin shell in a distance field is from itself, by steps. The scene is that of the
//! published numbers: radius 30, half width 0.4 voxel, rays at impact 0 to 38; the volume holds the distance at voxel
//! centres, so the reference is a picture of the same volume with 64 samples a voxel, by the CPU in f64.

use super::studio::{Studio, transfer_of, volume_of};
use glam::{DVec3, dvec3};
use std::error::Error;
use stratavox::camera::{Camera, Projection};
use stratavox::technique::{Jitter, Lattice, Settings};
use stratavox::transfer::TransferFunction;
use stratavox::volume::Volume;

const DIMS: [u32; 3] = [44, 4, 92];
const RAYS: u32 = 400;

/// The shell, seen along the cylinder's radius.
pub struct Scene {
    pub volume: Volume,
    pub transfer: TransferFunction,
    pub camera: Camera,
}

pub fn scene() -> Result<Scene, Box<dyn Error>> {
    let axis = dvec3(2.0, 2.0, 46.0);
    let volume = volume_of(DIMS, |p| dvec3(p.x - axis.x, 0.0, p.z - axis.z).length())?;
    let shell = |v: f64| 1.2 * (1.0 - (v - 30.0).abs() / 0.4).max(0.0);
    let target = dvec3(axis.x + 19.0, axis.y, axis.z);
    Ok(Scene {
        volume,
        transfer: transfer_of([28.0, 32.0], shell, |_| 1.0),
        camera: Camera {
            eye: target - 100.0 * DVec3::Z,
            target,
            up: DVec3::Y,
            projection: Projection::Orthographic {
                view_height: 38.0 / f64::from(RAYS),
            },
            zoom: 1.0,
        },
    })
}

impl Scene {
    pub fn studio(&self) -> Result<Studio<'_>, Box<dyn Error>> {
        Studio::new(&self.volume, self.transfer.clone(), [RAYS, 1])
    }

    /// By the CPU, in f64, 64 samples a voxel.
    pub fn reference(&self, studio: &Studio) -> Result<Vec<[f64; 2]>, Box<dyn Error>> {
        let fine = Settings {
            samples_per_voxel: 64.0,
            ..Settings::default()
        };
        studio.picture_of_reference(&self.camera, fine)
    }
}

/// The root of the mean square of what alpha is off.
pub fn rms(found: &[[f64; 2]], reference: &[[f64; 2]]) -> f64 {
    let squares = found
        .iter()
        .zip(reference)
        .map(|(a, b)| (a[1] - b[1]).powi(2));
    (squares.sum::<f64>() / reference.len() as f64).sqrt()
}

/// Rays with so many samples a voxel.
pub fn rays(samples_per_voxel: f64, preintegrated: bool) -> Settings {
    Settings {
        samples_per_voxel,
        preintegrated,
        ..Settings::default()
    }
}

pub fn print() -> Result<(), Box<dyn Error>> {
    let scene = scene()?;
    let mut studio = scene.studio()?;
    let reference = scene.reference(&studio)?;
    let rms = |found: &[[f64; 2]]| rms(found, &reference);
    let mut picture = |settings| studio.picture(&scene.camera, settings);
    println!("\n### Wood-grain: RMS error of alpha\n");
    println!("| way | step in voxels | published | measured |\n|---|---|---|---|");
    let published = [(1.0, ".234"), (2.0, ".021"), (4.0, ".010"), (8.0, ".0023")];
    for (samples, published) in published {
        let found = rms(&picture(rays(samples, false))?);
        println!("| samples | {} | {published} | {found:.5} |", 1.0 / samples);
    }
    for (frames, published) in [(1, ".154"), (4, ""), (16, ""), (64, ".051")] {
        let mut mean = vec![[0.0; 2]; reference.len()];
        for frame in 0..frames {
            let jittered = Settings {
                lattice: Lattice::Jitter,
                jitter: Jitter { seed: 0, frame },
                ..rays(1.0, false)
            };
            for (mean, found) in mean.iter_mut().zip(picture(jittered)?) {
                mean[1] += found[1] / f64::from(frames);
            }
        }
        println!(
            "| samples, jittered, mean of {frames} | 1 | {published} | {:.5} |",
            rms(&mean)
        );
    }
    for (samples, published) in [(0.5, ".0047"), (1.0, ".0011"), (2.0, ".0003")] {
        let found = rms(&picture(rays(samples, true))?);
        println!(
            "| pre-integrated | {} | {published} | {found:.5} |",
            1.0 / samples
        );
    }
    Ok(())
}
