//! The process that asks: a source whose voxels another process reads.

use super::{
    child::{OTHER_BYTES, SECONDS},
    wire::{Answer, Asking, Opened, Opening, What, put, take, take_piece},
};
use crate::{
    cli::memory::in_units,
    volume::{
        Header, Limits, Piece, PrecisionLoss, Problem, ReadError, Source, TimeComponent,
        VolumeSelection, VoxelBox,
    },
};
use std::{
    io::{self, BufReader, Read},
    ops::ControlFlow,
    os::unix::process::ExitStatusExt,
    path::{Path, PathBuf},
    process::{Child, ChildStdin, ChildStdout, Command, Stdio},
    sync::{Mutex, MutexGuard, PoisonError},
};

/// What a reader of a test does wrong: `loop`, `allocate`, `read` another file, or `write` to its own.
const FAULT: &str = "STRATAVOX_READER_FAULT";

/// Opens a file, as raw voxels of a layout where one is given, in a process of its own.
///
/// # Errors
/// What the reader says, and that it took more than it may.
pub fn open(
    path: &Path,
    raw: Option<&str>,
    wanted: &VolumeSelection,
    limits: &Limits,
) -> Result<Box<dyn Source>, ReadError> {
    let failed = |problem| ReadError {
        path: path.to_owned(),
        problem,
    };
    let name = path
        .to_str()
        .ok_or_else(|| failed(not_answered("a name that is not UTF-8")))?;
    let opening = Opening {
        path: name.to_owned(),
        raw: raw.map(str::to_owned),
        wanted: wanted.clone(),
        limits: *limits,
    };
    let mut reader = Reader::start(&opening).map_err(|cause| failed(started(cause)))?;
    let answer = reader.answer(path, limits.max_bytes)?;
    let Answer::Opened(opened) = answer else {
        return Err(failed(not_answered("no header")));
    };
    if !opened.is_sound() {
        return Err(failed(not_answered("a header that cannot be")));
    }
    Ok(Box::new(ReadElsewhere {
        path: path.to_owned(),
        opened: *opened,
        opening,
        reader: Mutex::new(Some(reader)),
    }))
}

/// The source.
struct ReadElsewhere {
    path: PathBuf,
    opened: Opened,
    opening: Opening,
    /// `None` where the last one was ended before it had said all.
    reader: Mutex<Option<Reader>>,
}

/// A process that reads. It ends with this.
struct Reader {
    child: Child,
    to: ChildStdin,
    from: BufReader<ChildStdout>,
}

impl Reader {
    fn start(opening: &Opening) -> io::Result<Self> {
        let mut command = Command::new(std::env::current_exe()?);
        command.arg(super::VERB);
        if let Some(fault) = std::env::var_os(FAULT) {
            command.arg("--fault").arg(fault);
        }
        let mut child = command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()?;
        let gone = || io::Error::other("the reader has no pipe");
        let mut to = child.stdin.take().ok_or_else(gone)?;
        let from = child.stdout.take().ok_or_else(gone)?;
        // A reader that ended at once is told by how it ended.
        let _ = put(&mut to, opening);
        Ok(Self {
            child,
            to,
            from: BufReader::with_capacity(1 << 16, from),
        })
    }

    /// What the reader says next, its errors as ours.
    fn answer(&mut self, path: &Path, max_bytes: u64) -> Result<Answer, ReadError> {
        match take(&mut self.from) {
            Ok(Some(Answer::Failed { path, problem })) => Err(ReadError {
                path: path.into(),
                problem,
            }),
            Ok(Some(answer)) => Ok(answer),
            Ok(None) | Err(_) => Err(self.ended(path, max_bytes)),
        }
    }

    /// Why the reader has ended.
    fn ended(&mut self, path: &Path, max_bytes: u64) -> ReadError {
        let _ = self.child.kill();
        let status = self.child.wait();
        let signal = status.as_ref().ok().and_then(ExitStatusExt::signal);
        let problem = match signal {
            Some(libc::SIGXCPU) => Problem::Io {
                doing: "its reader was stopped",
                cause: io::Error::new(
                    io::ErrorKind::TimedOut,
                    format!(
                        "it took more processor time than --untrusted allows, {SECONDS} s and 2 s more for each MiB of voxels"
                    ),
                ),
            },
            // Memory that is refused ends a program of Rust's by abort.
            Some(libc::SIGABRT | libc::SIGSEGV | libc::SIGBUS) => Problem::Io {
                doing: "its reader was stopped",
                cause: io::Error::new(
                    io::ErrorKind::OutOfMemory,
                    format!(
                        "it took more memory than --untrusted allows, {}",
                        in_units(max_bytes.saturating_mul(2).saturating_add(OTHER_BYTES))
                    ),
                ),
            },
            _ => not_answered("no answer"),
        };
        ReadError {
            path: path.to_owned(),
            problem,
        }
    }
}

impl Drop for Reader {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn started(cause: io::Error) -> Problem {
    Problem::Io {
        doing: "starting its reader",
        cause,
    }
}

fn not_answered(found: &str) -> Problem {
    Problem::Io {
        doing: "asking its reader",
        cause: io::Error::other(format!("{found} came back")),
    }
}

impl ReadElsewhere {
    fn failed(&self, problem: Problem) -> ReadError {
        ReadError {
            path: self.path.clone(),
            problem,
        }
    }

    fn kept(&self) -> MutexGuard<'_, Option<Reader>> {
        self.reader.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The reader, started anew where the last one was ended.
    fn reader<'a>(&self, kept: &'a mut Option<Reader>) -> Result<&'a mut Reader, ReadError> {
        if kept.is_none() {
            let mut reader =
                Reader::start(&self.opening).map_err(|cause| self.failed(started(cause)))?;
            reader.answer(&self.path, self.opening.limits.max_bytes)?;
            *kept = Some(reader);
        }
        kept.as_mut()
            .ok_or_else(|| self.failed(not_answered("no answer")))
    }

    /// Asks, and hands over each piece until the reader has no more or `take` breaks off.
    fn pieces(
        &self,
        asking: Asking,
        regions: &mut dyn Iterator<Item = VoxelBox>,
        take: &mut dyn FnMut(VoxelBox, Piece) -> ControlFlow<()>,
    ) -> Result<(), ReadError> {
        let mut kept = self.kept();
        let reader = self.reader(&mut kept)?;
        let outcome = self.pieces_of(reader, asking, regions, take);
        if !matches!(outcome, Ok(ControlFlow::Continue(()))) {
            // What it has still to say is not waited for.
            *kept = None;
        }
        outcome.map(|_| ())
    }

    fn pieces_of(
        &self,
        reader: &mut Reader,
        asking: Asking,
        regions: &mut dyn Iterator<Item = VoxelBox>,
        take: &mut dyn FnMut(VoxelBox, Piece) -> ControlFlow<()>,
    ) -> Result<ControlFlow<()>, ReadError> {
        let most = self.opening.limits.max_bytes;
        // A reader that is gone says so below.
        let _ = put(&mut reader.to, &asking);
        for region in regions {
            let piece = match reader.answer(&self.path, most)? {
                Answer::Voxels {
                    r#type,
                    count,
                    changed,
                    worst,
                } if count == count_of(region) => {
                    let worst = f64::from_bits(worst);
                    let loss = PrecisionLoss { changed, worst };
                    take_piece(&mut reader.from, r#type, count as usize, loss)
                        .map_err(|_| reader.ended(&self.path, most))?
                }
                _ => return Err(self.failed(not_answered("other voxels than wanted"))),
            };
            if take(region, piece).is_break() {
                return Ok(ControlFlow::Break(()));
            }
        }
        match asking.what {
            What::Slabs(_) => match reader.answer(&self.path, most)? {
                Answer::End => Ok(ControlFlow::Continue(())),
                _ => Err(self.failed(not_answered("more than wanted"))),
            },
            _ => Ok(ControlFlow::Continue(())),
        }
    }
}

fn count_of(region: VoxelBox) -> u64 {
    region.dims().iter().map(|&n| u64::from(n)).product()
}

impl Source for ReadElsewhere {
    fn path(&self) -> &Path {
        &self.path
    }

    fn header(&self) -> &Header {
        &self.opened.header
    }

    fn reads_parts(&self) -> bool {
        self.opened.reads_parts
    }

    fn reads_whole_rows(&self) -> bool {
        self.opened.reads_whole_rows
    }

    fn read(&self, pick: TimeComponent, region: VoxelBox) -> Result<Piece, ReadError> {
        let mut read = None;
        let what = What::Piece;
        let asking = Asking { pick, region, what };
        self.pieces(asking, &mut std::iter::once(region), &mut |_, piece| {
            read = Some(piece);
            ControlFlow::Continue(())
        })?;
        read.ok_or_else(|| self.failed(not_answered("no voxels")))
    }

    fn read_slabs(
        &self,
        pick: TimeComponent,
        region: VoxelBox,
        slices: u32,
        take: &mut dyn FnMut(VoxelBox, Piece) -> ControlFlow<()>,
    ) -> Result<(), ReadError> {
        let what = What::Slabs(slices);
        let asking = Asking { pick, region, what };
        self.pieces(asking, &mut region.slabs(slices), take)
    }

    fn read_bytes(
        &self,
        pick: TimeComponent,
        region: VoxelBox,
    ) -> Result<Option<Vec<u8>>, ReadError> {
        let most = self.opening.limits.max_bytes;
        let mut kept = self.kept();
        let reader = self.reader(&mut kept)?;
        let what = What::Bytes;
        let _ = put(&mut reader.to, &Asking { pick, region, what });
        let wanted = count_of(region).saturating_mul(self.opened.header.stored.bytes() as u64);
        let read = match reader.answer(&self.path, most) {
            Ok(Answer::Bytes(None)) => return Ok(None),
            Ok(Answer::Bytes(Some(count))) if count == wanted => {
                let mut bytes = Vec::new();
                match reader.from.by_ref().take(count).read_to_end(&mut bytes) {
                    Ok(found) if found as u64 == count => Ok(Some(bytes)),
                    _ => Err(reader.ended(&self.path, most)),
                }
            }
            Ok(_) => Err(self.failed(not_answered("other bytes than wanted"))),
            Err(error) => Err(error),
        };
        if read.is_err() {
            *kept = None;
        }
        read
    }
}
