//! Coast and borders of the Earth, 1 : 50 million (Natural Earth, public domain), inside of the program:
//! `tests/fixtures/coast/make.py` made the bytes and says how they are packed.

use super::coast::without_edges;
use crate::format::geographic::on_edges;
use std::sync::OnceLock;

/// Lines of longitudes and latitudes in degrees.
pub(super) type Lines = Vec<Vec<[f64; 2]>>;

/// Coast and borders.
#[derive(Debug)]
pub(super) struct Earth {
    pub coast: Lines,
    pub borders: Lines,
}

const PACKED: &[u8] = include_bytes!("earth.bin");

/// Unpacked once.
pub(super) fn earth() -> &'static Earth {
    static EARTH: OnceLock<Earth> = OnceLock::new();
    EARTH.get_or_init(|| {
        let bytes = miniz_oxide::inflate::decompress_to_vec_zlib(PACKED).expect("bytes of ours");
        let (head, rest) = bytes.split_at(32);
        let number =
            |k: usize| f64::from_le_bytes(head[8 * k..8 * k + 8].try_into().expect("eight"));
        let mut reader = Reader {
            bytes: rest,
            scale: [number(0), number(1)],
            translate: [number(2), number(3)],
        };
        Earth {
            coast: reader.lines().into_iter().flat_map(without_edges).collect(),
            borders: reader.lines(),
        }
    })
}

struct Reader<'a> {
    bytes: &'a [u8],
    scale: [f64; 2],
    translate: [f64; 2],
}

impl Reader<'_> {
    fn lines(&mut self) -> Lines {
        (0..self.varint()).map(|_| self.line()).collect()
    }

    fn line(&mut self) -> Vec<[f64; 2]> {
        let mut at = [0_i64; 2];
        (0..self.varint())
            .map(|_| {
                at = at.map(|n| n + self.step());
                on_edges([0, 1].map(|k| at[k] as f64 * self.scale[k] + self.translate[k]))
            })
            .collect()
    }

    fn step(&mut self) -> i64 {
        let n = self.varint();
        (n >> 1) as i64 ^ -((n & 1) as i64)
    }

    fn varint(&mut self) -> u64 {
        let mut n = 0;
        for shift in (0..64).step_by(7) {
            let (first, rest) = self.bytes.split_first().expect("bytes of ours");
            self.bytes = rest;
            n |= u64::from(first & 127) << shift;
            if first & 128 == 0 {
                break;
            }
        }
        n
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn capes_and_borders_lie_where_they_are() {
        let earth = earth();
        let points: usize = earth.coast.iter().chain(&earth.borders).map(Vec::len).sum();
        assert!((70_000..110_000).contains(&points), "{points}");
        let nearest = |lines: &Lines, [x, y]: [f64; 2]| {
            let all = lines.iter().flatten();
            all.map(|p| (p[0] - x).hypot(p[1] - y))
                .fold(f64::INFINITY, f64::min)
        };
        // The Cape of Good Hope, Land's End, Gibraltar, Cape Comorin: to a fifth of a degree.
        for place in [
            [18.47, -34.35],
            [-5.7, 50.07],
            [-5.35, 36.13],
            [77.55, 8.08],
        ] {
            assert!(nearest(&earth.coast, place) < 0.2, "{place:?}");
        }
        // Polygons are cut along the 180th meridian and closed at the south pole: that is no coast.
        let is_edge = |pair: &[[f64; 2]]| {
            let is_on = |k: usize, edge: f64| pair.iter().all(|p| (p[k].abs() - edge).abs() < 1e-6);
            is_on(0, 180.0) || pair.iter().all(|p| p[1].abs() > 89.9)
        };
        let pairs = earth.coast.iter().flat_map(|line| line.windows(2));
        assert_eq!(pairs.filter(|pair| is_edge(pair)).count(), 0);
        // The border on the 49th parallel, and none in the middle of France.
        assert!(nearest(&earth.borders, [-100.65, 49.0]) < 3.0);
        assert!(nearest(&earth.borders, [2.5, 47.0]) > 2.0);
        assert!(nearest(&earth.coast, [2.5, 47.0]) > 2.0);
    }
}
