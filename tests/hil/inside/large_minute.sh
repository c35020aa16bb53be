#!/bin/bash
# The run of large.sh for a minute of virtual time. An instruction takes 1 ns here, so that it needs a quarter of an hour of
# this machine's CPU; the physics then computes a fifth of what it would on a rig, and loses more time.
. tests/hil/inside/rig.sh
warm chrt
scene=scenes/suture-3-0-knot.toml script=tests/hil/pull_apart.csv recorder_s=90
run_for 60 large --set suture.nodes=2000 --set suture.work_instructions=16000000
