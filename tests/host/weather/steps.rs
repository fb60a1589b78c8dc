//! Steps of a cell at most, along each axis: in longer ones the kinks of a trilinear field are missed.

use super::{Changed, Found, sees, within};
use glam::{DAffine3, DMat3, DVec3, dvec3};
use std::f64::consts::TAU;
use stratavox::flow::{
    Direction, GridField, Limits, Metric, Snapshot, VectorField, random_seeds, stream_lines,
};
use stratavox::volume::Grid;

#[derive(Clone, Copy, Debug)]
enum Fault {
    /// Only the error says how long a step is.
    NoLimit,
    /// Cells are cubes of the longest edge.
    Cubes,
}

/// An ABC flow whose waves have 12 cells, of cells that are a quarter as high.
fn field() -> (GridField, Grid) {
    let grid = Grid {
        dims: [24, 24, 96],
        world_from_voxel: DAffine3::from_scale(dvec3(1.0, 1.0, 0.25)),
    };
    let wind = Snapshot::from_fn(&grid, |[x, y, z]| {
        let [x, y, z] = [(x, 1.0), (y, 1.0), (z, 0.25)]
            .map(|(i, cell)| TAU / 12.0 * cell * (f64::from(i) + 0.5));
        let flow = [z.sin() + y.cos(), x.sin() + z.cos(), y.sin() + x.cos()];
        Some(flow.map(|n| n as f32))
    });
    let field = GridField::new(grid, vec![(0.0, wind)], Metric::plain(1.0)).expect("a field");
    (field, grid)
}

/// Against lines of 1e-11 cell a step.
fn keeps_to_cells(fault: Option<Fault>) -> Found {
    let (field, grid) = field();
    let seeds = random_seeds(&grid, 40, 3);
    let limits = Limits {
        duration: 2.0,
        ..Limits::default()
    };
    // A thousand cells in one: the tolerance stays what it was in world length.
    let (cells, tolerance) = match fault {
        None => (DMat3::IDENTITY, limits.tolerance),
        Some(Fault::NoLimit) => (
            DMat3::from_diagonal(DVec3::splat(1e-3)),
            1e-3 * limits.tolerance,
        ),
        Some(Fault::Cubes) => (
            DMat3::from_diagonal(dvec3(1.0, 1.0, 0.25)),
            limits.tolerance,
        ),
    };
    let changed = Changed {
        field: &field,
        velocity: |_, _, own| own,
        cells,
    };
    let ahead = Direction::Forward;
    let by = |tolerance| Limits {
        tolerance,
        ..limits
    };
    let found = stream_lines(&changed, 0.0, &seeds, ahead, &by(tolerance));
    let exact = stream_lines(&field, 0.0, &seeds, ahead, &by(1e-11));
    let cells = |way: DVec3| (field.cells_from_world() * way).abs().max_element();
    let (mut longest, mut off, mut compared) = (0.0_f64, 0.0_f64, 0);
    for (found, exact) in found.iter().zip(&exact) {
        for pair in found.vertices.windows(2) {
            longest = longest.max(cells(pair[1].place - pair[0].place));
        }
        if found.ends == exact.ends
            && let [Some(a), Some(b)] = [found, exact].map(|line| line.vertices.last())
            && a.time == b.time
        {
            off = off.max(cells(a.place - b.place));
            compared += 1;
        }
    }
    if compared < 10 {
        return Err(format!("{compared} lines are compared"));
    }
    within("the end of a line (cells)", off, 2e-2)?;
    within("a step (cells)", (longest - 1.0).max(0.0), 1e-9)
}

#[test]
fn no_step_is_longer_than_a_cell() {
    sees(&[Fault::NoLimit, Fault::Cubes], keeps_to_cells);
}
