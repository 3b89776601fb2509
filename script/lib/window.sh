# shellcheck shell=bash disable=SC2034,SC2154 # what is set here is used by scripts, and the other way round
# A window on a virtual X server: what it reports, where things are in it, and what the mouse does there. For scripts
# that have read common.sh and set `out`, the folder for what is seen.

# The program writes its state here, whenever that changes.
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

# check DESCRIPTION COMMAND…
check() {
    local description=$1
    shift
    if "$@"; then pass "$description"; else fail "$description"; fi
}

# A failure after which nothing more can be tried.
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
    printf 'seen in %s\n' "$out"
    printf '%s passed, %s failed\n' "$passed" "$failed"
    exit "$code"
}

# --- Looking ---------------------------------------------------------------------------------------

# look FILTER: a value of the status that the program reports; empty while there is none.
look() { jq -r "$1" "$status" 2>/dev/null || true; }

running() { kill -0 "$app_pid" 2>/dev/null; }

# wait_for SECONDS COMMAND…: until the command succeeds.
wait_for() {
    local deadline=$((SECONDS + $1))
    shift
    until "$@"; do
        running || abort "the program goes on running"
        [ "$SECONDS" -lt "$deadline" ] || return 1
        sleep 0.2
    done
}

# settled: waits until the program has been idle, and its status the same, for a second.
settled() {
    local deadline=$((SECONDS + 120)) quiet=0 before='' now
    while [ "$quiet" -lt 5 ]; do
        running || abort "the program goes on running"
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

# geometry: sets where the window is on the screen, and its size.
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

# viewport: sets left, top (on the screen), width and height of the picture.
viewport() {
    geometry
    # The numbers are whole, but JSON may write them as 12.0.
    read -r left top width height < <(look \
        '.viewport // empty | [.x, .y, .width, .height] | map(. + 0.5 | floor | tostring) | join(" ")') ||
        abort "the status tells where the picture is"
    left=$((left + window_x)) top=$((top + window_y))
}

# --- Doing -----------------------------------------------------------------------------------------

# drag X Y DX DY: presses the left button at a point of the screen and moves in ten steps.
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
    # A handle moves or a light is rebuilt; if nothing changes at all, the checks will say so.
    wait_for 10 status_differs_from "$before" || true
}

# --- Machine ---------------------------------------------------------------------------------------

# Ends the script, successfully, where there can be no virtual X server.
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
    want_command jq jq jq "reads what the program reports"
    install_wanted
}

# need_program PROGRAM: sets `program` to that one or, if none is named, to the one that the tests run.
need_program() {
    if [ -n "$1" ]; then
        program=$(cd "$(dirname "$1")" && pwd)/$(basename "$1")
    else
        # Not `cargo build`: the tests ask for more of the GPU and window libraries, which it would compile once more.
        (cd "$root" && cargo test --locked --no-run --test cli)
        program=$(target_folder)/debug/chiaroscuro
    fi
    [ -x "$program" ] || die "there is no program $program"
}

# open_screen: a screen, and in front of it a user whom the program has never met. Closed when the script ends.
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
