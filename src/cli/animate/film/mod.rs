//! Films in one file, made of finished frames. One file a format.
//!
//! | | |
//! |---|---|
//! | `.apng` | as exact as the frames, with transparency, 8 or 16 bits |
//! | `.gif` | 256 colours for the whole film, at most 50 frames a second |
//! | `.y4m` | every pixel, uncompressed, 8 bits YCbCr: for other programs |
//! | `.mp4` | H.264 by an installed ffmpeg |

mod apng;
mod gif;
mod mp4;
mod palette;
pub mod y4m;

use super::{rate::Rate, target::Frames};
use crate::cli::{
    Error,
    line::{Line, encoders},
    progress::Progress,
    signals::Gate,
};
use std::{
    fs::File,
    io::{BufReader, BufWriter, Write},
    path::{Path, PathBuf},
    sync::mpsc::channel,
    thread,
};

pub use mp4::find_ffmpeg;

/// A kind of film file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names say it")]
pub enum FilmFormat {
    Apng,
    Gif,
    Y4m,
    Mp4,
}

impl FilmFormat {
    /// The format of a file's extension, in capitals or not.
    pub fn of_path(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()?.to_ascii_lowercase().as_str() {
            "apng" => Some(Self::Apng),
            "gif" => Some(Self::Gif),
            "y4m" => Some(Self::Y4m),
            "mp4" => Some(Self::Mp4),
            _ => None,
        }
    }

    /// What keeps transparency, and 16 bits.
    pub fn is_as_good_as_png(self) -> bool {
        self == Self::Apng
    }
}

/// Finished frames, and what a film of them needs to know.
#[derive(Debug)]
pub struct Reel<'a> {
    /// PNGs of 8 bits, or of 16 for APNG.
    pub frames: &'a Frames,
    /// How many.
    pub count: u32,
    /// Pixels across and down.
    pub extent_pixels: [u32; 2],
    /// How fast.
    pub rate: Rate,
    /// The film, as errors name it.
    pub path: &'a Path,
    /// Who hears how far it is.
    pub progress: &'a Progress,
}

impl Reel<'_> {
    /// Red, green, blue and alpha of each pixel of a frame: bytes, or pairs of them with the high one first.
    fn codes(&self, number: u32) -> Result<Vec<u8>, Error> {
        let path = self.frames.path(number);
        let refused = |problem: String| Error::Input {
            path: path.clone(),
            problem,
        };
        let file = File::open(&path).map_err(|cause| refused(cause.to_string()))?;
        let decoder = png::Decoder::new(BufReader::new(file));
        let mut reader = decoder
            .read_info()
            .map_err(|cause| refused(cause.to_string()))?;
        let info = reader.info();
        if [info.width, info.height] != self.extent_pixels
            || info.color_type != png::ColorType::Rgba
        {
            return Err(refused("it is not a frame of this film".to_owned()));
        }
        let mut bytes = vec![0; reader.output_buffer_size().unwrap_or(0)];
        reader
            .next_frame(&mut bytes)
            .map_err(|cause| refused(cause.to_string()))?;
        Ok(bytes)
    }

    /// What `make` makes of each frame, by all cores and a few frames ahead, to `put` in order.
    fn in_order<T: Send>(
        &self,
        make: impl Fn(u32) -> Result<T, Error> + Sync,
        mut put: impl FnMut(T) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let threads = encoders(self.extent_pixels);
        let line = &Line::new(threads + 1);
        let (sender, numbers) = channel();
        thread::scope(|scope| {
            scope.spawn(move || {
                for number in 0..self.count {
                    if !line.enter(number as usize)
                        || sender.send((number as usize, number)).is_err()
                    {
                        return;
                    }
                }
            });
            line.run(
                numbers,
                threads,
                |_, number| make(number),
                |at, made| {
                    self.progress.stage("encode", at, self.count as usize);
                    put(made?)
                },
            )
        })
    }

    fn wrote(&self, cause: std::io::Error) -> Error {
        Error::output(self.path, &cause)
    }
}

/// Writes the film under a name of its own in the frames' folder, then gives it its place.
pub fn write(format: FilmFormat, reel: &Reel, force: bool, gate: &Gate) -> Result<(), Error> {
    let part: PathBuf = reel.frames.folder.join("film.part");
    // One that a kill has left is of no use.
    let part = tempfile::TempPath::try_from_path(part).map_err(|cause| reel.wrote(cause))?;
    if format == FilmFormat::Mp4 {
        mp4::write(reel, &part)?;
    } else {
        let file = File::create(&part).map_err(|cause| reel.wrote(cause))?;
        let mut out = BufWriter::new(file);
        match format {
            FilmFormat::Apng => apng::write(reel, &mut out)?,
            FilmFormat::Gif => gif::write(reel, &mut out)?,
            FilmFormat::Y4m | FilmFormat::Mp4 => y4m::write(reel, &mut out)?,
        }
        out.flush().map_err(|cause| reel.wrote(cause))?;
    }
    let synced = File::open(&part).and_then(|file| file.sync_all());
    synced.map_err(|cause| reel.wrote(cause))?;
    gate.whole(|| {
        let placed = if force {
            part.persist(reel.path)
        } else {
            part.persist_noclobber(reel.path)
        };
        placed.map_err(|failed| reel.wrote(failed.error))
    })
}
