//! `stratavox convert`: a volume in another format, or a part of it, or in another type.

use super::{
    Error,
    flags::{InputFlags, Numbers, PointGrid, PointGridFlags},
    flow::FlowFlags,
    load, output,
    progress::{Progress, ProgressWord},
    resume_check::{hash_of, stamp_of},
    signals::Gate,
    surface::Surface,
    unfinished::Unfinished,
};
use crate::{
    format::write::{
        DoneBricks, NumberType, Selection, Unpacked, VolumeFormat, WriteVolumeError,
        WriteVolumeOptions, Written, write_bricks, write_volume,
    },
    isosurface::Border,
    mesh::MeshFormat,
    picture::{OutputError, OutputFile, OutputProblem},
    volume::{Header, Source, VoxelBox, VoxelType},
};
use clap::Args;
use serde_json::{Value, json};
use std::{
    hash::Hasher,
    io::Write,
    path::{Path, PathBuf},
};

/// Write a volume in another format
#[derive(Args, Debug)]
#[command(
    after_help = "All times and components are written unless --time and --component take one. Stored numbers stay \
    as they are\nwhere the format can say what they mean; what it cannot keep is said on stderr.\n\nExamples:\n  \
    stratavox convert phantom:head -o head.nrrd\n  \
    stratavox convert phantom:head -o bone.nii.gz --type u8 --window=-200,800\n  \
    stratavox convert phantom:shells,n=64 -o shells.npy --type f32\n  \
    stratavox convert phantom:head -o head.svb --resume\n  \
    stratavox convert phantom:head,n=64 -o skull.ply --iso 300\n  \
    stratavox convert phantom:storm,n=32 -o updraft.vtp --flow stream --flow-seeds 'where:w>5,100'\n  \
    stratavox convert phantom:storm,n=32 -o tubes.glb --flow stream\n  \
    stratavox convert phantom:storm,n=32 -o wind.csv --flow stream\n  \
    stratavox convert wind.csv -o speed.nrrd --point-columns value=value --grid 48x48x24",
    mut_arg("flow", |flow| flow.conflicts_with_all(["crop", "type", "window", "uncompressed", "iso", "resume"]))
)]
pub struct Convert {
    #[command(flatten)]
    input: InputFlags,
    /// The file: .nrrd, .mha, .nii, .nii.gz, .npy, or .svb of bricks and coarser levels, for volumes larger than the
    /// memory; for a surface .ply, .stl or .glb; for lines .vtp, .csv or .glb
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Keep this box of whole voxels
    #[arg(
        long,
        value_name = "X0,X1,Y0,Y1,Z0,Z1",
        allow_hyphen_values = true,
        help_heading = "Numbers"
    )]
    crop: Option<Numbers<6>>,
    /// Write values, rounded to this type: u8, i8, u16, i16, u32, i32, u64, i64, f16, f32, f64 [default: as stored]
    #[arg(long, value_name = "TYPE", value_parser = voxel_type, help_heading = "Numbers")]
    r#type: Option<VoxelType>,
    /// Spread the values from LO to HI over the type: 0 to its largest number, or 0 to 1 for floats
    #[arg(
        long,
        value_name = "LO,HI",
        allow_hyphen_values = true,
        requires = "type",
        help_heading = "Numbers"
    )]
    window: Option<Numbers<2>>,
    /// The surface of this value, for a .ply, .stl or .glb
    #[arg(long, value_name = "VALUE", allow_hyphen_values = true, conflicts_with_all = ["crop", "type", "window", "uncompressed"], help_heading = "Surface")]
    iso: Option<f64>,
    /// Close the surface where the volume ends, as printers of solids want it
    #[arg(long, requires = "iso", help_heading = "Surface")]
    closed: bool,
    #[command(flatten)]
    point_grid: PointGridFlags,
    #[command(flatten)]
    flow: FlowFlags,
    /// Go on with a .svb where a run before was stopped; the file is that of one that was not
    #[arg(long, conflicts_with = "iso")]
    resume: bool,
    /// Do not compress a .nrrd or .mha
    #[arg(long)]
    uncompressed: bool,
    /// Say on stderr how far the work is
    #[arg(long, value_enum, default_value_t, help_heading = "Run")]
    progress: ProgressWord,
    /// Replace a file that exists
    #[arg(long, help_heading = "Run")]
    force: bool,
}

/// The type of a word.
fn voxel_type(word: &str) -> Result<VoxelType, String> {
    use VoxelType::{F16, F32, F64, I8, I16, I32, I64, U8, U16, U32, U64};
    let all = [U8, I8, U16, I16, U32, I32, U64, I64, F16, F32, F64];
    all.into_iter()
        .find(|number| number.name() == word)
        .ok_or_else(|| "wanted a type such as u8, i16 or f32".to_owned())
}

impl Convert {
    /// Reads and writes.
    pub fn run(mut self, gate: &Gate) -> Result<(), Error> {
        self.put_points_on_grid()?;
        let wind = self.flow.wind.is_some().then_some("--wind");
        if let Some(word) = self
            .flow
            .word_without_lines()
            .or(wind.filter(|_| self.flow.flow.is_none()))
        {
            return Err(Error::usage(
                format!("{word} is of lines along the wind, and a volume is written"),
                "--flow stream writes lines",
            ));
        }
        if let Some(word) = self.flow.flow {
            self.flow.check(&self.output)?;
            let inputs: Vec<PathBuf> = self.input.file().map(Path::to_owned).into_iter().collect();
            output::check(std::slice::from_ref(&self.output), &inputs, self.force)?;
            let progress = Progress::new(self.progress);
            let (path, force) = (&self.output, self.force);
            return (self.flow).write(word, &self.input, path, force, &progress, gate);
        }
        if let Some(surface) = self.surface()? {
            let inputs: Vec<PathBuf> = self.input.file().map(Path::to_owned).into_iter().collect();
            output::check(std::slice::from_ref(&self.output), &inputs, self.force)?;
            let progress = Progress::new(self.progress);
            return surface.write(&self.input, &self.output, self.force, &progress, gate);
        }
        let options = self.options()?;
        let inputs: Vec<PathBuf> = self.input.file().map(Path::to_owned).into_iter().collect();
        output::check(std::slice::from_ref(&self.output), &inputs, self.force)?;
        let progress = Progress::new(self.progress);
        let source = self.input.open(&self.input.limits())?;
        let selection = self.selection(source.header())?;
        for note in &source.header().notes {
            // Said of a volume in memory; the file gets the stored numbers, or a count of those that changed.
            if !note.starts_with("voxels are stored as") {
                progress.note(note);
            }
        }
        load::prepare(source.as_ref(), &self.input, &progress);
        let written = match options.format {
            VolumeFormat::Bricks => self.bricks(source, &selection, &options, &progress, gate)?,
            _ => self.write(source.as_ref(), &selection, &options, &progress, gate)?,
        };
        for note in &written.notes {
            progress.note(note);
        }
        Ok(())
    }

    /// Scattered points become a volume by interpolation.
    fn put_points_on_grid(&mut self) -> Result<(), Error> {
        if self.input.are_points() {
            self.input.on_grid = Some(Box::new(PointGrid {
                flags: self.point_grid.clone(),
                exaggerate: None,
            }));
        } else if self.point_grid.are_given() {
            return Err(Error::usage(
                "--grid, --interpolate, --reach and --anisotropy are for scattered points, and the input is a volume",
                "leave them out",
            ));
        }
        Ok(())
    }

    /// Bricks are parts: what is compressed as a whole is decoded once, into a file without a name beside the output.
    fn in_parts(
        &self,
        source: Box<dyn Source>,
        selection: &Selection,
        done: &DoneBricks,
        progress: &Progress,
    ) -> Result<Box<dyn Source>, Error> {
        if source.reads_parts() || done.holds_all_voxels(selection) {
            return Ok(source);
        }
        let folder = self
            .output
            .parent()
            .filter(|folder| *folder != Path::new(""));
        let folder = folder.unwrap_or(Path::new("."));
        let mut say = |done, of| progress.stage("decode", done, of);
        let unpacked = Unpacked::new(source, selection, folder, &mut say);
        let unpacked = unpacked.map_err(|error| self.error(error))?;
        Ok(Box::new(match done.count() {
            0 => unpacked,
            _ => unpacked.told(),
        }))
    }

    /// What the words say of a surface; `None` where a volume is wanted.
    fn surface(&self) -> Result<Option<Surface>, Error> {
        let name = self.output.display();
        match (MeshFormat::of_path(&self.output), self.iso) {
            (None, None) => Ok(None),
            (Some(_), None) => Err(Error::usage(
                format!("-o {name}: a surface is that of a value"),
                "--iso 300 takes the surface of 300",
            )),
            (None, Some(_)) => Err(Error::usage(
                format!("-o {name}: no format of surfaces has that ending"),
                "name a file that ends in .ply, .stl or .glb",
            )),
            (Some(_), Some(level)) if !level.is_finite() => Err(Error::usage(
                format!("--iso {level}: wanted a finite value"),
                "--iso 300",
            )),
            (Some(format), Some(level)) => Ok(Some(Surface {
                format,
                level,
                border: if self.closed {
                    Border::Closed
                } else {
                    Border::Open
                },
            })),
        }
    }

    fn options(&self) -> Result<WriteVolumeOptions, Error> {
        let format = VolumeFormat::of_path(&self.output).ok_or_else(|| {
            Error::usage(
                format!(
                    "-o {}: no format of volumes has that ending",
                    self.output.display()
                ),
                "name a file that ends in .nrrd, .mha, .nii, .nii.gz, .npy or .svb",
            )
        })?;
        if self.resume && format != VolumeFormat::Bricks {
            return Err(Error::usage(
                "--resume is for a .svb: other files are written in one piece",
                "leave out --resume",
            ));
        }
        let window = self.window.map(|Numbers(ends)| ends);
        if let Some([low, high]) = window
            && low >= high
        {
            return Err(Error::usage(
                format!("--window {low},{high}: the lower value comes first"),
                "--window -200,800",
            ));
        }
        let numbers = match (self.r#type, window) {
            (None, _) => NumberType::Stored,
            (Some(number), None) => NumberType::Values(number),
            (Some(number), Some(window)) => NumberType::Spread(number, window),
        };
        Ok(WriteVolumeOptions {
            format,
            numbers,
            compress: !self.uncompressed,
        })
    }

    fn selection(&self, header: &Header) -> Result<Selection, Error> {
        self.input.check_one(header)?;
        let times = match self.input.time {
            None => 0..header.times,
            Some(_) => {
                let (time, _) = self.input.time(header)?;
                time..time + 1
            }
        };
        Ok(Selection {
            region: match self.crop {
                None => header.whole(),
                Some(crop) => whole_voxels(crop, header)?,
            },
            times,
            components: self.input.components(header)?,
        })
    }

    /// Writes bricks, from where a run before was stopped.
    fn bricks(
        &self,
        source: Box<dyn Source>,
        selection: &Selection,
        options: &WriteVolumeOptions,
        progress: &Progress,
        gate: &Gate,
    ) -> Result<Written, Error> {
        let conversion = self.identity(source.header())?;
        let (mut unfinished, done) =
            Unfinished::open(&self.output, conversion, self.resume, self.force)?;
        gate.keeps(unfinished.hint());
        if done.count() > 0 {
            progress.note(&format!("{} bricks are there and stay", done.count()));
        }
        let source = self.in_parts(source, selection, &done, progress);
        let mut bricks = done.count();
        let outcome = source.and_then(|source| {
            let mut say = |done, of| {
                bricks = done;
                progress.stage("write", done, of);
            };
            let (file, mut note) = unfinished.parts();
            let numbers = options.numbers;
            let source = source.as_ref();
            write_bricks(source, selection, numbers, file, done, &mut note, &mut say)
                .map_err(|error| self.error(error))
        });
        let written = outcome.inspect_err(|_| match bricks {
            0 => gate.finished(|| Unfinished::remove(&self.output)),
            _ => progress.note(&unfinished.hint()),
        })?;
        unfinished.publish(self.force, gate)?;
        Ok(written)
    }

    /// Every word that decides what the file holds, and what is known of the input without reading it.
    fn identity(&self, header: &Header) -> Result<Value, Error> {
        let input = serde_json::to_value(&self.input).expect("plain data as JSON");
        let header = format!("{header:?}");
        Ok(json!({
            "input": input,
            "point_grid": serde_json::to_value(&self.point_grid).expect("plain data as JSON"),
            "file": stamp_of(self.input.file())?,
            "header": hash_of(|hasher| hasher.write(header.as_bytes())),
            "crop": self.crop.map(|crop| crop.to_string()),
            "type": self.r#type.map(VoxelType::name),
            "window": self.window.map(|window| window.to_string()),
        }))
    }

    fn write(
        &self,
        source: &dyn Source,
        selection: &Selection,
        options: &WriteVolumeOptions,
        progress: &Progress,
        gate: &Gate,
    ) -> Result<Written, Error> {
        let make = || OutputFile::create(&self.output, self.force);
        let mut file = gate.unfinished(make, |file| file.part().to_owned())?;
        let mut say = |done, of| progress.stage("write", done, of);
        say(0, 1);
        let outcome = write_volume(source, selection, options, &mut file, &mut say)
            .and_then(|written| Ok(file.flush().map(|()| written)?));
        match outcome {
            Ok(written) => {
                gate.finished(|| file.publish())?;
                Ok(written)
            }
            Err(error) => {
                gate.finished(|| drop(file));
                Err(self.error(error))
            }
        }
    }

    fn error(&self, error: WriteVolumeError) -> Error {
        match error {
            WriteVolumeError::Read(error) => Error::Read(error),
            WriteVolumeError::Write(cause) => Error::WritePicture(OutputError {
                path: self.output.clone(),
                problem: OutputProblem::Io {
                    doing: "cannot write the voxels",
                    cause,
                },
            }),
            WriteVolumeError::NoRoom(problem) => Error::Output {
                path: self.output.clone(),
                problem,
                hint: Some("a .nrrd has room for volumes of any size"),
            },
        }
    }
}

/// A box of whole voxels inside the volume.
fn whole_voxels(Numbers(ends): Numbers<6>, header: &Header) -> Result<VoxelBox, Error> {
    let [x, y, z] = header.dims;
    let refuse = || {
        let words = Numbers(ends).to_string();
        Error::usage(
            format!("--crop {words}: wanted whole voxels inside 0,{x},0,{y},0,{z}, at least one"),
            "the order is X0,X1,Y0,Y1,Z0,Z1; each first is under its second",
        )
    };
    if ends.iter().any(|n| n.fract() != 0.0 || *n < 0.0) {
        return Err(refuse());
    }
    // A float over the largest u32 becomes that number, which no axis reaches.
    let [x0, x1, y0, y1, z0, z1] = ends.map(|n| n as u32);
    let region = VoxelBox {
        min: [x0, y0, z0],
        max: [x1, y1, z1],
    };
    let inside = (0..3).all(|k| region.min[k] < region.max[k] && region.max[k] <= header.dims[k]);
    if inside { Ok(region) } else { Err(refuse()) }
}
