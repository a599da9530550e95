"""What the mutation scripts of the simulations share: changing a source, and reading what a simulation says."""

import re
import subprocess
from collections import namedtuple

# Replaces one piece of text of a file; noticed_by says who must notice.
Mutation = namedtuple("Mutation", "name file find replace noticed_by")


def apply(text, mutation):
    """The text of the file, changed. What is to be replaced must be there once; where lines are broken does not count."""
    words = [re.escape(word) for word in re.findall(r"\w+|[^\w\s]", mutation.find)]
    found = list(re.finditer(r"\s*".join(words), text))
    if len(found) != 1:
        raise RuntimeError(f"its text is in {mutation.file} {len(found)} times, not once")
    return text[:found[0].start()] + mutation.replace + text[found[0].end():]


def simulate(program, seeds, jobs, first=1):
    """Runs a simulation of so many seeds from the first. Returns the violated invariant, or None."""
    try:
        run = subprocess.run([str(program), "--first", str(first), "--seeds", str(seeds), "--jobs", str(jobs)], capture_output=True,
                             text=True, timeout=600)
    except subprocess.TimeoutExpired:
        return "the simulation does not end"
    if run.returncode == 0:
        return None
    lines = run.stdout.splitlines()
    failed = [number for number, line in enumerate(lines) if line.startswith("FAILED")]
    if not failed:
        return f"ended with status {run.returncode}"
    return f"seed {lines[failed[0]].split()[2].rstrip(',')}, {lines[failed[0] + 1]}"
