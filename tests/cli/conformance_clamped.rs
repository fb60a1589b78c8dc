//! `stratavox conformance` on a device of the least limits, under a driver that prints, and with waivers.

use crate::person::{Folder, Ran};
use serde_json::{Value, json};
use std::collections::BTreeMap;

#[path = "../layer/mod.rs"]
mod layer;

fn records(folder: &Folder, words: &str) -> (Ran, BTreeMap<String, Value>) {
    let ran = folder.run(&format!("conformance --json a.json --force {words}"));
    let records = read(folder).unwrap_or_else(|| panic!("{ran:#?}"));
    (ran, records)
}

fn read(folder: &Folder) -> Option<BTreeMap<String, Value>> {
    let text = std::fs::read_to_string(folder.path("a.json")).ok()?;
    let package: Value = serde_json::from_str(&text).ok()?;
    let cases = package["cases"].as_array()?.iter();
    let named = cases.map(|case| Some((case["name"].as_str()?.to_owned(), case.clone())));
    named.collect()
}

#[test]
fn a_device_of_least_limits_draws_what_it_can_and_names_what_it_lacks() {
    let folder = Folder::new();
    const BLENDING: &str = "VK_FORMAT_R32G32B32A32_SFLOAT";
    // What lacks nothing but 32-bit blending composites in 16 bits.
    let wanted = [
        (
            "raycast.ray.composite.headlight.linear_fetch.f32.perspective",
            None,
        ),
        ("raycast.ray.mida.lamps.linear_fetch.f32.perspective", None),
        (
            "raycast.ray.composite.waves.linear_fetch.f32.perspective",
            None,
        ),
        (
            "slices_3d.over.composite.homogeneous.linear_fetch.u16.perspective",
            None,
        ),
        (
            "slices_2d.under.composite.waves.linear_fetch.f32.perspective",
            None,
        ),
        (
            "relation.skipped.slices_3d.over.composite.perspective",
            None,
        ),
        (
            "relation.in_bricks.slices_3d.over.composite.perspective",
            Some((
                BLENDING,
                "COLOR_ATTACHMENT | COLOR_ATTACHMENT_BLEND",
                "COLOR_ATTACHMENT",
            )),
        ),
        (
            "slices_3d.mip.ramp.nearest.f32.perspective",
            Some((
                BLENDING,
                "COLOR_ATTACHMENT | COLOR_ATTACHMENT_BLEND",
                "COLOR_ATTACHMENT",
            )),
        ),
        (
            "slices_3d.half_angle.from_behind.12_slices",
            Some((
                BLENDING,
                "COLOR_ATTACHMENT | COLOR_ATTACHMENT_BLEND",
                "COLOR_ATTACHMENT",
            )),
        ),
    ];
    let filter = wanted.map(|(name, _)| name).join("|");
    let (ran, records) = records(
        &folder,
        &format!("--limits vulkan-minimum --filter {filter}"),
    );
    ran.assert_done();
    for (name, lacking) in wanted {
        let record = &records[name];
        let Some((need, wanted, found)) = lacking else {
            assert_eq!(record["verdict"], "pass", "{record}");
            let is_exact = name.starts_with("relation");
            let derivation = record["bound"]["derivation"]
                .as_str()
                .expect("a derivation");
            let is_in_f16 = derivation.contains("16-bit floats");
            assert_eq!(is_in_f16, name.starts_with("slices"), "{record}");
            let widest = record["bound"]["inputs"]["widest"].as_f64();
            assert!(
                is_exact || widest.is_some_and(|widest| widest < 0.1),
                "{record}"
            );
            continue;
        };
        assert_eq!(record["verdict"], "not_supported", "{record}");
        let needs = record["needs"].as_array().expect("needs");
        let record_of = needs
            .iter()
            .find(|record| record["name"] == need)
            .expect(need);
        assert_eq!(record_of["wanted"], wanted, "{record}");
        assert_eq!(record_of["library_says"], found, "{record}");
        assert_eq!(record_of["library_has"], false, "{record}");
        let reason = record["reason"].as_str().expect("a reason");
        let said = format!("{need}: wanted {wanted}, found {found}");
        assert!(reason.starts_with(&said), "{reason}");
    }
}

/// Prints to both outputs without ending its lines, bytes that are no text and more than a pipe holds.
const LOUD: &str = r#"
#include "chain.h"

static PFN_vkVoidFunction of_instance(const char *name, PFN_vkVoidFunction next) { (void)name; return next; }

static PFN_vkQueueSubmit next_submit;
static VKAPI_ATTR VkResult VKAPI_CALL submit(VkQueue queue, uint32_t count, const VkSubmitInfo *infos, VkFence fence) {
    static int has_filled;
    for (int i = 0; !has_filled && i < 3000; i++) {
        printf("{\"record\": %d}\n", i);
        fprintf(stderr, "submission of %u, \xff\n", count);
    }
    has_filled = 1;
    printf("\xff submitting ...");
    fflush(stdout);
    fprintf(stderr, "submitting ...");
    return next_submit(queue, count, infos, fence);
}

static PFN_vkVoidFunction of_device(const char *name, PFN_vkVoidFunction next) {
    TAKE("vkQueueSubmit", next_submit, submit)
    return next;
}
"#;

#[test]
fn a_driver_that_prints_spoils_no_verdict() {
    let folder = Folder::new();
    const NAME: &str = "VK_LAYER_STRATAVOX_loud";
    std::fs::create_dir(folder.path("layers")).expect("a folder");
    if !layer::build(&folder.path("layers"), NAME, LOUD) {
        println!("skipped: {}", layer::UNBUILT);
        return;
    }
    let run = |words: &str| {
        let mut command = folder.command(&format!(
            "conformance --json a.json --force --jobs 1 --timeout 30 --filter probe.math.exp|probe.math.sqrt {words}"
        ));
        let layers = std::env::var("VK_INSTANCE_LAYERS").unwrap_or_default();
        command
            .env("VK_ADD_LAYER_PATH", folder.path("layers"))
            .env("VK_INSTANCE_LAYERS", format!("{NAME}:{layers}"));
        let output = command.output().expect("it runs");
        (
            output.status.code(),
            read(&folder).unwrap_or_else(|| panic!("{output:?}")),
        )
    };
    let (code, records) = run("");
    assert_eq!(code, Some(0));
    for record in records.values() {
        assert_eq!(record["verdict"], "pass", "{record}");
    }
    // What it printed says what became of it.
    let (code, records) = run("--fault probe.math.sqrt=abort");
    assert_eq!(code, Some(1));
    assert_eq!(records["probe.math.exp"]["verdict"], "pass");
    let reason = records["probe.math.sqrt"]["reason"]
        .as_str()
        .expect("a reason");
    assert!(
        reason.contains("it said: ") && reason.contains("submi"),
        "{reason}"
    );
}

#[test]
fn waivers_of_several_files_are_for_their_vendor_device_and_version() {
    let folder = Folder::new();
    let words = "--filter probe.math.exp --jobs 1 --fault *=fail";
    let (_, _) = records(&folder, words);
    let text = std::fs::read_to_string(folder.path("a.json")).expect("a.json");
    let device = serde_json::from_str::<Value>(&text).expect("JSON")["device"].clone();
    let waiver = |change: &dyn Fn(&mut Value)| {
        let version = device["driver_version"].as_u64().expect("a number");
        let mut waiver = json!({"cases": "probe.math.*", "verdicts": ["fail"], "reason": "known",
            "link": "https://example.org/1", "expires": "2999-12-31",
            "vendor_id": format!("{:#x}", device["vendor_id"].as_u64().expect("a number")),
            "device_id": device["device_id"], "driver_id": device["driver_id"],
            "driver": device["driver"], "driver_info": device["driver_info"],
            "driver_version": {"from": version, "before": version + 1}});
        change(&mut waiver);
        json!({"stratavox_waivers": 1, "waivers": [waiver]}).to_string()
    };
    folder.file("none.json", r#"{"stratavox_waivers": 1, "waivers": []}"#);
    let verdict = |change: &dyn Fn(&mut Value)| {
        folder.file("w.json", waiver(change));
        let (_, records) = records(
            &folder,
            &format!("{words} --waivers w.json --waivers none.json"),
        );
        records["probe.math.exp"]["verdict"].clone()
    };
    assert_eq!(verdict(&|_| {}), "waived");
    assert_eq!(verdict(&|waiver| waiver["vendor_id"] = json!(1)), "fail");
    let later = device["driver_version"].as_u64().expect("a number") + 1;
    let from = json!({"from": later});
    assert_eq!(
        verdict(&|waiver| waiver["driver_version"] = from.clone()),
        "fail"
    );
    folder.file("w.json", waiver(&|waiver| waiver["link"] = json!("")));
    let ran =
        folder.run("conformance --filter probe.math.exp --waivers none.json --waivers w.json");
    ran.assert_refused(3, &["w.json", "waiver 1, link: wanted a text, found \"\""]);
}
