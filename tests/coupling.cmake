# Grains and finite elements together. `coupling_scene.h` is shared.
function(coupling_test name label)
  trackbed_test(${name} ${label} trackbed_coupling)
  target_include_directories(${name}_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/unit)
endfunction()

coupling_test(coupling_world unit)
coupling_test(coupling_exchange verification)
coupling_test(coupling_threads hard)
coupling_test(effects_off hard)
