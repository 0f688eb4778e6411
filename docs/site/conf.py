"""Sphinx's settings for the site: scripts/docs.sh stages the pages in build/docs/source by stage.py and builds them."""

import importlib.util
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "docs/site"), str(ROOT / "python")]

project = "MFV"
author = "The MFV developers"
version = release = (ROOT / "VERSION").read_text().strip()
html_title = f"MFV {release}"

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx_design", "sphinx_copybutton", "sphinx.ext.mathjax", "docstrings"]
myst_enable_extensions = ["dollarmath", "colon_fence"]
myst_fence_as_directive = ["math"]
myst_heading_anchors = 4
exclude_patterns = ["**/.*"]
root_doc = "index"

nitpicky = True
# Types of other projects, whose documents are not here; and names that only annotations use.
nitpick_ignore_regex = [("c:identifier", r"(size_t|int\d+_t)"), ("py:.*", r".*")]

autodoc_default_options = {"members": True, "undoc-members": True, "exclude-members": "count,index"}
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
autodoc_mock_imports = ["plotly", "tqdm", "xarray", "h5netcdf", "pandas", "imageio_ffmpeg"]
python_use_unqualified_type_names = True
python_maximum_signature_line_length = 90
default_role = "code"

html_theme = "furo"
# MathJax in one file, with its fonts, from the package that brings it along: no network is needed.
MATHJAX = Path(importlib.util.find_spec("sphinx-mathjax-offline").submodule_search_locations[0], "static/mathjax/tex-svg.js")
mathjax_path = MATHJAX.name
html_static_path = [str(ROOT / "docs/site/static"), str(MATHJAX)]
html_css_files = ["site.css"]
html_show_sphinx = False
html_show_copyright = False
smartquotes = False
html_copy_source = False
html_theme_options = {"navigation_with_keys": True}
pygments_style = "friendly"
pygments_dark_style = "github-dark"
copybutton_prompt_text = "$ "
