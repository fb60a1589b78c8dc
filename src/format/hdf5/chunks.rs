//! Chunks: how many bytes one decodes to, where a filter of ours stops, and what the filters are called.

use super::problem_of;
use crate::format::convert::to_u64;
use crate::format::problem::{escape, invalid};
use crate::format::zstd;
use crate::volume::Problem;
use hdf5_reader::error::Error;
use hdf5_reader::{Dataset, FilterRegistry};
use std::sync::{
    Arc,
    atomic::{AtomicUsize, Ordering},
};

/// Bytes of the largest chunk among the data sets that were read. Clones share the number.
///
/// The library does not tell a filter which data set a chunk is of, and several threads may read several data sets.
#[derive(Clone, Default)]
pub(crate) struct ChunkBytes(Arc<AtomicUsize>);

/// A chunk may be larger than its data set: one of a series of times that has not begun, for example.
const SMALL_CHUNK_BYTES: u64 = 64 << 20;

impl ChunkBytes {
    /// Takes the chunks of a data set into account, before any of them is read.
    ///
    /// # Errors
    /// A chunk that is neither small nor within its data set: it asks for memory that no number of the data set needs.
    pub(super) fn admit(
        &self,
        dataset: &Dataset,
        format: &'static str,
        name: &str,
    ) -> Result<(), Problem> {
        let Some(sides) = dataset.chunks() else {
            return Ok(());
        };
        let number = dataset.raw_element_size();
        let number = to_u64(number.map_err(|error| problem_of(format, name, &error))?);
        let bytes = |sides: &mut dyn Iterator<Item = u64>| sides.fold(number, u64::saturating_mul);
        let chunk = bytes(&mut sides.iter().map(|&side| side.into()));
        let all = bytes(&mut dataset.shape().iter().copied());
        let most = all.max(SMALL_CHUNK_BYTES);
        if chunk > most {
            let wanted = format!("chunks of at most {most} bytes");
            let found = format!("chunks of {chunk} bytes");
            return Err(invalid(format, name, wanted, &found));
        }
        let chunk = usize::try_from(chunk).unwrap_or(usize::MAX);
        self.0.fetch_max(chunk, Ordering::Relaxed);
        Ok(())
    }

    /// The most bytes that a filter may give: filters before it may have added a checksum, or a header.
    fn most(&self) -> usize {
        const ADDED_BYTES: usize = 64;
        let chunk = self.0.load(Ordering::Relaxed);
        chunk
            .saturating_add(chunk.div_ceil(1024))
            .saturating_add(ADDED_BYTES)
    }
}

/// The filters of the library, and Zstandard, registered as 32015.
pub(crate) fn filters(chunk_bytes: &ChunkBytes) -> FilterRegistry {
    let chunk_bytes = chunk_bytes.clone();
    let mut filters = FilterRegistry::new();
    filters.register(
        32015,
        Box::new(move |_, bytes, _| {
            zstd::decode(bytes, chunk_bytes.most())
                .map_err(|cause| Error::FilterError(format!("Zstandard: {cause}")))
        }),
    );
    filters
}

/// The name of a filter that is known by its number, portal.hdfgroup.org, registered filter plug-ins.
pub(super) fn filter_name(name: &str) -> String {
    let known = [
        ("32000", "LZF"),
        ("32001", "Blosc"),
        ("32004", "LZ4"),
        ("32008", "bitshuffle"),
        ("32013", "ZFP"),
        ("32026", "Blosc2"),
    ];
    let known = known.iter().find(|(number, _)| name.contains(number));
    match known {
        Some((number, word)) => format!("the filter {number}, {word},"),
        None => format!("the filter {}", escape(name)),
    }
}
