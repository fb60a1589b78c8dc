//! `-o`: a picture file a frame, one film file, or a stream into the next program.

use super::film::FilmFormat;
use crate::{cli::Error, format::numbered_name, picture::PictureFormat};
use std::path::{Path, PathBuf};

/// Where a film goes.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// A file for each frame.
    Frames(Frames),
    /// One file.
    Film {
        /// It.
        path: PathBuf,
        /// By its ending.
        format: FilmFormat,
    },
    /// The standard output, as Y4M.
    Stream,
}

/// Numbered files in a folder.
#[derive(Clone, Debug, PartialEq)]
pub struct Frames {
    /// Where they lie.
    pub folder: PathBuf,
    /// Their name: `%04d.png`.
    pub template: String,
    /// By its ending.
    pub format: PictureFormat,
}

const HINT: &str = "-o frames/%04d.png, or a name that ends in .apng, .gif, .y4m or .mp4";

impl Target {
    /// What the word of `-o` says.
    pub fn new(path: &Path) -> Result<Self, Error> {
        if path == Path::new("-") {
            return Ok(Self::Stream);
        }
        let refused = |what: String| Error::usage(format!("-o {}: {what}", path.display()), HINT);
        let name = path.file_name().and_then(|name| name.to_str());
        let name = name.ok_or_else(|| refused("it names no file".to_owned()))?;
        if let Some(format) = FilmFormat::of_path(path) {
            let path = path.to_owned();
            return Ok(Self::Film { path, format });
        }
        let format = PictureFormat::of_path(path)
            .ok_or_else(|| refused("the ending says no kind of film or picture".to_owned()))?;
        if numbered_name(name, 0).is_none() {
            return Err(refused(
                "a film of pictures needs one number in their name".to_owned(),
            ));
        }
        let folder = match path.parent() {
            Some(folder) if folder != Path::new("") => folder,
            _ => Path::new("."),
        };
        Ok(Self::Frames(Frames {
            folder: folder.to_owned(),
            template: name.to_owned(),
            format,
        }))
    }
}

impl Frames {
    /// The file of a frame.
    pub fn path(&self, number: u32) -> PathBuf {
        let name = numbered_name(&self.template, number.into());
        self.folder
            .join(name.expect("`Target::new` has tried the template"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_template_numbers_files_and_an_ending_makes_a_film() {
        let Ok(Target::Frames(frames)) = Target::new(Path::new("a%b/f_%03d.exr")) else {
            panic!("no frames");
        };
        assert_eq!(frames.path(7), Path::new("a%b/f_007.exr"));
        assert_eq!(frames.format, PictureFormat::Exr);
        for name in ["a.apng", "a.GIF", "a.y4m", "a.mp4"] {
            let target = Target::new(Path::new(name)).expect(name);
            assert!(matches!(target, Target::Film { .. }), "{target:?}");
        }
        assert_eq!(
            Target::new(Path::new("-")).expect("a stream"),
            Target::Stream
        );
    }

    #[test]
    fn a_name_that_cannot_be_numbered_is_refused() {
        for name in [
            "a.png", "%d%d.png", "%s.png", "%%d.png", "a%04d", "a.avi", "..",
        ] {
            let error = Target::new(Path::new(name)).expect_err(name);
            assert_eq!(error.exit_code(), 2, "{name}");
        }
    }
}
