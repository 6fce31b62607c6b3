"""Sphinx: the pages of the Python package, and the page that leads to the rest (.ci/pages)."""

import inspect
import re

import kairos

project = "kairos"
version = release = kairos.__version__
extensions = ["sphinx.ext.autodoc"]
autodoc_member_order = "bysource"
autodoc_typehints = "none"
html_theme = "alabaster"
html_theme_options = {"description": "What happens between two frames, and what it costs to know"}
html_show_copyright = False

_ARGUMENT = re.compile(r"^([a-z_]+(?:, [a-z_]+)*): +(.*)$")


def _parameters(thing):
    try:
        return set(inspect.signature(thing).parameters)
    except (TypeError, ValueError):
        return set()


def as_fields(app, what, name, thing, options, lines):
    """Docstrings are written for `help`. Lines "parameter: meaning", with what is indented below
    them, become a list of fields; a block that is indented below an empty line, code."""
    known = _parameters(thing)
    out, in_fields, in_code = [], False, False
    for i, line in enumerate(lines):
        field = _ARGUMENT.match(line)
        if field and not set(field[1].split(", ")) <= known:
            field = None
        indented = line.startswith(" ") or not line.strip()
        if not in_fields and not in_code and line.startswith(" ") and not lines[i - 1].strip():
            out += ["::", ""]
            in_code = True
        elif in_code and not indented:
            out.append("")
            in_code = False
        if bool(field or (in_fields and indented)) != in_fields:
            out.append("")
        in_fields = bool(field or (in_fields and indented))
        out.append(f":{field[1]}: {field[2]}" if field else line)
    lines[:] = out


def setup(app):
    app.connect("autodoc-process-docstring", as_fields)
