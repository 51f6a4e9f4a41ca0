#!/usr/bin/env python3
"""References of `sphere-in-shell-re-3d`: the Navier-Stokes equations around a sphere at the centre of a shell.

The flow is axisymmetric about the direction of the motion, with swirl, and seen from the centre of the sphere. Its
velocity, that of the laboratory, is curl curl (P r) + curl (T r) with the vector r, and P and T are sums of Legendre
polynomials P_l(cos theta) times functions of r at Chebyshev points. In the frame of the sphere

    du/dt = (u - V) x curl u - grad(p / rho + |u - V|^2 / 2) + nu laplace u,

whose product is made on a grid of Gauss points in cos theta. Diffusion and the equations of motion of the sphere are
implicit, the product is extrapolated (backward differences of second order). The sphere takes part by l = 1 only.

    python spectral.py            minutes; needs numpy and scipy
"""

import sys
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.polynomial import legendre
from scipy.linalg import lu_factor, lu_solve


def zero(_):
    return 0.0


@dataclass
class Case:
    """Density of the fluid 1, radius of the sphere 1; functions of time."""

    shell: float
    viscosity: float
    solid: float = 1.0  # density of the sphere
    velocity: object = None  # imposed, else free
    spin: object = None
    force: object = zero  # external, without the pressure at rest
    torque: object = zero
    spring: float = 0.0
    torsion: float = 0.0
    place: float = 0.0  # at the start
    angle: float = 0.0
    slip: object = field(default=lambda t: (0.0, 0.0))  # B1, B2 of a squirmer, at the time
    is_linear: bool = False


def chebyshev(n, shell):
    """Points from the sphere to the shell, and the matrix that differentiates there."""
    x = -np.cos(np.pi * np.arange(n + 1) / n)
    c = np.ones(n + 1)
    c[[0, -1]] = 2.0
    c *= (-1.0) ** np.arange(n + 1)
    d = np.outer(c, 1.0 / c) / (x[:, None] - x[None, :] + np.eye(n + 1))
    d -= np.diag(d.sum(1))
    half = 0.5 * (shell - 1.0)
    return 1.0 + half * (x + 1.0), d / half


class Flow:
    def __init__(self, case, n, degree, step):
        self.case, self.n, self.degree, self.step = case, n, degree, step
        self.r, self.d = chebyshev(n, case.shell)
        self.angles(degree)
        self.square = 0.0 if case.is_linear else 0.4  # part of |slip|^2 / 2 in cos, over B1 B2
        mass = 4.0 * np.pi / 3.0
        self.mass, self.inertia = case.solid * mass, 0.4 * case.solid * mass
        self.degrees = np.arange(1, degree + 1)
        self.laplace = [
            self.d @ self.d + (2.0 / self.r)[:, None] * self.d - np.diag(k * (k + 1) / self.r**2) for k in self.degrees
        ]
        # rows of what the surface exerts: derivatives of P and T at r = 1
        d = self.d
        eye = np.eye(n + 1)
        tangential = np.diag(1.0 / self.r) @ d @ np.diag(self.r)  # g = (r P)' / r, u_theta = -g sin
        head = case.viscosity * (d @ np.diag(self.r) @ self.laplace[0])[0]  # of p, without -r dg/dt
        normal = 4.0 * case.viscosity * (d[0] - eye[0])
        shear = case.viscosity * ((d @ tangential)[0] - tangential[0] + 2.0 * eye[0])
        self.pull = 4.0 * np.pi / 3.0 * (normal - head) + 8.0 * np.pi / 3.0 * shear
        self.twist = 8.0 * np.pi / 3.0 * case.viscosity * (d[0] - eye[0])
        self.factors = {rate: self.systems(rate) for rate in (1.0 / step, 1.5 / step)}

    def angles(self, degree):
        x, weight = legendre.leggauss(3 * degree // 2 + 2)
        sine = np.sqrt(1.0 - x**2)
        unit = np.eye(degree + 1)
        p = np.array([legendre.legval(x, unit[k]) for k in range(1, degree + 1)])
        dp = np.array([-sine * legendre.legval(x, legendre.legder(unit[k])) for k in range(1, degree + 1)])
        k = np.arange(1, degree + 1)
        self.p, self.dp, self.cosine, self.sine = p, dp, x, sine
        self.of_p = (p * weight).T * ((2 * k + 1) / 2.0)
        self.of_dp = (dp * weight).T * ((2 * k + 1) / (2.0 * k * (k + 1)))

    def systems(self, rate):
        """Factors of all degrees; of the first with velocity and place, spin and angle of the sphere."""
        c, n = self.case, self.n
        poloidal, toroidal = [], []
        for k in range(self.degree):
            extra = 2 if k == 0 else 0
            lap = self.laplace[k]
            a = np.zeros((n + 1 + extra,) * 2)
            a[2 : n - 1, : n + 1] = (rate * lap - c.viscosity * lap @ lap)[2 : n - 1]
            a[0, 0] = a[n - 1, n] = 1.0
            a[1, : n + 1], a[n, : n + 1] = self.d[0], self.d[n]
            b = np.zeros((n + 1 + extra,) * 2)
            b[1:n, : n + 1] = (rate * np.eye(n + 1) - c.viscosity * lap)[1:n]
            b[0, 0] = b[n, n] = 1.0
            if extra:
                v, x = n + 1, n + 2
                a[0, v] = a[1, v] = -0.5
                b[0, v] = -1.0
                a[x, x], a[x, v] = rate, -1.0
                b[x, x], b[x, v] = rate, -1.0
                if c.velocity is None:
                    a[v, v] = rate * (self.mass - 4.0 * np.pi / 3.0)
                    a[v, : n + 1] = -self.pull
                    a[v, x] = c.spring
                else:
                    a[v, v] = 1.0
                if c.spin is None:
                    b[v, v] = rate * self.inertia
                    b[v, : n + 1] = -self.twist
                    b[v, x] = c.torsion
                else:
                    b[v, v] = 1.0
            poloidal.append(lu_factor(a))
            toroidal.append(lu_factor(b))
        return poloidal, toroidal

    def product(self, pol, tor, speed):
        """(u - V) x curl u by degrees: what drives P (its vorticity) and T; arrays of degrees by points."""
        r, d, k = self.r, self.d, self.degrees[:, None]
        around = k * (k + 1)
        vorticity = np.array([lap @ f for lap, f in zip(self.laplace, pol, strict=True)])
        u_r = (around * pol / r).T @ self.p - speed * self.cosine
        u_t = ((r * pol) @ d.T / r).T @ self.dp + speed * self.sine
        u_f = -tor.T @ self.dp
        w_r = (around * tor / r).T @ self.p
        w_t = ((r * tor) @ d.T / r).T @ self.dp
        w_f = vorticity.T @ self.dp
        f_r = ((u_t * w_f - u_f * w_t) @ self.of_p).T
        f_t = ((u_f * w_r - u_r * w_f) @ self.of_dp).T
        f_f = ((u_r * w_t - u_t * w_r) @ self.of_dp).T
        return ((r * f_t) @ d.T - f_r) / r, -f_f

    def run(self, times):
        """Velocity, place, force (of the fluid), spin, angle, torque at times that are whole steps."""
        c, n, h = self.case, self.n, self.step
        pol, tor = np.zeros((self.degree, n + 1)), np.zeros((self.degree, n + 1))
        # velocity, place; spin, angle; the slip B1
        now = [pol, tor, np.array([0.0, c.place]), np.array([0.0, c.angle]), c.slip(0.0)[0], None]
        now[5] = self.product(pol, tor, 0.0)
        before, found = now, []
        for count in range(1, round(max(times) / h) + 1):
            t = count * h
            first = count == 1
            rate = 1.0 / h if first else 1.5 / h
            past = [(a / h if first else (2.0 * a - 0.5 * b) / h) for a, b in zip(now[:5], before[:5], strict=True)]
            drive = now[5] if first else [2.0 * a - b for a, b in zip(now[5], before[5], strict=True)]
            if c.is_linear:
                drive = [0.0 * one for one in drive]
            new = self.solve(rate, t, past, drive)
            new.append(self.product(new[0], new[1], new[2][0]))
            before, now = now, new
            if any(abs(t - one) < 1e-9 for one in times):
                found.append([*now[2], self.force(rate, past, now, t), *now[3], self.twist @ now[1][0]])
        return np.array(found)

    def solve(self, rate, t, past, drive):
        c, n = self.case, self.n
        poloidal, toroidal = self.factors[rate]
        b1, b2 = c.slip(t)
        pol, tor = np.zeros_like(past[0]), np.zeros_like(past[1])
        motion, turn = None, None
        for k in range(self.degree):
            extra = 2 if k == 0 else 0
            right = np.zeros(n + 1 + extra)
            right[2 : n - 1] = (self.laplace[k] @ past[0][k] + drive[0][k])[2 : n - 1]
            right[1] = (-b1, -b2 / 3.0)[k] if k < 2 else 0.0
            swirl = np.zeros(n + 1 + extra)
            swirl[1:n] = (past[1][k] + drive[1][k])[1:n]
            if extra:
                right[n + 2], swirl[n + 2] = past[2][1], past[3][1]
                if c.velocity is None:
                    added = 4.0 * np.pi / 3.0
                    right[n + 1] = (self.mass - added) * past[2][0] + c.force(t)
                    # dB1/dt and the square of the slip are in the pressure
                    right[n + 1] += added * (self.square * b1 * b2 - (rate * b1 - past[4]))
                else:
                    right[n + 1] = c.velocity(t)
                if c.spin is None:
                    swirl[n + 1] = self.inertia * past[3][0] + c.torque(t)
                else:
                    swirl[n + 1] = c.spin(t)
            x, y = lu_solve(poloidal[k], right), lu_solve(toroidal[k], swirl)
            pol[k], tor[k] = x[: n + 1], y[: n + 1]
            if extra:
                motion, turn = x[n + 1 :], y[n + 1 :]
        return [pol, tor, motion, turn, b1]

    def force(self, rate, past, now, t):
        b1, b2 = self.case.slip(t)
        change = rate * now[2][0] - past[2][0] - (rate * b1 - past[4])
        return self.pull @ now[0][0] + 4.0 * np.pi / 3.0 * (change + self.square * b1 * b2)


QUANTITIES = ["velocity", "place", "force", "spin", "angle", "torque"]
VELOCITY, PLACE, FORCE, SPIN, ANGLE, TORQUE = range(6)


def ramp(t):
    """The `smooth-ramp` of a case, of duration 1."""
    return 0.5 * (1.0 - np.cos(np.pi * min(t, 1.0)))


WEIGHT = 4.0 * np.pi / 3.0  # of a density above the fluid's and a gravity of 1

# name: case, what is compared, when
VARIANTS = {
    "falling": (Case(4.0, 0.1, solid=2.0, force=lambda t: 1.5 * WEIGHT), VELOCITY, [1.0, 2.0, 4.0]),
    "swung": (Case(4.0, 0.1, velocity=lambda t: np.sin(2.0 * t)), FORCE, [0.5, 1.0, 2.0, 3.0]),
    "sprung": (Case(4.0, 0.1, spring=20.0, place=1.5), PLACE, [0.5, 1.0, 2.0, 3.0]),
    "turned": (Case(3.0, 0.05, spin=lambda t: 4.0 * np.sin(t)), TORQUE, [1.0, 2.0, 3.0, 4.0]),
    "twisted": (Case(3.0, 0.05, torsion=4.0, angle=3.0), ANGLE, [1.0, 2.0, 3.0, 4.0]),
    "falling-spinning": (
        Case(4.0, 0.1, solid=2.0, force=lambda t: 1.5 * WEIGHT, torque=lambda t: 6.0),
        VELOCITY,
        [1.0, 2.0, 4.0],
    ),
    "pusher": (Case(4.0, 0.2, slip=lambda t: (1.5 * ramp(t), -7.5 * ramp(t))), VELOCITY, [1.0, 2.0, 4.0]),
}

if __name__ == "__main__":
    for name, (case, what, times) in VARIANTS.items():
        if sys.argv[1:] and name not in sys.argv[1:]:
            continue
        for label, n, degree, step in [
            ("linear", 48, 2, 1e-3),
            ("", 32, 12, 2e-3),
            ("", 48, 16, 2e-3),
            ("", 48, 16, 1e-3),
            ("", 64, 20, 1e-3),
        ]:
            one = replace(case, is_linear=label == "linear")
            found = Flow(one, n, degree, step).run(times)
            for one in [VELOCITY, SPIN] if name == "falling-spinning" else [what]:
                print(name, QUANTITIES[one], label, n, degree, step, *(f"{x:.7f}" for x in found[:, one]), flush=True)
