//! JUnit XML, as servers of continuous integration read it: one `testcase` a case.

use super::escaped;
use crate::conformance::record::{Package, Record};
use crate::conformance::verdict::Verdict;
use std::fmt::Write;

/// The whole file.
pub fn junit(package: &Package) -> String {
    let count = |is: fn(Verdict) -> bool| {
        let all = package.cases.iter();
        all.filter(|record| is(record.verdict)).count()
    };
    let failures = count(|verdict| verdict == Verdict::Fail);
    let errors = count(|verdict| verdict.fails_run() && verdict != Verdict::Fail);
    let skipped = count(is_skipped);
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let device = package.device.as_ref();
    let name = device.map_or_else(String::new, |d| {
        format!("{}, {} {}", d.name, d.driver, d.driver_info)
    });
    let _ = writeln!(
        text,
        "<testsuites>\n<testsuite name=\"stratavox conformance on {}\" tests=\"{}\" failures=\"{failures}\" \
         errors=\"{errors}\" skipped=\"{skipped}\" time=\"{:.3}\">",
        escaped(&name),
        package.cases.len(),
        package.seconds
    );
    for record in &package.cases {
        case(&mut text, record);
    }
    text.push_str("</testsuite>\n</testsuites>\n");
    text
}

/// JUnit has one word for all that is neither passed nor failed; the property `verdict` tells them apart.
fn is_skipped(verdict: Verdict) -> bool {
    use Verdict::{ExpectedFailure, NotSupported, Waived};
    matches!(verdict, NotSupported | Waived | ExpectedFailure)
}

fn case(text: &mut String, record: &Record) {
    let (class, name) = record.name.rsplit_once('.').unwrap_or(("", &record.name));
    let _ = write!(
        text,
        "<testcase classname=\"{}\" name=\"{}\" time=\"{:.3}\">",
        escaped(class),
        escaped(name),
        1e-3 * record.ms
    );
    let mut properties = vec![
        ("verdict", record.verdict.word()),
        ("command", &record.command),
    ];
    properties.extend(record.baseline.map(|verdict| ("baseline", verdict.word())));
    properties.extend(record.weak_bound.then_some(("weak_bound", "true")));
    let _ = write!(text, "<properties>");
    for (name, value) in properties {
        let value = escaped(value);
        let _ = write!(text, "<property name=\"{name}\" value=\"{value}\"/>");
    }
    let _ = write!(text, "</properties>");
    let reason = escaped(&record.reason);
    let _ = match record.verdict {
        Verdict::Pass => Ok(()),
        Verdict::QualityWarning => {
            write!(text, "<system-out>quality_warning: {reason}</system-out>")
        }
        Verdict::Fail => write!(
            text,
            "<failure type=\"fail\" message=\"{reason}\">{}</failure>",
            escaped(record.bound.as_ref().map_or("", |bound| &bound.derivation))
        ),
        verdict if is_skipped(verdict) => {
            write!(text, "<skipped message=\"{verdict}: {reason}\"/>")
        }
        verdict => write!(text, "<error type=\"{verdict}\" message=\"{reason}\"/>"),
    };
    text.push_str("</testcase>\n");
}
