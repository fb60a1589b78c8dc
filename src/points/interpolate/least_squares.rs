//! Linear least squares of few unknowns: Householder reflections with column pivoting.
//!
//! Golub and Van Loan, "Matrix Computations", 4th edition, 5.4.2. Columns are scaled to length 1 first; those whose rest
//! is below a tolerance when all that matter more are taken have a coefficient of 0.

/// Unknowns at most.
pub(super) const MOST: usize = 9;

/// What comes after this many of the first columns gives way to these where the data do not tell them apart.
const PREFERENCE: f64 = 0.25;

/// Rows `[a_1 .. a_n, b]`; taken to pieces by [`Self::solve`].
#[derive(Clone, Debug, Default)]
pub(super) struct System {
    rows: Vec<[f64; MOST + 1]>,
}

/// The coefficients, and the smallest rest of a column, 0 to 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Solution {
    pub coefficients: [f64; MOST],
    pub smallest_rest: f64,
}

impl System {
    /// Without rows.
    pub fn clear(&mut self) {
        self.rows.clear();
    }

    /// One more equation, times its weight already: coefficients of the unknowns, and what they make.
    pub fn push(&mut self, unknowns: &[f64], right: f64) {
        let mut row = [0.0; MOST + 1];
        row[..unknowns.len()].copy_from_slice(unknowns);
        row[MOST] = right;
        self.rows.push(row);
    }

    /// Least squares of `count` unknowns, of which the first `preferred` are taken before others that are about as
    /// independent. At least as many rows as unknowns.
    pub fn solve(&mut self, count: usize, preferred: usize, tolerance: f64) -> Solution {
        let rows = &mut self.rows;
        let length = |rows: &[[f64; MOST + 1]], k: usize| {
            rows.iter().map(|row| row[k] * row[k]).sum::<f64>().sqrt()
        };
        let lengths: [f64; MOST] = std::array::from_fn(|k| length(rows, k));
        for k in (0..count).filter(|&k| lengths[k] > 0.0) {
            rows.iter_mut().for_each(|row| row[k] /= lengths[k]);
        }
        let mut order: [usize; MOST] = std::array::from_fn(|k| k);
        let (mut rank, mut smallest_rest) = (count, 1.0_f64);
        for step in 0..count {
            let rest = |k: usize| length(&rows[step..], order[k]);
            let rated = |k: usize| {
                rest(k)
                    * if order[k] < preferred {
                        1.0
                    } else {
                        PREFERENCE
                    }
            };
            let best = (step..count).fold(step, |a, b| if rated(b) > rated(a) { b } else { a });
            let norm = rest(best);
            smallest_rest = smallest_rest.min(norm);
            if norm <= tolerance {
                rank = step;
                break;
            }
            order.swap(step, best);
            reflect(
                &mut rows[step..],
                order[step],
                &order[step + 1..count],
                norm,
            );
        }
        let mut coefficients = [0.0; MOST];
        for step in (0..rank).rev() {
            let row = &rows[step];
            let known = order[step + 1..rank]
                .iter()
                .map(|&k| row[k] * coefficients[k]);
            let k = order[step];
            coefficients[k] = (row[MOST] - known.sum::<f64>()) / row[k];
        }
        for (coefficient, &length) in coefficients.iter_mut().zip(&lengths[..count]) {
            *coefficient /= if length > 0.0 { length } else { 1.0 };
        }
        Solution {
            coefficients,
            smallest_rest,
        }
    }
}

/// Turns a column, `norm` long, into its first element, and others and the right sides alike.
fn reflect(rows: &mut [[f64; MOST + 1]], column: usize, others: &[usize], norm: f64) {
    let first = -norm.copysign(rows[0][column]);
    // The reflection is I - v v^T / (norm |v_0|).
    rows[0][column] -= first;
    let scale = 1.0 / (norm * rows[0][column].abs());
    for &k in others.iter().chain(&[MOST]) {
        let along: f64 = rows.iter().map(|row| row[column] * row[k]).sum();
        rows.iter_mut()
            .for_each(|row| row[k] -= row[column] * along * scale);
    }
    rows[0][column] = first;
}

#[cfg(test)]
mod tests {
    use super::*;

    fn solved(rows: &[([f64; 3], f64)], preferred: usize) -> Solution {
        let mut system = System::default();
        rows.iter()
            .for_each(|(unknowns, right)| system.push(unknowns, *right));
        system.solve(3, preferred, 1e-10)
    }

    #[test]
    fn what_has_an_answer_is_answered_and_what_has_none_by_least_squares() {
        let rows = [
            ([1.0, 0.0, 1.0], 4.0),
            ([0.0, 2.0, 1.0], 7.0),
            ([3.0, 1.0, 0.0], 5.0),
            ([1.0, 1.0, 1.0], 6.0),
        ];
        let found = solved(&rows, 0).coefficients;
        for (k, wanted) in [1.0, 2.0, 3.0].into_iter().enumerate() {
            assert!((found[k] - wanted).abs() < 1e-14, "{found:?}");
        }
        // Four values of x + y t + z t^2: the line of least squares through 0, 1, 4, 9 is -1 + 3 t.
        let rows = [0.0, 1.0, 2.0, 3.0].map(|t| ([1.0, t, 0.0], t * t));
        let found = solved(&rows, 0).coefficients;
        assert!(
            (found[0] + 1.0).abs() < 1e-14 && (found[1] - 3.0).abs() < 1e-14 && found[2] == 0.0,
            "{found:?}"
        );
    }

    #[test]
    fn of_columns_that_are_alike_the_preferred_ones_are_taken() {
        // The second is the sum of the first and the third.
        let rows = [
            ([1.0, 1.0, 0.0], 1.0),
            ([0.0, 1.0, 1.0], 1.0),
            ([0.0, 0.0, 0.0], 0.0),
        ];
        for (preferred, wanted) in [(2, [0.0, 1.0, 0.0]), (1, [1.0, 0.0, 1.0])] {
            let found = solved(&rows, preferred);
            assert!(found.smallest_rest < 1e-10);
            for (k, wanted) in wanted.into_iter().enumerate() {
                assert!(
                    (found.coefficients[k] - wanted).abs() < 1e-12,
                    "{preferred}: {found:?}"
                );
            }
        }
    }
}
