#!/bin/bash
# The linker keeps one of all functions of a name. If a function that other files share used wide vectors, a processor
# without them would meet an instruction that it does not have. If another file compiled the functions for eight runs
# without wide vectors, the program might never use these. Usage: lane_vectors_test.sh avx2|avx512 OBJECT PROGRAM
set -e
case "$1" in
    avx2) bytes=32 register=ymm ;;
    avx512) bytes=64 register=zmm ;;
    *) exit 2 ;;
esac
weak=$(nm -C --defined-only "$2" | awk '$2 == "W" || $2 == "V"' | cut -d' ' -f3- | grep -v "<${bytes}ul>" || true)
objdump -dC --no-show-raw-insn "$2" | awk -v weak="$weak" '
    BEGIN { count = split(weak, names, "\n"); for (i = 1; i <= count; ++i) shared["<" names[i] ">:"] = 1 }
    /^[0-9a-f]+ </ { name = substr($0, index($0, "<")) }
    (name in shared) && /\tv[a-z0-9]+ .*%[xyz]mm/ { print name $0; found = 1 }
    END { exit found }'
fly=$(nm --defined-only "$3" | awk '{ print $3 }' | grep "LaneStepperOver.*Lm${bytes}E.*flyE")
objdump -d --no-show-raw-insn --disassemble="$fly" "$3" | grep -q "$register" ||
    { echo "$fly of $3 does not use %$register"; exit 1; }
