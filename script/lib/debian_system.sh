# shellcheck shell=bash disable=SC2034,SC2154 # variables of script/test-packages: systems, work, system
# Roots of Debian systems to install packages in. Sourced by script/test-packages.

# Programs that recognise types of files, and a virtual screen; installed before the packages, which need none of them.
desktop_programs='libglib2.0-bin desktop-file-utils shared-mime-info xdg-utils xvfb'

# new_system RELEASE [PROGRAMS…]: makes a new root of a release of Debian with these programs, and sets `system` to its
# folder. Copies one that an earlier run has made, if there is one.
new_system() {
    local release=$1 kept mirror
    shift
    kept=$systems/$release${1:+-desktop}
    if [ ! -e "$kept/complete" ]; then
        rm -rf "$kept"
        say "making a root of Debian $release"
        # The mirror of this system, if it is Debian.
        # shellcheck disable=SC2016 # expanded by apt-get
        mirror=$(apt-get indextargets --format '$(REPO_URI)' 2>/dev/null | grep '/debian/*$' | head -n 1) || true
        # shellcheck disable=SC2086 # one word or none
        debootstrap --variant=minbase "$release" "$kept" $mirror >"$work/debootstrap.log" 2>&1 || {
            tail -n 20 "$work/debootstrap.log" >&2
            die "debootstrap could not make a root of Debian $release"
        }
        system=$kept
        # No service is started by an installation.
        printf '#!/bin/sh\nexit 101\n' >"$kept/usr/sbin/policy-rc.d"
        chmod 755 "$kept/usr/sbin/policy-rc.d"
        [ $# -eq 0 ] || inside apt-get install -y -q --no-install-recommends "$@" >"$work/programs.log" 2>&1 || {
            tail -n 20 "$work/programs.log" >&2
            die "$* could not be installed in Debian $release"
        }
        touch "$kept/complete"
    fi
    system=$work/$release
    rm -rf "$system"
    cp -a "$kept" "$system"
    rm "$system/complete"
    # Lists and versions of packages may have changed since.
    inside apt-get update -q >"$work/update.log" 2>&1 || die "the list of packages of Debian $release could not be refreshed (see $work/update.log)"
}

# inside COMMAND…: runs a command in the root `system`, with /proc and /dev, as after login.
inside() {
    # shellcheck disable=SC2016 # expanded by the inner shell
    unshare --mount --propagation private -- bash -c '
        system=$1
        shift
        mount -t proc proc "$system/proc"
        mount --rbind /dev "$system/dev"
        cp /etc/resolv.conf "$system/etc/resolv.conf"
        exec chroot "$system" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 \
            DEBIAN_FRONTEND=noninteractive ${http_proxy:+"http_proxy=$http_proxy"} "$@"' - "$system" "$@"
}

# files_of_system: lists all files of the root, apart from what the system itself remembers of packages.
files_of_system() {
    (cd "$system" && find . -xdev -mindepth 1 \
        \( -path ./proc -o -path ./dev -o -path ./run -o -path ./tmp -o -path ./var/lib/apt -o -path ./var/lib/dpkg \
        -o -path ./var/cache -o -path ./var/log -o -path ./var/lib/rpm \) -prune -o -print | sort)
}
