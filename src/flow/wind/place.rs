//! From what a header says of its place to the metric of a wind on that grid.
//!
//! ```text
//! kilometres of the Earth   0.001 world a metre; degrees, or a map with its factors, or a plain plane
//! another world             1 / (metres of its unit), along the axes of the grid
//! ```

use crate::flow::metric::{Horizontal, Metric, Vertical};
use crate::volume::Header;

/// Lengths on the map over those on the Earth along x and y, one a column of voxels.
pub type MapFactors = [Vec<f64>; 2];

/// The metric of a wind on the grid of a header. Where a world that is not of the Earth has no unit, a velocity of 1 is a
/// world length per second.
pub fn metric_of(header: &Header, vertical: Vertical, map: Option<MapFactors>) -> Metric {
    let world_per_metre = match header.length_metres {
        Some(metres) if metres > 0.0 && metres.is_finite() => 1.0 / metres,
        _ if header.is_earth => 1e-3,
        _ => 1.0,
    };
    let horizontal = match (header.degree_lengths, map) {
        ([Some(x), Some(y)], _) if header.is_earth => Horizontal::Degrees { x, y },
        (_, Some([x, y])) => Horizontal::Map { x, y },
        _ if header.is_earth => Horizontal::World,
        _ => Horizontal::GridAxes,
    };
    Metric {
        world_per_metre,
        horizontal,
        vertical,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::{Format, VoxelType};
    use glam::DAffine3;

    #[test]
    fn the_place_of_a_file_says_how_its_wind_moves_what_is_drawn() {
        let mut header = Header::new(Format::NetCdf, [2; 3], VoxelType::F32, DAffine3::IDENTITY);
        let of = |header: &Header, map| metric_of(header, Vertical::Metres, map);
        assert_eq!(of(&header, None).horizontal, Horizontal::GridAxes);
        assert_eq!(of(&header, None).world_per_metre, 1.0);
        header.length_metres = Some(1e-3);
        assert_eq!(of(&header, None).world_per_metre, 1e3);
        (header.is_earth, header.length_metres) = (true, Some(1e3));
        assert_eq!(of(&header, None).world_per_metre, 1e-3);
        assert_eq!(of(&header, None).horizontal, Horizontal::World);
        let map = [vec![1.0; 4], vec![2.0; 4]];
        assert!(matches!(
            of(&header, Some(map.clone())).horizontal,
            Horizontal::Map { .. }
        ));
        header.degree_lengths = [Some(90.0), Some(111.0)];
        let degrees = Horizontal::Degrees { x: 90.0, y: 111.0 };
        assert_eq!(of(&header, Some(map)).horizontal, degrees);
    }
}
