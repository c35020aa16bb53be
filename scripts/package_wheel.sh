# Builds the Python package as a wheel into build/wheel and checks it: what is inside, which libraries it needs, and that it
# installs in a clean Debian 12 without a compiler, where examples/01 runs. Called by: scripts/package wheel
#   package wheel                builds and checks; the last check needs root
#   package wheel --no-root      without the clean Debian
#   package wheel -- OPTIONS     with further options of pip wheel, such as --config-settings=cmake.define.LIGATURE_ARCH=x86-64-v2
set -euo pipefail
cd "$(dirname "$0")/.."
clean=yes options=()
while [ $# -gt 0 ]; do
  case $1 in
    --no-root) clean=no ;;
    -h|--help) sed -n '1,5s/^# \?//p' scripts/package_wheel.sh; exit 0 ;;
    --) options=("${@:2}"); break ;;
    *) echo "package wheel: unknown argument '$1', allowed: --no-root, -- OPTIONS" >&2; exit 2 ;;
  esac
  shift
done
[ $clean = no ] || [ "$(id -u)" -eq 0 ] || { echo "package wheel: the clean Debian is made by root only: sudo, or --no-root" >&2; exit 2; }
scripts/setup wheel
out=$PWD/build/wheel python=$PWD/build/venv/bin/python
export PATH=$PWD/build/venv/bin:$PATH
mkdir -p "$out"
rm -rf "$out"/raw "$out"/*.whl
[[ "${options[*]}" == *=build-dir=* ]] || options+=("--config-settings=build-dir=$out/build")
"$python" -m pip wheel --quiet --no-build-isolation --no-deps -w "$out/raw" "${options[@]}" .
# Names the oldest system that the wheel runs on, and copies in what no system is sure to have (nothing, as checked below).
"$python" -m auditwheel repair --strip --wheel-dir "$out" "$out"/raw/*.whl > "$out/auditwheel.log" 2>&1 || { cat "$out/auditwheel.log" >&2; exit 3; }
wheel=$(ls "$out"/*.whl)

"$python" -m zipfile -l "$wheel" > "$out/contents.txt"
wrong=0
note() { echo "package wheel: $*" >&2; wrong=1; }
for file in ligature/_core.pyi ligature/mcap_file.py ligature/py.typed ligature/scenes/paper.toml ligature/scenes/operators/overhand.csv \
    ligature/scenes/shapes/overhand-loose.csv ligature/scenes/faults/emergency.toml ligature/rig/plugin.py ligature/study/__main__.py ligature_msg/tick_t.py; do
  grep -q "^$file " "$out/contents.txt" || note "$file is missing"
done
grep -q '^ligature/_core\..*\.so ' "$out/contents.txt" || note "the extension is missing"
! grep '\.libs/' "$out/contents.txt" || note "libraries were copied in: link them statically"
! grep -E '\.(cpp|hpp|o|a) ' "$out/contents.txt" || note "sources or objects are inside"

if [ $clean = yes ]; then
  source scripts/debian_root.sh
  settings=()
  root=$PWD/build/on/debian12-bare/root
  make_root debian12 "$root"
  mkdir -p "$root/wheel"
  rm -f "$root"/wheel/*
  cp "$wheel" examples/01_first_knot.py "$root/wheel"
  enter_root "$root" 'set -e
    command -v python3 > /dev/null || { apt-get update -q && apt-get install -y -q --no-install-recommends python3 python3-venv; } > /dev/null
    ! command -v cc gcc g++ clang cmake || { echo "a compiler is installed: this shows nothing"; exit 3; }
    rm -rf /fresh && python3 -m venv /fresh
    /fresh/bin/pip install --quiet --disable-pip-version-check --only-binary :all: /wheel/*.whl
    cd / && /fresh/bin/python /wheel/01_first_knot.py
    /fresh/bin/python -c "
from ligature.rig import Rig
with Rig(\"paper.toml\") as rig: rig.arm()
print(\"ligature.rig:\", rig.state)"' > "$out/clean.txt" 2>&1 || note "it does not work in a clean Debian 12: $(tail -n 3 "$out/clean.txt")"
  grep -q '3_1 right' "$out/clean.txt" || note "examples/01 found another knot"
  cat "$out/clean.txt"
fi
[ $wrong -eq 0 ] || exit 3
echo "package wheel: $wheel, $(du -h "$wheel" | cut -f1), $(wc -l < "$out/contents.txt") entries, fine"
