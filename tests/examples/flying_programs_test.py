#!/usr/bin/env python3
"""Checks that programs that fly contain nothing that only the ground needs.

Usage: flying_programs_test.py NM READELF TOOL PROGRAM...
TOOL is the program `rabit`, which contains what the others must not: so the check itself is checked.
"""
import re
import subprocess
import sys

# Namespaces and classes: the tool, merged recordings, replays, types known only at run time, simulated networks, servers.
GROUND_SYMBOLS = re.compile(r"\b(Rabit::(?:Tool|Merge|Replay|Dynamic)::|Rabit::Simulated\w+|boost::beast::)")
GROUND_LIBRARIES = re.compile(r"\[(lib(?:cycloneddsidl|ssl)\.so[^\]]*)\]")


def found_in(nm: str, readelf: str, program: str) -> set[str]:
    symbols = subprocess.run([nm, "--defined-only", "--demangle", program], capture_output=True, text=True, check=True).stdout
    assert "Rabit::GatewayManager::" in symbols, f"{program} has no symbols of a gateway: is it stripped?"
    libraries = subprocess.run([readelf, "--dynamic", program], capture_output=True, text=True, check=True).stdout
    return set(GROUND_SYMBOLS.findall(symbols)) | set(GROUND_LIBRARIES.findall(libraries))


def main(nm: str, readelf: str, tool: str, *programs: str) -> None:
    assert len(found_in(nm, readelf, tool)) >= 5, f"{tool} should contain what the ground needs"
    for program in programs:
        found = found_in(nm, readelf, program)
        assert not found, f"{program} contains what only the ground needs: {', '.join(sorted(found))}"


if __name__ == "__main__":
    main(*sys.argv[1:])
