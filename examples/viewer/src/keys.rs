//! What keys do: one table, which the help shows and the viewer obeys.

use egui::{Event, Key};
use stratavox::camera::View;
use stratavox::technique::Technique;

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Command {
    Technique(Technique),
    NextMode { is_back: bool },
    NextFilter { is_back: bool },
    Projection,
    Light,
    Scatter,
    Marks,
    View(View),
    Turn([f64; 2]),
    Zoom(f64),
    Reset,
    Pick,
    Play,
    NextTime { is_back: bool },
    SavePicture,
    SaveWindow,
    SayCamera,
    Panel,
    Help,
    Close,
    Quit,
}

/// A key, alone and with shift.
pub struct Row {
    pub key: Key,
    pub command: Command,
    pub shifted: Option<Command>,
    pub name: &'static str,
    pub what: &'static str,
}

const fn row(
    key: Key,
    command: Command,
    shifted: Option<Command>,
    name: &'static str,
    what: &'static str,
) -> Row {
    Row {
        key,
        command,
        shifted,
        name,
        what,
    }
}

/// Of the pointer, for the help.
pub const POINTER: [(&str, &str); 5] = [
    ("drag", "turn"),
    ("shift + drag, middle drag", "move"),
    ("wheel", "nearer, farther"),
    ("click", "what lies there"),
    ("double click", "all of it again"),
];

/// Every key.
pub const KEYS: &[Row] = &[
    row(
        Key::Num1,
        Command::Technique(Technique::Raycast),
        None,
        "1",
        "rays",
    ),
    row(
        Key::Num2,
        Command::Technique(Technique::Slices3d),
        None,
        "2",
        "slices across the line of sight",
    ),
    row(
        Key::Num3,
        Command::Technique(Technique::Slices2d),
        None,
        "3",
        "the volume's own slices",
    ),
    row(
        Key::M,
        Command::NextMode { is_back: false },
        Some(Command::NextMode { is_back: true }),
        "M",
        "next mode, with shift the one before",
    ),
    row(
        Key::F,
        Command::NextFilter { is_back: false },
        Some(Command::NextFilter { is_back: true }),
        "F",
        "next filter, with shift the one before",
    ),
    row(Key::L, Command::Light, None, "L", "light on surfaces"),
    row(
        Key::G,
        Command::Scatter,
        None,
        "G",
        "light that scatters, where rays composite and the picture rests",
    ),
    row(
        Key::A,
        Command::Marks,
        None,
        "A",
        "colour bar, scale and letters",
    ),
    row(
        Key::O,
        Command::Projection,
        None,
        "O",
        "perspective or parallel",
    ),
    row(
        Key::X,
        Command::View(View::Right),
        Some(Command::View(View::Left)),
        "X",
        "from the right, with shift from the left",
    ),
    row(
        Key::Y,
        Command::View(View::Anterior),
        Some(Command::View(View::Posterior)),
        "Y",
        "from the front, with shift from behind",
    ),
    row(
        Key::Z,
        Command::View(View::Superior),
        Some(Command::View(View::Inferior)),
        "Z",
        "from above, with shift from below",
    ),
    row(
        Key::ArrowLeft,
        Command::Turn([-25.0, 0.0]),
        None,
        "arrows",
        "turn",
    ),
    row(Key::ArrowRight, Command::Turn([25.0, 0.0]), None, "", ""),
    row(Key::ArrowUp, Command::Turn([0.0, -25.0]), None, "", ""),
    row(Key::ArrowDown, Command::Turn([0.0, 25.0]), None, "", ""),
    row(
        Key::Plus,
        Command::Zoom(1.2),
        None,
        "+ -",
        "nearer, farther",
    ),
    row(Key::Equals, Command::Zoom(1.2), None, "", ""),
    row(Key::Minus, Command::Zoom(1.0 / 1.2), None, "", ""),
    row(Key::R, Command::Reset, None, "R", "the first view"),
    row(
        Key::P,
        Command::Pick,
        None,
        "P",
        "what lies under the pointer",
    ),
    row(Key::Space, Command::Play, None, "space", "play a series"),
    row(
        Key::Period,
        Command::NextTime { is_back: false },
        None,
        ". ,",
        "next time, the one before",
    ),
    row(
        Key::Comma,
        Command::NextTime { is_back: true },
        None,
        "",
        "",
    ),
    row(
        Key::S,
        Command::SavePicture,
        Some(Command::SaveWindow),
        "S",
        "save the picture, with shift the window",
    ),
    row(
        Key::C,
        Command::SayCamera,
        None,
        "C",
        "print the camera for stratavox render",
    ),
    row(
        Key::Tab,
        Command::Panel,
        None,
        "tab",
        "hide or show the panel",
    ),
    row(Key::H, Command::Help, None, "H", "this help"),
    row(Key::Escape, Command::Close, None, "esc", "close the help"),
    row(Key::Q, Command::Quit, None, "Q", "end"),
];

/// What the keys of these events ask for; they are taken out, so that egui does not move its focus with them.
pub fn take(events: &mut Vec<Event>) -> Vec<Command> {
    let mut commands = Vec::new();
    events.retain(|event| {
        let Event::Key {
            key,
            pressed,
            modifiers,
            ..
        } = event
        else {
            return true;
        };
        let row = KEYS.iter().find(|row| row.key == *key);
        let Some(row) = row.filter(|_| !modifiers.ctrl && !modifiers.alt) else {
            return true;
        };
        if *pressed {
            let shifted = row.shifted.filter(|_| modifiers.shift);
            commands.push(shifted.unwrap_or(row.command));
        }
        false
    });
    commands
}
