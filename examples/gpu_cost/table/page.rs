//! The page of a table: written by `make gpu-cost`, read by the test.

use super::{Table, cost::Cost, cost::Row};
use std::fmt::Write as _;

const HEAD: &str = "# What pipelines cost on graphics cards

`make gpu-cost` writes this page, without a graphics card: RADV, Mesa's driver for AMD's chips, has a device without hardware
(`RADV_FORCE_FAMILY`) whose compiler is the real one, and `VK_KHR_pipeline_executable_properties` tells what it made. It gets
the SPIR-V that a card gets. The test `cost::` of the test program `gpu` compiles it again where this version of Mesa is
installed, and compares.

## How to read it

A row is a variant: what a SPIR-V module holds for some values of its specialization constants, which the library folds
(`src/shaders/fold.rs`). Rows are what `stratavox bench` draws with and the defaults of each technique and mode on a card (filter `linear` by the sampler, transfer functions as a table), with the
passes before and after; variants that only software drivers use are not among them.

| column | meaning | good |
|---|---|---|
| VGPRs | vector registers of an invocation: they decide the waves | few |
| SGPRs | scalar registers of a wave, which hold what is alike for its invocations; from RDNA on always all 128 | |
| spilled | scalar and vector registers that did not fit and are moved to and fro | 0 |
| scratch | bytes of memory for an invocation's variables: arrays with computed indices, spilled vector registers | 0 |
| waves | subgroups that a SIMD unit holds at a time, by registers and shared memory: while one waits for memory another runs | 8 or more; on GCN 4, with 256 registers a lane for all waves together, no fewer than here |
| code | bytes of machine code; the instruction cache has 32 KiB | |
| throughput | inverse throughput: estimated cycles for 64 invocations. A loop counts as 8 turns (one within it as 4, deeper ones as 2), what a uniform branch holds as half, what a divergent one holds as three quarters; waves that hide latency make it smaller | compare with the same row before |
| straight | that over the inverse throughput of the straight form: the same variant as `spirv-opt` folds it and removes dead branches | at most 1.03 |

The estimate is of compiled code, not of a run: it knows neither caches nor how often a loop turns. It says which of two
forms of one shader is more expensive, and what a change of the shaders has done. Rows of different shaders are not to be compared. A raster
pipeline has a row for each of its stages; its target is `R32G32B32A32_SFLOAT`, blended back to front.

The test asserts no scratch, no spilled registers, waves as above, and that no row is over 3 % more expensive
than here or than its straight form. Where a change makes a row more expensive with good reason, or shaders come and go, run `make gpu-cost`
and commit the page with the change. The rows are in `examples/gpu_cost/table/rows.rs`, the rules in `rules.rs` beside it.
";

const COMPILER: &str = "Compiler: RADV of ";

const COLUMNS: &str =
    "| variant | VGPRs | SGPRs | spilled | scratch | waves | code | throughput | straight |";

/// The text of a page.
pub fn written(table: &Table) -> String {
    let mut text = format!("{HEAD}\n{COMPILER}{}.\n", table.driver);
    for (family, rows) in &table.families {
        let line = format!("|---{}|", "|---:".repeat(8));
        writeln!(text, "\n## {family}\n\n{COLUMNS}\n{line}").unwrap();
        for row in rows {
            let cost = &row.pair;
            let ratio = row.over_straight();
            let ratio = ratio.map_or("-".into(), |ratio| format!("{ratio:.3}"));
            writeln!(
                text,
                "| `{}` | {} | {} | {} | {} | {} | {} | {} | {ratio} |",
                row.name,
                cost.vgprs,
                cost.sgprs,
                cost.spilled,
                cost.scratch_bytes,
                cost.waves,
                cost.code_bytes,
                cost.throughput,
            )
            .unwrap();
        }
    }
    text
}

/// The table of a page, without straight forms.
///
/// # Errors
/// The line that is none of a page's.
pub fn read(text: &str) -> Result<Table, String> {
    let mut table = Table {
        driver: String::new(),
        families: Vec::new(),
    };
    for line in text.lines() {
        if let Some(driver) = line.strip_prefix(COMPILER) {
            driver.trim_end_matches('.').clone_into(&mut table.driver);
        } else if let Some(family) = line.strip_prefix("## ") {
            table.families.push((family.to_owned(), Vec::new()));
        } else if let Some(cells) = line.strip_prefix("| `") {
            let row = row(cells).ok_or_else(|| format!("no row of a table: {line}"))?;
            let (_, rows) = table.families.last_mut().ok_or("a row without a family")?;
            rows.push(row);
        }
    }
    // The chapter before the tables has none.
    table.families.retain(|(_, rows)| !rows.is_empty());
    Ok(table)
}

fn row(cells: &str) -> Option<Row> {
    let (name, cells) = cells.split_once("` |")?;
    let cells: Vec<&str> = cells.split('|').map(str::trim).collect();
    let &[
        vgprs,
        sgprs,
        spilled,
        scratch,
        waves,
        code,
        throughput,
        _,
        "",
    ] = &cells[..]
    else {
        return None;
    };
    let numbers = [vgprs, sgprs, spilled, scratch, waves, code, throughput];
    let numbers: Result<Vec<u64>, _> = numbers.iter().map(|cell| cell.parse()).collect();
    Some(Row {
        name: name.to_owned(),
        pair: Cost::of_numbers(&numbers.ok()?)?,
        straight: None,
    })
}
