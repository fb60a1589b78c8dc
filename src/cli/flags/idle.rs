//! Flags and keys that change nothing, named one by one: only those that were given.

use super::shadows::ShadowsWord;
use super::{LightFlags, SceneFlags};
use crate::technique::Mode;

/// `a`, `a and b`, `a, b and c`.
fn listed(words: &[&str]) -> String {
    match words {
        [] => String::new(),
        [word] => (*word).to_owned(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

/// That those of `flags` that were given have no effect, and `why`; `None` where none was.
pub(super) fn no_effect(flags: &[(&str, bool)], why: &str) -> Option<String> {
    let given = flags.iter().filter(|(_, is_given)| *is_given);
    let given: Vec<_> = given.map(|(flag, _)| *flag).collect();
    let verb = match given.len() {
        0 => return None,
        1 => "has",
        _ => "have",
    };
    Some(format!("{} {verb} no effect {why}", listed(&given)))
}

impl SceneFlags {
    /// Flags of light, and of matter that scatters it.
    pub(super) fn idle_of_light(&self, mode: Mode) -> Vec<String> {
        let LightFlags {
            material,
            half_gradient,
            shadows,
            ..
        } = &self.light;
        let of_shading = [
            ("--material", material.is_some()),
            ("--half-gradient", half_gradient.is_some()),
        ];
        if self.traces_paths() {
            let of_rays = [
                ("--shadows off", *shadows == Some(ShadowsWord::Off)),
                ("--shadows volume", *shadows == Some(ShadowsWord::Volume)),
                (
                    "--samples-per-voxel",
                    self.sampling.samples_per_voxel.is_some(),
                ),
            ];
            let flags = [&of_shading[..], &of_rays[..]].concat();
            let idle = no_effect(&flags, "with --technique pathtrace");
            return idle.into_iter().chain(self.path.idle_of_paths()).collect();
        }
        if self.path.scatters_once() {
            let idle = no_effect(&of_shading, "with --scattering single");
            return idle.into_iter().chain(self.path.idle_of_rays()).collect();
        }
        let of_light = self.light.idle(mode).into_iter().map(str::to_owned);
        of_light.chain(self.path.idle()).collect()
    }

    /// Keys of the function that are for pictures of light that scatters.
    pub(super) fn idle_medium(&self) -> Option<String> {
        if self.traces_paths() || self.path.scatters_once() {
            return None;
        }
        let function = self.classification.function_of_files();
        let medium = function.medium.as_ref()?;
        let keys = medium.keys();
        let verb = if keys.len() == 1 { "is" } else { "are" };
        let drawn = match (medium.extinction.is_empty(), function.opacity.is_empty()) {
            (false, _) => "its colour is drawn, as dense as the mean of its extinction",
            (true, false) => "its colour and opacity are drawn",
            (true, true) => "its colour is drawn",
        };
        Some(format!(
            "{} of the transfer function {verb} for --technique pathtrace and --scattering single: {drawn}",
            listed(&keys)
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn those_that_were_given_are_named_and_no_others() {
        let said = |given: [bool; 3]| {
            let [a, b, c] = given;
            no_effect(&[("--a", a), ("--b", b), ("--c", c)], "here")
        };
        assert_eq!(said([false; 3]), None);
        for (given, wanted) in [
            ([false, true, false], "--b has no effect here"),
            ([true, false, true], "--a and --c have no effect here"),
            ([true; 3], "--a, --b and --c have no effect here"),
        ] {
            assert_eq!(said(given).as_deref(), Some(wanted));
        }
    }
}
