//! Lines along the wind of files: what is taken, what is written, what is refused.

use crate::person::{Folder, Ran, assert_begins};
use crate::real::data;
use std::fs;

fn fixture(name: &str) -> String {
    format!("{}/tests/fixtures/{name}", env!("CARGO_MANIFEST_DIR"))
}

const STORM: &str = "phantom:storm,n=16";

/// Rows of a file of lines: `line,time,x,y,z,lon,lat,height,value`; what is empty is NaN.
fn rows(folder: &Folder, name: &str) -> Vec<[f64; 9]> {
    let text = fs::read_to_string(folder.path(name)).expect("the lines");
    let row = |row: &str| {
        let numbers = row.split(',').map(|n| n.parse().unwrap_or(f64::NAN));
        let numbers: Vec<f64> = numbers.collect();
        numbers.try_into().unwrap_or_else(|_| panic!("{row}"))
    };
    text.lines().skip(1).map(row).collect()
}

/// The last vertex of each line.
fn ends(rows: &[[f64; 9]]) -> Vec<[f64; 9]> {
    let mut ends: Vec<[f64; 9]> = Vec::new();
    for &row in rows {
        match ends.last_mut() {
            Some(last) if last[0] == row[0] => *last = row,
            _ => ends.push(row),
        }
    }
    ends
}

#[test]
fn lines_of_a_storm_are_written_in_each_format_and_their_causes_said() {
    let folder = Folder::new();
    for name in ["a.vtp", "a.csv", "a.glb"] {
        let ran = folder.run(&format!(
            "convert {STORM} -o {name} --flow stream --flow-seeds grid:4,4,2"
        ));
        ran.assert_done();
        for words in ["the wind is u, v, w", "32 lines of", "ends: domain"] {
            assert!(ran.err.contains(words), "no {words:?}: {ran:#?}");
        }
    }
    assert_begins(
        &folder.path("a.vtp"),
        b"<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\"",
    );
    assert_begins(&folder.path("a.glb"), b"glTF");
    let glb = fs::read(folder.path("a.glb")).expect("tubes");
    assert!(String::from_utf8_lossy(&glb[..400]).contains("\"COLOR_0\":3"));
    let lines = rows(&folder, "a.csv");
    assert!(
        lines
            .iter()
            .all(|row| row[2..5].iter().all(|n| n.abs() <= 24.0))
    );
    // Our own reader of points takes the vertices of the other file.
    let info = folder.run("info a.vtp --points --json");
    info.assert_done();
    assert!(info.out.contains("vtp"), "{info:#?}");
    // The same words, the same bytes.
    let again = format!("convert {STORM} -o b.csv --flow stream --flow-seeds grid:4,4,2");
    folder.run(&again).assert_done();
    let read = |name: &str| fs::read(folder.path(name)).expect("lines");
    assert_eq!(read("a.csv"), read("b.csv"));
}

#[test]
fn seeds_colours_lengths_and_times_are_what_the_words_say() {
    let folder = Folder::new();
    let run = |words: &str| -> Vec<[f64; 9]> {
        let ran = folder.run(&format!(
            "convert {STORM} -o a.csv --force --flow stream {words}"
        ));
        ran.assert_done();
        rows(&folder, "a.csv")
    };
    let updraft =
        run("--flow-seeds where:w>5,10 --flow-direction forward --flow-color w --flow-time 2min");
    let first = |line: f64| updraft.iter().find(|row| row[0] == line).expect("a line");
    assert!(
        (0..10).all(|i| first(f64::from(i))[8] > 5.0),
        "seeds are not in the updraft"
    );
    assert!(updraft.iter().all(|row| (0.0..=120.0).contains(&row[1])));
    folder.file("seeds.csv", "x,y,z\n1,2,5\n-3,4,6\n");
    let few = run("--flow-seeds seeds.csv --flow-direction backward --flow-length 2");
    assert!(few.iter().all(|row| row[1] <= 0.0));
    for (end, seed) in ends(&few).iter().zip([[1.0, 2.0, 5.0], [-3.0, 4.0, 6.0]]) {
        assert_eq!(end[2..5], seed);
    }
    let ways = few.windows(2).filter(|pair| pair[0][0] == pair[1][0]);
    let way = |pair: &[[f64; 9]]| {
        (2..5)
            .map(|k| (pair[1][k] - pair[0][k]).powi(2))
            .sum::<f64>()
            .sqrt()
    };
    let length: f64 = ways.map(way).sum();
    assert!(length <= 4.0 + 1e-9, "{length}");
    let even = run("--flow-seeds even:6");
    assert!(ends(&even).len() >= 20, "{} lines", ends(&even).len());
    // Without w lines keep their height.
    let level = run("--flow-seeds grid:3,3,3 --wind u,v,none");
    for pair in level.windows(2).filter(|pair| pair[0][0] == pair[1][0]) {
        assert_eq!(pair[0][4], pair[1][4]);
    }
}

/// The file's wind is u = 4 (x + 1/2) and v = 4 (y + 1/2) a cell of 2 km and 3 km, held over three hours.
#[test]
fn particles_and_smoke_go_through_the_times_of_a_file() {
    let folder = Folder::new();
    let file = fixture("netcdf/wrf.nc");
    folder.file("seeds.csv", "-4,-2,0.5\n");
    for (word, times) in [("path", [0.0, 1800.0]), ("streak", [9000.0, 10800.0])] {
        let ran = folder.run(&format!(
            "convert {file} -o {word}.csv --flow {word} --flow-seeds seeds.csv --flow-time 30min --wind U,V,none"
        ));
        ran.assert_done();
        let warns = ran
            .err
            .contains("snapshots are far apart: path lines are uncertain");
        assert_eq!(warns, word == "path", "{ran:#?}");
        assert!(
            ran.err.contains("without a unit, and taken as m s-1: U, V"),
            "{ran:#?}"
        );
        let rows = rows(&folder, &format!("{word}.csv"));
        let found = [rows[0][1], rows[rows.len() - 1][1]];
        let most = if word == "path" { 1800.0 } else { 10800.0 };
        assert!(
            found[0] >= times[0] && found[1] <= most + 1e-9,
            "{word}: {found:?}"
        );
        // Beyond the last column the wind is held.
        for row in rows.iter().filter(|row| row[2] <= 4.0) {
            // In m, from the first column: dx/dt = 4 (x / 2000 + 1/2), so x + 1000 grows by exp(t / 500 s).
            let age = if word == "path" {
                row[1]
            } else {
                10800.0 - row[1]
            };
            let x = 1e3 * (row[2] + 4.0) + 1000.0;
            assert!(
                (x / (1000.0 * (age / 500.0).exp()) - 1.0).abs() < 2e-3,
                "{word}: {row:?}"
            );
        }
    }
}

#[test]
fn what_is_no_wind_and_no_seed_is_refused_by_name() {
    let folder = Folder::new();
    folder.file("seeds.csv", "1,2,3\n\n1,2\n");
    folder.file("far.csv", "1000,2,3\n");
    let run = |input: &str, words: &str| -> Ran {
        folder.run(&format!("convert {input} -o a.vtp {words}"))
    };
    let stream = |input: &str, words: &str| run(input, &format!("--flow stream {words}"));
    stream("phantom:head,n=8", "").assert_refused(
        2,
        &["no wind in phantom:head,n=8", "wanted U and V", "found"],
    );
    stream(STORM, "--wind u,cloud2")
        .assert_refused(2, &["--wind: no variable cloud2", "there are cloud"]);
    stream(STORM, "--wind u").assert_refused(2, &["wanted U,V or U,V,W"]);
    stream(STORM, "--flow-seeds circle:3").assert_refused(2, &["wanted even, grid"]);
    stream(STORM, "--flow-seeds seeds.csv")
        .assert_refused(3, &["line 3: 3 numbers wanted, found 2"]);
    stream(STORM, "--flow-seeds far.csv").assert_refused(
        2,
        &[
            "none of 1 seeds lies in the wind",
            "box -24,-24,0 to 24,24,18",
        ],
    );
    stream(STORM, "--flow-seeds where:w>500,3").assert_refused(2, &["in no voxel"]);
    stream(STORM, "--flow-color 1:0:0").assert_refused(2, &["for tubes"]);
    stream(STORM, "--iso 3").assert_refused(2, &["cannot be used with"]);
    run(STORM, "--flow-seeds random:4").assert_refused(2, &["--flow"]);
    run("phantom:storm,n=16,times=1", "--flow path")
        .assert_refused(2, &["one time", "--flow stream"]);
    run(STORM, "--flow path --flow-seeds even").assert_refused(2, &["particles keep no distance"]);
    run(STORM, "--flow streak --flow-direction both").assert_refused(2, &["smoke goes forward"]);
    folder
        .run(&format!("convert {STORM} -o a.ply --flow stream"))
        .assert_refused(2, &["no format of lines", ".vtp, .csv or .glb"]);
    let wrf = fixture("netcdf/wrf.nc");
    stream(&wrf, "--wind U,V,T").assert_refused(2, &["T has unit K", "m s-1", "Pa s-1"]);
    assert!(!folder.path("a.vtp").exists());
}

/// 8 times from 0 to 24 h. The wind at 9 km blows east with over 10 m/s.
#[test]
fn times_that_are_numbers_of_hours_carry_particles_as_dates_do() {
    let folder = Folder::new();
    folder.file("seeds.csv", "-20,0,9\n");
    let ran = folder.run(&format!(
        "convert {STORM} -o path.csv --flow path --flow-seeds seeds.csv --flow-time 0.1h"
    ));
    ran.assert_done();
    let rows = rows(&folder, "path.csv");
    let last = rows[rows.len() - 1];
    assert!((last[1] - 360.0).abs() < 1e-6, "{last:?}");
    let gone = last[2] + 20.0;
    assert!(
        (3.6..11.0).contains(&gone),
        "10 to 30 m/s for six minutes, in km: {gone}"
    );
}

/// Where 60 places of a real forecast are after an hour, against an integration in its own columns.
#[test]
fn lines_of_a_forecast_end_where_its_own_columns_say() {
    let Some(data) = data() else {
        println!("skipped: there is no data");
        return;
    };
    let file = data.join("met-wrf/wrf_ci.nc");
    if !file.exists() {
        println!("skipped: there is no {}", file.display());
        return;
    }
    let text = fs::read_to_string(fixture("flow/wrf_ends.csv")).expect("the ends");
    let wanted: Vec<Vec<Option<f64>>> = text
        .lines()
        .filter(|line| !line.starts_with('#'))
        .map(|line| line.split(',').map(|n| n.parse().ok()).collect())
        .collect();
    let folder = Folder::new();
    let seeds: Vec<String> = wanted
        .iter()
        .map(|row| {
            row[..3]
                .iter()
                .flatten()
                .map(f64::to_string)
                .collect::<Vec<_>>()
                .join(",")
        })
        .collect();
    folder.file("seeds.csv", seeds.join("\n"));
    let ran = folder.run(&format!(
        "convert {} -o a.csv --flow stream --flow-seeds seeds.csv --flow-direction forward --flow-time 1h",
        file.display()
    ));
    ran.assert_done();
    let ends = ends(&rows(&folder, "a.csv"));
    assert_eq!(ends.len(), 60);
    let (mut sideways, mut up) = (Vec::new(), Vec::new());
    for (end, wanted) in ends.iter().zip(&wanted) {
        if let [.., Some(x), Some(y), Some(z)] = wanted[..] {
            sideways.push((end[2] - x).hypot(end[3] - y));
            up.push(1e3 * (end[4] - z).abs());
        }
    }
    sideways.sort_by(f64::total_cmp);
    up.sort_by(f64::total_cmp);
    let [middle, last] = [sideways.len() / 2, sideways.len() - 1];
    println!(
        "km {} {}, m {} {}",
        sideways[middle], sideways[last], up[middle], up[last]
    );
    assert!(sideways.len() == 59 && sideways[last] < 0.6 && sideways[middle] < 0.02);
    // W is brought from its own even heights to those of U.
    assert!(up[last] < 25.0 && up[middle] < 2.0);
}

#[test]
fn beside_a_volume_that_is_drawn_from_its_file_is_what_is_beside_one_in_memory() {
    let folder = Folder::new();
    for words in ["--flow stream", "--barbs=2 --hide-volume"] {
        let draw = |more: &str, name: &str| {
            let ran = folder.run(&format!(
                "render {STORM} --variable vapor {words} {more} --size 80x60 --force -o {name}"
            ));
            ran.assert_done();
            fs::read(folder.path(name)).expect("a picture")
        };
        let wanted = draw("", "a.png");
        assert!(draw("--stream", "b.png") == wanted, "{words}");
    }
}

#[test]
fn what_goes_up_beside_a_pair_that_is_said_is_said_too() {
    let folder = Folder::new();
    for (pair, wanted) in [
        ("u,v", "the wind is u, v, w"),
        ("v,u", "the wind is v, u, without an upward variable"),
        ("v,u,w", "the wind is v, u, w"),
    ] {
        let ran = folder.run(&format!(
            "convert {STORM} -o a.csv --force --flow stream --flow-seeds grid:2,2,1 --wind {pair}"
        ));
        ran.assert_done();
        assert!(ran.err.contains(wanted), "{pair}: {ran:#?}");
    }
}

/// Mercator's map of a real forecast against its own latitudes and longitudes: there, as columns of lines, and back, as seeds.
#[test]
fn lines_of_a_forecast_on_a_map_have_degrees_and_seeds_take_them() {
    let Some(file) = data().map(|data| data.join("met-wrf/wrf_ci.nc")) else {
        println!("skipped: there is no data");
        return;
    };
    if !file.exists() {
        println!("skipped: there is no {}", file.display());
        return;
    }
    let folder = Folder::new();
    let file = file.display();
    // Of the first time, 48 by 48, x fastest.
    let numbers = |name: &str| -> Vec<f64> {
        folder
            .run(&format!(
                "convert {file} -o {name}.npy --variable {name} --time 0 --type f64"
            ))
            .assert_done();
        let bytes = fs::read(folder.path(&format!("{name}.npy"))).expect("numbers");
        let numbers = &bytes[bytes.len() - 8 * 48 * 48..];
        let number = |b: &[u8]| f64::from_le_bytes(b.try_into().expect("eight bytes"));
        numbers.chunks(8).map(number).collect()
    };
    let [latitudes, longitudes] = ["XLAT", "XLONG"].map(numbers);
    let lines = |seeds: &str, name: &str| {
        let words = "--flow stream --flow-direction forward --flow-time 1h --force";
        folder
            .run(&format!(
                "convert {file} -o {name} {words} --flow-seeds {seeds}"
            ))
            .assert_done();
        rows(&folder, name)
    };
    let there = lines("random:40", "there.csv");
    for row in &there {
        // Middles of cells are 10 km apart, the first at -235 km.
        let [x, y] = [row[2], row[3]].map(|n| (n + 235.0) / 10.0);
        let [i, j] = [x, y].map(|n| n.floor().clamp(0.0, 46.0));
        let at = |list: &[f64]| {
            let node = |di: f64, dj: f64| list[((j + dj) * 48.0 + i + di) as usize];
            let along = |dj: f64| node(0.0, dj) + (x - i) * (node(1.0, dj) - node(0.0, dj));
            along(0.0) + (y - j) * (along(1.0) - along(0.0))
        };
        // The map meets XLAT and XLONG to 2 m; between nodes a latitude bends by (10 km)^2 tan(p) / (8 R): 1 m. A degree is 111 km.
        assert!((row[5] - at(&longitudes)).abs() < 5e-5, "{row:?}");
        assert!((row[6] - at(&latitudes)).abs() < 5e-5, "{row:?}");
    }
    let mut seeds = "lon,lat,height\n".to_owned();
    let mut first = there.clone();
    first.dedup_by_key(|row| row[0]);
    for row in &first {
        seeds += &format!("{},{},{}\n", row[5], row[6], row[7]);
    }
    folder.file("seeds.csv", seeds);
    let back = lines("seeds.csv", "back.csv");
    let mut begins = back.clone();
    begins.dedup_by_key(|row| row[0]);
    assert!(first.len() >= 30 && begins.len() == first.len());
    for (a, b) in first.iter().zip(&begins) {
        for k in 2..5 {
            assert!((a[k] - b[k]).abs() < 1e-6, "{a:?} {b:?}");
        }
    }
    folder.file("far.csv", "lon,lat,height\n100,20,500\n");
    let far = folder.run(&format!(
        "convert {file} -o a.csv --flow stream --flow-seeds far.csv"
    ));
    let said = "none of 1 seeds lies in the wind";
    assert!(far.code == 2 && far.err.contains(said), "{far:#?}");
}

#[test]
fn a_wind_that_is_too_large_is_refused_with_its_size_or_reduced() {
    let folder = Folder::new();
    let info = |input: &str| -> serde_json::Value {
        let ran = folder.run(&format!("info {input} --json"));
        ran.assert_done();
        serde_json::from_str(&ran.out).expect("JSON")
    };
    let of_storm = info(STORM);
    let bytes = &of_storm["render_bytes"];
    // 16 x 16 x 6 voxels of three floats, at eight times.
    assert_eq!(bytes["wind"], 16 * 16 * 6 * 12, "{bytes}");
    assert_eq!(bytes["wind_of_all_times"], 8 * 16 * 16 * 6 * 12, "{bytes}");
    assert!(
        bytes["line_vertex"].as_u64() > Some(40) && bytes["geometry_pixel"] == 28,
        "{bytes}"
    );
    assert!(info("phantom:head,n=8")["render_bytes"]["wind"].is_null());
    let lines = format!(
        "convert {STORM} -o a.csv --flow stream --flow-seeds random:40 --max-memory 30K --force"
    );
    let refused = folder.run(&lines);
    assert_ne!(refused.code, 0);
    let said = "the wind of one time takes 36864 bytes, and there are 30720";
    assert!(refused.err.contains(said), "{}", refused.err);
    let reduced = folder.run(&format!("{lines} --fit"));
    reduced.assert_done();
    let said = "reduced from 16 x 16 x 6 to 8 x 8 x 3 voxels, means of blocks of 2 a side";
    assert!(reduced.err.contains(said), "{}", reduced.err);
    // Of 36 864 bytes and of an eighth: lines of the same seeds in nearly the same wind.
    let of_blocks = ends(&rows(&folder, "a.csv"));
    folder.run(&lines.replace("30K", "1G")).assert_done();
    let of_voxels = ends(&rows(&folder, "a.csv"));
    assert_eq!(of_blocks.len(), of_voxels.len());
    let speed = |ends: &[[f64; 9]]| ends.iter().map(|end| end[8]).sum::<f64>() / ends.len() as f64;
    let [blocks, voxels] = [speed(&of_blocks), speed(&of_voxels)];
    assert!((blocks / voxels - 1.0).abs() < 0.2, "{blocks} {voxels}");
}
