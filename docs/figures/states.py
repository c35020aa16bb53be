"""States of the controller and their transitions, read from state_machine.hpp; for docs/architecture.md."""

import re

from drawing import BLACK, BLUE, GREY, ORANGE, RED, arrow, box, sheet, source, write

WIDTH, HEIGHT = 104, 44
PLACES = {"OFF": (20, 200), "CALIBRATE": (196, 200), "IDLE": (372, 200), "ENGAGE": (512, 200), "FORCE": (726, 200),
          "BRAKE": (512, 76), "FAULT": (20, 20)}  # lower left corners
EVENTS = {"kDrivesUp": "drives\nenabled", "kCalibrated": "possible\npose", "kArm": "arm", "kTooFast": "hand too fast",
          "kEngaged": "one hand has\nfull gain", "kLetGo": "both hands let go\nof the dead-man", "kDisarm": "disarm",
          "kStopped": "gains and\nforces zero", "kPowerDown": "shut down", "kReset": "reset-fault"}


def machine():
    """Transitions as {(from, to): [events]}, and the states in which torque may be commanded."""
    text = source("firmware/control/state_machine.hpp")
    states = re.findall(r"(k\w+) = \d", re.search(r"enum class State.*?};", text, re.S)[0])
    names = dict(zip(states, re.findall(r'"([A-Z]+)"', text)))
    edges = {}
    for a, event, b in re.findall(r"Transition\{State::(\w+), Event::(\w+), State::(\w+)\}", text):
        edges.setdefault((names[a], names[b]), []).append(event)
    pushing = {names[s] for s in re.findall(r"s == State::(\w+)", re.search(r"bool may_push.*?}", text, re.S)[0])}
    assert "if (e == Event::kFault) return State::kFault;" in text  # the arrow from the frame to FAULT
    return list(names.values()), edges, pushing


def side(state, right=0.5, up=0.5):
    """A point of a state's box, as shares of its width and height."""
    x, y = PLACES[state]
    return x + right * WIDTH, y + up * HEIGHT


# For each pair of states: the way of the arrow, and the place and alignment of its label.
WAYS = {
    ("OFF", "CALIBRATE"): ([side("OFF", 1), side("CALIBRATE", 0)], (160, 240), "center"),
    ("CALIBRATE", "IDLE"): ([side("CALIBRATE", 1), side("IDLE", 0)], (336, 240), "center"),
    ("IDLE", "ENGAGE"): ([side("IDLE", 1), side("ENGAGE", 0)], (494, 233), "center"),
    ("ENGAGE", "FORCE"): ([side("ENGAGE", 1, 0.7), side("FORCE", 0, 0.7)], (671, 249), "center"),
    ("FORCE", "ENGAGE"): ([side("FORCE", 0, 0.25), side("ENGAGE", 1, 0.25)], (671, 194), "center"),
    ("CALIBRATE", "OFF"): ([side("CALIBRATE", 0.25, 0), (222, 160), (98, 160), side("OFF", 0.75, 0)], (160, 169),
                           "center"),
    ("IDLE", "OFF"): ([side("IDLE", 0.25, 0), (398, 134), (72, 134), side("OFF", 0.5, 0)], (240, 143), "center"),
    ("ENGAGE", "BRAKE"): ([side("ENGAGE", 0.5, 0), side("BRAKE", 0.5, 1)], (570, 160), "left"),
    ("FORCE", "BRAKE"): ([side("FORCE", 0.5, 0), (778, 98), side("BRAKE", 1)], (700, 109), "center"),
    ("BRAKE", "IDLE"): ([side("BRAKE", 0), (424, 98), side("IDLE", 0.5, 0)], (418, 112), "right"),
    ("FAULT", "OFF"): ([side("FAULT", 0.25, 1), side("OFF", 0.25, 0)], (52, 106), "left"),
}


def draw():
    states, edges, pushing = machine()
    figure, axes = sheet(850, 290)
    for state in states:
        colour = ORANGE if state in pushing else RED if state == "FAULT" else BLUE
        box(axes, *PLACES[state], WIDTH, HEIGHT, state, colour)
    for pair, events in edges.items():
        way, (x, y), align = WAYS[pair]
        arrow(axes, way)
        write(axes, x, y, " or ".join(EVENTS[e] for e in sorted(events)), align=align, size=10)
    arrow(axes, [(230, 42), side("FAULT", 1)], RED)
    write(axes, 236, 42, "any state, on a fault", RED, "left", 10)
    write(axes, 20, 276, "blue: no torque", BLUE, "left", 10)
    write(axes, 130, 276, "orange: torque possible", ORANGE, "left", 10)
    write(axes, 290, 276, "red: no torque, power stages off, until reset-fault", RED, "left", 10)
    return figure
