//! `--show vapor|wind|both`: a scene of the weather by one word, which stands for flags that are said.
//!
//! | word | stands for |
//! |---|---|
//! | `vapor` | `--variable VAPOUR --mode iso --iso-color-by TEMPERATURE --annotate` |
//! | `wind` | `--variable VAPOUR --hide-volume --flow stream --annotate`, the terrain where the ground is not flat |
//! | `both` | the first with `--flow stream` |

use super::{
    Error,
    flags::SceneFlags,
    flow::{FlowWord, Variables},
    ground::has_relief,
    load::open,
    map::MapWords,
};
use crate::annotate::{Marks, caption};
use crate::figure::letter_lacking;
use crate::technique::Mode;
use crate::volume::Header;
use clap::{Args, ValueEnum};

/// What is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ShowWord {
    /// A surface of water vapour, coloured by temperature
    Vapor,
    /// Stream lines of the wind, coloured by its speed
    Wind,
    /// Both
    Both,
}

/// CF standard names, then names of WRF, ECMWF, NCEP and CMIP.
const VAPOUR: [&[&str]; 2] = [
    &[
        "humidity_mixing_ratio",
        "specific_humidity",
        "relative_humidity",
    ],
    &["QVAPOR", "q", "hus", "SPFH", "vapor"],
];
const TEMPERATURE: [&[&str]; 2] = [&["air_temperature"], &["temperature", "t", "ta", "TMP"]];

/// `--show`, of commands that draw one volume.
#[derive(Args, Clone, Copy, Debug, Default)]
pub struct ShowFlags {
    /// A scene of the weather: a surface of water vapour coloured by temperature, stream lines of the wind coloured by
    /// its speed, or both; it stands for flags, which are said. A film shows all times
    #[arg(long, value_enum, value_name = "SCENE", help_heading = "Lines")]
    pub show: Option<ShowWord>,
}

impl ShowFlags {
    /// Fills in the flags that the word stands for, and says them.
    pub fn expand(self, scene: &mut SceneFlags) -> Result<Option<String>, Error> {
        let Some(word) = self.show else {
            return Ok(None);
        };
        let words = expand(word, scene)?;
        scene.default_to_auto();
        let name = word
            .to_possible_value()
            .map(|value| value.get_name().to_owned());
        Ok(Some(format!(
            "--show {}: {words}",
            name.unwrap_or_default()
        )))
    }
}

/// Fills in the flags that the word stands for and no other flag says; what they are, as a person would write them.
fn expand(word: ShowWord, scene: &mut SceneFlags) -> Result<String, Error> {
    if scene.input.are_points() {
        return Err(Error::usage(
            "--show: the input is scattered points, which have neither vapour nor wind",
            "--points-as spheres --map --annotate",
        ));
    }
    let limits = scene.input.limits();
    let source = open(&scene.input, &limits)?;
    let header = source.header();
    let wanted = |names: [&[&str]; 2], what: &str| {
        found(header, names).ok_or_else(|| {
            let wanted = names.concat().join(", ");
            let there = match header.variables.as_slice() {
                [] => "one variable without a name".to_owned(),
                names => names.join(", "),
            };
            Error::usage(
                format!("--show: no {what} in the input: wanted one of {wanted}, found {there}"),
                "--variable, --mode iso, --iso-color-by and --flow draw other variables so",
            )
        })
    };
    let has_surface = word != ShowWord::Wind;
    if scene.input.variable.is_none() && (has_surface || !header.variables.is_empty()) {
        // Lines alone want a grid, of whatever it is.
        scene.input.variable = match (wanted(VAPOUR, "water vapour"), has_surface) {
            (Ok(name), _) => Some(name),
            (Err(refused), true) => return Err(refused),
            (Err(_), false) => None,
        };
    }
    if has_surface {
        scene.sampling.mode.get_or_insert(Mode::Iso);
        if scene.modes.levels.iso_color_by.is_none() {
            scene.modes.levels.iso_color_by = Some(wanted(TEMPERATURE, "temperature")?);
        }
    } else {
        scene.flow_style.hide_volume = true;
    }
    if word != ShowWord::Vapor {
        scene.flow.flow.get_or_insert(FlowWord::Stream);
    }
    let variables = Variables {
        input: &scene.input,
        limits,
    };
    if scene.map.map.is_none() && MapWords::can_show(header, &variables) {
        let all: MapWords = MapWords::ALL.parse().expect("words");
        // Below a surface of vapour the ground is hidden.
        let has_terrain = word == ShowWord::Wind && has_relief(header, &variables);
        scene.map.map = Some(if has_terrain { all.with_terrain() } else { all });
    }
    if scene.annotate.annotate.is_none() {
        let usual: Marks = Marks::USUAL.parse().expect("marks");
        let title = has_surface.then(|| title(scene)).transpose()?;
        scene.annotate.annotate = Some(Marks { title, ..usual });
    }
    let mut words = Vec::new();
    words.extend(
        scene
            .input
            .variable
            .iter()
            .map(|name| format!("--variable {name}")),
    );
    words.extend(
        scene
            .sampling
            .mode
            .iter()
            .map(|mode| format!("--mode {mode}")),
    );
    let by = scene.modes.levels.iso_color_by.iter();
    words.extend(by.map(|name| format!("--iso-color-by {name}")));
    if scene.flow_style.hide_volume {
        words.push("--hide-volume".to_owned());
    }
    words.extend(
        scene
            .flow
            .flow
            .iter()
            .map(|flow| format!("--flow {}", flow.name())),
    );
    words.extend(scene.map.map.iter().map(|map| format!("--map {map}")));
    let marks = scene.annotate.annotate.iter();
    words.extend(marks.map(|marks| match marks.to_string() {
        usual if usual == Marks::USUAL => "--annotate".to_owned(),
        other => format!("--annotate '{other}'"),
    }));
    Ok(words.join(" "))
}

/// What the surface is of, and what its colours are of; letters that are not drawn are left out.
fn title(scene: &SceneFlags) -> Result<String, Error> {
    let of = |variable: &Option<String>| {
        let mut input = scene.input.clone();
        input.variable.clone_from(variable);
        let source = open(&input, &input.limits())?;
        Ok::<_, Error>(caption(source.header()))
    };
    let surface = of(&scene.input.variable)?;
    let colors = of(&scene.modes.levels.iso_color_by)?;
    let title = format!("{surface} coloured by {colors}");
    Ok(title
        .chars()
        .filter(|&c| letter_lacking(&c.to_string()).is_none())
        .collect())
}

/// The first variable of these standard names or names; one that is derived before a name alone.
fn found(header: &Header, [standard, names]: [&[&str]; 2]) -> Option<String> {
    let by_standard = standard.iter().find_map(|wanted| {
        let at = header
            .variable_standard_names
            .iter()
            .position(|name| name == wanted)?;
        header.variables.get(at).cloned()
    });
    let derived = || {
        let one = header
            .derived
            .iter()
            .find(|one| names.contains(&one.name.as_str()));
        one.map(|one| one.name.clone())
    };
    let by_name = || {
        names
            .iter()
            .find(|name| header.variables.iter().any(|own| own == *name))
    };
    by_standard
        .or_else(derived)
        .or_else(|| by_name().map(|name| (*name).to_owned()))
}
