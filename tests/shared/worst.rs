//! The worst error of a check, against what each pixel is allowed.

/// Where the error over its allowance was largest. Says nothing until asked.
#[must_use = "ask `assert_holds` or `assert_caught`: alone it checks nothing"]
#[derive(Clone, Debug)]
pub struct Worst {
    what: String,
    ratio: f64,
    error: f64,
    allowed: f64,
    at: [u32; 2],
    checked: usize,
    left_out: usize,
}

impl Worst {
    pub fn new(what: impl Into<String>) -> Self {
        Self {
            what: what.into(),
            ratio: 0.0,
            error: 0.0,
            allowed: 0.0,
            at: [0; 2],
            checked: 0,
            left_out: 0,
        }
    }

    /// Two pictures, number by number, each allowed as much.
    pub fn between(
        what: impl Into<String>,
        width: u32,
        wanted: &[[f32; 4]],
        found: &[[f32; 4]],
        allowed: f64,
    ) -> Self {
        let mut worst = Self::new(what);
        assert_eq!(wanted.len(), found.len(), "pictures of different size");
        for (i, (wanted, found)) in (0..).zip(wanted.iter().zip(found)) {
            for c in 0..4 {
                let error = f64::from(found[c]) - f64::from(wanted[c]);
                worst.take([i % width, i / width], error, allowed);
            }
        }
        let drawn = wanted.iter().filter(|pixel| pixel[3] > 0.01).count();
        assert!(drawn > 40, "{}: only {drawn} pixels are drawn", worst.what);
        worst
    }

    /// One number of one pixel. Not a number is infinitely wrong.
    pub fn take(&mut self, at: [u32; 2], error: f64, allowed: f64) {
        self.checked += 1;
        let error = if error.is_nan() {
            f64::INFINITY
        } else {
            error.abs()
        };
        let ratio = if error == 0.0 { 0.0 } else { error / allowed };
        if ratio > self.ratio {
            (self.ratio, self.error, self.allowed, self.at) = (ratio, error, allowed, at);
        }
    }

    /// A pixel whose answer depends on rounding.
    pub fn leave_out(&mut self) {
        self.left_out += 1;
    }

    pub fn error(&self) -> f64 {
        self.error
    }

    pub fn ratio(&self) -> f64 {
        self.ratio
    }

    fn text(&self) -> String {
        let Self {
            what,
            error,
            allowed,
            at,
            checked,
            left_out,
            ..
        } = self;
        format!(
            "{what}: off by {error:.3e} at {at:?}, allowed {allowed:.3e} ({checked} numbers, {left_out} pixels left out)"
        )
    }

    /// Every number was inside its allowance, enough were looked at, few were left out.
    #[track_caller]
    pub fn assert_holds(&self) {
        println!("{}", self.text());
        assert!(
            self.checked >= 100,
            "{}: hardly anything checked",
            self.text()
        );
        assert!(
            self.left_out * 20 <= self.checked,
            "{}: too much left out",
            self.text()
        );
        assert!(self.ratio <= 1.0, "{}", self.text());
    }

    /// At least one number was clearly outside: by a factor of two.
    #[track_caller]
    pub fn assert_caught(&self) {
        println!("caught: {}", self.text());
        assert!(self.ratio > 2.0, "not caught: {}", self.text());
    }
}
