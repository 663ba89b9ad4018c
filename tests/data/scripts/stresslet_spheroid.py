"""Stresslet of spheroids held in a straining flow: tests/data/stresslet_spheroid.csv.

    python3 stresslet_spheroid.py > ../stresslet_spheroid.csv

Closed forms: Kim & Karrila 1991, Microhydrodynamics, table 3.4 (prolate); oblate spheroids by continuation to an imaginary
eccentricity in complex arithmetic. Checks, to 40 digits (the script stops otherwise): X^M and Z^M against Jeffery's ellipsoid
integrals by quadrature (their common factor is that of the sphere), and all three are 1 in the limit of a sphere.
"""
import sys
from mpmath import mp, mpf, mpc, sqrt, pi, log, quad, nstr, inf

mp.dps = 70


def closed(c, b):
    """polar semi-axis c, equatorial b: X^M, Y^M, Z^M in units of 20/3 pi mu c^3."""
    e = sqrt(mpc((c - b) * (c + b))) / c
    L, e2 = log((1 + e) / (1 - e)), e * e
    x = mpf(8) / 15 * e**5 / ((3 - e2) * L - 6 * e)
    y = mpf(4) / 5 * e**5 * (2 * e * (1 - 2 * e2) - (1 - e2) * L) / (
        (2 * e * (2 * e2 - 3) + 3 * (1 - e2) * L) * (-2 * e + (1 + e2) * L))
    z = mpf(16) / 5 * e**5 * (1 - e2) / (3 * (1 - e2)**2 * L - 2 * e * (3 - 5 * e2))
    for v in (x, y, z):
        if abs(v.imag) > mpf(10)**-50 * abs(v):
            sys.exit("not real")
    return [x.real, y.real, z.real]


def integrals(c, b):
    """S along the axis in axisymmetric strain, and across in planar strain, both of unit size: Jeffery's integrals."""
    cuts = sorted({mpf(0), b / 2, c / 2, b, c, 3 * b, 3 * c, 20 * max(b, c)}) + [inf]
    d = lambda u: (b * b + u * u) * sqrt(c * c + u * u)
    # lambda = u^2; axis 1 is the axis of symmetry
    a2 = quad(lambda u: 2 * u**3 / ((b * b + u * u)**2 * d(u)), cuts)
    b2 = quad(lambda u: 2 * u**3 / ((b * b + u * u) * (c * c + u * u) * d(u)), cuts)
    # Axisymmetric strain (1, -1/2, -1/2): A = (2 a2 + b2) / (6 (2 a2 b2 + b2^2)) = 1 / (6 b2); S = factor * A.
    # Planar strain (0, 1, -1): B = 3 b2 / (6 (2 a2 b2 + b2^2)) with beta'' = gamma'' = b2.
    along = 1 / (6 * b2)
    across = 3 * b2 / (6 * (2 * a2 * b2 + b2 * b2))
    return along, across


one = mpf(1)
reference = integrals(one, one)
print("# Stresslet of spheroids held at the centre of a straining flow E, viscosity 1: S = 20/3 pi amax^3 (X^M d0 + Y^M d1 + Z^M d2) : E.")
print("# Origin: tests/data/scripts/stresslet_spheroid.py (mpmath, 70 digits; Kim & Karrila 1991 table 3.4, oblate by continuation;")
print("# X^M, Z^M checked to 40 digits against Jeffery's integrals). amax = max(polar, equatorial), semi-axes as exact doubles.")
print("# xm: E = diag(-1, -1, 2), ym: E_xz = E_zx = 1, zm: E = diag(1, -1, 0), with the axis along z.")
print("polar,equatorial,xm,ym,zm")
for cf, bf in [(1.0, 0.1), (1.0, 0.25), (1.0, 0.5), (1.0, 0.9), (0.9, 1.0), (0.5, 1.0), (0.25, 1.0), (0.1, 1.0)]:
    c, b = mpf(cf), mpf(bf)
    big = max(c, b)
    values = [v * (c / big)**3 for v in closed(c, b)]
    found = [v / r / big**3 for v, r in zip(integrals(c, b), reference)]
    for u, v in ((values[0], found[0]), (values[2], found[1])):
        if abs(u / v - 1) > mpf(10)**-40:
            sys.exit(f"disagree at {cf} {bf}: {nstr(u, 30)} {nstr(v, 30)}")
    print(",".join([repr(cf), repr(bf)] + [nstr(v, 20) for v in values]))
if any(abs(v - 1) > mpf(10)**-6 for v in closed(one, one - mpf(10)**-7)):
    sys.exit("no sphere in the limit")
