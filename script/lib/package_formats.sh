# shellcheck shell=bash disable=SC2034,SC2154 # variables of script/package: root, version, name, work
# Packing of the staged tree as archive, .deb, .rpm and wheel. Sourced by script/package.
#
# Each function takes the tree and the file to write, for the wheel its folder. Owners, order, times and compression are fixed, so that the same
# tree gives the same bytes.

# pack_archive TREE FILE: an archive with bin/ and share/ in one folder, which can be unpacked into ~/.local.
pack_archive() {
    tar --create --format=ustar --sort=name --owner=0 --group=0 --numeric-owner --mtime="@$SOURCE_DATE_EPOCH" \
        --transform="s|^usr|$name|" --directory="$1" usr | gzip -9 --no-name >"$2"
}

# pack_deb TREE FILE
pack_deb() {
    local tree=$work/deb documents installed_kib
    cp -a "$1" "$tree"
    documents=$tree/usr/share/doc/chiaroscuro
    # Debian has the Apache licence in a place of its own, and the other one is in the file copyright.
    rm "$documents/LICENSE-MIT" "$documents/LICENSE-APACHE"
    mv "$tree/usr/share/zsh/site-functions" "$tree/usr/share/zsh/vendor-completions"
    fill "$root/packaging/deb/changelog.in" | gzip -9 --no-name >"$documents/changelog.Debian.gz"
    if [ -f "$root/packaging/deb/lintian-overrides" ]; then
        mkdir -p "$tree/usr/share/lintian/overrides"
        cp "$root/packaging/deb/lintian-overrides" "$tree/usr/share/lintian/overrides/chiaroscuro"
    fi
    # Each file in KiB, rounded up, and one for each folder, as dpkg-gencontrol counts.
    installed_kib=$(find "$tree" -type f -printf '%s\n' | awk -v folders="$(find "$tree" -type d | wc -l)" \
        '{ sum += int(($1 + 1023) / 1024) } END { print sum + folders }')
    mkdir "$tree/DEBIAN"
    fill "$root/packaging/deb/control.in" >"$tree/DEBIAN/control"
    (cd "$tree" && find usr -type f -print0 | sort -z | xargs -0 md5sum) >"$tree/DEBIAN/md5sums"
    find "$tree/DEBIAN" -type f -exec chmod 644 {} +
    same_times "$tree"
    # xz, which Debian 11 can read; in one thread, since the number of threads changes the bytes.
    DPKG_DEB_THREADS_MAX=1 dpkg-deb --build --root-owner-group -Zxz "$tree" "$2" >/dev/null
}

# pack_rpm TREE FILE
pack_rpm() {
    local top=$work/rpm list=$work/rpm-files
    mkdir "$top"
    # Folders that every system has belong to it. The others belong to this package too, as rpm allows, so that it removes
    # those that it has created.
    (cd "$1" && find usr -mindepth 1 -type d | sort | sed -e 's|^|/|' \
        -e '/\/bin$/d' -e '/\/share$/d' -e '/\/share\/doc$/d' -e '/\/share\/man/d' -e 's|^|%dir |') >"$list"
    (cd "$1" && find usr -type f | sort | sed -e 's|^|/|' -e 's|^/usr/share/doc/.*LICENSE|%license &|' \
        -e 's|^/usr/share/doc/|%doc &|' -e 's|^/usr/share/man/|%doc &|') >>"$list"
    rpmbuild -bb --quiet --target x86_64 \
        --define "_topdir $top" --define "_tmppath $top/tmp" --define "_rpmdir $top" --define "_rpmfilename out.rpm" \
        --define "version $version" --define "glibc $oldest_glibc" \
        --define "tree $1" --define "file_list $list" \
        "$root/packaging/rpm/chiaroscuro.spec" >"$top/log" 2>&1 || {
        cat "$top/log" >&2
        die "rpmbuild could not pack $2"
    }
    mv "$top/out.rpm" "$2"
}

# pack_wheels TREE FOLDER: a wheel with the program, and one with the package for Python; their names follow from version
# and C library.
pack_wheels() {
    local documents=$1/usr/share/doc/chiaroscuro own=$work/python-documents
    python3 "$root/script/lib/wheel.py" program "$2" "$documents" "$version" "$oldest_glibc" "$program" >/dev/null
    mkdir "$own"
    cp "$root/LICENSE-MIT" "$root/LICENSE-APACHE" "$own"
    third_party_licences chiaroscuro-python >"$own/THIRD-PARTY-LICENSES"
    list_of_components python/chiaroscuro-python.cdx.json >"$own/chiaroscuro.cdx.json"
    compress "$own/THIRD-PARTY-LICENSES"
    compress "$own/chiaroscuro.cdx.json"
    python3 "$root/script/lib/wheel.py" package "$2" "$own" "$version" "$oldest_glibc" "$module" >/dev/null
}
