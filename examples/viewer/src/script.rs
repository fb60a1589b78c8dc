//! What a hand does, as lines of a file. A script feeds the events that a window system would, and sees what a person
//! sees: pictures of the window.
//!
//! ```text
//! key M            a key; `key shift M`
//! press X Y        the left button; `press X Y right`, `press X Y middle`
//! move X Y         the pointer, in points from the window's upper left corner
//! release X Y
//! drag X Y X2 Y2   press, five moves, release; `drag X Y X2 Y2 middle`
//! click X Y
//! wheel N X Y      notches, over 0 is away from the hand
//! size W H         the window
//! time N           the slider of a series
//! frames N         that many frames
//! window FILE      the window into a PNG
//! picture FILE     the picture of the volume alone into a PNG, as `stratavox render` writes it
//! report           a line for each thing there is to know, on stdout
//! ```
//!
//! Each line waits until what the last one did is drawn. `#` begins a comment.

use crate::error::Error;
use egui::{Event, Key, Modifiers, MouseWheelUnit, PointerButton, Pos2, TouchPhase, pos2, vec2};
use std::collections::VecDeque;
use std::path::{Path, PathBuf};

/// What is done in one frame.
#[derive(Clone, Debug)]
pub enum Step {
    Events(Vec<Event>),
    Size([u32; 2]),
    Time(u32),
    Frame,
    Window(PathBuf),
    Picture(PathBuf),
    Report,
}

/// The steps of a file.
pub fn read(path: &Path) -> Result<VecDeque<Step>, Error> {
    let failed = |line: usize, problem: String| Error::Script {
        path: path.to_owned(),
        line,
        problem,
    };
    let text = std::fs::read_to_string(path).map_err(|cause| failed(0, cause.to_string()))?;
    let mut steps = VecDeque::new();
    for (number, line) in text.lines().enumerate() {
        let line = line.split('#').next().unwrap_or_default();
        let words: Vec<&str> = line.split_whitespace().collect();
        if !words.is_empty() {
            let read = steps_of(&words).ok_or_else(|| {
                failed(
                    number + 1,
                    format!("`{}` is not understood", words.join(" ")),
                )
            })?;
            steps.extend(read);
        }
    }
    Ok(steps)
}

fn steps_of(words: &[&str]) -> Option<Vec<Step>> {
    let number = |k: usize| words.get(k).and_then(|word| word.parse::<f32>().ok());
    let whole = |k: usize| words.get(k).and_then(|word| word.parse::<u32>().ok());
    let at = |k: usize| Some(pos2(number(k)?, number(k + 1)?));
    let button = |k: usize| match words.get(k) {
        None | Some(&"left") => Some(PointerButton::Primary),
        Some(&"right") => Some(PointerButton::Secondary),
        Some(&"middle") => Some(PointerButton::Middle),
        Some(_) => None,
    };
    Some(match *words.first()? {
        "key" => key(words)?,
        "press" => vec![moved(at(1)?), pressed(at(1)?, button(3)?, true)],
        "move" => vec![moved(at(1)?)],
        "release" => vec![moved(at(1)?), pressed(at(1)?, button(3)?, false)],
        "click" => vec![
            moved(at(1)?),
            pressed(at(1)?, button(3)?, true),
            pressed(at(1)?, button(3)?, false),
        ],
        "drag" => drag(at(1)?, at(3)?, button(5)?),
        "wheel" => vec![
            moved(at(2)?),
            Step::Events(vec![Event::MouseWheel {
                unit: MouseWheelUnit::Line,
                delta: vec2(0.0, number(1)?),
                modifiers: Modifiers::NONE,
                phase: TouchPhase::Move,
                source: egui::MouseWheelSource::Unknown,
            }]),
            // egui spreads a notch over some frames.
            Step::Frame,
        ],
        "size" => vec![Step::Size([whole(1)?, whole(2)?])],
        "time" => vec![Step::Time(whole(1)?)],
        "frames" => vec![Step::Frame; whole(1)? as usize],
        "window" => vec![Step::Window(words.get(1)?.into())],
        "picture" => vec![Step::Picture(words.get(1)?.into())],
        "report" => vec![Step::Report],
        _ => return None,
    })
}

fn key(words: &[&str]) -> Option<Vec<Step>> {
    let (modifiers, name) = match words {
        [_, "shift", name] => (Modifiers::SHIFT, name),
        [_, name] => (Modifiers::NONE, name),
        _ => return None,
    };
    let key = Key::from_name(name)?;
    let event = |pressed| Event::Key {
        key,
        physical_key: None,
        pressed,
        repeat: false,
        modifiers,
    };
    Some(vec![
        Step::Events(vec![event(true)]),
        Step::Events(vec![event(false)]),
    ])
}

fn moved(at: Pos2) -> Step {
    Step::Events(vec![Event::PointerMoved(at)])
}

fn pressed(pos: Pos2, button: PointerButton, pressed: bool) -> Step {
    Step::Events(vec![Event::PointerButton {
        pos,
        button,
        pressed,
        modifiers: Modifiers::NONE,
    }])
}

fn drag(from: Pos2, to: Pos2, button: PointerButton) -> Vec<Step> {
    const MOVES: u8 = 5;
    let mut steps = vec![moved(from), pressed(from, button, true)];
    steps.extend((1..=MOVES).map(|k| moved(from + (to - from) * f32::from(k) / f32::from(MOVES))));
    steps.push(pressed(to, button, false));
    steps
}
