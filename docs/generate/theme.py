"""Mends the theme Furo as Debian 12 has it: it was packed without Furo's own build, so three things are missing. A theme
that is whole stays as it is."""

import pathlib
import re

NORMALIZE = "@import url(/javascript/normalize.css/normalize.css);"
DARK = re.compile(r'@media not print \{\n  body\[data-theme="dark"\] \{(?P<colors>.*?)\}\n', re.DOTALL)


def with_imports(script, gumshoe):
    """A script that imports another is a module, and Sphinx loads it as a plain one: both become one."""
    imported = re.compile(r"^import Gumshoe from .*$", re.MULTILINE)
    return gumshoe + "\n" + imported.sub("", script) if imported.search(script) else script


def with_styles(style, normalize):
    """The style that resets a browser's own is not taken from a web server, and the dark colours hold where the system
    asks for them, too."""
    style = style.replace(NORMALIZE, normalize)
    dark = DARK.search(style)
    if dark and "prefers-color-scheme" not in style:
        style += ('@media not print { @media (prefers-color-scheme: dark) { body:not([data-theme="light"]) {'
                  f'{dark["colors"]}}} body:not([data-theme="light"]) .only-light {{ display: none !important; }} '
                  'body:not([data-theme="light"]) .only-dark { display: block !important; } } }\n')
    return style


def mend(furo, to):
    """Writes the mended files to a folder of static files, which Sphinx prefers to those of the theme."""
    static = pathlib.Path(furo) / "theme/furo/static"
    normalize = pathlib.Path("/usr/share/javascript/normalize.css/normalize.css")
    gumshoe = static / "scripts/gumshoe-patched.js"
    made = {
        "scripts/furo.js": with_imports((static / "scripts/furo.js").read_text(),
                                        gumshoe.read_text() if gumshoe.exists() else ""),
        "styles/furo.css": with_styles((static / "styles/furo.css").read_text(),
                                       normalize.read_text() if normalize.exists() else "body { margin: 0; }"),
    }
    for name, text in made.items():
        (to / name).parent.mkdir(parents=True, exist_ok=True)
        (to / name).write_text(text)
