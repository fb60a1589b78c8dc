//! The pictures of a relation, and how far they are apart.

use super::super::drawn::{WIDEST, derivation, errors, layer};
use super::super::ground::{self, Placement};
use super::Kind;
use crate::camera::Projection;
use crate::conformance::case::Stop;
use crate::conformance::measurement::{Bound, Measurement, Pictures};
use crate::conformance::oracle::{Numbers, PictureCase};
use crate::conformance::test_bed::TestBed;
use crate::gpu::Caps;
use crate::picture::{ColorSpace, LayerKind, Picture};
use crate::technique::pathtrace::PathTracing;
use crate::technique::{Filter, Lattice, Level, Light, Mode, Order, Shading, SkipBy};
use crate::transfer::{ColorPoint, OpacityPoint, Phase, TransferFunction};
use glam::{DAffine3, DVec3, dvec3};

const BOTH: &str = "Both pictures are roundings of the same numbers: they may be apart by the sum of what each may be off by. ";

/// A picture, and what each number of it may be off by.
struct Rough {
    pixels: Vec<[f64; 4]>,
    off: Vec<[f64; 4]>,
}

/// A shot, its numbers and its function.
#[derive(Clone)]
struct Sight {
    shot: PictureCase,
    numbers: Numbers,
    function: TransferFunction,
}

impl Sight {
    fn picture(&self, bed: &mut TestBed, layers: &[LayerKind]) -> Result<Picture, Stop> {
        let scene = self.shot.scene(&self.numbers.volume, Some(&self.function));
        bed.render(&scene, layers)
    }

    /// With its errors, where those count.
    fn rough(&self, bed: &mut TestBed) -> Result<Rough, Stop> {
        let scene = self.shot.scene(&self.numbers.volume, Some(&self.function));
        let wide = |pixels: Vec<[f32; 4]>| pixels.iter().map(|p| p.map(f64::from)).collect();
        Ok(Rough {
            pixels: wide(self.picture(bed, &[])?.pixels),
            off: wide(errors::<true>(bed, &scene)?.pixels),
        })
    }

    fn exact(&self, bed: &mut TestBed) -> Result<Rough, Stop> {
        let picture = self.picture(bed, &[])?;
        Ok(Rough::exact(&picture))
    }
}

impl Rough {
    fn exact(picture: &Picture) -> Self {
        let pixels: Vec<_> = picture.pixels.iter().map(|p| p.map(f64::from)).collect();
        let off = vec![[0.0; 4]; pixels.len()];
        Self { pixels, off }
    }

    /// What `of` makes of two, each number as uncertain as both together: `of` stretches nothing.
    fn with(self, other: Self, of: impl Fn(usize, [f64; 4], [f64; 4]) -> [f64; 4]) -> Self {
        let both = self.pixels.iter().zip(&other.pixels).enumerate();
        let pixels = both.map(|(i, (&a, &b))| of(i, a, b)).collect();
        // An uncertain opacity of the front counts once more, in what it lets through.
        let off = self.off.iter().zip(&other.off);
        let off = off.map(|(a, b)| std::array::from_fn(|c| a[c] + b[c] + a[3]));
        Self {
            pixels,
            off: off.collect(),
        }
    }
}

/// Draws and compares.
pub fn measure(
    bed: &mut TestBed,
    kind: Kind,
    placement: Placement,
    mode: Mode,
    is_perspective: bool,
) -> Result<Measurement, Stop> {
    let shot = ground::shot(placement, mode, (Filter::Linear, false), is_perspective);
    let shot = shot.with(|settings| {
        settings.crop = None;
        settings.per_mode.lmip_threshold = 0.6;
        settings.per_mode.mida_gamma = -0.25;
        settings.per_mode.levels = [(0.55, 0.6), (0.7, 1.0)]
            .map(|(value, opacity)| Level {
                value,
                srgb: [0.9, 0.7, 0.4],
                opacity,
            })
            .into();
    });
    let shot = match placement.technique.traces_paths() {
        true => of_paths(&shot),
        false => shot,
    };
    let (shot, field): (_, fn(DVec3) -> f64) = match kind.is_by_voxels() {
        true => (of_long_rows(shot), islands),
        false => (shot, ground::waves),
    };
    let mut function = ground::ramps();
    if mode == Mode::Xray {
        // Integrals of 20 voxels: not all of them at the end of the function.
        let points = &mut function.color;
        points.iter_mut().for_each(|point| point.value *= 16.0);
        let points = &mut function.opacity;
        points.iter_mut().for_each(|point| point.value *= 16.0);
    }
    let sight = Sight {
        numbers: Numbers::of(&shot, field),
        shot,
        function,
    };
    if kind == Kind::Summed {
        return summed(bed, &sight);
    }
    let (first, second) = match kind.is_exact() {
        true => same_bits(bed, kind, &sight)?,
        false => roundings(bed, kind, &sight)?,
    };
    let bound = match kind.is_exact() {
        true => Bound::new(
            "same-bytes",
            "the same operations on the same numbers, or on numbers times a power of two: no bit differs",
        ),
        false => both_running_errors(bed, &sight.shot)?,
    };
    Ok(compare(kind, &sight.shot, bound, first, second))
}

/// Rows of three words of 32 voxels, of the last of which some bits are no voxels, which rays go along: of an eye from the end to
/// the beginning, parallel ones the other way.
fn of_long_rows(mut shot: PictureCase) -> PictureCase {
    shot.grid.dims = [75, 13, 11];
    shot.camera = ground::oblique_camera(&shot.grid, shot.camera.projection);
    let size = (shot.grid.world_from_voxel.matrix3 * shot.grid.far_corner()).length();
    let side = match &mut shot.camera.projection {
        Projection::Orthographic { view_height } => {
            *view_height = 0.7 * size;
            -1.0
        }
        _ => 1.0,
    };
    shot.camera.eye = shot.camera.target + side * size * dvec3(1.6, -0.25, 0.15);
    // They fill the picture.
    shot.camera.zoom = 2.5;
    shot
}

/// Waves of which half are under water: voxels that matter with wide gaps between.
fn islands(p: DVec3) -> f64 {
    (2.0 * ground::waves(1.6 * p) - 1.0).max(0.0)
}

/// White lights, surfaces and grey solid ones, four paths a pixel.
fn of_paths(shot: &PictureCase) -> PictureCase {
    let light = |towards| Light::of_world(towards, [1.0; 3]);
    shot.with(|settings| {
        settings.color_space = ColorSpace::Linear;
        let levels = &mut settings.per_mode.levels;
        levels.iter_mut().for_each(|level| level.srgb = [0.9; 3]);
        settings.path = PathTracing {
            samples: 4,
            phase: Phase::HenyeyGreenstein(0.4),
            lights: vec![light(dvec3(1.0, 2.0, 0.5)), light(dvec3(-1.0, 0.2, 1.0))],
            surface: 2.0,
            ..PathTracing::default()
        };
    })
}

fn same_bits(bed: &mut TestBed, kind: Kind, sight: &Sight) -> Result<(Rough, Rough), Stop> {
    let mut first = sight.clone();
    let mut other = sight.clone();
    if kind == Kind::LitInBricks {
        for sight in [&mut first, &mut other] {
            sight.shot.settings.filter = Filter::CatmullRom;
            sight.shot.settings.shading = Some(Shading::default());
        }
    }
    let settings = &mut other.shot.settings;
    match kind {
        Kind::Skipped => settings.skip = !settings.skip,
        Kind::SkippedByOctree => settings.empty_space = SkipBy::Octree,
        Kind::SkippedByRuns => settings.empty_space = SkipBy::Runs,
        Kind::PermutedColors => {
            let points = &mut other.function.color;
            points
                .iter_mut()
                .for_each(|point| point.srgb.rotate_left(1));
        }
        Kind::ScaledValues => {
            other.numbers = Numbers::of(&other.shot, |p| 4.0 * f64::from(ground::waves(p) as f32));
            let points = &mut other.function.color;
            points.iter_mut().for_each(|point| point.value *= 4.0);
            let points = &mut other.function.opacity;
            points.iter_mut().for_each(|point| point.value *= 4.0);
            let levels = &mut other.shot.settings.per_mode.levels;
            levels.iter_mut().for_each(|level| level.value *= 4.0);
        }
        Kind::ScaledWorld => {
            let twice = DAffine3::from_scale(DVec3::splat(2.0));
            let shot = &mut other.shot;
            shot.grid.world_from_voxel = twice * shot.grid.world_from_voxel;
            shot.camera.eye *= 2.0;
            shot.camera.target *= 2.0;
            if let Projection::Orthographic { view_height } = &mut shot.camera.projection {
                *view_height *= 2.0;
            }
            other.numbers = Numbers::of(&other.shot, ground::waves);
        }
        Kind::OtherMode if settings.mode == Mode::Mida => {
            first.shot.settings.per_mode.mida_gamma = -1.0;
            settings.mode = Mode::Composite;
        }
        Kind::OtherMode => {
            first.shot.settings.per_mode.lmip_threshold = f64::INFINITY;
            settings.mode = Mode::Mip;
        }
        _ => {}
    }
    let wanted = first.exact(bed)?;
    let mut found = match kind {
        Kind::WithLayers => {
            let is_projection = first.shot.settings.mode.is_projection();
            let layers: &[LayerKind] = match is_projection {
                true => &[LayerKind::Value, LayerKind::Samples],
                false => &[LayerKind::Transmittance, LayerKind::Samples],
            };
            Rough::exact(&other.picture(bed, layers)?)
        }
        Kind::InBricks | Kind::LitInBricks => {
            let scene = other
                .shot
                .scene(&other.numbers.volume, Some(&other.function));
            Rough::exact(&bed.render_lowered(in_bricks, &scene)?)
        }
        Kind::InSmallSubmissions if bed.wants_device() => {
            let scene = other
                .shot
                .scene(&other.numbers.volume, Some(&other.function));
            let picture = bed.with_renderer(&scene, |renderer| {
                // Less than anything takes: as few rows or slices at once as there can be.
                renderer.set_submission_ms(1e-3);
                renderer.render(&scene, &[])?;
                Ok(renderer.render(&scene, &[])?.picture)
            })?;
            Rough::exact(&picture)
        }
        _ => other.exact(bed)?,
    };
    if kind == Kind::PermutedColors {
        found.pixels.iter_mut().for_each(|p| p[..3].rotate_right(1));
    }
    Ok((wanted, found))
}

/// Neither texture holds the ground in one piece, along no axis.
fn in_bricks(caps: Caps) -> Caps {
    Caps {
        max_image_dimension_3d: caps.max_image_dimension_3d.min(12),
        max_image_array_layers: caps.max_image_array_layers.min(8),
        ..caps
    }
}

fn roundings(bed: &mut TestBed, kind: Kind, sight: &Sight) -> Result<(Rough, Rough), Stop> {
    let mut first = sight.clone();
    let mut other = sight.clone();
    let shot = &sight.shot;
    let far = shot.grid.far_corner();
    let voxels = shot.grid.world_from_voxel;
    match kind {
        Kind::OtherOrder => other.shot.settings.order = Order::FrontToBack,
        Kind::RaysOnPlanes => {
            other.shot.settings.technique = ground::RAYS.technique;
            other.shot.settings.lattice = Lattice::Planes;
        }
        Kind::Mirrored => {
            // Voxel i of the one is voxel n - 1 - i of the other, at the same place in the world.
            let n = far.x;
            let mirror = DAffine3::from_scale(dvec3(-1.0, 1.0, 1.0))
                * DAffine3::from_translation(dvec3(-n, 0.0, 0.0));
            other.shot.grid.world_from_voxel = voxels * mirror;
            let field = |p: DVec3| ground::waves(dvec3(n - p.x, p.y, p.z));
            other.numbers = Numbers::of(&other.shot, field);
        }
        Kind::Turned => {
            // What was along x, y and z now is along y, z and x.
            let [nx, ny, nz] = shot.grid.dims;
            other.shot.grid.dims = [nz, nx, ny];
            let m = voxels.matrix3;
            other.shot.grid.world_from_voxel.matrix3 =
                glam::DMat3::from_cols(m.z_axis, m.x_axis, m.y_axis);
            let field = |p: DVec3| ground::waves(dvec3(p.y, p.z, p.x));
            other.numbers = Numbers::of(&other.shot, field);
        }
        Kind::InTwo => {
            // Faces where no sample of a stack and no voxel's centre lies.
            let cut = dvec3(far.x, 11.2, far.z);
            first.shot.settings.crop = Some([DVec3::ZERO, cut]);
            other.shot.settings.crop = Some([dvec3(0.0, cut.y, 0.0), far]);
            let [low, high] = [first.rough(bed)?, other.rough(bed)?];
            let whole = sight.rough(bed)?;
            let rays = shot.camera.rays(shot.extent);
            let (width, row) = (shot.extent[0] as usize, voxels.matrix3.inverse().row(1));
            let both = low.with(high, |i, low, high| {
                let at = [i % width, i / width].map(|n| n as f64 + 0.5);
                let goes_up = row.dot(rays.at(at[0], at[1]).1) > 0.0;
                let (front, back) = if goes_up { (low, high) } else { (high, low) };
                std::array::from_fn(|c| front[c] + (1.0 - front[3]) * back[c])
            });
            return Ok((whole, both));
        }
        Kind::ClearOutside => {
            let filter = Filter::Nearest;
            let crop = [dvec3(3.0, 4.0, 2.0), far - dvec3(4.0, 3.0, 3.0)];
            first.shot.settings.crop = Some(crop);
            for sight in [&mut first, &mut other] {
                sight.shot.settings.filter = filter;
            }
            // Under the first point of the function nothing is seen.
            let field = |p: DVec3| match p.cmpgt(crop[0]).all() && p.cmplt(crop[1]).all() {
                true => ground::waves(p),
                false => 0.05,
            };
            other.numbers = Numbers::of(&other.shot, field);
        }
        Kind::Furnace => {
            let srgb = [0.8, 0.5, 0.25];
            first.function.color = vec![ColorPoint { value: 0.0, srgb }];
            let seen = first.rough(bed)?;
            let over = |p: &[f64; 4]| -> [f64; 4] {
                std::array::from_fn(|c| match c {
                    3 => p[3],
                    c => p[c] + (1.0 - p[3]) * srgb[c],
                })
            };
            let pixels: Vec<_> = seen.pixels.iter().map(over).collect();
            let wanted = pixels.iter().map(|p| [srgb[0], srgb[1], srgb[2], p[3]]);
            let wanted = Rough {
                pixels: wanted.collect(),
                off: vec![[0.0; 4]; pixels.len()],
            };
            let off = seen
                .off
                .iter()
                .map(|o| std::array::from_fn(|c| o[c] + o[3]));
            return Ok((
                wanted,
                Rough {
                    pixels,
                    off: off.collect(),
                },
            ));
        }
        _ => {}
    }
    Ok((first.rough(bed)?, other.rough(bed)?))
}

fn both_running_errors(bed: &mut TestBed, shot: &PictureCase) -> Result<Bound, Stop> {
    let of_each = derivation(bed, &shot.settings)?;
    Ok(Bound::new(
        "both-running-errors",
        format!("{BOTH}{of_each}"),
    ))
}

fn compare(
    kind: Kind,
    shot: &PictureCase,
    bound: Bound,
    first: Rough,
    second: Rough,
) -> Measurement {
    let mut measurement = Measurement::new(bound, 1000);
    let mut widest = 0.0f64;
    for (i, pixel) in shot.pixels().enumerate() {
        let allowed: [f64; 4] = std::array::from_fn(|c| first.off[i][c] + second.off[i][c]);
        // Where a ray meets an end of the domain at a sample, either may have it.
        let hangs = !kind.is_exact() && shot.chord(pixel).is_some_and(|chord| chord.hangs);
        if hangs || !allowed.iter().all(|&error| error < WIDEST.into()) {
            measurement.leave_out(4);
            continue;
        }
        for (c, allowed) in allowed.into_iter().enumerate() {
            widest = widest.max(allowed);
            let at = || format!("channel {c} of pixel {pixel:?}");
            measurement.take(at, first.pixels[i][c], second.pixels[i][c], allowed);
        }
    }
    let drawn = second.pixels.iter().filter(|pixel| pixel[3] > 0.01).count();
    measurement.hold(|| "pixels that are drawn".into(), drawn > 100);
    if !kind.is_exact() {
        measurement.bound.inputs.insert("widest".into(), widest);
    }
    let narrow = |rough: Rough| rough.pixels.iter().map(|p| p.map(|n| n as f32)).collect();
    measurement.pictures = Some(Pictures {
        width: shot.extent[0],
        expected: narrow(first),
        found: narrow(second),
    });
    measurement
}

/// X(f + g) = X(f) + X(g).
fn summed(bed: &mut TestBed, sight: &Sight) -> Result<Measurement, Stop> {
    let shot = &sight.shot;
    // Numbers of 16 bits: their sums are numbers of f32.
    let coarse = |x: f64| (x * 65536.0).round() / 65536.0;
    let one = |p: DVec3| coarse(ground::waves(p));
    let two = |p: DVec3| coarse(ground::waves(dvec3(9.0 - p.y, p.z + 2.0, 0.7 * p.x)));
    let fields: [&dyn Fn(DVec3) -> f64; 3] = [&one, &two, &|p| one(p) + two(p)];
    let mut function = sight.function.clone();
    function.opacity = vec![OpacityPoint {
        value: 0.0,
        opacity: 0.5,
    }];
    let mut found = Vec::new();
    for field in fields {
        let numbers = Numbers::of(shot, field);
        let scene = shot.scene(&numbers.volume, Some(&function));
        let value = LayerKind::Value;
        let pictures = [bed.render(&scene, &[value])?, errors::<true>(bed, &scene)?];
        let missing = || Stop::Suite("no values".into());
        let mut numbers = Vec::new();
        for picture in &pictures {
            numbers.push(layer(picture, value).ok_or_else(missing)?.to_vec());
        }
        found.push(numbers);
    }
    let bound = both_running_errors(bed, shot)?;
    let mut measurement = Measurement::new(bound, 200);
    for (i, pixel) in shot.pixels().enumerate() {
        let [a, b, sum] = [0, 1, 2].map(|k: usize| f64::from(found[k][0][i]));
        let off: f64 = found.iter().map(|numbers| f64::from(numbers[1][i])).sum();
        if off.is_nan() {
            continue;
        }
        let hangs = shot.chord(pixel).is_none_or(|chord| chord.hangs);
        if hangs || off.is_infinite() {
            measurement.leave_out(1);
            continue;
        }
        measurement.take(|| format!("value of pixel {pixel:?}"), a + b, sum, off);
    }
    Ok(measurement)
}
