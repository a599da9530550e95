"""Writes a page for each command of the program `rabit`, from what its --help says."""

import re
import subprocess

# Headings of CLI11, and the words that people know.
HEADINGS = {"Positionals": "Arguments", "Subcommands": "Commands"}
COMMAND = re.compile(r"^  (\w+) {2,}(.*)$", re.MULTILINE)


def help_of(rabit, *words):
    text = subprocess.run([rabit, *words, "--help"], capture_output=True, text=True, check=True).stdout
    # Called by its path.
    return re.sub(r"^Usage: \S*rabit", "Usage: rabit", text, flags=re.MULTILINE)


def commands_in(text):
    """The commands that a help lists, each with its line."""
    listed = text.partition("\nSubcommands:\n")[2].partition("\n\n")[0]
    return COMMAND.findall(listed)


def page_of(words, text):
    name = "rabit " + " ".join(words)
    first, _, rest = text.partition("\nUsage: ")
    usage, _, rest = rest.partition("\n")
    examples = re.search(r"\nExamples:\n((?:  .*\n)+)", rest)
    rest = rest.replace(examples[0], "") if examples else rest
    shown = [f"# {name}", "", first.strip() + ".", "", "```text", usage, "```", ""]
    if examples:
        lines = [f"$ {line.strip()}" for line in examples[1].splitlines()]
        shown += ["## Examples", "", "```console", *lines, "```", ""]
    return "\n".join([*shown, *sections(rest)]) + "\n"


def sections(text):
    """The parts of a help below their headings: options as a list of definitions, which a narrow screen can show."""
    shown = []
    for part in re.split(r"\n\n+", text.strip("\n")):
        heading, _, body = part.partition("\n")
        if not body.startswith("  ") or not heading.endswith(":"):
            shown += [part, ""]
            continue
        shown += [f"## {HEADINGS.get(heading[:-1], heading[:-1])}", ""]
        for entry in re.split(r"\n(?=  \S)", body):
            # The explanation is behind the name, or in the next line.
            name, *rest = re.split(r"\s{2,}", entry.strip(), maxsplit=1)
            says = " ".join(" ".join(rest).split())
            shown += [f"`{name}`", f": {escaped(says) or '-'}", ""]
    return shown


def escaped(text):
    return re.sub(r"(?<!`)([*_<>|])(?!`)", r"\\\1", text)


def write(rabit, folder):
    folder.mkdir(parents=True, exist_ok=True)
    whole = help_of(rabit)
    rows, pages = [], []
    for name, line in commands_in(whole):
        text = help_of(rabit, name)
        (folder / f"{name}.md").write_text(page_of([name], text))
        pages.append(name)
        rows += [f"[`rabit {name}`]({name}.md)", f": {escaped(line)}", ""]
        for inner, inner_line in commands_in(text):
            page = f"{name}_{inner}"
            (folder / f"{page}.md").write_text(page_of([name, inner], help_of(rabit, name, inner)))
            pages.append(page)
            rows += [f"[`rabit {name} {inner}`]({page}.md)", f": {escaped(inner_line)}", ""]
    index = folder / "index.md"
    toc = ["```{toctree}", ":hidden:", "", *pages, "```", ""]
    exits = re.search(r"^Exit code: .*$", whole, re.MULTILINE)
    index.write_text("\n".join([index.read_text(), *rows, exits[0] if exits else "", "", *toc]))
