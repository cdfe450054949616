# The Debian packages, made by `app/run package`: achilles, and achilles-mpi with the library for mpirun, because that one
# needs Open MPI. Dependencies on libraries are found by dpkg-shlibdeps; others are listed here.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The Achilles authors <maintainers@users.noreply.github.com>" CACHE STRING
    "Maintainer of the packages")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
                                                WORLD_READ WORLD_EXECUTE)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/debian.cmake)
set(CPACK_THREADS 0)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
foreach(package MAIN MPI)
    set(CPACK_DEBIAN_${package}_FILE_NAME DEB-DEFAULT)
endforeach()

set(CPACK_DEBIAN_MAIN_PACKAGE_NAME achilles)
set(CPACK_COMPONENT_MAIN_DESCRIPTION "A ball that loses speed at every impact bounces infinitely often in finite
time. Achilles completes such motions past the instant where the impacts
accumulate, certifies it with interval arithmetic, and proves whole runs.
.
The package has the program with its explorer, gallery and manual, the Python
module, and the C++ library with its headers.")
# Libraries that are loaded when they are needed, so that dpkg-shlibdeps does not see them: OpenGL for the window and
# without a display, HDF5 for tables.
set(CPACK_DEBIAN_MAIN_PACKAGE_DEPENDS "fonts-dejavu-core, libgl1, libgl1-mesa-dri, libosmesa6 | libegl1")
set(CPACK_DEBIAN_MAIN_PACKAGE_RECOMMENDS librsvg2-bin)
set(CPACK_DEBIAN_MAIN_PACKAGE_SUGGESTS
    "achilles-mpi, ffmpeg, g++, cmake, pkg-config, libeigen3-dev, libfmt-dev, libtbb-dev, libtomlplusplus-dev")
if(ACHILLES_HDF5_FILE)
    file(REAL_PATH "${ACHILLES_HDF5_FILE}" file)
    execute_process(COMMAND dpkg-query -S ${file} OUTPUT_VARIABLE owner ERROR_QUIET)
    if(owner MATCHES "^([^:]+):")
        string(APPEND CPACK_DEBIAN_MAIN_PACKAGE_RECOMMENDS ", ${CMAKE_MATCH_1}")
    endif()
endif()
if(TARGET achilles_python)
    math(EXPR next "${ACHILLES_PYTHON_MINOR} + 1")
    string(APPEND CPACK_DEBIAN_MAIN_PACKAGE_DEPENDS
           ", python3 (>= 3.${ACHILLES_PYTHON_MINOR}), python3 (<< 3.${next}), python3-numpy")
    set(CPACK_DEBIAN_MAIN_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_LIST_DIR}/postinst ${CMAKE_CURRENT_LIST_DIR}/prerm)
endif()

set(CPACK_DEBIAN_MPI_PACKAGE_NAME achilles-mpi)
set(CPACK_DEBIAN_MPI_PACKAGE_DEPENDS "achilles (= ${PROJECT_VERSION})")
set(CPACK_COMPONENT_MPI_DESCRIPTION "The library that lets the processes of mpirun or srun share the runs of a
sweep.")

include(CPack)
cpack_add_component_group(main)
cpack_add_component_group(mpi)
foreach(component Unspecified core python)
    cpack_add_component(${component} GROUP main)
endforeach()
cpack_add_component(mpi GROUP mpi)
