//! Relations between pictures: no answer is known, and two of them must agree.
//!
//! | relation | allowed |
//! |---|---|
//! | the same picture twice | nothing |
//! | empty space skipped and not | nothing |
//! | colours of the function permuted, and the picture's | nothing |
//! | front to back and back to front | roundings of the blends |
//! | view-aligned slices and rays on their lattice | roundings of both |
//! | the volume mirrored along an axis, and the world with it | roundings of both |

use super::ground::{self, PLACEMENTS, PROJECTIONS, Placement};
use crate::conformance::case::{Case, Profile, Stop};
use crate::conformance::measurement::{Bound, Measurement, Pictures};
use crate::conformance::oracle::Shot;
use crate::conformance::stand::Stand;
use crate::picture::Picture;
use crate::technique::{Filter, Mode, Order, Settings};
use crate::transfer::TransferFunction;
use crate::volume::{Rescale, Volume, Voxels};
use glam::{DAffine3, DVec3, dvec3};

/// Half a unit in the last place of an f32 at 1.
const U: f64 = 1.0 / (1u32 << 24) as f64;

/// Every relation for every placement and projection that has it.
pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for placement in PLACEMENTS {
        for projection in PROJECTIONS {
            for (word, relation) in RELATIONS {
                if !relation.is_for(placement) {
                    continue;
                }
                for (mode_word, mode) in [("composite", Mode::Composite), ("xray", Mode::Xray)] {
                    let Some(of) = placement.word_in(mode) else {
                        continue;
                    };
                    if !relation.has(mode) {
                        continue;
                    }
                    let name = format!("relation.{word}.{of}.{mode_word}.{}", projection.0);
                    let is_perspective = projection.1;
                    let mut case = Case::new(name, move |stand| {
                        relation.measure(stand, placement, mode, is_perspective)
                    });
                    case.needs = ground::needs(placement, crate::volume::VoxelType::F32, false);
                    if mode == Mode::Xray && is_perspective {
                        case.profile = Profile::Full;
                    }
                    cases.push(case);
                }
            }
        }
    }
    cases
}

const RELATIONS: [(&str, Relation); 6] = [
    ("repeated", Relation::Repeated),
    ("skipped", Relation::Skipped),
    ("permuted_colors", Relation::PermutedColors),
    ("other_order", Relation::OtherOrder),
    ("rays_on_planes", Relation::RaysOnPlanes),
    ("mirrored", Relation::Mirrored),
];

#[derive(Clone, Copy, Debug, PartialEq)]
enum Relation {
    Repeated,
    Skipped,
    PermutedColors,
    OtherOrder,
    RaysOnPlanes,
    Mirrored,
}

impl Relation {
    fn is_for(self, placement: Placement) -> bool {
        match self {
            Self::OtherOrder => placement.is_slicer() && placement.order == Order::BackToFront,
            Self::RaysOnPlanes => placement.word == "slices_3d.over",
            // Samples would lie elsewhere, but for planes through the middle.
            Self::Mirrored => placement.word != "raycast.ray",
            _ => true,
        }
    }

    fn has(self, mode: Mode) -> bool {
        match self {
            Self::Repeated | Self::Skipped | Self::RaysOnPlanes => true,
            Self::PermutedColors | Self::OtherOrder | Self::Mirrored => mode == Mode::Composite,
        }
    }

    fn measure(
        self,
        stand: &mut Stand,
        placement: Placement,
        mode: Mode,
        is_perspective: bool,
    ) -> Result<Measurement, Stop> {
        let shot = ground::shot(placement, mode, (Filter::Linear, false), is_perspective);
        let shot = shot.with(|settings| settings.crop = None);
        let function = ground::ramps();
        let volume = volume_of(&shot, |p| ground::waves(p));
        let one = |stand: &mut Stand, shot: &Shot, volume: &Volume, function: &TransferFunction| {
            stand.render(&shot.scene(volume, Some(function)), &[])
        };
        let first = one(stand, &shot, &volume, &function)?;
        let with = |change: fn(&mut Settings)| shot.with(change);
        let second = match self {
            Self::Repeated => one(stand, &shot, &volume, &function)?,
            Self::Skipped => one(stand, &with(|s| s.skip = !s.skip), &volume, &function)?,
            Self::PermutedColors => {
                let mut permuted = function.clone();
                permuted
                    .color
                    .iter_mut()
                    .for_each(|point| point.srgb.rotate_left(1));
                let mut picture = one(stand, &shot, &volume, &permuted)?;
                picture
                    .pixels
                    .iter_mut()
                    .for_each(|pixel| pixel[..3].rotate_right(1));
                picture
            }
            Self::OtherOrder => {
                let other = with(|s| s.order = Order::FrontToBack);
                one(stand, &other, &volume, &function)?
            }
            Self::RaysOnPlanes => {
                let rays = with(|s| {
                    s.technique = crate::technique::Technique::Raycast;
                    s.lattice = crate::technique::Lattice::Planes;
                });
                one(stand, &rays, &volume, &function)?
            }
            Self::Mirrored => {
                // Voxel i of the one is voxel n - 1 - i of the other, at the same place in the world.
                let n = f64::from(shot.grid.dims[0]);
                let mirror = DAffine3::from_scale(dvec3(-1.0, 1.0, 1.0))
                    * DAffine3::from_translation(dvec3(-n, 0.0, 0.0));
                let mut mirrored = shot.clone();
                mirrored.grid.world_from_voxel = shot.grid.world_from_voxel * mirror;
                let field = |p: DVec3| ground::waves(dvec3(n - p.x, p.y, p.z));
                let volume = volume_of(&mirrored, field);
                one(stand, &mirrored, &volume, &function)?
            }
        };
        Ok(self.compare(&shot, &first, &second))
    }

    fn compare(self, shot: &Shot, first: &Picture, second: &Picture) -> Measurement {
        let is_exact = matches!(self, Self::Repeated | Self::Skipped | Self::PermutedColors);
        // Segments that a ray of this picture can have at most.
        let segments = shot.grid.diagonal() / shot.grid.smallest_spacing() * 1.5;
        let (bound, allowed) = match is_exact {
            true => (
                Bound::new(
                    "same-bytes",
                    "the same operations on the same numbers: no bit differs",
                ),
                0.0,
            ),
            false => {
                let slips = slips(shot);
                let text = "u = 2^-24, N segments at most. Each blend and each sum rounds thrice on either side (12 N u together); \
each place is off by 8 u of the sum of sizes of what it is made of, its value by the slopes of the field (at most 0.26 a voxel on \
an axis), its extinction by the steepest slope of the function over 1 - 0.4, log by 2^-21 and exp by (3 + 2x) 2^-23: seen by at \
most all of the light, on both sides, times the longest segment; sums grow with the largest value and the length.";
                let scale = if shot.settings.mode == Mode::Xray {
                    2.0 * segments
                } else {
                    2.0
                };
                (
                    Bound::new("two-ways", text)
                        .with("segments", segments)
                        .with("slip_per_segment", slips),
                    scale * segments * (12.0 * U + slips),
                )
            }
        };
        let mut measurement = Measurement::new(bound, 1000);
        for (i, pixel) in shot.pixels().enumerate() {
            // Where a ray meets an end of the domain at a sample, either may have it.
            let hangs = !is_exact
                && (shot.chord(pixel).is_some_and(|chord| chord.hangs)
                    || shot.chord(pixel).is_none() != (first.pixels[i][3] == 0.0));
            if hangs {
                measurement.leave_out();
                continue;
            }
            for c in 0..4 {
                let [wanted, found] = [first, second].map(|p| f64::from(p.pixels[i][c]));
                measurement.take(
                    || format!("channel {c} of pixel {pixel:?}"),
                    wanted,
                    found,
                    allowed,
                );
            }
        }
        let drawn = first.pixels.iter().filter(|pixel| pixel[3] > 0.01).count();
        measurement.hold(|| "pixels that are drawn".into(), drawn > 100);
        measurement.pictures = Some(Pictures {
            width: shot.extent[0],
            expected: first.pixels.clone(),
            found: second.pixels.clone(),
        });
        measurement
    }
}

/// What one segment may be off by on one side.
fn slips(shot: &Shot) -> f64 {
    let size = |k: usize| {
        let voxel = shot.grid.world_from_voxel.inverse();
        let m = voxel.matrix3.transpose();
        let reach = shot.camera.eye.distance(shot.grid.center()) + shot.grid.diagonal();
        8.0 * U * (2.0 * m.col(k).abs().element_sum() * reach + f64::from(shot.grid.dims[k]))
    };
    let moved = (0..3).map(size).fold(0.0, f64::max);
    let value = 3.0 * 0.26 * moved + 24.0 * U;
    // 0.4 - 0.15 over 0.3 is the steepest rise of opacity, 0.6 over 0.5 of a colour.
    let extinction = (0.25 / 0.3 * value + 4.0 * U) / 0.6 + 1.0 / f64::from(1u32 << 21);
    extinction * 2.0 + 1.2 * value + 5.0 * 2.0 * U
}

fn volume_of(shot: &Shot, field: impl Fn(DVec3) -> f64) -> Volume {
    let [nx, ny, nz] = shot.grid.dims;
    let at = |x: u32, y: u32, z: u32| field(dvec3(x.into(), y.into(), z.into()) + 0.5) as f32;
    let voxels = (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| (x, y, z))));
    let values: Vec<f32> = voxels.map(|(x, y, z)| at(x, y, z)).collect();
    let affine = shot.grid.world_from_voxel;
    Volume::from_voxels(
        shot.grid.dims,
        affine,
        Voxels::F32(values),
        Rescale::default(),
        None,
    )
    .expect("as many voxels as the grid has")
}
