import csv
from collections import defaultdict

import matplotlib.pyplot as plt

lines = defaultdict(list)
with open("sweeps/tube/sweep.csv") as file:
    for row in csv.DictReader(file):
        if row["state"] == "finished":
            beta = float(row["body.0.gait.squirmer.modes.1"]) / 1.5
            radius = float(row["domain.cylinder.radius"])
            lines[beta].append((radius, float(row["squirmer.power"])))

figure, axes = plt.subplots(figsize=(5, 3.2), layout="constrained")
for beta, points in sorted(lines.items()):
    axes.plot(*zip(*sorted(points)), "o-", label=rf"$\beta$ = {beta:g}")
axes.set_xlabel("radius of the tube / radius of the squirmer")
axes.set_ylabel(r"power / $\mu\, a\, U_0^2$")
axes.legend()
figure.savefig("power.png", dpi=130)
