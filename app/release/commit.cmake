# Writes the header with the commit of the source, only if it changed: cmake -DSOURCE=... -DHEADER=... -P commit.cmake
# It runs in every build, so that --version is right without configuring again.
set(archived "$Format:%h$")  # filled in by git archive (.gitattributes)
set(commit "commit unknown: built from files outside of a git repository")
if(EXISTS ${SOURCE}/.git)
    # Without the lock, which could disturb a git command of the user.
    execute_process(COMMAND git --no-optional-locks -C ${SOURCE} describe --always --abbrev=10 --exclude=* --dirty=+
                    OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
    if(NOT failed)
        string(REPLACE "+" " with changes" described "${described}")
        set(commit "commit ${described}")
    endif()
elseif(NOT archived MATCHES "Format")
    set(commit "commit ${archived}")
endif()
file(CONFIGURE OUTPUT ${HEADER} @ONLY CONTENT [[// Written by app/release/commit.cmake.
#pragma once
inline constexpr const char* build_commit = "@commit@";
]])
