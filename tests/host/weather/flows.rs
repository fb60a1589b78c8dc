//! Velocities in closed form: the lines of `phantom:flow`.
//!
//! ```text
//! helix          x^2 + y^2,  z - angle / 4          saddle   x y          taylor-green   sin px sin py        constant
//! ```

use super::{sees, within};
use glam::{DVec3, dvec3};
use std::f64::consts::PI;
use stratavox::flow::wind::metric_of;
use stratavox::flow::{
    Component, Direction, GridField, Limits, Snapshot, VectorField, Vertical, stream_lines,
};
use stratavox::volume::{Grid, Limits as Memory, TimeComponent, Volume, phantom};

const VOXELS: u32 = 32;
/// Metres.
const CELL: f64 = 2.0 / VOXELS as f64;

/// The trilinear field of voxels.
fn field(kind: &str) -> GridField {
    let memory = Memory::default();
    let spec = format!("phantom:flow,n={VOXELS},kind={kind}");
    let source = phantom::open(&spec, &memory).expect("a flow");
    let header = source.header();
    let read = |component| {
        let pick = TimeComponent { time: 0, component };
        Volume::read(&*source, pick, header.whole(), &memory).expect("a component")
    };
    let volumes = [0, 1, 2].map(read);
    let [east, north, up] = volumes.each_ref().map(|volume| Component {
        volume,
        factor: 1.0,
    });
    let snapshot = Snapshot::new(east, north, Some(up)).expect("one grid");
    let grid = Grid {
        dims: header.dims,
        world_from_voxel: header.world_from_voxel,
    };
    let metric = metric_of(header, Vertical::Metres, None);
    GridField::new(grid, vec![(0.0, snapshot)], metric).expect("a field")
}

#[derive(Clone, Copy, Debug)]
enum Fault {
    /// A step goes as far as its first velocity says.
    Euler,
    /// A step goes as far as the velocity in its middle says: of order 2.
    Midpoint,
    /// The first component is taken for the second, and the other way round.
    Swapped,
}

/// The places of a line each cell or so, and the last after so many seconds.
fn places(
    fault: Option<Fault>,
    field: &GridField,
    seed: DVec3,
    duration: f64,
    tolerance: f64,
) -> Vec<DVec3> {
    // A wrong line may leave the cube.
    let velocity = |place: DVec3| field.velocity(0.0, place).unwrap_or_default();
    let by_steps = |step: &dyn Fn(DVec3, f64) -> DVec3| {
        let fastest = velocity(seed).abs().max_element().max(1.0);
        let count = (duration * fastest / CELL).ceil();
        let mut place = seed;
        let steps = (0..count as u32).map(|_| {
            place += step(place, duration / count);
            place
        });
        steps.collect()
    };
    match fault {
        Some(Fault::Euler) => by_steps(&|place, h| h * velocity(place)),
        Some(Fault::Midpoint) => {
            by_steps(&|place, h| h * velocity(place + 0.5 * h * velocity(place)))
        }
        Some(Fault::Swapped) => by_steps(&|place, h| {
            let half = velocity(place + 0.5 * h * velocity(place));
            h * dvec3(half.y, half.x, half.z)
        }),
        None => {
            let limits = Limits {
                duration,
                tolerance,
                ..Limits::default()
            };
            let ahead = Direction::Forward;
            let line = stream_lines(field, 0.0, &[seed], ahead, &limits).remove(0);
            line.vertices.iter().map(|vertex| vertex.place).collect()
        }
    }
}

/// The largest change of a number that a line keeps.
fn change(places: &[DVec3], number: impl Fn(DVec3) -> f64) -> f64 {
    let first = places.first().map_or(f64::NAN, |&place| number(place));
    let off = places.iter().map(|&place| (number(place) - first).abs());
    off.fold(0.0, f64::max)
}

const FAULTS: [Fault; 3] = [Fault::Euler, Fault::Midpoint, Fault::Swapped];

/// f32 rounds velocities up to 1 by 3e-8, over 4 seconds; 150 steps are off by the tolerance of 1e-9 cells each.
#[test]
fn a_helix_keeps_its_radius_and_rises_with_its_angle() {
    let field = field("helix");
    sees(&FAULTS, |fault| {
        let seed = dvec3(0.5, 0.0, -0.6);
        let way = places(fault, &field, seed, 4.0, 1e-9);
        within("the radius", change(&way, |p| p.truncate().length()), 1e-6)?;
        let end = way[way.len() - 1];
        let turned = dvec3(0.5 * 4.0_f64.cos(), 0.5 * 4.0_f64.sin(), 0.4);
        within("the end", (end - turned).abs().max_element(), 1e-6)
    });
}

/// As above; rounding of the first velocities grows by e^1.6.
#[test]
fn a_saddle_keeps_the_product_of_x_and_y() {
    let field = field("saddle");
    sees(&FAULTS, |fault| {
        let seed = dvec3(0.15, 0.8, 0.1);
        let way = places(fault, &field, seed, 1.6, 1e-9);
        within("x y", change(&way, |p| p.x * p.y), 1e-6)?;
        let end = way[way.len() - 1];
        let wanted = dvec3(0.15 * 1.6_f64.exp(), 0.8 * (-1.6_f64).exp(), 0.1);
        within("the end", (end - wanted).abs().max_element(), 1e-6)
    });
}

/// The trilinear field keeps the stream function to what it is off by: pi^2 of a cell squared over 8, along each axis, over the
/// way of 1.8 seconds, which is not yet around, times the gradient of the function, pi.
#[test]
fn a_vortex_of_taylor_and_green_ends_where_an_exact_line_of_its_voxels_does() {
    let field = field("taylor-green");
    let seed = dvec3(0.3, 0.45, 0.2);
    let exact = places(None, &field, seed, 1.8, 1e-11);
    let exact = exact[exact.len() - 1];
    sees(&FAULTS, |fault| {
        let way = places(fault, &field, seed, 1.8, 1e-3);
        let end = way[way.len() - 1];
        within(
            "the end (cells)",
            (end - exact).abs().max_element() / CELL,
            6e-3,
        )?;
        let of_field = PI * 1.8 * 2.0 * (PI * CELL).powi(2) / 8.0;
        let kept = change(&way, |p| (PI * p.x).sin() * (PI * p.y).sin());
        within("the stream function", kept, of_field)
    });
}
