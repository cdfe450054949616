#!/bin/bash
# Fifteen tasks of a student in a real window, with the actions of fifteen_tasks.txt: each at most three, or two thirds of
# the earlier number. fifteen_tasks_test.cpp checks what the explorer shows. All of it takes at most 60 s of processor
# time.
#     fifteen_tasks_test.sh BUILD_FOLDER
table="$(realpath "$(dirname "$0")")/fifteen_tasks.txt"
. "$(dirname "$0")/window.sh"
. "$(dirname "$0")/counted_tasks.sh"

# The condition on every row of the table.
awk '/^[a-z_]+ +[0-9]+ +[0-9]+ / && $3 > 3 && 3 * $3 > 2 * $2 { print $1; wrong = 1 } END { exit wrong }' "$table" ||
    fail "a task takes more than three actions and more than two thirds of what it took"

"$build/test_app" --gtest_brief=1 --gtest_filter='FifteenTasks.*' > "$folder/places" ||
    { cat "$folder/places"; fail "test_app"; }
mkdir "$folder/bin"
# A substitute for ffmpeg.
printf '#!/bin/sh\nfor last; do :; done\ncase $last in */*) echo film > "$last" ;; esac\n' > "$folder/bin/ffmpeg"
chmod +x "$folder/bin/ffmpeg"
export PATH=$folder/bin:$PATH
cd "$folder"  # output files are written there
open_window "" ball_on_sine --record "$folder/record"
settle

drag e_from e_to
recorded '^set e 0\.[0-9]*$' "the drag of the slider sets no value"
act key space
recorded '^play$' "Space does not play"
done_with change_e
xdotool key space sleep 0.2
recorded '^pause$' "Space does not pause"
back "reset" "seek 0"

click zeno
recorded '^select ' "the Zeno point is not selected"
done_with certificate
back "select 0" "seek 0"

click release
recorded "^select $(sed -n 's/^release //p' "$folder/places")\$" "the release is not selected"
done_with why_ended
back "select 0" "seek 0"

click zeno
click lens
recorded '^show lens$' "the lens is not shown"
done_with accumulation
back "hide lens" "select 0" "seek 0"

plays=$(grep -c '^play$' "$folder/record")
act key space
act key Right
act key Right
[ "$(grep -c '^play$' "$folder/record")" -gt "$plays" ] || fail "Space does not play"
recorded '^step 1 event$' "Right steps to no event"
[ "$(tail -1 "$folder/record")" = "step 1 event" ] || fail "the playback goes on after a step: $(tail -3 "$folder/record")"
done_with pause_and_step
back "select 0" "seek 0"

drag body body_to
recorded '^start x ' "the body is not moved"
done_with elsewhere
back "look all" "reset"

click pin
say "e = 0.3"
recorded '^set e 0.3$' "the palette sets no value"
done_with compare
back "unpin all" "hide runs" "reset"

back "end 1" "speed 4"
act key ctrl+p
settle
xdotool key ctrl+a
entered "a.pdf"
recorded '^export a.pdf$' "Ctrl+P exports no PDF"
settle
act key ctrl+m
settle
xdotool key ctrl+a
entered "b.mp4"
recorded '^export b.mp4$' "Ctrl+M exports no film"
done_with pdf_and_film
[ "$(head -c 5 a.pdf)" = "%PDF-" ] || fail "a.pdf is no PDF"
await test -s b.mp4 || fail "there is no film"
back "speed 1" "reset"

act key ctrl+n
settle
xdotool type --delay 8 "oops"
actions=$((actions + 1))
recorded '^text "oops' "what is typed does not reach the new text"
settle
act key ctrl+z
recorded '^undo$' "Ctrl+Z does not take the mistake back"
done_with own_text

act key ctrl+s
settle
xdotool key ctrl+a
entered "$folder/own.toml"
recorded "^save $folder/own.toml\$" "Ctrl+S does not save"
settle
close_window
open_window "for the second time" ball_on_sine --record "$folder/record2"
mv "$folder/record" "$folder/record1" && ln -s "$folder/record2" "$folder/record"
settle
act key ctrl+shift+t
recorded "^open $folder/own.toml\$" "Ctrl+Shift+T opens another file"
done_with save_and_reopen
back "open ball_on_sine"

click equations
recorded '^show equations$' "the tab shows no equations"
done_with equations
back "hide equations"

act key ctrl+4
recorded '^show sweep$' "Ctrl+4 shows no sweep"
click second_axis
click second_name
recorded "^sweep .*x'=" "the menu makes no map"
done_with sweep_and_map
back "hide sweep"

# The proof needs no action; the strip shows it, and a copy of the events has it.
settle
is_proof_copied() { xclip -selection clipboard -o | grep 'proved from'; }
if command -v xclip > /dev/null; then
    xdotool key ctrl+c sleep 0.3
    await is_proof_copied || fail "the run is not proved by itself: $(timeout 5 xclip -selection clipboard -o | head -1)"
fi
actions=0
done_with prove

back "open ball_down_a_wave" "set e 0.3"
act key ctrl+6
click along
click along_b
recorded '^orbit .*b=' "the choice of a parameter starts no search"
recorded '^branch [0-9]*$' "the run does not start on the periodic run"
settle
drag branch_from branch_to
[ "$(grep -c '^branch ' "$folder/record")" -gt 1 ] || fail "the mouse does not move along the branch"
done_with branch
back "hide orbit" "open ball_on_sine"

act key F11
recorded '^present on$' "F11 does not present"
click animate
recorded '^animate e ' "the button does not move the value"
act key Down
recorded '^open double_pendulum$' "Down does not open the next system"
done_with lecture
back "present off"

close_window
all_done
echo "in all: $now actions, $before before"
times > "$folder/times"  # not in a pipe, which would measure its own shell
spent=$(tail -1 "$folder/times" | awk '{ for (i = 1; i <= 2; ++i) { split($i, part, /[ms]/); sum += 60 * part[1] + part[2] } print int(sum) }')
echo "$spent s of processor time"
[ "$spent" -le $((60 * patience)) ] || fail "$spent s of processor time are more than 60"
