//! From the words to volumes in memory: opened, compared with the memory that is there, read.

use super::{
    Error, exaggerate,
    flags::{DenoiseWord, InputFlags, SceneFlags},
    memory::{DeviceRoom, Held, fitting, is_little},
    progress::Progress,
    renderer::Device,
    timings::Loaded,
};
use crate::volume::{ComponentKind, Header, Limits, Magnitude, PrecisionLoss, Source, Volume};

/// The source that the words name. Vectors are taken by their length, unless a word takes something else.
pub fn open(input: &InputFlags, limits: &Limits) -> Result<Box<dyn Source>, Error> {
    let source = input.open(limits)?;
    let header = source.header();
    if input.component.is_none() && header.meaning == ComponentKind::Vector && header.components > 1
    {
        return Ok(Box::new(Magnitude::new(source)));
    }
    Ok(source)
}

/// The same of a scene, whose look may take the first of several variables that is no coordinate; it is said.
pub fn open_first(
    scene: &mut SceneFlags,
    limits: &Limits,
    progress: &Progress,
) -> Result<Box<dyn Source>, Error> {
    let source = open(&scene.input, limits)?;
    scene.take_first_variable(source.header(), progress);
    // Where no word names one the source is of the first in the file.
    let source = match (&scene.input.variable, source.header().variables.first()) {
        (Some(taken), Some(opened)) if taken != opened => open(&scene.input, limits)?,
        _ => source,
    };
    scene.set_matter(source.header());
    Ok(source)
}

/// The one volume of `source` that the words pick, and how much higher than it is it will be drawn.
pub fn load_from(
    source: Box<dyn Source>,
    scene: &SceneFlags,
    device: &dyn DeviceRoom,
    progress: &Progress,
) -> Result<(Volume, f64), Error> {
    // What may be wrong with the words is said before anything about memory.
    scene.input.pick(source.header())?;
    let beside = scene.with.volumes().count() as u32 + u32::from(scene.opacity.are_given());
    let held = Held::of(scene, 1 + beside);
    // A little volume is read while the device is still being made, and then compared with what that has.
    let is_ahead = scene.denoise.is_none() && is_little(source.header(), scene, held);
    let ahead = is_ahead.then(|| read_stretched(source.as_ref(), scene, progress));
    let dims = source.header().dims;
    let source = fitting(source, scene, device.memory()?, held)?;
    if let Some(read) = ahead.filter(|_| source.header().dims == dims) {
        return read;
    }
    read_stretched(source.as_ref(), scene, progress)
}

/// The one volume of `source` that the words pick; there is memory for it.
pub fn read(source: &dyn Source, scene: &SceneFlags, progress: &Progress) -> Result<Volume, Error> {
    let (volume, _) = read_stretched(source, scene, progress)?;
    Ok(volume)
}

fn read_stretched(
    source: &dyn Source,
    scene: &SceneFlags,
    progress: &Progress,
) -> Result<(Volume, f64), Error> {
    let (pick, note) = scene.input.pick(source.header())?;
    for note in source.header().notes.iter().chain(&note) {
        progress.note(note);
    }
    prepare(source, &scene.input, progress);
    let (mut volume, loaded) = Loaded::volume(source, pick, &scene.input.limits())?;
    progress.loaded(loaded);
    say_what_was_lost(&volume, "voxels", progress);
    denoise(std::slice::from_mut(&mut volume), scene)?;
    let factor = stretch(
        std::slice::from_mut(&mut volume),
        scene,
        source.header(),
        progress,
    )?;
    Ok((volume, factor))
}

/// Makes voxels of points where a word wants a grid of them, and tells how far that is.
pub fn prepare(source: &dyn Source, input: &InputFlags, progress: &Progress) {
    if input.on_grid.is_some() {
        progress.stage("interpolate", 0, 1);
        source.prepare(&|part| progress.part(part));
    }
}

/// Takes the noise out of volumes where a word wants it.
pub fn denoise(volumes: &mut [Volume], scene: &SceneFlags) -> Result<(), Error> {
    let Some(DenoiseWord(filter)) = scene.denoise else {
        return Ok(());
    };
    let mut device = Device::find(scene.device.first().map(String::as_str))?;
    for volume in volumes {
        (*volume, device) = device.denoised(volume, &filter)?;
    }
    Ok(())
}

/// Stretches volumes of one grid upward as far as the words or the planet want it, says so, and gives the factor.
pub fn stretch(
    volumes: &mut [Volume],
    scene: &SceneFlags,
    header: &Header,
    progress: &Progress,
) -> Result<f64, Error> {
    let Some(first) = volumes.first() else {
        return Ok(1.0);
    };
    let (factor, note) = exaggerate::factor(scene, &first.grid(), header.is_earth)?;
    if let Some(note) = &note {
        progress.note(note);
    }
    for volume in volumes {
        volume.world_from_voxel = exaggerate::stretched(volume.world_from_voxel, factor);
    }
    Ok(factor)
}

/// Notes on what is not in memory as it is in the file; `voxels` is what they are called.
pub fn say_what_was_lost(volume: &Volume, voxels: &str, progress: &Progress) {
    if !volume.loss.is_none() {
        let PrecisionLoss { changed, worst } = volume.loss;
        progress.note(&format!(
            "{changed} {voxels} were rounded to 32-bit floats, by at most {worst}"
        ));
    }
    let no_data = volume.no_data_count();
    if no_data > 0 {
        progress.note(&format!("{no_data} {voxels} hold no data"));
    }
}
