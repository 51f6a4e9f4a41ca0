"""Resistance of a torus in unbounded Stokes flow, by fundamental solutions on a torus within it.

In axes that turn with the ring, all is a wave around it: none for motion along the axis and spin about it, one
for motion across and tumbling. Writes force over viscosity times velocity, and torque over viscosity times rate,
for more and more points: python reference.py
"""

import numpy as np

RING, TUBE = 1.0, 0.4


def section(n, tube):
    """Distance from the axis and height of n points around the section of the ring."""
    v = 2 * np.pi * np.arange(n) / n
    return RING + tube * np.cos(v), tube * np.sin(v)


def strengths(wave, wanted, n_ring, n_tube, depth):
    """Stokeslets on an inner torus for velocities at twice as many points around the section."""
    far, height = section(n_tube, depth * TUBE)
    far_on, height_on = section(2 * n_tube, TUBE)
    matrix = np.zeros((2 * n_tube, 3, n_tube, 3), dtype=complex)
    for u in 2 * np.pi * np.arange(n_ring) / n_ring:
        turn = np.array([[np.cos(u), -np.sin(u), 0], [np.sin(u), np.cos(u), 0], [0, 0, 1]])
        source = np.stack([far * np.cos(u), far * np.sin(u), height], axis=1)
        point = np.stack([far_on, 0 * far_on, height_on], axis=1)
        away = point[:, None] - source[None]
        near = (1 / np.linalg.norm(away, axis=2))[..., None, None]
        green = np.eye(3) * near + away[..., :, None] * away[..., None, :] * near**3
        matrix += np.einsum("jlab,bc->jalc", green, turn) * np.exp(1j * wave * u) / (8 * np.pi)
    matrix = matrix.reshape(6 * n_tube, -1)
    wanted = np.stack(np.broadcast_arrays(*wanted(far_on, height_on)), axis=1).ravel()
    found, *_ = np.linalg.lstsq(matrix, wanted, rcond=1e-14)
    return found.reshape(n_tube, 3).T, far, height, np.abs(matrix @ found - wanted).max()


def resistance(n_ring, n_tube, depth):
    size = n_ring, n_tube, depth
    (_, _, f_z), _, _, worst = strengths(0, lambda far, z: (0j, 0j, 1 + 0j * far), *size)
    along = n_ring * f_z.real.sum()
    (_, f_t, _), far, _, _ = strengths(0, lambda far, z: (0j, far + 0j, 0j), *size)
    spinning = n_ring * (far * f_t.real).sum()
    (f_r, f_t, _), _, _, off = strengths(1, lambda far, z: (1 + 0j * far, 1j, 0j), *size)
    across = n_ring / 2 * (f_r.real + f_t.imag).sum()
    (f_r, f_t, f_z), far, z, _ = strengths(1, lambda far, z: (1j * z, -z, -1j * far), *size)
    tumbling = n_ring / 2 * (-far * f_z.imag - z * (f_t.real - f_r.imag)).sum()
    return across, along, tumbling, spinning, max(worst, off)


if __name__ == "__main__":
    for n_ring, n_tube, depth in [(100, 12, 0.5), (200, 20, 0.5), (400, 30, 0.5), (400, 30, 0.6)]:
        across, along, tumbling, spinning, worst = resistance(n_ring, n_tube, depth)
        print(
            f"{n_ring} x {n_tube}, depth {depth}: force across {across:.8f}, along {along:.8f}, "
            f"torque across {tumbling:.8f}, along {spinning:.8f}; velocity off by {worst:.0e}"
        )
