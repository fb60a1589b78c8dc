//! What the pipelines of stratavox cost on graphics cards, as RADV's compiler says without one.
//!
//! The chip is chosen by an environment variable that the driver reads once: each family is measured in a process of
//! its own, which prints a line for each row.

mod compiled;
pub mod cost;
pub mod null_device;
pub mod page;
pub mod rows;
pub mod rules;
mod straight;

use compiled::Code;
use cost::{Cost, Row};
use null_device::{FAMILIES, NullDevice};
use std::process::{Child, Command, Stdio};
use stratavox::shaders::shader;

/// Says to a process what it is to print.
pub const CHILD: &str = "STRATAVOX_GPU_COST_CHILD";

/// The version of the driver, and no more.
const DRIVER: &str = "driver";
/// That and all rows.
const ROWS: &str = "rows";

/// The rows of all families.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// `Mesa 22.3.6`.
    pub driver: String,
    /// In the order of [`FAMILIES`].
    pub families: Vec<(String, Vec<Row>)>,
}

impl Table {
    /// That row of that family.
    pub fn row(&self, family: &str, name: &str) -> Option<&Row> {
        let (_, rows) = self.families.iter().find(|(one, _)| one == family)?;
        rows.iter().find(|row| row.name == name)
    }
}

/// The version of the driver that is installed. `Err` says why there is none.
pub fn driver(program: impl Fn() -> Command) -> Result<String, String> {
    let child = spawned(program(), FAMILIES[0], DRIVER)?;
    Ok(printed(child, FAMILIES[0])?.0)
}

/// Measures by children of that program, which call [`child`]. `Err` says what is not installed, or has failed.
pub fn measured(program: impl Fn() -> Command) -> Result<Table, String> {
    let children = FAMILIES
        .iter()
        .map(|family| spawned(program(), family, ROWS));
    let children: Vec<Child> = children.collect::<Result<_, _>>()?;
    let mut table = Table {
        driver: String::new(),
        families: Vec::new(),
    };
    for (family, child) in FAMILIES.iter().zip(children) {
        let (driver, rows) = printed(child, family)?;
        table.driver = driver;
        table.families.push(((*family).to_owned(), rows));
    }
    Ok(table)
}

/// A process on the null device of a family.
fn spawned(mut program: Command, family: &str, what: &str) -> Result<Child, String> {
    let manifest = null_device::manifest()
        .ok_or("RADV is not installed (Debian: mesa-vulkan-drivers)".to_owned())?;
    let child = program
        .env(CHILD, what)
        .env("RADV_FORCE_FAMILY", family)
        .env("VK_DRIVER_FILES", &manifest)
        .env("VK_ICD_FILENAMES", &manifest)
        // What comes out of the driver's cache has no statistics.
        .env("MESA_SHADER_CACHE_DISABLE", "true")
        .env_remove("VK_INSTANCE_LAYERS")
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn();
    child.map_err(|e| format!("measure for {family}: {e}"))
}

/// What it has printed.
fn printed(child: Child, family: &str) -> Result<(String, Vec<Row>), String> {
    let output = child.wait_with_output().map_err(|e| e.to_string())?;
    let said = String::from_utf8_lossy(&output.stdout);
    parsed(&said).ok_or_else(|| {
        let told = String::from_utf8_lossy(&output.stderr);
        format!("no table for {family} ({}): {said}{told}", output.status)
    })
}

/// Prints the rows of this process's family.
pub fn child() -> Result<(), String> {
    let null = NullDevice::new()?;
    let with_straight = straight::is_installed();
    println!("\ndriver\t{}", null.driver);
    if std::env::var_os(CHILD).is_some_and(|what| what == DRIVER) {
        println!("whole");
        return Ok(());
    }
    for (beside, name) in rows::rows() {
        let names = [Some(name), beside];
        let shaders: Vec<_> = names.into_iter().flatten().map(shader).collect();
        let cost = |words: Vec<Vec<u32>>| {
            let codes = (0..shaders.len()).map(|k| Code {
                shader: shaders[k],
                words: &words[k],
            });
            compiled::cost(&null, &codes.collect::<Vec<_>>())
        };
        let pair = cost(shaders.iter().map(|of| of.folded(false)).collect())?;
        let folded: Result<Vec<_>, _> = match with_straight {
            true => shaders.iter().map(|of| straight::words(of)).collect(),
            false => Ok(Vec::new()),
        };
        let folded = folded?;
        let straight = with_straight.then(|| cost(folded)).transpose()?;
        let costs = [Some(pair), straight];
        let numbers = costs.iter().flatten().flat_map(Cost::numbers);
        let numbers: Vec<String> = numbers.map(|number| number.to_string()).collect();
        println!("row\t{name}\t{}", numbers.join("\t"));
    }
    println!("whole");
    Ok(())
}

/// The driver and the rows that a child has printed, among other lines. `None` where it did not come to its end.
fn parsed(said: &str) -> Option<(String, Vec<Row>)> {
    let mut driver = None;
    let mut rows = Vec::new();
    for line in said.lines() {
        match line.split('\t').collect::<Vec<_>>()[..] {
            ["driver", of] => driver = Some(of.to_owned()),
            ["row", name, ref numbers @ ..] => {
                let numbers: Result<Vec<u64>, _> = numbers.iter().map(|n| n.parse()).collect();
                let numbers = numbers.ok()?;
                let (pair, straight) = numbers.split_at_checked(7)?;
                rows.push(Row {
                    name: name.to_owned(),
                    pair: Cost::of_numbers(pair)?,
                    straight: Cost::of_numbers(straight),
                });
            }
            ["whole"] => return Some((driver?, rows)),
            _ => {}
        }
    }
    None
}
