# shellcheck shell=bash disable=SC2154 # variables of script/package: root, version, program, triple, tools_folder, work
# The tree of files that all packages contain, with paths as below the root of a system. Sourced by script/package.

# Sizes of the icon in pixels that desktops look for; larger ones are drawn from the SVG file.
icon_sizes='16 22 24 32 48 64 128 256'

# stage_tree FOLDER: puts all files into FOLDER, with their final modes and times.
stage_tree() {
    local tree=$1
    say "staging files"
    stage_program "$tree"
    stage_desktop "$tree"
    stage_documents "$tree"
    find "$tree" -type d -exec chmod 755 {} +
    find "$tree" -type f -exec chmod 644 {} +
    chmod 755 "$tree/usr/bin/chiaroscuro"
    same_times "$tree"
}

# same_times FOLDER: gives all files and folders the time of the commit.
same_times() { find "$1" -exec touch --no-dereference --date="@$SOURCE_DATE_EPOCH" {} +; }

# compress FILE: replaces a file by a compressed one, without name and time in it.
compress() { gzip -9 --no-name "$1"; }

stage_program() {
    local man=$1/usr/share/man/man1 page
    mkdir -p "$1/usr/bin"
    cp "$program" "$1/usr/bin/chiaroscuro"
    "$program" man-pages "$man" >/dev/null
    for page in "$man"/*.1; do
        compress "$page"
    done
    mkdir -p "$1/usr/share/bash-completion/completions" "$1/usr/share/zsh/site-functions" \
        "$1/usr/share/fish/vendor_completions.d"
    "$program" completions bash >"$1/usr/share/bash-completion/completions/chiaroscuro"
    "$program" completions zsh >"$1/usr/share/zsh/site-functions/_chiaroscuro"
    "$program" completions fish >"$1/usr/share/fish/vendor_completions.d/chiaroscuro.fish"
}

stage_desktop() {
    local share=$1/usr/share size icons
    mkdir -p "$share/applications" "$share/metainfo" "$share/mime/packages"
    cp "$root/packaging/linux/chiaroscuro.desktop" "$share/applications"
    cp "$root/packaging/linux/chiaroscuro-mime.xml" "$share/mime/packages/chiaroscuro.xml"
    fill "$root/packaging/linux/chiaroscuro.metainfo.xml.in" >"$share/metainfo/io.github.chiaroscuro.Chiaroscuro.metainfo.xml"
    for size in $icon_sizes; do
        icons=$share/icons/hicolor/${size}x$size/apps
        mkdir -p "$icons"
        rsvg-convert --width="$size" --height="$size" --output="$icons/chiaroscuro.png" "$root/assets/icon.svg"
    done
    mkdir -p "$share/icons/hicolor/scalable/apps"
    cp "$root/assets/icon.svg" "$share/icons/hicolor/scalable/apps/chiaroscuro.svg"
}

stage_documents() {
    local documents=$1/usr/share/doc/chiaroscuro
    mkdir -p "$documents"
    cp "$root/packaging/deb/copyright" "$root/LICENSE-MIT" "$root/LICENSE-APACHE" "$documents"
    cp "$root/CHANGELOG.md" "$documents/changelog"
    third_party_licences chiaroscuro >"$documents/THIRD-PARTY-LICENSES"
    list_of_components chiaroscuro.cdx.json >"$documents/chiaroscuro.cdx.json"
    compress "$documents/changelog"
    compress "$documents/THIRD-PARTY-LICENSES"
    compress "$documents/chiaroscuro.cdx.json"
}

# third_party_licences CRATE: prints the licences of everything that a crate is linked with.
third_party_licences() {
    (cd "$root" && cargo tree --locked -p "$1" --edges normal --target "$triple" --prefix none --format '{p}') |
        python3 "$root/script/lib/licences.py" "$triple" "LLVM libunwind=$tools_folder/ziglang/lib/libunwind/LICENSE.TXT"
}

# list_of_components FILE: prints the crates that a crate is linked with in the format of CycloneDX; FILE is named after it,
# and lies beside its manifest.
list_of_components() {
    local copy=$work/source
    # The tool writes beside each manifest, so it works on a copy.
    mkdir "$copy"
    (cd "$root" && git ls-files -z | tar --create --null --files-from=-) | tar --extract --directory="$copy"
    (cd "$copy" && cargo cyclonedx --quiet --format json --spec-version 1.5 --target "$triple" --no-build-deps) ||
        die "cargo cyclonedx could not list the crates"
    # Crates of the project are identified by their folder.
    sed "s|path+file://$copy|path+file:///chiaroscuro|g" "$copy/$1"
    rm -rf "$copy"
}

# fill FILE: prints a file with its @NAMES@ replaced.
fill() {
    local maintainer="${DEBFULLNAME:-The Chiaroscuro authors} <${DEBEMAIL:-authors@chiaroscuro.invalid}>"
    sed -e "s|@VERSION@|$version|g" \
        -e "s|@DATE@|$(date --date="@$SOURCE_DATE_EPOCH" +%Y-%m-%d)|g" \
        -e "s|@CHANGED@|$(date --date="@$SOURCE_DATE_EPOCH" --rfc-email)|g" \
        -e "s|@GLIBC@|$oldest_glibc|g" \
        -e "s|@MAINTAINER@|$maintainer|g" \
        -e "s|@SIZE@|${installed_kib-}|g" "$1" | fill_screenshots
}

# fill_screenshots: replaces the line @SCREENSHOTS@ by the pictures of the documentation, if their address is known.
fill_screenshots() {
    local line
    while IFS= read -r line; do
        if [ "$line" != @SCREENSHOTS@ ]; then
            printf '%s\n' "$line"
        elif [ -n "${CHIAROSCURO_PICTURES-}" ]; then
            printf '%s\n' '  <screenshots>'
            screenshot default window.png 'The window, with settings of lights and shadows on the right'
            screenshot '' figure-6-chair-parallel.png 'A chair without shadows and with shadows'
            screenshot '' cloud.png 'A cloud that casts shadows on itself'
            printf '%s\n' '  </screenshots>'
        fi
    done
}

# screenshot TYPE FILE CAPTION: prints the entry of one picture of docs/images.
screenshot() {
    [ -f "$root/docs/images/$2" ] || die "docs/images/$2 is missing; package_tree.sh lists it as a screenshot"
    printf '    <screenshot%s>\n      <caption>%s</caption>\n      <image>%s/%s</image>\n    </screenshot>\n' \
        "${1:+ type=\"$1\"}" "$3" "${CHIAROSCURO_PICTURES%/}" "$2"
}
