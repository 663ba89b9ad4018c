"""Resistance of the torus: tests/data/torus_drag.csv.

    python3 torus_drag.py > ../torus_drag.csv

Torque about the axis, exact series (derived in the comment at `axis_torque_series`); all four resistance functions by
the first-kind single-layer equation in multiprecision: Fourier modes 0 and 1 around the axis, trigonometric collocation
along the circle, the logarithm split off exactly (Q_{n-1/2} = -P_{n-1/2} log(chi-1)/2 + analytic) and integrated by
Kress's (Martensen's, Kussmaul's) rule, targets half a step off the nodes so that no diagonal limit is needed.
Written: the digits on which two resolutions agree, at most 20.
"""
import sys
from mpmath import mp, mpf, sqrt, pi, cos, sin, log, agm, nstr

mp.dps = 60


def ellip(m1):
    """K and E for complementary parameter m1 = 1 - m, by the AGM."""
    a, b, m = mpf(1), sqrt(m1), 1 - m1
    s, p = m / 2, mpf(1) / 2
    c2 = m
    while True:
        a, b, c = (a + b) / 2, sqrt(a * b), (a - b) / 2
        p *= 2
        s += p * c * c
        if abs(c) < mpf(10) ** (-mp.dps):
            break
    k = pi / (2 * a)
    return k, k * (1 - s)


def legendre(x):
    """[Q_{n-1/2}], [P_{n-1/2}], n = 0, 1, 2 at chi = 1 + x, each with first derivative."""
    chi = 1 + x
    k, e = ellip(x / (x + 2))
    kp, ep = ellip(2 / (x + 2))
    u, w = sqrt(2 / (x + 2)), sqrt(2 * (x + 2))
    out = []
    for f0, f1 in ((u * k, chi * u * k - w * e), (2 / pi * u * kp, 2 / pi * (w * ep - u * kp))):
        f = [f0, f1, (4 * chi * f1 - f0) / 3]
        d = x * (x + 2)
        g = [(f[1] - chi * f[0]) / (2 * d)] + [(n - mpf(1) / 2) * (chi * f[n] - f[n - 1]) / d for n in (1, 2)]
        out.append((f, g))
    return out


def single(n, r, rp, a, b, f, g, R, rho2):
    """9 entries of 8 pi V for mode n in (0, 1) from f = Q, g = Q' (or the same with P): shared note modal-kernels.md."""
    e0 = [2 * sqrt(mpf(2)) * v / sqrt(R) for v in f]
    e1 = [-4 * sqrt(mpf(2)) * v / R ** mpf(1.5) for v in g]
    em = (rho2 + R) * e0[0] - R * e0[1] if n == 0 else -(R / 4) * (e0[0] - e0[2])
    lo = abs(n - 1)
    C0, C1, S = (e0[lo] + e0[n + 1]) / 2, (e1[lo] + e1[n + 1]) / 2, (e0[lo] - e0[n + 1]) / 2
    W = (em - 2 * rho2 * e0[n] + rho2 ** 2 * e1[n]) / (2 * R)
    T = e0[n] - rho2 * e1[n]
    k = 2 * n / R
    return [C0 + a * a * C1 - W, 3 * S / 2 + (a * r - rho2 / 2) * k * e0[n], b * (a * e1[n] + T / (2 * r)),
            -3 * S / 2 + (a * rp + rho2 / 2) * k * e0[n], C0 + T - W, b * rp * k * e0[n],
            b * (a * e1[n] - T / (2 * rp)), b * r * k * e0[n], e0[n] + b * b * e1[n]]


def solve(A, B):
    """Gaussian elimination with partial pivoting; B a list of right-hand sides."""
    n = len(A)
    A = [row + [v[i] for v in B] for i, row in enumerate(A)]
    for k in range(n):
        p = max(range(k, n), key=lambda i: abs(A[i][k]))
        A[k], A[p] = A[p], A[k]
        pr, inv = A[k], 1 / A[k][k]
        for i in range(k + 1, n):
            row = A[i]
            f = row[k] * inv
            if f:
                A[i] = row[:k + 1] + [x - f * y for x, y in zip(row[k + 1:], pr[k + 1:])]
    sols = []
    for c in range(len(B)):
        x = [mpf(0)] * n
        for i in range(n - 1, -1, -1):
            x[i] = (A[i][n + c] - mp.fdot(A[i][i + 1:n], x[i + 1:])) / A[i][i]
        sols.append(x)
    return sols


def by_equation(minor, M, moved=True):
    N = 2 * M + 1
    h = 2 * pi / N
    # Moebius map of the circle, w = (u - beta)/(1 - beta u), |u| = 1: moves the nodes to the hole and puts the two nearest
    # singularities (the axis, and infinity) at the same distance.
    e0 = (1 - sqrt(1 - minor * minor)) / minor
    beta = mp.tanh(mp.atanh(e0) / 2) if moved else mpf(0)
    us = [mp.expj(j * h / 2) for j in range(2 * N)]
    ws = [(u - beta) / (1 - beta * u) for u in us]
    cs, sn = [w.real for w in ws], [w.imag for w in ws]
    speed = [(1 - beta * beta) / abs(1 - beta * u) ** 2 for u in us]
    # R depends on the odd multiple of h/2 between target and node
    Rw = [-(4 * pi / N) * mp.fsum(cos((2 * d + 1) * k * h / 2) / k for k in range(1, M + 1)) for d in range(N)]
    ker = [[None] * N for _ in range(M + 1)]
    for i in range(M + 1):
        ti = 2 * i + 1
        r, z = 1 + minor * cs[ti], minor * sn[ti]
        for jj in range(N):
            j = jj - M
            sj = (2 * j) % (2 * N)
            rp, zp = 1 + minor * cs[sj], minor * sn[sj]
            a, b = r - rp, z - zp
            rho2, R = a * a + b * b, 2 * r * rp
            d = abs(2 * i + 1 - 2 * j)
            L = log(4 * sin(d * h / 4) ** 2)
            (q, qd), (p, pd) = legendre(rho2 / R)
            out = []
            for n in (0, 1):
                full = single(n, r, rp, a, b, q, qd, R, rho2)
                lg = [-v / 2 for v in single(n, r, rp, a, b, p, pd, R, rho2)]
                scale = minor * speed[sj] * rp / (8 * pi)
                dd = (d - 1) // 2
                out.append([scale * (h * (u - v * L) + Rw[dd % N] * v) for u, v in zip(full, lg)])
            ker[i][jj] = out

    def block(n, e, odd):
        """Rows: targets; columns: nodes j = 0..M (even) or 1..M (odd density)."""
        rows = []
        for i in range(M + 1):
            k = [ker[i][jj][n][e] for jj in range(N)]
            if odd:
                rows.append([k[M + j] - k[M - j] for j in range(1, M + 1)])
            else:
                rows.append([k[M]] + [k[M + j] + k[M - j] for j in range(1, M + 1)])
        return rows

    def system(n, comps, parity, signs, rhs):
        """comps: component numbers; parity: True if odd; signs[(i,j)]."""
        A, B = [], []
        for i, oi in zip(comps, parity):
            blocks = []
            for j, oj in zip(comps, parity):
                s = signs.get((i, j), 1)
                blocks.append([[s * v for v in row] for row in block(n, 3 * i + j, oj)])
            for t in range(M if oi else M + 1):
                A.append(sum((bl[t] for bl in blocks), []))
                B.append(rhs(i, 1 + minor * cs[2 * t + 1], minor * sn[2 * t + 1]))
        x = solve(A, [B])[0]
        out, at = {}, 0
        for i, oi in zip(comps, parity):
            if oi:
                v = x[at:at + M]
                out[i] = [-y for y in v[::-1]] + [mpf(0)] + v
                at += M
            else:
                v = x[at:at + M + 1]
                out[i] = v[:0:-1] + v
                at += M + 1
        return out

    rs = [1 + minor * cs[(2 * (j - M)) % (2 * N)] for j in range(N)]
    zs = [minor * sn[(2 * (j - M)) % (2 * N)] for j in range(N)]
    area = [minor * h * r * speed[(2 * (j - M)) % (2 * N)] for j, r in enumerate(rs)]
    s1 = {(0, 1): -1, (2, 1): -1}
    t = system(0, [1], [False], {}, lambda i, r, z: r)
    torque_axis = 2 * pi * mp.fsum(w * r * v for w, r, v in zip(area, rs, t[1]))
    t = system(0, [0, 2], [True, False], {}, lambda i, r, z: mpf(i == 2))
    force_axis = 2 * pi * mp.fsum(w * v for w, v in zip(area, t[2]))
    t = system(1, [0, 1, 2], [False, False, True], s1, lambda i, r, z: (1, -1, 0)[i])
    force_across = pi * mp.fsum(w * (u - v) for w, u, v in zip(area, t[0], t[1]))
    t = system(1, [0, 1, 2], [True, True, False], s1, lambda i, r, z: (z, -z, -r)[i])
    torque_across = pi * mp.fsum(w * (z * (u - v) - r * y) for w, r, z, u, v, y in zip(area, rs, zs, t[0], t[1], t[2]))
    return [force_axis, force_across, torque_axis, torque_across]


def axis_torque_series(minor):
    # Toroidal coordinates r = c sinh e/(cosh e - cos x), z = c sin x/(cosh e - cos x), c^2 = 1 - minor^2, chi0 = 1/minor.
    # u_theta exp(i theta) is harmonic: u_theta = sqrt(cosh e - cos x) sum A_n P'_{n-1/2}(chi) sinh e cos(n x), equal to r on
    # e = e0. With (chi - cos x)^{-1/2} = (sqrt 2/pi) sum eps_n Q_{n-1/2}(chi) cos(n x) differentiated:
    # A_n = -2 c (sqrt 2/pi) eps_n Q'/P'. Far away u_theta -> T r/(8 pi R^3), R the distance, so
    # T = -32 c^3 sum eps_n (n^2 - 1/4) Q'_{n-1/2}(chi0)/P'_{n-1/2}(chi0)   (Kanwal 1961's result in another form).
    with mp.workdps(120):
        chi = 1 / minor
        c = sqrt(1 - minor * minor)
        d = chi * chi - 1
        total, n = mpf(0), 0
        half = mpf(1) / 2
        q = lambda v: mp.quad(lambda t: (chi + sqrt(d) * mp.cosh(t)) ** (-v - 1), [0, 1, 2, 4, 8, 16, 40, mp.inf])
        # Q by the hypergeometric series, P upwards
        z = (chi - sqrt(d)) ** 2
        Q = lambda k: sqrt(pi) * mp.gamma(k + half) / mp.gamma(k + 1) * z ** ((k + half) / 2) * mp.hyp2f1(half, k + half, k + 1, z)
        (_, _), (p, _) = legendre(chi - 1)
        p0, p1, q0, q1 = p[0], p[1], Q(0), Q(1)
        while True:
            # derivative: (chi^2-1) f'_v = (v+1)(f_{v+1} - chi f_v)
            term = (1 if n == 0 else 2) * (n * n - half / 2) * (q1 - chi * q0) / (p1 - chi * p0)
            total += term
            if abs(term) < abs(total) * mpf(10) ** -45:
                return -32 * c ** 3 * total
            n += 1
            p0, p1 = p1, (2 * n * chi * p1 - (n - half) * p0) / (n + half)
            q0, q1 = q1, Q(n + 1)


def same_digits(u, v):
    rel = abs(u - v) / abs(v)
    return 20 if rel < mpf(10) ** -21 else max(3, int(-mp.log10(rel)) - 1)


if __name__ == "__main__":
    sizes = {0.01: (8, 12), 0.1: (14, 20), 0.25: (20, 28), 0.5: (30, 40), 0.75: (40, 56), 0.9: (80, 112)}
    if len(sys.argv) > 1:
        sizes = {float(sys.argv[1]): (int(sys.argv[2]), int(sys.argv[3]))}
    print("# Torus, major radius 1, viscosity 1: force and torque on the fluid per unit velocity / angular velocity.")
    print("# Origin: tests/data/scripts/torus_drag.py (mpmath, 60 digits). torque_along is the exact toroidal series; the single-layer")
    print("# equation reproduces it to the digits in column `digits`, which is also what two resolutions of the other three agree to.")
    print("# Slender limit, L = ln(8/minor), confirmed by these numbers to O(minor^2 L): 8 pi^2/(L + 1/2), 2 pi^2 (3L - 17/2)/((L - 1/2)(L - 2) - 2),")
    print("# 4 pi^2/(L - 2), 4 pi^2/(L - 3/2) (Johnson & Wu 1979, J. Fluid Mech. 95, 263, quoted from memory).")
    print("# Independent double-precision panel code (panel_drag.py check): minor 0.25 agrees to 1e-15 in all four.")
    print("minor,force_along,force_across,torque_along,torque_across,digits")
    for mf, (m1, m2) in sizes.items():
        minor = mpf(mf)
        exact = axis_torque_series(minor)
        one, two = by_equation(minor, m1), by_equation(minor, m2)
        dg = [same_digits(u, v) for u, v in zip(one, two)] + [same_digits(two[2], exact)]
        print(mf, [nstr(abs(u / v - 1), 3) for u, v in zip(one, two)], nstr(abs(two[2] / exact - 1), 3), file=sys.stderr)
        two[2] = exact
        print(",".join([repr(mf)] + [nstr(v, 20) for v in two] + [str(min(dg))]))
        sys.stdout.flush()
