//! A scene of which nothing is left to choose: what a scene file keeps.

use super::View;
use crate::cli::flags::{
    ChannelWord, Classification, ClassificationFlags, ColorWord, Look, SceneFlags, ShadingWord,
    WindowWord, inlined,
};
use crate::cli::labels::LABEL_OVER_OPACITY;
use crate::cli::scene_inputs::SceneInputs;
use crate::scene::{Beside, Channel};
use crate::technique::{Filter, Level, Mode, Role};
use crate::transfer::{ColorPoint, LIT_LABEL_OPACITY, TransferFunction};

/// What a picture or a film was drawn with, where no flag said it.
#[derive(Clone, Copy, Debug)]
pub struct Chosen<'a> {
    /// What was done with samples.
    pub mode: Mode,
    /// How values are seen; `None` where keys say it.
    pub function: Option<&'a TransferFunction>,
    /// What is seen together with the volume.
    pub beside: Beside<'a>,
    /// Channels with their colours and windows, where several are drawn.
    pub channels: &'a [ChannelWord],
    /// The window of a projection, or of MIDA where one is said; `None` where keys or nothing says it.
    pub window: Option<[f64; 2]>,
    /// Surfaces of `--mode iso`.
    pub levels: &'a [Level],
    /// Where the values themselves ask for one.
    pub filter: Option<Filter>,
    /// The function is not yet spread over its window, nor laid under `--colormap`, `--color-tf` and `--opacity-tf`.
    pub is_base: bool,
    /// How much higher than they are heights are drawn.
    pub height_factor: f64,
}

impl<'a> Chosen<'a> {
    /// Of a picture of `shown`, which has these others beside it. `integrals` is the range of an X-ray that found its own
    /// window, `base` the function of [`base_of`], where there is one.
    pub fn of_picture(
        view: &'a View,
        shown: &'a SceneInputs,
        beside: Beside<'a>,
        integrals: Option<[f64; 2]>,
        base: Option<&'a Classification>,
    ) -> Self {
        let function = match base.unwrap_or(&shown.classification) {
            Classification::Function(function) => Some(function),
            Classification::RangeOfPicture => None,
        };
        let per_mode = &view.settings.per_mode;
        Self {
            mode: view.settings.mode,
            function,
            beside,
            channels: shown.channels(),
            window: match base {
                Some(_) => Some(per_mode.unit_values),
                None => integrals.or(function.and_then(ends_of)),
            },
            levels: &per_mode.levels,
            filter: shown.filter,
            is_base: base.is_some(),
            height_factor: shown.height_factor,
        }
    }

    /// The scene in plain flags: drawn again it is the same picture, whatever later versions choose.
    pub fn frozen(&self, scene: &SceneFlags) -> SceneFlags {
        let mut scene = scene.clone();
        if scene.is_auto() && self.mode == Mode::Composite {
            scene.input.keep_all.get_or_insert(false);
        }
        if let (Some(filter), true) = (self.filter, self.function.is_some()) {
            scene.sampling.filter.get_or_insert(filter);
        }
        if scene.labels.labels.is_some() && self.mode != Mode::Composite {
            scene.labels.label_opacity.get_or_insert(LABEL_OVER_OPACITY);
        } else if scene.is_auto() && scene.labels.labels.is_some() {
            scene.labels.label_opacity.get_or_insert(LIT_LABEL_OPACITY);
        }
        self.keep_colors(&mut scene);
        if scene.light.shading.is_none() && !scene.light.is_lit(self.mode) {
            scene.light.shading = Some(ShadingWord::None);
        }
        if scene.sampling.has_steps() {
            scene.sampling.samples_per_voxel.get_or_insert(1.0);
        }
        if self.height_factor != 1.0 {
            scene.camera.exaggerate.get_or_insert(self.height_factor);
        }
        scene.look = Some(Look::Plain);
        scene
    }

    /// How values are seen, where the flags do not say it.
    fn keep_colors(&self, scene: &mut SceneFlags) {
        self.keep_with(scene);
        if !self.channels.is_empty() {
            scene.channels.channels.clear();
            scene.channels.channel = self.channels.to_vec();
            return;
        }
        let chosen = &scene.classification;
        let is_chosen = chosen.preset.is_none() && chosen.transfer_function.is_none();
        if self.mode == Mode::Iso {
            // Surfaces stand by themselves, whatever the function, but where another variable colours them.
            keep_levels(scene, self.levels);
            if let (Some(paint), true) = (self.beside_as(Role::Numbers), is_chosen) {
                self.keep_function(scene, paint);
            }
            return;
        }
        if let (Some(opaque), None) = (
            self.beside_as(Role::Opacity),
            &scene.classification.opacity_function,
        ) {
            scene.classification.opacity_function = Some(inlined(opaque));
            scene.opacity.opacity_window = None;
        }
        if !is_chosen {
            return;
        }
        if self.mode.is_projection() || self.is_base {
            let window = self.window.filter(|[low, high]| low < high);
            let is_said = matches!(scene.classification.window, Some(WindowWord::Values(_)));
            if let (Some(ends), false) = (window, is_said) {
                scene.classification.window = Some(WindowWord::Values(ends));
            }
        }
        if let (false, Some(function)) = (self.mode.is_projection(), self.function) {
            self.keep_function(scene, function);
        }
    }

    /// The functions of the volumes of `--with`, which stand behind channels of the file.
    fn keep_with(&self, scene: &mut SceneFlags) {
        let Beside::Channels(channels) = self.beside else {
            return;
        };
        let of_numbers = channels.iter().filter(|one| one.role == Role::Numbers);
        let of_numbers: Vec<_> = of_numbers.collect();
        let first = of_numbers
            .len()
            .saturating_sub(scene.with.volumes().count());
        let words = scene.with.with.iter_mut().filter(|word| !word.is_shape());
        for (word, channel) in words.zip(&of_numbers[first..]) {
            if let Some(function) = channel.transfer {
                word.function = Some(inlined(function));
                (word.preset, word.colormap, word.color, word.window) = (None, None, None, None);
            }
        }
    }

    /// The function in the place of the words that made it.
    fn keep_function(&self, scene: &mut SceneFlags, function: &TransferFunction) {
        if function.uses_gradient() {
            return;
        }
        let mut function = function.clone();
        if function.color.is_empty() {
            // Colours are those of the voxels; a file of a function has some.
            function.color.push(ColorPoint {
                value: 0.0,
                srgb: [1.0; 3],
            });
        }
        let chosen = &mut scene.classification;
        chosen.transfer_function = Some(inlined(&function).transfer_function);
        if self.is_base {
            return;
        }
        // It lies where the window has put it.
        chosen.window = None;
        chosen.colormap = None;
        chosen.color_function = None;
        if !scene.opacity.are_given() {
            chosen.opacity_function = None;
        }
        if scene.labels.labels.is_none() {
            // Labels that are the volume itself have their colours now.
            scene.labels = Default::default();
        }
    }

    /// The function of what lies beside the volume in this role.
    fn beside_as(&self, role: Role) -> Option<&'a TransferFunction> {
        let Beside::Channels(channels) = self.beside else {
            return None;
        };
        let of_role = |channel: &&Channel<'a>| channel.role == role;
        channels.iter().find(of_role)?.transfer
    }
}

/// The words whose function stands for the chosen one, where a window says more than where that lies: MIDA compares
/// maxima over it. The window is spread over this function when the scene is drawn.
pub fn base_of(flags: &ClassificationFlags, mode: Mode) -> Option<ClassificationFlags> {
    let is_chosen = flags.preset.is_none() && flags.transfer_function.is_none();
    let is_base = mode == Mode::Mida && flags.window.is_some() && is_chosen;
    is_base.then(|| without_parts(flags))
}

/// The words without a window, and without what is laid over a function.
pub fn without_parts(flags: &ClassificationFlags) -> ClassificationFlags {
    ClassificationFlags {
        window: None,
        colormap: None,
        color_function: None,
        opacity_function: None,
        ..flags.clone()
    }
}

/// The values of the first and the last point of opacity: of a projection the ends of its window.
pub fn ends_of(function: &TransferFunction) -> Option<[f64; 2]> {
    let (first, last) = (function.opacity.first()?, function.opacity.last()?);
    Some([first.value, last.value])
}

/// The surfaces that were drawn, where the flags name none.
fn keep_levels(scene: &mut SceneFlags, levels: &[Level]) {
    let flags = &mut scene.modes.levels;
    if !flags.iso.is_empty() {
        return;
    }
    flags.iso = levels.iter().map(|level| level.value).collect();
    if flags.iso_color_by.is_none() {
        let colors = levels.iter().map(|level| ColorWord(level.srgb));
        flags.iso_color = colors.collect();
    }
    flags.iso_opacity = levels.iter().map(|level| level.opacity).collect();
}
