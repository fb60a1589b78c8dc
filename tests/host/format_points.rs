//! Scattered points: which column is which, where rows lie in the world, and what is refused.
#![cfg(feature = "files")]

use crate::files::{Folder, message, numbers};
use crate::truth;
use glam::{DVec3, dvec3};
use std::path::Path;
use stratavox::format::{
    self, NoColumns, PointColumns, PointFile, holds_points, open_npy, open_points,
};
use stratavox::points::Points;
use stratavox::volume::{Format, Limits, Source, TimeComponent, Volume, VolumeSelection, VoxelBox};

/// Kilometres of a degree of latitude, by the Earth's mean radius.
const DEGREE: f64 = 6371.0088 * std::f64::consts::PI / 180.0;

fn read_as(name: &str, bytes: impl AsRef<[u8]>, columns: &str) -> Result<PointFile, String> {
    let folder = Folder::new();
    let path = folder.write(name, bytes);
    let columns = match columns {
        "" => PointColumns::default(),
        words => words.parse().expect("columns"),
    };
    open_points(&path, &columns, &Limits::default()).map_err(|error| message(&error))
}

#[track_caller]
fn read(name: &str, bytes: impl AsRef<[u8]>) -> PointFile {
    read_as(name, bytes, "").unwrap_or_else(|error| panic!("{error}"))
}

#[track_caller]
fn refused(name: &str, bytes: impl AsRef<[u8]>) -> String {
    match read_as(name, bytes, "") {
        Ok(file) => panic!("{:?}", file.points()),
        Err(message) => message,
    }
}

fn notes(file: &PointFile) -> String {
    file.header().notes.join("\n")
}

fn is_near(found: DVec3, wanted: DVec3) -> bool {
    (found - wanted).abs().max_element() < 1e-9
}

#[test]
fn earthquakes_lie_under_the_earth_with_their_magnitudes() {
    let Some(folder) = truth::folder() else {
        return;
    };
    let path = folder.join("points-quakes/earthquakes.csv");
    assert!(holds_points(&path));
    let limits = Limits::default();
    let file = open_points(&path, &PointColumns::default(), &limits).unwrap();
    let (points, header) = (file.points(), file.header());
    assert_eq!(points.len(), 1707);
    assert_eq!(points.value_range(), [-0.8_f32, 6.4].map(f64::from));
    assert_eq!(header.format, Format::Csv);
    assert_eq!(header.long_name.as_deref(), Some("magnitude"));
    assert!(header.is_earth);
    assert_eq!(header.length_metres, Some(1000.0));
    let [Some(along_x), Some(along_y)] = header.degree_lengths else {
        panic!("{:?}", header.degree_lengths)
    };
    assert!((along_y - DEGREE).abs() < 1e-9);
    let text = std::fs::read_to_string(&path).unwrap();
    let latitudes = text.lines().skip(1).map(|line| {
        let mut fields = line.split(',');
        fields.nth(1).unwrap().parse::<f64>().unwrap()
    });
    let latitudes: Vec<f64> = latitudes.collect();
    let low = latitudes.iter().copied().fold(f64::INFINITY, f64::min);
    let high = latitudes.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let middle: f64 = 0.5 * (low + high);
    assert!((along_x - DEGREE * middle.to_radians().cos()).abs() < 1e-9);
    let first = dvec3(-118.6671667 * along_x, 34.4945 * along_y, -26.49);
    assert!(is_near(points.places()[0], first), "{}", points.places()[0]);
    assert_eq!(points.values()[0], 2.0);
    for words in [
        "the value of a point is magnitude",
        "points at the place of one before them: 1",
        "degrees are lengths at latitude",
    ] {
        assert!(notes(&file).contains(words), "{}", notes(&file));
    }
    assert!(!notes(&file).contains("dropped"), "{}", notes(&file));
    // As a volume it opens as all files do.
    let source = format::open(&path, &VolumeSelection::default(), &limits).unwrap();
    assert_eq!(source.header(), header);
}

#[test]
fn columns_are_found_by_their_names() {
    let km = |x: f64| 5.574_380 + x;
    for (names, row, place, value) in [
        ("x,y,z,v", "1,2,3,4", dvec3(1.0, 2.0, 3.0), 4.0),
        ("v,Z,Y,X", "4,3,2,1", dvec3(1.0, 2.0, 3.0), 4.0),
        ("x_km,y_m,z_KM,v", "1,2000,3,4", dvec3(1.0, 2.0, 3.0), 4.0),
        ("x,y,depth,v", "1,2,3,4", dvec3(1.0, 2.0, -3.0), 4.0),
        ("x,y,altitude,v", "1,2,3,4", dvec3(1.0, 2.0, 3.0), 4.0),
        (
            "lon,lat,height_m,v",
            "0,1,2500,4",
            dvec3(0.0, DEGREE, 2.5),
            4.0,
        ),
        (
            "Longitude,LATITUDE,depth_m,v",
            "0,1,2500,4",
            dvec3(0.0, DEGREE, -2.5),
            4.0,
        ),
        (
            "lon,lat,depth,v",
            "0,1,2.5,4",
            dvec3(0.0, DEGREE, -2.5),
            4.0,
        ),
        (
            "lat,lon,depth_km,id,time,,v",
            "1,0,0,5,6,7,4",
            dvec3(0.0, DEGREE, 0.0),
            4.0,
        ),
        (
            "place,lon,lat,depth_km,v",
            "7 km E,0,1,1,4",
            dvec3(0.0, DEGREE, -1.0),
            4.0,
        ),
        (
            "x,y,z,weight,std,a,b",
            "1,2,3,9,8,4,5",
            dvec3(1.0, 2.0, 3.0),
            4.0,
        ),
        ("x,y,lon,lat,z,v", "1,2,3,4,5,6", dvec3(1.0, 2.0, 5.0), 3.0),
    ] {
        let file = read("a.csv", format!("{names}\n{row}\n"));
        let points = file.points();
        assert!(
            is_near(points.places()[0], place),
            "{names}: {}",
            points.places()[0]
        );
        assert_eq!(points.values(), [value], "{names}");
    }
    for names in ["lon,lat,pressure_hPa,v", "lon,lat,pressure,v"] {
        let file = read("a.csv", format!("{names}\n0,0,500,4\n0,1,1013.25,4\n"));
        let places = file.points().places();
        assert!((places[0].z - km(0.0)).abs() < 1e-3, "{}", places[0]);
        assert!(places[1].z.abs() < 1e-9, "{}", places[1]);
        assert!(notes(&file).contains("standard atmosphere"));
        assert_eq!(
            notes(&file).contains("hPa are taken"),
            names.contains("pressure,")
        );
    }
}

#[test]
fn standard_deviations_and_weights_are_columns() {
    let file = read(
        "a.csv",
        "lon,lat,depth_m,v_m,std_m,weight\n0,0,0,1,500,2\n1,0,0,1,1500,0\n",
    );
    let points = file.points();
    assert_eq!(points.stds(), [0.5, 1.5]);
    assert_eq!([points.weight(0), points.weight(1)], [2.0, 0.0]);
    assert_eq!(file.header().long_name.as_deref(), Some("v"));
    assert_eq!(file.header().unit.as_deref(), Some("m"));
    assert!(!notes(&file).contains("no standard deviations"));
    let plain = read("a.csv", "x,y,z,v\n0,0,0,1\n3,0,0,1\n");
    assert_eq!(plain.points().stds(), [1.5, 1.5]);
    assert_eq!(plain.points().weight(0), 1.0);
    assert_eq!(plain.header().length_metres, None);
    assert!(!plain.header().is_earth);
}

#[test]
fn a_person_names_columns() {
    let table = "a,b,depth_km,c,s,w,lon,lat\n1,2,3,4,5,6,7,8\n";
    let columns = "x=A, y=b,z=depth_km,value=c,std=s,weight=w";
    let file = read_as("a.csv", table, columns).unwrap();
    let points = file.points();
    assert_eq!(points.places(), [dvec3(1.0, 2.0, -3.0)]);
    assert_eq!(
        (points.values()[0], points.stds()[0], points.weight(0)),
        (4.0, 5.0, 6.0)
    );
    let usgs = "time,latitude,longitude,depth,mag,magType\n2020-01-01,0,1,2,3,ml\n";
    let file = read_as("a.csv", usgs, "value=mag").unwrap();
    assert!(is_near(file.points().places()[0], dvec3(DEGREE, 0.0, -2.0)));
    assert!(notes(&file).contains("the column depth has no unit: km are taken"));
    for (columns, words) in [
        (
            "value=d",
            "csv field `value`: wanted the column d, found `a, b, depth_km",
        ),
        (
            "x=lat,y=b",
            "field `x`: wanted a column that measures along x, found `lat`",
        ),
        ("z=lon", "field `z`"),
    ] {
        let message = read_as("a.csv", table, columns).unwrap_err();
        assert!(message.contains(words), "{message}");
    }
    for (words, wanted) in [
        ("x", NoColumns::NoName("x".to_owned())),
        ("x=", NoColumns::NoName("x=".to_owned())),
        ("=lon", NoColumns::NoName("=lon".to_owned())),
        ("x=a,,y=b", NoColumns::NoName(String::new())),
        ("", NoColumns::NoName(String::new())),
        ("u=a", NoColumns::UnknownKey("u".to_owned())),
        ("x=a,x=b", NoColumns::Twice("x")),
    ] {
        let error = words.parse::<PointColumns>().unwrap_err();
        assert_eq!(error, wanted, "{words}");
        let text = error.to_string();
        assert!(text.contains("key=name") || text.contains("x"), "{text}");
    }
}

#[test]
fn a_variable_of_the_selection_is_the_value() {
    let folder = Folder::new();
    let path = folder.write("a.csv", "x,y,z,u,v\n0,0,0,1,2\n1,0,0,1,2\n");
    let open = |variable: Option<&str>| {
        let wanted = VolumeSelection {
            variable: variable.map(str::to_owned),
            ..VolumeSelection::default()
        };
        format::open(&path, &wanted, &Limits::default())
    };
    assert_eq!(open(None).unwrap().header().variables, ["u", "v"]);
    assert_eq!(open(Some("v")).unwrap().header().variables, ["v", "u"]);
    assert!(open(Some("w")).is_err());
}

#[test]
fn tables_are_the_same_however_they_are_written() {
    let plain = read("a.csv", "x,y,z,v\n1,2,3,4\n5,6,7,8\n");
    for (name, text) in [
        ("a.csv", "x,y,z,v\r\n1,2,3,4\r\n5,6,7,8\r\n"),
        (
            "a.CSV",
            "# made by hand\n\n# x,y\nx,y,z,v\n\n1,2,3,4\n   \n5,6,7,8\n\n",
        ),
        (
            "a.csv",
            "\u{feff}\"x\",\"y\",\"z\",\"v\"\n\"1\",\"2\",\"3\",\"4\"\n5,6,7,8\n",
        ),
        (
            "a.csv",
            "name,x,y,z,v\n\"a, \"\"b\"\"\n\",1,2,3,4\n,5,6,7,8\n",
        ),
        (
            "a.csv",
            " x , y , z , v \n 1 , 2 ,3 ,4e0\n5.0,+6,0.7e1,8.\n",
        ),
        ("a.tsv", "x\ty\tz\tv\n1\t2\t3\t4\n5\t6\t7\t8\n"),
        ("a.csv", "x,y,z,v\n1,2,3,4\n5,6,7,8"),
    ] {
        let file = read(name, text);
        assert_eq!(file.points(), plain.points(), "{text:?}");
        let is_open = !text.ends_with('\n');
        assert_eq!(notes(&file).contains("has no end"), is_open, "{text:?}");
    }
}

#[test]
fn rows_without_a_number_are_dropped_and_counted() {
    let bad = [
        "nan,0,0,1,1,1",
        ",0,0,1,1,1",
        "0,inf,0,1,1,1",
        "0,0,-,1,1,1",
        "0,0,0,1e39,1,1",
        "0,0,0,NaN,1,1",
        "0,0,0,1,0,1",
        "0,0,0,1,-1,1",
        "0,0,0,1,1,-1",
        "0,0,0,1,1,inf",
        "0,91,0,1,1,1",
        "361,0,0,1,1,1",
        "0,0,1e31,1,1,1",
    ];
    let table = format!(
        "lon,lat,depth_km,v,std,weight\n1,2,3,4,5,6\n{}\n1,2,3,4,5,6\n7,2,3,4,5,6\n",
        bad.join("\n")
    );
    let file = read("a.csv", &table);
    assert_eq!(file.points().len(), 3);
    let dropped = format!("{} rows were dropped", bad.len());
    assert!(notes(&file).contains(&dropped), "{}", notes(&file));
    assert!(
        notes(&file).contains("points at the place of one before them: 1;"),
        "{}",
        notes(&file)
    );
    let one = read("a.csv", "x,y,z,v\n1,2,3,4\n1,2,x,4\n");
    assert!(notes(&one).contains("1 row was dropped"), "{}", notes(&one));
    let none = refused("a.csv", "x,y,z,v\n1,2,3,4\n".replace('3', "nan"));
    assert!(
        none.contains("at least one row of finite numbers"),
        "{none}"
    );
}

#[test]
fn a_table_that_is_wrong_is_refused_by_line_and_field() {
    for (text, words) in [
        (
            "x,y,z,v\n1,2,3,4\n\n1,2,3\n",
            "csv field `line 4`: wanted 4 fields, one a name, found `3`",
        ),
        (
            "# c\r\nx,y,z,v\r\n1,2,3,4\r\n1,2,3,4,5\r\n",
            "`line 4`: wanted 4 fields, one a name, found `5`",
        ),
        (
            "x,y,z,v\n1,2,3,4\n1,2,3,\"4\n",
            "`line 3`: wanted a quote that ends the field",
        ),
        (
            "x,y,z,v\n1,2,3,\"4\"5\n",
            "`line 2`: wanted a delimiter behind quotes",
        ),
        (
            "x,y,z,v\n1,2,3,4\"\n",
            "`line 2`: wanted quotes around a whole field",
        ),
        ("x,y,z\n1,2,3\n", "has no `value`"),
        ("x,y,z,name\n1,2,3,a\n", "has no `value`"),
        (
            "x,y,v\n1,2,3\n",
            "has no `z, height, altitude, depth or pressure`",
        ),
        ("a,y,z,v\n1,2,3,4\n", "has no `x, lon or longitude`"),
        ("x,b,z,v\n1,2,3,4\n", "has no `y, lat or latitude`"),
        (
            "x,y,z,X,v\n1,2,3,4,5\n",
            "field `x`: wanted one column of that name",
        ),
        (
            "lon,lat,depth_hPa,v\n1,2,3,4\n",
            "wanted a unit of what the column measures",
        ),
        ("x,y,z,v\n", "at least one row"),
        ("# nothing\n", "has no `row of names`"),
        (
            "x,y,z,v\n1e20,0,0,1\n1e20,0,0,1\n",
            "a box of a length that its coordinates can tell",
        ),
    ] {
        let message = refused("a.csv", text);
        assert!(message.contains(words), "{text:?}: {message}");
        assert!(message.contains("a.csv"), "{message}");
    }
}

#[test]
fn limits_hold_for_rows_columns_and_points() {
    let folder = Folder::new();
    let limits = Limits {
        max_bytes: 600,
        max_header_bytes: 100,
        ..Limits::default()
    };
    let row = "1,2,3,4\n";
    for (text, words) in [
        (
            "x,y,z,v\n".to_owned() + &row.repeat(100),
            "the points needs 660 bytes",
        ),
        (
            "x,y,z,v\n".to_owned() + &"1".repeat(101),
            "a row needs 101 bytes",
        ),
        ("\"".to_owned() + &"x\n".repeat(1000), "a row needs"),
    ] {
        let path = folder.write("a.csv", text);
        let error = open_points(&path, &PointColumns::default(), &limits).unwrap_err();
        assert!(message(&error).contains(words), "{}", message(&error));
    }
    let wide = refused("a.csv", ",".repeat(5000));
    assert!(wide.contains("at most 4096 fields"), "{wide}");
}

#[test]
fn as_a_volume_points_are_their_means_and_voxels_without_one_hold_no_data() {
    let file = read("a.csv", "x,y,z,v\n0,0,0,1\n0,0,0,3\n4,2,1,5\n9,0,3,6\n");
    let header = file.header();
    let wanted = file.points().binned();
    assert_eq!(header.dims, wanted.dims);
    assert_eq!(header.world_from_voxel, wanted.world_from_voxel);
    let limits = Limits::default();
    let pick = TimeComponent::default();
    let volume = Volume::read(&file, pick, header.whole(), &limits).unwrap();
    assert_eq!(volume.validity, wanted.validity);
    assert_eq!(volume.value_range, [2.0, 6.0]);
    let valid = volume.validity.as_ref().unwrap();
    let whole = numbers(&file.read(pick, header.whole()).unwrap().voxels);
    for (index, number) in whole.iter().enumerate() {
        assert_eq!(number.is_nan(), valid[index] == 0);
    }
    let [nx, ny, nz] = header.dims;
    let region = VoxelBox {
        min: [3, 1, 2],
        max: [nx - 1, ny, nz - 2],
    };
    let part = numbers(&file.read(pick, region).unwrap().voxels);
    let mut index = 0;
    for z in 2..nz - 2 {
        for y in 1..ny {
            for x in 3..nx - 1 {
                let there = whole[(x + nx * (y + ny * z)) as usize];
                assert_eq!(part[index].to_bits(), there.to_bits());
                index += 1;
            }
        }
    }
    assert_eq!(index, part.len());
    let beyond = VoxelBox {
        min: [0; 3],
        max: [nx + 1, ny, nz],
    };
    assert!(file.read(pick, beyond).is_err());
}

const ROWS: [[f64; 6]; 3] = [
    [1.0, 2.0, 3.0, 4.5, 0.5, 1.0],
    [-1.0, 0.25, 7.0, -2.0, 0.25, 2.0],
    [2.0, 2.5, 1.0, 8.0, 1.0, 0.0],
];

fn truth_of(columns: usize) -> Points {
    let column = |k: usize| ROWS.map(|row| row[k] as f32).to_vec();
    let places = ROWS.map(|[x, y, z, ..]| dvec3(x, y, z)).to_vec();
    let stds = (columns > 4).then(|| column(4));
    let weights = (columns > 5).then(|| column(5));
    Points::new(places, column(3), stds, weights).unwrap()
}

/// With an element before the vertices, and one behind.
fn ply(encoding: &str) -> Vec<u8> {
    let mut file = format!(
        "ply\nformat {encoding} 1.0\ncomment a test\nelement camera 2\nproperty short a\nproperty double b\n\
         element vertex 3\nproperty float x\nproperty double y\nproperty float64 z\nproperty float32 v\n\
         property uchar red\nproperty float std\nproperty float weight\nelement face 0\n\
         property list uchar int vertex_indices\nend_header\n"
    )
    .into_bytes();
    let big = encoding.contains("big");
    let mut put = |bytes: &[u8]| match big {
        true => file.extend(bytes.iter().rev()),
        false => file.extend(bytes),
    };
    for [x, y, z, v, std, weight] in ROWS {
        if encoding != "ascii" {
            if x == ROWS[0][0] {
                for _ in 0..2 {
                    put(&7_i16.to_le_bytes());
                    put(&9_f64.to_le_bytes());
                }
            }
            put(&(x as f32).to_le_bytes());
            put(&y.to_le_bytes());
            put(&z.to_le_bytes());
            put(&(v as f32).to_le_bytes());
            put(&[200]);
            put(&(std as f32).to_le_bytes());
            put(&(weight as f32).to_le_bytes());
        }
    }
    if encoding == "ascii" {
        file.extend(b"7 9\n7 9\n");
        for [x, y, z, v, std, weight] in ROWS {
            file.extend(format!("{x} {y} {z} {v} 200 {std} {weight}\n").bytes());
        }
    }
    file
}

#[test]
fn vertices_of_ply_are_points_in_words_and_bytes_of_both_orders() {
    for encoding in ["ascii", "binary_little_endian", "binary_big_endian"] {
        let bytes = ply(encoding);
        let file = read("a.ply", &bytes);
        assert_eq!(**file.points(), truth_of(6), "{encoding}");
        assert_eq!(file.header().format, Format::Ply);
        assert_eq!(file.header().variables, ["v", "red"]);
        // What it holds counts.
        assert_eq!(read("a.csv", &bytes).points(), file.points());
        let red = read_as("a.ply", &bytes, "value=red").unwrap();
        assert_eq!(red.points().values(), [200.0; 3]);
        for cut in 0..bytes.len() {
            refused("a.ply", &bytes[..cut]);
        }
    }
    let text = String::from_utf8(ply("ascii"))
        .unwrap()
        .replace('\n', "\r\n");
    assert_eq!(**read("a.ply", text).points(), truth_of(6));
    let holey = String::from_utf8(ply("ascii"))
        .unwrap()
        .replace("-2 200", "nan 200");
    let holey = read("a.ply", holey);
    assert_eq!(holey.points().len(), 2);
    assert!(notes(&holey).contains("1 row was dropped"));
}

#[test]
fn ply_files_of_other_kinds_and_lies_are_refused() {
    let good = String::from_utf8(ply("ascii")).unwrap();
    for (from, to, words) in [
        (
            "face 0",
            "face 1",
            "a mesh (a file with faces) is not supported",
        ),
        ("vertex 3", "vertex 30", "element vertex"),
        ("vertex 3", "vertex 18446744073709551615", "element vertex"),
        (
            "vertex 3",
            "vertex 18446744073709551616",
            "a whole number of elements",
        ),
        ("vertex 3", "vertex -3", "a whole number of elements"),
        ("camera 2", "camera 18446744073709551615", "element vertex"),
        ("vertex 3", "vertices 3", "has no `element vertex`"),
        (
            "float32 v",
            "list uchar int v",
            "a list as a property of vertices",
        ),
        ("format ascii 1.0", "format ascii 2.0", "version 2.0"),
        ("format ascii 1.0", "format utf8 1.0", "`line 2`"),
        ("format ascii 1.0", "comment", "has no `format`"),
        (
            "property short",
            "property half",
            "`line 5`: wanted the type and name",
        ),
        ("element camera 2\n", "", "an element before it"),
        (
            "200 0.25",
            "0.25",
            "`line 21`: wanted 7 numbers, one a property, found `6`",
        ),
        ("end_header", "end", "a line of a PLY header"),
    ] {
        assert!(good.contains(from), "{from}");
        let message = refused("a.ply", good.replacen(from, to, 1));
        assert!(message.contains(words), "{to}: {message}");
    }
    for encoding in ["binary_little_endian", "binary_big_endian"] {
        let bytes = ply(encoding);
        for count in ["4", "4294967296", "18446744073709551615"] {
            let at = bytes.windows(8).position(|w| w == b"vertex 3").unwrap() + 7;
            let file = [&bytes[..at], count.as_bytes(), &bytes[at + 1..]].concat();
            let message = refused("a.ply", file);
            assert!(message.contains("element vertex"), "{count}: {message}");
        }
    }
    let splats = "ply\nformat binary_little_endian 1.0\nelement vertex 0\nproperty float x\nproperty float y\n\
                  property float z\nproperty float f_dc_0\nproperty float opacity\nproperty float scale_0\n\
                  property float rot_0\nend_header\n";
    assert!(refused("a.ply", splats).contains("Gaussian splats (3DGS"));
    let not = refused("a.ply", "hello\n");
    assert!(not.contains("ply field `line 1`: wanted ply"), "{not}");
}

fn npy(descr: &str, shape: &str, fortran: bool, columns: usize) -> Vec<u8> {
    let order = if fortran { "True" } else { "False" };
    let header = format!("{{'descr': '{descr}', 'fortran_order': {order}, 'shape': {shape}, }}\n");
    let mut file = b"\x93NUMPY\x01\0".to_vec();
    file.extend((header.len() as u16).to_le_bytes());
    file.extend(header.bytes());
    let mut put = |number: f64| {
        let mut bytes = match descr.ends_with('8') {
            true => number.to_le_bytes().to_vec(),
            false => (number as f32).to_le_bytes().to_vec(),
        };
        if descr.starts_with('>') {
            bytes.reverse();
        }
        file.extend(bytes);
    };
    match fortran {
        true => (0..columns).for_each(|k| ROWS.iter().for_each(|row| put(row[k]))),
        false => ROWS
            .iter()
            .for_each(|row| row[..columns].iter().for_each(|&n| put(n))),
    }
    file
}

#[test]
fn arrays_of_rows_are_points() {
    let folder = Folder::new();
    let limits = Limits::default();
    for descr in ["<f4", ">f4", "<f8", ">f8"] {
        for fortran in [false, true] {
            for columns in 4..=6 {
                let bytes = npy(descr, &format!("(3, {columns})"), fortran, columns);
                let path = folder.write("a.npy", &bytes);
                let file = open_npy(&path, &limits).unwrap();
                assert_eq!(
                    **file.points(),
                    truth_of(columns),
                    "{descr} {fortran} {columns}"
                );
                assert_eq!(file.header().format, Format::Npy);
                assert_eq!(read("a.npy", &bytes).points(), file.points());
                for cut in (0..bytes.len()).rev().step_by(5) {
                    let path = folder.write("cut.npy", &bytes[..cut]);
                    assert!(open_npy(&path, &limits).is_err(), "{cut}");
                }
            }
        }
    }
    assert!(!holds_points(Path::new("a.npy")));
    for (descr, shape, words) in [
        (
            "<f4",
            "(3, 3)",
            "a table of points, (N, 4) to (N, 6), found `(3, 3)`",
        ),
        ("<f4", "(3, 7)", "a table of points"),
        ("<f4", "(0, 4)", "a table of points"),
        ("<f4", "(12,)", "a table of points"),
        ("<f4", "(1, 3, 4)", "a table of points"),
        ("<i4", "(3, 4)", "points of f32 or f64"),
        ("<f4", "(4294967295, 4)", "promises"),
        ("<f4", "(4294967296, 4)", "a table of points"),
    ] {
        let path = folder.write("a.npy", npy(descr, shape, false, 4));
        let message = message(&open_npy(&path, &limits).unwrap_err());
        assert!(message.contains(words), "{shape}: {message}");
    }
    let named = read_as("a.npy", npy("<f4", "(3, 4)", false, 4), "value=v").unwrap_err();
    assert!(named.contains("columns of an array have none"), "{named}");
}

fn vtp(binary: bool) -> Vec<u8> {
    let column = |k: usize| ROWS.map(|row| row[k]).to_vec();
    let places: Vec<f64> = ROWS.iter().flat_map(|row| row[..3].to_vec()).collect();
    let mut appended = b"_".to_vec();
    let mut array = |name: &str, components: usize, numbers: Vec<f64>| {
        let head = format!(
            "<DataArray type=\"Float64\" Name=\"{name}\" NumberOfComponents=\"{components}\""
        );
        if binary {
            let offset = appended.len() - 1;
            appended.extend((8 * numbers.len() as u32).to_le_bytes());
            appended.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
            return format!("{head} format=\"appended\" offset=\"{offset}\"/>");
        }
        let words: Vec<String> = numbers.iter().map(f64::to_string).collect();
        format!("{head} format=\"ascii\">{} </DataArray>", words.join(" "))
    };
    let body = [
        array("other", 1, vec![9.0; 3]),
        array("X", 1, vec![9.0; 3]),
        array("v", 1, column(3)),
        array("std", 1, column(4)),
        array("weight", 1, column(5)),
        array("flow", 3, vec![0.0; 9]),
    ]
    .concat();
    let places = array("Points", 3, places);
    let mut file = format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\">\
         <PolyData><Piece NumberOfPoints=\"3\" NumberOfVerts=\"0\" NumberOfPolys=\"0\">\
         <PointData Scalars=\"v\">{body}</PointData><Points>{places}</Points></Piece></PolyData>"
    )
    .into_bytes();
    if binary {
        file.extend(b"<AppendedData encoding=\"raw\">");
        file.extend(appended);
        file.extend(b"</AppendedData>");
    }
    file.extend(b"</VTKFile>\n");
    file
}

#[test]
fn points_of_polydata_have_an_array_as_their_value() {
    for binary in [false, true] {
        let bytes = vtp(binary);
        let file = read("a.vtp", &bytes);
        assert_eq!(**file.points(), truth_of(6));
        assert_eq!(file.header().format, Format::Vtp);
        assert_eq!(file.header().variables, ["v", "other"]);
        let other = read_as("a.vtp", &bytes, "value=other").unwrap();
        assert_eq!(other.points().values(), [9.0; 3]);
        let folder = Folder::new();
        let (header, _) = folder.read("a.xml", &bytes).unwrap();
        assert_eq!(header.format, Format::Vtp);
        // But for the white space behind it every byte counts.
        for cut in (0..bytes.len() - 1).rev().step_by(11) {
            refused("a.vtp", &bytes[..cut]);
        }
    }
    let good = String::from_utf8(vtp(false)).unwrap();
    for (from, to, words) in [
        (
            "NumberOfPolys=\"0\"",
            "NumberOfPolys=\"1\"",
            "a mesh (PolyData with polygons or strips)",
        ),
        (
            "NumberOfPoints=\"3\"",
            "NumberOfPoints=\"4294967295\"",
            "cannot hold",
        ),
        (
            "NumberOfPoints=\"3\"",
            "NumberOfPoints=\"4294967296\"",
            "a number below 2^32",
        ),
        (
            "NumberOfPoints=\"3\"",
            "NumberOfPoints=\"0\"",
            "has no `Piece`",
        ),
        ("NumberOfPoints=\"3\"", "", "has no `NumberOfPoints`"),
        (
            "\"Points\" NumberOfComponents=\"3\"",
            "\"Points\" NumberOfComponents=\"2\"",
            "3 for Points",
        ),
        ("<Points>", "<Paints>", "vti field `markup`"),
    ] {
        assert!(good.contains(from), "{from}");
        let message = refused("a.vtp", good.replacen(from, to, 1));
        assert!(message.contains(words), "{to}: {message}");
    }
    let message = read_as("a.vtp", &good, "x=other").unwrap_err();
    assert!(
        message.contains("places that are those of the points"),
        "{message}"
    );
}
