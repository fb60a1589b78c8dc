//! A renderer for a volume, on a Vulkan device or on the CPU alone: the one place of the program that makes one.

use super::{Error, flags::Classification};
use crate::{
    camera::Camera,
    offscreen,
    picture::{LayerKind, Picture},
    scene::Scene,
    technique::Settings,
    volume::Volume,
};

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
        Err(Error::NotBuilt("drawing with Vulkan".to_owned()))
    }

    /// The picture that this camera sees, in memory when the call returns.
    pub fn draw(&mut self, camera: &Camera) -> Result<Frame, Error> {
        (self.draw)(camera)
    }

    fn reference(job: Job<'a>) -> Self {
        let draw = move |camera: &Camera| {
            let scene = Scene {
                volume: job.volume,
                transfer: match job.classification {
                    Classification::Function(function) => Some(function),
                    Classification::RangeOfPicture => None,
                },
                camera,
                extent_pixels: job.extent_pixels,
                settings: job.settings,
            };
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
