//! All that a case has given to a device and got from it, in a folder of its own.
//!
//! ```text
//! DIR/NAME/commands.txt           what was asked of the device, in order
//!          SHADER.spv             a shader as the device got it
//!          SHADER.wgsl            the text that it was compiled from
//!          0007.BUFFER.write.bin  bytes that the host wrote before command 7; parameters are among them
//!          0031.BUFFER.read.bin   bytes that the host read: numbers, pixels
//!          expected.npy found.npy difference.npy    of pictures, premultiplied
//!          record.json            what is said of the case, and its command line
//! ```
//!
//! The folder is called `NAME.unfinished` until all of it is there: a case that ends its process leaves that.

mod wgsl;

pub use wgsl::wgsl;

use super::measurement::Pictures;
use super::record::Record;
use super::worker::picture_files;
use crate::gpu::recorder::{Event, listen};
use crate::picture::write_file;
use std::collections::BTreeSet;
use std::fmt::Write;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// Where the dump of a case lies.
pub fn folder_of(dumps: &Path, case: &str) -> PathBuf {
    dumps.join(case)
}

/// Runs `judge` and writes what passes meanwhile into the folder of the case, in place of what is there.
///
/// # Errors
/// Where a file cannot be written.
pub fn dumped(
    dumps: &Path,
    case: &str,
    judge: impl FnOnce() -> (Record, Option<Pictures>),
) -> io::Result<(Record, Option<Pictures>)> {
    let unfinished = dumps.join(format!("{case}.unfinished"));
    remove(&unfinished)?;
    fs::create_dir_all(&unfinished)?;
    let files = Files {
        folder: unfinished.clone(),
        commands: String::new(),
        count: 0,
        shaders: BTreeSet::new(),
        problem: None,
    };
    let files = Arc::new(Mutex::new(files));
    let heard = Arc::clone(&files);
    listen(Some(Box::new(move |event| {
        let mut files = heard.lock().unwrap_or_else(PoisonError::into_inner);
        if files.problem.is_none() {
            files.problem = files.hear(event).err();
        }
    })));
    let (record, pictures) = judge();
    listen(None);
    let mut files = files.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(problem) = files.problem.take() {
        return Err(problem);
    }
    files.write("commands.txt", files.commands.as_bytes())?;
    let text = serde_json::to_string_pretty(&record)?;
    files.write("record.json", format!("{text}\n").as_bytes())?;
    if let Some(pictures) = &pictures {
        picture_files(pictures, |what| unfinished.join(format!("{what}.npy")))?;
    }
    let folder = folder_of(dumps, case);
    remove(&folder)?;
    fs::rename(&unfinished, folder)?;
    Ok((record, pictures))
}

fn remove(folder: &Path) -> io::Result<()> {
    match fs::remove_dir_all(folder) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}

struct Files {
    folder: PathBuf,
    commands: String,
    count: u32,
    shaders: BTreeSet<String>,
    problem: Option<io::Error>,
}

impl Files {
    fn write(&self, name: &str, bytes: &[u8]) -> io::Result<()> {
        write_file(&self.folder.join(name), bytes, true).map_err(io::Error::other)
    }

    fn hear(&mut self, event: &Event<'_>) -> io::Result<()> {
        let n = self.count;
        self.count += 1;
        let line = match *event {
            Event::Shader { shader, words } => {
                let name = file_name(shader.name);
                if self.shaders.insert(name.clone()) {
                    self.write(&format!("{name}.spv"), bytemuck::cast_slice(words))?;
                    let text = wgsl(shader.name).unwrap_or_default();
                    self.write(&format!("{name}.wgsl"), text.as_bytes())?;
                }
                let slots = shader.bindings.iter();
                let slots =
                    slots.map(|slot| format!("{} {:?} {}", slot.binding, slot.kind, slot.name));
                let slots: Vec<String> = slots.collect();
                let constants = shader.constants.iter();
                let constants = constants.map(|(id, value)| format!(" {id}={value}"));
                let constants: String = constants.collect();
                format!(
                    "load {} ({}) constants{constants}",
                    shader.name,
                    slots.join(", ")
                )
            }
            Event::Written {
                buffer,
                offset,
                bytes,
            } => self.bytes(n, "write", buffer, offset, bytes)?,
            Event::Read {
                buffer,
                offset,
                bytes,
            } => self.bytes(n, "read", buffer, offset, bytes)?,
            Event::Dispatch {
                shader,
                base,
                groups,
            } => format!("dispatch {shader}: {groups:?} workgroups from {base:?}"),
            Event::DispatchIndirect { shader, buffer } => {
                format!("dispatch {shader}: as many workgroups as `{buffer}` says")
            }
            Event::Draw {
                shader,
                vertices,
                instances: [first, end],
            } => format!("draw {shader}: {vertices} vertices of instances {first} to {end}"),
            Event::DrawIndirect { shader, buffer } => {
                format!("draw {shader}: as much as `{buffer}` says")
            }
            Event::Submitted => "submitted, and done".to_owned(),
        };
        let _ = writeln!(self.commands, "{n:04} {line}");
        Ok(())
    }

    fn bytes(
        &self,
        n: u32,
        verb: &str,
        buffer: &str,
        offset: u64,
        bytes: &[u8],
    ) -> io::Result<String> {
        let name = format!("{n:04}.{}.{verb}.bin", file_name(buffer));
        self.write(&name, bytes)?;
        let count = bytes.len();
        Ok(format!(
            "{verb} `{buffer}`: {count} bytes from byte {offset}, {name}"
        ))
    }
}

/// A name without what file systems take for their own.
fn file_name(name: &str) -> String {
    let is_kept = |c: char| c.is_ascii_alphanumeric() || "._-".contains(c);
    let kept = name.chars().map(|c| if is_kept(c) { c } else { '_' });
    kept.collect()
}
