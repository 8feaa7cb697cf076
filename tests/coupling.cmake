# Grains and finite elements together. `coupling_scene.h` is shared.
function(coupling_test name label)
  trackbed_test(${name} ${label} trackbed_coupling)
  target_include_directories(${name}_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/unit)
endfunction()

coupling_test(coupling_world unit)
coupling_test(coupling_exchange verification)
coupling_test(coupling_limit verification)
coupling_test(coupling_beam_impact verification)
coupling_test(coupling_servo verification)
coupling_test(coupling_threads hard)
coupling_test(effects_off hard)

# Hard cases: one table for the quick test and for the command that runs all settings.
file(GLOB hard_case_files CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/hard/cases/*.cc)
add_library(trackbed_hard_cases STATIC ${hard_case_files})
target_include_directories(trackbed_hard_cases PUBLIC ${CMAKE_CURRENT_SOURCE_DIR}/unit
                           ${CMAKE_CURRENT_SOURCE_DIR}/verification
                           ${CMAKE_CURRENT_SOURCE_DIR}/hard/cases)
target_link_libraries(trackbed_hard_cases PUBLIC trackbed_coupling)
trackbed_test(hard_cases hard trackbed_hard_cases)
target_compile_definitions(hard_cases_test PRIVATE TESTS="${CMAKE_CURRENT_SOURCE_DIR}")
add_executable(hard_cases ${CMAKE_CURRENT_SOURCE_DIR}/hard/hard_cases.cc)
target_link_libraries(hard_cases PRIVATE trackbed_hard_cases)
