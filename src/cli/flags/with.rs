//! What is seen together with INPUT: other volumes, each by a function of its own, surfaces and scattered points: the words.

use super::{
    Error, Inlined, InputFlags, color::rgb, component::Component, input::PHANTOM, values::colormap,
    values::preset,
};
use crate::cli::{registration, shape::ShapeOnce};
use crate::format::geometry::is_invertible;
use clap::Args;
use glam::{DAffine3, DMat4, DVec3};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// The words, none of them filled in.
#[derive(Args, Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct WithFlags {
    /// Another volume of the same place, on a grid of its own if need be, drawn together with INPUT and by a function of its
    /// own: preset, tf, colormap, color and window say which, variable and component what is read, transform=FILE (a linear
    /// registration of ITK, ANTs or 3D Slicer, with INPUT as the fixed volume) and then shift=X:Y:Z, in world length, move it;
    /// once for each volume. Or a surface (.ply with faces, .stl, .glb), which takes color, transform and shift, or points
    /// (.csv, .tsv, .vtp, .ply without faces) as spheres, which take variable, window, colormap or color, transform and shift
    #[arg(
        long,
        value_name = "FILE[,preset=NAME][,window=LO:HI]...",
        help_heading = "Channels"
    )]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub with: Vec<WithWord>,
}

/// One volume and how it is seen.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WithWord {
    /// A file, a folder of slices, or a built-in volume.
    pub path: String,
    /// One of several variables.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub variable: Option<String>,
    /// One of several numbers of a voxel.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub component: Option<u32>,
    /// A transfer function of ours.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub preset: Option<String>,
    /// The file of one.
    #[serde(skip)]
    pub tf: Option<PathBuf>,
    /// What stood in it, or what was drawn.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub function: Option<Inlined>,
    /// The name of a colour map.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub colormap: Option<String>,
    /// One colour, sRGB, 0 to 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub color: Option<[f64; 3]>,
    /// From the value that is hardly seen to the one that is seen most.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub window: Option<[f64; 2]>,
    /// The file of a registration.
    #[serde(skip)]
    pub transform_file: Option<PathBuf>,
    /// What stood in it: rows of the matrix that puts it into the world of INPUT.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub transform: Option<[[f64; 4]; 3]>,
    /// How far it is moved after that, in world length.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shift: Option<[f64; 3]>,
    /// The surface or the points of the file, once they are read.
    #[serde(skip)]
    pub shape: ShapeOnce,
}

/// Endings of files of surfaces and points.
const SHAPES: [&str; 6] = ["ply", "stl", "glb", "csv", "tsv", "vtp"];

/// The keys of a word.
const KEYS: &str = "preset, tf, colormap, color, window, variable, component, transform or shift";

impl WithFlags {
    /// Reads the files of functions and registrations; what a scene says in their place is gone.
    pub fn inline_files(&mut self) -> Result<(), Error> {
        for word in &mut self.with {
            if let Some(path) = &word.tf {
                word.function = Some(Inlined::read(path)?);
            }
            if let Some(path) = &word.transform_file {
                let [x, y, z, _] = DMat4::from(registration::read(path)?)
                    .transpose()
                    .to_cols_array_2d();
                word.transform = Some([x, y, z]);
            }
        }
        Ok(())
    }

    /// The other volumes.
    pub fn volumes(&self) -> impl Iterator<Item = &WithWord> {
        self.with.iter().filter(|word| !word.is_shape())
    }

    /// The surfaces and points.
    pub fn shapes(&self) -> impl Iterator<Item = &WithWord> {
        self.with.iter().filter(|word| word.is_shape())
    }

    /// The files, those of functions and registrations too.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        let words = self.with.iter();
        words.flat_map(|word| {
            let beside = [word.tf.as_deref(), word.transform_file.as_deref()];
            word.file().into_iter().chain(beside.into_iter().flatten())
        })
    }

    /// The same words with other paths.
    pub fn with_paths(&self, path: impl Fn(&Path) -> PathBuf) -> Self {
        let of_word = |word: &WithWord| WithWord {
            path: match word.file() {
                Some(file) => path(file).to_string_lossy().into_owned(),
                None => word.path.clone(),
            },
            ..word.clone()
        };
        Self {
            with: self.with.iter().map(of_word).collect(),
        }
    }
}

impl WithWord {
    /// True for a file of a surface or of points, by the ending of its name.
    pub fn is_shape(&self) -> bool {
        let ending = self.file().and_then(Path::extension);
        ending.is_some_and(|ending| {
            SHAPES
                .iter()
                .any(|shape| ending.eq_ignore_ascii_case(shape))
        })
    }

    /// The file, where it is no built-in volume.
    pub fn file(&self) -> Option<&Path> {
        let path = Path::new(&self.path);
        (!self.path.starts_with(PHANTOM)).then_some(path)
    }

    /// The name that notes and legends use.
    pub fn name(&self) -> String {
        let file = self.file().and_then(Path::file_name);
        let file = file.map(|name| name.to_string_lossy().into_owned());
        match &self.variable {
            Some(variable) => variable.clone(),
            None => file.unwrap_or(self.path.clone()),
        }
    }

    /// Where the words move what the file has.
    pub fn moved(&self, world_from_voxel: DAffine3) -> Result<DAffine3, Error> {
        let registered = match self.transform {
            Some([x, y, z]) => {
                let rows = DMat4::from_cols_array_2d(&[x, y, z, [0.0, 0.0, 0.0, 1.0]]);
                DAffine3::from_mat4(rows.transpose())
            }
            None => DAffine3::IDENTITY,
        };
        if !is_invertible(&registered) {
            return Err(Error::usage(
                format!("--with {}: its `transform` has no inverse", self.name()),
                "three rows of four numbers put it into the world of INPUT",
            ));
        }
        let shift = DVec3::from_array(self.shift.unwrap_or_default());
        Ok(DAffine3::from_translation(shift) * registered * world_from_voxel)
    }

    /// The words that name it, as those of INPUT say how to read.
    pub fn input(&self, of_input: &InputFlags) -> InputFlags {
        InputFlags {
            path: Some(self.path.clone()),
            variable: self.variable.clone(),
            component: self.component.map(Component::Number),
            raw: None,
            series: None,
            level: None,
            ..of_input.clone()
        }
    }

    fn set(&mut self, key: &str, value: &str) -> Result<(), String> {
        let is_new = match key {
            "preset" => self.preset.replace(preset(value)?).is_none(),
            "tf" => self.tf.replace(value.into()).is_none(),
            "colormap" => self.colormap.replace(colormap(value)?).is_none(),
            "color" => self.color.replace(rgb(value)?).is_none(),
            "window" => self
                .window
                .replace(super::channels::window_of(value)?)
                .is_none(),
            "transform" => self.transform_file.replace(value.into()).is_none(),
            "shift" => self.shift.replace(shift_of(value)?).is_none(),
            "variable" => self.variable.replace(value.to_owned()).is_none(),
            "component" => {
                let number = value.parse();
                let wanted = || format!("component={value}: wanted a number, counted from 0");
                self.component
                    .replace(number.map_err(|_| wanted())?)
                    .is_none()
            }
            _ => return Err(format!("wanted {KEYS}, found {key:?}")),
        };
        match is_new {
            true => Ok(()),
            false => Err(format!("{key} is said twice")),
        }
    }

    fn check(&self) -> Result<(), String> {
        let ways = [
            ("preset", self.preset.is_some()),
            ("tf", self.tf.is_some() || self.function.is_some()),
            ("color", self.color.is_some()),
        ];
        let of_volumes = [
            ("preset", self.preset.is_some()),
            ("tf", self.tf.is_some() || self.function.is_some()),
            ("component", self.component.is_some()),
        ];
        let of_volumes = of_volumes.into_iter().find(|(_, is_given)| *is_given);
        if let (true, Some((key, _))) = (self.is_shape(), of_volumes) {
            return Err(format!(
                "{key} is of volumes: a surface takes color, transform and shift, points take variable, window and colormap too"
            ));
        }
        let mut given = ways.into_iter().filter(|(_, is_given)| *is_given);
        match (given.next(), given.next()) {
            (Some((one, _)), Some((other, _))) => Err(format!(
                "{one} and {other} both say which colours there are: wanted one of them"
            )),
            (Some(("color", _)), None) if self.colormap.is_some() => Err(
                "color and colormap both say which colours there are: wanted one of them".into(),
            ),
            _ => Ok(()),
        }
    }
}

fn shift_of(text: &str) -> Result<[f64; 3], String> {
    let numbers: Vec<f64> = text.split(':').filter_map(|n| n.parse().ok()).collect();
    let shift = <[f64; 3]>::try_from(numbers).ok();
    let shift =
        shift.filter(|shift| text.split(':').count() == 3 && shift.iter().all(|n| n.is_finite()));
    shift.ok_or_else(|| format!("shift={text}: wanted X:Y:Z, three lengths of the world"))
}

impl FromStr for WithWord {
    type Err = String;

    /// The file ends where the first key begins: its name may hold commas. So may the value of `colormap`.
    fn from_str(text: &str) -> Result<Self, String> {
        let mut parts: Vec<String> = Vec::new();
        for piece in text.split(',') {
            let key = piece.split_once('=').map(|(key, _)| key);
            let is_key = key.is_some_and(|key| key.bytes().all(|c| c.is_ascii_lowercase()));
            // Built-in volumes have keys of their own.
            let is_of_phantom = parts.len() == 1
                && text.starts_with(PHANTOM)
                && key.is_some_and(|key| matches!(key, "n" | "type"));
            match parts.last_mut() {
                Some(last) if !is_key || is_of_phantom => {
                    last.push(',');
                    last.push_str(piece);
                }
                _ => parts.push(piece.to_owned()),
            }
        }
        let mut parts = parts.into_iter();
        let path = parts.next().unwrap_or_default();
        if path.is_empty() {
            return Err("wanted the name of a file".to_owned());
        }
        let mut word = Self {
            path,
            ..Self::default()
        };
        for part in parts {
            let (key, value) = part.split_once('=').expect("parts begin with a key");
            word.set(key, value)?;
        }
        word.check()?;
        Ok(word)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_is_a_file_and_what_is_said_of_it() {
        let word: WithWord = "a b,c.nrrd,preset=pet,window=0:5".parse().expect("a word");
        assert_eq!(
            (word.path.as_str(), word.window),
            ("a b,c.nrrd", Some([0.0, 5.0]))
        );
        assert_eq!(word.preset.as_deref(), Some("pet"));
        let word: WithWord = "phantom:gauss,n=32,type=u8,colormap=viridis,reverse"
            .parse()
            .expect("a word");
        assert_eq!(word.path, "phantom:gauss,n=32,type=u8");
        assert_eq!(word.colormap.as_deref(), Some("viridis,reverse"));
        let word: WithWord = "x.nc,variable=W,component=2,color=cyan"
            .parse()
            .expect("a word");
        assert_eq!(
            (word.variable.as_deref(), word.component),
            (Some("W"), Some(2))
        );
        assert_eq!(word.color, Some([0.0, 1.0, 1.0]));
    }

    #[test]
    fn what_is_no_word_is_refused_by_its_part() {
        for (text, wanted) in [
            ("", "name of a file"),
            ("a.nrrd,hue=3", "hue"),
            ("a.nrrd,preset=bone", "bone"),
            ("a.nrrd,window=4:4", "4:4"),
            ("a.nrrd,window=0:1,window=0:2", "twice"),
            ("a.nrrd,preset=pet,color=red", "preset and color"),
            ("a.nrrd,color=red,colormap=vik", "color and colormap"),
            ("a.nrrd,component=x", "component=x"),
            ("a.nrrd,shift=1:2", "X:Y:Z"),
            ("a.STL,preset=pet", "preset is of volumes"),
            ("a.nrrd,shift=1:2:x:3", "X:Y:Z"),
        ] {
            let problem = text.parse::<WithWord>().expect_err(text);
            assert!(problem.contains(wanted), "{text}: {problem}");
        }
    }
}
