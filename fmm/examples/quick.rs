use std::time::Instant;
use stokes_fmm::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let n: usize = a[1].parse().unwrap();
    let tol: f64 = a[2].parse().unwrap();
    let kind = a.get(3).map_or("s", |s| s);
    let mut r = fastrand::Rng::with_seed(3);
    let x: Vec<[f64; 3]> = if a.get(4).is_some() {
        let m = (n as f64 / 2550.0).cbrt().ceil() as i32;
        let mut v = Vec::new();
        'o: for i in 0..m {
            for j in 0..m {
                for k in 0..m {
                    if v.len() >= n {
                        break 'o;
                    }
                    let c = [i, j, k].map(|i| 2.4 * i as f64 + 0.1 * r.f64());
                    let e = {
                        let mut g = || r.f64() - 0.5;
                        let v = [g(), g(), g()];
                        let l = v.iter().map(|v| v * v).sum::<f64>().sqrt();
                        v.map(|v| v / l)
                    };
                    for _ in 0..2550 {
                        let z = 2.0 * r.f64() - 1.0;
                        let p = r.f64() * 6.283185307;
                        let s = (1.0 - z * z).sqrt();
                        let d = [s * p.cos(), s * p.sin(), z];
                        let dot: f64 = (0..3).map(|i| d[i] * e[i]).sum();
                        v.push([0, 1, 2].map(|i| c[i] + 0.5 * (d[i] + dot * e[i])));
                    }
                }
            }
        }
        v
    } else {
        (0..n).map(|_| [0; 3].map(|_| r.f64())).collect()
    };
    let n = x.len();
    let f: Vec<[f64; 3]> = (0..n).map(|_| [0; 3].map(|_| r.f64() - 0.5)).collect();
    let nn: Vec<[f64; 3]> = (0..n).map(|_| [0; 3].map(|_| r.f64() - 0.5)).collect();
    let s = match kind {
        "d" => Singularities::Stresslets,
        "b" => Singularities::Both,
        _ => Singularities::Stokeslets,
    };
    let st = match kind {
        "d" => Strengths {
            stresslets: Some(Stresslets {
                densities: &f,
                normals: &nn,
            }),
            ..Default::default()
        },
        "b" => Strengths {
            stokeslets: Some(&nn),
            stresslets: Some(Stresslets {
                densities: &f,
                normals: &nn,
            }),
            ..Default::default()
        },
        _ => Strengths {
            stokeslets: Some(&f),
            ..Default::default()
        },
    };
    let o = if std::env::var("OUT").is_ok() {
        Output::Gradient
    } else {
        Output::Velocity
    };
    let t = Instant::now();
    let plan = StokesSum::new(Points::same(&x), s, o, tol).unwrap();
    println!("plan {:?}", t.elapsed());
    let t = Instant::now();
    let plan = plan.moved(Points::same(&x)).unwrap();
    println!("moved {:?}", t.elapsed());
    let mut flow = Flow::default();
    for _ in 0..3 {
        let t = Instant::now();
        flow = plan.apply(&st).unwrap();
        let t = t.elapsed().as_secs_f64();
        println!(
            "apply {t:.3} = {:.2} us/pt, {:.0}k pts/s",
            t / n as f64 * 1e6,
            n as f64 / t / 1e3
        );
    }
    let pick: Vec<usize> = (0..200).map(|i| i * n / 200).collect();
    let tx: Vec<[f64; 3]> = pick.iter().map(|&i| x[i]).collect();
    let t = Instant::now();
    let d = direct::sum(&x, &st, &tx, o, None).unwrap();
    println!(
        "direct {:.2} Gpairs/s",
        n as f64 * 200.0 / t.elapsed().as_secs_f64() / 1e9
    );
    let err = |a: &dyn Fn(usize) -> Vec<f64>, b: &dyn Fn(usize) -> Vec<f64>| {
        let (mut e, mut q) = (0.0, 0.0);
        for i in 0..200 {
            for (a, b) in a(i).iter().zip(b(i)) {
                e += (a - b) * (a - b);
                q += b * b;
            }
        }
        (e / q as f64).sqrt()
    };
    println!(
        "u {:.2e}",
        err(&|i| flow.velocity[pick[i]].to_vec(), &|i| d.velocity[i]
            .to_vec())
    );
    if !d.gradient.is_empty() {
        println!(
            "p {:.2e}",
            err(&|i| vec![flow.pressure[pick[i]]], &|i| vec![d.pressure[i]])
        );
        println!(
            "g {:.2e}",
            err(&|i| flow.gradient[pick[i]].concat(), &|i| d.gradient[i]
                .concat())
        );
    }
}
