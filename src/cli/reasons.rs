//! Why a picture is empty: nobody is left alone with a blank one.

use super::flags::Classification;
use crate::{
    camera::Camera,
    figure::short,
    picture::Picture,
    technique::{Filter, Mode, Settings},
    transfer::{Absorption, Points, TransferFunction, classify_by_points},
    volume::Volume,
};
use glam::{DMat3, DVec3};
use std::fmt;

/// Nothing of the volume is seen in a picture.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Unseen {
    /// Nor anything else.
    pub is_empty: bool,
    pub why: String,
}

impl fmt::Display for Unseen {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = match self.is_empty {
            true => "the picture is empty",
            false => "nothing of the volume is seen",
        };
        write!(f, "{what}: {}", self.why)
    }
}

/// What there may be in a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shows {
    /// The volume.
    Volume,
    /// The volume and lines, a map or spheres.
    VolumeAndOthers,
    /// Lines, a map or spheres, and the volume is hidden.
    Others,
}

impl Shows {
    /// Of a picture with or without lines, a map or spheres.
    pub fn of(has_others: bool, hides_volume: bool) -> Self {
        match (has_others, hides_volume) {
            (_, true) => Self::Others,
            (true, false) => Self::VolumeAndOthers,
            (false, false) => Self::Volume,
        }
    }
}

/// Why nothing of the volume is seen in `picture`, where that is so. Where others are seen too, pixels do not tell, and it is
/// so where values and places of the volume leave no doubt; where it is hidden, nothing is said but of an empty picture.
pub fn why_empty(
    picture: &Picture,
    shows: Shows,
    volume: &Volume,
    classification: &Classification,
    camera: &Camera,
    settings: &Settings,
) -> Option<Unseen> {
    let is_empty = picture.pixels.iter().all(|pixel| pixel[3] == 0.0);
    let is_certain = || match (classification, seen_of(picture, volume, camera, settings)) {
        (_, Seen::Nothing | Seen::Clipped) => true,
        _ if settings.splat.of_points || settings.field.is_some() => false,
        _ if settings.mode == Mode::Iso => meets_no_level(settings, volume),
        (Classification::Function(function), _) => covers_nothing(settings, function, volume),
        (Classification::RangeOfPicture, _) => false,
    };
    if shows == Shows::Others {
        let why = "no line, map or point is seen, and the volume is not drawn".to_owned();
        return is_empty.then_some(Unseen { is_empty, why });
    }
    let has_others = shows == Shows::VolumeAndOthers;
    let is_unseen = is_empty || has_others && (holds_no_data(volume) || is_certain());
    is_unseen.then(|| Unseen {
        is_empty,
        why: reason(picture, volume, classification, camera, settings),
    })
}

fn holds_no_data(volume: &Volume) -> bool {
    let validity = volume.validity.as_deref().unwrap_or(&[1]);
    !validity.is_empty() && validity.iter().all(|&valid| valid == 0)
}

/// True where no level lies between the extremes of the values, nor between those that filters make of them.
fn meets_no_level(settings: &Settings, volume: &Volume) -> bool {
    let [low, high] = volume.value_range;
    let is_between = matches!(
        settings.filter,
        Filter::Nearest | Filter::Linear | Filter::QuadraticSmooth | Filter::CubicSmooth
    );
    let mut levels = settings.per_mode.levels.iter();
    is_between && levels.all(|level| !(low..=high).contains(&level.value))
}

fn reason(
    picture: &Picture,
    volume: &Volume,
    classification: &Classification,
    camera: &Camera,
    settings: &Settings,
) -> String {
    if holds_no_data(volume) {
        return "all voxels of the volume hold no data".to_owned();
    }
    let seen = seen_of(picture, volume, camera, settings);
    let [low, high] = volume.value_range.map(short);
    let unit = volume.unit.as_ref().map(|unit| format!(" {unit}"));
    let values = format!(
        "values run from {low} to {high}{}",
        unit.unwrap_or_default()
    );
    match (seen, classification) {
        (Seen::Nothing, _) => "the camera sees no volume".to_owned(),
        (Seen::Clipped, _) => {
            "everything that the camera sees is cut away by --crop or --clip".to_owned()
        }
        (Seen::Volume, _) if settings.splat.of_points || settings.field.is_some() => {
            format!(
                "no point that is left is seen, or the transfer function covers none of their values; {values}"
            )
        }
        (Seen::Volume, _) if settings.mode == Mode::Iso => {
            let levels = settings.per_mode.levels.iter();
            let levels: Vec<String> = levels.map(|level| short(level.value)).collect();
            format!("no ray meets the level {}; {values}", levels.join(" or "))
        }
        (Seen::Volume, Classification::Function(function))
            if covers_nothing(settings, function, volume) =>
        {
            format!("the transfer function covers no value of this volume; {values}")
        }
        (Seen::Volume, _) => {
            "no sample of a ray meets a value that the transfer function covers".to_owned()
        }
    }
}

/// How far the rays of a picture get.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Seen {
    /// All miss the grid box.
    Nothing,
    /// All that hit the grid box miss what crop and clip leave of it.
    Clipped,
    /// Some go through the domain.
    Volume,
}

fn seen_of(picture: &Picture, volume: &Volume, camera: &Camera, settings: &Settings) -> Seen {
    seen(volume, camera, settings, [picture.width, picture.height])
}

fn seen(volume: &Volume, camera: &Camera, settings: &Settings, extent: [u32; 2]) -> Seen {
    let box_slabs = slabs(
        volume,
        [DVec3::ZERO, DVec3::from(volume.dims.map(f64::from))],
    );
    let mut domain = box_slabs.clone();
    if let Some(crop) = settings.crop {
        domain.extend(slabs(volume, crop));
    }
    domain.extend(settings.clip_planes.iter().map(|plane| HalfSpace {
        normal: plane.normal,
        offset: plane.offset,
    }));
    let rays = camera.rays(extent);
    let pixels = (0..extent[1]).flat_map(|y| (0..extent[0]).map(move |x| (x, y)));
    let of_pixel = |(x, y)| {
        let (origin, direction) = rays.at(f64::from(x) + 0.5, f64::from(y) + 0.5);
        if hits(&domain, origin, direction) {
            Seen::Volume
        } else if hits(&box_slabs, origin, direction) {
            Seen::Clipped
        } else {
            Seen::Nothing
        }
    };
    pixels.map(of_pixel).max().unwrap_or(Seen::Nothing)
}

/// World points with `normal . x >= offset`.
#[derive(Clone, Debug)]
struct HalfSpace {
    normal: DVec3,
    offset: f64,
}

/// A box of voxel space as six half spaces of the world.
fn slabs(volume: &Volume, [min, max]: [DVec3; 2]) -> Vec<HalfSpace> {
    let affine = volume.world_from_voxel;
    let rows: DMat3 = affine.matrix3.inverse().transpose();
    (0..3)
        .flat_map(|k| {
            let row = rows.col(k);
            // Voxel coordinate k of a world point is row . (x - translation).
            let shift = row.dot(affine.translation);
            [
                HalfSpace {
                    normal: row,
                    offset: min[k] + shift,
                },
                HalfSpace {
                    normal: -row,
                    offset: -(max[k] + shift),
                },
            ]
        })
        .collect()
}

/// True where the ray from `origin` has a stretch of some length inside all half spaces.
fn hits(half_spaces: &[HalfSpace], origin: DVec3, direction: DVec3) -> bool {
    let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
    for HalfSpace { normal, offset } in half_spaces {
        let (height, slope) = (normal.dot(origin) - offset, normal.dot(direction));
        if slope == 0.0 {
            if height < 0.0 {
                return false;
            }
        } else if slope > 0.0 {
            enter = enter.max(-height / slope);
        } else {
            leave = leave.min(-height / slope);
        }
    }
    enter < leave
}

/// True where the function gives opacity to no value between the volume's extremes. An integral is no such
/// value.
fn covers_nothing(settings: &Settings, function: &TransferFunction, volume: &Volume) -> bool {
    let [low, high] = volume.value_range;
    let points = Points::new(function, Absorption::Opacity, settings.color_space);
    let inside = function.opacity.iter().map(|point| point.value);
    let inside = inside.filter(|value| (low..=high).contains(value));
    let opacity = |value| classify_by_points(&points, value)[3];
    settings.mode != Mode::Xray
        && !function.uses_gradient()
        && [low, high]
            .into_iter()
            .chain(inside)
            .all(|v| opacity(v) == 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        camera::Projection,
        technique::{ClipPlane, Level},
        transfer::{Classified, Window},
        volume::{Rescale, Voxels},
    };
    use glam::DAffine3;

    struct Case {
        volume: Volume,
        camera: Camera,
        settings: Settings,
        window: [f64; 2],
        alpha: f32,
        shows: Shows,
    }

    /// A cube of values 0 to 7 around (1, 1, 1), seen from the front, all of it grey.
    fn case() -> Case {
        Case {
            volume: Volume {
                dims: [2, 2, 2],
                world_from_voxel: DAffine3::IDENTITY,
                voxels: Voxels::U8((0..8).collect()),
                rescale: Rescale::default(),
                validity: None,
                hounsfield: false,
                unit: None,
                loss: Default::default(),
                value_range: [0.0, 7.0],
            },
            camera: Camera {
                eye: DVec3::new(1.0, 9.0, 1.0),
                target: DVec3::ONE,
                up: DVec3::Z,
                projection: Projection::Perspective { fov_degrees: 30.0 },
                zoom: 1.0,
            },
            settings: Settings::default(),
            window: [0.0, 7.0],
            alpha: 0.0,
            shows: Shows::Volume,
        }
    }

    fn surface(value: f64) -> Level {
        Level {
            value,
            srgb: [1.0; 3],
            opacity: 1.0,
        }
    }

    fn reason(case: &Case) -> String {
        let picture = Picture {
            width: 4,
            height: 4,
            pixels: vec![[case.alpha; 4]; 16],
            color_space: Default::default(),
            layers: Vec::new(),
        };
        let [low, high] = case.window;
        let window = Window::new(low, high).expect("a window");
        let function = Classification::Function(window.grey(Classified::Samples));
        why_empty(
            &picture,
            case.shows,
            &case.volume,
            &function,
            &case.camera,
            &case.settings,
        )
        .map(|unseen| unseen.to_string())
        .unwrap_or_default()
    }

    #[test]
    fn a_picture_that_shows_something_needs_no_reason() {
        assert_eq!(
            reason(&Case {
                alpha: 0.1,
                ..case()
            }),
            ""
        );
    }

    #[test]
    fn beside_lines_the_volume_counts_where_it_leaves_no_doubt() {
        let beside = || Case {
            alpha: 1.0,
            shows: Shows::VolumeAndOthers,
            ..case()
        };
        assert_eq!(reason(&beside()), "");
        let mut level = beside();
        level.settings.mode = Mode::Iso;
        level.settings.per_mode.levels = vec![surface(9.0)];
        let said = reason(&level);
        assert_eq!(
            said,
            "nothing of the volume is seen: no ray meets the level 9; values run from 0 to 7"
        );
        // What a filter may make of the values, and a level of them.
        level.settings.filter = Filter::Cubic;
        assert_eq!(reason(&level), "");
        level.settings.filter = Filter::Linear;
        level.settings.per_mode.levels.push(surface(3.0));
        assert_eq!(reason(&level), "");
        let beyond = Case {
            window: [100.0, 200.0],
            ..beside()
        };
        assert!(reason(&beyond).contains("covers no value of this"));
        let mut away = beside();
        away.camera.target = DVec3::new(1.0, 20.0, 1.0);
        assert!(reason(&away).contains("nothing of the volume is seen: the camera sees no volume"));
        let mut empty = beside();
        empty.volume.validity = Some(vec![0; 8]);
        assert!(reason(&empty).contains("no data"));
        // A hidden volume is no reason for anything.
        let hidden = |alpha| Case {
            alpha,
            shows: Shows::of(true, true),
            ..case()
        };
        assert_eq!(reason(&hidden(1.0)), "");
        assert!(reason(&hidden(0.0)).contains("no line, map or point is seen"));
    }

    #[test]
    fn a_camera_that_looks_away_is_the_reason() {
        let mut away = case();
        away.camera.target = DVec3::new(1.0, 20.0, 1.0);
        assert!(
            reason(&away).contains("camera sees no volume"),
            "{}",
            reason(&away)
        );
    }

    #[test]
    fn planes_and_crops_that_leave_nothing_are_the_reason() {
        let mut clipped = case();
        clipped.settings.clip_planes = vec![ClipPlane {
            normal: DVec3::X,
            offset: 2.5,
        }];
        assert!(
            reason(&clipped).contains("cut away"),
            "{}",
            reason(&clipped)
        );
        let mut cropped = case();
        cropped.settings.crop = Some([DVec3::splat(5.0), DVec3::splat(6.0)]);
        assert!(
            reason(&cropped).contains("cut away"),
            "{}",
            reason(&cropped)
        );
    }

    #[test]
    fn a_function_beyond_the_values_is_the_reason() {
        let beyond = Case {
            window: [100.0, 200.0],
            ..case()
        };
        assert!(
            reason(&beyond).contains("covers no value of this"),
            "{}",
            reason(&beyond)
        );
        // The values are covered, yet nothing of them is seen: not the fault of the function as a whole.
        assert!(
            reason(&case()).contains("no sample of a ray"),
            "{}",
            reason(&case())
        );
    }

    #[test]
    fn a_volume_without_data_is_the_reason() {
        let mut empty = case();
        empty.volume.validity = Some(vec![0; 8]);
        assert!(reason(&empty).contains("no data"), "{}", reason(&empty));
    }

    #[test]
    fn a_rotated_and_moved_grid_is_hit_where_it_lies() {
        let mut moved = case();
        moved.volume.world_from_voxel = DAffine3::from_translation(DVec3::new(100.0, 0.0, 0.0))
            * DAffine3::from_rotation_z(0.5);
        assert!(
            reason(&moved).contains("sees no volume"),
            "{}",
            reason(&moved)
        );
        moved.camera.target = moved.volume.world_from_voxel.transform_point3(DVec3::ONE);
        moved.camera.eye = moved.camera.target + DVec3::new(0.0, 6.0, 0.0);
        assert!(
            reason(&moved).contains("no sample of a ray"),
            "{}",
            reason(&moved)
        );
    }
}
