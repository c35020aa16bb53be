"""One period of the real-time loop and the beginning of the next, for docs/architecture.md.

The times are those of a bus of 1 Mbit/s whose frames have their greatest length, with the constants of the code."""

from drawing import BLACK, BLUE, GREEN, GREY, ORANGE, PALE, arrow, microseconds, sheet, write

PERIOD, SEND = 1000, 20                 # us; SEND, the call that sends SYNC, is drawn without a measured length
LAW = 30                                # us, control law and sending of torques: 21 to 31 (docs/measurements/timing.md)
LEFT, SCALE = 78, 0.455                 # points; points per us
BUS, LOOP, PHYSICS, HIGH = 226, 156, 86, 30  # lower edges of the three rows, and their height


def longest_frame_us(data_bytes):
    """Longest time of a CAN frame at 1 Mbit/s: a stuff bit after each 4 of its stuffable bits, and 13 bits without."""
    stuffable = 34 + 8 * data_bytes
    return stuffable + (stuffable - 1) // 4 + 13


def at(us):
    return LEFT + SCALE * us


def bar(axes, begin, end, row, colour, text="", filled=True):
    corners = [at(begin), at(end), at(end), at(begin)], [row, row, row + HIGH, row + HIGH]
    axes.fill(*corners, linewidth=1.1, edgecolor=colour, facecolor=PALE[colour] if filled else "white",
              linestyle="-" if filled else (0, (3, 2)))
    write(axes, at((begin + end) / 2), row + HIGH / 2, text, size=10)


def draw():
    sync, sample, torque = longest_frame_us(0), longest_frame_us(8), longest_frame_us(4)
    bus = "firmware/platform/cia402_time.hpp"
    samples, wait = microseconds(bus, "samples_latest"), microseconds(bus, "longest_wait()")
    margin = microseconds("firmware/rt/bus_time.hpp", "kMargin")
    assert sync + 3 * sample == samples and samples + 3 * torque + microseconds(bus, "most_work()") == PERIOD
    sent = samples + LAW

    figure, axes = sheet(790, 322)
    rows = (BUS, "CAN bus", "of each hand"), (LOOP, "loop", "same core"), (PHYSICS, "physics", "same core")
    for row, name, more in rows:
        write(axes, LEFT - 8, row + HIGH / 2 + 6, name, align="right", weight="bold")
        write(axes, LEFT - 8, row + HIGH / 2 - 8, more, GREY, "right", 8)
    for k, name in ((0, "SYNC k"), (1, "SYNC k+1")):
        start = k * PERIOD
        axes.plot([at(start)] * 2, [58, 284], color=GREY, linewidth=0.9, linestyle=(0, (4, 3)))
        write(axes, at(start), 294, name, weight="bold", align="left" if k == 0 else "center")
        bar(axes, start, start + sync, BUS, BLUE)
        write(axes, at(start + sync / 2), BUS + HIGH / 2, "SYNC", size=8, rotation=90)
        for i in range(3):
            begin = start + sync + i * sample
            bar(axes, begin, begin + sample, BUS, BLUE, f"TPDO {i + 1}")
        bar(axes, start, start + SEND, LOOP, ORANGE)
        arrow(axes, [(at(start + SEND / 2), LOOP + HIGH), (at(start + SEND / 2), BUS)], ORANGE)
        write(axes, at(start + SEND) + 1, LOOP + HIGH + 20, "sends SYNC", ORANGE, "left", 9)
        bar(axes, start + SEND, start + samples, LOOP, GREY, "waits for the samples", filled=False)
        bar(axes, start + samples, start + sent, LOOP, ORANGE)
        write(axes, at(start + samples + LAW / 2), LOOP + HIGH / 2, "law", size=9, rotation=90)
    for i in range(3):
        bar(axes, sent + i * torque, sent + (i + 1) * torque, BUS, ORANGE, f"RPDO {i + 1}")
    bar(axes, sent, PERIOD, LOOP, GREY, "sleeps", filled=False)

    bar(axes, SEND, samples - margin, PHYSICS, GREEN, "computes with the tools of k-1")
    bar(axes, sent, PERIOD, PHYSICS, GREEN, "computes with the tools of k")
    bar(axes, PERIOD + SEND, PERIOD + samples - margin, PHYSICS, GREEN, "and continues")

    middle = LOOP + HIGH
    arrow(axes, [(at(samples) + 3, BUS), (at(samples) + 3, middle)], BLUE)
    arrow(axes, [(at(sent) - 2, middle), (at(sent + 15), BUS)], ORANGE)
    write(axes, at(samples) - 4, middle + 20, "joint angles", BLUE, "right", 9)
    write(axes, at(sent) + 12, middle + 20, "torques of k: they act at SYNC k+1", ORANGE, "left", 9)
    arrow(axes, [(at(sent) - 2, LOOP), (at(sent + 15), PHYSICS + HIGH)], ORANGE)
    write(axes, at(sent) + 12, LOOP - 20, "tools of k", ORANGE, "left", 9)
    for start, name in ((0, "k-1"), (PERIOD, "k")):
        arrow(axes, [(at(start + samples - margin), PHYSICS + HIGH), (at(start + samples) + 4, LOOP)], GREEN)
        write(axes, at(start + samples - margin) - 2, LOOP - 20, f"grasp after {name}", GREEN, "right", 9)

    axis = 58
    axes.plot([at(0), at(PERIOD + sent)], [axis, axis], color=BLACK, linewidth=1)
    late = wait + 3 * torque
    close = {samples: "right", sent: "left", PERIOD + samples - margin: "right", PERIOD + samples: "left"}
    for us in (0, sync, sent + 3 * torque, PERIOD, *close):
        axes.plot([at(us)] * 2, [axis - 4, axis + 4], color=BLACK, linewidth=1)
        align = close.get(us, "center")
        write(axes, at(us) + {"right": 4, "left": -4, "center": 0}[align], axis - 13, str(us), align=align, size=9)
    write(axes, LEFT - 8, axis - 13, "time, us", align="right", size=9)
    write(axes, LEFT, 20, f"The loop waits until {wait} us at the latest. The RPDOs then end at {late} us, before "
          "SYNC k+1.", align="left", size=9)
    return figure
