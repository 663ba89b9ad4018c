//! Tests of the panel: exactness on polynomials, tiny offsets, exact hits.

use super::*;
use proptest::prelude::*;

fn apply(row: &[f64], f: impl Fn(f64) -> f64, panel: &PanelBasis) -> f64 {
    std::iter::zip(row, panel.nodes())
        .map(|(l, &x)| l * f(x))
        .sum()
}

proptest! {
    #[test]
    fn reproduces_polynomials(order in 1usize..40, t in -1.05f64..1.05) {
        let panel = PanelBasis::new(order).unwrap();
        let mut row = vec![0.0; order];
        panel.interpolation_row(t, &mut row).unwrap();
        let c: Vec<f64> = (0..order).map(|k| 1.0 / (k as f64 + 1.0)).collect();
        let exact = legendre::series(&c, t);
        let at = apply(&row, |x| legendre::series(&c, x), &panel);
        let growth = row.iter().map(|l| l.abs()).sum::<f64>();
        prop_assert!((at - exact).abs() < 1e-14 * growth * exact.abs().max(2.0), "{at} {exact}");
    }

    #[test]
    fn divided_differences_keep_relative_precision(
        order in 2usize..25, node in 0usize..25, exponent in -300f64..-0.5, sign in prop::bool::ANY,
    ) {
        let node = node % order;
        let panel = PanelBasis::new(order).unwrap();
        let offset = 10f64.powf(exponent) * if sign { 1.0 } else { -1.0 };
        let mut row = vec![0.0; order];
        panel.divided_difference_row(node, offset, &mut row).unwrap();
        // (t^2 - x^2) / (t - x) = t + x
        let x = panel.nodes()[node];
        if order > 2 {
            let at = apply(&row, |x| x * x, &panel);
            prop_assert!((at - (2.0 * x + offset)).abs() < 1e-12, "{at}");
        }
        let slope = apply(&row, |x| x, &panel);
        prop_assert!((slope - 1.0).abs() < 1e-12);
        let mut near = vec![0.0; order];
        panel.interpolation_row_near(node, offset, &mut near).unwrap();
        for (j, (l, d)) in std::iter::zip(&near, &row).enumerate() {
            let expected = d * offset + if j == node { 1.0 } else { 0.0 };
            prop_assert!((l - expected).abs() <= 1e-12 * expected.abs());
        }
    }
}

#[test]
fn hits_on_nodes_are_exact() {
    let panel = PanelBasis::new(7).unwrap();
    let mut row = [0.0; 7];
    for i in 0..7 {
        let unit: Vec<f64> = (0..7).map(|j| if i == j { 1.0 } else { 0.0 }).collect();
        panel.interpolation_row(panel.nodes()[i], &mut row).unwrap();
        assert_eq!(row.as_slice(), unit);
        panel.interpolation_row_near(i, 0.0, &mut row).unwrap();
        assert_eq!(row.as_slice(), unit);
        let gap = panel.nodes()[i] - panel.nodes()[3];
        panel.interpolation_row_near(3, gap, &mut row).unwrap();
        assert_eq!(row.as_slice(), unit);
        panel.divided_difference_row(3, gap, &mut row).unwrap();
        assert!((apply(&row, |x| x * x, &panel) - (2.0 * panel.nodes()[3] + gap)).abs() < 1e-14);
    }
}

#[test]
fn differentiation_matrix_is_the_limit_of_divided_differences() {
    let panel = PanelBasis::new(16).unwrap();
    let matrix = panel.differentiation_matrix();
    let mut row = [0.0; 16];
    for i in 0..16 {
        panel.divided_difference_row(i, 0.0, &mut row).unwrap();
        let derivative: f64 = (0..16)
            .map(|j| matrix[(i, j)] * panel.nodes()[j].sin())
            .sum();
        assert!((derivative - panel.nodes()[i].cos()).abs() < 1e-12);
        for j in 0..16 {
            assert!((row[j] - matrix[(i, j)]).abs() < 1e-13 * matrix[(i, j)].abs().max(1.0));
        }
    }
}

#[test]
fn matrix_has_the_rows() {
    let panel = PanelBasis::new(5).unwrap();
    let matrix = panel.interpolation_matrix(&[-1.0, 0.25]).unwrap();
    let mut row = [0.0; 5];
    panel.interpolation_row(0.25, &mut row).unwrap();
    assert!((0..5).all(|j| matrix[(1, j)] == row[j]));
    assert_eq!(matrix.nrows(), 2);
}

#[test]
fn coefficients_continue_into_the_complex_plane() {
    let panel = PanelBasis::new(24).unwrap();
    let values: Vec<f64> = panel.nodes().iter().map(|x| x.exp()).collect();
    let c = panel.coefficients(&values).unwrap();
    let z = num_complex::Complex64::new(0.4, 0.3);
    assert!((legendre::series_complex(&c, z) - z.exp()).norm() < 1e-12);
    assert!((legendre::series(&c, 0.4) - 0.4f64.exp()).abs() < 1e-14);
}

#[test]
fn tail_tells_resolved_from_unresolved() {
    let panel = PanelBasis::new(16).unwrap();
    let tail = |f: fn(f64) -> f64| {
        let values: Vec<f64> = panel.nodes().iter().map(|&x| f(x)).collect();
        panel.tail(&values).unwrap()
    };
    assert!(tail(f64::exp) < 1e-14);
    assert!(tail(f64::cos) < 1e-14);
    assert!(tail(f64::abs) > 1e-3);
    assert!(tail(|x| (40.0 * x).sin()) > 0.1);
    assert_eq!(tail(|_| 0.0), 0.0);
    assert_eq!(tail(|_| f64::NAN), f64::INFINITY);
}

#[test]
fn misuse_is_an_error() {
    let panel = PanelBasis::new(4).unwrap();
    let mut row = [0.0; 4];
    assert!(PanelBasis::new(0).is_err());
    assert!(panel.interpolation_row(f64::NAN, &mut row).is_err());
    assert!(panel.interpolation_row(0.0, &mut row[..3]).is_err());
    assert!(panel.interpolation_row_near(4, 0.0, &mut row).is_err());
    assert!(
        panel
            .divided_difference_row(0, f64::INFINITY, &mut row)
            .is_err()
    );
    assert!(panel.coefficients(&[1.0]).is_err() && panel.tail(&[]).is_err());
}
