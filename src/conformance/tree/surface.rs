//! A16: surfaces where a line and a quadric say they are, with the light of A18 on the plane.
//!
//! ```text
//! plane   f(o + t d) = level                  of a linear field, which every filter gives back
//! ball    |o + t d - c| = R                   of |p - c| - R at voxel centres, between which it is interpolated
//! ```

use super::drawn::layer;
use super::ground::{self, FILTERS, PLACEMENTS, PROJECTIONS, TYPES};
use crate::conformance::case::{Case, Profile, Stop};
use crate::conformance::measurement::{Bound, Measurement, Pictures};
use crate::conformance::oracle::{Chord, Kind, Numbers, PictureCase};
use crate::conformance::test_bed::TestBed;
use crate::picture::LayerKind;
use crate::technique::{Filter, Level, Mode, Shading};
use crate::volume::VoxelType;
use glam::{DMat3, DVec3};

/// Half a unit in the last place of an f32 at 1.
const U: f64 = 1.0 / (1u32 << 24) as f64;

const PLANE: &str = "u = 2^-24. The value at a place is off by e: the steps of the field times the blur of the place (8 u of the sum \
of sizes of what it is made of), and taps x 3 u of 1.25. A crossing is where the value as computed is the level, so at most 4 e over \
the slope along the ray away (the value at the crossing, at both ends of what is left of the segment, and the level), and 8 u of t. \
A level nearer than e to the value at an end of the ray may or may not be met: such pixels are left out. Light: each difference of \
two taps is off by 2 e' (e' without the place's own blur, which both have), which over the gradient and with the condition of \
the affine turns the normal by n: the colour moves by (diffuse + shininess specular) 2 n, by shininess 2^-21 for log2 and by 64 u.";

const BALL: &str = "Trilinear interpolation of a convex field lies above it, by no more than an eighth of the sum of its second \
derivatives along the axes: e = 2 / (8 (R - 1.8)), the Laplacian of the distance over the cells that the surface passes. So the \
crossing lies between the balls of radius R and R - e, both met in closed form, and the blur of the ray (8 u of sizes, u = 2^-24) \
beyond over the slope. Rays that are in the smaller ball for less than a step may miss it, and those that pass between both: they \
are left out. The last 2^-10 of a step is a straight line: that much more.";

/// All of them.
pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for (projection, is_perspective) in PROJECTIONS {
        for (word, filter, by_sampler) in FILTERS {
            if by_sampler || filter == Filter::Nearest {
                continue;
            }
            for (of_type, stored) in TYPES {
                for (look, is_lit) in [("plane", false), ("lit_plane", true)] {
                    let name = format!("raycast.ray.iso.{look}.{word}.{of_type}.{projection}");
                    let mut case = Case::new(name, move |bed| {
                        plane(bed, (filter, stored), is_lit, is_perspective)
                    });
                    let is_common = filter == Filter::Linear || stored == VoxelType::F32;
                    let is_in = is_common && is_lit == is_perspective;
                    case.profile = if is_in {
                        Profile::Baseline
                    } else {
                        Profile::Full
                    };
                    cases.push(case);
                }
            }
        }
        let name = format!("raycast.ray.iso.ball.linear_fetch.f32.{projection}");
        cases.push(Case::new(name, move |bed| ball(bed, is_perspective)));
    }
    cases
}

fn level(value: f64, srgb: [f64; 3], opacity: f64) -> Level {
    Level {
        value,
        srgb,
        opacity,
    }
}

/// A crossing, where nothing depends on rounding.
struct Hit {
    t: f64,
    off: f64,
    level: Level,
}

/// Depth and colour of a ray, and what each is allowed: `None` where that depends on rounding.
type Answer = Option<(f64, f64, [f64; 4], f64)>;

fn plane(
    bed: &mut TestBed,
    (filter, stored): (Filter, VoxelType),
    is_lit: bool,
    is_perspective: bool,
) -> Result<Measurement, Stop> {
    let shot = ground::shot(PLACEMENTS[0], Mode::Iso, (filter, false), is_perspective);
    let shot = shot.with(|settings| {
        settings.shading = is_lit.then(Shading::default);
        settings.per_mode.levels = vec![
            level(0.72, [0.2, 0.8, 0.5], 0.5),
            level(0.5, [0.9, 0.3, 0.2], 0.4),
            level(0.58, [0.3, 0.4, 0.9], 1.0),
        ];
    });
    let field = Kind::Ramp.field();
    let volume = field.volume(&shot, stored);
    let of_filter = if filter == Filter::Linear { 8.0 } else { 64.0 } * 3.0 * U * 1.25;
    let to_world = shot.grid.world_from_voxel.matrix3;
    let of_voxels = field.slope();
    let normal = (to_world.inverse().transpose() * of_voxels).normalize();
    let turned = condition(to_world) * 2.0 * (of_filter + 50.0 * U * of_voxels.length())
        / of_voxels.length();
    let answer = |chord: &Chord| -> Answer {
        let off = field.steps().dot(chord.blur_voxels) + of_filter;
        let [f0, f1] = chord.ends.map(|t| field.value(chord.at(t)));
        let slope = of_voxels.dot(chord.direction);
        let mut hits = Vec::new();
        for level in &shot.settings.per_mode.levels {
            let [before, after] = [f0 - level.value, f1 - level.value];
            if before.abs() <= 2.0 * off || after.abs() <= 2.0 * off {
                return None;
            }
            if before * after < 0.0 {
                let t = chord.ends[0] - before / slope;
                let off = 4.0 * off / slope.abs() + 8.0 * U * t;
                hits.push(Hit {
                    t,
                    off,
                    level: *level,
                });
            }
        }
        hits.sort_by(|a, b| a.t.total_cmp(&b.t));
        let along = (to_world * chord.direction).normalize();
        let (mut color, mut left) = (DVec3::ZERO, 1.0);
        for hit in &hits {
            let own = DVec3::from_array(hit.level.srgb);
            let lit = match &shot.settings.shading {
                // The headlight: light, eye and what lies half way between are one.
                Some(s) => {
                    let facing = normal.dot(along).abs();
                    (s.ambient + s.diffuse * facing) * own + s.specular * facing.powf(s.shininess)
                }
                None => own,
            };
            color += left * hit.level.opacity * lit;
            left *= 1.0 - hit.level.opacity;
        }
        let of_light = shot.settings.shading.as_ref().map_or(0.0, |s| {
            (s.diffuse + s.shininess * s.specular) * 2.0 * turned
                + s.shininess / f64::from(1u32 << 21)
        });
        let first = hits.first();
        let t = first.map_or(f64::NAN, |hit| hit.t);
        let off = first.map_or(0.0, |hit| hit.off);
        Some((
            t,
            off,
            [color.x, color.y, color.z, 1.0 - left],
            of_light + 64.0 * U,
        ))
    };
    let bound = Bound::new("f32-crossing", PLANE);
    compare(bed, &shot, &volume, bound, answer)
}

/// How much a matrix may turn what is off, more than what is right.
fn condition(m: DMat3) -> f64 {
    let size = |m: DMat3| {
        let axes = [m.x_axis, m.y_axis, m.z_axis].map(DVec3::length_squared);
        axes.iter().sum::<f64>().sqrt()
    };
    size(m) * size(m.inverse())
}

fn ball(bed: &mut TestBed, is_perspective: bool) -> Result<Measurement, Stop> {
    let shot = ground::shot(
        PLACEMENTS[0],
        Mode::Iso,
        (Filter::Linear, false),
        is_perspective,
    );
    let color = [0.9, 0.6, 0.3];
    let shot = shot.with(|settings| {
        settings.crop = None;
        settings.per_mode.levels = vec![level(0.0, color, 1.0)];
    });
    let radius = 5.0;
    let middle = 0.5 * shot.grid.far_corner();
    let numbers = Numbers::of(&shot, |p| p.distance(middle) - radius);
    let bend = 2.0 / (8.0 * (radius - 1.8));
    let step = shot.view().step_world();
    let answer = |chord: &Chord| -> Answer {
        // In voxel space, where t counts world length all the same.
        let (o, d) = (chord.origin - middle, chord.direction);
        let (a, b) = (d.length_squared(), o.dot(d));
        let aside = (o.length_squared() - b * b / a).max(0.0).sqrt();
        let half = |radius: f64| ((radius * radius - aside * aside) / a).sqrt();
        let blur = chord.blur_voxels.length();
        if aside > radius + 2.0 * blur {
            return Some((f64::NAN, 0.0, [0.0; 4], 0.0));
        }
        let inner = radius - bend;
        if aside >= inner || 2.0 * half(inner) < step {
            return None;
        }
        let nearest = -b / a;
        let [near, far] = [nearest - half(radius), nearest - half(inner)];
        // How fast the distance falls where the smaller ball is met.
        let slope = (inner * inner - aside * aside).sqrt() / inner * a.sqrt();
        let off = 4.0 * (blur + 40.0 * U * radius) / slope + step / 1024.0;
        let [r, g, b] = color;
        let pixel = [r, g, b, 1.0];
        Some((0.5 * (near + far), off + 0.5 * (far - near), pixel, 8.0 * U))
    };
    let bound = Bound::new("interpolated-ball", BALL)
        .with("R", radius)
        .with("e", bend);
    compare(bed, &shot, &numbers.volume, bound, answer)
}

fn compare(
    bed: &mut TestBed,
    shot: &PictureCase,
    volume: &crate::volume::Volume,
    bound: Bound,
    answer: impl Fn(&Chord) -> Answer,
) -> Result<Measurement, Stop> {
    let scene = shot.scene(volume, None);
    let found = bed.render(&scene, &[LayerKind::Depth])?;
    let depths = layer(&found, LayerKind::Depth).ok_or(Stop::Suite("no depth".into()))?;
    let mut measurement = Measurement::new(bound, 1000);
    let mut expected = Vec::new();
    for (i, pixel) in shot.pixels().enumerate() {
        let chord = shot.chord(pixel);
        let hangs = chord.as_ref().is_some_and(|chord| chord.hangs);
        let nothing = Some((f64::NAN, 0.0, [0.0; 4], 0.0));
        let wanted = chord.map_or(nothing, |chord| answer(&chord));
        let Some((t, off, color, color_off)) = wanted.filter(|_| !hangs) else {
            measurement.leave_out(5);
            expected.push(found.pixels[i]);
            continue;
        };
        expected.push(color.map(|n| n as f32));
        measurement.take(
            || format!("depth of pixel {pixel:?}"),
            t,
            depths[i].into(),
            off,
        );
        for (c, color) in color.into_iter().enumerate() {
            let at = || format!("channel {c} of pixel {pixel:?}");
            measurement.take(at, color, found.pixels[i][c].into(), color_off);
        }
    }
    let drawn = found.pixels.iter().filter(|pixel| pixel[3] > 0.01).count();
    measurement.hold(|| "pixels that are drawn".into(), drawn > 40);
    measurement.pictures = Some(Pictures {
        width: shot.extent[0],
        expected,
        found: found.pixels,
    });
    Ok(measurement)
}
