//! A wind that turns: path, streak and stream lines are three curves, and between snapshots it is linear.
//!
//! ```text
//! v = (1, cos t, 0)    path  y = sin x      streak at T  y = sin T - sin(T - x)      stream at T  y = x cos T
//! snapshots each second: y(t) = sum of (cos i + cos(i + 1)) / 2, and of a part f of a second  f c + f^2 (c' - c) / 2
//! ```

use super::{Changed, Found, sees, within};
use glam::{DAffine3, DMat3, DVec3, dvec3};
use stratavox::flow::{
    Absence, Direction, GridField, Limits, Line, Metric, Snapshot, VectorField, path_lines,
    streak_lines, stream_lines,
};
use stratavox::volume::Grid;

const LAST: f64 = 5.0;

/// Exact at all times.
struct Turning;

impl VectorField for Turning {
    fn velocity(&self, time: f64, _: DVec3) -> Result<DVec3, Absence> {
        Ok(dvec3(1.0, time.cos(), 0.0))
    }

    fn cells_from_world(&self) -> DMat3 {
        DMat3::IDENTITY
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Path,
    Streak,
    Stream,
}

fn line(kind: Kind) -> Line {
    let limits = Limits {
        duration: LAST,
        tolerance: 1e-9,
        ..Limits::default()
    };
    let seeds = [DVec3::ZERO];
    let mut lines = match kind {
        Kind::Path => path_lines(&Turning, 0.0, &seeds, Direction::Forward, &limits),
        Kind::Streak => streak_lines(&Turning, [0.0, LAST], &seeds, &limits),
        Kind::Stream => stream_lines(&Turning, LAST, &seeds, Direction::Forward, &limits),
    };
    lines.remove(0)
}

/// A line of this kind where one of that kind is wanted.
fn is_the_curve(found: Kind, wanted: Kind) -> Found {
    let law = |x: f64| match wanted {
        Kind::Path => x.sin(),
        Kind::Streak => LAST.sin() - (LAST - x).sin(),
        Kind::Stream => x * LAST.cos(),
    };
    let vertices = line(found).vertices;
    let off = vertices.iter().map(|v| (v.place.y - law(v.place.x)).abs());
    let reach = vertices.iter().map(|v| v.place.x).fold(0.0, f64::max);
    within("the length of a line", (reach - LAST).abs(), 1e-7)?;
    within("a curve", off.fold(0.0, f64::max), 1e-7)
}

#[test]
fn each_kind_of_line_is_its_curve_and_no_other() {
    use Kind::*;
    for wanted in [Path, Streak, Stream] {
        let others: Vec<Kind> = [Path, Streak, Stream]
            .into_iter()
            .filter(|kind| *kind != wanted)
            .collect();
        sees(&others, |other| {
            is_the_curve(other.unwrap_or(wanted), wanted)
        });
    }
}

#[derive(Clone, Copy, Debug)]
enum Fault {
    /// The wind is that of the nearest snapshot.
    Nearest,
    /// Steps go over snapshots.
    StepAcross,
}

/// A field whose kinks in time nobody is told of.
struct NoKinks<'a>(&'a GridField);

impl VectorField for NoKinks<'_> {
    fn velocity(&self, time: f64, place: DVec3) -> Result<DVec3, Absence> {
        self.0.velocity(time, place)
    }

    fn cells_from_world(&self) -> DMat3 {
        self.0.cells_from_world()
    }
}

/// In cells of 4, so that steps go as far as they may.
fn snapshots() -> GridField {
    let grid = Grid {
        dims: [4; 3],
        world_from_voxel: DAffine3::from_scale(DVec3::splat(4.0)),
    };
    let at = |i: u32| {
        let t = f64::from(i);
        (
            t,
            Snapshot::from_fn(&grid, move |_| Some([1.0, t.cos() as f32, 0.0])),
        )
    };
    GridField::new(grid, (0..=5).map(at).collect(), Metric::plain(1.0)).expect("a field")
}

fn is_linear_in_time(field: &impl VectorField) -> Found {
    let seed = dvec3(2.0, 8.0, 8.0);
    for duration in [1.0, 2.5, 4.25] {
        let limits = Limits {
            duration,
            ..Limits::default()
        };
        let line = path_lines(field, 0.0, &[seed], Direction::Forward, &limits).remove(0);
        let mut wanted = 0.0;
        for i in 0..5 {
            let [c, next] = [i, i + 1].map(|i| f64::from(f64::from(i).cos() as f32));
            let part = (duration - f64::from(i)).clamp(0.0, 1.0);
            wanted += part * c + 0.5 * part * part * (next - c);
        }
        let found = line
            .vertices
            .last()
            .map_or(f64::NAN, |v| v.place.y - seed.y);
        // The formula is exact of a velocity that is linear in time.
        within("a way", (found - wanted).abs(), 1e-12)?;
    }
    Ok(())
}

#[test]
fn between_snapshots_the_wind_is_linear() {
    let field = snapshots();
    sees(&[Fault::Nearest, Fault::StepAcross], |fault| match fault {
        None => is_linear_in_time(&field),
        Some(Fault::Nearest) => is_linear_in_time(&Changed {
            velocity: |time: f64, place, _| {
                let nearest = time.round().clamp(0.0, LAST);
                field.velocity(nearest, place).unwrap_or(DVec3::NAN)
            },
            field: &field,
            cells: DMat3::IDENTITY,
        }),
        Some(Fault::StepAcross) => is_linear_in_time(&NoKinks(&field)),
    });
}
