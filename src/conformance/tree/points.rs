//! Splats of scattered points, against the same sums on the CPU in f64: points of many widths, points that pixels widen, an
//! eye among them, and clip planes.

use super::ground::{self, MODES, PROJECTIONS};
use super::reference;
use crate::camera::{Camera, Projection};
use crate::conformance::case::{Case, Profile, Stop};
use crate::conformance::measurement::Measurement;
use crate::conformance::oracle::PictureCase;
use crate::conformance::test_bed::TestBed;
use crate::picture::ColorSpace;
use crate::points::Points;
use crate::scene::{Beside, Scene};
use crate::technique::splat::Splat;
use crate::technique::{ClipPlane, Mode, Settings, Technique};
use glam::{DVec3, dvec3};

/// The points lie in a cube of this side.
const SIDE: f64 = 10.0;
const COUNT: u32 = 400;

/// What is seen of them.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Look {
    /// From a tenth of a pixel to a third of the cube wide.
    Cloud,
    /// All so small that pixels widen them.
    Small,
    /// From among them: some lie behind the eye.
    Among,
    /// Those on one side of a plane.
    Clipped,
}

impl Look {
    const ALL: [(Self, &str); 4] = [
        (Self::Cloud, "cloud"),
        (Self::Small, "small"),
        (Self::Among, "among"),
        (Self::Clipped, "clipped"),
    ];
}

/// The product of modes and looks.
pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for mode in MODES {
        for (look, word) in Look::ALL {
            for (projection, is_perspective) in PROJECTIONS {
                // Nothing is behind an eye that is everywhere.
                if look == Look::Among && !is_perspective {
                    continue;
                }
                let of_mode = ground::word_of(mode);
                let name = format!("splat.points.{of_mode}.{word}.{projection}");
                let mut case = Case::new(name, move |bed| measure(bed, mode, look, is_perspective));
                case.profile = match is_perspective {
                    true => Profile::Baseline,
                    false => Profile::Full,
                };
                cases.push(case);
            }
        }
    }
    cases
}

fn measure(
    bed: &mut TestBed,
    mode: Mode,
    look: Look,
    is_perspective: bool,
) -> Result<Measurement, Stop> {
    let points = points(look);
    let volume = points.binned();
    let mut function = ground::ramps();
    // Light comes through all of them: else what is left of it is known to no digit.
    function.reference_length = Some(match look {
        Look::Small => 3e-4,
        Look::Cloud | Look::Clipped | Look::Among => 8.0,
    });
    let settings = Settings {
        technique: Technique::Splat,
        mode,
        conformance: true,
        color_space: ColorSpace::Linear,
        splat: Splat::of_points(),
        clip_planes: match look {
            Look::Clipped => vec![plane()],
            Look::Cloud | Look::Small | Look::Among => Vec::new(),
        },
        ..Settings::default()
    };
    let shot = PictureCase {
        grid: volume.grid(),
        camera: camera(look, is_perspective),
        extent: [61, 47],
        settings,
    };
    let scene = Scene {
        beside: Beside::Points(&points),
        ..shot.scene(&volume, Some(&function))
    };
    reference::of_scene(bed, &shot, &scene)
}

fn camera(look: Look, is_perspective: bool) -> Camera {
    let (eye, fov_degrees) = match look {
        Look::Among => (dvec3(5.5, 4.0, 2.0), 95.0),
        Look::Cloud | Look::Small | Look::Clipped => (dvec3(17.0, -9.0, 12.0), 38.0),
    };
    Camera {
        eye,
        target: DVec3::splat(0.5 * SIDE),
        up: DVec3::Z,
        projection: match is_perspective {
            true => Projection::Perspective { fov_degrees },
            false => Projection::Orthographic { view_height: 13.0 },
        },
        zoom: 1.0,
    }
}

/// Through the middle, along no axis.
fn plane() -> ClipPlane {
    let normal = dvec3(0.6, -0.64, 0.48);
    ClipPlane {
        normal,
        offset: normal.dot(DVec3::splat(0.5 * SIDE)),
    }
}

/// Numbers without a pattern, the same each time.
fn points(look: Look) -> Points {
    let mut state = 88_172_645_u32;
    let mut unit = || {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        f64::from(state) / f64::from(u32::MAX)
    };
    let mut places = Vec::new();
    let [mut values, mut stds, mut weights] = [Vec::new(), Vec::new(), Vec::new()];
    for _ in 0..COUNT {
        places.push(SIDE * dvec3(unit(), unit(), unit()));
        values.push(unit() as f32);
        let wide = unit();
        stds.push(match look {
            Look::Small => (0.002 + 0.01 * wide) as f32,
            Look::Cloud | Look::Among | Look::Clipped => (0.03 * 100f64.powf(wide.powi(3))) as f32,
        });
        weights.push((0.2 + unit()) as f32);
    }
    Points::new(places, values, Some(stds), Some(weights)).expect("as many of each")
}
