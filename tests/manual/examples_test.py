"""Each public class is named in an example of the manual (docs/examples), whose tests the build compiles and runs; each
example is on a page, and each marker that a page includes exists.

Usage: examples_test.py ROOT
"""

import pathlib
import re
import sys

# A class that is defined in a public header, not only declared. Structs are data, which examples use by their members.
CLASS = re.compile(r"^class (\w+)(?: final)?(?: : [^;{]*)?\n\{", re.MULTILINE)
DETAIL = re.compile(r"^namespace Detail\n\{.*?^\}  // namespace Detail", re.MULTILINE | re.DOTALL)
INCLUDED = re.compile(r"^```\{literalinclude\} (?P<file>\S+)\n(?P<options>(?::.*\n)*)", re.MULTILINE)


def classes_without_example(headers, examples):
    words = set(re.findall(r"\w+", examples))
    return [f"{name}: the class {one} has no example in docs/examples" for name, text in headers
            for one in CLASS.findall(DETAIL.sub("", text)) if one not in words]


def headers_without_example(headers, examples):
    return [f"{name}: no example of docs/examples includes it" for name, text in headers
            if f"#include <{name}>" not in examples and "#include" in text]


def wrong_markers(page):
    wrong = []
    for match in INCLUDED.finditer(page.read_text()):
        file = page.parent / match["file"]
        if not file.exists():
            wrong.append(f"{page}: there is no {match['file']}")
            continue
        wanted = re.findall(r"^:(?:start-after|end-before|start-at): \"?(.*?)\"?$", match["options"], re.MULTILINE)
        wrong += [f"{page}: {match['file']} has no {marker}" for marker in wanted if marker not in file.read_text()]
    return wrong


def main():
    root = pathlib.Path(sys.argv[1])
    sys.path.insert(0, str(root / "docs/generate"))
    import api
    assert classes_without_example([("x.h", "class A\n{\n"), ("y.h", "class B : public A\n{\n")], "A a;") == [
        "y.h: the class B has no example in docs/examples"]
    sources = sorted((root / "docs/examples").glob("*.cpp"))
    examples = "\n".join(file.read_text() for file in sources)
    headers = [(str(file).rpartition("/include/")[2], file.read_text()) for file in api.public_headers(root)]
    wrong = classes_without_example(headers, examples) + headers_without_example(headers, examples)
    listed = (root / "docs/api/examples.dox").read_text()
    wrong += [f"docs/api/examples.dox does not list {file.name}" for file in sources if f"@example {file.name}\n" not in listed]
    for page in sorted((root / "docs").rglob("*.md")):
        wrong += wrong_markers(page)
    print("\n".join(wrong or [f"{len(headers)} headers, {len(sources)} examples"]))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
