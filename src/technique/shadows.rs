//! What keeps light from matter.

use super::Settings;

/// How shadows are made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Shadows {
    /// Light goes through everything.
    #[default]
    Off,
    /// Composite by [`super::Technique::Slices3d`], of one volume in one texture: slices half way between eye and
    /// light, drawn into the picture and into what the light sees ([`super::slices_3d::HalfAngleSlicer`]).
    HalfAngle,
}

impl Settings {
    /// Whether slices lie half way between eye and light.
    pub fn is_half_angle(&self) -> bool {
        let shading = self.shading.as_ref();
        shading.is_some_and(|shading| shading.shadows == Shadows::HalfAngle)
    }
}
