//! The three kinds of lines of one wind, in closed form.

use crate::flow::{
    Absence, Direction, End, GridField, Limits, Metric, Snapshot, path_lines, streak_lines,
    stream_lines,
};
use crate::volume::Grid;
use glam::{DAffine3, dvec3};

/// v = (1, cos t, 0), a snapshot each 1/64 s. Linear between snapshots the integral of cos is off by dt^2 / 12 of the change
/// of its derivative at most.
#[test]
fn path_streak_and_stream_lines_of_one_wind_are_three_curves() {
    let grid = Grid {
        dims: [12, 12, 4],
        world_from_voxel: DAffine3::IDENTITY,
    };
    let dt = 1.0 / 64.0;
    let snapshots = (0..=5 * 64).map(|i| {
        let t = f64::from(i) * dt;
        let wind = Snapshot::from_fn(&grid, move |_| Some([1.0, t.cos() as f32, 0.0]));
        (t, wind)
    });
    let field = GridField::new(grid, snapshots.collect(), Metric::plain(1.0)).expect("a field");
    let seed = dvec3(1.0, 6.0, 2.0);
    // And f32, the tolerance of steps, and chords.
    let near = dt * dt / 12.0 * 2.0 + 1e-6;
    let limits = Limits::default();
    let path = path_lines(&field, 0.0, &[seed], Direction::Forward, &limits).remove(0);
    let streak = streak_lines(&field, [0.0, 5.0], &[seed], &limits).remove(0);
    let stream = stream_lines(&field, 5.0, &[seed], Direction::Forward, &limits).remove(0);
    for vertex in &path.vertices {
        let q = vertex.place - seed;
        assert!(
            (q.x - vertex.time).abs() < near && (q.y - q.x.sin()).abs() < near,
            "{q}"
        );
    }
    assert_eq!(streak.ends, [Some(End::Time); 2]);
    assert_eq!(streak.vertices[0].time, 0.0, "the oldest first");
    for vertex in &streak.vertices {
        let q = vertex.place - seed;
        assert!((q.x - (5.0 - vertex.time)).abs() < near, "{q}");
        assert!((q.y - (5f64.sin() - (5.0 - q.x).sin())).abs() < near, "{q}");
    }
    for vertex in &stream.vertices {
        let q = vertex.place - seed;
        assert!((q.y - q.x * 5f64.cos()).abs() < 1e-6, "{q}");
    }
    for pair in streak.vertices.windows(2) {
        assert!((pair[1].place - pair[0].place).abs().max_element() <= 1.0);
    }
    // Smoke that has left the box is no part of the line, and the reason is kept.
    let gone = streak_lines(&field, [0.0, 5.0], &[dvec3(9.0, 6.0, 2.0)], &limits).remove(0);
    assert_eq!(gone.ends[0], Some(End::Absence(Absence::Domain)));
    assert!(
        gone.vertices
            .iter()
            .all(|v| v.place.x <= 12.0 && v.time > 1.9)
    );
    assert!(gone.vertices.last().is_some_and(|v| v.place.x == 9.0));
}
