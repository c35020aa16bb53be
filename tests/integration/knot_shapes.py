"""Polylines of known knots: closed braids, disguised by moves that keep the type, rotated, noisy, open and closed."""

import math

import numpy as np

# KnotInfo's braid words, as in tests/unit/knot/recognise_test.cpp; the handedness is that of the given word.
BRAIDS = {
    ("0_1", "none"): (4, (1, -2, 3)),
    ("3_1", "right"): (2, (1, 1, 1)),
    ("4_1", "amphichiral"): (3, (1, -2, 1, -2)),
    ("5_1", "right"): (2, (1, 1, 1, 1, 1)),
    ("5_2", "right"): (3, (1, 1, 1, 2, -1, 2)),
    ("6_1", "right"): (4, (1, 1, 2, -1, -3, 2, -3)),
    ("6_2", "right"): (3, (1, 1, 1, -2, 1, -2)),
    ("6_3", "amphichiral"): (3, (1, 1, -2, 1, -2, -2)),
    ("7_1", "right"): (2, (1, 1, 1, 1, 1, 1, 1)),
    ("7_2", "right"): (4, (1, 1, 1, 2, -1, 2, 3, -2, 3)),
    ("7_3", "right"): (3, (1, 1, 1, 1, 1, 2, -1, 2)),
    ("7_4", "right"): (4, (1, 1, 2, -1, 2, 2, 3, -2, 3)),
    ("7_5", "right"): (3, (1, 1, 1, 1, 2, -1, 2, 2)),
    ("7_6", "right"): (4, (1, 1, -2, 1, 3, -2, 3)),
    ("7_7", "right"): (4, (1, -2, 1, -2, 3, -2, 3)),
    ("8_1", "right"): (5, (1, 1, 2, -1, 2, 3, -2, -4, 3, -4)),
    ("8_2", "right"): (3, (1, 1, 1, 1, 1, -2, 1, -2)),
    ("8_3", "amphichiral"): (5, (1, 1, 2, -1, -3, 2, -3, -4, 3, -4)),
    ("8_4", "right"): (4, (1, 1, 1, -2, 1, -2, -3, 2, -3)),
    ("8_5", "right"): (3, (1, 1, 1, -2, 1, 1, 1, -2)),
    ("8_6", "right"): (4, (1, 1, 1, 1, 2, -1, -3, 2, -3)),
    ("8_7", "right"): (3, (1, 1, 1, 1, -2, 1, -2, -2)),
    ("8_8", "right"): (4, (1, 1, 1, 2, -1, -3, 2, -3, -3)),
    ("8_9", "amphichiral"): (3, (1, 1, 1, -2, 1, -2, -2, -2)),
    ("8_10", "right"): (3, (1, 1, 1, -2, 1, 1, -2, -2)),
    ("8_11", "right"): (4, (1, 1, 2, -1, 2, 2, -3, 2, -3)),
    ("8_12", "amphichiral"): (5, (1, -2, 1, 3, -2, -4, 3, -4)),
    ("8_13", "right"): (4, (-1, -1, 2, -1, 2, 2, 3, -2, 3)),
    ("8_14", "right"): (4, (1, 1, 1, 2, -1, 2, -3, 2, -3)),
    ("8_15", "right"): (4, (1, 1, -2, 1, 3, 2, 2, 2, 3)),
    ("8_16", "right"): (3, (1, 1, -2, 1, 1, -2, 1, -2)),
    ("8_17", "amphichiral"): (3, (1, 1, -2, 1, -2, 1, -2, -2)),
    ("8_18", "amphichiral"): (3, (1, -2, 1, -2, 1, -2, 1, -2)),
    ("8_19", "right"): (3, (1, 1, 1, 2, 1, 1, 1, 2)),
    ("8_20", "right"): (3, (-1, -1, -1, 2, 1, 1, 1, 2)),
    ("8_21", "right"): (3, (1, 1, 1, 2, -1, -1, 2, 2)),
    ("3_1#3_1", "right"): (3, (1, 1, 1, 2, 2, 2)),
    ("3_1#3_1", "amphichiral"): (3, (1, 1, 1, -2, -2, -2)),
    ("3_1#4_1", "right"): (4, (1, 1, 1, 2, -3, 2, -3)),
    ("4_1#4_1", "amphichiral"): (5, (1, -2, 1, -2, 3, -4, 3, -4)),
    ("3_1#5_1", "right"): (3, (1, 1, 1, 2, 2, 2, 2, 2)),
    ("3_1#5_2", "right"): (4, (1, 1, 1, 2, 2, 2, 3, -2, 3)),
    ("3_1#3_1#3_1", "right"): (4, (1, 1, 1, 2, 2, 2, 3, 3, 3)),
}
OTHER = {"right": "left", "left": "right"}


def closed_braid(strands, word):
    """Closure of a braid that runs along x; the strands return far outside; positive letters make right-handed
    crossings."""
    end, line, at = 2.0 * len(word) + 1.0, [], 0
    while True:
        line.append((0.0, at, 0.0))
        x = 0.5
        for letter in word:
            k = abs(letter) - 1
            line.append((x, at, 0.0))
            if at in (k, k + 1):
                up = at == k
                to = k + 1 if up else k
                line.append((x + 0.75, (at + to) / 2, 0.4 if (letter > 0) != up else -0.4))
                at = to
            x += 2.0
            line.append((x - 0.5, at, 0.0))
        out = 2.0 + strands - at
        line += [(end, at, 0.0), (end + out, at, 0.0), (end + out, strands + out, 0.0), (-out, strands + out, 0.0), (-out, at, 0.0)]
        if at == 0:
            return np.array(line)


def mirrored(points):
    return points * [1.0, 1.0, -1.0]


def turned(points, rng, noise=0.0):
    q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    q[:, 0] *= np.sign(np.linalg.det(q))
    return points @ q.T + noise * rng.normal(size=points.shape)


def refined(points, pieces):
    ends = np.roll(points, -1, axis=0)
    u = np.arange(pieces)[:, None, None] / pieces
    return np.swapaxes(points + u * (ends - points), 0, 1).reshape(-1, 3)


def pierced(a, b, c, starts, ends):
    """Whether any segment intersects the triangle, with a margin."""
    normal = np.cross(b - a, c - a)
    area2 = normal @ normal
    if area2 < 1e-18:
        return False
    da, db = (starts - a) @ normal, (ends - a) @ normal
    crossing = (da > 0) != (db > 0)
    if not crossing.any():
        return False
    s, e, da, db = starts[crossing], ends[crossing], da[crossing], db[crossing]
    p = s + (e - s) * (da / (da - db))[:, None]
    inside = np.ones(len(p), bool)
    for u, v in ((a, b), (b, c), (c, a)):
        inside &= np.cross(v - u, p - u) @ normal >= -1e-3 * area2
    return bool(inside.any())


def disguised(points, rng, moves, reach):
    """Moves random corners; each move sweeps two triangles that no other edge intersects, so the type is kept."""
    p, n = points.copy(), len(points)
    done = 0
    for _ in range(8 * moves):
        if done == moves:
            break
        i = int(rng.integers(n))
        a, b, c = p[i - 1], p[i], p[(i + 1) % n]
        to = b + reach * rng.normal(size=3)
        keep = [k for k in range(n) if k not in ((i - 1) % n, i)]
        starts, ends = p[keep], p[[(k + 1) % n for k in keep]]
        # The two edges beside the moved ones share a corner with a triangle. Apart from this corner they must not
        # intersect it, so they are tested a little shortened there. All others are tested whole: two shortened edges
        # leave a gap at their common corner, through which a triangle's side can pass.
        before, after = keep.index((i - 2) % n), keep.index((i + 1) % n)
        ends[before] += 1e-6 * (starts[before] - ends[before])
        starts[after] += 1e-6 * (ends[after] - starts[after])
        if pierced(a, b, to, starts, ends) or pierced(b, c, to, starts, ends):
            continue
        p[i] = to
        done += 1
    return p


def opened(points, rng):
    """Opens the line at its outermost corner and extends both ends outwards to twice the size, so the type is kept."""
    centre = points.mean(axis=0)
    away = points - centre
    cut = int(np.argmax((away ** 2).sum(axis=1)))
    line = np.roll(points, -cut, axis=0)
    first, last = line[0] + 1e-3 * (line[1] - line[0]), line[0] + 1e-3 * (line[-1] - line[0])
    side = np.cross(away[cut], rng.normal(size=3))
    side *= 0.05 * np.linalg.norm(away[cut]) / np.linalg.norm(side)
    return np.vstack([first + away[cut] + side, first, line[1:], last, last + away[cut] - side])


def smooth_unknot(rng, n):
    """An unknot that looks tangled: z rises monotonically and the return path runs outside."""
    t, phase = np.linspace(0.0, 2 * math.pi, n, endpoint=False), rng.uniform(0, 2 * math.pi, 2)
    body = np.stack([np.sin(5 * t + phase[0]) + np.cos(9 * t), np.cos(7 * t + phase[1]) - np.sin(4 * t), 0.02 * np.arange(n)], 1)
    return np.vstack([body, [6.0, 0.0, 0.02 * n + 1], [6.0, 0.0, -1.0]])


def doubled_trefoil(n, twist):
    """The unknot: a long bight laid along a trefoil, its strands twisted about each other; pulling the bight back
    undoes it."""
    def at(t, side):
        base = np.stack([np.sin(t) + 2 * np.sin(2 * t), np.cos(t) - 2 * np.cos(2 * t), -np.sin(3 * t)], 1)
        return base + side * 0.08 * np.stack([np.cos(twist * t), np.sin(twist * t), np.sin(twist * t + 1.0)], 1)
    t = 0.5 + (2 * math.pi - 0.5) * np.arange(n + 1) / n
    return np.vstack([at(t, 1.0), at(t[::-1], -1.0)])
