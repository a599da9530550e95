"""Copies the pages of the manual: all Markdown files of the project, so that their links to each other hold."""

import re
import shutil

LINK = re.compile(r"(?P<image>!?)\[(?P<text>(?:[^\[\]]|\[[^\[\]]*\])*)\]\((?P<target>[^()\s#]*)(?P<anchor>#[^()\s]*)?\)")


INCLUDE = re.compile(r"^```\{literalinclude\} (\S+)$", re.MULTILINE)


def of_project(folder):
    """All files but hidden ones and those of a build."""
    for entry in sorted(folder.iterdir()):
        if entry.is_dir():
            if not entry.name.startswith((".", "build", "__", "node_modules")):
                yield from of_project(entry)
        else:
            yield entry


def without_sources(text, page, root):
    """Links to folders lead to their README. A link to another file of the sources, which the manual has not, becomes
    its text."""
    def replaced(match):
        target = match["target"]
        if match["image"] or not target or ":" in target:
            return match[0]
        path = (page.parent / target).resolve()
        if path.is_dir() and (path / "README.md").exists():
            return f"[{match['text']}]({target.rstrip('/')}/README.md{match['anchor'] or ''})"
        is_source = path.exists() and path.suffix not in (".md", ".html") and root in path.parents
        return match["text"] if is_source else match[0]
    return LINK.sub(replaced, text)


def copy_file(file, root, to):
    place = to / file.relative_to(root)
    place.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(file, place)


def copy(root, to):
    root = root.resolve()
    for file in of_project(root):
        place = to / file.relative_to(root)
        if file.suffix == ".md":
            place.parent.mkdir(parents=True, exist_ok=True)
            text = file.read_text()
            place.write_text(without_sources(text, file, root))
            for included in INCLUDE.findall(text):
                copy_file((file.parent / included).resolve(), root, to)
        elif file.suffix in (".png", ".svg") or root / "docs" in file.parents:
            copy_file(file, root, to)
