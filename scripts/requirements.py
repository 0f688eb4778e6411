"""Print the dependencies of the Python package from pyproject.toml for pip: python requirements.py [EXTRA].

With this installed the package runs from the source tree."""

import re
import sys
from pathlib import Path

if sys.version_info >= (3, 11):
    import tomllib
else:
    from pip._vendor import tomli as tomllib


def of_extra(project: dict, extra: str) -> list[str]:
    """Requirements of an extra, those of the extras that it names among them."""
    found = []
    for requirement in project["optional-dependencies"][extra]:
        own = re.fullmatch(rf"{project['name']}\[(.*)\]", requirement)
        found += [line for name in own[1].split(",") for line in of_extra(project, name)] if own else [requirement]
    return found


def main() -> None:
    """Print the requirements, one per line."""
    project = tomllib.loads((Path(__file__).resolve().parents[1] / "pyproject.toml").read_text())["project"]
    requirements = project["dependencies"] + [line for extra in sys.argv[1:] for line in of_extra(project, extra)]
    print("\n".join(requirements))


if __name__ == "__main__":
    main()
