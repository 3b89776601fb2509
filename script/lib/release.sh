# shellcheck shell=bash disable=SC2034,SC2154 # scripts and this file share variables
# Building of the program for distribution: flags that keep paths of this machine out of it, and the check that they
# did. Sourced after common.sh.

# release_flags: sets the flags of all builds for distribution, and prepares `release_folder`, into which they go. They
# have a folder of their own, since cargo compiles everything again when flags change.
release_flags() {
    local target separator
    target=$(target_folder)
    release_folder=$target/given
    # Flags separated by this character may contain spaces.
    separator=$'\x1f'
    # Of several prefixes that match, rustc takes the last: the target folder may lie in the project or outside.
    CARGO_ENCODED_RUSTFLAGS=--remap-path-prefix=$root=chiaroscuro
    CARGO_ENCODED_RUSTFLAGS+=$separator--remap-path-prefix=$target=chiaroscuro/target
    CARGO_ENCODED_RUSTFLAGS+=$separator--remap-path-prefix=$(cargo_home)/registry/src=crates
    CARGO_ENCODED_RUSTFLAGS+=$separator--remap-path-prefix=$(rustc --print sysroot)=rust
    export CARGO_ENCODED_RUSTFLAGS
}

cargo_home() { printf '%s\n' "${CARGO_HOME:-$HOME/.cargo}"; }

# check_release PROGRAM: stops if a program contains paths of this machine (messages of libraries contain the paths of
# their sources) or injected faults.
check_release() {
    local path count
    for path in "$(cargo_home)" "$root" "$(target_folder)" "$(rustc --print sysroot)"; do
        count=$({ grep -a -o -F "$path/" "$1" || true; } | wc -l)
        [ "$count" -eq 0 ] || die "$1 contains $count paths of this machine: $path/…"
    done
    say "$1 contains no path of this machine"
    # Part of the message about an unknown fault.
    ! grep -q -a -F 'pictures-lost@N' "$1" || die "$1 contains the feature faults, which is for tests"
}

# --- Programs for older systems -------------------------------------------------------------------

# Oldest version of the C library that the program runs with: that of Debian 10 and RHEL 8.
oldest_glibc=2.28

# Programs that record the names and versions of all crates, in the program and beside it.
auditable_version=0.7.7
cyclonedx_version=0.5.9

# build_portable: builds the program and the module for Python without symbols, for all systems since that C library, and
# sets `program` and `module` to them. The caller has set `triple`, and called need_tools packaging.
build_portable() {
    release_flags
    say "building for glibc $oldest_glibc"
    portable_build --bin chiaroscuro
    portable_build --package chiaroscuro-python --lib
    program=$release_folder/$triple/release/chiaroscuro
    module=$release_folder/$triple/release/libchiaroscuro_python.so
    check_release "$program"
    check_portable "$program"
    check_release "$module"
    check_portable "$module"
    ! readelf --wide --dynamic "$module" | grep -F libpython ||
        die "$module needs a libpython; expected the interpreter's own functions, by the feature extension-module of pyo3"
}

# portable_build ARGS: builds what ARGS of cargo select.
portable_build() {
    # Everything that the linker compiles for itself stays in the target folder. A profile's `strip` would count for
    # script/release too, which keeps the names of functions for reports of crashes.
    # cargo-auditable is given as the compiler's wrapper by its name, as `cargo auditable` would give it by its absolute
    # path: cargo hashes the text into the names of symbols, and the bytes would depend on where the tool lies.
    CARGO_PROFILE_RELEASE_STRIP=symbols \
        RUSTC_WORKSPACE_WRAPPER=cargo-auditable \
        CARGO_AUDITABLE_ORIG_ARGS='{"offline":false,"locked":true,"frozen":false,"config":[]}' \
        CARGO_ZIGBUILD_ZIG_PATH=$tools_folder/ziglang/zig CARGO_ZIGBUILD_CACHE_DIR=$tools_folder/cache \
        ZIG_GLOBAL_CACHE_DIR=$tools_folder/cache/zig ZIG_LOCAL_CACHE_DIR=$tools_folder/cache/zig \
        cargo zigbuild --release --locked "$@" \
        --target "$triple.$oldest_glibc" --target-dir "$release_folder"
}

# check_portable PROGRAM: stops if a program needs a newer C library than `oldest_glibc`, has symbols besides those for
# the loader, or does not list its crates.
check_portable() {
    local highest
    highest=$(readelf --wide --dyn-syms "$1" | grep -o '@GLIBC_[0-9.]*' | sed 's/^@GLIBC_//' | sort -V | tail -n 1)
    [ -n "$highest" ] || die "$1 has no symbols of the C library; expected versions such as GLIBC_2.2.5"
    [ "$(printf '%s\n' "$highest" "$oldest_glibc" | sort -V | tail -n 1)" = "$oldest_glibc" ] ||
        die "$1 needs symbols of glibc $highest; at most $oldest_glibc is allowed: $(readelf --wide --dyn-syms "$1" |
            grep -o "[^ ]*@GLIBC_$highest\$" | sort -u | paste -s -d ' ' -)"
    say "$1 needs glibc $highest, of at most $oldest_glibc, and $(readelf --wide --dynamic "$1" |
        sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p' | paste -s -d ' ' -)"
    ! readelf --wide --sections "$1" | grep -q -F -e ' .symtab ' -e ' .debug_' ||
        die "$1 has symbols for debuggers; expected none, by CARGO_PROFILE_RELEASE_STRIP"
    readelf --wide --sections "$1" | grep -F ' .dep-v0 ' >/dev/null ||
        die "$1 does not list its crates: expected a section .dep-v0, which cargo auditable adds"
}
