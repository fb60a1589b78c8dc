//! What one device does for a film: it takes the next frame, draws it, and hands the picture on.

use super::{
    draw::{Drawing, Drawn},
    feed::Feed,
    ready::Ready,
    volumes::Moment,
};
use crate::{
    cli::{
        Error,
        line::Line,
        reasons::{Shows, Unseen, why_empty},
        renderer::{Device, Job, Renderer},
        scene_inputs::Parts,
        timings::{FrameTime, Timings, ms_since, peak_rss_bytes},
    },
    picture::{LayerKind, Picture},
    volume::Volume,
};
use std::{
    sync::{Arc, mpsc::Sender},
    time::Instant,
};

/// What all devices share.
pub struct Work<'a> {
    /// The film.
    pub drawing: &'a Drawing<'a>,
    /// Numbers of the frames that are drawn.
    pub wanted: &'a [u32],
    /// How each frame of the film is computed.
    pub ready: &'a [Ready],
    /// What is seen together with the volumes.
    pub parts: &'a Parts<'a>,
    /// Where frames come from.
    pub feed: &'a Feed<'a>,
    /// How far the work is.
    pub line: &'a Line,
    /// Pixels across and down.
    pub extent_pixels: [u32; 2],
}

/// What one device did.
#[derive(Default)]
pub struct Seen {
    /// From memory to the device.
    pub upload_ms: f64,
    /// Device, pipelines, tables.
    pub prepare_ms: f64,
    /// Frames by their place, and what they took.
    pub frames: Vec<(usize, FrameTime)>,
    /// Frames that show nothing, and why.
    pub empty: Vec<(u32, Unseen)>,
    /// Samples of the last frame, on the device that drew it.
    pub samples: Option<u64>,
    /// The most memory of the process by then.
    pub peak_rss_bytes: Option<u64>,
    /// Memory of this device.
    pub device_bytes: u64,
}

impl Seen {
    /// What all devices did, in the order of frames.
    pub fn together(all: Vec<Self>, mut timings: Timings) -> Timings {
        let mut frames = Vec::new();
        for seen in all {
            timings.upload_ms += seen.upload_ms;
            timings.prepare_ms += seen.prepare_ms;
            timings.device_bytes += seen.device_bytes;
            timings.samples += seen.samples.unwrap_or(0);
            timings.peak_rss_bytes = timings.peak_rss_bytes.max(seen.peak_rss_bytes);
            frames.extend(seen.frames);
        }
        frames.sort_by_key(|&(at, _)| at);
        timings.frames = frames.into_iter().map(|(_, time)| time).collect();
        timings.first_frame_ms = timings.frames.first().map_or(0.0, |frame| frame.wall_ms);
        timings
    }
}

impl Work<'_> {
    /// A job with the settings and colours of frame `number`.
    pub fn job<'j>(
        &'j self,
        moment: &'j Moment,
        parts: &'j Parts<'j>,
        number: u32,
        layers: &'j [LayerKind],
    ) -> Job<'j> {
        let ready = &self.ready[number as usize];
        Job {
            volume: &moment.volume,
            stream: moment.stream(),
            beside: parts.beside(),
            lines: moment.lines().or(self.drawing.content.lines()),
            classification: &ready.classification,
            settings: &ready.settings,
            extent_pixels: self.extent_pixels,
            layers,
        }
    }

    /// Draws frames on `device` until none is left or nobody wants them. An error takes the place of its frame.
    pub fn draw_on(&self, device: Device, pictures: &Sender<(usize, Drawn)>) -> Seen {
        let _stops = self.line.stops_in_panic();
        let mut seen = Seen::default();
        let mut at = 0;
        if let Err(error) = self.draw_all(device, pictures, &mut seen, &mut at) {
            // Where nobody hears of it, an earlier frame has failed.
            let _ = pictures.send((at, Err(error)));
        }
        seen
    }

    fn draw_all(
        &self,
        mut device: Device,
        pictures: &Sender<(usize, Drawn)>,
        seen: &mut Seen,
        at: &mut usize,
    ) -> Result<(), Error> {
        let mut next = self.feed.next();
        while let Some((place, moment)) = next {
            *at = place;
            let moment = moment?;
            let camera = &self.drawing.shots[self.wanted[*at] as usize].camera;
            let own = moment.parts();
            let parts = own.as_ref().unwrap_or(self.parts);
            let job = self.job(&moment, parts, self.wanted[*at], self.drawing.layers);
            let mut renderer = Renderer::new(job, camera, device)?;
            seen.upload_ms += renderer.upload_ms;
            seen.prepare_ms += renderer.prepare_ms;
            let other = loop {
                if !self.line.enter(*at) {
                    return Ok(());
                }
                let picture = self.draw_one(&mut renderer, &moment.volume, *at, seen)?;
                if pictures.send((*at, Ok(picture))).is_err() {
                    return Ok(());
                }
                if *at + 1 == self.wanted.len() && self.drawing.wants_timings {
                    let camera = &self.drawing.shots[self.wanted[*at] as usize].camera;
                    seen.samples = Some(renderer.samples(camera)?);
                    seen.peak_rss_bytes = peak_rss_bytes();
                }
                if self.feed.has_room_for_one() && !self.is_same_time(*at) {
                    break None;
                }
                match self.feed.next() {
                    Some((place, Ok(same))) if Arc::ptr_eq(&same, &moment) => *at = place,
                    other => break other,
                }
            };
            seen.device_bytes = renderer.device_bytes();
            device = renderer.into_device();
            drop(own);
            drop(moment);
            next = other.or_else(|| self.feed.next());
        }
        Ok(())
    }

    fn draw_one<'a>(
        &'a self,
        renderer: &mut Renderer<'a>,
        volume: &Volume,
        at: usize,
        seen: &mut Seen,
    ) -> Result<Picture, Error> {
        let number = self.wanted[at];
        let Ready {
            classification,
            settings,
            ..
        } = &self.ready[number as usize];
        let camera = &self.drawing.shots[number as usize].camera;
        renderer.change(classification, settings);
        let start = Instant::now();
        let frame = renderer.draw(camera)?;
        let time = FrameTime {
            gpu_ms: frame.gpu_ms,
            wall_ms: ms_since(start),
        };
        seen.frames.push((at, time));
        let reasoned = self.parts.only(classification);
        let hides_volume = self.drawing.scene.hides_volume();
        let shows = Shows::of(self.drawing.content.lines().is_some(), hides_volume);
        let picture = &frame.picture;
        let unseen = why_empty(picture, shows, volume, reasoned, camera, settings);
        seen.empty.extend(unseen.map(|unseen| (number, unseen)));
        Ok(frame.picture)
    }

    /// True where the frame behind `at` shows the same time.
    fn is_same_time(&self, at: usize) -> bool {
        let time = |at: usize| {
            let number = self.wanted.get(at)?;
            Some(self.ready[*number as usize].time)
        };
        time(at) == time(at + 1)
    }
}
