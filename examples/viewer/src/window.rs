//! A frame from beginning to end: what the hand did, what that asks of stratavox, what is recorded.
//!
//! Barriers of this host's own stand here and in `drawing.rs` (the picture), `painter.rs` (glyphs):
//!
//! ```text
//! image of the window   nothing, once acquired      -> color target     its first use waits for the semaphore there
//!                       color target                -> presentation     or by way of a copy, for a screenshot
//! picture               sampled -> copied -> sampled                    for a screenshot of the volume alone
//! buffer of a copy      written by a transfer       -> read by the host
//! ```

use crate::drawing::Drawing;
use crate::error::Error;
use crate::eye::Eye;
use crate::frames::{Begun, Frames};
use crate::host::Host;
use crate::keys::{self, Command};
use crate::look::{Change, Look};
use crate::painter::{Painter, pixels};
use crate::panel;
use crate::reader::{Read, Reader};
use crate::script::Step;
use crate::shot::{Shot, free_name};
use crate::subject::Subject;
use crate::swapchain::Swapchain;
use crate::view::{Picked, View};
use crate::words::Words;
use ash::vk;
use egui::{FullOutput, ViewportId};
use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicUsize;
use std::time::{Duration, Instant};
use stratavox::gpu::{
    Load, Region, Target, TargetState, Timer, Use, begin_rendering, buffer_barrier, end_rendering,
    image_barrier, image_to_buffer,
};
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
    words: Words,
    steps: Option<VecDeque<Step>>,
    drawn: Option<Drawn>,
    drawing: Option<Drawing>,
    arrived: Option<Read>,
    reader: Reader,
    painter: Option<Painter>,
    /// Around the volume, for each frame in flight, and in how many parts its picture was shrunk.
    timers: Vec<Option<Timer>>,
    timed: Vec<Option<u32>>,
    /// A pixel whose depth was copied in a frame in flight.
    asked: Option<(u32, [u32; 2])>,
    saves: Vec<Save>,
    last_move: Option<Instant>,
    awaited_size: Option<([u32; 2], Instant)>,
    is_resized: bool,
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

impl Window {
    pub fn new(
        window: winit::window::Window,
        words: &Words,
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
            asked: None,
            saves: Vec::new(),
            last_move: None,
            awaited_size: None,
            is_resized: false,
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
        if let Err(Error::DeviceLost(_)) = &frame {
            // The host hears first: stratavox asks nothing of the device from here on.
            self.host.gpu().declare_lost();
        }
        frame
    }

    fn frame_inner(&mut self) -> Result<Next, Error> {
        if self.is_resized {
            self.fit()?;
        }
        let Some(swapchain) = &self.swapchain else {
            // Minimized: nothing is drawn until there is a size again.
            return Ok(Next {
                at: None,
                ends: false,
            });
        };
        let Some(begun) = self.frames.begin(&self.host, swapchain)? else {
            self.is_resized = true;
            self.ask_for_frame();
            return Ok(Next {
                at: None,
                ends: false,
            });
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
            extent: drawn.extent,
        };
        self.drawn.as_ref().is_none_or(|drawn| now(drawn) != *drawn)
    }

    fn is_shrunk(&self) -> bool {
        let picture = self.drawn.as_ref().map(|drawn| drawn.extent);
        picture.is_some_and(|extent| extent != self.view.status.extent)
    }

    /// The next line of the script, when all that came before is drawn.
    fn next_step(&mut self) -> Result<Option<Step>, Error> {
        if let (Some((size, since)), Some(swapchain)) = (self.awaited_size, &self.swapchain) {
            if swapchain.extent == size {
                self.awaited_size = None;
            } else if since.elapsed() > PATIENCE {
                return Err(Error::Window(format!(
                    "the window was to have {size:?} pixels and has {:?}",
                    swapchain.extent
                )));
            }
        }
        let is_idle = self.is_idle();
        let steps = self.steps.as_mut().filter(|_| is_idle);
        Ok(steps.and_then(VecDeque::pop_front))
    }

    fn lay_out(&mut self, step: Option<&Step>) -> FullOutput {
        let mut input = self.egui.take_egui_input(&self.window);
        if self.steps.is_some() {
            // A script is the only hand.
            input.events = match step {
                Some(Step::Events(events)) => events.clone(),
                _ => Vec::new(),
            };
        }
        let pointer = self.context.pointer_latest_pos();
        if !self.context.egui_wants_keyboard_input() {
            for command in keys::take(&mut input.events) {
                let extent = self.view.status.extent;
                self.view.obey(command, pointer, extent);
            }
        }
        let view = &mut self.view;
        view.status.pipelines = self.host.gpu().pipelines_made();
        view.status.device_bytes = self.host.gpu().device_bytes();
        let mut output = self.context.run_ui(input, |ui| panel::show(ui, view));
        if self.view.is_moving {
            self.last_move = Some(Instant::now());
        }
        let platform = std::mem::take(&mut output.platform_output);
        self.egui.handle_platform_output(&self.window, platform);
        output
    }

    fn obey_step(&mut self, step: Option<Step>) {
        match step {
            Some(Step::Size(size)) => {
                self.awaited_size = Some((size, Instant::now()));
                // The answer is an event, where it is not the size already.
                let _ = self
                    .window
                    .request_inner_size(PhysicalSize::new(size[0], size[1]));
            }
            Some(Step::Time(time)) => self.view.wanted_time = time.min(self.view.times() - 1),
            Some(Step::Window(path)) => self.saves.push(Save::Window(path)),
            Some(Step::Picture(path)) => self.saves.push(Save::Picture(path)),
            // Of what this frame draws: afterwards.
            Some(Step::Report | Step::Events(_) | Step::Frame) | None => {}
        }
    }

    fn obey_commands(&mut self) {
        let (commands, name) = (
            std::mem::take(&mut self.view.commands),
            &self.view.subject.name,
        );
        for command in commands {
            match command {
                Command::SavePicture => self.saves.push(Save::Picture(free_name(name))),
                Command::SaveWindow => {
                    self.saves
                        .push(Save::Window(free_name(&format!("{name}-window"))));
                }
                Command::SayCamera => println!("{}", self.view.eye.words()),
                other => self.view.commands.push_back(other),
            }
        }
        if let Some(variable) = self.view.wanted_variable.take() {
            self.words.variable = Some(variable);
            self.words.time = 0;
            match Subject::open(&self.words) {
                Ok(subject) => {
                    self.reader = reader(&self.host, &subject, &self.wake);
                    self.view.show(subject);
                    self.window.set_title(&self.view.title());
                    // Of another grid perhaps: nothing of the picture stays. What frames in flight use waits for them.
                    (self.drawing, self.drawn, self.arrived) = (None, None, None);
                    self.asked = None;
                }
                Err(error) => self.view.message = Some(error.to_string()),
            }
        }
    }

    /// Asks for the time that the slider stands at, and takes what was read.
    fn follow_time(&mut self) -> Result<(), Error> {
        if let Some(read) = self.reader.take() {
            match read {
                Ok(read) => self.arrived = Some(read),
                Err(error) => {
                    self.view.message = Some(error.to_string());
                    self.view.wanted_time = self.view.subject.time;
                    self.view.is_playing = false;
                }
            }
        }
        let is_there = self.view.wanted_time == self.view.subject.time;
        let is_free = self.reader.pending.is_none() && self.arrived.is_none();
        if is_there && is_free && self.view.is_playing && self.drawn.is_some() {
            self.view.step_time(false);
        }
        if self.view.wanted_time != self.view.subject.time && is_free {
            let settings = self.view.look.settings();
            self.reader.ask(self.view.wanted_time, &settings);
        }
        Ok(())
    }

    fn report(&self) {
        let view = &self.view;
        let per_point = self.context.pixels_per_point();
        let [width, height] = view.status.extent;
        let origin = (view.picture.min.to_vec2() * per_point).round();
        println!("picture {} {} {width} {height}", origin.x, origin.y);
        println!(
            "look {} {} {}",
            view.look.technique, view.look.mode, view.look.filter
        );
        println!("camera {}", view.eye.words());
        println!("time {}", view.subject.time);
        println!("pipelines {}", self.host.gpu().pipelines_made());
        for (grip, at) in &view.curve.handles {
            println!("handle {grip:?} {} {}", at.x, at.y);
        }
        match &view.picked {
            None => {}
            Some(Picked::Nothing) => println!("pick nothing"),
            Some(Picked::Something {
                position, value, ..
            }) => {
                let [x, y, z] = position.to_array();
                println!("pick {x} {y} {z} {}", value.unwrap_or(f64::NAN));
            }
        }
        if let Some(message) = &view.message {
            println!("message {message}");
        }
    }

    /// Records all of a frame; gives the screenshots that will be in it.
    fn record(&mut self, begun: Begun, output: FullOutput) -> Result<Vec<Shot>, Error> {
        let swapchain = self.swapchain.as_ref().expect("frames have one");
        let window = swapchain.extent;
        let per_point = output.pixels_per_point;
        let place = pixels(self.view.picture, per_point, window);
        let FullOutput {
            textures_delta,
            shapes,
            ..
        } = output;
        let primitives = self.context.tessellate(shapes, per_point);
        let (cmd, frame) = (begun.cmd, begun.frame);
        let mut shots = Vec::new();
        // SAFETY: the command buffer is recording outside rendering; its frame in flight is free, and everything that is
        // used lives until it is done, because what is dropped waits for that.
        unsafe {
            let painter = self.painter.as_mut().expect("made with the swapchain");
            painter.prepare(cmd, frame, textures_delta, &primitives, per_point, window)?;
            if place.extent.width > 0 && place.extent.height > 0 {
                self.draw_volume(begun, [place.extent.width, place.extent.height])?;
            }
            self.save_pictures(cmd, &mut shots)?;
        }
        let swapchain = self.swapchain.as_ref().expect("frames have one");
        let painter = self.painter.as_ref().expect("made with the swapchain");
        let shown = &swapchain.images[begun.image];
        let (gpu, device) = (self.host.gpu(), &self.host.device);
        let mut target = Target {
            image: shown.image,
            view: shown.view,
            format: swapchain.format,
            extent: window,
            // What it showed is given up. The semaphore of its acquisition is waited for at this stage: so the change of
            // layout, which begins here, waits for it too.
            before: TargetState {
                layout: vk::ImageLayout::UNDEFINED,
                stage: vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT,
                access: vk::AccessFlags2::NONE,
                queue_family: vk::QUEUE_FAMILY_IGNORED,
            },
            // Presentation waits for a semaphore, which makes all visible.
            after: TargetState {
                layout: vk::ImageLayout::PRESENT_SRC_KHR,
                stage: vk::PipelineStageFlags2::NONE,
                access: vk::AccessFlags2::NONE,
                queue_family: vk::QUEUE_FAMILY_IGNORED,
            },
        };
        // SAFETY: as above.
        unsafe {
            target.enter(gpu, cmd, Use::ColorTarget);
            let black = Load::Clear([0.0, 0.0, 0.0, 1.0]);
            begin_rendering(gpu, cmd, &[(target.view, black)], window);
            if let Some(drawing) = self.drawing.as_ref().filter(|_| place.extent.width > 0) {
                let viewport = vk::Viewport {
                    x: place.offset.x as f32,
                    y: place.offset.y as f32,
                    width: place.extent.width as f32,
                    height: place.extent.height as f32,
                    min_depth: 0.0,
                    max_depth: 1.0,
                };
                device.cmd_set_viewport(cmd, 0, &[viewport]);
                device.cmd_set_scissor(cmd, 0, &[place]);
                painter.draw_picture(cmd, &drawing.canvas.bindings);
            }
            painter.draw(cmd, frame, window);
            end_rendering(gpu, cmd);
            let mut last = Use::ColorTarget;
            for save in std::mem::take(&mut self.saves) {
                let Save::Window(path) = save else {
                    continue;
                };
                if !swapchain.can_be_copied {
                    self.view.message = Some("the driver lets no window be copied".into());
                    continue;
                }
                let shot = Shot::new(gpu, path, swapchain.format, window)?;
                if last == Use::ColorTarget {
                    let present = std::mem::replace(&mut target.after, Use::TransferRead.into());
                    target.leave(gpu, cmd, last);
                    (target.after, last) = (present, Use::TransferRead);
                }
                let copy = [vk::BufferImageCopy::default()
                    .image_subresource(vk::ImageSubresourceLayers {
                        aspect_mask: vk::ImageAspectFlags::COLOR,
                        layer_count: 1,
                        ..Default::default()
                    })
                    .image_extent(vk::Extent3D {
                        width: window[0],
                        height: window[1],
                        depth: 1,
                    })];
                let layout = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
                let buffer = &shot.buffer;
                device.cmd_copy_image_to_buffer(cmd, target.image, layout, buffer.raw(), &copy);
                buffer_barrier(gpu, cmd, buffer, Use::TransferWrite, Use::HostRead);
                shots.push(shot);
            }
            target.leave(gpu, cmd, last);
        }
        Ok(shots)
    }

    /// Brings the picture of the volume up to date, where it is not.
    ///
    /// # Safety
    /// As [`Drawing::record`].
    unsafe fn draw_volume(&mut self, begun: Begun, place: [u32; 2]) -> Result<(), Error> {
        let (cmd, frame) = (begun.cmd, begun.frame);
        self.view.status.extent = place;
        self.view.eye.fit(place);
        let parts = self.parts();
        let extent = place.map(|side| side.div_ceil(parts));
        // SAFETY: the caller's promise.
        unsafe {
            self.follow_look(cmd, extent)?;
            self.follow_arrived(cmd)?;
        }
        let Some(drawing) = &mut self.drawing else {
            return Ok(());
        };
        let painter = self.painter.as_ref().expect("made with the swapchain");
        if drawing.canvas.extent != extent {
            // What was asked of the images before is gone with them.
            self.asked = None;
            drawing.resize(painter, extent)?;
        }
        let now = Drawn {
            look: self.view.look.clone(),
            eye: self.view.eye.clone(),
            time: self.view.subject.time,
            extent,
        };
        if self.drawn.as_ref() == Some(&now) && self.view.to_pick.is_none() {
            return Ok(());
        }
        let camera = self.view.eye.camera(extent);
        let camera = camera.map_err(|error| Error::Drawing(error.into()))?;
        let timer = self.timers[frame as usize].as_ref();
        // SAFETY: the caller's promise.
        unsafe { drawing.record(cmd, frame, &camera, timer)? };
        self.timed[frame as usize] = Some(parts);
        self.drawn = Some(now);
        if let Some(at) = self.view.to_pick.take() {
            let per_point = self.context.pixels_per_point();
            let at = (at - self.view.picture.min) * per_point / parts as f32;
            let pixel = [at.x, at.y].map(|x| x.max(0.0) as u32);
            let pixel = [0, 1].map(|k| pixel[k].min(extent[k] - 1));
            // SAFETY: as above, after the picture.
            match unsafe { drawing.renderer.record_pick(cmd, frame, pixel) } {
                Ok(()) => self.asked = Some((frame, pixel)),
                Err(error @ stratavox::embed::Error::NoDepth { .. }) => {
                    self.view.picked = None;
                    self.view.message = Some(error.to_string());
                }
                Err(error) => return Err(error.into()),
            }
        }
        Ok(())
    }

    /// In how many parts the sides of the picture are shrunk while a hand moves it. A script sees all pixels.
    fn parts(&self) -> u32 {
        let moves = self.last_move.is_some_and(|moved| moved.elapsed() < REST);
        match self.view.status.picture_ms {
            Some(ms) if moves && self.steps.is_none() && ms > SLOW_MS => {
                ((ms / SLOW_MS).sqrt().ceil() as u32).min(4)
            }
            _ => 1,
        }
    }

    /// What changed of the look goes to the renderer, in the cheapest way there is.
    ///
    /// # Safety
    /// As [`Drawing::new`].
    unsafe fn follow_look(
        &mut self,
        cmd: vk::CommandBuffer,
        extent: [u32; 2],
    ) -> Result<(), Error> {
        use stratavox::embed::Error as Refused;
        let look = &self.view.look;
        let mut is_other = true;
        if let (Some(drawing), Some(drawn)) = (&mut self.drawing, &self.drawn) {
            let changed = match look.change_from(&drawn.look) {
                Change::Kind => Err(None),
                Change::Numbers => drawing.renderer.set_settings(look.settings()).map_err(Some),
                Change::Nothing => Ok(()),
            };
            let is_same = look.function() == drawn.look.function();
            let changed = changed.and_then(|()| match is_same {
                true => Ok(()),
                false => drawing.renderer.set_function(look.function()).map_err(Some),
            });
            is_other = match changed {
                Ok(()) => false,
                Err(None | Some(Refused::OtherClass { .. })) => true,
                Err(Some(error)) => return Err(error.into()),
            };
        }
        if !is_other {
            return Ok(());
        }
        let painter = self.painter.as_ref().expect("made with the swapchain");
        let (gpu, count) = (self.host.gpu(), self.frames.count());
        let voxels = &self.view.subject.voxels;
        // SAFETY: the caller's promise.
        let made = unsafe { Drawing::new(gpu, cmd, painter, voxels, look, extent, count) };
        match (made, &self.drawn) {
            (Ok(made), _) => {
                self.asked = None;
                self.drawing = Some(made);
            }
            // What cannot be drawn so is said, and the picture stays.
            (
                Err(error @ Error::Drawing(Refused::NotEmbedded { .. } | Refused::Technique(_))),
                Some(drawn),
            ) => {
                let before = drawn.look.clone();
                self.view.refuse(&error, before);
            }
            (Err(error), _) => return Err(error),
        }
        Ok(())
    }

    /// The time that was read takes the place of the one before, without a stall: its textures are made, its upload is
    /// recorded here.
    ///
    /// # Safety
    /// As [`stratavox::embed::Volume::record_upload`].
    unsafe fn follow_arrived(&mut self, cmd: vk::CommandBuffer) -> Result<(), Error> {
        let Some(mut read) = self.arrived.take() else {
            return Ok(());
        };
        let (look, Some(drawing)) = (&self.view.look, &mut self.drawing) else {
            return Ok(());
        };
        let textures = |settings: &stratavox::technique::Settings| {
            (
                settings.technique,
                settings.filter,
                settings.shading.is_some(),
            )
        };
        if textures(&read.settings) != textures(&look.settings()) {
            // A hand was faster: the time is asked for once more, in other textures.
            return Ok(());
        }
        // SAFETY: the caller's promise.
        unsafe { read.textures.record_upload(self.host.gpu(), cmd)? };
        drawing.set_volume(&Arc::new(read.textures), look.function())?;
        self.view.subject.voxels = Arc::new(read.voxels);
        self.view.subject.time = read.time;
        Ok(())
    }

    /// # Safety
    /// The command buffer is recording outside rendering.
    unsafe fn save_pictures(
        &mut self,
        cmd: vk::CommandBuffer,
        shots: &mut Vec<Shot>,
    ) -> Result<(), Error> {
        let (gpu, Some(drawing)) = (self.host.gpu(), &self.drawing) else {
            return Ok(());
        };
        let image = &drawing.canvas.image;
        for save in std::mem::take(&mut self.saves) {
            let Save::Picture(path) = save else {
                self.saves.push(save);
                continue;
            };
            let shot = Shot::new(gpu, path, image.format(), drawing.canvas.extent)?;
            // SAFETY: the caller's promise; the picture is sampled before and after.
            unsafe {
                image_barrier(gpu, cmd, image, Use::FragmentSampled, Use::TransferRead);
                image_to_buffer(gpu, cmd, image, Region::whole(image), &shot.buffer, 0)?;
                image_barrier(gpu, cmd, image, Use::TransferRead, Use::FragmentSampled);
                buffer_barrier(gpu, cmd, &shot.buffer, Use::TransferWrite, Use::HostRead);
            }
            shots.push(shot);
        }
        Ok(())
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
