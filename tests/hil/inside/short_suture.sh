#!/bin/bash
# The short test of a suture, run for every change: 2.5 seconds. The work budget is given, because measuring it takes
# long here.
exec bash tests/hil/inside/suture.sh 2.5 --set suture.work_instructions=3700000
