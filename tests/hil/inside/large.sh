#!/bin/bash
# Two hands pull at a knot in a thread of 2000 nodes, whose physics takes longer than a period: for SECONDS, 4 if not given.
# Each takes a minute of this machine's CPU. The work budget is given, because measuring it takes long here.
. tests/hil/inside/rig.sh
warm chrt
scene=scenes/suture-3-0-knot.toml script=tests/hil/pull_apart.csv recorder_s=70 hands_priority=75
run_for "${1:-4}" large --set suture.nodes=2000 --set suture.work_instructions=16000000
