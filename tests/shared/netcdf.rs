//! NetCDF files of the classic format (CDF-1), as docs.unidata.ucar.edu/netcdf-c, appendix B, has them.

/// A variable of doubles over dimensions by number, with attributes of text and numbers.
pub struct Variable<'a> {
    pub name: &'a str,
    pub dimensions: &'a [usize],
    pub texts: &'a [(&'a str, &'a str)],
    pub numbers: &'a [(&'a str, f64)],
    pub values: Vec<f64>,
}

const DIMENSION: u32 = 10;
const VARIABLE: u32 = 11;
const ATTRIBUTE: u32 = 12;
const CHAR: u32 = 2;
const DOUBLE: u32 = 6;

/// The file.
pub fn netcdf(
    dimensions: &[(&str, u32)],
    texts: &[(&str, &str)],
    variables: &[Variable],
) -> Vec<u8> {
    netcdf_with(dimensions, texts, &[], variables)
}

/// The same with numbers that are of the whole file.
pub fn netcdf_with(
    dimensions: &[(&str, u32)],
    texts: &[(&str, &str)],
    numbers: &[(&str, f64)],
    variables: &[Variable],
) -> Vec<u8> {
    let header = |begins: &[u32]| {
        let mut out = b"CDF\x01".to_vec();
        put(&mut out, 0);
        list(&mut out, DIMENSION, dimensions.len());
        for (name, size) in dimensions {
            text(&mut out, name);
            put(&mut out, *size);
        }
        attributes(&mut out, texts, numbers);
        list(&mut out, VARIABLE, variables.len());
        for (variable, begin) in variables.iter().zip(begins) {
            text(&mut out, variable.name);
            put(&mut out, variable.dimensions.len() as u32);
            variable
                .dimensions
                .iter()
                .for_each(|id| put(&mut out, *id as u32));
            attributes(&mut out, variable.texts, variable.numbers);
            put(&mut out, DOUBLE);
            put(&mut out, 8 * variable.values.len() as u32);
            put(&mut out, *begin);
        }
        out
    };
    let mut next = header(&vec![0; variables.len()]).len() as u32;
    let mut begins = Vec::new();
    for variable in variables {
        begins.push(next);
        next += 8 * variable.values.len() as u32;
    }
    let mut file = header(&begins);
    for value in variables.iter().flat_map(|variable| &variable.values) {
        file.extend(value.to_be_bytes());
    }
    file
}

fn put(out: &mut Vec<u8>, number: u32) {
    out.extend(number.to_be_bytes());
}

fn list(out: &mut Vec<u8>, tag: u32, count: usize) {
    put(out, if count == 0 { 0 } else { tag });
    put(out, count as u32);
}

/// Its length and its bytes, up to a multiple of four.
fn text(out: &mut Vec<u8>, text: &str) {
    put(out, text.len() as u32);
    out.extend(text.bytes());
    out.resize(out.len().next_multiple_of(4), 0);
}

fn attributes(out: &mut Vec<u8>, texts: &[(&str, &str)], numbers: &[(&str, f64)]) {
    list(out, ATTRIBUTE, texts.len() + numbers.len());
    for (name, value) in texts {
        text(out, name);
        put(out, CHAR);
        text(out, value);
    }
    for (name, value) in numbers {
        text(out, name);
        put(out, DOUBLE);
        put(out, 1);
        out.extend(value.to_be_bytes());
    }
}
