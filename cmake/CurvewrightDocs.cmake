# Target `docs`: HTML of the pages and of the library's headers, in docs/html of the build folder. Only if doxygen is there.
find_program(DOXYGEN_PROGRAM doxygen)
if(DOXYGEN_PROGRAM)
    configure_file(docs/Doxyfile.in ${PROJECT_BINARY_DIR}/docs/Doxyfile @ONLY)
    # Pictures that a page names by HTML stay where it looks for them.
    set(thesis_pictures ${PROJECT_SOURCE_DIR}/docs/thesis/pictures)
    if(EXISTS ${thesis_pictures})
        set(copy_pictures COMMAND ${CMAKE_COMMAND} -E copy_directory ${thesis_pictures} ${PROJECT_BINARY_DIR}/docs/html/pictures)
    endif()
    add_custom_target(docs
        COMMAND ${DOXYGEN_PROGRAM} ${PROJECT_BINARY_DIR}/docs/Doxyfile
        COMMAND ${CMAKE_COMMAND} -D LOG=${PROJECT_BINARY_DIR}/docs/warnings.txt -P ${PROJECT_SOURCE_DIR}/cmake/CheckDocs.cmake
        ${copy_pictures}
        WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} VERBATIM COMMENT "Making the documentation")
endif()
