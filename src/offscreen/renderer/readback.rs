//! What a technique leaves beside the picture: the range of its values, and layers.

use super::Renderer;
use super::gather::Pass;
use crate::gpu::Use;
use crate::offscreen::Error;
use crate::offscreen::position::{labels, positions};
use crate::offscreen::reference::normals;
use crate::picture::{Layer, LayerKind};
use crate::resolve::reference::projected_value;
use crate::scene::Scene;
use crate::technique::gather::{LAYERS, PICTURE};
use crate::technique::{InPixel, Mode, Settings};
use crate::transfer::{Classified, TransferFunction, Window};

impl Renderer<'_> {
    /// The default window of a projecting mode without a transfer function: the range of this picture.
    pub(super) fn grey_of_picture(&mut self, scene: &Scene) -> Result<TransferFunction, Error> {
        let found = self.read_gathered(PICTURE)?;
        let values = found
            .iter()
            .filter_map(|&left| projected_value(scene.settings.mode, left));
        let [low, high] = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| {
            [low.min(v.into()), high.max(v.into())]
        });
        Ok(Window::of_range([low, high]).grey(Classified::Projection))
    }

    /// The pixels of an image of the canvas.
    fn read_gathered(&mut self, number: usize) -> Result<Vec<[f32; 4]>, Error> {
        let targets = self.targets.as_ref().expect("prepared");
        let image = targets.canvas.image(number);
        Ok(targets.read(&mut self.device, image, Use::FragmentSampled)?)
    }

    /// The layers of the rays through pixel centres, which were gathered last.
    pub(super) fn read_layers(
        &mut self,
        scene: &Scene,
        wanted: &[LayerKind],
    ) -> Result<Vec<Layer>, Error> {
        let Settings {
            technique, mode, ..
        } = *scene.settings;
        if wanted.is_empty() {
            return Ok(Vec::new());
        }
        let is_slicer = !technique.casts_rays();
        let left = self.read_gathered(PICTURE)?;
        // (value, depth, transmittance, samples) of each pixel, as far as the technique has them.
        let beside = if is_slicer {
            self.pass(scene, InPixel::CENTER, Pass::Count)?;
            let targets = self.targets.as_ref().expect("prepared");
            let canvas = targets.count.as_ref().expect("just filled");
            let counts = canvas.image(PICTURE);
            let counts = targets.read(&mut self.device, counts, Use::FragmentSampled)?;
            counts
                .into_iter()
                .map(|[n, ..]| [0.0, -1.0, 0.0, n])
                .collect()
        } else if mode.is_projection() {
            left.iter()
                .map(|&[_, _, depth, samples]| [0.0, depth, 0.0, samples])
                .collect()
        } else {
            self.read_gathered(LAYERS)?
        };
        let layer = |kind| {
            let number = |(left, beside): (&[f32; 4], &[f32; 4])| match kind {
                LayerKind::Value if mode == Mode::Iso && beside[1] < 0.0 => f32::NAN,
                LayerKind::Value if mode == Mode::Iso => beside[0],
                LayerKind::Value => projected_value(mode, *left).unwrap_or(f32::NAN),
                LayerKind::Depth | LayerKind::Position | LayerKind::Normal | LayerKind::Label => {
                    match beside[1] {
                        depth if depth < 0.0 => f32::NAN,
                        depth => depth,
                    }
                }
                LayerKind::Transmittance => 1.0 - left[3],
                LayerKind::Samples => beside[3],
                // They are refused before, or come of geometry.
                LayerKind::Noise
                | LayerKind::Albedo
                | LayerKind::Direct
                | LayerKind::Indirect
                | LayerKind::Emission
                | LayerKind::Bounces
                | LayerKind::Annotation
                | LayerKind::Line => f32::NAN,
            };
            let values: Vec<f32> = left.iter().zip(&beside).map(number).collect();
            let values = match kind {
                LayerKind::Position => positions(scene, &values),
                LayerKind::Normal => normals(scene, &values)?,
                LayerKind::Label => labels(scene, &values),
                _ => values,
            };
            Ok(Layer { kind, values })
        };
        wanted.iter().map(|&kind| layer(kind)).collect()
    }
}
