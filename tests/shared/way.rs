//! Ways to compute a picture of matter given by a formula: the CPU references, and the device.

use super::{PictureCase, device, volume_of};
use glam::{DVec3, dvec3};
use std::marker::PhantomData;
use stratavox::offscreen::Renderer;
use stratavox::picture::{ColorSpace, LayerKind, Picture};
use stratavox::real::Real;
use stratavox::resolve::reference::projected_value;
use stratavox::scene::Scene;
use stratavox::shaders::Frame;
use stratavox::technique::reference::Samples;
use stratavox::technique::{AlikeCells, Settings};
use stratavox::transfer::{ColorPoint, Interpolation, OpacityPoint, TransferFunction};

/// A field over voxel space and what its values look like. Colours are blended as they are
/// (`ColorSpace::Display`), so that a linear ramp of values is a linear ramp of light.
pub struct Matter<'a> {
    pub value: &'a (dyn Fn(DVec3) -> f64 + Sync),
    /// Linear in the value over `range`.
    pub color: &'a (dyn Fn(f64) -> [f64; 3] + Sync),
    /// Per world length.
    pub extinction: &'a (dyn Fn(f64) -> f64 + Sync),
    /// Of the values; what lies between is where the device's transfer function has its points.
    pub range: [f64; 2],
}

/// Something that makes a picture.
pub trait Way {
    fn name(&self) -> String;
    /// Premultiplied colour of each pixel.
    fn picture(&self, shot: &PictureCase, matter: &Matter) -> Vec<[f64; 4]>;
    /// What a projecting mode projects; NaN without a sample.
    fn values(&self, shot: &PictureCase, matter: &Matter) -> Vec<f64>;
}

/// The library's own functions a ray, in f32 or f64, on the formula itself.
#[derive(Default)]
pub struct Reference<R>(PhantomData<R>);

impl<R: Real> Reference<R> {
    pub fn new() -> Self {
        Self(PhantomData)
    }

    fn gather(&self, shot: &PictureCase, matter: &Matter) -> Vec<[R; 4]> {
        let (frame, slices) = shot.parameters();
        let formula = Formula {
            shot,
            frame: &frame,
            slices,
            matter,
        };
        let pixel = |[x, y]: [u32; 2]| {
            let pixel = [x, y].map(|n| R::from_f64(f64::from(n) + 0.5));
            let technique = shot.settings.technique;
            technique.pixel(&formula, pixel).accumulation
        };
        shot.pixels().map(pixel).collect()
    }
}

impl<R: Real> Way for Reference<R> {
    fn name(&self) -> String {
        format!("reference {}", std::any::type_name::<R>())
    }

    fn picture(&self, shot: &PictureCase, matter: &Matter) -> Vec<[f64; 4]> {
        let gathered = self.gather(shot, matter);
        gathered.into_iter().map(|p| p.map(R::to_f64)).collect()
    }

    fn values(&self, shot: &PictureCase, matter: &Matter) -> Vec<f64> {
        let value = |left| projected_value(shot.settings.mode, left).map_or(f64::NAN, R::to_f64);
        self.gather(shot, matter).into_iter().map(value).collect()
    }
}

/// The formula in place of a volume.
struct Formula<'a> {
    shot: &'a PictureCase,
    frame: &'a Frame,
    slices: u32,
    matter: &'a Matter<'a>,
}

impl<R: Real> Samples<R> for Formula<'_> {
    fn frame(&self) -> &Frame {
        self.frame
    }

    fn settings(&self) -> &Settings {
        &self.shot.settings
    }

    fn slice_count(&self) -> u32 {
        self.slices
    }

    fn dim(&self, axis: usize) -> u32 {
        self.shot.grid.dims[axis]
    }

    fn value(&self, p: [R; 3]) -> Option<R> {
        let [x, y, z] = p.map(R::to_f64);
        Some(R::from_f64((self.matter.value)(dvec3(x, y, z))))
    }

    fn value_in_slice(&self, _axis: usize, _slice: u32, p: [R; 3]) -> Option<R> {
        self.value(p)
    }

    /// What the formula is at its centre.
    fn voxel(&self, index: [i32; 3]) -> Option<R> {
        self.value(index.map(|i| R::from_f64(f64::from(i) + 0.5)))
    }

    fn material(&self, p: [R; 3], _ray_direction: [R; 3]) -> Option<[R; 4]> {
        self.value(p).map(|value| self.classify(value))
    }

    fn material_in_slice(
        &self,
        _axis: usize,
        _slice: u32,
        p: [R; 3],
        ray_direction: [R; 3],
    ) -> Option<[R; 4]> {
        self.material(p, ray_direction)
    }

    fn classify(&self, value: R) -> [R; 4] {
        let value = value.to_f64();
        let [r, g, b] = (self.matter.color)(value);
        [r, g, b, (self.matter.extinction)(value)].map(R::from_f64)
    }

    fn classify_slab(&self, _ends: [R; 2]) -> [R; 4] {
        panic!("a formula is not pre-integrated")
    }

    fn lit(
        &self,
        material: [R; 4],
        _p: [R; 3],
        _ray_direction: [R; 3],
        _tap: impl Fn([i32; 3]) -> Option<R>,
    ) -> [R; 4] {
        material
    }

    fn alike(&self) -> Option<&AlikeCells> {
        None
    }
}

/// The device, on a volume of the formula at voxel centres. The transfer function has so many opacity points
/// that what lies between them does not count: see [`OPACITY_POINTS`].
pub struct Device;

/// Opacity runs straight between two points where the law of `Matter` curves. With n points over a range in
/// which sigma d0 rises to `s`, opacity 1 - exp(-sigma d0) is off by at most (s/n)^2 / 8: under 3e-8 s^2.
const OPACITY_POINTS: u32 = 2048;

impl Device {
    fn render(&self, shot: &PictureCase, matter: &Matter, layers: &[LayerKind]) -> Picture {
        let volume = volume_of(shot.grid.dims, shot.grid.world_from_voxel, matter.value);
        let transfer = transfer_of(matter);
        let settings = Settings {
            conformance: true,
            color_space: ColorSpace::Display,
            ..shot.settings.clone()
        };
        let scene = Scene {
            beside: Default::default(),
            volume: &volume,
            transfer: Some(&transfer),
            camera: &shot.camera,
            extent_pixels: shot.extent,
            settings: &settings,
        };
        let mut renderer = Renderer::new(device(), &volume).unwrap();
        renderer.render(&scene, layers).unwrap().picture
    }
}

impl Way for Device {
    fn name(&self) -> String {
        "device".into()
    }

    fn picture(&self, shot: &PictureCase, matter: &Matter) -> Vec<[f64; 4]> {
        let picture = self.render(shot, matter, &[]);
        picture.pixels.iter().map(|p| p.map(f64::from)).collect()
    }

    fn values(&self, shot: &PictureCase, matter: &Matter) -> Vec<f64> {
        let picture = self.render(shot, matter, &[LayerKind::Value]);
        let values = &picture.layers[0].values;
        values.iter().copied().map(f64::from).collect()
    }
}

/// Opacities per world length 1.
fn transfer_of(matter: &Matter) -> TransferFunction {
    let [low, high] = matter.range;
    let color = |value| ColorPoint {
        value,
        srgb: (matter.color)(value),
    };
    let opacity = |i: u32| {
        let value = low + (high - low) * f64::from(i) / f64::from(OPACITY_POINTS);
        OpacityPoint {
            value,
            opacity: -(-(matter.extinction)(value)).exp_m1(),
        }
    };
    TransferFunction {
        color: vec![color(low), color(high)],
        opacity: (0..=OPACITY_POINTS).map(opacity).collect(),
        reference_length: Some(1.0),
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: None,
    }
}
