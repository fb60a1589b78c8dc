//! Everything that is drawn, against the same functions on the CPU in f64: filters through voxels, surfaces, local
//! and attenuated maxima, MIDA, light, lit slabs, functions of gradients, holes.
//!
//! Two bounds: the running error of the picture is a worst case, and what lies outside of it is wrong. The second takes
//! it that a device rounds about as well as the CPU reference in f32 does: what lies outside of that is a warning.

use super::drawn;
use super::ground::{self, FILTERS, MODES, PROJECTIONS, Placement, RAYS};
use crate::conformance::case::{Case, Profile, Stop};
use crate::conformance::measurement::{Bound, Measurement, Pictures};
use crate::conformance::oracle::PictureCase;
use crate::conformance::test_bed::TestBed;
use crate::named::Named;
use crate::offscreen::reference;
use crate::picture::ColorSpace;
use crate::scene::Scene;
use crate::technique::{Filter, Level, Mode, Shading};
use crate::volume::{Rescale, Volume, VoxelType, Voxels};
use glam::{DVec3, dvec3};

/// Where the CPU references in f32 and in f64 are farther apart, a sample has jumped over a border: nothing is known of the
/// pixel.
const JUMP: f64 = 2e-5;

const LIKELY: &str = "farther from the reference than three times what f32 makes of it: see `likely` in the derivation";

const DERIVATION: &str = "likely: How exactly f32 knows this very picture is found out on the CPU: the reference runs in f64 and in f32, and r is \
the worst difference of the two over all pixels that are no jumps (under 2e-5). A device that rounds in another order, or \
contracts, is taken to be at most three times as far from f64 as the reference: 4 r around the reference. Where light is absorbed, each of \
at most N segments has its own log and exp, off by 2^-21 and by 5 x 2^-23 (Vulkan specification, precision of SPIR-V \
instructions), seen by at most all of the light. Colours are decoded by pow(c, 2.4), off by (3 + 4.8 |log2 c|) 2^-23 and what \
log2 is off by (2.4 x 2^-21 ln 2) of it: c is 0.14 or more, which makes 24 x 2^-23. allowed = 4 r + N (2^-21 + 5 x 2^-23) d / d0 \
+ 24 x 2^-23, without the second term where nothing is absorbed.";

/// What is drawn beside the plain modes.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Look {
    Plain,
    Lit,
    LitSlabs,
    Holes,
}

/// The product of placements and what they can draw.
pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    let mut add =
        |placement: Placement, word: &str, mode: Mode, filter: (&str, Filter), look: Look| {
            let Some(of) = placement.word_in(mode) else {
                return;
            };
            let is_hidden = ground::hides_maxima(placement, mode, filter.1);
            if is_hidden || ground::is_unsure(placement, mode, filter.1) {
                return;
            }
            for (projection, is_perspective) in PROJECTIONS {
                let of_look = match look {
                    Look::Plain => "plain",
                    Look::Lit => "lit",
                    Look::LitSlabs => "lit_slabs",
                    Look::Holes => "holes",
                };
                let name = format!("reference.{of}.{word}.{of_look}.{}.{projection}", filter.0);
                let filter = filter.1;
                let mut case = Case::new(name, move |bed| {
                    measure(bed, placement, mode, filter, look, is_perspective)
                });
                case.needs = ground::needs(placement, mode, VoxelType::F32, false);
                let is_common = matches!(filter, Filter::Linear | Filter::Cubic);
                case.profile = match is_common && is_perspective {
                    true => Profile::Baseline,
                    false => Profile::Full,
                };
                cases.push(case);
            }
        };
    let wide = [("quadratic", Filter::Quadratic), ("cubic", Filter::Cubic)];
    let fetched = FILTERS
        .iter()
        .filter(|filter| !filter.2)
        .map(|f| (f.0, f.1));
    let filters: Vec<_> = fetched.chain(wide).collect();
    for placement in ground::all_placements() {
        for mode in MODES {
            let word = &ground::word_of(mode);
            for &filter in &filters {
                add(placement, word, mode, filter, Look::Plain);
            }
            add(
                placement,
                word,
                mode,
                ("linear_fetch", Filter::Linear),
                Look::Holes,
            );
        }
        add(
            placement,
            "composite",
            Mode::Composite,
            ("linear_fetch", Filter::Linear),
            Look::Lit,
        );
        if placement.has_slabs() {
            add(
                placement,
                "composite",
                Mode::Composite,
                ("linear_fetch", Filter::Linear),
                Look::LitSlabs,
            );
        }
        add(
            placement,
            "composite",
            Mode::Composite,
            ("cubic", Filter::Cubic),
            Look::Lit,
        );
    }
    for &mode in Mode::ALL.iter().filter(|mode| mode.needs_rays()) {
        let word = &ground::word_of(mode);
        for &filter in filters.iter().filter(|filter| filter.1 != Filter::Nearest) {
            add(RAYS, word, mode, filter, Look::Plain);
        }
    }
    cases
}

fn measure(
    bed: &mut TestBed,
    placement: Placement,
    mode: Mode,
    filter: Filter,
    look: Look,
    is_perspective: bool,
) -> Result<Measurement, Stop> {
    let shot = ground::shot(placement, mode, (filter, false), is_perspective);
    let shot = shot.with(|settings| {
        settings.crop = None;
        settings.color_space = ColorSpace::Linear;
        settings.preintegrated = look == Look::LitSlabs;
        settings.shading = matches!(look, Look::Lit | Look::LitSlabs).then(Shading::default);
        settings.per_mode.lmip_threshold = 0.6;
        settings.per_mode.levels = vec![Level {
            value: 0.55,
            srgb: [0.9, 0.7, 0.4],
            opacity: 0.6,
        }];
    });
    of_shot(bed, &shot, look == Look::Holes)
}

/// The picture of a shot, of waves, against the CPU references.
pub(super) fn of_shot(
    bed: &mut TestBed,
    shot: &PictureCase,
    has_holes: bool,
) -> Result<Measurement, Stop> {
    let volume = volume(shot, has_holes);
    let function = ground::ramps();
    of_scene(bed, shot, &shot.scene(&volume, Some(&function)))
}

/// The picture of a scene that a shot has, against the CPU references.
pub(super) fn of_scene(
    bed: &mut TestBed,
    shot: &PictureCase,
    scene: &Scene,
) -> Result<Measurement, Stop> {
    let mode = shot.settings.mode;
    let found = bed.render(scene, &[])?;
    let wrong = |error: crate::technique::Error| Stop::Suite(error.to_string());
    let double = reference::render::<f64>(scene).map_err(wrong)?;
    let single = reference::render::<f32>(scene).map_err(wrong)?;
    let apart = |i: usize, c: usize| {
        (f64::from(double.pixels[i][c]) - f64::from(single.pixels[i][c])).abs()
    };
    let jumps = |i: usize| (0..4).any(|c| apart(i, c) >= JUMP);
    let all = || (0..single.pixels.len()).filter(|&i| !jumps(i));
    let rounding = all().flat_map(|i| (0..4).map(move |c| (i, c)));
    let rounding = rounding.map(|(i, c)| apart(i, c)).fold(0.0, f64::max);
    let segments = match mode.is_projection() {
        true => 0.0,
        false => shot.grid.diagonal() / shot.grid.smallest_spacing(),
    };
    let allowed = 4.0 * rounding + segments * (4.0 + 5.0) / f64::from(1u32 << 23);
    let allowed = allowed + 24.0 / f64::from(1u32 << 23);
    // The last steps of a search are decided inside of any error, and where they end is as good as anywhere near.
    let worst_case = match mode {
        Mode::Iso => None,
        _ => Some(drawn::errors::<false>(bed, scene)?),
    };
    let is_merged = bed.is_merged(scene.settings)?;
    let (id, derivation) = match &worst_case {
        Some(_) => {
            let of_errors = drawn::derivation(bed, scene.settings)?;
            ("running-error", format!("{of_errors} {DERIVATION}"))
        }
        None => ("likely", DERIVATION.to_owned()),
    };
    let bound = Bound::new(id, derivation)
        .with("r", rounding)
        .with("N", segments)
        .with("likely", allowed);
    let mut measurement = Measurement::new(bound, 1000);
    let mut widest = 0.0f64;
    for (i, pixel) in shot.pixels().enumerate() {
        let errors = worst_case
            .as_ref()
            .map(|errors| errors.pixels[i].map(f64::from));
        let most = drawn::WIDEST.into();
        let is_sure = errors.is_none_or(|errors| errors.iter().all(|&error| error < most));
        if jumps(i) || !is_sure {
            measurement.leave_out(4);
            continue;
        }
        for c in 0..4 {
            let at = || format!("channel {c} of pixel {pixel:?}");
            let [single, double] = [&single, &double].map(|p| f64::from(p.pixels[i][c]));
            let found = found.pixels[i][c].into();
            match errors {
                Some(errors) => {
                    // The picture of the f64 CPU reference is kept in f32.
                    let kept = double.abs() / f64::from(1u32 << 24);
                    widest = widest.max(errors[c] + kept);
                    measurement.take(at, double, found, errors[c] + kept);
                    // Of 16-bit floats f32 knows nothing.
                    if !is_merged {
                        measurement.prefer(LIKELY, at, single, found, allowed);
                    }
                }
                None => measurement.take(at, single, found, allowed),
            }
        }
    }
    if is_merged {
        measurement.bound.inputs.insert("widest".into(), widest);
    }
    let drawn = single.pixels.iter().filter(|pixel| pixel[3] > 0.01).count();
    measurement.hold(|| "pixels that are drawn".into(), drawn > 40);
    measurement.pictures = Some(Pictures {
        width: shot.extent[0],
        expected: single.pixels,
        found: found.pixels,
    });
    Ok(measurement)
}

/// Waves on the grid of a shot.
pub(super) fn volume(shot: &PictureCase, has_holes: bool) -> Volume {
    let [nx, ny, nz] = shot.grid.dims;
    let place = |x: u32, y: u32, z: u32| dvec3(x.into(), y.into(), z.into()) + DVec3::splat(0.5);
    let voxels = (0..nz).flat_map(|z| (0..ny).flat_map(move |y| (0..nx).map(move |x| (x, y, z))));
    let mut values: Vec<f32> = voxels
        .map(|(x, y, z)| ground::waves(place(x, y, z)) as f32)
        .collect();
    if has_holes {
        values
            .iter_mut()
            .step_by(61)
            .for_each(|value| *value = -9.0);
    }
    let fill = has_holes.then_some(-9.0);
    let affine = shot.grid.world_from_voxel;
    Volume::from_voxels(
        shot.grid.dims,
        affine,
        Voxels::F32(values),
        Rescale::default(),
        fill,
    )
    .expect("as many voxels as the grid has")
}
