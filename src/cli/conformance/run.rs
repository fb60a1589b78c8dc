//! A run: cases chosen, run by workers or in this process, and written down.

use super::super::{
    Error, Source,
    output::{say, say_aside},
    signals::Gate,
    small_file::parsed,
};
use super::cases::Cases;
use super::check::read;
use super::hearing::{Hearing, quoted};
use super::outputs::Outputs;
use super::summary::tell;
use super::words::{self, LimitsWord};
use crate::conformance::baseline::Baseline;
use crate::conformance::case::Case;
use crate::conformance::in_process;
use crate::conformance::measurement::hex;
use crate::conformance::record::{Asked, Build, DeviceRecord, Package, Stress};
use crate::conformance::selection::Selection;
use crate::conformance::stress;
use crate::conformance::supervisor::{self, Plan};
use crate::conformance::test_bed::TestBed;
use crate::conformance::tree::cases;
use crate::conformance::waiver::Waivers;
use crate::conformance::worker::{self, Answers, Trouble};
use crate::gpu::{DeviceChoice, Headless, Options, SharedDevice};
use clap::Args;
use sha2::{Digest, Sha256};
use std::ffi::OsString;
use std::num::NonZero;
use std::path::PathBuf;
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

/// What one case may take, where no word says it.
const SECONDS: f64 = 60.0;

/// What to ask, of what, and where to write it.
#[derive(Args, Debug)]
pub struct Run {
    /// Which device: a name, an index, a UUID or `cpu` [default: the first that can draw]
    #[arg(long, value_name = "D")]
    device: Option<String>,
    #[command(flatten)]
    cases: Cases,
    /// What is random follows from it
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Runs of each case: other verdicts or other numbers among them are a failure
    #[arg(long, value_name = "N", default_value_t = NonZero::<u32>::MIN)]
    repeat: NonZero<u32>,
    /// End with the first case that is not well
    #[arg(long)]
    stop_on_fail: bool,
    /// Run cases in this process, for debuggers: what crashes or hangs is the end of the run
    #[arg(long, conflicts_with_all = ["jobs", "timeout"])]
    in_process: bool,
    /// Run cases alone, and then on so many threads at once, on so many queues of one device, in this process
    #[arg(long, value_name = "QUEUES,THREADS", value_parser = words::stress)]
    #[arg(conflicts_with_all = ["jobs", "timeout", "repeat", "dump"])]
    stress: Option<Stress>,
    /// Seconds that one case may take
    #[arg(long, value_name = "SECONDS", default_value_t = SECONDS, value_parser = seconds)]
    timeout: f64,
    /// Workers at a time, each with a device of its own [default: one for each core, 8 at most]
    #[arg(long, value_name = "N")]
    jobs: Option<NonZero<usize>>,
    /// Known problems of drivers; may be given several times
    #[arg(long, value_name = "FILE.json")]
    waivers: Vec<PathBuf>,
    /// What `--json` has written of an earlier run: failures that are the same are expected
    #[arg(long, value_name = "FILE.json")]
    baseline: Option<PathBuf>,
    /// Run as if the device had no more than this
    #[arg(long, value_enum, default_value_t)]
    limits: LimitsWord,
    #[command(flatten)]
    outputs: Outputs,
    /// Say the names of the cases and run none
    #[arg(long)]
    list: bool,
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
    pub fn run(self, source: Source, gate: &Gate) -> Result<(), Error> {
        let all = cases();
        if self.worker {
            return worker::serve(&all, &mut self.test_bed(), &self.answers())
                .map_err(|cause| Error::output("the pipe to the supervisor", &cause));
        }
        let selection = self.cases.selection(&all)?;
        let chosen = selection.of(&all);
        if chosen.is_empty() {
            return Err(self.cases.none_left());
        }
        if self.list {
            let names = chosen.iter().map(|case| format!("{}\n", case.name));
            return say(&names.collect::<String>());
        }
        let begun = Instant::now();
        let inputs = self
            .cases
            .inputs()
            .chain(&self.waivers)
            .chain(&self.baseline);
        let inputs: Vec<PathBuf> = inputs.cloned().collect();
        self.outputs.check(&inputs, &chosen)?;
        let mut asked = self.asked(&selection);
        let hearing = self.hearing(&asked, chosen.len())?;
        let outcome = match self.stress {
            Some(wanted) => self.stress(wanted, &mut asked, &chosen, &hearing)?,
            None => self.ask(&chosen, &hearing)?,
        };
        let seconds = begun.elapsed().as_secs_f64();
        let (device, records) = (outcome.device, outcome.records);
        let package = Package::new(&all, build(source), asked, device, records, seconds);
        self.outputs.write(&package, gate)?;
        tell(&package)
    }

    fn test_bed(&self) -> TestBed {
        let (choice, caps) = (self.choice(), self.limits.caps());
        TestBed::new(self.seed, move |lower| {
            let options = Options {
                caps: lower(caps),
                ..Options::default()
            };
            Headless::new(&choice, &options)
        })
    }

    fn answers(&self) -> Answers<'_> {
        let fault = self.fault.as_ref();
        Answers {
            pictures: self.pictures.as_deref().or(self.outputs.pictures()),
            dumps: self.outputs.dumps(),
            trouble: fault.map(|fault| (fault.pattern.as_str(), fault.trouble)),
        }
    }

    fn choice(&self) -> DeviceChoice {
        self.device
            .as_deref()
            .map_or(DeviceChoice::Default, DeviceChoice::from)
    }

    fn asked(&self, selection: &Selection) -> Asked {
        Asked {
            selection: selection.clone(),
            seed: self.seed,
            limits: self.limits.word().to_owned(),
            repeat: self.repeat.get(),
            in_process: self.in_process || self.stress.is_some(),
            stress: self.stress,
        }
    }

    fn hearing(&self, asked: &Asked, cases: usize) -> Result<Hearing, Error> {
        let wrong = |path: &PathBuf, problem| Error::Input {
            path: path.clone(),
            problem,
        };
        let baseline = |path: &PathBuf| {
            Baseline::of(&read(path)?, asked).map_err(|problem| wrong(path, problem))
        };
        let baseline = self.baseline.as_ref().map(baseline).transpose()?;
        let waivers = self.read_waivers()?;
        // A device that is not there is no verdict on a device.
        let options = Options {
            caps: self.limits.caps(),
            ..Options::default()
        };
        let device = DeviceRecord::of(Headless::new(&self.choice(), &options)?.gpu());
        Ok(Hearing {
            again: self.again(),
            waivers,
            baseline,
            device,
            stops_on_fail: self.stop_on_fail,
            cases,
        })
    }

    fn read_waivers(&self) -> Result<Waivers, Error> {
        const MOST_BYTES: u64 = 32 << 20;
        let mut waivers = Waivers::default();
        for path in &self.waivers {
            parsed(path, "a file of waivers", MOST_BYTES, |bytes| {
                let text = std::str::from_utf8(bytes).map_err(|_| "it is not UTF-8".to_owned())?;
                waivers.read(text)
            })?;
        }
        Ok(waivers)
    }

    /// The words behind `--filter NAME` that run a case as it ran in this run.
    fn again(&self) -> String {
        let mut words = format!(" --seed {}", self.seed);
        if let Some(device) = &self.device {
            words.push_str(&format!(" --device {}", quoted(device)));
        }
        if self.limits != LimitsWord::Device {
            words.push_str(&format!(" --limits {}", self.limits.word()));
        }
        if self.timeout != SECONDS {
            words.push_str(&format!(" --timeout {}", self.timeout));
        }
        if let Some(Stress { queues, threads }) = self.stress {
            words.push_str(&format!(" --stress {queues},{threads}"));
        }
        if self.repeat != NonZero::<u32>::MIN {
            words.push_str(&format!(" --repeat {}", self.repeat));
        }
        words
    }

    fn ask(&self, chosen: &[&Case], hearing: &Hearing) -> Result<supervisor::Outcome, Error> {
        let heard = |done, record: &mut _| hearing.hear(done, record);
        if self.in_process {
            let (answers, mut bed) = (self.answers(), self.test_bed());
            return in_process::run(&answers, &mut bed, chosen, self.repeat, heard)
                .map_err(|cause| Error::output("the pictures of a failure", &cause));
        }
        let plan = Plan {
            program: std::env::current_exe().map_err(|cause| Error::output("a worker", &cause))?,
            words: self.words(),
            time_per_case: Duration::from_secs_f64(self.timeout),
            jobs: self.jobs.unwrap_or_else(jobs),
            repeat: self.repeat,
        };
        supervisor::run(&plan, chosen, heard).map_err(|cause| Error::output("a worker", &cause))
    }

    /// On one device for all threads. `asked` learns how many queues it has.
    fn stress(
        &self,
        wanted: Stress,
        asked: &mut Asked,
        chosen: &[&Case],
        hearing: &Hearing,
    ) -> Result<supervisor::Outcome, Error> {
        let options = Options::default();
        let device = SharedDevice::new(&self.choice(), options.validation, wanted.queues)?;
        let device = Arc::new(device);
        let found = Stress {
            queues: device.queues() as u32,
            threads: wanted.threads,
        };
        asked.stress = Some(found);
        if found.queues < wanted.queues {
            say_aside(&format!(
                "note: this device has {} queues of this family, and not {}: threads take turns at submitting",
                found.queues, wanted.queues
            ));
        }
        let (seed, caps) = (self.seed, self.limits.caps());
        let bed = |number: usize| {
            let device = Arc::clone(&device);
            TestBed::new(seed, move |lower| {
                let options = Options {
                    caps: lower(caps),
                    ..Options::default()
                };
                device.headless(number, &options)
            })
        };
        let heard = |done, record: &mut _| hearing.hear(done, record);
        stress::run(&self.answers(), found, bed, chosen, heard)
            .map_err(|cause| Error::output("what the threads have found", &cause))
    }

    fn words(&self) -> Vec<OsString> {
        let mut words: Vec<OsString> = ["conformance", "--worker"].map(OsString::from).into();
        let mut add = |name: &str, value: OsString| words.extend([OsString::from(name), value]);
        add("--seed", self.seed.to_string().into());
        add("--limits", self.limits.word().into());
        if let Some(device) = &self.device {
            add("--device", device.into());
        }
        if let Some(folder) = self.outputs.pictures() {
            add("--pictures", folder.into());
        }
        if let Some(folder) = self.outputs.dumps() {
            add("--dump", folder.into());
        }
        if let Some(fault) = &self.fault {
            add("--fault", (&fault.text).into());
        }
        words
    }
}

fn build(source: Source) -> Build {
    Build {
        commit: source.commit.unwrap_or("unknown").to_owned(),
        cargo_lock_sha256: hex(&Sha256::digest(source.cargo_lock)),
    }
}
