#!/bin/bash
# Exports in a real window by keyboard only: the gallery, a focused control, the dialog with its folder, and an exported
# picture that is dropped on the window.
#     export_test.sh BUILD_FOLDER
. "$(dirname "$0")/window.sh"

mkdir "$folder/papers" "$folder/bin"
# A substitute for ffmpeg.
printf '#!/bin/sh\nfor last; do :; done\ncase $last in */*) echo film > "$last" ;; esac\n' > "$folder/bin/ffmpeg"
chmod +x "$folder/bin/ffmpeg"
export PATH=$folder/bin:$PATH

open_window "" ball_on_sine --record "$folder/record"
settle

# Tab moves the focus to a control, Escape returns it to the player.
xdotool key Tab sleep 0.3 key Right sleep 0.3 key Right sleep 0.3 key Escape sleep 0.3 key Right
recorded '^step 1 event$' "Escape does not give the keys back to the player"
[ "$(grep -c '^step' "$folder/record")" -eq 1 ] || fail "arrows move the time while a control has the keys"

# Gallery: right arrow, Enter.
xdotool key ctrl+g
recorded '^show gallery$' "Ctrl+G shows no gallery"
settle
xdotool key Right sleep 0.3 key Return
recorded '^open double_pendulum$' "the gallery opens nothing by keys"
settle

# Opens the dialog with the palette; completes its path and exports.
xdotool key ctrl+shift+p sleep 0.5
xdotool type --delay 20 "show export"
xdotool sleep 0.2 key Return
recorded '^show export$' "the palette does not show the dialog"
settle
xdotool key ctrl+a
xdotool type --delay 20 "$folder/pap"
xdotool sleep 0.3 key Tab sleep 0.5
xdotool type --delay 20 "a.svg"
xdotool sleep 0.3 key Return
recorded "^export $folder/papers/a.svg$" "the dialog does not complete a folder and write into it: $(cat "$folder/record")"
await test -s "$folder/papers/a.svg" || fail "nothing is written"
recorded '^hide export$' "the dialog stays"

# An animation: its completion is shown without further input.
xdotool key ctrl+shift+p sleep 0.5
xdotool type --delay 20 "export $folder/papers/b.mp4 fps 1 pixels 320"
xdotool sleep 0.2 key Return
recorded "^export $folder/papers/b.mp4" "the palette exports no film"
await test -s "$folder/papers/b.mp4" || fail "no film is made"
# The explorer checks every 0.25 s whether the film's process has ended. settle() waits only 0.2 s, which may be too
# short, so this waits for the process first.
has_no_child() { ! grep -qs "^PPid:[[:space:]]*$explorer\$" /proc/[0-9]*/status; }
await has_no_child || fail "the film does not end"
expect_drawn "the end of a film is not drawn before the next key"

# A dropped picture of a mechanism on paper restores its session.
"$build/achilles" figure impact_oscillator --mechanism --at 3 --width-mm 85 --out "$folder/mechanism.svg"
timeout 120 "$build/x11_input" drop "$window" "$folder/mechanism.svg" || fail "nobody takes a picture"
recorded '^open impact_oscillator' "a mechanism that is dropped is not opened"
recorded '^seek 3$' "a mechanism that is dropped does not lead to its instant"
# So does the picture from the dialog.
timeout 120 "$build/x11_input" drop "$window" "$folder/papers/a.svg" || fail "nobody takes a second picture"
opened_twice() { [ "$(grep -c '^open double_pendulum' "$folder/record")" -eq 2 ]; }
await opened_twice || fail "an exported figure does not lead back"
settle
close_window
