//! Lines on the Earth from files: what is read, what is refused, and what no file makes of memory.

use crate::files::Folder;
use crate::memory;
use crate::mutate::{Mutation, Random, mutate};
use crate::shapefile::{Lines, shapefile};
use std::panic::{AssertUnwindSafe, catch_unwind};
use stratavox::format::geographic::read_lines;
use stratavox::volume::Limits;

/// Bytes of a place in memory, over those of "[0,0]," in a file: six. Lists are at most doubled when they grow, and for a
/// moment both are there; a list of its own for two places, "[[0,0],[0,0]],", takes 24 bytes and another 64 where four are made
/// room for.
const MOST_TIMES: usize = 3 * (24 + 64) / 14 + 1;
/// Of an error, and of what reads.
const BESIDE_BYTES: usize = 1 << 16;

fn read(folder: &Folder, name: &str, bytes: &[u8]) -> Result<Lines, String> {
    let path = folder.write(name, bytes);
    read_lines(&path, &Limits::default()).map_err(|error| crate::files::message(&error))
}

fn island() -> Vec<[f64; 2]> {
    vec![[1.5, 50.0], [2.5, 50.25], [2.0, 51.125], [1.5, 50.0]]
}

fn river() -> Vec<[f64; 2]> {
    vec![[-179.5, -89.5], [180.0, 90.0]]
}

#[test]
fn shapefiles_are_read_with_heights_and_measures_and_without() {
    let folder = Folder::new();
    for kind in [3, 5, 13, 15, 23, 25] {
        let file = shapefile(kind, &[vec![island(), river()], vec![], vec![river()]]);
        let found = read(&folder, "a.shp", &file);
        assert_eq!(found, Ok(vec![island(), river(), river()]), "type {kind}");
    }
    // Measures may be left out, heights may not: of the only record, 16 bytes and 8 a place.
    let without = |kind: i32, places: usize| {
        let mut file = shapefile(kind, &[vec![island()]]);
        file.truncate(file.len() - 16 - 8 * places);
        let words = (file.len() / 2) as i32;
        file[24..28].copy_from_slice(&words.to_be_bytes());
        file[104..108].copy_from_slice(&(words - 54).to_be_bytes());
        file
    };
    for kind in [13, 15, 23, 25] {
        assert_eq!(
            read(&folder, "a.shp", &without(kind, 4)),
            Ok(vec![island()])
        );
    }
    let refused = read(&folder, "a.shp", &without(13, 3)).expect_err("half of the measures");
    assert!(refused.contains("record 1: length"), "{refused}");
}

#[test]
fn geometries_of_geojson_are_read_wherever_they_stand() {
    let folder = Folder::new();
    let line = "[[-179.5,-89.5],[180,90,1234.5]]";
    let ring = "[[1.5,50],[2.5,50.25],[2.0,5.1125e1],[1.5,50]]";
    let geometry = |kind: &str, coordinates: &str| {
        format!(r#"{{"bbox":[0,0,1,1],"coordinates":{coordinates},"type":"{kind}"}}"#)
    };
    let of = |kind: &str, list: &str, members: &[String]| {
        format!(r#"{{"type":"{kind}","{list}":[{}]}}"#, members.join(" ,\n"))
    };
    let feature = |geometry: &str| {
        format!(
            r#"{{"type":"Feature","properties":{{"type":7,"coordinates":"x"}},"geometry":{geometry}}}"#
        )
    };
    let geometries = [
        geometry("LineString", line),
        geometry("MultiLineString", &format!("[{line},{line}]")),
        geometry("Polygon", &format!("[{ring},{ring}]")),
        geometry("MultiPolygon", &format!("[[{ring}],[{ring},[]],[]]")),
        geometry("Point", "[1,2]"),
        geometry("MultiPoint", line),
        geometry("LineString", "[]"),
    ];
    let wanted = [
        river(),
        river(),
        river(),
        island(),
        island(),
        island(),
        island(),
    ];
    for (text, wanted) in [
        (geometries[0].clone(), &wanted[..1]),
        (geometries[1].clone(), &wanted[1..3]),
        (geometries[2].clone(), &wanted[3..5]),
        (geometries[3].clone(), &wanted[5..]),
        (feature(&geometries[0]), &wanted[..1]),
        (
            of("GeometryCollection", "geometries", &geometries),
            &wanted[..],
        ),
        (
            of(
                "FeatureCollection",
                "features",
                &[
                    feature("null"),
                    feature(&of("GeometryCollection", "geometries", &geometries)),
                ],
            ),
            &wanted[..],
        ),
    ] {
        for text in [text.clone(), format!("\u{feff} \n{text}\n")] {
            let found = read(&folder, "a.geojson", text.as_bytes());
            assert_eq!(found.as_deref(), Ok(wanted), "{text}");
        }
    }
}

fn topology(transform: &str, arcs: &str, used: &str) -> String {
    format!(
        r#"{{"type":"Topology","transform":{transform},"arcs":{arcs},"objects":{{"all":{{"type":"LineString","arcs":{used}}}}}}}"#
    )
}

#[test]
fn arcs_of_topojson_are_lines_once() {
    let folder = Folder::new();
    // The quarter of a degree, from 180 west and 90 south: the first arc is the river from its end.
    let arcs =
        "[[[1440,720],[-1438,-718]],[[726,560],[4,1],[-2,3.5],[-2,-4.5]],[[0,0],[1,1]],[[5,5]]]";
    let transform = r#"{"scale":[0.25,0.25],"translate":[-180,-90]}"#;
    let objects = r#"{"land":{"type":"GeometryCollection","geometries":[
        {"type":"MultiPolygon","arcs":[[[1]],[[-2,3]]]},{"type":null},{"type":"Point","coordinates":[7,7]}]},
        "rivers":{"type":"MultiLineString","id":4,"properties":{"arcs":[2]},"arcs":[[-1],[0]]}}"#;
    let text = format!(
        r#"{{"objects":{objects},"arcs":{arcs},"transform":{transform},"bbox":[0,0,1,1],"type":"Topology"}}"#
    );
    let river = vec![[180.0, 90.0], [-179.5, -89.5]];
    for text in [text.clone(), format!("\u{feff}\n {text}")] {
        let found = read(&folder, "a.json", text.as_bytes());
        assert_eq!(found, Ok(vec![river.clone(), island()]));
    }
    // Numbers that are degrees already, and heights.
    let found = read(
        &folder,
        "a.json",
        topology("null", "[[[-179.5,-89.5,3],[180,90,4]]]", "[0]").as_bytes(),
    );
    assert_eq!(found, Ok(vec![self::river()]));
    // What a sum of steps is off the edge of the map is taken away.
    let steps = topology(
        r#"{"scale":[0.0036000360003600037,0.001],"translate":[-180,-90]}"#,
        "[[[99999,0],[0,1000]]]",
        "[0]",
    );
    let found = read(&folder, "a.json", steps.as_bytes());
    assert_eq!(found, Ok(vec![vec![[180.0, -90.0], [180.0, -89.0]]]));
}

#[test]
fn what_is_wrong_in_a_file_is_said() {
    let folder = Folder::new();
    let line = |coordinates: &str| {
        format!(
            r#"{{"type":"LineString",{}"coordinates":{coordinates}}}"#,
            "\n"
        )
    };
    let mut cases: Vec<(Vec<u8>, &[&str])> = Vec::new();
    let texts: [(String, &[&str]); 20] = [
        (
            line("[[500000,0],[0,0]]"),
            &["line 2", "a longitude from -360 to 360 degrees", "500000"],
        ),
        (
            line("[[0,-90.5],[0,0]]"),
            &["a latitude from -90 to 90 degrees", "-90.5"],
        ),
        (line("[[0,0]]"), &["LineString with two positions", "one"]),
        (line("[1,2]"), &["2 lists around each number", "1 lists"]),
        (
            line("[[[0,0],[1,1]]]"),
            &["2 lists around each number", "3 lists"],
        ),
        (line("[[0,0],[[1,1],[2,2]]]"), &["positions only in a line"]),
        (
            line("[[0],[1,1]]"),
            &["longitude and latitude", "one number"],
        ),
        (line("null"), &["`coordinates`", "null"]),
        (line("[[1e999,0],[0,0]]"), &["number out of range"]),
        (
            r#"{"type":"Atlas","arcs":[]}"#.to_owned(),
            &["FeatureCollection", "Atlas"],
        ),
        (
            r#"{"type":"Topology","arcs":[]}"#.to_owned(),
            &["a topology", "objects"],
        ),
        (
            topology("null", "[[[0,0],[1,1]]]", "[-2]"),
            &["objects", "of which there are 1", "`-2`"],
        ),
        (
            topology("null", "[[[0,0],[1]]]", "[0]"),
            &["line 1", "two numbers"],
        ),
        (
            topology("null", "[[[0,0],[0,91]]]", "[0]"),
            &["arcs: 0", "a latitude from -90 to 90 degrees", "91"],
        ),
        (
            topology(
                r#"{"scale":[1e300,1],"translate":[0,0]}"#,
                "[[[1e300,0],[0,0]]]",
                "[0]",
            ),
            &["arcs: 0", "a longitude from -360 to 360 degrees"],
        ),
        (
            topology("null", "[[[0,0],[1,1]]]", "[[]]"),
            &["objects", "a line", "none"],
        ),
        (r#"{"coordinates":[]}"#.to_owned(), &["`type`", "none"]),
        (
            r#"{"type":"Feature","type":"Feature","geometry":null}"#.to_owned(),
            &["once", "twice"],
        ),
        (
            r#"{"type":"FeatureCollection","features":[{"type":"Point"}]}"#.to_owned(),
            &["`type` Feature", "Point"],
        ),
        (
            r#"{"type":"FeatureCollection","features":[]}"#.to_owned(),
            &["a line", "none"],
        ),
    ];
    for (text, wanted) in &texts {
        cases.push((text.clone().into_bytes(), wanted));
    }
    cases.push((
        b"\x89PNG".to_vec(),
        &["wanted a shapefile (.shp), GeoJSON or TopoJSON"],
    ));
    cases.push((shapefile(1, &[]), &["type 1", "not supported"]));
    cases.push((
        shapefile(4, &[]),
        &["`type`", "5, 15 or 25 of polygons", "4"],
    ));
    cases.push((shapefile(3, &[]), &["a line", "none"]));
    let far = vec![[0.0, 0.0], [500_000.0, 0.0]];
    cases.push((shapefile(3, &[vec![far]]), &["record 1: points", "500000"]));
    let whole = shapefile(5, &[vec![river()], vec![river(), island()]]);
    // Behind the header: the first record of 8 and 80 bytes. Of the second one: length, type, parts, points, first points.
    let second = 100 + 8 + 80;
    let places: [(usize, [u8; 4], &[&str]); 10] = [
        (24, 70_i32.to_be_bytes(), &["file length", "found `140`"]),
        (24, (-70_i32).to_be_bytes(), &["file length"]),
        (28, 999_i32.to_le_bytes(), &["version", "1000"]),
        (
            second + 4,
            i32::MAX.to_be_bytes(),
            &["record 2: length", "words"],
        ),
        (second + 4, (-4_i32).to_be_bytes(), &["record 2: length"]),
        (
            second + 8,
            3_i32.to_le_bytes(),
            &["record 2: type", "5, which the header names"],
        ),
        (
            second + 44,
            i32::MAX.to_le_bytes(),
            &["record 2: length", "2147483647 parts"],
        ),
        (
            second + 48,
            (-6_i32).to_le_bytes(),
            &["record 2: length", "-6 points"],
        ),
        (
            second + 56,
            7_i32.to_le_bytes(),
            &["record 2: parts", "0, then 7"],
        ),
        (
            second + 52,
            1_i32.to_le_bytes(),
            &["record 2: parts", "1, then 2"],
        ),
    ];
    for (place, bytes, wanted) in &places {
        let mut file = whole.clone();
        file[*place..place + 4].copy_from_slice(bytes);
        cases.push((file, wanted));
    }
    assert!(read(&folder, "whole", &whole).is_ok());
    for (bytes, wanted) in cases {
        memory::start();
        let found = read(&folder, "a", &bytes);
        let memory = memory::peak_since_start();
        let refused = found.expect_err("something is wrong");
        for word in wanted {
            assert!(refused.contains(word), "{refused}: wanted {word}");
        }
        assert!(
            refused.contains(folder.path("a").to_str().expect("UTF-8")),
            "{refused}"
        );
        assert!(memory < BESIDE_BYTES, "{refused}: {memory} bytes");
    }
    let deep = [
        b"{\"type\":\"LineString\",\"coordinates\":".to_vec(),
        vec![b'['; 100_000],
    ]
    .concat();
    read(&folder, "a", &deep).expect_err("no end");
    let small = Limits {
        max_bytes: 100,
        ..Limits::default()
    };
    let refused = read_lines(&folder.path("whole"), &small).expect_err("too large");
    let refused = crate::files::message(&refused);
    assert!(refused.contains("the limit is 100"), "{refused}");
}

fn bases() -> [Vec<u8>; 5] {
    let shapes = [vec![island(), river()], vec![], vec![river()]];
    let text = r#"{"type":"FeatureCollection","features":[
{"type":"Feature","properties":{"name":"a"},"geometry":{"type":"LineString","coordinates":[[1,2],[3,4.5]]}},
{"type":"Feature","properties":null,"geometry":
{"type":"MultiPolygon","coordinates":[[[[1.5,50],[2.5,50.25],[2,51],[1.5,50]],[[0,0],[1,1]]]]}}]}"#;
    [
        shapefile(3, &shapes),
        shapefile(15, &shapes),
        shapefile(23, &shapes),
        text.as_bytes().to_vec(),
        topology(
            r#"{"scale":[0.25,0.25],"translate":[-180,-90]}"#,
            "[[[1440,720],[-1438,-718]],[[726,560],[4,1],[-2,3]]]",
            "[-1,1]",
        )
        .into_bytes(),
    ]
}

#[test]
fn a_file_that_is_cut_anywhere_is_refused() {
    let folder = Folder::new();
    for base in bases() {
        read(&folder, "a", &base).expect("whole");
        for length in 0..base.len() {
            let found = catch_unwind(AssertUnwindSafe(|| read(&folder, "a", &base[..length])));
            let found = found.unwrap_or_else(|_| panic!("cut at {length}: a panic"));
            assert!(found.is_err(), "cut at {length} of {}", base.len());
        }
    }
}

#[test]
fn geographic_lines_survive_mutations() {
    let count = crate::survive::mutations();
    let folder = Folder::new();
    let (mut refused, mut given, mut most) = (0_u64, 0_u64, 0.0_f64);
    let bases = bases();
    for number in 0..count {
        let mut random = Random::new(number);
        let base = &bases[(number % bases.len() as u64) as usize];
        let (bytes, mutation) = mutate(base, &mut random);
        let path = folder.write("a", &bytes);
        memory::start();
        let found = catch_unwind(AssertUnwindSafe(|| read_lines(&path, &Limits::default())));
        let memory = memory::peak_since_start();
        let found = found.unwrap_or_else(|_| panic!("mutation {number}, {mutation:?}: a panic"));
        most = most.max(memory as f64 / (bytes.len() + BESIDE_BYTES) as f64);
        assert!(
            memory <= MOST_TIMES * bytes.len() + BESIDE_BYTES,
            "mutation {number}, {mutation:?}: {memory} bytes of memory for {}",
            bytes.len()
        );
        match found {
            Err(_) => refused += 1,
            Ok(lines) => {
                given += 1;
                let numbers = lines.iter().flatten().flatten();
                assert!(
                    numbers.clone().all(|n| n.abs() <= 360.0),
                    "mutation {number}"
                );
                assert!(lines.iter().all(|line| line.len() > 1), "mutation {number}");
                assert!(
                    mutation != Mutation::Cut,
                    "mutation {number}: lines of a cut file"
                );
            }
        }
    }
    println!("{count} mutations, {refused} refused, {given} read");
    assert!(refused > count / 4 && (given > 0 || count < 1000));
}
