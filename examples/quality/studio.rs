//! What the measures share: small volumes of a formula, and pictures of them as numbers.

use glam::{DAffine3, DVec3, dvec3};
use std::error::Error;
use stratavox::camera::Camera;
use stratavox::gpu::{DeviceChoice, Headless, Options};
use stratavox::offscreen::{Renderer, reference};
use stratavox::picture::{ColorSpace, Picture};
use stratavox::scene::{Beside, Scene};
use stratavox::technique::Settings;
use stratavox::transfer::{ColorPoint, Interpolation, OpacityPoint, TransferFunction};
use stratavox::volume::{Rescale, Volume, Voxels};

/// A volume of `dims` voxels of side 1, whose box begins at the origin, of a field over voxel space.
pub fn volume_of(
    dims: [u32; 3],
    mut field: impl FnMut(DVec3) -> f64,
) -> Result<Volume, Box<dyn Error>> {
    let [nx, ny, nz] = dims;
    let mut values = Vec::new();
    for z in 0..nz {
        for y in 0..ny {
            for x in 0..nx {
                values.push(field(dvec3(x.into(), y.into(), z.into()) + 0.5) as f32);
            }
        }
    }
    let affine = DAffine3::IDENTITY;
    let voxels = Voxels::F32(values);
    Ok(Volume::from_voxels(
        dims,
        affine,
        voxels,
        Rescale::default(),
        None,
    )?)
}

/// Extinction per voxel, and brightness, as functions of the value, in so many points over a range that what lies
/// between two of them does not count.
pub fn transfer_of(
    [low, high]: [f64; 2],
    extinction: impl Fn(f64) -> f64,
    brightness: impl Fn(f64) -> f64,
) -> TransferFunction {
    const POINTS: u32 = 2000;
    let values = || (0..=POINTS).map(|i| low + (high - low) * f64::from(i) / f64::from(POINTS));
    TransferFunction {
        color: values()
            .map(|value| ColorPoint {
                value,
                srgb: [brightness(value).clamp(0.0, 1.0); 3],
            })
            .collect(),
        opacity: values()
            .map(|value| OpacityPoint {
                value,
                opacity: -(-extinction(value)).exp_m1(),
            })
            .collect(),
        reference_length: Some(1.0),
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: None,
    }
}

/// Takes pictures of one volume.
pub struct Studio<'v> {
    renderer: Renderer<'v>,
    volume: &'v Volume,
    /// Green, blue and depth of classified voxels.
    beside: Vec<&'v Volume>,
    transfer: TransferFunction,
    extent_pixels: [u32; 2],
}

impl<'v> Studio<'v> {
    pub fn new(
        volume: &'v Volume,
        transfer: TransferFunction,
        extent_pixels: [u32; 2],
    ) -> Result<Self, Box<dyn Error>> {
        Self::several(&[volume], transfer, extent_pixels)
    }

    /// Of the four volumes of classified voxels.
    pub fn of_classified(
        parts: &'v [Volume; 4],
        transfer: TransferFunction,
        extent_pixels: [u32; 2],
    ) -> Result<Self, Box<dyn Error>> {
        Self::several(&parts.each_ref(), transfer, extent_pixels)
    }

    fn several(
        volumes: &[&'v Volume],
        transfer: TransferFunction,
        extent_pixels: [u32; 2],
    ) -> Result<Self, Box<dyn Error>> {
        let device = Headless::new(&DeviceChoice::Default, &Options::default())?;
        Ok(Self {
            renderer: Renderer::several(device, volumes.to_vec())?,
            volume: volumes[0],
            beside: volumes[1..].to_vec(),
            transfer,
            extent_pixels,
        })
    }

    /// Brightness and opacity of each pixel. Colours are blended as they are, nothing ends early.
    pub fn picture(
        &mut self,
        camera: &Camera,
        settings: Settings,
    ) -> Result<Vec<[f64; 2]>, Box<dyn Error>> {
        let settings = blended_as_they_are(settings);
        let scene = scene(
            self.volume,
            &self.beside,
            &self.transfer,
            camera,
            self.extent_pixels,
            &settings,
        );
        Ok(numbers(&self.renderer.render(&scene, &[])?.picture))
    }

    /// The same by the CPU, in f64.
    pub fn picture_of_reference(
        &self,
        camera: &Camera,
        settings: Settings,
    ) -> Result<Vec<[f64; 2]>, Box<dyn Error>> {
        let settings = blended_as_they_are(settings);
        let scene = scene(
            self.volume,
            &self.beside,
            &self.transfer,
            camera,
            self.extent_pixels,
            &settings,
        );
        Ok(numbers(&reference::render::<f64>(&scene)?))
    }
}

fn blended_as_they_are(settings: Settings) -> Settings {
    Settings {
        color_space: ColorSpace::Display,
        ..settings
    }
}

fn scene<'a>(
    volume: &'a Volume,
    beside: &'a [&'a Volume],
    transfer: &'a TransferFunction,
    camera: &'a Camera,
    extent_pixels: [u32; 2],
    settings: &'a Settings,
) -> Scene<'a> {
    Scene {
        volume,
        transfer: Some(transfer),
        beside: match beside {
            [] => Beside::Nothing,
            _ => Beside::Classified(beside),
        },
        camera,
        extent_pixels,
        settings,
    }
}

fn numbers(picture: &Picture) -> Vec<[f64; 2]> {
    let pixels = picture.pixels.iter();
    pixels
        .map(|&[red, _, _, alpha]| [red.into(), alpha.into()])
        .collect()
}
