# Shared by the scripts in this folder: a virtual display with its screen in a file, a temporary folder, and an explorer
# in a window. Sourced first, with the script's arguments; $1 is the build folder. $screen is the size of both.
set -euo pipefail

screen=${screen:-1280x800}
if [ -z "${ACHILLES_WINDOW_FOLDER-}" ]; then
    ACHILLES_WINDOW_FOLDER=$(mktemp -d)
    export ACHILLES_WINDOW_FOLDER
    # The screen is as small as the window allows; the user's own display is not used. Without -noreset the server would
    # restart when an explorer closes, and the next one might not find it.
    exec xvfb-run --auto-servernum --server-args="-screen 0 ${screen}x24 -noreset -fbdir $ACHILLES_WINDOW_FOLDER" "$0" "$@"
fi

build=$1
folder=$ACHILLES_WINDOW_FOLDER
explorer=
trap 'if [ -n "$explorer" ]; then kill "$explorer" 2>/dev/null || true; fi; rm -rf "$folder"' EXIT
export MESA_SHADER_CACHE_DISABLE=true XDG_CONFIG_HOME=$folder XDG_STATE_HOME=$folder/state

fail() { echo "$(basename "$0" .sh): $*" >&2; exit 1; }
# Slowdown of this build compared with an ordinary one, e.g. with sanitizers. A click before its target is drawn is
# lost, so all pauses, also those of the simulated input, are multiplied by it.
patience=${ACHILLES_PATIENCE:-1}
sleep() { for _ in $(seq "$patience"); do command sleep "$1"; done; }
xdotool() {
    local word before="" words=()
    for word in "$@"; do
        case $before in
            sleep) for _ in $(seq 2 "$patience"); do words+=("$word" sleep); done ;;
            --delay) word=$((word * patience)) ;;
        esac
        words+=("$word")
        before=$word
    done
    command xdotool "${words[@]}"
}

# await COMMAND: waits up to 30 s for the command to succeed.
await() { for _ in $(seq 300); do if "$@" >/dev/null 2>&1; then return 0; fi; sleep 0.1; done; return 1; }

# place NAME: the position "X Y" that a test printed into $folder/places. recorded PATTERN WHY: waits until a line of
# the record matches.
place() { grep "^$1 " "$folder/places" | cut -d' ' -f2-; }
# recorded PATTERN MESSAGE: waits until the journal has a line like PATTERN.
recorded() { await grep -q "$1" "$folder/record" || fail "$2"; }

# open_window WHY ARGUMENTS: starts an explorer with these arguments; its process is $explorer, its window $window.
open_window() {
    local why=$1
    shift
    "$build/achilles" explore --size "$screen" "$@" &
    explorer=$!
    await xdotool search --onlyvisible --class achilles || fail "no window appears $why"
    window=$(xdotool search --onlyvisible --class achilles | head -1)
    xdotool windowfocus --sync "$window" || true
}

# Waits until the explorer ends by itself, and checks its status.
expect_end() {
    local status=0
    wait "$explorer" || status=$?
    explorer=
    [ "$status" -eq 0 ] || fail "$1 the explorer ends with status $status"
}
close_window() {
    xdotool key ctrl+q
    expect_end "closed by Ctrl+Q"
}

# True if all threads of the explorer sleep, so that it has drawn everything.
is_asleep() { ! sed 's/.*) //' /proc/"$explorer"/task/*/stat | grep -qv '^S'; }
# Waits until the window shows the result, also on a busy machine: the explorer sleeps and its screen no longer changes.
settle() {
    for _ in $(seq 400); do
        cp "$folder/Xvfb_screen0" "$folder/before"
        sleep 0.2
        if is_asleep && cmp -s "$folder/Xvfb_screen0" "$folder/before"; then return 0; fi
    done
    fail "the window does not come to rest"
}
# Checks that the window is up to date: a key without effect redraws it, and nothing changes.
expect_drawn() {
    settle
    cp "$folder/Xvfb_screen0" "$folder/asleep"
    xdotool key shift sleep 0.5
    settle
    cmp -s "$folder/Xvfb_screen0" "$folder/asleep" || fail "$1"
}
