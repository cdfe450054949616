#!/bin/bash
# Ten tasks of a researcher and a teacher in a real window: at most the actions of ten_tasks.txt, and in total at most
# two thirds of the earlier number. ten_tasks_test.cpp checks what the explorer shows.
#     ten_tasks_test.sh BUILD_FOLDER
table="$(realpath "$(dirname "$0")")/ten_tasks.txt"
. "$(dirname "$0")/window.sh"
. "$(dirname "$0")/counted_tasks.sh"

"$build/test_app" --gtest_brief=1 --gtest_filter='TenTasks.*' > "$folder/places" || { cat "$folder/places"; fail "test_app"; }
"$build/achilles" new "$folder/mine" > /dev/null
mkdir "$folder/achilles"
echo "open $folder/mine.toml" > "$folder/achilles/preferences.journal"
cd "$folder"  # output files are written there
open_window "" ball_on_sine --record "$folder/record"
settle

# Researcher.
click equations
recorded '^show equations$' "the tab shows no equations"
click zeno
recorded '^select ' "a result is not selected"
act key Left
act key Left
recorded '^step -1 event$' "Left does not go to the impact before"
done_with zeno_condition
back "hide equations" "select 0" "seek 0"

back "set e 0.3" "set x' 1.2" "method dopri5"
done_with differs
back "reset"

click pin
say "set e 0.3"
recorded '^set e 0.3$' "the palette sets no value"
click pin_again
say "set e 0.7"
recorded '^set e 0.7$' "the palette sets no second value"
[ "$(grep -c '^pin$' "$folder/record")" -eq 2 ] || fail "two runs are not pinned"
done_with restitutions
back "unpin all" "hide runs" "reset"

say "export height.svg plot 2 width 85 font 8"
recorded '^export height.svg plot 2 width 85' "the palette exports nothing"
await grep -q 'width="85mm"' "$folder/height.svg" || fail "the figure is not as wide as a column"
done_with figure

say "method dopri5"
recorded '^method dopri5$' "the palette does not change the method"
done_with method
back "reset"

# Teacher.
act key F11
recorded '^present on$' "F11 does not present"
done_with class
back "present off"

click zeno
act key Left
click camera
click camera_zeno
recorded '^camera zeno$' "the camera does not go to the Zeno point"
done_with bouncing
back "camera fit" "select 0" "seek 0"

click view
click view_energy
recorded '^show energy$' "the energy is not shown"
click zeno_over_energy
recorded '^select ' "a result is not selected beside the energy"
done_with energy
back "hide energy" "select 0"

click file
point recent_menu
xdotool sleep 0.4
click recent
recorded "^open $folder/mine.toml\$" "the menu does not open the file that was open last"
done_with yesterday
back "open ball_on_sine"

act key ctrl+g
settle
point gallery
notches=$(sed -n 's/^notches //p' "$folder/places")
act click --repeat "$notches" --delay 5 5
settle
click several
recorded '^open double_pendulum_two_stops$' "the gallery opens no system with several contacts"
done_with contacts

close_window
all_done
echo "in all: $now actions, $before before"
[ $((3 * now)) -le $((2 * before)) ] || fail "$now actions are more than two thirds of $before"
