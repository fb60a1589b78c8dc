//! Memory of volumes that are there at once: one is read while another is drawn.

use super::{DeviceMemory, Held, RenderBytes, SHARE, available_bytes, filters_of};
use crate::{
    cli::{Error, flags::SceneFlags},
    technique::LightPlan,
    volume::Header,
};

/// What knows, perhaps after a while, what a device has for textures; `None` of the CPU references, which need none.
pub trait DeviceRoom {
    /// It.
    fn memory(&self) -> Result<Option<DeviceMemory>, Error>;
}

impl DeviceRoom for Option<DeviceMemory> {
    fn memory(&self) -> Result<Self, Error> {
        Ok(*self)
    }
}

/// True where what is held of a volume fits so often, and once more in memory while the next is read. The header is
/// that of a source that fits.
pub fn leaves_room(
    header: &Header,
    scene: &SceneFlags,
    device: Option<DeviceMemory>,
    held: Held,
    devices: u32,
) -> bool {
    let filters = filters_of(scene);
    let one = RenderBytes::held(header, header.fill.is_some(), held, &filters);
    let light = LightPlan::bytes(header.dims, scene.bundle_count());
    let on_host = one.host.saturating_mul(u64::from(devices) + 1);
    let on_device = one.device.saturating_add(light);
    let on_device = on_device.saturating_mul(devices.into());
    let share = |bytes: u64| (SHARE * bytes as f64) as u64;
    let is_of_host = device.is_some_and(|device| device.is_of_host);
    let in_all = on_host.saturating_add(if is_of_host { on_device } else { 0 });
    let host_bytes = scene.input.max_memory.or_else(available_bytes);
    host_bytes.is_none_or(|there| in_all <= share(there))
        && device.is_none_or(|device| on_device <= share(device.heap_bytes))
}

/// Bytes of the host that what is held of a volume takes; on a CPU driver those of its textures are among them.
pub fn needed_bytes(
    header: &Header,
    scene: &SceneFlags,
    device: Option<DeviceMemory>,
    held: Held,
) -> u64 {
    let needed = RenderBytes::held(header, true, held, &filters_of(scene));
    let light = LightPlan::bytes(header.dims, scene.bundle_count());
    match device.is_some_and(|device| device.is_of_host) {
        true => needed
            .host
            .saturating_add(needed.device)
            .saturating_add(light),
        false => needed.host,
    }
}
