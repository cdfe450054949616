#!/bin/bash
# A proof in a real window: a button starts and removes it, a menu proves a wider box; a picture of the record shows it.
#     proof_window_test.sh BUILD_FOLDER
. "$(dirname "$0")/window.sh"

"$build/test_app" --gtest_filter=ProofPanels.TellWhereTheyAre > "$folder/places"

open_window "" ball_on_sine --record "$folder/record"
settle
# shellcheck disable=SC2046
xdotool mousemove --window "$window" $(place tab) sleep 0.3 click 1
recorded '^show proof$' "the tab does not open"
settle
# shellcheck disable=SC2046
xdotool mousemove --window "$window" $(place prove) sleep 0.3 click 1
recorded '^prove$' "the button proves nothing"
settle
# shellcheck disable=SC2046
xdotool mousemove --window "$window" $(place prove) sleep 0.3 click 1
recorded '^prove off$' "the button does not forget the proof"
settle
# shellcheck disable=SC2046
xdotool mousemove --window "$window" $(place more) sleep 0.3 click 1 sleep 0.5
# shellcheck disable=SC2046
xdotool mousemove --window "$window" $(place wider) sleep 0.3 click 1
recorded '^prove width 1e-06$' "the menu proves no more"
settle
"$build/achilles" screenshot --journal "$folder/record" --size 1280x800 --out "$folder/record.png"
[ -s "$folder/record.png" ] || fail "the record cannot be drawn"
close_window
