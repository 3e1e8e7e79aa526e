"""Sphinx: pages in Markdown, and the reference from the docstrings of what `import wheelchair_fmu` has."""

from functools import partialmethod
from itertools import count

from nbclient import NotebookClient
from nbformat.v4 import nbbase

from wheelchair_fmu import __version__

project = "wheelchair-fmu"
copyright = "the wheelchair-fmu authors, MIT licence"
release = version = __version__
extensions = ["myst_nb", "sphinx.ext.autodoc"]
myst_heading_anchors = 3
default_role = "code"
autodoc_typehints = "signature"
autodoc_member_order = "bysource"
autodoc_default_options = {"members": True}
html_theme = "alabaster"
html_theme_options = {
    "description": "a manual wheelchair on real tyres, as an FMU",
    "page_width": "1300px",
    "body_max_width": "none",
}
html_sidebars = {"**": ["about.html", "searchbox.html", "navigation.html"]}
html_extra_path = ["LICENSE", "CITATION.cff", "references.bib", "sweep.toml", "make_inputs.py"]
exclude_patterns = ["contents.txt"]
# The tutorials run when the site is built, each in an empty folder of its own; one that fails or takes too long fails the site.
nb_execution_mode = "force"
nb_execution_in_temp = True
nb_execution_raise_on_error = True
nb_execution_timeout = 300
nb_merge_streams = True
# What a command prints comes in pieces of a hundred characters, which are joined as they are.
NotebookClient.__init__ = partialmethod(NotebookClient.__init__, coalesce_streams=True)
# Names of cells are drawn by chance, and are in the notebooks that readers take with them; two builds are to give the same.
numbers = count(1)
nbbase.random_cell_id = lambda: f"cell-{next(numbers)}"
