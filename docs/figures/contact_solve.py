"""How a substep of the rod solves its contacts, for docs/rod-contact.md."""

import re

from drawing import BLACK, BLUE, GREEN, GREY, ORANGE, RED, arrow, box, sheet, source, write


def draw():
    waits = re.search(r"\bpatience = (\d+);", source("firmware/physics/rod/tuning.hpp"))[1]
    figure, axes = sheet(790, 372)
    found = "list of pairs\n(broad phase)", "near pairs,\nfour at a time", "contacts: gap,\nnormal, two points"
    for x, text in zip((14, 156, 298), found):
        box(axes, x, 316, 122, 44, text, BLUE, size=10)
    arrow(axes, [(136, 338), (156, 338)])
    arrow(axes, [(278, 338), (298, 338)])
    arrow(axes, [(359, 316), (359, 286)])

    box(axes, 264, 240, 190, 46, "Which bodies touch?", BLACK)
    arrow(axes, [(264, 263), (129, 263), (129, 216)])
    write(axes, 258, 274, "strands only", align="right", size=9.5)
    arrow(axes, [(454, 263), (619, 263), (619, 216)])
    write(axes, 460, 280, "also desk, pegs or grippers;\nor friction turns the thread", align="left", size=9.5)

    box(axes, 34, 170, 190, 46, "Newton's method\non all contacts together", GREEN)
    box(axes, 524, 170, 190, 46, "sweeps: projected\nGauss-Seidel", GREEN)
    arrow(axes, [(224, 201), (524, 201)])
    write(axes, 374, 210, "no solution found", size=9.5)
    box(axes, 262, 126, 194, 46, "wait: this substep continues\nin the next tick", ORANGE, size=10)
    arrow(axes, [(224, 182), (243, 182), (243, 149), (262, 149)])
    write(axes, 238, 140, "budget spent", align="right", size=9.5)
    arrow(axes, [(456, 149), (490, 149), (490, 182), (524, 182)])
    write(axes, 497, 150, f"after {waits} ticks\nat most", align="left", size=9.5)

    box(axes, 524, 78, 190, 40, "brake: scales velocities down", RED, size=10)
    arrow(axes, [(640, 170), (640, 118)])
    write(axes, 646, 143, "not converged", align="left", size=9.5)
    box(axes, 242, 78, 190, 40, "velocities of all nodes", BLACK)
    arrow(axes, [(129, 170), (129, 98), (242, 98)])
    write(axes, 122, 134, "converged, or\nerror small enough", align="right", size=9.5)
    arrow(axes, [(524, 98), (432, 98)])
    arrow(axes, [(714, 193), (752, 193), (752, 58), (400, 58), (400, 78)])
    write(axes, 746, 67, "converged", align="right", size=9.5)
    arrow(axes, [(337, 78), (337, 48)])
    box(axes, 196, 8, 282, 40, "guard: shortens the substep\nif a pair could cross", BLUE, size=10)
    write(axes, 486, 28, "then the nodes move", GREY, "left", 9.5)
    return figure
