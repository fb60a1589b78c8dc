//! How the volume is shown: what the panel and the keys change, and the settings and the function that follow.

use crate::error::Error;
use crate::subject::Subject;
use stratavox::color::decode_srgb;
use stratavox::look::{BACKGROUND, STILL_SAMPLES, is_lit, light};
use stratavox::technique::{Filter, Level, Mode, PerMode, Settings, Shading, Technique};
use stratavox::transfer::{
    Classified, Context, Interpolation, JointCounts, Kind, Preset, TransferFunction, Window,
    automatic, automatic_in, boundaries, surfaces,
};
use stratavox::volume::{JointHistogram, Rescale, Volume, steepest_gradient};

/// What an 8-bit picture in linear light cannot show: 0.4 of a code where sRGB is steepest.
const TERMINATION: f32 = 1.0 / 8192.0;

pub const TECHNIQUES: [Technique; 3] =
    [Technique::Raycast, Technique::Slices3d, Technique::Slices2d];
pub const MODES: [Mode; 9] = [
    Mode::Composite,
    Mode::Mip,
    Mode::Minip,
    Mode::Average,
    Mode::Xray,
    Mode::Lmip,
    Mode::AttenuatedMip,
    Mode::Mida,
    Mode::Iso,
];
pub const FILTERS: [Filter; 5] = [
    Filter::Linear,
    Filter::Nearest,
    Filter::Cubic,
    Filter::CatmullRom,
    Filter::CubicSmooth,
];

#[derive(Clone, Debug, PartialEq)]
pub struct Look {
    pub technique: Technique,
    pub mode: Mode,
    pub filter: Filter,
    pub is_lit: bool,
    /// Of lit matter; surfaces have the usual one.
    light: Shading,
    pub samples_per_voxel: f64,
    /// The function is thinner than samples lie apart: fields, under `--look auto`.
    is_layered: bool,
    /// A hand moves a picture that is slow: one sample a voxel is enough.
    pub is_moving: bool,
    /// Behind the volume, linear light; `None` is what suits the mode.
    pub background: Option<[f32; 4]>,
    /// Of modes that classify samples.
    pub samples: TransferFunction,
    /// Of modes that project one value a ray.
    pub projection: TransferFunction,
    /// Of the integral along a ray, which has another unit.
    pub integral: Option<TransferFunction>,
    /// What `samples` began as: a preset, or what suits the values.
    pub preset: Option<Preset>,
    pub per_mode: PerMode,
}

/// What a change of the look asks of the renderer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Change {
    Nothing,
    /// `set_settings`.
    Numbers,
    /// Another renderer: other textures, or other pipelines.
    Kind,
}

impl Look {
    /// What suits the values.
    pub fn new(subject: &Subject) -> Self {
        let summary = &subject.summary;
        let samples = usual_function(subject);
        let is_auto = subject.context.is_some();
        let kind = |context: &Context| context.choice(summary).kind;
        let level = |surface: stratavox::transfer::Surface| Level {
            value: surface.value,
            srgb: surface.srgb,
            opacity: surface.opacity,
        };
        let [low, high] = [0.0005, 0.9995].map(|share| summary.quantile(share));
        let usual = Window::new(low, high).unwrap_or(Window::of_range(summary.range));
        Self {
            technique: Technique::Raycast,
            mode: Mode::Composite,
            // No value lies between two labels.
            filter: match samples.interpolation {
                Interpolation::Step => Filter::Nearest,
                Interpolation::Linear => Filter::Linear,
            },
            is_lit: subject
                .context
                .as_ref()
                .is_some_and(|context| is_lit(kind(context))),
            light: match is_auto {
                true => light(&subject.voxels),
                false => Shading::default(),
            },
            samples_per_voxel: if is_auto { STILL_SAMPLES } else { 1.0 },
            is_layered: subject
                .context
                .as_ref()
                .is_some_and(|context| kind(context) == Kind::Field),
            is_moving: false,
            background: is_auto.then(|| {
                let [r, g, b, opacity] = BACKGROUND;
                let [r, g, b] = [r, g, b].map(|code| decode_srgb(code) as f32);
                [r, g, b, opacity as f32]
            }),
            samples,
            projection: automatic(summary, Classified::Projection, None),
            integral: None,
            preset: None,
            per_mode: PerMode {
                unit_values: [usual.low(), usual.high()],
                lmip_threshold: Window::of_range(summary.range).at(0.5),
                levels: surfaces(summary).into_iter().map(level).collect(),
                ..PerMode::default()
            },
        }
    }

    /// Behind the volume, linear light: by itself a blue so dark that everything stands out against it. A projection
    /// begins with the black of its lowest value, and its box is not to be seen.
    pub fn backdrop(&self) -> [f32; 4] {
        let usual = match self.mode.is_projection() {
            true => [0.0, 0.0, 0.0, 1.0],
            false => [0.008, 0.011, 0.016, 1.0],
        };
        self.background.unwrap_or(usual)
    }

    pub fn settings(&self) -> Settings {
        let is_surface = self.mode == Mode::Iso;
        let can_be_lit = matches!(self.mode, Mode::Composite | Mode::Mida);
        let can_be_slabs = self.mode == Mode::Composite
            && !self.is_lit
            && matches!(self.filter, Filter::Linear | Filter::Nearest)
            && self.technique != Technique::Slices2d
            && !self.samples.is_graded();
        let preintegrated = self.is_layered && can_be_slabs;
        Settings {
            technique: self.technique,
            mode: self.mode,
            filter: self.filter,
            preintegrated,
            samples_per_voxel: match self.is_moving || preintegrated {
                true => self.samples_per_voxel.min(1.0),
                false => self.samples_per_voxel,
            },
            termination: TERMINATION,
            shading: match is_surface {
                true => Some(Shading::default()),
                false => (can_be_lit && self.is_lit).then(|| self.light.clone()),
            },
            per_mode: self.per_mode.clone(),
            ..Settings::default()
        }
    }

    /// The function of the mode; `None` for surfaces.
    pub fn function(&self) -> Option<&TransferFunction> {
        match self.mode {
            Mode::Iso => None,
            Mode::Xray => self.integral.as_ref().or(Some(&self.projection)),
            mode if mode.is_projection() => Some(&self.projection),
            _ => Some(&self.samples),
        }
    }

    /// The same to be edited.
    pub fn function_mut(&mut self) -> Option<&mut TransferFunction> {
        match self.mode {
            Mode::Iso => None,
            Mode::Xray => self.integral.as_mut().or(Some(&mut self.projection)),
            mode if mode.is_projection() => Some(&mut self.projection),
            _ => Some(&mut self.samples),
        }
    }

    /// Another mode, with what it wants to know.
    pub fn set_mode(&mut self, mode: Mode, voxels: &Volume) {
        self.mode = mode;
        if mode == Mode::Xray && self.integral.is_none() {
            let window = Window::of_range(integrals(voxels));
            self.integral = Some(window.grey(Classified::Projection));
        }
    }

    /// What a preset is for these values; `None` is what suits them.
    pub fn set_preset(&mut self, preset: Option<Preset>, subject: &Subject) {
        let summary = &subject.summary;
        self.preset = preset;
        self.samples = match preset {
            None => usual_function(subject),
            Some(Preset::Boundaries) => of_boundaries(&subject.voxels)
                .unwrap_or_else(|| Preset::Boundaries.function(summary, Classified::Samples, None)),
            Some(preset) => preset.function(summary, Classified::Samples, None),
        }
        .with_steepest(|| steepest_gradient(&subject.voxels));
    }

    /// What has to be done to get from `drawn` to this. Functions are looked at elsewhere.
    pub fn change_from(&self, drawn: &Self) -> Change {
        let kind = |look: &Self| {
            let function = look.function();
            let is_graded = function.is_some_and(TransferFunction::is_graded);
            let settings = look.settings();
            let pipelines = (settings.shading.is_some(), settings.preintegrated);
            (look.technique, look.mode, look.filter, pipelines, is_graded)
        };
        if kind(self) != kind(drawn) {
            return Change::Kind;
        }
        match self.settings() == drawn.settings() {
            true => Change::Nothing,
            false => Change::Numbers,
        }
    }

    /// Whether technique, mode and filter go together; else why not, in a sentence.
    pub fn check(&self) -> Result<(), Error> {
        let checked = self.settings().check();
        checked.map_err(|error| Error::Drawing(error.into()))
    }
}

/// What suits the values: under `--look auto` by what the file says of them too.
fn usual_function(subject: &Subject) -> TransferFunction {
    let (summary, classified) = (&subject.summary, Classified::Samples);
    match &subject.context {
        Some(context) => automatic_in(context, summary, classified, None),
        None => automatic(summary, classified, None),
    }
}

/// The next of a list, around its end.
pub fn next<T: Copy + PartialEq>(all: &[T], now: T, is_back: bool) -> T {
    let at = all.iter().position(|one| *one == now).unwrap_or(0);
    let step = if is_back { all.len() - 1 } else { 1 };
    all[(at + step) % all.len()]
}

/// Surfaces between substances, by value and gradient.
fn of_boundaries(voxels: &Volume) -> Option<TransferFunction> {
    let joint = JointHistogram::of(voxels, 256, 192);
    let grid = voxels.grid();
    let counts = JointCounts {
        value_range: joint.value_range,
        steepest: joint.gradient_range[1],
        smallest_spacing: grid.smallest_spacing(),
        columns: joint.columns,
        counts: &joint.counts,
    };
    let length = grid.diagonal() / 512.0;
    boundaries(
        &counts,
        (length > 0.0 && length.is_finite()).then_some(length),
    )
}

/// The least and the largest of the integrals of the value over world length along rows of voxels, which say what an
/// X-ray along the axes of the volume shows.
fn integrals(voxels: &Volume) -> [f64; 2] {
    let [nx, ny, nz] = voxels.dims.map(|n| n as usize);
    let Rescale { slope, intercept } = voxels.rescale;
    let mut sums = [vec![0.0; ny * nz], vec![0.0; nx * nz], vec![0.0; nx * ny]];
    for i in 0..voxels.voxels.len() {
        let (x, y, z) = (i % nx, i / nx % ny, i / (nx * ny));
        let value = f64::from(voxels.voxels.stored(i)) * slope + intercept;
        for (axis, at) in [y + ny * z, x + nx * z, x + nx * y].into_iter().enumerate() {
            sums[axis][at] += value;
        }
    }
    let spacing = voxels.grid().spacing();
    let lengths = sums.iter().zip(spacing);
    let each = lengths.flat_map(|(sums, spacing)| sums.iter().map(move |sum| sum * spacing));
    each.fold([0.0, 0.0], |[low, high]: [f64; 2], sum| {
        [low.min(sum), high.max(sum)]
    })
}
