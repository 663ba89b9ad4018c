"""Chains of equal spheres: tests/data/sphere_chains.csv.

    python3 sphere_chains.py > ../sphere_chains.csv

Method A of multipoles.py. The script stops when N and 4/3 N differ by more than 1e-14 of the value, or the matrix of forces and
torques against velocities and angular velocities is asymmetric by more than 1e-14 of its largest entry, or rings of Stokeslets
inside (spheroidal.py, double precision) give forces or torques that differ by more than 5e-12 of the largest.
"""
import sys
import numpy as np
from multipoles import Chain
from spheroidal import Body, rings
from two_spheres import agree, show, WORST

OUT = []
for count in (3, 5):
    for spacing, n in ((2.5, 45), (2.2, 66)):
        z = [spacing * (i - (count - 1) // 2) for i in range(count)]
        res = {}
        for m in (0, 1):
            u, v = (np.array(Chain([1.0] * count, z, k, m).moments()) for k in (n, 4 * n // 3))
            step = 2 + m
            mid = count // 2
            keep = {"along_all": (0, u[:, :, 0::step].sum(2), v[:, :, 0::step].sum(2)),
                    "along_middle": (0, u[:, :, mid * step], v[:, :, mid * step])} if m == 0 else {
                    "across_all": (1, u[:, :, 0::step].sum(2), v[:, :, 0::step].sum(2)),
                    "across_middle": (1, u[:, :, mid * step], v[:, :, mid * step]),
                    "turn_all": (1, u[:, :, 1::step].sum(2), v[:, :, 1::step].sum(2)),
                    "turn_middle": (1, u[:, :, mid * step + 1], v[:, :, mid * step + 1])}
            big = np.abs(u[:2]).max()
            agree("N and 4/3 N", u[:2], v[:2], big, 1e-15)
            if m == 0:
                agree("symmetry", u[0][:, 0::2], u[0][:, 0::2].T, big)
            else:
                full = np.vstack([np.hstack([u[0][:, 0::3], u[0][:, 1::3]]), np.hstack([u[1][:, 0::3], u[1][:, 1::3]])])
                agree("symmetry", full, full.T, big)
            # rings order the motions sphere by sphere: translation, rotation (m = 0: about the axis)
            ring = rings([Body(1, 1, (0, 0, v)) for v in z], [0.5 if spacing == 2.5 else 0.65] * count, n - 5, m, 128)[0]
            if m == 0:
                agree("rings", ring[::2, ::2], u[0][:, 0::2], big, 5e-12)
            else:
                for row, mom in ((0, u[0]), (1, u[1])):
                    for col in (0, 1):
                        agree("rings", ring[row::2, col::2], mom[:, col::3], big, 5e-12)
            res.update(keep)
        for name, (m, f, g) in res.items():
            for i in range(count):
                # the torque of the middle one vanishes when the motion is even, and the like
                zero = abs(f[:2, i]) < 1e-15 * np.abs(f[:2]).max()
                w = np.where(zero, 0, f[:2, i])
                agree("N and 4/3 N, of the value", w, np.where(zero, 0, g[:2, i]), tol=1e-13)
                OUT.append(",".join([str(count), repr(spacing), name, str(i + 1), repr(float(z[i])), show(w[0]), show(w[1])]))

print("""# Chains of unit spheres on the z axis, viscosity 1. Origin: tests/data/scripts/sphere_chains.py (multipoles, 64-bit mantissa).
# Sphere `sphere` stands at z = (sphere - (count + 1)/2) spacing (exact doubles). Motions
# (rest held): along_all, along_middle: velocity e_z of all, of the middle one; across_*: velocity e_x; turn_*: each about its own
# centre with angular velocity e_y. Force (z for along, x else) and torque (y; about the sphere's own centre) ON THE FLUID; 0 is exact.
count,spacing,motion,sphere,z,force,torque""")
print("\n".join(OUT))
print(WORST, file=sys.stderr)
