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
    let errors = count(|verdict| !verdict.is_good() && verdict != Verdict::Fail);
    let skipped = count(|verdict| matches!(verdict, Verdict::NotSupported | Verdict::Waived));
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

fn case(text: &mut String, record: &Record) {
    let (class, name) = record.name.rsplit_once('.').unwrap_or(("", &record.name));
    let _ = write!(
        text,
        "<testcase classname=\"{}\" name=\"{}\" time=\"{:.3}\"",
        escaped(class),
        escaped(name),
        1e-3 * record.ms
    );
    let reason = escaped(&record.reason);
    let _ = match record.verdict {
        Verdict::Pass => writeln!(text, "/>"),
        Verdict::QualityWarning => {
            writeln!(
                text,
                "><system-out>quality_warning: {reason}</system-out></testcase>"
            )
        }
        Verdict::NotSupported | Verdict::Waived => writeln!(
            text,
            "><skipped message=\"{}: {reason}\"/></testcase>",
            record.verdict
        ),
        Verdict::Fail => writeln!(
            text,
            "><failure type=\"fail\" message=\"{reason}\">{}</failure></testcase>",
            escaped(record.bound.as_ref().map_or("", |bound| &bound.derivation))
        ),
        verdict => writeln!(
            text,
            "><error type=\"{verdict}\" message=\"{reason}\"/></testcase>"
        ),
    };
}
