//! `--technique pathtrace`, path by path: shader and CPU reference draw the same numbers and make the same choices with them, but
//! where rounding decides.
//!
//! ```text
//! |found - f64| <= running error of the path      where no choice of any of the pixel's paths lies inside of its error
//! ```
//!
//! All choices are comparisons (is a collision real, is it one with a surface, which lobe, does roulette end the path), so the
//! running error analysis knows which pixels a rounding may turn: these are left out, and all others are held to the worst case
//! of their paths. Where each bounce makes errors ten times as large (normals are differences of values), paths are few and short.
//! Solid surfaces are not here: a path begins a thousandth of a voxel before them, which is less than the worst case of where it is.

use super::super::ground::{self, PATHS};
use super::super::reference;
use super::{lamp, lit, shot};
use crate::conformance::case::{Case, Stop};
use crate::conformance::measurement::Measurement;
use crate::conformance::test_bed::TestBed;
use crate::technique::pathtrace::{LampShape, Lens, PathTracing, SkyPicture};
use crate::technique::{ClipPlane, Filter};
use crate::transfer::{
    GradientTransfer, MediumPoint, MediumTransfer, OpacityPoint, Phase, TransferFunction,
};
use glam::{DVec3, dvec3};

/// What paths meet, and what light there is.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Look {
    /// Light of two directions, scattered by two lobes, as often as it is; more paths than one pass has.
    TwoLobes,
    Isotropic,
    /// Once, to all sides as small particles do.
    RayleighOnce,
    /// Matter shines in its colours.
    NoBounce,
    /// Lambert's surfaces in matter, under an even sky.
    Surfaces,
    /// A few under a coat, which makes errors of normals a thousand times as large, through a lens, by lights that look wide.
    Coated,
    /// A picture of a sky, which the eye sees.
    Sky,
    /// A ball and a disc that shine.
    Lamps,
    /// Three extinctions, and light of its own.
    Medium,
    /// Cut by two planes, which let light in.
    Cut,
    /// More opaque where it is steep.
    Steep,
}

impl Look {
    const ALL: [(Self, &str); 11] = [
        (Self::TwoLobes, "two_lobes"),
        (Self::Isotropic, "isotropic"),
        (Self::RayleighOnce, "rayleigh_once"),
        (Self::NoBounce, "no_bounce"),
        (Self::Surfaces, "surfaces"),
        (Self::Coated, "coated"),
        (Self::Sky, "sky"),
        (Self::Lamps, "lamps"),
        (Self::Medium, "medium"),
        (Self::Cut, "cut"),
        (Self::Steep, "steep"),
    ];

    fn path(self) -> PathTracing {
        match self {
            Self::TwoLobes => PathTracing {
                samples: 6,
                ..lit()
            },
            Self::Medium | Self::Cut | Self::Steep => PathTracing {
                samples: 2,
                bounces: Some(2),
                ..lit()
            },
            Self::Isotropic => PathTracing {
                phase: Phase::Isotropic,
                ..lit()
            },
            Self::RayleighOnce => PathTracing {
                bounces: Some(1),
                phase: Phase::Rayleigh,
                ..lit()
            },
            Self::NoBounce => PathTracing {
                bounces: Some(0),
                ..lit()
            },
            Self::Surfaces => PathTracing {
                samples: 2,
                bounces: Some(2),
                surface: 4.0,
                sky: [0.2, 0.3, 0.5],
                ..lit()
            },
            Self::Coated => PathTracing {
                samples: 1,
                bounces: Some(1),
                sky: [0.2, 0.3, 0.5],
                surface: 1.5,
                f0: 0.3,
                roughness: 0.8,
                light_size_degrees: 20.0,
                lens: Some(Lens {
                    radius: 1.0,
                    focus: None,
                }),
                ..lit()
            },
            Self::Sky => PathTracing {
                lights: Vec::new(),
                sky: [1.0, 0.9, 0.8],
                sky_picture: Some(sky()),
                sky_turn_degrees: 35.0,
                shows_sky: true,
                ..lit()
            },
            Self::Lamps => PathTracing {
                lights: Vec::new(),
                lamps: vec![
                    lamp(
                        dvec3(14.0, 19.0, 9.0),
                        LampShape::Sphere { radius: Some(4.0) },
                        [1.0, 0.8, 0.6],
                    ),
                    lamp(
                        dvec3(-3.0, 2.0, 15.0),
                        LampShape::Disc { radius: 6.0 },
                        [0.4, 0.8, 1.0],
                    ),
                ],
                ..lit()
            },
        }
    }
}

/// Eleven of the baseline, none beyond.
pub fn cases() -> Vec<Case> {
    let case = |(look, word): (Look, &str)| {
        let name = format!("reference.pathtrace.composite.{word}.linear_fetch.perspective");
        Case::new(name, move |bed| measure(bed, look))
    };
    Look::ALL.into_iter().map(case).collect()
}

fn measure(bed: &mut TestBed, look: Look) -> Result<Measurement, Stop> {
    let shot = shot(PATHS, Filter::Linear).with(|settings| {
        settings.path = look.path();
        // The reference has one majorant: cells change which numbers are drawn.
        settings.skip = false;
        if look == Look::Cut {
            settings.clip_planes = cuts();
        }
    });
    let volume = reference::volume(&shot, false);
    let function = match look {
        Look::Medium => medium(),
        Look::Steep => steep(),
        _ => ground::ramps(),
    };
    reference::of_scene(bed, &shot, &shot.scene(&volume, Some(&function)))
}

/// Little light, and a sun, which reaches half way into the texels around.
fn sky() -> SkyPicture {
    let pixel = |i: usize| match i {
        10 => [20.0, 15.0, 10.0],
        _ => [0.2, 0.1 + 0.05 * (i % 7) as f32, 0.3],
    };
    // No row ends where a cosine is put together of two pieces, on either of which a division may end.
    let pixels: Vec<_> = (0..72).map(pixel).collect();
    SkyPicture::new([12, 6], &pixels).expect("twice as wide as high, with light in it")
}

/// Through the middle of the volume, aslant to each other.
fn cuts() -> Vec<ClipPlane> {
    let center = ground::grid().center();
    let plane = |normal: DVec3, by: f64| ClipPlane {
        normal,
        offset: normal.dot(center) + by,
    };
    vec![
        plane(dvec3(1.0, 0.4, 0.3), -2.0),
        plane(dvec3(-0.2, 1.0, -0.3), -3.0),
    ]
}

/// The ramps, all of it where values rise by a third of their range in a voxel.
fn steep() -> TransferFunction {
    let point = |value, opacity| OpacityPoint { value, opacity };
    TransferFunction {
        gradient_transfer: Some(GradientTransfer {
            steepest: Some(0.3),
            share: vec![point(0.0, 0.3), point(1.0, 1.0)],
            widgets: Vec::new(),
        }),
        ..ground::ramps()
    }
}

/// Three extinctions, two albedos and light of its own, beside the colours of the ramps.
fn medium() -> TransferFunction {
    let point = |value, linear| MediumPoint { value, linear };
    let function = TransferFunction {
        medium: Some(Box::new(MediumTransfer {
            albedo: vec![point(0.2, [0.9, 0.7, 0.4]), point(0.8, [0.3, 0.9, 0.8])],
            emission: vec![point(0.3, [0.0; 3]), point(0.8, [0.05, 0.02, 0.1])],
            ..MediumTransfer::default()
        })),
        ..ground::ramps()
    };
    function.with_extinction(vec![
        point(0.2, [0.0; 3]),
        point(0.5, [0.3, 0.2, 0.1]),
        point(0.9, [0.1, 0.2, 0.4]),
    ])
}
