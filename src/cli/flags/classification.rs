//! Value to colour and opacity: flags to a transfer function, once the volume is known.

use super::{
    Error, Inlined, WindowWord, boundaries_of, function_in, preset, refuse_gradients_in, summary,
    values::colormap,
};
use crate::{
    technique::Mode,
    transfer::{
        Classified, Context, Interpolation, MediumTransfer, Preset, TransferFunction, ValueSummary,
        Window, automatic, automatic_in,
    },
    volume::{Volume, steepest_gradient},
};
use clap::Args;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// The flags, none of them filled in.
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ClassificationFlags {
    /// A transfer function of ours: ct-bone, ct-soft-tissue, ct-lung, mri, microscopy, pet, boundaries, grey [default:
    /// by the values]
    #[arg(long, value_name = "NAME", value_parser = preset, conflicts_with = "tf", help_heading = "Colour")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub preset: Option<String>,
    /// A transfer function file: ours, or one of 3D Slicer, ParaView, Inviwo, Voreen, VAPOR, or rows of points
    #[arg(long, value_name = "FILE", help_heading = "Colour")]
    #[serde(skip)]
    pub tf: Option<PathBuf>,
    /// A transfer function file of which the colours are taken, in the place of those of --tf, --preset or the values
    #[arg(long, value_name = "FILE", help_heading = "Colour")]
    #[serde(skip)]
    pub color_tf: Option<PathBuf>,
    /// A transfer function file of which all is taken but the colours
    #[arg(long, value_name = "FILE", help_heading = "Colour")]
    #[serde(skip)]
    pub opacity_tf: Option<PathBuf>,
    /// What the file says of its values, under `--look auto`; `None`: the values alone decide.
    #[arg(skip)]
    #[serde(skip)]
    pub context: Option<Context>,
    /// What stood in the file of --color-tf.
    #[arg(skip)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub color_function: Option<Inlined>,
    /// What stood in the file of --opacity-tf.
    #[arg(skip)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub opacity_function: Option<Inlined>,
    /// What stood in that file: a scene carries it with it.
    #[arg(skip)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub transfer_function: Option<serde_json::Value>,
    /// True where its points stand at fractions, 0 to 1, of the window or of the volume's range.
    #[arg(skip)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub transfer_function_of_fractions: Option<bool>,
    /// A colour map in the place of the colours of --tf, --preset or the values, which keep their opacity: viridis,
    /// magma, inferno, plasma, cividis, turbo, batlow, roma, vik, coolwarm, grey, wind, hot-iron, pet; over --window
    /// if given, else over the values that had those colours
    #[arg(long, value_name = "NAME[,reverse]", value_parser = colormap, conflicts_with = "color_tf", help_heading = "Colour")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub colormap: Option<String>,
    /// The values that the function is spread over (xray: of the integral): from LO to HI, all (full), or most (auto:
    /// without a background, if there is one, and without the least and the largest half per cent)
    #[arg(
        long,
        value_name = "LO,HI|auto|full",
        allow_hyphen_values = true,
        help_heading = "Colour"
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub window: Option<WindowWord>,
}

/// How values become colour.
#[derive(Clone, Debug, PartialEq)]
pub enum Classification {
    /// By this function.
    Function(TransferFunction),
    /// By preset `grey` over the range of the integrals that the (first) picture holds.
    RangeOfPicture,
}

impl Classification {
    /// The function, where it is known before the picture is.
    pub fn function(&self) -> Option<&TransferFunction> {
        match self {
            Self::Function(function) => Some(function),
            Self::RangeOfPicture => None,
        }
    }
}

impl ClassificationFlags {
    /// True where a function is asked for by name or file, which may be one of gradients.
    pub fn names_a_function(&self) -> bool {
        self.preset.is_some()
            || self.transfer_function.is_some()
            || self.opacity_function.is_some()
            || self.color_function.is_some()
    }

    /// Reads the files of `--tf`, `--color-tf` and `--opacity-tf`; what a scene says in their place is gone.
    pub fn inline_file(&mut self) -> Result<(), Error> {
        if let Some(path) = &self.tf {
            let inlined = Inlined::read(path)?;
            self.transfer_function = Some(inlined.transfer_function);
            self.transfer_function_of_fractions = inlined.of_fractions.then_some(true);
        }
        if let Some(path) = &self.color_tf {
            self.color_function = Some(Inlined::read(path)?);
        }
        if let Some(path) = &self.opacity_tf {
            self.opacity_function = Some(Inlined::read(path)?);
        }
        Ok(())
    }

    /// Takes out what `stronger` excludes, so that both can be put together.
    pub fn give_way_to(&mut self, stronger: &Self) {
        if stronger.preset.is_some() || stronger.transfer_function.is_some() {
            self.preset = None;
            self.transfer_function = None;
            self.transfer_function_of_fractions = None;
            self.color_function = None;
            self.opacity_function = None;
            self.colormap = None;
        }
        if stronger.color_function.is_some() || stronger.colormap.is_some() {
            self.color_function = None;
            self.colormap = None;
        }
        if stronger.opacity_function.is_some() {
            self.opacity_function = None;
        }
    }

    /// What can be said wrong without a volume.
    pub fn check(&self) -> Result<(), Error> {
        self.window()?;
        self.map()?;
        self.function_of_file()?;
        if self
            .part(&self.color_function)?
            .is_some_and(|function| has_no_color(&function))
        {
            return Err(Error::usage(
                "--color-tf: wanted a function with the key `color`, found one of widgets alone",
                "--tf takes the whole of such a file",
            ));
        }
        self.part(&self.opacity_function)?;
        if let Some(name) = &self.preset {
            preset(name).map_err(|problem| Error::usage(problem, "--preset ct-bone"))?;
        }
        Ok(())
    }

    /// True where the function of `--tf` asks for pre-integrated classification.
    pub fn wants_slabs(&self) -> bool {
        let function = self.transfer_function.as_ref();
        let key = |key: &str| function.and_then(|function| function.get(key));
        let uses_gradient = ["widgets", "gradient_opacity"]
            .iter()
            .any(|name| key(name).is_some());
        key("preintegrated") == Some(&serde_json::Value::Bool(true)) && !uses_gradient
    }

    /// True where this program alone has found that the volume holds labels: no value lies between two of them.
    pub fn found_labels(&self, found: &Classification) -> bool {
        let is_automatic = self.preset.is_none() && self.transfer_function.is_none();
        let is_step = |f: &TransferFunction| f.interpolation == Interpolation::Step;
        is_automatic && matches!(found, Classification::Function(f) if is_step(f))
    }

    /// The function for this volume and what `mode` classifies.
    pub fn classification(&self, volume: &Volume, mode: Mode) -> Result<Classification, Error> {
        let flags = self.with_window_of(mode, || Ok(summary(volume)))?;
        let found = match flags.boundaries(volume, mode)? {
            Some(function) => Classification::Function(
                flags.with_parts(function, || Ok(Window::of_range(volume.value_range)))?,
            ),
            None => flags.classification_of(mode, || Ok(summary(volume)))?,
        };
        Ok(match found {
            Classification::Function(function) => {
                Classification::Function(function.with_steepest(|| steepest_gradient(volume)))
            }
            found @ Classification::RangeOfPicture => found,
        })
    }

    /// What preset `boundaries` is for this volume; `None` for another one, and where no boundary is found.
    fn boundaries(&self, volume: &Volume, mode: Mode) -> Result<Option<TransferFunction>, Error> {
        let preset = self.preset.as_deref().and_then(Preset::from_name);
        if preset != Some(Preset::Boundaries) {
            return Ok(None);
        }
        refuse_gradients_in(mode)?;
        let function = boundaries_of(volume);
        Ok(match self.window()? {
            Some(window) => function.map(|function| function.spread_over(window)),
            None => function,
        })
    }

    /// `function` with the colours and the opacity of the files that say them; `range` is where points at fractions
    /// lie without a window.
    pub fn with_parts(
        &self,
        mut function: TransferFunction,
        range: impl FnOnce() -> Result<Window, Error>,
    ) -> Result<TransferFunction, Error> {
        let parts = [&self.color_function, &self.opacity_function];
        let any_fractions = parts
            .iter()
            .any(|part| part.as_ref().is_some_and(|p| p.of_fractions));
        let window = match self.window()? {
            None if any_fractions => Some(range()?),
            window => window,
        };
        let placed = |part: &Option<Inlined>| -> Result<_, Error> {
            let of_fractions = part.as_ref().is_some_and(|part| part.of_fractions);
            Ok(self.part(part)?.map(|found| match window {
                Some(window) if of_fractions => found.of_fractions(window),
                Some(window) if self.window.is_some() => found.spread_over(window),
                _ => found,
            }))
        };
        if let Some(color) = placed(&self.color_function)? {
            function = function.with_color_of(&color);
        }
        if let Some(opacity) = placed(&self.opacity_function)? {
            function = function.with_opacity_of(&opacity);
        }
        Ok(match self.map()? {
            Some(map) => function.with_colormap(map, self.window()?),
            None => function,
        })
    }

    /// The same for values that look like `summary`, which is asked for where it decides anything.
    pub fn classification_of(
        &self,
        mode: Mode,
        mut summary: impl FnMut() -> Result<ValueSummary, Error>,
    ) -> Result<Classification, Error> {
        if matches!(self.window, Some(WindowWord::Auto | WindowWord::Full)) {
            let flags = self.with_window_of(mode, &mut summary)?;
            return flags.classification_of(mode, summary);
        }
        let window = self.window()?;
        let classified = if mode.is_projection() {
            Classified::Projection
        } else {
            Classified::Samples
        };
        let preset = self.preset.as_deref().and_then(Preset::from_name);
        let function = match (self.function_of_file()?, preset) {
            (Some(function), _) if self.transfer_function_of_fractions == Some(true) => {
                if mode == Mode::Xray && window.is_none() {
                    return Err(Error::usage(
                        "the points of the --tf file stand at fractions of a range, and that of integrals is not known",
                        "--window LO,HI says it",
                    ));
                }
                let window = match window {
                    Some(window) => window,
                    None => Window::of_range(summary()?.range),
                };
                function.of_fractions(window)
            }
            (Some(function), _) => match window {
                Some(window) => function.spread_over(window),
                None => function,
            },
            // The range of the volume says nothing about that of integrals.
            (None, None | Some(Preset::Grey)) if mode == Mode::Xray && window.is_none() => {
                if self.colormap.is_some() {
                    return Err(Error::usage(
                        "--colormap in --mode xray: the range of the integrals is not known",
                        "--window LO,HI says it",
                    ));
                }
                return Ok(Classification::RangeOfPicture);
            }
            (None, Some(Preset::Grey)) if let Some(window) = window => window.grey(classified),
            (None, Some(preset)) => preset.function(&summary()?, classified, window),
            (None, None) => match window.filter(|_| classified == Classified::Projection) {
                Some(window) => window.grey(classified),
                None => match &self.context {
                    Some(context) => automatic_in(context, &summary()?, classified, window),
                    None => automatic(&summary()?, classified, window),
                },
            },
        };
        let range = || Ok(Window::of_range(summary()?.range));
        let function = self.with_parts(function, range)?;
        if function.uses_gradient() {
            refuse_gradients_in(mode)?;
        }
        Ok(Classification::Function(function))
    }

    /// `found` where words named it: a preset, a file or a window.
    pub fn named<'a>(&self, found: &'a Classification) -> Option<&'a TransferFunction> {
        let is_named = self.preset.is_some()
            || self.transfer_function.is_some()
            || self.window.is_some()
            || self.colormap.is_some();
        match found {
            Classification::Function(function) if is_named => Some(function),
            _ => None,
        }
    }

    /// The window of `--window LO,HI`.
    pub fn window(&self) -> Result<Option<Window>, Error> {
        self.window.map_or(Ok(None), WindowWord::window)
    }

    /// The function of `--tf`, or that of a scene.
    pub fn function_of_file(&self) -> Result<Option<TransferFunction>, Error> {
        let Some(value) = &self.transfer_function else {
            return Ok(None);
        };
        function_in(value).map(Some)
    }

    /// What the files of these words say of matter that scatters light; `None` too where they are wrong.
    pub fn medium(&self) -> Option<Box<MediumTransfer>> {
        self.function_of_files().medium
    }

    /// The function of `--tf` with the parts of `--color-tf` and `--opacity-tf`; what no file says, and what is wrong, is
    /// empty.
    pub fn function_of_files(&self) -> TransferFunction {
        let part = |part: &Option<Inlined>| self.part(part).ok().flatten();
        let mut function = self.function_of_file().ok().flatten().unwrap_or(NOTHING);
        if let Some(color) = part(&self.color_function) {
            function = function.with_color_of(&color);
        }
        if let Some(opacity) = part(&self.opacity_function) {
            function = function.with_opacity_of(&opacity);
        }
        function
    }

    /// The function of a file that gives a part.
    fn part(&self, part: &Option<Inlined>) -> Result<Option<TransferFunction>, Error> {
        let part = part
            .as_ref()
            .map(|part| function_in(&part.transfer_function));
        part.transpose()
    }
}

/// Says nothing.
const NOTHING: TransferFunction = TransferFunction {
    color: Vec::new(),
    opacity: Vec::new(),
    reference_length: None,
    interpolation: Interpolation::Linear,
    gradient_transfer: None,
    medium: None,
};

/// What is read of a file whose widgets alone have colours: black everywhere.
fn has_no_color(function: &TransferFunction) -> bool {
    let widgets = function
        .gradient_transfer
        .iter()
        .flat_map(|gradient_transfer| &gradient_transfer.widgets);
    let is_black = function.color.len() == 1 && function.color[0].srgb == [0.0; 3];
    is_black && widgets.count() > 0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::{Rescale, Voxels};
    use glam::DAffine3;

    fn volume() -> Volume {
        Volume {
            dims: [2, 2, 2],
            world_from_voxel: DAffine3::IDENTITY,
            voxels: Voxels::U8(vec![0, 10, 20, 30, 40, 50, 60, 70]),
            rescale: Rescale::default(),
            validity: None,
            hounsfield: false,
            unit: None,
            loss: Default::default(),
            value_range: [0.0, 70.0],
        }
    }

    fn of(flags: &ClassificationFlags, mode: Mode) -> Classification {
        flags.classification(&volume(), mode).expect("a function")
    }

    #[test]
    fn a_maximum_is_grey_over_the_range_of_the_volume() {
        let wanted = Window::of_range([0.0, 70.0]).grey(Classified::Projection);
        let found = of(&ClassificationFlags::default(), Mode::Mip);
        assert_eq!(found, Classification::Function(wanted));
    }

    #[test]
    fn the_window_of_an_xray_comes_from_its_picture_unless_it_is_given() {
        let mut flags = ClassificationFlags::default();
        assert_eq!(of(&flags, Mode::Xray), Classification::RangeOfPicture);
        flags.window = Some(WindowWord::Values([1.0, 9.0]));
        let wanted = Window::of_range([1.0, 9.0]).grey(Classified::Projection);
        assert_eq!(of(&flags, Mode::Xray), Classification::Function(wanted));
    }

    #[test]
    fn a_window_upside_down_is_a_usage_error() {
        let flags = ClassificationFlags {
            window: Some(WindowWord::Values([5.0, 5.0])),
            ..ClassificationFlags::default()
        };
        let error = flags.check().expect_err("refused");
        assert_eq!(error.exit_code(), 2);
        assert!(error.to_string().contains("--window 5,5"), "{error}");
    }

    #[test]
    fn a_function_inside_a_scene_is_used_and_a_wrong_one_is_an_input_error() {
        let json =
            r#"{"stratavox_transfer_function":1,"color":[[0,1,0,0]],"opacity":[[0,0],[9,1]]}"#;
        let mut flags = ClassificationFlags {
            transfer_function: Some(serde_json::from_str(json).expect("JSON")),
            ..ClassificationFlags::default()
        };
        let Classification::Function(function) = of(&flags, Mode::Composite) else {
            panic!("no function");
        };
        assert_eq!(function.color[0].srgb, [1.0, 0.0, 0.0]);
        flags.transfer_function = Some(serde_json::json!({"stratavox_transfer_function": 2}));
        assert_eq!(flags.check().expect_err("refused").exit_code(), 3);
    }

    #[test]
    fn a_stronger_preset_takes_the_place_of_a_function() {
        let mut weak = ClassificationFlags {
            transfer_function: Some(serde_json::json!({})),
            window: Some(WindowWord::Values([0.0, 1.0])),
            ..ClassificationFlags::default()
        };
        let strong = ClassificationFlags {
            preset: Some("mri".to_owned()),
            ..ClassificationFlags::default()
        };
        weak.give_way_to(&strong);
        assert_eq!(weak.transfer_function, None);
        assert!(weak.window.is_some());
    }
}
