"""Reference values of the modal Stokes kernels: tests/data/modal_kernels.csv (near) and modal_kernels_far.csv.

    python3 modal_kernels.py near > ../modal_kernels.csv
    python3 modal_kernels.py far > ../modal_kernels_far.csv

The three-dimensional kernels are evaluated at 90 digits or more, node by node, and integrated over the angle:
dyadic Gauss-Legendre panels (100 nodes) clustered at t = 0, or the trapezoidal rule when chi - 1 > 0.3.
Checks, on every number: a second grid (ratio 1.7, 112 nodes; or more trapezoidal points); and the
closed forms in Q_{n-1/2} (shared note modal-kernels.md; pressures likewise), evaluated at the same precision.
The script stops when a check differs by more than 1e-25 of the largest entry of the same kernel and mode.
"""
import sys
import numpy as np
from mpmath import mp, mpf, sqrt, pi, cos, sin, nstr, log
from toroidal import by_series

NS = [0, 1, 2, 5, 20, 60]
NAMES = [k + i + j for k in "sdt" for i in "123" for j in "123"] + [k + j for k in ("ps", "pd") for j in "123"]
ODD = [n[-1] == "2" if n[0] == "p" else (n[1] == "2") != (n[2] == "2") for n in NAMES]


def geometries(which):
    """(label, rp, a, b, nr, nz, mr, mz), all floats."""
    out = []
    if which == "near":
        # generic direction, generic normals; distance from 0.1 to 1e-7 times rp
        for rp in (1.0, 0.3):
            for e in range(1, 8):
                rho = rp * 10.0 ** -e
                ang = 0.7 + 0.9 * e
                out.append((f"generic-{rp}-1e-{e}", rp, float(rho * np.cos(ang)), float(rho * np.sin(ang)),
                            float(np.cos(0.4 + e)), float(np.sin(0.4 + e)), float(np.cos(1.9 - e)), float(np.sin(1.9 - e))))
        # pure offsets
        for e in (2, 5):
            out.append((f"radial-1e-{e}", 0.75, 10.0 ** -e, 0.0, 0.6, 0.8, -0.8, 0.6))
            out.append((f"axial-1e-{e}", 0.75, 0.0, -(10.0 ** -e), 0.6, 0.8, -0.8, 0.6))
        # both points on a circle of radius 1 in the meridian plane; normals of that circle
        mp.dps = 50
        for name, centre, phi in (("sphere", 0.0, 0.9), ("torus", 2.0, 2.6)):
            for e in range(1, 8):
                d = mpf(10.0 ** -e) * (1 if e % 2 else -1)
                p = mpf(phi)
                a, b = cos(p + d) - cos(p), sin(p + d) - sin(p)
                out.append((f"circle-{name}-1e-{e}", centre + float(cos(p)), float(a), float(b), float(cos(p)),
                            float(sin(p)), float(cos(p + d)), float(sin(p + d))))
        # near the axis and near each other
        for rp, a, b in ((1e-3, 1e-5, 2e-5), (1e-3, 1e-7, -3e-8), (1e-6, 3e-8, 1e-8), (0.01, -1e-3, 1e-4)):
            out.append((f"axis-near-{rp}-{a}", rp, a, b, 0.28, 0.96, 0.1, -0.995))
    else:
        g = ((0.6, 0.8, -0.8, 0.6), (-0.28, 0.96, 0.96, 0.28))
        i = 0
        for rp, a, b in ((1.0, 0.5, 0.25), (1.0, -0.5, 1.0), (0.5, 1.5, -2.0), (2.0, -1.5, 0.3), (1.0, 0.0, 1.3),
                         (1.0, 3.0, 0.0), (0.7, 0.05, 0.2), (1.0, -0.2, -0.3),
                         (1e-3, 1e-3, 0.0), (1e-3, 1e-3, 5e-4), (2e-3, -1e-3, 0.0), (1e-6, 1.0, 0.0),
                         (1e-6, 1.0, 0.7), (1.0, -0.999999, 0.2), (1e-3, 0.5, -0.1), (1.0, 1e3, 2e3),
                         (1e3, -999.0, 5.0), (1e-4, 0.0, 1e-2), (0.05, 0.02, 3.0), (1e-6, 1e-6, 1e-7)):
            out.append((f"far-{i}", rp, a, b, *g[i % 2]))
            i += 1
    return out


_GL = {}


def gauss(m):
    if (m, mp.dps) not in _GL:
        xs, ws = [], []
        for x0 in np.polynomial.legendre.leggauss(m)[0]:
            x = mpf(float(x0))
            for _ in range(20):
                p0, p1 = mpf(1), x
                for k in range(2, m + 1):
                    p0, p1 = p1, ((2 * k - 1) * x * p1 - (k - 1) * p0) / k
                dp = m * (x * p1 - p0) / (x * x - 1)
                step = p1 / dp
                x -= step
                if abs(step) < mpf(10) ** (-mp.dps // 2 - 5):
                    break
            p0, p1 = mpf(1), x
            for k in range(2, m + 1):
                p0, p1 = p1, ((2 * k - 1) * x * p1 - (k - 1) * p0) / k
            dp = m * (x * p1 - p0) / (x * x - 1)
            xs.append(x)
            ws.append(2 / ((1 - x * x) * dp * dp))
        _GL[m, mp.dps] = xs, ws
    return _GL[m, mp.dps]


def kernels(g, t):
    _, rp, a, b, nr, nz, mr, mz = g
    r = rp + a
    c, s = 2 * sin(t / 2) ** 2, sin(t)
    ct = 1 - c
    q = a * a + b * b + 2 * r * rp * c
    q1 = 1 / sqrt(q)
    q3 = q1 / q
    q5 = q3 / q
    d = (a + rp * c, rp * s, b)        # x - x' in the target's frame
    e = (a - r * c, r * s, b)          # x - x' in the source's frame
    delta = ((ct, s, 0), (-s, ct, 0), (0, 0, 1))   # e_i(target) . e_j(source)
    ns = nr * e[0] + nz * e[2]
    nt = mr * d[0] + mz * d[2]
    k8, k34, k4, k2 = 1 / (8 * pi), 3 / (4 * pi), 1 / (4 * pi), 1 / (2 * pi)
    dd = [d[i] * e[j] for i in range(3) for j in range(3)]
    out = [k8 * (delta[i][j] * q1 + dd[3 * i + j] * q3) for i in range(3) for j in range(3)]
    out += [k34 * ns * q5 * x for x in dd]
    out += [-k34 * nt * q5 * x for x in dd]
    out += [k4 * q3 * x for x in e]
    nu = (nr, 0, nz)
    out += [k2 * (-nu[j] * q3 + 3 * e[j] * ns * q5) for j in range(3)]
    return out


def integrate(g, nodes, weights, factor):
    vals = [kernels(g, t) for t in nodes]
    cols = list(zip(*vals))
    res = {}
    for n in NS:
        wc = [factor * w * cos(n * t) for w, t in zip(weights, nodes)]
        ws = [factor * w * sin(n * t) for w, t in zip(weights, nodes)]
        res[n] = [mp.fdot(ws if odd else wc, col) for col, odd in zip(cols, ODD)]
    return res


def modes(g, second):
    _, rp, a, b = g[:4]
    x = (a * a + b * b) / (2 * rp * (rp + a))
    eta = 2 * mp.asinh(sqrt(x / 2))
    if x > 0.3:
        n = int(2 * NS[-1] + 65 * log(10) / eta) + (37 if second else 10)
        return integrate(g, [2 * pi * k / n for k in range(n)], [2 * pi / n] * n, 1)
    m, ratio = (112, mpf("1.7")) if second else (100, mpf(2))
    cuts = [+pi]
    while cuts[-1] > eta:
        cuts.append(cuts[-1] / ratio)
    cuts.append(mpf(0))
    xs, ws = gauss(m)
    nodes, weights = [], []
    for hi, lo in zip(cuts, cuts[1:]):
        h = (hi - lo) / 2
        nodes += [lo + h * (1 + y) for y in xs]
        weights += [h * w for w in ws]
    return integrate(g, nodes, weights, 2)


def closed(g):
    """S and D from the closed forms of the note, at working precision."""
    _, rp, a, b, nr, nz = g[:6]
    r = rp + a
    R, rho2 = 2 * r * rp, a * a + b * b
    x = rho2 / R
    need = sorted({abs(n + k) for n in NS for k in (-1, 0, 1)})
    q = {(n, k): by_series(n, k, x) for n in need for k in range(3)}
    E0 = lambda n: 2 * sqrt(mpf(2)) * q[abs(n), 0] / sqrt(R)
    E1 = lambda n: -4 * sqrt(mpf(2)) * q[abs(n), 1] / R ** mpf(1.5)
    E2 = lambda n: 8 * sqrt(mpf(2)) / 3 * q[abs(n), 2] / R ** mpf(2.5)
    Em = lambda n: -(R / (4 * n)) * (E0(n - 1) - E0(n + 1)) if n else (rho2 + R) * E0(0) - R * E0(1)
    res = {}
    for n in NS:
        C = lambda f: (f(n - 1) + f(n + 1)) / 2
        e0, e1, e2, em = E0(n), E1(n), E2(n), Em(n)
        S = (E0(n - 1) - E0(n + 1)) / 2
        W = (em - 2 * rho2 * e0 + rho2 ** 2 * e1) / (2 * R)
        T = e0 - rho2 * e1
        k = 2 * n / R
        v = [C(E0) + a * a * C(E1) - W, 3 * S / 2 + (a * r - rho2 / 2) * k * e0, b * (a * e1 + T / (2 * r)),
             -3 * S / 2 + (a * rp + rho2 / 2) * k * e0, C(E0) + T - W, b * rp * k * e0,
             b * (a * e1 - T / (2 * rp)), b * r * k * e0, e0 + b * b * e1]
        G = [e2, (e1 - rho2 * e2) / R, (e0 - 2 * rho2 * e1 + rho2 ** 2 * e2) / R ** 2,
             (em - 3 * rho2 * e0 + 3 * rho2 ** 2 * e1 - rho2 ** 3 * e2) / R ** 3]
        H = [2 * n / (3 * R) * e1, n / R ** 2 * (2 * e0 - 2 * rho2 * e1 / 3),
             (S - 4 * rho2 * n * e0 / R + 2 * rho2 ** 2 * n * e1 / (3 * R)) / R ** 2]
        be, al = nr * a + nz * b, nr * r
        num = [("G", a * a, -a * a, -r * rp), ("H", r * a, r * rp, 0), ("G", a * b, rp * b, 0),
               ("H", rp * a, -r * rp, 0), ("G", 0, 2 * r * rp, -r * rp), ("H", rp * b, 0, 0),
               ("G", a * b, -r * b, 0), ("H", r * b, 0, 0), ("G", b * b, 0, 0)]
        dl = []
        for kind, *p in num:
            M = G if kind == "G" else H
            co = [be * p[0], be * p[1] - al * p[0], be * p[2] - al * p[1], -al * p[2]]
            dl.append(sum(c * M[i] for i, c in enumerate(co) if c != 0))
        p1 = [a * e1 - r * (e0 - rho2 * e1) / R, r * k * e0, b * e1]
        p2 = [3 * (a * (be * G[0] - al * G[1]) - r * (be * G[1] - al * G[2])) - nr * e1, 3 * r * (be * H[0] - al * H[1]),
              3 * b * (be * G[0] - al * G[1]) - nz * e1]
        res[n] = [[y / (8 * pi) for y in v], [3 * y / (4 * pi) for y in dl], [y / (4 * pi) for y in p1], [y / (2 * pi) for y in p2]]
    return res


def closed_all(g):
    """All 33 entries; T from D with target and source exchanged: T_ij(x, x') = D_ji(x', x), odd transforms change sign."""
    one = closed(g)
    two = closed((g[0], g[1] + g[2], -g[2], -g[3], g[6], g[7]))
    out = {}
    for n in NS:
        s, d, p1, p2 = one[n]
        t = [(-1 if ODD[18 + 3 * i + j] else 1) * two[n][1][3 * j + i] for i in range(3) for j in range(3)]
        out[n] = s + d + t + p1 + p2
    return out


def main(which):
    print(f"# Modal Stokes kernels. Origin: tests/data/scripts/modal_kernels.py {which} (mpmath, >= 90 digits).")
    print("# Target (r, z), source (rp, zp), a = r - rp, b = z - zp exact doubles, r = rp + a in exact arithmetic (written rounded).")
    print("# xb = x - x', t = theta - theta'; indices 1, 2, 3 = e_r, e_theta, e_z at the target (i) and at the source (j); mu = 1.")
    print("# s = (delta/|xb| + xb xb/|xb|^3)/(8 pi); d = 3/(4 pi) xb_i xb_j (xb.nu')/|xb|^5; t = -3/(4 pi) xb_i xb_j (xb.nu)/|xb|^5;")
    print("# ps = xb_j/(4 pi |xb|^3); pd = (-nu'_j/|xb|^3 + 3 xb_j (xb.nu')/|xb|^5)/(2 pi). nu' = (nr, 0, nz) source, nu = (mr, 0, mz) target:")
    print("# exact doubles, not normalised further. Integral over [-pi, pi] of K cos(n t) for i - j even (pressure: j = 1, 3), of K sin(n t) else.")
    print("# beta = nr a + nz b and gamma = mr a + mz b from the exact doubles (they cancel when the points share a smooth curve).")
    print("label,r,rp,a,b,nr,nz,mr,mz,beta,gamma,n," + ",".join(NAMES))
    worst = mpf(0)
    for gf in geometries(which):
        mp.dps = 90
        g = (gf[0],) + tuple(mpf(v) for v in gf[1:])
        x = (g[2] ** 2 + g[3] ** 2) / (2 * g[1] * (g[1] + g[2]))
        mp.dps = 100 + int(2 * NS[-1] * mp.asinh(sqrt(x / 2)) / log(10)) * 2
        one, two, three = modes(g, False), modes(g, True), closed_all(g)
        digits = mp.dps
        for n in NS:
            for lo, hi in ((0, 9), (9, 18), (18, 27), (27, 30), (30, 33)):
                size = max(abs(v) for v in one[n][lo:hi])
                err = max(abs(u - v) for u, v in zip(one[n][lo:hi], two[n][lo:hi])) / size
                err = max(err, max(abs(u - v) for u, v in zip(one[n][lo:hi], three[n][lo:hi])) / size)
                worst = max(worst, err)
                if err > mpf(10) ** -25:
                    sys.exit(f"check failed: {gf} n={n} entries {NAMES[lo:hi]} {nstr(err, 3)}\n{[nstr(v,8) for v in one[n][lo:hi]]}\n{[nstr(v,8) for v in (three[n][lo:hi] or two[n][lo:hi])]}")
                # what should vanish is written as 0
                for i in range(lo, hi):
                    if abs(one[n][i]) < size * mpf(10) ** -60 or abs(one[n][i]) < mpf(10) ** -300:
                        one[n][i] = mpf(0)
            head = [gf[0], repr(float(g[1] + g[2]))] + [repr(v) for v in gf[1:]]
            head += [nstr(g[4] * g[2] + g[5] * g[3], 20), nstr(g[6] * g[2] + g[7] * g[3], 20), str(n)]
            print(",".join(head + ["0" if v == 0 else nstr(v, 20, min_fixed=-3, max_fixed=3) for v in one[n]]))
            sys.stdout.flush()
    print("largest disagreement, relative to the largest entry of the kernel", nstr(worst, 3), file=sys.stderr)


if __name__ == "__main__":
    main(sys.argv[1])
