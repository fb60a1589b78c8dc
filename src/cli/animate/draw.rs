//! Shots to pictures: one device for the whole film, a volume uploaded once for all frames that show it, and a
//! frame written while the next one is drawn.

use super::{
    film::y4m,
    rate::Rate,
    ready::{self, Ready},
    shots::Shot,
    store::Store,
    volumes::Volumes,
};
use crate::{
    cli::{
        Error,
        flags::{Classification, SceneFlags},
        progress::Progress,
        reasons::why_empty,
        renderer::{Device, Job, Renderer},
        shown::{Parts, Shown},
        timings::{FrameTime, Timings, ms_since, peak_rss_bytes},
    },
    picture::{LayerKind, Picture},
    transfer::{Classified, Window},
    volume::{Source, Volume},
};
use std::{
    io::{self, Write},
    sync::{
        Arc,
        mpsc::{Receiver, sync_channel},
    },
    time::Instant,
};

/// Pictures that wait to be written.
const QUEUE: usize = 2;

/// What is drawn.
pub struct Drawing<'a> {
    /// The flags that stay the same.
    pub scene: &'a SceneFlags,
    /// All frames.
    pub shots: &'a [Shot],
    /// Layers that the pictures must have.
    pub layers: &'a [LayerKind],
    /// The volumes.
    pub content: &'a Content,
    /// Colours behind the picture, the nearest first.
    pub background: Vec<[f64; 4]>,
    /// When reading began.
    pub start: Instant,
    /// Who hears how far it is.
    pub progress: &'a Progress,
    /// Samples are counted at the end.
    pub wants_timings: bool,
}

/// What the frames show.
pub enum Content {
    /// One time, of everything that `render` draws.
    Still(Box<Shown>),
    /// Several times of one number a voxel.
    Times(Box<dyn Source>),
}

/// Where pictures go.
pub enum Sink<'a> {
    /// Into files.
    Store(&'a Store),
    /// As Y4M to the standard output.
    Stream(Rate),
}

impl Drawing<'_> {
    /// Draws what `sink` does not have yet.
    pub fn draw(&self, sink: &Sink, device: Device) -> Result<Timings, Error> {
        let all: Vec<u32> = (0..self.shots.len() as u32).collect();
        let wanted = match sink {
            Sink::Store(store) => store.missing(),
            Sink::Stream(_) => &all,
        };
        let saw = |time: u32, volumes: &[&Volume]| match sink {
            Sink::Store(store) => store.journal().saw_volumes(time, volumes),
            Sink::Stream(_) => Ok(()),
        };
        match self.content {
            Content::Still(shown) => {
                let parts = shown.parts();
                let volumes = [vec![&*shown.volume], parts.beside().volumes()].concat();
                saw(self.shots[0].time as u32, &volumes)?;
                let ready = ready::of_still(self.shots, self.scene, shown)?;
                let at = |_| Ok(Arc::clone(&shown.volume));
                self.draw_ready(wanted, ready, at, &parts, sink, device)
            }
            Content::Times(source) => {
                self.progress.stage("read", 0, 1);
                let saw = |time, volume: &Volume| saw(time, &[volume]);
                let mut volumes = Volumes::new(source.as_ref(), self.scene, self.progress, &saw);
                let is_labels = source.header().is_labels;
                let ready = ready::of_times(
                    self.shots,
                    self.scene,
                    is_labels,
                    &mut volumes,
                    self.progress,
                )?;
                let alone = Parts::Channels(Vec::new());
                let at = |time| volumes.at(time);
                self.draw_ready(wanted, ready, at, &alone, sink, device)
            }
        }
    }

    /// Draws these frames; `at` has the volume of a time.
    fn draw_ready(
        &self,
        wanted: &[u32],
        mut ready: Vec<Ready>,
        mut at: impl FnMut(f64) -> Result<Arc<Volume>, Error>,
        parts: &Parts,
        sink: &Sink,
        device: Device,
    ) -> Result<Timings, Error> {
        let load_ms = ms_since(self.start);
        let (sender, receiver) = sync_channel(QUEUE);
        std::thread::scope(|scope| {
            let writer = scope.spawn(|| self.write(sink, wanted.len(), receiver));
            let mut seen = Seen {
                load_ms,
                ..Seen::default()
            };
            // A picture that nobody takes: the writer has stopped and says why.
            let give = |picture| sender.send(picture).is_ok();
            let drawn = self.draw_all(
                wanted, &mut at, &mut ready, parts, sink, &mut seen, device, give,
            );
            drop(sender);
            match writer.join() {
                Ok(written) => written?,
                Err(panic) => std::panic::resume_unwind(panic),
            }
            drawn?;
            seen.say(self.progress, wanted.len());
            Ok(seen.timings)
        })
    }

    #[expect(
        clippy::too_many_arguments,
        reason = "each is borrowed for another time"
    )]
    fn draw_all(
        &self,
        wanted: &[u32],
        at: &mut impl FnMut(f64) -> Result<Arc<Volume>, Error>,
        ready: &mut [Ready],
        parts: &Parts,
        sink: &Sink,
        seen: &mut Seen,
        mut device: Device,
        give: impl Fn((u32, Picture)) -> bool,
    ) -> Result<(), Error> {
        let extent_pixels = self.scene.picture.extent_pixels()?;
        self.progress.stage("prepare", 0, 1);
        if ready
            .iter()
            .any(|ready| ready.classification == Classification::RangeOfPicture)
        {
            let volume = at(ready[0].time)?;
            let job = self.job(
                &volume,
                parts,
                &ready[0],
                extent_pixels,
                &[LayerKind::Value],
            );
            let camera = &self.shots[0].camera;
            let mut renderer = Renderer::new(job, camera, device)?;
            let range = renderer.projected_range(camera)?;
            device = renderer.into_device();
            let function = Window::of_range(range).grey(Classified::Projection);
            for ready in ready.iter_mut() {
                ready.classification = Classification::Function(function.clone());
            }
            let window = format!("{},{}", range[0], range[1]);
            self.progress.note(&format!(
                "all frames have the window of the first: {window}"
            ));
        }
        let ready = &*ready;
        let mut rest = wanted;
        while let Some(&first) = rest.first() {
            let time = ready[first as usize].time;
            let volume = at(time)?;
            let job = self.job(
                &volume,
                parts,
                &ready[first as usize],
                extent_pixels,
                self.layers,
            );
            let camera = &self.shots[first as usize].camera;
            let mut renderer = Renderer::new(job, camera, device)?;
            seen.prepared(&renderer);
            if let Sink::Store(store) = sink {
                store
                    .journal()
                    .saw_device(&format!("{}, {}", seen.timings.device, seen.timings.driver))?;
            }
            let same = rest
                .iter()
                .take_while(|&&number| ready[number as usize].time == time)
                .count();
            let (now, later) = rest.split_at(same);
            for &number in now {
                let Ready {
                    classification,
                    settings,
                    ..
                } = &ready[number as usize];
                let camera = &self.shots[number as usize].camera;
                renderer.change(classification, settings);
                let start = Instant::now();
                let frame = renderer.draw(camera)?;
                seen.timings.frames.push(FrameTime {
                    gpu_ms: frame.gpu_ms,
                    wall_ms: ms_since(start),
                });
                let mut picture = frame.picture;
                let reasoned = parts.only(classification);
                if let Some(why) = why_empty(&picture, &volume, reasoned, camera, settings) {
                    seen.empty(number, why);
                }
                for &color in &self.background {
                    picture.over_background(color);
                }
                if !give((number, picture)) {
                    return Ok(());
                }
            }
            rest = later;
            if let (true, [.., last]) = (self.wants_timings && rest.is_empty(), now) {
                seen.timings.samples = renderer.samples(&self.shots[*last as usize].camera)?;
                seen.timings.device_bytes = renderer.device_bytes();
                seen.timings.peak_rss_bytes = peak_rss_bytes();
            }
            device = renderer.into_device();
        }
        Ok(())
    }

    fn job<'j>(
        &'j self,
        volume: &'j Volume,
        parts: &'j Parts,
        ready: &'j Ready,
        extent_pixels: [u32; 2],
        layers: &'j [LayerKind],
    ) -> Job<'j> {
        Job {
            volume,
            stream: None,
            beside: parts.beside(),
            classification: &ready.classification,
            settings: &ready.settings,
            extent_pixels,
            layers,
        }
    }

    /// Writes pictures as they come, and says how long it will take.
    fn write(
        &self,
        sink: &Sink,
        wanted: usize,
        pictures: Receiver<(u32, Picture)>,
    ) -> Result<(), Error> {
        let total = self.shots.len();
        let before = total - wanted;
        let start = Instant::now();
        self.progress.frames(before, total, None);
        for (done, (number, picture)) in (1..).zip(pictures) {
            match sink {
                Sink::Store(store) => store.write(number, &picture)?,
                Sink::Stream(rate) => stream(number, &picture, *rate)?,
            }
            let each = start.elapsed() / done;
            let left = each.saturating_mul((wanted as u32).saturating_sub(done));
            self.progress
                .frames(before + done as usize, total, Some(left));
        }
        Ok(())
    }
}

fn stream(number: u32, picture: &Picture, rate: Rate) -> Result<(), Error> {
    let codes = picture.codes(u8::MAX.into());
    let codes: Vec<u8> = codes
        .as_flattened()
        .iter()
        .map(|&code| code as u8)
        .collect();
    let mut out = io::stdout().lock();
    let mut write = |bytes: &[u8]| {
        out.write_all(bytes)
            .map_err(|cause| Error::output("the standard output", &cause))
    };
    if number == 0 {
        write(y4m::head([picture.width, picture.height], rate).as_bytes())?;
    }
    write(&y4m::frame(&codes))
}

/// What was met on the way.
#[derive(Default)]
struct Seen {
    load_ms: f64,
    timings: Timings,
    /// Frames that show nothing: the first, why, and how many.
    empty: Option<(u32, &'static str, usize)>,
}

impl Seen {
    fn prepared(&mut self, renderer: &Renderer) {
        let timings = &mut self.timings;
        if timings.device.is_empty() {
            timings.device = renderer.device();
            timings.driver = renderer.driver();
            timings.load_ms = self.load_ms;
        }
        timings.upload_ms += renderer.upload_ms;
        timings.prepare_ms += renderer.prepare_ms;
    }

    fn empty(&mut self, number: u32, why: &'static str) {
        let (.., count) = self.empty.get_or_insert((number, why, 0));
        *count += 1;
    }

    fn say(&mut self, progress: &Progress, drawn: usize) {
        self.timings.first_frame_ms = self
            .timings
            .frames
            .first()
            .map_or(0.0, |frame| frame.wall_ms);
        if let Some((number, why, count)) = self.empty {
            progress.note(&format!(
                "{count} of {drawn} frames are empty, frame {number} because: {why}"
            ));
        }
    }
}
