"""The reference of the Fortran modules, from their sources: comments that begin with !> and the statements below them.

FORD does not read this code: lengths told by functions of several arguments stop it, and comments whose first line has a
colon are lost. What is read here is the style that fprettify and the project's rules leave: one module a file, `private`
and a list of what is public, a comment above each entity.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

PROCEDURE = re.compile(r"((?:\w+(?:\([^()]*\))? +)*?)(subroutine|function) +(\w+) *(\([^)]*\))?(.*)", re.IGNORECASE)
TYPE = re.compile(r"type(?:, *[\w() ,]+)? *(?:::)? *(\w+)$", re.IGNORECASE)
WORDS_OF_FOLDERS = {
    "api": "Interfaces",
    "algorithms": "Algorithms",
    "compliance": "Compliance of bodies",
    "io": "Reading and writing",
    "reference": "Closed forms",
    "common": "Common tools",
}


@dataclass
class Entity:
    """What a module declares: names (several where they stand in one statement), comment, statements as they are shown."""

    names: list[str]
    words: list[str]
    statements: list[str]


@dataclass
class Module:
    name: str
    path: Path
    words: list[str]
    public: list[str] = field(default_factory=list)
    used: list[tuple[str, list[str]]] = field(default_factory=list)
    entities: list[Entity] = field(default_factory=list)
    hands_on: bool = False

    def entity(self, name: str) -> Entity | None:
        return next((entity for entity in self.entities if name.lower() in map(str.lower, entity.names)), None)


def write_fortran_reference(root: Path, folder: Path) -> None:
    """Write fortran/index.md and a page for every module of src below `folder`, the source of the site."""
    pages = folder / "fortran"
    pages.mkdir()
    modules = [module for path in sorted((root / "src").rglob("*.[fF]90")) for module in [read_module(path)] if module]
    by_name = {module.name: module for module in modules}
    lines = ["# Fortran modules", "", "From the comments of the sources; what is private is omitted.", ""]
    folders: dict[str, list[Module]] = {}
    for module in modules:
        folders.setdefault(module.path.relative_to(root / "src").parts[0], []).append(module)
        (pages / f"{module.name}.md").write_text(_page(root, module, by_name))
    front = [module for module in modules if module.name == "mfv"]
    if front:
        lines += ["Programs use one of them, [`mfv`](mfv.md).", "", *_words(front[0].words), ""]
    for name in sorted(folders, key=lambda name: list(WORDS_OF_FOLDERS).index(name) if name in WORDS_OF_FOLDERS else 99):
        lines += [f"## {WORDS_OF_FOLDERS.get(name, name.capitalize())}", "", "| module | what it is |", "| --- | --- |"]
        lines += [f"| [`{module.name}`]({module.name}.md) | {_first_sentence(module.words)} |" for module in folders[name]]
        lines.append("")
    (pages / "index.md").write_text("\n".join(lines) + "\n")


def read_module(path: Path) -> Module | None:
    """The module of a file, None where there is none."""
    module = None
    words: list[str] = []
    statements = list(_statements(path.read_text()))
    inside_procedure = 0
    i = 0
    while i < len(statements):
        text, comment = statements[i]
        i += 1
        words = comment
        procedure = PROCEDURE.fullmatch(text)
        if module is None:
            begins = re.fullmatch(r"module +(\w+)", text, re.IGNORECASE)
            if begins:
                module = Module(begins[1], path, words)
        elif re.match(r"use +\w+", text, re.IGNORECASE) and inside_procedure == 0:
            name, _, names = text[len("use") :].partition(",")
            module.used.append((name.strip(), re.findall(r"\w+", names.partition(":")[2])))
        elif text.lower() == "public":
            module.hands_on = True
        elif re.match(r"public *::", text, re.IGNORECASE):
            module.public += [name.strip().lower() for name in text.split("::")[1].split(",")]
        elif TYPE.fullmatch(text):
            block = [(text, [])]
            while i < len(statements) and not re.match(r"end *type", statements[i - 1][0], re.IGNORECASE):
                block.append(statements[i])
                i += 1
            module.entities.append(Entity([TYPE.fullmatch(text)[1]], words, _type_lines(block)))
        elif re.match(r"(abstract +)?interface\b", text, re.IGNORECASE):
            name = text.split()[-1]
            block = [text]
            while i < len(statements) and not re.match(r"end *interface", statements[i - 1][0], re.IGNORECASE):
                block.append(statements[i][0])
                i += 1
            module.entities.append(Entity([name], words, _indented(block)))
            begun = [PROCEDURE.fullmatch(line) for line in block[1:] if not line.lower().startswith("end ")]
            module.entities += [Entity([match[3]], [], _indented(block)) for match in begun if match]
        elif procedure and not text.lower().startswith("end "):
            inside_procedure += 1
            if inside_procedure == 1:
                module.entities.append(Entity([procedure[3]], words, _procedure_lines(text, procedure, statements[i:])))
        elif re.match(r"end *(subroutine|function)", text, re.IGNORECASE):
            inside_procedure -= 1
        elif inside_procedure == 0 and "::" in text and not re.match(r"(use|import|procedure|module)\b", text, re.IGNORECASE):
            names = _declared(text)
            module.entities.append(Entity(names, words, [text]))
            if re.search(r"\bpublic\b", text.split("::")[0], re.IGNORECASE):
                module.public += [name.lower() for name in names]
    return module


def _statements(source: str) -> Iterator[tuple[str, list[str]]]:
    """Statements without comments and with their continuation lines, each with the comment above it."""
    comment: list[str] = []
    text = ""
    for line in source.split("\n"):
        stripped = line.strip()
        if stripped.startswith("!>"):
            comment.append(stripped[2:].removeprefix(" "))
            continue
        if stripped.startswith(("!", "#")):
            continue
        if not stripped:
            comment = comment if text else []
            continue
        text += _without_comment(stripped).removeprefix("&").strip() if text else _without_comment(stripped)
        if text.endswith("&"):
            text = text[:-1]
            continue
        yield " ".join(text.split()) if "'" not in text and '"' not in text else text.strip(), comment
        text, comment = "", []


def _declared(statement: str) -> list[str]:
    """Names that a declaration declares, with what is between brackets and quotes omitted."""
    rest = statement.split("::", 1)[1]
    before = None
    while before != rest:
        before, rest = rest, re.sub(r"\([^()]*\)|\[[^][]*\]|'[^']*'|\"[^\"]*\"", "", rest)
    return [found[1] for part in rest.split(",") if (found := re.match(r"\s*([A-Za-z]\w*)", part))]


def _without_comment(line: str) -> str:
    quote = ""
    for place, character in enumerate(line):
        if quote:
            quote = "" if character == quote else quote
        elif character in "'\"":
            quote = character
        elif character == "!":
            return line[:place].rstrip()
    return line


def _type_lines(block: list[tuple[str, list[str]]]) -> list[str]:
    """A type with its public components and bound procedures, their comments above them."""
    lines, private = [block[0][0]], False
    for text, comment in block[1:]:
        if re.fullmatch(r"private|sequence", text, re.IGNORECASE):
            private = True
        elif re.match(r"contains$", text, re.IGNORECASE):
            private = False
            lines.append(text)
        elif re.match(r"end *type", text, re.IGNORECASE):
            lines.append(text)
        elif not private and not re.search(r"\bprivate\b", text.split("::")[0], re.IGNORECASE):
            lines += [*(f"   ! {line}" for line in comment), f"   {text}"]
    return lines


def _procedure_lines(text: str, match: re.Match, after: list[tuple[str, list[str]]]) -> list[str]:
    """The first statement of a procedure and the declarations of its arguments and result."""
    wanted = {name.strip().lower() for name in (match[4] or "()").strip("()").split(",")} - {""}
    result = re.search(r"result\((\w+)\)", match[5], re.IGNORECASE)
    wanted |= {result[1].lower()} if result else ({match[3].lower()} if match[2].lower() == "function" else set())
    lines = [text]
    for statement, _ in after:
        if not wanted or re.match(r"end *(subroutine|function)|contains$", statement, re.IGNORECASE):
            break
        if "::" in statement and not statement.lower().startswith("use"):
            names = {name.lower() for name in _declared(statement)}
            if names & wanted:
                lines.append(f"   {statement}")
                wanted -= names
    return [*lines, f"end {match[2]} {match[3]}"]


def _indented(block: list[str]) -> list[str]:
    depth, lines = 0, []
    for text in block:
        if text.lower().startswith("end"):
            depth -= 1
        lines.append("   " * depth + text)
        begins_procedure = PROCEDURE.fullmatch(text) and not text.lower().startswith(("end", "module procedure"))
        if begins_procedure or re.match(r"(abstract +)?interface\b", text, re.IGNORECASE):
            depth += 1
    return lines


def _page(root: Path, module: Module, modules: dict[str, Module]) -> str:
    # A hundred modules would fill the side bar of every page: they are found from the table.
    lines = ["---", "orphan: true", "---", "", f"# {module.name}", "", "[Fortran modules](index.md)", ""]
    lines += [*_words(module.words), "", f"`{module.path.relative_to(root)}`", ""]
    lines += _handed_on(module, modules)
    for entity in module.entities:
        shown = [name for name in entity.names if name.lower() in module.public]
        if shown:
            code = [piece for line in entity.statements for piece in _broken(line)]
            lines += [f"## {', '.join(shown)}", "", "```fortran", *code, "```", "", *_words(entity.words), ""]
    return "\n".join(lines)


def _handed_on(module: Module, modules: dict[str, Module]) -> list[str]:
    """What a module makes public of others: a table of names, of where they are from and of what they are."""
    rows = []
    for home, names in module.used:
        source = modules.get(home)
        for name in names or (source.public if source else []):
            if not module.hands_on and name.lower() not in module.public:
                continue
            entity = source.entity(name) if source else None
            words = (entity.words if entity else []) or (source.words if source else [])
            rows.append(f"| `{name}` | {f'[`{home}`]({home}.md)' if source else f'`{home}`'} | {_first_sentence(words)} |")
    return ["| name | from | what it is |", "| --- | --- | --- |", *rows, ""] if rows else []


def _broken(line: str, width: int = 96) -> list[str]:
    """A statement in lines that fit, cut after commas."""
    if len(line) <= width or line.lstrip().startswith("!"):
        return [line]
    place = line.rfind(", ", 0, width)
    if place < 0:
        return [line]
    return [line[: place + 1] + " &", *_broken("         " + line[place + 2 :], width)]


def _words(comment: list[str]) -> list[str]:
    """A comment as Markdown: indented lines are code, between backquotes too; nothing else is markup."""
    lines = []
    for block in re.split(r"\n[ \t]*\n", "\n".join(comment)):
        lines += [block if block.startswith("    ") else _literal(block), ""]
    return lines


def _literal(text: str) -> str:
    parts = re.split(r"(`[^`]+`)", text)
    return "".join(part if part.startswith("`") else re.sub(r"([\\*_$<\[\]{}|#])", r"\\\1", part) for part in parts)


def _first_sentence(comment: list[str]) -> str:
    words = " ".join(" ".join(comment).split("  ")[0].split())
    return _literal(re.split(r"(?<=[\w)])(?<!\beq)(?<!\bsection)[.:;] ", words, maxsplit=1)[0].rstrip("."))
