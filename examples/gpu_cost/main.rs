//! `gpu_cost FILE.md`: writes what the pipelines cost on three generations of AMD's chips into a page
//! (`make gpu-cost`).

// The test reads what the program writes.
#[allow(dead_code)]
mod table;

use std::process::{Command, ExitCode};

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("gpu_cost: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), String> {
    if std::env::var_os(table::CHILD).is_some() {
        return table::child();
    }
    let path = std::env::args_os()
        .nth(1)
        .ok_or("wanted the name of the page")?;
    let program = std::env::current_exe().map_err(|e| e.to_string())?;
    let measured = table::measured(|| Command::new(&program))?;
    let text = table::page::written(&measured);
    std::fs::write(&path, &text).map_err(|e| format!("{}: {e}", path.display()))?;
    // Beside itself: what does not depend on the page before.
    let broken = table::rules::broken(&measured, &measured);
    for line in &broken {
        eprintln!("{line}");
    }
    match broken.is_empty() {
        true => Ok(()),
        false => Err(format!(
            "{} rules are broken (examples/gpu_cost/table/rules.rs)",
            broken.len()
        )),
    }
}
