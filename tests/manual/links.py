"""Links of static pages: what each page refers to, and what is not there. No page of another site is asked for."""

import html.parser
import pathlib
import urllib.parse


class Page(html.parser.HTMLParser):
    """The targets of a page's links, and the names that a link may have behind `#`."""

    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.links, self.names = [], set()
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        for key, value in attrs:
            if key in ("id", "name") and value:
                self.names.add(value)
            elif (key == "href" and tag in ("a", "link") or key == "src") and value:
                self.links.append((self.getpos()[0], value))


def broken(folder, pages, without_places=None):
    """A line for each link of these pages that leads nowhere, below that folder. Of links within the folder
    `without_places` only the files must exist: Doxygen's lists of members name places that it leaves out."""
    read = {}

    def page_at(path):
        if path not in read:
            read[path] = Page(path.read_text(errors="replace"))
        return read[path]

    wrong = []
    for path in pages:
        for line, link in page_at(path).links:
            parts = urllib.parse.urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = path.parent / urllib.parse.unquote(parts.path) if parts.path else path
            where = f"{path.relative_to(folder)}:{line}: {link}"
            if not target.exists():
                wrong.append(f"{where}: there is no such file")
            elif not target.resolve().is_relative_to(folder.resolve()):
                wrong.append(f"{where}: leads out of the manual")
            elif parts.fragment and target.suffix == ".html" and without_places not in path.parents:
                if not page_at(target).names & {parts.fragment, urllib.parse.unquote(parts.fragment)}:
                    wrong.append(f"{where}: the page has no such place")
    return wrong


def pages_below(folder):
    return sorted(pathlib.Path(folder).rglob("*.html"))
