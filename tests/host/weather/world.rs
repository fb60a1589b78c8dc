//! How fast a drawn place moves: on maps, on levels of pressure, and where heights are exaggerated.

use super::{Changed, Found, sees, within};
use glam::{DAffine3, DMat3, DVec3, dvec3};
use stratavox::flow::{
    Direction, GridField, Horizontal, Limits, Metric, Snapshot, VectorField, Vertical,
    height_of_pressure, stream_lines,
};
use stratavox::volume::Grid;

/// From a corner in the origin, of cells of this size.
fn grid(dims: [u32; 3], cell: DVec3) -> Grid {
    Grid {
        dims,
        world_from_voxel: DAffine3::from_scale(cell),
    }
}

/// Where the stream line of a seed is after so many seconds.
fn end(field: &impl VectorField, seed: DVec3, duration: f64) -> DVec3 {
    let limits = Limits {
        duration,
        tolerance: 1e-9,
        ..Limits::default()
    };
    let line = stream_lines(field, 0.0, &[seed], Direction::Forward, &limits).remove(0);
    line.vertices.last().map_or(DVec3::NAN, |v| v.place)
}

#[derive(Clone, Copy, Debug)]
enum OfMap {
    /// A kilometre is one on the map too.
    NoFactor,
    /// That of x for y.
    FactorsSwapped,
    /// What the map stretches is shrunk.
    Divided,
}

/// ```text
/// m_y = 1 + a y:  y(t) = ((1 + a y0) exp(a v t) - 1) / a        m_x = 2
/// ```
fn moves_as_the_map_is_stretched(fault: Option<OfMap>) -> Found {
    let grid = grid([40, 40, 2], DVec3::ONE);
    let growth = 0.01;
    let factor = |j: u32| 1.0 + growth * (f64::from(j) + 0.5);
    let double = vec![2.0; 1600];
    let growing: Vec<f64> = (0..1600).map(|i| factor(i / 40)).collect();
    let inverse = |factors: Vec<f64>| factors.into_iter().map(f64::recip).collect();
    let horizontal = match fault {
        None => Horizontal::Map {
            x: double,
            y: growing,
        },
        Some(OfMap::NoFactor) => Horizontal::World,
        Some(OfMap::FactorsSwapped) => Horizontal::Map {
            x: growing,
            y: double,
        },
        Some(OfMap::Divided) => Horizontal::Map {
            x: inverse(double),
            y: inverse(growing),
        },
    };
    let metric = Metric {
        world_per_metre: 1e-3,
        horizontal,
        vertical: Vertical::Metres,
    };
    let of = |u, v| {
        let wind = Snapshot::from_fn(&grid, move |_| Some([u, v, 0.0]));
        GridField::new(grid, vec![(0.0, wind)], metric.clone()).expect("a field")
    };
    let seed = dvec3(3.0, 4.0, 1.0);
    let east = end(&of(10.0, 0.0), seed, 1200.0);
    within("the way to the east (km)", (east.x - 27.0).abs(), 1e-6)?;
    let north = end(&of(0.0, 10.0), seed, 1200.0);
    let wanted = ((1.0 + growth * 4.0) * (growth * 12.0_f64).exp() - 1.0) / growth;
    within("the way to the north (km)", (north.y - wanted).abs(), 1e-6)
}

#[test]
fn on_a_map_places_move_as_it_is_stretched() {
    use OfMap::*;
    sees(
        &[NoFactor, FactorsSwapped, Divided],
        moves_as_the_map_is_stretched,
    );
}

#[derive(Clone, Copy, Debug)]
enum OfPressure {
    /// Falling pressure sinks.
    Sign,
    /// Without the acceleration of free fall.
    NoGravity,
    /// Pa/s are m/s.
    AsMetres,
    /// hPa/s are Pa/s.
    AsHectopascals,
}

/// Air that loses a pascal a second is after t seconds where the standard atmosphere has t pascals less.
fn rises_as_its_pressure_falls(fault: Option<OfPressure>) -> Found {
    let grid = grid([2, 2, 60], dvec3(50.0, 50.0, 0.25));
    let wind = Snapshot::from_fn(&grid, |_| Some([0.0, 0.0, -1.0]));
    let metric = Metric {
        world_per_metre: 1e-3,
        horizontal: Horizontal::World,
        vertical: match fault {
            Some(OfPressure::AsMetres) => Vertical::Metres,
            _ => Vertical::Pascals,
        },
    };
    let factor = match fault {
        Some(OfPressure::Sign) => -1.0,
        Some(OfPressure::NoGravity) => 9.80665,
        Some(OfPressure::AsHectopascals) => 100.0,
        Some(OfPressure::AsMetres) | None => 1.0,
    };
    let field = GridField::new(grid, vec![(0.0, wind)], metric).expect("a field");
    let field = Changed {
        field: &field,
        velocity: |_, _, own: DVec3| factor * own,
        cells: DMat3::IDENTITY,
    };
    let height = |pascals: f64| 1e-3 * height_of_pressure(pascals).expect("a height");
    let seed = dvec3(50.0, 50.0, height(50_000.0));
    let off = end(&field, seed, 3000.0).z - height(47_000.0);
    within("the height (km)", off.abs(), 1e-6)
}

#[test]
fn air_rises_as_its_pressure_falls() {
    use OfPressure::*;
    sees(
        &[Sign, NoGravity, AsMetres, AsHectopascals],
        rises_as_its_pressure_falls,
    );
}

#[derive(Clone, Copy, Debug)]
struct HeightsAlone;

/// Lines that are stretched are those of a world and a wind that are.
fn are_stretched(fault: Option<HeightsAlone>) -> Found {
    const STRETCH: f64 = 16.0;
    let field = |stretch: f64, of_wind: f64| {
        let grid = grid([24; 3], dvec3(1.0, 1.0, stretch));
        let wind = Snapshot::from_fn(&grid, |voxel| {
            let [x, y, z] = voxel.map(|i| 0.25 * f64::from(i));
            let up = of_wind * (y.sin() + x.cos());
            Some([z.sin() + y.cos(), x.sin() + z.cos(), up].map(|n| n as f32))
        });
        GridField::new(grid, vec![(0.0, wind)], Metric::plain(1.0)).expect("a field")
    };
    let of_wind = if fault.is_some() { 1.0 } else { STRETCH };
    let fields = [field(1.0, 1.0), field(STRETCH, of_wind)];
    let seed = dvec3(12.0, 11.0, 13.0);
    let ends = [(&fields[0], 1.0), (&fields[1], STRETCH)];
    let [low, high] = ends.map(|(field, stretch)| end(field, seed * dvec3(1.0, 1.0, stretch), 4.0));
    let off = (low * dvec3(1.0, 1.0, STRETCH) - high).abs().max_element();
    within("a stretched line", off, 1e-9)
}

#[test]
fn stretched_lines_are_lines_of_the_stretched_wind() {
    sees(&[HeightsAlone], are_stretched);
}
