//! Numbers in tables: as many digits as are known, and zeros that are zeros.
//!
//! A number is shown to two digits beyond its estimated error, and never with fewer than four
//! digits or more than thirteen. A number that is taken for noise is shown as 0: one below a
//! thousandth of its estimated error, or below 1e-14 of the scale of its quantity or of the largest
//! component of its vector.

/// Numbers below this part of their scale are rounding.
const ROUNDING: f64 = 1e-14;
/// Numbers below this part of their estimated error are zero for all one knows.
const HIDDEN: f64 = 1e-3;
/// Digits beyond the estimated error.
const BEYOND: f64 = 2.0;
/// Fewest and most digits.
const FEWEST: usize = 4;
const MOST: usize = 13;
/// Characters of a number in a table.
const WIDTH: usize = 20;

/// What is known of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// Its estimated error relative to the scale.
    error: f64,
    /// How large such a number is for a flow as strong as this one.
    scale: f64,
}

impl Known {
    /// A number with this estimated error relative to its scale.
    pub fn relative(error: f64, scale: f64) -> Self {
        Self { error, scale }
    }

    /// A number with this absolute error.
    pub fn absolute(error: f64, scale: f64) -> Self {
        Self {
            error: error / scale,
            scale,
        }
    }

    /// A number as text of twenty characters.
    pub fn number(self, x: f64) -> String {
        self.row(&[x], &[])
    }

    /// The components of a vector beside each other; those that are given are exact.
    pub fn row(self, vector: &[f64], given: &[bool]) -> String {
        self.cells(vector, given).join("  ")
    }

    /// The same one by one.
    pub fn cells(self, vector: &[f64], given: &[bool]) -> Vec<String> {
        let largest = vector.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let rounding = ROUNDING * largest.max(self.scale);
        let zero = rounding.max(HIDDEN * self.error * self.scale);
        let text = |(i, &x): (usize, &f64)| {
            let text = match given.get(i) {
                Some(true) => exactly(x),
                _ if x.abs() < zero => "0".to_owned(),
                _ => with_digits(x, self.digits(x)),
            };
            format!("{text:>WIDTH$}")
        };
        vector.iter().enumerate().map(text).collect()
    }

    fn digits(self, x: f64) -> usize {
        let before_the_error = (x.abs() / (self.error * self.scale)).log10();
        // What is not a number becomes zero, and what is infinite the most there is.
        ((before_the_error + BEYOND).ceil() as usize).clamp(FEWEST, MOST)
    }
}

/// A number with as many digits as it has, within limits.
fn exactly(x: f64) -> String {
    let text = with_digits(x, MOST);
    let Some((mantissa, exponent)) = text.split_once('e') else {
        return text;
    };
    let trimmed = mantissa.trim_end_matches('0').len();
    let shortest = with_digits(x, FEWEST).find('e').unwrap_or_default();
    format!("{}e{exponent}", &mantissa[..trimmed.max(shortest)])
}

/// So many digits, and a signed exponent of at least two; zero is just that.
fn with_digits(x: f64, digits: usize) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    let text = format!("{x:.0$e}", digits - 1);
    match text.split_once('e').map(|(m, e)| (m, e.parse::<i32>())) {
        Some((mantissa, Ok(exponent))) => format!("{mantissa}e{exponent:+03}"),
        _ => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(text: &str) -> Vec<&str> {
        text.split_whitespace().collect()
    }

    #[test]
    fn digits_follow_the_error() {
        let shown = |error| {
            let text = Known::relative(error, 1.0).number(0.406_857_945_859_012_3);
            text.trim().to_owned()
        };
        assert_eq!(shown(5.4e-4), "4.0686e-01");
        assert_eq!(shown(1e-8), "4.068579459e-01");
        assert_eq!(shown(0.5), "4.069e-01");
        assert_eq!(shown(0.0), "4.068579458590e-01");
        assert_eq!(shown(f64::NAN), "4.069e-01");
        // A small one of the same quantity has the same absolute error.
        let small = Known::relative(1e-8, 1.0).number(1.234_567_89e-4);
        assert_eq!(small.trim(), "1.234568e-04");
        let absolute = Known::absolute(1e-6, 100.0).number(-25.0);
        assert_eq!((absolute.trim(), absolute.len()), ("-2.500000000e+01", 20));
    }

    #[test]
    fn rounding_is_zero_and_nothing_else_is() {
        let exact = Known::relative(1e-14, 10.0);
        assert_eq!(words(&exact.row(&[9e-14, 0.0, -9e-14], &[])), ["0"; 3]);
        assert_eq!(words(&exact.row(&[2e-13, 0.0], &[])), ["2.000e-13", "0"]);
        // Beside a component that is larger than the scale there is more rounding.
        let large = exact.row(&[5e3, 4e-11], &[]);
        assert_eq!(words(&large), ["5.000000000000e+03", "0"]);
        // A thousandth of an error of 1e-5.
        let known = Known::relative(1e-6, 10.0);
        let beside = known.row(&[5.0, 9e-9, 1.1e-8], &[]);
        assert_eq!(words(&beside), ["5.0000000e+00", "0", "1.100e-08"]);
    }

    #[test]
    fn what_is_given_is_shown_as_it_is() {
        let known = Known::relative(1e-3, 1.0);
        let text = known.row(&[1e-20, -0.123_456_789, 0.3], &[true, true, false]);
        assert_eq!(words(&text), ["1.000e-20", "-1.23456789e-01", "3.0000e-01"]);
    }

    #[test]
    fn nothing_is_too_strange() {
        let known = Known::absolute(0.0, 0.0);
        for x in [f64::NAN, f64::INFINITY, -1.5e-300, 1.5e300, -0.0] {
            assert_eq!(known.number(x).len(), 20, "{x}");
        }
    }
}
