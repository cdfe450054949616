# Shared by the scripts that count the actions of tasks in a real window. Sourced after window.sh. $table is the table of
# the tasks, with the numbers of actions before and now; $folder/places has the places that test_app printed.

actions=0 now=0 before=0 done=0
# Every action goes through this function.
act() { actions=$((actions + 1)); xdotool "$@" sleep 0.2; }
position_of() { grep "^place $1 " "$folder/places" | cut -d' ' -f3- | grep . || fail "nobody knows where $1 is"; }
point() {
    local x y
    read -r x y < <(position_of "$1")
    settle  # a new run moves other items
    xdotool mousemove --window "$window" "$x" "$y" sleep 0.15
}
click() {
    point "$1"
    act click 1
}
# drag FROM TO: one action.
drag() {
    local x y
    point "$1"
    read -r x y < <(position_of "$2")
    act mousedown 1 sleep 0.4 mousemove_relative -- 3 0 sleep 0.2 mousemove --window "$window" "$x" "$y" sleep 0.3 mouseup 1
}
entered() {
    xdotool type --delay 8 "$1"
    act key Return
}
# say LINE: types a line in the palette, two actions.
say() {
    act key ctrl+shift+p
    entered "$1"
}
recorded() { await grep -q -- "$1" "$folder/record" || fail "$2: $(tail -3 "$folder/record")"; }
# done_with TASK: checks the number of actions against the table.
done_with() {
    local was is
    read -r was is < <(awk -v task="$1" '$1 == task { print $2, $3 }' "$table")
    echo "$1: $actions actions, $was before"
    [ "$actions" -eq "$is" ] || fail "the task '$1' takes $actions actions, and not $is"
    now=$((now + actions)) before=$((before + was)) done=$((done + 1)) actions=0
}
# True if every palette that was shown is hidden again; until then the palette receives the keys.
is_palette_closed() { [ "$(grep -c '^show palette$' "$folder/record")" -eq "$(grep -c '^hide palette$' "$folder/record")" ]; }
# Resets the window between tasks; not counted.
back() {
    xdotool mousemove --window "$window" 640 4
    for line in "$@"; do
        xdotool key ctrl+shift+p sleep 0.25 type --delay 8 "$line"
        xdotool key Return sleep 0.15
        recorded "^${line}\$" "the window is not as it was"
        await is_palette_closed || fail "the palette stays open"
        settle
    done
    actions=0
}
all_done() { [ "$done" -eq "$(grep -cE '^[a-z_]+ +[0-9]+ +[0-9]+ ' "$table")" ] || fail "a task is left out"; }
