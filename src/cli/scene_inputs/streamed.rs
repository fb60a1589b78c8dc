//! A volume that is too large for the memory: drawn brick by brick from its file.

use super::{Others, Plan, SceneInputs, check::plan, has_beside};
use crate::cli::Error;
use crate::cli::exaggerate;
use crate::cli::flags::{InputFlags, SceneFlags};
use crate::cli::memory::{DeviceMemory, DeviceRoom, Held, for_bricks, is_too_large};
use crate::cli::progress::Progress;
use crate::format;
use crate::offscreen::{Stream, StreamOptions};
use crate::technique::Settings;
use crate::volume::{Source, TimeComponent};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

/// Whether the volume is drawn brick by brick: because a word says so, or because it is too large and can be.
pub fn is_wanted(
    source: &dyn Source,
    scene: &SceneFlags,
    settings: &Settings,
    device: &dyn DeviceRoom,
) -> Result<bool, Error> {
    let header = source.header();
    let what = match () {
        () if plan(scene, header)?.0 != Plan::One => Some("several numbers a voxel"),
        () if scene.labels.labels.is_some() || has_beside(scene, settings.mode) => {
            Some("--with, --labels and what else is seen together with a volume")
        }
        () if scene.denoise.is_some() => Some("--denoise"),
        () if scene.points_are_spheres() || settings.field.is_some() => Some(POINTS),
        () if !settings.technique.streams() => {
            Some("--technique slices-3d, slices-2d, shear-warp, splat and pathtrace")
        }
        () if settings.filter.spline().is_some() => Some("--filter quadratic and cubic"),
        () if settings.single_scattering.is_some() => Some("--scattering single"),
        () if settings.wants_light_volume() => Some("--ambient-occlusion and --shadows"),
        () if header.is_labels => Some("labels in their own colours"),
        () if !source.reads_parts() => Some(AS_A_WHOLE),
        () => None,
    };
    if !scene.input.stream {
        if what.is_some_and(|what| what != AS_A_WHOLE) || scene.input.fit {
            return Ok(false);
        }
        // A little volume does not wait for the device.
        let held = Held::of(scene, 1);
        let is_needed = is_too_large(header, scene, None, held)
            || !crate::cli::memory::is_little(header, scene, held)
                && is_too_large(header, scene, device.memory()?, held);
        return match (is_needed, what) {
            (true, Some(_)) if device.memory()?.is_some() => {
                let name = source.path().display();
                Err(in_no_parts(
                    source,
                    format!(
                        "{name}: there is no memory for all of it, and {AS_A_WHOLE} has no parts"
                    ),
                    false,
                ))
            }
            (is_needed, what) => Ok(is_needed && what.is_none()),
        };
    }
    let what = match device.memory()? {
        None => Some("--device reference"),
        Some(_) => what,
    };
    match what {
        None => Ok(true),
        Some(AS_A_WHOLE) => {
            let message = format!("--stream is not for {AS_A_WHOLE}");
            Err(in_no_parts(source, message, true))
        }
        Some(POINTS) => Err(Error::usage(
            format!("--stream is not for {POINTS}"),
            "leave it out: points are read whole",
        )),
        Some(what) => Err(Error::usage(
            format!("--stream is not for {what}"),
            "--fit draws a reduced volume that fits into memory",
        )),
    }
}

const POINTS: &str = "scattered points";
const AS_A_WHOLE: &str = "a file that is compressed as a whole";

/// Says which command makes bricks of the file.
fn in_no_parts(source: &dyn Source, message: String, is_usage: bool) -> Error {
    let path = source.path();
    let bricks = path.with_file_name(format!("{}.svb", format::stem(path)));
    let [from, to] = [path, &bricks].map(Path::display);
    Error::NotInParts {
        message,
        hint: format!(
            "`stratavox convert {from} -o {to}` makes bricks of it; --fit draws it with fewer voxels"
        ),
        is_usage,
    }
}

/// Looks at all of one time of the source, and places it as high as it is drawn; and what a person should know of that.
pub fn open(
    source: Arc<dyn Source>,
    pick: TimeComponent,
    scene: &SceneFlags,
    memory: DeviceMemory,
    progress: &Progress,
) -> Result<(Stream, Option<String>), Error> {
    let [device_bytes, piece_bytes] = for_bricks(scene, memory);
    let options = StreamOptions {
        piece_bytes,
        device_bytes,
        all_device_bytes: device_bytes,
        ..StreamOptions::default()
    };
    let is_earth = source.header().is_earth;
    let stream = Stream::open(source, pick, options, &mut |done, of| {
        progress.stage("look", done, of);
        ControlFlow::Continue(())
    })?;
    let stream = stream.expect("nobody ends it");
    let grid = stream.outline().grid();
    let (height_factor, note) = exaggerate::factor(scene, &grid, is_earth)?;
    let placed = exaggerate::stretched(grid.world_from_voxel, height_factor);
    Ok((stream.placed(placed), note))
}

impl SceneInputs {
    /// Looks at all of the source once, and takes from an overview how values are seen.
    pub(super) fn streamed(
        source: Box<dyn Source>,
        scene: &SceneFlags,
        settings: &Settings,
        device: &dyn DeviceRoom,
        progress: &Progress,
    ) -> Result<Self, Error> {
        let (pick, note) = scene.input.pick(source.header())?;
        for note in source.header().notes.iter().chain(&note) {
            progress.note(note);
        }
        let Some(memory) = device.memory()? else {
            return Self::of(source, scene, settings, device, progress);
        };
        let header = source.header().clone();
        let (stream, _) = open(Arc::from(source), pick, scene, memory, progress)?;
        let bricks = match stream.brick_count() {
            1 => "one brick".to_owned(),
            count => format!("{count} bricks"),
        };
        let seen = match stream.overview().every() {
            1 => "all voxels".to_owned(),
            every => format!("one voxel of {every} along each axis"),
        };
        progress.note(&format!(
            "drawn from the file in {bricks}; what no flag says is chosen from {seen}"
        ));
        // An overview holds what was picked.
        let of_overview = SceneFlags {
            input: InputFlags {
                path: scene.input.path.clone(),
                variable: scene.input.variable.clone(),
                series: scene.input.series.clone(),
                ..InputFlags::default()
            },
            ..scene.clone()
        };
        let overview = Box::new(stream.overview().clone());
        let shown = Self::of(overview, &of_overview, settings, device, progress)?;
        let Others::Channels(_) = shown.others else {
            unreachable!("one number a voxel is no colour");
        };
        Ok(Self {
            header,
            volume: Arc::new(stream.outline().clone()),
            stream: Some(stream),
            overview: Some(shown.volume),
            ..shown
        })
    }
}
