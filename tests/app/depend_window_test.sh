#!/bin/bash
# Sensitivities in a real window: Ctrl+5 shows them, a click on a bar sweeps its slider; a picture of the record has
# both.
#     depend_window_test.sh BUILD_FOLDER
. "$(dirname "$0")/window.sh"

"$build/test_app" --gtest_filter=SensitivityPanel.TellsWhereItIs > "$folder/places"

open_window "" ball_on_sine --record "$folder/record"
settle
xdotool key ctrl+5
recorded '^show depend$' "Ctrl+5 does not show what a result depends on"
settle
# shellcheck disable=SC2046
xdotool mousemove --window "$window" $(place rate) sleep 0.3 click 1
recorded "^sweep .*x'=-5:5:512" "a click on a bar sweeps nothing"
settle
"$build/achilles" screenshot --journal "$folder/record" --size 1280x800 --out "$folder/record.png"
[ -s "$folder/record.png" ] || fail "the record cannot be drawn"
close_window
