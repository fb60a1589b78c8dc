//! What the pipelines cost on graphics cards, as the compiler of RADV's device without hardware says
//! (`docs/gpu-cost.md`).

#[allow(dead_code)]
#[path = "../../examples/gpu_cost/table/mod.rs"]
mod table;

use std::{collections::BTreeSet, process::Command};
use table::{CHILD, Table, cost::Cost, cost::Row, null_device::FAMILIES, page, rows, rules};

const PAGE: &str = include_str!("../../docs/gpu-cost.md");

#[test]
fn pipelines_spill_nothing_and_are_no_dearer_than_in_the_page_or_than_straight() {
    const TEST: &str =
        "cost::pipelines_spill_nothing_and_are_no_dearer_than_in_the_page_or_than_straight";
    if std::env::var_os(CHILD).is_some() {
        return table::child().unwrap();
    }
    let page = page::read(PAGE).unwrap();
    let program = || {
        let mut child = Command::new(std::env::current_exe().unwrap());
        child.args([TEST, "--exact", "--nocapture"]);
        child
    };
    match table::driver(program) {
        Err(why) => return println!("skipped: {why}"),
        Ok(driver) if driver != page.driver => {
            return println!(
                "skipped: docs/gpu-cost.md is of {}, RADV here of {driver}",
                page.driver
            );
        }
        Ok(_) => {}
    }
    let measured = table::measured(program).unwrap();
    let families = measured.families.iter();
    let mut rows_measured = families.clone().flat_map(|(_, rows)| rows);
    if rows_measured.any(|row| row.straight.is_none()) {
        println!("skipped: straight forms, for want of spirv-opt (Debian: spirv-tools)");
    }
    for (family, rows) in families {
        assert_eq!(rows.len(), rows::rows().count(), "{family}");
    }
    let broken = rules::broken(&measured, &page);
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

#[test]
fn the_page_has_each_row_once_and_is_read_as_it_was_written() {
    let names: BTreeSet<_> = rows::rows().map(|(_, name)| name).collect();
    assert_eq!(names.len(), rows::rows().count(), "a row stands twice");
    assert!(names.len() <= rows::MOST_ROWS, "{} rows", names.len());
    let page = page::read(PAGE).unwrap();
    let families: Vec<_> = page.families.iter().map(|(family, _)| family).collect();
    assert_eq!(families, FAMILIES.each_ref());
    for (family, rows) in &page.families {
        let found: Vec<_> = rows.iter().map(|row| row.name.as_str()).collect();
        let wanted: Vec<_> = rows::rows().map(|(_, name)| name).collect();
        assert_eq!(found, wanted, "rows for {family}: run make gpu-cost");
    }
    assert_eq!(page::read(&page::written(&page)).unwrap(), page);
}

/// A table of one row for the first family.
fn table_of(pair: Cost, straight: Option<Cost>) -> Table {
    let name = "distance_map".to_owned();
    let row = Row {
        name,
        pair,
        straight,
    };
    Table {
        driver: "Mesa 1".into(),
        families: vec![(FAMILIES[0].into(), vec![row])],
    }
}

/// Something of a cost that was good.
type Change = fn(&mut Cost);

#[test]
fn each_rule_is_broken_by_what_is_beyond_it_and_kept_by_what_is_not() {
    let good = Cost {
        vgprs: 16,
        sgprs: 128,
        waves: 8,
        code_bytes: 100,
        throughput: 1000,
        ..Cost::default()
    };
    let page = table_of(good.clone(), None);
    let broken = |change: Change| {
        let mut changed = good.clone();
        change(&mut changed);
        rules::broken(&table_of(changed, Some(good.clone())), &page)
    };
    assert!(broken(|_| {}).is_empty());
    assert!(broken(|cost| cost.throughput = 1030).is_empty());
    let cases: [(Change, &[&str]); 4] = [
        (|cost| cost.scratch_bytes = 16, &["16 bytes of scratch"]),
        (|cost| cost.spilled = 1, &["1 spilled registers"]),
        (|cost| cost.waves = 7, &["7 waves"]),
        (
            |cost| cost.throughput = 1031,
            &["in the page", "of its straight form"],
        ),
    ];
    for (change, wanted) in cases {
        let found = broken(change);
        assert_eq!(found.len(), wanted.len(), "{found:?}");
        for (found, wanted) in found.iter().zip(wanted) {
            assert!(found.contains(wanted), "{found}");
        }
    }
    let nothing = Table {
        driver: String::new(),
        families: Vec::new(),
    };
    let found = rules::broken(&page, &nothing);
    assert!(found[0].contains("not in the page"), "{found:?}");
}
