#!/bin/bash
# A periodic orbit in a real window: Ctrl+6 shows the panel, its button searches and starts the run on the result; a
# picture of the record shows it.
#     orbit_window_test.sh BUILD_FOLDER
. "$(dirname "$0")/window.sh"

"$build/test_app" --gtest_filter=OrbitPanel.TellsWhereItIs > "$folder/places"

open_window "" ball_down_a_wave --record "$folder/record"
settle
xdotool key ctrl+6
recorded '^show orbit$' "Ctrl+6 does not show the periodic run"
settle
# shellcheck disable=SC2046
xdotool mousemove --window "$window" $(place periodic) sleep 0.3 click 1
recorded '^orbit ""$' "the button searches for nothing"
recorded '^branch 1$' "the run does not begin on what was found"
settle
"$build/achilles" screenshot --journal "$folder/record" --size 1280x800 --out "$folder/record.png"
[ -s "$folder/record.png" ] || fail "the record cannot be drawn"
close_window
