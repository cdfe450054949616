/* The parts of FreeType that a page needs (see dependencies.cmake). No guard: FreeType includes it repeatedly. */
FT_USE_MODULE(FT_Driver_ClassRec, tt_driver_class)
FT_USE_MODULE(FT_Module_Class, sfnt_module_class)
