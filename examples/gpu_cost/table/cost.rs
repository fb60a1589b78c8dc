//! What a driver says about one compiled shader.

/// Statistics of a shader in a pipeline, in RADV's order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cost {
    /// Vector registers of an invocation.
    pub vgprs: u64,
    /// Scalar registers of a subgroup.
    pub sgprs: u64,
    /// Scalar and vector registers that did not fit.
    pub spilled: u64,
    /// Bytes of memory that an invocation keeps variables in.
    pub scratch_bytes: u64,
    /// Subgroups that one SIMD unit can hold at a time: what hides the latency of memory.
    pub waves: u64,
    /// Bytes of machine code.
    pub code_bytes: u64,
    /// Estimated cycles that a subgroup keeps its unit busy for, each loop counted as eight turns.
    pub throughput: u64,
}

impl Cost {
    /// The statistic of one name; names that the table has no column for are left.
    pub fn set(&mut self, name: &str, value: u64) {
        match name {
            "VGPRs" => self.vgprs = value,
            "SGPRs" => self.sgprs = value,
            "Spilled SGPRs" | "Spilled VGPRs" => self.spilled += value,
            "Scratch size" => self.scratch_bytes = value,
            "Subgroups per SIMD" => self.waves = value,
            "Code size" => self.code_bytes = value,
            "Inverse Throughput" => self.throughput = value,
            _ => {}
        }
    }

    /// As numbers of a line.
    pub fn numbers(&self) -> [u64; 7] {
        [
            self.vgprs,
            self.sgprs,
            self.spilled,
            self.scratch_bytes,
            self.waves,
            self.code_bytes,
            self.throughput,
        ]
    }

    /// The inverse of [`Self::numbers`]; `None` where there are too few.
    pub fn of_numbers(numbers: &[u64]) -> Option<Self> {
        let &[
            vgprs,
            sgprs,
            spilled,
            scratch_bytes,
            waves,
            code_bytes,
            throughput,
        ] = numbers
        else {
            return None;
        };
        Some(Self {
            vgprs,
            sgprs,
            spilled,
            scratch_bytes,
            waves,
            code_bytes,
            throughput,
        })
    }
}

/// One row: a variant, and the same module with its constants folded before the driver saw it.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The shader's name.
    pub name: String,
    /// What the driver says of the pair of module and constants.
    pub pair: Cost,
    /// And of its straight form; `None` where `spirv-opt` is not installed.
    pub straight: Option<Cost>,
}

impl Row {
    /// Inverse throughput over that of the straight form.
    pub fn over_straight(&self) -> Option<f64> {
        let straight = self.straight.as_ref()?;
        Some(self.pair.throughput as f64 / straight.throughput.max(1) as f64)
    }
}
