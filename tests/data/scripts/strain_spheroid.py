"""Spheroids in strain, held and free: tests/data/strain_spheroid.csv.

    python3 strain_spheroid.py > ../strain_spheroid.csv

Closed forms: Kim & Karrila 1991, Microhydrodynamics, table 3.4 (prolate); oblate spheroids by continuation to an imaginary
eccentricity in complex arithmetic. Checks, to 40 digits (the script stops otherwise): the functions of the free spheroid against
Jeffery's ellipsoid integrals (Jeffery 1922) by quadrature; its Bretherton constant 2 Y^H / Y^C against Jeffery's
(c^2 - b^2) / (c^2 + b^2); the intrinsic viscosity against the sum over Jeffery's integrals that Simha (1940) averaged. And: all
are those of the sphere in its limit, and with Brownian rotation the viscosities are those printed by Mehl, Oncley & Simha (1940,
Science 92, 132) and Scheraga (1955, J. Chem. Phys. 23, 1526) to their last digit.
"""
import sys
from mpmath import mp, mpf, mpc, sqrt, pi, log, quad, nstr, inf

mp.dps = 70


def closed(c, b):
    """Polar semi-axis c, equatorial b, viscosity 1: X^M, Y^M, Z^M, Y^H, Y^C as dimensional tensors have them."""
    e = sqrt(mpc((c - b) * (c + b))) / c
    L, e2 = log((1 + e) / (1 - e)), e * e
    x = mpf(8) / 15 * e**5 / ((3 - e2) * L - 6 * e)
    y = mpf(4) / 5 * e**5 * (2 * e * (1 - 2 * e2) - (1 - e2) * L) / (
        (2 * e * (2 * e2 - 3) + 3 * (1 - e2) * L) * (-2 * e + (1 + e2) * L))
    z = mpf(16) / 5 * e**5 * (1 - e2) / (3 * (1 - e2)**2 * L - 2 * e * (3 - 5 * e2))
    yh = mpf(4) / 3 * e**5 / (-2 * e + (1 + e2) * L)
    yc = mpf(4) / 3 * e**3 * (2 - e2) / (-2 * e + (1 + e2) * L)
    for v in (x, y, z, yh, yc):
        if abs(v.imag) > mpf(10)**-50 * abs(v):
            sys.exit("not real")
    m, h, t = 20 * pi / 3 * c**3, 4 * pi * c**3, 8 * pi * c**3
    return [m * x.real, m * y.real, m * z.real, h * yh.real, t * yc.real]


def jeffery(c, b):
    """alpha', beta', alpha'', beta'' of Jeffery (1922), axis 1 the axis of symmetry, by quadrature with lambda = u^2."""
    cuts = sorted({mpf(0), b / 2, c / 2, b, c, 3 * b, 3 * c, 20 * max(b, c)}) + [inf]
    over = lambda power, i, j: quad(
        lambda u: 2 * u**(1 + power) / ((b * b + u * u)**(1 + i) * sqrt(c * c + u * u)**(1 + 2 * j)), cuts)
    return [over(0, 2, 0), over(0, 1, 1), over(2, 2, 0), over(2, 1, 1)]


def agree(what, u, v, tol=mpf(10)**-40):
    if abs(u / v - 1) > tol:
        sys.exit(f"{what}: {nstr(u, 30)} {nstr(v, 30)}")


# Intrinsic viscosities with Brownian rotation, as printed: aspect ratio, prolate, oblate.
PRINTED = [(2, 2.91, 2.85), (3, 3.68, 3.43), (4, 4.66, 4.06), (5, 5.81, 4.71), (6, 7.10, 5.36), (8, 10.10, 6.70), (10, 13.63, 8.04)]


def functions(c, b):
    xm, ym, zm, yh, yc = closed(c, b)
    free_y = ym - 2 * yh**2 / yc
    bretherton = 2 * yh / yc
    volume = 4 * pi / 3 * b * b * c
    eta = (xm + 2 * free_y + 2 * zm) / (10 * volume)
    return [xm, ym, zm, yh, free_y, bretherton, eta, eta + bretherton**2 * yc / (10 * volume)]


for ratio, prolate, oblate in PRINTED:
    for value, printed in ((functions(mpf(ratio), mpf(1))[-1], prolate), (functions(mpf(1), mpf(ratio))[-1], oblate)):
        if abs(value - printed) > 0.0101:
            sys.exit(f"printed {ratio}: {nstr(value, 10)} {printed}")

print("# Spheroids in strain, viscosity 1, about their centres, axis along z. Origin: tests/data/scripts/strain_spheroid.py (mpmath, 70 digits;")
print("# Kim & Karrila 1991 table 3.4, oblate by continuation; checked to 40 digits against Jeffery's integrals). Semi-axes as exact doubles.")
print("# Held in E: S = (xm d0 + ym d1 + zm d2) : E and T = 2 yh d x E.d, T of the fluid on the body. Free: S = (xm d0 + free_ym d1 + zm d2) : E.")
print("# bretherton = 2 yh / Y^C; eta = (xm + 2 free_ym + 2 zm) / 10 V, eta_brownian = eta + bretherton^2 Y^C / 10 V.")
print("polar,equatorial,xm,ym,zm,yh,free_ym,bretherton,eta,eta_brownian")
for cf, bf in [(1.0, 0.05), (1.0, 0.1), (1.0, 0.25), (1.0, 0.5), (1.0, 0.9), (0.9, 1.0), (0.5, 1.0), (0.25, 1.0), (0.1, 1.0), (0.05, 1.0)]:
    c, b = mpf(cf), mpf(bf)
    values = functions(c, b)
    xm, ym, zm, yh, free_y, bretherton, eta, _ = values
    a1, b1, a2, b2 = jeffery(c, b)
    volume = 4 * pi / 3 * b * b * c
    # M, K, J, L of Simha (1940).
    m = 1 / (c * b**4 * a1)
    k = m / 2
    j = k * a2 / b2
    l = 2 / (c * b * b * (c * c + b * b) * b1)
    agree("x", xm, (8 * j + 2 * m) / 3 * volume)
    agree("y", free_y, 2 * l * volume)
    agree("z", zm, 2 * m * volume)
    agree("eta", eta, mpf(4) / 15 * (j + k - l) + mpf(2) / 3 * l + m / 3)
    agree("Bretherton", bretherton, (c * c - b * b) / (c * c + b * b))
    print(",".join([repr(cf), repr(bf)] + [nstr(v, 20) for v in values]))
near = functions(mpf(1), 1 - mpf(10)**-7)
for value, sphere in zip(near, [20 * pi / 3] * 3 + [0, 20 * pi / 3, 0, 2.5, 2.5]):
    if abs(value - sphere) > 3e-6 * 20:
        sys.exit("no sphere in the limit")
