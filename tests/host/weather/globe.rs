//! Air that turns with a tilted globe: each line is a circle around the axis of the rotation.
//!
//! ```text
//! u = cos p cos a + sin p cos l sin a,   v = -sin l sin a      times the speed;  l longitude, p latitude
//! r . n = constant,   n = (-sin a, 0, cos a)
//! ```
//!
//! Williamson et al., "A Standard Test Set for Numerical Approximations to the Shallow Water Equations in Spherical Geometry",
//! J. Comp. Phys. 102, 1992, case 1: a turn in 12 days.

use super::{Changed, Found, sees, within};
use glam::{DAffine3, DMat3, DVec3, dvec3};
use stratavox::flow::{
    Direction, GridField, Horizontal, Limits, Metric, Snapshot, VectorField, Vertical, stream_lines,
};
use stratavox::volume::Grid;

/// Kilometres of a degree of latitude, and of one of longitude as it is drawn.
const DEGREE: f64 = 111.2;
const DRAWN: f64 = 0.6 * DEGREE;
const TILT: f64 = 40.0;
const DAYS: f64 = 5.0;

#[derive(Clone, Copy, Debug)]
enum Fault {
    /// A degree of longitude is as long everywhere.
    NoCosine,
    /// It grows where it should shrink.
    CosineSwapped,
    /// The middle latitude is taken for each.
    NoMiddle,
    /// East is west.
    WestForEast,
}

fn axis() -> DVec3 {
    let (sin, cos) = TILT.to_radians().sin_cos();
    dvec3(-sin, 0.0, cos)
}

fn on_sphere(longitude: f64, latitude: f64) -> DVec3 {
    let ([sin_l, cos_l], [sin_p, cos_p]) = (
        <[f64; 2]>::from(longitude.to_radians().sin_cos()),
        <[f64; 2]>::from(latitude.to_radians().sin_cos()),
    );
    dvec3(cos_p * cos_l, cos_p * sin_l, sin_p)
}

/// Degrees from the axis.
fn from_axis(place: DVec3) -> f64 {
    let there = on_sphere(place.x / DRAWN, place.y / DEGREE);
    axis().dot(there).clamp(-1.0, 1.0).acos().to_degrees()
}

/// On a grid of a degree around the whole globe.
fn field() -> GridField {
    let grid = Grid {
        dims: [360, 180, 1],
        world_from_voxel: DAffine3::from_mat3_translation(
            DMat3::from_diagonal(dvec3(DRAWN, DEGREE, 1.0)),
            dvec3(0.0, -90.0 * DEGREE, 0.0),
        ),
    };
    let metres_per_second = 1e3 * 360.0 * DEGREE / (12.0 * 86400.0);
    let (sin, cos) = TILT.to_radians().sin_cos();
    let wind = Snapshot::from_fn(&grid, |[x, y, _]| {
        let (sin_l, cos_l) = (f64::from(x) + 0.5).to_radians().sin_cos();
        let (sin_p, cos_p) = (f64::from(y) - 89.5).to_radians().sin_cos();
        let wind = [cos_p * cos + sin_p * cos_l * sin, -sin_l * sin, 0.0];
        Some(wind.map(|n| (n * metres_per_second) as f32))
    });
    let metric = Metric {
        world_per_metre: 1e-3,
        horizontal: Horizontal::Degrees {
            x: DRAWN,
            y: DEGREE,
        },
        vertical: Vertical::Metres,
    };
    GridField::new(grid, vec![(0.0, wind)], metric).expect("a field")
}

fn stays_on_its_circle(field: &impl VectorField) -> Found {
    let limits = Limits {
        duration: DAYS * 86400.0,
        tolerance: 1e-5,
        ..Limits::default()
    };
    // The last one goes over the seam.
    let seeds = [[90.0, 0.0], [90.0, 30.0], [90.0, 60.0], [300.0, 0.0]];
    let places =
        seeds.map(|[longitude, latitude]| dvec3(longitude * DRAWN, latitude * DEGREE, 0.5));
    let lines = stream_lines(field, 0.0, &places, Direction::Forward, &limits);
    let mut worst: f64 = 0.0;
    for (line, seed) in lines.iter().zip(places) {
        for (i, vertex) in line.vertices.iter().enumerate() {
            // Both sides of the seam lie on a chord.
            if line.breaks.iter().any(|&at| i == at || i + 1 == at) {
                continue;
            }
            worst = worst.max((from_axis(vertex.place) - from_axis(seed)).abs());
        }
    }
    let passed = lines.iter().filter(|line| !line.breaks.is_empty()).count();
    if passed != 1 {
        return Err(format!("{passed} lines pass the seam"));
    }
    let last = lines[0].vertices.last().map_or(DVec3::NAN, |v| v.place);
    let [first, last] = [
        on_sphere(90.0, 0.0),
        on_sphere(last.x / DRAWN, last.y / DEGREE),
    ];
    let turned = first.dot(last).acos().to_degrees();
    // Between nodes each component is off by the square of a step over 8 times its two second derivatives, which are the speed
    // at most: over the way of all days this far aside. 400 steps of the tolerance are not 0.01.
    let way = 360.0 * DAYS / 12.0;
    let of_field = way * 1.0_f64.to_radians().powi(2) / 8.0 * 2.0 * 2.0_f64.sqrt();
    within("a circle (degrees)", worst, 0.01 + of_field)?;
    within(
        "the way of a great circle (degrees)",
        (turned - way).abs(),
        0.01 + of_field,
    )
}

#[test]
fn lines_of_a_tilted_rotation_are_circles_around_its_axis() {
    use Fault::*;
    let field = field();
    sees(&[NoCosine, CosineSwapped, NoMiddle, WestForEast], |fault| {
        let faulty = Changed {
            velocity: move |_, place: DVec3, own: DVec3| {
                let cosine = (place.y / DEGREE).to_radians().cos();
                let factor = match fault {
                    None => 1.0,
                    Some(NoCosine) => cosine * DEGREE / DRAWN,
                    Some(CosineSwapped) => (cosine * DEGREE / DRAWN).powi(2),
                    Some(NoMiddle) => DEGREE / DRAWN,
                    Some(WestForEast) => -1.0,
                };
                dvec3(own.x * factor, own.y, own.z)
            },
            field: &field,
            cells: DMat3::IDENTITY,
        };
        stays_on_its_circle(&faulty)
    });
}
