#!/usr/bin/env bash
# Builds the release preset's benchmarks and measures the gateway against DDS called by hand; README.md says how to
# read the results. --quick: takes two minutes, only to see that it works. Other arguments: see harness/run.py.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
cd "$root"
cmake --preset release > /dev/null
cmake --build --preset release --target bench_programs > /dev/null
export PYTHONDONTWRITEBYTECODE=1
case " $* " in
*" --quick "*) exec python3 tests/bench/harness/run.py "$@" build/release/bin ;;
*) exec python3 tests/bench/harness/run.py --output tests/bench "$@" build/release/bin ;;
esac
