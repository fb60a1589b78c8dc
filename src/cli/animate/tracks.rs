//! Everything that can change along a film, laid over the flags of the command line.

use super::{functions::mixed, track::Track};
use crate::{
    cli::{
        Error,
        flags::{CameraFlags, ClassificationFlags, Numbers, SamplingFlags, WindowWord},
    },
    technique::{Light, Shading},
    transfer::{TransferFunction, transfer_function_to_json},
};

/// One track a word; one without keys changes nothing.
#[derive(Clone, Debug)]
#[allow(missing_docs, reason = "the names are the words of the flags")]
pub struct Tracks {
    pub azimuth: Track<1>,
    pub elevation: Track<1>,
    pub roll: Track<1>,
    pub fov: Track<1>,
    pub ln_zoom: Track<1>,
    pub ln_view_height: Track<1>,
    pub eye: Track<3>,
    pub target: Track<3>,
    pub up: Track<3>,
    pub window: Track<2>,
    pub crop: Track<6>,
    /// One a plane, with unit normals at the keys.
    pub clip: Vec<Track<4>>,
    /// The way to the only light.
    pub light: Track<3>,
    pub time: Track<1>,
    /// Mixed by straight lines, whatever the easing: opacities stay between 0 and 1.
    pub functions: Vec<(f64, TransferFunction)>,
}

impl Tracks {
    /// True where a key has a word that says where the camera stands or how near it is.
    pub fn places_the_camera(&self) -> bool {
        let is_open = self.eye.is_empty()
            && self.target.is_empty()
            && self.ln_zoom.is_empty()
            && self.ln_view_height.is_empty();
        !is_open
    }

    /// `flags` as they are at `u`.
    pub fn camera(&self, flags: &CameraFlags, u: f64) -> CameraFlags {
        let stronger = CameraFlags {
            azimuth: self.azimuth.number(u),
            elevation: self.elevation.number(u),
            roll: self.roll.number(u),
            fov: self.fov.number(u),
            zoom: self.ln_zoom.number(u).map(f64::exp),
            view_height: self.ln_view_height.number(u).map(f64::exp),
            eye: self.eye.at(u).map(Numbers),
            target: self.target.at(u).map(Numbers),
            up: self.up.at(u).map(Numbers),
            ..CameraFlags::default()
        };
        let mut weaker = flags.clone();
        weaker.give_way_to(&stronger);
        CameraFlags {
            projection: weaker.projection,
            frame: weaker.frame,
            exaggerate: weaker.exaggerate,
            view: weaker.view,
            azimuth: stronger.azimuth.or(weaker.azimuth),
            elevation: stronger.elevation.or(weaker.elevation),
            roll: stronger.roll.or(weaker.roll),
            fov: stronger.fov.or(weaker.fov),
            zoom: stronger.zoom.or(weaker.zoom),
            view_height: stronger.view_height.or(weaker.view_height),
            eye: stronger.eye.or(weaker.eye),
            target: stronger.target.or(weaker.target),
            up: stronger.up.or(weaker.up),
        }
    }

    /// `flags` as they are at `u`. Normals of planes have length 1 again; two opposed ones have nothing
    /// between them, which the flags refuse.
    pub fn sampling(&self, flags: &SamplingFlags, u: f64) -> SamplingFlags {
        let mut flags = flags.clone();
        if let Some(crop) = self.crop.at(u) {
            flags.crop = Some(Numbers(crop));
        }
        if !self.clip.is_empty() {
            let planes = self.clip.iter().filter_map(|plane| plane.at(u));
            flags.clip = planes.map(|plane| Numbers(renormalized(plane))).collect();
        }
        flags
    }

    /// Moves the light of `shading` to where it is at `u`.
    pub fn light(&self, shading: &mut Option<Shading>, u: f64) -> Result<(), Error> {
        let Some(towards) = self.light.at(u) else {
            return Ok(());
        };
        let hint = "--shading phong, and at most one --light, whose colour stays";
        let Some(shading) = shading else {
            return Err(Error::usage(
                "a key has a `light`, and nothing is lit",
                hint,
            ));
        };
        let found = shading.lights.len();
        if found > 1 {
            let message = format!("a key moves the only `light`, and there are {found}");
            return Err(Error::usage(message, hint));
        }
        if towards.iter().map(|x| x * x).sum::<f64>().sqrt() < SHORTEST_NORMAL {
            return Err(Error::usage(
                "the `light` of two keys comes from opposite sides: no way lies between them",
                "a key between them says where it goes along",
            ));
        }
        let srgb = shading.lights.first().map_or([1.0; 3], |light| light.srgb);
        let towards = towards.into();
        shading.lights = vec![Light::of_world(towards, srgb)];
        Ok(())
    }

    /// `flags` as they are at `u`; `spacing` is the smallest one of the grid.
    pub fn classification(
        &self,
        flags: &ClassificationFlags,
        u: f64,
        spacing: f64,
    ) -> ClassificationFlags {
        let mut flags = flags.clone();
        if let Some(function) = self.function(u, spacing) {
            let text = transfer_function_to_json(&function);
            let value = serde_json::from_str(&text).expect("what we have just written as JSON");
            flags.preset = None;
            flags.transfer_function = Some(value);
            flags.transfer_function_of_fractions = None;
        }
        if let Some(window) = self.window.at(u) {
            flags.window = Some(WindowWord::Values(window));
        }
        flags
    }

    fn function(&self, u: f64, spacing: f64) -> Option<TransferFunction> {
        let passed = self.functions.iter().take_while(|key| key.0 <= u).count();
        match (passed.checked_sub(1), self.functions.get(passed)) {
            (None, None) => None,
            (None, Some((_, only))) => Some(only.clone()),
            (Some(k), None) => Some(self.functions[k].1.clone()),
            (Some(k), Some((u1, b))) => {
                let (u0, a) = &self.functions[k];
                Some(mixed(a, b, (u - u0) / (u1 - u0), spacing))
            }
        }
    }
}

/// Shorter ones have lost their direction.
const SHORTEST_NORMAL: f64 = 1e-6;

fn renormalized([x, y, z, offset]: [f64; 4]) -> [f64; 4] {
    let length = (x * x + y * y + z * z).sqrt();
    if length < SHORTEST_NORMAL {
        return [0.0, 0.0, 0.0, offset];
    }
    [x / length, y / length, z / length, offset]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::animate::track::Easing;

    fn nothing() -> Tracks {
        fn none<const N: usize>() -> Track<N> {
            Track::new(Vec::new(), Easing::Linear)
        }
        Tracks {
            azimuth: none(),
            elevation: none(),
            roll: none(),
            fov: none(),
            ln_zoom: none(),
            ln_view_height: none(),
            eye: none(),
            target: none(),
            up: none(),
            window: none(),
            crop: none(),
            clip: Vec::new(),
            light: none(),
            time: none(),
            functions: Vec::new(),
        }
    }

    #[test]
    fn a_plane_between_two_has_a_unit_normal_and_the_distance_between() {
        let plane = Track::new(
            vec![(0.0, [1.0, 0.0, 0.0, 2.0]), (1.0, [0.0, 1.0, 0.0, 6.0])],
            Easing::Linear,
        );
        let tracks = Tracks {
            clip: vec![plane],
            ..nothing()
        };
        let found = tracks.sampling(&SamplingFlags::default(), 0.5).clip[0].0;
        let half = 0.5_f64.sqrt();
        let wanted = [half, half, 0.0, 4.0];
        assert!(
            (0..4).all(|i| (found[i] - wanted[i]).abs() < 1e-15),
            "{found:?}"
        );
        let opposed = Track::new(
            vec![(0.0, [1.0, 0.0, 0.0, 2.0]), (1.0, [-1.0, 0.0, 0.0, 2.0])],
            Easing::Linear,
        );
        let tracks = Tracks {
            clip: vec![opposed],
            ..nothing()
        };
        let found = tracks.sampling(&SamplingFlags::default(), 0.5).clip[0].0;
        assert_eq!(found, [0.0, 0.0, 0.0, 2.0]);
    }

    #[test]
    fn without_keys_the_flags_stay_and_an_eye_takes_the_place_of_angles() {
        let flags = CameraFlags {
            azimuth: Some(3.0),
            zoom: Some(2.0),
            ..CameraFlags::default()
        };
        assert_eq!(nothing().camera(&flags, 0.3), flags);
        let eye = Track::new(
            vec![(0.0, [1.0, 2.0, 3.0]), (1.0, [3.0, 2.0, 1.0])],
            Easing::Linear,
        );
        let found = Tracks { eye, ..nothing() }.camera(&flags, 0.5);
        let wanted = CameraFlags {
            eye: Some(Numbers([2.0, 2.0, 2.0])),
            zoom: Some(2.0),
            ..CameraFlags::default()
        };
        assert_eq!(found, wanted);
    }
}
