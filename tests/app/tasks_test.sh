#!/bin/bash
# Six tasks in a real window, with a limit on the number of actions: a click, a value typed with Return, or a key
# combination is one action. Results are checked in the window's record and on its screen, which test_app compares with
# the picture of the record.
#     tasks_test.sh BUILD_FOLDER
. "$(dirname "$0")/window.sh"

actions=0 elsewhere=0 mouse_at=
# Every action goes through this function.
act() { actions=$((actions + 1)); xdotool "$@"; }
# The place printed by test_app: "x y width height".
place_of() { grep "^place $1 " "$folder/places" | cut -d' ' -f3-; }
point() {
    local x y
    read -r x y _ < <(place_of "$1") || fail "nobody knows where $1 is"
    settle  # a new run moves other items
    mouse_at="$x $y"
    xdotool mousemove --window "$window" "$x" "$y" sleep 0.15
}
click() {
    point "$1"
    [ "$1" = text ] || elsewhere=$((elsewhere + 1))
    act click 1 sleep 0.15
}
# Letters, and cursor motion in a text, are not actions; typing counts as one action with the key that enters it.
letters() { xdotool type --delay 12 "$1"; }
entered() { letters "$1"; act key Return; }
# done_with TASK MOST: checks that the task took at most that many actions; saves its screen.
done_with() {
    echo "$1: $actions actions of $2"
    [ "$actions" -le "$2" ] || fail "the task '$1' takes $actions actions, and may take $2"
    settle
    mkdir "$folder/$1"
    cp "$folder/Xvfb_screen0" "$folder/$1/screen"
    cp "$folder/record" "$folder/$1/record"
    echo "$mouse_at" > "$folder/$1/mouse"
    actions=0 elsewhere=0
}

"$build/test_app" --gtest_brief=1 --gtest_filter='Tasks.*' > "$folder/places" || { cat "$folder/places"; fail "test_app"; }
"$build/achilles" new "$folder/mine" > /dev/null
cd "$folder"  # output files are written there
open_window "" ball_on_sine --record "$folder/record"
settle

# The second Zeno time and its interval: the mouse rests on it.
point zeno
done_with read 0
[ "$(wc -l < "$folder/record")" -eq 1 ] || fail "to read is to change something: $(cat "$folder/record")"

# The reason of a release.
click release
recorded '^select ' "a release is not selected"
done_with why 2
xdotool key Escape
recorded '^select 0' "Escape does not close the card"

# Comparison of e = 0.3 with e = 0.5.
click pin
point e
act click 1
act click 1
sleep 0.15
entered 0.3
recorded '^set e 0.3' "a value that is typed is not set"
grep -q '^pin' "$folder/record" || fail "the run is not pinned"
done_with compare 4
xdotool key Escape
recorded '^hide runs' "Escape does not close the table"
grep -q '^unpin' "$folder/record" && fail "Escape lets go of the pinned run"
click unpin
recorded '^unpin all' "the pinned runs cannot be let go"
actions=0 elsewhere=0

# One plot as a figure.
click plot
click save
settle  # the dialog is open
act key Return
recorded '^export ball_on_sine-.*\.svg plot 2$' "one plot is not exported"
figure=$(sed -n 's/^export \(.*\) plot 2$/\1/p' "$folder/record")
done_with save 3
"$build/achilles" reproduce "$folder/$figure" --out "$folder/again.svg" || fail "the figure cannot be made again"
cmp -s "$folder/$figure" "$folder/again.svg" || fail "the figure is another one when it is made again"

# A new system from the template, with the mouse used only in the text.
# in_line KEY TEXT: replaces the first line that starts with the key, counted from the top of the text.
in_line() {
    local lines
    lines=$(grep -n "^$1" "$folder/mine.toml" | head -1 | cut -d: -f1)
    xdotool key --delay 15 ctrl+Home $(yes Down | head -n $((lines - 1))) End shift+Home sleep 0.2
    letters "$2"
}
act key ctrl+o sleep 0.3
entered "$folder/mine.toml"
recorded "^open $folder/mine.toml" "Ctrl+O does not open the skeleton"
act key ctrl+e sleep 0.3
click text
in_line title 'title = "My ball"'
in_line '    {name = "y"' '    {name = "y", start = 2.5},'
recorded '^text .*My ball.*start = 2.5},\\n' "what is typed does not take effect"
act key ctrl+s
recorded "^save $folder/mine.toml" "Ctrl+S does not save"
[ "$elsewhere" -eq 0 ] || fail "a ball of one's own takes the mouse out of the text"
done_with own 5
"$build/achilles" simulate "$folder/mine.toml" --csv - | sed -n 2p | grep -q '^0,hybrid,2.5,' || fail "it is another ball"

# Undo of a mistake in the file.
xdotool key End
for wrong in " = x" "/2"; do letters "$wrong"; sleep 0.7; done  # two texts, both invalid
recorded '^text .*start = 2.5}, = x/2\\n' "the mistake is not read"
act key ctrl+z
recorded '^undo' "Ctrl+Z does not take the mistake back"
done_with typo 1

ACHILLES_TASKS=$folder "$build/test_app" --gtest_brief=1 --gtest_filter='TasksOnDisplay.*' || fail "the window shows something else"
close_window
