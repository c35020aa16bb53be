# Sourced by the scenarios: a rig of processes in the guest. Simulated hardware shares the one virtual CPU with the
# controller and must have the higher priority, or the controller would delay its own bus: hands at 85, loop at 80. Where an
# instruction takes less than 1 ns, 75 is enough: then the hands take time only from the physics.
set -eu
export XDG_STATE_HOME=/run/state
flight=/run/flight.rec
scene=scenes/paper.toml script=scenes/operators/overhand.csv  # of both hands and the controller
record=                                                       # device record of both hands; empty: the Omni class
recorder_s=30                                                 # time that the flight recorder keeps
hands_priority=85

# As on a rig (docs/deployment.md). By default Linux stops real-time processes for 5 % of each second; from 6.12 on its
# fair server does so. Only other values are written: with one CPU, Linux 6.12 refused the second -1 (EBUSY).
write() { [ "$(cat "$2")" = "$1" ] || echo "$1" > "$2"; }  # VALUE FILE
write -1 /proc/sys/kernel/sched_rt_runtime_us
fair_server=/sys/kernel/debug/sched/fair_server/cpu
for runtime in "$fair_server"*/runtime; do [ ! -e "$runtime" ] || write 0 "$runtime"; done

# Reads all needed files in advance, because file access to the host takes an unpredictable amount of virtual time.
warm() {
  local programs=("$LIGATURE_BIN"/ligature-{firmware,device,host} $(type -P "$@" bash sleep cat cp date rm mkdir))
  { printf '%s\n' "${programs[@]}"; ldd "${programs[@]}" 2>/dev/null | grep -o '/[^ :]*' || true; } | sort -u | xargs cat > /dev/null
}

# hand left|right INTERFACE [ARGUMENT...]: starts a simulated hand (ligature-device) on a CAN interface
hand() {
  local side=$1 interface=$2
  shift 2
  chrt -f "$hands_priority" "$LIGATURE_BIN/ligature-device" --hand "$side" --bus "socketcan:$interface" --scene "$scene" \
    --operator "$script" --stats "/run/$side.json" ${record:+--device "$record"} "$@" > "/run/$side.log" 2>&1 &
  printf -v "${side}_pid" %d $!
}

# firmware LEFT-INTERFACE RIGHT-INTERFACE [ARGUMENT...]: starts the controller; with --force, because the tests themselves
# check whether the loop is in time
firmware() {
  local left=$1 right=$2
  shift 2
  rm -f "$flight"* /run/firmware.log  # in_force reads this run's log only
  "$LIGATURE_BIN/ligature-firmware" run --scene "$scene" --left "socketcan:$left" --right "socketcan:$right" \
    ${record:+--device "$record"} --arm --force --rt=enforce --recorder "$flight" --recorder-s "$recorder_s" "$@" > /run/firmware.log 2>&1 &
  firmware_pid=$!
}

# Returns half a second after the rig has reached full force.
in_force() {
  local tries
  for tries in {1..600}; do
    ! grep -q 'ENGAGE -> FORCE' /run/firmware.log || { sleep 0.5; return 0; }
    sleep 0.05
  done
  echo "the rig does not come to force"; cat /run/firmware.log; return 1
}

# Starts candump, which logs every frame of the given interfaces, in order.
listen() {
  candump -L -D -r 67108864 "$@" > /run/can.log 2> /run/candump.log &
  candump_pid=$!
}

# gone PID: ends a process with SIGTERM and waits for it
gone() { kill -TERM "$1" 2>/dev/null || true; wait "$1" || true; }

# run_for SECONDS NAME [ARGUMENT...]: one run of the controller with both hands on vcan, kept as NAME
run_for() {
  local seconds=$1 name=$2 code=0
  shift 2
  hand left vcan0; hand right vcan1
  sleep 0.5
  firmware vcan0 vcan1 --duration "$seconds" "$@"
  wait "$firmware_pid" || code=$?
  gone "$left_pid"; gone "$right_pid"
  cat /run/firmware.log
  keep "$name"
  return "$code"
}

# keep NAME: copies a run's results to the folder that outlives the guest
keep() {
  mkdir -p "/hil/$1"
  cp "$flight"* /run/*.log /run/*.json "/hil/$1/" 2>/dev/null || true
}
