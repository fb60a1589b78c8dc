//! Cases handed to worker processes, one name at a time: what a case breaks is its own process.
//!
//! ```text
//! for each name:  worker alive?  no -> start one
//!                 name -> worker, record <- worker       in time: that is the record
//!                                                        too late: killed, `timeout`
//!                                                        gone: `crash`, with how it ended and its last words
//!                 not good -> once more, in a worker of its own: another verdict is told as a flake
//! ```
//!
//! Several workers take from one list, each the next name. Which of them took which leaves no trace in a record.

use super::case::Case;
use super::record::{DeviceRecord, Record};
use super::repeat::repeated;
use super::verdict::Verdict;
use super::worker::Line;
use std::collections::VecDeque;
use std::ffi::OsString;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::num::NonZero;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

/// How workers are started and how long they are waited for.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The program.
    pub program: PathBuf,
    /// Its words.
    pub words: Vec<OsString>,
    /// What one case may take.
    pub time_per_case: Duration,
    /// How many workers there are at a time.
    pub jobs: NonZero<usize>,
    /// How often each case runs.
    pub repeat: NonZero<u32>,
}

/// What became of all cases.
#[derive(Debug, Default)]
pub struct Outcome {
    /// As a worker saw it.
    pub device: Option<DeviceRecord>,
    /// One for each case that ran, in their order.
    pub records: Vec<Record>,
}

/// Runs `cases`; `heard` is called after each with how many are done. Where it breaks off, no further case begins.
///
/// # Errors
/// Where a worker cannot be started.
pub fn run(
    plan: &Plan,
    cases: &[&Case],
    heard: impl FnMut(usize, &mut Record) -> ControlFlow<()> + Send,
) -> io::Result<Outcome> {
    let next = AtomicUsize::new(0);
    // Records by the place of their case, and who wants to hear of them.
    let done = Mutex::new((Vec::with_capacity(cases.len()), heard));
    let work = || -> io::Result<Option<DeviceRecord>> {
        let (mut worker, mut device) = (None, None);
        loop {
            let place = next.fetch_add(1, Ordering::Relaxed);
            let Some(case) = cases.get(place) else {
                return Ok(device);
            };
            let end = || next.store(cases.len(), Ordering::Relaxed);
            let mut record =
                settled(plan, &mut worker, &mut device, case).inspect_err(|_| end())?;
            let (records, heard) = &mut *done.lock().unwrap_or_else(PoisonError::into_inner);
            if heard(records.len() + 1, &mut record).is_break() {
                end();
            }
            records.push((place, record));
        }
    };
    let jobs = plan.jobs.get().min(cases.len());
    let devices = thread::scope(|scope| {
        let threads: Vec<_> = (0..jobs).map(|_| scope.spawn(work)).collect();
        let ended = |thread: thread::ScopedJoinHandle<'_, _>| {
            let gone = || Err(io::Error::other("a thread of the supervisor panicked"));
            thread.join().unwrap_or_else(|_| gone())
        };
        threads
            .into_iter()
            .map(ended)
            .collect::<io::Result<Vec<_>>>()
    })?;
    let (mut records, _) = done.into_inner().unwrap_or_else(PoisonError::into_inner);
    records.sort_by_key(|&(place, _)| place);
    Ok(Outcome {
        device: devices.into_iter().flatten().next(),
        records: records.into_iter().map(|(_, record)| record).collect(),
    })
}

/// What is said of a case in the end.
fn settled(
    plan: &Plan,
    worker: &mut Option<Worker>,
    device: &mut Option<DeviceRecord>,
    case: &Case,
) -> io::Result<Record> {
    let mut record = repeated(plan.repeat, |is_again| {
        ask(plan, worker, device, case, is_again)
    })?;
    if !record.verdict.is_good() && record.runs.is_empty() {
        // Of its own: nothing of an earlier case is in it.
        let again = ask(plan, &mut None, device, case, true)?;
        if again.verdict != record.verdict {
            record.runs = vec![record.verdict, again.verdict];
            record.reason = format!("flaky, {} when run again: {}", again.verdict, record.reason);
        }
    }
    Ok(record)
}

fn ask(
    plan: &Plan,
    worker: &mut Option<Worker>,
    device: &mut Option<DeviceRecord>,
    case: &Case,
    is_again: bool,
) -> io::Result<Record> {
    let alive = match worker.take() {
        Some(alive) => alive,
        None => Worker::start(plan)?,
    };
    let mut alive = alive;
    let of = |verdict, reason| Record::unmeasured(&case.name, case.profile, verdict, reason);
    match alive.ask(&case.name, is_again, plan.time_per_case, device) {
        Answer::Record(record) => {
            // A lost device stays lost for its process.
            if record.verdict != Verdict::DeviceLost {
                *worker = Some(alive);
            }
            Ok(*record)
        }
        Answer::Late => {
            alive.kill();
            let seconds = plan.time_per_case.as_secs_f64();
            Ok(of(Verdict::Timeout, format!("not done after {seconds} s")))
        }
        Answer::Gone => {
            let reason = alive.last_words();
            Ok(of(Verdict::Crash, reason))
        }
        Answer::Nonsense(line) => {
            alive.kill();
            let reason = format!("the worker said {line:?}, which is no record");
            Ok(of(Verdict::InternalError, reason))
        }
    }
}

enum Answer {
    Record(Box<Record>),
    Late,
    Gone,
    Nonsense(String),
}

/// The last lines that it wrote for people.
const LAST_LINES: usize = 6;

struct Worker {
    child: Child,
    /// Closed to let it end.
    names: Option<ChildStdin>,
    lines: Receiver<String>,
    last_lines: Arc<Mutex<VecDeque<String>>>,
}

impl Worker {
    fn start(plan: &Plan) -> io::Result<Self> {
        let mut child = Command::new(&plan.program)
            .args(&plan.words)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()?;
        let names = child.stdin.take();
        let out = child.stdout.take().expect("piped above");
        let err = child.stderr.take().expect("piped above");
        let (send, lines) = channel();
        thread::spawn(move || {
            for line in BufReader::new(out).lines().map_while(Result::ok) {
                if send.send(line).is_err() {
                    break;
                }
            }
        });
        let last_lines = Arc::new(Mutex::new(VecDeque::new()));
        let kept = Arc::clone(&last_lines);
        thread::spawn(move || keep_last(err, &kept));
        Ok(Self {
            child,
            names,
            lines,
            last_lines,
        })
    }

    fn ask(
        &mut self,
        name: &str,
        is_again: bool,
        time: Duration,
        device: &mut Option<DeviceRecord>,
    ) -> Answer {
        let again = if is_again { "again " } else { "" };
        let names = self.names.as_mut().expect("closed only when dropped");
        if writeln!(names, "{again}{name}")
            .and_then(|()| names.flush())
            .is_err()
        {
            return Answer::Gone;
        }
        loop {
            let line = match self.lines.recv_timeout(time) {
                Ok(line) => line,
                Err(RecvTimeoutError::Timeout) => return Answer::Late,
                Err(RecvTimeoutError::Disconnected) => return Answer::Gone,
            };
            match serde_json::from_str(&line) {
                Ok(Line::Device(found)) => {
                    device.get_or_insert(*found);
                }
                Ok(Line::Record(record)) if record.name == name => return Answer::Record(record),
                Ok(Line::Record(_)) | Err(_) => return Answer::Nonsense(line),
            }
        }
    }

    fn kill(&mut self) {
        // One that is gone already is as good.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }

    /// How it ended, and what it said last.
    fn last_words(&mut self) -> String {
        let ended = self.child.wait().map_or_else(|e| e.to_string(), how);
        let lines = self
            .last_lines
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        let lines: Vec<&str> = lines.iter().map(String::as_str).collect();
        match lines.is_empty() {
            true => ended,
            false => format!("{ended}; it said: {}", lines.join(" / ")),
        }
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        // At the end of its names it ends by itself; one that does not is not waited for.
        self.names = None;
        for _ in 0..100 {
            if !matches!(self.child.try_wait(), Ok(None)) {
                return;
            }
            thread::sleep(Duration::from_millis(20));
        }
        self.kill();
    }
}

fn keep_last(err: impl Read, kept: &Mutex<VecDeque<String>>) {
    for line in BufReader::new(err).lines().map_while(Result::ok) {
        let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
        if kept.len() == LAST_LINES {
            kept.pop_front();
        }
        kept.push_back(line);
    }
}

fn how(status: ExitStatus) -> String {
    #[cfg(unix)]
    if let Some(signal) = std::os::unix::process::ExitStatusExt::signal(&status) {
        return format!("ended by signal {signal}");
    }
    match status.code() {
        Some(code) => format!("ended with exit code {code}"),
        None => "ended".to_owned(),
    }
}
