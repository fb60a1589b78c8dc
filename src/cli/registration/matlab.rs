//! ITK's binary files of transforms, `0GenericAffine.mat` of ANTs: MATLAB's level 4, matrices one after the other, of each
//! transform its parameters by the name of its class, then `fixed`.
//!
//! A matrix is five whole numbers of 32 bits (type MOPT, rows, columns, whether there is an imaginary part, bytes of the name),
//! the name with a zero byte, and the numbers. M is 0 for little and 1 for big endian, P 0 for f64 and 1 for f32
//! (MathWorks, *MAT-File Format*, level 4; `vnl_matlab_header`).

use super::parts::Part;

const HEADER_BYTES: usize = 20;
const LONGEST_NAME: usize = 256;

/// Whether it may be one: a type of numbers that ITK writes.
pub fn is_one(bytes: &[u8]) -> bool {
    bytes.len() >= HEADER_BYTES && Kind::of(bytes).is_some()
}

/// How the numbers of a matrix are stored.
#[derive(Clone, Copy)]
struct Kind {
    is_big: bool,
    is_single: bool,
}

impl Kind {
    fn of(bytes: &[u8]) -> Option<Self> {
        let word: [u8; 4] = bytes.get(..4)?.try_into().ok()?;
        [false, true].into_iter().find_map(|is_big| {
            let code = if is_big {
                u32::from_be_bytes(word)
            } else {
                u32::from_le_bytes(word)
            };
            // Rows or columns first is one for a matrix of one column.
            let rest = code.checked_sub(1000 * u32::from(is_big))?;
            let is_single = matches!(rest, 10 | 110);
            (is_single || matches!(rest, 0 | 100)).then_some(Self { is_big, is_single })
        })
    }

    fn u32(self, bytes: &[u8]) -> Option<u32> {
        let word = bytes.try_into().ok()?;
        Some(if self.is_big {
            u32::from_be_bytes(word)
        } else {
            u32::from_le_bytes(word)
        })
    }

    fn number(self, bytes: &[u8]) -> f64 {
        let mut word = [0; 8];
        word[..bytes.len()].copy_from_slice(bytes);
        if self.is_big {
            word[..bytes.len()].reverse();
        }
        match self.is_single {
            true => f32::from_le_bytes([word[0], word[1], word[2], word[3]]).into(),
            false => f64::from_le_bytes(word),
        }
    }
}

/// The transforms in their order.
pub fn parts(bytes: &[u8]) -> Result<Vec<Part>, String> {
    let mut parts: Vec<Part> = Vec::new();
    let mut rest = bytes;
    while !rest.is_empty() {
        let (name, numbers);
        (name, numbers, rest) = matrix(rest).ok_or_else(|| {
            format!(
                "wanted a matrix of MATLAB's level 4 at byte {}",
                bytes.len() - rest.len()
            )
        })?;
        match (name.as_str(), parts.last_mut()) {
            ("fixed", Some(part)) => part.fixed = numbers,
            _ => parts.push(Part {
                parameters: numbers,
                ..Part::new(&name)
            }),
        }
    }
    Ok(parts)
}

/// The first matrix's name and numbers, and what follows.
fn matrix(bytes: &[u8]) -> Option<(String, Vec<f64>, &[u8])> {
    let kind = Kind::of(bytes)?;
    let field = |nth: usize| kind.u32(bytes.get(4 * nth..4 * nth + 4)?);
    let [rows, columns, imaginary, name_bytes] = [field(1)?, field(2)?, field(3)?, field(4)?];
    let name_bytes = name_bytes as usize;
    if imaginary != 0 || name_bytes > LONGEST_NAME {
        return None;
    }
    let rest = bytes.get(HEADER_BYTES..)?;
    let name = std::str::from_utf8(rest.get(..name_bytes)?).ok()?;
    let number_bytes = if kind.is_single { 4 } else { 8 };
    let count = (rows as usize).checked_mul(columns as usize)?;
    let rest = &rest[name_bytes..];
    let numbers = rest.get(..count.checked_mul(number_bytes)?)?;
    Some((
        name.trim_end_matches('\0').to_owned(),
        numbers
            .chunks_exact(number_bytes)
            .map(|one| kind.number(one))
            .collect(),
        &rest[numbers.len()..],
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix_of(name: &str, numbers: &[f64], is_big: bool) -> Vec<u8> {
        let header = [
            1000 * u32::from(is_big),
            numbers.len() as u32,
            1,
            0,
            name.len() as u32 + 1,
        ];
        let word = |word: u32| {
            if is_big {
                word.to_be_bytes()
            } else {
                word.to_le_bytes()
            }
        };
        let number = |number: &f64| {
            if is_big {
                number.to_be_bytes()
            } else {
                number.to_le_bytes()
            }
        };
        let mut bytes: Vec<u8> = header.into_iter().flat_map(word).collect();
        bytes.extend(name.bytes().chain([0]));
        bytes.extend(numbers.iter().flat_map(number));
        bytes
    }

    #[test]
    fn matrices_of_both_orders_are_read_and_lies_are_not() {
        for is_big in [false, true] {
            let mut bytes = matrix_of("AffineTransform_double_3_3", &[1.0, -2.5], is_big);
            bytes.extend(matrix_of("fixed", &[3.0], is_big));
            assert!(is_one(&bytes));
            let found = parts(&bytes).expect("one transform");
            assert_eq!(found.len(), 1);
            assert_eq!(found[0].parameters, [1.0, -2.5]);
            assert_eq!(found[0].fixed, [3.0]);
            for end in 1..bytes.len() {
                // Cut between the matrices there is a transform without what is fixed.
                let is_whole = parts(&bytes[..end]).is_ok();
                assert_eq!(is_whole, end == 20 + 27 + 16, "{end}");
            }
            let mut lie = bytes.clone();
            lie[4..8].fill(0xff);
            lie[8..12].fill(0xff);
            assert!(parts(&lie).is_err());
        }
    }
}
