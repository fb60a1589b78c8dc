//! `stratavox convert INPUT -o LINES.vtp --flow stream`: lines along the wind of a file.
//!
//! ```text
//! wind -> seeds -> lines -> values -> .vtp, .csv or .glb
//! ```

mod barbs;
mod causes;
mod colors;
mod components;
mod drawn;
mod film;
mod flags;
mod ground;
mod moving;
mod notes;
mod placed;
mod ribbon;
mod seeds;
mod shapes;
mod style;
mod surface;
mod tubes;
mod value;
mod variable;
mod wind;

pub use barbs::BarbFlags;
pub use drawn::DrawnLines;
pub use film::{FilmSeed, FilmTime, with_range_of_film};
pub use flags::{FlowFlags, FlowWord};
pub use ground::{heights as ground_heights, sea_of};
pub use moving::Ways;
pub use notes::notes;
pub use style::FlowStyleFlags;
pub use variable::{Variables, numbers};

use super::{
    Error, exaggerate, flags::InputFlags, map::OnEarth, progress::Progress, signals::Gate,
};
use crate::annotate::{caption, unit};
use crate::figure::short;
use crate::flow::write::{Geography, LineValues, Upright, write_csv, write_vtp};
use crate::flow::{
    Direction, EvenLines, Limits, Line, Seeds, even_stream_lines, path_lines_from, streak_lines,
    stream_lines,
};
use crate::picture::{OutputError, OutputFile, OutputProblem};
use crate::volume::{Grid, Header};
use flags::FlowColor;
use glam::DVec3;
use std::io::{BufWriter, Write};
use std::path::Path;
use wind::Wind;

/// Particles go far apart: they are sown, not spaced.
const PARTICLES: Seeds = Seeds::Random {
    count: 200,
    seed: 0,
};

/// Between two places of a cell the wind is linear: lines that are nearer than this part of it show nothing more.
const LEAST_OF_CELL: f64 = 0.5;

/// Seeds from one word of progress to the next, some for each thread.
const PART: usize = 1024;

/// Lines, with the wind that they follow.
struct Traced {
    lines: Vec<Line>,
    values: LineValues,
    wind: Wind,
    /// Of stream lines: seconds of the wind; `None` where vertices have their own.
    at: Option<f64>,
    /// What the values are, and their unit as the file has it.
    caption: String,
    unit: Option<String>,
}

/// Of a vertex of a line, with its value, and as it is drawn.
pub const VERTEX_BYTES: u64 = (size_of::<crate::flow::Vertex>()
    + size_of::<f64>()
    + size_of::<moving::Passed>()
    + size_of::<crate::geometry::Vertex>()) as u64;

/// Bytes of the wind of an input at one of its times; `None` where it has none.
pub fn wind_bytes(input: &InputFlags) -> Option<u64> {
    let variables = Variables {
        input: &InputFlags {
            variable: None,
            component: None,
            ..input.clone()
        },
        limits: input.limits(),
    };
    let found = components::components(&variables, None, &Progress::of_part()).ok()?;
    Some(wind::bytes(found.east.0.header(), 1))
}

/// A kind of file for lines.
#[derive(Clone, Copy, Debug, PartialEq)]
enum LineFormat {
    Vtp,
    Csv,
    Glb,
}

impl LineFormat {
    fn of_path(path: &Path) -> Result<Self, Error> {
        let ending = path.extension().and_then(|ending| ending.to_str());
        match ending.unwrap_or_default().to_ascii_lowercase().as_str() {
            "vtp" => Ok(Self::Vtp),
            "csv" => Ok(Self::Csv),
            "glb" => Ok(Self::Glb),
            _ => Err(Error::usage(
                format!("-o {}: no format of lines has that ending", path.display()),
                "name a file that ends in .vtp, .csv or .glb",
            )),
        }
    }
}

impl FlowFlags {
    /// What can be refused before anything is read.
    pub fn check(&self, path: &Path) -> Result<(), Error> {
        let format = LineFormat::of_path(path)?;
        self.check_words()?;
        match (self.color()?, format) {
            (Some(FlowColor::One(_)), LineFormat::Vtp | LineFormat::Csv) => Err(Error::usage(
                "--flow-color R:G:B is for tubes",
                "--flow-color VAR writes the values of a variable",
            )),
            _ => Ok(()),
        }
    }

    /// The same of words that do not depend on what is made of the lines.
    pub fn check_words(&self) -> Result<(), Error> {
        let word = self.flow.map_or("stream", FlowWord::name);
        let is_even = matches!(self.seeds()?, Some(Seeds::Even | Seeds::EvenAt(_)));
        if self.flow != Some(FlowWord::Stream) && is_even {
            return Err(Error::usage(
                format!("--flow {word} with --flow-seeds even: particles keep no distance"),
                "--flow-seeds random:200",
            ));
        }
        let direction = self.flow_direction.map_or(Direction::Forward, Into::into);
        if self.flow == Some(FlowWord::Streak) && direction != Direction::Forward {
            return Err(Error::usage(
                "--flow streak with --flow-direction: smoke goes forward",
                "leave out --flow-direction",
            ));
        }
        Ok(())
    }

    /// Reads the wind, of whose file this was `said` where something was, and traces the lines.
    fn traced(
        &self,
        word: FlowWord,
        input: &InputFlags,
        of_film: Option<FilmTime>,
        said: Option<&[String]>,
        progress: &Progress,
    ) -> Result<Traced, Error> {
        let limits = input.limits();
        let variables = Variables { input, limits };
        let is_of_particles = word != FlowWord::Stream;
        let at = of_film.map(|film| film.time);
        let words = self.wind_words()?;
        let wind = wind::read(&variables, words.as_ref(), word, at, said, progress)?;
        let painted = match self.color()? {
            Some(FlowColor::Variable(name)) => {
                let source = variables.open(&name)?;
                Some((name, caption(source.header()), unit(source.header())))
            }
            _ => None,
        };
        let start = match at {
            Some(time) => time.fract(),
            None => self.start(word, input, &wind)?,
        };
        progress.stage("trace", 0, 1);
        let lines = match of_film {
            Some(film) => film::lines_from(film.seeds, &wind, start),
            None => self.lines(word, &wind, start, &variables, progress)?,
        };
        causes::say(&lines, progress);
        if word == FlowWord::Path {
            causes::say_displacement(&lines, &wind, progress);
        }
        let at = |time: f64| if is_of_particles { time } else { start };
        let (values, caption, unit) = match painted {
            Some((name, caption, unit)) => {
                let values = value::along(&lines, &name, &wind, at, &variables)?;
                (values, caption, unit)
            }
            None => {
                let unit = wind.header.is_earth.then(|| "m s-1".to_owned());
                (LineValues::speeds(&lines), "Wind speed".to_owned(), unit)
            }
        };
        Ok(Traced {
            lines,
            values,
            wind,
            at: (!is_of_particles).then_some(start),
            caption,
            unit,
        })
    }

    /// Reads the wind, traces the lines and writes them.
    pub fn write(
        &self,
        word: FlowWord,
        input: &InputFlags,
        path: &Path,
        force: bool,
        progress: &Progress,
        gate: &Gate,
    ) -> Result<(), Error> {
        let format = LineFormat::of_path(path)?;
        let Traced {
            lines,
            values,
            wind,
            ..
        } = self.traced(word, input, None, None, progress)?;
        progress.stage("write", 0, 1);
        let make = || OutputFile::create(path, force);
        let mut file = gate.unfinished(make, |file| file.part().to_owned())?;
        let mut out = BufWriter::new(&mut file);
        let written = match format {
            LineFormat::Vtp => write_vtp(&lines, &values, &mut out),
            LineFormat::Csv => {
                let on_earth = OnEarth::of(&wind.header);
                let degrees = on_earth.map(|on_earth| move |at| on_earth.degrees(at));
                let geography = Geography {
                    degrees: degrees.as_ref().map(|degrees| degrees as &_),
                    upright: upright(&wind.header),
                };
                write_csv(&lines, &values, geography, &mut out)
            }
            LineFormat::Glb => {
                let one = match self.color()? {
                    Some(FlowColor::One(color)) => Some(color),
                    _ => None,
                };
                tubes::write_tubes(&lines, &values, wind.grid.diagonal(), one, &mut out)
            }
        };
        let outcome = written.and_then(|()| out.flush());
        drop(out);
        match outcome {
            Ok(()) => Ok(gate.finished(|| file.publish())?),
            Err(cause) => {
                gate.finished(|| drop(file));
                Err(Error::WritePicture(OutputError {
                    path: path.to_owned(),
                    problem: OutputProblem::Io {
                        doing: "cannot write the lines",
                        cause,
                    },
                }))
            }
        }
    }

    /// Seconds at which particles are at their seeds, or at which smoke is seen.
    fn start(&self, word: FlowWord, input: &InputFlags, wind: &Wind) -> Result<f64, Error> {
        let [first, last] = [wind.times.first(), wind.times.last()];
        let ends = [first, last].map(|end| end.map_or(0.0, |&(_, seconds)| seconds));
        if word == FlowWord::Stream {
            return Ok(ends[0]);
        }
        if input.time.is_none() {
            return Ok(if word == FlowWord::Path {
                ends[0]
            } else {
                ends[1]
            });
        }
        let (time, _) = input.time(&wind.header)?;
        let chosen = wind.times.iter().find(|(other, _)| *other == time);
        let chosen = chosen.map_or(ends[0], |&(_, seconds)| seconds);
        if word == FlowWord::Streak && chosen <= ends[0] {
            return Err(Error::usage(
                "--flow streak at the first time: no smoke has left yet",
                "--time of a later one",
            ));
        }
        Ok(chosen)
    }

    fn lines(
        &self,
        word: FlowWord,
        wind: &Wind,
        start: f64,
        variables: &Variables<'_>,
        progress: &Progress,
    ) -> Result<Vec<Line>, Error> {
        let limits = Limits {
            length: self.flow_length.unwrap_or(f64::INFINITY),
            duration: self.flow_time.unwrap_or(f64::INFINITY),
            ..Limits::default()
        };
        let default = if word == FlowWord::Stream {
            Seeds::Even
        } else {
            PARTICLES
        };
        let words = self.seeds()?.unwrap_or(default);
        let direction = match (self.flow_direction, word) {
            (Some(direction), _) => direction.into(),
            (None, FlowWord::Stream) => Direction::Both,
            (None, _) => Direction::Forward,
        };
        if matches!(words, Seeds::Even | Seeds::EvenAt(_)) {
            return self.even(&words, wind, start, direction, &limits, progress);
        }
        let seeds = seeds::places(&words, wind, variables)?;
        seeds::check(&seeds, wind, start)?;
        if word != FlowWord::Path && seeds.iter().any(|(_, time)| time.is_some()) {
            progress.note("times of seeds are for --flow path");
        }
        let seeds: Vec<(f64, DVec3)> = seeds
            .iter()
            .map(|&(place, time)| (time.unwrap_or(start), place))
            .collect();
        let trace = |seeds: &[(f64, DVec3)]| {
            let places = || seeds.iter().map(|&(_, place)| place).collect::<Vec<_>>();
            match word {
                FlowWord::Stream => stream_lines(&wind.field, start, &places(), direction, &limits),
                FlowWord::Path => path_lines_from(&wind.field, seeds, direction, &limits),
                FlowWord::Streak => {
                    let first = wind.times.first().map_or(0.0, |&(_, seconds)| seconds);
                    let since = first.max(start - limits.duration);
                    streak_lines(&wind.field, [since, start], &places(), &limits)
                }
            }
        };
        Ok(in_parts(&seeds, trace, progress))
    }

    fn even(
        &self,
        words: &Seeds,
        wind: &Wind,
        start: f64,
        direction: Direction,
        limits: &Limits,
        progress: &Progress,
    ) -> Result<Vec<Line>, Error> {
        let stretch = match wind.header.is_earth {
            true => exaggerate::suggested(&wind.grid),
            false => 1.0,
        };
        let mut spacing = EvenLines::of(&wind.grid, stretch);
        if let Seeds::EvenAt(distance) = words {
            let least = LEAST_OF_CELL * shortest_side(&wind.grid, stretch);
            if *distance < least {
                return Err(Error::usage(
                    format!(
                        "--flow-seeds even:{distance}: wanted a distance of at least {}, half of the shortest side of a cell \
                         as it is seen: nearer lines show nothing more",
                        short(least)
                    ),
                    "--flow-seeds even",
                ));
            }
            spacing.distance = *distance;
        }
        let mut vertices = 0;
        let mut told = |line: &Line, count: usize| {
            vertices += line.vertices.len();
            let [lines, vertices] = [
                count as f64 / spacing.most as f64,
                vertices as f64 / spacing.most_vertices as f64,
            ];
            progress.part(lines.max(vertices).min(1.0));
        };
        let lines = even_stream_lines(
            &wind.field,
            start,
            &wind.grid,
            spacing,
            direction,
            limits,
            &mut told,
        );
        if lines.is_empty() {
            return Err(Error::usage(
                format!(
                    "--flow-seeds even: no line is as long as the distance {}",
                    spacing.distance
                ),
                "--flow-seeds even:D with a smaller D, or random:200",
            ));
        }
        if lines.len() >= spacing.most || vertices >= spacing.most_vertices {
            progress.note(&format!(
                "there is room for more than the {} lines of {vertices} vertices: no more than {} lines and {} vertices are \
                 made; even:D with a D over {} leaves no gaps",
                lines.len(),
                spacing.most,
                spacing.most_vertices,
                spacing.distance
            ));
        }
        Ok(lines)
    }
}

/// Lines of so many seeds at a time, in their order; `progress` hears how many are done.
fn in_parts(
    seeds: &[(f64, DVec3)],
    trace: impl Fn(&[(f64, DVec3)]) -> Vec<Line>,
    progress: &Progress,
) -> Vec<Line> {
    let mut lines = Vec::new();
    for (part, seeds_of_part) in seeds.chunks(PART).enumerate() {
        let before = part * PART;
        progress.part(before as f64 / seeds.len() as f64);
        lines.extend(trace(seeds_of_part).into_iter().map(|line| Line {
            seed: before + line.seed,
            ..line
        }));
    }
    lines
}

/// World length of the shortest side of a cell as it is seen, of the axes that have several.
fn shortest_side(grid: &Grid, stretch: f64) -> f64 {
    let m = grid.world_from_voxel.matrix3;
    let seen = DVec3::new(1.0, 1.0, stretch);
    let sides = (0..3).filter(|&k| grid.dims[k] > 1);
    sides
        .map(|k| (seen * m.col(k)).length())
        .fold(f64::INFINITY, f64::min)
}

/// What z of the world is.
fn upright(header: &Header) -> Option<Upright> {
    let level = header.level_length().map(Upright::Level);
    let height = header.height_metres().filter(|_| header.is_earth);
    level.or(height.map(Upright::Height))
}
