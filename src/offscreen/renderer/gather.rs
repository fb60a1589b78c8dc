//! One pass over all samples of a picture: parameters into the ring, one part a brick, submissions.

use super::pacing::Expected;
use super::{Renderer, parts_of};
use crate::offscreen::Error;
use crate::offscreen::passes::Passes;
use crate::offscreen::submission::{self, Submission};
use crate::offscreen::time_slices::Spent;
use crate::scene::Scene;
use crate::technique::{InPixel, Inputs, Recording};

impl Renderer<'_> {
    /// One pass of the technique, rays at one position in each pixel.
    pub(super) fn gather(
        &mut self,
        scene: &Scene,
        in_pixel: InPixel,
    ) -> Result<Option<f64>, Error> {
        if self.streaming.is_some() {
            return self.gather_stream(scene, in_pixel);
        }
        let (spent, expected) = self.pass(scene, in_pixel, Passes::gather)?;
        self.learn(expected, &spent);
        Ok(spent.gpu_ms)
    }

    /// The next of the passes over all samples that the picture takes.
    pub(super) fn pass(
        &mut self,
        scene: &Scene,
        in_pixel: InPixel,
        pass: impl FnOnce(&Passes, Submission) -> Result<Spent, crate::gpu::Error>,
    ) -> Result<(Spent, Expected), Error> {
        let [done, of] = self.passes_done;
        let span = self.slices.enter(done, of);
        let submitted = self.submit(scene, in_pixel, pass);
        self.slices.leave(span);
        self.passes_done[0] += 1;
        submitted
    }

    /// Parameters into the ring, then submissions.
    fn submit(
        &mut self,
        scene: &Scene,
        in_pixel: InPixel,
        pass: impl FnOnce(&Passes, Submission) -> Result<Spent, crate::gpu::Error>,
    ) -> Result<(Spent, Expected), Error> {
        let grid = scene.volume.grid();
        let view = scene.view(&grid, in_pixel);
        let transfer = self.transfer.as_ref().map(|uploaded| &uploaded.made);
        let parts = parts_of(&self.resident, self.shown, scene);
        let mut recordings = view.recordings_of(&parts, transfer)?;
        let expected = self.expected(scene, &view, &recordings, parts.len());
        let skip = self.skipped.skip();
        for recording in &mut recordings {
            recording.skip(skip);
        }
        let beside = |recording: &Recording| -> Vec<_> {
            let others = parts[1..].iter();
            others
                .map(|part| &part.volume.bricks()[recording.brick])
                .collect()
        };
        let beside: Vec<_> = recordings.iter().map(beside).collect();
        let part = |(slot, (recording, beside)): (u32, (Recording, _))| {
            let volume = parts[0].volume;
            let inputs = Inputs {
                ring: &self.ring,
                volume,
                brick: &volume.bricks()[recording.brick],
                transfer,
                beside,
                light: self.light.as_ref().map(|lit| &lit.made),
                skip,
            };
            Ok(submission::Part {
                inputs,
                offset: recording.write(&self.ring, slot)?,
                slices: recording.slices,
                order: recording.order,
                seen: None,
            })
        };
        let with_others = recordings.into_iter().zip(beside.iter().map(Vec::as_slice));
        let drawn = (0..).zip(with_others).map(part);
        let bricks = drawn.collect::<Result<Vec<_>, Error>>()?;
        let submission = Submission {
            device: &mut self.device,
            targets: self.targets.as_ref().expect("prepared"),
            bricks: &bricks,
            timer: self.timer.as_ref(),
            slices: &mut self.slices,
            expected_ms: expected.ms,
            is_drawing: true,
            resumes: false,
        };
        let spent = pass(self.passes.as_ref().expect("prepared"), submission)?;
        Ok((spent, expected))
    }
}
