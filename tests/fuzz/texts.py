"""Texts to fuzz with: cases and columns of numbers, taken apart into groups and keys, changed, and put together again.

Everything random comes from `random`, an object with the methods of random.Random: Hypothesis gives one whose choices it can shrink.
"""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]

#: Small cases beside those of the examples: every shape, law, algorithm and linear solver, in milliseconds.
SMALL = """&scene coupling='full' /
&body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3 /
&body shape='disk', radius=0.25, rigid=.true. /
&mesh nodes=21, half_width=0.01225 /
&friction law='coulomb', mu=0.7 /
&step normal_force=1.0e-3, friction=.false. /
&step tangential_force=2.8e-4 /
&step tangential_force=-2.8e-4, cycles=2 /
"""
CIRCLES = """&body shape='hole', radius=0.26, shear_modulus=1.0, poisson_ratio=0.3, kernel='fourier' /
&body shape='disk', radius=0.25, rigid=.true. /
&mesh nodes=20, half_angle=20, normals='radial' /
&friction law='coulomb', mu=0.3 /
&step normal_force=1.0e-3 /
&step tangential_force=1e-4, cycles=3, steady_tolerance=1e-3 /
"""
MATRIX = """&body shape='matrix', file='matrix.h5' /
&body shape='disk', radius=0.25, rigid=.true. /
&friction law='coulomb', mu=0.7 /
&step normal_force=1.0e-5 /
&step tangential_force=3e-6 /
"""
VARIANTS = {
    "&scene coupling='full' /": ["&scene coupling='goodman' /", "&scene coupling='none', plane='stress' /"],
    "&body shape='disk', radius=0.25, rigid=.true. /": [
        "&body shape='disk', radius=0.25, shear_modulus=2.0, poisson_ratio=0.2 /",
        "&body shape='flat_punch', half_width=0.01, rigid=.true. /",
        "&body shape='rounded_punch', half_width=0.01, edge_radius=0.1, rigid=.true. /",
        "&body shape='wedge', angle=3, rigid=.true. /",
        "&body shape='power', coefficient=2.0, exponent=4, rigid=.true. /",
        "&body shape='profile', file='columns.txt', interpolation='monotone_cubic', level='line', height_scale=-1, rigid=.true. /",
        "&body shape='profile', file='columns.txt', rigid=.true. /",
        "&body shape='wave', amplitude=1e-3, wavelength=0.1, rigid=.true. /",
    ],
    "&body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3 /": [
        "&body shape='hole', radius=0.26, youngs_modulus=2.6, poisson_ratio=0.3, datum=1.0 /",
        "&body shape='half_plane', elasticity='orthotropic', youngs_modulus_1=3, youngs_modulus_2=1, youngs_modulus_3=1, "
        "poisson_ratio_12=0.3, poisson_ratio_13=0.3, poisson_ratio_23=0.3, shear_modulus_12=0.5, axis_angle=30 /",
        "&body shape='half_plane', elasticity='anisotropic', compliances=1, -0.3, 1, 0.1, 0, 2.6, -0.3, -0.3, 1, 0 /",
    ],
    "&mesh nodes=21, half_width=0.01225 /": [
        "&mesh nodes=21 /",
        "&mesh nodes=21, half_width=0.03, gap='parabolic' /",
        "&mesh nodes=21, period=0.1 /",
        "",
    ],
    "&friction law='coulomb', mu=0.7 /": [
        "&friction law='static_kinetic', mu_static=0.7, mu_kinetic=0.5 /",
        "&friction law='weakening', mu_static=0.7, mu_kinetic=0.5, weakening_distance=1e-4 /",
        "&friction law='dahl', mu=0.7, stiffness=1e3, exponent=1 /",
        "&friction law='coulomb', mu_file='columns.txt' /",
    ],
    "&step tangential_force=2.8e-4 /": [
        "&step force_ratio=0.4 /\n&solver stepping='leap', accuracy=1e-3 /",
        "&step shift=1e-5 /\n&solver linear_solver='fft' /",
        "&step approach=1e-4, shift=1e-5 /\n&solver algorithm='conventional', load_step=0.2, iterations=50 /",
        "&step moment=1e-6 /\n&solver stepping='nominal', linear_solver='dgesv', load_step=0.2 /",
        "&step rotation=1e-4 /\n&output error_estimate=.true., states='steps' /",
    ],
}
COLUMNS = (
    "# x and height\n-1 0.5\n-0.01 0.1\n0 0\n0.01, 0.1\n1 0.5\n",
    "-1 0.7 0.5\n0 0.6 0.5\n1\t0.7 0.4\n",
    'Trace,A\r\r\n"x [um]";z;\r\r\n4\r\r\n1;-0,5;"0,5";\r\r\n2;0;nan;\r\r\n3;0,5;;\r\r\n4;1;0,25;\r\r\n',
    "\0".join("tangential_force\ttime\n1e-4\t0\n-1e-4\t1\n") + "\0",
)

#: Values of every kind and none: extreme numbers, texts of all sorts, what looks like a number to Fortran alone.
VALUES = [
    "0",
    "-0",
    "1",
    "-1",
    "2",
    "3",
    "5",
    "0.5",
    "1e-3",
    "1e-12",
    "1e-300",
    "4.9e-324",
    "1e-310",
    "1e30",
    "1e150",
    "1e300",
    "1.7976931348623157e308",
    "1e309",
    "-1e308",
    "1d0",
    "1.e0",
    ".5",
    "5.",
    ".",
    "+",
    "-",
    "+1",
    "1e",
    "1e+",
    "e1",
    "1e-3e",
    "1..2",
    "1+2",
    "1-300",
    "1+300",
    "1d400",
    "--1",
    "3*1",
    "2*'a'",
    "1,2,3",
    "1;2",
    "0x10",
    "nan",
    "NaN",
    "inf",
    "-Infinity",
    "(1,2)",
    "2147483647",
    "2147483648",
    "-2147483649",
    "99999999999999999999",
    "1_8",
    "1_wp",
    ".true.",
    ".false.",
    "t",
    "f",
    "T",
    ".t.",
    ".tru",
    "true",
    "yes",
    "'full'",
    "'goodman'",
    "'none'",
    "'half_plane'",
    "'disk'",
    "'hole'",
    "'flat_punch'",
    "'profile'",
    "'matrix'",
    "'fft'",
    "'coulomb'",
    "'all'",
    "''",
    "'",
    "'",
    "''''",
    '""',
    '"\'"',
    "'a''b'",
    "'columns.txt'",
    "'matrix.h5'",
    "'base.nml'",
    "'.'",
    "'/'",
    "'/nowhere/x'",
    "'/dev/null'",
    "'no.h5'",
    "'%'",
    "'friction%mu'",
    "'step(0)%shift'",
    "'step(99999999999)%shift'",
    "'step(1%shift'",
    "'body(2)%radius'",
    "'dundurs_beta'",
    "'scene'",
    "'ümlaut'",
    "''",
]
TOKENS = [
    "&",
    "/",
    "!",
    ",",
    "=",
    "'",
    '"',
    "\n",
    "\r\n",
    "\t",
    " ",
    ",,",
    "&end",
    "$step",
    "!'",
    "''",
    "\0",
    "\xff",
    "é",
    "(",
    ")",
    "%",
    "*",
    ";",
]
ODD_LINES = [
    "! a comment with ' and & and /",
    "",
    "\t\t",
    "&step /",
    "&STEP SHIFT=1e-6 /",
    "/",
    "&",
    "& step /",
    "x" * 5000,
    "&scene /",
]

#: Cases that are legitimately too long or too large to fuzz with: more nodes, cycles or terms than these digits hold.
TOO_LONG = re.compile(rb"(nodes|harmonics)\s*=[\s,]*\+?0*[1-9]\d{3,}", re.IGNORECASE)


@cache
def cases() -> list[str]:
    """Cases to begin with: the examples with fewer nodes, the templates of the Python package, and the small ones."""
    found = [SMALL, CIRCLES, MATRIX] + [SMALL.replace(old, new) for old, variants in VARIANTS.items() for new in variants]
    paths = [*ROOT.glob("examples/*.nml"), *ROOT.glob("examples/dissertation/*.nml"), *ROOT.glob("python/mfv/templates/*.nml")]
    texts = [path.read_text() for path in sorted(paths)]
    found += [re.sub(r"nodes\s*=\s*\d+", "nodes=31", text) for text in texts if "&sweep" not in text]
    return found


def key_table(markdown: str) -> dict[str, list[str]]:
    """Groups and their keys, from the tables of --keys."""
    table: dict[str, list[str]] = {}
    for line in markdown.splitlines():
        if line.startswith("### &"):
            group = line[5:].split()[0]
        elif match := re.match(r"\| `(\w+)` ", line):
            table.setdefault(group, []).append(match[1])
    return table


#: One group of a text: its name and its (key, values as written).
Group = tuple[str, list[tuple[str, str]]]


@cache
def taken_apart(text: str) -> tuple[tuple[str, tuple[tuple[str, str], ...]], ...]:
    """A valid text as groups and keys."""
    without_comments = re.sub(r"(?m)((?:'[^'\n]*'|\"[^\"\n]*\"|[^!'\"\n])*)!.*$", r"\1", text)
    groups = re.findall(r"&(\w+)((?:'[^']*'|\"[^\"]*\"|[^/'\"])*)/", without_comments)
    key = re.compile(r"(\w+)\s*=\s*((?:'[^']*'|\"[^\"]*\"|[^='\"])*?)(?=,?\s*\w+\s*=|\s*$)")
    return tuple((name, tuple((k, v.strip().rstrip(",")) for k, v in key.findall(body))) for name, body in groups)


def changed_text(random: Any, texts: list[str], keys: dict[str, list[str]]) -> bytes:
    """One of the texts, with some of its groups, keys and values changed, moved, doubled or taken out; then perhaps some bytes."""
    groups: list[Group] = [(name, list(entries)) for name, entries in taken_apart(random.choice(texts))]
    for _ in range(random.randint(0, 4)):
        _change(random, groups, texts, keys)
    data = _written(random, groups).encode("utf-8", "surrogateescape")
    if random.randint(0, 2) == 0:
        data = changed_bytes(random, data, [token.encode() for token in TOKENS])
    return data


def changed_whole(random: Any, texts: list[str]) -> bytes:
    """One of the texts as it is written, with some bytes changed."""
    return changed_bytes(random, random.choice(texts).encode(), [token.encode() for token in TOKENS])


def _change(random: Any, groups: list[Group], texts: list[str], keys: dict[str, list[str]]) -> None:
    """One change of groups, keys or values."""
    kind = random.choice(("value", "value", "value", "key", "number", "add", "drop", "double", "move", "group", "foreign", "name"))
    name, entries = random.choice(groups) if groups else ("step", [])
    place = random.randrange(len(entries)) if entries else -1
    if kind == "value" and entries:
        entries[place] = (entries[place][0], _value(random, texts))
    elif kind == "number" and entries:
        number = random.choice(("1", "-1", "0.1", "10", "1e6", "1e-6", "1e12", "1e-12", "1e-200", "1e200"))
        entries[place] = (entries[place][0], re.sub(r"^[-+.\d]+([eEdD][-+]?\d+)?", number, entries[place][1]))
    elif kind == "key" and entries:
        entries[place] = (random.choice(keys.get(name, ["x"])), entries[place][1])
    elif kind == "add":
        entries.insert(random.randint(0, len(entries)), (random.choice(keys.get(name, ["x"])), _value(random, texts)))
    elif kind == "drop" and entries:
        del entries[place]
    elif kind == "double" and entries:
        entries.insert(random.randint(0, len(entries)), entries[place])
    elif kind == "move" and len(groups) > 1:
        groups.insert(random.randrange(len(groups)), groups.pop(random.randrange(len(groups))))
    elif kind == "group" and groups:
        if random.randint(0, 1):
            groups.insert(random.randrange(len(groups)), (name, list(entries)))
        else:
            del groups[random.randrange(len(groups))]
    elif kind == "foreign":
        other = taken_apart(random.choice(texts))
        if other:
            taken = random.choice(other)
            groups.insert(random.randint(0, len(groups)), (taken[0], list(taken[1])))
    elif kind == "name" and groups:
        groups[random.randrange(len(groups))] = (random.choice(list(keys) + ["stpe", "Body", "vary", "x", "_", "1"]), entries)


def _value(random: Any, texts: list[str]) -> str:
    """A value from the list, of another key, a list of such, or a number of any size."""
    kind = random.randint(0, 9)
    if kind < 4:
        return random.choice(VALUES)
    if kind < 7:
        entries = [value for _, group in taken_apart(random.choice(texts)) for _, value in group]
        return random.choice(entries) if entries else "1"
    if kind == 7:
        return ", ".join(random.choice(VALUES) for _ in range(random.randint(0, 4)))
    return f"{random.choice(('', '-'))}{random.randint(0, 9999)}e{random.randint(-320, 310)}"


def _written(random: Any, groups: list[Group]) -> str:
    """The text of groups, in one of several ways to write it."""
    separator = random.choice((", ", ", ", " ", "\n   ", ",\t", "\r\n"))
    equals = random.choice(("=", "=", " = ", "= ", "=\n"))
    end = random.choice((" /\n", " /\n", "/\r\n", "\n/\n", " / ! end\n", "/"))
    parts = []
    for name, entries in groups:
        parts.append(f"&{name} " + separator.join(f"{key}{equals}{value}" for key, value in entries) + end)
        if random.randint(0, 19) == 0:
            parts.append(random.choice(ODD_LINES) + "\n")
    return "".join(parts)


def changed_bytes(random: Any, data: bytes, tokens: list[bytes]) -> bytes:
    """Bytes with some flipped, overwritten, cut, doubled, moved or put in."""
    changed = bytearray(data)
    for _ in range(random.randint(1, 6)):
        if not changed:
            return bytes(changed)
        at = random.randrange(len(changed))
        length = min(random.choice((1, 1, 2, 4, 8, 64)), len(changed) - at)
        kind = random.randint(0, 7)
        if kind <= 1:
            changed[at] ^= 1 << random.randint(0, 7)
        elif kind == 2:
            changed[at : at + length] = bytes([random.choice((0, 1, 0x7F, 0x80, 0xFF, 0x20, 0x2F))]) * length
        elif kind == 3:
            changed[at : at + length] = b""
        elif kind == 4:
            changed[at:at] = changed[at : at + length] * random.choice((1, 1, 2, 50))
        elif kind == 5:
            changed[at:at] = random.choice(tokens)
        elif kind == 6:
            changed[at : at + length] = random.choice(tokens)
        elif random.randint(0, 3) == 0:
            del changed[at:]
        else:
            other = random.randrange(len(changed))
            changed[at : at + length] = changed[other : other + length]
    return bytes(changed)
