//! `stratavox convert -o surface.ply --iso VALUE`: where a volume has one value, as a mesh.

use super::{Error, flags::InputFlags, load, progress::Progress, signals::Gate};
use crate::{
    isosurface::{Border, isosurface},
    mesh::MeshFormat,
    picture::{OutputError, OutputFile, OutputProblem},
    volume::Volume,
};
use std::{
    io::{BufWriter, Write},
    path::Path,
};

/// What is asked for.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    /// By the ending of the file.
    pub format: MeshFormat,
    /// The value.
    pub level: f64,
    /// What stands at the border of the grid.
    pub border: Border,
}

impl Surface {
    /// Reads the volume, finds the surface and writes it.
    pub fn write(
        self,
        input: &InputFlags,
        path: &Path,
        force: bool,
        progress: &Progress,
        gate: &Gate,
    ) -> Result<(), Error> {
        let limits = input.limits();
        let source = input.open(&limits)?;
        let (pick, note) = input.pick(source.header())?;
        for note in source.header().notes.iter().chain(&note) {
            progress.note(note);
        }
        progress.stage("read", 0, 1);
        load::prepare(source.as_ref(), input, progress);
        let volume = Volume::read(source.as_ref(), pick, source.header().whole(), &limits)?;
        progress.stage("surface", 0, 1);
        let mesh = isosurface(&volume, self.level, self.border).ok_or_else(|| Error::TooMany {
            message: "the surface has more than 2^32 corners".to_owned(),
            hint: "--crop takes a part of the volume",
        })?;
        if mesh.triangles.is_empty() {
            let [low, high] = volume.value_range;
            progress.note(&format!(
                "the surface is empty: {} lies outside of the values, {low} to {high}",
                self.level
            ));
        }
        progress.stage("write", 0, 1);
        let make = || OutputFile::create(path, force);
        let mut file = gate.unfinished(make, |file| file.part().to_owned())?;
        let mut out = BufWriter::new(&mut file);
        let outcome = mesh.write(self.format, &mut out).and_then(|()| out.flush());
        drop(out);
        match outcome {
            Ok(()) => Ok(gate.finished(|| file.publish())?),
            Err(cause) => {
                gate.finished(|| drop(file));
                Err(Error::WritePicture(OutputError {
                    path: path.to_owned(),
                    problem: OutputProblem::Io {
                        doing: "cannot write the surface",
                        cause,
                    },
                }))
            }
        }
    }
}
