//! Lines in fields whose lines are known, and each reason why one ends.

use super::{in_order, line};
use crate::flow::{
    Absence, Direction, End, GridField, Horizontal, Limits, Line, Metric, Snapshot, VectorField,
    Vertical, path_lines, stream_lines,
};
use crate::volume::Grid;
use glam::{DAffine3, DVec3, dvec3};

fn grid(dims: [u32; 3]) -> Grid {
    Grid {
        dims,
        world_from_voxel: DAffine3::IDENTITY,
    }
}

/// A field of one instant on voxels of side 1: trilinear, and exact where `wind` is linear.
fn field(dims: [u32; 3], wind: impl Fn(DVec3) -> DVec3) -> GridField {
    let grid = grid(dims);
    let at = |voxel: [u32; 3]| {
        let found = wind(DVec3::from(voxel.map(f64::from)) + 0.5);
        Some(found.to_array().map(|n| n as f32))
    };
    let wind = Snapshot::from_fn(&grid, at);
    GridField::new(grid, vec![(0.0, wind)], Metric::plain(1.0)).expect("a field")
}

fn one(field: &GridField, seed: DVec3, direction: Direction, limits: &Limits) -> Line {
    stream_lines(field, 0.0, &[seed], direction, limits).remove(0)
}

const CENTER: DVec3 = DVec3::splat(10.0);

fn rotation(p: DVec3) -> DVec3 {
    let q = p - CENTER;
    dvec3(-q.y, q.x, 0.0)
}

#[test]
fn a_line_around_a_center_is_a_circle_and_closes() {
    let field = field([20; 3], rotation);
    let seed = CENTER + dvec3(6.0, 0.0, 0.3);
    let line = one(&field, seed, Direction::Forward, &Limits::default());
    assert_eq!(line.ends, [None, Some(End::Closed)]);
    assert_eq!(line.vertices[0].place, seed);
    assert_eq!(line.vertices.last().map(|v| v.place), Some(seed));
    for pair in line.vertices.windows(2) {
        let radius = (pair[0].place - CENTER).truncate().length();
        // Steps of a cell are off by a thousandth of a cell each at most, 2 pi 6 of them in turn.
        assert!((radius - 6.0).abs() < 38.0 * 1e-3, "{radius}");
        let way = (pair[1].place - pair[0].place).abs().max_element();
        // The last one goes on to the seed.
        let most = if pair[1].place == seed {
            1.2
        } else {
            1.0 + 1e-9
        };
        assert!(way <= most, "a step of {way} cells");
        // The speed is the radius, in a field of f32.
        assert!((pair[0].speed - radius).abs() < 1e-5, "{pair:?}");
        assert_eq!(pair[0].place.z, pair[1].place.z, "no upward wind");
    }
    // Twice the tolerance lies on the circle of a tenth of that: it is heeded.
    let exact = Limits {
        tolerance: 1e-9,
        ..Limits::default()
    };
    let line = one(&field, seed, Direction::Forward, &exact);
    let off = |v: &crate::flow::Vertex| ((v.place - CENTER).truncate().length() - 6.0).abs();
    let worst = line.vertices.iter().map(off).fold(0.0, f64::max);
    assert!(worst < 1e-6, "{worst}");
}

#[test]
fn chords_stay_within_a_twentieth_of_a_cell() {
    // A circle of two cells: a step of a cell bends by half a radian.
    let field = field([20; 3], rotation);
    let line = one(
        &field,
        CENTER + 2.0 * DVec3::X,
        Direction::Forward,
        &Limits::default(),
    );
    for pair in line.vertices.windows(2) {
        let middle = 0.5 * (pair[0].place + pair[1].place);
        let sagitta = 2.0 - (middle - CENTER).truncate().length();
        assert!(sagitta < 0.06, "{sagitta}");
    }
}

#[test]
fn lines_end_at_the_border_at_holes_at_the_ground_and_say_so() {
    let even = field([12, 6, 6], |_| dvec3(3.0, 0.0, 0.0));
    let seed = dvec3(4.3, 3.0, 3.0);
    let line = one(&even, seed, Direction::Both, &Limits::default());
    assert_eq!(line.ends, [Some(End::Absence(Absence::Domain)); 2]);
    let [first, last] = [0, line.vertices.len() - 1].map(|i| line.vertices[i]);
    // The last step is the shortest: a thousandth of a cell from the border.
    assert!(
        first.place.x < 1e-3 && last.place.x > 12.0 - 1e-3,
        "{first:?} {last:?}"
    );
    assert!((last.time - first.time - (last.place.x - first.place.x) / 3.0).abs() < 1e-9);
    assert!(
        line.vertices
            .iter()
            .any(|v| v.place == seed && v.time == 0.0)
    );

    let grid = grid([12, 6, 6]);
    let wind = Snapshot::from_fn(&grid, |[x, ..]| (x != 9).then_some([3.0, 0.0, 0.0]));
    let holes = GridField::new(grid, vec![(0.0, wind)], Metric::plain(1.0)).expect("a field");
    let at = |x| holes.velocity(0.0, dvec3(x, 3.0, 3.0));
    // At the centre of the voxel beside it a hole has no weight.
    assert!(at(8.5).is_ok() && at(8.5 + 1e-9) == Err(Absence::NoData));
    let line = one(&holes, seed, Direction::Forward, &Limits::default());
    assert_eq!(line.ends[1], Some(End::Absence(Absence::NoData)));
    // The voxel beside the hole has its centre at 8.5: farther on the hole has a weight.
    let end = line.vertices.last().expect("vertices").place.x;
    assert!((8.5 - 1e-3..=8.5).contains(&end), "{end}");

    let slope = even.over_ground((0..12 * 6).map(|i| f64::from(i % 12) / 2.0).collect());
    let line = one(
        &slope.expect("ground"),
        seed,
        Direction::Forward,
        &Limits::default(),
    );
    assert_eq!(line.ends[1], Some(End::Absence(Absence::Ground)));
    // The ground is (x - 1/2) / 2 high there: 3 at 6.5.
    let end = line.vertices.last().expect("vertices").place.x;
    assert!((6.5 - 1e-3..=6.5).contains(&end), "{end}");
}

#[test]
fn lines_end_where_nothing_moves_and_at_each_limit() {
    let sink = field([20; 3], |p| CENTER - p);
    let line = one(
        &sink,
        CENTER + dvec3(5.0, 2.0, -1.0),
        Direction::Forward,
        &Limits::default(),
    );
    assert_eq!(line.ends[1], Some(End::Stagnation));
    let end = line.vertices.last().expect("vertices").place;
    // Ten tolerances.
    assert!(end.distance(CENTER) < 0.01, "{end}");
    let still = field([4; 3], |_| DVec3::ZERO);
    let line = one(
        &still,
        DVec3::splat(2.0),
        Direction::Both,
        &Limits::default(),
    );
    assert_eq!(line.ends, [Some(End::Stagnation); 2]);

    let turning = field([20; 3], rotation);
    let seed = CENTER + 6.0 * DVec3::X;
    let ahead = |limits| one(&turning, seed, Direction::Forward, &limits);
    let short = ahead(Limits {
        length: 7.5,
        ..Limits::default()
    });
    assert_eq!(short.ends[1], Some(End::Length));
    let ways = short
        .vertices
        .windows(2)
        .map(|v| v[0].place.distance(v[1].place));
    assert!((ways.sum::<f64>() - 7.5).abs() < 1e-9);
    let brief = ahead(Limits {
        duration: 1.25,
        ..Limits::default()
    });
    assert_eq!(brief.ends[1], Some(End::Time));
    let last = brief.vertices.last().expect("vertices");
    assert!((last.time - 1.25).abs() < 1e-12);
    // 1.25 radians farther.
    assert!(
        last.place
            .distance(CENTER + 6.0 * dvec3(1.25f64.cos(), 1.25f64.sin(), 0.0))
            < 1e-2
    );
    let few = ahead(Limits {
        vertices: 9,
        ..Limits::default()
    });
    assert_eq!((few.vertices.len(), few.ends[1]), (9, Some(End::Vertices)));
    let outside = one(&turning, -CENTER, Direction::Both, &Limits::default());
    assert!(outside.vertices.is_empty());
    assert_eq!(outside.ends, [Some(End::Absence(Absence::Domain)); 2]);
}

#[test]
fn any_number_of_threads_makes_the_same_lines() {
    let field = field([20; 3], |p| rotation(p) + dvec3(0.1 * p.z, 0.0, 0.4));
    let seeds: Vec<_> = (0..200)
        .map(|i| {
            CENTER
                + dvec3(
                    f64::from(i % 17) - 8.0,
                    f64::from(i % 13) - 6.0,
                    f64::from(i % 11) - 5.0,
                )
        })
        .collect();
    let limits = Limits::default();
    let make = |i: usize| line(&field, (0.0, seeds[i]), i, Direction::Both, &limits, None);
    let by = |threads| in_order(seeds.len(), threads, make);
    let one = by(1);
    assert_eq!(one.len(), 200);
    assert!(one.iter().enumerate().all(|(i, line)| line.seed == i));
    assert!(by(2) == one && by(7) == one);
}

/// v = a t: what a particle has gone is a t^2 / 2, and linear interpolation in time is exact.
#[test]
fn a_particle_in_a_wind_that_grows_goes_as_far_as_its_integral_says() {
    let grid = grid([40, 4, 4]);
    let wind = |t: f32| Snapshot::from_fn(&grid, move |_| Some([2.0 * t, 0.0, 0.0]));
    let times = [0.0, 1.0, 2.5, 4.0];
    let snapshots = times.map(|t| (t, wind(t as f32)));
    let field = GridField::new(grid, snapshots.into(), Metric::plain(1.0)).expect("a field");
    let seed = dvec3(3.0, 2.0, 2.0);
    let line = path_lines(&field, 1.0, &[seed], Direction::Forward, &Limits::default()).remove(0);
    assert_eq!(line.ends[1], Some(End::Time), "the last snapshot");
    for vertex in &line.vertices {
        let wanted = 3.0 + vertex.time.powi(2) - 1.0;
        assert!((vertex.place.x - wanted).abs() < 1e-9, "{vertex:?}");
    }
    assert_eq!(line.vertices.last().map(|v| v.time), Some(4.0));
    // No chord goes across a snapshot: each of its times has a vertex.
    assert!(line.vertices.iter().any(|v| v.time == 2.5));
    let stream = stream_lines(&field, 2.5, &[seed], Direction::Forward, &Limits::default());
    assert!(
        stream[0]
            .vertices
            .iter()
            .all(|v| (v.speed - 5.0).abs() < 1e-5)
    );
}

#[test]
fn on_a_globe_degrees_of_longitude_shrink_and_lines_end_before_the_pole() {
    // One voxel is a degree; the middle latitude is 60, where a degree of longitude is drawn half as long.
    let (per_degree, middle) = (111.0, 0.5);
    let affine = DAffine3::from_mat3_translation(
        glam::DMat3::from_diagonal(dvec3(middle * per_degree, per_degree, 1.0)),
        dvec3(0.0, 29.5 * per_degree, 0.0),
    );
    // Rows at 30 to 90 degrees.
    let grid = Grid {
        dims: [40, 61, 2],
        world_from_voxel: affine,
    };
    let metric = Metric {
        world_per_metre: 1e-3,
        horizontal: Horizontal::Degrees {
            x: middle * per_degree,
            y: per_degree,
        },
        vertical: Vertical::Metres,
    };
    let wind = |u, v| {
        let wind = Snapshot::from_fn(&grid, move |_| Some([u, v, 0.0]));
        GridField::new(grid, vec![(0.0, wind)], metric.clone()).expect("a field")
    };
    let hour = Limits {
        duration: 3600.0,
        ..Limits::default()
    };
    for latitude in [45.0f64, 60.0, 75.0] {
        let seed = affine.transform_point3(dvec3(4.0, latitude - 29.5, 1.0));
        let line = one(&wind(20.0, 0.0), seed, Direction::Forward, &hour);
        let end = line.vertices.last().expect("vertices").place;
        // 72 km along the circle of latitude, in degrees of longitude, drawn.
        let degrees = 72.0 / (per_degree * latitude.to_radians().cos());
        assert!(
            (end.x - seed.x - degrees * middle * per_degree).abs() < 1e-3,
            "{latitude}"
        );
        assert_eq!(end.y, seed.y);
    }
    let seed = affine.transform_point3(dvec3(4.0, 55.0, 1.0));
    let line = one(
        &wind(0.0, 20.0),
        seed,
        Direction::Forward,
        &Limits::default(),
    );
    assert_eq!(line.ends[1], Some(End::Absence(Absence::Pole)));
    let end = line.vertices.last().expect("vertices").place.y / per_degree;
    assert!((89.0 - 1e-3..=89.0).contains(&end), "{end}");
}
