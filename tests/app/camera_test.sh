#!/bin/bash
# The cameras in a real window: the menu selects one, the middle button pans, and a picture is drawn from the record.
#     camera_test.sh BUILD_FOLDER
. "$(dirname "$0")/window.sh"

"$build/test_app" --gtest_filter=CameraMenu.TellsWhereItIs > "$folder/places"

open_window "" ball_on_sine --record "$folder/record"
settle
# shellcheck disable=SC2046
xdotool mousemove --window "$window" $(place menu) sleep 0.3 click 1 sleep 0.5
# shellcheck disable=SC2046
xdotool mousemove --window "$window" $(place zeno) sleep 0.3 click 1
recorded '^camera zeno$' "the menu of cameras chooses none"
read -r x y < <(place picture)
xdotool mousemove --window "$window" "$x" "$y" sleep 0.3 mousedown 2 sleep 0.2
for step in 1 2 3; do xdotool mousemove --window "$window" $((x + 20 * step)) $((y + 10 * step)) sleep 0.2; done
xdotool mouseup 2
recorded '^look ' "the middle button does not move the picture"
grep -q '^start ' "$folder/record" && fail "the middle button moves the body"
settle
"$build/achilles" screenshot --journal "$folder/record" --size 1280x800 --out "$folder/record.png"
[ -s "$folder/record.png" ] || fail "the record cannot be drawn"
close_window
