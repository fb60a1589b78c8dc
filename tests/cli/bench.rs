//! `bench`: the structure of its table, and that its counts are counts. No time is asserted: it belongs to the machine.

use crate::person::Folder;
use serde_json::Value;
use std::fs;

const SMALL: &str = "--size 24x16";

fn json(text: &str) -> Value {
    serde_json::from_str(text).expect("JSON")
}

fn table_of(folder: &Folder, words: &str) -> Value {
    folder
        .run(&format!("bench {words} --repeat 2 --json t.json --force"))
        .assert_done();
    json(&fs::read_to_string(folder.path("t.json")).expect("a file"))
}

fn rows(table: &Value) -> &[Value] {
    table["rows"].as_array().expect("rows")
}

#[test]
fn a_table_has_every_technique_mode_and_projection() {
    let folder = Folder::new();
    let ran = folder.run(&format!(
        "bench phantom:gauss,n=8 --repeat 1 --json t.json {SMALL}"
    ));
    ran.assert_done();
    let table = json(&fs::read_to_string(folder.path("t.json")).expect("a file"));
    let mut names: Vec<_> = rows(&table)
        .iter()
        .map(|row| row["name"].as_str())
        .collect();
    for name in &names {
        let name = name.expect("a name");
        assert!(ran.out.contains(name), "no {name}: {ran:#?}");
    }
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), 20, "{table}");
    assert!(names.contains(&Some("slices-2d mip orthographic")));
    let device = table["device"].as_str().expect("a device");
    assert!(ran.out.contains(device), "{ran:#?}");
}

#[test]
fn scattered_points_are_measured_as_splats_and_by_no_other_technique() {
    let folder = Folder::new();
    let rows_of = |n: u32| format!("{},{},{},{n}\n", n % 3, n % 5, n % 7);
    let points: String = (0..40).map(rows_of).collect();
    folder.file("p.csv", format!("x,y,z,value\n{points}"));
    let table = table_of(&folder, &format!("p.csv --modes composite,xray {SMALL}"));
    let names: Vec<_> = rows(&table)
        .iter()
        .filter_map(|row| row["name"].as_str())
        .collect();
    assert_eq!(names.len(), 4, "{table}");
    assert!(
        names.iter().all(|name| name.starts_with("splat ")),
        "{table}"
    );
    // What is counted are the points that rays meet, not samples of a volume.
    let samples = rows(&table)[0]["samples"].as_u64().expect("a number");
    assert!(samples > 0 && samples <= 24 * 16 * 40, "{table}");
    let ran = folder.run(&format!("bench p.csv --techniques raycast {SMALL}"));
    assert_eq!(ran.code, 2, "{ran:?}");
    assert!(
        ran.err.contains("scattered points is for splatting"),
        "{ran:?}"
    );
}

#[test]
fn a_table_without_a_row_is_refused_by_name() {
    let folder = Folder::new();
    folder
        .run(&format!(
            "bench phantom:gauss,n=8 --modes iso --techniques slices-3d {SMALL}"
        ))
        .assert_refused(2, &["slices-3d iso", "no picture of the table"]);
}

#[test]
fn rates_are_numbers_and_a_share_of_what_was_probed() {
    let folder = Folder::new();
    let words = "phantom:gauss,n=8 --techniques raycast --modes mip --projections orthographic";
    let table = table_of(&folder, &format!("{words} {SMALL}"));
    let number = |value: &Value| {
        let number = value
            .as_f64()
            .unwrap_or_else(|| panic!("{value} in {table}"));
        assert!(number > 0.0 && number.is_finite(), "{number} in {table}");
        number
    };
    let ceilings = &table["ceilings"][0];
    let most = number(&ceilings["samples_per_second"]);
    number(&ceilings["bytes_per_second"]);
    let row = &rows(&table)[0];
    assert_eq!(row["frames"], 2);
    let rate = number(&row["samples_per_second"]);
    let wanted = 1e3 * number(&row["samples"]) / number(&row["gpu_ms"]);
    assert!((rate / wanted - 1.0).abs() < 1e-12, "{table}");
    let share = number(&row["of_ceiling"]);
    assert!((share / (rate / most) - 1.0).abs() < 1e-12, "{table}");
}

/// The box is 100 mm wide and 8 voxels deep, and just fills the picture: 16 x 16 rays of 8 samples.
#[test]
fn samples_are_those_that_a_picture_takes() {
    let folder = Folder::new();
    let words = "phantom:gauss,n=8 --view anterior --view-height 100 --size 16x16";
    let table = table_of(
        &folder,
        &format!(
            "{words} --modes mip --projections orthographic --techniques raycast,slices-3d,slices-2d"
        ),
    );
    assert_eq!(rows(&table).len(), 3, "{table}");
    for row in rows(&table) {
        assert_eq!(row["samples"], 16 * 16 * 8, "{row}");
    }
    let table = table_of(
        &folder,
        &format!("{words} --projections orthographic --technique raycast --mode composite"),
    );
    let [row] = rows(&table) else {
        panic!("one row: {table}");
    };
    folder
        .run(&format!(
            "render --look plain {words} --projection orthographic -o a.png --timings r.json"
        ))
        .assert_done();
    let timings = json(&fs::read_to_string(folder.path("r.json")).expect("a file"));
    assert_eq!(row["samples"], timings["samples"], "{table} {timings}");
}

#[test]
fn several_volumes_have_rows_and_ceilings_each_and_what_cannot_be_is_left_out_by_name() {
    let folder = Folder::new();
    let words = "phantom:gauss,n=8 phantom:fog,n=8,type=u8 --techniques raycast,slices-3d --modes mip,lmip --projections perspective";
    let ran = folder.run(&format!("bench {words} --repeat 1 --json t.json {SMALL}"));
    ran.assert_done();
    assert!(
        ran.err.contains("slices-3d lmip perspective is left out"),
        "{ran:#?}"
    );
    let table = json(&fs::read_to_string(folder.path("t.json")).expect("a file"));
    let found: Vec<_> = rows(&table)
        .iter()
        .map(|row| {
            (
                row["volume"].as_str().expect("one"),
                row["name"].as_str().expect("one"),
            )
        })
        .collect();
    let names = [
        "raycast mip perspective",
        "slices-3d mip perspective",
        "raycast lmip perspective",
    ];
    let wanted: Vec<_> = ["phantom:gauss,n=8", "phantom:fog,n=8,type=u8"]
        .into_iter()
        .flat_map(|volume| names.map(|name| (volume, name)))
        .collect();
    assert_eq!(found, wanted);
    assert_eq!(
        table["ceilings"].as_array().map(Vec::len),
        Some(2),
        "{table}"
    );
}

#[test]
fn the_cpu_has_no_ceiling() {
    let folder = Folder::new();
    let words = "phantom:fog,n=8 --device reference --technique slices-2d --mode mip";
    let table = table_of(&folder, &format!("{words} --size 8x8"));
    assert_eq!(rows(&table).len(), 2, "{table}");
    assert!(
        table["ceilings"][0]["samples_per_second"].is_null(),
        "{table}"
    );
    assert!(rows(&table)[0]["of_ceiling"].is_null(), "{table}");
    assert!(
        rows(&table)[0]["samples_per_second"].as_f64() > Some(0.0),
        "{table}"
    );
}

#[test]
fn rows_of_the_table_are_no_words_for_views() {
    let folder = Folder::new();
    folder.file(
        "views.json",
        r#"[{"eye":[0,50,0],"target":[0,0,0],"up":[0,0,1],"fov":30}]"#,
    );
    for words in ["--modes mip", "phantom:fog,n=8"] {
        let ran = folder.run(&format!(
            "bench phantom:gauss,n=8 {words} --cameras views.json"
        ));
        assert_eq!(ran.code, 2, "{ran:#?}");
        assert!(ran.err.contains("--cameras"), "{ran:#?}");
    }
}

#[test]
fn views_are_gone_through_as_often_as_asked() {
    let folder = Folder::new();
    folder.file(
        "views.json",
        r#"[{"eye":[0,50,0],"target":[0,0,0],"up":[0,0,1],"fov":30},
            {"eye":[50,0,0],"target":[0,0,0],"up":[0,0,1],"fov":30}]"#,
    );
    for (words, frames) in [("", 2), ("--repeat 3", 6)] {
        folder
            .run(&format!(
                "bench phantom:gauss,n=8 --size 8x8 {words} --cameras views.json --json t.json --force"
            ))
            .assert_done();
        let times = json(&fs::read_to_string(folder.path("t.json")).expect("a file"));
        assert_eq!(
            times["frames"].as_array().map(Vec::len),
            Some(frames),
            "{times}"
        );
    }
}

/// What is measured does not depend on what a look would choose.
#[test]
fn without_a_flag_a_bench_is_plain() {
    let folder = Folder::new();
    folder.file(
        "views.json",
        r#"[{"eye":[0,500,0],"target":[0,0,0],"up":[0,0,1],"fov":30}]"#,
    );
    let samples = |words: &str| {
        folder
            .run(&format!(
                "bench phantom:head,n=24 --size 32x24 {words} --cameras views.json --json t.json --force"
            ))
            .assert_done();
        let times = json(&fs::read_to_string(folder.path("t.json")).expect("a file"));
        times["samples"].as_f64().expect("a count")
    };
    let bare = samples("");
    assert!(bare > 1000.0);
    assert_eq!(bare, samples("--look plain"));
    assert!(samples("--samples-per-voxel 2") > 1.5 * bare);
}
