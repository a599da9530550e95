#!/usr/bin/env python3
"""What ROS 2's own rosidl_adapter makes of message packages is taken as it is: each file comes through rabit_ros_idl and idlc.

Usage: rosidl_test.py ROS_IDL IDLC PLUGIN PACKAGES
PACKAGES: a folder of packages. Ends with 77 where Debian's python3-rosidl is not installed."""

import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2]))
from skipped import skip  # noqa: E402

PYTHON = "/usr/bin/python3"  # whose packages are Debian's
# Runs in a process of its own: it prints its steps to standard output, and breaks if Python redirects that.
ADAPT = """
import pathlib, sys
from rosidl_adapter.msg import convert_msg_to_idl
for package, message, folder in zip(*[iter(map(pathlib.Path, sys.argv[1:]))] * 3):
    convert_msg_to_idl(package, package.name, message.relative_to(package), folder)
"""


def problem(argv):
    """What a program says if it fails, with its arguments."""
    done = subprocess.run(argv, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
    return [f"{argv}: {done.stderr}{done.stdout}"] if done.returncode else []


def main():
    ros_idl, idlc, plugin, packages = sys.argv[1:]
    if problem([PYTHON, "-c", "import rosidl_adapter.msg"]):
        skip("there is no rosidl_adapter", "python3-rosidl")
    messages = sorted(pathlib.Path(packages).resolve().glob("*/msg/*.msg"))
    with tempfile.TemporaryDirectory(prefix="rabit_rosidl_") as work:
        adapted, made, generated = (pathlib.Path(work, name) for name in ("adapted", "made", "generated"))
        generated.mkdir()
        arguments, failures = [], []
        for message in messages:
            package = message.parents[1]
            for folder in (adapted, made):
                (folder / package.name / "msg").mkdir(parents=True, exist_ok=True)
            arguments += [package, message, adapted / package.name / "msg"]
        failures += problem([PYTHON, "-c", ADAPT, *arguments])
        files = [file.relative_to(adapted) for file in sorted(adapted.glob("*/msg/*.idl"))]
        for file in files:
            failures += problem([ros_idl, file.parts[0], adapted / file, made / file])
        for file in files:
            failures += problem([idlc, "-f", "case-sensitive", "-W", "no-implicit-extensibility", "-I", made, "-l", plugin,
                                 "-o", generated, made / file])
    print("\n".join(failures) or f"{len(files)} messages")
    sys.exit(1 if failures or len(files) != len(messages) or not files else 0)


if __name__ == "__main__":
    main()
