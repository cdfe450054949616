#!/bin/bash
# In a real window: the card of keys and terms, the palette, round slider values, the interface scale, presentation
# mode, and preferences kept for the next window.
#     finding_test.sh BUILD_FOLDER
. "$(dirname "$0")/window.sh"

read -r _ x y width < <("$build/test_app" --gtest_filter=Explorer.TellsWhereTheSliderOfGIs | grep '^slider ')
"$build/achilles" new "$folder/mine" > /dev/null


open_window "" ball_on_sine --record "$folder/record"
settle

xdotool key F1
recorded '^show help$' "F1 shows no help"
xdotool sleep 0.3 key Escape
recorded '^hide help$' "Escape does not close the help"

xdotool sleep 0.3 key ctrl+shift+p sleep 0.5
recorded '^show palette$' "Ctrl+Shift+P opens no palette"
xdotool type --delay 30 "gri"
xdotool sleep 0.2 key Return sleep 0.3
xdotool type --delay 30 "3 2"
xdotool sleep 0.2 key Return
recorded '^grid 3 2$' "the palette does not complete and run a command"
recorded '^hide palette$' "the palette stays when its command is done"

# A drag ends at a round number; with Shift the same drag moves the value less.
value() { grep '^set g ' "$folder/record" | tail -1 | cut -d' ' -f3; }
drag() {
    xdotool mousemove --window "$window" $((x + width / 3)) "$y" sleep 0.3 mousedown 1 sleep 0.2
    for step in 1 2 3 4; do xdotool mousemove --window "$window" $((x + width / 3 + step * 10)) "$y" sleep 0.15; done
    xdotool mouseup 1 sleep 0.3
}
drag
recorded '^set g ' "a slider cannot be dragged"
coarse=$(value)
[ "${#coarse}" -le 4 ] || fail "a drag ends at $coarse, which is not round"
xdotool keydown Shift_L sleep 0.2
drag
xdotool keyup Shift_L sleep 0.2
fine=$(value)
[ "$fine" != "$coarse" ] || fail "Shift keeps a slider from moving"
awk -v a="$coarse" -v b="$fine" 'BEGIN { d = b - a; exit !(d > 0 && d < 0.2 * a) }' ||
    fail "a fine drag goes from $coarse to $fine"

xdotool mousemove --window "$window" 640 10 key ctrl+d sleep 0.3 key ctrl+plus sleep 0.5
recorded '^theme dark$' "Ctrl+D does not change the theme"
recorded '^enlarge 1.1$' "Ctrl+Plus makes nothing larger"
xdotool key F11
recorded '^present on$' "F11 does not present"
settle
# A picture of the record equals the window.
"$build/achilles" screenshot --journal "$folder/record" --size 1280x800 --out "$folder/record.png"
[ -s "$folder/record.png" ] || fail "the record cannot be drawn"
xdotool key Escape
recorded '^present off$' "Escape does not end the presentation"
xdotool key ctrl+o sleep 0.5
xdotool type --delay 20 "$folder/mine.toml"
xdotool sleep 0.2 key Return
recorded "^open $folder/mine.toml$" "Ctrl+O does not open a file"
remembered="$folder/achilles/preferences.journal"
await grep -q "^open $folder/mine.toml$" "$remembered" || fail "the file that was open is not remembered"
close_window
printf 'theme dark\nenlarge 1.1\nopen %s\n' "$folder/mine.toml" | cmp - "$remembered" ||
    fail "something else is remembered: $(cat "$remembered")"

open_window "again" ball_on_sine --record "$folder/second"
settle
printf 'open ball_on_sine\ntheme dark\nenlarge 1.1\n' | cmp - "$folder/second" ||
    fail "the next window looks otherwise: $(cat "$folder/second")"
xdotool key ctrl+0 sleep 0.3 key ctrl+d sleep 0.5
await grep -q '^theme light$' "$folder/second" || fail "the theme cannot be changed back"
close_window
printf 'open %s\n' "$folder/mine.toml" | cmp - "$remembered" || fail "what was put back is not: $(cat "$remembered")"
