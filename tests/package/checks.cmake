# What the tests of packages share.

# run(STATUS COMMAND...): runs a command, which must end with that status; leaves `output` and `errors`.
function(run expected)
    execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE errors)
    if(NOT status STREQUAL expected)
        list(JOIN ARGN " " command)
        message(FATAL_ERROR "${command}\nended with ${status}, not ${expected}\n${output}${errors}")
    endif()
    set(output "${output}" PARENT_SCOPE)
    set(errors "${errors}" PARENT_SCOPE)
endfunction()

# expect(TEXT REGEX): the text must match.
function(expect text regex)
    if(NOT text MATCHES "${regex}")
        message(FATAL_ERROR "Expected ${regex}\nin ${text}")
    endif()
endfunction()
