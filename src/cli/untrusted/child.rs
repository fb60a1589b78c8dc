//! The process that reads: limits first, then what it is asked for, until nobody asks.

use super::sandbox::restrict_to;
use super::wire::{Answer, Asking, Opened, Opening, What, put, put_failed, put_piece, take};
use crate::{cli::Error, format, volume::Source};
use clap::Args;
use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
use std::{
    fs::File,
    io::{self, BufReader, Read, Write},
    ops::ControlFlow,
    path::Path,
    process::abort,
    time::Duration,
};

/// Read a volume for another process of this program (internal)
#[derive(Args, Debug)]
#[command(after_help = "Example:\n  stratavox render scan.nii.gz --untrusted -o scan.png")]
pub struct ReadUntrusted {
    /// What a test has it do as it begins: loop, allocate, read or write
    #[arg(long, hide = true)]
    fault: Option<String>,
}

/// Memory beside two copies of the largest volume: the program itself, its stacks, and what readers keep.
pub const OTHER_BYTES: u64 = 512 << 20;
/// Files that are open at once.
const OPEN_FILES: u64 = 64;
/// Processor time of one request, and what is added for each MiB of voxels.
pub const SECONDS: u64 = 20;
const SECONDS_PER_MIB: u64 = 2;

impl ReadUntrusted {
    pub fn run(self) -> Result<(), Error> {
        let out = &mut io::stdout().lock();
        let input = &mut BufReader::new(io::stdin().lock());
        // Where the other process has gone there is nobody to tell.
        let _ = self.serve(input, out);
        Ok(())
    }

    fn serve(&self, input: &mut impl Read, out: &mut impl Write) -> io::Result<()> {
        let Some(opening) = take::<Opening>(input)? else {
            return Ok(());
        };
        let most = opening.limits.max_bytes;
        let most = most.saturating_mul(2).saturating_add(OTHER_BYTES);
        limit(Resource::As, most)?;
        limit(Resource::Nofile, OPEN_FILES)?;
        limit(Resource::Fsize, 0)?;
        limit(Resource::Core, 0)?;
        // Who loops is waited for; who takes memory may need more than a second to get at it.
        let is_to_loop = self.fault.as_deref() == Some("loop");
        allow_time(if is_to_loop { 1 } else { SECONDS })?;
        let path = Path::new(&opening.path);
        restrict_to(path)?;
        self.misbehave(path);
        let opened = match &opening.raw {
            Some(layout) => {
                let layout = format::raw::RawSpec::parse(layout);
                let layout = layout.map_err(|problem| io::Error::other(problem.to_string()))?;
                format::raw::open(path, &layout, &opening.limits)
            }
            None => format::open(path, &opening.wanted, &opening.limits),
        };
        let source = match opened {
            Ok(source) => source,
            Err(error) => return put_failed(out, error),
        };
        let opened = Opened {
            header: source.header().clone(),
            reads_parts: source.reads_parts(),
            reads_whole_rows: source.reads_whole_rows(),
        };
        put(out, &Answer::Opened(Box::new(opened)))?;
        while let Some(asking) = take::<Asking>(input)? {
            answer(source.as_ref(), asking, out)?;
        }
        Ok(())
    }

    /// What a damaged reader would do.
    fn misbehave(&self, input: &Path) {
        match self.fault.as_deref() {
            Some("loop") => loop {
                std::hint::spin_loop();
            },
            Some("allocate") => {
                // Address space alone: to touch pages takes processor time.
                let mut all = Vec::new();
                loop {
                    all.push(std::hint::black_box(Vec::<u8>::with_capacity(64 << 20)));
                }
            }
            Some("read") if std::env::current_exe().and_then(File::open).is_ok() => abort(),
            Some("write") if File::options().append(true).open(input).is_ok() => abort(),
            _ => {}
        }
    }
}

fn answer(source: &dyn Source, asking: Asking, out: &mut impl Write) -> io::Result<()> {
    let Asking { pick, region, what } = asking;
    let voxels: u64 = (0..3)
        .map(|k| u64::from(region.max[k].saturating_sub(region.min[k])))
        .product();
    let mib = voxels.saturating_mul(source.header().stored.bytes() as u64) >> 20;
    allow_time(SECONDS.saturating_add(mib.saturating_mul(SECONDS_PER_MIB)))?;
    match what {
        What::Piece => match source.read(pick, region) {
            Ok(piece) => put_piece(out, &piece),
            Err(error) => put_failed(out, error),
        },
        What::Slabs(slices) => {
            let mut written = Ok(());
            let read = source.read_slabs(pick, region, slices, &mut |_, piece| {
                written = put_piece(out, &piece);
                match written {
                    Ok(()) => ControlFlow::Continue(()),
                    Err(_) => ControlFlow::Break(()),
                }
            });
            written?;
            match read {
                Ok(()) => put(out, &Answer::End),
                Err(error) => put_failed(out, error),
            }
        }
        What::Bytes => match source.read_bytes(pick, region) {
            Ok(Some(bytes)) => {
                put(out, &Answer::Bytes(Some(bytes.len() as u64)))?;
                out.write_all(&bytes)?;
                out.flush()
            }
            Ok(None) => put(out, &Answer::Bytes(None)),
            Err(error) => put_failed(out, error),
        },
    }
}

fn limit(resource: Resource, most: u64) -> io::Result<()> {
    let most = match getrlimit(resource).maximum {
        Some(there) => most.min(there),
        None => most,
    };
    let both = Rlimit {
        current: Some(most),
        maximum: Some(most),
    };
    Ok(setrlimit(resource, both)?)
}

/// So many seconds of processor time from now on; the system ends the process after that.
fn allow_time(seconds: u64) -> io::Result<()> {
    let used = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    let used = Duration::new(used.tv_sec as u64, 0).as_secs() + 1;
    let maximum = getrlimit(Resource::Cpu).maximum;
    let wanted = used.saturating_add(seconds);
    let limit = Rlimit {
        current: Some(maximum.map_or(wanted, |there| wanted.min(there))),
        maximum,
    };
    Ok(setrlimit(Resource::Cpu, limit)?)
}
