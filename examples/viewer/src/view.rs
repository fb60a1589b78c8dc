//! What the window shows, without anything of Vulkan: the subject, its look, the eye, and what a person is told.

use crate::curve::Curve;
use crate::error::Error;
use crate::eye::Eye;
use crate::keys::Command;
use crate::look::{FILTERS, Look, MODES, next};
use crate::subject::Subject;
use egui::{Pos2, Rect};
use glam::DVec3;
use std::collections::VecDeque;
use stratavox::annotate::{Annotation, Facts, Marks};

pub struct View {
    pub subject: Subject,
    pub look: Look,
    pub eye: Eye,
    pub curve: Curve,
    pub has_panel: bool,
    pub has_help: bool,
    /// The marks of `annotation` are drawn.
    pub has_marks: bool,
    pub annotation: Annotation,
    pub is_playing: bool,
    /// The time that the slider stands at; `subject.time` is the one that is drawn.
    pub wanted_time: u32,
    /// Where the picture is, in points.
    pub picture: Rect,
    /// Where the pointer was that drags the picture, when it was last heard of.
    pub held: Option<Pos2>,
    /// A hand is on something that changes the picture.
    pub is_moving: bool,
    /// The place in the picture that is to be looked at, in points of the window.
    pub to_pick: Option<Pos2>,
    pub picked: Option<Picked>,
    /// What a person should know, and it goes with the next thing that is done.
    pub message: Option<String>,
    /// Commands that the viewer itself obeys.
    pub commands: VecDeque<Command>,
    /// A variable of the source that is to be opened.
    pub wanted_variable: Option<String>,
    pub status: Status,
}

/// What lies under a pixel.
#[derive(Clone, Debug, PartialEq)]
pub enum Picked {
    Nothing,
    Something {
        position: DVec3,
        /// Of the voxel there; `None` where it has no data.
        value: Option<f64>,
        is_label: bool,
        /// What the label is called.
        name: Option<String>,
    },
}

/// What the panel says of the work.
#[derive(Clone, Debug, Default)]
pub struct Status {
    pub device: String,
    /// The last picture of the volume, on the device.
    pub picture_ms: Option<f64>,
    pub extent: [u32; 2],
    /// Paths a pixel, of how many, where light scatters.
    pub paths: Option<[u32; 2]>,
    /// How noisy they are, once that is known.
    pub noise: Option<f64>,
    pub present: String,
    pub pipelines: u32,
    pub device_bytes: u64,
}

impl View {
    /// With the marks of `annotate`, or the usual ones, which a key shows.
    pub fn new(subject: Subject, has_panel: bool, annotate: Option<&Marks>) -> Self {
        let mut eye = Eye::new(subject.voxels.grid(), subject.side());
        eye.may_choose_side = subject.has_open_side();
        let usual = || Marks::USUAL.parse().expect("words of a list");
        let annotation = Annotation {
            marks: annotate.cloned().unwrap_or_else(usual),
            size: None,
            color: None,
            is_log: false,
            facts: Facts::of(subject.header(), &subject.file),
        };
        Self {
            look: Look::new(&subject),
            eye,
            wanted_time: subject.time,
            subject,
            curve: Curve::default(),
            has_panel,
            has_help: false,
            has_marks: annotate.is_some(),
            annotation,
            is_playing: false,
            picture: Rect::ZERO,
            held: None,
            is_moving: false,
            to_pick: None,
            picked: None,
            message: None,
            commands: VecDeque::new(),
            wanted_variable: None,
            status: Status::default(),
        }
    }

    /// Another subject in the same window.
    pub fn show(&mut self, subject: Subject) {
        let (status, commands) = (self.status.clone(), std::mem::take(&mut self.commands));
        *self = Self {
            status,
            commands,
            picture: self.picture,
            has_marks: self.has_marks,
            ..Self::new(subject, self.has_panel, Some(&self.annotation.marks))
        };
    }

    /// The title of the window.
    pub fn title(&self) -> String {
        let [x, y, z] = self.subject.voxels.dims;
        format!("{} ({x} × {y} × {z}) - stratavox", self.subject.name)
    }

    /// Does what a key asks for, or leaves it to the viewer.
    pub fn obey(&mut self, command: Command, pointer: Option<Pos2>, pixels: [u32; 2]) {
        self.message = None;
        let before = self.look.clone();
        match command {
            Command::Technique(technique) => self.look.technique = technique,
            Command::NextMode { is_back } => {
                let mode = next(&MODES, self.look.mode, is_back);
                self.look.set_mode(mode, &self.subject.voxels);
            }
            Command::NextFilter { is_back } => {
                self.look.filter = next(&FILTERS, self.look.filter, is_back);
            }
            Command::Light => self.look.light_by_hand = Some(!self.look.wants_light()),
            Command::Scatter => {
                self.look.scatters = !self.look.scatters;
                if self.look.scatters && !self.look.rests() {
                    self.message = Some(SCATTERS_IN.into());
                }
            }
            Command::Marks => self.has_marks = !self.has_marks,
            Command::Projection => self.eye.is_parallel = !self.eye.is_parallel,
            Command::View(side) => self.eye.orbit = side.orbit(),
            Command::Turn([right, down]) => self.eye.turn(right, down),
            Command::Zoom(factor) => self.eye.approach(factor, [0.0; 2], pixels),
            Command::Reset => self.eye.reset(),
            Command::Pick => self.to_pick = pointer.filter(|at| self.picture.contains(*at)),
            Command::Play => self.is_playing = self.times() > 1 && !self.is_playing,
            Command::NextTime { is_back } => self.step_time(is_back),
            Command::Panel => self.has_panel = !self.has_panel,
            Command::Help => self.has_help = !self.has_help,
            Command::Close => self.has_help = false,
            Command::SavePicture | Command::SaveWindow | Command::SayCamera | Command::Quit => {
                self.commands.push_back(command);
            }
        }
        self.keep_look_possible(before);
    }

    /// A look that cannot be drawn is not taken, and a person is told why.
    pub fn keep_look_possible(&mut self, before: Look) {
        if let Err(error) = self.look.check() {
            self.refuse(&error, before);
        }
    }

    /// Back to `before`, because of `error`.
    pub fn refuse(&mut self, error: &Error, before: Look) {
        self.message = Some(error.to_string());
        self.look = before;
    }

    pub fn times(&self) -> u32 {
        self.subject.header().times
    }

    pub fn step_time(&mut self, is_back: bool) {
        let times = self.times();
        let step = if is_back { times - 1 } else { 1 };
        self.wanted_time = (self.wanted_time + step) % times;
    }

    /// The name of a time.
    pub fn time_name(&self, time: u32) -> String {
        let names = &self.subject.header().time_names;
        names.get(time as usize).cloned().unwrap_or_default()
    }
}

const SCATTERS_IN: &str = "light scatters in composites by rays, with the filters linear and nearest and a function of the value alone";

/// A number with as many digits as a person reads.
pub fn short(value: f64) -> String {
    let size = value.abs();
    match size {
        _ if value == 0.0 => "0".into(),
        _ if !(1e-3..1e6).contains(&size) => format!("{value:.2e}"),
        _ if value.fract() == 0.0 => format!("{value}"),
        _ => {
            let digits = (3 - size.log10().floor() as i32).max(0) as usize;
            let text = format!("{value:.digits$}");
            match text.contains('.') {
                true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
                false => text,
            }
        }
    }
}
