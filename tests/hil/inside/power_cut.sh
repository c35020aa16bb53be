#!/bin/bash
# The power is cut while a rig renders force and records to a separate disk. Just before, the controller is killed and the
# file is copied from the page cache, for comparison. Only the recorder itself may have synced its pages to the disk.
. tests/hil/inside/rig.sh
warm chrt grep
mkfs.ext4 -q /dev/vda
mkdir /run/disk
mount -o noatime,commit=600 /dev/vda /run/disk
echo 0 > /proc/sys/vm/dirty_writeback_centisecs
flight=/run/disk/flight.rec
hand left vcan0; hand right vcan1
sleep 0.5
firmware vcan0 vcan1
in_force
kill -KILL "$firmware_pid"
keep power-cut
echo "HIL-EXIT 0" > /dev/ttyS0
echo b > /proc/sysrq-trigger                                     # immediate reboot without sync or unmount
