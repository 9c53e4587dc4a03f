# Fails if doxygen has warned. Every class, enumeration, type and free function needs a sentence; of the members of a class
# only those whose names do not say all, so that such warnings are passed over. LOG: doxygen's warnings.
file(STRINGS ${LOG} lines)
list(FILTER lines EXCLUDE REGEX "warning: Member .* of (class|struct) .* is not documented")
list(FILTER lines EXCLUDE REGEX "^ *$")
list(LENGTH lines count)
if(count GREATER 0)
    list(TRANSFORM lines PREPEND "  ")  # CMake wraps lines that are not indented
    list(JOIN lines "\n" text)
    message(FATAL_ERROR "${count} warnings:\n${text}")
endif()
