#!/usr/bin/env python3
"""References of `sphere-in-shell-unsteady`: unsteady Stokes flow between a sphere and a concentric shell.

Two ways that share nothing but the equations:

- in Laplace space the flow has four coefficients, of the potentials r cos and cos / r^2 and of the modified
  spherical Bessel functions of sqrt(s / nu) r; the force follows in closed form, and the transform of the motion is
  inverted by Talbot's method with 40 digits;
- in time the profile of the radial velocity is a polynomial at Chebyshev points of the gap, and is advanced by Radau's
  method of fifth order.

    python exact.py                            a minute; needs numpy and mpmath
"""

import mpmath as mp
import numpy as np

RADIUS, SHELL, DENSITY, VISCOSITY = 1.0, 4.0, 1.0, 1.0
SPRING, SOLID = 200.0, 1.5  # stiffness, density of the sphere
FREQUENCY = 8.0


def resistance(s):
    """Force of the fluid on the sphere over minus its velocity, in Laplace space.

    u_r = F(r) cos, u_theta = -G(r) sin with G = (r^2 F)' / (2 r), F = A + B / r^3 + C k_1(z) / r + D i_1(z) / r,
    z = sqrt(s / nu) r; F = G = 1 on the sphere, 0 on the shell. The potential A r - B / (2 r^2) makes the pressure
    -rho s times itself, and the force is 4 pi / 3 a^2 (rho s (A a - B / (2 a^2)) + 2 mu G'(a)).
    """
    wave = mp.sqrt(s * DENSITY / VISCOSITY)

    def outgoing(r):
        z = wave * r
        return mp.exp(-(z - wave * RADIUS)) * (1 / z + 1 / z**2) / r

    def ingoing(r):
        z = wave * r
        scale = mp.exp(-wave * SHELL)
        return scale * (mp.cosh(z) / z - mp.sinh(z) / z**2) / r

    profiles = [lambda r: mp.mpf(1) + 0 * r, lambda r: r**-3, outgoing, ingoing]

    def tangential(f, r):
        return f(r) + r / 2 * mp.diff(f, r)

    rows = []
    for r in (mp.mpf(RADIUS), mp.mpf(SHELL)):
        rows += [[f(r) for f in profiles], [tangential(f, r) for f in profiles]]
    a, b, c, d = mp.lu_solve(mp.matrix(rows), mp.matrix([1, 1, 0, 0]))
    r = mp.mpf(RADIUS)
    # G' = 3 F' / 2 + r F'' / 2, and F' = 0 on the sphere
    bend = sum(x * mp.diff(f, r, 2) for x, f in zip((a, b, c, d), profiles, strict=True))
    force = DENSITY * s * (a * r - b / (2 * r**2)) + 2 * VISCOSITY * r / 2 * bend
    return -4 * mp.pi / 3 * r**2 * force


def by_transform(times, of_resistance):
    """Inverse transforms at times."""
    mp.mp.dps = 40
    return [mp.invertlaplace(lambda s: of_resistance(s, resistance(s)), t, method="talbot") for t in times]


def sprung(s, z):
    """Transform of x / x0: released at rest at x0 from the place where the spring is at rest."""
    mass = SOLID * 4 * mp.pi / 3 * RADIUS**3
    return (mass * s + z) / (mass * s**2 + z * s + SPRING)


def swung(s, z):
    """Transform of F / V0 with the velocity V0 sin(frequency t)."""
    return -z * FREQUENCY / (s**2 + FREQUENCY**2)


def chebyshev(n):
    """Points from the sphere to the shell, and the matrix that differentiates there."""
    x = -np.cos(np.pi * np.arange(n + 1) / n)
    c = np.ones(n + 1)
    c[[0, -1]] = 2.0
    c *= (-1.0) ** np.arange(n + 1)
    apart = x[:, None] - x[None, :] + np.eye(n + 1)
    d = np.outer(c, 1.0 / c) / apart
    d -= np.diag(d.sum(1))
    half = 0.5 * (SHELL - RADIUS)
    return RADIUS + half * (x + 1.0), d / half


class InTime:
    """Unknowns: F at the points, and for a free sphere its velocity and place; E y' = A y + b(t)."""

    def __init__(self, n, is_free):
        r, d = chebyshev(n)
        d2 = d @ d
        # Vorticity over sin: (F - (r G)') / r with G = F + r F' / 2
        g = np.eye(n + 1) + 0.5 * r[:, None] * d
        vorticity = (np.eye(n + 1) - d @ (r[:, None] * g)) / r[:, None]
        diffuse = d2 + (2.0 / r)[:, None] * d - np.diag(2.0 / r**2)
        size = n + 1 + 2
        e, a = np.zeros((size, size)), np.zeros((size, size))
        inside = slice(2, n - 1)
        e[inside, : n + 1] = DENSITY * vorticity[inside]
        a[inside, : n + 1] = VISCOSITY * (diffuse @ vorticity)[inside]
        # F(a) = V, F'(a) = 0, F(R) = 0, F'(R) = 0
        a[0, 0], a[0, n + 1] = 1.0, -1.0
        a[1, : n + 1] = d[0]
        a[n - 1, n] = 1.0
        a[n, : n + 1] = d[n]
        # Force: pressure by the equation along the surface, -(4 pi / 3) P + (8 pi / 3) mu G'
        curl = (d @ (r[:, None] * vorticity))[0]
        self.force = 4 * np.pi / 3 * (VISCOSITY * curl + 2.0 * VISCOSITY * (d @ g)[0])
        self.added = 4 * np.pi / 3 * DENSITY  # times the acceleration of the sphere
        mass = SOLID * 4 * np.pi / 3
        if is_free:
            e[n + 1, n + 1] = mass - self.added
            a[n + 1, : n + 1] = self.force
            a[n + 1, n + 2] = -SPRING
        else:
            a[n + 1, n + 1] = -1.0
        e[n + 2, n + 2], a[n + 2, n + 1] = 1.0, 1.0
        self.n, self.e, self.a, self.is_free = n, e, a, is_free

    def source(self, t):
        b = np.zeros(len(self.e))
        if not self.is_free:
            b[self.n + 1] = np.sin(FREQUENCY * t)
        return b

    def run(self, times, step):
        """x / x0, or F / V0, at times that are whole steps; Radau's method with three stages."""
        root = np.sqrt(6.0)
        c = np.array([(4 - root) / 10, (4 + root) / 10, 1.0])
        table = np.array(
            [
                [(88 - 7 * root) / 360, (296 - 169 * root) / 1800, (-2 + 3 * root) / 225],
                [(296 + 169 * root) / 1800, (88 + 7 * root) / 360, (-2 - 3 * root) / 225],
                [(16 - root) / 36, (16 + root) / 36, 1.0 / 9.0],
            ]
        )
        size = len(self.e)
        y = np.zeros(size)
        y[-1] = 1.0 if self.is_free else 0.0
        system = np.linalg.inv(np.kron(np.eye(3), self.e) - step * np.kron(table, self.a))
        found = []
        for k in range(round(max(times) / step)):
            t = k * step
            right = np.concatenate([self.a @ y + self.source(t + x * step) for x in c])
            # Algebraic rows of E y' = A y + b hold at the stages themselves
            rates = (system @ right).reshape(3, size)
            y = y + step * table[2] @ rates
            now = (k + 1) * step
            if any(abs(now - one) < 1e-9 for one in times):
                if self.is_free:
                    found.append(y[-1])
                else:
                    speedup = FREQUENCY * np.cos(FREQUENCY * now)
                    found.append(self.force @ y[: self.n + 1] + self.added * speedup)
        return found


if __name__ == "__main__":
    for name, is_free, transform, times in [
        ("x / x0", True, sprung, [0.1, 0.2, 0.3, 0.5, 0.8, 1.2]),
        ("F / V0", False, swung, [0.2, 0.4, 0.6, 1.0, 1.4, 2.0]),
    ]:
        exact = by_transform(times, transform)
        for n, step in [(32, 2e-3), (48, 1e-3), (64, 5e-4)]:
            print(name, n, step, " ".join(f"{x:.7f}" for x in InTime(n, is_free).run(times, step)), flush=True)
        print(name, "by its transform", " ".join(mp.nstr(x, 9) for x in exact), flush=True)
