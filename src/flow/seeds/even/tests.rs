//! Distances between lines, and from any place to its line.

use super::{EvenLines, even_stream_lines};
use crate::flow::{Direction, GridField, Limits, Line, Metric, Snapshot};
use crate::volume::Grid;
use glam::{DAffine3, DVec3};

/// The ABC flow in a unit box whose heights are `flat` times as high; the flow is flat too.
fn abc(flat: f64) -> (GridField, Grid) {
    let grid = Grid {
        dims: [32; 3],
        world_from_voxel: DAffine3::from_scale(DVec3::new(1.0, 1.0, flat) / 32.0),
    };
    let wind = Snapshot::from_fn(&grid, |voxel| {
        let [x, y, z] = voxel.map(|i| 6.0 * (f64::from(i) + 0.5) / 32.0);
        let flow = [
            z.sin() + y.cos(),
            x.sin() + z.cos(),
            flat * (y.sin() + x.cos()),
        ];
        Some(flow.map(|n| n as f32))
    });
    let field = GridField::new(grid, vec![(0.0, wind)], Metric::plain(1.0)).expect("a field");
    (field, grid)
}

/// Lines in both directions, of which each is told.
fn even(field: &GridField, grid: &Grid, spacing: EvenLines) -> Vec<Line> {
    let limits = Limits::default();
    let mut told = Vec::new();
    let mut tell = |line: &Line, count: usize| {
        assert_eq!(count, told.len() + 1);
        told.push(line.clone());
    };
    let lines = even_stream_lines(
        field,
        0.0,
        grid,
        spacing,
        Direction::Both,
        &limits,
        &mut tell,
    );
    assert!(told == lines);
    lines
}

/// The distance of two chords, to the ends of one of them.
fn distance(p: DVec3, [a, b]: [DVec3; 2]) -> f64 {
    let along = b - a;
    let part = ((p - a).dot(along) / along.length_squared().max(1e-300)).clamp(0.0, 1.0);
    p.distance(a + part * along)
}

/// The vertices of a line as they are seen.
fn seen(line: &Line, stretch: f64) -> Vec<DVec3> {
    let seen = |v: &crate::flow::Vertex| v.place * DVec3::new(1.0, 1.0, stretch);
    line.vertices.iter().map(seen).collect()
}

fn nearest(p: DVec3, line: &[DVec3]) -> f64 {
    let chords = line.windows(2).map(|pair| distance(p, [pair[0], pair[1]]));
    chords.fold(f64::INFINITY, f64::min)
}

/// What is off where a world is seen `stretch` times as high, and lines are made as if it was `told` times.
fn off(stretch: f64, told: f64) -> Result<(), String> {
    let separation = 1.0 / 8.0;
    let (field, grid) = abc(1.0 / stretch);
    let spacing = EvenLines {
        distance: separation,
        stretch: told,
        most: 2000,
        most_vertices: usize::MAX,
    };
    let lines = even(&field, &grid, spacing);
    assert!(lines.iter().enumerate().all(|(i, line)| line.seed == i));
    let ways: Vec<_> = lines.iter().map(|line| seen(line, stretch)).collect();
    let mut closest = f64::INFINITY;
    for (i, way) in ways.iter().enumerate() {
        for other in &ways[..i] {
            for &place in way {
                closest = closest.min(nearest(place, other));
            }
        }
    }
    let part = |i: u32| (f64::from(i) + 0.5) / 12.0;
    let places =
        (0..12 * 12 * 12).map(|i| DVec3::new(part(i % 12), part(i / 12 % 12), part(i / 144)));
    let gap = |p| {
        let all = ways.iter().map(|way| nearest(p, way));
        all.fold(f64::INFINITY, f64::min)
    };
    let mut gaps: Vec<f64> = places.map(gap).collect();
    gaps.sort_by(f64::total_cmp);
    let at = |share: f64| gaps[(share * (gaps.len() - 1) as f64) as usize] / separation;
    let found = [closest / separation, at(0.95), at(1.0)];
    // Samples are an eighth of the distance apart: sqrt(.25 - 2 / 256) of it between two chords.
    let is_even = found[0] >= 0.49 && found[1] <= 1.0 && found[2] <= 1.5;
    let count = lines.len();
    match (60..300).contains(&count) && is_even {
        true => Ok(()),
        false => Err(format!("{count} lines, closest and gaps {found:.2?}")),
    }
}

#[test]
fn lines_stay_half_the_distance_apart_and_leave_no_gap_in_the_world_as_it_is_seen() {
    for stretch in [1.0, 10.0] {
        assert_eq!(off(stretch, stretch), Ok(()), "{stretch} times as high");
    }
    let as_it_is =
        off(10.0, 1.0).expect_err("distances in the world as it is are seen to be wrong");
    println!("{as_it_is}");
}

#[test]
fn no_more_lines_come_than_are_wanted_and_the_same_each_time() {
    let (field, grid) = abc(1.0);
    let few = EvenLines {
        most: 5,
        ..EvenLines::of(&grid, 1.0)
    };
    let make = || even(&field, &grid, few);
    let lines = make();
    assert_eq!(lines.len(), 5);
    // Nor any more once these have so many vertices.
    let counts = lines.iter().map(|line| line.vertices.len());
    let counts: Vec<usize> = counts.collect();
    for most_vertices in [1, counts[0], counts[0] + 1, counts[..3].iter().sum()] {
        let some = even(
            &field,
            &grid,
            EvenLines {
                most_vertices,
                ..few
            },
        );
        let made: usize = counts[..some.len()].iter().sum();
        let before = made - counts[some.len() - 1];
        assert!(some == lines[..some.len()] && made >= most_vertices && before < most_vertices);
    }
    assert!(lines == make());
    assert!((few.distance - 3f64.sqrt() / 24.0).abs() < 1e-12);
}
