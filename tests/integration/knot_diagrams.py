"""Known knots from the literature as input for knot recognition: planar diagrams, drawn as polygons in space; among
them published diagrams of the unknot that are hard to recognise.

A diagram is a list of crossings in PD code: the labels of a crossing's four edges, counter-clockwise from the incoming
under one."""

import math

import numpy as np

# Diagrams of the unknot that cannot be undone by moves that lower or keep the number of crossings.
HARD_UNKNOTS = {
    "Goeritz": [(11, 1, 12, 0), (1, 13, 2, 12), (13, 3, 14, 2), (3, 15, 4, 14), (4, 21, 5, 0), (20, 5, 21, 6), (15, 11, 16, 10),
                (10, 16, 9, 17), (6, 17, 7, 18), (18, 7, 19, 8), (8, 19, 9, 20)],
    "Thistlethwaite": [(22, 2, 23, 1), (3, 27, 4, 26), (5, 21, 6, 20), (7, 18, 8, 19), (9, 25, 10, 24), (11, 2, 12, 3), (4, 13, 5, 14),
                       (15, 6, 16, 7), (30, 17, 1, 18), (19, 14, 20, 15), (28, 22, 29, 21), (23, 11, 24, 10), (25, 9, 26, 8),
                       (27, 12, 28, 13), (16, 29, 17, 30)],
    "Ochiai": [(12, 2, 13, 1), (3, 6, 4, 7), (5, 24, 6, 25), (7, 15, 8, 14), (16, 10, 17, 9), (26, 12, 1, 11), (13, 20, 14, 21),
               (22, 15, 23, 16), (10, 18, 11, 17), (19, 3, 20, 2), (21, 8, 22, 9), (23, 4, 24, 5), (25, 19, 26, 18)],
    "Culprit": [(2, 15, 3, 16), (6, 4, 7, 3), (14, 6, 15, 5), (5, 13, 4, 14), (1, 13, 2, 12), (1, 8, 0, 7), (9, 0, 8, 19), (16, 9, 17, 10),
                (10, 17, 11, 18), (19, 12, 18, 11)],
    "Monster": [(3, 1, 2, 4), (8, 9, 1, 7), (5, 6, 7, 3), (4, 18, 6, 5), (17, 19, 8, 18), (9, 10, 11, 14), (10, 12, 13, 11),
                (12, 19, 15, 13), (20, 16, 14, 15), (16, 20, 17, 2)],
}


def strands(diagram):
    """@returns the edges in the order of a walk along the knot; and for each end of an edge, given as (crossing,
    place), the edge's other end and its label."""
    ends = {}
    for crossing, labels in enumerate(diagram):
        for place, label in enumerate(labels):
            ends.setdefault(label, []).append((crossing, place))
    across = {}
    for label, (a, b) in ends.items():
        across[a], across[b] = (b, label), (a, label)
    walk, at = [], (0, 2)
    while not walk or at != (0, 2):
        to, label = across[at]
        walk.append((at, to, label))
        at = (to[0], (to[1] + 2) % 4)
    assert len(walk) == 2 * len(diagram), "more than one component"
    return walk, across


def faces_of(diagram, across, path):
    """For each face its corners, in the order of a walk round it with the face on the left."""
    faces, seen = [], set()
    for start in ((c, k) for c in range(len(diagram)) for k in range(4)):
        face, at = [], start
        while at not in seen:
            seen.add(at)
            face += [("crossing", at[0])] + path[at]
            to, _ = across[at]
            at = (to[0], (to[1] - 1) % 4)
        if face:
            faces.append(face)
    assert len(faces) == len(diagram) + 2, "not planar"
    return faces


def drawn(diagram, outer=0):
    """The diagram as a closed polygon: a Tutte drawing of its graph, with over strands raised and under strands
    lowered. Two extra vertices on every edge (bends) and one inside every face but the outer one (hub) make the graph
    simple, so that the drawing has no fold [Tutte 1963]."""
    walk, across = strands(diagram)
    path = {}
    for a, b, label in walk:
        path[a] = [("bend", label, 0), ("bend", label, 1)]
        path[b] = path[a][::-1]
    faces = faces_of(diagram, across, path)
    outside = [face for face in faces if len(set(face)) == len(face)][outer]
    links = [(p, q) for a, b, _ in walk for line in [[("crossing", a[0]), *path[a], ("crossing", b[0])]] for p, q in zip(line, line[1:])]
    links += [(("hub", i), p) for i, face in enumerate(faces) if face is not outside for p in face]
    number = {p: i for i, p in enumerate(dict.fromkeys(p for link in links for p in link))}
    pull = np.zeros((len(number), len(number)))
    for p, q in links:
        pull[number[p], number[q]] = pull[number[q], number[p]] = 1.0
    rim = [number[p] for p in outside]
    fixed = np.zeros((len(number), 2))
    turn = -2 * math.pi * np.arange(len(rim)) / len(rim)  # clockwise, because the drawing is outside of this face
    fixed[rim] = np.stack([np.cos(turn), np.sin(turn)], 1)
    for _ in range(30):  # longer edges get larger weights, so that small faces grow
        balance = np.diag(pull.sum(axis=1)) - pull
        balance[rim] = 0.0
        balance[rim, rim] = 1.0
        at = np.linalg.solve(balance, fixed)
        pull = (pull > 0) * (np.linalg.norm(at[:, None] - at[None], axis=2) ** 0.7 + 1e-9)
    line = []
    for (crossing, place), _, _ in walk:
        line.append([*at[number["crossing", crossing]], 0.25 if place % 2 else -0.25])
        line += [[*at[number[p]], 0.0] for p in path[crossing, place]]
    return np.array(line)
