//! What a hand, or a script in its place, asks for.

use super::{PATIENCE, Save, Window, reader};
use crate::error::Error;
use crate::keys::{self, Command};
use crate::panel;
use crate::script::Step;
use crate::shot::free_name;
use crate::subject::Subject;
use crate::view::Picked;
use egui::FullOutput;
use std::collections::VecDeque;
use std::time::Instant;
use winit::dpi::PhysicalSize;

impl Window {
    /// The next line of the script, when all that came before is drawn.
    pub(super) fn next_step(&mut self) -> Result<Option<Step>, Error> {
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

    pub(super) fn lay_out(&mut self, step: Option<&Step>) -> FullOutput {
        let mut input = self.egui.take_egui_input(&self.window);
        if self.steps.is_some() {
            // A script is the only hand, and its frames are even: a press and a release on either side of a slow one
            // would be no click.
            input.time = Some(self.context.cumulative_frame_nr() as f64 / 60.0);
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
        view.status.device_bytes = self.host.gpu().memory().reserved_bytes;
        let mut output = self.context.run_ui(input, |ui| panel::show(ui, view));
        if self.view.is_moving {
            self.last_move = Some(Instant::now());
        }
        let platform = std::mem::take(&mut output.platform_output);
        self.egui.handle_platform_output(&self.window, platform);
        output
    }

    pub(super) fn obey_step(&mut self, step: Option<Step>) {
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

    pub(super) fn obey_commands(&mut self) {
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
    pub(super) fn follow_time(&mut self) -> Result<(), Error> {
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

    pub(super) fn report(&self) {
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
        if let Some([traced, all]) = view.status.paths {
            println!("paths {traced} {all}");
        }
        for (grip, at) in &view.curve.handles {
            println!("handle {grip:?} {} {}", at.x, at.y);
        }
        match &view.picked {
            None => {}
            Some(Picked::Nothing) => println!("pick nothing"),
            Some(Picked::Something {
                position,
                value,
                name,
                ..
            }) => {
                let [x, y, z] = position.to_array();
                println!("pick {x} {y} {z} {}", value.unwrap_or(f64::NAN));
                println!("called {}", name.as_deref().unwrap_or("nothing"));
            }
        }
        if let Some(message) = &view.message {
            println!("message {message}");
        }
    }
}
