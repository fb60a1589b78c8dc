//! A renderer for a volume, on a Vulkan device or on the CPU alone: the one place of the program that makes one.

use super::{Error, flags::Classification, timings::ms_since};
use crate::{
    camera::Camera,
    gpu::{DeviceChoice, Headless, Options},
    offscreen,
    picture::{LayerKind, Picture},
    scene::Scene,
    technique::Settings,
    volume::Volume,
};
use std::time::Instant;

/// What stays the same from picture to picture.
#[derive(Clone, Copy, Debug)]
pub struct Job<'a> {
    /// What is drawn.
    pub volume: &'a Volume,
    /// How its values are seen.
    pub classification: &'a Classification,
    /// What is computed.
    pub settings: &'a Settings,
    /// Pixels across and down.
    pub extent_pixels: [u32; 2],
    /// Layers that the picture must have.
    pub layers: &'a [LayerKind],
    /// The word of `--device`.
    pub device: Option<&'a str>,
    /// The camera of the first picture: what it needs is brought to the device at once.
    pub first_camera: &'a Camera,
}

impl<'a> Job<'a> {
    fn scene(&self, camera: &'a Camera) -> Scene<'a> {
        Scene {
            volume: self.volume,
            transfer: match self.classification {
                Classification::Function(function) => Some(function),
                Classification::RangeOfPicture => None,
            },
            camera,
            extent_pixels: self.extent_pixels,
            settings: self.settings,
        }
    }
}

/// A renderer that is ready to draw.
pub struct Renderer<'a> {
    /// The device's name.
    pub device: String,
    /// Its driver and the driver's version.
    pub driver: String,
    /// What bringing the volume to the device took.
    pub upload_ms: f64,
    /// What all other preparation took.
    pub prepare_ms: f64,
    /// Device memory in use.
    pub device_bytes: u64,
    draw: Box<dyn FnMut(&Camera) -> Result<Frame, Error> + 'a>,
}

/// One picture and what it took.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Before the background.
    pub picture: Picture,
    /// By the device's own clock.
    pub gpu_ms: Option<f64>,
}

/// The word of `--device` for the CPU twins.
const REFERENCE: &str = "reference";

impl<'a> Renderer<'a> {
    /// Finds the device, brings the volume there, makes what drawing needs.
    pub fn new(job: Job<'a>) -> Result<Self, Error> {
        if job.device == Some(REFERENCE) {
            return Ok(Self::reference(job));
        }
        Self::vulkan(job)
    }

    /// The picture that this camera sees, in memory when the call returns.
    pub fn draw(&mut self, camera: &Camera) -> Result<Frame, Error> {
        (self.draw)(camera)
    }

    fn vulkan(job: Job<'a>) -> Result<Self, Error> {
        let start = Instant::now();
        let choice = job.device.map(DeviceChoice::from).unwrap_or_default();
        let headless = Headless::new(&choice, &Options::default())?;
        let identity = headless.gpu().identity();
        let device = identity.name.clone();
        let driver = format!("{} {}", identity.driver_name, identity.driver_info);
        let mut renderer = offscreen::Renderer::new(headless, job.volume)?;
        let prepare_ms = ms_since(start);
        let start = Instant::now();
        renderer.upload(&job.scene(job.first_camera))?;
        let upload_ms = ms_since(start);
        let device_bytes = renderer.device().gpu().device_bytes();
        let draw = move |camera: &Camera| {
            let rendered = renderer.render(&job.scene(camera), job.layers)?;
            Ok(Frame {
                picture: rendered.picture,
                gpu_ms: rendered.gpu_ms,
            })
        };
        Ok(Self {
            device,
            driver,
            upload_ms,
            prepare_ms,
            device_bytes,
            draw: Box::new(draw),
        })
    }

    fn reference(job: Job<'a>) -> Self {
        let draw = move |camera: &Camera| {
            let scene = job.scene(camera);
            let mut picture = offscreen::reference::render::<f32>(&scene)
                .map_err(|error| Error::Limit(error.to_string()))?;
            keep_layers(&mut picture, job.layers)?;
            Ok(Frame {
                picture,
                gpu_ms: None,
            })
        };
        Self {
            device: "reference (the CPU, without Vulkan)".to_owned(),
            driver: format!("stratavox {}", env!("CARGO_PKG_VERSION")),
            upload_ms: 0.0,
            prepare_ms: 0.0,
            device_bytes: 0,
            draw: Box::new(draw),
        }
    }
}

/// Leaves the layers that were asked for, in that order.
fn keep_layers(picture: &mut Picture, wanted: &[LayerKind]) -> Result<(), Error> {
    let mut made = std::mem::take(&mut picture.layers);
    for &kind in wanted {
        let at = made.iter().position(|layer| layer.kind == kind);
        let at = at.ok_or_else(|| {
            let name = format!("{kind:?}").to_lowercase();
            Error::NotBuilt(format!("`--aov {name}` with this technique and mode"))
        })?;
        picture.layers.push(made.swap_remove(at));
    }
    Ok(())
}
