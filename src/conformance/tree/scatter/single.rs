//! `--scattering single`: every way of light to a sample, on both lattices.

use super::super::ground::{self, PLACEMENTS, Placement, RAYS};
use super::super::reference;
use super::{lamp, light, lit, shot};
use crate::conformance::case::{Case, Profile};
use crate::technique::pathtrace::{LampShape, PathTracing};
use crate::technique::{Filter, SingleScattering};
use crate::transfer::Phase;
use glam::{DVec3, dvec3};

/// Rays on planes.
const PLANES: Placement = PLACEMENTS[1];

/// How light comes to a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Look {
    /// Nothing is in its way.
    Open,
    /// Through the light volume.
    Volume,
    /// Followed from the sample on.
    March,
    /// From all around, through the light volume.
    Sky,
    /// From a point before what is seen of the volume, followed.
    Point,
}

impl Look {
    const ALL: [(Self, &str); 5] = [
        (Self::Open, "open"),
        (Self::Volume, "volume"),
        (Self::March, "march"),
        (Self::Sky, "sky"),
        (Self::Point, "point"),
    ];

    fn way(self) -> SingleScattering {
        match self {
            Self::Open => SingleScattering::Open,
            Self::Volume | Self::Sky => SingleScattering::Volume,
            Self::March | Self::Point => SingleScattering::March,
        }
    }

    fn light(self) -> PathTracing {
        match self {
            Self::Open | Self::Volume => lit(),
            Self::March => PathTracing {
                lights: vec![light(dvec3(0.3, -1.0, 0.4))],
                ..lit()
            },
            Self::Sky => PathTracing {
                phase: Phase::Isotropic,
                sky: [0.2, 0.3, 0.5],
                lights: vec![light(dvec3(1.0, 2.0, 0.5))],
                ..lit()
            },
            Self::Point => PathTracing {
                lights: Vec::new(),
                lamps: vec![lamp(
                    dvec3(9.0, 5.0, 6.0),
                    LampShape::Sphere { radius: None },
                    [1.0, 0.9, 0.8],
                )],
                ..lit()
            },
        }
    }
}

/// All ways, by rays; two of them on planes, one by voxels.
pub fn cases() -> Vec<Case> {
    let linear = ("linear_fetch", Filter::Linear);
    let mut cases = Vec::new();
    let mut add = |placement: Placement, look: (Look, &str), filter: (&str, Filter)| {
        let name = format!(
            "reference.{}.composite.scattered_{}.{}.perspective",
            placement.word, look.1, filter.0
        );
        let mut case = Case::new(name, move |bed| {
            let shot = shot(placement, filter.1).with(|settings| {
                settings.single_scattering = Some(look.0.way());
                settings.path = look.0.light();
                // Of each sample a way to a light is as uncertain as it is long: of four cells in depth.
                if look.0.way() == SingleScattering::March {
                    settings.crop = Some(ground::thin([DVec3::ZERO, ground::grid().far_corner()]));
                }
            });
            reference::of_shot(bed, &shot, look.0 == Look::March)
        });
        case.profile = match placement == RAYS && filter == linear {
            true => Profile::Baseline,
            false => Profile::Full,
        };
        cases.push(case);
    };
    for look in Look::ALL {
        add(RAYS, look, linear);
    }
    add(PLANES, Look::ALL[1], linear);
    add(PLANES, Look::ALL[2], linear);
    add(RAYS, Look::ALL[2], ("nearest", Filter::Nearest));
    cases
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every way that light comes by is asked of every device.
    #[test]
    fn the_baseline_has_every_way_of_light() {
        let of_baseline = cases();
        let of_baseline = of_baseline
            .iter()
            .filter(|c| c.profile == Profile::Baseline);
        assert_eq!(of_baseline.count(), Look::ALL.len());
    }
}
