//! Where the picture is seen from: flags to a [`Camera`], once the volume's box is known.

use super::{Error, Numbers, Subject, finite, positive};
use crate::camera::{self, Camera, Lens, Orbit, View, up_for};
use clap::{Args, ValueEnum};
use glam::{DMat3, DVec3};
use serde::{Deserialize, Serialize};

/// The flags, none of them filled in.
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CameraFlags {
    /// How rays spread [default: perspective]
    #[arg(long, help_heading = "Camera")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub projection: Option<ProjectionWord>,
    /// Vertical angle of a perspective view [default: 30]
    #[arg(long, value_name = "DEG", value_parser = positive, help_heading = "Camera")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fov: Option<f64>,
    /// What fills the picture: what is visible of the volume, or its whole box [default: visible under --look auto; the
    /// bounding sphere with --zoom alone and under plain]
    #[arg(long, value_name = "WHAT", conflicts_with_all = ["eye", "target", "view_height"], help_heading = "Camera")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frame: Option<FrameWord>,
    /// Magnification: at 1 what --frame names fits the picture, or without it the bounding sphere [default: 1, of what
    /// --frame names under --look auto]
    #[arg(long, value_name = "F", value_parser = positive, help_heading = "Camera")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub zoom: Option<f64>,
    /// Stand on this side [default: between right and anterior, a little above; of a piece of the Earth the south;
    /// under --look auto the face of a slab, and the best of six sides where the file names no axes]
    #[arg(long, value_name = "SIDE", conflicts_with_all = ["azimuth", "elevation"], help_heading = "Camera")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub view: Option<ViewWord>,
    /// Stand at this angle around +z, from +x towards +y
    #[arg(long, value_name = "DEG", value_parser = finite, allow_negative_numbers = true, help_heading = "Camera")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub azimuth: Option<f64>,
    /// Stand at this angle above the plane of x and y
    #[arg(long, value_name = "DEG", value_parser = finite, allow_negative_numbers = true, help_heading = "Camera")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub elevation: Option<f64>,
    /// Turn the picture clockwise
    #[arg(long, value_name = "DEG", value_parser = finite, allow_negative_numbers = true, help_heading = "Camera")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub roll: Option<f64>,
    /// Stand here, in world space
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true,
          conflicts_with_all = ["view", "azimuth", "elevation", "roll"], help_heading = "Camera")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub eye: Option<Numbers<3>>,
    /// Look at this point [default: the middle of the grid box]
    #[arg(
        long,
        value_name = "X,Y,Z",
        allow_hyphen_values = true,
        help_heading = "Camera"
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target: Option<Numbers<3>>,
    /// This direction is up in the picture [default: +z, looking along z +y]
    #[arg(
        long,
        value_name = "X,Y,Z",
        allow_hyphen_values = true,
        help_heading = "Camera"
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub up: Option<Numbers<3>>,
    /// World height of an orthographic picture [default: the bounding sphere fits]
    #[arg(long, value_name = "H", value_parser = positive, help_heading = "Camera")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub view_height: Option<f64>,
    /// Stretch heights, world z, by this; 1 for not at all [default: 1, more where a piece of the Earth is wide and
    /// flat]
    #[arg(long, value_name = "F", value_parser = positive, help_heading = "Camera")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub exaggerate: Option<f64>,
}

/// Full vertical angle of a perspective view.
const DEFAULT_FOV_DEGREES: f64 = 30.0;

impl CameraFlags {
    /// The camera on this subject.
    pub fn camera(&self, subject: &Subject, extent_pixels: [u32; 2]) -> Result<Camera, Error> {
        let bounds = &subject.bounds;
        let lens = match self.projection.unwrap_or_default() {
            ProjectionWord::Perspective => Lens::Perspective {
                fov_degrees: self.fov.unwrap_or(DEFAULT_FOV_DEGREES),
            },
            ProjectionWord::Orthographic => Lens::Orthographic {
                view_height: self.view_height,
            },
        };
        let target = self.target.map_or(bounds.center, |Numbers(p)| p.into());
        let up = self.up.map(|Numbers(v)| DVec3::from(v));
        let camera = match self.eye {
            Some(Numbers(eye)) => {
                let eye = DVec3::from(eye);
                Camera {
                    eye,
                    target,
                    up: up.unwrap_or_else(|| up_for(target - eye)),
                    projection: lens.projection(bounds, extent_pixels),
                    zoom: 1.0,
                }
            }
            None => {
                let orbit = self.orbit(subject);
                Camera::orbit(bounds, target, orbit, up, lens, extent_pixels).map_err(refused)?
            }
        };
        let camera = Camera {
            zoom: self.zoom.unwrap_or(1.0),
            ..camera
        };
        camera.check().map_err(refused)?;
        Ok(camera)
    }

    /// What the camera is to be fitted to, if to anything: what a word says; what is visible, where `is_auto` and no
    /// word says how near or where.
    pub fn framed(&self, is_auto: bool) -> Option<FrameWord> {
        let places = self.eye.is_some() || self.target.is_some() || self.view_height.is_some();
        match self.frame {
            Some(word) if !places => Some(word),
            None if is_auto && !places && self.zoom.is_none() => Some(FrameWord::Visible),
            _ => None,
        }
    }

    /// True where a word says from which side the volume is seen.
    pub fn names_a_side(&self) -> bool {
        self.eye.is_some()
            || self.view.is_some()
            || self.azimuth.is_some()
            || self.elevation.is_some()
    }

    /// True where a word says how rays spread or where they start.
    pub fn places_the_eye(&self) -> bool {
        self.names_a_side()
            || self.projection == Some(ProjectionWord::Perspective)
            || self.fov.is_some()
    }

    /// Takes back what [`Self::places_the_eye`] asks for.
    pub fn leave_the_eye(&mut self) {
        self.leave_the_side();
        (self.projection, self.fov) = (None, None);
    }

    fn orbit(&self, subject: &Subject) -> Orbit {
        let side = match (self.view, self.azimuth, self.elevation) {
            (Some(view), _, _) => view.view(subject.is_earth).orbit(),
            (None, None, None) => subject.side(),
            (None, azimuth, elevation) => Orbit {
                azimuth_degrees: azimuth.unwrap_or(0.0),
                elevation_degrees: elevation.unwrap_or(0.0),
                roll_degrees: 0.0,
            },
        };
        Orbit {
            roll_degrees: self.roll.unwrap_or(0.0),
            ..side
        }
    }

    /// Makes room for one of several views: nothing else says where to stand.
    pub fn leave_the_side(&mut self) {
        (self.eye, self.view) = (None, None);
        (self.azimuth, self.elevation) = (None, None);
    }

    /// The same flags gone around the vertical axis through the target, from +x towards +y.
    pub fn turned(&self, degrees: f64, subject: &Subject) -> Self {
        let turn = DMat3::from_rotation_z(degrees.to_radians());
        let turned_up = |forward| {
            let up = self
                .up
                .map_or_else(|| up_for(forward), |Numbers(v)| v.into());
            Some(Numbers((turn * up).into()))
        };
        let mut turned = self.clone();
        if let Some(Numbers(eye)) = self.eye {
            let target = self
                .target
                .map_or(subject.bounds.center, |Numbers(p)| p.into());
            let from_target = DVec3::from(eye) - target;
            turned.eye = Some(Numbers((target + turn * from_target).into()));
            turned.up = turned_up(-from_target);
            return turned;
        }
        let orbit = self.orbit(subject);
        turned.view = None;
        turned.azimuth = Some(orbit.azimuth_degrees + degrees);
        turned.elevation = Some(orbit.elevation_degrees);
        // Along the axis nothing would turn but for `up`.
        let (sine, cosine) = orbit.elevation_degrees.to_radians().sin_cos();
        let forward = DVec3::new(cosine, 0.0, -sine);
        if self.up.is_none() && up_for(forward) == DVec3::Y {
            turned.up = turned_up(forward);
        }
        turned
    }

    /// Takes out what `stronger` excludes, so that both can be put together.
    pub fn give_way_to(&mut self, stronger: &Self) {
        let stronger_orbits = stronger.azimuth.is_some() || stronger.elevation.is_some();
        if stronger.eye.is_some() || stronger.view.is_some() || stronger_orbits {
            if !stronger_orbits || self.eye.is_some() {
                (self.azimuth, self.elevation) = (None, None);
            }
            (self.view, self.eye) = (None, None);
        }
        if stronger.eye.is_some() {
            self.roll = None;
        }
        if stronger.eye.is_some() || stronger.target.is_some() || stronger.view_height.is_some() {
            self.frame = None;
        }
        if stronger.frame.is_some() {
            (self.eye, self.target, self.view_height) = (None, None, None);
            self.zoom = None;
        }
        if stronger.roll.is_some() {
            self.eye = None;
        }
    }

    /// Flags that change nothing under the others, a sentence each.
    pub fn idle(&self, is_section: bool) -> Vec<&'static str> {
        let mut notes = Vec::new();
        match self.projection.unwrap_or_default() {
            ProjectionWord::Perspective if self.view_height.is_some() && !is_section => {
                notes.push("--view-height has no effect without --projection orthographic");
            }
            ProjectionWord::Orthographic if self.fov.is_some() => {
                notes.push("--fov has no effect with --projection orthographic");
            }
            _ => {}
        }
        notes
    }
}

/// A camera that sees nothing, as words that cannot be followed.
pub fn refused(error: camera::Error) -> Error {
    Error::usage(
        error.to_string(),
        "a camera stands at --eye, looks at --target, and --up points elsewhere",
    )
}

/// Every word of `--projection`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[allow(missing_docs, reason = "the names say it")]
pub enum ProjectionWord {
    #[default]
    Perspective,
    Orthographic,
}

/// Every word of `--frame`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FrameWord {
    /// Pixels that let less than 97 % of the light behind them through
    Visible,
    /// The grid box, or what --crop leaves of it
    Box,
}

/// Every word of `--view`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[allow(missing_docs, reason = "the names say it")]
pub enum ViewWord {
    Anterior,
    Posterior,
    Left,
    Right,
    Superior,
    Inferior,
    /// The anterior side; of a piece of the Earth the south
    Front,
    /// The other side than front
    Back,
    /// Superior
    Top,
    /// Inferior
    Bottom,
}

impl ViewWord {
    /// The word itself.
    pub fn name(self) -> &'static str {
        match self {
            Self::Anterior => "anterior",
            Self::Posterior => "posterior",
            Self::Left => "left",
            Self::Right => "right",
            Self::Superior => "superior",
            Self::Inferior => "inferior",
            Self::Front => "front",
            Self::Back => "back",
            Self::Top => "top",
            Self::Bottom => "bottom",
        }
    }

    fn view(self, is_earth: bool) -> View {
        match self {
            // On a map the north is away.
            Self::Front if is_earth => View::Posterior,
            Self::Back if is_earth => View::Anterior,
            Self::Anterior | Self::Front => View::Anterior,
            Self::Posterior | Self::Back => View::Posterior,
            Self::Left => View::Left,
            Self::Right => View::Right,
            Self::Superior | Self::Top => View::Superior,
            Self::Inferior | Self::Bottom => View::Inferior,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{BoundingSphere, Projection};

    const BOUNDS: BoundingSphere = BoundingSphere {
        center: DVec3::new(10.0, 20.0, 30.0),
        radius: 5.0,
    };

    const SUBJECT: Subject = Subject {
        bounds: BOUNDS,
        half_axes: [DVec3::X, DVec3::Y, DVec3::Z],
        smallest_spacing: 1.0,
        is_earth: false,
    };

    fn camera(change: impl FnOnce(&mut CameraFlags)) -> Camera {
        let mut flags = CameraFlags::default();
        change(&mut flags);
        flags.camera(&SUBJECT, [1024, 768]).expect("a camera")
    }

    #[test]
    fn without_a_flag_the_whole_volume_is_seen_from_three_sides() {
        let found = camera(|_| {});
        // 5 / sin(15 degrees) = 19.318516525781366 from the middle, at azimuth 60 and elevation 15: times
        // (cos 15 cos 60, cos 15 sin 60, sin 15) = (0.48296291, 0.83651630, 0.25881905).
        let wanted = BOUNDS.center + DVec3::new(9.330_127_02, 16.160_254_04, 5.0);
        assert!((found.eye - wanted).length() < 1e-7, "{found:?}");
        assert_eq!(found.target, BOUNDS.center);
        assert_eq!(
            found.projection,
            Projection::Perspective { fov_degrees: 30.0 }
        );
    }

    #[test]
    fn azimuth_alone_leaves_the_elevation_at_zero() {
        let found = camera(|f| f.azimuth = Some(180.0));
        assert!(found.eye.x < 0.0 && found.eye.z == 30.0, "{found:?}");
        assert_eq!(found, camera(|f| f.view = Some(ViewWord::Left)));
    }

    #[test]
    fn an_orthographic_eye_stands_two_radii_off_and_the_height_fits() {
        let found = camera(|f| {
            f.projection = Some(ProjectionWord::Orthographic);
            f.view = Some(ViewWord::Anterior);
        });
        assert!((found.eye.y - 30.0).abs() < 1e-12, "{found:?}");
        assert_eq!(
            found.projection,
            Projection::Orthographic { view_height: 10.0 }
        );
    }

    #[test]
    fn zoom_applies_to_an_explicit_eye_too() {
        let found = camera(|f| {
            f.eye = Some(Numbers([10.0, 20.0, 99.0]));
            f.zoom = Some(2.0);
        });
        assert_eq!(found.zoom, 2.0);
        assert_eq!(found.eye, DVec3::new(10.0, 20.0, 99.0));
        // Straight down: +z cannot be up.
        assert_eq!(found.up, DVec3::Y);
    }

    #[test]
    fn a_camera_inside_its_own_target_is_a_usage_error() {
        let flags = CameraFlags {
            eye: Some(Numbers([10.0, 20.0, 30.0])),
            ..CameraFlags::default()
        };
        let error = flags.camera(&SUBJECT, [8, 8]).expect_err("refused");
        assert_eq!(error.exit_code(), 2);
        assert!(error.to_string().contains("same point"), "{error}");
    }

    #[test]
    fn a_stronger_eye_takes_the_place_of_a_view() {
        let mut weak = CameraFlags {
            view: Some(ViewWord::Left),
            roll: Some(5.0),
            zoom: Some(2.0),
            ..CameraFlags::default()
        };
        let strong = CameraFlags {
            eye: Some(Numbers([0.0; 3])),
            ..CameraFlags::default()
        };
        weak.give_way_to(&strong);
        let wanted = CameraFlags {
            zoom: Some(2.0),
            ..CameraFlags::default()
        };
        assert_eq!(weak, wanted);
    }

    #[test]
    fn a_stronger_azimuth_keeps_the_elevation() {
        let mut weak = CameraFlags {
            azimuth: Some(1.0),
            elevation: Some(2.0),
            ..CameraFlags::default()
        };
        let strong = CameraFlags {
            azimuth: Some(3.0),
            ..CameraFlags::default()
        };
        weak.give_way_to(&strong);
        assert_eq!(weak.elevation, Some(2.0));
        assert_eq!(weak.view, None);
    }
}
