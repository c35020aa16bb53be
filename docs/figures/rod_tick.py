"""The steps of a tick of the rod, for docs/rod.md."""

import re

from drawing import BLACK, BLUE, GREEN, GREY, ORANGE, ROOT, arrow, box, sheet, source, write

CODE = "firmware/physics/rod/"
WIDE, GAP = 138, 14
ONCE = (("begin_tick", "targets and speeds of\nthe hands; number of\nsubsteps; budget", "rod.cpp"),
        ("remesh", "nodes move along the\nthread to where they\nare needed", "refine.cpp\nmerge_guard.cpp"),
        ("twist", "angle and moment\nof each span", "twist.cpp, spin.cpp"))
EACH = (("look", "finds contacts: pairs\nthat may touch, their\ngaps and normals",
         "motion.cpp, pair_search.cpp\ncontact_measure.cpp, smooth.hpp"),
        ("assemble", "matrix A and\nright-hand side of\nA v = M v0 + ...", "assembly.cpp"),
        ("settle", "factorises A; solves\nimpulses p and\nvelocities v", "band_solver.cpp\ncontact_direct.cpp"),
        ("guard", "largest share of the\nsubstep in which\nnothing can cross", "guard.cpp"),
        ("move", "x += share dt v", "rod_substep.cpp"))


def step(axes, x, y, what, colour):
    name, text, files = what
    assert re.search(rf"\b{name}(?:_\.update)?[(<]", source(CODE + "rod.cpp") + source(CODE + "rod_substep.cpp")), name
    assert all(list((ROOT / CODE).rglob(file)) for file in re.split(r"[,\s]+", files)), files
    box(axes, x, y, WIDE, 76, "", colour)
    write(axes, x + WIDE / 2, y + 63, name, weight="bold")
    write(axes, x + WIDE / 2, y + 28, text, size=9.5)
    write(axes, x + WIDE / 2, y - 13, files, GREY, size=8)


def draw():
    figure, axes = sheet(5 * WIDE + 4 * GAP + 48, 348)
    for k, what in enumerate(ONCE):
        x = 24 + k * (WIDE + GAP)
        step(axes, x, 258, what, BLUE)
        if k > 0:
            arrow(axes, [(x - GAP, 296), (x, 296)])
    axes.fill([10, 784, 784, 10], [64, 64, 208, 208], facecolor="#FAFAFA", edgecolor=GREY, linestyle=(0, (4, 3)))
    repeat = "substep, for example 16 times; each moves the hands' targets by 1/16 of their way"
    write(axes, 20, 195, repeat, align="left", size=10)
    for k, what in enumerate(EACH):
        x = 24 + k * (WIDE + GAP)
        step(axes, x, 100, what, GREEN)
        if k > 0:
            arrow(axes, [(x - GAP, 138), (x, 138)])
    end = 24 + 2 * (WIDE + GAP) + WIDE
    arrow(axes, [(end, 296), (end + 10, 296), (end + 10, 230), (93, 230), (93, 208)])
    last = 24 + 4 * (WIDE + GAP)
    arrow(axes, [(last + WIDE / 2, 64), (last + WIDE / 2, 24), (last - GAP, 24)], BLACK)
    force = "feel_hands: force on each hand,\nat the thread's new position"
    box(axes, 24 + 2 * (WIDE + GAP), 6, 2 * WIDE + GAP, 36, force, ORANGE, size=10)
    return figure
