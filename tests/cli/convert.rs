//! A volume in another format is the same volume: numbers, place, meaning. What gets lost is said.

use crate::person::{Folder, assert_begins};
use std::path::Path;
use stratavox::{
    format,
    volume::{
        ComponentKind, Header, Limits, Source, TimeComponent, VolumeSelection, VoxelType, Voxels,
    },
};

const ENDINGS: [&str; 5] = ["nrrd", "mha", "nii", "nii.gz", "npy"];

/// Those that this program reads again.
const READ_AGAIN: [&str; 4] = ["nrrd", "mha", "nii", "nii.gz"];

fn open(path: &Path) -> Box<dyn Source> {
    format::open(path, &VolumeSelection::default(), &Limits::default())
        .unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// All numbers after rescale, times slowest.
fn values(source: &dyn Source) -> Vec<f64> {
    let header = source.header();
    let mut all = Vec::new();
    for time in 0..header.times {
        for component in 0..header.components {
            let piece = source
                .read(TimeComponent { time, component }, header.whole())
                .expect("voxels");
            all.extend((0..piece.voxels.len()).map(|i| {
                f64::from(piece.voxels.stored(i)) * header.rescale.slope + header.rescale.intercept
            }));
        }
    }
    all
}

/// Fails unless voxels lie in the same places, to a millionth of the volume's distance from the origin.
#[track_caller]
fn assert_same_place(found: &Header, wanted: &Header, what: &str) {
    let corners = [[0.0; 3], wanted.dims.map(f64::from)].map(glam::DVec3::from_array);
    for corner in corners {
        let wanted = wanted.world_from_voxel.transform_point3(corner);
        let found = found.world_from_voxel.transform_point3(corner);
        let limit = 1e-6 * wanted.length().max(1.0);
        assert!(
            found.distance(wanted) <= limit,
            "{what}: {found}, not {wanted}"
        );
    }
}

/// A volume of two times of i16 that lies askew, with a rescale.
pub fn askew(folder: &Folder) -> std::path::PathBuf {
    let head = "ObjectType = Image\nNDims = 4\nDimSize = 4 3 2 2\nElementType = MET_SHORT\n\
        BinaryDataByteOrderMSB = True\nTransformMatrix = 0.8 0.6 0 0 -0.6 0.8 0 0 0 0.1 0.99 0 0 0 0 1\n\
        Offset = 10 -20 30.5 0\nElementSpacing = 1.5 2 2.5 1\nElementToIntensityFunctionSlope = 0.5\n\
        ElementToIntensityFunctionOffset = -7\nElementDataFile = LOCAL\n";
    let numbers = (0..48_i16).flat_map(|n| (n * 601 - 9000).to_be_bytes());
    folder.file(
        "askew.mha",
        [head.as_bytes(), &numbers.collect::<Vec<_>>()].concat(),
    )
}

#[test]
fn every_format_that_is_written_reads_back_as_the_same_volume() {
    let folder = Folder::new();
    let path = askew(&folder);
    let before = open(&path);
    let mut compared = 0;
    for ending in READ_AGAIN {
        let ran = folder.run(&format!("convert askew.mha -o out.{ending}"));
        ran.assert_done();
        let after = open(&folder.path(&format!("out.{ending}")));
        let (wanted, found) = (before.header(), after.header());
        assert_eq!(
            (found.dims, found.times),
            (wanted.dims, wanted.times),
            "{ending}"
        );
        assert_same_place(found, wanted, ending);
        assert_eq!(values(after.as_ref()), values(before.as_ref()), "{ending}");
        let keeps_rescale = ending != "nrrd";
        let stored = if keeps_rescale {
            VoxelType::I16
        } else {
            VoxelType::F32
        };
        assert_eq!(found.stored, stored, "{ending}");
        assert_eq!(
            ran.err.contains("values are written, as f32"),
            !keeps_rescale,
            "{}",
            ran.err
        );
        compared += 1;
    }
    assert_eq!(compared, 4);
}

#[test]
fn a_chain_through_all_formats_ends_where_it_began() {
    let folder = Folder::new();
    folder
        .run("convert phantom:head,n=16,type=i16 -o bad.nrrd")
        .assert_refused(3, &["i16"]);
    let mut words = "phantom:head,n=16,type=u16".to_owned();
    for (step, ending) in ["nrrd", "mha", "nii.gz", "nrrd", "nii", "mha"]
        .iter()
        .enumerate()
    {
        let name = format!("{step}.{ending}");
        folder
            .run(&format!("convert {words} -o {name}"))
            .assert_done();
        words = name;
    }
    folder
        .run("convert phantom:head,n=16,type=u16 -o again.mha")
        .assert_done();
    let (first, last) = (open(&folder.path("again.mha")), open(&folder.path("5.mha")));
    assert_eq!(values(last.as_ref()), values(first.as_ref()));
    assert_same_place(last.header(), first.header(), "the chain");
}

#[test]
fn every_stored_type_keeps_its_type_and_every_number_of_it() {
    let folder = Folder::new();
    let mut compared = 0;
    for (word, bytes) in [
        ("u8", vec![0, 255, 7, 1]),
        ("i8", vec![0, 128, 127, 255]),
        (
            "u16",
            [0_u16, 65_535, 256, 1].map(u16::to_le_bytes).concat(),
        ),
        (
            "i16",
            [0_i16, -32_768, 32_767, -1].map(i16::to_le_bytes).concat(),
        ),
        (
            "u32",
            [0_u32, u32::MAX, 16_777_217, 1]
                .map(u32::to_le_bytes)
                .concat(),
        ),
        (
            "i32",
            [0_i32, i32::MIN, i32::MAX, -1]
                .map(i32::to_le_bytes)
                .concat(),
        ),
        (
            "u64",
            [0_u64, u64::MAX, 1 << 53 | 1, 1]
                .map(u64::to_le_bytes)
                .concat(),
        ),
        (
            "i64",
            [0_i64, i64::MIN, i64::MAX, -1]
                .map(i64::to_le_bytes)
                .concat(),
        ),
        (
            "f32",
            [0.1_f32, f32::MAX, -1e-40, f32::INFINITY]
                .map(f32::to_le_bytes)
                .concat(),
        ),
        (
            "f64",
            [0.1_f64, f64::MAX, -1e-300, 1.0 / 3.0]
                .map(f64::to_le_bytes)
                .concat(),
        ),
    ] {
        folder.file("in.raw", &bytes);
        let raw = format!("--raw 2x2x1,{word},1x2x3,le");
        for ending in ENDINGS {
            let ran = folder.run(&format!(
                "convert in.raw {raw} -o out.{ending} --uncompressed --force"
            ));
            ran.assert_done();
            for word in ["rounded", "kept as f32"] {
                assert!(!ran.err.contains(word), "{word} {ending}: {}", ran.err);
            }
            let path = folder.path(&format!("out.{ending}"));
            if ending == "npy" {
                let file = std::fs::read(&path).expect("a file");
                assert!(file.ends_with(&bytes), "{word}: {file:?}");
                continue;
            }
            let source = open(&path);
            assert_eq!(source.header().stored.name(), word, "{ending}");
            let found = match source.read_bytes(TimeComponent::default(), source.header().whole()) {
                Ok(Some(found)) => found,
                other => panic!("{word} {ending}: {other:?}"),
            };
            assert_eq!(found, bytes, "{word} {ending}");
            compared += 1;
        }
    }
    assert_eq!(compared, 40);
}

#[test]
fn colors_stay_side_by_side_and_one_component_can_be_taken() {
    let folder = Folder::new();
    let head = "NRRD0004\ntype: uint8\ndimension: 4\nspace: right-anterior-superior\nsizes: 3 2 2 1\n\
        space directions: none (1,0,0) (0,1,0) (0,0,1)\nkinds: RGB-color domain domain domain\nencoding: raw\n\n";
    let bytes: Vec<u8> = (0..12).collect();
    folder.file("in.nrrd", [head.as_bytes(), &bytes].concat());
    for ending in READ_AGAIN {
        folder
            .run(&format!("convert in.nrrd -o out.{ending}"))
            .assert_done();
        let source = open(&folder.path(&format!("out.{ending}")));
        assert_eq!(source.header().components, 3, "{ending}");
        // MetaImage has no word for colors.
        if ending != "mha" {
            assert_eq!(source.header().meaning, ComponentKind::Rgb, "{ending}");
        }
        for component in 0..3 {
            let pick = TimeComponent { time: 0, component };
            let piece = source.read(pick, source.header().whole()).expect("voxels");
            let c = component as u8;
            assert_eq!(
                piece.voxels,
                Voxels::U8(vec![c, c + 3, c + 6, c + 9]),
                "{ending}"
            );
        }
        folder
            .run(&format!("convert in.nrrd -o one.{ending} --component 1"))
            .assert_done();
        let source = open(&folder.path(&format!("one.{ending}")));
        assert_eq!(source.header().components, 1, "{ending}");
        assert_eq!(values(source.as_ref()), [1.0, 4.0, 7.0, 10.0], "{ending}");
        assert_eq!(source.header().meaning, ComponentKind::Numbers, "{ending}");
    }
}

#[test]
fn a_part_of_a_volume_lies_where_it_lay_in_the_whole() {
    let folder = Folder::new();
    let path = askew(&folder);
    let whole = open(&path);
    for ending in READ_AGAIN {
        folder
            .run(&format!(
                "convert askew.mha -o part.{ending} --crop 1,3,0,2,1,2 --time 1"
            ))
            .assert_done();
        let part = open(&folder.path(&format!("part.{ending}")));
        assert_eq!(
            (part.header().dims, part.header().times),
            ([2, 2, 1], 1),
            "{ending}"
        );
        let corner = glam::dvec3(1.0, 0.0, 1.0);
        let wanted = whole.header().world_from_voxel.transform_point3(corner);
        let found = part
            .header()
            .world_from_voxel
            .transform_point3(glam::DVec3::ZERO);
        assert!(
            found.distance(wanted) < 1e-4,
            "{ending}: {found}, not {wanted}"
        );
        let all = values(whole.as_ref());
        let at = |x: usize, y: usize| all[24 + 12 + 4 * y + x];
        assert_eq!(
            values(part.as_ref()),
            [at(1, 0), at(2, 0), at(1, 1), at(2, 1)],
            "{ending}"
        );
    }
}

#[test]
fn a_type_and_a_window_change_the_numbers_as_they_say() {
    let folder = Folder::new();
    folder.file(
        "in.raw",
        [-1000_i16, 0, 500, 3000].map(i16::to_le_bytes).concat(),
    );
    let convert = |words: &str| {
        let ran = folder.run(&format!(
            "convert in.raw --raw 4x1x1,i16 -o out.nrrd --force {words}"
        ));
        ran.assert_done();
        let source = open(&folder.path("out.nrrd"));
        (source.header().stored, values(source.as_ref()), ran.err)
    };
    let (stored, found, err) = convert("--type u8");
    assert_eq!(
        (stored, found),
        (VoxelType::U8, vec![0.0, 0.0, 255.0, 255.0])
    );
    assert!(err.contains("3 numbers beyond the ends of u8"), "{err}");
    let (_, found, err) = convert("--type u8 --window -1000,1000");
    assert_eq!(found, [0.0, 128.0, 191.0, 255.0]);
    assert!(!err.contains("beyond"), "{err}");
    let (stored, found, _) = convert("--type f32 --window 0,1000");
    assert_eq!((stored, found), (VoxelType::F32, vec![0.0, 0.0, 0.5, 1.0]));
    let (stored, found, _) = convert("--type f64");
    assert_eq!(
        (stored, found),
        (VoxelType::F64, vec![-1000.0, 0.0, 500.0, 3000.0])
    );
}

#[test]
fn npy_says_its_shape_and_that_it_keeps_no_place() {
    let folder = Folder::new();
    askew(&folder);
    let ran = folder.run("convert askew.mha -o out.npy");
    ran.assert_done();
    assert!(ran.err.contains("where the voxels lie"), "{}", ran.err);
    let bytes = std::fs::read(folder.path("out.npy")).expect("a file");
    let text = String::from_utf8_lossy(&bytes[10..128]);
    assert!(
        text.contains("'descr': '<f4'") && text.contains("(2, 2, 3, 4)"),
        "{text}"
    );
    assert_eq!(bytes.len(), 128 + 4 * 48);
}

#[test]
fn a_surface_is_written_by_the_ending_of_its_file_and_only_of_a_value() {
    let folder = Folder::new();
    for (name, first) in [
        ("a.ply", &b"ply\n"[..]),
        ("a.stl", b"stratavox"),
        ("a.glb", b"glTF"),
    ] {
        let words = format!("convert phantom:head,n=32 -o {name} --iso 300 --closed");
        folder.run(&words).assert_done();
        assert_begins(&folder.path(name), first);
    }
    let ran = folder.run("convert phantom:head,n=32 -o b.ply");
    ran.assert_refused(2, &["b.ply", "--iso"]);
    let ran = folder.run("convert phantom:head,n=32 -o b.nrrd --iso 300");
    ran.assert_refused(2, &["b.nrrd", ".ply"]);
    let ran = folder.run("convert phantom:head,n=32 -o b.ply --iso 1e9");
    ran.assert_done();
    assert!(ran.err.contains("the surface is empty"), "{}", ran.err);
    folder
        .run("convert phantom:head,n=32 -o a.ply --iso 300")
        .assert_refused(4, &["a.ply", "--force"]);
}
