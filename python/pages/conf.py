"""Sphinx: the pages of the Python package, and the page that leads to the rest (.ci/pages)."""

import kairos

project = "kairos"
version = release = kairos.__version__
extensions = ["sphinx.ext.autodoc"]
autodoc_member_order = "bysource"
autodoc_typehints = "none"
html_theme = "alabaster"
html_theme_options = {"description": "What happens between two frames, and what it costs to know"}
html_show_copyright = False
