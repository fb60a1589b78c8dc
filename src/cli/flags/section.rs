//! A cut through the volume, seen from straight in front: what radiologists call multiplanar reformation.
//!
//! ```text
//! plane       n . (x - target) = 0,   the eye on the side of n, orthographic
//! slab        |n . (x - target)| <= thickness / 2,   by two clip planes
//! height      2 max(H_up, H_right height / width),   H_v = |v . (c - target)| + sum of |v . a_k|
//! at p        e . x = p,   e the axis of the world that the plane stands across, or the normal as it was given
//! i of N      n . (x - c) = H_n(c) (1 - (2 i - 1) / N),   H_n(c) = sum of |n . a_k|,   i = 1 the nearest to the eye
//! ```
//!
//! with c the middle of the grid box and a_k half of its edges: all of the box fits. A slab thinner than a step of
//! the ray holds one sample a ray, at its middle: on the plane itself.

use super::{
    CameraFlags, Depth, Error, Numbers, SamplingFlags, Subject,
    camera::refused,
    finite, positive,
    section_words::{Cuts, MOST_CUTS, Place, Planes},
};
use crate::{
    camera::{Camera, Frame, Projection, up_for},
    shaders::MAX_CLIP_PLANES,
    technique::{ClipPlane, Lattice, Mode, Settings},
};
use clap::Args;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// The flags, none of them filled in.
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SectionFlags {
    /// Show a cut through --target, seen from in front: axial (from below), coronal (from anterior), sagittal (from
    /// the left), or by its normal; on the Earth axial is a map (from above) and coronal seen from the south; --mode is
    /// average unless given. Several planes in one picture, at one scale: axial,coronal,sagittal; axial:12 is twelve of
    /// them, evenly from end to end, and axial:3/12 the third
    #[arg(long, value_name = "PLANE", allow_hyphen_values = true, help_heading = "Camera",
          conflicts_with_all = ["projection", "fov", "view", "azimuth", "elevation", "eye"])]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub section: Option<Planes>,
    /// World positions of the cuts, one or several in one picture: of axial z, of coronal y, of sagittal x, of a normal N
    /// along it, N.x / |N| [default: --target]
    #[arg(long, value_name = "P,...", value_delimiter = ',', value_parser = finite, allow_hyphen_values = true,
          requires = "section", help_heading = "Camera")]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub at: Vec<f64>,
    /// World thickness of the cut; --mode says what becomes of its values [default: one sample]
    #[arg(long, value_name = "T", value_parser = positive, requires = "section", help_heading = "Camera")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub thickness: Option<f64>,
}

/// A cut of no thickness is so thick, in smallest voxel spacings: less than any step, and more than f32 loses
/// between the eye and the plane.
const THINNEST: f64 = 0.01;

impl SectionFlags {
    /// The same flags for each of the planes alone; none without a section.
    pub fn each(&self) -> Vec<Self> {
        if !self.at.is_empty() {
            let alone = |&position| Self {
                at: vec![position],
                ..self.clone()
            };
            return self.at.iter().map(alone).collect();
        }
        let cuts = self.section.iter().flat_map(|planes| &planes.0);
        let alone = |cut: Cuts| Self {
            section: Some(Planes(vec![cut])),
            ..self.clone()
        };
        cuts.flat_map(|cuts| cuts.each()).map(alone).collect()
    }

    /// The plane, where there is one.
    fn cut(&self) -> Result<Option<Cuts>, Error> {
        let Some(planes) = &self.section else {
            return Ok(None);
        };
        match (&planes.0[..], &self.at[..]) {
            (&[cut], []) if !matches!(cut.place, Place::All(_)) => Ok(Some(cut)),
            (&[cut], &[position]) => Ok(Some(Cuts {
                place: Place::At(position),
                ..cut
            })),
            _ => Err(Error::usage(
                "--section of several planes makes one picture of them, and only `render` draws that",
                "name one plane",
            )),
        }
    }

    /// What to compute: a cut is the mean over its thickness unless another mode is asked for.
    pub fn settings(&self, sampling: &SamplingFlags, depth: Depth) -> Result<Settings, Error> {
        let mut settings = sampling.settings(depth)?;
        self.check_at()?;
        if self.section.is_none() {
            return Ok(settings);
        }
        if sampling.mode.is_none() {
            settings.mode = Mode::Average;
        }
        // Sheets of splats are far apart: a cut of one sample lies between two.
        let is_between = settings.technique.splats() && self.thickness.is_none();
        if !settings.technique.has_depth() || is_between || settings.lattice != Lattice::Ray {
            return Err(Error::usage(
                "--section takes its samples on the cut: other lattices than that of rays have none there",
                "leave out --technique and --lattice",
            ));
        }
        if settings.mode == Mode::Iso && self.thickness.is_none() {
            return Err(Error::usage(
                "--section without --thickness is one sample a ray, and --mode iso shows what lies between two",
                "add --thickness T for the surfaces in a slab",
            ));
        }
        Ok(settings)
    }

    /// Whether the positions are those of planes that face one way, and not too many.
    fn check_at(&self) -> Result<(), Error> {
        let Some(planes) = self.section.as_ref().filter(|_| !self.at.is_empty()) else {
            return Ok(());
        };
        let is_one = matches!(&planes.0[..], [cut] if cut.place == Place::Target);
        let found = self.at.len();
        match found > MOST_CUTS as usize {
            _ if !is_one => Err(Error::usage(
                format!("--at places planes that face one way, and --section says {planes}"),
                "name one: --section axial --at 10,20,30",
            )),
            true => Err(Error::usage(
                format!("--at: wanted at most {MOST_CUTS} planes, found {found}"),
                "leave some out, or draw several pictures",
            )),
            false => Ok(()),
        }
    }

    /// The error, naming `--section` where that chose the mode that is to blame: where `is_right` of the same words
    /// with `--mode composite`.
    pub fn named_in(
        &self,
        error: Error,
        sampling: &SamplingFlags,
        is_right: impl FnOnce(&SamplingFlags) -> bool,
    ) -> Error {
        let composite = SamplingFlags {
            mode: Some(Mode::Composite),
            ..sampling.clone()
        };
        match error {
            Error::Usage { message, .. }
                if self.section.is_some() && sampling.mode.is_none() && is_right(&composite) =>
            {
                let message =
                    format!("--section draws --mode average unless a mode is given: {message}");
                Error::usage(message, "add --mode composite, or leave out --section")
            }
            error => error,
        }
    }

    /// The camera on this subject; a cut adds its two clip planes to `settings`.
    pub fn camera(
        &self,
        camera: &CameraFlags,
        subject: &Subject,
        extent_pixels: [u32; 2],
        settings: &mut Settings,
    ) -> Result<Camera, Error> {
        let Some(Cuts { plane, place }) = self.cut()? else {
            return camera.camera(subject, extent_pixels);
        };
        if camera.places_the_eye() {
            return Err(Error::usage(
                "--section looks straight at its plane: nothing else may place the camera",
                "--target moves the plane, --up and --roll turn the picture",
            ));
        }
        let center = subject.bounds.center;
        let normal = plane.normal(subject.is_earth)?;
        let mut target = camera.target.map_or(center, |Numbers(p)| p.into());
        match place {
            Place::Nth(nth, count) => {
                let share = 1.0 - f64::from(2 * nth - 1) / f64::from(count);
                let along = (center - target).dot(normal) + share * subject.half_extent(normal);
                target += along * normal;
            }
            Place::At(position) => {
                let axis = plane.axis(subject.is_earth)?;
                self.check_position(position, axis, subject)?;
                target += (position - target.dot(axis)) * axis;
            }
            Place::Target | Place::All(_) => {}
        }
        let up = camera
            .up
            .map_or_else(|| up_for(normal), |Numbers(v)| v.into());
        let upright = Camera {
            eye: target + 2.0 * subject.bounds.radius * normal,
            target,
            up,
            projection: Projection::Orthographic { view_height: 1.0 },
            zoom: camera.zoom.unwrap_or(1.0),
        };
        upright.check().map_err(refused)?;
        let (sine, cosine) = camera.roll.unwrap_or(0.0).to_radians().sin_cos();
        let Frame { right, up, .. } = upright.frame();
        let rolled = Camera {
            up: cosine * up - sine * right,
            ..upright
        };
        let Frame { right, up, .. } = rolled.frame();
        let half = |v: DVec3| subject.half_extent(v) + v.dot(center - target).abs();
        let [width, height] = extent_pixels.map(f64::from);
        let fitted = 2.0 * half(up).max(half(right) * height / width);
        let view_height = camera.view_height.unwrap_or(fitted);

        if settings.clip_planes.len() + 2 > MAX_CLIP_PLANES as usize {
            return Err(Error::TooMany {
                message: format!(
                    "--section cuts with two planes, beside the {} of --clip and --clip-box: at most {MAX_CLIP_PLANES} are \
                     possible",
                    settings.clip_planes.len()
                ),
                hint: "use --crop for planes along the axes of the grid",
            });
        }
        let half_thickness = 0.5
            * self
                .thickness
                .unwrap_or(THINNEST * subject.smallest_spacing);
        for side in [normal, -normal] {
            settings.clip_planes.push(ClipPlane {
                normal: side,
                offset: side.dot(target) - half_thickness,
            });
        }
        Ok(Camera {
            projection: Projection::Orthographic { view_height },
            ..rolled
        })
    }

    /// World length from the planes to either side of their slabs, 0 for one sample; `None` without a section.
    pub fn half_thickness(&self) -> Option<f64> {
        let thickness = self.thickness.unwrap_or(0.0);
        self.section.is_some().then_some(0.5 * thickness)
    }

    /// Whether a slab at this position along `axis` holds anything of the volume.
    fn check_position(&self, position: f64, axis: DVec3, subject: &Subject) -> Result<(), Error> {
        let (middle, half) = (subject.bounds.center.dot(axis), subject.half_extent(axis));
        if (position - middle).abs() <= half + self.half_thickness().unwrap_or(0.0) {
            return Ok(());
        }
        Err(Error::usage(
            format!(
                "--at {position}: the volume lies from {} to {} there",
                rounded(middle - half),
                rounded(middle + half)
            ),
            "`stratavox info INPUT` says where the volume lies in the world",
        ))
    }
}

/// To what a person reads.
fn rounded(number: f64) -> f64 {
    (1e3 * number).round() / 1e3
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::technique::Technique;
    use crate::volume::Grid;
    use glam::{DAffine3, DMat3, dvec3};

    /// A box of 40 x 60 x 100 around (1, 2, 3).
    fn subject() -> Subject {
        let matrix = DMat3::from_diagonal(dvec3(4.0, 6.0, 5.0));
        let grid = Grid {
            dims: [10, 10, 20],
            world_from_voxel: DAffine3::from_mat3_translation(matrix, dvec3(-19.0, -28.0, -47.0)),
        };
        Subject::new(&grid, false)
    }

    fn seen(
        word: &str,
        change: impl FnOnce(&mut CameraFlags, &mut SectionFlags),
    ) -> (Camera, Settings) {
        let mut camera = CameraFlags::default();
        let mut section = SectionFlags {
            section: Some(word.parse().expect("a plane")),
            ..SectionFlags::default()
        };
        change(&mut camera, &mut section);
        let sampling = SamplingFlags::default();
        let mut settings = section.settings(&sampling, Depth::Eight).expect("settings");
        let camera = section.camera(&camera, &subject(), [300, 200], &mut settings);
        (camera.expect("a camera"), settings)
    }

    #[test]
    fn the_patients_right_is_on_the_left_and_the_box_fits() {
        for (word, right, up, height) in [
            ("axial", DVec3::X * -1.0, DVec3::Y, 60.0),
            ("coronal", DVec3::X * -1.0, DVec3::Z, 100.0),
            ("sagittal", DVec3::Y * -1.0, DVec3::Z, 100.0),
        ] {
            let (camera, settings) = seen(word, |_, _| {});
            let frame = camera.frame();
            assert!((frame.right - right).length() < 1e-12, "{word}: {frame:?}");
            assert!((frame.up - up).length() < 1e-12, "{word}: {frame:?}");
            let Projection::Orthographic { view_height } = camera.projection else {
                panic!("{camera:?}");
            };
            assert!((view_height - height).abs() < 1e-9, "{word}: {view_height}");
            assert_eq!(settings.mode, Mode::Average);
        }
        // A box wider than the picture is fitted by its width: 100 across, and 2 of 3 of that in height.
        let (camera, _) = seen("1,0,0", |camera, _| camera.roll = Some(90.0));
        let Projection::Orthographic { view_height } = camera.projection else {
            panic!("{camera:?}");
        };
        assert!(
            (view_height - 100.0 * 2.0 / 3.0).abs() < 1e-9,
            "{view_height}"
        );
    }

    #[test]
    fn maps_of_the_earth_have_the_east_on_the_right() {
        let subject = Subject {
            is_earth: true,
            ..subject()
        };
        for (word, up) in [("axial", DVec3::Y), ("coronal", DVec3::Z)] {
            let section = SectionFlags {
                section: Some(word.parse().expect("a plane")),
                ..SectionFlags::default()
            };
            let (camera, mut settings) = (CameraFlags::default(), Settings::default());
            let camera = section.camera(&camera, &subject, [300, 200], &mut settings);
            let frame = camera.expect("a camera").frame();
            assert!((frame.right - DVec3::X).length() < 1e-12, "{frame:?}");
            assert!((frame.up - up).length() < 1e-12, "{frame:?}");
        }
    }

    #[test]
    fn the_slab_lies_on_both_sides_of_the_target() {
        let (_, settings) = seen("0,0,2", |camera, section| {
            camera.target = Some(Numbers([5.0, 5.0, 7.0]));
            section.thickness = Some(3.0);
        });
        let [above, below] = &settings.clip_planes[..] else {
            panic!("{settings:?}");
        };
        assert_eq!((above.normal, above.offset), (DVec3::Z, 5.5));
        assert_eq!((below.normal, below.offset), (-DVec3::Z, -8.5));
    }

    #[test]
    fn what_goes_against_a_section_is_refused() {
        let section = SectionFlags {
            section: Some("axial".parse().expect("a plane")),
            ..SectionFlags::default()
        };
        let turned = CameraFlags {
            azimuth: Some(20.0),
            ..CameraFlags::default()
        };
        let mut settings = Settings::default();
        let refused = section.camera(&turned, &subject(), [8, 8], &mut settings);
        assert_eq!(refused.expect_err("refused").exit_code(), 2);
        let slices = SamplingFlags {
            technique: Some(Technique::Slices3d),
            ..SamplingFlags::default()
        };
        let refused = section.settings(&slices, Depth::Eight);
        assert_eq!(refused.expect_err("refused").exit_code(), 2);
        for text in [
            "axial",
            "coronal",
            "sagittal",
            "1,0,-0.5",
            "axial,coronal,sagittal",
        ] {
            let planes: Planes = text.parse().expect("planes");
            assert_eq!(planes.to_string(), text);
        }
        for text in ["flat", "axial,flat", "axial,1,0,0", "axial:65"] {
            assert!(text.parse::<Planes>().is_err(), "{text}");
        }
    }
}
