#!/bin/bash
# The linker keeps one of all functions of a name. Where one of them uses AVX-512 and its name does not say so, a
# processor without it would run into an instruction that it does not have. Usage: avx512_test.sh OBJECT
set -e
weak=$(nm -C --defined-only "$1" | awk '$2 == "W" || $2 == "V"' | cut -d' ' -f3- | grep -v '<64ul>' || true)
objdump -dC --no-show-raw-insn "$1" | awk -v weak="$weak" '
    BEGIN { count = split(weak, names, "\n"); for (i = 1; i <= count; ++i) shared["<" names[i] ">:"] = 1 }
    /^[0-9a-f]+ </ { name = substr($0, index($0, "<")) }
    (name in shared) && /\tv[a-z0-9]+ .*%[xyz]mm/ { print name $0; found = 1 }
    END { exit found }'
