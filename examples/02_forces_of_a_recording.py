"""Forces that the hands felt in a recording (LCM log or flight recorder file):
  `python examples/02_forces_of_a_recording.py RECORDING`
"""

import sys

import numpy as np

import ligature

recording = ligature.Recording(sys.argv[1])
print(f"{len(recording.t_s)} ticks of {recording.period_s} s by firmware {recording.firmware_version}, {recording.missing} missing")
for hand in ("left", "right"):
    force_N = np.linalg.norm(recording.vectors(f"{hand}_device_f", "N"), axis=1)
    held = recording.ticks[f"{hand}_node"] >= 0
    peak = int(force_N.argmax())
    mean_N = force_N[held].mean() if held.any() else 0.0
    print(f"{hand:5}: peak {force_N[peak]:.3f} N at {recording.t_s[peak]:.3f} s, mean {mean_N:.3f} N over {held.sum()} ticks of grasp")
for event in recording.events[:10]:
    print(f"{event['t_s']:8.3f} s  {event['text']}")
if len(recording.shapes):
    print("knot at the end:", ligature.knot(recording.shapes[-1]).type)
