"""Draws what the example prints: `filament.py filament.csv docs/pictures/filament.png`."""

import csv
import sys
from collections import defaultdict
from pathlib import Path

import matplotlib.pyplot as plt

from alewife_post import style


def read(path: str) -> dict[str, list[tuple[float, float]]]:
    """Points by the name of their curve."""
    curves = defaultdict(list)
    with Path(path).open(newline="") as file:
        for row in csv.DictReader(file):
            curves[row["curve"]].append((float(row["x"]), float(row["y"])))
    return curves


def main() -> None:
    """Shapes over a cycle for two stiffnesses, and the thrust beside them."""
    source, target = sys.argv[1:]
    curves = read(source)
    style.use()
    figure, axes = plt.subplots(1, 3, figsize=(10.0, 2.9), layout="constrained")
    for axis, number in zip(axes, ("2.16", "5"), strict=False):
        shapes = [curve for name, curve in curves.items() if name.startswith(f"shape {number} ")]
        for i, shape in enumerate(shapes):
            axis.plot(*zip(*shape, strict=True), color=plt.cm.viridis(i / len(shapes)), lw=1.4)
        axis.plot(0.0, 0.0, "o", color="black", ms=4)
        axis.set(xlabel="$x / L$", title=f"$Sp$ = {number}", xlim=(-0.05, 1.05), ylim=(-0.32, 0.32))
        axis.set_aspect("equal")
    axes[0].set_ylabel("$y / L$")
    axes[2].plot(*zip(*curves["linear"], strict=True), color="black", lw=1.4, label="linear theory")
    for name, marker, color in (
        ("angle 0.05", "o", style.SERIES[0]),
        ("angle 0.5", "s", style.REFERENCE),
    ):
        label = f"{name.split()[1]} rad"
        axes[2].plot(*zip(*curves[name], strict=True), marker, ms=4.5, color=color, label=label)
    axes[2].set(xlabel="$Sp$", xlim=(0.5, 6.0), ylim=(0.0, None))
    axes[2].set_title(r"thrust / $(\zeta_\perp - \zeta_\parallel)\,\omega\,(\varepsilon l)^2$")
    axes[2].legend(frameon=False)
    figure.savefig(target, dpi=style.DPI)


if __name__ == "__main__":
    main()
