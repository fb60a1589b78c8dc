//! The volumes of a film, one time after another: no more in memory than a frame needs.
//!
//! Between two times every voxel is mixed, `v = v0 + s (v1 - v0)`.

use super::together::Together;
use crate::{
    cli::{
        Error,
        flags::SceneFlags,
        flow::DrawnLines,
        load,
        memory::DeviceMemory,
        progress::Progress,
        scene_inputs::{Parts, SceneInputs, open_stream},
    },
    offscreen::Stream,
    transfer::{Quantity, ValueSummary},
    volume::{Limits, Problem, ReadError, Source, TimeComponent, Volume, Voxels},
};
use glam::DAffine3;
use std::{collections::BTreeSet, sync::Arc};

/// Voxels that all times together give to the choice of colours.
const MAX_SAMPLES: usize = 1 << 22;
/// Voxels that are taken one after the other: labels are known by what their neighbours are.
const RUN: usize = 256;

/// A volume at one time.
pub struct Moment {
    /// It; of a stream all but the voxels.
    pub volume: Arc<Volume>,
    /// Where voxels come from, where they are not in memory, and every n-th of them, unless others have looked at
    /// those.
    pub streamed: Option<(Stream, Option<Volume>)>,
    /// The volumes that are seen together with it, where they change with the time.
    pub together: Option<Box<SceneInputs>>,
}

impl Moment {
    /// Where voxels come from, where they are not in memory.
    pub fn stream(&self) -> Option<&Stream> {
        self.streamed.as_ref().map(|(stream, _)| stream)
    }

    fn in_memory(volume: Volume) -> Self {
        Self {
            volume: Arc::new(volume),
            streamed: None,
            together: None,
        }
    }

    /// What is seen together with it, if not `parts` at all times.
    pub fn parts(&self) -> Option<Parts<'_>> {
        self.together.as_ref().map(|shown| shown.parts())
    }

    /// Lines of this time.
    pub fn lines(&self) -> Option<&DrawnLines> {
        self.together.as_ref().and_then(|shown| shown.lines())
    }

    /// A volume that shows which values there are.
    pub fn looked_at(&self) -> &Volume {
        let overview = self.streamed.as_ref().and_then(|(_, seen)| seen.as_ref());
        overview.unwrap_or(&self.volume)
    }
}

/// Reads what frames need, and keeps it as long as the next frame needs it too.
pub struct Volumes<'a> {
    of: Of<'a>,
    scene: SceneFlags,
    progress: &'a Progress,
    first: Option<(TimeComponent, DAffine3)>,
    kept: Vec<(u32, Arc<Moment>)>,
    saw: &'a Saw<'a>,
}

/// Is told of every time that is read, with its volumes.
pub type Saw<'a> = dyn Fn(u32, &[&Volume]) -> Result<(), Error> + Sync + 'a;

/// What is read.
#[derive(Clone, Copy)]
enum Of<'a> {
    /// One number a voxel; with the device's memory, drawn brick by brick from the file.
    Source(&'a Arc<dyn Source>, Option<DeviceMemory>),
    /// All that is seen together.
    Together(&'a Together),
}

impl<'a> Volumes<'a> {
    /// Of the words of `scene`, which name times only in `source`.
    pub fn new(
        source: &'a Arc<dyn Source>,
        bricks: Option<DeviceMemory>,
        scene: &SceneFlags,
        progress: &'a Progress,
        saw: &'a Saw<'a>,
    ) -> Self {
        Self::of(Of::Source(source, bricks), scene, progress, saw)
    }

    /// Of all volumes that are seen together.
    pub fn together(
        together: &'a Together,
        scene: &SceneFlags,
        progress: &'a Progress,
        saw: &'a Saw<'a>,
    ) -> Self {
        Self::of(Of::Together(together), scene, progress, saw)
    }

    fn of(of: Of<'a>, scene: &SceneFlags, progress: &'a Progress, saw: &'a Saw<'a>) -> Self {
        Self {
            of,
            scene: scene.clone(),
            progress,
            first: None,
            kept: Vec::new(),
            saw,
        }
    }

    /// The volume at this time; of streams at a whole one.
    pub fn at(&mut self, time: f64) -> Result<Arc<Moment>, Error> {
        let [before, after] = [time.floor(), time.ceil()].map(|time| time as u32);
        self.kept
            .retain(|&(time, _)| time == before || time == after);
        let source = match self.of {
            Of::Source(source, _) => source,
            Of::Together(together) => return self.together_at(together, time),
        };
        let first = self.whole(source, before)?;
        if before == after {
            return Ok(first);
        }
        let second = self.whole(source, after)?;
        blend(&first.volume, &second.volume, time.fract())
            .map(|volume| Arc::new(Moment::in_memory(volume)))
            .map_err(|problem| {
                Error::Read(ReadError {
                    path: source.path().to_owned(),
                    problem,
                })
            })
    }

    fn whole(&mut self, source: &Arc<dyn Source>, time: u32) -> Result<Arc<Moment>, Error> {
        if let Some((_, moment)) = self.kept.iter().find(|kept| kept.0 == time) {
            return Ok(Arc::clone(moment));
        }
        let moment = match self.of {
            Of::Source(_, Some(memory)) => self.streamed(source, time, memory)?,
            Of::Source(..) | Of::Together(_) => Moment::in_memory(self.read(source, time)?),
        };
        (self.saw)(time, &[moment.looked_at()])?;
        let moment = Arc::new(moment);
        self.kept.push((time, Arc::clone(&moment)));
        Ok(moment)
    }

    fn together_at(&mut self, together: &Together, time: f64) -> Result<Arc<Moment>, Error> {
        let shown = together.at(time)?;
        let moment = Moment {
            volume: Arc::clone(&shown.volume),
            streamed: None,
            together: Some(Box::new(shown)),
        };
        if time.fract() == 0.0 {
            let parts = moment.parts();
            let beside = parts.as_ref().map(|parts| parts.beside().volumes());
            let beside = beside.unwrap_or_default();
            (self.saw)(time as u32, &[vec![moment.looked_at()], beside].concat())?;
        }
        Ok(Arc::new(moment))
    }

    fn streamed(
        &mut self,
        source: &Arc<dyn Source>,
        time: u32,
        memory: DeviceMemory,
    ) -> Result<Moment, Error> {
        self.scene.input.time = Some(time.to_string());
        let (pick, note) = self.scene.input.pick(source.header())?;
        let notes_of_file = source.header().notes.clone();
        let source = Arc::clone(source);
        let (stream, stretched) = open_stream(source, pick, &self.scene, memory, self.progress)?;
        // What is seen of it is small, whatever the memory for volumes.
        let overview = stream.overview();
        let whole = overview.header().whole();
        let seen = Volume::read(
            overview,
            TimeComponent::default(),
            whole,
            &Limits::default(),
        )?;
        if self.first.is_none() {
            let notes = notes_of_file.iter().chain(&note);
            notes
                .chain(&stretched)
                .for_each(|note| self.progress.note(note));
            self.progress.note(&format!(
                "each time is drawn from the file in {} bricks",
                stream.brick_count()
            ));
            self.first = Some((pick, stream.outline().world_from_voxel));
        }
        Ok(Moment {
            volume: Arc::new(stream.outline().clone()),
            streamed: Some((stream, Some(seen))),
            together: None,
        })
    }

    fn read(&mut self, source: &Arc<dyn Source>, time: u32) -> Result<Volume, Error> {
        Ok(match self.first {
            // What there is to say is said of the first.
            None => {
                self.scene.input.time = Some(time.to_string());
                let (pick, _) = self.scene.input.pick(source.header())?;
                let volume = load::read(source.as_ref(), &self.scene, self.progress)?;
                self.first = Some((pick, volume.world_from_voxel));
                volume
            }
            Some((pick, world_from_voxel)) => {
                let whole = source.header().whole();
                let limits = self.scene.input.limits();
                let pick = TimeComponent { time, ..pick };
                let mut volume = Volume::read(source.as_ref(), pick, whole, &limits)?;
                load::denoise(std::slice::from_mut(&mut volume), &self.scene)?;
                Volume {
                    // Stretched as the first is.
                    world_from_voxel,
                    ..volume
                }
            }
        })
    }

    /// What the values of these times look like together, so that colours mean the same in all frames.
    pub fn summary(&mut self, times: &BTreeSet<u32>) -> Result<ValueSummary, Error> {
        let per_time = MAX_SAMPLES / times.len().max(1);
        let mut pool = Vec::new();
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        let (mut diagonal, mut hounsfield, mut quantity) = (0.0, false, Quantity::Unknown);
        for (done, &time) in times.iter().enumerate() {
            self.progress.stage("look at all times", done, times.len());
            let moment = self.at(time.into())?;
            let (volume, seen) = (&moment.volume, moment.looked_at());
            if seen.no_data_count() < seen.voxels.len() as u64 {
                let [low, high] = volume.value_range;
                range = [range[0].min(low), range[1].max(high)];
            }
            diagonal = volume
                .world_from_voxel
                .transform_vector3(volume.grid().far_corner())
                .length();
            hounsfield = volume.hounsfield;
            quantity = Quantity::of_unit(volume.unit.as_deref());
            pool.extend(runs(seen.voxels.len(), per_time).map(|i| value(seen, i)));
        }
        if range[0] > range[1] {
            range = [0.0; 2];
        }
        Ok(
            ValueSummary::of(pool.len(), range, diagonal, hounsfield, |i| pool[i])
                .measuring(quantity),
        )
    }
}

/// At most `most` of `count` voxels (or one run), in runs at equal distances; all of them where they are few.
fn runs(count: usize, most: usize) -> impl Iterator<Item = usize> {
    let runs = if count <= most {
        count.div_ceil(RUN)
    } else {
        (most / RUN).max(1)
    };
    (0..runs).flat_map(move |run| {
        let start = (run as u128 * count as u128 / runs as u128) as usize;
        let next = ((run + 1) as u128 * count as u128 / runs as u128) as usize;
        start..next.min(start + RUN)
    })
}

fn value(volume: &Volume, i: usize) -> Option<f64> {
    let is_valid = volume.validity.as_ref().is_none_or(|valid| valid[i] != 0);
    let stored = f64::from(volume.voxels.stored(i));
    is_valid.then_some(stored * volume.rescale.slope + volume.rescale.intercept)
}

/// Between `a` (`s = 0`) and `b` (`s = 1`); no data where either has none.
pub fn blend(a: &Volume, b: &Volume, s: f64) -> Result<Volume, Problem> {
    let is_valid =
        |volume: &Volume, i: usize| volume.validity.as_ref().is_none_or(|valid| valid[i] != 0);
    let mixed = |i: usize| {
        if !is_valid(a, i) || !is_valid(b, i) {
            return f32::NAN;
        }
        let [a, b] = [a, b].map(|volume| f64::from(volume.voxels.stored(i)));
        (a + s * (b - a)) as f32
    };
    let voxels = Voxels::F32((0..a.voxels.len()).map(mixed).collect());
    let blended = Volume::from_voxels(a.dims, a.world_from_voxel, voxels, a.rescale, None)?;
    Ok(Volume {
        hounsfield: a.hounsfield,
        unit: a.unit.clone(),
        loss: a.loss.and(b.loss),
        ..blended
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::Rescale;

    fn volume(voxels: Voxels, fill: Option<f64>) -> Volume {
        let rescale = Rescale {
            slope: 2.0,
            intercept: 1.0,
        };
        Volume::from_voxels([3, 1, 1], DAffine3::IDENTITY, voxels, rescale, fill).expect("a volume")
    }

    #[test]
    fn a_blend_is_that_of_the_values_and_no_data_stays_no_data() {
        let a = volume(Voxels::U8(vec![0, 10, 255]), Some(255.0));
        let b = volume(Voxels::U8(vec![4, 30, 7]), None);
        let found = blend(&a, &b, 0.25).expect("a volume");
        // The hole takes the number of its neighbour.
        assert_eq!(found.voxels, Voxels::F32(vec![1.0, 15.0, 15.0]));
        assert_eq!(found.validity, Some(vec![1, 1, 0]));
        assert_eq!(found.value_range, [3.0, 31.0]);
    }

    #[test]
    fn samples_are_runs_over_all_of_the_volume_and_never_too_many() {
        assert_eq!(
            runs(1000, 5000).collect::<Vec<_>>(),
            (0..1000).collect::<Vec<_>>()
        );
        let found: Vec<_> = runs(10_000, 1024).collect();
        assert_eq!(found.len(), 1024);
        assert_eq!(found[..2], [0, 1]);
        assert_eq!(found[RUN], 2500);
        assert!(found.is_sorted_by(|a, b| a < b) && found[1023] < 10_000);
        assert_eq!(runs(10_000, 0).count(), RUN);
    }
}
