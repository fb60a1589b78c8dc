//! Files made wrong on purpose, the same way each time.

/// SplitMix64 (Steele, Lea and Flood, "Fast Splittable Pseudorandom Number Generators", OOPSLA 2014).
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number below `end`, which is above 0.
    pub fn below(&mut self, end: usize) -> usize {
        (self.next() % end as u64) as usize
    }
}

/// What was done to a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mutation {
    Cut,
    Bits,
    Bytes,
    Insert,
    Remove,
    Number,
    Line,
    Splice,
}

const KINDS: [Mutation; 8] = [
    Mutation::Cut,
    Mutation::Bits,
    Mutation::Bytes,
    Mutation::Insert,
    Mutation::Remove,
    Mutation::Number,
    Mutation::Line,
    Mutation::Splice,
];

/// Numbers that readers stumble over.
const NUMBERS: [&str; 26] = [
    "0",
    "1",
    "-1",
    "-2",
    "2",
    "3",
    "4",
    "16",
    "17",
    "255",
    "256",
    "65535",
    "65536",
    "2147483647",
    "2147483648",
    "4294967295",
    "4294967296",
    "9223372036854775807",
    "9223372036854775808",
    "18446744073709551615",
    "1e30",
    "1e308",
    "1e-308",
    "nan",
    "inf",
    "-inf",
];

/// Bytes that mean something somewhere.
const BYTES: [u8; 12] = [0, 1, 10, 13, 32, 37, 47, 58, 61, 127, 128, 255];

/// A file with one mutation, or now and then a few; the one that is named came last.
pub fn mutate(bytes: &[u8], random: &mut Random) -> (Vec<u8>, Mutation) {
    let mut mutated = bytes.to_vec();
    let kind = KINDS[random.below(KINDS.len())];
    if kind != Mutation::Cut {
        for _ in 0..[0, 0, 0, 1, 3][random.below(5)] {
            let before = KINDS[1 + random.below(KINDS.len() - 1)];
            apply(before, &mut mutated, random);
        }
    }
    apply(kind, &mut mutated, random);
    (mutated, kind)
}

fn apply(kind: Mutation, bytes: &mut Vec<u8>, random: &mut Random) {
    if bytes.is_empty() {
        bytes.push(0);
    }
    let at = random.below(bytes.len());
    match kind {
        Mutation::Cut => bytes.truncate(at),
        Mutation::Bits => {
            for _ in 0..1 + random.below(4) {
                let at = random.below(bytes.len());
                bytes[at] ^= 1 << random.below(8);
            }
        }
        Mutation::Bytes => {
            for _ in 0..1 + random.below(4) {
                let at = random.below(bytes.len());
                bytes[at] = BYTES[random.below(BYTES.len())];
            }
        }
        Mutation::Insert => {
            let count = 1 + random.below(40);
            let new: Vec<u8> = (0..count)
                .map(|_| BYTES[random.below(BYTES.len())])
                .collect();
            bytes.splice(at..at, new);
        }
        Mutation::Remove => {
            let end = (at + 1 + random.below(20)).min(bytes.len());
            bytes.drain(at..end);
        }
        Mutation::Number => replace_a_number(bytes, random),
        Mutation::Line => move_a_line(bytes, random),
        Mutation::Splice => {
            let end = (at + random.below(bytes.len())).min(bytes.len());
            let piece = bytes[at..end].to_vec();
            let to = random.below(bytes.len());
            bytes.splice(to..to, piece);
        }
    }
}

/// Puts a number that readers stumble over where some digits are.
fn replace_a_number(bytes: &mut Vec<u8>, random: &mut Random) {
    let is_digit = |byte: &u8| byte.is_ascii_digit() || matches!(byte, b'.' | b'-');
    let starts: Vec<usize> = (0..bytes.len())
        .filter(|&i| is_digit(&bytes[i]) && (i == 0 || !is_digit(&bytes[i - 1])))
        .collect();
    if starts.is_empty() {
        return;
    }
    let start = starts[random.below(starts.len())];
    let length = bytes[start..]
        .iter()
        .take_while(|byte| is_digit(byte))
        .count();
    let number = NUMBERS[random.below(NUMBERS.len())];
    bytes.splice(start..start + length, number.bytes());
}

/// Removes, doubles or moves one line.
fn move_a_line(bytes: &mut Vec<u8>, random: &mut Random) {
    let mut lines: Vec<Vec<u8>> = bytes
        .split_inclusive(|&byte| byte == b'\n')
        .map(<[u8]>::to_vec)
        .collect();
    let line = lines[random.below(lines.len())].clone();
    let choice = random.below(3);
    if choice != 0 {
        lines.retain(|other| *other != line);
    }
    if choice != 1 {
        lines.insert(random.below(lines.len() + 1), line);
    }
    *bytes = lines.concat();
}
