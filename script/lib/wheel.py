"""Packs a wheel, which pip, pipx and uv install:

    wheel.py program FOLDER DOCUMENTS VERSION GLIBC PROGRAM    chiaroscuro_app: the program among the scripts
    wheel.py package FOLDER DOCUMENTS VERSION GLIBC MODULE     chiaroscuro: python/chiaroscuro with its native module

FOLDER is where the wheel is written, DOCUMENTS a folder with licences and the list of components, GLIBC the oldest C
library that the binary runs with, such as 2.28. SOURCE_DATE_EPOCH is the time of all files in the wheel. Prints the name
of the wheel.
"""

import base64
import gzip
import hashlib
import os
import pathlib
import stat
import sys
import time
import tomllib
import zipfile

PYTHON = pathlib.Path(__file__).resolve().parents[2] / "python"

# Names of files in DOCUMENTS, and in the wheel: licences and lists of components have folders of their own.
DOCUMENTS = {
    "LICENSE-MIT": "licenses/LICENSE-MIT",
    "LICENSE-APACHE": "licenses/LICENSE-APACHE",
    "THIRD-PARTY-LICENSES.gz": "licenses/THIRD-PARTY-LICENSES",
    "chiaroscuro.cdx.json.gz": "sboms/chiaroscuro.cdx.json",
}

# Description of the wheel of the program; python/pyproject.toml is that of the other.
PROGRAM = {
    "name": "chiaroscuro-app",
    "description": "See the shape of volume data: a desktop viewer with true volumetric shadows",
    "requires-python": ">=3.8",
    "classifiers": ["Topic :: Scientific/Engineering :: Visualization"],
}
PROGRAM_README = "The program `chiaroscuro`: the window, and the commands that render and convert volumes.\n"


def read(path):
    """Contents of a file, unpacked."""
    path = str(path)
    with (gzip.open if path.endswith(".gz") else open)(path, "rb") as file:
        return file.read()


def metadata(project, version, readme):
    """Description of a wheel, in the form of packages' metadata."""
    licences = [name for name in DOCUMENTS.values() if name.startswith("licenses/")]
    lines = [
        "Metadata-Version: 2.4",
        f"Name: {project['name']}",
        f"Version: {version}",
        f"Summary: {project['description']}",
        *([f"Keywords: {','.join(project['keywords'])}"] if "keywords" in project else []),
        "License-Expression: MIT OR Apache-2.0",
        *(f"License-File: {name.removeprefix('licenses/')}" for name in licences),
        *(f"Classifier: {classifier}" for classifier in project["classifiers"]),
        f"Requires-Python: {project['requires-python']}",
        *(f"Requires-Dist: {dependency}" for dependency in project.get("dependencies", [])),
        *(
            f"Provides-Extra: {extra}\nRequires-Dist: {dependency}; extra == '{extra}'"
            for extra, dependencies in project.get("optional-dependencies", {}).items()
            for dependency in dependencies
        ),
        "Description-Content-Type: text/markdown",
        "",
        readme,
    ]
    return "\n".join(lines).encode()


def package_files(module):
    """Files of the Python package, by their names in the wheel."""
    sources = sorted(path for path in (PYTHON / "chiaroscuro").iterdir() if path.suffix in {".py", ".pyi", ".typed"})
    files = {f"chiaroscuro/{path.name}": path.read_bytes() for path in [*sources, PYTHON / "chiaroscuro" / "py.typed"]}
    return {**files, "chiaroscuro/_native.abi3.so": read(module)}


def main():
    """Writes the wheel."""
    if len(sys.argv) != 7 or sys.argv[1] not in {"program", "package"} or "SOURCE_DATE_EPOCH" not in os.environ:
        sys.exit(f"wheel.py: error: expected arguments as below, and SOURCE_DATE_EPOCH in the environment\n{__doc__}")
    kind, folder, documents, version, glibc, binary = sys.argv[1:]
    platform = f"manylinux_{glibc.replace('.', '_')}_x86_64"
    if kind == "program":
        project, readme, tag = PROGRAM, PROGRAM_README, f"py3-none-{platform}"
    else:
        project = tomllib.loads((PYTHON / "pyproject.toml").read_text(encoding="utf-8"))["project"]
        # The module uses the part of Python's C interface that every version from the oldest one on has.
        oldest = project["requires-python"].removeprefix(">=").replace(".", "")
        readme, tag = (PYTHON / "README.md").read_text(encoding="utf-8"), f"cp{oldest}-abi3-{platform}"
    name = project["name"].replace("-", "_")
    info = f"{name}-{version}.dist-info"
    scripts = f"{name}-{version}.data/scripts"

    files = package_files(binary) if kind == "package" else {f"{scripts}/chiaroscuro": read(binary)}
    for source, place in DOCUMENTS.items():
        files[f"{info}/{place}"] = read(os.path.join(documents, source))
    files[f"{info}/METADATA"] = metadata(project, version, readme)
    files[f"{info}/WHEEL"] = (
        f"Wheel-Version: 1.0\nGenerator: chiaroscuro script/package\nRoot-Is-Purelib: false\nTag: {tag}\n".encode()
    )
    record = []
    for place, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        record.append(f"{place},sha256={digest},{len(content)}\n")
    files[f"{info}/RECORD"] = "".join([*record, f"{info}/RECORD,,\n"]).encode()

    wheel = f"{name}-{version}-{tag}.whl"
    moment = time.gmtime(int(os.environ["SOURCE_DATE_EPOCH"]))[:6]
    with zipfile.ZipFile(os.path.join(folder, wheel), "w") as archive:
        for place, content in files.items():
            entry = zipfile.ZipInfo(place, moment)
            mode = 0o755 if "/scripts/" in place or place.endswith(".so") else 0o644
            # The upper half of these attributes is the mode of the file; 3 stands for Unix.
            entry.external_attr = (stat.S_IFREG | mode) << 16
            entry.create_system = 3
            archive.writestr(entry, content, zipfile.ZIP_DEFLATED, 9)
    print(wheel)


main()
