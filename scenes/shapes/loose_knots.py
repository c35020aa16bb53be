#!/usr/bin/env python3
"""A thread with a loose knot in it, both ends free, as a CSV of points: what `suture.initial` of a scene reads.

usage: loose_knots.py KNOT [--length 0.3] [--out FILE] [--check]

KNOT is figure-eight (4_1), square (3_1 # its mirror image), granny (3_1 # 3_1), surgeons (5_1 # mirrored 3_1), or throws
of your own: odd half turns, first throw first, positive right-handed: `loose_knots.py throws=5,-3,3`. Plain Python.
--check: instead of writing, exit 1 when FILE is not what this script makes.

A throw is what a surgeon calls one: two strands wound around each other about the x axis by n half turns, so that the
strand that comes up on the left leaves on the right. n throws above each other, a loop below (where the tissue would
be) and the ends led off along -x and +x close to T(2,n1) # T(2,n2) # .. : joined through the loop and at infinity, each
horizontal twist is the closure of the two-braid sigma^n. The figure-eight is the well-known curve
r = 2 + cos 2t, angle 3t, height sin 4t.
"""
import argparse
import math
import pathlib
import sys

R_M = 1.5e-3         # half the distance of two strands wound around each other: five diameters of a 3-0 suture
HALF_TURN_M = 5e-3   # along x, for each half turn
BETWEEN_M = 8e-3     # from one throw's axis to the next
LOOP_M = 6e-3        # radius of the loop below
EIGHT_M = 3.2e-3     # a unit of the figure-eight
HEIGHT_M = 0.05      # of the ends
STEP_M = 2.5e-4      # between the points written
SMOOTH_M = 1.2e-3    # pieces are rounded off by a Gaussian this wide: the curvature steps where a line meets a circle
THROWS = {"square": (3, -3), "granny": (3, 3), "surgeons": (5, -3)}


def twist(n, half_width, side, z):
    """The strand that enters throw n on `side` (-1 left, +1 right) at the bottom, to where it leaves, opposite, on top."""
    own = 0.5 * abs(n) * HALF_TURN_M
    for k in range(201):
        x = side * half_width * (1 - k / 100)
        u = min(max((x + own) / (2 * own), 0.0), 1.0)
        turn = u * u * u * (10 + u * (6 * u - 15))  # no slope at the ends, where it goes straight on
        angle = -0.5 * math.pi + n * math.pi * turn + (math.pi if side > 0 else 0.0)
        yield x, R_M * math.cos(angle), z + R_M * math.sin(angle)


def half_circle(x, z_from, z_to, outward):
    middle, radius = 0.5 * (z_from + z_to), 0.5 * abs(z_to - z_from)
    for k in range(1, 100):
        a = math.pi * k / 100
        yield x + outward * radius * math.sin(a), 0.0, middle + 0.5 * (z_from - z_to) * math.cos(a)


def strand(throws, side):
    """From the middle of the loop's bottom up through every throw to the end that leaves on top."""
    half_width = 0.5 * HALF_TURN_M * max(abs(n) for n in throws)
    bottom = -R_M - 2 * LOOP_M
    points = [(side * half_width * k / 20, 0.0, bottom) for k in range(20)]
    points += half_circle(side * half_width, bottom, -R_M, side)
    for k, n in enumerate(throws):
        z = k * BETWEEN_M
        points += twist(n, half_width, side, z)
        side = -side
        if k + 1 < len(throws):
            points += half_circle(side * half_width, z + R_M, z + BETWEEN_M - R_M, side)
    return points


def thrown(throws):
    left, right = strand(throws, -1), strand(throws, 1)
    line = left[::-1] + right[1:]
    return line if line[0][0] < line[-1][0] else line[::-1]


def figure_eight():
    """Cut open where it is outermost; the two ends cross there once, which no knot minds, and part along -x and +x."""
    cut, points = 0.25, []
    for k in range(2001):
        t = cut + (2 * math.pi - 2 * cut) * k / 2000
        r = EIGHT_M * (2 + math.cos(2 * t))
        points.append((r * math.sin(3 * t), -r * math.cos(3 * t), EIGHT_M * math.sin(4 * t)))
    first, last = points[0], points[-1]
    beyond = 1.3 * EIGHT_M
    return [(-first[0], first[1] - beyond, first[2])] + points + [(-last[0], last[1] - beyond, last[2])]


def resampled(points, count):
    """`count` points equally far along the line."""
    along = [0.0]
    for a, b in zip(points, points[1:]):
        along.append(along[-1] + math.dist(a, b))
    out, k = [], 0
    for i in range(count):
        s = along[-1] * i / (count - 1)
        while k + 2 < len(points) and along[k + 1] < s:
            k += 1
        f = (s - along[k]) / (along[k + 1] - along[k])
        out.append(tuple((1 - f) * a + f * b for a, b in zip(points[k], points[k + 1])))
    return out, along[-1]


def with_tails(points, each_m):
    """Ends led on along -x and +x by lines long enough for any length."""
    (xa, ya, za), (xb, yb, zb) = points[0], points[-1]
    return ([(xa - each_m * (1 - k / 400), ya, za) for k in range(400)] + points
            + [(xb + each_m * k / 400, yb, zb) for k in range(1, 401)])


def smoothed(points, step):
    reach = round(3 * SMOOTH_M / step)
    weights = [math.exp(-0.5 * (k * step / SMOOTH_M) ** 2) for k in range(-reach, reach + 1)]
    total = sum(weights)
    middle = [tuple(sum(w * points[i + k - reach][axis] for k, w in enumerate(weights)) / total for axis in range(3))
              for i in range(reach, len(points) - reach)]
    return middle


def loose(knot, length_m):
    """Points of the whole thread, its knot in the middle."""
    bare = figure_eight() if knot == "figure-eight" else thrown(THROWS.get(knot) or throws_of(knot))
    long = with_tails(bare, 0.7 * length_m)
    _, all_m = resampled(long, 2)
    line, all_m = resampled(smoothed(resampled(long, round(all_m / STEP_M))[0], STEP_M), round(all_m / STEP_M))
    spare = round((all_m - length_m) / 2 / (all_m / (len(line) - 1)))
    tail_m = line[spare][0] - line[0][0]
    if spare < 0 or line[spare][0] > min(p[0] for p in bare) or tail_m < 0:
        raise SystemExit(f"{knot} needs more than {length_m} m of thread")
    line, _ = resampled(line[spare:len(line) - spare], round(length_m / STEP_M) + 1)
    middle = [0.5 * (a + b) for a, b in zip(line[0], line[-1])]
    return [(x - middle[0], y - middle[1], z - middle[2] + HEIGHT_M) for x, y, z in line]


def throws_of(text):
    try:
        throws = tuple(int(n) for n in text.removeprefix("throws=").split(","))
    except ValueError:
        throws = (0,)
    if not text.startswith("throws=") or not all(n % 2 for n in throws):
        raise SystemExit(f"KNOT: found {text}, allowed figure-eight, {', '.join(THROWS)} or throws=N,N,.. of odd half turns")
    return throws


def text_of(knot, length_m):
    lines = [f"# A loose {knot.replace('=', ' ')} knot, ends along x; {length_m} m; metres; made by loose_knots.py {knot}", "x,y,z"]
    return "\n".join(lines + ["%.6f,%.6f,%.6f" % p for p in loose(knot, length_m)]) + "\n"


def is_same(text, other):
    """Whether two texts have the same points within 2 um: Python and the C library round differently from version to version."""
    ours, theirs = text.splitlines(), other.splitlines()
    if ours[:2] != theirs[:2] or len(ours) != len(theirs):
        return False
    pairs = zip(",".join(ours[2:]).split(","), ",".join(theirs[2:]).split(","))
    return all(abs(float(a) - float(b)) < 2e-6 for a, b in pairs)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("knot", metavar="KNOT", help="figure-eight, square, granny, surgeons or throws=5,-3,3")
    parser.add_argument("--length", type=float, default=0.3, metavar="M", help="of the thread [0.3]")
    parser.add_argument("--out", type=pathlib.Path, help="CSV to write [stdout]")
    parser.add_argument("--check", action="store_true", help="only compare with --out, within 2 um")
    a = parser.parse_args()
    text = text_of(a.knot, a.length)
    if a.out is None:
        sys.stdout.write(text)
    elif a.check:
        return 0 if is_same(text, a.out.read_text()) else 1
    else:
        a.out.write_text(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
