#!/usr/bin/env python3
"""Runs one command in a temporary PREEMPT_RT guest with SocketCAN, and ends with its exit code.

The guest sees this machine's root file system read-only below a tmpfs: it may write anywhere, but only files in /hil are
kept. With --arm64 it sees the folder of arm64 packages instead, and in it the project at its path. It has lo, vcan0 and
vcan1, and can0 and can1 on two emulated SJA1000 controllers (initially down). QEMU always runs at normal priority: with
a real-time priority it would take the machine's CPU from everything else.

Example: guest.py --out build/hil/look --icount 1 -- uname -a
Exit: the command's; 124: time limit reached; 125: the guest reported no exit code."""

import argparse
import ctypes
import os
import pathlib
import re
import shlex
import shutil
import signal
import subprocess
import sys
import threading
import time

import initramfs
import kernel

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
ARM64_ROOT = ROOT / "build/arm64/root"  # scripts/setup arm64
OUT_OF_TIME, NO_ANSWER = 124, 125
KERNEL_LINE = ("rdinit=/init panic=-1 quiet loglevel=4 random.trust_cpu=on mitigations=off nokaslr nowatchdog "
               "audit=0 apparmor=0 selinux=0 cryptomgr.notests raid=noautodetect")
OF_X86 = "console=ttyS0 no_timer_check tsc=reliable"
OF_ARM64 = "console=ttyAMA0"


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder that the guest sees as /hil; logs go there, too")
    parser.add_argument("--icount", type=int, metavar="N", help="virtual time: an instruction takes 2^N ns, waiting takes none; one CPU")
    parser.add_argument("--per-ns", type=int, default=1, metavar="N", help="with --icount 0: N instructions take 1 ns")
    parser.add_argument("--cpus", type=int, default=1, help="without --icount")
    parser.add_argument("--arm64", action="store_true", help="a machine with an arm64 CPU (QEMU's virt, Cortex-A76) instead of a PC")
    parser.add_argument("--isolate", action="store_true", help="keep the last CPU free: isolcpus, nohz_full, rcu_nocbs")
    parser.add_argument("--disk", type=pathlib.Path, help="file that the guest has as /dev/vda, with ext4 to mount it")
    parser.add_argument("--memory-mb", type=int, default=1024)
    parser.add_argument("--timeout", type=int, default=300, help="seconds of this machine's time")
    parser.add_argument("command", nargs="+")
    options = parser.parse_args()
    if options.arm64 and options.per_ns > 1:
        parser.error("--per-ns is not for --arm64, whose clock counts 62.5 MHz of QEMU's time")
    return options


def first_files(busybox, folder, names, options):
    files = {"bin/busybox": busybox.read_bytes(), "init": (HERE / "init").read_bytes()}
    for i, module in enumerate(kernel.modules(folder, names)):
        files[f"modules/{i:02}-{module.name}"] = module.read_bytes()
    known = "".join(f"export {k}={shlex.quote(v)}\n" for k, v in os.environ.items()
                    if k in ("PATH", "HOME", "LANG") or k.startswith("LIGATURE_"))
    files["command"] = f"{known}cd {shlex.quote(str(ROOT))} && exec {shlex.join(options.command)}\n".encode()
    if options.arm64:
        files["project_path"] = str(ROOT).encode()
    return initramfs.archive(files)


def machine(options, folder, initrd):
    line = f"{KERNEL_LINE} {OF_ARM64 if options.arm64 else OF_X86}"
    if options.isolate:
        last = options.cpus - 1
        line += f" isolcpus=managed_irq,domain,{last} nohz_full={last} rcu_nocbs={last} irqaffinity=0"
    if options.per_ns > 1:
        line += f" tsc_early_khz={1_000_000 * options.per_ns}"
    if options.icount is None:
        time_base = ["-accel", "tcg,thread=multi", "-smp", str(options.cpus)]
    else:
        time_base = ["-accel", "tcg,thread=single", "-smp", "1", "-icount", f"shift={options.icount},sleep=off"]
    disk = ["-drive", f"file={options.disk.resolve()},format=raw,if=none,id=disk", "-device", "virtio-blk-pci,drive=disk"] if options.disk else []
    if options.arm64:
        kind = ["qemu-system-aarch64", "-machine", "virt,gic-version=3", "-cpu", "cortex-a76",
                "-virtfs", f"local,path={ROOT},mount_tag=project,security_model=none,readonly=on,multidevs=remap"]
    else:
        kind = ["qemu-system-x86_64", "-machine", "pc,hpet=off,vmport=off,usb=off", "-cpu", "max"]
    return [*kind, "-nodefaults", "-no-user-config", "-no-reboot", "-display", "none", "-nic", "none",
            "-m", str(options.memory_mb), *time_base, *disk,
            "-kernel", str(folder / "vmlinux"), "-initrd", str(initrd), "-append", line,
            "-chardev", f"file,id=console,path={options.out / 'console.log'}", "-serial", "chardev:console",
            "-device", "virtio-serial-pci,max_ports=4", "-chardev", "stdio,id=out,signal=off",
            "-device", "virtserialport,chardev=out,name=hil.out", "-device", "virtio-rng-pci",
            "-virtfs", f"local,path={ARM64_ROOT if options.arm64 else '/'},mount_tag=host,security_model=none,readonly=on,multidevs=remap",
            "-virtfs", f"local,path={options.out},mount_tag=out,security_model=none,multidevs=remap",
            "-object", "can-bus,id=bus", "-device", "kvaser_pci,canbus=bus", "-device", "kvaser_pci,canbus=bus"]


def dies_with_us():
    """QEMU is killed when this process ends for any reason."""
    ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG


def copy(stream, log):
    for line in stream:
        sys.stdout.buffer.write(line)
        sys.stdout.buffer.flush()
        log.write(line)
        log.flush()


def run(options):
    program = "qemu-system-aarch64" if options.arm64 else "qemu-system-x86_64"
    busybox = (ARM64_ROOT if options.arm64 else pathlib.Path("/")) / "bin/busybox"
    if shutil.which(program) is None or not busybox.exists():
        raise RuntimeError(f"no {program if busybox.exists() else busybox}; remedy: scripts/setup hil{'-arm64' if options.arm64 else ''}")
    options.out = options.out.resolve()
    options.out.mkdir(parents=True, exist_ok=True)
    folder = kernel.fetch(ROOT / ("build/hil/kernel-arm64" if options.arm64 else "build/hil/kernel"), options.arm64)
    initrd = options.out / "initrd"
    initrd.write_bytes(first_files(busybox, folder, kernel.MODULES + (kernel.OF_A_DISK if options.disk else ()), options))
    began = time.monotonic()
    with open(options.out / "output.log", "wb") as log, open(options.out / "qemu.log", "wb") as complaints:
        qemu = subprocess.Popen(machine(options, folder, initrd), stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=complaints,
                                preexec_fn=dies_with_us)
        reader = threading.Thread(target=copy, args=(qemu.stdout, log))
        reader.start()
        try:
            qemu.wait(timeout=options.timeout)
        except subprocess.TimeoutExpired:
            print(f"hil: no end within {options.timeout} s", file=sys.stderr)
            return OUT_OF_TIME
        finally:
            qemu.kill()
            qemu.wait()
            reader.join()
            initrd.unlink()
    console = (options.out / "console.log").read_text(errors="replace")
    (options.out / "seconds").write_text(f"{time.monotonic() - began:.1f}\n")
    told = re.findall(r"^HIL-EXIT (\d+)", console, re.MULTILINE)
    if not told or told[-1] == str(NO_ANSWER):
        print("hil: the guest did not come to an end:\n" + console[-3000:] + (options.out / "qemu.log").read_text()[-2000:], file=sys.stderr)
        return NO_ANSWER
    return int(told[-1])


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    try:
        sys.exit(run(arguments()))
    except (RuntimeError, OSError) as error:
        print(f"hil: {error}", file=sys.stderr)
        sys.exit(NO_ANSWER)
