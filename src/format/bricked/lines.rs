//! The header of a file of bricks: lines `key: words`.

use super::BRICKS;
use crate::format::geometry::is_invertible;
use crate::format::problem::{invalid, missing};
use crate::volume::{Problem, VoxelType};
use glam::DAffine3;
use std::collections::BTreeMap;

/// The lines of a header, each key once but `level`.
pub(super) struct Lines {
    pub values: BTreeMap<String, String>,
    pub levels: Vec<String>,
}

impl Lines {
    pub fn of(text: &str) -> Result<Self, Problem> {
        let mut lines = Self {
            values: BTreeMap::new(),
            levels: Vec::new(),
        };
        for line in text.lines() {
            let Some((key, words)) = line.split_once(": ") else {
                return Err(invalid(BRICKS, "header", "lines `key: words`", line));
            };
            if key == "level" {
                lines.levels.push(words.to_owned());
            } else if lines
                .values
                .insert(key.to_owned(), words.to_owned())
                .is_some()
            {
                return Err(invalid(BRICKS, "header", "each key once", key));
            }
        }
        Ok(lines)
    }

    pub fn take(&mut self, key: &str) -> Result<String, Problem> {
        self.values.remove(key).ok_or_else(|| missing(BRICKS, key))
    }

    pub fn stored(&mut self) -> Result<VoxelType, Problem> {
        let word = self.take("type")?;
        let mut kept = [
            VoxelType::U8,
            VoxelType::I8,
            VoxelType::U16,
            VoxelType::I16,
            VoxelType::F16,
            VoxelType::F32,
        ]
        .into_iter();
        kept.find(|stored| stored.name() == word)
            .ok_or_else(|| invalid(BRICKS, "type", "u8, i8, u16, i16, f16 or f32", &word))
    }

    pub fn positive(&mut self, key: &str) -> Result<u32, Problem> {
        let word = self.take(key)?;
        let number = word.parse::<u32>().ok().filter(|&n| n > 0);
        number.ok_or_else(|| invalid(BRICKS, key, "a whole number above 0", &word))
    }

    pub fn whole(&mut self, key: &str) -> Result<[u32; 3], Problem> {
        let line = self.take(key)?;
        let wrong = || invalid(BRICKS, key, "three whole numbers above 0", &line);
        let numbers: Vec<u32> = line
            .split(' ')
            .filter_map(|word| word.parse().ok())
            .filter(|&n: &u32| n > 0 && n < i32::MAX.unsigned_abs())
            .collect();
        <[u32; 3]>::try_from(numbers).map_err(|_| wrong())
    }

    pub fn numbers<const N: usize>(
        &mut self,
        key: &str,
        wanted: &str,
    ) -> Result<[f64; N], Problem> {
        let line = self.take(key)?;
        let numbers: Vec<f64> = line
            .split(' ')
            .filter_map(|word| word.parse().ok())
            .filter(|n: &f64| n.is_finite())
            .collect();
        <[f64; N]>::try_from(numbers).map_err(|_| invalid(BRICKS, key, wanted, &line))
    }

    pub fn affine(&mut self) -> Result<DAffine3, Problem> {
        const KEY: &str = "world_from_voxel";
        const WANTED: &str = "twelve finite numbers of an invertible transform, column by column";
        let numbers: [f64; 12] = self.numbers(KEY, WANTED)?;
        let affine = DAffine3::from_cols_array(&numbers);
        match is_invertible(&affine) {
            true => Ok(affine),
            false => Err(invalid(BRICKS, KEY, WANTED, &format!("{numbers:?}"))),
        }
    }

    pub fn yes(&mut self, key: &str) -> Result<bool, Problem> {
        match self.take(key)?.as_str() {
            "yes" => Ok(true),
            "no" => Ok(false),
            other => Err(invalid(BRICKS, key, "yes or no", other)),
        }
    }
}
