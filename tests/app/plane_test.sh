#!/bin/bash
# The configuration plane in a real window: its menu selects a phase plane, its toggle the contours, and a picture is
# drawn from the record.
#     plane_test.sh BUILD_FOLDER
. "$(dirname "$0")/window.sh"

"$build/test_app" --gtest_filter=PlaneMenu.TellsWhereItIs > "$folder/places"

open_window "" double_pendulum --do "show plane" --record "$folder/record"
settle
# shellcheck disable=SC2046
xdotool mousemove --window "$window" $(place menu) sleep 0.3 click 1 sleep 0.5
# shellcheck disable=SC2046
xdotool mousemove --window "$window" $(place phase) sleep 0.3 click 1
recorded "^plane theta2 theta2'$" "the menu of the plane chooses none"
settle
# shellcheck disable=SC2046
xdotool mousemove --window "$window" $(place contours) sleep 0.3 click 1
recorded '^show contours$' "the switch shows no contours"
settle
"$build/achilles" screenshot --journal "$folder/record" --size 1280x800 --out "$folder/record.png"
[ -s "$folder/record.png" ] || fail "the record cannot be drawn"
close_window
