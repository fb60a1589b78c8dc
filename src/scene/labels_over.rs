//! Labels over a picture that does not mix them: of each ray the label that it meets first.
//!
//! ```text
//! picture = a c + (1 - a) p        c, a the colour and the opacity of the first label along the ray whose opacity is not 0
//! ```
//!
//! The opacity is that of the transfer function as it is, however thick the label: a cut as thin as a sample has the
//! labels of its plane. Both are drawn as composites of labels that nothing shines through: one of colours, and one of
//! opacities in the place of colours where labels have several.

use super::{Beside, Channel, Scene};
use crate::color::encode_srgb;
use crate::picture::{ColorSpace, Picture};
use crate::technique::{Filter, Mode, Role, Settings};
use crate::transfer::TransferFunction;

/// The reference length of labels that nothing shines through, in smallest voxel spacings: a sample of a cut, which is a
/// hundredth of a spacing thick, is opaque.
const OPAQUE_SPACINGS: f64 = 1e-4;

impl<'a> Scene<'a> {
    /// The label maps that lie over the picture: those behind all other channels, in modes but composite.
    pub(crate) fn labels_over(&self) -> &'a [Channel<'a>] {
        match self.beside {
            Beside::Channels(channels) if self.settings.mode != Mode::Composite => {
                &channels[labels_from(channels)..]
            }
            _ => &[],
        }
    }

    /// The scene without them.
    pub(crate) fn under_labels(&self) -> Self {
        let beside = match self.beside {
            Beside::Channels(channels) => {
                match &channels[..channels.len() - self.labels_over().len()] {
                    [] => Beside::Nothing,
                    numbers => Beside::Channels(numbers),
                }
            }
            beside => beside,
        };
        Self { beside, ..*self }
    }
}

/// Where the labels behind all numbers begin.
fn labels_from(channels: &[Channel]) -> usize {
    let behind = channels.iter().rev();
    channels.len() - behind.take_while(|one| one.role == Role::Labels).count()
}

/// One label map as it is drawn over a picture.
#[derive(Debug)]
pub(crate) struct LabelsOver {
    settings: Settings,
    colors: TransferFunction,
    opacity: Opacity,
}

#[derive(Debug)]
enum Opacity {
    /// That of all labels that are seen.
    Same(f32),
    /// The labels with their opacities as greys.
    Greys(TransferFunction),
}

impl LabelsOver {
    /// Of a map in this scene; `None` where nothing of it is seen.
    pub fn new(scene: &Scene, map: &Channel) -> Option<Self> {
        let function = map.transfer?;
        let seen = function.opacity.iter().map(|point| point.opacity);
        let seen = seen.filter(|&opacity| opacity > 0.0);
        let most = seen.clone().reduce(f64::max)?;
        let mut colors = function.clone();
        colors.reference_length = Some(OPAQUE_SPACINGS * scene.volume.grid().smallest_spacing());
        for point in &mut colors.opacity {
            point.opacity = f64::from(u8::from(point.opacity > 0.0));
        }
        let are_same = seen.clone().all(|opacity| opacity == most);
        let space = scene.settings.color_space;
        let opacity = match are_same {
            true => Opacity::Same(most as f32),
            false => Opacity::Greys(greys(&colors, function, space)),
        };
        let settings = scene.settings;
        Some(Self {
            colors,
            opacity,
            settings: Settings {
                filter: Filter::Nearest,
                samples_per_voxel: settings.samples_per_voxel,
                rays_per_side: settings.rays_per_side,
                uneven_rays: settings.uneven_rays,
                jitter: settings.jitter,
                skip: settings.skip,
                color_space: space,
                crop: settings.crop,
                clip_planes: settings.clip_planes.clone(),
                conformance: settings.conformance,
                ..Settings::default()
            },
        })
    }

    /// Lays the map over the picture of the scene, with what draws a scene of labels alone.
    ///
    /// # Errors
    /// Those of `draw`.
    pub fn lay<E>(
        &self,
        scene: &Scene,
        map: &Channel,
        under: &mut Picture,
        mut draw: impl FnMut(&Scene) -> Result<Picture, E>,
    ) -> Result<(), E> {
        let alone = |function| Scene {
            volume: map.volume,
            transfer: Some(function),
            beside: Beside::Nothing,
            settings: &self.settings,
            ..*scene
        };
        let colors = draw(&alone(&self.colors))?;
        let greys = match &self.opacity {
            Opacity::Same(_) => None,
            Opacity::Greys(greys) => Some(draw(&alone(greys))?),
        };
        for (i, (under, color)) in under.pixels.iter_mut().zip(&colors.pixels).enumerate() {
            let covered = color[3];
            if covered == 0.0 {
                continue;
            }
            let opacity = match (&self.opacity, &greys) {
                (Opacity::Same(opacity), _) => *opacity,
                (_, Some(greys)) => greys.pixels[i][0] / covered,
                (_, None) => unreachable!("greys are drawn where opacities differ"),
            };
            let through = 1.0 - opacity * covered;
            *under = std::array::from_fn(|c| opacity * color[c] + through * under[c]);
        }
        Ok(())
    }
}

/// The labels of `opaque`, each as grey as `function` is opaque there, in the numbers that are blended.
fn greys(
    opaque: &TransferFunction,
    function: &TransferFunction,
    space: ColorSpace,
) -> TransferFunction {
    let mut greys = opaque.clone();
    for point in &mut greys.color {
        let opacity = function.opacity(point.value);
        let shown = match space {
            ColorSpace::Linear => encode_srgb(opacity),
            ColorSpace::Display => opacity,
        };
        point.srgb = [shown; 3];
    }
    greys
}
