//! Gradients: the mean angle between normals as the device makes them and those of the signal of Marschner and Lobb.
//!
//! A white surface in red light from x, green from y and blue from z has the colour (|n_x|, |n_y|, |n_z|); three more
//! lights between the axes tell which of them have the same sign. Light on both sides does not tell the sign of all
//! three, which is that of the CPU's CPU reference.

use super::marschner_lobb::{camera, heights, signal, slab, world_from_voxel};
use glam::{DVec3, dvec3};
use std::error::Error;
use stratavox::gpu::{DeviceChoice, Headless, Options};
use stratavox::offscreen::Renderer;
use stratavox::picture::ColorSpace;
use stratavox::scene::{Beside, Scene};
use stratavox::technique::gradient::gradient_of;
use stratavox::technique::gradient_taps::weighted_gradient;
use stratavox::technique::{Filter, GradientFilter, GradientSource, Light, Settings, Shading};
use stratavox::transfer::{ColorPoint, Interpolation, OpacityPoint, TransferFunction};
use stratavox::volume::field::{Field, MarschnerLobb};
use stratavox::volume::kernel::convolved;
use stratavox::volume::sample::{linear, nearest};
use stratavox::volume::{Coefficients, Volume};

/// Words of both filters, and the mean angle in degrees that an independent program found.
#[allow(dead_code, reason = "a test measures some of them")]
const ROWS: [(&str, Filter, &str, GradientFilter, &str); 10] = {
    use {Filter as F, GradientFilter as G};
    [
        ("linear", F::Linear, "central", G::Central, "29.3"),
        ("linear", F::Linear, "sobel", G::Sobel, ""),
        ("linear", F::Linear, "cubic", G::Cubic, "11.1"),
        ("cubic", F::Cubic, "linear", G::Linear, "29.3"),
        ("cubic", F::Cubic, "central", G::Central, ""),
        ("quadratic", F::Quadratic, "analytic", G::Analytic, ""),
        ("cubic", F::Cubic, "analytic", G::Analytic, "11.1"),
        ("catmull-rom", F::CatmullRom, "analytic", G::Analytic, ""),
        (
            "quadratic-smooth",
            F::QuadraticSmooth,
            "analytic",
            G::Analytic,
            "",
        ),
        ("cubic-smooth", F::CubicSmooth, "analytic", G::Analytic, ""),
    ]
};

/// Slabs, and pixels a side: with 60 a side they would be in step with the signal, and the mean off by a fifth.
pub const POINTS: [u32; 2] = [12, 100];

#[allow(dead_code, reason = "a test does not print")]
pub fn print() -> Result<(), Box<dyn Error>> {
    let signal = signal();
    let device = Headless::new(&DeviceChoice::Default, &Options::default())?;
    println!("{}\n", device.gpu().identity().name);
    println!("| filter | gradient filter | mean angle | known | by fetches |");
    println!("|---|---|---|---|---|");
    let mut renderer = Renderer::new(device, &signal)?;
    for (filter_word, filter, word, gradient_filter, known) in ROWS {
        let mut measured = |conformance| {
            let settings = Settings {
                filter,
                gradient_filter,
                conformance,
                ..Settings::default()
            };
            mean_angle_degrees(&mut renderer, &signal, &settings, POINTS)
        };
        let (fast, exact) = (measured(false)?, measured(true)?);
        println!("| {filter_word} | {word} | {fast:.2} | {known} | {exact:.2} |");
    }
    Ok(())
}

/// Over so many slabs, in pictures of so many pixels a side.
pub fn mean_angle_degrees(
    renderer: &mut Renderer,
    signal: &Volume,
    settings: &Settings,
    [slabs, pixels]: [u32; 2],
) -> Result<f64, Box<dyn Error>> {
    let field = MarschnerLobb::default();
    let reference = Reference::new(signal, settings);
    let (mut sum, mut count) = (0.0, 0);
    for z in heights(slabs) {
        let (crop, points) = slab(z, pixels);
        let mut seen = |lights| cosines(renderer, signal, settings, crop, pixels, lights);
        let [x, y, z] = DVec3::AXES;
        let (along, between) = (seen([x, y, z])?, seen([x + y, y + z, z + x])?);
        for ((point, along), between) in points.into_iter().zip(along).zip(between) {
            let normal = reference.signed(point, axis_free(along, between));
            sum += normal.angle_between(slope(&field, point));
            count += 1;
        }
    }
    Ok((sum / f64::from(count)).to_degrees())
}

/// |n.l| of three lights in each pixel.
fn cosines(
    renderer: &mut Renderer,
    signal: &Volume,
    settings: &Settings,
    crop: [DVec3; 2],
    pixels: u32,
    lights: [DVec3; 3],
) -> Result<Vec<DVec3>, Box<dyn Error>> {
    let light = |(towards, srgb)| Light::of_world(towards, srgb);
    let colors = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let shading = Shading {
        ambient: 0.0,
        diffuse: 1.0,
        specular: 0.0,
        lights: lights.into_iter().zip(colors).map(light).collect(),
        ..Shading::default()
    };
    let settings = Settings {
        shading: Some(shading),
        color_space: ColorSpace::Display,
        crop: Some(crop),
        ..settings.clone()
    };
    let white = TransferFunction {
        color: vec![ColorPoint {
            value: 0.0,
            srgb: [1.0; 3],
        }],
        opacity: vec![OpacityPoint {
            value: 0.0,
            opacity: 0.9,
        }],
        reference_length: None,
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: None,
    };
    let scene = Scene {
        volume: signal,
        transfer: Some(&white),
        beside: Beside::Nothing,
        camera: &camera(),
        extent_pixels: [pixels; 2],
        settings: &settings,
    };
    let drawn = renderer.render(&scene, &[])?.picture;
    let color = |pixel: &[f32; 4]| {
        let [r, g, b, alpha] = pixel.map(f64::from);
        dvec3(r, g, b) / alpha
    };
    Ok(drawn.pixels.iter().map(color).collect())
}

/// The normal up to its sign from |n_x|, |n_y|, |n_z| and |n_x + n_y|, |n_y + n_z|, |n_z + n_x| over sqrt 2.
fn axis_free(along: DVec3, between: DVec3) -> DVec3 {
    let error = |n: &DVec3| {
        let sums = dvec3(n.x + n.y, n.y + n.z, n.z + n.x) * std::f64::consts::FRAC_1_SQRT_2;
        (sums.abs() - between).length()
    };
    let signs = [
        DVec3::ONE,
        dvec3(-1., 1., 1.),
        dvec3(1., -1., 1.),
        dvec3(1., 1., -1.),
    ];
    let normals = signs.map(|sign| sign * along);
    let best = normals
        .into_iter()
        .min_by(|a, b| error(a).total_cmp(&error(b)));
    best.expect("four of them")
}

/// The gradient of the signal, by differences too small to matter.
fn slope(field: &MarschnerLobb, point: DVec3) -> DVec3 {
    const STEP: f64 = 1e-5;
    let along = |axis: DVec3| field.value(point + STEP * axis) - field.value(point - STEP * axis);
    DVec3::from_array(DVec3::AXES.map(along))
}

/// Gradients by the CPU.
struct Reference<'a> {
    settings: &'a Settings,
    frame: stratavox::shaders::Frame,
    signal: &'a Volume,
    values: Option<Coefficients>,
    source: Option<Coefficients>,
}

impl<'a> Reference<'a> {
    fn new(signal: &'a Volume, settings: &'a Settings) -> Self {
        let coefficients = |spline| Coefficients::new(signal, spline, [true; 3]);
        let source = settings.gradient_source().and_then(GradientSource::spline);
        let grid = signal.grid();
        let scene = Scene {
            volume: signal,
            transfer: None,
            beside: Beside::Nothing,
            camera: &camera(),
            extent_pixels: [1; 2],
            settings,
        };
        let frame = scene.view(&grid, [0.0; 2]).on_cpu();
        Self {
            settings,
            frame: frame.expect("parameters").frame,
            signal,
            values: settings.filter.spline().map(coefficients),
            source: source.map(coefficients),
        }
    }

    /// The one of a normal and its opposite that the CPU reference's gradient is nearer to.
    fn signed(&self, point: DVec3, normal: DVec3) -> DVec3 {
        let p = world_from_voxel().inverse().transform_point3(point);
        let values = self
            .values
            .as_ref()
            .map_or(self.signal, Coefficients::volume);
        let source = self
            .source
            .as_ref()
            .map_or(self.signal, Coefficients::volume);
        let gradient: DVec3 = match self.settings.gradient_source() {
            None => gradient_of::<f64>(&self.frame, |step| {
                let p = (p + DVec3::from_array(step.map(f64::from))).to_array();
                match self.settings.filter {
                    Filter::Nearest => nearest(values, p),
                    Filter::Linear => linear(values, p),
                    filter => convolved(values, filter.kernel()?, p),
                }
            }),
            Some(_) => {
                let operator = self.settings.gradient_operator();
                weighted_gradient::<f64>(&self.frame, source, operator, p.to_array())
            }
        }
        .into();
        normal * gradient.dot(normal).signum()
    }
}
