//! A scene to a picture on the CPU: every technique by its twin, in f32 or f64, no Vulkan anywhere.

use crate::picture::{Layer, LayerKind, Picture};
use crate::real::Real;
use crate::resolve::reference::{premultiplied, projected_value};
use crate::scene::{Scene, positions_in_pixel};
use crate::shaders::Frame;
use crate::technique::blend::{blend, clear_color};
use crate::technique::{
    Error, Filter, Mode, Recording, Technique, projection, raycast, slices_2d, slices_3d,
};
use crate::transfer::{
    Absorption, Classified, Points, Table, TransferFunction, Window, classify_by_points,
    classify_by_table,
};
use crate::volume::sample::{linear, linear_in_slice, nearest};
use crate::volume::{Grid, Volume};

/// What a technique leaves for one pixel, before it is resolved.
#[derive(Clone, Copy, Debug)]
struct Gathered<R> {
    /// Composite: premultiplied colour. Else (value, weight, unused, unused).
    accumulation: [R; 4],
    depth: Option<R>,
    samples: u32,
}

/// The picture of `scene` with all layers that its technique has.
///
/// # Errors
/// Those of the parameters: too many samples or clip planes.
pub fn render<R: Real>(scene: &Scene) -> Result<Picture, Error> {
    let grid = scene.volume.grid();
    let mode = scene.settings.mode;
    let gathered = |in_pixel| Walk::<R>::new(scene, &grid, in_pixel).map(|walk| walk.gather_all());
    let centers = gathered([0.0; 2])?;
    let transfer = match scene.transfer {
        Some(transfer) => transfer.clone(),
        None => grey_of_picture(mode, &centers),
    };
    let space = scene.settings.color_space;
    let points = Points::new(&transfer, Absorption::Opacity, space);
    let resolve =
        |g: &Gathered<R>| premultiplied(mode, g.accumulation, |v| classify_by_points(&points, v));

    let per_side = scene.settings.rays_per_side;
    let weight = R::from_f64(1.0 / f64::from(per_side * per_side));
    let mut pixels = vec![[R::from_f64(0.0); 4]; centers.len()];
    for in_pixel in positions_in_pixel(per_side) {
        let found = if in_pixel == [0.0; 2] {
            centers.clone()
        } else {
            gathered(in_pixel)?
        };
        for (pixel, found) in pixels.iter_mut().zip(&found) {
            let color = resolve(found);
            *pixel = std::array::from_fn(|c| pixel[c] + weight * color[c]);
        }
    }
    let [width, height] = scene.extent_pixels;
    Ok(Picture {
        width,
        height,
        pixels: pixels.iter().map(|pixel| pixel.map(R::to_f32)).collect(),
        color_space: space,
        layers: layers(scene, &centers),
    })
}

/// The default window of a projecting mode without a transfer function: the range of this picture.
fn grey_of_picture<R: Real>(mode: Mode, gathered: &[Gathered<R>]) -> TransferFunction {
    let values = gathered
        .iter()
        .filter_map(|g| projected_value(mode, g.accumulation))
        .map(R::to_f64);
    let range = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| {
        [low.min(v), high.max(v)]
    });
    Window::of_range(range).grey(Classified::Projection)
}

fn layers<R: Real>(scene: &Scene, gathered: &[Gathered<R>]) -> Vec<Layer> {
    let mode = scene.settings.mode;
    let layer = |kind, number: &dyn Fn(&Gathered<R>) -> f32| Layer {
        kind,
        values: gathered.iter().map(number).collect(),
    };
    let number = |found: Option<R>| found.map_or(f32::NAN, R::to_f32);
    let mut layers = vec![layer(LayerKind::Samples, &|g| g.samples as f32)];
    if mode.is_projection() {
        layers.push(layer(LayerKind::Value, &|g| {
            number(projected_value(mode, g.accumulation))
        }));
    } else {
        layers.push(layer(LayerKind::Transmittance, &|g| {
            1.0 - g.accumulation[3].to_f32()
        }));
    }
    if scene.settings.technique == Technique::Raycast {
        layers.push(layer(LayerKind::Depth, &|g| number(g.depth)));
    }
    layers
}

/// One walk over the pixels of a picture.
struct Walk<'a, R> {
    scene: &'a Scene<'a>,
    frame: Frame,
    /// Slices to draw; a ray caster has none.
    slices: u32,
    classifier: Classifier,
    real: std::marker::PhantomData<R>,
}

/// Conformance pictures search the points, the others look into the table: both as the shaders do.
enum Classifier {
    Table(Table),
    Points(Points),
    /// A projecting mode classifies when it resolves.
    Later,
}

impl<'a, R: Real> Walk<'a, R> {
    fn new(scene: &'a Scene<'a>, grid: &Grid, in_pixel: [f64; 2]) -> Result<Self, Error> {
        let view = scene.view(grid, in_pixel);
        let reference_length = scene.reference_length();
        let absorption = Absorption::Extinction { reference_length };
        let space = scene.settings.color_space;
        let classifier = match scene.transfer {
            _ if scene.settings.mode.is_projection() => Classifier::Later,
            Some(function) if scene.settings.conformance => {
                Classifier::Points(Points::new(function, absorption, space))
            }
            Some(function) => Classifier::Table(Table::new(function, absorption, space)),
            None => return Err(Error::NoTransferFunction),
        };
        let Recording { frame, slices, .. } = view.on_cpu()?;
        Ok(Self {
            scene,
            frame,
            slices,
            classifier,
            real: std::marker::PhantomData,
        })
    }

    /// All pixels, rows shared out among the machine's cores.
    fn gather_all(&self) -> Vec<Gathered<R>> {
        let [width, height] = self.scene.extent_pixels;
        let threads = std::thread::available_parallelism()
            .map_or(1, |n| n.get() as u32)
            .min(height.max(1));
        let rows = |first: u32| {
            let mine = (first..height).step_by(threads as usize);
            mine.map(|y| (0..width).map(|x| self.gather(x, y)).collect::<Vec<_>>())
                .collect::<Vec<_>>()
        };
        let mut shares = std::thread::scope(|scope| {
            let workers: Vec<_> = (0..threads)
                .map(|first| scope.spawn(move || rows(first)))
                .collect();
            let joined = workers
                .into_iter()
                .map(|worker| worker.join().expect("a pixel does not panic"));
            joined.map(Vec::into_iter).collect::<Vec<_>>()
        });
        (0..height as usize)
            .flat_map(|y| shares[y % threads as usize].next().expect("every row"))
            .collect()
    }

    fn gather(&self, x: u32, y: u32) -> Gathered<R> {
        let pixel = [x, y].map(|n| R::from_f64(f64::from(n)) + R::from_f64(0.5));
        let settings = self.scene.settings;
        let (volume, frame) = (self.scene.volume, &self.frame);
        let value_at = |p| filtered(volume, settings.filter, p);
        match settings.technique {
            Technique::Raycast if settings.mode.is_projection() => {
                let (found, samples) = projection::reference::project(
                    frame,
                    settings.lattice,
                    settings.mode,
                    pixel,
                    value_at,
                );
                let zero = R::from_f64(0.0);
                let accumulation = [found.value, found.weight, zero, zero];
                Gathered {
                    accumulation,
                    depth: found.depth,
                    samples,
                }
            }
            Technique::Raycast => {
                let classify = |value| self.classify(value);
                let (found, samples) = raycast::reference::radiance(
                    frame,
                    settings.lattice,
                    pixel,
                    value_at,
                    classify,
                );
                let [r, g, b] = found.color;
                let accumulation = [r, g, b, R::from_f64(1.0) - found.transmittance];
                Gathered {
                    accumulation,
                    depth: found.depth,
                    samples,
                }
            }
            Technique::Slices3d => self.blend_all(|instance| {
                let plane = frame.slice_first + instance as i32 * frame.slice_direction;
                slices_3d::reference::fragment(frame, pixel, plane, value_at)
            }),
            Technique::Slices2d => self.blend_all(|instance| {
                let slice = slices_2d::reference::slice_of(frame, instance);
                let axis = frame.slice_axis as usize;
                let value_at =
                    |p| filtered_in_slice(volume, settings.filter, axis, slice as u32, p);
                slices_2d::reference::fragment(frame, pixel, slice, value_at)
            }),
        }
    }

    /// All slices of one pixel through the blending unit.
    fn blend_all(
        &self,
        fragment: impl Fn(u32) -> Option<Option<crate::technique::blend::Fragment<R>>>,
    ) -> Gathered<R> {
        let (mode, order) = (self.scene.settings.mode, self.scene.settings.order);
        let mut target = clear_color(mode).map(R::from_f32);
        let mut samples = 0;
        for fragment in (0..self.slices).filter_map(fragment) {
            samples += 1;
            if let Some(fragment) = fragment {
                target = blend(mode, order, target, fragment, |value| self.classify(value));
            }
        }
        Gathered {
            accumulation: target,
            depth: None,
            samples,
        }
    }

    fn classify(&self, value: R) -> [R; 4] {
        match &self.classifier {
            Classifier::Table(table) => classify_by_table(table, value),
            Classifier::Points(points) => classify_by_points(points, value),
            Classifier::Later => [R::from_f64(0.0); 4],
        }
    }
}

fn filtered<R: Real>(volume: &Volume, filter: Filter, p: [R; 3]) -> Option<R> {
    match filter {
        Filter::Nearest => nearest(volume, p),
        Filter::Linear => linear(volume, p),
    }
}

fn filtered_in_slice<R: Real>(
    volume: &Volume,
    filter: Filter,
    axis: usize,
    slice: u32,
    mut p: [R; 3],
) -> Option<R> {
    match filter {
        Filter::Nearest => {
            p[axis] = R::from_f64(f64::from(slice) + 0.5);
            nearest(volume, p)
        }
        Filter::Linear => linear_in_slice(volume, axis, slice, p),
    }
}
