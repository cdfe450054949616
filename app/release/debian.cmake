# Run by CPack on the files of the packages before it packs them: what Debian's policy wants otherwise than an
# installation under /usr/local.
set(main ${CPACK_TEMPORARY_DIRECTORY}/main/usr)
cmake_path(GET CMAKE_CURRENT_LIST_DIR PARENT_PATH source)
cmake_path(GET source PARENT_PATH source)

# The font is that of its own package.
file(GLOB fonts ${main}/share/achilles/fonts/*.ttf)
foreach(font ${fonts})
    cmake_path(GET font FILENAME name)
    file(REMOVE ${font})
    file(CREATE_LINK ../../fonts/truetype/dejavu/${name} ${font} SYMBOLIC)
endforeach()

# Python packages do not lie in a folder of one version.
file(GLOB python ${main}/lib/python3.*)
if(python)
    file(RENAME ${python} ${main}/lib/python3)
endif()

# The license, and the notices of the libraries whose code is in the program. Boost's license needs none in programs.
file(READ ${source}/LICENSE license)
set(copyright "Achilles, built by the authors as a Debian package.\n\n${license}")
foreach(package libimgui-dev libstb-dev libcli11-dev pybind11-dev libxbyak-dev libtomlplusplus-dev nlohmann-json3-dev
        libeigen3-dev libfmt-dev)
    if(EXISTS /usr/share/doc/${package}/copyright)
        file(READ /usr/share/doc/${package}/copyright notice)
        string(APPEND copyright "\n\n---- The programs contain code of Debian's ${package}, with this notice: ----\n\n${notice}")
    endif()
endforeach()
set(documents ${main}/share/doc/achilles)
file(WRITE ${documents}/copyright "${copyright}")

string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)  # of SOURCE_DATE_EPOCH, if that is set
file(WRITE ${documents}/changelog "achilles (${CPACK_PACKAGE_VERSION}) unstable; urgency=medium

  * Version ${CPACK_PACKAGE_VERSION}.

 -- ${CPACK_PACKAGE_CONTACT}  ${date}
")
execute_process(COMMAND gzip -9n ${documents}/changelog COMMAND_ERROR_IS_FATAL ANY)

# The documents of the second package are those of the first.
set(mpi ${CPACK_TEMPORARY_DIRECTORY}/mpi/usr)
if(EXISTS ${mpi})
    file(MAKE_DIRECTORY ${mpi}/share/doc)
    file(CREATE_LINK achilles ${mpi}/share/doc/achilles-mpi SYMBOLIC)
endif()
