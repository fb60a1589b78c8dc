//! What can be said of words before anything is read.

use super::preclassified;
use crate::cli::Error;
use crate::cli::flags::{ClassificationFlags, Component, Plan, SceneFlags};
use crate::offscreen::check_geometry;
use crate::shaders::MAX_CHANNELS;
use crate::technique::{Filter, Mode, Settings, Technique};
use crate::volume::Header;
/// Which of the numbers of a voxel are drawn, and what a person should know of it.
pub(super) fn plan(scene: &SceneFlags, header: &Header) -> Result<(Plan, Option<String>), Error> {
    let beside = scene.with.volumes().count() + usize::from(scene.labels.labels.is_some());
    let room = (MAX_CHANNELS as usize).saturating_sub(beside);
    scene.channels.plan(&scene.input, header, room)
}

/// True where more than one number a voxel is seen.
pub fn shows_several(scene: &SceneFlags, header: &Header) -> Result<bool, Error> {
    let (plan, _) = plan(scene, header)?;
    let mode = scene.sampling.mode.unwrap_or_default();
    let has_labels = scene.labels.labels.is_some();
    // Lines of the Earth stay as they are.
    let has_lines = scene.has_lines();
    Ok(plan != Plan::One || has_labels || has_lines || has_beside(scene, mode))
}

/// True where words name something that is mixed with the volume, sample by sample. Labels are in composites alone.
pub(super) fn has_beside(scene: &SceneFlags, mode: Mode) -> bool {
    (scene.labels.labels.is_some() && mode == Mode::Composite)
        || scene.with.volumes().next().is_some()
        || scene.modes.paint(mode).is_some()
        || scene.opacity.are_given()
        || scene.sampling.preclassified
}

/// What can be said wrong before anything is opened.
pub fn check(scene: &SceneFlags, settings: &Settings) -> Result<(), Error> {
    check_in(scene, settings).map_err(|error| {
        scene.section.named_in(error, &scene.sampling, |_| {
            let mode = Mode::Composite;
            check_in(
                scene,
                &Settings {
                    mode,
                    ..settings.clone()
                },
            )
            .is_ok()
        })
    })
}

/// What volumes of `--with` do not go with.
fn check_with(scene: &SceneFlags, mode: Mode) -> Result<(), Error> {
    let with = scene.with.volumes().count();
    if with == 0 {
        return Ok(());
    }
    if mode != Mode::Composite && !mode.is_projection() {
        return Err(Error::usage(
            format!("--with draws several volumes, and --mode {mode} draws one"),
            "leave out --mode, or take one that projects: --mode mip",
        ));
    }
    let others = [
        scene.labels.labels.is_some(),
        scene.opacity.are_given(),
        true,
    ];
    let all = with + others.into_iter().filter(|is_there| *is_there).count();
    if all > MAX_CHANNELS as usize {
        return Err(Error::usage(
            format!(
                "{all} volumes: at most {MAX_CHANNELS} can be drawn together, INPUT, labels and numbers of opacity among them"
            ),
            "leave out some of --with",
        ));
    }
    Ok(())
}

/// What lines do not go with.
fn check_lines(scene: &SceneFlags, settings: &Settings) -> Result<(), Error> {
    if scene.flow.wind.is_some() && scene.flow.flow.is_none() && scene.barbs.barbs.is_none() {
        return Err(Error::usage(
            "--wind names a wind that nothing draws",
            "--flow stream draws its lines, --barbs its barbs",
        ));
    }
    let word = scene.flow.word_without_lines();
    let word = word.or_else(|| {
        scene
            .flow_style
            .word()
            .filter(|_| scene.flow.flow.is_none())
    });
    if let Some(word) = word {
        return Err(Error::usage(
            format!("{word} is of lines along the wind, and none are drawn"),
            "--flow stream draws them, and so do --show wind and --show both",
        ));
    }
    if !scene.has_lines() {
        return match scene.flow_style.hide_volume {
            true => Err(Error::usage(
                "--hide-volume leaves nothing without --flow, --map, --barbs, --ground or a surface or points by --with",
                "leave it out",
            )),
            false => Ok(()),
        };
    }
    scene.flow.check_words()?;
    let [_, height] = scene.picture.extent_pixels()?;
    scene.flow_style.check(height)?;
    if let Some(range) = scene.ground.ground_range {
        range.check_rises("--ground-range", "280,310")?;
    }
    if scene.flow.flow.is_some() && settings.filter != Filter::Linear {
        return Err(Error::usage(
            format!(
                "--flow with --filter {}: lines follow the linear field",
                settings.filter
            ),
            "leave out --filter",
        ));
    }
    let word = scene.geometry_word().unwrap_or("--points-as spheres");
    let refused =
        |problem: &str, hint: &str| Err(Error::usage(format!("{word} {problem}"), hint.to_owned()));
    if scene.points_are_spheres() && settings.technique != Technique::Raycast {
        return refused(
            &format!(
                "and --technique {}: a technique is of the samples of a volume, and spheres have none",
                settings.technique
            ),
            "leave out --technique",
        );
    }
    if let Err(problem) = check_geometry(settings) {
        return refused(
            &format!("ends rays and slices, and these do not end: {problem}"),
            match settings.splat.of_points {
                true => "--points-as spheres, grid or field",
                false => {
                    "--technique raycast, slices-2d or slices-3d, without --shadows half-angle and --aa-uneven"
                }
            },
        );
    }
    let stands_elsewhere = [
        ("--barbs", scene.barbs.barbs.is_some()),
        ("--ground", scene.ground.ground.is_some()),
    ];
    let stands_elsewhere = stands_elsewhere.into_iter().find(|(_, is_there)| *is_there);
    if let (true, Some((word, _))) = (scene.section.section.is_some(), stands_elsewhere) {
        return Err(Error::usage(
            format!(
                "{word} with --section: it stands at a height of its own, and not in the plane"
            ),
            "leave out one of them; --view top looks down on both",
        ));
    }
    if scene.section.section.is_some() && scene.points_are_spheres() {
        return refused(
            "with --section: a section is of a volume, and spheres are symbols beside it",
            "leave out one of them",
        );
    }
    if scene.flow_style.hide_volume && settings.mode != Mode::Composite {
        return refused(
            "with --hide-volume and another mode: there is no volume to project",
            "leave out --mode",
        );
    }
    Ok(())
}

fn check_in(scene: &SceneFlags, settings: &Settings) -> Result<(), Error> {
    let mode = settings.mode;
    scene.modes.check(settings)?;
    if scene.labels.labels.is_some() && scene.labels.label_dim.is_some() && mode != Mode::Composite
    {
        return Err(Error::usage(
            "--label-dim needs --mode composite: others cannot make a part of a ray faint",
            "--label-hide leaves it out",
        ));
    }
    check_with(scene, mode)?;
    scene.check_point_look()?;
    check_lines(scene, settings)?;
    scene.opacity.check()?;
    preclassified::check(scene, settings)?;
    if scene.opacity.are_given() && mode != Mode::Composite {
        return Err(Error::usage(
            format!(
                "{} needs --mode composite: the others show one number a ray",
                scene.opacity.word()
            ),
            "leave out --mode",
        ));
    }
    if scene.opacity.are_given() && settings.preintegrated {
        return Err(Error::usage(
            format!(
                "{} and --preintegrated: slabs are integrated over one number",
                scene.opacity.word()
            ),
            "leave out one of them",
        ));
    }
    let ClassificationFlags {
        preset,
        colormap,
        window,
        color_function,
        opacity_function,
        ..
    } = &scene.classification;
    let several = scene.channels.are_given() || scene.input.component == Some(Component::All);
    let one_function = [
        ("--preset", preset.is_some()),
        ("--tf", scene.classification.function_of_file()?.is_some()),
        ("--color-tf", color_function.is_some()),
        ("--opacity-tf", opacity_function.is_some()),
        ("--colormap", colormap.is_some()),
        ("--window", window.is_some()),
    ];
    match one_function.into_iter().find(|(_, is_given)| *is_given) {
        Some((flag, _)) if several => Err(Error::usage(
            format!("{flag} is for one number a voxel, and several are drawn"),
            "say it of each: --channel 0,color=cyan,window=0:100",
        )),
        _ => Ok(()),
    }
}
