"""Broken links of the repository's Markdown files, or of a site. Standard library only.

    python3 scripts/check_links.py                     # every Markdown file of the source tree
    python3 scripts/check_links.py build/docs/html     # every page of a site

Files and anchors are checked; web addresses are listed, not fetched. Exit code 1 if a link is broken.
"""

import argparse
import html.parser
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import unquote, urldefrag

ROOT = Path(__file__).resolve().parents[1]
MARKDOWN_LINK = re.compile(r"(\[(?:[^][]|\[[^]]*\])*\])\(([^()\s]+(?:\([^()\s]*\))?)\)")
WEB = re.compile(r"[a-z][a-z0-9+.-]*:|//", re.IGNORECASE)


def main() -> int:
    parser = argparse.ArgumentParser(description="List broken links.")
    parser.add_argument("site", nargs="?", type=Path, help="folder of HTML files (default: the repository's Markdown files)")
    site = parser.parse_args().site
    pages = read_site(site) if site else read_markdown(markdown_files())
    broken, web = check(pages)
    for address in sorted(web):
        print(f"not fetched: {address}")
    for line in broken:
        print(line, file=sys.stderr)
    links = sum(len(page.links) for page in pages.values())
    print(f"{len(pages)} pages, {links} links, {len(web)} addresses of the web, {len(broken)} broken links")
    return 1 if broken else 0


class Page:
    """Anchors of a page, and its links as they are written."""

    def __init__(self) -> None:
        self.anchors: set[str] = set()
        self.links: list[str] = []


def check(pages: dict[Path, Page]) -> tuple[list[str], set[str]]:
    """Broken links, one per line, and the web addresses."""
    broken, web = [], set()
    for path, page in pages.items():
        for link in page.links:
            if WEB.match(link):
                if not link.startswith(("data:", "mailto:", "javascript:")):
                    web.add(link)
                continue
            file, anchor = urldefrag(link)
            target = (path.parent / unquote(file.split("?")[0])).resolve() if file else path
            if target.is_dir() and (target / "index.html").exists():
                target /= "index.html"
            if not target.exists():
                broken.append(f"{path}: {link}: no such file")
            elif anchor and target in pages and unquote(anchor) not in pages[target].anchors | {"", "top"}:
                broken.append(f"{path}: {link}: no such anchor in {target.name}")
    return broken, web


def markdown_files() -> list[Path]:
    """The Markdown files of the source tree, without build and hidden folders."""
    files = sorted(ROOT.rglob("*.md"))
    return [path for path in files if not any(part == "build" or part[0] == "." for part in path.relative_to(ROOT).parts)]


def read_markdown(files: list[Path]) -> dict[Path, Page]:
    pages = {}
    for path in files:
        page = pages[path.resolve()] = Page()
        text = path.read_text()
        page.links = [link for _, link in links_of(text)]
        page.anchors = set(anchors_of(text))
    return pages


def links_of(text: str) -> Iterator[tuple[str, str]]:
    """Words and targets of the links and pictures of a Markdown text, code aside."""
    for match in MARKDOWN_LINK.finditer(without_code(text)):
        yield match[1], match[2]


def anchors_of(text: str) -> Iterator[str]:
    """Anchors that repository browsers give to the headings of a Markdown text."""
    seen: dict[str, int] = {}
    for heading in re.findall(r"^#{1,6} +(.+?)(?: +#+)? *$", without_code(text, inline=False), re.MULTILINE):
        words = re.sub(r"!?\[([^]]*)\]\([^)]*\)", r"\1", heading).lower()
        slug = re.sub(r"[^\w\- ]", "", words).replace(" ", "-")
        number = seen[slug] = seen.get(slug, -1) + 1
        yield f"{slug}-{number}" if number else slug


def without_code(text: str, inline: bool = True) -> str:
    """A Markdown text without fenced code, and without code between backquotes where that is wanted."""
    text = re.sub(r"^(```+|~~~+).*?^\1`*$", "", text, flags=re.MULTILINE | re.DOTALL)
    return re.sub(r"`[^`\n]*`", "`x`", text) if inline else text


class _Reader(html.parser.HTMLParser):
    def __init__(self, page: Page) -> None:
        super().__init__()
        self.page = page

    def handle_starttag(self, tag: str, attributes: list[tuple[str, "str | None"]]) -> None:
        for name, value in attributes:
            if value is None:
                continue
            if name == "id" or (name == "name" and tag == "a"):
                self.page.anchors.add(value)
            elif name in ("href", "src") and not (tag == "link" and value.startswith("#")):
                self.page.links.append(value)


def read_site(folder: Path) -> dict[Path, Page]:
    pages = {}
    for path in sorted(folder.rglob("*.html")):
        page = pages[path.resolve()] = Page()
        _Reader(page).feed(path.read_text(errors="replace"))
    return pages


if __name__ == "__main__":
    sys.exit(main())
