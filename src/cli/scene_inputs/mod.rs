//! What a picture shows: a volume and how it is classified, and what it is seen together with.

mod beside;
mod channels;
mod check;
mod colors;
mod level;
mod opacity;
mod paint;
mod points;
mod preclassified;
mod reader;
mod streamed;
mod with;

pub use check::{check, shows_several};
pub use level::with_level;
pub use paint::with_range_of_film;
pub use streamed::{is_wanted as wants_stream, open as open_stream};

use super::{
    Error,
    flags::{ChannelWord, Classification, ClassificationFlags, Plan, SceneFlags, Subject, context},
    flow::{DrawnLines, FilmTime},
    load::open_first,
    look::{Seen, base_of},
    memory::{self, DeviceRoom},
    progress::Progress,
};
use crate::{
    camera::Camera,
    offscreen::Stream,
    points::{FieldKernel, Points},
    scene::{Beside, Channel},
    technique::{Filter, FilterBy, Mode, PerMode, Role, Settings, splat::Splat},
    transfer::{Classified, Context, TransferFunction},
    volume::{Header, Limits, Source, Volume},
};
use check::{has_beside, plan};
use reader::Reader;
use std::sync::Arc;

/// Everything that is drawn.
#[derive(Debug)]
pub struct SceneInputs {
    /// The volume; red of colours, the first of channels.
    pub volume: Arc<Volume>,
    /// What its file says of it.
    pub header: Header,
    /// What the file says of its values, under `--look auto`.
    context: Option<Context>,
    /// How its values are seen.
    pub classification: Classification,
    /// What the mode wants to know of the values.
    pub per_mode: PerMode,
    /// Where the values themselves ask for one.
    pub filter: Option<Filter>,
    /// How much higher than it is the volume is drawn.
    pub height_factor: f64,
    others: Others,
    /// Of several channels, what each is drawn with.
    channels: Vec<ChannelWord>,
    /// Where the voxels come from, brick by brick; the volume is its outline then.
    stream: Option<Stream>,
    /// Of a stream every n-th voxel.
    overview: Option<Arc<Volume>>,
    /// Lines along the wind.
    lines: Option<DrawnLines>,
    /// The field of points that rays are cast through, once the points are known.
    field: Option<FieldKernel>,
    /// How many bits later splats of points end than one of them would, because so many lie at one place.
    crowd_bits: u32,
}

#[derive(Debug)]
enum Others {
    Channels(Vec<Other>),
    Colors(Vec<Volume>),
    Preclassified,
    Points(Points),
}

/// A volume that is seen together with the first.
#[derive(Debug)]
pub struct Other {
    /// On the same grid.
    pub volume: Volume,
    /// How its values are seen.
    pub function: TransferFunction,
    /// What it is.
    pub role: Role,
}

impl SceneInputs {
    /// Of one number a voxel, seen alone.
    fn new(
        volume: Volume,
        header: Header,
        height_factor: f64,
        classification: Classification,
        per_mode: PerMode,
    ) -> Self {
        Self {
            volume: Arc::new(volume),
            header,
            context: None,
            classification,
            per_mode,
            filter: None,
            height_factor,
            others: Others::Channels(Vec::new()),
            channels: Vec::new(),
            stream: None,
            overview: None,
            lines: None,
            field: None,
            crowd_bits: 0,
        }
    }

    /// Lines that are drawn with the volume.
    pub fn lines(&self) -> Option<&DrawnLines> {
        self.lines.as_ref()
    }

    /// The same with the lines that the words ask for, and without the volume where they say so.
    pub fn with_lines(
        mut self,
        scene: &SceneFlags,
        of_film: Option<FilmTime>,
        progress: &Progress,
    ) -> Result<Self, Error> {
        let drawn = DrawnLines::of(scene, &self.header, self.height_factor, of_film, progress)?;
        self.lines = match (self.lines.take(), drawn) {
            (Some(spheres), Some(lines)) => Some(spheres.with(lines)),
            (spheres, lines) => spheres.or(lines),
        };
        let style = &scene.flow_style;
        if style.hide_volume
            && let Classification::Function(function) = &mut self.classification
        {
            for point in &mut function.opacity {
                point.opacity = 0.0;
            }
        }
        Ok(self)
    }

    /// Reads what the words name, for a picture of these settings. Under `--look auto` the first of several variables is
    /// taken, and `scene` says so afterwards.
    pub fn read(
        scene: &mut SceneFlags,
        settings: &Settings,
        device: &dyn DeviceRoom,
        progress: &Progress,
    ) -> Result<Self, Error> {
        check(scene, settings)?;
        let limits = limits(scene);
        let source = open_first(scene, &limits, progress)?;
        let shown = Self::of_source(source, scene, settings, device, progress)?;
        Ok(shown.at_level(scene))
    }

    /// The same with opacities of the finest resolution, where a word takes a coarser one.
    pub fn at_level(mut self, scene: &SceneFlags) -> Self {
        let level = scene.input.level.filter(|&level| level > 0);
        if let (Some(level), Classification::Function(function)) = (level, &mut self.classification)
        {
            let spacing = self.volume.grid().smallest_spacing() / f64::from(level).exp2();
            function.reference_length.get_or_insert(spacing);
        }
        self
    }

    /// Of a source that is open already, from its file where it has to be.
    pub fn of_source(
        source: Box<dyn Source>,
        scene: &SceneFlags,
        settings: &Settings,
        device: &dyn DeviceRoom,
        progress: &Progress,
    ) -> Result<Self, Error> {
        let with_level = with_level(scene, settings.mode, source.as_ref(), progress)?;
        let scene = with_level.as_ref().unwrap_or(scene);
        let shown = match streamed::is_wanted(source.as_ref(), scene, settings, device)? {
            true => Self::streamed(source, scene, settings, device, progress),
            false => Self::of(source, scene, settings, device, progress),
        }?;
        shown.with_lines(scene, None, progress)
    }

    /// Where the voxels come from, where they are not in memory.
    pub fn stream(&self) -> Option<&Stream> {
        self.stream.as_ref()
    }

    /// A volume that shows which values there are: of a stream every n-th voxel.
    pub fn looked_at(&self) -> &Volume {
        self.overview.as_ref().unwrap_or(&self.volume)
    }

    /// The function that a window of the words is spread over, where a scene has to keep both.
    pub fn base(&self, scene: &SceneFlags, mode: Mode) -> Result<Option<Classification>, Error> {
        let flags = ClassificationFlags {
            context: self.context.clone(),
            ..scene.classification.clone()
        };
        let base = base_of(&flags, mode).map(|base| base.classification(self.looked_at(), mode));
        base.transpose()
    }

    /// The words of several channels with all that was chosen; none of one number a voxel.
    pub fn channels(&self) -> &[ChannelWord] {
        &self.channels
    }

    /// The same of a source that is open already, from memory.
    pub fn of(
        source: Box<dyn Source>,
        scene: &SceneFlags,
        settings: &Settings,
        device: &dyn DeviceRoom,
        progress: &Progress,
    ) -> Result<Self, Error> {
        check(scene, settings)?;
        if scene.sampling.of_points {
            return points::read(scene, settings.mode, progress);
        }
        if let Some(kernel) = scene.sampling.field {
            return points::field(scene, settings.mode, kernel.quantity, progress);
        }
        if scene.points_are_spheres() {
            return points::spheres(scene, settings, progress);
        }
        let said = scene.is_auto().then(|| context(source.header()));
        let (plan, note) = plan(scene, source.header())?;
        if scene.opacity.are_given() && plan != Plan::One {
            return Err(Error::usage(
                format!(
                    "{} makes one number a voxel opaque, and several are drawn",
                    scene.opacity.word()
                ),
                "say which one is coloured: --component 0",
            ));
        }
        if scene.sampling.preclassified && plan != Plan::One {
            return Err(Error::usage(
                "--preclassified is for one number a voxel, and several are drawn",
                "take one of them: --component 0",
            ));
        }
        let is_alone = plan == Plan::One && !has_beside(scene, settings.mode);
        let are_several = !is_alone;
        if are_several && !settings.mode.is_projection() && settings.filter.kernel().is_some() {
            let filter = scene.sampling.filter.unwrap_or_default();
            return Err(Error::usage(
                format!("--filter {filter} reads one number a voxel, and several are drawn"),
                "--filter linear draws them together",
            ));
        }
        if let Some(note) = note {
            progress.note(&note);
        }
        if plan != Plan::One {
            scene.modes.check_several(settings.mode)?;
        }
        let reader = Reader {
            scene,
            mode: settings.mode,
            device,
            progress,
        };
        let mut shown = match plan {
            Plan::One => reader.one(source)?,
            Plan::Channels(words) => reader.channels(source, &words)?,
            Plan::Colors => reader.colors(source)?,
        };
        shown.context = said;
        if scene.sampling.preclassified {
            return preclassified::classified(shown);
        }
        shown.with_beside(&reader)
    }

    /// The volumes between these (`share` 0) and those of another time (1), each voxel by `blend`; labels are those of this one.
    pub fn between(
        mut self,
        after: Self,
        share: f64,
        blend: impl Fn(&Volume, &Volume, f64) -> Result<Volume, Error>,
    ) -> Result<Self, Error> {
        self.volume = Arc::new(blend(&self.volume, &after.volume, share)?);
        let pairs = match (&mut self.others, after.others) {
            (Others::Channels(own), Others::Channels(after)) => {
                for (own, after) in own.iter_mut().zip(after) {
                    if own.role != Role::Labels {
                        own.volume = blend(&own.volume, &after.volume, share)?;
                    }
                }
                return Ok(self);
            }
            (Others::Colors(own), Others::Colors(after)) => own.iter_mut().zip(after),
            _ => return Ok(self),
        };
        for (own, after) in pairs {
            *own = blend(own, &after, share)?;
        }
        Ok(self)
    }

    /// True where the file says how its axes lie, in a patient or on the Earth.
    pub fn has_named_axes(&self) -> bool {
        self.header.is_patient || self.header.is_earth
    }

    /// What the look of a picture is chosen by.
    pub fn seen(&self) -> Seen<'_> {
        Seen {
            volume: self.looked_at(),
            context: self.context.as_ref(),
            classification: &self.classification,
            is_alone: matches!(self.parts().beside(), Beside::Nothing),
            is_beside_others: self.stand_by_themselves(),
        }
    }

    /// True for a volume of numbers with labels or other files beside it, but no channels of one and no numbers of opacity.
    fn stand_by_themselves(&self) -> bool {
        let Others::Channels(others) = &self.others else {
            return false;
        };
        let is_opaque_by = others.iter().any(|other| other.role == Role::Opacity);
        !others.is_empty() && self.channels.is_empty() && !is_opaque_by
    }

    /// What a camera is turned to.
    pub fn subject(&self) -> Subject {
        Subject::new(&self.volume.grid(), self.header.is_earth)
    }

    /// Who looks, and in `settings` what is known now that there are voxels.
    pub fn camera(
        &self,
        scene: &SceneFlags,
        extent_pixels: [u32; 2],
        settings: &mut Settings,
    ) -> Result<Camera, Error> {
        let (section, subject) = (&scene.section, self.subject());
        let camera = section.camera(&scene.camera, &subject, extent_pixels, settings)?;
        if let (None, Some(filter)) = (scene.sampling.filter, self.filter) {
            settings.filter = filter;
        }
        settings.per_mode = self.per_mode.clone();
        settings.field = self.field;
        let later = settings.splat.cut_bits + self.crowd_bits;
        settings.splat.cut_bits = later.min(Splat::of_points().cut_bits);
        settings.filter_by = self.filter_by(scene, settings.filter_by);
        Ok(camera)
    }

    /// What makes values between voxels, where memory has a say.
    pub fn filter_by(&self, scene: &SceneFlags, wanted: FilterBy) -> FilterBy {
        let parts = self.parts();
        let beside = parts.beside();
        let volumes: Vec<_> = [&*self.volume]
            .into_iter()
            .chain(beside.volumes())
            .collect();
        match (&self.stream, beside) {
            (Some(_), _) => wanted,
            (None, Beside::Preclassified) => {
                memory::filter_by_of_classified(&scene.input, wanted, &self.volume)
            }
            (None, _) => memory::filter_by(&scene.input, wanted, &volumes),
        }
    }

    /// What [`Parts::beside`] hands out.
    pub fn parts(&self) -> Parts<'_> {
        match &self.others {
            Others::Channels(others) => Parts::Channels(
                others
                    .iter()
                    .map(|other| Channel {
                        volume: &other.volume,
                        transfer: Some(&other.function),
                        role: other.role,
                    })
                    .collect(),
            ),
            Others::Colors(volumes) => Parts::Colors(volumes.iter().collect()),
            Others::Preclassified => Parts::Preclassified,
            Others::Points(points) => Parts::Points(points),
        }
    }
}

/// The others, as a scene wants them.
#[derive(Debug)]
pub enum Parts<'a> {
    /// Things of their own.
    Channels(Vec<Channel<'a>>),
    /// Green, blue, and perhaps alpha.
    Colors(Vec<&'a Volume>),
    /// Nothing: the voxels are classified before they are interpolated.
    Preclassified,
    /// Scattered points, for which the volume stands.
    Points(&'a Points),
}

impl Parts<'_> {
    /// The function that says alone why a picture is empty. What one of several covers says nothing of the others.
    pub fn only<'a>(&self, classification: &'a Classification) -> &'a Classification {
        match self.beside() {
            Beside::Nothing => classification,
            Beside::Channels(_)
            | Beside::Colors(_)
            | Beside::Classified(_)
            | Beside::Preclassified
            | Beside::Points(_) => &Classification::RangeOfPicture,
        }
    }

    /// For a scene.
    pub fn beside(&self) -> Beside<'_> {
        match self {
            Self::Channels(channels) if channels.is_empty() => Beside::Nothing,
            Self::Channels(channels) => Beside::Channels(channels),
            Self::Colors(volumes) => Beside::Colors(volumes),
            Self::Preclassified => Beside::Preclassified,
            Self::Points(points) => Beside::Points(points),
        }
    }
}

/// What reading may take.
pub fn limits(scene: &SceneFlags) -> Limits {
    let limits = scene.input.limits();
    Limits {
        // Of several resolutions the finest, not the finest that fits.
        max_bytes: if scene.input.stream {
            u64::MAX
        } else {
            limits.max_bytes
        },
        ..limits
    }
}

/// True where no word says how values are seen.
fn says_nothing(flags: &ClassificationFlags) -> Result<bool, Error> {
    let of_file = flags.function_of_file()?;
    let of_parts = flags.color_function.is_some()
        || flags.opacity_function.is_some()
        || flags.colormap.is_some();
    Ok(flags.preset.is_none() && of_file.is_none() && !of_parts && flags.window.is_none())
}

/// Takes most of its opacity from a volume that labels lie inside of.
fn fade(classification: &mut Classification) {
    const REST: f64 = 0.12;
    if let Classification::Function(function) = classification {
        for point in &mut function.opacity {
            point.opacity *= REST;
        }
    }
}

fn classified(mode: Mode) -> Classified {
    if mode.is_projection() {
        Classified::Projection
    } else {
        Classified::Samples
    }
}
