//! Files of bricks whose writing was stopped: gone on with from any row, after any damage, they are byte for byte those
//! of one run, and no reader takes them for whole before.
#![cfg(feature = "files")]

use crate::files;

use files::{Folder, message};
use glam::DAffine3;
use std::io::{self, Cursor};
use std::path::Path;
use stratavox::format;
use stratavox::format::write::{DoneBricks, NumberType, Selection, Written, write_bricks};
use stratavox::volume::{
    Format, Header, Limits, Piece, ReadError, Source, TimeComponent, VolumeSelection, VoxelBox,
    VoxelType, Voxels,
};

/// Numbers of a formula with holes, two times and two components.
struct Made(Header);

impl Made {
    fn new() -> Self {
        let dims = [131, 125, 7];
        let mut header = Header::new(Format::Raw, dims, VoxelType::F32, DAffine3::IDENTITY);
        (header.times, header.components) = (2, 2);
        Self(header)
    }
}

impl Source for Made {
    fn path(&self) -> &Path {
        Path::new("made")
    }

    fn header(&self) -> &Header {
        &self.0
    }

    fn read(&self, pick: TimeComponent, region: VoxelBox) -> Result<Piece, ReadError> {
        let ([x0, y0, z0], [x1, y1, z1]) = (region.min, region.max);
        let mut all = Vec::new();
        for (z, y) in (z0..z1).flat_map(|z| (y0..y1).map(move |y| (z, y))) {
            all.extend((x0..x1).map(|x| {
                let n = x * 3 + y * 7 + z * 31 + 11 * pick.time + 5 * pick.component;
                // A hole, one number beyond the ends of the type, and a flat part.
                match (n % 997, pick.component) {
                    (5, 0) => f32::NAN,
                    (6, _) => 1e9,
                    (_, 1) => 4.0,
                    _ => (n % 251) as f32 * 0.37,
                }
            }));
        }
        Ok(Voxels::F32(all).into())
    }
}

/// Goes on with `file` from `lines`, stopped behind `rows` more rows.
fn gone_on(
    file: &mut Vec<u8>,
    lines: &mut Vec<String>,
    rows: usize,
    numbers: NumberType,
) -> Option<Written> {
    let made = Made::new();
    let mut out = Cursor::new(std::mem::take(file));
    let done = DoneBricks::read(lines.iter().map(String::as_str), &mut out).expect("readable");
    lines.truncate(done.rows());
    out.get_mut().truncate(done.end_bytes() as usize);
    let begun = lines.len();
    let mut note = |line: &str| {
        lines.push(line.to_owned());
        match lines.len() - begun < rows {
            true => Ok(()),
            false => Err(io::Error::other("a kill")),
        }
    };
    let all = Selection::all(&made.0);
    let mut told = Vec::new();
    let mut say = |done: usize, of: usize| told.push((done, of));
    let outcome = write_bricks(&made, &all, numbers, &mut out, done, &mut note, &mut say);
    assert!(told.is_sorted() && told.iter().all(|&(done, of)| done <= of && of == 20));
    *file = out.into_inner();
    outcome.ok()
}

fn whole(numbers: NumberType) -> (Vec<u8>, Vec<String>, Written) {
    let (mut file, mut lines) = (Vec::new(), Vec::new());
    let written = gone_on(&mut file, &mut lines, usize::MAX, numbers).expect("written");
    (file, lines, written)
}

#[test]
fn a_file_stopped_behind_any_row_ends_as_that_of_one_run() {
    for numbers in [NumberType::Stored, NumberType::Values(VoxelType::U8)] {
        let (wanted, all, said) = whole(numbers);
        assert_eq!(all.len(), 12, "rows of two levels");
        assert_eq!(said.notes.is_empty(), numbers == NumberType::Stored);
        let every = if numbers == NumberType::Stored { 1 } else { 5 };
        for rows in (1..=all.len()).step_by(every) {
            let (mut file, mut lines) = (Vec::new(), Vec::new());
            assert!(gone_on(&mut file, &mut lines, rows, numbers).is_none());
            assert_eq!(lines.len(), rows);
            // What a kill leaves: a brick that is not noted, and a line that is torn.
            file.extend([7; 99]);
            lines.push(all.last().expect("a line")[..40].to_owned());
            let written = gone_on(&mut file, &mut lines, usize::MAX, numbers);
            assert_eq!(written.as_ref(), Some(&said), "{rows} rows");
            assert!(file == wanted && lines == all, "{rows} rows");
        }
        // Stopped again and again, and once all is there but for its name.
        let (mut file, mut lines) = (Vec::new(), Vec::new());
        let mut ended = None;
        while ended.is_none() {
            ended = gone_on(&mut file, &mut lines, 2, numbers).filter(|_| lines.len() == 12);
        }
        assert!(file == wanted);
        let written = gone_on(&mut file, &mut lines, usize::MAX, numbers);
        assert!(written.as_ref() == Some(&said) && file == wanted);
    }
}

#[test]
fn bricks_that_are_not_as_they_were_written_are_written_again() {
    let (wanted, all, _) = whole(NumberType::Stored);
    let bricks_end = {
        let mut file = Cursor::new(wanted.clone());
        let done = DoneBricks::read(all.iter().map(String::as_str), &mut file).expect("readable");
        assert_eq!((done.rows(), done.count()), (12, 20));
        done.end_bytes() as usize
    };
    for at in (32..bricks_end).step_by(bricks_end / 23) {
        let mut changed = wanted.clone();
        changed[at] ^= 0x10;
        let cut = wanted[..at].to_vec();
        for mut file in [changed, cut] {
            let mut lines = all.clone();
            let written = gone_on(&mut file, &mut lines, usize::MAX, NumberType::Stored);
            assert!(
                written.is_some() && file == wanted && lines == all,
                "byte {at}"
            );
        }
    }
    // Of a line that is missing in the middle, nothing behind it counts.
    let mut lines = all.clone();
    lines.remove(4);
    let mut file = wanted.clone();
    gone_on(&mut file, &mut lines, usize::MAX, NumberType::Stored).expect("written");
    assert!(file == wanted);
}

#[test]
fn an_unfinished_file_is_read_by_nobody() {
    let folder = Folder::new();
    let (wanted, all, _) = whole(NumberType::Stored);
    for rows in 1..=all.len() {
        let (mut file, mut lines) = (Vec::new(), Vec::new());
        gone_on(&mut file, &mut lines, rows, NumberType::Stored);
        let path = folder.write("a.svb", &file);
        let error = format::open(&path, &VolumeSelection::default(), &Limits::default()).err();
        let said = message(&error.expect("refused"));
        assert!(said.contains("was stopped"), "{said}");
    }
    // The front says where the index is, and the index is not there in full.
    for end in [33, wanted.len() / 2, wanted.len() - 1] {
        let path = folder.write("a.svb", &wanted[..end]);
        assert!(format::open(&path, &VolumeSelection::default(), &Limits::default()).is_err());
    }
}
