//! What paths leave beside their picture: CPU reference of `shaders/lib/path_layers.wgsl`, and where each layer stands in it.
//!
//! ```text
//! layer   = sum over paths / paths            depth = sum over paths / paths that have met something
//! picture = emission + direct + indirect + sky that the eye sees
//! ```

use crate::picture::LayerKind;
use crate::real::{Real, add};

/// How many images of four numbers a pixel the shader fills.
pub(crate) const PATH_IMAGES: usize = 5;

/// Means over the paths of a pixel: (albedo, part of the paths that met something), (normal, depth), (direct light, bounces),
/// (indirect light, samples), (emission, 0).
pub(crate) type PathMeans = [[f32; 4]; PATH_IMAGES];

/// Which of the images a layer is made of; none: it is no layer of single paths.
pub(crate) fn images_of(kind: LayerKind) -> &'static [usize] {
    match kind {
        LayerKind::Albedo => &[0],
        LayerKind::Depth => &[0, 1],
        LayerKind::Normal => &[1],
        LayerKind::Direct | LayerKind::Bounces => &[2],
        LayerKind::Indirect | LayerKind::Samples => &[3],
        LayerKind::Emission => &[4],
        _ => &[],
    }
}

/// The numbers of a layer in one pixel: as many as it has, then 0.
pub(crate) fn numbers_of(kind: LayerKind, means: &PathMeans) -> [f32; 3] {
    let three = |image: usize| [0, 1, 2].map(|c| means[image][c]);
    match kind {
        LayerKind::Albedo => three(0),
        LayerKind::Normal => three(1),
        // Where no path has met anything 0 / 0: there is none.
        LayerKind::Depth => [means[1][3] / means[0][3], 0.0, 0.0],
        LayerKind::Direct => three(2),
        LayerKind::Bounces => [means[2][3], 0.0, 0.0],
        LayerKind::Indirect => three(3),
        LayerKind::Samples => [means[3][3], 0.0, 0.0],
        LayerKind::Emission => three(4),
        _ => [f32::NAN; 3],
    }
}

/// Sums over the paths of a pixel.
#[derive(Clone, Copy)]
pub(super) struct PathLayers<R> {
    albedo: [R; 3],
    normal: [R; 3],
    depth: R,
    met: R,
    /// By how often it was scattered: never, once, more often.
    light: [[R; 3]; 3],
    bounces: R,
    samples: R,
}

impl<R: Real> PathLayers<R> {
    pub fn none() -> Self {
        let zero = R::from_f64(0.0);
        Self {
            albedo: [zero; 3],
            normal: [zero; 3],
            depth: zero,
            met: zero,
            light: [[zero; 3]; 3],
            bounces: zero,
            samples: zero,
        }
    }

    /// The first real collision of a path; `normal`: of a surface.
    pub fn add_first(&mut self, albedo: [R; 3], normal: Option<[R; 3]>, depth: R) {
        self.albedo = add(self.albedo, albedo);
        if let Some(normal) = normal {
            self.normal = add(self.normal, normal);
        }
        self.depth = self.depth + depth;
        self.met = self.met + R::from_f64(1.0);
    }

    /// Light that was scattered so often.
    pub fn add_light(&mut self, light: [R; 3], scatterings: u32) {
        let sum = &mut self.light[scatterings.min(2) as usize];
        *sum = add(*sum, light);
    }

    /// A path is scattered.
    pub fn add_bounce(&mut self) {
        self.bounces = self.bounces + R::from_f64(1.0);
    }

    /// A tentative collision.
    pub fn add_sample(&mut self) {
        self.samples = self.samples + R::from_f64(1.0);
    }

    /// Of so many paths.
    pub fn means(&self, paths: R) -> PathMeans {
        let zero = R::from_f64(0.0);
        let [emission, direct, indirect] = self.light;
        let images = [
            (self.albedo, self.met),
            (self.normal, self.depth),
            (direct, self.bounces),
            (indirect, self.samples),
            (emission, zero),
        ];
        images.map(|([x, y, z], w)| [x, y, z, w].map(|sum| (sum / paths).to_f32()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_layer_is_made_of_the_images_that_it_names() {
        for kind in LayerKind::ALL {
            // NaN in all images but those.
            let is_read = |image: usize| images_of(kind).contains(&image);
            let means = std::array::from_fn(|i| [if is_read(i) { 0.5 } else { f32::NAN }; 4]);
            let numbers = numbers_of(kind, &means);
            let is_of_paths = !images_of(kind).is_empty();
            assert_eq!(numbers.iter().all(|n| !n.is_nan()), is_of_paths, "{kind:?}");
        }
    }

    #[test]
    fn depth_is_the_mean_over_the_paths_that_met_something() {
        let mut sums = PathLayers::<f64>::none();
        sums.add_first([0.5; 3], None, 3.0);
        sums.add_first([1.0; 3], Some([0.0, 0.6, 0.8]), 5.0);
        let means = sums.means(8.0);
        assert_eq!(numbers_of(LayerKind::Depth, &means)[0], 4.0);
        assert_eq!(numbers_of(LayerKind::Albedo, &means), [0.1875; 3]);
        assert_eq!(numbers_of(LayerKind::Normal, &means), [0.0, 0.075, 0.1]);
        let none = PathLayers::<f64>::none().means(8.0);
        assert!(numbers_of(LayerKind::Depth, &none)[0].is_nan());
    }
}
