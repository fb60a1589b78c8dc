//! The small volumes that pairs show, as files in a folder.

use crate::person::Folder;
use std::fmt::Write as _;

/// What is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Input {
    /// The built-in head.
    Head,
    /// Three channels of one place.
    Cells,
    /// Variables of the weather at two times.
    Storm,
    /// Variables of the weather at a place of the Earth.
    Earth,
    /// Three numbers a voxel that are a colour.
    Colors,
    /// Rows of x, y, z and a value.
    Points,
}

/// Every input; those that show most come first.
pub const ALL: &[Input] = &[
    Input::Head,
    Input::Cells,
    Input::Storm,
    Input::Earth,
    Input::Colors,
    Input::Points,
];

/// Those with voxels.
pub const VOLUMES: &[Input] = ALL.split_at(5).0;

impl Input {
    /// What the command line calls it, of a file that is drawn brick by brick the form that can be.
    pub fn words(self, is_streamed: bool) -> &'static str {
        match (self, is_streamed) {
            (Self::Head, false) => "phantom:head,n=20",
            (Self::Head, true) => "head.svb",
            (Self::Cells, false) => "phantom:cells,n=12",
            (Self::Cells, true) => "cells.svb",
            (Self::Storm, _) => "phantom:storm,n=12,times=2 --variable vapor",
            (Self::Earth, _) => "earth.nc --variable pot",
            (Self::Colors, _) => "colors.nrrd",
            (Self::Points, _) => "points.csv",
        }
    }

    /// Words of a feature as this input takes them: its place in the world, and lengths there.
    pub fn fill(self, words: &str) -> String {
        let (place, clip, thick, window) = match self {
            Self::Head => ("", "1,0,0,0", "60", "-200,500"),
            Self::Cells => ("", "1,0,0,0", "30", "0,0.5"),
            Self::Storm => ("", "1,0,0,0", "6", "0,5"),
            Self::Earth => ("-earth", "1,0,0,480", "40", "295,315"),
            Self::Colors => ("", "1,0,0,0", "60", "0,100"),
            Self::Points => ("", "1,0,0,0", "60", "10,50"),
        };
        [
            ("{place}", place),
            ("{clip}", clip),
            ("{thick}", thick),
            ("{window}", window),
            (
                "{ground}",
                if self == Self::Earth {
                    "pot"
                } else {
                    "temperature"
                },
            ),
        ]
        .iter()
        .fold(words.to_owned(), |words, (name, value)| {
            words.replace(name, value)
        })
    }
}

/// Writes the files that inputs and features name.
pub fn write(folder: &Folder) {
    for words in [
        "phantom:head,n=20 -o head.svb",
        "phantom:cells,n=12 -o cells.svb",
    ] {
        folder.run(&format!("convert {words}")).assert_done();
    }
    let earth = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/fixtures/netcdf/theta.nc"
    );
    std::fs::copy(earth, folder.path("earth.nc")).expect("a file");
    // Around the middle of all other volumes, and around that of the piece of the Earth.
    for (place, center, side) in [
        ("", [0.0; 3], 240.0),
        ("-earth", [519.0, 5727.0, 42.0], 500.0),
    ] {
        let labels = |[x, y, z]: [i32; 3]| match x * x + y * y + z * z {
            far if far > 36 => [0],
            _ => [if x < 0 { 1 } else { 2 }],
        };
        folder.file(&format!("labels{place}.nrrd"), nrrd(center, side, labels));
        let other = |[x, y, z]: [i32; 3]| {
            let distance = f64::from(x * x + y * y + z * z).sqrt();
            [(60.0 * (11.0 - distance)).clamp(0.0, 255.0) as u8]
        };
        // On a grid of its own: no voxel of it is one of another volume.
        let other = nrrd(center.map(|c| c + 3.0), side, other);
        folder.file(&format!("other{place}.nrrd"), other);
        folder.file(&format!("bar{place}.stl"), bar(center, side));
    }
    let colors = |[x, y, z]: [i32; 3]| {
        let distance = f64::from(x * x + y * y + z * z).sqrt();
        let bright = (40.0 * (9.0 - distance)).clamp(0.0, 255.0);
        let part = |n: i32| (bright * f64::from(n + SIDE / 2) / f64::from(SIDE)) as u8;
        [bright as u8, part(x), part(y)]
    };
    folder.file("colors.nrrd", nrrd([0.0; 3], 240.0, colors));
    let mut rows = "x,y,z,strength\n".to_owned();
    for i in 0..60 {
        let t = f64::from(i);
        let [x, y] = [(0.3 * t).cos() * t, (0.3 * t).sin() * t];
        writeln!(rows, "{x},{y},{},{t}", 0.5 * t - 15.0).expect("text");
    }
    folder.file("points.csv", rows);
}

/// A prism that goes through a cube along x and out at both sides, and no plane of it along the axes.
fn bar([x, y, z]: [f64; 3], side: f64) -> String {
    let corner = |k: usize| {
        let end = if k < 3 { -0.75 } else { 0.75 } * side;
        let [across, up] = [[0.06, 0.01], [-0.05, 0.04], [-0.02, -0.06]][k % 3];
        format!("vertex {} {} {}", x + end, y + across * side, z + up * side)
    };
    let sides = [
        [0, 1, 4],
        [0, 4, 3],
        [1, 2, 5],
        [1, 5, 4],
        [2, 0, 3],
        [2, 3, 5],
    ];
    let mut text = "solid bar\n".to_owned();
    for side in sides {
        let corners = side.map(corner).join("\n");
        writeln!(
            text,
            "facet normal 0 0 0\nouter loop\n{corners}\nendloop\nendfacet"
        )
        .expect("text");
    }
    text + "endsolid bar\n"
}

const SIDE: i32 = 20;

/// A cube of voxels of so many bytes, counted from its middle.
fn nrrd<const N: usize>(
    center: [f64; 3],
    side: f64,
    voxel: impl Fn([i32; 3]) -> [u8; N],
) -> Vec<u8> {
    let spacing = side / f64::from(SIDE);
    let [x, y, z] = center.map(|c| c + 0.5 * (spacing - side));
    let (dimension, first, kinds, none) = match N {
        1 => (3, "", "domain domain domain", ""),
        _ => (4, "3 ", "RGB-color domain domain domain", "none "),
    };
    let header = format!(
        "NRRD0004\ntype: uchar\ndimension: {dimension}\nsizes: {first}{SIDE} {SIDE} {SIDE}\nkinds: {kinds}\n\
         encoding: raw\nspace: right-anterior-superior\n\
         space directions: {none}({spacing},0,0) (0,{spacing},0) (0,0,{spacing})\nspace origin: ({x},{y},{z})\n\n"
    );
    let mut bytes = header.into_bytes();
    let of_middle = |i: i32| i - SIDE / 2;
    let rows = (0..SIDE).flat_map(|z| (0..SIDE).map(move |y| [y, z]));
    for [y, z] in rows {
        for x in 0..SIDE {
            bytes.extend(voxel([x, y, z].map(of_middle)));
        }
    }
    bytes
}
