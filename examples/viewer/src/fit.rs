//! The eye fitted to what is visible, under `--look auto`, as `stratavox render` fits its camera.
//!
//! The small frames are drawn on the device of the window, by a renderer of its own that submits and waits: it happens
//! once, and again when a hand asks for the first view.

use crate::error::Error;
use crate::eye::Eye;
use crate::view::View;
use crate::words::Layer;
use stratavox::camera::{Camera, Orbit};
use stratavox::gpu::{DeviceChoice, Headless, Options, Validation, ValidationMode};
use stratavox::look::{SHARE, SIDES, best_side, corners, fit_to_visible, frames_the_box};
use stratavox::offscreen::Renderer;
use stratavox::picture::Picture;
use stratavox::scene::{Beside, Scene};

/// The device that draws small frames.
#[derive(Clone, Debug)]
pub struct Small {
    /// The name of the window's device.
    pub device: String,
    pub layer: Option<Layer>,
}

/// Fits the eye of `view` for a picture of this size; gives how many messages the validation layer had.
pub fn fit(view: &mut View, extent: [u32; 2], small: &Small) -> Result<usize, Error> {
    let (look, volume) = (&view.look, &*view.subject.voxels);
    let settings = look.settings();
    let corners = corners(&volume.grid(), None);
    let boxed = |eye: &Eye| {
        let mut eye = eye.clone();
        eye.zoom = 1.0;
        let camera = eye.camera(extent);
        camera.map(|camera| camera.fitted_to_points(&corners, extent, SHARE))
    };
    let options = Options {
        validation: match small.layer {
            None => Validation::Off,
            Some(Layer::Core) => Validation::On(ValidationMode::Core),
            Some(Layer::Sync) => Validation::On(ValidationMode::Synchronization),
        },
        ..Options::default()
    };
    let device = Headless::new(&DeviceChoice::Name(small.device.clone()), &options)?;
    let mut renderer = Renderer::new(device, volume)?;
    let mut draw = |camera: &Camera, extent_pixels: [u32; 2]| -> Result<Picture, Error> {
        let scene = Scene {
            volume,
            transfer: look.function(),
            beside: Beside::Nothing,
            camera,
            extent_pixels,
            settings: &settings,
        };
        Ok(renderer.render(&scene, &[])?.picture)
    };
    let mut eye = view.eye.clone();
    if eye.may_choose_side {
        let turned = |eye: &Eye, [azimuth_degrees, elevation_degrees]: [f64; 2]| {
            eye.with_side(Orbit {
                azimuth_degrees,
                elevation_degrees,
                roll_degrees: 0.0,
            })
        };
        let best = best_side(extent, |side, small| {
            draw(&boxed(&turned(&eye, side)).map_err(camera_error)?, small)
        })?;
        eye = turned(&eye, best.unwrap_or(SIDES[0]));
    }
    let mut camera = boxed(&eye).map_err(camera_error)?;
    if !frames_the_box(look.mode, false) {
        fit_to_visible(&mut camera, extent, &mut draw)?;
    }
    eye.take(&camera);
    let heard = renderer.device().take_validation_messages();
    for message in &heard {
        eprintln!("validation: {message:?}");
    }
    view.eye = eye;
    Ok(heard.len())
}

fn camera_error(error: stratavox::camera::Error) -> Error {
    Error::Drawing(error.into())
}
