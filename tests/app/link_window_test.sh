#!/bin/bash
# In a real window: Copy link puts a link on the clipboard, and `achilles explore LINK` opens the same session. The links
# of both windows are equal, and the second window looks like the picture of the link.
#     link_window_test.sh BUILD_FOLDER
. "$(dirname "$0")/window.sh"

command -v xclip >/dev/null || { echo "skipped: xclip is not installed"; exit 77; }

# Copies the link by its entry of the palette, and prints it.
copied_link() {
    xdotool key ctrl+shift+p sleep 0.5
    xdotool type --delay 30 "copy link"
    xdotool sleep 0.3 key Return sleep 0.3
    recorded '^copy link$' "the palette does not copy a link"
    xclip -o -selection clipboard
}

open_window "" double_pendulum --set e=0.31 --do "pin" --do "theme dark" --do "seek 1.25" --record "$folder/record"
settle
first=$(copied_link)
case $first in "http://127.0.0.1:8000/#run="*) ;; *) fail "this is no link: $first" ;; esac
xdotool key Escape sleep 0.3
close_window

rm "$folder/record" "$folder/achilles/preferences.journal"
open_window "of the link" "$first" --record "$folder/record"
recorded '^set e 0.31$' "the link does not set the value"
settle
second=$(copied_link)
[ "$second" = "$first" ] || fail "the second window has another link: $second"
xdotool key Escape sleep 0.3
close_window
