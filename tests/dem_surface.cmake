# Grains on deforming surfaces. `surface_scene.h` is shared.
function(surface_test name label)
  trackbed_test(${name} ${label} trackbed_dem)
  target_include_directories(${name}_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/unit)
endfunction()

surface_test(surface_facet unit)
surface_test(surface_patch unit)
surface_test(surface_threads unit)
surface_test(surface_energy verification)
surface_test(surface_round verification)
surface_test(surface_flat verification)
target_include_directories(surface_flat_test PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/verification)

add_executable(surface_benchmark ${CMAKE_CURRENT_SOURCE_DIR}/benchmarks/surface_benchmark.cc)
target_link_libraries(surface_benchmark PRIVATE trackbed_dem)
target_include_directories(surface_benchmark PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/unit)
