"""Licences of everything that the program is linked with, as one text on standard output: a list of the crates, then
each text once, with the crates that it belongs to.

    cargo tree … --format '{p}' | licences.py TRIPLE [NAME=FILE…]

Standard input has a crate in each line, as cargo tree prints them. NAME=FILE adds the licence of a library that is not
a crate. A crate without licence files gets the text of a licence that its manifest permits; if none of them is known
here, the script fails and names the crate.
"""

import json
import os
import re
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

# Names of licence files. Those of fonts are named after the licence or after the font.
LICENCE_FILE = re.compile(r"(un)?licen[cs]e|copying|copyright|notice|[ou]fl\.txt$", re.IGNORECASE)

# Texts that the project itself has. Both are permitted for nearly every crate.
KNOWN_TEXTS = {"MIT": "LICENSE-MIT", "Apache-2.0": "LICENSE-APACHE"}

# Licences of fonts, with the names of the files that hold their texts.
FONT_TEXTS = {"OFL-1.1": "OFL.txt", "Ubuntu-font-1.0": "UFL.txt"}


def fail(message):
    """Ends the script with an error message."""
    sys.exit(f"licences.py: error: {message}")


def read(path):
    """Text of a licence file, with the line ends and without the margins that differ between copies."""
    with open(path, encoding="utf-8", errors="replace") as file:
        lines = [line.rstrip() for line in file.read().replace("\r\n", "\n").split("\n")]
    return "\n".join(lines).strip("\n")


def mit_text(holder):
    """The MIT licence for another holder than that of this project."""
    text = read(os.path.join(ROOT, KNOWN_TEXTS["MIT"]))
    changed, count = re.subn(r"(?m)^Copyright.*$", f"Copyright (c) {holder}", text)
    if count != 1:
        fail(f"{KNOWN_TEXTS['MIT']}: line Copyright: expected one, found {count}; write it as the licence has it")
    return changed


def crates():
    """Names and versions of the crates in standard input, without the project's own."""
    found = set()
    for line in sys.stdin:
        parts = line.split()
        if len(parts) < 2:
            continue
        # The project's own crates are followed by their folder.
        if not any(part.startswith("(/") for part in parts):
            found.add((parts[0], parts[1].removeprefix("v")))
    if not found:
        fail("standard input names no crate; expected the output of cargo tree --prefix none --format '{p}'")
    return sorted(found)


def manifests(triple):
    """Packages of cargo metadata by name and version."""
    command = ["cargo", "metadata", "--locked", "--offline", "--format-version", "1", "--filter-platform", triple]
    result = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, check=False)
    if result.returncode != 0:
        fail("cargo metadata failed; fetch the crates first: cargo fetch --locked")
    return {(package["name"], package["version"]): package for package in json.loads(result.stdout)["packages"]}


def licence_files(folder):
    """Licence files of a crate, in its folder or one below; in folders of fonts, every text."""
    found = []
    for place in [folder] + sorted(entry.path for entry in os.scandir(folder) if entry.is_dir()):
        names = sorted(os.listdir(place))
        has_fonts = any(name.endswith((".ttf", ".otf")) for name in names)
        for name in names:
            path = os.path.join(place, name)
            is_source = name.endswith((".rs", ".toml", ".py"))
            is_licence = LICENCE_FILE.search(name) or has_fonts and name.endswith(".txt")
            if is_licence and not is_source and os.path.isfile(path):
                found.append(path)
    return found


def replacement_texts(package, files):
    """Texts for a crate without a licence file of its own: one for each part of its licence expression."""
    label = f"{package['name']} {package['version']}"
    expression = package["license"] or ""
    present = {os.path.basename(path) for path in files}
    texts = []
    for part in expression.split(" AND "):
        options = re.split(r" OR |/", part.strip("() "))
        known = [option for option in KNOWN_TEXTS if option in options]
        if "MIT" in known:
            texts.append(mit_text(", ".join(package["authors"]) or f"the authors of {package['name']}"))
        elif known:
            texts.append(read(os.path.join(ROOT, KNOWN_TEXTS[known[0]])))
        elif not any(FONT_TEXTS.get(option) in present for option in options):
            fail(f"{label}: no licence file, and no text is known for {part or 'an empty licence'} (Cargo.toml, "
                 f"license); expected {' or '.join(KNOWN_TEXTS)}; add its text to KNOWN_TEXTS")
    return texts


def main():
    """Prints the list and the texts."""
    if len(sys.argv) < 2:
        fail("expected the target triple as argument, for example x86_64-unknown-linux-gnu")
    packages = manifests(sys.argv[1])
    listed, owners = [], {}

    for argument in sys.argv[2:]:
        name, _, path = argument.partition("=")
        listed.append((name, "see its text below"))
        owners.setdefault(read(path), []).append(name)
    for name, version in crates():
        package = packages.get((name, version))
        if package is None:
            fail(f"{name} {version} is not among the packages of Cargo.lock for {sys.argv[1]}")
        label = f"{name} {version}"
        listed.append((label, package["license"] or "see its text below"))
        files = licence_files(os.path.dirname(package["manifest_path"]))
        texts = [read(path) for path in files]
        # Files below the folder belong to a part of the crate, such as its fonts.
        if not any(os.path.dirname(path) == os.path.dirname(package["manifest_path"]) for path in files):
            texts += replacement_texts(package, files)
        for text in dict.fromkeys(text for text in texts if text):
            owners.setdefault(text, []).append(label)

    line = "=" * 80
    print("Chiaroscuro contains the following libraries, under the licences beside their names.\n")
    for label, licence in listed:
        print(f"  {label}: {licence}")
    for text, labels in owners.items():
        print(f"\n{line}\n{', '.join(labels)}\n{line}\n\n{text}")


main()
