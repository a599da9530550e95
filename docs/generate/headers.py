"""Copies the public headers for Doxygen, with their comments in its form: `///` above a declaration, `///<` behind."""

import re

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


def in_doxygens_form(text):
    lines, shown = text.splitlines(), []
    column = None  # of the comment behind the code of the line above
    for at, line in enumerate(lines):
        full, behind = FULL.match(line), BEHIND.match(line)
        if full and column == len(full["space"]):
            shown.append(f"{full['space']}///<{escaped(full['text'])}")
            continue
        column = None
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


def copy(headers, to):
    """Each header by the name by which programs include it."""
    for header in headers:
        place = to / str(header).rpartition("/include/")[2]
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(in_doxygens_form(header.read_text()))
