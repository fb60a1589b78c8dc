//! The layers that come of what the CPU references leave for each pixel.

use super::layer_rules::{has_labels, has_normals};
use super::position::{labels, positions};
use super::reference::normals;
use crate::picture::{Layer, LayerKind};
use crate::real::Real;
use crate::resolve::reference::projected_value;
use crate::scene::Scene;
use crate::technique::pathtrace::{images_of, numbers_of};
use crate::technique::reference::Gathered;
use crate::technique::{Error, Mode};
use crate::transfer::{Classified, TransferFunction, Window};

/// The default window of a projecting mode without a transfer function: the range of this picture.
pub(super) fn grey_of_picture<R: Real>(mode: Mode, gathered: &[Gathered<R>]) -> TransferFunction {
    let values = gathered
        .iter()
        .filter_map(|g| projected_value(mode, g.accumulation))
        .map(R::to_f64);
    let range = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| {
        [low.min(v), high.max(v)]
    });
    Window::of_range(range).grey(Classified::Projection)
}

pub(super) fn layers<R: Real>(
    scene: &Scene,
    gathered: &[Gathered<R>],
) -> Result<Vec<Layer>, Error> {
    if scene.settings.technique.traces_paths() {
        return Ok(layers_of_paths(gathered));
    }
    let mode = scene.settings.mode;
    let layer = |kind, number: &dyn Fn(&Gathered<R>) -> f32| Layer {
        kind,
        values: gathered.iter().map(number).collect(),
    };
    let number = |found: Option<R>| found.map_or(f32::NAN, R::to_f32);
    let mut layers = vec![layer(LayerKind::Samples, &|g| g.samples)];
    if mode.is_projection() {
        layers.push(layer(LayerKind::Value, &|g| {
            number(projected_value(mode, g.accumulation))
        }));
    } else {
        layers.push(layer(LayerKind::Transmittance, &|g| {
            1.0 - g.accumulation[3].to_f32()
        }));
    }
    if mode == Mode::Iso {
        layers.push(layer(LayerKind::Value, &|g| number(g.level)));
    }
    if scene.settings.technique.has_depth() {
        let depth = layer(LayerKind::Depth, &|g| number(g.depth));
        if mode.has_depth() {
            layers.push(Layer {
                kind: LayerKind::Position,
                values: positions(scene, &depth.values),
            });
        }
        if mode.has_depth() && has_normals(scene) {
            layers.push(Layer {
                kind: LayerKind::Normal,
                values: normals(scene, &depth.values)?,
            });
        }
        if mode.has_depth() && has_labels(scene) {
            layers.push(Layer {
                kind: LayerKind::Label,
                values: labels(scene, &depth.values),
            });
        }
        layers.push(depth);
    }
    Ok(layers)
}

/// What paths met nothing by, and what they leave beside their picture.
fn layers_of_paths<R: Real>(gathered: &[Gathered<R>]) -> Vec<Layer> {
    let of_paths = |kind: LayerKind| {
        let pixels = gathered.iter().filter_map(|g| g.paths.as_ref());
        let numbers = pixels.flat_map(|means| {
            let numbers = numbers_of(kind, means).into_iter();
            numbers.take(kind.numbers())
        });
        Layer {
            kind,
            values: numbers.collect(),
        }
    };
    let through = |g: &Gathered<R>| 1.0 - g.accumulation[3].to_f32();
    let transmittance = Layer {
        kind: LayerKind::Transmittance,
        values: gathered.iter().map(through).collect(),
    };
    let kinds = LayerKind::ALL.into_iter();
    let kinds = kinds.filter(|&kind| !images_of(kind).is_empty());
    [transmittance]
        .into_iter()
        .chain(kinds.map(of_paths))
        .collect()
}
