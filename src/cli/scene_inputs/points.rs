//! Scattered points, read, and how their values are seen.

use super::{Others, SceneInputs};
use crate::annotate::{ColorLegend, caption, unit};
use crate::cli::{
    Error, exaggerate,
    flags::{Classification, ClassificationFlags, SceneFlags, ShadingWord, summary},
    flow::DrawnLines,
    look::short,
    progress::Progress,
};
use crate::points::Points;
use crate::technique::{Mode, PerMode, Settings};
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

/// The same as spheres, around a volume of which nothing is seen; a clip plane takes those away whose middles it cuts off.
pub fn spheres(
    scene: &SceneFlags,
    settings: &Settings,
    progress: &Progress,
) -> Result<SceneInputs, Error> {
    let mode = settings.mode;
    check_words(scene, mode)?;
    check_spheres(scene, mode)?;
    let (points, volume, header, factor) = placed(scene, progress)?;
    let mut classification = classification(&scene.classification, &volume, mode)?;
    let lines = match &mut classification {
        Classification::Function(function) => {
            let legend = ColorLegend {
                function: function.clone(),
                caption: caption(&header),
                unit: unit(&header),
            };
            function
                .opacity
                .iter_mut()
                .for_each(|point| point.opacity = 0.0);
            let is_kept = |place: DVec3| {
                let mut planes = settings.clip_planes.iter();
                planes.all(|plane| plane.normal.dot(place) >= plane.offset)
            };
            DrawnLines::spheres(&points, is_kept, legend, scene.point_look.sphere_size)
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
    let of_volumes = [
        ("--labels", scene.labels.labels.is_some()),
        ("--with", !scene.with.with.is_empty()),
        (scene.opacity.word(), scene.opacity.are_given()),
        ("--preclassified", scene.sampling.preclassified),
        ("--iso-color-by", scene.modes.paint(mode).is_some()),
        ("--channel", scene.channels.are_given()),
        ("--component", scene.input.component.is_some()),
        ("--denoise", scene.denoise.is_some()),
        ("--section", scene.section.section.is_some()),
    ];
    match of_volumes.into_iter().find(|(_, is_given)| *is_given) {
        Some((word, _)) => Err(Error::usage(
            format!("{word} is for volumes, and these are scattered points"),
            "leave it out",
        )),
        None => Ok(()),
    }
}

/// What is for samples of a volume, of which spheres have none.
fn check_spheres(scene: &SceneFlags, mode: Mode) -> Result<(), Error> {
    let (sampling, light) = (&scene.sampling, &scene.light);
    let is_lit = light.shading == Some(ShadingWord::Phong);
    let mode = match mode {
        Mode::Composite => None,
        mode => Some(format!("--mode {mode}")),
    };
    let of_samples = [
        ("--preintegrated", sampling.preintegrated),
        ("--smooth", sampling.smooth),
        ("--jitter", sampling.jitter.is_some()),
        ("--adaptive-steps", sampling.adaptive_steps.is_some()),
        ("--filter", sampling.filter.is_some()),
        ("--cut-faces", sampling.cut_faces.is_some()),
        ("--shading phong", is_lit),
        ("--shadows", light.shadows.is_some()),
        ("--ambient-occlusion", light.ambient_occlusion.is_some()),
        ("--scattering single", scene.path.scatters_once()),
    ];
    let given = of_samples.into_iter().find(|(_, is_given)| *is_given);
    match mode.or(given.map(|(word, _)| word.to_owned())) {
        Some(word) => Err(Error::usage(
            format!("--points-as spheres and {word}: spheres are no volume"),
            format!("leave out {word}"),
        )),
        None => Ok(()),
    }
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
        medium: None,
    }
}
