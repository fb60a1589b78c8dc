//! Surfaces of PLY files (Turk 1994): vertices with the properties x, y, z, and where they are there nx, ny, nz and red, green,
//! blue; faces as lists `vertex_indices` or `vertex_index` of three corners or more, which are cut into triangles as a fan.
//!
//! ```text
//! polygon v_0 ... v_(n-1)   ->   v_0 v_k v_(k+1),  k = 1 ... n - 2
//! ```
//!
//! Colours are sRGB, whole numbers as parts of the largest of their type. Other elements and properties are passed over.

use super::{Corner, Parts};
use crate::color::decode_srgb;
use crate::format::convert::{Endian, decoded, to_u64};
use crate::format::ply::{Element, Encoding, Head, PLY, Property};
use crate::format::problem::{invalid, missing, unsupported};
use crate::format::text::{number, whole};
use crate::volume::{Limits, Problem, VoxelType};
use glam::DVec3;

/// The surface of a file that begins as a PLY file does.
pub(super) fn read(bytes: &[u8], limits: &Limits) -> Result<Parts, Problem> {
    let head = Head::read(bytes, limits.max_header_bytes)?;
    let begin = usize::try_from(head.data_begins).unwrap_or(usize::MAX);
    let mut numbers = Numbers {
        encoding: head.encoding,
        rest: bytes.get(begin..).unwrap_or_default(),
    };
    let mut parts = Parts::new(PLY, limits);
    let vertices = head.elements.iter().find(|e| e.name == "vertex");
    let corners = vertices
        .ok_or_else(|| missing(PLY, "element vertex"))?
        .count;
    let mut has_faces = false;
    for element in &head.elements {
        match element.name.as_str() {
            "vertex" => add_vertices(&mut parts, element, &mut numbers)?,
            "face" => {
                has_faces = true;
                add_faces(&mut parts, element, corners, &mut numbers)?;
            }
            "tristrips" if element.count > 0 => {
                return Err(unsupported(PLY, "strips of triangles (element tristrips)"));
            }
            _ => skip(element, &mut numbers)?,
        }
    }
    match has_faces {
        true => Ok(parts),
        false => Err(missing(PLY, "element face")),
    }
}

fn add_vertices(
    parts: &mut Parts,
    element: &Element,
    numbers: &mut Numbers,
) -> Result<(), Problem> {
    let place = |name: &str| {
        let mut all = element.properties.iter();
        all.position(|p| p.name == name && p.length.is_none())
    };
    let of = |names: [&str; 3]| match names.map(place) {
        [Some(a), Some(b), Some(c)] => Some([a, b, c]),
        _ => None,
    };
    let places = of(["x", "y", "z"]).ok_or_else(|| missing(PLY, "property x, y and z"))?;
    let [normals, colors] = [of(["nx", "ny", "nz"]), of(["red", "green", "blue"])];
    let mut row = vec![0.0; element.properties.len()];
    for nth in 0..element.count {
        let field = || format!("vertex {nth}");
        for (property, found) in element.properties.iter().zip(&mut row) {
            *found = match property.length {
                None => numbers.next(property.stored, &field)?,
                Some(_) => numbers.list(property, &field, |_| Ok(()))?,
            };
        }
        let at =
            |places: [usize; 3]| places.map(|place| row.get(place).copied().unwrap_or(f64::NAN));
        let share = |place: usize| {
            let stored = element.properties.get(place).map(|p| p.stored);
            let found = row.get(place).copied().unwrap_or(0.0);
            (found / stored.map_or(1.0, largest)).clamp(0.0, 1.0)
        };
        let color = colors.map(|all| all.map(|place| decode_srgb(share(place))));
        let corner = Corner {
            place: DVec3::from_array(at(places)),
            normal: normals.map(|all| DVec3::from_array(at(all)).as_vec3()),
            color: color.map(|color| DVec3::from_array(color).as_vec3()),
        };
        parts.corner(&corner, field)?;
    }
    Ok(())
}

fn add_faces(
    parts: &mut Parts,
    element: &Element,
    corners: u64,
    numbers: &mut Numbers,
) -> Result<(), Problem> {
    let is_corners = |p: &Property| {
        matches!(p.name.as_str(), "vertex_indices" | "vertex_index") && p.length.is_some()
    };
    if element.count > 0 && !element.properties.iter().any(is_corners) {
        return Err(missing(PLY, "property list vertex_indices"));
    }
    for nth in 0..element.count {
        let field = || format!("face {nth}");
        for property in &element.properties {
            if property.length.is_none() {
                numbers.next(property.stored, &field)?;
                continue;
            }
            if !is_corners(property) {
                numbers.list(property, &field, |_| Ok(()))?;
                continue;
            }
            let (mut found, mut first, mut before) = (0_u64, 0, 0);
            numbers.list(property, &field, |number| {
                let corner = whole(number).and_then(|n| u64::try_from(n).ok());
                let corner = corner.unwrap_or(u64::MAX);
                match found {
                    0 => first = corner,
                    1 => {}
                    _ => parts.triangle([first, before, corner], [0, corners], field)?,
                }
                before = corner;
                found = found.saturating_add(1);
                Ok(())
            })?;
            if found < 3 {
                let found = found.to_string();
                return Err(invalid(PLY, &field(), "three corners at least", &found));
            }
        }
    }
    Ok(())
}

fn skip(element: &Element, numbers: &mut Numbers) -> Result<(), Problem> {
    if element.properties.is_empty() {
        return Ok(());
    }
    for nth in 0..element.count {
        let field = || format!("{} {nth}", element.name);
        for property in &element.properties {
            match property.length {
                None => numbers.next(property.stored, &field)?,
                Some(_) => numbers.list(property, &field, |_| Ok(()))?,
            };
        }
    }
    Ok(())
}

/// What stands for 1.
fn largest(stored: VoxelType) -> f64 {
    match stored {
        VoxelType::U8 => u8::MAX.into(),
        VoxelType::U16 => u16::MAX.into(),
        VoxelType::U32 => u32::MAX.into(),
        _ => 1.0,
    }
}

/// Numbers one after the other, in words or bytes.
struct Numbers<'a> {
    encoding: Encoding,
    rest: &'a [u8],
}

impl Numbers<'_> {
    /// The next one; of an error the `field`.
    fn next(&mut self, stored: VoxelType, field: &dyn Fn() -> String) -> Result<f64, Problem> {
        let cut = || invalid(PLY, &field(), "a number more", "the end of the file");
        let endian = match self.encoding {
            Encoding::Words => {
                let rest = self.rest.trim_ascii_start();
                let end = rest.iter().position(u8::is_ascii_whitespace);
                // Without a space behind it a word may have lost digits.
                let (word, rest) = rest
                    .split_at_checked(end.ok_or_else(cut)?)
                    .ok_or_else(cut)?;
                self.rest = rest;
                let word = String::from_utf8_lossy(word);
                return number(&word).ok_or_else(|| invalid(PLY, &field(), "a number", &word));
            }
            Encoding::LittleEndian => Endian::Little,
            Encoding::BigEndian => Endian::Big,
        };
        let split = self.rest.split_at_checked(stored.bytes());
        let (bytes, rest) = split.ok_or_else(cut)?;
        self.rest = rest;
        Ok(decoded(bytes, stored, endian))
    }

    /// The numbers of a list, which `each` takes; how many there are.
    fn list(
        &mut self,
        property: &Property,
        field: &dyn Fn() -> String,
        mut each: impl FnMut(f64) -> Result<(), Problem>,
    ) -> Result<f64, Problem> {
        let count = self.next(property.length.unwrap_or(VoxelType::U8), field)?;
        let wanted = whole(count).and_then(|n| u64::try_from(n).ok());
        let wanted = wanted.filter(|&n| n <= to_u64(self.rest.len()));
        let wanted = wanted.ok_or_else(|| {
            let field = format!("{}: length of {}", field(), property.name);
            let fits = format!("0 to {}, as many bytes as follow", self.rest.len());
            invalid(PLY, &field, fits, &count.to_string())
        })?;
        for _ in 0..wanted {
            each(self.next(property.stored, field)?)?;
        }
        Ok(count)
    }
}
