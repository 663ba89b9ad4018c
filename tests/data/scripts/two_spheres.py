"""Resistance of two spheres: tests/data/two_spheres_resistance.csv (plain) and two_spheres_functions.csv (normalised).

    python3 two_spheres.py plain > ../two_spheres_resistance.csv
    python3 two_spheres.py functions > ../two_spheres_functions.csv

Methods in multipoles.py. The script stops when methods A and B, or A with N and 4/3 N, or (equal spheres) A and the series of
Stimson & Jeffery 1926 and Brenner 1961 differ by more than 1e-14 of the value, or the matrix (force, torque, stresslet against
velocity, angular velocity, strain) is asymmetric by more than 1e-14 of its largest entry.
"""
import sys
import numpy as np
from multipoles import Chain, twin, stimson_jeffery, PI, LD

CASES = [(1.0, 1.0, 4.0, 40), (1.0, 1.0, 2.5, 60), (1.0, 1.0, 2.1, 110), (1.0, 1.0, 2.01, 240), (1.0, 2.0, 3.4, 80)]
MOTIONS = ["along", "strain_zz", "across", "turn_across", "strain_xz", "turn_along"]
WORST = {}


def agree(what, u, v, scale=None, tol=1e-14):
    u, v = np.asarray(u), np.asarray(v)
    scale = np.abs(u) if scale is None else scale
    err = float(np.max(np.where(u == v, 0, np.abs(u - v)) / np.where(scale == 0, 1, scale)))
    WORST[what] = max(WORST.get(what, 0), err)
    if not err < tol:
        sys.exit(f"{what} disagree: {err}\n{u}\n{v}")


def matrices(a1, a2, d, n):
    """[motion][moved sphere][force, torque, stresslet][sphere]."""
    out = {}
    for m, swirl, names in ((0, False, MOTIONS[:2]), (1, False, MOTIONS[2:5]), (1 - 1, True, MOTIONS[5:])):
        mom = np.array(Chain([a1, a2], [0, d], n, m, swirl).moments())
        for i, name in enumerate(names):
            out[name] = [mom[:, :, i], mom[:, :, len(names) + i]]
    return out


def case(a1, a2, d, n):
    r = matrices(a1, a2, d, n)
    fine = matrices(a1, a2, d, 4 * n // 3)
    for name in MOTIONS:
        agree("N and 4/3 N", r[name], fine[name])
    for b1, b2, first, mirror in ((a1, a2, 0, 1), (a2, a1, 1, -1)):
        # sphere `first` moving, scaled to radius 1; seen from sphere 2 the axis is turned about y: u_x -> -u_x, Omega_y kept
        o = 1 - first
        for kind, names in (("XA", ["along"]), ("XC", ["turn_along"]), ("Y", ["across", "turn_across"])):
            t = twin(1, LD(b2) / b1, LD(d) / b1, n, kind)
            for col, name in enumerate(names):
                turn = name.startswith("turn")
                f, q = LD(b1) ** (2 if turn else 1), LD(b1) ** (3 if turn else 2)
                flip = mirror if kind == "Y" else 1
                w = np.array([[0, 0], [0, 0]], LD)
                w[0, first], w[1, first], w[0, o], w[1, o] = t[:, col] * np.array([f, q, f, q])
                if kind == "Y":
                    w[1 if not turn else 0] *= flip
                agree("A and B", r[name][first][:2], w)
    scale = max(np.abs(np.array(v)).max() for v in r.values())
    kind = {"along": 0, "across": 0, "turn_along": 1, "turn_across": 1, "strain_zz": 2, "strain_xz": 2}
    # E : S: strain_zz 3/2 S_zz, strain_xz 2 S_xz
    weight = {"strain_xz": 2}
    for group in (MOTIONS[:2], MOTIONS[2:5], MOTIONS[5:]):
        for p in group:
            for q in group:
                for i in (0, 1):
                    for j in (0, 1):
                        agree("symmetry", r[p][i][kind[q], j] * weight.get(q, 1), r[q][j][kind[p], i] * weight.get(p, 1), scale)
    if a1 == a2 == 1:
        same, apart = stimson_jeffery(d)
        x = r["along"][0][0] / (6 * PI)
        agree("A and Stimson & Jeffery, Brenner", [x.sum(), x[0] - x[1]], [same, apart])
    return r


def functions(a, r):
    """Names as Jeffrey & Onishi 1984, Jeffrey 1992; index 1 of the motion's sphere last."""
    out = {}
    for i in (0, 1):
        for j in (0, 1):
            s = (LD(a[i]) + LD(a[j])) / 2
            w = f"{i + 1}{j + 1}"
            out["xa" + w] = r["along"][j][0, i] / (6 * PI * s)
            out["ya" + w] = r["across"][j][0, i] / (6 * PI * s)
            out["yb" + w] = -r["across"][j][1, i] / (4 * PI * s ** 2)
            out["xc" + w] = r["turn_along"][j][1, i] / (8 * PI * s ** 3)
            out["yc" + w] = r["turn_across"][j][1, i] / (8 * PI * s ** 3)
            out["xg" + w] = r["along"][j][2, i] / (4 * PI * s ** 2)
            out["yg" + w] = r["across"][j][2, i] / (4 * PI * s ** 2)
            out["yh" + w] = r["turn_across"][j][2, i] / (8 * PI * s ** 3)
    return out


def show(v):
    return np.format_float_scientific(v, precision=16, unique=False) if v != 0 else "0"


if __name__ == "__main__":
    plain = sys.argv[1] == "plain"
    script = "tests/data/scripts/two_spheres.py (multipoles in 64-bit mantissa; two methods agree to 1e-14 of the value)"
    lines = []
    for a1, a2, d, n in CASES:
        r = case(a1, a2, d, n)
        if plain:
            for name in MOTIONS:
                for j in (0, 1):
                    v = r[name][j]
                    st = [v[2, i] * (LD(2) / 3 if name in MOTIONS[:2] else 1) for i in (0, 1)]
                    vals = [v[0, 0], v[1, 0], st[0], v[0, 1], v[1, 1], st[1]]
                    lines.append(",".join([repr(a1), repr(a2), repr(d), name, str(j + 1)] + [show(x) for x in vals]))
        else:
            f = functions((a1, a2), r)
            lines.append(",".join([repr(a1), repr(a2), repr(d)] + [show(x) for x in f.values()]))
            head = ",".join(f)
    if plain:
        print(f"""# Two spheres, viscosity 1. Origin: {script}.
# Sphere 1 (radius a1) at the origin, sphere 2 (radius a2) at z = distance. `moving` has the unit motion, the other is held:
# along: velocity e_z; across: velocity e_x; turn_along: angular velocity e_z; turn_across: angular velocity e_y;
# strain_zz, strain_xz: its surface moves with E (x - centre), E = diag(-1/2, -1/2, 1), and E_xz = E_zx = 1 (the disturbance of
# spheres held in the flow -E (x - centre) on that sphere). Force, torque ON THE FLUID, about each sphere's own centre, components:
# along, strain_zz: force z, stresslet S_zz (S = diag(-1/2, -1/2, 1) S_zz); across, turn_across, strain_xz: force x, torque y,
# stresslet S_xz = S_zx; turn_along: torque z. Stresslet: symmetric traceless first moment of the force on the fluid; in the rows
# strain_* the far-field one (double layer included: one sphere alone gives 20/3 pi a^3 E). 0 means exactly zero.
a1,a2,distance,motion,moving,force1,torque1,stresslet1,force2,torque2,stresslet2""")
    else:
        print(f"""# Two spheres: normalised resistance functions. Origin: {script}.
# d = e_z from sphere 1 (radius a1) to sphere 2 (radius a2), s = (a_i + a_j)/2. Definitions (i: the
# sphere whose force on the fluid is taken, j: the moving one, the other held), viscosity 1:
# F_i = 6 pi s xa_ij U_z e_z, 6 pi s ya_ij U_x e_x; T_i = 4 pi s^2 yb_ij (U x d) for U across [T_y = -4 pi s^2 yb_ij U_x];
# T_i = 8 pi s^3 xc_ij Omega_z e_z, 8 pi s^3 yc_ij Omega_y e_y; S_i = 4 pi s^2 xg_ij U_z (dd - I/3), S_xz = 4 pi s^2 yg_ij U_x,
# S_xz = 8 pi s^3 yh_ij Omega_y. These are the normalisations of Jeffrey & Onishi 1984 (A, B, C) and Jeffrey 1992 (G, H).
a1,a2,distance,{head}""")
    print("\n".join(lines))
    print(WORST, file=sys.stderr)
