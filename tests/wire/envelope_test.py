#!/usr/bin/env python3
"""The independent reader opens the recorded datagrams, and the program opens those that the reader makes.

Usage: envelope_test.py READER VECTORS CHECK"""

import importlib.util
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from skipped import skip  # noqa: E402


def main():
    reader, vectors, check = sys.argv[1:]
    if importlib.util.find_spec("cryptography") is None:
        skip("Python's package cryptography is missing", "python3-cryptography")
    with tempfile.TemporaryDirectory() as folder:
        made = pathlib.Path(folder) / "made.txt"
        read = subprocess.run([sys.executable, reader, vectors, str(made)], check=False)
        if read.returncode != 0:
            return read.returncode
        text = made.read_text()
        opened = subprocess.run([check, str(made)], check=False).returncode
        # The check can fail: a datagram that differs in its last digit.
        lines = text.splitlines()
        at = next(i for i, line in enumerate(lines) if line.startswith("pairwise "))
        lines[at] = lines[at][:-1] + ("1" if lines[at][-1] == "0" else "0")
        made.write_text("\n".join(lines) + "\n")
        damaged = subprocess.run([check, str(made)], check=False).returncode
    return 0 if opened == 0 and damaged == 1 else 1


if __name__ == "__main__":
    sys.exit(main())
