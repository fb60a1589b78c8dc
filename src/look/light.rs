//! The light of pictures, where light shows a shape.
//!
//! ```text
//! light        right, up and towards the eye -0.5, 0.6, 1     ambient .35, diffuse .65, specular .2, shininess 20
//! g0           sqrt(3/2) sigma / h: the root mean square of the gradient that noise of deviation sigma makes, by central
//!              differences over voxels of the side h; of labels .01 / h: neighbours of two labels differ by 1 at least
//! ```

use super::values::summary;
use crate::technique::{Light, LightSpace, Mode, Shading};
use crate::transfer::{Kind, Preset};
use crate::volume::{Volume, noise_of};
use glam::DVec3;

/// Material of lit pictures: ambient, diffuse and specular part, and shininess.
pub const MATERIAL: [f64; 4] = [0.35, 0.65, 0.2, 20.0];

/// The way to the light in the axes of the camera: from the left, above and behind it.
pub const LIGHT: DVec3 = DVec3::new(-0.5, 0.6, 1.0);

/// Samples for each voxel along a ray of a still: wood-grain of one sample a voxel is seen in smooth matter.
pub const STILL_SAMPLES: f64 = 2.0;

/// Presets that are made for lit surfaces.
const LIT_PRESETS: [Preset; 3] = [Preset::CtBone, Preset::CtSoftTissue, Preset::Mri];

/// Where the function of samples comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// The program chose it by the values and what their file says.
    Automatic,
    /// A preset that was named.
    Preset(Preset),
    /// A file.
    Given,
}

/// True for composites by a function that the program chose, or that is made for light: light and samples of other
/// pictures are those that are asked for.
pub fn may_choose(mode: Mode, origin: Origin) -> bool {
    let is_ours = match origin {
        Origin::Automatic => true,
        Origin::Preset(preset) => LIT_PRESETS.contains(&preset),
        Origin::Given => false,
    };
    mode == Mode::Composite && is_ours
}

/// True where [`may_choose`] holds and light shows a shape: of presets that are made for it, and of kinds of values with
/// surfaces.
pub fn is_lit(mode: Mode, origin: Origin, kind: impl FnOnce() -> Kind) -> bool {
    let has_shape = || matches!(kind(), Kind::Ct | Kind::Tissue | Kind::Labels);
    may_choose(mode, origin) && (origin != Origin::Automatic || has_shape())
}

/// The half gradient of labels, in labels per voxel: their numbers have no noise, and a gradient of 1/2, the least between
/// two labels, has the weight .98.
const OF_LABELS: f64 = 0.01;

/// The half gradient that noise of a volume asks for, in values per world length.
pub fn half_gradient(volume: &Volume) -> f64 {
    let per_voxel = match summary(volume).labels {
        Some(_) => OF_LABELS,
        None => 1.5_f64.sqrt() * noise_of(volume),
    };
    per_voxel / volume.grid().smallest_spacing()
}

/// [`LIGHT`] on [`MATERIAL`], with the [`half_gradient`] of a volume.
pub fn light(volume: &Volume) -> Shading {
    let [ambient, diffuse, specular, shininess] = MATERIAL;
    Shading {
        ambient,
        diffuse,
        specular,
        shininess,
        half_gradient: half_gradient(volume),
        lights: vec![Light {
            towards: LIGHT,
            space: LightSpace::Camera,
            srgb: [1.0; 3],
        }],
        ..Shading::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_is_chosen_for_composites_of_what_has_surfaces_alone() {
        let lit = |mode, origin, kind| is_lit(mode, origin, || kind);
        let automatic = Origin::Automatic;
        for kind in [Kind::Ct, Kind::Tissue, Kind::Labels] {
            assert!(lit(Mode::Composite, automatic, kind), "{kind:?}");
        }
        assert!(!lit(Mode::Composite, automatic, Kind::Field));
        assert!(may_choose(Mode::Composite, automatic));
        for mode in [Mode::Mida, Mode::Mip, Mode::Average, Mode::Xray, Mode::Iso] {
            assert!(!may_choose(mode, automatic), "{mode}");
            assert!(!lit(mode, automatic, Kind::Ct), "{mode}");
        }
        for preset in Preset::ALL {
            let is_made_for_light = matches!(preset.name(), "ct-bone" | "ct-soft-tissue" | "mri");
            let origin = Origin::Preset(preset);
            assert_eq!(may_choose(Mode::Composite, origin), is_made_for_light);
            assert_eq!(lit(Mode::Composite, origin, Kind::Field), is_made_for_light);
        }
        assert!(!may_choose(Mode::Composite, Origin::Given));
        assert!(!lit(Mode::Composite, Origin::Given, Kind::Ct));
    }
}
