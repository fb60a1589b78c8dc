//! A run: cases chosen, handed to workers, and written down.

use super::super::{
    Error,
    output::{self, say, say_aside, write_whole},
    signals::Gate,
};
use super::words::{LimitsWord, ProfileWord, shard};
use crate::conformance::case::Case;
use crate::conformance::record::{Asked, Package, Record};
use crate::conformance::report::{html, junit};
use crate::conformance::stand::Stand;
use crate::conformance::supervisor::{self, Plan, chosen};
use crate::conformance::tree::cases;
use crate::conformance::verdict::Verdict;
use crate::conformance::waiver::{Waivers, today};
use crate::conformance::worker::{self, Trouble};
use crate::gpu::{DeviceChoice, Headless, Options};
use clap::Args;
use std::ffi::OsString;
use std::io::{IsTerminal, Write};
use std::num::NonZero;
use std::path::PathBuf;
use std::thread;
use std::time::{Duration, Instant};

/// What to ask, of what, and where to write it.
#[derive(Args, Debug)]
pub struct Run {
    /// Which device: a name, an index, a UUID or `cpu` [default: the first that can draw]
    #[arg(long, value_name = "D")]
    device: Option<String>,
    /// Cases by name: * for any characters, ? for one, | between patterns
    #[arg(long, value_name = "GLOB", default_value = "*")]
    filter: String,
    /// Which list
    #[arg(long, value_enum, default_value_t)]
    profile: ProfileWord,
    /// One part of the list: 2/4 is the second of four
    #[arg(long, value_name = "I/N", value_parser = shard, default_value = "1/1")]
    shard: [u32; 2],
    /// What is random follows from it
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Seconds that one case may take
    #[arg(long, value_name = "SECONDS", default_value_t = 60.0, value_parser = seconds)]
    timeout: f64,
    /// Workers at a time, each with a device of its own [default: one for each core, 8 at most]
    #[arg(long, value_name = "N")]
    jobs: Option<NonZero<usize>>,
    /// Known problems of drivers; may be given several times
    #[arg(long, value_name = "FILE.json")]
    waivers: Vec<PathBuf>,
    /// Run as if the device had no more than this
    #[arg(long, value_enum, default_value_t)]
    limits: LimitsWord,
    /// Write all records
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write the verdicts for a server of continuous integration
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,
    /// Write a page with the pictures of what failed into a folder
    #[arg(long, value_name = "DIR")]
    html: Option<PathBuf>,
    /// Say the names of the cases and run none
    #[arg(long)]
    list: bool,
    /// Replace files that exist
    #[arg(long)]
    force: bool,
    /// Be a worker: names come in, records go out
    #[arg(long, hide = true)]
    worker: bool,
    /// Where a worker puts pictures
    #[arg(long, hide = true, value_name = "DIR")]
    pictures: Option<PathBuf>,
    /// What a worker does at some cases: GLOB=abort|exit|hang|babble|lose-device|flake|fail
    #[arg(long, hide = true, value_name = "GLOB=WORD", value_parser = trouble)]
    fault: Option<Fault>,
}

#[derive(Clone, Debug)]
struct Fault {
    text: String,
    pattern: String,
    trouble: Trouble,
}

fn trouble(text: &str) -> Result<Fault, String> {
    let found = text.split_once('=');
    let found = found.and_then(|(pattern, word)| Some((pattern, Trouble::of(word)?)));
    let (pattern, trouble) =
        found.ok_or("wanted GLOB=abort|exit|hang|babble|lose-device|flake|fail")?;
    Ok(Fault {
        text: text.to_owned(),
        pattern: pattern.to_owned(),
        trouble,
    })
}

/// More workers than this want more memory than they spare time.
fn jobs() -> NonZero<usize> {
    const MOST: NonZero<usize> = NonZero::new(8).unwrap();
    thread::available_parallelism().map_or(NonZero::<usize>::MIN, |cores| cores.min(MOST))
}

fn seconds(text: &str) -> Result<f64, String> {
    let number: f64 = text.parse().map_err(|_| "wanted a number of seconds")?;
    match number.is_finite() && number > 0.0 && number <= 86_400.0 {
        true => Ok(number),
        false => Err("wanted more than 0 and at most a day".to_owned()),
    }
}

impl Run {
    /// Exit code 1 where a case is not well.
    pub fn run(self, gate: &Gate) -> Result<(), Error> {
        let all = cases();
        if self.worker {
            return self.serve(&all);
        }
        let chosen = chosen(&all, self.profile.into(), &self.filter, self.shard);
        if chosen.is_empty() {
            return Err(Error::usage(
                format!(
                    "--filter {}: no case of this profile and shard has such a name",
                    self.filter
                ),
                "`stratavox conformance --list` says their names",
            ));
        }
        if self.list {
            let names = chosen.iter().map(|case| format!("{}\n", case.name));
            return say(&names.collect::<String>());
        }
        self.judge(&all, &chosen, gate)
    }

    fn serve(&self, all: &[Case]) -> Result<(), Error> {
        let (choice, caps) = (self.choice(), self.limits.caps());
        let mut stand = Stand::new(self.seed, move |lower| {
            let options = Options {
                caps: lower(caps),
                ..Options::default()
            };
            Headless::new(&choice, &options)
        });
        let fault = self.fault.as_ref();
        let fault = fault.map(|fault| (fault.pattern.as_str(), fault.trouble));
        worker::serve(all, &mut stand, self.pictures.as_deref(), fault)
            .map_err(|cause| Error::output("the pipe to the supervisor", &cause))
    }

    fn choice(&self) -> DeviceChoice {
        self.device
            .as_deref()
            .map_or(DeviceChoice::Default, DeviceChoice::from)
    }

    fn judge(&self, all: &[Case], chosen: &[&Case], gate: &Gate) -> Result<(), Error> {
        let begun = Instant::now();
        let files: Vec<PathBuf> = self.json.iter().chain(&self.junit).cloned().collect();
        output::check(&files, &self.waivers, self.force)?;
        let waivers = self.read_waivers()?;
        self.prepare_folder()?;
        // A device that is not there is no verdict on a device.
        let options = Options {
            caps: self.limits.caps(),
            ..Options::default()
        };
        drop(Headless::new(&self.choice(), &options)?);
        let plan = Plan {
            program: std::env::current_exe().map_err(|cause| Error::output("a worker", &cause))?,
            words: self.words(),
            time_per_case: Duration::from_secs_f64(self.timeout),
            jobs: self.jobs.unwrap_or_else(jobs),
        };
        let progress = Progress::new(chosen.len());
        let outcome = supervisor::run(&plan, chosen, |done, record| progress.heard(done, record));
        let outcome = outcome.map_err(|cause| Error::output("a worker", &cause))?;
        let mut records = outcome.records;
        if let Some(device) = &outcome.device {
            let today = today();
            records
                .iter_mut()
                .for_each(|record| waivers.apply(record, device, today));
        }
        let asked = Asked {
            profile: self.profile.into(),
            filter: self.filter.clone(),
            shard: self.shard,
            seed: self.seed,
            limits: self.limits.word().to_owned(),
        };
        let seconds = begun.elapsed().as_secs_f64();
        let package = Package::new(all, asked, outcome.device, records, seconds);
        self.write(&package, gate)?;
        tell(&package)
    }

    fn read_waivers(&self) -> Result<Waivers, Error> {
        let mut waivers = Waivers::default();
        for path in &self.waivers {
            let wrong = |problem: String| Error::Input {
                path: path.clone(),
                problem,
            };
            let text = std::fs::read_to_string(path).map_err(|cause| wrong(cause.to_string()))?;
            waivers.read(&text).map_err(wrong)?;
        }
        Ok(waivers)
    }

    /// The folder of the page: made where it is not there, and empty unless forced.
    fn prepare_folder(&self) -> Result<(), Error> {
        let Some(folder) = &self.html else {
            return Ok(());
        };
        std::fs::create_dir_all(folder).map_err(|cause| Error::output(folder, &cause))?;
        let page = folder.join("index.html");
        output::check(&[page], &[], self.force)
    }

    fn words(&self) -> Vec<OsString> {
        let mut words: Vec<OsString> = ["conformance", "--worker"].map(OsString::from).into();
        let mut add = |name: &str, value: OsString| words.extend([OsString::from(name), value]);
        add("--seed", self.seed.to_string().into());
        add("--limits", self.limits.word().into());
        if let Some(device) = &self.device {
            add("--device", device.into());
        }
        if let Some(folder) = &self.html {
            add("--pictures", folder.into());
        }
        if let Some(fault) = &self.fault {
            add("--fault", (&fault.text).into());
        }
        words
    }

    fn write(&self, package: &Package, gate: &Gate) -> Result<(), Error> {
        if let Some(path) = &self.json {
            let text = serde_json::to_string_pretty(package).map_err(|cause| Error::Output {
                path: path.clone(),
                problem: cause.to_string(),
                hint: None,
            })?;
            write_whole(path, format!("{text}\n").as_bytes(), self.force, gate)?;
        }
        if let Some(path) = &self.junit {
            write_whole(path, junit(package).as_bytes(), self.force, gate)?;
        }
        if let Some(folder) = &self.html {
            let page = folder.join("index.html");
            write_whole(&page, html(package).as_bytes(), self.force, gate)?;
        }
        Ok(())
    }
}

/// The summary, and exit code 1 where a case is not well.
fn tell(package: &Package) -> Result<(), Error> {
    let device = package.device.as_ref();
    let name = device.map_or("no device", |device| &device.name);
    let mut text = format!(
        "{name}: {} cases in {:.1} s\n",
        package.cases.len(),
        package.seconds
    );
    for verdict in Verdict::ALL {
        if let Some(count) = package.summary.get(&verdict) {
            text.push_str(&format!("  {verdict:<16} {count}\n"));
        }
    }
    for record in package.cases.iter().filter(|record| record.unexpected_pass) {
        text.push_str(&format!(
            "  {} passes, and a waiver says it does not\n",
            record.name
        ));
    }
    say(&text)?;
    let bad = package
        .cases
        .iter()
        .filter(|record| !record.verdict.is_good())
        .count();
    match bad {
        0 => Ok(()),
        _ => Err(Error::Differs(format!(
            "{bad} of {} cases are not well",
            package.cases.len()
        ))),
    }
}

/// Lines on stderr: what is not well, and on a terminal how far the work is.
struct Progress {
    of: usize,
    is_shown: bool,
}

impl Progress {
    fn new(of: usize) -> Self {
        let is_shown = std::io::stderr().is_terminal();
        Self { of, is_shown }
    }

    fn heard(&self, done: usize, record: &Record) {
        if !record.verdict.is_good() {
            say_aside(&format!(
                "{}: {}: {}",
                record.verdict, record.name, record.reason
            ));
        }
        if self.is_shown {
            let end = if done == self.of { "\n" } else { "" };
            let mut err = std::io::stderr();
            let _ = write!(err, "\r{done} of {} cases{end}", self.of);
        }
    }
}
