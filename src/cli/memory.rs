//! What memory a picture takes, and whether it is there: asked before the first voxel is read.
//!
//! ```text
//! host   = voxels as they are kept + one byte a voxel where some may be no data
//! device = voxels as texels        + the same
//! ```
//!
//! The light volume of occlusion and shadows comes on top, on the device.
//!
//! Filters that read coefficients have floats as texels, made of one volume after the other in memory of the host.
//!
//! The textures of a CPU driver lie in the memory of the host: there the sum has to fit.

mod at_once;

pub use at_once::{DeviceRoom, leaves_room, needed_bytes};

use super::{
    Error,
    flags::{InputFlags, SceneFlags},
};
use crate::{
    resident::{FootprintTexels, KeptGradients},
    technique::{FilterBy, GradientSource, GradientStorage, LightPlan, Settings},
    volume::{Header, Reduced, Source, Volume, VoxelType},
};
use serde::Serialize;

/// What one time and component takes, pictures left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct RenderBytes {
    /// In the memory of the process.
    pub host: u64,
    /// In the memory of the device.
    pub device: u64,
}

impl RenderBytes {
    /// Of a volume like this one; `has_holes` where voxels without data are known or expected.
    pub fn of(header: &Header, has_holes: bool) -> Self {
        let voxels = header.voxel_count();
        // What is not kept exactly becomes f32; 8-bit numbers may need 16 on a device.
        let host = if header.stored.is_kept_exactly() {
            header.stored.bytes() as u64
        } else {
            4
        };
        let device = host.max(2);
        let mask = u64::from(has_holes);
        Self {
            host: voxels.saturating_mul(host + mask),
            device: voxels.saturating_mul(device + mask),
        }
    }

    /// Of volumes like this one that are there at once, and what filters make of them.
    fn held(header: &Header, has_holes: bool, held: Held, filters: &Settings) -> Self {
        let one = Self::of(header, has_holes);
        let floats = Header {
            stored: VoxelType::F32,
            ..header.clone()
        };
        let floats = Self::of(&floats, has_holes);
        let (count, mut all) = match held {
            Held::Volumes(count) => (count, one.times(count)),
            Held::Denoised(count) => {
                let noisy = one.times(count).host;
                let host = noisy.saturating_add(floats.times(count + 1).host);
                let device = floats.times(count).device;
                (count, Self { host, device })
            }
            Held::Classified => {
                let host = one.host.saturating_add(floats.times(4).host);
                let device = floats.times(4).device;
                (1, Self { host, device })
            }
            Held::Blend => {
                let host = one.times(2).host.saturating_add(floats.host);
                (1, Self { host, ..floats })
            }
        };
        if filters.filter.spline().is_some() {
            all.host = all.host.saturating_add(floats.host);
            all.device = floats.times(count).device;
        }
        if filters.gradient_storage == GradientStorage::Precomputed {
            let kept = header
                .voxel_count()
                .saturating_mul(KeptGradients::BYTES_PER_VOXEL);
            all.device = all.device.saturating_add(kept);
        }
        // A texture beside the values, without a mask of its own.
        let layout = filters.technique.desc().layouts[0];
        let beside = match filters.gradient_source_beside(layout) {
            None => return all,
            Some(GradientSource::Voxels) => Self {
                host: 0,
                ..Self::of(header, false)
            },
            Some(GradientSource::Coefficients(_)) => floats.times(1),
        };
        Self {
            host: all.host.saturating_add(beside.host),
            device: all.device.saturating_add(beside.device),
        }
    }

    fn times(self, volumes: u32) -> Self {
        Self {
            host: self.host.saturating_mul(volumes.into()),
            device: self.device.saturating_mul(volumes.into()),
        }
    }
}

/// Bytes of the device's memory that pictures by rays take where its driver is llvmpipe: corners in
/// place of texels.
pub fn software_device_bytes(header: &Header, has_holes: bool) -> u64 {
    let mask = if has_holes { header.voxel_count() } else { 0 };
    match FootprintTexels::bytes_of(header.stored, header.dims) {
        Some(corners) => corners.saturating_add(mask),
        None => RenderBytes::of(header, has_holes).device,
    }
}

/// The sampler, where nobody asks for another way and corners take more than `--max-memory`. What happens to be free
/// does not count: the same words draw the same picture.
pub fn filter_by(input: &InputFlags, wanted: FilterBy, volumes: &[&Volume]) -> FilterBy {
    let bytes_of = |volume: &&Volume| {
        let stored = volume.voxels.voxel_type();
        let voxel_bytes = stored.bytes() as u64 + u64::from(volume.validity.is_some());
        let corners = FootprintTexels::bytes_of(stored, volume.dims).unwrap_or(0);
        (volume.voxels.len() as u64 * voxel_bytes).saturating_add(corners)
    };
    let bytes = volumes.iter().map(bytes_of).fold(0, u64::saturating_add);
    filter_by_of_bytes(input, wanted, bytes)
}

/// The same of voxels that are classified: of the four volumes of floats that are made of them.
pub fn filter_by_of_classified(input: &InputFlags, wanted: FilterBy, volume: &Volume) -> FilterBy {
    let voxel_bytes = 4 * (4 + u64::from(volume.validity.is_some()));
    filter_by_of_bytes(input, wanted, voxel_bytes * volume.voxels.len() as u64)
}

fn filter_by_of_bytes(input: &InputFlags, wanted: FilterBy, bytes: u64) -> FilterBy {
    match (wanted, input.max_memory) {
        (FilterBy::Auto, Some(there)) if bytes as f64 > SHARE * there as f64 => FilterBy::Sampler,
        _ => wanted,
    }
}

/// Volumes of one source that are there at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Held {
    /// So many, on the device too.
    Volumes(u32),
    /// So many that become floats, one after the other, by a noise filter.
    Denoised(u32),
    /// One of which each voxel becomes four floats, which alone are on the device.
    Classified,
    /// Those of two times, and floats between them, which alone are on the device.
    Blend,
}

impl Held {
    /// So many volumes of a picture of these flags.
    pub fn of(scene: &SceneFlags, count: u32) -> Self {
        let mode = scene.sampling.mode.unwrap_or_default();
        let count = count + u32::from(scene.modes.paint(mode).is_some());
        match scene.denoise {
            _ if scene.sampling.preclassified => Self::Classified,
            Some(_) => Self::Denoised(count),
            None => Self::Volumes(count),
        }
    }
}

/// The memory that a device has for textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DeviceMemory {
    /// Its largest heap.
    pub heap_bytes: u64,
    /// True where that is the memory of the host.
    pub is_of_host: bool,
}

/// Voxels of a source that are read at once to be reduced.
const SLAB_BYTES: u64 = 256 << 20;

/// Part of what is there that a volume may take: the rest is for pictures, programs and the system.
const SHARE: f64 = 0.9;

/// The source, reduced where that is wanted and needed, so that what is held of it fits.
///
/// # Errors
/// Where the memory is not there, and `--fit` is not given.
pub fn fitting(
    source: Box<dyn Source>,
    scene: &SceneFlags,
    device: Option<DeviceMemory>,
    held: Held,
) -> Result<Box<dyn Source>, Error> {
    let input = &scene.input;
    let filters = filters_of(scene);
    let host_bytes = input.max_memory.or_else(available_bytes);
    let light = LightPlan::bytes(source.header().dims, scene.bundle_count());
    let (host_left, device_left) = beside_light(light, host_bytes, device);
    let factor = least_factor(source.header(), held, &filters, host_left, device_left);
    if factor == 1 {
        return Ok(source);
    }
    if input.fit {
        let slab_bytes = host_bytes.map_or(SLAB_BYTES, |there| (there / 16).min(SLAB_BYTES));
        return Ok(Box::new(Reduced::new(source, factor, slab_bytes)));
    }
    let needed = RenderBytes::held(source.header(), false, held, &filters);
    let there = |bytes: Option<u64>| bytes.map_or("an unknown amount".to_owned(), in_units);
    Err(Error::Memory(format!(
        "{}: the volume needs {} of memory and {} of the device's; there are {} and {}",
        source.path().display(),
        in_units(needed.host),
        in_units(needed.device.saturating_add(light)),
        there(host_bytes),
        there(device.map(|device| device.heap_bytes)),
    )))
}

/// True where a picture of the volume needs more memory than there is.
pub fn is_too_large(
    header: &Header,
    scene: &SceneFlags,
    device: Option<DeviceMemory>,
    held: Held,
) -> bool {
    let host_bytes = scene.input.max_memory.or_else(available_bytes);
    let light = LightPlan::bytes(header.dims, scene.bundle_count());
    let (host_left, device_left) = beside_light(light, host_bytes, device);
    least_factor(header, held, &filters_of(scene), host_left, device_left) > 1
}

/// Bytes of the device that bricks may take, and of the host that reading them may.
pub fn for_bricks(scene: &SceneFlags, device: DeviceMemory) -> [u64; 2] {
    let host_bytes = scene.input.max_memory.or_else(available_bytes);
    let host_bytes = host_bytes.unwrap_or(device.heap_bytes);
    let there = match device.is_of_host {
        true => device.heap_bytes.min(host_bytes) / 2,
        false => device.heap_bytes / 10 * 8,
    };
    let wanted = scene.input.device_memory;
    [
        wanted.map_or(there, |wanted| wanted.min(device.heap_bytes)),
        (host_bytes / 16).min(SLAB_BYTES / 2),
    ]
}

/// True where what is held of a volume is so little beside the memory of the host that it may be read before anything
/// is known of the device.
pub fn is_little(header: &Header, scene: &SceneFlags, held: Held) -> bool {
    const SHARE: u64 = 8;
    let needed = RenderBytes::held(header, true, held, &filters_of(scene));
    let there = scene.input.max_memory.or_else(available_bytes);
    let needed = needed.host.saturating_add(needed.device);
    there.is_some_and(|there| needed <= there / SHARE)
}

/// Of the settings, those that memory depends on.
fn filters_of(scene: &SceneFlags) -> Settings {
    Settings {
        technique: scene.sampling.technique.unwrap_or_default(),
        filter: scene.sampling.filter.unwrap_or_default(),
        gradient_filter: scene.gradient.filter(),
        gradient_storage: scene.gradient.keep(),
        ..Settings::default()
    }
}

/// What there is when the light volume is there too.
fn beside_light(
    light: u64,
    host_bytes: Option<u64>,
    device: Option<DeviceMemory>,
) -> (Option<u64>, Option<DeviceMemory>) {
    let is_of_host = device.is_none_or(|device| device.is_of_host);
    let on_host = if is_of_host { light } else { 0 };
    let device = device.map(|device| DeviceMemory {
        heap_bytes: device.heap_bytes.saturating_sub(light),
        ..device
    });
    (
        host_bytes.map(|there| there.saturating_sub(on_host)),
        device,
    )
}

/// By how much each axis has to shrink.
fn least_factor(
    header: &Header,
    held: Held,
    filters: &Settings,
    host_bytes: Option<u64>,
    device: Option<DeviceMemory>,
) -> u32 {
    let whole = RenderBytes::held(header, header.fill.is_some(), held, filters);
    let largest = header.dims.iter().copied().max().unwrap_or(1);
    let fits = |&factor: &u32| {
        let part = |bytes: u64| bytes as f64 / f64::from(factor).powi(3);
        let within = |wanted: f64, there: Option<u64>| {
            there.is_none_or(|there| wanted <= SHARE * there as f64)
        };
        let on_device = device.map_or(0.0, |_| part(whole.device));
        let shares = device.is_some_and(|device| device.is_of_host);
        let on_host = part(whole.host) + if shares { on_device } else { 0.0 };
        within(on_host, host_bytes) && within(on_device, device.map(|d| d.heap_bytes))
    };
    (1..largest).find(fits).unwrap_or(largest)
}

/// Memory that this process may still take without swapping: the least of what the system and its control group
/// have left. `None` where the system does not tell.
pub fn available_bytes() -> Option<u64> {
    let system = std::fs::read_to_string("/proc/meminfo")
        .ok()
        .and_then(|text| kib_of_line(&text, "MemAvailable:"));
    let read = |name: &str| {
        let text = std::fs::read_to_string(format!("/sys/fs/cgroup/{name}")).ok()?;
        text.trim().parse::<u64>().ok()
    };
    let group = read("memory.max")
        .zip(read("memory.current"))
        .map(|(most, now)| most.saturating_sub(now));
    [system, group].into_iter().flatten().min()
}

/// `MemAvailable:   123 kB` in bytes.
fn kib_of_line(text: &str, name: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    let kib: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    kib.checked_mul(1024)
}

/// `2.5 GiB`.
pub fn in_units(bytes: u64) -> String {
    const UNITS: [&str; 5] = ["bytes", "KiB", "MiB", "GiB", "TiB"];
    let mut size = bytes as f64;
    let mut unit = 0;
    while size >= 1024.0 && unit + 1 < UNITS.len() {
        size /= 1024.0;
        unit += 1;
    }
    let digits = usize::from(unit > 0 && size < 100.0);
    format!("{size:.digits$} {}", UNITS[unit])
}

/// A size as people write it: `512M`, `2G`, `1.5GiB`, or plain bytes.
pub fn bytes_of_word(word: &str) -> Result<u64, String> {
    let wanted = || format!("wanted a size such as 512M or 2G, found {word:?}");
    let end = word.find(|c: char| !(c.is_ascii_digit() || c == '.'));
    let (number, unit) = word.split_at(end.unwrap_or(word.len()));
    let number: f64 = number.parse().map_err(|_| wanted())?;
    let unit = unit.to_ascii_uppercase();
    let power = match unit.trim_end_matches("IB").trim_end_matches('B') {
        "" => 0,
        "K" => 1,
        "M" => 2,
        "G" => 3,
        "T" => 4,
        _ => return Err(wanted()),
    };
    let bytes = number * 1024_f64.powi(power);
    if !(1.0..1.8e19).contains(&bytes) {
        return Err(wanted());
    }
    Ok(bytes as u64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::technique::{Filter, GradientFilter};
    use crate::volume::Format;
    use glam::DAffine3;

    const ONE: Held = Held::Volumes(1);
    fn filters(filter: Filter, gradient_filter: GradientFilter) -> Settings {
        Settings {
            filter,
            gradient_filter,
            ..Settings::default()
        }
    }

    fn least_factor(
        header: &Header,
        held: Held,
        host_bytes: Option<u64>,
        device: Option<DeviceMemory>,
    ) -> u32 {
        super::least_factor(header, held, &Settings::default(), host_bytes, device)
    }

    fn header(side: u32, stored: VoxelType) -> Header {
        Header::new(Format::Raw, [side; 3], stored, DAffine3::IDENTITY)
    }

    #[test]
    fn a_volume_shrinks_by_the_least_factor_that_fits() {
        // 100^3 u16: 2 MB on each side.
        let header = header(100, VoxelType::U16);
        let card = |heap_bytes| {
            Some(DeviceMemory {
                heap_bytes,
                is_of_host: false,
            })
        };
        let cpu = |heap_bytes| {
            Some(DeviceMemory {
                heap_bytes,
                is_of_host: true,
            })
        };
        assert_eq!(least_factor(&header, ONE, None, None), 1);
        assert_eq!(least_factor(&header, ONE, Some(2_300_000), None), 1);
        assert_eq!(least_factor(&header, ONE, Some(2_200_000), None), 2);
        assert_eq!(
            least_factor(&header, ONE, Some(2_300_000), card(2_300_000)),
            1
        );
        assert_eq!(
            least_factor(&header, ONE, Some(2_300_000), cpu(2_300_000)),
            2
        );
        assert_eq!(least_factor(&header, ONE, Some(1 << 40), card(80_000)), 4);
        assert_eq!(least_factor(&header, ONE, Some(1 << 40), card(0)), 100);
    }

    #[test]
    fn coefficients_are_floats_on_the_device_and_once_more_in_memory() {
        // 100^3 u16: 2 MB and 4 MB of floats a volume.
        let header = header(100, VoxelType::U16);
        let bytes = |held, filters: &Settings| {
            let RenderBytes { host, device } = RenderBytes::held(&header, false, held, filters);
            (host / 1_000_000, device / 1_000_000)
        };
        let held = |held, filter| bytes(held, &filters(filter, GradientFilter::Central));
        assert_eq!(held(ONE, Filter::Linear), (2, 2));
        assert_eq!(held(ONE, Filter::CubicSmooth), (2, 2));
        assert_eq!(held(ONE, Filter::CatmullRom), (2, 2));
        assert_eq!(held(ONE, Filter::Cubic), (6, 4));
        assert_eq!(held(Held::Volumes(3), Filter::Quadratic), (10, 12));
        assert_eq!(held(Held::Blend, Filter::Linear), (8, 4));
        assert_eq!(held(Held::Blend, Filter::Cubic), (12, 4));
        let gradient_transfer = |filter, gradient| bytes(ONE, &filters(filter, gradient));
        assert_eq!(
            gradient_transfer(Filter::Linear, GradientFilter::Cubic),
            (6, 6)
        );
        assert_eq!(
            gradient_transfer(Filter::Cubic, GradientFilter::Cubic),
            (6, 4)
        );
        assert_eq!(
            gradient_transfer(Filter::Cubic, GradientFilter::Linear),
            (6, 6)
        );
        assert_eq!(
            gradient_transfer(Filter::Nearest, GradientFilter::Sobel),
            (2, 2)
        );
    }

    #[test]
    fn a_blend_takes_two_volumes_and_floats_and_floats_alone_on_the_device() {
        // 100^3 u16: 2 MB, 2 MB, and 4 MB of floats; nine tenths of the memory may be taken.
        let header = header(100, VoxelType::U16);
        let fits = |host, heap_bytes, is_of_host| {
            let device = DeviceMemory {
                heap_bytes,
                is_of_host,
            };
            least_factor(&header, Held::Blend, Some(host), Some(device)) == 1
        };
        assert!(fits(8_900_000, 4_500_000, false));
        assert!(!fits(8_800_000, 4_500_000, false));
        assert!(!fits(8_900_000, 4_400_000, false));
        assert!(fits(13_400_000, 13_400_000, true));
        assert!(!fits(13_300_000, 13_300_000, true));
    }

    #[test]
    fn light_takes_its_part_of_the_device_and_of_the_host_where_that_is_the_device() {
        // Cells, and the corners of them for two bundles.
        let light = LightPlan::bytes([512, 60, 100], 2);
        assert_eq!(light, 4 * (128 * 60 * 100 + 2 * 129 * 61 * 101));
        assert_eq!(LightPlan::bytes([512; 3], 0), 0);
        let card = |is_of_host| DeviceMemory {
            heap_bytes: 100,
            is_of_host,
        };
        let left = |light, device| {
            let (host, device) = beside_light(light, Some(50), device);
            (host, device.map(|device| device.heap_bytes))
        };
        assert_eq!(left(30, Some(card(false))), (Some(50), Some(70)));
        assert_eq!(left(30, Some(card(true))), (Some(20), Some(70)));
        assert_eq!(left(60, None), (Some(0), None));
    }

    #[test]
    fn sizes_are_read_as_they_are_written() {
        for (word, bytes) in [
            ("4096", 4096),
            ("2K", 2048),
            ("1.5G", 3 << 29),
            ("3MiB", 3 << 20),
            ("3mb", 3 << 20),
        ] {
            assert_eq!(bytes_of_word(word), Ok(bytes), "{word}");
        }
        for word in ["", "G", "-1G", "1X", "0", "1e300G", "nan"] {
            assert!(bytes_of_word(word).is_err(), "{word}");
        }
        assert_eq!(in_units(512), "512 bytes");
        assert_eq!(in_units(3 << 29), "1.5 GiB");
        assert_eq!(in_units(900 << 20), "900 MiB");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn the_memory_of_this_machine_is_known() {
        let bytes = available_bytes().expect("a number");
        assert!(bytes > 1 << 20, "{bytes}");
        let text = "MemTotal: 5 kB\nMemAvailable:      7 kB\n";
        assert_eq!(kib_of_line(text, "MemAvailable:"), Some(7 << 10));
    }
}
