//! Pictures of light that scatters, and no light: nobody is left alone with a black one.

use super::{EnvironmentWord, SceneFlags};

impl SceneFlags {
    /// Says so where neither lights nor sky nor matter send out any light. Without words for lights and sky there is the
    /// light of the eye, and with `--bounces 0` matter shines in its colours.
    pub(super) fn darkness(&self) -> Option<String> {
        let shines = self.traces_paths() && self.path.bounces == Some(0);
        let scatters = self.traces_paths() || self.path.scatters_once();
        if !scatters || shines || self.has_light() || self.has_emission() {
            return None;
        }
        Some(
            "no light: the picture is black; --light X,Y,Z, --environment R,G,B over 0 and `emission` of a --tf file give light"
                .to_owned(),
        )
    }

    /// True where a light, the sky or the eye shines.
    fn has_light(&self) -> bool {
        let is_lit = |color: [f64; 3]| color.iter().any(|&c| c > 0.0);
        let lights = self.light.light.iter().map(|word| word.light().srgb);
        let lamps = self.light.lamps().into_iter().map(|lamp| lamp.srgb);
        let has_lit = lights.chain(lamps).any(is_lit);
        has_lit
            || match &self.path.environment {
                None => !self.light.has_lights(),
                Some(EnvironmentWord::Even(light)) => is_lit(*light),
                // One that is black is refused.
                Some(EnvironmentWord::Picture(_)) => true,
            }
    }

    /// True where the function's file has matter that shines.
    fn has_emission(&self) -> bool {
        let medium = self.classification.function_of_files().medium;
        medium.is_some_and(|medium| {
            let mut numbers = medium.emission.iter().flat_map(|point| point.linear);
            numbers.any(|c| c > 0.0)
        })
    }
}
