"""Runs Doxygen on the public headers, in the colours of the manual."""

import pathlib
import subprocess

import headers

AWESOME = pathlib.Path("/usr/share/doxygen-awesome-css")
HERE = pathlib.Path(__file__).resolve().parent.parent / "api"


def public_headers(root):
    """All but compat/, which is for programs that exist."""
    folders = (root / top for top in ("base", "core", "idl", "transport", "gateway"))
    return [file for folder in folders for file in sorted(folder.rglob("include/rabit/**/*.h"))
            if "compat" not in file.parts]


def quoted(files):
    return " ".join(f'"{file}"' for file in files)


def write(root, out, html, version):
    """Returns the file that lists the classes and their pages."""
    html.mkdir(parents=True)
    examples = {file.name: file.read_text() for file in (root / "docs/examples").glob("*.cpp")}
    headers.copy(public_headers(root), examples, out / "headers")
    header, unused, tags = out / "header.html", out / "unused", out / "tags.xml"
    subprocess.run(["doxygen", "-w", "html", header, unused, unused], cwd=out, check=True, capture_output=True)
    header.write_text(header.read_text().replace("</head>", (HERE / "head.html").read_text() + "</head>"))
    given = {
        "PROJECT_NUMBER": version, "OUTPUT_DIRECTORY": out, "HTML_OUTPUT": html, "HTML_HEADER": header,
        "GENERATE_TAGFILE": tags, "STRIP_FROM_PATH": out / "headers", "STRIP_FROM_INC_PATH": out / "headers",
        "INPUT": quoted([out / "headers", *sorted(HERE.glob("*.dox"))]), "EXAMPLE_PATH": root / "docs/examples",
        "HTML_EXTRA_STYLESHEET": quoted([AWESOME / "doxygen-awesome.css", AWESOME / "doxygen-awesome-sidebar-only.css",
                                         AWESOME / "doxygen-awesome-sidebar-only-darkmode-toggle.css", HERE / "api.css"]),
        "HTML_EXTRA_FILES": quoted([AWESOME / "doxygen-awesome-darkmode-toggle.js",
                                    AWESOME / "doxygen-awesome-fragment-copy-button.js"]),
    }
    settings = out / "Doxyfile"
    settings.write_text((HERE / "Doxyfile").read_text() + "".join(f"{name} = {value}\n" for name, value in given.items()))
    subprocess.run(["doxygen", "-q", settings], check=True)
    return tags
