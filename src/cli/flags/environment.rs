//! `--environment`: light from all around, even or by a picture.

use super::{Error, Numbers};
use crate::picture::read_image;
use crate::technique::pathtrace::SkyPicture;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};
use std::{fmt, str::FromStr};

/// `R,G,B` or the path of a picture of the sky.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum EnvironmentWord {
    /// Linear radiance.
    Even([f64; 3]),
    /// By a file.
    Picture(SkyFile),
}

/// A file that is read once, by whoever asks first.
#[derive(Clone, Debug)]
pub struct SkyFile {
    path: PathBuf,
    read: Arc<OnceLock<SkyPicture>>,
}

impl PartialEq for SkyFile {
    fn eq(&self, other: &Self) -> bool {
        self.path == other.path
    }
}

impl SkyFile {
    fn new(path: PathBuf) -> Self {
        Self {
            path,
            read: Arc::default(),
        }
    }

    /// What the file shows.
    pub fn picture(&self) -> Result<SkyPicture, Error> {
        if let Some(picture) = self.read.get() {
            return Ok(picture.clone());
        }
        let image = read_image(&self.path)?;
        let light = |&[r, g, b, _]: &[f32; 4]| [r, g, b];
        let pixels: Vec<_> = image.pixels.iter().map(light).collect();
        let picture = SkyPicture::new([image.width, image.height], &pixels);
        let picture = picture.map_err(|problem| Error::Input {
            path: self.path.clone(),
            problem: format!("the sky: {problem}"),
        })?;
        Ok(self.read.get_or_init(|| picture).clone())
    }
}

impl EnvironmentWord {
    /// The file, where it is one.
    pub fn file(&self) -> Option<&Path> {
        match self {
            Self::Even(_) => None,
            Self::Picture(file) => Some(&file.path),
        }
    }

    /// The same word with another path.
    pub fn with_path(&self, path: impl Fn(&Path) -> PathBuf) -> Self {
        match self {
            Self::Even(_) => self.clone(),
            Self::Picture(file) => Self::Picture(SkyFile::new(path(&file.path))),
        }
    }
}

impl FromStr for EnvironmentWord {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let path = Path::new(text);
        let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
        match ending.as_deref().and_then(|ending| ending.to_str()) {
            Some("exr" | "hdr") => Ok(Self::Picture(SkyFile::new(path.to_owned()))),
            _ => match Numbers::<3>::from_str(text) {
                Ok(Numbers(light)) => Ok(Self::Even(light)),
                Err(problem) => Err(format!("{problem}; or a picture .hdr or .exr")),
            },
        }
    }
}

impl fmt::Display for EnvironmentWord {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Even(light) => Numbers(*light).fmt(f),
            Self::Picture(file) => write!(f, "{}", file.path.display()),
        }
    }
}

impl TryFrom<String> for EnvironmentWord {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<EnvironmentWord> for String {
    fn from(word: EnvironmentWord) -> Self {
        word.to_string()
    }
}
