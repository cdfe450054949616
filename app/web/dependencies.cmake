# Libraries of a build for the browser. Debian has them for its own processor only, so header-only libraries come from
# /usr/include, through a folder of links (the folder itself has headers of the wrong C library), ImGui and zlib are
# compiled from Debian's source packages (app/web/fetch), and TBB has stand-ins for one thread.
set(ACHILLES_WEB ${CMAKE_CURRENT_LIST_DIR})
set(ACHILLES_WEB_LINKS ${PROJECT_BINARY_DIR}/headers)
file(MAKE_DIRECTORY ${ACHILLES_WEB_LINKS})

function(link_headers folder)
    find_path(found ${folder} PATHS ${ARGN} /usr/include NO_DEFAULT_PATH NO_CMAKE_FIND_ROOT_PATH NO_CACHE REQUIRED)
    file(CREATE_LINK ${found}/${folder} ${ACHILLES_WEB_LINKS}/${folder} SYMBOLIC)
endfunction()
link_headers(Eigen /usr/include/eigen3)
link_headers(boost)
link_headers(fmt)
link_headers(nlohmann)
link_headers(stb)
link_headers(toml++)

function(add_headers target)
    add_library(${target} INTERFACE IMPORTED GLOBAL)
    target_include_directories(${target} INTERFACE ${ACHILLES_WEB_LINKS} ${ARGN})
endfunction()
add_headers(Eigen3::Eigen)
add_headers(Boost::headers)
add_headers(PkgConfig::TOMLPLUSPLUS)
add_headers(nlohmann_json::nlohmann_json)
add_headers(PkgConfig::STB ${ACHILLES_WEB_LINKS}/stb)
add_headers(fmt::fmt)
target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY)
add_headers(TBB::tbb ${ACHILLES_WEB})

# What the C++ library of Emscripten lacks, before the library itself.
target_include_directories(achilles_flags SYSTEM BEFORE INTERFACE ${ACHILLES_WEB}/standard)

# The libraries that are compiled here, from the folders that app/web/fetch has filled.
set(ACHILLES_WEB_SOURCES ${PROJECT_BINARY_DIR}/sources)
function(add_source_library target folder)
    list(TRANSFORM ARGN PREPEND ${ACHILLES_WEB_SOURCES}/${folder}/ OUTPUT_VARIABLE files)
    add_library(${target} STATIC ${files})
    target_include_directories(${target} SYSTEM PUBLIC ${ACHILLES_WEB_SOURCES}/${folder})
    target_compile_options(${target} PRIVATE -w)
endfunction()
if(EXISTS ${ACHILLES_WEB_SOURCES}/zlib)
    enable_language(C)
    add_source_library(achilles_zlib zlib adler32.c compress.c crc32.c deflate.c inffast.c inflate.c inftrees.c trees.c
                       uncompr.c zutil.c)
    # FreeType reads the outlines of figures as SVG: TrueType fonts alone.
    add_source_library(achilles_freetype freetype src/base/ftbase.c src/base/ftbitmap.c src/base/ftdebug.c
                       src/base/ftinit.c src/base/ftsystem.c src/gzip/ftgzip.c src/sfnt/sfnt.c src/truetype/truetype.c)
    target_include_directories(achilles_freetype SYSTEM PUBLIC ${ACHILLES_WEB_SOURCES}/freetype/include)
    target_compile_definitions(achilles_freetype PRIVATE FT2_BUILD_LIBRARY FT_CONFIG_OPTION_SYSTEM_ZLIB
                               FT_CONFIG_MODULES_H=<${ACHILLES_WEB}/freetype_modules.h>)
    target_link_libraries(achilles_freetype PUBLIC achilles_zlib)
    add_source_library(achilles_imgui imgui imgui.cpp imgui_draw.cpp imgui_tables.cpp imgui_widgets.cpp
                       misc/cpp/imgui_stdlib.cpp)
    # ImGui's own rasterizer draws the letters.
    target_include_directories(achilles_imgui SYSTEM PUBLIC ${ACHILLES_WEB_SOURCES}/imgui/misc/cpp)
endif()
