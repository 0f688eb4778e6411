"""What pyproject.toml cannot say: the version is the project's, and the built library goes into the package."""

import shutil
from pathlib import Path

from setuptools import Distribution, setup
from setuptools.command.bdist_wheel import bdist_wheel
from setuptools.command.build_py import build_py

PROJECT = Path(__file__).resolve().parent.parent


def built_library():
    """The shared library of the release build, None where it has not been built."""
    candidates = [PROJECT / "build" / "release" / "lib" / name for name in ("libmfv.so", "libmfv.dylib")]
    return next((path for path in candidates if path.exists()), None)


class BuildWithLibrary(build_py):
    """Puts the library, one real file whatever it is a link to, next to the modules; none of an earlier build."""

    def run(self):
        super().run()
        package = Path(self.build_lib) / "mfv"
        for stale in package.glob("libmfv.*"):
            stale.unlink()
        library = built_library()
        if library and not self.editable_mode:
            shutil.copyfile(library, package / library.name)


class DistributionWithLibrary(Distribution):
    """Tells setuptools that a package with the library belongs to one kind of machine."""

    def has_ext_modules(self):
        return built_library() is not None


class WheelForAnyPython(bdist_wheel):
    """The library knows nothing of Python: its wheel serves every Python 3 on this kind of machine."""

    def get_tag(self):
        return "py3", "none", super().get_tag()[2]


setup(
    version=(PROJECT / "VERSION").read_text().strip(),
    distclass=DistributionWithLibrary,
    cmdclass={"build_py": BuildWithLibrary, "bdist_wheel": WheelForAnyPython},
)
