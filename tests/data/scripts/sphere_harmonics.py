"""Layer operators on the unit sphere in vector spherical harmonics: tests/data/sphere_harmonics.csv; see sphere_harmonics.md.

    python3 sphere_harmonics.py > ../sphere_harmonics.csv

Checks the formulas of the .md file by direct integration in spherical coordinates with the pole at the target
(the kernel times sin(alpha) is analytic there), 50 digits, several (l, m), targets and off-surface points.
"""
import sys
from fractions import Fraction as F
from mpmath import mp, mpf, mpc, sin, cos, sqrt, pi, expj, atan2, nstr, matrix
from modal_kernels import gauss

mp.dps = 50


def eig(l):
    """s_v, s_w, s_x, d_v, d_w, d_x"""
    k = 2 * l + 1
    return [F(l, k * (k + 2)), F(l + 1, k * (k - 2)) if l else None, F(1, k) if l else None,
            F(3, 2 * k * (k + 2)), F(-3, 2 * k * (k - 2)) if l else None, F(-3, 2 * k) if l else None]


def outside(l, r, kind):
    """Coefficients (v, w, x) of S[.] and D[.] at distance r > 1."""
    k = 2 * l + 1
    r = mpf(r)
    if kind == "v":
        return ({"v": mpf(l) / (k * (k + 2)) * r ** (-l - 2)}, {"v": mpf(2 * l * l + 4 * l + 3) / (k * (k + 2)) * r ** (-l - 2)})
    if kind == "x":
        return ({"x": r ** (-l - 1) / k}, {"x": mpf(l - 1) / k * r ** (-l - 1)})
    diff = r ** (-l - 2) - r ** (-l)
    return ({"w": mpf(l + 1) / (k * (k - 2)) * r ** (-l), "v": mpf(l) / (2 * k) * diff},
            {"w": mpf(2 * (l * l - 1)) / (k * (k - 2)) * r ** (-l), "v": mpf(l * (l - 1)) / k * diff})


def inside(l, r, kind):
    """The same at distance r < 1."""
    k = 2 * l + 1
    r = mpf(r)
    if kind == "w":
        return ({"w": mpf(l + 1) / (k * (k - 2)) * r ** (l - 1)}, {"w": -mpf(2 * l * l + 1) / (k * (k - 2)) * r ** (l - 1)})
    if kind == "x":
        return ({"x": r ** l / k}, {"x": -mpf(l + 2) / k * r ** l})
    diff = r ** (l + 1) - r ** (l - 1)
    return ({"v": mpf(l) / (k * (k + 2)) * r ** (l + 1), "w": mpf(l + 1) / (2 * k) * diff},
            {"v": -mpf(2 * l * (l + 2)) / (k * (k + 2)) * r ** (l + 1), "w": -mpf((l + 1) * (l + 2)) / k * diff})


def pressure(l, r, kind):
    """Coefficients of Y in the pressures of S and D."""
    if kind == "w" and r > 1:
        return l * r ** (-l - 1), 2 * l * (l - 1) * r ** (-l - 1)
    if kind == "v" and r < 1:
        return (l + 1) * r ** l, -2 * (l + 1) * (l + 2) * r ** l
    return mpf(0), mpf(0)


def basis(l, m, x, y, z):
    """Cartesian V, W, X at the direction (x, y, z), Y = P_l^m(cos t) e^{i m p} (no Condon-Shortley phase, not normalised)."""
    R = sqrt(x * x + y * y + z * z)
    x, y, z = x / R, y / R, z / R
    s = sqrt(x * x + y * y)
    c, p = z, atan2(y, x)
    a, b = mpf(0), mpf(1)
    for k in range(1, m + 1):
        b *= (2 * k - 1) * s
    for k in range(m + 1, l + 1):
        a, b = b, ((2 * k - 1) * c * b - (k + m - 1) * a) / (k - m)
    e = expj(m * p)
    Y = b * e
    dY = (l * c * b - (l + m) * (a if l > m else 0)) / s * e
    pY = mpc(0, m) * b / s * e
    er = (x, y, z)
    et = (c * cos(p), c * sin(p), -s)
    ep = (-sin(p), cos(p), mpf(0))
    g = [dY * u + pY * v for u, v in zip(et, ep)]
    gx = [dY * v - pY * u for u, v in zip(et, ep)]
    return {"v": [u - (l + 1) * Y * v for u, v in zip(g, er)], "w": [u + l * Y * v for u, v in zip(g, er)], "x": gx, "y": Y}


def apply(l, m, kind, X, na):
    """S and D of the basis density at the point X (on or outside the sphere)."""
    R = sqrt(sum(u * u for u in X))
    n = [u / R for u in X]
    # frame with n as the pole
    h = sqrt(n[0] ** 2 + n[1] ** 2)
    e1 = (n[2] * n[0] / h, n[2] * n[1] / h, -h)
    e2 = (-n[1] / h, n[0] / h, mpf(0))
    xs, ws = gauss(na)
    nb = 2 * l + 10
    S, D, p = [mpc(0)] * 3, [mpc(0)] * 3, [mpc(0)] * 2
    for xa, wa in zip(xs, ws):
        al, wa = pi * (1 + xa) / 2, pi * wa / 2
        for kb in range(nb):
            be = 2 * pi * (kb + mpf(1) / 3) / nb
            y = [cos(al) * u + sin(al) * (cos(be) * v + sin(be) * w) for u, v, w in zip(n, e1, e2)]
            rho = basis(l, m, *y)[kind]
            d = [u - v for u, v in zip(X, y)]
            q = sqrt((R - 1) ** 2 + 4 * R * sin(al / 2) ** 2)
            # x on the sphere: (x - y).y = -q^2/2
            dn = R * cos(al) - 1 if R != 1 else -q * q / 2
            dr = sum(u * v for u, v in zip(d, rho))
            w = wa * 2 * pi / nb * sin(al)
            if R != 1:
                p[0] += w / (4 * pi) * dr / q ** 3
                p[1] += w / (2 * pi) * (-sum(u * v for u, v in zip(y, rho)) / q ** 3 + 3 * dr * dn / q ** 5)
            for i in range(3):
                S[i] += w / (8 * pi) * (rho[i] / q + d[i] * dr / q ** 3)
                D[i] += w * 3 / (4 * pi) * d[i] * dr * dn / q ** 5
    return S, D, p


def check():
    worst = mpf(0)
    for l, m in ((1, 0), (1, 1), (2, 0), (2, 1), (3, 2), (5, 3)):
        for kind in "vwx":
            n = [mpf("0.36"), mpf("-0.48"), mpf("0.8")]
            for R in (1, mpf("1.75"), mpf("0.5")):
                X = [R * u for u in n]
                S, D, p = apply(l, m, kind, X, 60 if R == 1 else 110)
                base = basis(l, m, *X)
                if R == 1:
                    ev = eig(l)
                    i = "vwx".index(kind)
                    want = [{kind: mpf(ev[i].numerator) / ev[i].denominator}, {kind: mpf(ev[3 + i].numerator) / ev[3 + i].denominator}]
                else:
                    want = outside(l, R, kind) if R > 1 else inside(l, R, kind)
                if R != 1:
                    for got, c in zip(p, pressure(l, R, kind)):
                        err = abs(got - c * base["y"])
                        worst = max(worst, err)
                        if err > mpf(10) ** -30:
                            sys.exit(f"pressure {l} {m} {kind} {nstr(R, 4)}: {nstr(got / base['y'], 12)} {nstr(c, 12)}")
                size = max(abs(u) for u in base[kind])
                for got, w in zip((S, D), want):
                    ref = [sum(c * base[k][i] for k, c in w.items()) for i in range(3)]
                    err = max(abs(u - v) for u, v in zip(got, ref)) / size
                    worst = max(worst, err)
                    if err > mpf(10) ** -30:
                        # what the coefficients are instead
                        A = matrix(3, 3)
                        for j, k in enumerate("vwx"):
                            for i in range(3):
                                A[i, j] = base[k][i]
                        print("FAILED", l, m, kind, nstr(R, 4), nstr(err, 3), "coefficients", [nstr(c, 12) for c in mp.lu_solve(A, matrix(got))],
                              {k: nstr(c, 12) for k, c in w.items()}, file=sys.stderr)
    return worst


if __name__ == "__main__":
    worst = check()
    print("largest error of the direct check", nstr(worst, 3), file=sys.stderr)
    print("# Eigenvalues on the unit sphere (s: single layer, d: double layer = traction of the single layer) for the bases v, w, x of")
    print("# sphere_harmonics.md. Origin: tests/data/scripts/sphere_harmonics.py: closed forms, 20 digits; the same for every order m.")
    print("l,s_v,s_w,s_x,d_v,d_w,d_x")
    for l in range(0, 31):
        print(",".join([str(l)] + ["" if f is None else nstr(mpf(f.numerator) / f.denominator, 20, min_fixed=-9) for f in eig(l)]))
