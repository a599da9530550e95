"""Sphinx's settings of the manual. build.py calls Sphinx on a copy of all pages, with RABIT_TAGS: the file in which
Doxygen lists the classes and their pages."""

import os
import sys
import xml.etree.ElementTree

from docutils import nodes
from pygments.lexers import get_lexer_by_name

project = "Distributed Rabit"
version = release = os.environ.get("RABIT_VERSION", "")
root_doc = "docs/index"
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "generate"))
extensions = ["myst_parser", "sphinx_copybutton", "pictures"]
myst_enable_extensions = ["colon_fence", "deflist"]
myst_heading_anchors = 4
# The sections of a README are linked from others by the anchors that GitHub gives them.
suppress_warnings = ["myst.header"]
# `--option` in text stays as it is.
smartquotes = False
highlight_language = "text"
# Only what is typed is copied, not the prompt nor the output.
copybutton_prompt_text = "$ "
copybutton_line_continuation_character = "\\"

html_theme = "furo"
html_title = "Rabit"
html_static_path = ["static"]
html_css_files = ["rabit.css"]
html_logo = "static/logo.svg"
html_favicon = "static/logo.svg"
html_show_sphinx = False
html_show_copyright = False
html_show_sourcelink = False
html_copy_source = False
html_theme_options = {
    "light_css_variables": {"color-brand-primary": "#0b6b58", "color-brand-content": "#0b6b58"},
    "dark_css_variables": {"color-brand-primary": "#4fd1b0", "color-brand-content": "#5fd6b8"},
}


def pages_of_classes():
    """The page of each class, by its whole name."""
    tags = xml.etree.ElementTree.parse(os.environ["RABIT_TAGS"])
    return {one.findtext("name"): one.findtext("filename") for one in tags.iter("compound")
            if one.get("kind") in ("class", "struct", "namespace")}


def setup(app):
    pages = pages_of_classes()

    def api(name, rawtext, text, lineno, inliner, options=None, content=None):
        """{api}`RabitManager`: a link to the page of Rabit::RabitManager."""
        page = pages.get(f"Rabit::{text}", pages.get(text))
        if page is None:
            return [], [inliner.reporter.error(f"there is no public class {text}", line=lineno)]
        above = "../" * inliner.document.settings.env.docname.count("/")
        link = nodes.reference(rawtext, "", refuri=f"{above}api/{page}", internal=True)
        link += nodes.literal(text, text)
        return [link], []

    app.add_role("api", api)
    # `idl` is another language to Pygments.
    app.add_lexer("idl", type(get_lexer_by_name("omg-idl")))
