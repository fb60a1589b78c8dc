//! One pass over all samples of a picture: parameters into the ring, one part a brick, submissions.

use super::pacing::Expected;
use super::{Renderer, parts_of};
use crate::gpu::{Gpu, Resource};
use crate::offscreen::Error;
use crate::offscreen::submission::Submission;
use crate::offscreen::time_slices::Spent;
use crate::scene::{Beside, Scene};
use crate::technique::gather::{BrickPass, PICTURE};
use crate::technique::splat::{GpuViewPoints, ViewPoints};
use crate::technique::{InPixel, Inputs, Recording};
use std::sync::Arc;

impl Renderer<'_> {
    /// One pass of the technique, rays at one position in each pixel. Milliseconds on the device.
    pub(super) fn gather(
        &mut self,
        scene: &Scene,
        in_pixel: InPixel,
    ) -> Result<Option<f64>, Error> {
        if self.streaming.is_some() {
            return self.gather_stream(scene, in_pixel);
        }
        let (spent, expected) = self.pass(scene, in_pixel, Pass::Values)?;
        self.learn(expected, &spent);
        Ok(spent.gpu_ms)
    }

    /// The same and the colours of it: in one submission where none of it takes long.
    pub(super) fn colors(
        &mut self,
        scene: &Scene,
        in_pixel: InPixel,
    ) -> Result<(Vec<[f32; 4]>, Option<f64>), Error> {
        let targets = self.targets.as_ref().expect("prepared");
        let is_long = self.resolve_ms() > MOST_OF_A_RESOLVE * self.slices.target_ms;
        if self.streaming.is_some() || is_long || !targets.output.is_small() {
            let gpu_ms = self.gather(scene, in_pixel)?;
            return Ok((self.resolve()?, gpu_ms));
        }
        let (spent, expected) = self.pass(scene, in_pixel, Pass::Colors)?;
        self.learn(expected, &spent);
        let targets = self.targets.as_ref().expect("prepared");
        Ok((targets.output.pixels()?, spent.gpu_ms))
    }

    /// The next of the passes over all samples that the picture takes.
    pub(super) fn pass(
        &mut self,
        scene: &Scene,
        in_pixel: InPixel,
        pass: Pass,
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
        pass: Pass,
    ) -> Result<(Spent, Expected), Error> {
        let grid = scene.volume.grid();
        let view = scene.view(&grid, in_pixel);
        let transfer = self.transfer.get();
        let parts = parts_of(&self.resident, self.shown, scene);
        let mut recordings = view.recordings_of(&parts, transfer)?;
        let expected = self.expected(scene, &view, &recordings, parts.len());
        if pass == Pass::Count && scene.settings.is_half_angle() {
            // The light's samples are no pixel's.
            recordings.truncate(1);
        }
        let skip = self.skipped.skip();
        let passes = self.passes.as_ref().expect("prepared");
        let leaves_path_layers = scene.settings.technique.traces_paths() && passes.writes_layers();
        let behind = self
            .behind
            .as_ref()
            .and_then(|behind| behind.ends(scene.settings));
        let max_loop_turns = self.device.gpu().limits().max_loop_turns;
        for recording in &mut recordings {
            recording.skip(skip);
            scene.tell_paths(&mut recording.frame, max_loop_turns)?;
            if leaves_path_layers {
                // Of tiles without matter too.
                recording.frame.draws_all_tiles = 1;
            }
            if let Some(ends) = &behind {
                ends.tell(recording, grid.center());
            }
        }
        let points = match scene.beside {
            Beside::Points(_) if scene.settings.field.is_some() => {
                recordings = self.field_recordings(scene, &view, recordings[0])?;
                None
            }
            Beside::Points(points) => {
                let seen = ViewPoints::new(&view, points)?;
                let gpu = self.device.gpu();
                recordings = seen.parts(recordings[0], points_at_once(gpu, scene));
                Some(GpuViewPoints::new(gpu, &seen)?)
            }
            _ => {
                let at_once =
                    view.splat_sheets_at_once(self.device.gpu().limits().max_loop_turns)?;
                if let (count @ 2.., [whole]) = (view.splat_parts(at_once), recordings.as_slice()) {
                    recordings = whole.in_parts(count, at_once);
                }
                None
            }
        };
        let sky = self.path_sky.of(self.device.gpu(), scene)?;
        let beside = |recording: &Recording| -> Vec<_> {
            let others = parts[1..].iter();
            others
                .map(|part| &part.volume.bricks()[recording.brick])
                .collect()
        };
        let beside: Vec<_> = recordings.iter().map(beside).collect();
        let volume = parts[0].volume;
        let of_recording = |(recording, beside): (&Recording, _)| Inputs {
            ring: &self.ring,
            volume,
            brick: &volume.bricks()[recording.brick],
            transfer,
            beside,
            light: self.light.get(),
            points: points.as_ref(),
            field: self.field.get().map(|field| &field.on_device),
            sky,
            skip,
        };
        let with_others = recordings.iter().zip(beside.iter().map(Vec::as_slice));
        let inputs: Vec<_> = with_others.map(of_recording).collect();
        let brick = |(number, recording): (usize, &Recording)| {
            Ok(BrickPass {
                number,
                offset: recording.write(&self.ring, number as u32)?,
                slices: recording.slices,
                order: recording.order,
                seen: None,
            })
        };
        let bricks = recordings.iter().enumerate().map(brick);
        let bricks = bricks.collect::<Result<Vec<_>, Error>>()?;
        let gpu = Arc::clone(self.device.gpu());
        let targets = self.targets.as_mut().expect("prepared");
        if pass == Pass::Count {
            targets.prepare_count(&gpu, passes)?;
        }
        let finish = match pass {
            Pass::Colors => {
                let (picture, slot) = (targets.canvas.image(PICTURE), self.ring.offset(0)?);
                let ring = (&self.ring, slot);
                Some(passes.finish(picture, &targets.output, ring, transfer)?)
            }
            Pass::Values | Pass::Count => None,
        };
        let (gather, canvas) = match pass {
            Pass::Values | Pass::Colors => (passes.picture(), &mut targets.canvas),
            Pass::Count => (
                passes.count(&gpu)?,
                targets.count.as_mut().expect("made above"),
            ),
        };
        let behind = behind.map(|ends| Resource::sampled(ends.image));
        let submission = Submission {
            device: &mut self.device,
            timer: self.timer.as_ref(),
            slices: &mut self.slices,
            expected_ms: expected.ms,
            is_drawing: true,
            finish: finish.as_ref(),
        };
        let spent = submission.gather(gather, canvas, (&inputs, &bricks), behind, false)?;
        Ok((spent, expected))
    }
}

/// How many scattered points one recording goes through, so that the loops of no pixel are longer than the device allows: a
/// point takes a turn, and those of a search among the control points of its function.
pub(super) fn points_at_once(gpu: &Gpu, scene: &Scene) -> u32 {
    let functions = scene.transfers().into_iter().flatten();
    let searched = functions.map(|f| f.color.len() + f.opacity.len()).max();
    let turns = 2 + searched.unwrap_or(0) as u32;
    // One turn finds that the list has ended.
    (gpu.limits().max_loop_turns / turns).max(2) - 1
}

/// A resolve of its own submission takes more than this part of one.
const MOST_OF_A_RESOLVE: f64 = 0.25;

/// What a pass over all samples is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Pass {
    /// What the technique gathers.
    Values,
    /// The same, and the colours of it, read back.
    Colors,
    /// How many samples a slicer takes in each pixel.
    Count,
}
