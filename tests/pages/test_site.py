"""The documents: valid links and complete references. scripts/docs.sh builds the site."""

import importlib
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
CHECKER = ROOT / "scripts/check_links.py"


@pytest.fixture(scope="module")
def site():
    """Import a module of docs/site by its name."""
    places = [str(ROOT / "docs/site"), str(ROOT / "scripts")]
    sys.path[:0] = places
    yield importlib.import_module
    for place in places:
        sys.path.remove(place)


def test_links_of_the_documents_lead_somewhere():
    checked = subprocess.run([sys.executable, CHECKER], cwd=ROOT, capture_output=True, text=True)
    assert checked.returncode == 0, checked.stderr
    assert int(re.search(r"(\d+) links", checked.stdout)[1]) > 100


def test_broken_links_of_a_document_are_named(tmp_path, site):
    check_links = site("check_links")
    (tmp_path / "other.md").write_text("# A `code` heading\n\n## Twice\n\n## Twice\n\n```\n# no heading\n```\n")
    text = (
        "# Here\n[a](#here) [b](other.md#a-code-heading) [c](other.md#twice-1)\n"
        "[d](https://example.org/) `[e](nowhere.md)`\n"
        "```\n[f](nowhere.md)\n```\n![g](nowhere.png) [h](other.md#no-heading) [i](#there) [![j](other.md)](gone.md)\n"
    )
    (tmp_path / "one.md").write_text(text)
    broken, web = check_links.check(check_links.read_markdown([tmp_path / "one.md", tmp_path / "other.md"]))
    assert web == {"https://example.org/"}
    assert [line.removeprefix(f"{tmp_path}/one.md: ") for line in broken] == [
        "nowhere.png: no such file",
        "other.md#no-heading: no such anchor in other.md",
        "#there: no such anchor in one.md",
        "gone.md: no such file",
    ]


def test_broken_links_of_a_site_are_named(tmp_path):
    (tmp_path / "folder").mkdir()
    (tmp_path / "folder/index.html").write_text('<h1 id="top-of-it">x</h1><a name="old">y</a>')
    links = ("folder/#top-of-it", "folder/index.html#old", "#", "folder/index.html#new", "https://example.org")
    (tmp_path / "index.html").write_text("".join(f'<a href="{link}">x</a>' for link in links) + '<img src="gone.png">')
    checked = subprocess.run([sys.executable, CHECKER, tmp_path], capture_output=True, text=True)
    assert checked.returncode == 1
    assert "index.html#new: no such anchor" in checked.stderr and "gone.png: no such file" in checked.stderr
    assert len(checked.stderr.splitlines()) == 2
    assert "not fetched: https://example.org" in checked.stdout and "2 pages, 6 links, 1 addresses" in checked.stdout


def test_the_c_reference_has_every_function_and_status(tmp_path, site):
    site("c_reference").write_c_reference(ROOT / "include", tmp_path / "c.md")
    page = (tmp_path / "c.md").read_text()
    header = re.sub(r"/\*.*?\*/", "", (ROOT / "include/mfv.h").read_text(), flags=re.DOTALL)
    functions = re.findall(r"^\w+ (mfv_\w+)\(", header, re.MULTILINE)
    assert len(functions) > 20
    for function in functions:
        assert re.search(rf"^(\.\. c:function::)? +\w+ {function}\(", page, re.MULTILINE), function
    for name in re.findall(r"^typedef (?:struct \w+|struct \w+ \{.*?\}) (\w+);", header, re.MULTILINE | re.DOTALL):
        assert re.search(rf"^::::\{{c:(type|struct)\}} {name}$", page, re.MULTILINE), name
    for status in re.findall(r"^MFV_STATUS\((\w+)", (ROOT / "include/mfv_status.def").read_text(), re.MULTILINE):
        assert f"| `{status}` |" in page


def test_the_fortran_reference_has_every_module_and_public_name(tmp_path, site):
    site("fortran_reference").write_fortran_reference(ROOT, tmp_path)
    index = (tmp_path / "fortran/index.md").read_text()
    sources = sorted((ROOT / "src").rglob("*.[fF]90"))
    assert len(sources) > 80
    for path in sources:
        text = re.sub(r"&\n *&?", "", path.read_text())
        name = re.search(r"^module (\w+)", text, re.MULTILINE)[1]
        assert f"[`{name}`]({name}.md)" in index
        page = (tmp_path / f"fortran/{name}.md").read_text().lower()
        for names in re.findall(r"^ *public *:: *(.+)", text, re.MULTILINE):
            for public in re.findall(r"\w+", names.split("!")[0]):
                assert re.search(rf"\b{public.lower()}\b", page), (name, public)


def test_a_procedure_is_shown_with_its_arguments(tmp_path, site):
    path = tmp_path / "one.f90"
    path.write_text("""!> One thing: with a colon.
module one
   use two, only: three
   implicit none
   private
   public :: half, point_type

   !> A point, `x` and *y*.
   type :: point_type
      private
      !> Hidden.
      real :: x
   contains
      procedure :: move
   end type point_type

contains

   !> Half of
   !> a number.
   pure real function half(number, &   ! why not
                           other) result(value)
      real, intent(in) :: number(size('!', 1):), other
      real :: local

      value = number/2
   end function half

   subroutine move(self)
      class(point_type), intent(inout) :: self
   end subroutine move

end module one
""")
    module = site("fortran_reference").read_module(path)
    assert (module.name, module.words, module.public) == ("one", ["One thing: with a colon."], ["half", "point_type"])
    entities = {entity.names[0]: entity for entity in module.entities}
    assert entities["half"].words == ["Half of", "a number."]
    assert entities["half"].statements == [
        "pure real function half(number, other) result(value)",
        "   real, intent(in) :: number(size('!', 1):), other",
        "end function half",
    ]
    shown = ["type :: point_type", "contains", "   procedure :: move", "end type point_type"]
    assert entities["point_type"].statements == shown
    assert module.used == [("two", ["three"])] and not module.hands_on
