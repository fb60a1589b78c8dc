//! How the volume is shown: what the panel and the keys change, and the settings and the function that follow.

use crate::error::Error;
use crate::subject::Subject;
use stratavox::color::decode_srgb;
use stratavox::look::{BACKGROUND, Origin, STILL_SAMPLES, is_lit, light, may_choose};
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
    /// What a hand says of light; `None`: what suits mode and function.
    pub light_by_hand: Option<bool>,
    /// Light scatters where the picture rests.
    pub scatters: bool,
    /// Of lit matter; surfaces have the usual one.
    light: Shading,
    /// What a hand says; `None`: what suits mode and function.
    pub samples_by_hand: Option<f64>,
    /// What the values are, under `--look auto`.
    kind: Option<Kind>,
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
            light_by_hand: None,
            scatters: false,
            light: match is_auto {
                true => light(&subject.voxels),
                false => Shading::default(),
            },
            samples_by_hand: None,
            kind: subject.context.as_ref().map(kind),
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

    fn origin(&self) -> Origin {
        self.preset.map_or(Origin::Automatic, Origin::Preset)
    }

    /// Whether light says something of the mode.
    pub fn can_be_lit(&self) -> bool {
        matches!(self.mode, Mode::Composite | Mode::Mida)
    }

    /// What a hand says of light, else what `stratavox render` chooses.
    pub fn wants_light(&self) -> bool {
        let is_chosen =
            |kind| !self.samples.uses_gradient() && is_lit(self.mode, self.origin(), || kind);
        self.light_by_hand
            .unwrap_or_else(|| self.kind.is_some_and(is_chosen))
    }

    /// The same of samples along a ray.
    pub fn samples_per_voxel(&self) -> f64 {
        let is_chosen = self.kind.is_some() && may_choose(self.mode, self.origin());
        let usual = if is_chosen { STILL_SAMPLES } else { 1.0 };
        self.samples_by_hand.unwrap_or(usual)
    }

    pub fn settings(&self) -> Settings {
        let is_surface = self.mode == Mode::Iso;
        let is_lit = self.can_be_lit() && self.wants_light();
        let can_be_slabs = self.mode == Mode::Composite
            && !is_lit
            && matches!(self.filter, Filter::Linear | Filter::Nearest)
            && self.technique != Technique::Slices2d
            && !self.samples.uses_gradient();
        // A function that is thinner than samples lie apart.
        let is_layered = self.kind == Some(Kind::Field) && self.preset.is_none();
        let preintegrated = is_layered && self.samples_by_hand.is_none() && can_be_slabs;
        Settings {
            technique: self.technique,
            mode: self.mode,
            filter: self.filter,
            preintegrated,
            samples_per_voxel: match self.is_moving || preintegrated {
                true => self.samples_per_voxel().min(1.0),
                false => self.samples_per_voxel(),
            },
            termination: TERMINATION,
            shading: match is_surface {
                true => Some(Shading::default()),
                false => is_lit.then(|| self.light.clone()),
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
            let uses_gradient = function.is_some_and(TransferFunction::uses_gradient);
            let settings = look.settings();
            let pipelines = (settings.shading.is_some(), settings.preintegrated);
            (
                look.technique,
                look.mode,
                look.filter,
                pipelines,
                uses_gradient,
            )
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::words::Arguments;
    use clap::Parser;

    fn open(words: &[&str]) -> Subject {
        let all = ["viewer"].iter().chain(words);
        Subject::open(&Arguments::parse_from(all)).expect("a phantom")
    }

    #[test]
    fn light_and_samples_are_chosen_where_the_command_line_chooses_them() {
        let subject = open(&["phantom:head,n=16"]);
        let chosen = |look: &Look| {
            let settings = look.settings();
            (settings.shading.is_some(), settings.samples_per_voxel)
        };
        let mut look = Look::new(&subject);
        assert_eq!(chosen(&look), (true, 2.0));
        for (preset, wanted) in [
            (Some(Preset::Grey), (false, 1.0)),
            (Some(Preset::CtBone), (true, 2.0)),
            (None, (true, 2.0)),
        ] {
            look.set_preset(preset, &subject);
            assert_eq!(chosen(&look), wanted, "{preset:?}");
        }
        for mode in [Mode::Mida, Mode::Mip, Mode::Xray] {
            look.set_mode(mode, &subject.voxels);
            assert_eq!(chosen(&look), (false, 1.0), "{mode}");
        }
        // What a hand says holds in every mode that light says something of.
        (look.light_by_hand, look.samples_by_hand) = (Some(true), Some(3.0));
        look.set_mode(Mode::Mida, &subject.voxels);
        assert_eq!(chosen(&look), (true, 3.0));
        look.set_mode(Mode::Composite, &subject.voxels);
        look.light_by_hand = Some(false);
        assert_eq!(chosen(&look), (false, 3.0));
        let plain = Look::new(&open(&["phantom:head,n=16", "--look", "plain"]));
        assert_eq!(chosen(&plain), (false, 1.0));
    }

    #[test]
    fn fields_are_layers_until_a_preset_or_a_hand_says_otherwise() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("field.nrrd");
        let head = b"NRRD0004\ntype: float\ndimension: 3\nsizes: 12 12 12\nencoding: raw\nendian: little\n\n";
        let value =
            |i: usize| (i % 12) as f32 + 0.37 * (i / 12 % 12) as f32 + 0.1 * (i / 144) as f32;
        let values = (0..12_usize.pow(3)).flat_map(|i| value(i).to_le_bytes());
        std::fs::write(
            &path,
            head.iter().copied().chain(values).collect::<Vec<_>>(),
        )
        .expect("a file");
        let subject = open(&[path.to_str().expect("plain names")]);
        let mut look = Look::new(&subject);
        assert!(look.settings().preintegrated);
        look.samples_by_hand = Some(2.0);
        assert!(!look.settings().preintegrated);
        look.samples_by_hand = None;
        look.set_preset(Some(Preset::Grey), &subject);
        assert!(!look.settings().preintegrated);
    }
}
