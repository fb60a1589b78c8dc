//! The order of flags in the help of verbs that draw: first those that most pictures need, the others by topic.

use super::Arguments;
use clap::{Arg, Command, CommandFactory};

/// The flags that people use most, in the order of the help.
const COMMON: [&str; 15] = [
    "output",
    "view",
    "zoom",
    "size",
    "background",
    "preset",
    "colormap",
    "window",
    "tf",
    "mode",
    "shading",
    "section",
    "annotate",
    "variable",
    "time",
];

/// The topic of flags that name none.
const OTHER: &str = "Sampling";

/// The verbs whose flags are those of a picture.
const DRAWING: [&str; 4] = ["render", "animate", "thumbnails", "bench"];

/// The words of the program, with its flags in the order of their use.
pub fn command() -> Command {
    let command = Arguments::command();
    DRAWING.iter().fold(command, |command, verb| {
        command.mut_subcommand(verb, |verb| verb.mut_args(by_use))
    })
}

fn by_use(arg: Arg) -> Arg {
    // A number below 0 is one out of range, and no flag that nobody knows.
    let takes_word = arg.get_action().takes_values() && !arg.is_positional();
    let arg = match takes_word {
        true => arg.allow_negative_numbers(true),
        false => arg,
    };
    let place = COMMON.iter().position(|name| arg.get_id() == *name);
    match place {
        Some(place) => arg.help_heading(None::<&str>).display_order(place),
        None if arg.get_help_heading().is_none() && !arg.is_positional() => arg.help_heading(OTHER),
        None => arg,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_help_of_render_opens_with_examples_and_the_flags_that_people_use() {
        let mut command = command();
        let render = command.find_subcommand_mut("render").expect("a verb");
        let help = render.render_long_help().to_string();
        let place = |text: &str| {
            help.find(text)
                .unwrap_or_else(|| panic!("no {text}: {help}"))
        };
        let other = place("Sampling:");
        assert!(place("Examples:") < other);
        let options = help[..other].lines().filter_map(|line| {
            let (_, option) = line.split_once("--")?;
            let is_option = line.trim_start().starts_with('-');
            is_option.then(|| option.split(' ').next().expect("one part at least"))
        });
        assert_eq!(
            options.collect::<Vec<_>>(),
            [&COMMON[..], &["help"]].concat()
        );
    }
}
