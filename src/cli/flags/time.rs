//! Which time: what `--time` says, by number or by date.

use super::super::Error;
use crate::volume::Header;

/// The number of the time that `word` means.
///
/// # Errors
/// A usage error that says which times there are.
pub fn chosen(word: &str, header: &Header) -> Result<u32, Error> {
    let times = header.times;
    match word.parse::<u32>() {
        Ok(time) if time < times => Ok(time),
        Ok(time) => {
            let message = match times {
                1 => format!("--time {time}: the input has one time, number 0"),
                _ => format!("--time {time}: the input has {times} times, counted from 0"),
            };
            Err(Error::usage(message, range(header)))
        }
        Err(_) => by_name(word, header),
    }
}

/// The first time whose name begins with `word`, so that a day or an hour is enough.
fn by_name(word: &str, header: &Header) -> Result<u32, Error> {
    let plain = |text: &str| text.replace(' ', "T").trim_end_matches('Z').to_owned();
    let wanted = plain(word);
    let found = header
        .time_names
        .iter()
        .position(|name| plain(name).starts_with(&wanted));
    found.map(|time| time as u32).ok_or_else(|| {
        let there = match header.time_names.as_slice() {
            [] => "its times have no dates, wanted a number counted from 0".to_owned(),
            [first, .., last] => format!("there are {first} to {last}"),
            [only] => format!("there is {only}"),
        };
        Error::usage(format!("--time {word}: {there}"), range(header))
    })
}

/// What may be said.
fn range(header: &Header) -> String {
    match header.times.saturating_sub(1) {
        0 => "leave out --time".to_owned(),
        last => format!("--time 0 to --time {last}"),
    }
}
