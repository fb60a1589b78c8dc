//! What a picture takes beside the volume: lines along the wind, and geometry of any kind.

use crate::cli::flags::InputFlags;
use crate::cli::flow::wind_bytes;
use crate::cli::memory::RenderBytes;
use crate::geometry::Seen;
use crate::volume::Header;
use serde::Serialize;

/// The volume, and what may be beside it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(super) struct DrawnBytes {
    #[serde(flatten)]
    pub volume: RenderBytes,
    /// Of the wind at one time, and at all of the file, in the memory of the process; `null` where the file has none.
    wind: Option<u64>,
    wind_of_all_times: Option<u64>,
    /// Of a vertex of a line in the memory of the process.
    line_vertex: u64,
    /// Of a pixel of a picture with geometry there, and on the device.
    geometry_pixel: u64,
    geometry_pixel_on_device: u64,
}

impl DrawnBytes {
    /// Beside this volume, in whose input a wind is looked for where there is one.
    pub(super) fn of(volume: RenderBytes, header: &Header, input: Option<&InputFlags>) -> Self {
        let may_have_wind = header.variables.len() > 1 || header.components == 3;
        let wind = input.filter(|_| may_have_wind).and_then(wind_bytes);
        Self {
            volume,
            wind,
            wind_of_all_times: wind.map(|one| one.saturating_mul(header.times.into())),
            line_vertex: crate::cli::flow::VERTEX_BYTES,
            geometry_pixel: Seen::BYTES_PER_PIXEL,
            geometry_pixel_on_device: 2 * size_of::<f32>() as u64,
        }
    }
}
