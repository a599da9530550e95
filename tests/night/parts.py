"""The parts of the night, their newest results, and what is known to fail. Read README.md first."""

import json
import pathlib
import re
import subprocess

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
FLIES = ("base", "core", "idl", "transport", "gateway")  # folders whose commits make a part old


def parts():
    """Name -> settings, of parts.json."""
    return json.loads((HERE / "parts.json").read_text(encoding="utf-8"))


def results(path=HERE / "results.json"):
    """Part -> the result of its newest complete run."""
    return json.loads(path.read_text(encoding="utf-8"))


def write_results(all_results, path=HERE / "results.json"):
    path.write_text(json.dumps(all_results, indent=2, sort_keys=True, ensure_ascii=False) + "\n", encoding="utf-8")


def known(path=HERE / "known.md"):
    """The names of tests that known.md says fail, and why: lines "- `name`: cause"."""
    return dict(re.findall(r"^- `([^`]+)`: (\S.*)$", path.read_text(encoding="utf-8"), re.MULTILINE))


class History:
    """What git knows of the commits of this tree."""

    def __init__(self, root=ROOT):
        self._root = root

    def _git(self, *arguments):
        answer = subprocess.run(("git", "-C", str(self._root), *arguments), capture_output=True, text=True, check=False)
        return answer.stdout.strip() if answer.returncode == 0 else None

    def head(self):
        return self._git("rev-parse", "HEAD")

    def is_shallow(self):
        return self._git("rev-parse", "--is-shallow-repository") == "true"

    def changed_files(self):
        """Tracked files that differ from HEAD."""
        return self._git("diff", "--name-only", "HEAD").splitlines()

    def commits_since(self, commit, paths):
        """Number of commits that touch the paths and are not in `commit`'s history; None if git does not know it."""
        if self._git("merge-base", "--is-ancestor", commit, "HEAD") is None:
            return None
        return int(self._git("rev-list", "--count", f"{commit}..HEAD", "--", *paths))
