//! `info --structure`: runs and octree of small masks to the letter, and of a real CT as another program counts them.

use crate::{person::Folder, real};
use serde_json::Value;

/// Opacity from 100 on.
const FUNCTION: &str =
    r#"{"stratavox_transfer_function":1,"color":[[0,1,1,1]],"opacity":[[100,0],[200,0.5]]}"#;

/// 4 x 4 x 4 voxels: the first eighth of the cube is full, a voxel of the fourth (addresses count from 1), and one of the eighth.
fn mask(folder: &Folder) {
    let is_full = |n: usize| {
        let [x, y, z] = [n % 4, n / 4 % 4, n / 16];
        x < 2 && y < 2 && z < 2 || [x, y, z] == [3, 3, 0] || [x, y, z] == [2, 3, 3]
    };
    let bytes: Vec<u8> = (0..64).map(|n| if is_full(n) { 200 } else { 0 }).collect();
    folder.file("mask.raw", bytes);
    folder.file("tf.json", FUNCTION);
}

const MASK: &str = "info mask.raw --raw 4x4x4,u8 --structure --tf tf.json";

#[test]
fn runs_nodes_and_addresses_of_a_small_mask_are_said() {
    let folder = Folder::new();
    mask(&folder);
    let ran = folder.run(MASK);
    ran.assert_done();
    let wanted = "
full         10 voxels, 15.6 %, whose own value has opacity (--preclassified)
runs         along x: 6 of 1.7 voxels in the mean, 116 bytes; as masks 128 bytes
             along y: 6 of 1.7 voxels in the mean, 116 bytes; as masks 128 bytes
             along z: 6 of 1.7 voxels in the mean, 116 bytes; as masks 128 bytes
octree       25 nodes of a cube of 4 voxels a side, 3 mixed, 24 bytes
             side     4            0 empty            0 full            1 mixed
             side     2            5 empty            1 full            2 mixed
             side     1           14 empty            2 full            0 mixed
full leaves  1 44 87
empty leaves 2 3 41 42 43 45 46 47 48 5 6 7 81 82 83 84 85 86 88

full         43 voxels, 67.2 %, in which --filter linear can make a value with opacity
runs         along x: 14 of 3.1 voxels in the mean, 180 bytes; as masks 128 bytes
             along y: 15 of 2.9 voxels in the mean, 188 bytes; as masks 128 bytes
             along z: 13 of 3.3 voxels in the mean, 172 bytes; as masks 128 bytes
octree       49 nodes of a cube of 4 voxels a side, 6 mixed, 48 bytes
             side     4            0 empty            0 full            1 mixed
             side     2            0 empty            3 full            5 mixed
             side     1           21 empty           19 full            0 mixed
full leaves  1 21 23 25 27 31 32 35 36 4 51 52 53 54 61 63 71 72 74 76 78 8
empty leaves 22 24 26 28 33 34 37 38 55 56 57 58 62 64 65 66 67 68 73 75 77
";
    assert!(ran.out.ends_with(wanted), "{}", ran.out);
    // Nothing of it without the word.
    let ran = folder.run("info mask.raw --raw 4x4x4,u8");
    assert!(!ran.out.contains("octree"), "{}", ran.out);
}

#[test]
fn json_says_the_same() {
    let folder = Folder::new();
    mask(&folder);
    let ran = folder.run(&format!("{MASK} --json"));
    ran.assert_done();
    let said: Value = serde_json::from_str(&ran.out).expect("JSON");
    let structure = &said["structure"];
    assert_eq!(structure["filter"], "linear");
    let before = &structure["preclassified"];
    assert_eq!(
        [&before["full"], &before["share"]],
        [&Value::from(10), &Value::from(0.15625)]
    );
    let wanted = serde_json::json!({
        "axis": "x", "runs": 6, "mean_length": 10.0 / 6.0, "bytes": 116, "mask_bytes": 128,
    });
    assert_eq!(before["runs"][0], wanted);
    let octree = serde_json::json!({
        "side": 4, "nodes": 25, "mixed": 3, "bytes": 24,
        "levels": [
            {"side": 4, "empty": 0, "full": 0, "mixed": 1},
            {"side": 2, "empty": 5, "full": 1, "mixed": 2},
            {"side": 1, "empty": 14, "full": 2, "mixed": 0},
        ],
        "leaves": {
            "full": ["1", "44", "87"],
            "empty": ["2", "3", "41", "42", "43", "45", "46", "47", "48", "5", "6", "7",
                "81", "82", "83", "84", "85", "86", "88"],
        },
    });
    assert_eq!(before["octree"], octree);
    assert_eq!(structure["postclassified"]["full"], 43);
    let ran = folder.run("info mask.raw --raw 4x4x4,u8 --json");
    let said: Value = serde_json::from_str(&ran.out).expect("JSON");
    assert_eq!(said.get("structure"), None);
}

#[test]
fn of_many_leaves_no_address_is_said_and_of_none_the_root() {
    let folder = Folder::new();
    let ran = folder.run("info phantom:head,n=32 --structure --preset ct-bone");
    ran.assert_done();
    assert!(
        ran.out.contains("octree ") && !ran.out.contains("leaves"),
        "{}",
        ran.out
    );
    // Widgets need gradients: no voxel is classified by its value alone.
    let ran = folder.run("info phantom:head,n=32 --structure --preset boundaries");
    ran.assert_done();
    let line = "full         no voxel by its own value: the function looks at gradients too\n";
    assert!(ran.out.contains(line), "{}", ran.out);
    folder.file("all.json", FUNCTION.replace("[100,0]", "[100,0.1]"));
    let ran = folder.run("info phantom:fog,n=8 --structure --tf all.json");
    ran.assert_done();
    for line in [
        "full         512 voxels, 100.0 %, whose own value has opacity (--preclassified)\n",
        "octree       1 node of a cube of 8 voxels a side, 0 mixed, 0 bytes\n",
        "full leaves  the root\n",
    ] {
        assert!(ran.out.contains(line), "no {line:?} in {}", ran.out);
    }
}

#[test]
fn a_function_without_structure_is_refused_by_name() {
    let folder = Folder::new();
    mask(&folder);
    for words in [
        "--preset ct-bone",
        "--tf tf.json",
        "--window 1,2",
        "--colormap turbo",
    ] {
        let ran = folder.run(&format!("info phantom:fog,n=8 {words}"));
        ran.assert_refused(2, &["--structure", "hint"]);
    }
    for (words, code, named) in [
        (
            "phantom:fog,n=8 --structure --window 3,3",
            2,
            "--window 3,3",
        ),
        (
            "phantom:fog,n=8 --structure --tf missing.json",
            3,
            "missing.json",
        ),
        ("phantom:storm,n=8 --structure", 2, "--variable"),
    ] {
        folder
            .run(&format!("info {words}"))
            .assert_refused(code, &[named]);
    }
}

/// Counted with NumPy from the file itself, in the same words: values over 100 Hounsfield units are full.
#[test]
fn a_real_ct_has_the_runs_and_nodes_that_another_program_counts() {
    let Some(data) = real::data() else { return };
    let folder = Folder::new();
    folder.file("tf.json", FUNCTION);
    let file = data.join("ct-cranium/cranium.nrrd");
    let ran = folder.run(&format!(
        "info {} --structure --tf tf.json --json",
        file.display()
    ));
    ran.assert_done();
    let said: Value = serde_json::from_str(&ran.out).expect("JSON");
    let before = &said["structure"]["preclassified"];
    assert_eq!(before["full"], 564_317);
    let runs = [0, 1, 2].map(|axis| before["runs"][axis]["runs"].as_u64());
    assert_eq!(runs, [70_230, 58_335, 65_497].map(Some));
    let octree = &before["octree"];
    assert_eq!(
        [&octree["nodes"], &octree["mixed"]],
        [543_425, 67_928].map(Value::from).each_ref()
    );
    assert_eq!(octree["bytes"], 8 * 67_928);
    let levels = octree["levels"].as_array().expect("levels").iter();
    let levels: Vec<_> = levels
        .map(|level| ["empty", "full", "mixed"].map(|key| level[key].as_u64().expect("a count")))
        .collect();
    let wanted = [
        [0, 0, 1],
        [4, 0, 4],
        [4, 0, 28],
        [67, 0, 157],
        [485, 0, 771],
        [2455, 2, 3711],
        [11_398, 2_244, 16_046],
        [51_117, 30_041, 47_210],
        [198_331, 179_349, 0],
    ];
    assert_eq!(levels, wanted);
    // After filtering each voxel that touches a full one; and what cells of the table and a sampler's rounding add.
    let after = said["structure"]["postclassified"]["full"]
        .as_u64()
        .expect("a count");
    assert!((967_644..990_000).contains(&after), "{after}");
}
