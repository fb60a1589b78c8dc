//! Lines over the seam of a map of the globe.

use super::split;
use crate::flow::{
    Absence, Direction, End, GridField, Horizontal, Limits, Line, Metric, Snapshot, VectorField,
    Vertex, Vertical, stream_lines,
};
use crate::volume::Grid;
use glam::{DAffine3, DVec3, dvec3};

fn one(field: &GridField, seed: DVec3) -> Line {
    stream_lines(field, 0.0, &[seed], Direction::Forward, &Limits::default()).remove(0)
}

#[test]
fn a_way_over_the_seam_is_in_pieces_that_meet_it() {
    let vertex = |x: f64| Vertex {
        place: dvec3(x, 2.0 * x, 0.0),
        time: x,
        speed: 1.0,
    };
    let way = [8.0, 9.5, 10.5, 11.0, 9.75].map(vertex).to_vec();
    assert_eq!(split(way.clone(), None), (way.clone(), vec![]));
    let (vertices, breaks) = split(way, Some([0.0, 10.0]));
    let xs: Vec<f64> = vertices.iter().map(|v| v.place.x).collect();
    assert_eq!(xs, [8.0, 9.5, 10.0, 0.0, 0.5, 1.0, 0.0, 10.0, 9.75]);
    assert_eq!(breaks, [3, 7]);
    // Other coordinates and the time go on.
    assert_eq!((vertices[2].place.y, vertices[3].time), (20.0, 10.0));
    assert_eq!((vertices[7].place.y, vertices[6].time), (20.0, 10.0));
}

/// Once around the equator in pieces, closed where it began, with no chord over the map.
#[test]
fn a_line_goes_on_at_the_other_side_of_a_closed_globe() {
    let per_degree = 111.0;
    let affine = DAffine3::from_mat3_translation(
        glam::DMat3::from_diagonal(dvec3(5.0 * per_degree, 5.0 * per_degree, 1.0)),
        dvec3(-2.5 * per_degree, -42.5 * per_degree, 0.0),
    );
    let metric = Metric {
        world_per_metre: 1e-3,
        horizontal: Horizontal::Degrees {
            x: per_degree,
            y: per_degree,
        },
        vertical: Vertical::Metres,
    };
    let field = |columns: u32| {
        let grid = Grid {
            dims: [columns, 17, 2],
            world_from_voxel: affine,
        };
        // Faster in the east, so that the wind at the seam is that of neither side.
        let wind = Snapshot::from_fn(&grid, move |[x, ..]| {
            Some([10.0 + 0.1 * x as f32, 0.0, 0.0])
        });
        GridField::new(grid, vec![(0.0, wind)], metric.clone()).expect("a field")
    };
    let seed = dvec3(300.0 * per_degree, 0.0, 1.0);
    let line = one(&field(72), seed);
    assert_eq!(line.ends, [None, Some(End::Closed)]);
    assert_eq!(line.breaks.len(), 1);
    let pieces: Vec<_> = line.pieces().collect();
    let [low, high] = [-2.5, 357.5].map(|x| x * per_degree);
    let ends =
        [pieces[0], pieces[1]].map(|piece| [piece[0], piece[piece.len() - 1]].map(|v| v.place.x));
    assert_eq!(ends, [[seed.x, high], [low, seed.x]]);
    for pair in pieces.iter().flat_map(|piece| piece.windows(2)) {
        assert!(
            (pair[1].place.x - pair[0].place.x).abs() < 6.0 * per_degree,
            "a chord"
        );
    }
    // At the seam the wind is half of 17.1 and half of 10.
    let speed = field(72)
        .speed(0.0, dvec3(high, 0.0, 1.0))
        .expect("a speed");
    assert!((speed - 13.55).abs() < 1e-4, "{speed}");
    // A grid of 355 degrees ends.
    let line = one(&field(71), seed);
    assert_eq!(line.ends[1], Some(End::Absence(Absence::Domain)));
    assert!(line.breaks.is_empty());
}
