//! A picture of a volume that comes brick by brick.
//!
//! ```text
//! bricks in the picture whose values are seen, from front to back
//!     one thread reads ahead                     the others: upload, draw so many at once, see what is hidden now
//! ```
//!
//! What is left out adds nothing: the picture is the same to the bit (`sampling.md` 5).

use super::Renderer;
use crate::gpu::{Gpu, Resource, Tile, Use};
use crate::offscreen::Error;
use crate::offscreen::stream::{Cache, Eye, Place, Stream};
use crate::offscreen::submission::Submission;
use crate::offscreen::time_slices::Spent;
use crate::resident::Halo;
use crate::scene::Scene;
use crate::technique::cost::{fetches_of_picture, ms_of_fetches};
use crate::technique::gather::{BrickPass, LAYERS, PICTURE};
use crate::technique::{GpuChannel, InPixel, Inputs, Mode, SkipBy, Skippable, View};
use crate::volume::Volume;
use std::collections::HashMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, sync_channel};
use std::thread;

/// Bricks that are drawn by one submission.
pub(super) const BRICKS_AT_ONCE: usize = 4;

/// Bricks that are read ahead.
const AHEAD: usize = 2;

/// A stream and what of it is on the device.
#[derive(Debug)]
pub struct Streaming<'v> {
    /// Where bricks come from.
    pub stream: &'v Stream,
    /// Those that are there.
    pub cache: Cache,
}

/// A brick that a picture shows.
struct Shown {
    brick: usize,
    place: Place,
    /// The values that filters may make in it.
    range: [f32; 2],
}

/// A brick that was read.
type Read = (usize, Result<Volume, crate::volume::ReadError>);

impl<'v> Renderer<'v> {
    /// What a stream cannot be drawn with.
    pub(super) fn check_stream(&self, scene: &Scene) -> Result<(), Error> {
        let outline = scene.volume.is_outline();
        let Some(streaming) = &self.streaming else {
            return match outline {
                true => Err(Error::Outline),
                false => Ok(()),
            };
        };
        let settings = scene.settings;
        if !outline || scene.volume.grid() != streaming.stream.outline().grid() {
            return Err(Error::Outline);
        }
        let refused = match () {
            () if !settings.technique.streams() => "another technique than ray casting",
            () if scene.volumes().len() > 1 => "several volumes",
            () if scene.is_classified() => "classified voxels",
            () if settings.filter.spline().is_some() => "a filter that reads coefficients",
            () if settings.single_scattering.is_some() => "single scattering",
            () if settings.wants_light_volume() => "occlusion or shadows",
            () if settings.adaptive_steps.is_some() => "adaptive steps",
            () if settings.empty_space != SkipBy::Cells => "empty space by an octree or by runs",
            () if settings
                .gradient_source_beside(crate::resident::TextureLayout::Texture3d)
                .is_some()
                && scene.has_gradients() =>
            {
                "gradients that are made of coefficients"
            }
            () => return Ok(()),
        };
        Err(Error::NotStreamed { what: refused })
    }

    /// Brings in the brick that comes first, so that it is known how bricks lie on the device.
    pub(super) fn prepare_stream(&mut self, scene: &Scene) -> Result<(), Error> {
        let Some(Streaming { stream, cache }) = &mut self.streaming else {
            return Ok(());
        };
        if cache.any().is_some() {
            return Ok(());
        }
        let (skippable, halo) = skippable(scene);
        let way = (&skippable, halo);
        let shown = shown(stream, scene, way);
        let first = shown.first().map_or(0, |shown| shown.brick);
        let voxels = stream.read(first)?;
        cache.put(&mut self.device, stream, first, &voxels, way, &[])
    }

    /// All that the picture shows of the stream, into the accumulation. Milliseconds on the device.
    pub(super) fn gather_stream(
        &mut self,
        scene: &Scene,
        in_pixel: InPixel,
    ) -> Result<Option<f64>, Error> {
        let (skippable, halo) = skippable(scene);
        let way = (&skippable, halo);
        let mut streaming = self.streaming.take().expect("a stream is drawn");
        let [done, of] = self.passes_done;
        let span = self.slices.enter(done, of);
        let outcome = self.gather_bricks(scene, in_pixel, way, &mut streaming);
        self.slices.leave(span);
        self.passes_done[0] += 1;
        self.streaming = Some(streaming);
        outcome
    }

    fn gather_bricks(
        &mut self,
        scene: &Scene,
        in_pixel: InPixel,
        way: (&Skippable, Halo),
        streaming: &mut Streaming,
    ) -> Result<Option<f64>, Error> {
        let Streaming { stream, cache } = streaming;
        let stream: &Stream = stream;
        let shown = shown(stream, scene, way);
        let grid = scene.volume.grid();
        let fetches = fetches_of_picture(&scene.view(&grid, in_pixel), 0, 1);
        let mut guess = Guess::new(self.device.gpu(), fetches / shown.len().max(1) as f64);
        let numbers: Vec<_> = shown.iter().map(|shown| shown.brick).collect();
        cache.begin(&numbers);
        let missing: Vec<_> = numbers
            .iter()
            .copied()
            .filter(|&brick| cache.get(brick).is_none())
            .collect();
        let is_hidden: Vec<AtomicBool> = shown.iter().map(|_| AtomicBool::new(false)).collect();
        thread::scope(|scope| {
            let (send, ready) = sync_channel::<Read>(AHEAD);
            let (shown, is_hidden, to_read) = (&shown, &is_hidden, missing.clone());
            scope.spawn(move || {
                let numbers = shown.iter().map(|shown| shown.brick);
                let hidden: HashMap<_, _> = numbers.zip(is_hidden).collect();
                let is_wanted = |brick| !hidden[&brick].load(Ordering::Relaxed);
                let mut left = &to_read[..];
                // Nobody waits any more where the picture has failed.
                let mut is_awaited = true;
                while is_awaited && !left.is_empty() {
                    let (row, rest) = left.split_at(stream.together(left));
                    is_awaited = stream.read_row(row, is_wanted, |brick, voxels| {
                        send.send((brick, voxels)).is_ok()
                    });
                    left = rest;
                }
            });
            let ahead = Ahead { ready, missing };
            let mut clock = Some(0.0);
            let mut next = 0;
            let mut is_first = true;
            loop {
                let mut chunk = Vec::new();
                let mut tiles = Vec::new();
                let before = next;
                while next < shown.len() && chunk.len() < BRICKS_AT_ONCE {
                    let Shown { brick, place, .. } = shown[next];
                    if is_hidden[next].load(Ordering::Relaxed) {
                        cache.drawn(brick);
                        next += 1;
                        continue;
                    }
                    let is_there = cache.get(brick).is_some();
                    // What is there is drawn before more comes that has no room beside it.
                    let has_room = is_there
                        || chunk.is_empty()
                        || cache.make_room(&mut self.device, stream, &chunk);
                    if !has_room {
                        break;
                    }
                    next += 1;
                    chunk.push(brick);
                    tiles.push(Some(Tile::around(place.pixels, scene.extent_pixels)));
                    if !is_there {
                        let voxels = ahead.take(stream, brick)?;
                        cache.put(&mut self.device, stream, brick, &voxels, way, &chunk)?;
                    }
                }
                // Where nothing is seen, any brick makes the empty picture.
                chunk.extend(cache.any_number().filter(|_| chunk.is_empty() && is_first));
                if chunk.is_empty() {
                    break;
                }
                let is_last = next == shown.len();
                let ends = [is_first, is_last];
                let span = self.slices.enter_some(before..next, shown.len());
                let expected_ms = guess.ms(chunk.len());
                let what = (&mut *cache, way, expected_ms);
                tiles.resize(chunk.len(), None);
                let drawn = self.draw(scene, in_pixel, what, (&chunk, &tiles), ends);
                self.slices.leave(span);
                let Spent { gpu_ms, wall_ms } = drawn?;
                guess.took(chunk.len(), wall_ms);
                clock = clock.zip(gpu_ms).map(|(sum, more)| sum + more);
                chunk.iter().for_each(|&brick| cache.drawn(brick));
                is_first = false;
                if !is_last {
                    self.hide(scene, &shown[next..], &is_hidden[next..])?;
                }
            }
            Ok(clock)
        })
    }

    /// Draws bricks that are there, one after the other.
    fn draw(
        &mut self,
        scene: &Scene,
        in_pixel: InPixel,
        (cache, way, expected_ms): (&mut Cache, (&Skippable, Halo), f64),
        (chunk, tiles): (&[usize], &[Option<Tile>]),
        [is_first, is_last]: [bool; 2],
    ) -> Result<Spent, Error> {
        cache.find_empty_space(&mut self.device, way, chunk)?;
        let grid = scene.volume.grid();
        let view = scene.view(&grid, in_pixel);
        let transfer = self.transfer.get();
        let behind = self.behind.as_ref();
        let behind = behind.and_then(|behind| behind.ends(scene.settings));
        let (mut inputs, mut bricks) = (Vec::new(), Vec::new());
        for (nth, (&brick, &seen)) in chunk.iter().zip(tiles).enumerate() {
            let there = cache.get(brick).expect("bricks of a chunk stay");
            let ends = [is_first && nth == 0, is_last && nth + 1 == chunk.len()];
            let mut recording = view.recording_of_brick(&there.volume, transfer, ends)?;
            let skip = there.skip(way);
            recording.skip(skip);
            if let Some(behind) = behind {
                behind.tell(&mut recording, grid.center());
            }
            inputs.push(Inputs {
                ring: &self.ring,
                volume: &there.volume,
                brick: &there.volume.bricks()[0],
                transfer,
                beside: &[],
                light: None,
                points: None,
                field: None,
                sky: None,
                skip,
            });
            bricks.push(BrickPass {
                number: nth,
                offset: recording.write(&self.ring, nth as u32)?,
                slices: recording.slices,
                order: recording.order,
                seen: seen.filter(|_| !ends[0]),
            });
        }
        let submission = Submission {
            device: &mut self.device,
            timer: self.timer.as_ref(),
            slices: &mut self.slices,
            expected_ms,
            is_drawing: true,
            finish: None,
        };
        let gather = self.passes.as_ref().expect("prepared").picture();
        let canvas = &mut self.targets.as_mut().expect("prepared").canvas;
        let behind = behind.map(|behind| Resource::sampled(behind.image));
        Ok(submission.gather(gather, canvas, (&inputs, &bricks), behind, !is_first)?)
    }

    /// Marks the bricks that can add nothing any more: all of their rays have ended, or have met larger values.
    fn hide(
        &mut self,
        scene: &Scene,
        rest: &[Shown],
        is_hidden: &[AtomicBool],
    ) -> Result<(), Error> {
        let settings = scene.settings;
        let targets = self.targets.as_ref().expect("prepared");
        let image = match settings.mode {
            Mode::Composite | Mode::Iso => LAYERS,
            Mode::Mip | Mode::Minip if !settings.per_mode.exact_maximum => PICTURE,
            _ => return Ok(()),
        };
        if !settings.skip {
            return Ok(());
        }
        let image = targets.canvas.image(image);
        let pixels = targets.read(&mut self.device, image, Use::FragmentSampled)?;
        let width = scene.extent_pixels[0] as usize;
        let has_ended = |[value, weight, transmittance, _]: [f32; 4], [low, high]: [f32; 2]| {
            match settings.mode {
                Mode::Mip => weight != 0.0 && high <= value,
                Mode::Minip => weight != 0.0 && low >= value,
                Mode::Composite => transmittance == 0.0 || transmittance < settings.termination,
                _ => transmittance == 0.0,
            }
        };
        let eye = Eye::new(&scene.volume.grid(), scene.camera, scene.extent_pixels);
        for (shown, is_hidden) in rest.iter().zip(is_hidden) {
            let [first, end] = shown.place.pixels;
            let mut places =
                (first[1]..end[1]).flat_map(|y| (first[0]..end[0]).map(move |x| [x, y]));
            let all = places.all(|[x, y]| {
                has_ended(pixels[y as usize * width + x as usize], shown.range)
                    || !eye.meets(&shown.place, [x, y])
            });
            is_hidden.store(all, Ordering::Relaxed);
        }
        Ok(())
    }
}

impl Streaming<'_> {
    /// A part that is there, to choose pipelines by.
    pub fn part(&self) -> GpuChannel<'_> {
        let any = self.cache.any().expect("`upload` brings one in");
        GpuChannel::numbers(&any.volume)
    }
}

/// What bricks take: of those before, and at first rather too much.
struct Guess {
    ms_of_brick: f64,
}

impl Guess {
    /// The next may take so many times what was measured.
    const DEARER: f64 = 2.0;
    /// And nothing is taken for so much cheaper at once.
    const CHEAPER: f64 = 0.25;

    fn new(gpu: &Gpu, looks_of_brick: f64) -> Self {
        Self {
            ms_of_brick: ms_of_fetches(gpu, looks_of_brick),
        }
    }

    fn ms(&self, bricks: usize) -> f64 {
        self.ms_of_brick * bricks as f64
    }

    fn took(&mut self, bricks: usize, ms: f64) {
        let measured = Self::DEARER * ms / bricks as f64;
        self.ms_of_brick = measured.max(Self::CHEAPER * self.ms_of_brick);
    }
}

/// Bricks that are being read.
struct Ahead {
    ready: Receiver<Read>,
    /// Those that were not there when the picture began.
    missing: Vec<usize>,
}

impl Ahead {
    /// What the thread has read. A brick that was there and had to leave is read now.
    fn take(&self, stream: &Stream, brick: usize) -> Result<Volume, Error> {
        if self.missing.contains(&brick) {
            while let Ok((number, voxels)) = self.ready.recv() {
                // Others were read before it was known that they are hidden.
                if number == brick {
                    return Ok(voxels?);
                }
            }
        }
        Ok(stream.read(brick)?)
    }
}

/// What a picture leaves out, and what is to be known of bricks for it. Their halos hold all that it may ask for: a
/// voxel for the filter, and one for gradients or two for half a slab.
fn skippable(scene: &Scene) -> (Skippable, Halo) {
    let found = super::skipping::wanted(scene);
    found.unwrap_or((Skippable::Nothing, scene.settings.halo()))
}

/// What a picture shows, from front to back.
fn shown(stream: &Stream, scene: &Scene, (skippable, halo): (&Skippable, Halo)) -> Vec<Shown> {
    let grid = scene.volume.grid();
    let view: View = scene.view(&grid, InPixel::CENTER);
    let cells = stream.cells();
    let eye = Eye::new(&grid, scene.camera, scene.extent_pixels);
    let shown = |&brick: &usize| {
        let cell = &cells[brick];
        let [low, high] = view.part(Some(cell));
        if !(low.cmplt(high).all()) {
            return None;
        }
        let range = stream.range(brick, halo)?;
        // What is not seen may be the largest.
        let has_maximum = scene.settings.mode == Mode::Mida;
        if let Skippable::Unseen(seen) = skippable
            && !has_maximum
            && !seen.shows(range)
        {
            return None;
        }
        Some(Shown {
            brick,
            place: eye.place_of(cell.own)?,
            range,
        })
    };
    let order = match stream.is_of_rows() {
        true => view.front_to_back_by_rows(cells),
        false => view.front_to_back(cells),
    };
    order.iter().filter_map(shown).collect()
}
