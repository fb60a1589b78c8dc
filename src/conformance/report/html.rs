//! A page for people: the summary first, then what is not well with its pictures, then every case. It needs no other
//! file but the pictures beside it.

use super::escaped;
use crate::conformance::baseline::Change;
use crate::conformance::record::{Package, Record};
use crate::conformance::verdict::Verdict;
use std::fmt::Write;

const STYLE: &str = "body{font:15px/1.4 sans-serif;max-width:70em;margin:2em auto;padding:0 1em}\
table{border-collapse:collapse}td,th{padding:.15em .6em;text-align:left;vertical-align:top;border-bottom:1px solid #ddd}\
.bad{color:#a00}.good{color:#070}.soft{color:#850}figure{display:inline-block;margin:.3em}\
img{width:256px;image-rendering:pixelated;background:#888}code{font-size:90%}";

/// The whole page.
pub fn html(package: &Package) -> String {
    let mut page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>stratavox conformance</title><style>{STYLE}</style>\n\
         <h1>stratavox conformance</h1>\n"
    );
    summary(&mut page, package);
    device(&mut page, package);
    let bad: Vec<_> = package
        .cases
        .iter()
        .filter(|r| r.verdict.fails_run())
        .collect();
    if !bad.is_empty() {
        let _ = writeln!(page, "<h2>Not well</h2>");
        bad.iter().for_each(|record| told(&mut page, record));
    }
    section(
        &mut page,
        package,
        "Warnings of quality",
        Verdict::QualityWarning,
    );
    section(&mut page, package, "Known, and waived", Verdict::Waived);
    let expected = Verdict::ExpectedFailure;
    section(&mut page, package, "Failed in the baseline too", expected);
    section(&mut page, package, "Not supported", Verdict::NotSupported);
    all(&mut page, package);
    page.push_str("</html>\n");
    page
}

fn summary(page: &mut String, package: &Package) {
    let (class, sentence) = match package.is_good() {
        true => (
            "good",
            "Every case that this device supports lies inside of its bounds.",
        ),
        false => (
            "bad",
            "Some cases do not lie inside of their bounds, or did not end.",
        ),
    };
    let _ = writeln!(page, "<p class=\"{class}\"><b>{sentence}</b></p><table>");
    for verdict in Verdict::ALL {
        if let Some(count) = package.summary.get(&verdict) {
            let _ = writeln!(page, "<tr><th>{verdict}<td>{count}");
        }
    }
    let _ = writeln!(page, "</table>");
    if package.is_partial {
        let _ = writeln!(
            page,
            "<p class=\"bad\">The run ended before all of its cases had run.</p>"
        );
    }
    let weak = package.cases.iter().filter(|record| record.weak_bound);
    let weak = weak.count();
    if weak > 0 {
        let _ = writeln!(
            page,
            "<p>{weak} cases prove little: more than a tenth of their channels may be off by more than half a code of \
             255.</p>"
        );
    }
    for record in &package.cases {
        if let Some(change) = Change::of(record) {
            let (name, change) = (escaped(&record.name), change.word());
            let _ = writeln!(page, "<p>{name}: {change} since the baseline.</p>");
        }
    }
    let known = package.cases.iter().filter(|record| record.unexpected_pass);
    for record in known {
        let name = escaped(&record.name);
        let _ = writeln!(
            page,
            "<p class=\"soft\">{name} passes, and a waiver says it does not.</p>"
        );
    }
}

fn device(page: &mut String, package: &Package) {
    let asked = &package.asked;
    let selection = &asked.selection;
    let [part, parts] = selection.shard;
    let mut rows = vec![
        ("suite", package.suite.clone()),
        ("commit", package.build.commit.clone()),
        (
            "SHA-256 of Cargo.lock",
            package.build.cargo_lock_sha256.clone(),
        ),
        ("profile", selection.profile.word().to_owned()),
        (
            "cases",
            format!("{}, part {part} of {parts}", selection.filter),
        ),
        (
            "lines of the case list",
            selection.caselist.len().to_string(),
        ),
        ("lines of exclusions", selection.exclude.len().to_string()),
        ("runs of each case", asked.repeat.to_string()),
        ("seed", asked.seed.to_string()),
        ("limits", asked.limits.clone()),
        ("time", format!("{:.1} s", package.seconds)),
        ("hash", package.content_sha256.clone()),
    ];
    if let Some(device) = &package.device {
        rows.push(("device", format!("{} ({})", device.name, device.kind)));
        rows.push((
            "driver",
            format!("{} {}", device.driver, device.driver_info),
        ));
        rows.push(("Vulkan", device.vulkan.clone()));
        for (name, is_enabled) in &device.features {
            let is = if *is_enabled {
                "enabled"
            } else {
                "not enabled"
            };
            rows.push((name, is.to_owned()));
        }
        rows.push(("extensions enabled", device.extensions_enabled.join(" ")));
        let available = device.extensions_available.join(" ");
        rows.push(("extensions available", available));
        for (name, number) in &device.limits {
            rows.push((name, number.to_string()));
        }
    }
    let _ = writeln!(page, "<h2>What was asked, and of what</h2><table>");
    for (name, value) in rows {
        let _ = writeln!(page, "<tr><th>{}<td>{}", escaped(name), escaped(&value));
    }
    let _ = writeln!(page, "</table>");
}

fn section(page: &mut String, package: &Package, title: &str, verdict: Verdict) {
    let of = |record: &&Record| record.verdict == verdict;
    if package.cases.iter().any(|record| of(&record)) {
        let _ = writeln!(page, "<h2>{title}</h2>");
        package
            .cases
            .iter()
            .filter(of)
            .for_each(|record| told(page, record));
    }
}

/// All that is known of one case.
fn told(page: &mut String, record: &Record) {
    let _ = writeln!(
        page,
        "<h3><code>{}</code></h3><p>{}: {}</p>",
        escaped(&record.name),
        record.verdict,
        escaped(&record.reason)
    );
    let _ = writeln!(page, "<p><code>{}</code></p>", escaped(&record.command));
    if let Some(waived) = &record.waived {
        let _ = writeln!(
            page,
            "<p class=\"soft\">{}: {} {}</p>",
            waived.verdict,
            escaped(&waived.reason),
            escaped(&waived.link)
        );
    }
    for need in &record.needs {
        let _ = writeln!(
            page,
            "<p>needs {} ({}); the device says {}</p>",
            escaped(&need.name),
            escaped(&need.wanted),
            escaped(&need.device_says)
        );
    }
    for message in &record.validation_messages {
        let _ = writeln!(page, "<p class=\"bad\">{}</p>", escaped(message));
    }
    for file in &record.pictures {
        let what = file.rsplit('.').nth(1).unwrap_or_default();
        let _ = writeln!(
            page,
            "<figure><img src=\"{}\" alt=\"{what}\"><figcaption>{what}</figcaption></figure>",
            escaped(file)
        );
    }
    if let Some(bound) = &record.bound {
        let inputs: Vec<_> = bound
            .inputs
            .iter()
            .map(|(name, n)| format!("{name} = {n}"))
            .collect();
        let _ = writeln!(
            page,
            "<details><summary>bound {}</summary><p>{}</p><p>{}</p></details>",
            escaped(&bound.id),
            escaped(&bound.derivation),
            escaped(&inputs.join(", "))
        );
    }
}

fn all(page: &mut String, package: &Package) {
    let _ = writeln!(
        page,
        "<h2>All cases</h2><details><summary>{} cases</summary><table><tr><th>case<th>verdict<th>of what is allowed<th>numbers<th>bound",
        package.cases.len()
    );
    for record in &package.cases {
        let class = match record.verdict {
            Verdict::Pass => "good",
            verdict if verdict.is_good() => "soft",
            _ => "bad",
        };
        let ratio = record.worst.as_ref().map_or(0.0, |worst| worst.ratio);
        let _ = writeln!(
            page,
            "<tr><td><code>{}</code><td class=\"{class}\">{}<td>{ratio:.3}<td>{}<td>{}",
            escaped(&record.name),
            record.verdict,
            record.checked,
            if record.weak_bound { "weak" } else { "" }
        );
    }
    let _ = writeln!(page, "</table></details>");
}
