//! Geometry in a picture: lines along a wind and of the Earth, points as spheres, surfaces.
//!
//! ```text
//! words -> lines in the drawn world -> round cones and triangles for a camera (`placed`)
//! ```

use super::super::{
    Error,
    flags::{InputFlags, SceneFlags},
    ground::Ground,
    map::GroundLine,
    progress::Progress,
    readable::in_unit,
};
use super::barbs::{self, Barbs};
use super::colors::LineColors;
use super::film::{FilmSeed, FilmTime, seeds_of};
use super::flags::{FlowColor, FlowWord};
use super::moving::{Drawn, Passed, Tail, Way, Ways, in_words};
use super::ribbon::turns;
use super::style::StyleWord;
use super::surface::Surface;
use super::variable::Variables;
use crate::annotate::{ColorLegend, DegreeLine, GeometryLegend};
use crate::color::decode_srgb;
use crate::figure::short;
use crate::points::Points;
use crate::volume::Header;
use glam::DVec3;
use std::sync::Arc;

/// Pixels; of the heads of comets, of spheres along lines, and of ribbons.
const WIDTH: f64 = 3.0;
const COMET_WIDTH: f64 = 6.0;
const SPHERE_WIDTH: f64 = 8.0;
const RIBBON_WIDTH: f64 = 12.0;
/// Tails of particles, of the times of the file.
const TAIL: f64 = 0.125;

/// Lines in the drawn world: of a wind, of the Earth; and what else is drawn beside a volume.
#[derive(Clone, Debug, Default)]
pub struct DrawnLines {
    pub(super) sets: Vec<LineSet>,
    pub(super) surfaces: Vec<Surface>,
    /// What the colours of points beside the volume mean.
    pub(super) points: Option<ColorLegend>,
    /// What the colours of the wind mean, where they have several.
    legend: Option<ColorLegend>,
    /// Values at the ends of these colours.
    range: [f64; 2],
    /// Where lines of other frames of a film begin.
    seeds: Vec<FilmSeed>,
    /// What other frames of a film draw up to their times.
    ways: Option<Arc<Ways>>,
    /// Seconds between spheres along them.
    sphere_step: Option<f64>,
    pub(super) barbs: Option<Barbs>,
    pub(super) ground: Option<Ground>,
    /// What symbols mean, a sentence each.
    words: Vec<String>,
    /// Meridians and parallels.
    degrees: Vec<DegreeLine>,
}

/// Lines that look alike.
#[derive(Clone, Debug)]
pub(super) struct LineSet {
    pub(super) lines: Vec<Vec<(DVec3, [f32; 3])>>,
    pub(super) width: Width,
    /// Of each line, where they differ: how wide it is of that.
    pub(super) shares: Option<Vec<f64>>,
    /// The same of each place of each line.
    pub(super) tapers: Option<Vec<Vec<f64>>>,
    /// Of ribbons: how far they are turned at each place of each line, radians.
    pub(super) turns: Option<Vec<Vec<f64>>>,
    /// The number of each line, where they have one.
    pub(super) numbers: Option<Vec<u32>>,
    pub(super) has_heads: bool,
    /// Of the map, in a section: half of its world thickness.
    pub(super) on_section: Option<f64>,
    /// By its radius, over what it lies on.
    pub(super) is_lifted: bool,
}

/// How wide lines are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Width {
    /// Where the camera is turned to.
    Pixels(f64),
    /// In the drawn world.
    World(f64),
}

impl LineSet {
    /// Lines that differ in nothing but their colours.
    pub(super) fn plain(lines: Vec<Vec<(DVec3, [f32; 3])>>, width: Width) -> Self {
        Self {
            lines,
            width,
            shares: None,
            tapers: None,
            turns: None,
            numbers: None,
            has_heads: false,
            on_section: None,
            is_lifted: false,
        }
    }

    /// Points with their values as spheres, larger where these are; pixels across the largest.
    pub(super) fn of_points(
        points: impl Iterator<Item = (DVec3, f64)>,
        [low, high]: [f64; 2],
        color: impl Fn(f64) -> [f32; 3],
        pixels: Option<f64>,
    ) -> Self {
        let share = |value: f64| {
            let part = ((value - low) / (high - low)).clamp(0.0, 1.0);
            SMALLEST + (1.0 - SMALLEST) * if part.is_finite() { part } else { 0.5 }
        };
        let all = points.map(|(place, value)| (vec![(place, color(value))], share(value)));
        let (lines, shares) = all.unzip();
        Self {
            shares: Some(shares),
            ..Self::plain(lines, Width::Pixels(pixels.unwrap_or(SPHERE_PIXELS)))
        }
    }
}

/// Pixels across a sphere of the largest value, and what the smallest has of it.
const SPHERE_PIXELS: f64 = 14.0;
const SMALLEST: f64 = 0.3;

impl DrawnLines {
    /// Points as spheres, in the colours of their values and larger where these are; pixels across the largest.
    pub fn spheres(
        points: &Points,
        is_kept: impl Fn(DVec3) -> bool,
        legend: ColorLegend,
        pixels: Option<f64>,
    ) -> Self {
        let values = points.values().iter().copied().map(f64::from);
        let all = points.places().iter().copied().zip(values);
        let kept = all.filter(|(place, _)| is_kept(*place));
        let color = |value: f64| legend.function.srgb(value).map(|c| decode_srgb(c as f32));
        let range = points.value_range();
        let set = LineSet::of_points(kept, range, color, pixels);
        Self {
            sets: vec![set],
            range,
            legend: Some(legend),
            ..Self::default()
        }
    }

    /// With more lines; what colours mean is that of these first.
    pub fn with(mut self, more: Self) -> Self {
        self.sets.extend(more.sets);
        self.surfaces = more.surfaces;
        self.points = more.points;
        self.seeds = more.seeds;
        self.ways = more.ways;
        self.sphere_step = more.sphere_step;
        self.barbs = more.barbs;
        self.ground = more.ground;
        self.words = more.words;
        self.degrees = more.degrees;
        self.legend = self.legend.or(more.legend);
        self
    }

    /// The lines that the words name, drawn so much higher than they are, around the volume of this header; `None` where
    /// there is no word.
    pub fn of(
        scene: &SceneFlags,
        header: &Header,
        height_factor: f64,
        of_film: Option<FilmTime>,
        progress: &Progress,
    ) -> Result<Option<Self>, Error> {
        if scene.geometry_word().is_none() {
            return Ok(None);
        }
        let stretch = DVec3::new(1.0, 1.0, height_factor);
        let said = header.notes.as_slice();
        let mut drawn = Self::default();
        let at = of_film.map(|film| film.time);
        drawn.ground = Ground::read(scene, header, stretch, at, progress)?;
        let input = &input_of_wind(scene);
        let variables = Variables {
            input,
            limits: input.limits(),
        };
        let of_map = scene.map.lines(header, &variables, progress)?;
        let is_on_light = is_light(scene.picture.background());
        drawn.add_map(of_map, stretch, scene.section.half_thickness(), is_on_light);
        if let Some(word) = scene.flow.flow {
            let of_seeds = of_film.filter(|film| !film.seeds.is_empty());
            match of_film.and_then(|film| film.ways.map(|ways| (ways, ways.now(&film)))) {
                Some((ways, now)) => {
                    let of_film = of_film.and_then(|film| film.sphere_step);
                    let of = (ways, Some(now), of_film);
                    drawn.add_ways(of, word, scene, header, progress)?
                }
                None => drawn.add_wind(word, scene, header, stretch, of_seeds, progress)?,
            }
        }
        drawn.add_barbs(scene, stretch, of_film, said, progress)?;
        drawn.add_shapes(scene, header, stretch, progress)?;
        Ok(Some(drawn))
    }

    /// Lines of the Earth, on the terrain where there is any.
    fn add_map(
        &mut self,
        lines: Vec<GroundLine>,
        stretch: DVec3,
        on_section: Option<f64>,
        is_on_light: bool,
    ) {
        let terrain = self
            .ground
            .as_ref()
            .and_then(|ground| ground.terrain.as_ref());
        for line in lines {
            let parts = match terrain {
                Some(terrain) => terrain.draped(&line.places),
                None => vec![line.places],
            };
            let drawn = parts
                .iter()
                .map(|part| part.iter().map(|&place| stretch * place));
            if let Some((degrees, is_meridian)) = line.degrees {
                self.degrees.push(DegreeLine {
                    degrees,
                    is_meridian,
                    places: drawn.clone().flatten().collect(),
                });
            }
            // The brightest lines stand out most from the dark, and the darkest from a light background; the ground is neither.
            let grey = match is_on_light {
                true => 1.0 - line.grey,
                false => line.grey,
            };
            let color = [decode_srgb(grey); 3];
            let lines = drawn.map(|part| part.map(|place| (place, color)).collect());
            self.sets.push(LineSet {
                on_section,
                is_lifted: self.ground.is_some(),
                ..LineSet::plain(lines.collect(), Width::Pixels(line.width))
            });
        }
    }

    fn add_barbs(
        &mut self,
        scene: &SceneFlags,
        stretch: DVec3,
        of_film: Option<FilmTime>,
        said: &[String],
        progress: &Progress,
    ) -> Result<(), Error> {
        let Some(words) = scene.barbs.barbs else {
            return Ok(());
        };
        let color = scene.barbs.barb_color.map(|color| color.0);
        let is_on_ground = self.ground.is_some();
        let color = color.unwrap_or_else(|| match is_on_ground {
            true => DARK,
            false => ink_on(scene.picture.background()),
        });
        let is_dark = color.iter().sum::<f64>() < 1.5;
        let casing = is_on_ground.then_some(if is_dark { LIGHT } else { DARK });
        let linear = |color: [f64; 3]| color.map(|c| decode_srgb(c as f32));
        let request = barbs::Request {
            words,
            input: &input_of_wind(scene),
            wind: scene.flow.wind_words()?,
            stretch,
            color: linear(color),
            casing: casing.map(linear),
            of_film,
            said,
        };
        // What there is to say of the wind was said of its lines.
        let quiet = Progress::of_part();
        let of_wind = if scene.flow.flow.is_some() {
            &quiet
        } else {
            progress
        };
        let barbs = Barbs::read(&request, of_wind, progress)?;
        self.words.push(barbs.words.clone());
        self.barbs = Some(barbs);
        Ok(())
    }

    fn add_wind(
        &mut self,
        word: FlowWord,
        scene: &SceneFlags,
        header: &Header,
        stretch: DVec3,
        of_film: Option<FilmTime>,
        progress: &Progress,
    ) -> Result<(), Error> {
        let (flags, style) = (&scene.flow, &scene.flow_style);
        let said = header.notes.as_slice();
        let input = &input_of_wind(scene);
        let traced = flags.traced(word, input, of_film, Some(said), progress)?;
        let one = match flags.color()? {
            Some(FlowColor::One(color)) => Some(color),
            _ => None,
        };
        let values = &traced.values;
        let range = style.flow_range.map(|range| range.0);
        let colors = LineColors::new(values, one, style.flow_colormap.as_deref(), range);
        if one.is_none() {
            let [low, high] = colors.range;
            progress.note(&format!(
                "lines are coloured by {}, from {} to {}{}",
                values.name,
                short(low),
                short(high),
                in_unit(traced.unit.as_deref())
            ));
        }
        let mut ways = Vec::new();
        for (line, numbers) in traced.lines.iter().zip(&values.numbers) {
            let seconds = |vertex: Option<&crate::flow::Vertex>| vertex.map_or(0.0, |v| v.time);
            let ends = [line.vertices.first(), line.vertices.last()].map(seconds);
            for range in line.piece_ranges() {
                let vertices = &line.vertices[range.clone()];
                let turns = match style.flow_style {
                    Some(StyleWord::Ribbons) => turns(&traced.wind.field, vertices, traced.at),
                    _ => Vec::new(),
                };
                let passed = vertices.iter().zip(&numbers[range]).enumerate();
                let passed = passed.map(|(i, (vertex, &value))| Passed {
                    place: stretch * vertex.place,
                    color: colors.of(value),
                    seconds: vertex.time,
                    turn: turns.get(i).copied().unwrap_or(0.0),
                });
                let passed = passed.collect();
                let number = line.seed as u32 + 1;
                ways.push(Way {
                    passed,
                    ends,
                    number,
                });
            }
        }
        if word == FlowWord::Stream {
            self.seeds = seeds_of(&traced.lines);
        }
        let ways = Ways {
            ways,
            seconds: traced
                .wind
                .times
                .iter()
                .map(|&(_, seconds)| seconds)
                .collect(),
            legend: one.is_none().then(|| ColorLegend {
                function: colors.function(),
                caption: traced.caption,
                unit: traced.unit,
            }),
            range: colors.range,
        };
        let of_first = of_film.and_then(|film| film.sphere_step);
        self.add_ways((&ways, None, of_first), word, scene, header, progress)?;
        self.ways = (word == FlowWord::Path).then(|| Arc::new(ways));
        Ok(())
    }

    /// Ways at a moment, or as long as they are; spheres along them so many seconds apart, where the first frame of a film says it.
    fn add_ways(
        &mut self,
        (ways, now, step): (&Ways, Option<f64>, Option<f64>),
        word: FlowWord,
        scene: &SceneFlags,
        header: &Header,
        progress: &Progress,
    ) -> Result<(), Error> {
        let style = &scene.flow_style;
        let look = style.flow_style.unwrap_or(match word {
            FlowWord::Stream => StyleWord::Arrows,
            FlowWord::Path | FlowWord::Streak => StyleWord::Tube,
        });
        if style.comet_time.is_some() && look != StyleWord::Comets {
            return Err(Error::usage(
                "--comet-time is of comets",
                "--flow-style comets draws them",
            ));
        }
        let tail = match (look, word, style.comet_time) {
            (StyleWord::Comets, FlowWord::Streak, _) => {
                return Err(Error::usage(
                    "--flow streak with --flow-style comets: smoke has no heads",
                    "--flow path has one for each particle",
                ));
            }
            (StyleWord::Points | StyleWord::Ribbons, FlowWord::Streak, _) => {
                return Err(Error::usage(
                    "--flow streak with --flow-style points and ribbons: no particle goes along smoke",
                    "--flow path has the way of each particle, --flow-style tube is for smoke",
                ));
            }
            (StyleWord::Tube | StyleWord::Arrows | StyleWord::Points | StyleWord::Ribbons, ..) => {
                Tail::All
            }
            (StyleWord::Comets, _, Some(seconds)) => Tail::Comet(seconds),
            (StyleWord::Comets, FlowWord::Path, None) => Tail::Comet(TAIL * ways.span()),
            (StyleWord::Comets, FlowWord::Stream, None) => Tail::WholeComet,
        };
        let width = |default: f64| match style.flow_width {
            None => Ok(Width::Pixels(default)),
            Some(word) => word.in_world(header),
        };
        if look == StyleWord::Points {
            let step = step.unwrap_or_else(|| ways.time_apart(header.is_earth));
            self.sphere_step = Some(step);
            let marks = ways.ways.iter().map(|way| way.marks(now, step));
            let marks = marks.flatten().map(|mark| vec![mark]).collect();
            self.sets.push(LineSet::plain(marks, width(SPHERE_WIDTH)?));
            let step = in_words(step);
            progress.note(&format!("a sphere every {step}"));
            self.words.push(format!("A sphere every {step}"));
        } else {
            let drawn = ways.ways.iter().filter_map(|way| {
                let Drawn {
                    line,
                    shares,
                    turns,
                } = way.drawn(now, tail)?;
                Some((line, (way.number, (shares, turns))))
            });
            let (lines, others): (Vec<_>, Vec<_>) = drawn.unzip();
            let (numbers, others): (_, Vec<_>) = others.into_iter().unzip();
            let (tapers, turns) = others.into_iter().unzip();
            let default = match look {
                StyleWord::Comets => COMET_WIDTH,
                StyleWord::Ribbons => RIBBON_WIDTH,
                _ => WIDTH,
            };
            self.sets.push(LineSet {
                tapers: (look == StyleWord::Comets).then_some(tapers),
                turns: (look == StyleWord::Ribbons).then_some(turns),
                numbers: Some(numbers),
                has_heads: look == StyleWord::Arrows,
                ..LineSet::plain(lines, width(default)?)
            });
        }
        self.range = ways.range;
        self.legend.clone_from(&ways.legend);
        Ok(())
    }

    /// What other frames of a film draw up to their times.
    pub fn ways(&self) -> Option<&Arc<Ways>> {
        self.ways.as_ref()
    }

    /// Seconds between spheres along them; `None` where they have none.
    pub fn sphere_step(&self) -> Option<f64> {
        self.sphere_step
    }

    /// Values at the ends of their colours.
    pub fn range(&self) -> [f64; 2] {
        self.range
    }

    /// Where the lines of other frames of a film begin.
    pub fn seeds(&self) -> &[FilmSeed] {
        &self.seeds
    }

    /// What there is to say of them in a picture.
    pub fn legend(&self) -> GeometryLegend<'_> {
        GeometryLegend {
            lines: self.legend.as_ref(),
            points: self.points.as_ref(),
            ground: self
                .ground
                .as_ref()
                .and_then(|ground| ground.legend.as_ref()),
            words: &self.words,
            degrees: &self.degrees,
        }
    }
}

/// What is drawn is seldom the wind. What there is to say of the file was said of the volume.
pub(super) fn input_of_wind(scene: &SceneFlags) -> InputFlags {
    InputFlags {
        variable: None,
        component: None,
        ..scene.input.clone()
    }
}

/// sRGB of symbols.
const DARK: [f64; 3] = [0.1; 3];
const LIGHT: [f64; 3] = [0.95; 3];

/// sRGB of symbols that are to be seen: dark on a light background, else light.
fn ink_on(background: Option<[f64; 4]>) -> [f64; 3] {
    if is_light(background) { DARK } else { LIGHT }
}

fn is_light(background: Option<[f64; 4]>) -> bool {
    background.is_some_and(|[r, g, b, a]| a > 0.5 && (r + g + b) / 3.0 > 0.6)
}
