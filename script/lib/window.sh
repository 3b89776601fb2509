# shellcheck shell=bash disable=SC2034,SC2154 # scripts and this file share variables
# Control of the viewer's window on a virtual X server: its reported status, positions in it, and mouse input. For
# scripts that have sourced common.sh and set `out`, the folder for logs and screenshots.

# File to which the program writes its status whenever it changes.
status=$out/status.json

passed=0 failed=0 closed=
app_pid='' x_pid=''

# --- Counting -------------------------------------------------------------------------------------

pass() {
    passed=$((passed + 1))
    printf '  ok    %s\n' "$1"
}

fail() {
    failed=$((failed + 1))
    printf '  FAIL  %s\n' "$1"
}

# check DESCRIPTION COMMAND…: counts a pass if the command succeeds, otherwise a failure.
check() {
    local description=$1
    shift
    if "$@"; then pass "$description"; else fail "$description"; fi
}

# abort DESCRIPTION: counts a failure after which no further check is possible, prints the log, and exits.
abort() {
    fail "$1"
    if [ -s "$out/app.log" ]; then
        printf '%s\n' "  the last lines of $out/app.log:"
        tail -n 15 "$out/app.log" | sed 's/^/    /'
    fi
    exit 1
}

finish() {
    local code=$?
    trap - EXIT
    local pid
    for pid in $app_pid $x_pid; do
        kill "$pid" 2>/dev/null || true
        wait "$pid" 2>/dev/null || true
    done
    if [ -z "$closed" ] && [ "$failed" -eq 0 ]; then
        fail "the script itself stopped early"
    fi
    [ "$failed" -eq 0 ] || [ "$code" -ne 0 ] || code=1
    printf 'logs and screenshots: %s\n' "$out"
    printf '%s passed, %s failed\n' "$passed" "$failed"
    exit "$code"
}

# --- Looking ---------------------------------------------------------------------------------------

# look FILTER: prints a value of the status that the program reports; nothing if there is no status yet.
look() { jq -r "$1" "$status" 2>/dev/null || true; }

running() { kill -0 "$app_pid" 2>/dev/null; }

# wait_for SECONDS COMMAND…: waits until the command succeeds; fails after this time.
wait_for() {
    local deadline=$((SECONDS + $1))
    shift
    until "$@"; do
        running || abort "the program keeps running"
        [ "$SECONDS" -lt "$deadline" ] || return 1
        sleep 0.2
    done
}

# settled: waits until the program has been idle with an unchanged status for a second; fails after 120 s.
settled() {
    local deadline=$((SECONDS + 120)) quiet=0 before='' now
    while [ "$quiet" -lt 5 ]; do
        running || abort "the program keeps running"
        [ "$SECONDS" -lt "$deadline" ] || return 1
        now=$(cat "$status" 2>/dev/null || true)
        if [ "$(look .state)" = idle ] && [ "$now" = "$before" ]; then
            quiet=$((quiet + 1))
        else
            quiet=0
        fi
        before=$now
        sleep 0.2
    done
}

must_settle() {
    settled || abort "full quality is reached within 120 s $1 (state: $(look .state))"
}

status_differs_from() { [ "$(cat "$status" 2>/dev/null || true)" != "$1" ]; }

find_window() {
    window=$(xdotool search --onlyvisible --name Chiaroscuro 2>/dev/null | head -n 1) || true
    [ -n "$window" ]
}

# geometry: sets the position of the window on the screen, and its size.
geometry() {
    local line
    for line in $(xdotool getwindowgeometry --shell "$window"); do
        case $line in
        X=*) window_x=${line#*=} ;;
        Y=*) window_y=${line#*=} ;;
        WIDTH=*) window_width=${line#*=} ;;
        HEIGHT=*) window_height=${line#*=} ;;
        esac
    done
}

# viewport: sets left, top (on the screen), width and height of the picture area.
viewport() {
    geometry
    # The numbers are integers, but JSON may contain them as 12.0.
    read -r left top width height < <(look \
        '.viewport // empty | [.x, .y, .width, .height] | map(. + 0.5 | floor | tostring) | join(" ")') ||
        abort "the status contains the position of the picture"
    left=$((left + window_x)) top=$((top + window_y))
}

# --- Doing -----------------------------------------------------------------------------------------

# drag X Y DX DY: presses the left button at a point of the screen, moves in ten steps, and releases it.
drag() {
    local before i
    before=$(cat "$status")
    xdotool mousemove "$1" "$2"
    sleep 0.5
    xdotool mousedown 1
    sleep 0.3
    for ((i = 0; i < 10; i++)); do
        xdotool mousemove_relative -- $(($3 / 10)) $(($4 / 10))
        sleep 0.1
    done
    sleep 0.3
    xdotool mouseup 1
    # A handle moves or a light volume is filled again; if nothing changes, later checks will report it.
    wait_for 10 status_differs_from "$before" || true
}

# --- Machine ---------------------------------------------------------------------------------------

# Ends the script successfully on systems without a virtual X server.
need_linux() {
    is_linux && return
    say "needs a virtual X server, which only Linux has; skipped"
    echo "0 passed, 0 failed"
    exit 0
}

need_window_tools() {
    need_rust
    need_vulkan
    need_window_libraries
    want_command Xvfb xvfb xorg-x11-server-Xvfb "the virtual X server that the window opens on"
    want_command xdotool xdotool xdotool "moves the mouse and presses keys"
    want_command jq jq jq "reads the status of the program"
    install_wanted
}

# need_program PROGRAM: sets `program` to this program or, if it is empty, to the one that the tests build.
need_program() {
    if [ -n "$1" ]; then
        program=$(cd "$(dirname "$1")" && pwd)/$(basename "$1")
    else
        # Not `cargo build`: the tests enable more features of the GPU and window libraries, which would be compiled
        # again.
        (cd "$root" && cargo test --locked --no-run --test cli)
        program=$(target_folder)/debug/chiaroscuro
    fi
    [ -x "$program" ] || die "there is no program $program"
}

# need_faults: fails unless `program` was built with injected faults, which programs for distribution lack.
need_faults() {
    "$program" info builtin:box:8 --fault slow:0 >/dev/null 2>&1 ||
        die "$program has no option --fault; build it with: cargo build --release --features faults"
}

# open_screen: starts a virtual X server, with empty settings and state as at the first start. Closed when the script
# ends.
open_screen() {
    rm -rf "$out"
    mkdir -p "$out"
    trap finish EXIT
    trap 'exit 130' INT TERM
    prefer_software_driver

    unset WAYLAND_DISPLAY WAYLAND_SOCKET DBUS_SESSION_BUS_ADDRESS
    export XDG_CONFIG_HOME=$out/home/config XDG_DATA_HOME=$out/home/data XDG_CACHE_HOME=$out/home/cache
    export XDG_STATE_HOME=$out/home/state XDG_RUNTIME_DIR=$out/home/runtime
    mkdir -p "$XDG_CONFIG_HOME" "$XDG_DATA_HOME" "$XDG_CACHE_HOME" "$XDG_STATE_HOME" "$XDG_RUNTIME_DIR"
    chmod 700 "$XDG_RUNTIME_DIR"
    export WINIT_X11_SCALE_FACTOR=1 RUST_BACKTRACE=1

    Xvfb -displayfd 3 -screen 0 1280x800x24 -noreset -nolisten tcp 3>"$out/display" 2>"$out/xvfb.log" &
    x_pid=$!
    for ((i = 0; i < 100; i++)); do
        [ ! -s "$out/display" ] || break
        sleep 0.1
    done
    [ -s "$out/display" ] || abort "a virtual X server starts (see $out/xvfb.log)"
    DISPLAY=:$(cat "$out/display")
    export DISPLAY
}
