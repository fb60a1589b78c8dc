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
use crate::conformance::oracle::{Chord, Shot};
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
        let volume = volume_of(&shot, ground::waves);
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
        let bound = match is_exact {
            true => Bound::new(
                "same-bytes",
                "the same operations on the same numbers: no bit differs",
            ),
            false => Bound::new("two-ways", TWO_WAYS),
        };
        let mut measurement = Measurement::new(bound, 1000);
        for (i, pixel) in shot.pixels().enumerate() {
            let chord = shot.chord(pixel);
            // Where a ray meets an end of the domain at a sample, either may have it.
            let hangs = chord.as_ref().is_some_and(|chord| chord.hangs);
            if !is_exact && hangs {
                measurement.leave_out();
                continue;
            }
            let allowed = match &chord {
                Some(chord) if !is_exact => apart(shot, chord),
                _ => 0.0,
            };
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

const TWO_WAYS: &str = "u = 2^-24, for each ray, on both sides: a sample's place is off by its blur (8 u of the sum of sizes of what it \
is made of), its value by the slopes of the field (0.21, 0.08 and 0.06 a voxel at most) times that and by 24 u, its opacity by 5/6, \
its extinction by that over (1 - 0.4) and 2^-21 for log, over the smallest spacing and times its length, its opacity by 5 x 2^-23 for \
exp and its colour by 1.2: seen by at most all of the light. Each blend and each sum rounds thrice: 12 u. X-rays: value times length.";

/// How far two ways of a pixel may be apart.
fn apart(shot: &Shot, chord: &Chord) -> f64 {
    let value = dvec3(0.21, 0.08, 0.06).dot(chord.blur_voxels) + 24.0 * U;
    let samples = chord.samples.len() as f64;
    if shot.settings.mode == Mode::Xray {
        // Opacity and colour of the integral: 5/6 and 1.2 a unit of value, and its sum of that size.
        let integral = chord.length() * (value + 6.0 * samples * U);
        return 2.0 * (5.0 / 6.0 + 1.2) * integral + 24.0 * U;
    }
    let opacity = 5.0 / 6.0 * value + 4.0 * U;
    let extinction = opacity / 0.6 + 1.0 / f64::from(1u32 << 21);
    let depth = extinction * chord.length() / shot.grid.smallest_spacing();
    2.0 * (depth + samples * (12.0 + 10.0) * U + 1.2 * value)
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
