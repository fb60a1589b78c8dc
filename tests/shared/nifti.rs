//! The tiny writer of NIfTI headers, by the offsets of nifti1.h and nifti2.h.
#![allow(dead_code, reason = "each test uses a part of it")]

/// The fields that a reader looks at.
#[derive(Clone, Debug)]
pub struct Nifti {
    /// 1 or 2.
    pub version: u8,
    pub big_endian: bool,
    /// False for a `.hdr` whose voxels lie in an `.img`.
    pub is_single_file: bool,
    pub dim: [i64; 8],
    pub datatype: i16,
    pub bitpix: i16,
    pub pixdim: [f64; 8],
    pub vox_offset: f64,
    pub scl_slope: f64,
    pub scl_inter: f64,
    pub qform_code: i16,
    pub sform_code: i16,
    pub quatern: [f64; 3],
    pub qoffset: [f64; 3],
    pub srow: [[f64; 4]; 3],
    pub units: u8,
    pub intent: i16,
}

impl Nifti {
    /// 3 x 2 x 1 voxels of one type, without orientation.
    pub fn new(datatype: i16, bitpix: i16) -> Self {
        Self {
            version: 1,
            big_endian: false,
            is_single_file: true,
            dim: [3, 3, 2, 1, 0, 0, 0, 0],
            datatype,
            bitpix,
            pixdim: [1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0],
            vox_offset: 0.0,
            scl_slope: 0.0,
            scl_inter: 0.0,
            qform_code: 0,
            sform_code: 0,
            quatern: [0.0; 3],
            qoffset: [0.0; 3],
            srow: [[0.0; 4]; 3],
            units: 2,
            intent: 0,
        }
    }

    /// The header, and the four bytes that say that no extension follows.
    pub fn bytes(&self) -> Vec<u8> {
        match self.version {
            1 => self.version_one(),
            _ => self.version_two(),
        }
    }

    /// The header with voxels behind it.
    pub fn with(&self, voxels: &[u8]) -> Vec<u8> {
        [self.bytes().as_slice(), voxels].concat()
    }

    fn version_one(&self) -> Vec<u8> {
        let mut out = vec![0; 352];
        let mut put = |at: usize, bytes: &[u8]| self.put(&mut out, at, bytes);
        let f = |x: f64| (x as f32).to_le_bytes();
        put(0, &348_i32.to_le_bytes());
        for k in 0..8 {
            put(40 + 2 * k, &(self.dim[k] as i16).to_le_bytes());
            put(76 + 4 * k, &f(self.pixdim[k]));
        }
        put(68, &self.intent.to_le_bytes());
        put(70, &self.datatype.to_le_bytes());
        put(72, &self.bitpix.to_le_bytes());
        put(108, &f(self.vox_offset));
        put(112, &f(self.scl_slope));
        put(116, &f(self.scl_inter));
        put(123, &[self.units]);
        put(252, &self.qform_code.to_le_bytes());
        put(254, &self.sform_code.to_le_bytes());
        for k in 0..3 {
            put(256 + 4 * k, &f(self.quatern[k]));
            put(268 + 4 * k, &f(self.qoffset[k]));
            for column in 0..4 {
                put(280 + 16 * k + 4 * column, &f(self.srow[k][column]));
            }
        }
        let magic = if self.is_single_file {
            b"n+1\0"
        } else {
            b"ni1\0"
        };
        out[344..348].copy_from_slice(magic);
        out
    }

    fn version_two(&self) -> Vec<u8> {
        let mut out = vec![0; 544];
        let mut put = |at: usize, bytes: &[u8]| self.put(&mut out, at, bytes);
        put(0, &540_i32.to_le_bytes());
        put(12, &self.datatype.to_le_bytes());
        put(14, &self.bitpix.to_le_bytes());
        for k in 0..8 {
            put(16 + 8 * k, &self.dim[k].to_le_bytes());
            put(104 + 8 * k, &self.pixdim[k].to_le_bytes());
        }
        put(168, &(self.vox_offset as i64).to_le_bytes());
        put(176, &self.scl_slope.to_le_bytes());
        put(184, &self.scl_inter.to_le_bytes());
        put(344, &i32::from(self.qform_code).to_le_bytes());
        put(348, &i32::from(self.sform_code).to_le_bytes());
        for k in 0..3 {
            put(352 + 8 * k, &self.quatern[k].to_le_bytes());
            put(376 + 8 * k, &self.qoffset[k].to_le_bytes());
            for column in 0..4 {
                put(
                    400 + 32 * k + 8 * column,
                    &self.srow[k][column].to_le_bytes(),
                );
            }
        }
        put(500, &i32::from(self.units).to_le_bytes());
        put(504, &i32::from(self.intent).to_le_bytes());
        let magic = if self.is_single_file {
            b"n+2\0\r\n\x1a\n"
        } else {
            b"ni2\0\r\n\x1a\n"
        };
        out[4..12].copy_from_slice(magic);
        out
    }

    /// One little-endian number, turned round where the header is big-endian.
    fn put(&self, out: &mut [u8], at: usize, number: &[u8]) {
        let to = &mut out[at..at + number.len()];
        to.copy_from_slice(number);
        if self.big_endian {
            to.reverse();
        }
    }
}
