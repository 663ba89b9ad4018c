"""Spheres on one axis in Stokes flow by multipoles, viscosity 1, extended precision (numpy longdouble, 64-bit mantissa).

Method A, `Chain`: about each sphere Lamb's three decaying solutions (Lamb 1932, art. 336; Happel & Brenner 1973, section 3-2),
degrees 1..N, azimuthal order m = 0 or 1; no slip by projecting the field of the other spheres on vector spherical harmonics with
Gauss-Legendre points, LU. Method B, `twin`: two spheres, the reflections of Jeffrey & Onishi 1984 (J. Fluid Mech. 139, 261),
their recurrences for P, V, Q summed as a linear system instead of in powers (written down from memory, not
from the paper; one factor 1/n in P of the asymmetric motions was restored from the far field of method A). Method C,
`stimson_jeffery`: equal spheres.
Forces, torques and stresslets are those exerted on the fluid, about each sphere's own centre.
"""
import numpy as np

LD = np.longdouble
PI = LD(2) * np.arccos(LD(0))


def gauss(m):
    """Gauss-Legendre nodes and weights in extended precision."""
    x = np.cos(PI * (np.arange(m, dtype=LD) + LD(0.75)) / (m + LD(0.5)))
    for _ in range(6):
        p0, p1 = np.ones_like(x), x.copy()
        for n in range(2, m + 1):
            p0, p1 = p1, ((2 * n - 1) * x * p1 - (n - 1) * p0) / LD(n)
        d = m * (p0 - x * p1) / (1 - x * x)
        x = x - p1 / d
    p0, p1 = np.ones_like(x), x.copy()
    for n in range(2, m + 1):
        p0, p1 = p1, ((2 * n - 1) * x * p1 - (n - 1) * p0) / LD(n)
    d = m * (p0 - x * p1) / (1 - x * x)
    return x, 2 / ((1 - x * x) * d * d)


def legendre(n_max, m, x, s):
    """P, dP/dtheta, m P / sin(theta) for degrees 1..n_max, P = P_n (m = 0) or sin(theta) P_n' (m = 1), divided by the norm."""
    p = np.zeros((n_max + 2,) + x.shape, LD)
    q = np.zeros_like(p)  # P_n'
    p[0], p[1], q[1] = 1, x, 1
    for n in range(2, n_max + 1):
        p[n] = ((2 * n - 1) * x * p[n - 1] - (n - 1) * p[n - 2]) / LD(n)
        q[n] = q[n - 2] + (2 * n - 1) * p[n - 1]
    n = np.arange(1, n_max + 1, dtype=LD).reshape((-1,) + (1,) * x.ndim)
    p, q = p[1:n_max + 1], q[1:n_max + 1]
    if m == 0:
        c = np.sqrt((2 * n + 1) / 2)
        return c * p, -c * s * q, 0 * p
    c = np.sqrt((2 * n + 1) / (2 * n * (n + 1)))
    # d/dtheta (s P') = x P' - s^2 P'' and (1 - x^2) P'' = 2 x P' - n (n + 1) P
    return c * s * q, c * (n * (n + 1) * p - x * q), c * q


def solve(a, b):
    """LU with partial pivoting in extended precision."""
    lu, x = a.copy(), b.copy()
    k = len(lu)
    for i in range(k):
        j = i + int(np.argmax(np.abs(lu[i:, i])))
        if j != i:
            lu[[i, j]] = lu[[j, i]]
            x[[i, j]] = x[[j, i]]
        f = lu[i + 1:, i] / lu[i, i]
        hit = np.nonzero(f)[0]
        if len(hit) == len(f):
            lu[i + 1:, i + 1:] -= f[:, None] * lu[i, i + 1:]
        else:
            lu[i + 1 + hit, i + 1:] -= f[hit, None] * lu[i, i + 1:]
        x[i + 1:] -= f[:, None] * x[i]
    for i in range(k - 1, -1, -1):
        x[i] = (x[i] - lu[i, i + 1:] @ x[i + 1:]) / lu[i, i]
    return x


class Chain:
    """Spheres of radii `a`, centres `z` on the axis; every elementary motion of order m for all spheres at once.

    swirl=False: m = 0 along the axis, or m = 1 (translation along x, rotation about y); swirl=True: rotation about the axis.
    """

    def __init__(self, a, z, n_max, m, swirl=False, points=None):
        self.a, self.z = [LD(v) for v in a], [LD(v) for v in z]
        self.n_max, self.m, self.swirl = n_max, m, swirl
        x, w = gauss(points or (3 * n_max) // 2 + 24)
        self.x, self.s, self.w = x, np.sqrt((1 - x) * (1 + x)), w
        self.fam = [2] if swirl else ([0, 1] if m == 0 else [0, 1, 2])
        self.own = legendre(n_max, m, self.x, self.s)
        k, nb = len(self.fam) * n_max, len(self.a)
        self.k = k
        mat = np.zeros((nb * k, nb * k), LD)
        for j in range(nb):
            for i in range(nb):
                mat[j * k:(j + 1) * k, i * k:(i + 1) * k] = self.project(self.field(i, j))
        rhs = self.right_sides()
        self.c = solve(mat, rhs)

    def field(self, i, j):
        """Components (rho, theta, phi) about sphere j, at its nodes, of the solutions about sphere i: [family][comp] n x points."""
        a, m = self.a[i], self.m
        if i == j:
            x, s, ratio = self.x, self.s, np.ones_like(self.x)
            p, d, o = self.own
            turn = None
        else:
            r, z = self.a[j] * self.s, self.z[j] - self.z[i] + self.a[j] * self.x
            rho = np.sqrt(r * r + z * z)
            x, s, ratio = z / rho, r / rho, a / rho
            p, d, o = legendre(self.n_max, m, x, s)
            # local frames: e_rho = (s, x), e_theta = (x, -s) in (r, z)
            turn = (self.s * s + self.x * x, self.s * x - self.x * s)
        n = np.arange(1, self.n_max + 1, dtype=LD)[:, None]
        pw = ratio ** n
        out = []
        for f in self.fam:
            if f == 0:  # p-family, times 2 n - 1
                u = [pw * (n + 1) / 2 * p, -pw * (n - 2) / (2 * n) * d, pw * (n - 2) / (2 * n) * o]
            elif f == 1:  # grad phi / (n + 1)
                g = pw * ratio ** 2 / (n + 1)
                u = [-(n + 1) * g * p, g * d, -g * o]
            else:  # curl (r chi) / (n + 1): chi ~ P sin(phi) for m = 1, P for m = 0
                g = pw * ratio / (n + 1)
                u = [0 * p, g * o, -g * d]
            if turn is not None:
                u[0], u[1] = turn[0] * u[0] + turn[1] * u[1], -turn[1] * u[0] + turn[0] * u[1]
            out.append(u)
        return out

    def project(self, fields):
        p, d, o = self.own
        n = np.arange(1, self.n_max + 1, dtype=LD)[:, None]
        l = np.sqrt(n * (n + 1))
        tests = [(p, None, None), (None, d / l, -o / l), (None, o / l, -d / l)]
        rows = [0, 1] if (self.m == 0 and not self.swirl) else ([2] if self.swirl else [0, 1, 2])
        out = []
        for t in rows:
            line = []
            for u in fields:
                acc = 0
                for comp in range(3):
                    if tests[t][comp] is not None:
                        acc = acc + (tests[t][comp] * self.w) @ u[comp].T
                line.append(acc)
            out.append(np.hstack(line))
        return np.vstack(out)

    def right_sides(self):
        """Columns, sphere by sphere: rotation (swirl); along, strain diag(-1/2, -1/2, 1) (m = 0); across, turn, strain (m = 1).

        Strain: the sphere's surface moves with E times the radius vector, so that a rigid sphere in a flow -E x is held. For
        m = 1, E_xz = E_zx = 1.
        """
        cols = []
        one = np.ones_like(self.x)
        for j in range(len(self.a)):
            if self.swirl:
                motions = [(0 * one, 0 * one, self.a[j] * self.s)]
            elif self.m == 0:
                a, x, s = self.a[j], self.x, self.s
                motions = [(x, -s, 0 * one), (a * (3 * x * x - 1) / 2, -3 * a * x * s / 2, 0 * one)]
            else:
                # e_x: (s, x) cos, -1 sin; e_y x r: rho (0, 1 cos, -x sin)
                a, x, s = self.a[j], self.x, self.s
                motions = [(s, x, -one), (0 * one, a * one, -a * x), (2 * a * s * x, a * (x * x - s * s), -a * x)]
            for v in motions:
                col = np.zeros((len(self.a) * self.k, 1), LD)
                col[j * self.k:(j + 1) * self.k] = self.project([[c[None, :] for c in v]])
                cols.append(col)
        return np.hstack(cols)

    def moments(self):
        """force, torque, stresslet as [sphere receiving, motion]; stresslet: 3/2 S_zz (m = 0), S_xz (m = 1), traceless.

        Force 4 pi grad(rho^3 p_-2), torque 8 pi grad(rho^3 chi_-2); the pressure of a stresslet is 3 x.S.x / (4 pi rho^5).
        """
        nb, n_max = len(self.a), self.n_max
        nm = self.c.shape[1]
        force, torque, stress = (np.zeros((nb, nm), LD) for _ in range(3))
        norm = [np.sqrt(LD(2 * n + 1) / 2) if self.m == 0 else np.sqrt(LD(2 * n + 1) / (2 * n * (n + 1))) for n in (1, 2)]
        for i in range(nb):
            a = self.a[i]
            for slot, f in enumerate(self.fam):
                c = self.c[i * self.k + slot * n_max:i * self.k + (slot + 1) * n_max]
                if f == 0:
                    # p = (2 n - 1) c a^n rho^(-n-1) Y
                    force[i] = 4 * PI * c[0] * norm[0] * a
                    p2 = 3 * c[1] * norm[1] * a ** 2
                    # P_2 for m = 0; P_2^1 without sign = 3 s x for m = 1
                    stress[i] = 2 * PI * p2
                if f == 2:
                    # chi = c (a / rho)^(n+1) Y / (n + 1)
                    torque[i] = 8 * PI * c[0] * norm[0] * a ** 2 / 2
        return force, torque, stress


def twin(a1, a2, dist, n_max, kind):
    """Method B. kind "XA", "XC", or "Y". Returns force1, torque1, force2, torque2 for each unit motion of sphere 1.

    Motions: XA along, XC about the line of centres, Y: across (x), then about y. Sphere 2 stands at +z of sphere 1; a1 = 1.
    """
    assert a1 == 1
    ta, tb = LD(a1) / LD(dist), LD(a2) / LD(dist)
    n = np.arange(1, n_max + 1, dtype=LD)[:, None]
    s = n.T

    def weights(t1, t2):
        """C(n + s, n) (XA, XC) or C(n + s, n + 1) (Y), times t1^n t2^s."""
        c = np.zeros((n_max, n_max), LD)
        for i in range(1, n_max + 1):
            # C(i + s, i) t1^i t2^s, s = 1..
            v = t1 ** i
            for j in range(1, n_max + 1):
                v = v * (i + j) / LD(j) * t2
                c[i - 1, j - 1] = v
        return c if kind in ("XA", "XC") else c * s / (n + 1)

    blocks = []
    for t1, t2 in ((ta, tb), (tb, ta)):
        w = weights(t1, t2)
        zero = np.zeros_like(w)
        if kind == "XC":
            # Q_n = delta + sum C(n+s, n) s/(n+1) t1^(n) t2^(s+1) Q_s, about a common axis
            blocks.append([[w * s / (n + 1) * t2]])
        elif kind == "XA":
            pp = w * (n * (2 * n + 1) * (2 * n * s - n - s + 2) / (2 * (n + 1) * (2 * s - 1) * (n + s)) / t1
                      - n * (2 * n - 1) / (2 * (n + 1)) * t1)
            pv = -w * n * (4 * n * n - 1) / (2 * (n + 1) * (2 * s + 1)) * t2 ** 2 / t1
            vp = -w * 2 * n / ((n + 1) * (2 * n + 3)) * t1
            blocks.append([[pp, pv], [pp + vp, pv]])
        else:
            pp = w * (n * (2 * n + 1) / (2 * (n + 1)) * (3 * (n + s) - (n * s + 1) * (2 * n * s - s - n + 2))
                      / (n * s * (n + s) * (2 * s - 1)) / t1 + n * (2 * n - 1) / (2 * (n + 1)) * t1)
            pv = w * n * (4 * n * n - 1) / (2 * (n + 1) * (2 * s + 1)) * t2 ** 2 / t1
            pq = -w * 2 * (4 * n * n - 1) / (3 * (n + 1)) * t2 / t1
            vp = w * 2 * n / ((n + 1) * (2 * n + 3)) * t1
            qq = w * s / (n + 1) * t2
            qp = -w * 3 / (2 * n * s * (n + 1))
            blocks.append([[pp, pv, pq], [pp + vp, pv, pq], [qp, zero, qq]])
    m12, m21 = (np.vstack([np.hstack(r) for r in b]) for b in blocks)
    k = len(m12)
    starts = {"XA": [[0, n_max]], "XC": [[0]], "Y": [[0, n_max], [2 * n_max]]}[kind]
    rhs = np.zeros((2 * k, len(starts)), LD)
    for col, rows in enumerate(starts):
        rhs[rows, col] = 1
    eye = np.eye(k, dtype=LD)
    c = solve(np.vstack([np.hstack([eye, -m12]), np.hstack([-m21, eye])]), rhs)
    # sphere 2 has its own axis, towards sphere 1, and the turning sense changes with it
    f, t, zero = 6 * PI, 8 * PI, 0 * c[0]
    b = LD(a2)
    if kind == "XA":
        return np.array([f * c[0], zero, -f * b * c[k], zero])
    if kind == "XC":
        return np.array([zero, t * c[0], zero, -t * b ** 2 * c[k]])
    sign = np.array([1, -1], LD)
    q = 2 * n_max
    return np.array([f * c[0] * sign, -t * c[q] * sign, -f * b * c[k] * sign, -t * b ** 2 * c[k + q] * sign])


def stimson_jeffery(dist, terms=4000):
    """Equal unit spheres: drag over 6 pi when both move alike (Stimson & Jeffery 1926), and apart (Brenner 1961)."""
    al = np.arccosh(LD(dist) / 2)
    n = np.arange(1, terms + 1, dtype=LD)
    k = n * (n + 1) / ((2 * n - 1) * (2 * n + 3))
    h, e = (n + LD(0.5)) * al, 2 * n + 1
    with np.errstate(over="ignore"):
        big = h > 2000
        h = np.where(big, 2000, h)
        same = k * (1 - (4 * np.sinh(h) ** 2 - e ** 2 * np.sinh(al) ** 2) / (2 * np.sinh(2 * h) + e * np.sinh(2 * al)))
        apart = k * ((4 * np.cosh(h) ** 2 + e ** 2 * np.sinh(al) ** 2) / (2 * np.sinh(2 * h) - e * np.sinh(2 * al)) - 1)
    c = LD(4) / 3 * np.sinh(al)
    return c * same[~big].sum(), c * apart[~big].sum()
