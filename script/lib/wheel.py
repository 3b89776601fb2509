"""Packs the program as a wheel, which pip, pipx and uv install: the program among the scripts of the environment, with
its licences and its list of components.

    wheel.py TREE VERSION GLIBC FOLDER

TREE is the tree of files that all packages contain, GLIBC the oldest C library that the program runs with, such as
2.28. SOURCE_DATE_EPOCH is the time of all files in the wheel. Prints the name of the wheel.
"""

import base64
import gzip
import hashlib
import os
import stat
import sys
import time
import zipfile

# Name in the index of packages; the library has the name chiaroscuro.
NAME = "chiaroscuro_app"

# Names of files in the documents of TREE, and in the wheel: licences and lists of components have folders of their own.
DOCUMENTS = {
    "LICENSE-MIT": "licenses/LICENSE-MIT",
    "LICENSE-APACHE": "licenses/LICENSE-APACHE",
    "THIRD-PARTY-LICENSES.gz": "licenses/THIRD-PARTY-LICENSES",
    "chiaroscuro.cdx.json.gz": "sboms/chiaroscuro.cdx.json",
}


def read(path):
    """Contents of a file, unpacked."""
    with (gzip.open if path.endswith(".gz") else open)(path, "rb") as file:
        return file.read()


def metadata(version):
    """Description of the wheel."""
    licences = [name for name in DOCUMENTS.values() if name.startswith("licenses/")]
    lines = [
        "Metadata-Version: 2.4",
        f"Name: {NAME.replace('_', '-')}",
        f"Version: {version}",
        "Summary: See the shape of volume data: a desktop viewer with true volumetric shadows",
        "License-Expression: MIT OR Apache-2.0",
        *(f"License-File: {name.removeprefix('licenses/')}" for name in licences),
        "Classifier: Topic :: Scientific/Engineering :: Visualization",
        "Requires-Python: >=3.8",
        "Description-Content-Type: text/markdown",
        "",
        "The program `chiaroscuro`: the window, and the commands that render and convert volumes.",
        "",
    ]
    return "\n".join(lines).encode()


def main():
    """Writes the wheel."""
    if len(sys.argv) != 5 or "SOURCE_DATE_EPOCH" not in os.environ:
        sys.exit("wheel.py: error: expected TREE VERSION GLIBC FOLDER, and SOURCE_DATE_EPOCH in the environment")
    tree, version, glibc, folder = sys.argv[1:]
    tag = f"py3-none-manylinux_{glibc.replace('.', '_')}_x86_64"
    info = f"{NAME}-{version}.dist-info"
    documents = os.path.join(tree, "usr/share/doc/chiaroscuro")

    files = {f"{NAME}-{version}.data/scripts/chiaroscuro": read(os.path.join(tree, "usr/bin/chiaroscuro"))}
    for source, name in DOCUMENTS.items():
        files[f"{info}/{name}"] = read(os.path.join(documents, source))
    files[f"{info}/METADATA"] = metadata(version)
    files[f"{info}/WHEEL"] = (
        f"Wheel-Version: 1.0\nGenerator: chiaroscuro script/package\nRoot-Is-Purelib: false\nTag: {tag}\n".encode()
    )
    record = []
    for name, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        record.append(f"{name},sha256={digest},{len(content)}\n")
    files[f"{info}/RECORD"] = "".join([*record, f"{info}/RECORD,,\n"]).encode()

    wheel = f"{NAME}-{version}-{tag}.whl"
    moment = time.gmtime(int(os.environ["SOURCE_DATE_EPOCH"]))[:6]
    with zipfile.ZipFile(os.path.join(folder, wheel), "w") as archive:
        for name, content in files.items():
            entry = zipfile.ZipInfo(name, moment)
            mode = 0o755 if "/scripts/" in name else 0o644
            # The upper half of these attributes is the mode of the file; 3 stands for Unix.
            entry.external_attr = (stat.S_IFREG | mode) << 16
            entry.create_system = 3
            archive.writestr(entry, content, zipfile.ZIP_DEFLATED, 9)
    print(wheel)


main()
