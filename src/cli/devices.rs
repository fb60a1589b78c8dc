//! `stratavox devices`: what is here to draw with, and what it lacks.

use super::{Error, error::visible, output::say};
use crate::gpu::{DeviceReport, Identity, Need, Requirement, list_devices};
use clap::Args;
use serde_json::{Value, json};
use std::fmt::Write;

/// List the Vulkan devices, what they can do for us and what they lack
#[derive(Args, Debug)]
#[command(after_help = "Example:\n  stratavox devices --json")]
pub struct Devices {
    /// As JSON
    #[arg(long)]
    json: bool,
}

impl Devices {
    /// Prints one report a device.
    pub fn run(self) -> Result<(), Error> {
        let devices = list_devices()?;
        if self.json {
            let devices: Vec<_> = devices.iter().enumerate().map(json_of).collect();
            return say(&format!("{:#}\n", json!({ "devices": devices })));
        }
        let text: String = devices.iter().enumerate().map(text_of).collect();
        say(if text.is_empty() {
            "no Vulkan device\n"
        } else {
            &text
        })
    }
}

fn uuid_text(uuid: &[u8; 16]) -> String {
    uuid.iter().map(|byte| format!("{byte:02x}")).collect()
}

fn json_of((index, device): (usize, &DeviceReport)) -> Value {
    let identity = &device.identity;
    let [major, minor, patch] = identity.api_version;
    let abilities: Vec<_> = device
        .findings
        .iter()
        .map(|finding| {
            let Requirement {
                item,
                need,
                unlocks,
            } = finding.requirement;
            json!({
                "name": item.to_string(),
                "wanted": item.wanted(),
                "found": finding.found,
                "present": finding.is_met,
                "required": need == Need::Required,
                "unlocks": unlocks,
            })
        })
        .collect();
    json!({
        "index": index,
        "name": identity.name,
        "kind": identity.kind.name(),
        "uuid": uuid_text(&identity.uuid),
        "vulkan": format!("{major}.{minor}.{patch}"),
        "driver": identity.driver_name,
        "driver_info": identity.driver_info,
        "memory_bytes": device.memory_bytes,
        "usable": device.is_usable(),
        "abilities": abilities,
    })
}

/// The driver's name, and its version as far as it has words for it.
pub fn driver_text(identity: &Identity) -> String {
    let text = format!("{} {}", identity.driver_name, identity.driver_info);
    text.trim_end().to_owned()
}

fn text_of((index, device): (usize, &DeviceReport)) -> String {
    let identity = &device.identity;
    let [major, minor, patch] = identity.api_version;
    let mut text = String::new();
    let _ = writeln!(
        text,
        "{index}  {} ({})",
        visible(&identity.name),
        identity.kind.name()
    );
    let _ = writeln!(text, "   uuid    {}", uuid_text(&identity.uuid));
    let _ = writeln!(
        text,
        "   driver  {}, Vulkan {major}.{minor}.{patch}",
        visible(&driver_text(identity)),
    );
    let _ = writeln!(text, "   memory  {} MiB", device.memory_bytes >> 20);
    let verdict = if device.is_usable() {
        "can draw"
    } else {
        "cannot draw"
    };
    let _ = writeln!(text, "   {verdict}");
    for (need, word) in [
        (Need::Required, "required"),
        (Need::Recommended, "recommended"),
    ] {
        for finding in device.missing(need) {
            let unlocks = finding.requirement.unlocks;
            let _ = writeln!(text, "   lacks {finding}, {word} for {unlocks}");
        }
    }
    text
}
