"""Links of static pages: what each page refers to, and what is not there. No page of another site is asked for."""

import html
import pathlib
import re
import urllib.parse

# The pages are made by programs, which quote all values; text is escaped.
LINK = re.compile(r"""<(?:a|link|script|img)\b[^>]*?\b(?:href|src)=(?:"([^"]*)"|'([^']*)')""")
NAME = re.compile(r"""\b(?:id|name)="([^"]+)\"""")


class Page:
    """The targets of a page's links, and the names that a link may have behind `#`."""

    def __init__(self, text):
        self.links = {html.unescape(one or other) for one, other in LINK.findall(text)}
        self.names = {html.unescape(name) for name in NAME.findall(text)}


def broken(folder, pages, without_places=None):
    """A line for each link of these pages that leads nowhere, below that folder. Of links within the folder
    `without_places` only the files must exist: Doxygen's lists of members name places that it leaves out."""
    read, exists = {}, {}

    def page_at(path):
        if path not in read:
            read[path] = Page(path.read_text(errors="replace"))
        return read[path]

    def place_of(path):
        """Where it is, if it is below the folder; empty if there is no such file."""
        if path not in exists:
            exists[path] = path.resolve() if path.exists() else None
        return exists[path]

    wrong = []
    for path in pages:
        for link in sorted(page_at(path).links):
            parts = urllib.parse.urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = path.parent / urllib.parse.unquote(parts.path) if parts.path else path
            where = f"{path.relative_to(folder)}: {link}"
            place = place_of(target)
            if place is None:
                wrong.append(f"{where}: there is no such file")
            elif not place.is_relative_to(folder.resolve()):
                wrong.append(f"{where}: leads out of the manual")
            elif parts.fragment and place.suffix == ".html" and without_places not in path.parents:
                if not page_at(place).names & {parts.fragment, urllib.parse.unquote(parts.fragment)}:
                    wrong.append(f"{where}: the page has no such place")
    return wrong


def pages_below(folder):
    return sorted(pathlib.Path(folder).resolve().rglob("*.html"))
