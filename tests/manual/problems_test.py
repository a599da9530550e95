"""Each problem that the code can report is on the page docs/what_rabit_tells_you.md, by the first word of its subject, and the
page has no other.

Usage: problems_test.py ROOT
"""

import pathlib
import re
import sys

# A file with one of these words makes or passes on problems.
ABOUT = re.compile(r"\b(?:Gateway::Problem|SettingsProblem)\b|\bfleet\.problems\b")
WORD = r'(?:std::string\()?"([a-z_]+)[ "]'
# The ways in which the subject of a new problem is written.
MADE = [re.compile(pattern) for pattern in (
    r"[Pp]roblems\.(?:push_back|emplace_back)\(\s*\{?\s*" + WORD,
    r"Problem\{\s*" + WORD,
    r"Note\(\{\s*" + WORD,
    r"\bAddProblem\(\s*" + WORD,
    r"\badd\(\s*" + WORD,
    r"\breturn \{" + WORD,
    r"(?:\.|->)(?:subject|Setting) =[^;,]*?" + WORD,
)]
MAKES = re.compile(r"[Pp]roblems\.(?:push_back|emplace_back)\(|Problem\{|Note\(\{|(?:\.|->)(?:subject|Setting) = ")
# Files that pass on problems of others, or make them of a name that another file gives.
PASS_ON = {"gateway/report/ProblemLog.cpp", "gateway/presence/RecentProblems.cpp", "gateway/backfill/Mail.cpp",
           "gateway/lab/facts/FleetFacts.cpp", "gateway/foreign/ForeignTopics.cpp",
           "gateway/tool/NodeProblems.cpp",
           "transport/common/SettingsCheck.cpp"}  # the last: a node does not start with them
ROWS = re.compile(r"^\| `([a-z_]+)(?: [^`:]*)?: ", re.MULTILINE)


def words_of(text):
    return {word for pattern in MADE for word in pattern.findall(text)}


def without_comments(text):
    return re.sub(r"//[^\n]*", "", text)


def made_in(root):
    """The words by file, and the files whose way of making problems is not known."""
    words, unknown = {}, []
    for room in "gateway", "transport":
        for file in sorted([*(root / room).rglob("*.cpp"), *(root / room).rglob("*.h")]):
            text = without_comments(file.read_text())
            name = str(file.relative_to(root))
            if not ABOUT.search(text) or name in PASS_ON:
                continue
            for word in words_of(text):
                words.setdefault(word, name)
            if MAKES.search(text) and not words_of(text):
                unknown.append(name)
    return words, unknown


def differences(words, page):
    rows = set(ROWS.findall(page))
    return [f"{file}: the problem `{word}` is not on the page" for word, file in sorted(words.items()) if word not in rows] + [
        f"the page has `{row}`, which no code makes" for row in sorted(rows - set(words))]


def main():
    root = pathlib.Path(sys.argv[1])
    assert words_of('problems.push_back(\n    {"send " + to, "", why});') == {"send"}
    assert words_of('problem.subject = empty ? "network" : setting;') == {"network"}
    assert differences({"send": "a.cpp"}, "| `queue Q: full` |") == [
        "a.cpp: the problem `send` is not on the page", "the page has `queue`, which no code makes"]
    words, unknown = made_in(root)
    wrong = differences(words, (root / "docs/what_rabit_tells_you.md").read_text())
    wrong += [f"{name}: makes problems in a way that this test does not read" for name in unknown]
    print("\n".join(wrong or [f"{len(words)} problems"]))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
