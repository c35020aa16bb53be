#!/bin/bash
# The run of large.sh for a minute of virtual time. Two instructions take 1 ns here, not five as on a rig's core, so that it
# needs 25 minutes of this machine's CPU. The physics computes less in a period, and loses more time.
. tests/hil/inside/rig.sh
warm chrt
scene=scenes/suture-3-0-knot.toml script=tests/hil/pull_apart.csv recorder_s=90 hands_priority=75
run_for 60 large --set suture.nodes=2000 --set suture.work_instructions=16000000
