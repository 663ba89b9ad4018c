"""Resistance of bodies without closed form: tests/data/capsule.csv and tests/data/biconcave.csv (double precision).

    python3 panel_drag.py capsule > ../capsule.csv
    python3 panel_drag.py biconcave > ../biconcave.csv
    python3 panel_drag.py check              # spheroids and tori against the exact values

First-kind single-layer equation, modes 0 and 1, Gauss-Legendre panels of 16 nodes along the generating curve; every
target's integrals by brute force: dyadic subdivision towards the target and towards its mirror image beyond the axis.
Independent of the solver (other quadrature, other equation). Written: the digits on which two resolutions agree.
"""
import sys
import numpy as np
from scipy.special import ellipk, ellipe, ellipkm1

P = 16
X, W = np.polynomial.legendre.leggauss(P)
XF, WF = np.polynomial.legendre.leggauss(20)
BW = np.array([1 / np.prod(X[i] - np.delete(X, i)) for i in range(P)])


def bary(x):
    d = x[:, None] - X[None, :]
    hit = np.abs(d) < 1e-300
    d[hit] = 1
    m = BW / d
    m /= m.sum(1)[:, None]
    rows = hit.any(1)
    m[rows] = hit[rows]
    return m


def kernel(r, z, rp, zp):
    """V for mode 0: (11, 13, 22, 31, 33); mode 1: all nine. Arrays over sources."""
    a, b = r - rp, z - zp
    rho2 = a * a + b * b
    R = 2 * r * rp
    x = rho2 / R
    out = np.empty((2, 9, len(rp)))
    far = x > 0.5
    if far.any():
        m = 64
        t = (np.arange(m) + 0.5) * 2 * np.pi / m
        c, s = 2 * np.sin(t / 2) ** 2, np.sin(t)
        af, bf, rf = a[far, None], b[far, None], rp[far, None]
        q = 1 / np.sqrt(rho2[far, None] + R[far, None] * c)
        q3 = q ** 3
        d = [af + rf * c, rf * s, bf + 0 * c]
        e = [af - r * c, r * s + 0 * af, bf + 0 * c]
        ct = 1 - c
        delta = [ct, s, 0, -s, ct, 0, 0, 0, 1]
        for n in (0, 1):
            for i in range(3):
                for j in range(3):
                    odd = (i == 1) != (j == 1)
                    f = np.sin(n * t) if odd else np.cos(n * t)
                    out[n, 3 * i + j, far] = ((delta[3 * i + j] * q + d[i] * e[j] * q3) * f).sum(1) * (2 * np.pi / m)
    near = ~far
    if near.any():
        x, a, b, rp, rho2, R = x[near], a[near], b[near], rp[near], rho2[near], R[near]
        chi, d = 1 + x, x * (2 + x)
        k, e = ellipkm1(x / (x + 2)), ellipe(2 / (x + 2))
        u, w = np.sqrt(2 / (x + 2)), np.sqrt(2 * (x + 2))
        f = [u * k, chi * u * k - w * e]
        f.append((4 * chi * f[1] - f[0]) / 3)
        g = [-w * e / (2 * d), (u * k - chi * w * e / d) / 2]
        g.append(chi * g[1] + 1.5 * f[1])
        e0 = [2 * np.sqrt(2 / R) * v for v in f]
        e1 = [-4 * np.sqrt(2) * v / R ** 1.5 for v in g]
        for n in (0, 1):
            em = (rho2 + R) * e0[0] - R * e0[1] if n == 0 else -(R / 4) * (e0[0] - e0[2])
            lo = abs(n - 1)
            C0, C1, S = (e0[lo] + e0[n + 1]) / 2, (e1[lo] + e1[n + 1]) / 2, (e0[lo] - e0[n + 1]) / 2
            Wt = (em - 2 * rho2 * e0[n] + rho2 ** 2 * e1[n]) / (2 * R)
            T = e0[n] - rho2 * e1[n]
            kk = 2 * n / R
            out[n][:, near] = [C0 + a * a * C1 - Wt, 1.5 * S + (a * r - rho2 / 2) * kk * e0[n], b * (a * e1[n] + T / (2 * r)),
                               -1.5 * S + (a * rp + rho2 / 2) * kk * e0[n], C0 + T - Wt, b * rp * kk * e0[n],
                               b * (a * e1[n] - T / (2 * rp)), b * r * kk * e0[n], e0[n] + b * b * e1[n]]
    return out / (8 * np.pi)


def resist(curve, panels, closed=False):
    """curve(piece, s) -> r, z, r', z'; panels: list of (piece, s0, s1). Returns the four resistance functions."""
    nodes, geo = [], []
    for piece, s0, s1 in panels:
        s = (s0 + s1) / 2 + (s1 - s0) / 2 * X
        r, z, dr, dz = curve(piece, s)
        sp = np.hypot(dr, dz)
        nodes.append((s, r, z, sp * r * (s1 - s0) / 2 * W, dz / sp, -dr / sp))
        geo.append(np.sum(sp * (s1 - s0) / 2 * W))
    n = P * len(panels)
    A = np.zeros((2, 9, n, n))
    for ip, (piece, s0, s1) in enumerate(panels):
        for k in range(P):
            st, rt, zt = nodes[ip][0][k], nodes[ip][1][k], nodes[ip][2][k]
            row = ip * P + k
            for jp, (pj, q0, q1) in enumerate(panels):
                s, r, z, w = nodes[jp][:4]
                stack = [(q0, st), (st, q1)] if jp == ip else [(q0, q1)]
                subs = []
                whole = False
                first = jp != ip
                while stack:
                    l, h = stack.pop()
                    xx = np.linspace(l, h, 9)
                    r_, z_, dr_, dz_ = curve(pj, xx)
                    length = np.hypot(np.diff(r_), np.diff(z_)).sum()
                    d = min(np.hypot(r_ - rt, z_ - zt).min(), np.hypot(r_ + rt, z_ - zt).min())
                    if d >= 1.2 * length or (h - l) < max(1e-13 * (q1 - q0), 4e-15):
                        if first:
                            whole = True
                        else:
                            subs.append((l, h))
                    else:
                        m = (l + h) / 2
                        stack += [(l, m), (m, h)]
                    first = False
                if whole:
                    A[:, :, row, jp * P:(jp + 1) * P] = kernel(rt, zt, r, z) * w
                else:
                    lo, hi = np.array(subs).T
                    ss = ((lo + hi)[:, None] / 2 + (hi - lo)[:, None] / 2 * XF).ravel()
                    ww = ((hi - lo)[:, None] / 2 * WF).ravel()
                    r_, z_, dr_, dz_ = curve(pj, ss)
                    ok = np.hypot(r_ - rt, z_ - zt) > 0
                    ss, ww, r_, z_, dr_, dz_ = (v[ok] for v in (ss, ww, r_, z_, dr_, dz_))
                    K = kernel(rt, zt, r_, z_) * (ww * r_ * np.hypot(dr_, dz_))
                    A[:, :, row, jp * P:(jp + 1) * P] = K @ bary((ss - (q0 + q1) / 2) / ((q1 - q0) / 2))
    r, z, w, nr, nz = (np.concatenate([v[i] for v in nodes]) for i in range(1, 6))
    o, one = np.zeros(n), np.ones(n)
    B = A[0]
    t = np.linalg.solve(B[4], r)
    torque_axis = 2 * np.pi * np.sum(w * r * t)
    M = np.block([[B[0], B[2]], [B[6], B[8]]])
    nu = np.concatenate([nr, nz])
    M += np.outer(nu, nu * np.concatenate([w, w]))
    f = np.linalg.solve(M, np.concatenate([o, one]))
    force_axis = 2 * np.pi * np.sum(w * f[n:])
    B = A[1]
    M = np.block([[B[0], -B[1], B[2]], [B[3], B[4], B[5]], [B[6], -B[7], B[8]]])
    rhs = np.stack([np.concatenate([one, -one, o]), np.concatenate([z, -z, -r])], 1)
    f = np.linalg.solve(M, rhs).reshape(3, n, 2)
    force_across = np.pi * np.sum(w * (f[0, :, 0] - f[1, :, 0]))
    torque_across = np.pi * np.sum(w * (z * (f[0, :, 1] - f[1, :, 1]) - r * f[2, :, 1]))
    return np.array([force_axis, force_across, torque_axis, torque_across])


def even(lo, hi, n, piece=0):
    s = np.linspace(lo, hi, n + 1)
    return [(piece, s[i], s[i + 1]) for i in range(n)]


def capsule(radius, length):
    h = length / 2

    def curve(piece, s):
        if piece == 1:      # straight, s = -z
            return radius + 0 * s, -s, 0 * s, -1 + 0 * s
        sh = h if piece == 0 else -h
        return radius * np.sin(s), sh + radius * np.cos(s), radius * np.cos(s), -radius * np.sin(s)
    return curve


def capsule_panels(radius, length, base, levels):
    """Halved towards the joints."""
    def graded(lo, hi, at_lo, at_hi, piece, n):
        s = list(np.linspace(lo, hi, n + 1))
        if at_hi:
            s = s[:-1] + [hi - (hi - s[-2]) * 0.5 ** k for k in range(1, levels + 1)] + [hi]
        if at_lo:
            s = [lo] + [lo + (s[1] - lo) * 0.5 ** k for k in range(levels, 0, -1)] + s[1:]
        return [(piece, s[i], s[i + 1]) for i in range(len(s) - 1)]
    n = max(2, int(np.ceil(base * length / (radius * np.pi / 2))))
    return (graded(0, np.pi / 2, False, True, 0, base) + graded(-length / 2, length / 2, True, True, 1, n)
            + graded(np.pi / 2, np.pi, True, False, 2, base))


def spheroid(polar, eq):
    return lambda piece, s: (eq * np.sin(s), polar * np.cos(s), eq * np.cos(s), -polar * np.sin(s))


def torus(minor):
    # clockwise in (r, z) like the others, so that (dz, -dr) ... sign of nu does not matter
    return lambda piece, s: (1 + minor * np.cos(s), minor * np.sin(s), -minor * np.sin(s), minor * np.cos(s))


C0, C1, C2 = 0.207161, 2.002558, -1.122762


def biconcave(piece, s):
    r, c = np.sin(s), np.cos(s)
    g = C0 + C1 * r * r + C2 * r ** 4
    return r, c * g / 2, c, -r * g / 2 + c * (2 * C1 * r + 4 * C2 * r ** 3) * c / 2


def show(u, v):
    out = []
    for x, y in zip(u, v):
        d = int(np.clip(-np.log10(abs(x - y) / abs(y) + 1e-16), 3, 13))
        out.append((f"{y:.15e}", d))
    return out


if __name__ == "__main__":
    what = sys.argv[1]
    if what == "check":
        for p, e, ref in ((1.0, 0.5, (11.346876506622714924, 12.995817441783083252, None, None)),
                          (0.1, 1.0, (16.068314399634356153, 11.560511971774634051, None, None))):
            for n in (6, 10):
                v = resist(spheroid(p, e), even(0, np.pi, n))
                print(p, e, n, v, [x / y - 1 for x, y in zip(v, ref) if y])
        for n in (8, 12):
            print("torus 0.25", n, [repr(float(v)) for v in resist(torus(0.25), even(-np.pi, np.pi, n))])
    elif what == "biconcave":
        u, v = (resist(biconcave, even(0, np.pi, n)) for n in (14, 20))
        print(u / v - 1, file=sys.stderr)
        d = show(u, v)
        print("# Biconcave disc (red cell), equatorial radius 1, viscosity 1: force and torque on the fluid per unit (angular) velocity.")
        print("# Evans & Fung 1972: r = sin s, z = cos s (C0 + C1 r^2 + C2 r^4)/2 with exactly C0 = 0.207161, C1 = 2.002558, C2 = -1.122762.")
        print("# Origin: tests/data/scripts/panel_drag.py (double precision, not a published value); digits: agreement of 14 and 20 panels of 16.")
        print("c0,c1,c2,force_along,force_across,torque_along,torque_across,digits")
        print(f"{C0},{C1},{C2}," + ",".join(x for x, _ in d) + f",{min(k for _, k in d)}")
    elif what == "capsule":
        print("# Capsule (cylinder of `length` between two hemispheres of `radius`), viscosity 1: force and torque (about the centre) on the fluid.")
        print("# Origin: tests/data/scripts/panel_drag.py (double precision, computed here, not published values). digits: agreement of two")
        print("# resolutions (panels halved 6 and 9 times towards the joints, where the curvature jumps).")
        print("radius,length,force_along,force_across,torque_along,torque_across,digits")
        for radius, length in ((0.5, 2.0), (0.5, 1.0), (1.0, 1.0), (0.25, 2.0)):
            u = resist(capsule(radius, length), capsule_panels(radius, length, 2, 6))
            v = resist(capsule(radius, length), capsule_panels(radius, length, 3, 9))
            print(radius, length, u / v - 1, file=sys.stderr)
            d = show(u, v)
            print(f"{radius!r},{length!r}," + ",".join(x for x, _ in d) + f",{min(k for _, k in d)}")
            sys.stdout.flush()
