"""Adds to a wheel the licence texts of the libraries it bundles: python wheel_licences.py WHEEL OUTPUT_FOLDER.

auditwheel has copied the libraries into mfv_contact.libs, under names with a checksum. Each is traced to the Debian package it comes from; the package's
copyright file is put beside the wheel's own licence. FFTW and GSL are covered by the GPL, and so is the wheel as a whole: its
metadata says so. Fails if the licence of a library is not found.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

#: Licence of the wheel as a whole, as metadata gives it: MFV's own, and those of what it bundles.
EXPRESSION = "BSD-3-Clause AND GPL-3.0-or-later"


def package_of(library: str) -> str:
    """Debian package that a bundled library comes from; `library`: its name in the wheel, libgsl-0f93aff2.so.27.0.0, with the checksum
    before the first point."""
    name = re.sub(r"-[0-9a-f]{8,}(?=\.)", "", library)
    found = subprocess.run(["dpkg", "-S", f"*/{name}"], capture_output=True, text=True, check=False)
    if found.returncode == 0:
        return found.stdout.split(":")[0]
    sys.exit(f"{library}: the Debian package it comes from was not found")


def main() -> None:
    """Unpack the wheel, add the texts, pack it again."""
    wheel, folder = Path(sys.argv[1]), Path(sys.argv[2])
    with tempfile.TemporaryDirectory() as work:
        subprocess.run([sys.executable, "-m", "wheel", "unpack", "--dest", work, wheel], check=True, stdout=subprocess.DEVNULL)
        (tree,) = Path(work).iterdir()
        (info,) = tree.glob("*.dist-info")
        texts = info / "licenses"
        texts.mkdir(exist_ok=True)
        packages = {package_of(path.name) for path in (tree / "mfv_contact.libs").iterdir()}
        for package in sorted(packages):
            shutil.copyfile(f"/usr/share/doc/{package}/copyright", texts / f"{package}.txt")
        for text in ("GPL-3", "LGPL-3", "GPL-2", "Apache-2.0"):
            shutil.copyfile(f"/usr/share/common-licenses/{text}", texts / f"{text}.txt")
        metadata = (info / "METADATA").read_text()
        metadata, count = re.subn(r"(?m)^License-Expression: .*$", f"License-Expression: {EXPRESSION}", metadata, count=1)
        if count != 1:
            sys.exit("METADATA has no License-Expression")
        files = "".join(
            f"License-File: {path.name}\n" for path in sorted(texts.iterdir()) if f"License-File: {path.name}\n" not in metadata
        )
        metadata = metadata.replace("License-File: LICENSE\n", f"License-File: LICENSE\n{files}", 1)
        (info / "METADATA").write_text(metadata)
        folder.mkdir(parents=True, exist_ok=True)
        subprocess.run([sys.executable, "-m", "wheel", "pack", "--dest-dir", folder, tree], check=True, stdout=subprocess.DEVNULL)


if __name__ == "__main__":
    main()
