"""Runs problems in several processes, writes the records, the table and the smallest problems of the findings.

python -m truth --scenes 10000 --seed 0 --processes 2 --folder build/deep/truth
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from tqdm import tqdm

from .campaign import findings, record, record_of, table
from .generate import problem
from .known import known_findings, suite_seeds, write_known
from .shrink import shrunk

#: Problems of one process.
CHUNK = 20
#: Before and after the table in a page.
MARK = "<!-- truth -->\n"


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m truth", description=__doc__)
    parser.add_argument("--scenes", type=int, default=10000)
    parser.add_argument("--seed", type=int, default=0, help="of the first scene")
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--folder", type=Path, default=Path("truth"))
    parser.add_argument("--shrink", type=int, default=0, help="findings of which the smallest problem is searched for")
    parser.add_argument("--only", help="--shrink: only findings that begin with this")
    parser.add_argument("--update-known", action="store_true", help="run the seeds of the suite and write known_findings.txt anew")
    parser.add_argument("--document", type=Path, help="page whose part between '<!-- truth -->' marks becomes the table")
    parser.add_argument("--worker", action="store_true", help="write the records to the standard output")
    given = parser.parse_args()
    seeds = range(given.seed, given.seed + given.scenes)
    if given.worker:
        for seed in seeds:
            started = time.process_time()
            found = record(seed)
            found["seconds"] = time.process_time() - started  # to choose the seeds of the suite
            print(json.dumps(found, default=float), flush=True)
        return 0
    if given.update_known:
        write_known([(seed, name) for seed in suite_seeds() for name in findings(record(seed))])
        return 0
    given.folder.mkdir(parents=True, exist_ok=True)
    records = _records(seeds, given.processes, given.folder / "records.jsonl")
    (given.folder / "table.md").write_text(table(records))
    print(table(records))
    _list(records, given.folder / "findings.txt")
    for one in _chosen(records, given.shrink, given.only):
        _shrink(one, given.folder)
    if given.document:
        _document(given.document, records, given.seed)
    return _report(records, given.seed)


def _records(seeds: range, processes: int, path: Path) -> list[dict[str, Any]]:
    """Records of all seeds, also written to a file as they come."""
    chunks = [seeds[start : start + CHUNK] for start in range(0, len(seeds), CHUNK)]
    found: list[dict[str, Any]] = []
    with ThreadPoolExecutor(processes) as pool, path.open("w") as file, tqdm(total=len(seeds), disable=None) as bar:

        def collect(chunk: range) -> None:
            for one in _of_chunk(chunk):
                found.append(one)
                file.write(json.dumps(one) + "\n")
                file.flush()
                bar.update()

        list(pool.map(collect, chunks))
    return sorted(found, key=lambda one: one["seed"])


def _of_chunk(seeds: range) -> Iterator[dict[str, Any]]:
    """Records of some seeds from a process; a seed that ends it has the fate 'crash'."""
    seed = seeds.start
    while seed < seeds.stop:
        command = [sys.executable, "-m", "truth", "--worker", "--seed", str(seed), "--scenes", str(seeds.stop - seed)]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
            assert process.stdout
            for line in process.stdout:
                yield json.loads(line)
                seed += 1
        if seed < seeds.stop:
            labels = problem(seed).labels
            message = f"exit code {process.returncode}"
            yield {"seed": seed, **labels, "fate": "crash", "message": message, "verdicts": {}, "relations": {}, "ordinary": False}
            seed += 1


def _list(records: list[dict[str, Any]], path: Path) -> None:
    """A line for every finding."""
    lines = []
    for one in records:
        for name in findings(one):
            values = one["verdicts"].get(name, [])
            numbers = " ".join(f"{value:.3g}" for value in values[1:])
            labels = " ".join(str(one.get(key)) for key in ("shape", "law", "loads", "mesh", "outcome"))
            lines.append(f"{one['seed']} {name} [{labels}] {numbers} {one.get('message', '')}".rstrip())
    path.write_text("\n".join(lines) + "\n")


def _chosen(records: list[dict[str, Any]], most: int, only: str | None) -> list[tuple[int, str]]:
    """Seed and name of the first findings of every kind, which is a quantity with a kind of mesh."""
    seen: Counter[str] = Counter()
    chosen = []
    for one in records:
        for name in findings(one):
            kind = f"{name} {one['mesh']}"
            if (only is None or name.startswith(only)) and seen[kind] == 0:
                seen[kind] += 1
                chosen.append((one["seed"], name))
    return chosen[:most]


def _shrink(chosen: tuple[int, str], folder: Path) -> None:
    seed, name = chosen
    smallest = shrunk(problem(seed), lambda made: name in findings(record_of(made, seed)))
    where = folder / "smallest" / f"{seed}-{name.replace('/', '-').replace(' ', '-').replace(':', '')}"
    smallest.write(where)
    verdict = record_of(smallest, seed)["verdicts"].get(name)
    (where / "finding.txt").write_text(f"{name}: error, bar, uncertainty, value, truth: {verdict}\n")


def _document(page: Path, records: list[dict[str, Any]], seed: int) -> None:
    """Replace the table in a page."""
    before, _, rest = page.read_text().partition(MARK)
    _, _, after = rest.partition(MARK)
    text = f"\n{len(records)} scenes from seed {seed} (`scripts/deep-check.sh truth`):\n\n{table(records)}"
    page.write_text(before + MARK + text + MARK + after)


def _report(records: list[dict[str, Any]], seed: int) -> int:
    """Print the line of results; 1 if there are findings that are not known."""
    words = Counter(verdict[0] for one in records for verdict in one["verdicts"].values())
    every, known = max(sum(words.values()), 1), known_findings()
    new = [(one["seed"], name) for one in records for name in findings(one) if (one["seed"], name) not in known]
    shares = ", ".join(f"{100 * words[word] / every:.1f} % {word}" for word in ("right", "within bars", "flagged", "unknown"))
    crashes = sum(one["fate"] == "crash" for one in records)
    print(
        f"{len(records)} scenes from seed {seed}: {sum(words.values())} quantities, {shares}, {words['finding']} findings; "
        f"{len(new)} with relations and ends that are not known, {crashes} crashes"
    )
    return 1 if new or crashes else 0


if __name__ == "__main__":
    sys.exit(main())
