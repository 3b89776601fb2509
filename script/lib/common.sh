# shellcheck shell=bash
# Functions shared by the scripts: messages, and detection and installation of dependencies.
# Also sourced by bash 3.2 (macOS), hence without arrays that may be empty.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
me=${0##*/}

# Messages go to standard error; standard output is for the programs.
say() { printf '%s: %s\n' "$me" "$*" >&2; }
warn() { printf '%s: warning: %s\n' "$me" "$*" >&2; }
die() {
    printf '%s: error: %s\n' "$me" "$*" >&2
    exit 1
}

is_linux() { [ "$(uname -s)" = Linux ]; }
has() { command -v "$1" >/dev/null 2>&1; }

# --- Packages -----------------------------------------------------------------------------------

# Names of the packages to be installed, collected by want_package.
wanted_packages=
# Set once this run has refreshed the list of packages.
packages_refreshed=

package_manager() {
    if has apt-get; then
        echo apt
    elif has dnf; then
        echo dnf
    else
        echo none
    fi
}

# want_package DEBIAN-NAME FEDORA-NAME REASON: notes a package for installation.
want_package() {
    local name=$1
    case $(package_manager) in
    dnf) name=$2 ;;
    none)
        warn "missing on this machine: $1 (its name on Debian), $3"
        return
        ;;
    esac
    say "installing $name: $3"
    wanted_packages="$wanted_packages $name"
}

# want_command COMMAND DEBIAN-NAME FEDORA-NAME REASON: notes a package if the command is missing.
want_command() {
    has "$1" || want_package "$2" "$3" "$4"
}

# want_library SONAME DEBIAN-NAME FEDORA-NAME REASON: notes a package if the shared library is missing.
want_library() {
    has_library "$1" || want_package "$2" "$3" "$4"
}

has_library() {
    local dir
    local IFS=:
    for dir in ${LD_LIBRARY_PATH:-}; do
        [ -e "$dir/$1" ] && return 0
    done
    # On Debian, ldconfig is not in the search path of ordinary users. No grep -q here: it would exit early, and the
    # closed pipe would end ldconfig with an error.
    PATH="$PATH:/sbin:/usr/sbin" ldconfig -p 2>/dev/null | grep -F "$1 " >/dev/null
}

# Installs all packages that were noted, in one command.
install_wanted() {
    [ -n "$wanted_packages" ] || return 0
    # Word splitting is intended: package names contain no spaces.
    # shellcheck disable=SC2086
    set -- $wanted_packages
    wanted_packages=
    case $(package_manager) in
    apt)
        need_root "apt-get install $*"
        [ -n "$packages_refreshed" ] || apt update ||
            warn "the list of packages could not be refreshed; the present one is used"
        packages_refreshed=yes
        apt install -y --no-install-recommends "$@" || die "could not install: $*"
        ;;
    dnf)
        need_root "dnf install $*"
        as_root dnf install -y --setopt=install_weak_deps=False "$@" || die "could not install: $*"
        ;;
    esac
}

# apt ARGS: runs apt-get without prompts; waits while another apt-get is running.
apt() { as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=300 "$@"; }

# need_root COMMAND: stops if this user cannot become root, and prints the command to be run as root.
need_root() {
    [ "$(id -u)" -ne 0 ] || return 0
    has sudo || die "installing needs root, and there is no sudo; run as root: $1"
    # sudo can ask for a password only in a terminal.
    [ -t 0 ] || sudo -n true 2>/dev/null ||
        die "installing needs root, and there is no terminal to ask for a password; run as root: $1"
}

as_root() {
    if [ "$(id -u)" -eq 0 ]; then
        "$@" </dev/null >&2
    else
        sudo "$@" >&2
    fi
}

# --- What the project needs ----------------------------------------------------------------------

# Checks for Rust, and installs a linker if there is none.
need_rust() {
    has cargo || PATH="${HOME:-}/.cargo/bin:$PATH"
    local version
    version=$(sed -n 's/^rust-version = "\(.*\)"$/\1/p' "$root/Cargo.toml")
    has cargo || die "cargo was not found; install Rust $version or newer (https://rustup.rs)"
    if ! has cc; then
        is_linux || die "there is no linker; run: xcode-select --install"
        want_package gcc gcc "Rust links programs with it"
        if [ "$(package_manager)" = apt ]; then
            want_package libc6-dev glibc-devel "files of the C library for the linker"
        fi
        install_wanted
    fi
}

# Installs the Vulkan loader and a driver if they are missing. macOS has Metal instead.
need_vulkan() {
    is_linux || return 0
    want_library libvulkan.so.1 libvulkan1 vulkan-loader "the Vulkan loader, for rendering"
    has_vulkan_driver ||
        want_package mesa-vulkan-drivers mesa-vulkan-drivers "there is no Vulkan driver; this is one in software"
    install_wanted
}

# Succeeds if a Vulkan driver is registered by a file, or chosen by the environment; the loader alone is not enough.
has_vulkan_driver() {
    [ -z "${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-}" ] || return 0
    local file
    for file in {/etc,/usr/share,/usr/local/etc,/usr/local/share,"${HOME:-}/.local/share"}/vulkan/icd.d/*.json; do
        [ ! -e "$file" ] || return 0
    done
    return 1
}

# Selects the software driver for windows on a virtual X server, where hardware drivers often cannot present pictures. A
# driver that the environment selects is kept.
prefer_software_driver() {
    [ -z "${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-}" ] || return 0
    local drivers
    drivers=$(printf '%s:' /usr/share/vulkan/icd.d/lvp_icd*.json)
    [ "$drivers" != '/usr/share/vulkan/icd.d/lvp_icd*.json:' ] || return 0
    # The second variable is for older loaders.
    export VK_DRIVER_FILES=${drivers%:} VK_ICD_FILENAMES=${drivers%:}
}

# Installs the libraries that the window loads at run time, for X11 and for Wayland.
need_window_libraries() {
    is_linux || return 0
    want_library libX11.so.6 libx11-6 libX11 "windows on X11"
    want_library libX11-xcb.so.1 libx11-xcb1 libX11-xcb "windows on X11"
    want_library libXcursor.so.1 libxcursor1 libXcursor "the mouse pointer on X11"
    want_library libXi.so.6 libxi6 libXi "mouse and keyboard on X11"
    want_library libxkbcommon-x11.so.0 libxkbcommon-x11-0 libxkbcommon-x11 "keyboard layouts on X11"
    want_library libxkbcommon.so.0 libxkbcommon0 libxkbcommon "keyboard layouts"
    want_library libwayland-client.so.0 libwayland-client0 libwayland-client "windows on Wayland"
    install_wanted
}

# --- Cargo ----------------------------------------------------------------------------------------

# Prints the folder into which cargo builds, as its settings define it.
target_folder() {
    (cd "$root" && cargo metadata --locked --no-deps --format-version 1) |
        sed -n 's/.*"target_directory":"\([^"]*\)".*/\1/p'
}
