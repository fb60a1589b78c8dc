//! From the words to a volume in memory: opened, compared with the memory that is there, read.

use super::{
    Error, exaggerate, flags::SceneFlags, memory::fitting, progress::Progress, renderer::Device,
};
use crate::volume::{Loss, Source, Volume};

/// The one volume that the words name, in memory.
pub fn load(scene: &SceneFlags, device: &Device, progress: &Progress) -> Result<Volume, Error> {
    let limits = scene.input.limits();
    let source = scene.input.open(&limits)?;
    // What may be wrong with the words is said before anything about memory.
    scene.input.pick(source.header())?;
    let source = fitting(source, &scene.input, device.memory())?;
    load_from(scene, source.as_ref(), progress)
}

/// The one volume of `source` that the words name, in memory; there is enough.
pub fn load_from(
    scene: &SceneFlags,
    source: &dyn Source,
    progress: &Progress,
) -> Result<Volume, Error> {
    let (pick, note) = scene.input.pick(source.header())?;
    for note in source.header().notes.iter().chain(&note) {
        progress.note(note);
    }
    let whole = source.header().whole();
    let mut volume = Volume::read(source, pick, whole, &scene.input.limits())?;
    let (factor, note) = exaggerate::factor(scene, &volume.grid(), source.header().is_earth)?;
    volume.world_from_voxel = exaggerate::stretched(volume.world_from_voxel, factor);
    if let Some(note) = &note {
        progress.note(note);
    }
    if !volume.loss.is_none() {
        let Loss { changed, worst } = volume.loss;
        progress.note(&format!(
            "{changed} voxels were rounded to 32-bit floats, by at most {worst}"
        ));
    }
    let no_data = volume.no_data_count();
    if no_data > 0 {
        progress.note(&format!("{no_data} voxels hold no data"));
    }
    Ok(volume)
}
