"""Reference values of toroidal functions: tests/data/toroidal.csv.

    python3 toroidal.py > ../toroidal.csv

value = d^k/dchi^k Q_{n-1/2}(chi), diff = d^k/dchi^k (Q_{n-1/2} - Q_{n+1/2})(chi).

Method 1 (the values written): with chi = cosh(eta)
    d^k Q_{n-1/2}/dchi^k = (-2)^k sqrt(pi) Gamma(n+k+1/2)/Gamma(n+1) e^{-(n+k+1/2) eta}
                           2F1(k+1/2, n+k+1/2; n+1; e^{-2 eta}).
Method 2 (check): Q_v(chi) = int_0^inf (chi + sqrt(chi^2-1) cosh t)^{-v-1} dt by the trapezoidal rule
(the integrand is analytic in |Im t| < pi), then Legendre's equation for the derivatives.
Both must agree to 30 digits for every value written (the script stops otherwise).
Needs mpmath (gmpy2 makes it faster).
"""
import sys
from mpmath import mp, mpf, sqrt, pi, gamma, exp, acosh, hyp2f1, cosh, nstr

WORK = 80
CHI_M1 = [1e-14, 1e-10, 1e-6, 1e-4, 1e-3, 1e-2, 0.05, 0.2, 0.7, 1.5, 5.0, 100.0, 1e6]
NS = [0, 1, 2, 3, 5, 10, 20, 40, 60, 100, 300, 1000]


def by_series(n, k, x):
    """x = chi - 1, exact."""
    chi = 1 + x
    eta = 2 * mp.asinh(sqrt(x / 2))
    a, b, c = k + mpf(1) / 2, n + k + mpf(1) / 2, mpf(n + 1)
    lead = (-2) ** k * sqrt(pi) * gamma(b) / gamma(c) * exp(-b * eta)
    z = exp(-2 * eta)
    if z < mpf("0.95"):
        # plain series: all terms positive, no cancellation
        term, total, j = mpf(1), mpf(1), 0
        while True:
            term *= (a + j) * (b + j) / ((c + j) * (j + 1)) * z
            total += term
            j += 1
            if term < total * mpf(10) ** (-WORK - 3) and (a + j) * (b + j) < (c + j) * (j + 1) / z:
                return lead * total
    # c - a - b = -2k: expansion about z = 1 (Abramowitz & Stegun 15.3.10 and 15.3.12), m = 2k
    m, w = 2 * k, -mp.expm1(-2 * eta)
    a0, b0 = a - m, b - m          # F(a0 + m, b0 + m; a0 + b0 + m; z) with a + b - c = m
    # A&S 15.3.12: F(a,b;a+b-m;z), a,b the actual parameters
    out = mpf(0)
    for j in range(m):
        out += mp.rf(a - m, j) * mp.rf(b - m, j) / (mp.factorial(j) * mp.rf(1 - m, j)) * w ** j
    if m:
        out *= gamma(m) * gamma(c) / (gamma(a) * gamma(b)) * w ** (-m)
    tail, j = mpf(0), 0
    coef = mpf(1) / mp.factorial(m)
    lw = mp.log(w)
    p1, pm, pa, pb = mp.psi(0, 1), mp.psi(0, m + 1), mp.psi(0, a), mp.psi(0, b)
    small = 0
    while True:
        add = coef * (lw - p1 - pm + pa + pb)
        tail += add
        coef *= (a + j) * (b + j) / ((j + 1) * (mpf(j) + m + 1)) * w
        p1 += mpf(1) / (j + 1)
        pm += mpf(1) / (j + m + 1)
        pa += 1 / (a + j)
        pb += 1 / (b + j)
        j += 1
        small = small + 1 if abs(add) < abs(tail) * mpf(10) ** (-mp.dps) else 0
        if small > 3:
            break
    tail *= -(-1) ** m * gamma(c) / (gamma(a - m) * gamma(b - m))
    return lead * (out + tail)


def q_integral(v, x, h):
    chi, s = 1 + x, sqrt(x * (2 + x))
    peak = (chi + s) ** (-v - 1)
    total, j = peak / 2, 0
    e, ej = exp(h), mpf(1)
    while True:
        j += 1
        ej *= e
        term = (chi + s * (ej + 1 / ej) / 2) ** (-v - 1)
        total += term
        if term < total * mpf(10) ** (-60):
            return total * h


def by_integral(n, x):
    chi, d = 1 + x, x * (2 + x)
    v = n - mpf(1) / 2
    s = sqrt(d)
    # error of the trapezoidal rule: about e^{-2 pi a/h} (chi+s)^(v+1) / |chi + s cosh(ia)|^(v+1), a = 2
    a = mpf(2)
    loss = max(mpf(0), (v + 1) * mp.log((chi + s) / (chi + s * mp.cos(a))))
    h = 2 * pi * a / (60 * mp.log(10) + loss)
    q, qn = q_integral(v, x, h), q_integral(v + 1, x, h)
    out = []
    for v_, q_, other in ((v, q, None), (v + 1, qn, q)):
        if other is None:
            # (chi^2-1) Q'_v = (v+1)(Q_{v+1} - chi Q_v)
            q1 = (v_ + 1) * (qn - chi * q_) / d
        else:
            q1 = v_ * (chi * q_ - other) / d
        q2 = (v_ * (v_ + 1) * q_ - 2 * chi * q1) / d
        q3 = ((v_ * (v_ + 1) - 2) * q1 - 4 * chi * q2) / d
        out.append((q_, q1, q2, q3))
    return out


def main():
    mp.dps = WORK
    print("# Toroidal functions. Origin: tests/data/scripts/toroidal.py (mpmath, 80 digits, two methods).")
    print("# value = d^k/dchi^k Q_{n-1/2}(chi); diff = d^k/dchi^k (Q_{n-1/2} - Q_{n+1/2})(chi); chi = 1 + chi_minus_1,")
    print("# chi_minus_1 the exact double. No (-1)^m anywhere: Q^m_{n-1/2} := (chi^2-1)^{m/2} d^m Q_{n-1/2}/dchi^m has")
    print("# sign (-1)^m, the same as Hobson's and mpmath.legenq(n-1/2, m, chi, type=3). Magnitudes below 1e-300 left out.")
    print("chi_minus_1,n,k,value,diff")
    worst = mpf(0)
    for xf in CHI_M1:
        x = mpf(xf)
        for n in NS:
            mp.dps = WORK + 20
            chk = None
            for k in range(4):
                v, v1 = by_series(n, k, x), by_series(n + 1, k, x)
                if abs(v) < mpf(10) ** -300:
                    continue
                if chk is None:
                    chk = by_integral(n, x)
                w, w1 = chk[0][k], chk[1][k]
                err = max(abs(v / w - 1), abs((v - v1) / (w - w1) - 1))
                worst = max(worst, err)
                if err > mpf(10) ** -30:
                    sys.exit(f"methods disagree: {xf} {n} {k} {nstr(v, 25)} {nstr(w, 25)} {nstr(err, 3)}")
                print(f"{xf!r},{n},{k},{nstr(v, 20, min_fixed=0, max_fixed=0)},{nstr(v - v1, 20, min_fixed=0, max_fixed=0)}")
    print("largest disagreement", nstr(worst, 3), file=sys.stderr)


if __name__ == "__main__":
    main()
