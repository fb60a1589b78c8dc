//! A picture to a file, by the file's extension.

use super::{Picture, npy, place};
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// How a picture is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WriteOptions {
    /// Of PNG.
    pub bit_depth: BitDepth,
    /// Replace existing files.
    pub force: bool,
}

/// Bits of a channel of a PNG.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names say it")]
pub enum BitDepth {
    #[default]
    Eight,
    Sixteen,
}

/// A kind of picture file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureFormat {
    /// Straight sRGB numbers of 8 or 16 bits.
    Png,
    /// Linear premultiplied f32, layers as channels of their names.
    Exr,
    /// Linear premultiplied f32, `[H, W, 4]`; each layer in a file beside it, `[H, W]`.
    Npy,
}

impl PictureFormat {
    /// The format of a file's extension, in capitals or not.
    pub fn of_path(path: &Path) -> Option<Self> {
        let extension = path.extension().and_then(OsStr::to_str)?;
        match extension.to_ascii_lowercase().as_str() {
            "png" => Some(Self::Png),
            "exr" => Some(Self::Exr),
            "npy" => Some(Self::Npy),
            _ => None,
        }
    }
}

/// What went wrong with a file to be written, and with which one.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {}: {problem}", path.display())]
pub struct OutputError {
    /// The file.
    pub path: PathBuf,
    /// What stood in the way.
    #[source]
    pub problem: OutputProblem,
}

/// What can stand in the way of a file.
#[derive(Debug, thiserror::Error)]
pub enum OutputProblem {
    /// It is there already and may not be replaced.
    #[error("the file exists")]
    Exists,
    /// A folder has that name.
    #[error("a folder has that name")]
    IsFolder,
    /// The path ends in no name, as `..` does.
    #[error("the path names no file")]
    NoName,
    /// The folder for it is missing.
    #[error("there is no folder {}", .0.display())]
    NoFolder(PathBuf),
    /// No writer knows this extension, or it was left out of this build.
    #[error("wanted a name that ends in .png, .exr or .npy, found {0}")]
    Extension(String),
    /// A picture whose parts have different sizes.
    #[error("the picture is {width}x{height}, but {what} has {found} numbers")]
    Size {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
        /// `pixels`, or the layer.
        what: &'static str,
        /// How many there are.
        found: usize,
    },
    /// The bytes found no room.
    #[error("cannot write its {wanted_bytes} bytes")]
    Write {
        /// How many there are to write.
        wanted_bytes: u64,
        /// The system's word.
        #[source]
        cause: std::io::Error,
    },
    /// The system would not let us.
    #[error("{doing}")]
    Io {
        /// What was being done.
        doing: &'static str,
        /// The system's word.
        #[source]
        cause: std::io::Error,
    },
    /// The encoder refused, as it does for a picture without pixels.
    #[error("the picture cannot be encoded: {0}")]
    Encode(String),
}

/// A picture as its files will hold it. Making one takes the CPU alone and writing one the disk alone, so that pictures
/// of a batch can be encoded side by side and written in order.
#[derive(Clone, Debug, PartialEq)]
pub struct EncodedPicture {
    files: Vec<(PathBuf, Vec<u8>)>,
}

impl EncodedPicture {
    /// `picture` in the format of the extension of `path`.
    ///
    /// PNG has no room for layers and leaves them out. For `.npy`, the layer `depth` of `OUT.npy` goes to
    /// `OUT.depth.npy`.
    ///
    /// # Errors
    /// An extension that is no format's, or a picture without pixels.
    pub fn new(picture: &Picture, path: &Path, options: WriteOptions) -> Result<Self, OutputError> {
        match encode(picture, path, options) {
            Ok(files) => Ok(Self { files }),
            Err(problem) => Err(OutputError {
                path: path.to_owned(),
                problem,
            }),
        }
    }

    /// The bytes of each file, with its path.
    pub fn into_files(self) -> Vec<(PathBuf, Vec<u8>)> {
        self.files
    }

    /// Writes all files, each whole or not at all; none gets its name before all are written. Only `force` replaces
    /// one.
    ///
    /// # Errors
    /// Where the system would not, or a file exists.
    pub fn write(&self, force: bool) -> Result<(), OutputError> {
        let mut staged = Vec::new();
        for (path, bytes) in &self.files {
            match place::stage(path, bytes, force) {
                Ok(file) => staged.push(file),
                Err(problem) => {
                    let path = path.clone();
                    return Err(OutputError { path, problem });
                }
            }
        }
        for file in staged {
            file.publish()?;
        }
        Ok(())
    }
}

/// Writes `picture` to `path` in the format of its extension, as [`EncodedPicture`] does.
///
/// # Errors
/// Those of [`EncodedPicture`].
pub fn write_picture(
    picture: &Picture,
    path: &Path,
    options: WriteOptions,
) -> Result<(), OutputError> {
    EncodedPicture::new(picture, path, options)?.write(options.force)
}

/// Puts a file with these bytes at `path`, whole or not at all. Only `force` replaces one.
pub fn write_file(path: &Path, bytes: &[u8], force: bool) -> Result<(), OutputError> {
    place::stage(path, bytes, force)
        .map_err(|problem| OutputError {
            path: path.to_owned(),
            problem,
        })?
        .publish()
}

/// The files of `picture` and what stands in them.
#[cfg_attr(
    not(feature = "png"),
    expect(unused_variables, reason = "only PNG has options")
)]
fn encode(
    picture: &Picture,
    path: &Path,
    options: WriteOptions,
) -> Result<Vec<(PathBuf, Vec<u8>)>, OutputProblem> {
    check_sizes(picture)?;
    match PictureFormat::of_path(path) {
        #[cfg(feature = "png")]
        Some(PictureFormat::Png) => {
            let bytes = super::png::encode(picture, options.bit_depth)?;
            Ok(vec![(path.to_owned(), bytes)])
        }
        #[cfg(feature = "exr")]
        Some(PictureFormat::Exr) => Ok(vec![(path.to_owned(), super::exr::encode(picture)?)]),
        Some(PictureFormat::Npy) => {
            let (width, height) = (picture.width, picture.height);
            let pixels = picture.linear_pixels();
            let mut files = vec![(
                path.to_owned(),
                npy::encode(pixels.as_flattened(), &[height, width, 4]),
            )];
            for layer in &picture.layers {
                let beside = path.with_extension(format!("{}.npy", layer.kind.name()));
                let numbers = layer.kind.numbers() as u32;
                let shape = [height, width, numbers];
                let shape = &shape[..if numbers == 1 { 2 } else { 3 }];
                files.push((beside, npy::encode(&layer.values, shape)));
            }
            Ok(files)
        }
        _ => {
            let found = path.extension().map_or("no extension".into(), |extension| {
                format!(".{}", extension.to_string_lossy().escape_debug())
            });
            Err(OutputProblem::Extension(found))
        }
    }
}

fn check_sizes(picture: &Picture) -> Result<(), OutputProblem> {
    let (width, height) = (picture.width, picture.height);
    let wanted = width as usize * height as usize;
    let layers = picture.layers.iter();
    let parts = layers.map(|layer| {
        let kind = layer.kind;
        (kind.name(), kind.numbers(), layer.values.len())
    });
    for (what, numbers, found) in parts.chain([("pixels", 1, picture.pixels.len())]) {
        if found != wanted * numbers {
            return Err(OutputProblem::Size {
                width,
                height,
                what,
                found,
            });
        }
    }
    Ok(())
}
