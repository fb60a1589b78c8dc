//! Which layers a picture has beside its colours: blending keeps no depth, a projection no transmittance, and a composite
//! has no one value.

use super::Settings;
use crate::picture::LayerKind;

/// What a picture lacks for a layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Lack {
    /// One number a voxel: the sum of several projections has no one value and no one depth.
    OneNumber,
    /// A mode that finds one value a ray.
    OneValue,
    /// A mode that composites.
    Transmittance,
    /// Rays of pixels.
    Rays,
    /// A mode with one depth a ray.
    Depth,
    /// Random paths.
    Paths,
    /// A background that is not light.
    Unlit,
    /// Annotation lies over a picture that is done.
    Annotation,
}

impl Settings {
    /// Whether it splats scattered points, which are thick.
    pub(crate) fn has_balls(&self) -> bool {
        self.technique.splats() && self.splat.of_points
    }

    /// What pictures of these settings lack for a layer, one volume's or, with `are_several`, that of several.
    pub(crate) fn lack(&self, layer: LayerKind, are_several: bool) -> Option<Lack> {
        use LayerKind::{
            Albedo, Annotation, Bounces, Depth, Direct, Emission, Indirect, Label, Line, Noise,
            Normal, Position, Samples, Transmittance, Value,
        };
        let (technique, mode) = (self.technique, self.mode);
        let is_sum = are_several && mode.is_projection();
        match layer {
            Noise | Albedo | Direct | Indirect | Emission | Bounces => {
                (!technique.traces_paths()).then_some(Lack::Paths)
            }
            // Paths that meet the sky meet something.
            Transmittance if technique.traces_paths() => self.path.shows_sky.then_some(Lack::Unlit),
            Depth | Normal | Samples if technique.traces_paths() => None,
            // Of many paths in a pixel none is the one.
            _ if technique.traces_paths() && layer != Annotation => Some(Lack::Rays),
            Value | Depth | Position | Normal | Label if is_sum => Some(Lack::OneNumber),
            Value => (!mode.has_value()).then_some(Lack::OneValue),
            Transmittance => mode.is_projection().then_some(Lack::Transmittance),
            Depth | Position | Normal | Label if !technique.has_depth() || self.has_balls() => {
                Some(Lack::Rays)
            }
            // Sheets are thick: only an extreme has the depth of one.
            Depth | Position | Normal | Label
                if technique.splats() && !mode.projects_one_place() =>
            {
                Some(Lack::Depth)
            }
            // It is of points.
            Normal | Label if self.field.is_some() => Some(Lack::OneNumber),
            Position | Normal | Label if !mode.has_depth() => Some(Lack::Depth),
            // It is of what is drawn beside the volume.
            Depth | Position | Normal | Label | Samples | Line => None,
            Annotation => Some(Lack::Annotation),
        }
    }
}
