//! `info` for a person: exact text, and nothing that a file says can steer the terminal.

use crate::person::Folder;

/// What is said of a small file, to the letter.
#[test]
fn info_says_all_of_a_small_file_in_groups() {
    let folder = Folder::new();
    let header = "NRRD0004\ntype: short\ndimension: 3\nsizes: 4 2 1\nencoding: raw\nendian: little\n\
        space: left-posterior-superior\nspace directions: (0.5,0,0) (0,0.75,0) (0,0,2.5)\n\
        space origin: (0,0,0)\n\n";
    let mut bytes = header.as_bytes().to_vec();
    bytes.extend(
        [-1000_i16, -1000, -1000, -1000, 0, 40, 60, 1000]
            .iter()
            .flat_map(|n| n.to_le_bytes()),
    );
    folder.file("a.nrrd", bytes);
    let ran = folder.run("info a.nrrd");
    ran.assert_done();
    let wanted = "\
format       nrrd
dims         4 x 2 x 1 = 8 voxels of i16

extent       2 x 1.5 x 2.5
spacing      0.5 x 0.75 x 2.5
orientation  x left, y posterior, z superior
world                -0.5           0           0           0   from voxel centres
                        0       -0.75           0           0
                        0           0         2.5           0

values       -1000 to 1000, mean -362.5
             |█                      ▄▄▄                     ▄|

drawn as     the values are Hounsfield units: bone, and faint skin
seen from    azimuth 60, elevation 15 degrees
to draw      16 bytes of memory, 16 bytes of the device's, 256 bytes by rays on llvmpipe
";
    assert_eq!(ran.out, wanted, "{}", ran.out);
}

#[test]
fn levels_and_what_corners_take_are_told() {
    let folder = Folder::new();
    folder
        .run("convert phantom:sphere,n=121 -o a.svb --type u8")
        .assert_done();
    let ran = folder.run("info a.svb");
    for line in [
        "levels       2, each next with half as many voxels along each axis: --level N\n",
        // 121^3 voxels of one byte, of two on the device, or 44 x 44 x 124 texels of 16 bytes, of 3 x 3 new voxels
        // each.
        "to draw      1.7 MiB of memory, 3.4 MiB of the device's, 3.7 MiB by rays on llvmpipe\n",
    ] {
        assert!(ran.out.contains(line), "no {line:?} in {}", ran.out);
    }
    let ran = folder.run("info a.svb --level 1");
    let note = ran
        .out
        .lines()
        .find(|line| line.contains("root mean square"));
    let note = note.expect("a note");
    assert!(
        !note.contains('e') || !note.contains("e-") && !note.contains("e1"),
        "{note}"
    );
}

#[test]
fn of_several_variables_it_is_said_whose_numbers_these_are() {
    let folder = Folder::new();
    let ran = folder.run("info phantom:storm,n=16");
    ran.assert_done();
    let first = "variable     cloud: all numbers here are its own; 5 more below\n";
    assert!(ran.out.contains(first), "{}", ran.out);
    assert!(
        ran.out.contains("times        8, 0 h to 24 h\n"),
        "{}",
        ran.out
    );
    for line in [
        "variables    cloud            16 x 16 x 6, f32, 8 times, g kg-1, Cloud water and ice\n",
        "             temperature      16 x 16 x 6, f32, 8 times, K, Temperature\n",
        "seen from    azimuth -60, elevation 25 degrees\n",
        "             --variable NAME takes one\n",
    ] {
        assert!(ran.out.contains(line), "no {line:?} in {}", ran.out);
    }
    let ran = folder.run("info phantom:storm,n=16 --variable temperature");
    assert!(
        ran.out.contains("variable     temperature: all numbers"),
        "{}",
        ran.out
    );
}

#[test]
fn voxels_without_data_are_counted_and_a_volume_of_none_has_no_values() {
    let folder = Folder::new();
    let numbers = |numbers: [f32; 4]| {
        numbers
            .iter()
            .flat_map(|n| n.to_le_bytes())
            .collect::<Vec<_>>()
    };
    folder.file("a.bin", numbers([1.0, f32::NAN, 2.0, f32::INFINITY]));
    let ran = folder.run("info a.bin --raw 2x2x1,f32");
    ran.assert_done();
    assert!(
        ran.out.contains("values       1 to 2, mean 1.5\n"),
        "{}",
        ran.out
    );
    assert!(ran.out.contains("not finite   2 voxels\n"), "{}", ran.out);
    folder.file("b.bin", numbers([f32::NAN; 4]));
    let ran = folder.run("info b.bin --raw 2x2x1,f32");
    ran.assert_done();
    assert!(ran.out.contains("values       none\n"), "{}", ran.out);
}

#[test]
fn a_name_in_a_file_cannot_steer_the_terminal() {
    let folder = Folder::new();
    let header = "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 1 1 2\nencoding: raw\n\
        sample units: \"\u{1b}[2Jdeg\"\n\n";
    let mut bytes = header.as_bytes().to_vec();
    bytes.extend([1, 2]);
    folder.file("a.nrrd", bytes);
    for words in ["info a.nrrd", "info a.nrrd --json"] {
        let ran = folder.run(words);
        assert!(
            !ran.out.contains('\u{1b}') && !ran.err.contains('\u{1b}'),
            "{ran:?}"
        );
    }
}

#[test]
fn what_is_drawn_and_from_where_is_that_of_the_look() {
    let folder = Folder::new();
    let volume = |name: &str, z: usize, space: &str, voxel: fn(usize) -> u16| {
        let mut bytes = format!(
            "NRRD0004\ntype: ushort\ndimension: 3\nsizes: 24 24 {z}\n{space}encoding: raw\nendian: little\n\n"
        )
        .into_bytes();
        bytes.extend((0..24 * 24 * z).flat_map(|i| voxel(i).to_le_bytes()));
        folder.file(name, bytes);
        let ran = folder.run(&format!("info {name}"));
        ran.assert_done();
        ran.out
    };
    // Hounsfield units and 1024: air, tissue and a little bone, with noise so that they are no labels.
    let ct = |i: usize| {
        let noise = (i * 7919 % 61) as u16;
        match i % 24 {
            0..12 => noise,
            12..22 => 1040 + noise,
            _ => 1900 + noise,
        }
    };
    let said = volume("ct.nrrd", 24, "", ct);
    let drawn = "drawn as     the values are Hounsfield units: bone, and faint skin\n";
    assert!(said.contains(drawn), "{said}");
    let six =
        "seen from    azimuth 60, elevation 15 degrees, or another of six sides that shows more\n";
    assert!(said.contains(six), "{said}");
    let ras = "space: right-anterior-superior\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n";
    let said = volume("patient.nrrd", 24, ras, ct);
    let usual = "seen from    azimuth 60, elevation 15 degrees\n";
    assert!(said.contains(usual), "{said}");
    // A slab: as `render` says it, --view superior or inferior.
    for (name, space, side) in [("slab.nrrd", "", 90), ("axial.nrrd", ras, -90)] {
        let said = volume(name, 4, space, ct);
        let line = said.lines().find(|line| line.starts_with("seen from"));
        let line = line.expect("a side");
        assert!(
            line.ends_with(&format!(", elevation {side} degrees")),
            "{said}"
        );
        let view = if side > 0 { "superior" } else { "inferior" };
        let ran = folder.run(&format!("render {name} --size 16x16 --force -o a.png"));
        assert!(ran.err.contains(&format!("--view {view} ")), "{ran:?}");
    }
    // Matter that is nobody's tissue has other colours than tissue.
    let matter = |i: usize| {
        let noise = (i * 7919 % 13) as u16;
        if i % 24 < 12 { noise } else { 150 + noise }
    };
    let said = volume("matter.nrrd", 24, "", matter);
    assert!(
        said.contains("dark background, in the colours of cividis\n"),
        "{said}"
    );
    let said = volume("tissue.nrrd", 24, ras, matter);
    assert!(said.contains("dark background\n"), "{said}");
}
