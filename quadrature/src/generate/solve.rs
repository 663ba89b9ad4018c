//! Linear systems in double-double arithmetic, nearly singular ones included.

use crate::double_double::Dd;

/// Solves the square system `matrix x = right` by Gaussian elimination with complete pivoting.
/// Pivots smaller than `rank_tolerance` times the first are taken for zero, and the unknowns
/// without a pivot are set to zero.
pub(super) fn solve(mut matrix: Vec<Vec<Dd>>, mut right: Vec<Dd>, rank_tolerance: f64) -> Vec<Dd> {
    let n = right.len();
    let mut column: Vec<usize> = (0..n).collect();
    let mut rank = n;
    let mut first = 0.0;
    for step in 0..n {
        let (mut best, mut at) = (0.0, (step, step));
        for (i, row) in matrix.iter().enumerate().skip(step) {
            for (j, entry) in row.iter().enumerate().skip(step) {
                if entry.to_f64().abs() > best {
                    (best, at) = (entry.to_f64().abs(), (i, j));
                }
            }
        }
        if step == 0 {
            first = best;
        }
        // NaN are never chosen as best, so a matrix of them ends here too.
        if best <= rank_tolerance * first {
            rank = step;
            break;
        }
        matrix.swap(step, at.0);
        right.swap(step, at.0);
        column.swap(step, at.1);
        matrix.iter_mut().for_each(|row| row.swap(step, at.1));
        let (above, below) = matrix.split_at_mut(step + 1);
        let pivot = &above[step];
        for (i, row) in below.iter_mut().enumerate() {
            let factor = row[step] / pivot[step];
            for j in step + 1..n {
                row[j] = row[j] - factor * pivot[j];
            }
            right[step + 1 + i] = right[step + 1 + i] - factor * right[step];
        }
    }
    let mut solution = vec![Dd::ZERO; n];
    for i in (0..rank).rev() {
        let mut sum = right[i];
        for j in i + 1..rank {
            sum = sum - matrix[i][j] * solution[column[j]];
        }
        solution[column[i]] = sum / matrix[i][i];
    }
    solution
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of a Hilbert matrix, condition 1e16 for 12 rows.
    fn hilbert(n: usize) -> Vec<Vec<Dd>> {
        (0..n)
            .map(|i| {
                (0..n)
                    .map(|j| Dd::ONE / Dd::from((i + j + 1) as f64))
                    .collect()
            })
            .collect()
    }

    fn times(matrix: &[Vec<Dd>], x: &[Dd]) -> Vec<Dd> {
        let dot = |row: &Vec<Dd>| std::iter::zip(row, x).fold(Dd::ZERO, |s, (a, x)| s + *a * *x);
        matrix.iter().map(dot).collect()
    }

    #[test]
    fn solves_what_doubles_cannot() {
        let matrix = hilbert(12);
        let x: Vec<Dd> = (0..12).map(|i| Dd::from(f64::from(i) - 4.0)).collect();
        let solution = solve(matrix.clone(), times(&matrix, &x), 1e-28);
        let error = |i: usize| (solution[i] - x[i]).to_f64().abs();
        assert!((0..12).all(|i| error(i) < 1e-13));
    }

    #[test]
    fn singular_systems_get_a_solution() {
        let matrix = vec![vec![Dd::ONE, Dd::ONE], vec![Dd::ONE, Dd::ONE]];
        let x = solve(matrix, vec![Dd::ONE, Dd::ONE], 1e-28);
        assert_eq!((x[0] + x[1]).to_f64(), 1.0);
    }
}
