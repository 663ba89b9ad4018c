"""Pairs of bodies: tests/data/spheroid_pairs.csv (resistance) and spheroid_pairs_mobility.csv (its inverse).

    python3 spheroid_pairs.py            # writes both files

Methods in spheroidal.py: exterior harmonics at N = 22 and 26 (bodies on one axis: 42 and 54, close 54 and 66).
Checks, the script stops otherwise: two resolutions to 5e-12 of the largest entry, symmetry to 1e-13; positive definite; single
spheroids against the closed forms; two spheres against two_spheres_resistance.csv (all but 2.01); a tilted copy of a pair on one
axis; Stokeslets inside, by rings (bodies on one axis, 5e-12) or in space (5e-6).
"""
import csv
import sys
from pathlib import Path
import numpy as np
from spheroidal import Body, resistance, rings, stokeslets

DATA = Path(__file__).resolve().parent.parent
R2 = 1 / np.sqrt(2)
CASES = {
    "side-by-side": ("two prolate spheroids 1, 0.5, axes z, second at (1.5, 0, 0)",
                     [Body(1, 0.5, (0, 0, 0)), Body(1, 0.5, (1.5, 0, 0))], None, (0.05, 0.05)),
    "end-to-end": ("two prolate spheroids 1, 0.5, axes z, second at (0, 0, 2.5)",
                   [Body(1, 0.5, (0, 0, 0)), Body(1, 0.5, (0, 0, 2.5))], 2, (0.1, 0.1)),
    "end-to-end-close": ("two prolate spheroids 1, 0.5, axes z, second at (0, 0, 2.125)",
                         [Body(1, 0.5, (0, 0, 0)), Body(1, 0.5, (0, 0, 2.125))], 2, (0.2, 0.2)),
    "oblate-sphere": ("oblate spheroid 0.5, 1, axis z, and sphere 0.7 at (0, 0, 1.6)",
                      [Body(0.5, 1, (0, 0, 0)), Body(0.7, 0.7, (0, 0, 1.6))], 2, (0.3, 0.7)),
    "general": ("prolate spheroid 1, 0.5, axis (1, 0, 1)/sqrt(2), and sphere 0.6 at (1.2, 0.7, -0.9)",
                [Body(1, 0.5, (0, 0, 0), (1, 0, 1)), Body(0.6, 0.6, (1.2, 0.7, -0.9))], None, (0.05, 0.4)),
}
AXIS = {0: [2, 5, 8, 11], 1: [0, 4, 6, 10]}


def must(what, err, tol):
    print(f"{what}: {err:.2g}", file=sys.stderr, flush=True)
    if not err < tol:
        sys.exit(f"{what}: {err} > {tol}")


def known():
    rows = [r for r in csv.DictReader(x for x in open(DATA / "resistance_spheroid.csv") if x[0] != "#")]
    for r in rows:
        p, e = float(r["polar"]), float(r["equatorial"])
        if (p, e) in ((1.0, 0.5), (0.5, 1.0)):
            for axis, m in (((0, 0, 1), 2), ((0.3, -2.0, 1.1), None)):
                body = Body(p, e, (0.3, 0.2, -0.1), axis)
                k = body.frame[2]
                got = resistance([body], 26 if m else 22, m)[0]
                kk, i = np.outer(k, k), np.eye(3)
                want = np.zeros((6, 6))
                for at, name in ((0, "force"), (3, "torque")):
                    along, across = float(r[name + "_along"]), float(r[name + "_across"])
                    want[at:at + 3, at:at + 3] = along * kk + across * (i - kk)
                must(f"single spheroid {p} {e}", np.abs(got - want).max() / np.abs(want).max(), 5e-13)
    slot = {"along": (0, 0), "turn_along": (0, 1), "across": (1, 0), "turn_across": (1, 1)}
    rows = list(csv.DictReader(x for x in open(DATA / "two_spheres_resistance.csv") if x[0] != "#"))
    for radius, distance, n in ((1, 4.0, 30), (1, 2.5, 42), (1, 2.1, 70), (2, 3.4, 60)):
        pair = [Body(1, 1, (0, 0, 0)), Body(radius, radius, (0, 0, distance))]
        got = resistance(pair, n, 2)[0]
        ring = [rings(pair, (0.5, 0.5), 50, m)[0] for m in (0, 1)] if distance == 2.5 else None
        for r in rows:
            if float(r["distance"]) == distance and float(r["a2"]) == radius and r["motion"] in slot:
                m, turn = slot[r["motion"]]
                want = np.array([float(r[k]) for k in ("force1", "torque1", "force2", "torque2")])
                col = 2 * (int(r["moving"]) - 1) + turn
                big = np.abs(want).max()
                must(f"two spheres {distance} {r['motion']}", np.abs(got[np.ix_(AXIS[m], AXIS[m])][:, col] - want).max() / big, 1e-14)
                if ring:
                    must(f"two spheres {r['motion']}, rings", np.abs(ring[m][:, col] - want).max() / big, 1e-12)


def turned(matrix, q):
    k = len(matrix) // 3
    full = np.kron(np.eye(k), q)
    return full @ matrix @ full.T


known()
out, mobility, notes = [], [], []
for label, (text, bodies, m_max, inner) in CASES.items():
    low, high = (22, 26) if m_max is None else (54, 66) if label == "end-to-end-close" else (42, 54)
    a, _, _ = resistance(bodies, low, m_max)
    b, residual, _ = resistance(bodies, high, m_max)
    big = np.abs(b).max()
    diff, asym = np.abs(a - b).max() / big, np.abs(b - b.T).max() / big
    must(f"{label}, two resolutions", diff, 5e-12)
    must(f"{label}, symmetry", asym, 1e-13)
    must(f"{label}, residual", residual, 1e-7)
    if m_max is None:
        c, worst = stokeslets(bodies, inner, 600)
        second = np.abs(b - c).max() / big
        must(f"{label}, Stokeslets in space", second, 5e-6)
    else:
        second = 0
        for m in (0, 1):
            c, worst = rings(bodies, inner, high + 10, m)
            second = max(second, np.abs(c - b[np.ix_(AXIS[m], AXIS[m])]).max() / big)
        must(f"{label}, rings of Stokeslets", second, 5e-12)
    if label == "end-to-end":
        tilt = Body(1, 1, (0, 0, 0), (1, -2, 0.7))
        copy = [Body(o.p, o.e, tilt.frame.T @ o.x, tilt.frame[2]) for o in bodies]
        t = resistance(copy, 20)[0]
        must("tilted copy", np.abs(turned(b, tilt.frame.T) - t).max() / big, 1e-11)
    b = (b + b.T) / 2
    eig = np.linalg.eigvalsh(b)
    if not eig[0] > 0:
        sys.exit(f"{label} is not positive definite: {eig}")
    zero = np.abs(b) < 2e-14 * big
    inv = np.linalg.inv(b)
    inv_a = np.linalg.inv((a + a.T) / 2)
    top = np.abs(inv).max()
    err, err_inv = max(diff, asym, 3e-15), max(np.abs(inv - inv_a).max() / top, 3e-15)
    if not np.linalg.eigvalsh(inv)[0] > 0:
        sys.exit(f"mobility of {label} is not positive definite")
    must(f"{label}, mobility times resistance", np.abs(inv @ b - np.eye(12)).max(), 1e-13)
    notes.append(f"# {label}: {text}. Residual {residual:.1g}, other method {second:.1g}.")
    for i in range(12):
        out.append(f"{label},{err:.0e},{i}," + ",".join("0" if zero[i, j] else f"{b[i, j]:.16e}" for j in range(12)))
        mobility.append(f"{label},{err_inv:.0e},{i}," + ",".join(
            "0" if abs(inv[i, j]) < 2e-14 * top else f"{inv[i, j]:.16e}" for j in range(12)))
    print(label, "eigenvalues", eig[0], eig[-1], file=sys.stderr)

COMMON = """# Bodies by polar and equatorial half axes (one number: sphere), the first at the origin, decimal inputs as exact doubles:
{notes}
# Rows and columns: {order}, x y z each,
# about each body's own centre. error: estimated error of all entries, relative to the largest entry of the matrix (difference of
# two resolutions, asymmetry, 3e-15). 0: zero by symmetry. Residual: largest error of the velocity on the surfaces; other method:
# difference from Stokeslets inside, relative to the largest entry."""
head = "label,error,row," + ",".join(f"c{j}" for j in range(12))
for name, title, order, lines in (
        ("spheroid_pairs.csv", "Resistance matrices of pairs: columns velocities, angular velocities, rows forces, torques ON THE FLUID",
         "body 1 velocity (force), body 1 angular velocity (torque), body 2 the same", out),
        ("spheroid_pairs_mobility.csv", "Mobility matrices of pairs (inverse of spheroid_pairs.csv): columns forces, torques on the fluid, rows velocities",
         "body 1 force (velocity), body 1 torque (angular velocity), body 2 the same", mobility)):
    with open(DATA / name, "w") as f:
        f.write(f"# {title}, viscosity 1.\n# Origin: tests/data/scripts/spheroid_pairs.py (exterior spheroidal harmonics, least squares, double precision).\n")
        f.write(COMMON.format(notes="\n".join(notes), order=order) + "\n" + head + "\n" + "\n".join(lines) + "\n")
