//! Run-length encoding against the set itself: round trip, maximal runs, three axes, ranks.

use crate::voxel_sets::{random, sets, voxels};
use stratavox::volume::{RankWord, Run, RunBits, Runs, VoxelSet};

/// What is wrong, where anything is.
type Found = Result<(), String>;

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

/// Runs of a set, row by row: none is empty, goes over an end of its row, touches another or leaves out a full voxel beside it,
/// and together they are as long as there are full voxels.
fn check_runs(set: &VoxelSet, runs: &Runs, of_row: impl Fn(usize) -> Vec<Run>) -> Found {
    let count = set.dims()[runs.axis()];
    let mut lengths = 0;
    for row in 0..runs.row_count() {
        let is_full = |i: u32| i < count && set.contains(runs.voxel(row, i));
        let found = of_row(row);
        for run in &found {
            let is_inside = run.length > 0 && run.end() <= count;
            let is_maximal = (run.start == 0 || !is_full(run.start - 1)) && !is_full(run.end());
            if !is_inside || !is_maximal || !(run.start..run.end()).all(is_full) {
                return Err(format!("{run:?} of row {row}, {count} voxels long"));
            }
            lengths += u64::from(run.length);
        }
        if let Some(pair) = found.windows(2).find(|pair| pair[0].end() >= pair[1].start) {
            return Err(format!("{pair:?} of row {row}"));
        }
    }
    let full = voxels(set.dims())
        .filter(|&voxel| set.contains(voxel))
        .count() as u64;
    match lengths == full {
        true => Ok(()),
        false => Err(format!("{lengths} voxels in runs, {full} are full")),
    }
}

#[test]
fn runs_are_maximal_and_their_lengths_add_up_to_the_set() {
    for set in sets() {
        for axis in AXES {
            let runs = Runs::new(&set, axis);
            assert_eq!(runs.row_first().len(), runs.row_count() + 1);
            assert_eq!(
                runs.row_first()[runs.row_count()] as usize,
                runs.run_count()
            );
            assert_eq!(
                check_runs(&set, &runs, |row| runs.row(row).to_vec()),
                Ok(())
            );
            assert_eq!(runs.full_count(), set.full_count());
        }
    }
}

/// Runs with one thing wrong each: over the end of a row into the next, in two parts, and without the last voxel of a word.
#[test]
fn runs_that_are_not_those_of_the_set_are_seen() {
    let is_seen = |of_row: &dyn Fn(&Runs, usize) -> Vec<Run>| {
        let all = sets();
        let of_set = |set: &VoxelSet| {
            let runs = Runs::new(set, 0);
            check_runs(set, &runs, |row| of_row(&runs, row)).is_err()
        };
        all.iter().filter(|set| of_set(set)).count()
    };
    let over_the_end = |runs: &Runs, row: usize| {
        let mut found = runs.row(row).to_vec();
        let count = runs.dims()[0];
        let next = (row + 1 < runs.row_count()).then(|| runs.row(row + 1));
        let next = next
            .and_then(|row| row.first())
            .filter(|run| run.start == 0);
        if let (Some(last), Some(next)) = (found.last_mut().filter(|run| run.end() == count), next)
        {
            last.length += next.length;
        }
        found
    };
    let in_two = |runs: &Runs, row: usize| {
        let halves = runs.row(row).iter().flat_map(|run| {
            let length = run.length.div_ceil(2);
            let rest = Run {
                start: run.start + length,
                length: run.length - length,
            };
            [Run { length, ..*run }, rest]
                .into_iter()
                .filter(|run| run.length > 0)
        });
        halves.collect()
    };
    let without_bit_31 = |runs: &Runs, row: usize| {
        let mut found = Vec::new();
        for run in runs.row(row) {
            let mut start = run.start;
            for i in (run.start..run.end()).filter(|i| i % 32 == 31) {
                found.extend((start < i).then(|| Run {
                    start,
                    length: i - start,
                }));
                start = i + 1;
            }
            let length = run.end() - start;
            found.extend((length > 0).then_some(Run { start, length }));
        }
        found
    };
    assert_eq!(is_seen(&|runs, row| runs.row(row).to_vec()), 0);
    type OfRow<'a> = &'a dyn Fn(&Runs, usize) -> Vec<Run>;
    let wrong: [(&str, OfRow); 3] = [
        ("over the end of a row", &over_the_end),
        ("in two", &in_two),
        ("without bit 31", &without_bit_31),
    ];
    for (what, wrong) in wrong {
        let seen = is_seen(wrong);
        println!("{what}: {seen} of {} sets", sets().len());
        assert!(seen > 5, "{what}: {seen} sets");
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

/// Ranks of the voxels of a set by its words: those of full voxels count up, row by row, and others have none.
fn check_ranks(runs: &Runs, rank: impl Fn(&[RankWord], u32) -> Option<u32>) -> Found {
    let bits = runs.bits();
    let payload: Vec<_> = runs.voxels().collect();
    let mut before = 0;
    for row in 0..runs.row_count() {
        let words = &bits.words()[row * bits.words_per_row()..];
        for i in 0..runs.dims()[runs.axis()] {
            let voxel = runs.voxel(row, i);
            let wanted = runs.contains(voxel).then_some(before);
            let found = rank(words, i);
            let is_payload = wanted.is_none_or(|rank| payload[rank as usize] == voxel);
            if found != wanted || !is_payload {
                return Err(format!("{voxel:?} has rank {found:?}, not {wanted:?}"));
            }
            before += u32::from(wanted.is_some());
        }
    }
    Ok(())
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
            for row in 0..runs.row_count() {
                let words = &bits.words()[row * bits.words_per_row()..][..bits.words_per_row()];
                for i in 0..count {
                    assert_eq!(bits.rank(row, i), rank(words, i), "row {row}, {i}");
                }
                // What stands behind the end of a row is empty.
                let ends = words.iter().map(|word| word.mask.count_ones());
                let full = (0..count).filter(|&i| set.contains(runs.voxel(row, i)));
                assert_eq!(ends.sum::<u32>(), full.count() as u32, "row {row}");
            }
            assert_eq!(check_ranks(&runs, rank), Ok(()));
            let ones = bits.words().iter().map(|word| word.mask.count_ones());
            assert_eq!(u64::from(ones.sum::<u32>()), set.full_count());
            assert_eq!(bits.full_count(), set.full_count());
            assert_eq!(bits.run_count(), runs.run_count() as u64);
            let [j, k] = [(axis + 1) % 3, (axis + 2) % 3];
            let number = |v: [u32; 3]| (v[j] + set.dims()[j] * v[k]) * count + v[axis];
            let numbers = runs.voxels().map(|voxel| number(voxel) as usize);
            assert!(bits.voxels().eq(numbers), "{:?}", set.dims());
            assert_eq!(runs.voxels().count() as u64, set.full_count());
        }
    }
}

/// first + popcount(mask & (2^(i % 32) - 1)) of a full voxel i of a row.
fn rank(words: &[RankWord], i: u32) -> Option<u32> {
    let word = words[(i / 32) as usize];
    let bit = 1_u32 << (i % 32);
    (word.mask & bit != 0).then(|| word.first + (word.mask & (bit - 1)).count_ones())
}

/// Ranks with one thing wrong each, by words that are right.
#[test]
fn ranks_that_are_not_those_of_payloads_are_seen() {
    let of_next = |words: &[RankWord], i: u32| {
        let word = words[(i / 32) as usize];
        let first = words
            .get((i / 32 + 1) as usize)
            .map_or(word.first, |word| word.first);
        rank(words, i).map(|found| found - word.first + first)
    };
    let with_itself = |words: &[RankWord], i: u32| rank(words, i).map(|found| found + 1);
    let without_bit_31 = |words: &[RankWord], i: u32| rank(words, i).filter(|_| i % 32 != 31);
    type Rank<'a> = &'a dyn Fn(&[RankWord], u32) -> Option<u32>;
    let wrong: [(&str, Rank); 3] = [
        ("the prefix of the next word", &of_next),
        ("the voxel counts itself", &with_itself),
        ("bit 31 is none", &without_bit_31),
    ];
    for (what, wrong) in wrong {
        let seen = sets()
            .iter()
            .filter(|set| check_ranks(&Runs::new(set, 0), wrong).is_err())
            .count();
        println!("{what}: {seen} of {} sets", sets().len());
        assert!(seen > 5, "{what}: {seen} sets");
    }
}

/// Of the bits of a set alone, the same words.
#[test]
fn words_need_no_runs() {
    for set in sets() {
        let [nx, ny, _] = set.dims();
        let voxel = |n: u32| [n % nx, n / nx % ny, n / nx / ny];
        let made = RunBits::of_rows(set.dims(), |n| set.contains(voxel(n as u32)));
        assert_eq!(made, Runs::new(&set, 0).bits(), "{:?}", set.dims());
    }
}

#[test]
fn sizes_are_those_of_what_is_stored() {
    let set = random([40, 5, 3], 0.4, 3);
    let runs = Runs::new(&set, 0);
    assert_eq!(runs.bytes(), 4 * 16 + 8 * runs.run_count() as u64);
    assert_eq!(runs.bits().bytes(), 8 * 2 * 15);
}
