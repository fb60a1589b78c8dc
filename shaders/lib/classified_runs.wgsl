// Masks and ranks of runs, and behind them their payload.

struct ClassifiedRuns {
    d: array<u32>,
}

@group(0) @binding(50) var<storage, read> classified_runs: ClassifiedRuns;
