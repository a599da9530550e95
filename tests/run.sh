#!/usr/bin/env bash
# Installs the Debian packages that are missing, builds the release preset and runs the gate's tests.
#   tests/run.sh                 the gate's tests: no clock decides them, so they pass on any machine
#   tests/run.sh --all           these, and then all parts of the night (tests/night/README.md): many hours
#   tests/run.sh ARGUMENT...     builds everything; the arguments go to ctest, for instance: tests/run.sh -L core
#   tests/run.sh --quick         only unit tests, the conformance suite of each backend, and two nodes over each pair of them
#   tests/run.sh --quick arm64   the same, compiled for arm64 and run under qemu-user: docker/README.md says what it needs
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"

# The programs of unit tests; each says itself what it tests. On this machine's processor the conformance suite of each
# backend is run as well.
unit_tests=(core_test idl_test idl_dynamic_test transport_common_test transport_factory_test links_rules_test links_path_test
            links_parts_test air_test gateway_parts_test gateway_nodes_test)

# step NUMBER NAME COMMAND...: runs a command and shows a line with its number, name and duration; its output only if it fails.
step() {
    local number=$1 name=$2 begin=$SECONDS output result=ok
    shift 2
    [ ! -t 1 ] || printf '%2d of %d  %s ...' "$number" "$steps" "$name"
    output=$("$@" 2>&1) || { result=FAILED; failed=$((failed + 1)); }
    [ ! -t 1 ] || printf '\r\033[K'
    printf '%2d of %d  %s: %s, %d s\n' "$number" "$steps" "$name" "$result" $((SECONDS - begin))
    [ "$result" = ok ] || printf '%s\n' "$output"
}

# quick PRESET
quick() {
    local preset=$1 under=() packages=build transports=() programs=("${unit_tests[@]}")
    for transport in fastdds cyclonedds; do
        grep -qs "^RABIT_WITH_${transport^^}:BOOL=OFF" "build/$preset/CMakeCache.txt" || transports+=("$transport")
    done
    if [ "$preset" = release ]; then
        programs+=("${transports[@]/%/_conformance_test}")
    else
        # Death tests start their own program again, which the kernel cannot do for another processor.
        under=(env "GTEST_FILTER=-*DeathTest*" qemu-aarch64) packages=arm64
    fi
    "$root/docker/install-packages.sh" "$root/docker/packages-$packages.txt"
    "$root/docker/build-preset.sh" "$preset" "${programs[@]}" sensor display
    local number=0 failed=0 steps=$((${#programs[@]} + 1)) pairs
    pairs=$(IFS=,; echo "${transports[*]}")
    for test in "${programs[@]}"; do
        number=$((number + 1))
        step "$number" "$test" tests/whole_program.sh "${under[@]}" "build/$preset/bin/$test"
    done
    step "$steps" "two nodes over each pair of $pairs" env PYTHONDONTWRITEBYTECODE=1 python3 \
        tests/examples/two_nodes_test.py "build/$preset/bin" "$root" "$pairs" "${under[@]}"
    [ "$failed" -eq 0 ] || { echo "$failed of $steps failed"; exit 1; }
    echo "all passed"
}

if [ "${1:-}" = --quick ]; then
    [ $# -eq 1 ] || [ "$*" = "--quick arm64" ] || { echo "run.sh: --quick takes no other argument than arm64" >&2; exit 2; }
    echo "The quick tests: unit tests, and two nodes over each pair of backends. If nothing is built yet, compiling takes longest."
    quick "${2:-release}"
    exit
fi
targets=()
if [ $# -eq 0 ] || [ "$*" = --all ]; then
    echo "The tests of the gate. If nothing is built yet, compiling takes longest. --quick: a part of them; --all: all tests there are."
    targets=(gate_tests)
fi
all=${1:-}
[ "$all" != --all ] || shift
[ ${#targets[@]} -eq 0 ] || set -- -L '^gate$'
"$root/docker/install-packages.sh"
[ ${#targets[@]} -gt 0 ] || "$root/docker/install-packages.sh" "$root/docker/packages-check.txt" "$root/docker/packages-pack.txt"
"$root/docker/build-preset.sh" release "${targets[@]}"
junit=$root/build/release/Testing/tests.xml
tests=(ctest --preset release -j3 --progress --no-tests=error --output-junit "$junit" "$@")
result=0
if [ -t 1 ]; then
    "${tests[@]}" || result=$?
else # One line for each test that has ended, with its number: no line for its start.
    "${tests[@]}" | { grep --line-buffered -Ev '^ *Start +[0-9]+: ' || true; } || result=$?
fi
python3 tests/skipped.py "$junit"
[ "$all" != --all ] || .ci/night all || result=$?
exit "$result"
