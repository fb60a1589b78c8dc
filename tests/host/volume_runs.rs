//! Run-length encoding against the set itself: round trip, maximal runs, three axes, ranks.

use crate::voxel_sets::{random, sets, voxels};
use stratavox::volume::{Runs, VoxelSet};

const AXES: [usize; 3] = [0, 1, 2];

#[test]
fn runs_of_each_axis_give_back_the_set() {
    for set in sets() {
        for axis in AXES {
            let runs = Runs::new(&set, axis);
            assert_eq!((runs.axis(), runs.dims()), (axis, set.dims()));
            assert_eq!(runs.decode(), set, "axis {axis}");
            for voxel in voxels(set.dims()) {
                assert_eq!(runs.contains(voxel), set.contains(voxel), "{voxel:?}");
                let (row, i) = runs.place(voxel);
                assert_eq!(runs.voxel(row, i), voxel);
            }
            for k in AXES {
                let mut outside = [0; 3];
                outside[k] = set.dims()[k];
                assert!(!runs.contains(outside), "{outside:?}");
            }
        }
    }
}

#[test]
fn runs_are_maximal_and_their_lengths_add_up_to_the_set() {
    for set in sets() {
        for axis in AXES {
            let runs = Runs::new(&set, axis);
            let count = set.dims()[axis];
            assert_eq!(runs.row_first().len(), runs.row_count() + 1);
            assert_eq!(
                runs.row_first()[runs.row_count()] as usize,
                runs.run_count()
            );
            for row in 0..runs.row_count() {
                for run in runs.row(row) {
                    assert!(run.length > 0 && run.end() <= count, "{run:?} of {count}");
                    let is_full = |i: u32| set.contains(runs.voxel(row, i));
                    assert!((run.start..run.end()).all(is_full), "{run:?}");
                    assert!(run.start == 0 || !is_full(run.start - 1), "{run:?}");
                    assert!(run.end() == count || !is_full(run.end()), "{run:?}");
                }
                let ends = runs.row(row).windows(2);
                assert!(ends.into_iter().all(|pair| pair[0].end() < pair[1].start));
            }
            assert_eq!(runs.full_count(), set.full_count());
            let lengths = runs.runs().iter().map(|run| u64::from(run.length));
            let is_full = |&voxel: &[u32; 3]| set.contains(voxel);
            let counted = voxels(set.dims()).filter(is_full).count();
            assert_eq!(lengths.sum::<u64>(), counted as u64);
        }
    }
}

#[test]
fn three_axes_encode_one_set() {
    for set in sets() {
        let [x, y, z] = AXES.map(|axis| Runs::new(&set, axis).decode());
        assert!(x == y && y == z, "{:?}", set.dims());
    }
    // Rows of one axis are columns of another: four in a line are one run, or four.
    let line = VoxelSet::by([4, 2, 3], |[_, y, z]| [y, z] == [1, 2]);
    assert_eq!(
        AXES.map(|axis| Runs::new(&line, axis).run_count()),
        [1, 4, 4]
    );
}

#[test]
fn the_next_full_voxel_of_a_row_is_found() {
    for set in sets() {
        for axis in AXES {
            let runs = Runs::new(&set, axis);
            let count = set.dims()[axis];
            for row in 0..runs.row_count() {
                for i in 0..=count {
                    let wanted = (i..count).find(|&i| set.contains(runs.voxel(row, i)));
                    assert_eq!(runs.next_full(row, i), wanted, "row {row}, {i}");
                }
            }
        }
    }
}

#[test]
fn the_rank_of_a_voxel_is_where_its_payload_lies() {
    for set in sets() {
        for axis in AXES {
            let runs = Runs::new(&set, axis);
            let bits = runs.bits();
            let count = set.dims()[axis];
            assert_eq!(bits.words_per_row(), count.div_ceil(32) as usize);
            assert_eq!(bits.words().len(), bits.words_per_row() * runs.row_count());
            let payload: Vec<_> = runs.voxels().collect();
            let mut before = 0;
            for row in 0..runs.row_count() {
                for i in 0..count {
                    let voxel = runs.voxel(row, i);
                    let wanted = set.contains(voxel).then_some(before);
                    assert_eq!(bits.rank(row, i), wanted, "{voxel:?} along {axis}");
                    if wanted.is_some() {
                        assert_eq!(payload[before as usize], voxel);
                        before += 1;
                    }
                }
                // What stands behind the end of a row is empty.
                for word in &bits.words()[row * bits.words_per_row()..][..bits.words_per_row()] {
                    let ones = word.mask.count_ones();
                    assert!(word.first + ones <= payload.len() as u32, "{word:?}");
                }
            }
            let ones = bits.words().iter().map(|word| word.mask.count_ones());
            assert_eq!(ones.sum::<u32>(), before);
            assert_eq!(payload.len(), before as usize);
        }
    }
}

#[test]
fn sizes_are_those_of_what_is_stored() {
    let set = random([40, 5, 3], 0.4, 3);
    let runs = Runs::new(&set, 0);
    assert_eq!(runs.bytes(), 4 * 16 + 8 * runs.run_count() as u64);
    assert_eq!(runs.bits().bytes(), 8 * 2 * 15);
}
