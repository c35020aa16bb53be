#!/bin/bash
# The short test, run for every change: ten seconds without a missed deadline, and three faults while the rig renders
# force.
set -eu
bash tests/hil/inside/overhand.sh
exec bash tests/hil/inside/faults.sh hand-killed emergency bus-off
