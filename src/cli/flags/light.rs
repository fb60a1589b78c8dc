//! Light on what is composited: flags to [`Shading`].

use super::lamps::{DiscLightWord, PointLightWord};
use super::{Error, Numbers, color::rgb, finite, occlusion::OcclusionWord, shadows::ShadowsWord};
use crate::{
    shaders::MAX_LIGHTS,
    technique::{AmbientOcclusion, Light, LightSpace, Mode, Shading, Shadows, pathtrace::Lamp},
};
use clap::{Args, ValueEnum};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::{fmt, str::FromStr};

const HEADING: &str = "Light";

/// The flags, none of them filled in.
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LightFlags {
    /// Colours as they are, or surfaces lit from both sides [default: phong in --mode iso, and under --look auto in
    /// composites of CT, tissue and labels, not with --tf; else none]
    #[arg(long, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shading: Option<ShadingWord>,
    /// Ambient, diffuse and specular part, and shininess [default: 0.1,0.7,0.2,10; 0.35,0.65,0.2,20 where --look
    /// auto lights]
    #[arg(long, value_name = "A,D,S,N", allow_hyphen_values = true, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub material: Option<Numbers<4>>,
    /// A light in this direction of the world, or of the camera (right, up, towards the eye), of a colour in sRGB numbers
    /// (repeatable) [default: white, from the eye; from above and left of it where --look auto lights]
    #[arg(long, value_name = "[camera:]X,Y,Z[,R,G,B]", allow_hyphen_values = true, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub light: Vec<LightWord>,
    /// A light at a place of the world, of a colour in sRGB numbers (repeatable), as bright where the camera is turned to as a
    /// --light of that colour: for --scattering single a point, for --technique pathtrace a sphere [default radius: 1/400
    /// of the diagonal of the volume]
    #[arg(long, value_name = "X,Y,Z[,R,G,B[,RADIUS]]", allow_hyphen_values = true, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub point_light: Vec<PointLightWord>,
    /// A disc at a place of the world that shines to where the camera is turned to, as bright there as a --light of its
    /// colour (repeatable), for --technique pathtrace
    #[arg(long, value_name = "X,Y,Z,RADIUS[,R,G,B]", allow_hyphen_values = true, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub disc_light: Vec<DiscLightWord>,
    /// Gradient magnitude, in values per world length, at which a sample is shaded half as a surface and half evenly;
    /// weaker gradients are shaded more evenly, so that noise does not sparkle [default: 0; by the noise of the volume
    /// where --look auto lights]
    #[arg(long, value_name = "G", value_parser = finite, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub half_gradient: Option<f64>,
    /// Darken where matter within RADIUS (world length) blocks light from all around: the ambient part with --shading
    /// phong, the whole colour without [default radius: a twentieth of the diagonal of the volume]
    #[arg(long, value_name = "STRENGTH[,RADIUS]", allow_hyphen_values = true, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ambient_occlusion: Option<OcclusionWord>,
    /// Whether matter on the way to a --light keeps it away; --material A is what stays in the shadow [default: off;
    /// volume with --scattering single]
    #[arg(long, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shadows: Option<ShadowsWord>,
    /// How wide lights look, in degrees: 0 for sharp shadows [default: 5; 0 with --technique pathtrace and --shadows march]
    #[arg(long, value_name = "DEGREES", value_parser = finite, allow_hyphen_values = true, help_heading = HEADING)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub light_size: Option<f64>,
}

/// Every word of `--shading`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[allow(missing_docs, reason = "the names say it")]
pub enum ShadingWord {
    #[default]
    None,
    Phong,
}

/// `X,Y,Z`, `X,Y,Z,R,G,B` or `X,Y,Z,COLOR`, after `camera:` where the axes are the camera's: the way to a light, and its colour.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct LightWord(Light);

impl LightWord {
    /// The light.
    pub fn light(self) -> Light {
        self.0
    }
}

impl FromStr for LightWord {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (space, text) = match text.strip_prefix(CAMERA) {
            Some(rest) => (LightSpace::Camera, rest),
            None => (LightSpace::World, text),
        };
        let (towards, srgb) = match text.matches(',').count() {
            2 => (Numbers::<3>::from_str(text)?.0, [1.0; 3]),
            5 => {
                let [x, y, z, r, g, b] = Numbers::<6>::from_str(text)?.0;
                ([x, y, z], [r, g, b])
            }
            3 => {
                let (way, color) = text.rsplit_once(',').expect("three commas");
                (Numbers::<3>::from_str(way)?.0, rgb(color)?)
            }
            _ => {
                return Err(
                    "wanted X,Y,Z or X,Y,Z,R,G,B or X,Y,Z,COLOR, after camera: or not".to_owned(),
                );
            }
        };
        let towards = DVec3::from_array(towards);
        if towards.try_normalize().is_none() {
            return Err("the way to a light needs a direction".to_owned());
        }
        if !srgb.iter().all(|c| (0.0..=1.0).contains(c)) {
            return Err("wanted a colour of numbers from 0 to 1".to_owned());
        }
        Ok(Self(Light {
            towards,
            srgb,
            space,
        }))
    }
}

impl fmt::Display for LightWord {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Light {
            towards,
            srgb,
            space,
        } = self.0;
        if space == LightSpace::Camera {
            f.write_str(CAMERA)?;
        }
        Numbers(towards.to_array()).fmt(f)?;
        if srgb != [1.0; 3] {
            write!(f, ",{}", Numbers(srgb))?;
        }
        Ok(())
    }
}

/// Before a direction in the axes of the camera.
const CAMERA: &str = "camera:";

impl LightWord {
    /// A white light in this direction of the camera: right, up, towards the eye.
    pub fn of_camera(towards: DVec3) -> Self {
        Self(Light {
            towards,
            srgb: [1.0; 3],
            space: LightSpace::Camera,
        })
    }
}

impl TryFrom<String> for LightWord {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<LightWord> for String {
    fn from(light: LightWord) -> Self {
        light.to_string()
    }
}

impl LightFlags {
    /// Surfaces are lit unless another word is said: without light they have no shape.
    fn word(&self, mode: Mode) -> ShadingWord {
        let of_mode = match mode {
            Mode::Iso => ShadingWord::Phong,
            _ => ShadingWord::None,
        };
        self.shading.unwrap_or(of_mode)
    }

    /// True where a picture in `mode` is lit.
    pub fn is_lit(&self, mode: Mode) -> bool {
        self.word(mode) == ShadingWord::Phong
    }

    /// Lights that have a place.
    pub fn lamps(&self) -> Vec<Lamp> {
        let points = self.point_light.iter().map(|word| word.lamp());
        let discs = self.disc_light.iter().map(|word| word.lamp());
        points.chain(discs).collect()
    }

    /// True where a word names a light.
    pub fn has_lights(&self) -> bool {
        !(self.light.is_empty() && self.point_light.is_empty() && self.disc_light.is_empty())
    }

    /// Whether slices lie half way to the light.
    pub fn is_half_angle(&self) -> bool {
        self.shadows == Some(ShadowsWord::HalfAngle)
    }

    /// The light of a picture in `mode`.
    pub fn shading(&self, mode: Mode) -> Result<Option<Shading>, Error> {
        let has_surfaces = self.word(mode) == ShadingWord::Phong;
        if !has_surfaces && !self.is_half_angle() {
            return Ok(None);
        }
        if mode.is_projection() {
            return Err(Error::usage(
                "--shading phong and --shadows need --mode composite, mida or iso: no light falls on a projection",
                "leave out --mode or --shading",
            ));
        }
        if self.light.len() > MAX_LIGHTS as usize {
            let found = self.light.len();
            return Err(Error::usage(
                format!("{found} lights, at most {MAX_LIGHTS} are possible"),
                "give --light at most four times",
            ));
        }
        let mut shading = Shading {
            lights: self.light.iter().map(|word| word.0).collect(),
            shadows: self.shadows()?,
            has_surfaces,
            half_gradient: self.half_gradient()?,
            ..Shading::default()
        };
        if let Some(Numbers(material)) = self.material {
            let [ambient, diffuse, specular, shininess] = material;
            let are_parts = material.iter().all(|&part| part >= 0.0);
            if !are_parts || !(MIN_SHININESS..=MAX_SHININESS).contains(&shininess) {
                return Err(Error::usage(
                    format!(
                        "--material {}: wanted three numbers from 0 and a shininess from {MIN_SHININESS} to {MAX_SHININESS}",
                        Numbers(material)
                    ),
                    "--material 0.1,0.7,0.2,10 is ambient, diffuse, specular, shininess",
                ));
            }
            shading = Shading {
                ambient,
                diffuse,
                specular,
                shininess,
                ..shading
            };
        }
        Ok(Some(shading))
    }

    fn half_gradient(&self) -> Result<f64, Error> {
        match self.half_gradient.unwrap_or(0.0) {
            gradient if gradient >= 0.0 && gradient.is_finite() => Ok(gradient),
            gradient => Err(Error::usage(
                format!("--half-gradient {gradient}: wanted a number from 0"),
                "--half-gradient 0 lights all gradients as surfaces",
            )),
        }
    }

    fn shadows(&self) -> Result<Shadows, Error> {
        Ok(self.shadows.unwrap_or_default().shadows(self.size()?))
    }

    /// How wide lights look whose shadows are followed through a grid, in degrees.
    pub(super) fn size(&self) -> Result<f64, Error> {
        let size = self.light_size.unwrap_or(DEFAULT_LIGHT_SIZE);
        if !(0.0..=MAX_LIGHT_SIZE).contains(&size) {
            return Err(Error::usage(
                format!("--light-size {size}: wanted degrees from 0 to {MAX_LIGHT_SIZE}"),
                "--light-size 0 makes shadows sharp, the sun is half a degree wide",
            ));
        }
        Ok(size)
    }

    /// How many bundles of paths of light are followed for a picture.
    pub fn bundle_count(&self) -> u32 {
        let of_occlusion = u32::from(self.ambient_occlusion.is_some());
        match self.shadows.unwrap_or_default() {
            ShadowsWord::Volume => of_occlusion + self.light.len() as u32,
            ShadowsWord::Off | ShadowsWord::March | ShadowsWord::HalfAngle => of_occlusion,
        }
    }

    /// The ambient occlusion of a picture in `mode`.
    pub fn occlusion(&self, mode: Mode) -> Result<Option<AmbientOcclusion>, Error> {
        let occlusion = self.ambient_occlusion.map(OcclusionWord::occlusion);
        if occlusion.is_some() && mode.is_projection() {
            return Err(Error::usage(
                "--ambient-occlusion needs --mode composite, mida or iso: no light falls on a projection",
                "leave out --mode or --ambient-occlusion",
            ));
        }
        Ok(occlusion)
    }

    /// Flags that change nothing under the others, a sentence each.
    pub fn idle(&self, mode: Mode) -> Vec<&'static str> {
        let is_dark = self.word(mode) == ShadingWord::None && !self.is_half_angle();
        let mut notes = Vec::new();
        if is_dark && self.material.is_some() {
            notes.push("--material has no effect without --shading phong");
        }
        if is_dark && !self.light.is_empty() {
            notes.push("--light has no effect without --shading phong");
        }
        if !self.point_light.is_empty() {
            notes.push(
                "--point-light has no effect without --technique pathtrace or --scattering single",
            );
        }
        if !self.disc_light.is_empty() {
            notes.push("--disc-light has no effect without --technique pathtrace");
        }
        if is_dark && self.half_gradient.is_some() {
            notes.push("--half-gradient has no effect without --shading phong");
        }
        if self.shadows == Some(ShadowsWord::Volume) && (is_dark || self.light.is_empty()) {
            notes.push(
                "--shadows volume has no effect without --shading phong and --light: nothing seen is in the shadow of the eye's own light",
            );
        }
        if self.light_size.is_some() && self.shadows != Some(ShadowsWord::Volume) {
            notes.push("--light-size has no effect without --shadows volume");
        }
        if self.ambient_occlusion.is_some() && !is_dark && self.material.is_none() {
            notes.push(
                "--ambient-occlusion takes ambient light, a tenth of it all unless --material says so: --material 0.5,0.5,0.2,10 shows more",
            );
        }
        notes
    }
}

/// Soft where matter is far, and no blur where it is near.
const DEFAULT_LIGHT_SIZE: f64 = 5.0;
const MAX_LIGHT_SIZE: f64 = 90.0;

/// A power of 0 would mirror everywhere, and over a thousand no pixel would.
const MIN_SHININESS: f64 = 0.1;
const MAX_SHININESS: f64 = 1000.0;

#[cfg(test)]
mod tests {
    use super::*;

    fn flags(shading: ShadingWord, material: &str, light: &[&str]) -> LightFlags {
        LightFlags {
            shading: Some(shading),
            material: (!material.is_empty()).then(|| material.parse().expect("numbers")),
            light: light.iter().map(|l| l.parse().expect("a light")).collect(),
            ..LightFlags::default()
        }
    }

    #[test]
    fn light_is_a_headlight_and_the_material_that_of_the_help_unless_given() {
        let shading = flags(ShadingWord::Phong, "", &[]).shading(Mode::Composite);
        assert_eq!(shading.expect("light"), Some(Shading::default()));
        assert_eq!(
            LightFlags::default().shading(Mode::Mip).expect("dark"),
            None
        );
        let lit = flags(ShadingWord::Phong, "0,1,2,3", &["0,-2,0", "1,0,0,1,0.5,0"]);
        let lit = lit.shading(Mode::Composite).expect("light").expect("lit");
        let parts = [lit.ambient, lit.diffuse, lit.specular, lit.shininess];
        assert_eq!(parts, [0.0, 1.0, 2.0, 3.0]);
        let way = |light: &Light| (light.towards.to_array(), light.srgb);
        assert_eq!(way(&lit.lights[0]), ([0.0, -2.0, 0.0], [1.0; 3]));
        assert_eq!(way(&lit.lights[1]), ([1.0, 0.0, 0.0], [1.0, 0.5, 0.0]));
    }

    #[test]
    fn what_is_no_light_is_refused_with_a_reason() {
        for (text, wanted) in [
            ("1,2", "X,Y,Z or X,Y,Z,R,G,B"),
            ("0,0,0", "a direction"),
            ("1,0,0,2,0,0", "from 0 to 1"),
            ("1,0,up", "a number"),
            ("1,0,0,puce", "no colour \"puce\""),
        ] {
            let problem = text.parse::<LightWord>().expect_err("refused");
            assert!(problem.contains(wanted), "{text}: {problem}");
        }
        for material in ["-1,0,0,10", "1,1,1,0", "1,1,1,1001"] {
            let refused = flags(ShadingWord::Phong, material, &[]).shading(Mode::Composite);
            let text = refused.expect_err("refused").to_string();
            assert!(text.contains("--material"), "{text}");
        }
        let many = flags(ShadingWord::Phong, "", &["1,0,0"; 5]).shading(Mode::Composite);
        let text = many.expect_err("refused").to_string();
        assert!(text.contains("at most 4"), "{text}");
    }

    #[test]
    fn a_light_comes_back_from_its_own_text() {
        for text in ["0.5,-1,2", "0,0,1,0.25,0.5,1", "camera:-0.5,1,2"] {
            let light: LightWord = text.parse().expect("a light");
            assert_eq!(light.to_string(), text);
        }
    }

    #[test]
    fn light_without_shading_is_mentioned() {
        let idle = flags(ShadingWord::None, "1,1,1,1", &["1,0,0"]).idle(Mode::Composite);
        assert_eq!(idle.len(), 2, "{idle:?}");
        assert!(
            flags(ShadingWord::Phong, "1,1,1,1", &["1,0,0"])
                .idle(Mode::Composite)
                .is_empty()
        );
    }
}
