"""Spheroids and spheres in Stokes flow by exterior spheroidal harmonics, viscosity 1, double precision.

Papkovich-Neuber: u = grad(x . B) - 2 B with harmonic B about each body's centre (Happel & Brenner 1973, section 3-3; a fourth
harmonic function is not needed outside a star-shaped body). B = sum of Q_n^m(xi) P_n^m(eta) cos, sin(m phi), n <= N, in the body's
spheroidal coordinates (spheres: r^-n-1). No slip by least squares with the area as weight, at Gauss-Legendre x uniform points.
Force and torque on the fluid from the monopole and the antisymmetric dipole of B: B ~ -F/(8 pi r), B_k ~ D_ki x_i/r^3 with
T_l = -8 pi eps_lik D_ki. Second method: Stokeslets on a confocal surface inside (`stokeslets`).
"""
import numpy as np
from scipy.linalg import lstsq, solve_triangular


class Body:
    """polar and equatorial semi-axes, centre, unit vector of the axis."""

    def __init__(self, polar, equatorial, centre, axis=(0.0, 0.0, 1.0)):
        self.p, self.e, self.x = polar, equatorial, np.array(centre, float)
        k = np.array(axis, float)
        k /= np.linalg.norm(k)
        t = np.eye(3)[np.argmin(np.abs(k))] if abs(k[2]) < 1 else np.array([1.0, 0, 0])
        i = t - k * (k @ t)
        i /= np.linalg.norm(i)
        self.frame = np.array([i, np.cross(k, i), k])  # rows: body axes
        self.c = np.sqrt(abs(polar ** 2 - equatorial ** 2))

    def points(self, n_eta, n_phi, shift=0.5):
        """Points, square roots of the area weights."""
        eta, w = np.polynomial.legendre.leggauss(n_eta)
        phi = (np.arange(n_phi) + shift) * 2 * np.pi / n_phi
        h, f = (v.ravel() for v in np.meshgrid(eta, phi, indexing="ij"))
        s = np.sqrt(1 - h * h)
        x = np.stack([self.e * s * np.cos(f), self.e * s * np.sin(f), self.p * h], 1)
        area = self.e * np.sqrt(self.p ** 2 * s * s + self.e ** 2 * h * h) * np.repeat(w, n_phi) * 2 * np.pi / n_phi
        return self.x + x @ self.frame, np.sqrt(area)

    def harmonics(self, pts, n_max, m_max):
        """Values and gradients (laboratory frame) of the exterior harmonics n <= N, m <= M, about 1 on the surface."""
        y = (pts - self.x) @ self.frame.T
        w = np.hypot(y[:, 0], y[:, 1])
        z, c = y[:, 2], self.c
        kind = np.sign(self.p - self.e)
        if kind == 0:
            xi = np.sqrt(w * w + z * z)
            eta = z / xi
            dxi, deta = np.stack([w, z]) / xi, np.stack([-w * eta, xi * (1 - eta ** 2)]) / xi ** 2
            x0 = self.p
        else:
            # w^2 = c^2 (xi^2 - kind)(1 - eta^2), z = c xi eta
            q = w * w + z * z + kind * c * c
            root = np.sqrt((w * w + z * z - c * c) ** 2 + 4 * c * c * (w * w if kind > 0 else z * z))
            xi2 = (q + root) / (2 * c * c)
            xi = np.sqrt(xi2)
            eta = np.clip(z / (c * xi), -1, 1)
            den = c * c * (xi2 - kind * eta ** 2)
            dxi = np.stack([w * xi, c * eta * (xi2 - kind)]) / den
            deta = np.stack([-w * eta, c * xi * (1 - eta ** 2)]) / den
            x0 = self.p / c
        s = np.sqrt(np.maximum(1 - eta ** 2, 0))
        cp, sp = y[:, 0] / w, y[:, 1] / w
        count = sum((n_max + 1 - m) * (2 if m else 1) for m in range(m_max + 1))
        val = np.empty((len(pts), count))
        grad = np.empty((3, len(pts), count))
        index = {}
        col = 0
        cm, sm = np.ones_like(w), np.zeros_like(w)
        for m in range(m_max + 1):
            radial, dradial = radial_functions(xi, x0, m, n_max, kind)
            p, dp = legendre(eta, s, m, n_max)
            for n in range(m, n_max + 1):
                r, dr = radial[n - m], dradial[n - m]
                f, g = p[n - m], dp[n - m]
                base = r * f
                dw = dr * f * dxi[0] + r * g * deta[0]
                dz = dr * f * dxi[1] + r * g * deta[1]
                for t, dt in ((cm, -m * sm), (sm, m * cm)):
                    if m == 0 and t is sm:
                        continue
                    index[(n, m, 0 if t is cm else 1)] = col
                    val[:, col] = base * t
                    local = np.stack([dw * t * cp - base * dt * sp / w, dw * t * sp + base * dt * cp / w, dz * t])
                    grad[:, :, col] = self.frame.T @ local
                    col += 1
            cm, sm = cm * cp - sm * sp, sm * cp + cm * sp
        self.index = index
        return val, grad

    def fields(self, pts, n_max, m_max):
        """Velocities (3 points) x (3 harmonics): component j of the point times component k of B; x_k d_j h - delta_jk h."""
        val, grad = self.harmonics(pts, n_max, m_max)
        y = pts - self.x
        a = np.empty((3, len(pts), 3, val.shape[1]))
        for j in range(3):
            for k in range(3):
                a[j, :, k] = y[:, k, None] * grad[j]
                if j == k:
                    a[j, :, k] -= val
        return a.reshape(3 * len(pts), -1)

    def moments(self, coef):
        """Force and torque on the fluid from the coefficients (3 harmonics) x columns."""
        b = coef.reshape(3, len(self.index), -1)
        mono, dip_z, dip_x = self.far()
        force = -8 * np.pi * mono * b[:, self.index[(0, 0, 0)]]
        # D_ki in body axes i, then laboratory
        d = np.stack([dip_x * b[:, self.index[(1, 1, 0)]], dip_x * b[:, self.index[(1, 1, 1)]],
                      dip_z * b[:, self.index[(1, 0, 0)]]], 1)
        d = np.einsum("kbs,bi->kis", d, self.frame)
        torque = -8 * np.pi * np.stack([d[2, 1] - d[1, 2], d[0, 2] - d[2, 0], d[1, 0] - d[0, 1]])
        return force, torque

    def far(self):
        """Factors of 1/r, z/r^3, x/r^3 far away of the harmonics (0, 0), (1, 0), (1, 1)."""
        kind = np.sign(self.p - self.e)
        x0 = self.p if kind == 0 else self.p / self.c
        if kind == 0:
            a = self.p
            return a * np.sqrt(0.5), a ** 2 * np.sqrt(1.5), a ** 2 * np.sqrt(0.75)
        # Q_0, Q_1, Q_1^1 in closed form at x0; their limits are 1/xi, 1/(3 xi^2), 2/(3 xi^2) with P_1^1 = s
        if kind > 0:
            q0 = np.arctanh(1 / x0)
            q1 = x0 * q0 - 1
            q11 = np.sqrt(x0 * x0 - 1) * (x0 / (x0 * x0 - 1) - q0)
        else:
            q0 = np.arctan(1 / x0)
            q1 = 1 - x0 * q0
            q11 = np.sqrt(x0 * x0 + 1) * (q0 - x0 / (x0 * x0 + 1))
        c = self.c
        return c / q0 * np.sqrt(0.5), c ** 2 / (3 * q1) * np.sqrt(1.5), c ** 2 * 2 / (3 * q11) * np.sqrt(0.75)


def radial_functions(xi, x0, m, n_max, kind):
    """Q_n^m(xi)/Q_n^m(x0) and derivative, n = m..N; kind 1 prolate, -1 oblate (argument i xi), 0 sphere (x0/xi)^(n+1).

    Ratios Q_{n+1}/Q_n by downward recurrence, the size from the Casoratian with P_n^m.
    """
    if kind == 0:
        n = np.arange(m, n_max + 1)[:, None]
        v = (x0 / xi[None]) ** (n + 1)
        return v, -(n + 1) * v / xi
    top = n_max + 80
    both = np.append(xi, x0)
    ratio = np.zeros((n_max - m + 1, len(both)))
    r = np.zeros_like(both)
    for n in range(top, m, -1):
        r = (n + m) / ((2 * n + 1) * both - kind * (n - m + 1) * r)  # Q_n / Q_{n-1}
        if n - 1 <= n_max:
            ratio[n - 1 - m] = r
    p_old, p = np.zeros_like(both), (both ** 2 - kind) ** (m / 2)
    v, d = np.empty((n_max - m + 1, len(xi))), np.empty((n_max - m + 1, len(xi)))
    for n in range(m, n_max + 1):
        p_new = ((2 * n + 1) * both * p - kind * (n + m) * p_old) / (n - m + 1)
        size = p_new - kind * ratio[n - m] * p
        v[n - m] = size[-1] / size[:-1]
        d[n - m] = v[n - m] * (kind * (n - m + 1) * ratio[n - m, :-1] - (n + 1) * xi) / (xi ** 2 - kind)
        p_old, p = p, p_new
    return v, d


def legendre(eta, s, m, n_max):
    """Normalised P_n^m(eta) (positive) and derivative, n = m..N."""
    # norm: P_0 = sqrt(1/2), P_1 = sqrt(3/2) eta, P_1^1 = sqrt(3/4) s
    pmm = np.full_like(eta, np.sqrt(0.5))
    for k in range(1, m + 1):
        pmm = pmm * s * np.sqrt((2 * k + 1) / (2 * k))
    p = [pmm]
    for n in range(m + 1, n_max + 1):
        a = np.sqrt((4 * n * n - 1) / (n * n - m * m))
        b = np.sqrt(((n - 1) ** 2 - m * m) / (4 * (n - 1) ** 2 - 1)) if n > m + 1 else 0
        p.append(a * (eta * p[-1] - (b * p[-2] if n > m + 1 else 0)))
    d = []
    for n in range(m, n_max + 1):
        # (1 - x^2) P' = (n + m) P_{n-1} - n x P_n, with the norms
        low = np.sqrt((n * n - m * m) * (2 * n + 1) / (2 * n - 1)) * p[n - m - 1] if n > m else 0
        d.append((low - n * eta * p[n - m]) / np.maximum(s * s, 1e-300))
    return p, d


def rigid(body, pts):
    """Six rigid motions about the body's centre at the points, (3 points) x 6."""
    y = pts - body.x
    out = np.zeros((3, len(pts), 6))
    for k in range(3):
        out[k, :, k] = 1
        e = np.zeros(3)
        e[k] = 1
        out[:, :, 3 + k] = np.cross(e, y).T
    return out.reshape(-1, 6)


def resistance(bodies, n_max, m_max=None, over=1.25, extra=8):
    """Grand resistance matrix (velocities, angular velocities of body 1, 2, ... to forces, torques), residual, condition.

    m_max: for bodies on one axis 2 is enough, B being in Cartesian components. The residual is the largest error of the velocity
    on points between those of the least squares.
    """
    mm = n_max if m_max is None else m_max
    n_eta, n_phi = int(over * n_max) + extra, 2 * mm + 14
    mats, rhs = [], []
    for j, b in enumerate(bodies):
        pts, w = b.points(n_eta, n_phi)
        w3 = np.tile(w, 3)[:, None]
        mats.append(w3 * np.hstack([o.fields(pts, n_max, mm) for o in bodies]))
        r = np.zeros((3 * len(pts), 6 * len(bodies)))
        r[:, 6 * j:6 * j + 6] = w3 * rigid(b, pts)
        rhs.append(r)
    a, b = np.vstack(mats), np.vstack(rhs)
    del mats
    scale = np.linalg.norm(a, axis=0)
    a /= scale
    t = np.linalg.qr(np.hstack([a, b]), mode="r")
    k = a.shape[1]
    del a
    x = solve_triangular(t[:k, :k], t[:k, k:]) / scale[:, None]
    d = np.abs(np.diag(t))[:k]
    worst = 0
    for j, o in enumerate(bodies):
        pts, _ = o.points(n_max + 11, 2 * mm + 9, 0.2)
        u = np.hstack([p.fields(pts, n_max, mm) for p in bodies]) @ x
        u[:, 6 * j:6 * j + 6] -= rigid(o, pts)
        worst = max(worst, np.abs(u).max())
    out = []
    for o, c in zip(bodies, np.split(x, len(bodies))):
        out += o.moments(c)
    return np.vstack(out), worst, d.max() / d.min()


def inside(b, f):
    """Semi-axes of the confocal surface: xi1 - 1 (prolate), zeta1 (oblate), radius (sphere) a fraction f of the body's."""
    if b.p > b.e:
        x1 = 1 + f * (b.p / b.c - 1)
        return b.c * x1, b.c * np.sqrt(x1 * x1 - 1)
    return f * b.p, np.sqrt(b.c ** 2 + (f * b.p) ** 2)


def stokeslet(pts, y):
    """Components (3, points, 3, sources)."""
    d = pts[:, None] - y[None]
    r = np.sqrt((d * d).sum(2))
    a = np.empty((3, len(pts), 3, len(y)))
    for j in range(3):
        for k in range(3):
            a[j, :, k] = d[:, :, j] * d[:, :, k] / r ** 3 + (1 / r if j == k else 0)
    return a / (8 * np.pi)


def stokeslets(bodies, inner, count, over=1.7):
    """The same by `count` Stokeslets on a spiral on confocal surfaces inside, least squares on another spiral."""
    golden = np.pi * (3 - np.sqrt(5))

    def spread(b, p, e, n):
        i = np.arange(n)
        h = 1 - (2 * i + 1) / n
        s = np.sqrt(1 - h * h)
        return b.x + np.stack([e * s * np.cos(golden * i), e * s * np.sin(golden * i), p * h], 1) @ b.frame

    sources = [spread(b, *inside(b, f), count) for b, f in zip(bodies, inner)]
    y = np.vstack(sources)

    def system(n):
        points = [spread(b, b.p, b.e, n) for b in bodies]
        v = np.zeros((3, n * len(bodies), 6 * len(bodies)))
        for j, (b, p) in enumerate(zip(bodies, points)):
            v[:, n * j:n * j + n, 6 * j:6 * j + 6] = rigid(b, p).reshape(3, n, 6)
        return stokeslet(np.vstack(points), y).reshape(3 * n * len(bodies), -1), v.reshape(-1, v.shape[2])

    a, v = system(int(over * count))
    x = lstsq(a, v, cond=1e-15, lapack_driver="gelsy", overwrite_a=True)[0]
    a, v = system(int(1.37 * over * count))
    worst = np.abs(a @ x - v).max()
    out = []
    for b, s, f in zip(bodies, sources, np.split(x.reshape(3, len(y), -1), len(bodies), 1)):
        q = s - b.x
        torque = [q[:, 1] @ f[2] - q[:, 2] @ f[1], q[:, 2] @ f[0] - q[:, 0] @ f[2], q[:, 0] @ f[1] - q[:, 1] @ f[0]]
        out += [f.sum(1), np.stack(torque)]
    return np.vstack(out), worst


def rings(bodies, inner, n, m, n_phi=200):
    """Bodies on the z axis by n rings of Stokeslets each on confocal surfaces inside, azimuthal order m = 0 or 1.

    m = 0: forces z of unit velocities z, then torques z of angular velocities z; m = 1: forces x, torques y against velocities x,
    angular velocities y, body by body. Strengths (f_r cos, f_phi sin, f_z cos)(m phi); m = 0: f_r, f_z and swirl f_phi apart.
    """
    t = np.arange(n_phi) * 2 * np.pi / n_phi
    ct, st = np.cos(t), np.sin(t)
    nodes = [np.polynomial.legendre.leggauss(k)[0] for k in (n, 2 * n, 2 * n + 7)]
    src = []
    for b, f in zip(bodies, inner):
        p, e = inside(b, f)
        src.append(np.stack([e * np.sqrt(1 - nodes[0] ** 2), b.x[2] + p * nodes[0]], 1))
    src = np.vstack(src)
    y = np.stack([np.outer(src[:, 0], ct), np.outer(src[:, 0], st), np.outer(src[:, 1], 1 + 0 * t)], 2).reshape(-1, 3)

    def system(h):
        """Rows u_r, u_z at phi = 0, u_phi at phi = pi/2 (m = 1) or 0; columns f_r, f_phi, f_z of each ring; and the motions."""
        rows, v = [], []
        for j, b in enumerate(bodies):
            s = np.sqrt(1 - h * h)
            r, z, o = b.e * s, b.p * h, 0 * h
            zero = np.stack([r, o, b.x[2] + z], 1)
            side = zero if m == 0 else np.stack([o, r, b.x[2] + z], 1)
            g = [stokeslet(q, y).reshape(3, len(h), 3, len(src), n_phi) for q in (zero, side)]
            cm, sm = (1 + 0 * t, 1 + 0 * t) if m == 0 else (ct, st)

            def cyl(a):
                parts = [(a[:, 0] * ct + a[:, 1] * st) @ cm, (a[:, 1] * ct - a[:, 0] * st) @ sm, a[:, 2] @ cm]
                return np.stack(parts, 1).reshape(len(h), -1) / n_phi

            u = [cyl(g[0][0]), cyl(g[1][1] if m == 0 else -g[1][0]), cyl(g[0][2])]
            w = np.zeros((3, len(h), 2 * len(bodies)))
            if m == 0:
                w[2, :, 2 * j], w[1, :, 2 * j + 1] = 1, r
            else:
                # e_x: (cos, -sin, 0); e_y x y: (z cos, -z sin, -r cos)
                w[0, :, 2 * j], w[1, :, 2 * j] = 1, -1
                w[0, :, 2 * j + 1], w[1, :, 2 * j + 1], w[2, :, 2 * j + 1] = z, -z, -r
            rows.append(np.vstack(u))
            v.append(w.reshape(3 * len(h), -1))
        return np.vstack(rows), np.vstack(v)

    a, v = system(nodes[1])
    x = lstsq(a, v, cond=1e-16, lapack_driver="gelsd")[0]
    a2, v2 = system(nodes[2])
    worst = np.abs(a2 @ x - v2).max()
    f = x.reshape(3, len(bodies), n, -1)
    out = []
    for j, b in enumerate(bodies):
        r, z = src[j * n:(j + 1) * n, 0], src[j * n:(j + 1) * n, 1] - b.x[2]
        fr, fp, fz = f[:, j]
        if m == 0:
            out += [fz.sum(0), r @ fp]
        else:
            # averages over the ring: F_x = (f_r - f_phi)/2, T_y = z F_x - x F_z = z (f_r - f_phi)/2 - r f_z / 2
            out += [(fr - fp).sum(0) / 2, z @ (fr - fp) / 2 - r @ fz / 2]
    return np.array(out), worst
