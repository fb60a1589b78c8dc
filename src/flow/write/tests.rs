//! Files of lines read back, and tubes as solids.

use super::{Geography, LineValues, Upright, tubes, write_csv, write_vtp};
use crate::flow::{End, Line, Vertex};
use glam::{DVec3, Vec3, dvec3};

fn vertex(x: f64) -> Vertex {
    Vertex {
        place: dvec3(x, x / 3.0, 0.1 + x),
        time: 60.0 * x,
        speed: 1.0 / (1.0 + x),
    }
}

/// A line in two pieces, and one of a single vertex, which is none.
fn lines() -> Vec<Line> {
    let line = |seed, xs: &[f64], breaks: &[usize]| Line {
        seed,
        vertices: xs.iter().map(|&x| vertex(x)).collect(),
        breaks: breaks.to_vec(),
        ends: [None, Some(End::Crowded)],
    };
    vec![
        line(4, &[8.0, 9.0, 10.0, 0.0, 1.0], &[3]),
        line(5, &[3.0], &[]),
    ]
}

#[test]
fn text_has_every_digit_and_a_number_for_each_piece() {
    let geography = Geography {
        degrees: Some(&|[x, y]| [x / 2.0, y / 4.0]),
        upright: Some(Upright::Height(1000.0)),
    };
    let mut out = Vec::new();
    let values = LineValues::speeds(&lines());
    write_csv(&lines(), &values, geography, &mut out).expect("memory");
    let text = String::from_utf8(out).expect("text");
    let rows: Vec<Vec<f64>> = text
        .lines()
        .skip(1)
        .map(|row| {
            row.split(',')
                .map(|n| n.parse().expect("a number"))
                .collect()
        })
        .collect();
    assert!(text.starts_with("line,time,x,y,z,lon,lat,height,value\n"));
    assert_eq!(
        rows.iter().map(|row| row[0]).collect::<Vec<_>>(),
        [0.0, 0.0, 0.0, 1.0, 1.0]
    );
    for (row, x) in rows.iter().zip([8.0, 9.0, 10.0, 0.0, 1.0]) {
        let v = vertex(x);
        assert_eq!(row[1..5], [v.time, v.place.x, v.place.y, v.place.z]);
        assert_eq!(row[6..], [v.place.y / 4.0, 1000.0 * v.place.z, v.speed]);
        assert!((row[5] - x / 2.0).abs() < 1e-12);
    }
    let mut out = Vec::new();
    write_csv(&lines(), &values, Geography::default(), &mut out).expect("memory");
    let text = String::from_utf8(out).expect("text");
    assert!(
        text.lines().nth(1).is_some_and(|row| row.contains(",,,")),
        "{text}"
    );
}

#[test]
fn levels_without_heights_have_their_numbers_and_no_metres() {
    let geography = Geography {
        degrees: None,
        upright: Some(Upright::Level(2.0)),
    };
    let mut out = Vec::new();
    let values = LineValues::speeds(&lines());
    write_csv(&lines(), &values, geography, &mut out).expect("memory");
    let text = String::from_utf8(out).expect("text");
    assert!(text.starts_with("line,time,x,y,z,lon,lat,level,value\n"));
    let first = text.lines().nth(1).expect("a vertex");
    let level = first.split(',').nth(7).and_then(|n| n.parse().ok());
    assert_eq!(level, Some(0.5 * vertex(8.0).place.z));
}

/// The numbers of an array, by its offset in the markup.
fn block<const N: usize>(file: &[u8], name: &str) -> Vec<[u8; N]> {
    let start = file
        .windows(2)
        .position(|pair| pair == b"\n_")
        .expect("appended data")
        + 2;
    let text = String::from_utf8_lossy(&file[..start]).into_owned();
    let (_, array) = text.split_once(&format!("Name=\"{name}\"")).expect(name);
    let (_, array) = array.split_once("offset=\"").expect("an offset");
    let offset: usize = array[..array.find('"').expect("its end")]
        .parse()
        .expect("a number");
    let from = start + offset;
    let size = u64::from_le_bytes(file[from..from + 8].try_into().expect("8 bytes")) as usize;
    let (numbers, rest) = file[from + 8..from + 8 + size].as_chunks::<N>();
    assert!(rest.is_empty());
    numbers.to_vec()
}

#[test]
fn polydata_has_a_polyline_for_each_piece_with_its_seed_and_cause() {
    let values = LineValues {
        name: "a<\"b".to_owned(),
        numbers: vec![vec![1.0, 2.0, f64::NAN, 4.0, 5.0], vec![6.0]],
    };
    let mut out = Vec::new();
    write_vtp(&lines(), &values, &mut out).expect("memory");
    let floats = |name| -> Vec<f64> {
        block::<8>(&out, name)
            .into_iter()
            .map(f64::from_le_bytes)
            .collect()
    };
    let integers = |name| -> Vec<i64> {
        block::<8>(&out, name)
            .into_iter()
            .map(i64::from_le_bytes)
            .collect()
    };
    let xs = [8.0, 9.0, 10.0, 0.0, 1.0];
    let places: Vec<f64> = xs
        .iter()
        .flat_map(|&x| vertex(x).place.to_array())
        .collect();
    assert_eq!(floats("Points"), places);
    assert_eq!(floats("time"), xs.map(|x| 60.0 * x));
    assert_eq!(floats("speed"), xs.map(|x| vertex(x).speed));
    let named = floats("a&lt;&quot;b");
    assert!(named[2].is_nan() && named[3..] == [4.0, 5.0]);
    assert_eq!(integers("connectivity"), [0, 1, 2, 3, 4]);
    assert_eq!(integers("offsets"), [3, 5]);
    assert_eq!(integers("seed"), [4, 4]);
    assert_eq!(block::<1>(&out, "cause"), [[10], [10]]);
    assert_eq!(block::<1>(&out, "cause_before"), [[0], [0]]);
    assert_eq!(End::ALL.map(End::number), [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]);
}

#[test]
fn a_tube_is_a_closed_solid_of_eight_sides_with_its_colours() {
    let straight = Line {
        vertices: [0.0, 1.0, 1.0, 4.0]
            .map(|x| Vertex {
                place: DVec3::new(x, 2.0, 0.0),
                time: 0.0,
                speed: x,
            })
            .to_vec(),
        breaks: Vec::new(),
        seed: 0,
        ends: [None; 2],
    };
    let mesh = tubes(&[straight], 0.5, |_, i| Vec3::splat(i as f32)).expect("few corners");
    // Three rings of 8 and two middles; 16 triangles a chord, 8 a cap.
    assert_eq!((mesh.positions.len(), mesh.triangles.len()), (26, 48));
    // An octagon of that radius has 2 sqrt(2) r^2.
    let wanted = 4.0 * 8f64.sqrt() * 0.25;
    assert!(
        (mesh.volume() - wanted).abs() < 1e-12,
        "{} {wanted}",
        mesh.volume()
    );
    let colors: Vec<f32> = mesh.colors.iter().step_by(8).map(|c| c.x).collect();
    assert_eq!((mesh.colors.len(), colors), (26, vec![0.0, 1.0, 3.0, 0.0]));
}
