# shellcheck shell=bash disable=SC2034,SC2154 # scripts and this file share variables
# Tests of user input during slow frames in a real window: flicked handles, typed paths and numbers, and diagrams that
# lead to sections of the panel. For script/faults, which counts trials and successes.

# go ARGS…: performs several actions with one call of xdotool, faster than the window draws a frame.
go() {
    xdotool windowfocus "$window"
    xdotool "$@"
}

# place NAME: sets x, y, across and down to the position and size in the window of a control of the side panel.
place() {
    x=0 y=0 across=0 down=0
    read -r x y across down < <(look ".places[\"$1\"] // empty | [.x, .y, .width, .height] | join(\" \")") || true
}

# must_rest NAME: waits until the control exists and has not moved for two seconds, then calls `place`.
must_rest() {
    local deadline=$((SECONDS + 30)) quiet=0 before='' now
    while [ "$quiet" -lt 8 ]; do
        [ "$SECONDS" -lt "$deadline" ] || { say "$1 is missing, or still moves: $now"; break; }
        now=$(look ".places[\"$1\"] // empty | tostring")
        if [ -n "$now" ] && [ "$now" = "$before" ]; then quiet=$((quiet + 1)); else quiet=0; fi
        before=$now
        sleep 0.25
    done
    place "$1"
}

asks_for_path() { [ "$(look .path_window)" = "$1" ]; }
has_kept() { [ "$(kept "$1")" = "$2" ]; }
has_changed() { [ "$(kept "$1")" != "$2" ]; }
is_written() { jq -e . "$1" >/dev/null 2>&1; }

# Drags a light's handle within a single frame; the camera must stay unchanged.
slow_flicks() {
    local by handle camera lights
    for by in '-40 25' '35 -20' '-25 -30'; do
        tried=$((tried + 1))
        must_settle "before a light is flicked"
        sleep 2
        camera=$(kept .camera) lights=$(kept .lights)
        read -r -a handle < <(look '.light_handles[0] // empty | [.x, .y] | join(" ")') ||
            abort "the status contains the position of the light's handle"
        handle=($((handle[0] + window_x)) $((handle[1] + window_y)))
        # shellcheck disable=SC2086 # two numbers
        set -- $by
        go mousemove "${handle[@]}" sleep 0.8 mousedown 1 mousemove_relative -- "$1" "$2" \
            mousemove_relative -- "$1" "$2" mousemove_relative -- "$1" "$2" mouseup 1
        if await 20 has_changed .lights "$lights" && has_kept .camera "$camera"; then
            well=$((well + 1))
        else
            say "a flick by $by moved $(has_kept .camera "$camera" && echo nothing || echo the camera)"
        fi
    done
}

# Types three numbers separated by Tab, as fast as a keyboard can send them.
slow_typing() {
    local camera
    tried=$((tried + 1))
    camera=$(kept '[.camera.azimuth_deg, .camera.elevation_deg, .camera.projection]')
    go key ctrl+p type --delay 4 Spacing
    xdotool key Return
    # Another row has the same name, above the rows that correct the file.
    must_rest Data/Unit
    place Data/Spacing
    # Fields are to the right of the label, which is 106 points wide.
    go mousemove $((window_x + x + 106 + 25)) $((window_y + y + down / 2)) click 1 \
        type --delay 4 0.957
    xdotool key Tab type --delay 4 0.957
    xdotool key Tab type --delay 4 1.5
    xdotool key Return
    if await 30 has_kept .volume.spacing '[0.957,0.957,1.5]' &&
        has_kept '[.camera.azimuth_deg, .camera.elevation_deg, .camera.projection]' "$camera"; then
        well=$((well + 1))
    else
        say "spacing $(kept .volume.spacing), camera $camera, then $(kept .camera)"
    fi
    must_settle "after the spacing was typed"
}

# Opens dialogs that ask for a path, since there is no desktop portal here, and types a path.
slow_dialogs() {
    local at key title saved=$out/slow.json
    for at in 1 2 3 4 5; do
        for key in s o; do
            tried=$((tried + 1))
            title='Open volume'
            [ "$key" = o ] || title='Save session'
            go key "ctrl+$key"
            if await 10 asks_for_path "$title"; then well=$((well + 1)); else say "Ctrl+$key, attempt $at: no dialog"; fi
            go key Escape
            await 10 asks_for_path null || true
        done
    done
    tried=$((tried + 1))
    go key ctrl+s type --delay 4 "$saved"
    xdotool key Return
    if await 20 is_written "$saved"; then well=$((well + 1)); else say "a session was not saved"; fi
}

# Clicks the diagrams above the panel, which scroll to the titles of sections: to the top, or to the panel's end.
slow_sections() {
    local title below end
    for title in Data Shading Lights Camera 'Sky and scattering' Clipping Shadows Floor; do
        tried=$((tried + 1))
        place "Go to $title"
        go mousemove $((window_x + x + across / 2)) $((window_y + y + down / 2)) click 1
        below=$((y + down))
        sleep 1
        must_rest "$title"
        end=$(look '[.places | to_entries[] | select(.key | startswith("Data")) | .value.y + .value.height] | max')
        if [ $((y - below)) -ge 0 ] && { [ $((y - below)) -le 24 ] || [ "$end" -lt "$window_height" ]; }; then
            well=$((well + 1))
        else
            say "$title: its title is $((y - below)) points below the diagram"
        fi
        import -window root "$out/section-${title%% *}.png" 2>/dev/null || true
    done
}

# Input within a frame of 300 ms, as occurs with software drivers and remote desktops, must not be lost.
slow_frames() {
    local well=0 tried=0 x y across down
    rm -rf "$XDG_DATA_HOME/chiaroscuro"
    # Where there is no portal, zenity would show dialogs; this replacement fails instead.
    mkdir -p "$out/no-dialog"
    printf '#!/bin/sh\nexit 1\n' >"$out/no-dialog/zenity"
    chmod +x "$out/no-dialog/zenity"
    ! has zenity || local -x PATH=$out/no-dialog:$PATH
    launch "$volume" --fault slow-frames:300
    await 60 find_window || abort "a window opens within 60 s"
    must_settle "with slow frames"
    geometry
    slow_flicks
    slow_dialogs
    slow_typing
    slow_sections
    ! panicked && running || well=0
    keep slow-frames
    end
    row "input during slow frames" "$tried" "$well" "frames of 300 ms"
}
