# What achilles::core needs to be compiled against and linked.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 3.4)
find_dependency(fmt)
find_dependency(TBB)
find_dependency(PkgConfig)
pkg_check_modules(TOMLPLUSPLUS REQUIRED IMPORTED_TARGET tomlplusplus)
include(${CMAKE_CURRENT_LIST_DIR}/achillesTargets.cmake)
