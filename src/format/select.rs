//! Which numbers of a stored array belong to one time, one component and one box.
//!
//! The array's axes stand fastest first. Space axes keep their order, so the wanted numbers come out of
//! the file x fastest by going forward only.

use crate::volume::{TimeComponent, VoxelBox};

/// What an axis of the stored array means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    Component,
    /// 0, 1, 2 for x, y, z, which come in this order.
    Space(usize),
    Time,
}

/// One axis of the stored array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Axis {
    pub role: Role,
    /// Numbers along it; not zero.
    pub size: u64,
}

/// `count` numbers of the array, the first at `start`, each `stride` after the last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Row {
    pub start: u64,
    pub count: u64,
    pub stride: u64,
}

/// The wanted numbers as rows, in the order in which they are stored.
///
/// The product of all sizes fits a u64, and `pick` and `region` lie inside the axes: what saturates below never does.
pub(crate) fn rows(axes: &[Axis], pick: TimeComponent, region: VoxelBox) -> Rows {
    let mut component = u64::from(pick.component);
    let mut time = u64::from(pick.time);
    let mut spans: Vec<Span> = Vec::new();
    let mut stride = 1_u64;
    for axis in axes {
        let (low, high) = match axis.role {
            Role::Component => one_of(&mut component, axis.size),
            Role::Time => one_of(&mut time, axis.size),
            Role::Space(k) => (
                region.min.get(k).copied().unwrap_or(0).into(),
                region.max.get(k).copied().unwrap_or(0).into(),
            ),
        };
        let span = Span {
            stride,
            size: axis.size,
            low,
            high,
        };
        match spans.last_mut() {
            // A faster axis wanted from end to end makes one longer axis with this one.
            Some(faster) if faster.low == 0 && faster.high == faster.size => {
                *faster = Span {
                    stride: faster.stride,
                    size: faster.size.saturating_mul(span.size),
                    low: faster.size.saturating_mul(low),
                    high: faster.size.saturating_mul(high),
                };
            }
            _ => spans.push(span),
        }
        stride = stride.saturating_mul(axis.size);
    }
    // Single picks before the row only move its start.
    let fastest = spans
        .iter()
        .position(|span| span.high.saturating_sub(span.low) > 1)
        .unwrap_or(0);
    let slower = spans.split_off(fastest.saturating_add(1).min(spans.len()));
    let start = spans
        .iter()
        .chain(&slower)
        .map(|span| span.low.saturating_mul(span.stride))
        .fold(0, u64::saturating_add);
    let (count, stride) = spans
        .last()
        .map_or((1, 1), |row| (row.high.saturating_sub(row.low), row.stride));
    let done = count == 0 || slower.iter().any(|span| span.low >= span.high);
    Rows {
        next: (!done).then_some(Row {
            start,
            count,
            stride,
        }),
        slower: slower.into_iter().map(|span| (span, span.low)).collect(),
    }
}

/// The rows that [`rows`] finds.
pub(crate) struct Rows {
    next: Option<Row>,
    /// Axes slower than the row, each with where we are on it.
    slower: Vec<(Span, u64)>,
}

#[derive(Clone, Copy)]
struct Span {
    stride: u64,
    size: u64,
    low: u64,
    high: u64,
}

/// Takes the place on one axis out of an index that may run over several.
fn one_of(index: &mut u64, size: u64) -> (u64, u64) {
    let here = index.checked_rem(size).unwrap_or(0);
    *index = index.checked_div(size).unwrap_or(0);
    (here, here.saturating_add(1))
}

impl Iterator for Rows {
    type Item = Row;

    fn next(&mut self) -> Option<Row> {
        let row = self.next?;
        self.next = None;
        let mut start = row.start;
        for (span, here) in &mut self.slower {
            *here = here.saturating_add(1);
            start = start.saturating_add(span.stride);
            if *here < span.high {
                self.next = Some(Row { start, ..row });
                break;
            }
            let back = span.high.saturating_sub(span.low);
            start = start.saturating_sub(back.saturating_mul(span.stride));
            *here = span.low;
        }
        Some(row)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZES: [u64; 5] = [2, 4, 3, 5, 3];

    /// Every wanted index, found the slow way.
    fn expected(roles: [Role; 5], pick: TimeComponent, region: VoxelBox) -> Vec<u64> {
        let total: u64 = SIZES.iter().product();
        (0..total)
            .filter(|&index| {
                let mut rest = index;
                roles.iter().zip(SIZES).all(|(role, size)| {
                    let here = rest % size;
                    rest /= size;
                    match role {
                        Role::Component => here == u64::from(pick.component),
                        Role::Time => here == u64::from(pick.time),
                        Role::Space(k) => {
                            (u64::from(region.min[*k])..u64::from(region.max[*k])).contains(&here)
                        }
                    }
                })
            })
            .collect()
    }

    #[test]
    fn rows_are_the_wanted_numbers_in_stored_order_wherever_the_axes_stand() {
        use Role::{Component as C, Space, Time as T};
        let orders = [
            [C, Space(0), Space(1), Space(2), T],
            [T, Space(0), Space(1), Space(2), C],
            [Space(0), Space(1), Space(2), C, T],
            [Space(0), C, Space(1), T, Space(2)],
        ];
        let mut tried = 0;
        for roles in orders {
            let axes: Vec<Axis> = roles
                .iter()
                .zip(SIZES)
                .map(|(&role, size)| Axis { role, size })
                .collect();
            let size_of = |k| {
                let at = roles.iter().position(|&role| role == Space(k)).unwrap();
                SIZES[at] as u32
            };
            let dims = [size_of(0), size_of(1), size_of(2)];
            for min in [[0, 0, 0], [1, 0, 0], [0, 1, 1]] {
                for max in [dims, [dims[0], dims[1] - 1, dims[2]], [2, 2, 2]] {
                    let region = VoxelBox { min, max };
                    let pick = TimeComponent {
                        time: 1,
                        component: 1,
                    };
                    let found: Vec<u64> = rows(&axes, pick, region)
                        .flat_map(|row| (0..row.count).map(move |i| row.start + i * row.stride))
                        .collect();
                    assert_eq!(found, expected(roles, pick, region), "{roles:?} {region:?}");
                    tried += found.len();
                }
            }
        }
        assert!(tried > 300, "only {tried} numbers were compared");
    }

    #[test]
    fn a_whole_volume_is_one_row() {
        let axes = [(0, 7), (1, 5), (2, 3)].map(|(k, size)| Axis {
            role: Role::Space(k),
            size,
        });
        let region = VoxelBox {
            min: [0; 3],
            max: [7, 5, 3],
        };
        let found: Vec<Row> = rows(&axes, TimeComponent::default(), region).collect();
        let whole = Row {
            start: 0,
            count: 105,
            stride: 1,
        };
        assert_eq!(found, [whole]);
    }
}
