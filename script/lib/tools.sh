# shellcheck shell=bash
# Installation of programs that check the project. Sourced after common.sh.

# need_component COMPONENT COMMAND…: adds a component of the Rust toolchain if COMMAND fails.
need_component() {
    local component=$1
    shift
    "$@" >/dev/null 2>&1 && return
    has rustup || die "$component is missing; install it next to this machine's Rust"
    say "adding $component to the Rust toolchain"
    rustup component add "$component"
}

need_shellcheck() {
    want_command shellcheck shellcheck ShellCheck "checks the scripts"
    install_wanted
    has shellcheck || die "shellcheck was not found; install it (macOS: brew install shellcheck)"
}

# need_tools NAME: puts the programs of a list, NAME.txt, first in PATH: tools for checks, or packaging. Installs them into
# a folder NAME in the target folder, if the list has changed since the last installation. Sets `tools_folder`.
need_tools() {
    local list
    list=$(dirname "${BASH_SOURCE[0]}")/$1.txt
    tools_folder=$(target_folder)/$1
    if ! cmp -s "$list" "$tools_folder/list.txt"; then
        want_command python3 python3 python3 "installs programs that the scripts use"
        python3 -m pip --version >/dev/null 2>&1 ||
            want_package python3-pip python3-pip "installs programs that the scripts use"
        install_wanted
        say "installing into $tools_folder: $(sed -n 's/^\([a-z-]*\)==\([0-9.]*\) .*/\1 \2/p' "$list" | paste -s -d ',' -)"
        rm -rf "$tools_folder"
        PIP_ROOT_USER_ACTION=ignore python3 -m pip install --quiet --disable-pip-version-check --no-deps --only-binary :all: --require-hashes \
            --target "$tools_folder" --requirement "$list" >&2 || die "the programs of $list could not be installed"
        cp "$list" "$tools_folder/list.txt"
    fi
    PATH=$tools_folder/bin:$PATH
}

# need_cargo_tool PROGRAM VERSION: builds a program of Rust into `tools_folder`, unless it is there, and puts it in PATH.
need_cargo_tool() {
    if ! grep -q "^\"$1 $2 " "$tools_folder/.crates.toml" 2>/dev/null; then
        say "building $1 $2 into $tools_folder"
        env -u CARGO_ENCODED_RUSTFLAGS cargo install --quiet --locked --root "$tools_folder" \
            --target-dir "$tools_folder/build" "$1@$2" || die "$1 $2 could not be installed"
        rm -rf "$tools_folder/build"
    fi
    PATH=$tools_folder/bin:$PATH
}

# need_python_packages: puts NumPy and what else the tests of the Python package need into PYTHONPATH. Installs them into
# the target folder if the list or the version of Python has changed since the last installation.
need_python_packages() {
    local list folder version
    list=$(dirname "${BASH_SOURCE[0]}")/python-tests.txt
    want_command python3 python3 python3 "runs the tests of the Python package"
    install_wanted
    version=$(python3 -c 'import sys; print("%s.%s" % sys.version_info[:2])')
    folder=$(target_folder)/python-tests-$version
    if ! cmp -s "$list" "$folder/python-tests.txt"; then
        python3 -m pip --version >/dev/null 2>&1 ||
            want_package python3-pip python3-pip "installs what the tests of the Python package need"
        install_wanted
        say "installing into $folder: $(sed -n 's/^\([a-z]*\)[=>].*/\1/p' "$list" | paste -s -d ',' -)"
        rm -rf "$folder"
        PIP_ROOT_USER_ACTION=ignore python3 -m pip install --quiet --disable-pip-version-check --only-binary :all: \
            --target "$folder" --requirement "$list" >&2 || die "the packages of $list could not be installed"
        cp "$list" "$folder/python-tests.txt"
    fi
    export PYTHONPATH=$folder${PYTHONPATH:+:$PYTHONPATH}
}
