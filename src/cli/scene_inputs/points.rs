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
use crate::points::interpolate::mean_distance_of;
use crate::points::{FieldKernel, PointField, Points, Quantity};
use crate::technique::{Mode, PerMode, Settings};
use crate::transfer::{
    ColorPoint, Colormap, Interpolation, OpacityPoint, TransferFunction, Window,
};
use crate::volume::{Header, Source, Volume};
use glam::{DAffine3, DVec3};

/// How opaque a point is along a ray through its centre, where nothing says it.
const OPACITY: f64 = 0.8;
/// Of neighbours, that a point of a field reaches where nobody says it.
const MEAN_DISTANCES: f64 = 2.0;
const COLORMAP: &str = "viridis";

/// The points that the words name, stretched upward as volumes are.
pub fn read(scene: &SceneFlags, mode: Mode, progress: &Progress) -> Result<SceneInputs, Error> {
    let technique = scene.sampling.technique.unwrap_or_default();
    if !technique.splats() {
        return Err(Error::usage(
            format!("--technique {technique} is for volumes, and scattered points are splatted"),
            "leave it out; --points-as field casts rays through them, --points-as grid through a volume of them",
        ));
    }
    check_words(scene, mode)?;
    let (points, volume, header, factor) = placed(scene, progress)?;
    let classification = classification(&scene.classification, &volume, mode, OPACITY)?;
    let per_mode = per_mode(scene, mode, &classification, &volume, progress)?;
    Ok(SceneInputs {
        crowd_bits: points.most_at_one_place().ilog2(),
        others: Others::Points(points),
        ..SceneInputs::new(volume, header, factor, classification, per_mode)
    })
}

/// The same as a field that rays are cast through.
pub fn field(
    scene: &SceneFlags,
    mode: Mode,
    quantity: Quantity,
    progress: &Progress,
) -> Result<SceneInputs, Error> {
    check_words(scene, mode)?;
    let (points, mut header, factor) = stretched(scene, progress)?;
    let given = scene.point_look.field.and_then(|word| word.radius);
    let radius = given.unwrap_or_else(|| {
        let distance = mean_distance_of(&points).unwrap_or(1.0);
        let radius = MEAN_DISTANCES * distance;
        progress.note(&format!(
            "points reach {} each, twice the mean distance of neighbours; --field kernel:R takes another",
            short(radius)
        ));
        radius
    });
    let kernel = FieldKernel { radius, quantity };
    if quantity == Quantity::Density {
        header.long_name = Some("density of points".to_owned());
        header.unit = None;
    }
    let volume = Volume {
        unit: header.unit.clone(),
        ..volume_of_field(&points, kernel)
    };
    place(&mut header, &volume, factor);
    let least = match quantity {
        Quantity::Mean => OPACITY,
        // Optical depth goes with how much there is.
        Quantity::Density => 0.0,
    };
    let classification = classification(&scene.classification, &volume, mode, least)?;
    let per_mode = per_mode(scene, mode, &classification, &volume, progress)?;
    Ok(SceneInputs {
        others: Others::Points(points),
        field: Some(kernel),
        ..SceneInputs::new(volume, header, factor, classification, per_mode)
    })
}

/// What the mode wants to know of the values.
fn per_mode(
    scene: &SceneFlags,
    mode: Mode,
    classification: &Classification,
    volume: &Volume,
    progress: &Progress,
) -> Result<PerMode, Error> {
    let (per_mode, note) = scene.modes.per_mode(
        mode,
        scene.classification.window()?,
        scene.classification.named(classification),
        || Ok(summary(volume)),
    )?;
    if let Some(note) = note {
        progress.note(&note);
    }
    Ok(per_mode)
}

/// The volume that says where the field is and which values it has: of a density those at the points, and from 0 on.
fn volume_of_field(points: &Points, kernel: FieldKernel) -> Volume {
    match kernel.quantity {
        Quantity::Mean => points.binned_within(kernel.radius),
        Quantity::Density => {
            let field = PointField::new(points, kernel);
            let at = |&place| field.at(place).unwrap_or(0.0) as f32;
            let densities = points.places().iter().map(at).collect();
            let there = Points::new(points.places().to_vec(), densities, None, None);
            let volume = there.expect("points").binned_within(kernel.radius);
            Volume {
                value_range: [0.0, volume.value_range[1]],
                ..volume
            }
        }
    }
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
    let mut classification = classification(&scene.classification, &volume, mode, OPACITY)?;
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
        ("--with", scene.with.volumes().next().is_some()),
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
    let (mut points, mut header, factor) = stretched(scene, progress)?;
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
    place(&mut header, &volume, factor);
    Ok((points, volume, header, factor))
}

/// The header of the volume that stands for points.
fn place(header: &mut Header, volume: &Volume, factor: f64) {
    header.dims = volume.dims;
    header.world_from_voxel =
        DAffine3::from_scale(DVec3::new(1.0, 1.0, factor.recip())) * volume.world_from_voxel;
}

/// The points in the drawn world, what their file says, and how much higher they are drawn than they are.
fn stretched(scene: &SceneFlags, progress: &Progress) -> Result<(Points, Header, f64), Error> {
    let file = scene.input.open_points(&scene.input.limits())?;
    let header = file.header().clone();
    for note in file.notes() {
        progress.note(note);
    }
    let points = (**file.points()).clone();
    let (factor, note) = exaggerate::factor(scene, &points.binned().grid(), header.is_earth)?;
    if let Some(note) = &note {
        progress.note(note);
    }
    Ok((points.stretched(factor), header, factor))
}

/// As of a volume; composites that no word classifies show all points alike, in colours over the range of their values, unless the
/// lowest of these has a lower opacity.
fn classification(
    flags: &ClassificationFlags,
    volume: &Volume,
    mode: Mode,
    least: f64,
) -> Result<Classification, Error> {
    if mode.is_projection() || flags.preset.is_some() || flags.function_of_file()?.is_some() {
        return flags.classification(volume, mode);
    }
    let flags = flags.with_window_of(mode, || Ok(summary(volume)))?;
    let range = Window::of_range(volume.value_range);
    let window = flags.window()?.unwrap_or(range);
    let colormap = Colormap::from_name(COLORMAP).expect("one of ours");
    let function = between(volume.value_range, least).with_colormap(colormap, Some(window));
    let function = flags.with_parts(function, || Ok(range))?;
    Ok(Classification::Function(function))
}

fn between([low, high]: [f64; 2], least: f64) -> TransferFunction {
    let ends = [low, high];
    TransferFunction {
        color: ends
            .map(|value| ColorPoint {
                value,
                srgb: [1.0; 3],
            })
            .to_vec(),
        opacity: [(low, least), (high, OPACITY)]
            .map(|(value, opacity)| OpacityPoint { value, opacity })
            .to_vec(),
        reference_length: None,
        interpolation: Interpolation::Linear,
        gradient_transfer: None,
        medium: None,
    }
}
