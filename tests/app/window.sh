# What the scripts beside this one share: a display of their own with its screen in a file, a folder, an explorer in its
# window. Sourced first, with the script's arguments; $1 is the folder of the build.
set -euo pipefail

if [ -z "${ACHILLES_WINDOW_FOLDER-}" ]; then
    ACHILLES_WINDOW_FOLDER=$(mktemp -d)
    export ACHILLES_WINDOW_FOLDER
    # As small a screen as the window needs; no display of the person who runs the tests is touched. Without -noreset the
    # server starts anew when one explorer has closed, and the next may find it gone.
    exec xvfb-run --auto-servernum --server-args="-screen 0 1280x800x24 -noreset -fbdir $ACHILLES_WINDOW_FOLDER" "$0" "$@"
fi

build=$1
folder=$ACHILLES_WINDOW_FOLDER
explorer=
trap 'if [ -n "$explorer" ]; then kill "$explorer" 2>/dev/null || true; fi; rm -rf "$folder"' EXIT
export MESA_SHADER_CACHE_DISABLE=true XDG_CONFIG_HOME=$folder XDG_STATE_HOME=$folder/state

fail() { echo "$(basename "$0" .sh): $*" >&2; exit 1; }
# How many times slower than an ordinary build this one is, as under the sanitizers: a click that comes before what it is to
# click has been drawn is lost, and so every pause here, of the hand too, is as much longer.
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

# Waits up to 30 s for a command to succeed.
await() { for _ in $(seq 300); do if "$@" >/dev/null 2>&1; then return 0; fi; sleep 0.1; done; return 1; }

# Where a thing is, "X Y", as a test told it into $folder/places; and waits until the record has such a line.
place() { grep "^$1 " "$folder/places" | cut -d' ' -f2-; }
recorded() { await grep -q "$1" "$folder/record" || fail "$2"; }

# open_window WHY ARGUMENTS: an explorer with these arguments; its process is $explorer, its window $window.
open_window() {
    local why=$1
    shift
    "$build/achilles" explore --size 1280x800 "$@" &
    explorer=$!
    await xdotool search --onlyvisible --class achilles || fail "no window appears $why"
    window=$(xdotool search --onlyvisible --class achilles | head -1)
    xdotool windowfocus --sync "$window" || true
}

# The explorer has to end by itself, with this status.
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

# Every thread of the explorer sleeps: it has drawn what it was told.
is_asleep() { ! sed 's/.*) //' /proc/"$explorer"/task/*/stat | grep -qv '^S'; }
# Until the window shows what was done, also where other work keeps it from drawing at once: it sleeps, and its screen is as
# it was some time ago.
settle() {
    for _ in $(seq 120); do
        cp "$folder/Xvfb_screen0" "$folder/before"
        sleep 0.2
        if is_asleep && cmp -s "$folder/Xvfb_screen0" "$folder/before"; then return 0; fi
    done
    fail "the window does not come to rest"
}
# What the window shows is all that there is to see: a key that does nothing draws it anew, and nothing changes.
expect_drawn() {
    settle
    cp "$folder/Xvfb_screen0" "$folder/asleep"
    xdotool key shift sleep 0.5
    settle
    cmp -s "$folder/Xvfb_screen0" "$folder/asleep" || fail "$1"
}
