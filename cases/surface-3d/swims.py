"""Velocity of a free ellipsoid that slips by the part of -(1, 1, 1) along its surface.

The traction on an ellipsoid that is moved is a constant times the distance h of the tangent plane
from the centre, so that the velocity is minus the mean of the slip with the weight h (reciprocal
theorem): along each axis 1 less the mean of the square of the normal's part. On the ellipsoid h dS
is the product of the semi-axes times the solid angle on the sphere that was stretched to it.
Writes it for more and more points: python swims.py
"""

from math import cos, pi, sin

SEMI_AXES = 2.0, 1.0, 0.5


def swims(n: int) -> list[float]:
    """Velocity by n times 2 n midpoints on the sphere."""
    means = [0.0, 0.0, 0.0]
    for row in range(n):
        polar = pi * (row + 0.5) / n
        weight = sin(polar) * (pi / n) ** 2 / (4 * pi)
        for column in range(2 * n):
            around = pi * (column + 0.5) / n
            point = sin(polar) * cos(around), sin(polar) * sin(around), cos(polar)
            slope = [part / axis for part, axis in zip(point, SEMI_AXES, strict=True)]
            square = sum(part * part for part in slope)
            for axis in range(3):
                means[axis] += weight * slope[axis] ** 2 / square
    return [1.0 - mean for mean in means]


coarse = swims(50)
for n in (100, 200, 400):
    fine = swims(n)
    # The midpoint rule is of second order at the poles
    limit = [f + (f - c) / 3 for f, c in zip(fine, coarse, strict=True)]
    print(n, *(f"{value:.8f}" for value in limit))
    coarse = fine
