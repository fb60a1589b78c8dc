//! The test log of the Khronos suites (`.qpa`), as their tools and those of Mesa read it: lines that begin with `#`, and
//! between them one XML document a case (VK-GL-CTS, `framework/qphelper/qpTestLog.c`).

use super::escaped;
use crate::conformance::record::{Package, Record};
use crate::conformance::verdict::Verdict;
use std::fmt::Write;

/// The whole file.
pub fn qpa(package: &Package) -> String {
    let mut text = format!(
        "#sessionInfo releaseName stratavox-{}\n#sessionInfo releaseId 0x{}\n#sessionInfo targetName \"stratavox\"\n",
        package.suite,
        release_id(&package.build.commit)
    );
    if let Some(device) = &package.device {
        let _ = writeln!(text, "#sessionInfo vendorID 0x{:04x}", device.vendor_id);
        let _ = writeln!(text, "#sessionInfo deviceID 0x{:04x}", device.device_id);
        let _ = writeln!(text, "#sessionInfo deviceName \"{}\"", plain(&device.name));
        let driver = format!("{} {}", device.driver, device.driver_info);
        let _ = writeln!(text, "#sessionInfo driver \"{}\"", plain(&driver));
    }
    text.push_str("#beginSession\n");
    for record in &package.cases {
        case(&mut text, record);
    }
    text.push_str("\n#endSession\n");
    text
}

/// The first 32 bits of the commit, 0 where none is known.
fn release_id(commit: &str) -> &str {
    match commit.get(..8) {
        Some(id) if id.bytes().all(|byte| byte.is_ascii_hexdigit()) => id,
        _ => "00000000",
    }
}

/// On one line, so that nothing in it looks like a line of the log, and without quotes.
fn plain(text: &str) -> String {
    let is_kept = |c: char| !c.is_control() && c != '"';
    let kept = text.chars().map(|c| if is_kept(c) { c } else { ' ' });
    kept.collect()
}

fn case(text: &mut String, record: &Record) {
    let name = &record.name;
    let _ = writeln!(
        text,
        "\n#beginTestCaseResult {name}\n<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <TestCaseResult Version=\"0.3.4\" CasePath=\"{}\" CaseType=\"SelfValidate\">",
        escaped(name)
    );
    let mut notes = vec![record.command.clone()];
    if let Some(bound) = &record.bound {
        notes.push(format!("bound {}: {}", bound.id, bound.derivation));
    }
    if let Some(worst) = &record.worst {
        notes.push(format!(
            "worst: {}, expected {:e}, found {:e}, allowed {:e}",
            worst.at, worst.expected, worst.found, worst.allowed
        ));
    }
    notes.extend(record.validation_messages.iter().cloned());
    for note in notes {
        let _ = writeln!(text, " <Text>{}</Text>", escaped(&plain(&note)));
    }
    let _ = writeln!(
        text,
        " <Number Name=\"TestDuration\" Description=\"Test case duration in microseconds\" Tag=\"Time\" \
         Unit=\"us\">{}</Number>\n <Result StatusCode=\"{}\">{}</Result>\n</TestCaseResult>\n\n#endTestCaseResult",
        (1e3 * record.ms).round(),
        status(record),
        escaped(&plain(&record.reason))
    );
}

/// The log has no word for a failure that was expected: it is the failure that it is.
fn status(record: &Record) -> &'static str {
    match (record.verdict, record.baseline) {
        (Verdict::ExpectedFailure, Some(verdict)) => word(verdict),
        (verdict, _) => word(verdict),
    }
}

fn word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Pass => "Pass",
        Verdict::QualityWarning => "QualityWarning",
        Verdict::NotSupported => "NotSupported",
        Verdict::Fail | Verdict::ExpectedFailure => "Fail",
        Verdict::ResourceError => "ResourceError",
        Verdict::InternalError => "InternalError",
        Verdict::Timeout => "Timeout",
        Verdict::Crash => "Crash",
        Verdict::DeviceLost => "DeviceLost",
        Verdict::Waived => "Waiver",
    }
}
