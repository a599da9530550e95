"""Copies the public headers for Doxygen, with their comments in its form: `///` above a declaration, `///<` behind."""

import re

DEFINED = re.compile(r"^class (\w+)[^;]*$")
FULL = re.compile(r"^(?P<space>\s*)//(?P<text>(?: .*)?)$")
BEHIND = re.compile(r"^(?P<code>\s*[^\s/].*?) +//(?P<text> .*)$")
# In these Doxygen takes no commands, nor backslashes.
LITERAL = re.compile(r"(`[^`]*`|\"[^\"]*\")")


def escaped(text):
    """Only code, in backticks or indented, may hold what Doxygen would take for a command or for HTML."""
    if text.startswith("     "):
        return text
    parts = LITERAL.split(text)
    parts[::2] = [re.sub(r"[<>@#\\%]", r"\\\g<0>", part) for part in parts[::2]]
    return "".join(parts)


def next_code(lines, at):
    """The line below the comment at this line."""
    while at < len(lines) and FULL.match(lines[at]):
        at += 1
    return lines[at].strip() if at < len(lines) else ""


def places_of(name, examples):
    """A paragraph with the examples of a class that Doxygen overlooks: it finds no class within <>."""
    if any(re.search(rf"(?<!<)\bRabit::{name}\b", text) for text in examples.values()):
        return []
    links = [f'<a href="{file.replace(".", "_8")}-example.html">{file}</a>' for file, text in sorted(examples.items())
             if re.search(rf"<Rabit::{name}\b", text)]
    return ["///", "/// @par Examples", f"/// {', '.join(links)}"] if links else []


def in_doxygens_form(text, examples):
    lines, shown = text.splitlines(), []
    column = None  # of the comment behind the code of the line above
    for at, line in enumerate(lines):
        full, behind = FULL.match(line), BEHIND.match(line)
        if full and column == len(full["space"]):
            shown.append(f"{full['space']}///<{escaped(full['text'])}")
            continue
        column = None
        defined = DEFINED.match(line)
        if defined:
            above = len(shown) - shown[-1].startswith("template")
            if shown[above - 1].startswith("///"):
                shown[above:above] = places_of(defined[1], examples)
        if full:
            below = next_code(lines, at)
            documents = below and not below.startswith(("#", "namespace", "}"))
            shown.append(f"{full['space']}///{escaped(full['text'])}" if documents else line)
        elif behind and behind["code"].count('"') % 2 == 0:
            column = line.index("//", len(behind["code"]))
            shown.append(f"{behind['code']}  ///<{escaped(behind['text'])}")
        else:
            shown.append(line)
    return "\n".join(shown) + "\n"


def copy(headers, examples, to):
    """Each header by the name by which programs include it. `examples`: texts by the names of their files."""
    for header in headers:
        place = to / str(header).rpartition("/include/")[2]
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(in_doxygens_form(header.read_text(), examples))
