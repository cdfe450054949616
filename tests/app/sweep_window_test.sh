#!/bin/bash
# A sweep in a real window: Ctrl+4 shows it, a menu turns the curve into a map, a click in the map selects a run, and a
# picture is drawn from the record.
#     sweep_window_test.sh BUILD_FOLDER
. "$(dirname "$0")/window.sh"

"$build/test_app" --gtest_filter=SweepPanel.TellsWhereItIs > "$folder/places"

open_window "" ball_on_sine --record "$folder/record"
settle
xdotool key ctrl+4
recorded '^show sweep$' "Ctrl+4 shows no sweep"
settle
# shellcheck disable=SC2046
xdotool mousemove --window "$window" $(place menu) sleep 0.3 click 1 sleep 0.5
# shellcheck disable=SC2046
xdotool mousemove --window "$window" $(place rate) sleep 0.3 click 1
recorded "^sweep .*x'=" "the menu makes no map"
settle
# shellcheck disable=SC2046
xdotool mousemove --window "$window" $(place picture) sleep 0.3 click 1
recorded "^start e .* x' " "a click in the map is no other run"
settle
"$build/achilles" screenshot --journal "$folder/record" --size 1280x800 --out "$folder/record.png"
[ -s "$folder/record.png" ] || fail "the record cannot be drawn"
close_window
