//! `--annotate`: words and marks over a picture, one figure of its size, without a ground.
//!
//! ```text
//! top left       title, time            right          colour bars, or patches of colour with names
//! bottom left    arrows, scale bar      bottom right   source           edges   letters of a patient's sides
//! ```
//!
//! PNG and films get it laid over, float files as a layer of its own.

mod bar;
mod bounds;
mod degrees;
mod facts;
mod geometry;
mod marks;
mod moment;
mod place;
mod projector;
mod sheet;
mod units;

pub use degrees::DegreeLine;
pub use facts::{Facts, caption, unit};
pub use geometry::{ColorLegend, GeometryLegend};
pub use marks::Marks;

#[cfg(feature = "files")]
use crate::picture::{Layer, LayerKind, PictureFormat};
use crate::{
    camera::Camera,
    figure::{Anchor, linear_pixels, short},
    picture::Picture,
    scene::Beside,
    technique::{Mode, Role, Settings},
    transfer::{Classified, TransferFunction, Window},
    volume::Grid,
};
use bar::{Bar, Room, column, legend};
use geometry::APART;
use projector::Projector;
use sheet::Sheet;

/// Why marks cannot be drawn.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// Of a title.
    #[error("--annotate title: no letter '{}'", .0.escape_debug())]
    NoLetter(char),
    /// Values that have no logarithm are to be spread by it.
    #[error("--colormap-scale log: wanted values above 0, found {0}")]
    NoLogarithm(f64),
}

/// What is drawn over the pictures of a volume.
#[derive(Clone, Debug)]
pub struct Annotation {
    /// Which marks.
    pub marks: Marks,
    /// Pixels of an em; `None`: a fortieth of the picture's height, at least 11.
    pub size: Option<f64>,
    /// Of words and lines, sRGB; `None`: black or white, by what lies under them.
    pub color: Option<[f64; 3]>,
    /// The bar's values are spread by their logarithms.
    pub is_log: bool,
    /// What is known of the volume.
    pub facts: Facts,
}

/// What a picture shows.
#[derive(Clone, Copy, Debug)]
pub struct Seen<'a> {
    /// Who looks.
    pub camera: &'a Camera,
    /// What was computed.
    pub settings: &'a Settings,
    /// How values are seen; `None`: grey over the range that is `projected`, or surfaces of colours of their own.
    pub function: Option<&'a TransferFunction>,
    /// What the volume is seen together with.
    pub beside: Beside<'a>,
    /// Where voxels are drawn.
    pub grid: Grid,
    /// How much higher than it is the volume is drawn.
    pub height_factor: f64,
    /// The time, counted from 0.
    pub time: f64,
    /// The range of what the mode projects, where colours are of it.
    pub projected: Option<[f64; 2]>,
    /// What there is to say of geometry in the picture.
    pub geometry: GeometryLegend<'a>,
}

/// Marks as pixels of a picture: linear light, premultiplied.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawn {
    /// What lies behind the volume; empty where nothing does.
    pub behind: Vec<[f32; 4]>,
    /// What lies over the picture.
    pub front: Vec<[f32; 4]>,
}

impl Annotation {
    /// What a person should know of it.
    pub fn note(&self) -> Option<String> {
        let letter = self.facts.letters_lacking()?;
        Some(format!(
            "--annotate: no letter {letter:?}, words of the file have boxes for such letters"
        ))
    }

    /// What a picture without its background lets through, where marks lie behind the volume.
    pub fn transmittance(&self, picture: &Picture) -> Option<Vec<f32>> {
        let is_wanted = self.marks.has_box();
        is_wanted.then(|| picture.pixels.iter().map(|pixel| 1.0 - pixel[3]).collect())
    }

    /// Draws over a picture that has its background, or adds a layer, as its file will have it.
    #[cfg(feature = "files")]
    pub fn put(
        &self,
        picture: &mut Picture,
        transmittance: Option<&[f32]>,
        seen: &Seen,
        format: PictureFormat,
    ) -> Result<(), Error> {
        let pixels = self.pixels(picture, transmittance, seen)?;
        match format {
            PictureFormat::Png => picture.lay_over(&pixels),
            PictureFormat::Exr | PictureFormat::Npy => picture.layers.push(Layer {
                kind: LayerKind::Annotation,
                values: pixels.into_flattened(),
            }),
        }
        Ok(())
    }

    /// Linear light, premultiplied.
    #[cfg(feature = "files")]
    fn pixels(
        &self,
        picture: &Picture,
        transmittance: Option<&[f32]>,
        seen: &Seen,
    ) -> Result<Vec<[f32; 4]>, Error> {
        let Drawn { behind, mut front } = self.draw(picture, seen)?;
        let behind = behind.iter().zip(transmittance.unwrap_or_default());
        for (over, (under, through)) in front.iter_mut().zip(behind) {
            let left = (1.0 - over[3]) * through.clamp(0.0, 1.0);
            *over = std::array::from_fn(|k| over[k] + left * under[k]);
        }
        Ok(front)
    }

    /// Pixels of an em in a picture of so many rows.
    pub fn em(&self, height: u32) -> f64 {
        self.size.unwrap_or((f64::from(height) / 40.0).max(11.0))
    }

    /// The marks over a picture that has its background, and those that lie behind the volume.
    pub fn draw(&self, picture: &Picture, seen: &Seen) -> Result<Drawn, Error> {
        let em = self.em(picture.height);
        let sheet = || Sheet::new(picture, em, self.color);
        let mut front = sheet();
        let projector = Projector::new(seen.camera, front.size());
        let mut behind = Vec::new();
        if self.marks.has_box() {
            let mut back = sheet();
            bounds::draw(&mut back, &projector, &seen.grid, true);
            behind = linear_pixels(&back.figure);
            bounds::draw(&mut front, &projector, &seen.grid, false);
        }
        if self.marks.ticks {
            bounds::ticks(
                &mut front,
                &projector,
                &seen.grid,
                &self.facts,
                seen.height_factor,
            );
        }
        self.words(&mut front, &projector, seen)?;
        Ok(Drawn {
            behind,
            front: linear_pixels(&front.figure),
        })
    }

    fn words(&self, sheet: &mut Sheet, projector: &Projector, seen: &Seen) -> Result<(), Error> {
        let ([width, height], em) = (sheet.size(), sheet.em);
        let mut right = width;
        let mut baseline = 1.6 * em;
        // Bars begin below words that reach over them.
        let mut top = 0.0;
        if let Some(title) = &self.marks.title {
            let title = sheet.shortened(title, 1.3, width - 2.0 * em);
            sheet.text_on_ground([em, baseline + 0.2 * em], &title, 1.3, Anchor::Start);
            if em + sheet.width(&title, 1.3) > column(width, em) {
                top = baseline + 0.6 * em;
            }
            baseline += 1.8 * em;
        }
        if self.marks.time
            && let Some(text) = moment::words(&self.facts, seen.time)
        {
            moment::draw(sheet, [em, baseline], &text);
            if em + moment::widest(sheet, &self.facts, &text) > column(width, em) {
                top = baseline + 0.4 * em;
            }
        }
        let mut bottom = height - em;
        if self.marks.scale {
            bottom = place::scale(sheet, projector, &self.facts, seen.height_factor);
        }
        if self.marks.bar {
            let (room, lines) = self.room(sheet, seen, top);
            let lefts = [
                self.colors(sheet, seen, room)?,
                geometry::bars(sheet, seen, room)?,
            ];
            right = lefts.into_iter().flatten().fold(right, f64::min);
            geometry::write(sheet, &lines);
        }
        let has_letters = self.marks.orientation && self.facts.is_patient;
        if has_letters {
            place::sides(sheet, projector, right);
        }
        if self.marks.axes || self.marks.orientation && !has_letters {
            place::triad(sheet, projector, place::axis_names(&self.facts), bottom);
        }
        if self.marks.source {
            let text = sheet.shortened(&self.facts.source, 0.9, 0.6 * width);
            sheet.text_on_ground([width - em, height - em], &text, 0.9, Anchor::End);
        }
        if self.marks.orientation {
            degrees::draw(sheet, projector, seen.geometry.degrees);
        }
        Ok(())
    }

    /// The rows that are left for bars below `top`, and the lines of sentences below them; none, where bars have no room beside
    /// them.
    fn room(&self, sheet: &Sheet, seen: &Seen, top: f64) -> (Room, Vec<(f64, String)>) {
        let ([_, height], em) = (sheet.size(), sheet.em);
        let levels = self.level_lines(sheet, seen).len();
        let below = self.base() + APART * levels as f64;
        let lines = geometry::words(sheet, seen, below);
        let bars = geometry::count(seen);
        // Words stand below the last of several.
        let free = height - if bars > 1 { 3.0 * em } else { 0.0 };
        let above = |baseline: f64| baseline - 1.3 * em;
        let lowest = match levels {
            0 => free,
            _ => free.min(above(height - (below - APART) * em)),
        };
        let room = |bottom: f64| Room { top, bottom };
        let Some((highest, _)) = lines.last() else {
            return (room(lowest), lines);
        };
        let beside = room(lowest.min(above(*highest)));
        match bars == 0 || beside.has(bars, em) {
            true => (beside, lines),
            false => (room(lowest), Vec::new()),
        }
    }

    /// The bar, or patches of colour; where it begins.
    fn colors(&self, sheet: &mut Sheet, seen: &Seen, room: Room) -> Result<Option<f64>, Error> {
        let facts = &self.facts;
        let Seen {
            settings, beside, ..
        } = *seen;
        let others = match beside {
            Beside::Channels(channels) => channels,
            _ => &[],
        };
        if settings.mode == Mode::Iso {
            if let ([channel], Some((caption, unit))) = (others, &facts.paint)
                && let Some(function) = channel.transfer
            {
                let left = Bar {
                    function,
                    depth: None,
                    caption,
                    unit: unit.as_deref(),
                    is_log: self.is_log,
                    levels: Vec::new(),
                    slot: geometry::slot(sheet, seen, room),
                }
                .draw(sheet)?;
                self.levels_below(sheet, seen);
                return Ok(left);
            }
            return self.surfaces(sheet, seen, room);
        }
        if matches!(beside, Beside::Colors(_)) || facts.is_color && !others.is_empty() {
            return Ok(None);
        }
        if others.iter().any(|other| other.role == Role::Numbers) {
            return Ok(legend(sheet, &self.channels(seen)));
        }
        let of_picture;
        let function = match (seen.function, seen.projected) {
            (Some(function), _) => function,
            (None, Some(range)) if range[0] <= range[1] => {
                of_picture = Window::of_range(range).grey(Classified::Projection);
                &of_picture
            }
            (None, _) => return Ok(None),
        };
        let integral =
            (settings.mode == Mode::Xray).then(|| facts.unit.clone().unwrap_or_default());
        let integral = integral.map(|unit| format!("{unit} × length"));
        let bar = Bar {
            function,
            depth: depth_of(function, seen),
            caption: &facts.caption,
            unit: integral.as_deref().or(facts.unit.as_deref()),
            is_log: self.is_log,
            levels: Vec::new(),
            slot: geometry::slot(sheet, seen, room),
        };
        bar.draw(sheet)
    }

    /// Marks on the bar where surfaces have the colours of a function, else a patch for each.
    fn surfaces(&self, sheet: &mut Sheet, seen: &Seen, room: Room) -> Result<Option<f64>, Error> {
        let levels = &seen.settings.per_mode.levels;
        if let Some(function) = seen.function {
            let is_of_function = levels.iter().all(|level| {
                let found = function.srgb(level.value);
                (0..3).all(|k| (found[k] - level.srgb[k]).abs() < 1e-3)
            });
            if is_of_function && !levels.is_empty() {
                let bar = Bar {
                    function,
                    depth: None,
                    caption: &self.facts.caption,
                    unit: self.facts.unit.as_deref(),
                    is_log: self.is_log,
                    levels: levels.iter().map(|level| level.value).collect(),
                    slot: geometry::slot(sheet, seen, room),
                };
                return bar.draw(sheet);
            }
        }
        let entry = |level: &crate::technique::Level| (level.srgb, self.level(level.value));
        let entries: Vec<_> = levels.iter().map(entry).collect();
        Ok(legend(sheet, &entries))
    }

    /// How far above the lower side words begin in the lower right, in em.
    fn base(&self) -> f64 {
        if self.marks.source { 2.6 } else { 0.7 }
    }

    /// What stands in the lower right where surfaces have the colours of another variable: which variable and level each
    /// shows, from above.
    fn level_lines(&self, sheet: &Sheet, seen: &Seen) -> Vec<String> {
        if seen.settings.mode != Mode::Iso || self.facts.paint.is_none() {
            return Vec::new();
        }
        let levels = seen.settings.per_mode.levels.iter();
        let lines = levels.flat_map(|level| {
            // A number and its unit are not parted.
            let level = self.level(level.value).replace(' ', "\u{a0}");
            let words = format!("{} {level}", self.facts.caption);
            sheet.wrapped(&words, 1.0, 0.5 * sheet.size()[0], 2)
        });
        lines.collect()
    }

    fn levels_below(&self, sheet: &mut Sheet, seen: &Seen) {
        let ([width, height], em) = (sheet.size(), sheet.em);
        let lines = self.level_lines(sheet, seen);
        for (at, text) in lines.iter().rev().enumerate() {
            let y = height - (self.base() + APART * at as f64) * em;
            sheet.text_on_ground([width - em, y], text, 1.0, Anchor::End);
        }
    }

    fn level(&self, value: f64) -> String {
        let (unit, factor) = units::scaled(self.facts.unit.as_deref(), value.abs());
        let number = units::signed(&short(value * factor));
        format!("{number} {}", unit.unwrap_or_default())
            .trim()
            .to_owned()
    }

    /// The last colour of each channel, and its name.
    fn channels(&self, seen: &Seen) -> Vec<([f64; 3], String)> {
        let others = match seen.beside {
            Beside::Channels(channels) => channels,
            _ => &[],
        };
        let others = others.iter().filter(|other| other.role == Role::Numbers);
        let functions = std::iter::once(seen.function).chain(others.map(|other| other.transfer));
        let colors = functions
            .flatten()
            .filter_map(|f| f.color.last().map(|point| point.srgb));
        let name = |at: usize| match self.facts.channels.get(at) {
            Some(name) if !name.is_empty() => name.clone(),
            _ => format!("channel {at}"),
        };
        colors
            .enumerate()
            .map(|(at, srgb)| (srgb, name(at)))
            .collect()
    }
}

/// How many reference lengths of the function an eighth of the box's diagonal is; `None` where something else says how
/// opaque a value is.
fn depth_of(function: &TransferFunction, seen: &Seen) -> Option<f64> {
    let is_other = match seen.beside {
        Beside::Channels(channels) => channels.iter().any(|other| other.role == Role::Opacity),
        _ => false,
    };
    if function.uses_gradient() || is_other || function.opacity.is_empty() {
        return None;
    }
    if seen.settings.mode.is_projection() {
        return Some(1.0);
    }
    let per = function
        .reference_length
        .unwrap_or_else(|| seen.grid.smallest_spacing());
    Some(seen.grid.diagonal() / (8.0 * per))
}
