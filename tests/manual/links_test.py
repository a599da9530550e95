"""The manual can be built, and each of its links leads to a page, a place or a picture that it has. It needs nothing of
another site: no script, style, font or picture.

Usage: links_test.py ROOT BIN OUT VERSION
"""

import pathlib
import re
import subprocess
import sys

import links

# Scripts, styles, fonts and pictures that a page loads by itself.
LOADED = re.compile(r"""(?:<(?:script|img|link)\b[^>]*\b(?:src|href)=["']|url\(["']?)(?:https?:)?//[^"')]+""")
SELF_TEST = {"good.html": '<a href="other.html#place">x</a><img src="p.png">', "other.html": '<p id="place">',
             "p.png": "", "bad.html": '<a href="none.html">x</a><a href="other.html#no">x</a>'}


def finds_what_is_broken(folder):
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in SELF_TEST.items():
        (folder / name).write_text(text)
    found = links.broken(folder, links.pages_below(folder))
    return [line.split(":")[0] for line in found] == ["bad.html", "bad.html"]


def main():
    root, programs, out, version = sys.argv[1:]
    out = pathlib.Path(out).resolve()
    if not finds_what_is_broken(out / "self_test"):
        print("the check of links does not find broken ones")
        return 1
    done = subprocess.run([sys.executable, pathlib.Path(root) / "docs/build.py", root, out, programs, version], check=False)
    if done.returncode != 0:
        return done.returncode
    pages = links.pages_below(out / "html")
    wrong = links.broken(out / "html", pages, out / "html/api")
    for page in [*pages, *(out / "html").rglob("*.css")]:
        wrong += [f"{page.relative_to(out)}: loads {match[0]}" for match in LOADED.finditer(page.read_text(errors="replace"))]
    print("\n".join(wrong[:50] or [f"{len(pages)} pages"]))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
