# Target `docs`: HTML of the pages and of the library's headers, in docs/html of the build folder. Only if doxygen is there.
find_program(DOXYGEN_PROGRAM doxygen)
if(DOXYGEN_PROGRAM)
    configure_file(docs/Doxyfile.in ${PROJECT_BINARY_DIR}/docs/Doxyfile @ONLY)
    add_custom_target(docs
        COMMAND ${DOXYGEN_PROGRAM} ${PROJECT_BINARY_DIR}/docs/Doxyfile
        COMMAND ${CMAKE_COMMAND} -D LOG=${PROJECT_BINARY_DIR}/docs/warnings.txt -P ${PROJECT_SOURCE_DIR}/cmake/CheckDocs.cmake
        WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} VERBATIM COMMENT "Making the documentation")
endif()
