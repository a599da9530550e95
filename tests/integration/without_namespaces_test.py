#!/usr/bin/env python3
"""Where network namespaces cannot be made, the tests that need them are skipped (77), and tell the reason.

Usage: without_namespaces_test.py LEDGER_NODE RADIO"""

import os
import pathlib
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
INTEROP = HERE.parent / "transport/interop"
SMOKE = HERE.parent / "gate/smoke.py"
sys.path.insert(0, str(HERE.parent))
from skipped import SKIPPED, skip  # noqa: E402

# Without the first no namespace can be made; without the second no device in it.
CAPABILITIES = ("sys_admin", "net_admin")


def main():
    ledger_node, radio = sys.argv[1:]
    if os.geteuid() != 0 or not shutil.which("setpriv"):
        skip("needs root and setpriv", "util-linux")
    scenarios = HERE / "scenarios"
    tests = [[HERE / "field_cleanup_test.py", ledger_node], [HERE / "radio_test.py", radio],
             [HERE / "run_scenario.py", "--ledger-node", ledger_node, scenarios / "baseline"],
             [HERE / "run_scenario.py", "--ledger-node", ledger_node, "--radio", radio, scenarios / "radio"],
             [HERE / "soak.py", "--ledger-node", ledger_node],
             [SMOKE, "--ledger-node", ledger_node, "--rabit", "", "--transports", "fastdds", "--logs", ""],
             [INTEROP / "late_network_test.py", ledger_node, "fastdds"],
             [INTEROP / "outage_test.py", ledger_node, "fastdds"],
             [INTEROP / "suspension_test.py", ledger_node, "1", "fastdds"]]
    failed = 0
    for capability in CAPABILITIES:
        for test in tests:
            done = subprocess.run(["setpriv", f"--bounding-set=-{capability}", sys.executable, *map(str, test)],
                                  capture_output=True, text=True, timeout=300, check=False)
            is_good = done.returncode == SKIPPED and done.stdout.startswith("skipped: ") and not done.stderr
            failed += not is_good
            print(f"{'ok' if is_good else 'FAILED'}: {test[0].name} without {capability}: {done.stdout}{done.stderr}".rstrip())
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
