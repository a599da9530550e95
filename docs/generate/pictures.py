"""Sphinx extension: puts the manual's SVG pictures into the page itself, so that they have the colours of the page."""

import html
import pathlib

from docutils import nodes


def inline(app, doctree, _):
    for image in list(doctree.findall(nodes.image)):
        uri = image["uri"]
        if uri.startswith("docs/pictures/") and uri.endswith(".svg"):
            svg = (pathlib.Path(app.srcdir) / uri).read_text()
            label = html.escape(image.get("alt", ""), quote=True)
            svg = svg.replace("<svg ", f'<svg data-alt="{label}" ', 1)
            image.replace_self(nodes.raw("", f'<div class="picture">{svg}</div>', format="html"))


def setup(app):
    app.connect("doctree-resolved", inline)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
