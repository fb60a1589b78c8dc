//! Lines end where there are no data, and at the ground.

use super::{Found, sees, within};
use glam::{DAffine3, dvec3};
use stratavox::flow::{Absence, Direction, End, GridField, Limits, Metric, Snapshot, stream_lines};
use stratavox::volume::Grid;

#[derive(Clone, Copy, Debug)]
enum Fault {
    /// Where there are no data the wind is 0, and lines get stuck.
    NothingIsCalm,
    /// Where there are no data the wind is what is around.
    NothingIsFilled,
    /// Lines go through the ground.
    NoGround,
}

const WIND: [f32; 3] = [3.0, 0.0, 0.0];

/// The wind blows along x, and ends by this cause at this x.
fn ends(fault: Option<Fault>, cause: Absence, wanted: f64) -> Found {
    let grid = Grid {
        dims: [12, 6, 6],
        world_from_voxel: DAffine3::IDENTITY,
    };
    let is_hole = |x: u32| cause == Absence::NoData && x == 9;
    let hole = match fault {
        Some(Fault::NothingIsCalm) => Some([0.0; 3]),
        Some(Fault::NothingIsFilled) => Some(WIND),
        Some(Fault::NoGround) | None => None,
    };
    let wind = Snapshot::from_fn(&grid, |[x, ..]| if is_hole(x) { hole } else { Some(WIND) });
    let mut field = GridField::new(grid, vec![(0.0, wind)], Metric::plain(1.0)).expect("a field");
    let has_ground = cause == Absence::Ground && !matches!(fault, Some(Fault::NoGround));
    if has_ground {
        let heights = (0..12 * 6).map(|i| f64::from(i % 12) / 2.0).collect();
        field = field.over_ground(heights).expect("ground");
    }
    let seed = dvec3(4.3, 3.0, 3.0);
    let line = stream_lines(&field, 0.0, &[seed], Direction::Forward, &Limits::default());
    let [_, end] = line[0].ends;
    if end != Some(End::Absence(cause)) {
        return Err(format!("a line ends by {end:?}"));
    }
    let last = line[0].vertices.last().map_or(f64::NAN, |v| v.place.x);
    within("the end", (wanted - last).abs(), 1e-3)
}

/// The centre of the voxel beside the hole lies at 8.5: farther on the hole has a weight.
#[test]
fn lines_end_at_holes() {
    use Fault::*;
    sees(&[NothingIsCalm, NothingIsFilled], |fault| {
        ends(fault, Absence::NoData, 8.5)
    });
}

/// The ground is (x - 1/2) / 2 high: 3 at 6.5.
#[test]
fn lines_end_at_the_ground() {
    sees(&[Fault::NoGround], |fault| {
        ends(fault, Absence::Ground, 6.5)
    });
}
