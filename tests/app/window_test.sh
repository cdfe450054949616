#!/bin/bash
# A real window on a virtual display. It draws the same as the off-screen picture; a slider dragged by mouse changes the
# run; typed text takes effect and is saved; a tour advances and ends; files are opened and dropped. The window closes
# with status 0 by Ctrl+Q and by a window manager, also during a long run.
#     window_test.sh BUILD_FOLDER
. "$(dirname "$0")/window.sh"

"$build/test_app" --gtest_filter='ExplorerOnDisplay.*' | tee "$folder/bytes"
grep -q '\[  PASSED  \] 1 test' "$folder/bytes" || fail "the window does not show the bytes of the picture"

"$build/test_app" --gtest_filter=Explorer.TellsWhereTheSliderOfGIs > "$folder/places"
read -r _ x y width < <(grep '^slider ' "$folder/places")
read -r _ tab_x tab_y < <(grep '^tab ' "$folder/places")

open_window "" ball_on_sine --record "$folder/journal"
settle

xdotool mousemove --window "$window" $((x + width / 3)) "$y" sleep 0.3 mousedown 1 sleep 0.3
for step in 1 2 3 4; do xdotool mousemove --window "$window" $((x + width / 3 + step * width / 10)) "$y" sleep 0.2; done
await grep -q '^set g ' "$folder/journal" || fail "the slider's value is not recorded"
followed() { [ "$(grep -c '^set g ' "$folder/journal")" -ge 2 ]; }
# Checked before the button is released, since a busy machine draws few frames.
await followed || fail "the slider does not follow the mouse"
xdotool mouseup 1 sleep 0.3
grep '^set ' "$folder/journal"
if grep '^set ' "$folder/journal" | grep -qv '^set g '; then fail "another value was changed"; fi

# The journal opens the system itself, and its picture differs from the initial one: the trajectory changed.
"$build/achilles" screenshot double_pendulum --size 1280x800 --journal "$folder/journal" --out "$folder/after.png"
"$build/achilles" screenshot ball_on_sine --size 1280x800 --out "$folder/before.png"
cmp -s "$folder/before.png" "$folder/after.png" && fail "nothing changed"

# The equations replace the events.
xdotool mousemove --window "$window" "$tab_x" "$tab_y" sleep 0.3 click 1
await grep -q '^show equations' "$folder/journal" || fail "the equations are not shown"
settle

xdotool key --window "$window" space
await grep -q '^play' "$folder/journal" || xdotool key space
await grep -q '^play' "$folder/journal" || fail "space does not play"
xdotool key --window "$window" space
await grep -q '^pause' "$folder/journal" || fail "space does not pause"

# The editor: a comment is typed at the end of the text and saved by the dialog.
xdotool key ctrl+e sleep 0.5 mousemove --window "$window" 200 300 sleep 0.3 click 1 sleep 0.3 key ctrl+End sleep 0.2
xdotool type --delay 40 "# by hand"
await grep -q '^text .*# by hand"$' "$folder/journal" || fail "what is typed does not take effect"
# The error message appears without further input.
xdotool key Return
xdotool type --delay 40 "[["
await grep -q '^text .*# by hand.*\[\["$' "$folder/journal" || fail "what is typed on the next line does not take effect"
expect_drawn "what a text leads to is not drawn before the next key"
xdotool key BackSpace sleep 0.1 key BackSpace sleep 0.1 key BackSpace
by_hand_again() { [ "$(grep -c '^text .*# by hand"$' "$folder/journal")" -ge 2 ]; }
await by_hand_again || fail "what is taken back does not take effect"
xdotool key ctrl+s sleep 0.5 key ctrl+a sleep 0.2
xdotool type --delay 40 "$folder/mine.toml"
xdotool sleep 0.3 key Return
await grep -q "^save $folder/mine.toml" "$folder/journal" || fail "Ctrl+S does not save"
await test -s "$folder/mine.toml" || fail "nothing was saved"
[ "$(tail -c 9 "$folder/mine.toml")" = "# by hand" ] || fail "something else was saved"

# Closing a window with unsaved changes asks first.
xdotool mousemove --window "$window" 200 300 sleep 0.2 click 1 sleep 0.3 key ctrl+End sleep 0.2
xdotool type --delay 40 "!"
await grep -q '^text .*# by hand!"$' "$folder/journal" || fail "the editor is deaf after it has saved"
xdotool key ctrl+q sleep 1
kill -0 "$explorer" || fail "the window closes over changes that are not saved"
xdotool key Escape sleep 0.5 mousemove --window "$window" 200 300 click 1 sleep 0.2 key ctrl+s
saved_twice() { [ "$(grep -c "^save $folder/mine.toml" "$folder/journal")" -ge 2 ]; }
await saved_twice || fail "the window is deaf after it was to be closed"

close_window

# A file is opened by its path, the window is resized, a tour is started and left, a file is exported; then a window
# manager asks the window to close.
printf 'unpin\nopen double_pendulum\nsay "First."\nwait 600\nsay "Second."\nwait 600\n' > "$folder/tour.journal"
open_window "for a tour" ball_on_sine --journal "$folder/tour.journal" --record "$folder/second"
await grep -q '^say "First' "$folder/second" || fail "the tour does not begin"
grep -q 'Second' "$folder/second" && fail "the tour does not wait"
xdotool sleep 0.5 key Return
await grep -q '^say "Second' "$folder/second" || fail "Enter does not lead the tour on"
grep -q '^wait [1-9]' "$folder/second" || fail "the record does not tell how long the tour waited"
xdotool sleep 0.3 key BackSpace
first_again() { [ "$(grep -c '^say "First' "$folder/second")" -eq 2 ]; }
await first_again || fail "Backspace does not lead the tour back"
xdotool sleep 0.3 key Escape
await grep -q '^say ""' "$folder/second" || fail "Escape does not end the tour"
xdotool key ctrl+shift+p sleep 0.5
xdotool type --delay 30 "show energy"
xdotool sleep 0.2 key Return
await grep -q '^show energy$' "$folder/second" || fail "the energy is not shown"
xdotool windowsize --sync "$window" 1000 700 sleep 0.5
xdotool key ctrl+o sleep 0.5
xdotool type --delay 40 "$folder/mine.toml"
xdotool sleep 0.3 key Return
await grep -q "^open $folder/mine.toml" "$folder/second" || fail "Ctrl+O does not open a file"
xdotool sleep 0.5 key Right sleep 0.3 key End sleep 0.3 key ctrl+z
await grep -q '^undo' "$folder/second" || fail "Ctrl+Z does not undo"
grep -q '^step 1 event' "$folder/second" || fail "the right arrow does not step"
# Files dropped on the window: a system is opened, a journal is replayed.
cp "$folder/mine.toml" "$folder/dropped.toml"
printf 'grid 3 2\n' > "$folder/dropped.journal"
timeout 120 "$build/x11_input" drop "$window" "$folder/dropped.toml" || fail "nobody takes a file that is dropped"
await grep -q "^open $folder/dropped.toml" "$folder/second" || fail "a system that is dropped is not opened"
timeout 120 "$build/x11_input" drop "$window" "$folder/dropped.journal" || fail "nobody takes a second file"
await grep -q '^grid 3 2' "$folder/second" || fail "a journal that is dropped is not replayed"
"$build/achilles" screenshot impact_oscillator --do "seek 3" --size 700x500 --out "$folder/dropped.png"
timeout 120 "$build/x11_input" drop "$window" "$folder/dropped.png" || fail "nobody takes a picture"
await grep -q '^open impact_oscillator' "$folder/second" || fail "a picture that is dropped is not opened as a session"
await grep -q '^seek 3' "$folder/second" || fail "a picture that is dropped does not lead to what it shows"
# A journal that writes files needs permission; Escape refuses. Files dropped meanwhile wait for the answer.
printf 'save %s/stolen.toml\n' "$folder" > "$folder/greedy.journal"
timeout 120 "$build/x11_input" drop "$window" "$folder/greedy.journal" || fail "nobody takes a third file"
"$build/achilles" screenshot --set e=0.25 --do "seek 4" --size 700x500 --out "$folder/own.png" "$folder/mine.toml"
timeout 120 "$build/x11_input" drop "$window" "$folder/own.png" || fail "nobody takes a file while a question is open"
xdotool sleep 0.8 key Return sleep 0.3
grep -q '^seek 4' "$folder/second" && fail "a question is lost in what is dropped after it"
xdotool key Escape sleep 0.8
[ ! -e "$folder/stolen.toml" ] || fail "a journal that is dropped writes a file unasked"
# A picture does not read the file it names without permission: if refused, its own text is used.
grep -q '^seek 4' "$folder/second" && fail "a picture that is dropped reads a file unasked"
xdotool key Escape
await grep -q '^seek 4' "$folder/second" || fail "what is dropped while a question is open is lost"
[ "$(grep -c "^open $folder/mine.toml" "$folder/second")" -eq 1 ] || fail "a file is opened that was refused"
xdotool key ctrl+z sleep 0.3 key ctrl+z sleep 0.3  # back to a text without unsaved changes
xdotool key End sleep 0.5 key Home
"$build/achilles" screenshot --allow-files --journal "$folder/second" --size 1000x700 --out "$folder/replayed.png" ||
    fail "the record cannot be replayed"
"$build/x11_input" close "$window"
expect_end "closed from outside"

# Unsaved text survives a killed window and is offered in the next one; text that is recovered and then discarded is
# gone.
[ -z "$(ls "$folder/state/achilles" 2>/dev/null)" ] || fail "text that was saved or given up is kept"
for signal in TERM HUP; do
    open_window "to be killed" "$folder/mine.toml"
    if [ "$signal" = HUP ]; then xdotool sleep 1 key Escape; fi  # answers "later" to the offer of the earlier text
    xdotool sleep 0.5 key ctrl+e sleep 0.5 mousemove --window "$window" 200 300 sleep 0.3 click 1 sleep 0.3 key ctrl+End sleep 0.2
    xdotool type --delay 40 " lost $signal"
    await grep -q "# by hand.* lost $signal\"" -r "$folder/state/achilles" || fail "what is typed is not kept"
    kill -s "$signal" "$explorer"
    wait "$explorer" || true
    explorer=
done
open_window "to recover in" ball_on_sine --record "$folder/third"
xdotool sleep 1 key Return
await grep -q "^text .* lost" "$folder/third" || fail "Enter does not recover what was not saved"
grep -q "^open $folder/mine.toml" "$folder/third" || fail "what is recovered does not belong to its file"
xdotool sleep 0.5 key Escape sleep 0.5
kill -s KILL "$explorer"
wait "$explorer" || true
explorer=
grep -q "lost" "$folder/mine.toml" && fail "what was not saved is in the file"
[ "$(ls "$folder/state/achilles" | wc -l)" -eq 2 ] || fail "the texts of two windows are not two files"

# A practically endless run: the window opens and closes at once.
open_window "while a long run is under way" ball_on_sine --set e=1 --end 1e9 --max-impacts 1000000000
sleep 2
begin=$SECONDS
close_window
[ $((SECONDS - begin)) -le $((10 * patience)) ] || fail "a long run keeps the window from closing"
