"""Resistance of spheroids: tests/data/resistance_spheroid.csv.

    python3 resistance_spheroid.py > ../resistance_spheroid.csv

Closed forms: Chwang & Wu 1975 (J. Fluid Mech. 67, 787), Kim & Karrila 1991, Microhydrodynamics, tables 3.4 (prolate)
and 3.6 (oblate). Check, to 40 digits (the script stops otherwise): Oberbeck's and Jeffery's ellipsoid integrals by quadrature.
"""
import sys
from mpmath import mp, mpf, sqrt, pi, log, asin, quad, nstr, inf

mp.dps = 70


def closed(c, b):
    """polar semi-axis c, equatorial b: X^A, Y^A, X^C, Y^C."""
    if c == b:
        return [mpf(1)] * 4
    if c > b:
        e = sqrt((c - b) * (c + b)) / c
        L, f = log((1 + e) / (1 - e)), 1 - e * e
        return [8 * e**3 / 3 / ((1 + e * e) * L - 2 * e), 16 * e**3 / 3 / (2 * e + (3 * e * e - 1) * L),
                4 * e**3 / 3 * f / (2 * e - f * L), 4 * e**3 / 3 * (2 - e * e) / ((1 + e * e) * L - 2 * e)]
    e = sqrt((b - c) * (b + c)) / b
    C, s = asin(e), sqrt(1 - e * e)
    return [4 * e**3 / 3 / ((2 * e * e - 1) * C + e * s), 8 * e**3 / 3 / ((2 * e * e + 1) * C - e * s),
            2 * e**3 / 3 / (C - e * s), 2 * e**3 / 3 * (2 - e * e) / (e * s - (1 - 2 * e * e) * C)]


def integrals(c, b):
    """Force along and across, torque about and across the axis for mu = 1, by quadrature."""
    # lambda = u^2 keeps the integrand smooth; Delta = (b^2 + u^2) sqrt(c^2 + u^2)
    cuts = sorted({mpf(0), b / 2, c / 2, b, c, 3 * b, 3 * c, 20 * max(b, c)}) + [inf]
    cuts = sorted(set(cuts))
    root = lambda u: sqrt(c * c + u * u)
    chi = quad(lambda u: 2 * u / ((b * b + u * u) * root(u)), cuts)
    ap = quad(lambda u: 2 * u / ((b * b + u * u) * root(u) ** 3), cuts)
    ae = quad(lambda u: 2 * u / ((b * b + u * u) ** 2 * root(u)), cuts)
    return [16 * pi / (chi + c * c * ap), 16 * pi / (chi + b * b * ae), 16 * pi / (3 * ae),
            16 * pi * (b * b + c * c) / (3 * (b * b * ae + c * c * ap))]


print("# Resistance of spheroids, viscosity 1. Origin: tests/data/scripts/resistance_spheroid.py (mpmath, 70 digits; closed forms of")
print("# Chwang & Wu 1975 and Kim & Karrila 1991 tables 3.4, 3.6, checked to 40 digits against Oberbeck's and Jeffery's integrals).")
print("# amax = max(polar, equatorial), semi-axes as exact doubles. Force and torque ON THE FLUID (by the body on the fluid):")
print("# force_along = 6 pi amax xa, force_across = 6 pi amax ya per unit velocity along / across the axis;")
print("# torque_along = 8 pi amax^3 xc, torque_across = 8 pi amax^3 yc per unit angular velocity about / across the axis, about the centre.")
print("polar,equatorial,xa,ya,xc,yc,force_along,force_across,torque_along,torque_across")
worst = mpf(0)
rows = [(1.0, q) for q in (100.0, 10.0, 2.0, 1.0, 0.5, 0.1, 0.01)] + [(q, 1.0) for q in (0.01, 0.1, 0.5, 2.0, 10.0, 100.0)]
for cf, bf in rows:
    c, b = mpf(cf), mpf(bf)
    big = max(c, b)
    k = closed(c, b)
    plain = [6 * pi * big * k[0], 6 * pi * big * k[1], 8 * pi * big**3 * k[2], 8 * pi * big**3 * k[3]]
    for u, v in zip(plain, integrals(c, b)):
        worst = max(worst, abs(u / v - 1))
        if abs(u / v - 1) > mpf(10) ** -40:
            sys.exit(f"disagree at {cf} {bf}: {nstr(u, 30)} {nstr(v, 30)}")
    print(",".join([repr(cf), repr(bf)] + [nstr(v, 20) for v in k + plain]))
print("largest disagreement", nstr(worst, 3), file=sys.stderr)
