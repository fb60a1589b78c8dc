//! Scattered points, read, and how their values are seen.

use super::{Others, SceneInputs, has_beside};
use crate::annotate::{LineLegend, caption, unit};
use crate::cli::{
    Error, exaggerate,
    flags::{Classification, ClassificationFlags, SceneFlags, summary},
    flow::DrawnLines,
    look::short,
    progress::Progress,
};
use crate::points::Points;
use crate::technique::{Mode, PerMode};
use crate::transfer::{
    ColorPoint, Colormap, Interpolation, OpacityPoint, TransferFunction, Window,
};
use crate::volume::{Header, Source, Volume};
use glam::{DAffine3, DVec3};

/// How opaque a point is along a ray through its centre, where nothing says it.
const OPACITY: f64 = 0.8;
const COLORMAP: &str = "viridis";

/// The points that the words name, stretched upward as volumes are.
pub fn read(scene: &SceneFlags, mode: Mode, progress: &Progress) -> Result<SceneInputs, Error> {
    let technique = scene.sampling.technique.unwrap_or_default();
    if !technique.splats() {
        return Err(Error::usage(
            format!("--technique {technique} is for volumes, and scattered points are splatted"),
            "leave it out",
        ));
    }
    check_words(scene, mode)?;
    let (points, volume, header, factor) = placed(scene, progress)?;
    let classification = classification(&scene.classification, &volume, mode)?;
    let (per_mode, note) = scene.modes.per_mode(
        mode,
        scene.classification.window()?,
        scene.classification.named(&classification),
        || Ok(summary(&volume)),
    )?;
    if let Some(note) = note {
        progress.note(&note);
    }
    Ok(SceneInputs {
        others: Others::Points(points),
        ..SceneInputs::new(volume, header, factor, classification, per_mode)
    })
}

/// The same as spheres, around a volume of which nothing is seen.
pub fn spheres(scene: &SceneFlags, mode: Mode, progress: &Progress) -> Result<SceneInputs, Error> {
    if mode != Mode::Composite {
        return Err(Error::usage(
            format!("--points-as spheres and --mode {mode}: spheres are no volume"),
            "leave out --mode",
        ));
    }
    check_words(scene, mode)?;
    let (points, volume, header, factor) = placed(scene, progress)?;
    let mut classification = classification(&scene.classification, &volume, mode)?;
    let lines = match &mut classification {
        Classification::Function(function) => {
            let legend = LineLegend {
                function: function.clone(),
                caption: caption(&header),
                unit: unit(&header),
            };
            function
                .opacity
                .iter_mut()
                .for_each(|point| point.opacity = 0.0);
            DrawnLines::spheres(&points, legend, scene.point_look.sphere_size)
        }
        Classification::RangeOfPicture => unreachable!("a composite has a function"),
    };
    Ok(SceneInputs {
        lines: Some(lines),
        ..SceneInputs::new(volume, header, factor, classification, PerMode::default())
    })
}

/// What is for volumes alone.
fn check_words(scene: &SceneFlags, mode: Mode) -> Result<(), Error> {
    let of_volumes = scene.labels.labels.is_some()
        || has_beside(scene, mode)
        || scene.channels.are_given()
        || scene.input.component.is_some()
        || scene.denoise.is_some()
        || scene.section.section.is_some();
    if of_volumes {
        return Err(Error::usage(
            "--labels, --channel, --component, --opacity-variable, --denoise, --section and --preclassified are for volumes, and these are scattered points",
            "leave it out",
        ));
    }
    Ok(())
}

/// The points in the drawn world, the volume that stands for them, what their file says, and how much higher they are
/// drawn than they are.
fn placed(scene: &SceneFlags, progress: &Progress) -> Result<(Points, Volume, Header, f64), Error> {
    let file = scene.input.open_points(&scene.input.limits())?;
    let mut header = file.header().clone();
    for note in file.notes() {
        progress.note(note);
    }
    let points = (**file.points()).clone();
    let (factor, note) = exaggerate::factor(scene, &points.binned().grid(), header.is_earth)?;
    if let Some(note) = &note {
        progress.note(note);
    }
    let mut points = points.stretched(factor);
    if let Some(std) = scene.sampling.splat_std {
        points = points.with_std(std as f32);
    }
    if points.has_default_stds() && !scene.points_are_spheres() {
        progress.note(&format!(
            "no standard deviations are given: all points have {}, by the distances of neighbours; --splat-std takes another",
            short(points.median_std())
        ));
    }
    let volume = Volume {
        unit: header.unit.clone(),
        ..points.binned()
    };
    header.dims = volume.dims;
    header.world_from_voxel =
        DAffine3::from_scale(DVec3::new(1.0, 1.0, factor.recip())) * volume.world_from_voxel;
    Ok((points, volume, header, factor))
}

/// As of a volume; composites that no word classifies show all points alike, in colours over the range of their values.
fn classification(
    flags: &ClassificationFlags,
    volume: &Volume,
    mode: Mode,
) -> Result<Classification, Error> {
    if mode.is_projection() || flags.preset.is_some() || flags.function_of_file()?.is_some() {
        return flags.classification(volume, mode);
    }
    let flags = flags.with_window_of(mode, || Ok(summary(volume)))?;
    let range = Window::of_range(volume.value_range);
    let window = flags.window()?.unwrap_or(range);
    let colormap = Colormap::from_name(COLORMAP).expect("one of ours");
    let function = alike(volume.value_range).with_colormap(colormap, Some(window));
    let function = flags.with_parts(function, || Ok(range))?;
    Ok(Classification::Function(function))
}

fn alike([low, high]: [f64; 2]) -> TransferFunction {
    let ends = [low, high];
    TransferFunction {
        color: ends
            .map(|value| ColorPoint {
                value,
                srgb: [1.0; 3],
            })
            .to_vec(),
        opacity: ends
            .map(|value| OpacityPoint {
                value,
                opacity: OPACITY,
            })
            .to_vec(),
        reference_length: None,
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
    }
}
