//! Toroidal functions against 40-digit values (tests/data/toroidal.csv).

use axistokes::body::special::toroidal::Toroidal;

#[test]
fn functions_differences_and_derivatives_match_high_precision() {
    let table = include_str!("../data/toroidal.csv");
    let mut rows = 0;
    let mut worst = [(0.0f64, String::new()), (0.0, String::new())];
    for line in table.lines().filter(|l| !l.starts_with('#')).skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let [h, value, difference] =
            [0, 3, 4].map(|k| fields[k].parse::<f64>().unwrap_or(f64::NAN));
        let [n, k] = [1, 2].map(|k| fields[k].parse::<usize>().expect("an index"));
        let functions = Toroidal::new(h, n);
        let derivative = functions.derivative(n, k).expect("k <= 3");
        let mut errors = vec![(usize::from(k > 0), (derivative / value - 1.0).abs())];
        if k == 0 && difference.is_normal() {
            errors.push((0, (functions.difference(n) / difference - 1.0).abs()));
        }
        for (kind, error) in errors {
            if error.is_nan() || error > worst[kind].0 {
                worst[kind] = (error, line.to_string());
            }
        }
        rows += 1;
    }
    println!(
        "functions and differences: {:?}\nderivatives: {:?}",
        worst[0], worst[1]
    );
    assert!(rows > 400, "only {rows} rows read");
    assert!(worst[0].0 <= 4e-14, "{:?}", worst[0]);
    assert!(worst[1].0 <= 4e-14, "{:?}", worst[1]);
}

#[test]
fn arguments_that_have_no_function_give_nan() {
    for h in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(Toroidal::new(h, 3).q(3).is_nan());
    }
    assert!(Toroidal::new(1.0, 3).derivative(0, 4).is_none());
}
