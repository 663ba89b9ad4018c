//! How the smooth pieces of a curve share a number of panels.

/// How many of `count` panels each piece gets, by the `lengths` of the pieces: one each, then
/// always one more to the piece whose panels are longest.
pub(super) fn shares(lengths: &[f64], count: usize) -> Vec<usize> {
    // Start just below the ideal shares, so that few panels remain to be handed out one by one.
    let total: f64 = lengths.iter().sum();
    let spare = count - lengths.len();
    let ideal = |length: f64| {
        if total > 0.0 {
            (length / total * spare as f64) as usize
        } else {
            0
        }
    };
    let mut shares: Vec<usize> = lengths.iter().map(|&l| 1 + ideal(l).min(spare)).collect();
    while shares.iter().sum::<usize>() > count {
        let Some(largest) = shares.iter_mut().max() else {
            break;
        };
        *largest -= 1;
    }
    let mut left = count - shares.iter().sum::<usize>().min(count);
    let mut open = vec![true; lengths.len()];
    while left > 0 {
        let size = |p: usize| lengths[p] / shares[p] as f64;
        let longest = (0..lengths.len())
            .filter(|&p| open[p])
            .map(size)
            .fold(0.0, f64::max);
        let equals: Vec<usize> = (0..lengths.len())
            .filter(|&p| open[p] && size(p) >= longest * (1.0 - 1e-9))
            .collect();
        // Pieces of one length get one more panel each or none: symmetric curves stay symmetric.
        if equals.is_empty() {
            shares[0] += left;
            left = 0;
        } else if equals.len() <= left {
            equals.iter().for_each(|&p| shares[p] += 1);
            left -= equals.len();
        } else if equals.len() < open.iter().filter(|&&o| o).count() {
            equals.iter().for_each(|&p| open[p] = false);
        } else {
            equals[..left].iter().for_each(|&p| shares[p] += 1);
            left = 0;
        }
    }
    shares
}
