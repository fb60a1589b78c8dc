//! A frame from beginning to end: what the hand did, what that asks of stratavox, what is recorded.
//!
//! Barriers of this host's own stand in `shown.rs`, in `drawing.rs` (the picture) and in `painter.rs` (glyphs):
//!
//! ```text
//! image of the window   nothing, once acquired      -> color target     its first use waits for the semaphore there
//!                       color target                -> presentation     or by way of a copy, for a screenshot
//! picture               sampled -> copied -> sampled                    for a screenshot of the volume alone
//! buffer of a copy      written by a transfer       -> read by the host
//! ```

mod drawn;
mod hand;
mod shown;

use crate::drawing::Drawing;
use crate::error::Error;
use crate::eye::Eye;
use crate::frames::Frames;
use crate::host::Host;
use crate::keys::Command;
use crate::look::Look;
use crate::marks::Marker;
use crate::painter::Painter;
use crate::panel;
use crate::reader::{Read, Reader};
use crate::script::Step;
use crate::subject::Subject;
use crate::swapchain::Swapchain;
use crate::view::{Picked, View};
use crate::words::Arguments;
use egui::ViewportId;
use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicUsize;
use std::time::{Duration, Instant};
use stratavox::gpu::Timer;
use winit::dpi::PhysicalSize;
use winit::event::WindowEvent;

/// Pictures that take longer are drawn with fewer pixels while a hand moves them.
const SLOW_MS: f64 = 60.0;
/// How long a hand rests until the picture is drawn with all of its pixels.
const REST: Duration = Duration::from_millis(180);
/// How long a script waits for the window to have the size that it asked for.
const PATIENCE: Duration = Duration::from_secs(5);

pub struct Window {
    view: View,
    words: Arguments,
    steps: Option<VecDeque<Step>>,
    drawn: Option<Drawn>,
    drawing: Option<Drawing>,
    arrived: Option<Read>,
    reader: Reader,
    painter: Option<Painter>,
    /// Where marks were shown once.
    marker: Option<Marker>,
    /// Around the volume, for each frame in flight, and in how many parts its picture was shrunk.
    timers: Vec<Option<Timer>>,
    timed: Vec<Option<u32>>,
    /// A pixel whose depth was copied in a frame in flight.
    asked: Option<(u32, [u32; 2])>,
    saves: Vec<Save>,
    last_move: Option<Instant>,
    awaited_size: Option<([u32; 2], Instant)>,
    is_resized: bool,
    /// Nothing was shown on it yet: lost once more, it stays so.
    is_surface_new: bool,
    swapchain: Option<Swapchain>,
    frames: Frames,
    context: egui::Context,
    egui: egui_winit::State,
    wake: Arc<dyn Fn() + Send + Sync>,
    host: Host,
    /// After the host, whose surface is on it.
    window: winit::window::Window,
}

/// What the picture in the canvas shows.
#[derive(Clone, PartialEq)]
struct Drawn {
    look: Look,
    eye: Eye,
    time: u32,
    has_marks: bool,
    extent: [u32; 2],
}

/// A picture that is wanted as a file.
enum Save {
    Window(PathBuf),
    Picture(PathBuf),
}

/// When there is something to draw again.
pub struct Next {
    pub at: Option<Instant>,
    pub ends: bool,
}

impl Next {
    /// Until something happens.
    const NOTHING: Self = Self {
        at: None,
        ends: false,
    };
}

impl Window {
    pub fn new(
        window: winit::window::Window,
        words: &Arguments,
        mut view: View,
        steps: Option<VecDeque<Step>>,
        wake: Arc<dyn Fn() + Send + Sync>,
    ) -> Result<Self, Error> {
        let host = Host::new(&window, words.device.as_deref(), words.validation)?;
        let gpu = host.gpu();
        let frames = Frames::new(&host, words.frames_in_flight)?;
        let timers = (0..frames.count())
            .map(|_| Timer::new(gpu))
            .collect::<Result<Vec<_>, _>>();
        let context = egui::Context::default();
        panel::set_style(&context);
        // A second pass over the same events would turn the volume twice.
        context.options_mut(|options| options.max_passes = 1.try_into().expect("one"));
        let scale = window.scale_factor() as f32;
        // Vulkan's least `maxImageDimension2D`.
        let most = Some(4096);
        let id = ViewportId::ROOT;
        let egui = egui_winit::State::new(context.clone(), id, &window, Some(scale), None, most);
        view.status.device = gpu.device_name().to_owned();
        let mut made = Self {
            reader: reader(&host, &view.subject, &wake),
            timed: vec![None; frames.count() as usize],
            timers: timers?,
            view,
            words: words.clone(),
            steps,
            drawn: None,
            drawing: None,
            arrived: None,
            painter: None,
            marker: None,
            asked: None,
            saves: Vec::new(),
            last_move: None,
            awaited_size: None,
            is_resized: false,
            is_surface_new: false,
            swapchain: None,
            frames,
            context,
            egui,
            wake,
            host,
            window,
        };
        made.fit()?;
        made.ask_for_frame();
        Ok(made)
    }

    pub fn messages(&self) -> Arc<AtomicUsize> {
        self.host.messages()
    }

    pub fn ask_for_frame(&self) {
        self.window.request_redraw();
    }

    pub fn hear(&mut self, event: &WindowEvent) {
        if matches!(event, WindowEvent::Resized(_)) {
            self.is_resized = true;
            self.ask_for_frame();
        }
        if self.egui.on_window_event(&self.window, event).repaint {
            self.ask_for_frame();
        }
    }

    /// Lays out, draws and shows a frame.
    pub fn frame(&mut self) -> Result<Next, Error> {
        let frame = self.frame_inner();
        match &frame {
            // The host hears first: stratavox asks nothing of the device from here on.
            Err(Error::DeviceLost(_)) => self.host.gpu().declare_lost(),
            // A display may come back as another. What is on the device is not lost with it.
            Err(Error::SurfaceLost) if !self.is_surface_new => {
                self.renew_surface()?;
                return Ok(Next::NOTHING);
            }
            _ => {}
        }
        frame
    }

    fn renew_surface(&mut self) -> Result<(), Error> {
        self.host.finish();
        self.frames.retire_all(&self.host);
        if let Some(swapchain) = self.swapchain.take() {
            swapchain.destroy(&self.host);
        }
        self.host.renew_surface(&self.window)?;
        (self.is_surface_new, self.is_resized) = (true, true);
        self.ask_for_frame();
        Ok(())
    }

    fn frame_inner(&mut self) -> Result<Next, Error> {
        if self.is_resized {
            self.fit()?;
        }
        let Some(swapchain) = &self.swapchain else {
            // Minimized: nothing is drawn until there is a size again.
            return Ok(Next::NOTHING);
        };
        let Some(begun) = self.frames.begin(&self.host, swapchain)? else {
            self.is_resized = true;
            self.ask_for_frame();
            return Ok(Next::NOTHING);
        };
        self.hear_device(begun.frame)?;
        let step = self.next_step()?;
        let output = self.lay_out(step.as_ref());
        let reports = matches!(step, Some(Step::Report));
        self.obey_step(step);
        self.obey_commands();
        self.follow_time()?;
        let delay = output
            .viewport_output
            .get(&ViewportId::ROOT)
            .map(|out| out.repaint_delay);
        let written = self.record(begun, output)?;
        if reports {
            self.report();
        }
        let swapchain = self.swapchain.as_ref().expect("looked at above");
        let fits = self.frames.show(&self.host, swapchain, begun)?;
        self.is_resized |= !fits;
        self.is_surface_new = false;
        if !written.is_empty() {
            // A screenshot is worth a wait.
            self.host.finish();
            for shot in written {
                shot.write()?;
                println!("saved {}", shot.path.display());
            }
        }
        let ends = self.view.commands.contains(&Command::Quit)
            || self.steps.as_ref().is_some_and(VecDeque::is_empty) && self.is_idle();
        Ok(Next {
            at: self.due(delay.unwrap_or(Duration::MAX)),
            ends,
        })
    }

    /// When the next frame is due: at once where something is on its way.
    fn due(&self, delay: Duration) -> Option<Instant> {
        let now = Instant::now();
        // Read for other textures, a time is asked for once more.
        let is_behind = self.view.wanted_time != self.view.subject.time;
        let is_behind = is_behind && self.reader.pending.is_none();
        let is_busy = self.steps.is_some() || self.is_resized || self.asked.is_some();
        if is_busy || is_behind || self.is_stale() {
            self.ask_for_frame();
        }
        let rest = self.last_move.map(|moved| moved + REST);
        let rest = rest.filter(|_| self.is_shrunk());
        let repaint = now
            .checked_add(delay)
            .filter(|_| delay < Duration::from_secs(3600));
        let next = self
            .view
            .is_playing
            .then(|| now + Duration::from_millis(40));
        [rest, repaint, next].into_iter().flatten().min()
    }

    /// Images of the window anew, of its size.
    fn fit(&mut self) -> Result<(), Error> {
        self.is_resized = false;
        let PhysicalSize { width, height } = self.window.inner_size();
        // Resizing is rare, and waiting is the one way that is right on every driver: nothing tells when presentation
        // is done with an image.
        self.host.finish();
        self.frames.retire_all(&self.host);
        let old = self.swapchain.take();
        let size = [width, height];
        self.swapchain = Swapchain::new(&self.host, old, size, self.words.present)?;
        if let Some(swapchain) = &self.swapchain {
            self.view.status.present = format!("{:?}", swapchain.present).to_lowercase();
            if self.painter.is_none() {
                let count = self.frames.count();
                let painter = Painter::new(self.host.gpu(), swapchain.format, count)?;
                self.painter = Some(painter);
            }
        }
        Ok(())
    }

    /// What the device has done since: how long a picture took, what lies under a pixel.
    fn hear_device(&mut self, frame: u32) -> Result<(), Error> {
        let slot = frame as usize;
        if let (Some(timer), Some(parts)) = (&self.timers[slot], self.timed[slot].take())
            && let Some(ms) = timer.elapsed_ms()?
        {
            let all = ms * f64::from(parts * parts);
            self.view.status.picture_ms = Some(all);
        }
        // Frames are done in their order: when this one comes around again, it is.
        if let (Some((asked, pixel)), Some(drawing)) = (self.asked, &self.drawing)
            && asked == frame
        {
            self.asked = None;
            let voxels = &self.view.subject.voxels;
            let height_factor = self.view.subject.way.height_factor;
            let found = drawing.renderer.pick(frame, pixel)?;
            self.view.picked = Some(found.map_or(Picked::Nothing, |pick| {
                let mut position = pick.position;
                position.z /= height_factor;
                Picked::Something {
                    position,
                    value: pick.voxel_of(voxels),
                    is_label: self.view.subject.summary.labels.is_some(),
                    name: self.view.subject.name_of(pick.voxel_of(voxels)),
                }
            }));
        }
        Ok(())
    }

    /// Nothing is on its way to the picture.
    fn is_idle(&self) -> bool {
        let is_fit = self.awaited_size.is_none();
        let is_read = self.view.wanted_time == self.view.subject.time && self.arrived.is_none();
        is_fit && is_read && self.asked.is_none() && !self.is_resized && !self.is_stale()
    }

    fn is_stale(&self) -> bool {
        let now = |drawn: &Drawn| Drawn {
            look: self.view.look.clone(),
            eye: self.view.eye.clone(),
            time: self.view.subject.time,
            has_marks: self.view.has_marks,
            extent: drawn.extent,
        };
        let drawing = self.drawing.as_ref();
        let goes_on = drawing.is_some_and(|drawing| drawing.resting.goes_on(&self.view.look));
        goes_on || self.drawn.as_ref().is_none_or(|drawn| now(drawn) != *drawn)
    }

    fn is_shrunk(&self) -> bool {
        let picture = self.drawn.as_ref().map(|drawn| drawn.extent);
        picture.is_some_and(|extent| extent != self.view.status.extent)
    }
}

impl Drop for Window {
    fn drop(&mut self) {
        self.host.finish();
        if let Some(swapchain) = self.swapchain.take() {
            swapchain.destroy(&self.host);
        }
        self.frames.destroy(&self.host);
    }
}

fn reader(host: &Host, subject: &Subject, wake: &Arc<dyn Fn() + Send + Sync>) -> Reader {
    let wake = Arc::clone(wake);
    let source = Arc::clone(&subject.source);
    Reader::new(host.gpu(), source, subject.way, move || wake())
}
