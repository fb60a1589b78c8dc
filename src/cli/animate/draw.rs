//! Shots to pictures: one device for the whole film, or several that share its frames; a volume uploaded once for all
//! frames that show it. While a frame is drawn the next time is read, those before it are encoded, and one is written.

use super::{
    drawer::{Seen, Work},
    feed::{Ahead, Feed, times_of},
    film::y4m,
    kept::Kept,
    rate::Rate,
    ready::{self, Ready},
    shots::{Film, FilmFrame},
    store::Store,
    together::Together,
    volumes::{Moment, Volumes},
};
use crate::{
    annotate::{Annotation, Seen as SeenFrame},
    cli::{
        Error,
        flags::{Classification, SceneFlags},
        flow::DrawnLines,
        line::{Line, encoders},
        memory::{DeviceMemory, DeviceRoom, Held, leaves_room},
        output,
        progress::Progress,
        reasons::Unseen,
        renderer::{Device, Job, Renderer},
        scene_inputs::{Parts, SceneInputs},
        timings::{Timings, ms_since},
    },
    picture::{EncodedPicture, LayerKind, Picture, PictureFormat},
    transfer::{Classified, Window},
    volume::{Grid, Source, Volume},
};
use std::{
    collections::BTreeSet,
    panic::resume_unwind,
    sync::{
        Arc,
        mpsc::{channel, sync_channel},
    },
    thread,
    time::Instant,
};

/// A picture, or why there is none.
pub type Drawn = Result<Picture, Error>;

/// What is drawn.
pub struct Drawing<'a> {
    /// The flags that stay the same.
    pub scene: &'a SceneFlags,
    /// All frames.
    pub shots: &'a [FilmFrame],
    /// Layers that the pictures must have.
    pub layers: &'a [LayerKind],
    /// The volumes.
    pub content: &'a Content,
    /// Colours behind the picture, the nearest first.
    pub background: Vec<[f64; 4]>,
    /// What is drawn over every frame.
    pub annotation: Option<Annotation>,
    /// As which files keep it.
    pub format: PictureFormat,
    /// Where voxels are drawn, and how much higher than they are.
    pub placed: (Grid, f64),
    /// When reading began.
    pub start: Instant,
    /// Who hears how far it is.
    pub progress: &'a Progress,
    /// Samples are counted at the end.
    pub wants_timings: bool,
    /// Which frames there are.
    pub film: &'a Film,
    /// What a scene keeps of what is chosen.
    pub kept: &'a Kept,
}

/// What the frames show.
pub enum Content {
    /// One time, of everything that `render` draws.
    Still(Box<SceneInputs>),
    /// Several times of the same, of which this is the first.
    Together(Box<SceneInputs>, Box<Together>),
    /// Several times of one number a voxel; with the device's memory, drawn brick by brick from their file.
    Times(Arc<dyn Source>, Option<DeviceMemory>),
}

impl Content {
    /// Lines that all frames show.
    pub fn lines(&self) -> Option<&DrawnLines> {
        match self {
            Self::Still(shown) | Self::Together(shown, _) => shown.lines(),
            Self::Times(..) => None,
        }
    }
}

/// Where pictures go.
pub enum Sink<'a> {
    /// Into files.
    Store(&'a Store),
    /// As Y4M to the standard output.
    Stream(Rate),
}

/// A frame on its way to where it goes.
enum Encoded {
    Files(EncodedPicture),
    Bytes(Vec<u8>),
}

impl Drawing<'_> {
    /// Draws what `sink` does not have yet.
    pub fn draw(&self, sink: &Sink, mut devices: Vec<Device>) -> Result<Timings, Error> {
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
                let volumes = [vec![shown.looked_at()], parts.beside().volumes()].concat();
                saw(self.shots[0].time as u32, &volumes)?;
                let all = self.kept.with_own(self.shots, self.film, self.scene);
                let mut ready = ready::of_still(&all, self.scene, shown)?;
                self.kept.take(&mut ready, self.shots.len());
                let load_ms = ms_since(self.start);
                let moment = Arc::new(Moment {
                    volume: Arc::clone(&shown.volume),
                    streamed: shown.stream().map(|stream| (stream.clone(), None)),
                    together: None,
                });
                let first = |_: &[Ready]| Ok(Arc::clone(&moment));
                self.choose_window(&mut ready, first, &parts, &mut devices)?;
                let feed = Feed::still(&moment, wanted.len());
                let line = self.line(devices.len())?;
                let work = self.work(wanted, &ready, &parts, &feed, &line)?;
                self.run(&work, sink, devices, load_ms, None)
            }
            Content::Together(shown, together) => {
                let parts = shown.parts();
                let all = self.kept.with_own(self.shots, self.film, self.scene);
                let mut ready = ready::of_still(&all, self.scene, shown)?;
                self.kept.take(&mut ready, self.shots.len());
                let load_ms = ms_since(self.start);
                let mut volumes = Volumes::together(together, self.scene, self.progress, &saw);
                let first = |ready: &[Ready]| volumes.at(ready[0].time);
                self.choose_window(&mut ready, first, &parts, &mut devices)?;
                let times = times_of(&ready, wanted);
                devices.truncate(1);
                let feed = Feed::behind(volumes, &times);
                let line = self.line(devices.len())?;
                let work = self.work(wanted, &ready, &parts, &feed, &line)?;
                self.run(&work, sink, devices, load_ms, None)
            }
            Content::Times(source, bricks) => {
                self.progress.stage("read", 0, 1);
                let mut volumes = Volumes::new(source, *bricks, self.scene, self.progress, &saw);
                let is_labels = source.header().is_labels;
                let all = self.kept.with_own(self.shots, self.film, self.scene);
                let mut ready =
                    ready::of_times(&all, self.scene, is_labels, &mut volumes, self.progress)?;
                self.kept.take(&mut ready, self.shots.len());
                let load_ms = ms_since(self.start);
                let parts = Parts::Channels(Vec::new());
                let first = |ready: &[Ready]| volumes.at(ready[0].time);
                self.choose_window(&mut ready, first, &parts, &mut devices)?;
                let times = times_of(&ready, wanted);
                let has_room =
                    bricks.is_none() && self.has_room_ahead(source.as_ref(), &devices)?;
                let (sender, frames) = sync_channel(0);
                let (feed, ahead) = if has_room {
                    let ahead = Ahead {
                        volumes,
                        times: &times,
                        sender,
                    };
                    (Feed::ahead(frames), Some(ahead))
                } else {
                    devices.truncate(1);
                    (Feed::behind(volumes, &times), None)
                };
                let line = self.line(devices.len())?;
                let work = self.work(wanted, &ready, &parts, &feed, &line)?;
                self.run(&work, sink, devices, load_ms, ahead)
            }
        }
    }

    /// Where colours are those of the picture, the first frame chooses them for all.
    fn choose_window(
        &self,
        ready: &mut [Ready],
        first: impl FnOnce(&[Ready]) -> Result<Arc<Moment>, Error>,
        parts: &Parts,
        devices: &mut Vec<Device>,
    ) -> Result<(), Error> {
        self.progress.stage("prepare", 0, 1);
        let is_open = |ready: &Ready| ready.classification == Classification::RangeOfPicture;
        if !ready.iter().any(is_open) {
            return Ok(());
        }
        let moment = first(ready)?;
        let job = Job {
            volume: &moment.volume,
            stream: moment.stream(),
            beside: parts.beside(),
            lines: None,
            classification: &ready[0].classification,
            settings: &ready[0].settings,
            extent_pixels: self.scene.picture.extent_pixels()?,
            layers: &[LayerKind::Value],
        };
        let camera = &self.shots[0].camera;
        let mut renderer = Renderer::new(job, camera, devices.remove(0))?;
        let range = renderer.projected_range(camera)?;
        devices.insert(0, renderer.into_device());
        let function = Window::of_range(range).grey(Classified::Projection);
        for ready in ready.iter_mut() {
            ready.classification = Classification::Function(function.clone());
        }
        let _ = self.kept.window.set(range);
        let window = format!("{},{}", range[0], range[1]);
        self.progress.note(&format!(
            "all frames have the window of the first: {window}"
        ));
        Ok(())
    }

    /// True where each device may hold a time, and one more be read meanwhile.
    fn has_room_ahead(&self, source: &dyn Source, devices: &[Device]) -> Result<bool, Error> {
        let is_whole = self.shots.iter().all(|shot| shot.time.fract() == 0.0);
        let held = if is_whole {
            Held::of(self.scene, 1)
        } else {
            Held::Blend
        };
        let has_room = leaves_room(
            source.header(),
            self.scene,
            devices[0].memory()?,
            held,
            devices.len() as u32,
        );
        if !has_room {
            self.progress.note(
                "there is memory for one time alone: each is read when the one before has gone",
            );
        }
        Ok(has_room)
    }

    fn work<'w>(
        &'w self,
        wanted: &'w [u32],
        ready: &'w [Ready],
        parts: &'w Parts<'w>,
        feed: &'w Feed<'w>,
        line: &'w Line,
    ) -> Result<Work<'w>, Error> {
        let extent_pixels = self.scene.picture.extent_pixels()?;
        Ok(Work {
            drawing: self,
            wanted,
            ready,
            parts,
            feed,
            line,
            extent_pixels,
        })
    }

    fn line(&self, devices: usize) -> Result<Line, Error> {
        let extent_pixels = self.scene.picture.extent_pixels()?;
        Ok(Line::new(devices + encoders(extent_pixels) + 1))
    }

    /// All stages at once; the thread that calls writes pictures as they come, and says how long it will take.
    fn run(
        &self,
        work: &Work,
        sink: &Sink,
        devices: Vec<Device>,
        load_ms: f64,
        ahead: Option<Ahead>,
    ) -> Result<Timings, Error> {
        let (name, driver) = names_of(&devices)?;
        if let Sink::Store(store) = sink {
            let mut journal = store.journal();
            journal.saw_device(&format!("{name}, {driver}"))?;
        }
        let timings = Timings {
            device: name,
            driver,
            load_ms,
            ..Timings::default()
        };
        let (sender, pictures) = channel();
        thread::scope(|scope| {
            if let Some(ahead) = ahead {
                scope.spawn(|| ahead.read(work.line));
            }
            let draw = |device| {
                let sender = sender.clone();
                scope.spawn(move || work.draw_on(device, &sender))
            };
            let drawers: Vec<_> = devices.into_iter().map(draw).collect();
            drop(sender);
            let encode = |at, drawn: Drawn| self.encoded(sink, work, work.wanted[at], drawn?);
            let mut put = self.put(sink, work.wanted);
            let threads = encoders(work.extent_pixels);
            let written = work
                .line
                .run(pictures, threads, encode, |at, frame| put(at, frame?));
            let seen: Vec<_> = drawers.into_iter().map(|drawer| drawer.join()).collect();
            work.feed.close();
            let seen = seen.into_iter();
            let seen = seen.map(|seen| seen.unwrap_or_else(|fault| resume_unwind(fault)));
            let seen: Vec<Seen> = seen.collect();
            written?;
            self.say_empty(&seen, work.wanted.len());
            Ok(Seen::together(seen, timings))
        })
    }

    fn encoded(
        &self,
        sink: &Sink,
        work: &Work,
        number: u32,
        mut picture: Picture,
    ) -> Result<Encoded, Error> {
        let annotation = self.annotation.as_ref();
        let behind = annotation.and_then(|annotation| annotation.transmittance(&picture));
        if self.format == PictureFormat::Png {
            picture.apply_tone(self.scene.picture.tone());
        }
        for &color in &self.background {
            picture.over_background(color);
        }
        if let Some(annotation) = annotation {
            let ready = &work.ready[number as usize];
            let seen = SeenFrame {
                camera: &self.shots[number as usize].camera,
                settings: &ready.settings,
                function: ready
                    .classification
                    .function()
                    .filter(|_| !self.scene.hides_volume()),
                geometry: self
                    .content
                    .lines()
                    .map(DrawnLines::legend)
                    .unwrap_or_default(),
                beside: work.parts.beside(),
                grid: self.placed.0,
                height_factor: self.placed.1,
                time: ready.time,
                // All frames have one function.
                projected: None,
            };
            annotation.put(&mut picture, behind.as_deref(), &seen, self.format)?;
        }
        match sink {
            Sink::Store(store) => store.encode(number, &picture).map(Encoded::Files),
            Sink::Stream(rate) => Ok(Encoded::Bytes(streamed(number, &picture, *rate))),
        }
    }

    /// Puts frames where they go, in order.
    fn put(&self, sink: &Sink, wanted: &[u32]) -> impl FnMut(usize, Encoded) -> Result<(), Error> {
        let total = self.shots.len();
        let before = total - wanted.len();
        let start = Instant::now();
        self.progress.frames(before, total, None);
        move |at, frame| {
            match (sink, frame) {
                (Sink::Store(store), Encoded::Files(files)) => store.write(wanted[at], &files)?,
                (_, Encoded::Bytes(bytes)) => output::write_out(&bytes)?,
                (Sink::Stream(_), Encoded::Files(_)) => unreachable!("a stream has no files"),
            }
            let done = at as u32 + 1;
            let left = (start.elapsed() / done).saturating_mul(wanted.len() as u32 - done);
            self.progress.frames(before + at + 1, total, Some(left));
            Ok(())
        }
    }

    fn say_empty(&self, seen: &[Seen], drawn: usize) {
        let empty = seen.iter().flat_map(|seen| &seen.empty);
        if let Some((number, Unseen { why, .. })) = empty.clone().min() {
            let what = match empty.clone().all(|(_, unseen)| unseen.is_empty) {
                true => "are empty",
                false => "show nothing of the volume",
            };
            let count = empty.count();
            self.progress.note(&format!(
                "{count} of {drawn} frames {what}, frame {number} because: {why}"
            ));
        }
    }
}

/// Each name and driver once, in an order that does not depend on the words.
fn names_of(devices: &[Device]) -> Result<(String, String), Error> {
    let names = devices
        .iter()
        .map(|device| Ok((device.name()?, device.driver()?)));
    let names = names.collect::<Result<BTreeSet<_>, Error>>()?;
    let (names, drivers): (Vec<_>, BTreeSet<_>) = names.into_iter().unzip();
    let drivers: Vec<_> = drivers.into_iter().collect();
    Ok((names.join(" + "), drivers.join(" + ")))
}

fn streamed(number: u32, picture: &Picture, rate: Rate) -> Vec<u8> {
    let codes = picture.codes(u8::MAX.into());
    let codes = codes.as_flattened().iter().map(|&code| code as u8);
    let frame = y4m::frame(&codes.collect::<Vec<u8>>());
    match number {
        0 => [
            y4m::head([picture.width, picture.height], rate).into_bytes(),
            frame,
        ]
        .concat(),
        _ => frame,
    }
}
